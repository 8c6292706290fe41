//! Spread of a measure, predicted by its derivatives.

use results::columns::measure_name;
use results::{Column, DesignRow, ParameterDerivative, SlopeSide};
use sweep::{BatchDeviation, Case, Deviation, Parameter};

use crate::moments;

/// Step of finite differences, in standard deviations.
const STEP: f64 = 1e-5;

/// Scales that share a deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeviationLevel {
    /// All scales of a batch.
    Batch,
    /// A single scale; each scale has its own deviation.
    Scale,
}

/// A source of deviations, and its contribution to the spread of a measure.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceShare {
    /// Key of the deviating parameter.
    pub source: String,
    /// Scales that share a deviation.
    pub level: DeviationLevel,
    /// Standard deviation of the source, in the unit of the source.
    pub deviation: f64,
    /// Standard deviation of the measure if this were the only source.
    pub spread: f64,
    /// Fraction of the variance of the measure.
    pub share: f64,
}

/// Spread of a measure, predicted by its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearSpread {
    /// Standard deviation of the measure.
    pub spread: f64,
    /// Sources, largest contribution first.
    pub sources: Vec<SourceShare>,
}

/// Derivatives and deviations of a design.
pub(crate) struct Gradients<'a> {
    /// Nominal design, with its scatter and the derivatives of its measures.
    pub(crate) design: &'a DesignRow,
    pub(crate) deviations: &'a [Deviation],
    /// Derivatives with respect to the gaps and slants of single scales.
    pub(crate) single: &'a [ParameterDerivative],
}

impl Gradients<'_> {
    /// Returns the spread of a column.
    ///
    /// `None` if a one-sided derivative is missing at a kink.
    pub(crate) fn spread(&self, column: &Column<DesignRow>) -> Option<LinearSpread> {
        let mut sources = Vec::new();
        for deviation in self.deviations {
            // Deviations that only vary from scale to scale are handled below.
            let Some(batch) = deviation.batch() else { continue };
            let variance = moments::variance(self.slopes(column, deviation, batch)?, batch);
            let (source, deviation) = (deviation.key(), batch.standard_deviation());
            sources.push((source, DeviationLevel::Batch, deviation, variance));
        }
        for (parameter, sd) in self.scattered() {
            let variance = self.scatter(column, parameter.key, sd)?;
            sources.push((self.key(parameter), DeviationLevel::Scale, sd, variance));
        }
        Some(LinearSpread::of(sources))
    }

    /// Returns the slopes of a column for negative and positive deviations.
    fn slopes(
        &self,
        column: &Column<DesignRow>,
        deviation: &Deviation,
        batch: BatchDeviation,
    ) -> Option<[f64; 2]> {
        let case = &self.design.case;
        // Values are extrapolated linearly from the design. The step may therefore be tiny, as long
        // as it exceeds round-off.
        let step = STEP * batch.standard_deviation();
        let value =
            |to: &Case| column.cell(&self.design.extrapolated(to, SlopeSide::Ahead)).number();
        let here = value(case)?;
        let [below, above] =
            [-step, step].map(|by| Some((value(&deviation.moved(case, by)?)? - here) / by));
        Some([below?, above?])
    }

    /// Returns the parameters with scatter, and their standard deviations.
    fn scattered(&self) -> Vec<(&'static Parameter, f64)> {
        let (imperfection, gap) = (self.design.case.imperfection, self.design.case.design.gap);
        let all =
            [("gap_over_t", imperfection.gap_cv * gap), ("slant_deg", imperfection.slant_sd_deg)];
        all.into_iter()
            .filter_map(|(key, sd)| Some((Parameter::named(key)?, sd)))
            .filter(|(_, sd)| *sd > 0.0)
            .collect()
    }

    /// Returns the variance of a column if all gaps, or slants, deviate independently.
    fn scatter(&self, column: &Column<DesignRow>, key: &str, sd: f64) -> Option<f64> {
        let measure = measure_name(&column.name);
        let mut derivatives = self.design.result.sensitivity.iter();
        // Parameters and the mass have no such derivatives, and scatter does not change them.
        let Some(known) = derivatives.find(|d| d.measure == measure) else { return Some(0.0) };
        let step = STEP * known.value.abs().max(f64::MIN_POSITIVE);
        // Columns in physical units are functions of the measure, so take their slope numerically.
        let [here, above] = [known.value, known.value + step]
            .map(|value| column.cell(&self.design.with_value(measure, value)?).number());
        let factor = (above? - here?) / step;
        let single = self.single.iter();
        let of_measure = single.filter(|d| d.measure == measure && d.parameter == key);
        of_measure
            .map(|derivative| {
                let slopes = [factor * derivative.left?, factor * derivative.right?];
                Some(moments::variance(slopes, BatchDeviation::Normal(sd)))
            })
            .sum()
    }

    /// Returns the key of the deviation of a parameter, which may be in mm.
    fn key(&self, parameter: &'static Parameter) -> String {
        let mut same = self.deviations.iter().filter(|d| d.parameter() == parameter);
        same.next().map_or_else(|| parameter.key.to_owned(), Deviation::key)
    }
}

impl LinearSpread {
    fn of(sources: Vec<(String, DeviationLevel, f64, f64)>) -> Self {
        let sum: f64 = sources.iter().map(|(.., variance)| variance).sum();
        let mut sources: Vec<_> = sources
            .into_iter()
            .map(|(source, level, deviation, variance)| {
                let share = if sum > 0.0 { variance / sum } else { 0.0 };
                let spread = variance.sqrt();
                SourceShare { source, level, deviation, spread, share }
            })
            .collect();
        // Stable sort, so that equal sources keep the order of the definition.
        sources.sort_by(|one, other| other.share.total_cmp(&one.share));
        Self { spread: sum.sqrt(), sources }
    }

    /// Lists the main sources: "`gap_mm` 83 %, `slant_deg` from scale to scale 12 %".
    pub fn in_words(&self) -> String {
        // Smaller fractions would appear as 0 %.
        let matters = self.sources.iter().filter(|source| source.share >= 0.005);
        matters
            .map(|source| {
                let level =
                    if source.level == DeviationLevel::Scale { " from scale to scale" } else { "" };
                format!("{}{level} {:.0} %", source.source, 100.0 * source.share)
            })
            .collect::<Vec<_>>()
            .join(", ")
    }
}
