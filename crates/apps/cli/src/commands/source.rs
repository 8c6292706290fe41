//! A definition and the folder of its results: whichever of the two is given, the other is found.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{bail, ensure};
use clap::Args;
use optimisation::DesignGoal;
use results::{Completeness, RunFolder, VerifiedFolder, verify_record};
use sweep::{InvalidSetting, Setting, Sweep, entries, read_text};

use crate::print::note;

/// Whether results are used that are not whole.
#[derive(Debug, Args)]
pub struct Partial {
    /// Use an incomplete run; outputs state how many designs they are made from
    #[arg(long)]
    pub partial: bool,
}

impl Partial {
    /// The results that will do.
    pub fn completeness(&self) -> Completeness {
        if self.partial { Completeness::Partial } else { Completeness::Whole }
    }
}

/// A definition and what is put in its place.
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

/// The settings that take the place of what a definition says.
pub fn settings(texts: &[String]) -> Result<Vec<Setting>, InvalidSetting> {
    texts.iter().map(|text| Setting::parse(text)).collect()
}

/// What a definition defines.
pub enum Defined {
    Sweep(Box<Sweep>),
    Goal(Box<DesignGoal>),
}

/// What is said where a sweep is asked for and a goal is given.
pub const IS_GOAL: &str = "has a [goal]: squama optimise searches for its best design, whose folder has one in optimum.toml";

/// What is defined, with its settings.
pub fn defined(definition: &Definition) -> anyhow::Result<Defined> {
    let settings = settings(&definition.settings)?;
    let file = definition_file(&definition.path)?;
    defined_by(&read_text(&file)?, &file, &settings)
}

/// What the `text` of a file defines.
pub fn defined_by(text: &str, file: &Path, settings: &[Setting]) -> anyhow::Result<Defined> {
    let name = file.display().to_string();
    let entries = entries(text, &name, settings)?;
    let is_fit = entries.iter().any(|entry| entry.key == "curve");
    ensure!(!is_fit, "{name}: has a [[curve]]: squama fit looks for the skin behind it");
    if entries.iter().any(|entry| entry.key == "goal") {
        return Ok(Defined::Goal(Box::new(DesignGoal::of_entries(&entries, &name)?)));
    }
    Ok(Defined::Sweep(Box::new(Sweep::of_entries(&entries, &name)?)))
}

/// The sweep that is defined, with its settings.
pub fn read(definition: &Definition) -> anyhow::Result<Sweep> {
    match defined(definition)? {
        Defined::Sweep(sweep) => {
            question(&sweep);
            Ok(*sweep)
        }
        Defined::Goal(_) => bail!("{}: {IS_GOAL}", definition.path.display()),
    }
}

/// Says what is strange about a definition though it is valid.
pub fn question(sweep: &Sweep) {
    if let Some(question) = sweep.question() {
        note(&question);
    }
}

/// The file of the definition, which is as it was written if a run has written it: `path`, or in the folder `path` the record of the run
/// or the optimum of the search.
pub fn definition_file(path: &Path) -> anyhow::Result<PathBuf> {
    if !path.is_dir() {
        // A run.toml that was edited is no longer the record of its run.
        verify_record(path)?;
        return Ok(path.to_owned());
    }
    let record = path.join(RunFolder::RUN_INFO);
    let optimum = path.join("optimum.toml");
    if !record.is_file() && optimum.is_file() {
        // Opened for the check alone: an optimum that somebody has changed is refused.
        VerifiedFolder::open(path, Completeness::Partial)?.file("optimum.toml")?;
        return Ok(optimum);
    }
    let holds = |table: &str| path.join(table).is_file();
    let folder = path.display();
    ensure!(
        !holds("front.csv"),
        "{folder}: holds a Pareto front and no single design; squama design, draw and make take one of them with --design"
    );
    ensure!(
        !holds("tolerance.csv") && !holds("sobol.csv"),
        "{folder}: holds an analysis of designs and none itself; give the definition or the results folder that it was made from"
    );
    ensure!(
        record.is_file(),
        "{folder}: holds no {}, expected a definition in TOML or a results folder",
        RunFolder::RUN_INFO
    );
    verify_record(&record)?;
    Ok(record)
}

/// The folder of results: `path`, the folder of the record `path`, or that of the sweep that `path` defines.
pub fn results_folder(path: &Path) -> anyhow::Result<PathBuf> {
    if !path.is_file() {
        // A folder that does not exist is refused where its files are opened, by the name of what is missing.
        refuse_folder_of_runs(path)?;
        return Ok(path.to_owned());
    }
    if path.ends_with(RunFolder::RUN_INFO) {
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

/// Refuses a folder that holds runs but is none, and names them.
fn refuse_folder_of_runs(path: &Path) -> anyhow::Result<()> {
    // A run that has only begun has a journal, but no record yet.
    let is_run = |folder: &Path| {
        [RunFolder::RUN_INFO, RunFolder::JOURNAL].iter().any(|file| folder.join(file).is_file())
    };
    if is_run(path) {
        return Ok(());
    }
    let folders = fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    let runs = folders.filter(|folder| is_run(folder));
    let mut names: Vec<_> =
        runs.filter_map(|run| Some(run.file_name()?.to_string_lossy().into_owned())).collect();
    // The disk lists folders in any order.
    names.sort();
    let folder = path.display();
    ensure!(
        !path.join("history.csv").is_file(),
        "{folder}: holds a search; squama export takes it, and squama report RESULTS --front {folder} shows it beside the designs of a sweep; its own figures stand in it"
    );
    let is_analysis = ["tolerance.csv", "sobol.csv", "fit.csv"].map(|table| path.join(table));
    ensure!(
        !is_analysis.iter().any(|table| table.is_file()),
        "{folder}: holds an analysis; squama export takes it, and its own figures stand in it"
    );
    ensure!(names.is_empty(), "{folder} holds no run; the runs in it are {}", names.join(", "));
    Ok(())
}

/// The results in the folder that `path` stands for, once they are checked.
pub fn verified_folder(path: &Path, completeness: Completeness) -> anyhow::Result<VerifiedFolder> {
    Ok(VerifiedFolder::open(&results_folder(path)?, completeness)?)
}

/// The folder of the results of `sweep` unless told otherwise.
pub fn folder_of(sweep: &Sweep, out: Option<&Path>) -> PathBuf {
    out.map_or_else(|| Path::new("results").join(sweep.name()), Path::to_owned)
}

/// The folder of what is made of some designs, named `what`, unless told otherwise: within the results of their sweep.
pub fn folder_within(definition: &Definition, sweep: &Sweep, what: &str) -> PathBuf {
    let path = &definition.path;
    let results = if path.is_dir() { path.clone() } else { folder_of(sweep, None) };
    results.join(what)
}

/// Refuses a file in a folder that does not exist: a mistyped path makes no folders.
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
