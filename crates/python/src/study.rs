//! Runs, searches and tolerances in folders: calls of the crates behind the commands.

use std::path::{Path, PathBuf};
use std::time::Duration;

use ::run::{Options, Program, Start};
use ::tolerance::{
    Analysis, DesignMeasureTolerance, DesignSource, DesignTolerance, DesignYield, NoAnalysis,
    SOURCE_COLUMNS, SampleStore, TOLERANCE_COLUMNS, YIELD_COLUMNS,
};
use optimisation::{
    Answer, DesignGoal, FRONT, OPTIMUM, OPTIMUM_DEFINITION, SearchOptions, write_found,
};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use ranking::{
    Criterion, Goal, Preferences, Ranking, Requirement, TetrahedralGrid, Weights, ranking_columns,
};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use results::{Completeness, CsvFormat, Results, RunFolder, VerifiedFolder};
use sweep::{Setting, Subset};

use crate::error;
use crate::skin::Skin;
use crate::value::{Array, arrays, text, value};
use crate::work::{threads as threads_of, watched};

/// This program, which a run notes in its folder.
const PROGRAM: Program =
    Program { version: env!("CARGO_PKG_VERSION"), revision: env!("SQUAMA_REVISION") };

/// How often the tables are written while a run goes on.
const TABLES_EVERY: Duration = Duration::from_secs(30);

/// The settings in place of what a definition says: dotted keys and their values.
fn settings(given: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<Setting>> {
    let setting = |(key, of): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let key = text(&key)?;
        let text = format!("{key}={}", value(&of)?);
        let expected = "a dotted key with a value, such as {\"puncture.scales\": 41}";
        let wrong = |_| error::invalid_parameter(of.py(), &key, Some(of.clone()), expected);
        Setting::parse(&text).map_err(wrong)
    };
    given.into_iter().flatten().map(setting).collect()
}

/// What becomes of earlier results.
fn start(resume: bool, fresh: bool) -> Start {
    match (resume, fresh) {
        (true, _) => Start::Resume,
        (_, true) => Start::Fresh,
        _ => Start::New,
    }
}

fn interrupted() -> PyErr {
    PyKeyboardInterrupt::new_err(())
}

/// Solves the designs of a definition into a folder, and returns the folder.
#[pyfunction]
#[pyo3(signature = (definition, out=None, set=None, resume=false, fresh=false, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub fn run(
    py: Python<'_>,
    definition: &Bound<'_, PyAny>,
    out: Option<PathBuf>,
    set: Option<&Bound<'_, PyDict>>,
    resume: bool,
    fresh: bool,
    threads: Option<usize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<PathBuf> {
    let sweep = Skin::definition(py, definition, &settings(set)?)?;
    let folder = out.unwrap_or_else(|| Path::new("results").join(sweep.name()));
    let place = folder.clone();
    let finished = watched(py, progress, move |watch| {
        let options = Options {
            threads: threads_of(threads),
            format: None,
            fail_fast: false,
            tables_every: TABLES_EVERY,
            stop: &watch.stop,
            work: &watch.run,
        };
        let told = |progress| watch.tell(progress);
        ::run::run(
            &sweep,
            Subset::default(),
            &place,
            start(resume, fresh),
            &options,
            &PROGRAM,
            told,
        )
    })?;
    let finished = finished.map_err(|error| error::of(py, "run", &error))?;
    if finished.missing > 0 { Err(interrupted()) } else { Ok(folder) }
}

/// The results in a folder, once they are checked.
fn results(py: Python<'_>, folder: &Path, file: &'static str) -> PyResult<Results> {
    let verified = VerifiedFolder::open(folder, Completeness::Whole);
    let verified = verified.map_err(|error| error::of(py, "read", &error))?;
    Results::of_file(&verified, file).map_err(|error| error::of(py, "read", &error))
}

/// The table of designs in a folder: names and cells of its columns.
#[pyfunction]
pub fn read(py: Python<'_>, folder: PathBuf) -> PyResult<Vec<(String, Vec<String>)>> {
    let files = [RunFolder::DESIGNS, OPTIMUM, FRONT];
    let file = files.into_iter().find(|file| folder.join(file).is_file());
    let results = results(py, &folder, file.unwrap_or(RunFolder::DESIGNS))?;
    let cells =
        |column| (0..results.len()).map(|row| results.text(row, column).to_owned()).collect();
    Ok(results.header().iter().cloned().enumerate().map(|(k, name)| (name, cells(k))).collect())
}

/// The designs of a run that meet requirements, by fitness.
#[pyfunction]
#[pyo3(signature = (folder, require, maximize, minimize, weights=None))]
pub fn rank(
    py: Python<'_>,
    folder: PathBuf,
    require: Vec<String>,
    maximize: Vec<String>,
    minimize: Vec<String>,
    weights: Option<Vec<f64>>,
) -> PyResult<Vec<Array<'_>>> {
    let failed = |error: &dyn std::fmt::Display| error::of(py, "rank", &error);
    let requirements = requirements(py, &require)?;
    let goals = [(Goal::Maximize, &maximize), (Goal::Minimize, &minimize)];
    let of = |(goal, columns): (Goal, &Vec<String>)| -> Vec<_> {
        columns.iter().map(|column| Criterion::new(column, goal)).collect()
    };
    let criteria: Vec<_> = goals.into_iter().flat_map(of).collect();
    let criteria = if criteria.is_empty() { ranking::CRITERIA.to_vec() } else { criteria };
    let weights =
        weights.map(|of| Weights::new(&of)).transpose().map_err(|error| failed(&error))?;
    let preferences = Preferences::new(requirements, criteria, weights, ranking::Scale::Paper);
    let preferences = preferences.map_err(|error| failed(&error))?;
    let results = results(py, &folder, RunFolder::DESIGNS)?;
    ranking::check_comparable(&results, &preferences).map_err(|error| failed(&error))?;
    let ranking = Ranking::by(&results, preferences, TetrahedralGrid::default());
    let ranking = ranking.map_err(|error| failed(&error))?;
    let parameters: Vec<_> = results.parameters().collect();
    let columns = ranking_columns(&parameters, ranking.preferences());
    arrays(py, &columns, &ranking.by_fitness(ranking.preferences().weights))
}

