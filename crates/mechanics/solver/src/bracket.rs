//! Root search in a bracket by the method of false position.

/// Interval with values of opposite sign at its ends.
///
/// The next estimate of the root is the zero of the secant. The estimate replaces one end, and the
/// value at the other end is halved, so that the next estimate moves towards the other end
/// (Illinois rule: Dowell & Jarratt 1971, doi 10.1007/BF01934364).
#[derive(Clone, Copy, Debug)]
pub struct Bracket {
    /// Argument and value at the two ends.
    ends: [(f64, f64); 2],
    /// Index of the end replaced last, or `None` if every replacement halves the other value.
    last: Option<usize>,
}

impl Bracket {
    /// Creates a bracket from two pairs `(argument, value)` with values of opposite sign.
    ///
    /// Each replacement of one end halves the value at the other end.
    pub fn new(low: (f64, f64), high: (f64, f64)) -> Self {
        Self { ends: [low, high], last: None }
    }

    /// Creates a bracket with the original Illinois rule, which halves values less often.
    ///
    /// The value at one end is halved only if the other end is replaced twice in succession.
    pub fn illinois(low: (f64, f64), high: (f64, f64)) -> Self {
        Self { last: Some(1), ..Self::new(low, high) }
    }

    /// Returns the zero of the secant, the next estimate of the root.
    pub fn secant(&self) -> f64 {
        let [(low, at_low), (high, at_high)] = self.ends;
        (low * at_high - high * at_low) / (at_high - at_low)
    }

    /// Returns the distance between the ends.
    pub fn width(&self) -> f64 {
        (self.ends[1].0 - self.ends[0].0).abs()
    }

    /// Replaces the end that has a value of the same sign as `value`.
    pub fn narrow(&mut self, argument: f64, value: f64) {
        let end = usize::from(value * self.ends[1].1 >= 0.0);
        self.ends[end] = (argument, value);
        // Without halving, only one end would converge to the root.
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
    fn both_halving_rules_converge_to_the_root_of_a_cubic() {
        for bracket in [Bracket::new, Bracket::illinois] {
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
