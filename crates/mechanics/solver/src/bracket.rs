//! Bracketing root search by false position.

/// Two arguments at which a function has opposite signs, with its values.
///
/// The next estimate is the zero of the secant. It replaces one end. The value at the other end is
/// halved, so that the next estimate moves towards that end: the Illinois rule (Dowell & Jarratt
/// 1971, doi 10.1007/BF01934364).
#[derive(Clone, Copy, Debug)]
pub struct Bracket {
    ends: [(f64, f64); 2],
    /// End replaced last; `None` if the value at the other end is halved every time.
    last: Option<usize>,
}

impl Bracket {
    /// Creates a bracket from two points with values of opposite signs.
    ///
    /// Each replacement of one end halves the value at the other end.
    pub fn new(low: (f64, f64), high: (f64, f64)) -> Self {
        Self { ends: [low, high], last: None }
    }

    /// Creates a bracket that halves values less often (Dowell and Jarratt).
    ///
    /// The value at one end is halved after two successive replacements of the other end.
    pub fn patient(low: (f64, f64), high: (f64, f64)) -> Self {
        Self { last: Some(1), ..Self::new(low, high) }
    }

    /// Returns the zero of the secant.
    pub fn secant(&self) -> f64 {
        let [(low, at_low), (high, at_high)] = self.ends;
        (low * at_high - high * at_low) / (at_high - at_low)
    }

    /// Returns the distance between the ends.
    pub fn width(&self) -> f64 {
        (self.ends[1].0 - self.ends[0].0).abs()
    }

    /// Replaces the end with the same sign as `value`.
    pub fn narrow(&mut self, argument: f64, value: f64) {
        let end = usize::from(value * self.ends[1].1 >= 0.0);
        self.ends[end] = (argument, value);
        // Without halving, the secant would approach the root from one side only.
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
            let values = (0..60).map(|_| {
                let x = bracket.secant();
                let value = x * x * x - 2.0;
                bracket.narrow(x, value);
                value
            });
            let rounds = values.take_while(|value| value.abs() > 1e-14).count();
            assert!(rounds < 60, "{rounds}");
        }
    }
}
