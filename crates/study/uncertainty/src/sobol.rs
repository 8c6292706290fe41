//! Sobol' indices: contributions of variables to the variance of a function.

/// Values of a function at two random points, and at combinations of these points.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// Value at the first point, `A`.
    pub first: f64,
    /// Value at the second point, `B`.
    pub second: f64,
    /// Value at `A` with coordinate `i` of `B`, for every `i`.
    pub mixed: Vec<f64>,
}

/// Sobol' indices of one variable: its contribution to the variance of a function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SobolIndices {
    /// First-order index: contribution of the variable alone.
    pub first: IndexEstimate,
    /// Total index: contribution of the variable, alone and in interactions.
    pub total: IndexEstimate,
}

/// An estimated index and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndexEstimate {
    /// Estimated value of the index.
    pub value: f64,
    /// Standard error of the estimate.
    pub error: f64,
}

/// Half-width of the 95 % interval, in standard errors.
const WITHIN: f64 = 1.959_964;

impl IndexEstimate {
    /// Returns the lower and upper end of the 95 % confidence interval.
    pub fn interval(self) -> [f64; 2] {
        [-WITHIN, WITHIN].map(|errors| self.value + errors * self.error)
    }
}

/// Estimates the first-order and total index of every variable.
///
/// `None` if there are fewer than two evaluations, or if the function is constant. The evaluations
/// must be independent. `f₀` and `V` are mean and variance over all points `A` and `B`. `A⁽ⁱ⁾` is
/// the point `A` with coordinate `i` of `B`:
///
/// ```text
/// S_i = ⟨(f(B) − f₀)(f(A⁽ⁱ⁾) − f(A))⟩/V                                               (T6)
/// T_i = ⟨(f(A) − f(A⁽ⁱ⁾))²⟩/2V                                                        (T7)
/// ```
///
/// (Saltelli et al. 2010, doi 10.1016/j.cpc.2009.09.018; Jansen 1999, doi
/// 10.1016/S0010-4655(98)00154-4). Each index `S` (`S_i` or `T_i`) is the ratio `⟨u⟩/⟨v⟩` of two
/// means over independent evaluations, with `⟨v⟩ = V`. Here `u` is the term in the brackets `⟨ ⟩`
/// (halved for `T_i`), and `v` is the contribution of an evaluation to the variance. The standard
/// error of `S` is the standard error of the mean of `(u − S v)/V`.
pub fn sobol_indices(evaluations: &[Evaluation]) -> Option<Vec<SobolIndices>> {
    let n = evaluations.len() as f64;
    let mean = evaluations.iter().map(|e| e.first + e.second).sum::<f64>() / (2.0 * n);
    // Subtract the mean from the values. A mean much larger than the spread would otherwise
    // dominate the errors of the indices.
    let squares: Vec<f64> = evaluations
        .iter()
        .map(|e| 0.5 * ((e.first - mean).powi(2) + (e.second - mean).powi(2)))
        .collect();
    let variance = squares.iter().sum::<f64>() / n;
    // The comparison is negated, so that it also excludes a variance of NaN.
    if evaluations.len() < 2 || !(variance > 0.0 && variance.is_finite()) {
        return None;
    }
    let ratio = |term: &dyn Fn(&Evaluation) -> f64| {
        let terms: Vec<f64> = evaluations.iter().map(term).collect();
        let value = terms.iter().sum::<f64>() / (n * variance);
        // Each evaluation contributes to the numerator and to the variance, so its influence on
        // the ratio has two terms.
        let influences =
            terms.iter().zip(&squares).map(|(u, v)| ((u - value * v) / variance).powi(2));
        IndexEstimate { value, error: (influences.sum::<f64>() / (n * (n - 1.0))).sqrt() }
    };
    let indices = (0..evaluations[0].mixed.len()).map(|i| SobolIndices {
        first: ratio(&|e| (e.second - mean) * (e.mixed[i] - e.first)),
        total: ratio(&|e| 0.5 * (e.first - e.mixed[i]).powi(2)),
    });
    Some(indices.collect())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng as _;
    use rand_distr::{Distribution as _, StandardUniform};

    use super::*;

    /// Returns the Ishigami–Homma function at `x`, with a = 7 and b = 0.1.
    ///
    /// Each coordinate is between −π and π (Ishigami & Homma 1990, doi 10.1109/ISUMA.1990.151285).
    fn ishigami(x: [f64; 3]) -> f64 {
        x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
    }

    /// Returns the exact indices of `ishigami`: first-order and total index of each variable.
    fn exact() -> [[f64; 2]; 3] {
        let (a, b) = (7.0, 0.1);
        let alone = 0.5 * (1.0 + b * PI.powi(4) / 5.0_f64).powi(2);
        let together = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
        let second = a * a / 8.0;
        let all = alone + second + together;
        [[alone, alone + together], [second, second], [0.0, together]]
            .map(|part| part.map(|p| p / all))
    }

    fn indices(seed: u64, samples: usize) -> Vec<SobolIndices> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let evaluations: Vec<_> = (0..samples)
            .map(|_| {
                let [a, b]: [[f64; 3]; 2] = [(); 2].map(|()| {
                    [(); 3].map(|()| {
                        let share: f64 = StandardUniform.sample(&mut random);
                        PI * (2.0 * share - 1.0)
                    })
                });
                Evaluation {
                    first: ishigami(a),
                    second: ishigami(b),
                    mixed: (0..3)
                        .map(|i| {
                            let mut mixed = a;
                            mixed[i] = b[i];
                            ishigami(mixed)
                        })
                        .collect(),
                }
            })
            .collect();
        sobol_indices(&evaluations).expect("indices")
    }

    #[test]
    fn indices_of_the_ishigami_function_match_the_closed_form() {
        for (found, exact) in indices(1, 200_000).into_iter().zip(exact()) {
            assert!((found.first.value - exact[0]).abs() < 0.012, "{found:?} {exact:?}");
            assert!((found.total.value - exact[1]).abs() < 0.012, "{found:?} {exact:?}");
        }
    }

    #[test]
    fn intervals_cover_the_exact_indices_95_percent_of_the_time() {
        const REPEATS: u64 = 600;
        let mut held = [[0_u32; 2]; 3];
        for seed in 0..REPEATS {
            for (i, (found, exact)) in indices(seed, 500).into_iter().zip(exact()).enumerate() {
                for (k, estimate) in [found.first, found.total].into_iter().enumerate() {
                    let [low, high] = estimate.interval();
                    held[i][k] += u32::from((low..=high).contains(&exact[k]));
                }
            }
        }
        // 95 % of 600 intervals are 570. The standard deviation of this count is 5.3.
        assert!(held.iter().flatten().all(|held| (554..=590).contains(held)), "{held:?}");
    }

    #[test]
    fn constant_functions_have_no_indices() {
        let evaluation = Evaluation { first: 1.0, second: 1.0, mixed: vec![1.0] };
        assert_eq!(sobol_indices(&vec![evaluation; 3]), None);
        assert_eq!(sobol_indices(&[]), None);
    }
}
