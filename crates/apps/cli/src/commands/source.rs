//! Finds and reads definitions and results folders.
//!
//! Most commands accept a definition or a results folder. A command that needs a definition reads
//! the record in the results folder. A command that needs results uses the folder of the
//! definition.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use anyhow::{bail, ensure};
use clap::Args;
use optimisation::DesignGoal;
use results::{Completeness, ResultsFolder, VerifiedFolder, verify_record};
use sweep::{InvalidSetting, Setting, Sweep, entries, read_text};

use crate::print::{note, warning};

/// The option `--partial`.
#[derive(Debug, Args)]
pub struct Partial {
    /// Use an incomplete run; outputs state the number of designs
    #[arg(long)]
    pub partial: bool,
}

impl Partial {
    /// Returns the completeness that results must have.
    pub fn completeness(&self) -> Completeness {
        if self.partial { Completeness::Partial } else { Completeness::Whole }
    }
}

/// A definition, and settings that override its keys.
#[derive(Debug, Args)]
pub struct Definition {
    /// Definition of a sweep in TOML, or a results folder
    #[arg(value_name = "SWEEP.toml")]
    pub path: PathBuf,

    /// Set a key of the definition, e.g. puncture.scales=41 (may be repeated)
    ///
    /// The key is dotted, the value is TOML; a single word needs no quotes. A parameter under
    /// `designs` becomes an axis of the grid, e.g. `designs.width_over_t=[1,2]`.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,
}

/// Parses the settings that override keys of a definition.
pub fn settings(texts: &[String]) -> Result<Vec<Setting>, InvalidSetting> {
    texts.iter().map(|text| Setting::parse(text)).collect()
}

/// A parsed definition.
pub enum Defined {
    Sweep(Box<Sweep>),
    Goal(Box<DesignGoal>),
}

/// Message of the error if a goal is given instead of a sweep.
pub const IS_GOAL: &str = "has a [goal], which defines no single design; run squama optimise, then use optimum.toml in its folder";

/// Reads a definition, or the definition in a results folder, and applies its settings.
pub fn defined(definition: &Definition) -> anyhow::Result<Defined> {
    let settings = settings(&definition.settings)?;
    let file = definition_file(&definition.path)?;
    defined_by(&read_text(&file)?, &file, &settings)
}

/// Parses the `text` of the definition `file` and applies `settings`.
pub fn defined_by(text: &str, file: &Path, settings: &[Setting]) -> anyhow::Result<Defined> {
    let name = file.display().to_string();
    let entries = entries(text, &name, settings)?;
    let is_fit = entries.iter().any(|entry| entry.key == "curve");
    ensure!(!is_fit, "{name}: has a [[curve]]: it is a definition for squama fit");
    if entries.iter().any(|entry| entry.key == "goal") {
        return Ok(Defined::Goal(Box::new(DesignGoal::of_entries(&entries, &name)?)));
    }
    Ok(Defined::Sweep(Box::new(Sweep::of_entries(&entries, &name)?)))
}

/// Reads a sweep, applies its settings and prints notes; a goal is an error.
pub fn read(definition: &Definition) -> anyhow::Result<Sweep> {
    match defined(definition)? {
        Defined::Sweep(sweep) => {
            print_notes(&sweep);
            Ok(*sweep)
        }
        Defined::Goal(_) => bail!("{}: {IS_GOAL}", definition.path.display()),
    }
}

/// Prints notes on doubtful values in a valid definition.
pub fn print_notes(sweep: &Sweep) {
    for text in sweep.notes() {
        note(&text);
    }
}

/// Returns the file that contains the definition.
///
/// The file is `path` itself, or the record or optimum in the results folder `path`. The checksum
/// of a file that squama wrote is verified.
pub fn definition_file(path: &Path) -> anyhow::Result<PathBuf> {
    if !path.is_dir() {
        // Reject a run.toml that was edited.
        verify_record(path)?;
        return Ok(path.to_owned());
    }
    let record = path.join(ResultsFolder::RUN_INFO);
    let optimum = path.join("optimum.toml");
    if !record.is_file() && optimum.is_file() {
        // Reject an optimum.toml that was edited.
        VerifiedFolder::open(path, Completeness::Partial)?.file("optimum.toml")?;
        return Ok(optimum);
    }
    let folder = path.display();
    ensure!(
        !path.join("front.csv").is_file(),
        "{folder}: holds a Pareto front; choose one design of it with --design, in squama design, draw or make"
    );
    ensure!(
        !path.join("tolerance.csv").is_file() && !path.join("sobol.csv").is_file(),
        "{folder}: holds an analysis and no designs; give the definition or the results folder of the run"
    );
    ensure!(
        record.is_file(),
        "{folder}: holds no {}, expected a definition in TOML or a results folder",
        ResultsFolder::RUN_INFO
    );
    verify_record(&record)?;
    Ok(record)
}

