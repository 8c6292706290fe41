//! Variance of a piecewise linear function of a random deviation.

use sweep::BatchDeviation;

/// Returns the variance of a measure caused by a `deviation` of mean 0 (T2).
///
/// `left` and `right` are the slopes of the measure for negative and for positive deviations. They
/// differ if the nominal design is at a kink of the measure.
pub(crate) fn variance([left, right]: [f64; 2], deviation: BatchDeviation) -> f64 {
    let squares = left.powi(2) + right.powi(2);
    let difference = right - left;
    let (mean, mean_square) = match deviation {
        BatchDeviation::Normal(sd) => {
            (sd * difference / std::f64::consts::TAU.sqrt(), sd * sd * squares / 2.0)
        }
        BatchDeviation::Uniform(most) => (most * difference / 4.0, most * most * squares / 6.0),
    };
    // Without this limit, round-off could make a vanishing variance negative.
    (mean_square - mean * mean).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_of_a_smooth_measure_is_slope_times_standard_deviation() {
        let slopes = [-3.0, -3.0];
        for deviation in [BatchDeviation::Normal(0.2), BatchDeviation::Uniform(0.2)] {
            let expected = 9.0 * deviation.standard_deviation().powi(2);
            assert!((variance(slopes, deviation) - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn variance_of_an_absolute_value_matches_the_closed_form() {
        let slopes = [-1.0, 1.0];
        // For a standard normal z the variance of |z| is 1 − 2/π. For an x that is uniformly
        // distributed from −w to w the variance of |x| is w²/3 − w²/4 = w²/12.
        let normal = variance(slopes, BatchDeviation::Normal(1.0));
        assert!((normal - (1.0 - 2.0 / std::f64::consts::PI)).abs() < 1e-15);
        assert!((variance(slopes, BatchDeviation::Uniform(1.0)) - 1.0 / 12.0).abs() < 1e-15);
    }
}
