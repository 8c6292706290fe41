//! Columns and rows of the tables with spreads, yields and Sobol' indices.

use results::{Column, columns};
use sweep::DesignNumber;

use crate::analysis::{DesignTolerance, MeasureTolerance};
use crate::global::MeasureIndices;
use crate::linear::{DeviationLevel, LinearSpread, SourceShare};
use crate::proportion::Proportion;
use crate::sampled_spread::SampledSpread;
use crate::sobol::SobolIndices;
use crate::yields::RequirementYield;

impl DesignTolerance {
    /// Returns the rows of `tolerance.csv`: one row for each measure.
    pub fn measure_rows(&self) -> impl Iterator<Item = (DesignNumber, MeasureTolerance)> {
        let design = self.nominal.number;
        self.measures.iter().cloned().map(move |measure| (design, measure))
    }

    /// Returns the rows of `tolerance_sources.csv`: one for each source of each measure.
    pub fn source_rows(&self) -> impl Iterator<Item = (DesignNumber, String, SourceShare)> {
        let design = self.nominal.number;
        self.measures.iter().flat_map(move |measure| {
            let sources = measure.linear.iter().flat_map(|linear| linear.sources.iter().cloned());
            sources.map(move |source| (design, measure.name.clone(), source))
        })
    }

    /// Returns the rows of `yield.csv`: one for each requirement, then one for all together.
    pub fn yield_rows(&self) -> impl Iterator<Item = (DesignNumber, RequirementYield)> {
        let design = self.nominal.number;
        self.yields.iter().cloned().map(move |of| (design, of))
    }
}

