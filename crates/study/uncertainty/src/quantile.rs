//! A quantile over samples, with the interval that they leave for that of the distribution.

use results::quantile;
use statrs::distribution::{Binomial, DiscreteCDF as _};

/// A quantile over samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledQuantile {
    /// The quantile of the samples; `None` where it is not finite.
    pub value: Option<f64>,
    /// The 95 % interval of the quantile of the distribution; `None` for an end that so few samples leave open.
    pub interval: [Option<f64>; 2],
}

/// The probability that an interval misses on one side.
const MISS: f64 = 0.025;

impl SampledQuantile {
    /// The quantile of `values` below which the `share` of them lies, with an interval that rests on no distribution, as the number of
    /// values below the quantile is binomial (T8; David & Nagaraja 2003, *Order Statistics*, section 7.1).
    pub fn of(mut values: Vec<f64>, share: f64) -> Self {
        values.sort_by(f64::total_cmp);
        let value = quantile(&values, share);
        let at = |place: Option<usize>| values.get(place?).copied().filter(|x| x.is_finite());
        let [low, high] = places(values.len(), share);
        Self { value, interval: [at(low), at(high)] }
    }
}

/// The places of the ends of the interval among values in their order, from 0.
fn places(count: usize, share: f64) -> [Option<usize>; 2] {
    let Ok(below) = Binomial::new(share, count as u64) else { return [None; 2] };
    // Value `l`, from 1, is too high if fewer than `l` lie below the quantile, value `u` too low if `u` or more do.
    let low = (1..=count).take_while(|&l| below.cdf(l as u64 - 1) <= MISS).last();
    let high = (1..=count).find(|&u| below.sf(u as u64 - 1) <= MISS);
    [low, high].map(|place| place.map(|from_one| from_one - 1))
}

#[cfg(test)]
mod tests {
    use statrs::distribution::{Binomial, Discrete as _};

    use super::{SampledQuantile, places};

    #[test]
    fn intervals_hold_the_quantile_as_often_as_they_say() {
        for (count, share) in [(200, 0.05), (1000, 0.05), (1000, 0.5), (1000, 0.95), (73, 0.5)] {
            let [low, high] = places(count, share).map(|place| place.expect("an end") as u64 + 1);
            let below = Binomial::new(share, count as u64).expect("a probability");
            // The quantile lies between value `low` and value `high` if at least `low` and fewer than `high` are below it.
            let covered: f64 = (low..high).map(|k| below.pmf(k)).sum();
            assert!((0.95..0.98).contains(&covered), "{count} {share}: {covered}");
        }
        assert_eq!(places(20, 0.05)[0], None, "all of 20 values lie above the 5 % quantile often");
    }

    #[test]
    fn samples_without_a_value_are_worse_than_any() {
        let mut values: Vec<f64> = (1..=99).map(f64::from).collect();
        values.push(f64::NEG_INFINITY);
        let half = SampledQuantile::of(values.clone(), 0.5);
        assert_eq!(half.value, Some(49.5));
        values.extend([f64::NEG_INFINITY; 20]);
        assert_eq!(
            SampledQuantile::of(values, 0.05),
            SampledQuantile { value: None, interval: [None, None] }
        );
    }
}
