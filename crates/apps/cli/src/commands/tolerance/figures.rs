//! Draws the figures of `squama tolerance` for a single design.

use ranking::Requirement;
use report::{Histogram, Shares, share_bars};
use sweep::Sweep;
use uncertainty::{DesignTolerance, DeviationLevel, MeasureTolerance};

use super::report::is_shown;

/// File name of the figure of the sources.
const SOURCES: &str = "sources.svg";

/// Draws the sources of the spread, and a histogram of each measure with a requirement.
///
/// Returns the file name and the SVG text of each figure.
pub fn figures(
    sweep: &Sweep,
    requirements: &[Requirement],
    design: &DesignTolerance,
) -> Vec<(String, String)> {
    let name = format!("{} design {}", sweep.name(), design.nominal.number);
    let shown = design.measures.iter().filter(|m| is_shown(&m.name, requirements));
    let shares: Vec<Shares> = shown.filter_map(shares).collect();
    let mut files = vec![(SOURCES.to_owned(), share_bars(&name, &shares))];
    for measure in
        design.measures.iter().filter(|m| requirements.iter().any(|r| r.column == m.name))
    {
        let Some(svg) = histogram(&name, requirements, design, measure) else { continue };
        let file = format!("histogram-{}.svg", measure.name.replace('_', "-"));
        files.push((file, svg));
    }
    files
}

/// Returns the fraction of the variance of a measure that each source contributes.
///
/// `None` if the measure has no linear prediction.
fn shares(measure: &MeasureTolerance) -> Option<Shares> {
    let sources = measure.linear.as_ref()?.sources.iter().map(|source| {
        let level = if source.level == DeviationLevel::Scale { " from scale to scale" } else { "" };
        (format!("{}{level}", source.source), source.share)
    });
    Some((measure.name.clone(), sources.collect()))
}

/// Draws the histogram of a measure; `None` if no sample has a value of the measure.
fn histogram(
    name: &str,
    requirements: &[Requirement],
    design: &DesignTolerance,
    measure: &MeasureTolerance,
) -> Option<String> {
    let index = design.columns.iter().position(|column| *column == measure.name)?;
    let values: Vec<f64> = design.samples.iter().filter_map(|s| s.values[index]).collect();
    let limiting = requirements.iter().filter(|requirement| requirement.column == measure.name);
    let bounds: Vec<_> = limiting.map(|r| (bound(r), r.limit)).collect();
    let histogram = Histogram {
        name,
        measure: &measure.name,
        values: &values,
        nominal: measure.value,
        bounds: &bounds,
    };
    (!values.is_empty()).then(|| histogram.svg())
}

/// Formats the bound of a requirement, with the typographic signs ≥ and ≤.
fn bound(requirement: &Requirement) -> String {
    let sign = requirement.relation.sign().replace(">=", "≥").replace("<=", "≤");
    format!("required {sign} {}", text::number::text(requirement.limit))
}
