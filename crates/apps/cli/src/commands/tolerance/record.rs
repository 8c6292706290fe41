//! The JSON output of `squama tolerance`.

use std::path::Path;

use serde_json::{Value, json};
use sweep::Sweep;
use uncertainty::{
    DesignTolerance, DeviationLevel, MeasureTolerance, RequirementYield, SourceShare,
};

use super::report::first_failure;
use crate::json;

/// Returns all results except the samples as JSON.
pub fn record(sweep: &Sweep, all: &[DesignTolerance], folder: &Path, files: &[String]) -> Value {
    json!({
        "sweep": sweep.name(),
        "designs": all.iter().map(|one| design(sweep, one)).collect::<Vec<_>>(),
        "folder": folder.to_string_lossy(),
        "files": files,
    })
}

fn design(sweep: &Sweep, design: &DesignTolerance) -> Value {
    let modes = sweep.grid().case(design.nominal.number.index()).judged_modes();
    json!({
        "design": design.nominal.number.to_string(),
        "measures": design.measures.iter().map(measure).collect::<Vec<_>>(),
        "yields": design.yields.iter().map(yielded).collect::<Vec<_>>(),
        "first_failure": first_failure(design),
        "failure_modes": modes.map(|modes| json::failure_modes(&modes)),
    })
}

fn measure(measure: &MeasureTolerance) -> Value {
    let sampled = measure.sampled.as_ref();
    let sources = measure.linear.iter().flat_map(|linear| linear.sources.iter().map(source));
    json!({
        "measure": measure.name,
        "unit": measure.unit,
        "value": measure.value,
        "linear_spread": measure.linear.as_ref().map(|linear| linear.spread),
        "sources": sources.collect::<Vec<_>>(),
        "samples": sampled.map(|s| s.count),
        "failed": measure.failed,
        "spread": sampled.map(|s| s.spread),
        "spread_error": sampled.map(|s| s.spread_error),
        "discrepancy": measure.discrepancy(),
        "mean": sampled.map(|s| s.statistics.mean),
        "quantiles": sampled.map(|s| s.statistics.quantiles),
    })
}

fn source(source: &SourceShare) -> Value {
    json!({
        "source": source.source,
        "level": if source.level == DeviationLevel::Batch { "batch" } else { "scale" },
        "deviation": source.deviation,
        "linear_spread": source.spread,
        "share": source.share,
    })
}

fn yielded(of: &RequirementYield) -> Value {
    json!({
        "requirement": of.requirement.as_ref().map_or("all".to_owned(), ToString::to_string),
        "samples": of.proportion.map(|p| p.of),
        "failed": of.failed,
        "met": of.proportion.map(|p| p.met),
        "yield": of.proportion.map(uncertainty::Proportion::share),
        "interval": of.proportion.map(uncertainty::Proportion::interval),
        "linear_yield": of.linear,
    })
}
