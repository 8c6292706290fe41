//! Comparison of numbers up to round-off.

use crate::columns::Goal;

/// Relative difference below which two numbers count as equal.
pub const ROUND_OFF: f64 = 1e-9;

/// Returns true if `a` and `b` are equal up to round-off.
pub fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUND_OFF * a.abs().max(b.abs())
}

/// The best of a sequence of values, with the item that has it.
///
/// If several values are equal up to round-off, the first is the best and the others are ties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leader<T> {
    /// First item with the best value.
    pub first: T,
    /// The value.
    pub value: f64,
    /// Number of other items with an equal value, up to round-off.
    pub ties: u64,
}

impl<T> Leader<T> {
    /// Updates the best value with another candidate.
    pub fn enter(best: &mut Option<Self>, first: T, value: f64, goal: Goal) {
        match best {
            // Test for equality first: among equal values the later must not win by its last
            // digits.
            Some(best) if same(value, best.value) => best.ties += 1,
            Some(best) if !goal.prefers(value, best.value) => {}
            _ => *best = Some(Self { first, value, ties: 0 }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_equal_values_is_the_best() {
        let mut best = None;
        for (design, value) in
            [0.5, 0.8, 0.3, 0.8 + 1e-12, 0.8 - 1e-12, 0.7].into_iter().enumerate()
        {
            Leader::enter(&mut best, design, value, Goal::Maximize);
        }
        assert_eq!(best, Some(Leader { first: 1, value: 0.8, ties: 2 }));
    }

    #[test]
    fn zero_equals_only_zero() {
        assert!(same(0.0, -0.0));
        assert!(!same(0.0, 1e-300));
        assert!(same(1e20, 1e20 + 1e10));
        assert!(!same(1.0, 1.0 + 1e-8));
    }
}
