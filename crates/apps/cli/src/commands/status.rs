//! The command `squama status`, which shows the state of a run or a search.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use optimisation::SearchStatus;
use serde_json::{Value, json};
use sweep::DesignNumber;

use super::answer::limit_text;
use super::source::results_folder;
use super::{DONE, INCOMPLETE};
use crate::json;
use crate::print::{aligned, counted, digits, print, time};

/// Arguments of `squama status`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama status results/paper
  squama status results/paper --json

Also works during a run or a search. Verifies the checksum of every table, and lists the rankings, figures and
pages that were made from tables which have changed since.
Exit code: 0 done, 1 some designs failed or are missing, a search has not ended, or a table was changed,
2 bad input.")]
pub struct Arguments {
    /// Results folder of a run or a search, or its definition
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}

/// Shows the status of a run or a search.
pub fn status(arguments: &Arguments) -> anyhow::Result<u8> {
    let path = &arguments.results;
    let folder = if SearchStatus::is_search(path) { path.clone() } else { results_folder(path)? };
    if SearchStatus::is_search(&folder) {
        return search_status(&folder, arguments.json);
    }
    let status = run::RunStatus::read(&folder)?;
    if arguments.json {
        json::print(&as_json(&status))?;
    } else {
        print(&report(&status))?;
    }
    let complete = status.failed == 0 && status.archive.missing().is_empty();
    let complete = complete && status.problems.is_empty();
    Ok(if complete { DONE } else { INCOMPLETE })
}

/// Prints the status of a search.
fn search_status(folder: &Path, json: bool) -> anyhow::Result<u8> {
    let status = SearchStatus::read(folder)?;
    if json {
        json::print(&json!({
            "goal": status.goal,
            "is_running": status.in_use,
            "is_complete": status.is_complete,
            "designs": status.designs,
            "sample_sets": status.sample_sets,
            "seconds": status.time.map(|time| time.as_secs_f64()),
            "best": status.best().map(|best| best_record(&status, best)),
            "program": status.program,
            "goal_sha256": status.goal_sha256,
            "problems": status.problems,
        }))?;
    } else {
        print(&search_report(&status))?;
    }
    let is_done = status.is_complete && status.problems.is_empty();
    Ok(if is_done { DONE } else { INCOMPLETE })
}

/// Formats the status of a search, with its best design and its problems.
pub fn search_report(status: &SearchStatus) -> String {
    let state = match (status.in_use, status.is_complete) {
        (true, _) => "search, running",
        (_, true) => "search, done",
        _ => "search, not finished; squama optimise --resume continues it",
    };
    let met = status.evaluations.iter().filter(|design| design.is_met).count();
    let mut rows = vec![row("solved", counted(status.designs as u64, "design"))];
    if !status.evaluations.is_empty() {
        let nominal = counted(status.evaluations.len() as u64, "nominal design");
        rows.push(row("evaluated", format!("{nominal}, {met} meet every requirement")));
    }
    rows.extend(status.time.map(|of| row("time", time(of))));
    rows.push(row("sample sets", status.sample_sets.to_string()));
    rows.push(row("program", format!("squama {}", status.program)));
    rows.push(row("goal", format!("sha256 {}", status.goal_sha256)));
    let best = status.best().map_or_else(String::new, |best| best_so_far(status, best));
    let problems = status.problems.iter().map(|problem| [problem.clone()]);
    let problems = titled("problems", &problems.collect::<Vec<_>>());
    format!("{}: {state}\n{}{best}{problems}", status.goal, aligned(&rows))
}

/// Lists variables, objectives and requirements of the evaluated design with the index `best`.
fn best_so_far(status: &SearchStatus, best: usize) -> String {
    let (Some(goal), best) = (&status.definition, &status.evaluations[best]) else {
        return String::new();
    };
    let mut rows = Vec::new();
    for (parameter, value) in goal.space.parameters().zip(&best.variables) {
        rows.extend(value.map(|v| [parameter.key.to_owned(), digits(v), String::new()]));
    }
    let (objectives, required) = best.values.split_at(goal.objectives.len());
    for (objective, value) in goal.objectives.iter().zip(objectives) {
        rows.push([objective.column.to_string(), digits(*value), String::new()]);
    }
    for (requirement, value) in goal.requirements.iter().zip(required) {
        let limit = limit_text(requirement, Some(*value));
        rows.push([requirement.column.clone(), digits(*value), limit]);
    }
    let title = if best.is_met { "best so far" } else { "nearest so far" };
    titled(title, &rows)
}

