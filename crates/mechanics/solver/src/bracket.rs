//! A bracket of a root that is narrowed by the false position.

/// Two places between which a quantity changes its sign, each with the value there.
///
/// The next place to look at is where the secant through both ends vanishes. The end that stays has its value halved, so that
/// the other end moves too: the Illinois rule (Dowell & Jarratt 1971, doi 10.1007/BF01934364).
#[derive(Clone, Copy, Debug)]
pub struct Bracket {
    ends: [(f64, f64); 2],
    /// The end that was replaced last, if the other is halved only where the same end is replaced twice in a row.
    last: Option<usize>,
}

impl Bracket {
    /// A bracket whose ends have values of different signs. The end that stays is halved every time.
    pub fn new(low: (f64, f64), high: (f64, f64)) -> Self {
        Self { ends: [low, high], last: None }
    }

    /// The same, but the end that stays is halved only where it stays twice: as Dowell and Jarratt have it.
    pub fn patient(low: (f64, f64), high: (f64, f64)) -> Self {
        Self { last: Some(1), ..Self::new(low, high) }
    }

    /// Where the secant through both ends vanishes.
    pub fn secant(&self) -> f64 {
        let [(low, at_low), (high, at_high)] = self.ends;
        (low * at_high - high * at_low) / (at_high - at_low)
    }

    /// Distance of both ends.
    pub fn width(&self) -> f64 {
        (self.ends[1].0 - self.ends[0].0).abs()
    }

    /// Replaces the end whose value has the sign of `value`.
    pub fn narrow(&mut self, place: f64, value: f64) {
        let end = usize::from(value * self.ends[1].1 >= 0.0);
        self.ends[end] = (place, value);
        // An end that stays is worth half as much to the next secant, or that would come nearer to it from one side
        // only.
        if self.last.is_none_or(|last| last == end) {
            self.ends[1 - end].1 *= 0.5;
        }
        self.last = self.last.map(|_| end);
    }
}

#[cfg(test)]
mod tests {
    use super::Bracket;

    #[test]
    fn both_rules_find_the_root_of_a_cubic() {
        for bracket in [Bracket::new, Bracket::patient] {
            let mut bracket = bracket((0.0, -2.0), (2.0, 6.0));
            let mut value = |_| {
                let x = bracket.secant();
                let value = x * x * x - 2.0;
                bracket.narrow(x, value);
                value
            };
            let rounds = (0..60).map(&mut value).take_while(|value| value.abs() > 1e-14).count();
            assert!(rounds < 60, "{rounds}");
        }
    }
}
