//! The command `squama rank`, which ranks the designs of a run.

mod answer;
mod checks;
mod columns;
mod gap_changes;
mod record;
mod report;

use anyhow::Context as _;
use clap::Args;
use ranking::{
    Criterion, Goal, InvalidRanking, Preferences, Ranking, Scale, TetrahedralGrid, Unmet, Weights,
    check_comparable,
};
use results::{Results, ResultsFolder};
use sweep::Sweep;

use super::options::whole;
use super::requirement_args::RequirementArgs;
use super::source::{Partial, verified_folder};
use super::{DONE, INCOMPLETE, derivation};
use crate::json;
use answer::RankedAnswer;
use checks::Checks;
use gap_changes::{couplings, gap_changes};
use record::{report_record, unmet_record};
use report::{RankReport, unmet_report};

pub(super) use report::{distance, obstacle};
use std::path::PathBuf;

/// Arguments of `squama rank`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama rank results/paper
  squama rank results/paper --weights 4,4,1,1 --top 20
  squama rank results/paper --require 'coverage >= 0.6' --require 'penetration < 0.3'
  squama rank results/paper --maximize critical_force --minimize gap_over_t
  squama rank results/paper --criteria coverage,max:peak_force,min:sink --scale log
  squama rank sweeps/paper.toml --json

Ranks the designs that meet all requirements and have a value for every criterion. The criteria are those of
the paper (coverage, critical force, penetration resistance, flexural compliance; in newtons and millimetres if
designs differ in thickness or moduli), those of --criteria, or
those of --maximize and --minimize. The fitness of a design is the product of its criteria, each rescaled from
0 (the worst) to 1 (the best) and raised to the power of its weight; with --scale linear or log it is their
weighted mean. A criterion is ignored if its weight is 0, or if all designs have the same value but for
round-off. Designs of equal fitness are listed in the order of their numbers.
Writes ranking.csv (designs by fitness), pareto.csv (the Pareto front), ranking.toml (requirements, criteria
and weights) and, with four criteria, winners.csv and quaternary.csv (the best design for all weights). If no
design meets the requirements, shows the nearest design and the requirement that is the obstacle.
Prints the ranking, and the answer: the best design that passes all checks, with its requirements and margins,
its values with a gap 10 % smaller and larger and with full substrate coupling, and every warning.
Exit code: 0 done, 1 no design meets the requirements, 2 bad input or a disk error.")]
pub struct Arguments {
    /// Results folder of a run, or its definition
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    #[command(flatten)]
    pub required: RequirementArgs,

    /// Column to maximize (may be repeated: several columns give the Pareto front and its knee)
    #[arg(long, value_name = "COLUMN", conflicts_with = "criteria")]
    pub maximize: Vec<String>,

    /// Column to minimize (may be repeated)
    #[arg(long, value_name = "COLUMN", conflicts_with = "criteria")]
    pub minimize: Vec<String>,

    /// Criteria instead of the paper's: max:COLUMN, min:COLUMN, or COLUMN alone, if it has a
    /// default direction
    #[arg(long, value_name = "CRITERION,…")]
    pub criteria: Option<String>,

    /// Weights of the criteria, in their order, --maximize before --minimize [default: equal]
    ///
    /// Weights are non-negative, and normalised to a sum of 1. The order of the paper's criteria is
    /// coverage, critical force, penetration resistance, flexural compliance.
    #[arg(long, value_name = "W,…", allow_hyphen_values = true)]
    pub weights: Option<String>,

    /// Scale of the criteria: paper, linear or log
    #[arg(long, value_name = "SCALE", default_value = "paper")]
    pub scale: String,

    /// Number of designs to print
    #[arg(long, allow_hyphen_values = true, value_name = "N", default_value_t = 10, value_parser = whole::<1, { u64::MAX }>)]
    pub top: u64,

    /// Number of steps along an edge of the tetrahedron of weights, 1 to 200
    #[arg(long, value_name = "R", allow_hyphen_values = true, default_value = "20")]
    pub resolution: String,

    /// Folder for the tables [default: RESULTS]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,

    #[command(flatten)]
    pub partial: Partial,
}

