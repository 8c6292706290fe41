//! The tables of tolerances.

use results::{Cell, Column};
use sweep::DesignNumber;

use crate::analysis::{DesignTolerance, MeasureTolerance};
use crate::global::MeasureIndices;
use crate::linear::{DeviationLevel, LinearSpread, SourceShare};
use crate::proportion::Proportion;
use crate::sampled::Sampled;
use crate::sobol::SobolIndices;
use crate::yields::RequirementYield;

impl DesignTolerance {
    /// The rows of `tolerance.csv`: a measure of a design and its spread.
    pub fn measure_rows(&self) -> impl Iterator<Item = (DesignNumber, MeasureTolerance)> {
        let design = self.nominal.number;
        self.measures.iter().cloned().map(move |measure| (design, measure))
    }

    /// The rows of `tolerance_sources.csv`: the share of a source in the spread of the measure of that name.
    pub fn source_rows(&self) -> impl Iterator<Item = (DesignNumber, String, SourceShare)> {
        let design = self.nominal.number;
        self.measures.iter().flat_map(move |measure| {
            let sources = measure.linear.iter().flat_map(|linear| linear.sources.iter().cloned());
            sources.map(move |source| (design, measure.name.clone(), source))
        })
    }

    /// The rows of `yield.csv`: how many samples of a design meet a requirement, or all of them.
    pub fn yield_rows(&self) -> impl Iterator<Item = (DesignNumber, RequirementYield)> {
        let design = self.nominal.number;
        self.yields.iter().cloned().map(move |of| (design, of))
    }
}