impl MeasureIndices {
    /// Returns the rows of `sobol.csv`: one for each variable, with the key of the variable.
    ///
    /// `variables` are the keys in the order of the indices.
    pub fn rows(
        &self,
        variables: &[&'static str],
    ) -> impl Iterator<Item = (Self, &'static str, SobolIndices)> {
        variables.iter().zip(&self.indices).map(|(key, indices)| (self.clone(), *key, *indices))
    }
}

const DESIGN: &str = "position of the design in the grid of its sweep";
const MEASURE: &str = "column name of the measure";
const SAME: &str = "as the measure";

/// Columns of `tolerance.csv`.
pub static TOLERANCE_COLUMNS: &[Column<(DesignNumber, MeasureTolerance)>] = &columns! {
    (DesignNumber, MeasureTolerance):
    "design", "-", |(design, _)| design.to_string(), DESIGN;
    "measure", "-", |(_, m)| m.name.clone(), MEASURE;
    "unit", "-", |(_, m)| m.unit, "unit of the measure";
    "value", SAME, |(_, m)| m.value, "value of the nominal design";
    "linear_spread", SAME, |(_, m)| m.linear.as_ref().map(|linear| linear.spread),
        "standard deviation that the derivatives predict; empty if a one-sided derivative is missing at a kink";
    "sources", "-", |(_, m)| m.linear.as_ref().map(LinearSpread::sources_text),
        "sources of the linear spread, the largest contribution first";
    "samples", "-", |(_, m)| m.sampled.as_ref().map(|sampled| sampled.count),
        "solved samples with a value";
    "failed", "-", |(_, m)| m.failed, "samples without a value";
    "spread", SAME, |(_, m)| sampled(m, |s| s.spread), "standard deviation over the solved samples";
    "spread_error", SAME, |(_, m)| sampled(m, |s| s.spread_error),
                "standard error of the spread";
    "discrepancy", "-", |(_, m)| m.discrepancy(),
                "relative error of the linear spread: linear_spread/spread − 1";
    "mean", SAME, |(_, m)| sampled(m, |s| s.statistics.mean), "mean over the samples";
    "p05", SAME, |(_, m)| sampled(m, |s| s.statistics.quantiles[0]), "5 % quantile over the samples";
    "p50", SAME, |(_, m)| sampled(m, |s| s.statistics.quantiles[1]), "median over the samples";
    "p95", SAME, |(_, m)| sampled(m, |s| s.statistics.quantiles[2]), "95 % quantile over the samples";
};

/// Columns of `tolerance_sources.csv`.
pub static SOURCE_COLUMNS: &[Column<(DesignNumber, String, SourceShare)>] = &columns! {
    (DesignNumber, String, SourceShare):
    "design", "-", |(design, ..)| design.to_string(), DESIGN;
    "measure", "-", |(_, measure, _)| measure.clone(), MEASURE;
    "source", "-", |(.., s)| s.source.clone(), "deviating parameter, by its key in [tolerance]";
    "level", "-",
        |(.., s)| match s.level {
            DeviationLevel::Batch => "batch",
            DeviationLevel::Scale => "scale",
        },
                "batch: all scales have the same deviation; scale: each scale has its own deviation";
    "deviation", "as the source", |(.., s)| s.deviation, "standard deviation of the source";
    "linear_spread", SAME, |(.., s)| s.spread,
                "standard deviation of the measure if this were the only source";
    "share", "-", |(.., s)| s.share, "fraction of the variance of the measure";
};

/// Columns of `yield.csv`.
pub static YIELD_COLUMNS: &[Column<(DesignNumber, RequirementYield)>] = &columns! {
    (DesignNumber, RequirementYield):
    "design", "-", |(design, _)| design.to_string(), DESIGN;
    "requirement", "-",
        |(_, of)| of.requirement.as_ref().map_or("all".to_owned(), ToString::to_string),
        "the requirement; all: all requirements together";
    "samples", "-", |(_, of)| of.proportion.map(|p| p.of), "solved samples";
    "failed", "-", |(_, of)| of.failed, "samples without a value, which count as not meeting the requirement";
    "met", "-", |(_, of)| of.proportion.map(|p| p.met), "samples that meet the requirement";
    "yield", "-", |(_, of)| of.proportion.map(Proportion::share), "fraction of the samples that meet the requirement";
    "yield_low", "-", |(_, of)| of.proportion.map(|p| p.interval()[0]),
        "lower end of the 95 % interval of the yield";
    "yield_high", "-", |(_, of)| of.proportion.map(|p| p.interval()[1]), "upper end of the 95 % interval of the yield";
    "linear_yield", "-", |(_, of)| of.linear, "yield that the linear spread predicts";
};

/// Columns of `sobol.csv`.
pub static INDEX_COLUMNS: &[Column<(MeasureIndices, &'static str, SobolIndices)>] = &columns! {
    (MeasureIndices, &'static str, SobolIndices):
    "measure", "-", |(m, ..)| m.name.clone(), MEASURE;
    "variable", "-", |(_, key, _)| *key, "the variable, by its key";
    "first", "-", |(.., of)| of.first.value,
        "first-order index: fraction of the variance caused by the variable alone";
    "first_low", "-", |(.., of)| of.first.interval()[0], "lower end of the 95 % interval of the first-order index";
    "first_high", "-", |(.., of)| of.first.interval()[1], "upper end of the 95 % interval of the first-order index";
    "total", "-", |(.., of)| of.total.value,
        "total index: fraction of the variance caused by the variable, alone and in interactions";
    "total_low", "-", |(.., of)| of.total.interval()[0], "lower end of the 95 % interval of the total index";
    "total_high", "-", |(.., of)| of.total.interval()[1], "upper end of the 95 % interval of the total index";
    "spread", SAME, |(m, ..)| m.spread, "standard deviation of the measure over the ranges of the variables";
    "samples", "-", |(m, ..)| m.samples, "samples with a value at every point";
    "failed", "-", |(m, ..)| m.failed, "samples without a value at some point, which are excluded";
};

fn sampled(measure: &MeasureTolerance, value: fn(&SampledSpread) -> f64) -> Option<f64> {
    measure.sampled.as_ref().map(value)
}
