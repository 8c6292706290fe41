//! `squama rank`.

mod gap_changes;
mod record;
mod report;

use anyhow::Context as _;
use ranking::{
    CRITERIA, Criterion, Goal, InvalidRanking, Preferences, Ranking, Requirement, Scale,
    TetrahedralGrid, Unmet, Weights, check_comparable,
};
use results::columns::SOUND_FORCE;
use results::{Results, RunFolder};

use super::source::verified_folder;
use super::{DONE, INCOMPLETE, derived};
use crate::args;
use crate::json;
use crate::print::print;
use gap_changes::{gap_changes, gap_changes_record};
use record::{ranking_record, unmet_record};
use report::{RankReport, unmet_report};

pub(super) use report::{distance, obstacle};

/// Finds the best designs of a run and writes them down.
pub fn rank(arguments: &args::RankArguments) -> anyhow::Result<u8> {
    let preferences = preferences(arguments)?;
    let grid: TetrahedralGrid = option("--resolution", &arguments.resolution)?;
    let verified = verified_folder(&arguments.results, arguments.partial.completeness())?;
    let results = Results::read_from(&verified)?;
    check_comparable(&results, &preferences)?;
    match Ranking::by(&results, preferences.clone(), grid) {
        Ok(ranking) => ranked(arguments, &results, &ranking),
        Err(InvalidRanking::Unmet(unmet)) => none_meets(arguments, &results, &preferences, &unmet),
        Err(error) => Err(error.into()),
    }
}

fn ranked(
    arguments: &args::RankArguments,
    results: &Results,
    ranking: &Ranking<'_>,
) -> anyhow::Result<u8> {
    let folder = arguments.out.as_deref().unwrap_or(results.folder());
    let files = ranking::write_ranking(folder, ranking)?;
    derived::note(results.verified_folder(), RunFolder::RANKING_RECORD, folder, &files)?;
    let changes = gap_changes(results, ranking);
    if arguments.json {
        let mut record = ranking_record(results, ranking, arguments.top);
        record["gap_changes"] = gap_changes_record(&changes).into();
        json::print(&record)?;
    } else {
        let text = RankReport { results, ranking, top: arguments.top, changes: &changes }.text();
        print(&format!("{text}\n{}: {}\n", folder.display(), files.join(" ")))?;
    }
    Ok(DONE)
}

fn none_meets(
    arguments: &args::RankArguments,
    results: &Results,
    preferences: &Preferences,
    unmet: &Unmet,
) -> anyhow::Result<u8> {
    let folder = arguments.out.as_deref().unwrap_or(results.folder());
    let file = ranking::write_unmet(folder, preferences)?;
    derived::note(results.verified_folder(), RunFolder::RANKING_RECORD, folder, &[file])?;
    if arguments.json {
        json::print(&unmet_record(results, unmet))?;
    } else {
        let text = unmet_report(results, preferences, unmet);
        print(&format!("{text}\n{}: {file}\n", folder.display()))?;
    }
    Ok(INCOMPLETE)
}

/// The preferences that the ranking goes by.
fn preferences(arguments: &args::RankArguments) -> anyhow::Result<Preferences> {
    let require = |text: &String| option::<Requirement>("--require", text);
    let requirements = arguments.require.iter().map(require).collect::<anyhow::Result<_>>()?;
    let scale: Scale = option("--scale", &arguments.scale)?;
    let given = arguments.weights.as_ref();
    let weights: Option<Weights> = given.map(|text| option("--weights", text)).transpose()?;
    let preferences = Preferences::new(requirements, criteria(arguments)?, weights, scale);
    match given {
        Some(text) => preferences.with_context(|| format!("--weights {text}")),
        None => Ok(preferences?),
    }
}

/// The criteria that are asked for, or those of the paper.
fn criteria(arguments: &args::RankArguments) -> anyhow::Result<Vec<Criterion>> {
    let goals = [(Goal::Maximize, &arguments.maximize), (Goal::Minimize, &arguments.minimize)];
    let of = |(goal, columns): (Goal, &Vec<String>)| -> Vec<Criterion> {
        columns.iter().map(|column| Criterion::new(column.trim(), goal)).collect()
    };
    let own: Vec<_> = goals.into_iter().flat_map(of).collect();
    match &arguments.criteria {
        Some(criteria) => {
            let read = |text: &str| option::<Criterion>("--criteria", text);
            criteria.split(',').map(read).collect()
        }
        None if own.is_empty() && arguments.sound => Ok(sound_criteria()),
        None if own.is_empty() => Ok(CRITERIA.to_vec()),
        None => Ok(own),
    }
}

/// The criteria of the paper with the force that the model can answer for.
fn sound_criteria() -> Vec<Criterion> {
    let sound = |criterion: &Criterion| match criterion.column.as_ref() {
        "critical_force" => Criterion::new(SOUND_FORCE, Goal::Maximize),
        _ => criterion.clone(),
    };
    CRITERIA.iter().map(sound).collect()
}

/// The value of an option.
fn option<T: std::str::FromStr>(name: &str, text: &str) -> anyhow::Result<T>
where
    T::Err: std::error::Error + Send + Sync + 'static,
{
    text.parse().with_context(|| format!("{name} {text}"))
}
