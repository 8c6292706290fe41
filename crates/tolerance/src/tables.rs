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

/// A row of `tolerance.csv`: a measure of a design and its spread.
pub struct DesignMeasureTolerance {
    /// The design.
    pub design: DesignNumber,
    /// The measure.
    pub measure: MeasureTolerance,
}

/// A row of `tolerance_sources.csv`: the share of a source in the spread of a measure.
pub struct DesignSource {
    /// The design.
    pub design: DesignNumber,
    /// Name of the measure.
    pub measure: String,
    /// The source.
    pub source: SourceShare,
}

/// A row of `yield.csv`: how many samples of a design meet a requirement.
pub struct DesignYield {
    /// The design.
    pub design: DesignNumber,
    /// The requirement, or all of them.
    pub of: RequirementYield,
}

/// A row of `sobol.csv`: the part of a variable in a measure.
pub struct IndexRow {
    /// The measure, with the indices of all variables.
    pub measure: MeasureIndices,
    /// Key of the variable.
    pub variable: &'static str,
    /// The indices of the variable.
    pub indices: SobolIndices,
}

impl DesignTolerance {
    /// The rows of `tolerance.csv`.
    pub fn measure_rows(&self) -> impl Iterator<Item = DesignMeasureTolerance> {
        let design = self.nominal.number;
        let measures = self.measures.iter().cloned();
        measures.map(move |measure| DesignMeasureTolerance { design, measure })
    }

    /// The rows of `tolerance_sources.csv`.
    pub fn source_rows(&self) -> impl Iterator<Item = DesignSource> {
        let design = self.nominal.number;
        let rows = move |of: &MeasureTolerance| {
            let row = |source| DesignSource { design, measure: of.name.clone(), source };
            let sources = of.linear.iter().flat_map(|linear| linear.sources.iter().cloned());
            sources.map(row).collect::<Vec<_>>()
        };
        self.measures.iter().flat_map(rows)
    }

    /// The rows of `yield.csv`.
    pub fn yield_rows(&self) -> impl Iterator<Item = DesignYield> {
        let design = self.nominal.number;
        self.yields.iter().cloned().map(move |of| DesignYield { design, of })
    }
}

const DESIGN: &str = "position of the design in the grid of its sweep";
const MEASURE: &str = "the measure, by the name of its column";
const SAME: &str = "as the measure";

/// The columns of `tolerance.csv`.
pub static TOLERANCE_COLUMNS: &[Column<DesignMeasureTolerance>] = &[
    Column::new("design", "-", DESIGN, |r| r.design.to_string().into()),
    Column::new("measure", "-", MEASURE, |r| r.measure.name.clone().into()),
    Column::new("unit", "-", "unit of the measure", |r| r.measure.unit.into()),
    Column::new("value", SAME, "value of the nominal design", |r| r.measure.value.into()),
    Column::new(
        "linear_spread",
        SAME,
        "standard deviation that the derivatives predict, empty at a kink without one of its sides",
        |r| r.measure.linear.as_ref().map(|linear| linear.spread).into(),
    ),
    Column::new("sources", "-", "what that spread comes from, the largest share first", |r| {
        r.measure.linear.as_ref().map(LinearSpread::in_words).into()
    }),
    Column::new("samples", "-", "solved samples that have a value", |r| {
        r.measure.sampled.as_ref().map(|sampled| sampled.count).into()
    }),
    Column::new("failed", "-", "samples without a value", |r| r.measure.failed.into()),
    Column::new("spread", SAME, "standard deviation over the solved samples", |r| {
        sampled(r, |s| s.spread)
    }),
    Column::new("spread_error", SAME, "standard error of that standard deviation", |r| {
        sampled(r, |s| s.spread_error)
    }),
    Column::new(
        "discrepancy",
        "-",
        "linear spread over that of the samples, less 1: how far the prediction is off",
        |r| r.measure.discrepancy().into(),
    ),
    Column::new("mean", SAME, "mean over the samples", |r| sampled(r, |s| s.statistics.mean)),
    Column::new("p05", SAME, "5 % quantile over the samples", |r| {
        sampled(r, |s| s.statistics.quantiles[0])
    }),
    Column::new("p50", SAME, "median over the samples", |r| {
        sampled(r, |s| s.statistics.quantiles[1])
    }),
    Column::new("p95", SAME, "95 % quantile over the samples", |r| {
        sampled(r, |s| s.statistics.quantiles[2])
    }),
];

