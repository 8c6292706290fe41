//! The text output of `squama tolerance`.

use std::fmt::Write as _;

use ranking::Requirement;
use results::MEASURE_TABLES;
use results::columns::name::{AREAL_MASS, FOLD_FORCE, GAP_STRETCH_MIN};
use results::columns::{measure_name, mode_column};
use sweep::Sweep;
use uncertainty::{DesignTolerance, MeasureTolerance, Proportion, RequirementYield};

use crate::commands::answer::DesignAnswer;
use crate::print::{aligned, change, counted, rounded};

/// Maximum number of designs that the report lists.
const LISTED: usize = 10;

/// Header of the table of measures.
const HEADER: [&str; 8] = [
    "measure",
    "nominal",
    "predicted ±",
    "sampled ±",
    "prediction off by",
    "5 %",
    "95 %",
    "sources",
];

/// Formats a detailed report on a single design, or a list of several designs.
pub fn report(sweep: &Sweep, requirements: &[Requirement], all: &[DesignTolerance]) -> String {
    match all {
        [design] => one(sweep, requirements, design),
        several => list(sweep, requirements, several),
    }
}

/// Formats the spread of the measures, the yield and the warnings of a single design.
fn one(sweep: &Sweep, requirements: &[Requirement], design: &DesignTolerance) -> String {
    let (number, count) = (design.nominal.number, sweep.grid().len());
    let samples = counted(design.samples.len() as u64, "sample");
    let mut text = format!("{}: design {number} of {count}, {samples}\n", sweep.name());
    let shown = design.measures.iter().filter(|measure| is_shown(&measure.name, requirements));
    let mut rows = vec![HEADER.map(str::to_owned).to_vec()];
    rows.extend(shown.clone().map(measure_row));
    let _ = write!(text, "{}", aligned(&rows));
    if shown.clone().any(MeasureTolerance::is_off) {
        text.push_str("  (!) off by more than twice the statistical error: the measure is nonlinear over these deviations; use the samples\n");
    }
    if !design.yields.is_empty() {
        let rows: Vec<_> = design.yields.iter().map(yield_row).collect();
        let _ = write!(text, "\nYield\n{}", aligned(&rows));
    }
    text.push_str(&folded(design).unwrap_or_default());
    let answer = DesignAnswer::new(sweep, &design.nominal, requirements);
    let rows = answer.rows();
    if !rows.is_empty() {
        let _ = write!(text, "\nThe nominal design\n{}", aligned(&rows));
    }
    text.push_str(&answer.warnings_text(None));
    if let Some(mode) = first_failure(design) {
        let _ = writeln!(text, "\nFirst failure of the nominal design: {mode}");
    }
    if let Some(modes) = sweep.grid().case(design.nominal.number.index()).judged_modes() {
        let _ = write!(text, "\n{modes}");
    }
    text
}

/// Returns the name of the first failure mode of the nominal design.
///
/// `None` if the first failure is not requested, or is unknown.
pub fn first_failure(design: &DesignTolerance) -> Option<&'static str> {
    Some(design.nominal.result.puncture?.measures.failure.mode?.name())
}

/// Returns a warning that the surface of some samples folds.
///
/// Samples with a fold count as failed only if a requirement excludes folds.
fn folded(design: &DesignTolerance) -> Option<String> {
    let index = design.columns.iter().position(|column| column == FOLD_FORCE)?;
    let folded = design.samples.iter().map(|sample| sample.values.get(index));
    let count = folded.filter(|force| force.is_some_and(Option::is_some)).count();
    let samples = counted(count as u64, "sample");
    let line = format!(
        "  (!) {samples}: the surface folds; add --require '{GAP_STRETCH_MIN} > 0' to count them as failed\n"
    );
    (count > 0).then_some(line)
}

/// Returns true for the main measures, failure forces, the mass, and columns with a requirement.
pub fn is_shown(name: &str, requirements: &[Requirement]) -> bool {
    let measure = measure_name(name);
    let leads = MEASURE_TABLES.iter().any(|(table, _)| *table == measure);
    leads
        || name == AREAL_MASS
        || mode_column(name).is_some()
        || requirements.iter().any(|requirement| requirement.column == name)
}

