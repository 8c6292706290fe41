//! Spearman's rank correlation.

/// Returns Spearman's rank correlation of the first and second values of `pairs`.
///
/// The correlation is 1 if first and second values have the same order, and −1 if their orders are
/// opposite. `None` if all first or all second values are equal.
pub fn rank_correlation(pairs: &[[f64; 2]]) -> Option<f64> {
    let [first, second] = [0, 1].map(|side| ranks(pairs.iter().map(|pair| pair[side])));
    // Ties do not change the mean rank.
    let mean = 0.5 * (pairs.len() as f64 + 1.0);
    let mut sums = [0.0; 3];
    for (a, b) in first.iter().zip(&second) {
        let (a, b) = (a - mean, b - mean);
        sums = [sums[0] + a * a, sums[1] + b * b, sums[2] + a * b];
    }
    let spread = (sums[0] * sums[1]).sqrt();
    (spread > 0.0).then(|| sums[2] / spread)
}

/// Returns the rank of each value, from 1. Equal values share their mean rank.
fn ranks(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sorted: Vec<(f64, usize)> = values.enumerate().map(|(i, value)| (value, i)).collect();
    // An unstable sort suffices, because equal values get the same rank.
    sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut ranks = vec![0.0; sorted.len()];
    let mut before = 0;
    for equal in sorted.chunk_by(|a, b| a.0.to_bits() == b.0.to_bits()) {
        let rank = before as f64 + 0.5 * (equal.len() as f64 + 1.0);
        for (_, i) in equal {
            ranks[*i] = rank;
        }
        before += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn correlation(first: &[f64], second: &[f64]) -> Option<f64> {
        let pairs: Vec<_> = first.iter().zip(second).map(|(a, b)| [*a, *b]).collect();
        rank_correlation(&pairs)
    }

    #[test]
    fn the_correlation_measures_the_agreement_of_orders() {
        for (found, expected) in [
            (correlation(&[1.0, 2.0, 30.0], &[-5.0, 0.1, 0.2]), 1.0),
            (correlation(&[1.0, 2.0, 30.0], &[3.0, 2.0, 1.0]), -1.0),
            // The ranks 1, 2.5, 2.5, 4 and 1, 2, 3, 4 have the correlation 4.5/√(4.5·5) = √0.9.
            (correlation(&[0.0, 1.0, 1.0, 2.0], &[0.0, 1.0, 2.0, 3.0]), 0.9_f64.sqrt()),
        ] {
            assert!(found.is_some_and(|found| (found - expected).abs() < 1e-15), "{found:?}");
        }
    }

    #[test]
    fn equal_values_have_no_correlation() {
        assert_eq!(correlation(&[], &[]), None);
        assert_eq!(correlation(&[1.0], &[2.0]), None);
        assert_eq!(correlation(&[1.0, 1.0], &[1.0, 2.0]), None);
    }

    #[test]
    fn the_correlation_depends_on_ranks_only() {
        let values: Vec<f64> = (0..20).map(f64::from).collect();
        let [up, down] =
            [1.0, -1.0].map(|sign| values.iter().map(|x| sign * x.exp()).collect::<Vec<_>>());
        assert!((correlation(&values, &up).expect("an order") - 1.0).abs() < 1e-12);
        assert!((correlation(&values, &down).expect("an order") + 1.0).abs() < 1e-12);
    }
}
