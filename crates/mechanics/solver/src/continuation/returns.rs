//! Detection of paths without progress, which return to earlier events again and again.

/// Largest number of returns to earlier events; a path with more returns makes no progress.
///
/// The count starts at the last maximum of the control parameter. In a system of equal parts, such
/// as the gaps of a strip, a valid path may return several times to control parameter and load of
/// an event, each time with another part changed.
const MOST_RETURNS: usize = 50;

/// Largest number of successive events at one point, divided by the number of constraints plus one.
const MOST_AT_A_POINT: usize = 3;

/// Largest relative difference between control parameters or loads of events that count as equal.
const SAME: f64 = 1e-9;

/// Number of most recent distinct events with which a new event is compared.
const COMPARED: usize = 1000;

/// Record of the events since the control parameter was last at its maximum.
#[derive(Clone, Debug, Default)]
pub(super) struct Returns {
    /// Control parameter and load of each distinct event.
    events: Vec<[f64; 2]>,
    /// Index in `events` of the most recent event.
    last: usize,
    /// Number of returns to an earlier event after at least one different event.
    repeated: usize,
    /// Number of successive repetitions of the most recent event.
    stays: usize,
}

impl Returns {
    /// Adds an event, given by control parameter and load.
    ///
    /// `constraints` is the number of constraints of the system. Returns true if the path makes no
    /// progress.
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

    /// Removes all events, for a path that has made progress.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }
}

/// Returns true if two events have the same control parameter and load up to round-off.
fn is_same(one: [f64; 2], other: [f64; 2]) -> bool {
    (0..2).all(|k| (one[k] - other[k]).abs() <= SAME * (one[k].abs() + other[k].abs()))
}