impl MeasureIndices {
    /// The rows of `sobol.csv`: the part of each of the `variables`, by their keys, in the measure.
    pub fn rows(
        &self,
        variables: &[&'static str],
    ) -> impl Iterator<Item = (Self, &'static str, SobolIndices)> {
        variables.iter().zip(&self.indices).map(|(key, indices)| (self.clone(), *key, *indices))
    }
}

const DESIGN: &str = "position of the design in the grid of its sweep";
const MEASURE: &str = "the measure, by the name of its column";
const SAME: &str = "as the measure";

/// The columns of `tolerance.csv`.
pub static TOLERANCE_COLUMNS: &[Column<(DesignNumber, MeasureTolerance)>] = &[
    Column::new("design", "-", DESIGN, |(design, _)| design.to_string().into()),
    Column::new("measure", "-", MEASURE, |(_, m)| m.name.clone().into()),
    Column::new("unit", "-", "unit of the measure", |(_, m)| m.unit.into()),
    Column::new("value", SAME, "value of the nominal design", |(_, m)| m.value.into()),
    Column::new(
        "linear_spread",
        SAME,
        "standard deviation that the derivatives predict, empty at a kink without one of its sides",
        |(_, m)| m.linear.as_ref().map(|linear| linear.spread).into(),
    ),
    Column::new(
        "sources",
        "-",
        "what that spread comes from, the largest share first",
        |(_, m)| m.linear.as_ref().map(LinearSpread::in_words).into(),
    ),
    Column::new("samples", "-", "solved samples that have a value", |(_, m)| {
        m.sampled.as_ref().map(|sampled| sampled.count).into()
    }),
    Column::new("failed", "-", "samples without a value", |(_, m)| m.failed.into()),
    Column::new("spread", SAME, "standard deviation over the solved samples", |(_, m)| {
        sampled(m, |s| s.spread)
    }),
    Column::new("spread_error", SAME, "standard error of that standard deviation", |(_, m)| {
        sampled(m, |s| s.spread_error)
    }),
    Column::new(
        "discrepancy",
        "-",
        "linear spread over that of the samples, less 1: how far the prediction is off",
        |(_, m)| m.discrepancy().into(),
    ),
    Column::new("mean", SAME, "mean over the samples", |(_, m)| sampled(m, |s| s.statistics.mean)),
    Column::new("p05", SAME, "5 % quantile over the samples", |(_, m)| {
        sampled(m, |s| s.statistics.quantiles[0])
    }),
    Column::new("p50", SAME, "median over the samples", |(_, m)| {
        sampled(m, |s| s.statistics.quantiles[1])
    }),
    Column::new("p95", SAME, "95 % quantile over the samples", |(_, m)| {
        sampled(m, |s| s.statistics.quantiles[2])
    }),
];

/// The columns of `tolerance_sources.csv`.
pub static SOURCE_COLUMNS: &[Column<(DesignNumber, String, SourceShare)>] = &[
    Column::new("design", "-", DESIGN, |(design, ..)| design.to_string().into()),
    Column::new("measure", "-", MEASURE, |(_, measure, _)| measure.clone().into()),
    Column::new("source", "-", "what deviates, by its key in [tolerance]", |(.., s)| {
        s.source.clone().into()
    }),
    Column::new(
        "level",
        "-",
        "batch: all scales have the same deviation; scale: each its own",
        |(.., s)| {
            match s.level {
                DeviationLevel::Batch => "batch",
                DeviationLevel::Scale => "scale",
            }
            .into()
        },
    ),
    Column::new("deviation", "as the source", "standard deviation of the source", |(.., s)| {
        s.deviation.into()
    }),
    Column::new(
        "linear_spread",
        SAME,
        "standard deviation of the measure, were this the only source",
        |(.., s)| s.spread.into(),
    ),
    Column::new("share", "-", "part of the variance of the measure", |(.., s)| s.share.into()),
];

/// The columns of `yield.csv`.
pub static YIELD_COLUMNS: &[Column<(DesignNumber, RequirementYield)>] = &[
    Column::new("design", "-", DESIGN, |(design, _)| design.to_string().into()),
    Column::new("requirement", "-", "the requirement, or all of them together", |(_, of)| {
        of.requirement.as_ref().map_or("all".to_owned(), ToString::to_string).into()
    }),
    Column::new("samples", "-", "solved samples", |(_, of)| share(of, |p| p.of.into())),
    Column::new("failed", "-", "samples without a value, which do not meet", |(_, of)| {
        of.failed.into()
    }),
    Column::new("met", "-", "samples that meet", |(_, of)| share(of, |p| p.met.into())),
    Column::new("yield", "-", "share of the samples that meet", |(_, of)| {
        share(of, |p| p.share().into())
    }),
    Column::new("yield_low", "-", "lower end of the 95 % interval of the yield", |(_, of)| {
        share(of, |p| p.interval()[0].into())
    }),
    Column::new("yield_high", "-", "upper end of that interval", |(_, of)| {
        share(of, |p| p.interval()[1].into())
    }),
    Column::new("linear_yield", "-", "yield that the linear spread predicts", |(_, of)| {
        of.linear.into()
    }),
];

/// The columns of `sobol.csv`.
pub static INDEX_COLUMNS: &[Column<(MeasureIndices, &'static str, SobolIndices)>] = &[
    Column::new("measure", "-", MEASURE, |(m, ..)| m.name.clone().into()),
    Column::new("variable", "-", "the variable, by its key", |(_, key, _)| (*key).into()),
    Column::new(
        "first",
        "-",
        "first-order index: part of the variance that the variable has alone",
        |(.., of)| of.first.value.into(),
    ),
    Column::new("first_low", "-", "lower end of its 95 % interval", |(.., of)| {
        of.first.interval()[0].into()
    }),
    Column::new("first_high", "-", "upper end of that interval", |(.., of)| {
        of.first.interval()[1].into()
    }),
    Column::new(
        "total",
        "-",
        "total index: part of the variance that the variable has, alone and together with others",
        |(.., of)| of.total.value.into(),
    ),
    Column::new("total_low", "-", "lower end of its 95 % interval", |(.., of)| {
        of.total.interval()[0].into()
    }),
    Column::new("total_high", "-", "upper end of that interval", |(.., of)| {
        of.total.interval()[1].into()
    }),
    Column::new("spread", SAME, "standard deviation of the measure over the box", |(m, ..)| {
        m.spread.into()
    }),
    Column::new("samples", "-", "samples that have all their values", |(m, ..)| m.samples.into()),
    Column::new("failed", "-", "samples that lack a value, which are left out", |(m, ..)| {
        m.failed.into()
    }),
];

fn sampled(measure: &MeasureTolerance, value: fn(&Sampled) -> f64) -> Cell {
    measure.sampled.as_ref().map(value).into()
}

fn share(of: &RequirementYield, cell: fn(Proportion) -> Cell) -> Cell {
    of.proportion.map_or(Cell::Empty, cell)
}