/// Ranks the designs of a run and writes the ranking.
pub fn rank(arguments: &Arguments) -> anyhow::Result<u8> {
    let grid: TetrahedralGrid = option("--resolution", &arguments.resolution)?;
    let verified = verified_folder(&arguments.results, arguments.partial.completeness())?;
    let preferences = preferences(arguments, results::definition(&verified)?.as_ref())?;
    let results = Ranking::results(&verified, &preferences)?;
    // Check before ranking, because values measured under different parameters are not comparable.
    check_comparable(&results, &preferences)?;
    match Ranking::by(&results, preferences.clone(), grid) {
        Ok(ranking) => ranked(arguments, &results, &ranking),
        Err(InvalidRanking::Unmet(unmet)) => none_meets(arguments, &results, &preferences, &unmet),
        Err(error) => Err(error.into()),
    }
}

/// Writes the tables of the ranking, checks the best designs and prints the report.
fn ranked(arguments: &Arguments, results: &Results, ranking: &Ranking<'_>) -> anyhow::Result<u8> {
    let folder = arguments.out.as_deref().unwrap_or(results.folder());
    // Keep the lock until the files are recorded, because a concurrent ranking would remove them.
    let (files, lock) = ranking::write_ranking(folder, ranking)?;
    derivation::record(results.verified_folder(), ResultsFolder::RANKING_RECORD, folder, &files)?;
    drop(lock);
    let checks = Checks::new(results, ranking);
    let changes = gap_changes(results, ranking, checks.best);
    let couplings = couplings(results, ranking, checks.best);
    let best = checks.best.unwrap_or_else(|| ranking.winner(ranking.preferences().weights));
    let answer = RankedAnswer::new(results, ranking.preferences(), best);
    let change = changes.iter().find(|change| change.design == best.design());
    let report = RankReport {
        results,
        ranking,
        top: arguments.top as usize,
        changes: &changes,
        couplings: &couplings,
        checks: &checks,
        answer: &answer,
    };
    let record = || report_record(&report, change);
    json::answer(arguments.json, record, || report.text(), (folder, &files))?;
    Ok(DONE)
}

/// Writes only the preferences and prints the nearest design, if no design meets the requirements.
fn none_meets(
    arguments: &Arguments,
    results: &Results,
    preferences: &Preferences,
    unmet: &Unmet,
) -> anyhow::Result<u8> {
    let folder = arguments.out.as_deref().unwrap_or(results.folder());
    // Replace an earlier ranking, because it would seem to belong to these requirements.
    let (file, lock) = ranking::write_unmet(folder, preferences)?;
    derivation::record(results.verified_folder(), ResultsFolder::RANKING_RECORD, folder, &[file])?;
    drop(lock);
    let (record, text) =
        (|| unmet_record(results, unmet), || unmet_report(results, preferences, unmet));
    json::answer(arguments.json, record, text, (folder, &[file]))?;
    Ok(INCOMPLETE)
}

/// Returns the requirements, criteria, weights and scale that the arguments request.
fn preferences(arguments: &Arguments, sweep: Option<&Sweep>) -> anyhow::Result<Preferences> {
    let requirements = arguments.required.read()?;
    let scale: Scale = option("--scale", &arguments.scale)?;
    let given = arguments.weights.as_ref();
    let weights: Option<Weights> = given.map(|text| option("--weights", text)).transpose()?;
    let preferences = Preferences::new(requirements, criteria(arguments, sweep)?, weights, scale);
    match given {
        Some(text) => preferences.with_context(|| format!("--weights {text}")),
        None => Ok(preferences?),
    }
}

/// Returns the requested criteria, or the default criteria of `sweep`.
fn criteria(arguments: &Arguments, sweep: Option<&Sweep>) -> anyhow::Result<Vec<Criterion>> {
    let goals = [(Goal::Maximize, &arguments.maximize), (Goal::Minimize, &arguments.minimize)];
    let requested: Vec<_> = goals
        .into_iter()
        .flat_map(|(goal, columns)| -> Vec<Criterion> {
            columns.iter().map(|column| Criterion::new(column.trim(), goal)).collect()
        })
        .collect();
    match &arguments.criteria {
        Some(criteria) => {
            criteria.split(',').map(|text| option::<Criterion>("--criteria", text)).collect()
        }
        None if requested.is_empty() => Ok(Criterion::usual(sweep)),
        None => Ok(requested),
    }
}

/// Parses `text`, the value of the option `name`.
fn option<T: std::str::FromStr>(name: &str, text: &str) -> anyhow::Result<T>
where
    T::Err: std::error::Error + Send + Sync + 'static,
{
    text.parse().with_context(|| format!("{name} {text}"))
}
