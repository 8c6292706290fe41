//! Spread of a measure, predicted by its derivatives.

use results::columns::measure_name;
use results::{Column, DesignRow, ParameterDerivative, SlopeSide};
use sweep::{BatchDeviation, Case, Deviation, Parameter};

use crate::moments;

/// Step of finite differences, relative to the standard deviation of a source or to a measure.
const STEP: f64 = 1e-5;

/// States which scales share a deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeviationLevel {
    /// All scales of a batch have the same deviation.
    Batch,
    /// Each scale has its own, independent deviation.
    Scale,
}

/// A source of deviations, and its contribution to the spread of a measure.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceShare {
    /// Key of the deviating parameter.
    pub source: String,
    /// States which scales share the deviation.
    pub level: DeviationLevel,
    /// Standard deviation of the source, in the unit of the source.
    pub deviation: f64,
    /// Standard deviation of the measure if this were the only source.
    pub spread: f64,
    /// Fraction of the variance of the measure that this source causes, from 0 to 1.
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

/// Inputs of the linear prediction: derivatives and deviations of a design.
pub(crate) struct Gradients<'a> {
    /// Nominal design with the derivatives of its measures.
    ///
    /// The imperfection of its case is the scatter from scale to scale.
    pub(crate) design: &'a DesignRow,
    pub(crate) deviations: &'a [Deviation],
    /// Derivatives with respect to the gaps and slants of single scales.
    pub(crate) single: &'a [ParameterDerivative],
}

impl Gradients<'_> {
    /// Predicts the spread of a column.
    ///
    /// `None` if the column has no value, or lacks a one-sided derivative at a kink.
    pub(crate) fn spread(&self, column: &Column<DesignRow>) -> Option<LinearSpread> {
        let mut sources = Vec::new();
        for deviation in self.deviations {
            // The next loop adds the sources that only vary from scale to scale.
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

    /// Returns the slopes of a column for negative and for positive values of a deviation.
    fn slopes(
        &self,
        column: &Column<DesignRow>,
        deviation: &Deviation,
        batch: BatchDeviation,
    ) -> Option<[f64; 2]> {
        let case = &self.design.case;
        // `value` extrapolates linearly from the design, so the step may be tiny. It only has to
        // exceed round-off.
        let step = STEP * batch.standard_deviation();
        let value =
            |to: &Case| column.cell(&self.design.extrapolated(to, SlopeSide::Ahead)).number();
        let here = value(case)?;
        let [below, above] =
            [-step, step].map(|by| Some((value(&deviation.moved(case, by)?)? - here) / by));
        Some([below?, above?])
    }

    /// Returns the parameters that scatter from scale to scale, with their standard deviations.
    fn scattered(&self) -> Vec<(&'static Parameter, f64)> {
        let (imperfection, gap) = (self.design.case.imperfection, self.design.case.design.gap);
        let all =
            [("gap_over_t", imperfection.gap_cv * gap), ("slant_deg", imperfection.slant_sd_deg)];
        all.into_iter()
            .filter_map(|(key, sd)| Some((Parameter::named(key)?, sd)))
            .filter(|(_, sd)| *sd > 0.0)
            .collect()
    }

    /// Returns the variance of a column caused by scatter from scale to scale.
    ///
    /// The parameter `key` (gap or slant) of each scale deviates independently with the standard
    /// deviation `sd`. `None` if a one-sided derivative is missing at a kink.
    fn scatter(&self, column: &Column<DesignRow>, key: &str, sd: f64) -> Option<f64> {
        let measure = measure_name(&column.name);
        let mut derivatives = self.design.result.sensitivity.iter();
        // Parameters and the areal mass have no derivatives. Scatter does not change them.
        let Some(known) = derivatives.find(|d| d.measure == measure) else { return Some(0.0) };
        let step = STEP * known.value.abs().max(f64::MIN_POSITIVE);
        // A column in physical units is a function of the measure. `factor` is its slope.
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

    /// Returns the key of the deviation of `parameter` in the definition.
    ///
    /// For the gap this is `gap_mm` if the definition states the deviation in mm.
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
        // The sort is stable: sources with equal fractions keep the order of the definition.
        sources.sort_by(|one, other| other.share.total_cmp(&one.share));
        Self { spread: sum.sqrt(), sources }
    }

    /// Lists the main sources, e.g. "`gap_mm` 83 %, `slant_deg` from scale to scale 12 %".
    pub fn sources_text(&self) -> String {
        // Omit fractions that would be rounded to 0 %.
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