/// The columns of `tolerance_sources.csv`.
pub static SOURCE_COLUMNS: &[Column<DesignSource>] = &[
    Column::new("design", "-", DESIGN, |r| r.design.to_string().into()),
    Column::new("measure", "-", MEASURE, |r| r.measure.clone().into()),
    Column::new("source", "-", "what deviates, by its key in [tolerance]", |r| {
        r.source.source.clone().into()
    }),
    Column::new(
        "level",
        "-",
        "batch: all scales have the same deviation; scale: each its own",
        |r| {
            match r.source.level {
                DeviationLevel::Batch => "batch",
                DeviationLevel::Scale => "scale",
            }
            .into()
        },
    ),
    Column::new("deviation", "as the source", "standard deviation of the source", |r| {
        r.source.deviation.into()
    }),
    Column::new(
        "linear_spread",
        SAME,
        "standard deviation of the measure, were this the only source",
        |r| r.source.spread.into(),
    ),
    Column::new("share", "-", "part of the variance of the measure", |r| r.source.share.into()),
];

/// The columns of `yield.csv`.
pub static YIELD_COLUMNS: &[Column<DesignYield>] = &[
    Column::new("design", "-", DESIGN, |r| r.design.to_string().into()),
    Column::new("requirement", "-", "the requirement, or all of them together", |r| {
        r.of.requirement.as_ref().map_or("all".to_owned(), ToString::to_string).into()
    }),
    Column::new("samples", "-", "solved samples", |r| share(r, |p| p.of.into())),
    Column::new("failed", "-", "samples without a value, which do not meet", |r| {
        r.of.failed.into()
    }),
    Column::new("met", "-", "samples that meet", |r| share(r, |p| p.met.into())),
    Column::new("yield", "-", "share of the samples that meet", |r| share(r, |p| p.share().into())),
    Column::new("yield_low", "-", "lower end of the 95 % interval of the yield", |r| {
        share(r, |p| p.interval()[0].into())
    }),
    Column::new("yield_high", "-", "upper end of that interval", |r| {
        share(r, |p| p.interval()[1].into())
    }),
    Column::new("linear_yield", "-", "yield that the linear spread predicts", |r| {
        r.of.linear.into()
    }),
];

/// The columns of `sobol.csv`.
pub static INDEX_COLUMNS: &[Column<IndexRow>] = &[
    Column::new("measure", "-", MEASURE, |r| r.measure.name.clone().into()),
    Column::new("variable", "-", "the variable, by its key", |r| r.variable.into()),
    Column::new(
        "first",
        "-",
        "first-order index: part of the variance that the variable has alone",
        |r| r.indices.first.value.into(),
    ),
    Column::new("first_low", "-", "lower end of its 95 % interval", |r| {
        r.indices.first.interval()[0].into()
    }),
    Column::new("first_high", "-", "upper end of that interval", |r| {
        r.indices.first.interval()[1].into()
    }),
    Column::new(
        "total",
        "-",
        "total index: part of the variance that the variable has, alone and together with others",
        |r| r.indices.total.value.into(),
    ),
    Column::new("total_low", "-", "lower end of its 95 % interval", |r| {
        r.indices.total.interval()[0].into()
    }),
    Column::new("total_high", "-", "upper end of that interval", |r| {
        r.indices.total.interval()[1].into()
    }),
    Column::new("spread", SAME, "standard deviation of the measure over the box", |r| {
        r.measure.spread.into()
    }),
    Column::new("samples", "-", "samples that have all their values", |r| r.measure.samples.into()),
    Column::new("failed", "-", "samples that lack a value, which are left out", |r| {
        r.measure.failed.into()
    }),
];

fn sampled(row: &DesignMeasureTolerance, value: fn(&Sampled) -> f64) -> Cell {
    row.measure.sampled.as_ref().map(value).into()
}

fn share(row: &DesignYield, cell: fn(Proportion) -> Cell) -> Cell {
    row.of.proportion.map_or(Cell::Empty, cell)
}
