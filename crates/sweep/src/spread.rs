//! What imperfect rows of one design measure: mean and quantiles over the samples.

use skin::flexure::{self, Flexure};
use skin::puncture;
use substrate::RowStiffness;

use crate::case::Case;
use crate::measure::Measure;
use crate::record::{FlexureRecord, PunctureRecord};

/// Values of a measure over the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Their mean.
    pub mean: f64,
    /// Their 5 %, 50 % and 95 % quantiles, interpolated between the two nearest values (type 7 of Hyndman
    /// and Fan 1996, doi 10.1080/00031305.1996.10473566).
    pub quantiles: [f64; 3],
}

/// Which quantiles.
const QUANTILES: [f64; 3] = [0.05, 0.5, 0.95];

impl Spread {
    /// The spread of `values`; `None` if there are none.
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let quantile = |share: f64| {
            let place = share * last as f64;
            let (below, above) = (place.floor() as usize, place.ceil() as usize);
            values[below] + (place - place.floor()) * (values[above] - values[below])
        };
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        Some(Self { mean, quantiles: QUANTILES.map(quantile) })
    }
}

/// What the samples of a design gave. Samples that failed have no part in the spreads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spreads {
    /// The critical force.
    pub critical_force: Option<Spread>,
    /// The penetration.
    pub penetration: Option<Spread>,
    /// Samples whose puncture has no values.
    pub puncture_failed: Option<usize>,
    /// The flexural compliance.
    pub compliance: Option<Spread>,
    /// The range of curvatures over which the gaps of a strip close.
    pub closing_range: Option<Spread>,
    /// Samples whose bending has no values.
    pub flexure_failed: Option<usize>,
}

impl Spreads {
    /// Punctures the samples of `case`.
    pub(crate) fn puncture(&mut self, case: &Case, substrate: &RowStiffness) {
        let (mut force, mut penetration) = (Vec::new(), Vec::new());
        for number in 1..=case.samples.count as u64 {
            let record = punctured(case, substrate, number);
            let measures = record.map(|record| record.measures);
            force.extend(measures.and_then(|measures| measures.critical_force));
            penetration.extend(measures.and_then(|measures| measures.penetration));
        }
        self.puncture_failed = Some(case.samples.count - force.len());
        self.critical_force = Spread::of(force);
        self.penetration = Spread::of(penetration);
    }

    /// Bends the samples of `case`.
    pub(crate) fn flexure(&mut self, case: &Case) {
        let (mut compliance, mut closing_range) = (Vec::new(), Vec::new());
        for number in 1..=case.samples.count as u64 {
            let Some(flexure) = bent(case, number) else { continue };
            let record = FlexureRecord::new(&flexure);
            if let Some(value) = record.measures.compliance {
                compliance.push(value);
                closing_range.extend(flexure.closing_range());
            }
        }
        self.closing_range = Spread::of(closing_range);
        self.flexure_failed = Some(case.samples.count - compliance.len());
        self.compliance = Spread::of(compliance);
    }

    /// Every sample of a measure failed, whatever the reason.
    pub(crate) fn fail(&mut self, case: &Case, measure: Measure) {
        match measure {
            Measure::Coverage => {}
            Measure::Puncture => self.puncture_failed = Some(case.samples.count),
            Measure::Flexure => self.flexure_failed = Some(case.samples.count),
        }
    }
}

fn punctured(case: &Case, substrate: &RowStiffness, number: u64) -> Option<PunctureRecord> {
    let sample = case.imperfection.sample(&case.design, case.samples.seed as u64, number).ok()?;
    let puncture =
        puncture::solve_sample(&case.design, substrate, &case.common, &case.puncture, &sample)
            .ok()?;
    Some(PunctureRecord::new(&puncture, substrate.estimated_error()))
}

fn bent(case: &Case, number: u64) -> Option<Flexure> {
    let sample = case.imperfection.sample(&case.design, case.samples.seed as u64, number).ok()?;
    flexure::solve_sample(&case.design, &case.common, &case.flexure, &sample).ok()
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn quantiles_lie_between_the_nearest_values() {
        let values: Vec<f64> = (0..=20).rev().map(f64::from).collect();
        let spread = Spread::of(values).expect("values");
        assert_eq!(spread, Spread { mean: 10.0, quantiles: [1.0, 10.0, 19.0] });
        let spread = Spread::of(vec![3.0, 1.0]).expect("values");
        assert_eq!((spread.mean, spread.quantiles[1]), (2.0, 2.0));
        assert!((spread.quantiles[0] - 1.1).abs() < 1e-15);
        assert_eq!(Spread::of(Vec::new()), None);
        assert_eq!(Spread::of(vec![7.0]).map(|spread| spread.quantiles), Some([7.0; 3]));
    }
}