/// Returns the evaluated design with the index `best` as JSON.
fn best_record(status: &SearchStatus, best: usize) -> Value {
    let best = &status.evaluations[best];
    let Some(goal) = &status.definition else { return Value::Null };
    let names = goal.space.parameters().map(|parameter| parameter.key);
    let variables: serde_json::Map<_, _> =
        names.zip(&best.variables).map(|(name, value)| (name.to_owned(), json!(value))).collect();
    let values: serde_json::Map<_, _> =
        goal.columns().zip(&best.values).map(|(name, v)| (name.to_owned(), json!(v))).collect();
    json!({ "met": best.is_met, "variables": variables, "values": values })
}

/// Formats the status of a run.
fn report(status: &run::RunStatus) -> String {
    let header = status.archive.header();
    let subset = header.subset().to_string();
    let mut rows = vec![
        row("designs", format!("{}, {subset}", status.archive.designs().len())),
        row("done", format!("{}{}", status.archive.done(), rerun_count(status))),
        row("failed", status.failed.to_string()),
        row("running", status.running().to_string()),
        row("missing", status.missing().to_string()),
    ];
    rows.extend(rate(status).map(|rate| row("rate", rate)));
    rows.push(row("sessions", status.archive.sessions().len().to_string()));
    rows.push(row("program", format!("squama {}", header.program())));
    rows.push(row("definition", format!("sha256 {}", header.definition_sha256())));
    let state = if status.in_use { "running" } else { "not running" };
    let name = status.archive.sweep().name();
    let lists = [problems(status), outdated(status), reasons(status), slowest(status)].concat();
    format!("{name}: {state}\n{}{lists}", aligned(&rows))
}

/// Lists the problems of the files of the run.
fn problems(status: &run::RunStatus) -> String {
    let rows = status.problems.iter().map(|problem| [problem.clone()]);
    titled("problems", &rows.collect::<Vec<_>>())
}

/// Lists the figures and rankings that are out of date, and the commands that update them.
fn outdated(status: &run::RunStatus) -> String {
    let rows = status.outdated.iter().map(|made| [made.product.clone(), made.command.clone()]);
    titled("out of date", &rows.collect::<Vec<_>>())
}

fn as_json(status: &run::RunStatus) -> Value {
    let (archive, header) = (&status.archive, status.archive.header());
    json!({
        "sweep": archive.sweep().name(),
        "is_running": status.in_use,
        "designs": archive.designs().len(),
        "subset": header.subset().to_string(),
        "done": archive.done(),
        "solved_again": status.solved_again,
        "failed": status.failed,
        "running": status.running(),
        "missing": status.missing(),
        "designs_per_second": status.rate(),
        "sessions": archive.sessions().len(),
        "program": header.program(),
        "definition_sha256": header.definition_sha256(),
        "failures": status.reasons.iter().map(|((measure, reason), count)| json!({
            "measure": measure, "reason": reason, "designs": count,
        })).collect::<Vec<_>>(),
        "slowest": status.slowest.iter().map(|(seconds, number)| json!({
            "design": number.to_string(), "seconds": seconds,
        })).collect::<Vec<_>>(),
        "problems": status.problems,
        "out_of_date": status.outdated.iter().map(|made| json!({
            "product": made.product, "command": made.command,
        })).collect::<Vec<_>>(),
    })
}

fn row(what: &str, value: String) -> [String; 2] {
    [what.to_owned(), value]
}

/// States how many designs `squama rerun` solved again; an empty text if there are none.
fn rerun_count(status: &run::RunStatus) -> String {
    match status.solved_again {
        0 => String::new(),
        count => format!(", {count} of them solved again"),
    }
}

/// Formats the rate of the last session, in designs per second, and the remaining time.
fn rate(status: &run::RunStatus) -> Option<String> {
    let rate = status.rate()?;
    let remaining = (status.running() + status.missing()) as f64 / rate;
    // At a rate of zero the remaining time is infinite, which a `Duration` cannot represent.
    let remaining = match Duration::try_from_secs_f64(remaining) {
        Ok(time_left) if !time_left.is_zero() => format!(", {} for the rest", time(time_left)),
        _ => String::new(),
    };
    Some(format!("{rate:.1} designs/s{remaining}"))
}

fn reasons(status: &run::RunStatus) -> String {
    let rows = status.reasons.iter().map(|((measure, reason), count)| {
        [(*measure).to_owned(), (*reason).to_owned(), counted(*count, "design")]
    });
    titled("why designs failed", &rows.collect::<Vec<_>>())
}

fn slowest(status: &run::RunStatus) -> String {
    let row =
        |(seconds, number): &(f64, DesignNumber)| [number.to_string(), format!("{seconds:.3} s")];
    titled("slowest designs", &status.slowest.iter().map(row).collect::<Vec<_>>())
}

/// Formats a table below its title; the text is empty if there are no rows.
fn titled<const N: usize>(title: &str, rows: &[[String; N]]) -> String {
    if rows.is_empty() { String::new() } else { format!("{title}\n{}", aligned(rows)) }
}
