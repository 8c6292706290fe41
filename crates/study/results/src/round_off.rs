//! Best values, with values that are equal up to round-off ([`same`]) treated as equal.

use text::number::same;

use crate::columns::Goal;

/// Replaces each group of values that are equal up to round-off by its best value.
///
/// A value belongs to a group if it equals the best value of the group, not just any value of the
/// group, so that many small steps do not make all values equal. Rankings group equal scores in the
/// same way.
pub fn merge_equal<'a>(values: impl IntoIterator<Item = &'a mut f64>, goal: Goal) {
    let mut values: Vec<&mut f64> = values.into_iter().collect();
    values.sort_by(|a, b| match goal {
        Goal::Maximize => b.total_cmp(a),
        Goal::Minimize => a.total_cmp(b),
    });
    let mut best = f64::NAN;
    for value in values {
        if same(*value, best) {
            *value = best;
        } else {
            best = *value;
        }
    }
}

/// The best value of a sequence, with the item that has this value.
///
/// If several best values are equal up to round-off, the first is the best and the others are ties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leader<T> {
    /// First item with the best value.
    pub first: T,
    /// The best value.
    pub value: f64,
    /// Number of other items with the same value up to round-off.
    pub ties: u64,
}

impl<T> Leader<T> {
    /// Updates `best` with the item `first` that has the value `value`.
    pub fn enter(best: &mut Option<Self>, first: T, value: f64, goal: Goal) {
        match best {
            // Test for equality first: a later value must not replace an equal value because of
            // its last digits.
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
    fn values_equal_up_to_round_off_are_replaced_by_the_best() {
        let mut values = [0.5, 0.8, 0.8 - 1e-12, 0.3, 0.8 + 1e-12, 0.5 + 1e-15];
        merge_equal(&mut values, Goal::Maximize);
        assert_eq!(values, [0.5 + 1e-15, 0.8 + 1e-12, 0.8 + 1e-12, 0.3, 0.8 + 1e-12, 0.5 + 1e-15]);
        // Each step is below round-off, but the sum of two steps is not.
        let mut steps = [1.0, 1.0 + 8e-10, 1.0 + 16e-10];
        merge_equal(&mut steps, Goal::Minimize);
        assert_eq!(steps, [1.0, 1.0, 1.0 + 16e-10]);
    }

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
}
