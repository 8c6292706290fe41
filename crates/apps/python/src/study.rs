//! Runs, rankings, searches and tolerance analyses in folders, with the crates of the commands.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use ::run::{Options, Program, Start};
use ::uncertainty::{
    Analysis, AnalysisError, DesignTolerance, SOURCE_COLUMNS, SampleStore, TOLERANCE_COLUMNS,
    YIELD_COLUMNS,
};
use optimisation::{
    Answer, DesignGoal, FRONT, OPTIMUM, OPTIMUM_DEFINITION, SearchOptions, write_found,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use ranking::{Criterion, Goal, Preferences, Ranking, TetrahedralGrid, Weights, ranking_columns};
use rayon::prelude::*;
use results::{Completeness, Results, ResultsFolder, VerifiedFolder};
use sweep::{Setting, Subset, Sweep};

use crate::error::{self, OrFailed as _};
use crate::skin::Skin;
use crate::value::{Cells, NamedCells, requirements, table, text, value};
use crate::work::{interrupted, pool, threads as threads_of, watched, whole};

/// This program, recorded in results folders.
const PROGRAM: Program =
    Program { version: env!("CARGO_PKG_VERSION"), revision: env!("SQUAMA_REVISION") };

/// The accepted numbers of samples, as for `squama tolerance`.
const SAMPLES: RangeInclusive<usize> = 0..=1_000_000;

/// Interval between updates of the tables during a run.
const TABLES_EVERY: Duration = Duration::from_secs(30);

/// Keywords shared by the functions of studies.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Keywords<'py> {
    /// The results folder; `None` for `results/NAME`.
    out: Option<PathBuf>,
    /// Settings that override the definition: dotted keys and values.
    set: Option<Bound<'py, PyDict>>,
    /// True to continue earlier results.
    resume: bool,
    /// True to discard earlier results.
    fresh: bool,
    threads: Option<Bound<'py, PyAny>>,
    progress: Option<Bound<'py, PyAny>>,
}

impl Keywords<'_> {
    fn settings(&self) -> PyResult<Vec<Setting>> {
        self.set
            .iter()
            .flatten()
            .map(|(key, of)| {
                let key = text(&key)?;
                let text = format!("{key}={}", value(&of)?);
                let expected = "a dotted key with a value, such as {\"puncture.scales\": 41}";
                Setting::parse(&text).map_err(|_| {
                    error::invalid_parameter(of.py(), &key, Some(of.clone()), expected)
                })
            })
            .collect()
    }

    /// Returns the results folder, with the same default as the command.
    fn folder(&self, sweep: &Sweep) -> PathBuf {
        self.out.clone().unwrap_or_else(|| Path::new("results").join(sweep.name()))
    }

    /// Returns the treatment of earlier results.
    fn start(&self) -> Start {
        match (self.resume, self.fresh) {
            (true, _) => Start::Resume,
            (_, true) => Start::Fresh,
            _ => Start::New,
        }
    }
}

/// Solves the designs of a definition, writes the results to a folder, and returns the folder.
#[pyfunction]
pub fn run(
    py: Python<'_>,
    definition: &Bound<'_, PyAny>,
    keywords: Keywords<'_>,
) -> PyResult<PathBuf> {
    let sweep = Skin::definition(py, definition, &keywords.settings()?)?;
    let (folder, start) = (keywords.folder(&sweep), keywords.start());
    let (place, threads) = (folder.clone(), threads_of(keywords.threads.as_ref())?);
    let finished = watched(py, keywords.progress, move |watch| {
        let options = Options {
            threads,
            format: None,
            fail_fast: false,
            tables_every: TABLES_EVERY,
            stop: &watch.stop,
            work: &watch.run,
        };
        ::run::run(&sweep, Subset::default(), &place, start, &options, &PROGRAM, |progress| {
            watch.update(progress);
        })
    })?;
    // Failed designs are results; only an interrupt leaves designs missing.
    if finished.or_failed("run")?.missing > 0 { Err(interrupted()) } else { Ok(folder) }
}

/// Reads and verifies the results in a folder.
fn results(folder: &Path, file: &'static str) -> PyResult<Results> {
    let verified = VerifiedFolder::open(folder, Completeness::Whole).or_failed("read")?;
    Results::of_file(&verified, file).or_failed("read")
}

/// Returns names and cells of the columns in the table of designs of a folder.
#[pyfunction]
pub fn read(py: Python<'_>, folder: PathBuf) -> PyResult<Vec<(String, Py<PyAny>)>> {
    let columns = watched(py, None, move |watch| {
        let files = [ResultsFolder::DESIGNS, OPTIMUM, FRONT];
        let file = files.into_iter().find(|file| folder.join(file).is_file());
        let results = results(&folder, file.unwrap_or(ResultsFolder::DESIGNS))?;
        let mut columns = Vec::new();
        for (column, name) in results.header().iter().enumerate() {
            if watch.stop.load(Ordering::Relaxed) {
                break;
            }
            let cells = (0..results.len()).map(|row| results.text(row, column).into_owned());
            let cells = match name.as_str() {
                "design" => Cells::text_column(cells.collect()),
                _ => Cells::of_texts(cells.collect()),
            };
            columns.push((name.clone(), cells));
        }
        Ok::<_, PyErr>(columns)
    })??;
    let mut converted = Vec::with_capacity(columns.len());
    for (name, cells) in columns {
        converted.push((name, cells.into_pyobject(py)?.unbind()));
        // Release the interpreter lock after each column: a million designs take seconds.
        py.detach(thread::yield_now);
    }
    Ok(converted)
}