fn requirements(py: Python<'_>, texts: &[String]) -> PyResult<Vec<Requirement>> {
    let read = |text: &String| text.parse().map_err(|error| error::of(py, text, &error));
    texts.iter().map(read).collect()
}

/// Searches for the best designs of a goal, and returns the folder and, of one objective, the definition of the best.
#[pyfunction]
#[pyo3(signature = (goal, out=None, set=None, resume=false, fresh=false, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub fn optimise(
    py: Python<'_>,
    goal: PathBuf,
    out: Option<PathBuf>,
    set: Option<&Bound<'_, PyDict>>,
    resume: bool,
    fresh: bool,
    threads: Option<usize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(PathBuf, Option<PathBuf>)> {
    let goal = DesignGoal::read(&goal, &settings(set)?)
        .map_err(|error| error::of(py, "optimise", &error))?;
    let folder = out.unwrap_or_else(|| Path::new("results").join(goal.space.sweep().name()));
    let place = folder.clone();
    let searched = watched(py, progress, move |watch| {
        let options = SearchOptions {
            threads: threads_of(threads),
            start: start(resume, fresh),
            stop: &watch.stop,
            meter: &watch.search,
        };
        let found =
            optimisation::optimise(&goal, &place, &options, &PROGRAM).map_err(|e| e.to_string())?;
        let write = |found| {
            write_found(&RunFolder::new(&place), &goal, &found, &[], CsvFormat::default())
                .map_err(|error| error.to_string())?;
            Ok(found.answer)
        };
        found.map(write).transpose()
    })?;
    match searched.map_err(|reason: String| error::failed(py, "optimise", &reason))? {
        None => Err(interrupted()),
        Some(Answer::Optimum(_)) => Ok((folder.clone(), Some(folder.join(OPTIMUM_DEFINITION)))),
        Some(Answer::Front(_)) => Ok((folder, None)),
        Some(Answer::Infeasible(_)) => {
            Err(error::failed(py, "optimise", "no design meets the constraints"))
        }
    }
}

/// The columns of the spread of every measure, of its sources, and of the yields.
type Tolerances<'py> = (Vec<Array<'py>>, Vec<Array<'py>>, Vec<Array<'py>>);

/// Predicts and samples the effect of the deviations of a definition on its designs; samples are kept in `store`.
#[pyfunction]
#[pyo3(signature = (definition, store, set=None, require=Vec::new(), samples=1000, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "they have names in Python")]
pub fn tolerance<'py>(
    py: Python<'py>,
    definition: &Bound<'py, PyAny>,
    store: PathBuf,
    set: Option<&Bound<'py, PyDict>>,
    require: Vec<String>,
    samples: usize,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Tolerances<'py>> {
    let sweep = Skin::definition(py, definition, &settings(set)?)?;
    if sweep.deviations().is_empty() && !sweep.is_imperfect() {
        let expected = "a definition with deviations, or such as set={\"tolerance.gap_over_t\": {\"batch_sd\": 0.02}}";
        return Err(error::invalid_parameter(py, "tolerance", None, expected));
    }
    let requirements = requirements(py, &require)?;
    let analysed =
        watched(py, progress, move |watch| -> Result<Vec<DesignTolerance>, Option<String>> {
            let pool = ThreadPoolBuilder::new().num_threads(threads_of(threads)).build();
            let analysis = Analysis::new(&sweep, &requirements, samples, PROGRAM, &watch.stop);
            let store = SampleStore::new(&store);
            let analyse = |index| analysis.design(index, &store);
            let all =
                || (0..sweep.grid().len()).into_par_iter().map(analyse).collect::<Result<_, _>>();
            let all = pool.map_err(|error| Some(error.to_string()))?.install(all);
            all.map_err(|error| match error {
                NoAnalysis::Stopped { .. } => None,
                error => Some(error.to_string()),
            })
        })?;
    let all = analysed.map_err(|reason| {
        reason.map_or_else(interrupted, |reason| error::failed(py, "tolerance", &reason))
    })?;
    let mut measures = Vec::new();
    let (mut sources, mut yields) = (Vec::new(), Vec::new());
    for DesignTolerance { nominal, measures: of, yields: met, .. } in all {
        let design = nominal.number;
        for measure in of {
            let named = measure.linear.iter().flat_map(|linear| linear.sources.iter().cloned());
            let row = |source| DesignSource { design, measure: measure.name.clone(), source };
            sources.extend(named.map(row));
            measures.push(DesignMeasureTolerance { design, measure });
        }
        yields.extend(met.into_iter().map(|of| DesignYield { design, of }));
    }
    Ok((
        arrays(py, TOLERANCE_COLUMNS, &measures)?,
        arrays(py, SOURCE_COLUMNS, &sources)?,
        arrays(py, YIELD_COLUMNS, &yields)?,
    ))
}