/// Returns the results folder that `path` refers to.
///
/// `path` is the folder itself, the record in the folder, or the definition of the run.
pub fn results_folder(path: &Path) -> anyhow::Result<PathBuf> {
    if !path.is_file() {
        // Do not check that the folder exists: opening its files reports a better error.
        refuse_folder_of_runs(path)?;
        return Ok(path.to_owned());
    }
    if path.ends_with(ResultsFolder::RUN_INFO) {
        return Ok(path.parent().map_or_else(PathBuf::new, Path::to_owned));
    }
    let folder = folder_of(&Sweep::read(path, &[])?, None);
    ensure!(
        folder.is_dir(),
        "{}: there are no results in {}; squama run {0} writes them",
        path.display(),
        folder.display()
    );
    Ok(folder)
}

/// Returns true if `folder` holds a finished run or a run in progress.
fn is_run(folder: &Path) -> bool {
    // A run in progress has a journal but no record.
    let files = [ResultsFolder::RUN_INFO, ResultsFolder::JOURNAL];
    files.iter().any(|file| folder.join(file).is_file())
}

/// Rejects a folder that holds a search, an analysis or folders of runs, but no run itself.
fn refuse_folder_of_runs(path: &Path) -> anyhow::Result<()> {
    if is_run(path) {
        return Ok(());
    }
    let folders = fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    let runs = folders.filter(|folder| is_run(folder));
    let mut names: Vec<_> =
        runs.filter_map(|run| Some(run.file_name()?.to_string_lossy().into_owned())).collect();
    // Sort the names, because `read_dir` returns them in arbitrary order.
    names.sort();
    let folder = path.display();
    ensure!(
        !path.join("history.csv").is_file(),
        "{folder}: holds a search, not a run; use squama export, or squama report {folder}; its figures are in the folder"
    );
    let is_analysis = ["tolerance.csv", "sobol.csv", "fit.csv"].map(|table| path.join(table));
    ensure!(
        !is_analysis.iter().any(|table| table.is_file()),
        "{folder}: holds an analysis, not a run; use squama export; its figures are in the folder"
    );
    ensure!(
        names.is_empty(),
        "{folder} holds no run itself; give one of the runs in it: {}",
        names.join(", ")
    );
    Ok(())
}

/// Opens and verifies the results folder that `path` refers to; see [`results_folder`].
pub fn verified_folder(path: &Path, completeness: Completeness) -> anyhow::Result<VerifiedFolder> {
    Ok(VerifiedFolder::open(&results_folder(path)?, completeness)?.warning(warn_once))
}

/// Prints each warning only once, although several steps of a command read the same table.
fn warn_once(text: &str) {
    static PRINTED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    if PRINTED.lock().is_ok_and(|mut printed| printed.insert(text.to_owned())) {
        warning(text);
    }
}

/// Returns the results folder of `sweep`: `out`, or by default `results/NAME`.
pub fn folder_of(sweep: &Sweep, out: Option<&Path>) -> PathBuf {
    out.map_or_else(|| Path::new("results").join(sweep.name()), Path::to_owned)
}

/// Returns the default folder for figures or tables of designs.
///
/// This is `subfolder` in the results folder of the sweep.
pub fn folder_within(definition: &Definition, sweep: &Sweep, subfolder: &str) -> PathBuf {
    let path = &definition.path;
    let results = if path.is_dir() { path.clone() } else { folder_of(sweep, None) };
    results.join(subfolder)
}

/// Returns an error if the folder of `file` does not exist, because the path is probably mistyped.
///
/// `option` is the name of the argument, for the message.
pub fn require_folder_of(option: &str, file: &Path) -> anyhow::Result<()> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    ensure!(
        folder.is_dir(),
        "{option} {}: there is no folder {}",
        file.display(),
        folder.display()
    );
    Ok(())
}