/// Ranks the designs of a run that meet requirements, by fitness.
#[pyfunction]
#[pyo3(signature = (folder, require, maximize, minimize, weights))]
pub fn rank(
    folder: PathBuf,
    require: Vec<String>,
    maximize: Vec<String>,
    minimize: Vec<String>,
    weights: Option<Vec<f64>>,
) -> PyResult<Vec<NamedCells>> {
    let requirements = requirements(&require)?;
    let goals = [(Goal::Maximize, maximize), (Goal::Minimize, minimize)];
    let criteria = goals.into_iter().flat_map(|(goal, columns)| {
        columns.into_iter().map(move |column| Criterion::new(&column, goal))
    });
    let criteria: Vec<_> = criteria.collect();
    let results = results(&folder, ResultsFolder::DESIGNS)?;
    let criteria =
        if criteria.is_empty() { Criterion::usual(results.definition()) } else { criteria };
    let weights = weights.map(|of| Weights::new(&of)).transpose().or_failed("rank")?;
    let preferences = Preferences::new(requirements, criteria, weights, ranking::Scale::Paper);
    let preferences = preferences.or_failed("rank")?;
    ranking::check_comparable(&results, &preferences).or_failed("rank")?;
    let ranking = Ranking::by(&results, preferences, TetrahedralGrid::default());
    let ranking = ranking.or_failed("rank")?;
    let parameters: Vec<_> = results.parameters().collect();
    let columns = ranking_columns(&parameters, ranking.preferences());
    Ok(table(&columns, ranking.by_fitness(ranking.preferences().weights)))
}

/// Searches for the best designs of a goal.
///
/// Returns the folder and, for a single objective, the definition of the best design and the checks
/// that it fails.
#[pyfunction]
pub fn optimise(
    py: Python<'_>,
    goal: PathBuf,
    keywords: Keywords<'_>,
) -> PyResult<(PathBuf, Option<PathBuf>, Vec<String>)> {
    let goal = DesignGoal::read(&goal, &keywords.settings()?).or_failed("optimise")?;
    let (folder, start) = (keywords.folder(goal.space.sweep()), keywords.start());
    let (place, threads) = (folder.clone(), threads_of(keywords.threads.as_ref())?);
    let searched = watched(py, keywords.progress, move |watch| {
        let options = SearchOptions { threads, start, stop: &watch.stop, progress: &watch.search };
        let found = optimisation::optimise(&goal, &place, &options, &PROGRAM);
        let Some(found) = found.or_failed("optimise")? else { return Err(interrupted()) };
        let folder = ResultsFolder::new(&place);
        let written = write_found(&folder, &goal, &found, &[], folder.csv_format());
        let failed_checks = match &found.answer {
            Answer::Optimum(best) => best.contradictions(&goal),
            Answer::Front(_) | Answer::Infeasible(_) => Vec::new(),
        };
        let failed_checks = failed_checks.iter().map(ToString::to_string).collect();
        written.or_failed("optimise").map(|_| (found.answer, failed_checks))
    })?;
    let (answer, failed_checks) = searched?;
    match answer {
        Answer::Optimum(_) => {
            let best = folder.join(OPTIMUM_DEFINITION);
            Ok((folder, Some(best), failed_checks))
        }
        Answer::Front(_) => Ok((folder, None, failed_checks)),
        Answer::Infeasible(_) => Err(error::failed("optimise", "no design meets the constraints")),
    }
}

/// Predicts and samples the effect of the deviations in a definition.
///
/// Returns the columns of the spread of every measure, of its sources, and of the yields. Samples
/// are stored in the folder.
#[pyfunction]
pub fn tolerance(
    py: Python<'_>,
    definition: &Bound<'_, PyAny>,
    require: Vec<String>,
    samples: &Bound<'_, PyAny>,
    keywords: Keywords<'_>,
) -> PyResult<[Vec<NamedCells>; 3]> {
    let sweep = Skin::definition(py, definition, &keywords.settings()?)?;
    if sweep.deviations().is_empty() && !sweep.is_imperfect() {
        let expected = "a definition with deviations, or such as set={\"tolerance.gap_over_t\": {\"batch_sd\": 0.02}}";
        return Err(error::invalid_parameter(py, "tolerance", None, expected));
    }
    let samples = whole("samples", samples, SAMPLES)?;
    let requirements = requirements(&require)?;
    let store = SampleStore::new(&keywords.folder(&sweep));
    let pool = pool(keywords.threads.as_ref())?;
    let analysed = watched(py, keywords.progress, move |watch| {
        let analysis = Analysis::new(&sweep, &requirements, samples, PROGRAM, &watch.stop);
        pool.install(|| -> Result<Vec<DesignTolerance>, AnalysisError> {
            (0..sweep.grid().len())
                .into_par_iter()
                .map(|index| analysis.design(index, &store))
                .collect()
        })
    })?;
    let all = analysed.map_err(|error| match error {
        AnalysisError::Stopped { .. } => interrupted(),
        error => error::failed("tolerance", &error.to_string()),
    })?;
    Ok([
        table(TOLERANCE_COLUMNS, all.iter().flat_map(DesignTolerance::measure_rows)),
        table(SOURCE_COLUMNS, all.iter().flat_map(DesignTolerance::source_rows)),
        table(YIELD_COLUMNS, all.iter().flat_map(DesignTolerance::yield_rows)),
    ])
}