fn measure_row(measure: &MeasureTolerance) -> Vec<String> {
    let linear = measure.linear.as_ref();
    let [spread, low, high] = match &measure.sampled {
        Some(sampled) => [
            format!("{} (± {})", short(sampled.spread), short(sampled.spread_error)),
            short(sampled.statistics.quantiles[0]),
            short(sampled.statistics.quantiles[2]),
        ],
        None => ["none"; 3].map(str::to_owned),
    };
    let off = measure.discrepancy().map_or("unknown".to_owned(), |off| {
        let mark = if measure.is_off() { " (!)" } else { "" };
        format!("{}{mark}", change(100.0 * off, 0))
    });
    vec![
        measure.name.clone(),
        measure.value.map_or("none".to_owned(), rounded),
        linear.map_or("kink".to_owned(), |linear| short(linear.spread)),
        spread,
        off,
        low,
        high,
        linear.map_or(String::new(), uncertainty::LinearSpread::sources_text),
    ]
}

fn yield_row(of: &RequirementYield) -> Vec<String> {
    let name = of.requirement.as_ref().map_or("all together".to_owned(), ToString::to_string);
    let linear = of.linear.map(|share| format!("prediction {}", percent(share)));
    let failed = (of.failed > 0).then(|| format!("{} failed", counted(of.failed as u64, "sample")));
    let notes: Vec<_> = failed.into_iter().chain(linear).collect();
    vec![name, of.proportion.map_or("none".to_owned(), proportion), notes.join(", ")]
}

/// Formats a fraction of samples with its 95 % interval.
fn proportion(proportion: Proportion) -> String {
    let [low, high] = proportion.interval().map(percent);
    format!("{} (95 % interval {low} to {high})", percent(proportion.share()))
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// Formats a value with three significant digits.
fn short(value: f64) -> String {
    text::number::rounded(value, 3)
}

/// Returns the fraction of samples that meet all requirements; `None` without requirements.
fn whole_yield(design: &DesignTolerance) -> Option<Proportion> {
    design.yields.last().and_then(|of| of.proportion)
}

/// Lists the designs in descending order of their yield.
///
/// Without requirements, the designs keep the order of their numbers.
fn list(sweep: &Sweep, requirements: &[Requirement], all: &[DesignTolerance]) -> String {
    let count = counted(all.len() as u64, "design");
    let mut text = format!("{}: {count} of {}\n", sweep.name(), sweep.grid().len());
    let mut designs: Vec<&DesignTolerance> = all.iter().collect();
    // The sort is stable, so designs with equal yields keep their order.
    designs.sort_by(|one, other| {
        let [one, other] = [one, other].map(|d| whole_yield(d).map_or(-1.0, Proportion::share));
        other.total_cmp(&one)
    });
    let rows = designs.iter().take(LISTED).flat_map(|design| yield_rows(design, requirements));
    let rows: Vec<_> = rows.collect();
    text.push_str(&aligned(&rows));
    let more = all.len().saturating_sub(LISTED);
    if more > 0 {
        let _ = writeln!(text, "  and {more} more");
    }
    text
}

/// Returns a row for each displayed measure of a design; all measures in one row would be too wide.
fn yield_rows(design: &DesignTolerance, requirements: &[Requirement]) -> Vec<Vec<String>> {
    let yielded = whole_yield(design).map(proportion);
    let first = [design.nominal.number.to_string(), yielded.unwrap_or_default()];
    let shown = design.measures.iter().filter(|m| is_shown(&m.name, requirements));
    let titles = std::iter::once(first).chain(std::iter::repeat(Default::default()));
    let rows = titles.zip(shown).map(|(title, m)| {
        let spread = m.sampled.as_ref().map(|s| s.spread).or(m.linear.as_ref().map(|l| l.spread));
        let value = m.value.map_or("none".to_owned(), rounded);
        let values = format!("{value} ± {}", spread.map_or("unknown".to_owned(), short));
        title.into_iter().chain([m.name.clone(), values]).collect()
    });
    rows.collect()
}
