//! Draws the random deviations of a sample.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal, StandardUniform};
use sha2::{Digest as _, Sha256};
use sweep::{BatchDeviation, Case, Deviation};

/// Maximum number of draws for one deviation.
///
/// A draw is repeated if the parameter would leave its bounds.
const DRAWS: usize = 1000;

/// Draws sample `number`, counted from 1, of the design `case`.
///
/// Returns the case of the sample, and for each of the `deviations` the drawn batch deviation
/// (`None` for a parameter that varies only from scale to scale). The standard deviations from
/// scale to scale become the imperfection of the returned case.
///
/// Returns `None` if a parameter leaves its bounds in every draw.
///
/// A batch deviation depends only on the seed of the case, the number of the sample and the key of
/// the parameter. It stays the same if the user adds another deviation or changes the design.
pub(crate) fn sample(
    case: &Case,
    deviations: &[Deviation],
    number: u64,
) -> Option<(Case, Vec<Option<f64>>)> {
    let (mut sampled, mut drawn) = (*case, Vec::new());
    for deviation in deviations {
        let Some(batch) = deviation.batch() else {
            drawn.push(None);
            continue;
        };
        let mut random = random(case, number, deviation.parameter().key);
        // Repeating draws out of bounds truncates the distribution at the bound. `applied` checks
        // the load position too, which depends on several parameters. So each deviation is applied
        // to the case that already includes the earlier deviations.
        let (moved, by) = (0..DRAWS).find_map(|_| {
            let by = draw(batch, &mut random);
            Some((deviation.applied(&sampled, by)?, by))
        })?;
        sampled = moved;
        drawn.push(Some(by));
    }
    scatter(&mut sampled, deviations);
    Some((sampled, drawn))
}

/// Sets the imperfection of `case` to the standard deviations from scale to scale.
pub(crate) fn scatter(case: &mut Case, deviations: &[Deviation]) {
    for deviation in deviations {
        let Some(sd) = deviation.scale_sd(case) else { continue };
        match deviation.parameter().key {
            // `gap_cv` is relative to the gap. Divide by the gap of this sample, so that the
            // scatter in mm is the same in each sample.
            "gap_over_t" => case.imperfection.gap_cv = sd / case.design.gap,
            _ => case.imperfection.slant_sd_deg = sd,
        }
    }
}

/// Draws a number that is uniformly distributed from 0 to 1.
///
/// The number depends only on the seed of the case, the sample `number` and `key`.
pub(crate) fn uniform(case: &Case, number: u64, key: &str) -> f64 {
    StandardUniform.sample(&mut random(case, number, key))
}

/// Creates the random number generator for sample `number` and `key`.
fn random(case: &Case, number: u64, key: &str) -> ChaCha8Rng {
    let mut digest = Sha256::new();
    digest.update((case.samples.seed as u64).to_le_bytes());
    digest.update(number.to_le_bytes());
    digest.update(key.as_bytes());
    ChaCha8Rng::from_seed(digest.finalize().into())
}

fn draw(batch: BatchDeviation, random: &mut ChaCha8Rng) -> f64 {
    match batch {
        BatchDeviation::Normal(sd) => {
            let z: f64 = StandardNormal.sample(random);
            sd * z
        }
        BatchDeviation::Uniform(most) => {
            let share: f64 = StandardUniform.sample(random);
            most * (2.0 * share - 1.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use sweep::Sweep;

    use super::sample;

    fn sweep(tolerance: &str) -> Sweep {
        let text = format!(
            "name = 'x'\n[designs]\ngap_over_t = 0.1\nlength_over_t = 1\nslant_deg = 1\n[tolerance]\n{tolerance}"
        );
        Sweep::parse(&text, "x.toml", &[]).expect("a sweep")
    }

    fn drawn(tolerance: &str, number: u64) -> Vec<Option<f64>> {
        let sweep = sweep(tolerance);
        sample(&sweep.grid().case(0), sweep.deviations(), number).expect("a sample").1
    }

    #[test]
    fn a_deviation_does_not_depend_on_other_deviations() {
        let one = drawn("gap_over_t = { batch_sd = 0.01 }", 7);
        let both = drawn("length_over_t = { batch_sd = 0.1 }\ngap_over_t = { batch_sd = 0.01 }", 7);
        assert_eq!(one[0], both[1]);
        assert_ne!(one, drawn("gap_over_t = { batch_sd = 0.01 }", 8));
        // With twice the standard deviation, the same random number gives twice the deviation.
        let twice = drawn("gap_over_t = { batch_sd = 0.02 }", 7);
        assert_eq!(twice[0], one[0].map(|by| 2.0 * by));
    }

    #[test]
    fn deviations_have_the_requested_moments_and_stay_within_bounds() {
        let [(mean, sd, _), uniform] = ["batch_sd", "batch_within"].map(|level| {
            let text = format!("length_over_t = {{ {level} = 0.1 }}");
            let values: Vec<_> =
                (1..=4000).map(|n| drawn(&text, n)[0].expect("a deviation")).collect();
            let mean = values.iter().sum::<f64>() / 4000.0;
            let square = values.iter().map(|value| value.powi(2)).sum::<f64>() / 4000.0;
            (mean, square.sqrt(), values.into_iter().fold(0.0, |max, x| f64::max(max, x.abs())))
        });
        assert!(mean.abs() < 0.005 && (sd - 0.1).abs() < 0.004, "{mean} {sd}");
        let (mean, sd, largest) = uniform;
        assert!(mean.abs() < 0.003 && (sd - 0.1 / 3.0_f64.sqrt()).abs() < 0.002, "{mean} {sd}");
        assert!(largest <= 0.1);
        // The slant is 1° ± 3°, so 37 % of all draws would make it negative.
        let sweep = sweep("slant_deg = { batch_sd = 3 }");
        for n in 1..=1000 {
            let sampled = sample(&sweep.grid().case(0), sweep.deviations(), n);
            assert!(sampled.expect("a sample").0.design.slant_deg >= 0.0);
        }
    }

    #[test]
    fn gap_cv_is_relative_to_the_gap_of_the_sample() {
        let sweep = sweep("gap_over_t = { batch_sd = 0.01, scale_sd = 0.02 }");
        let (sampled, _) = sample(&sweep.grid().case(0), sweep.deviations(), 3).expect("a sample");
        assert_ne!(sampled.design.gap, 0.1);
        assert_eq!(sampled.imperfection.gap_cv, 0.02 / sampled.design.gap);
    }
}
