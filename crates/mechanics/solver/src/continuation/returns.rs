//! Detection of paths that make no progress.

/// Number of returns to earlier events after which a path makes no progress.
///
/// Returns count from the last maximum of the control parameter. A path between equal parts, such as
/// the gaps of a strip, may return to the load of an event several times with other parts changed.
const MOST_RETURNS: usize = 50;

/// Number of successive events at one point, per constraint, after which a path makes no progress.
const MOST_AT_A_POINT: usize = 3;

/// Relative difference of the coordinates of equal events.
const SAME: f64 = 1e-9;

/// Number of earlier events that are compared.
const COMPARED: usize = 1000;

/// Events of a path since its control parameter was last at its maximum.
#[derive(Clone, Debug, Default)]
pub(super) struct Returns {
    /// Control parameter and load at the distinct events.
    events: Vec<[f64; 2]>,
    /// Index of the last event in the list.
    last: usize,
    /// Number of events that equal an earlier one with another one in between.
    repeated: usize,
    /// Number of successive events that equal the last one.
    stays: usize,
}

impl Returns {
    /// Adds an event of a system with this number of constraints.
    ///
    /// Returns true if the path makes no progress.
    pub(super) fn add(&mut self, event: [f64; 2], constraints: usize) -> bool {
        let first = self.events.len().saturating_sub(COMPARED);
        match self.events[first..]
            .iter()
            .rposition(|other| is_same(event, *other))
            .map(|found| first + found)
        {
            Some(found) if found == self.last => self.stays += 1,
            Some(found) => (self.last, self.stays, self.repeated) = (found, 0, self.repeated + 1),
            None => {
                self.events.push(event);
                (self.last, self.stays) = (self.events.len() - 1, 0);
            }
        }
        self.repeated > MOST_RETURNS || self.stays > MOST_AT_A_POINT * (constraints + 1)
    }

    /// Forgets all events, because the path has made progress.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }
}

/// Returns true if two events have the same coordinates up to round-off.
fn is_same(one: [f64; 2], other: [f64; 2]) -> bool {
    (0..2).all(|k| (one[k] - other[k]).abs() <= SAME * (one[k].abs() + other[k].abs()))
}
