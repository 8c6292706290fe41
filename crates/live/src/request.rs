//! What a page asks for, and how it is solved.

use results::columns::design_columns;
use results::{Cell, DesignRow};
use run::Evaluator;
use serde::Deserialize;
use skin::flexure;
use skin::puncture::{self, At};
use substrate::Calibrations;
use sweep::{Case, Measure, Setting, Sweep};

use crate::answer::{Answer, FlexurePath, PuncturePath, Slope, Value};

/// A design that is to be solved.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// The definition of a sweep, in TOML.
    pub definition: String,
    /// Keys that have another value, as in `designs.gap_over_t=0.2`. The first design of what this makes of the definition is solved.
    #[serde(default)]
    pub set: Vec<String>,
    /// What is to be measured; empty for what the definition measures.
    #[serde(default)]
    pub measures: Vec<Measure>,
    /// The states along each path that are to be drawn, without the state at rest.
    #[serde(default)]
    pub frames: u16,
    /// A number that the answer repeats, so that a page knows which request it answers.
    #[serde(default)]
    pub id: u64,
}

/// Answers requests one after the other.
#[derive(Debug, Default)]
pub struct Solver {
    /// The evaluator of the last request, whose calibrations the next one finds if it measures the same.
    evaluator: Option<(Vec<Measure>, Evaluator)>,
    calibrations: Calibrations,
}

impl Solver {
    /// The answer to `request`, both JSON. What is wrong with a request is an answer, too: `{"error": "…"}`.
    pub fn answer(&mut self, request: &str) -> String {
        let answer = serde_json::from_str(request)
            .map_err(|error| format!("the request: {error}"))
            .and_then(|request: Request| self.solve(&request));
        let answer = answer.map_or_else(|error| serde_json::json!({ "error": error }), |answer| {
            serde_json::to_value(answer).unwrap_or_default()
        });
        answer.to_string()
    }

    /// Solves the first design of a request.
    ///
    /// # Errors
    /// If the definition or a setting is refused: with the text that the command has for it.
    pub fn solve(&mut self, request: &Request) -> Result<Answer, String> {
        let sweep = sweep_of(request)?;
        let measures =
            if request.measures.is_empty() { sweep.measures() } else { &request.measures };
        let (case, number) = (sweep.grid().case(0), sweep.grid().number(0));
        let solved = self.evaluator(measures).solve(number, &case);
        let frames = usize::from(request.frames);
        let puncture = solved.puncture.as_ref().map(|path| {
            let at = places(path.path.iter().map(|point| point.tilt_deg), frames, At::Tilt);
            PuncturePath::new(&case, path, self.row_states(&case, &at))
        });
        let flexure = solved.flexure.as_ref().map(|path| {
            let at = places(path.path.iter().map(|point| point.end_rotation_deg), frames, |at| at);
            FlexurePath::new(path, strip_states(&case, &at))
        });
        Ok(Answer {
            id: request.id,
            values: values(&sweep, &solved.row),
            puncture,
            flexure,
            slopes: solved.row.result.sensitivity.iter().map(Slope::new).collect(),
        })
    }

    fn evaluator(&mut self, measures: &[Measure]) -> &Evaluator {
        if self.evaluator.as_ref().is_none_or(|(others, _)| others != measures) {
            self.evaluator = None;
        }
        let evaluator = || (measures.to_vec(), Evaluator::new(measures));
        &self.evaluator.get_or_insert_with(evaluator).1
    }

    /// The states of a row at `at`; none of a row that has no springs, whose measures say why.
    fn row_states(&self, case: &Case, at: &[At]) -> Vec<puncture::RowSnapshot> {
        let springs =
            case.footprint().ok().and_then(|foot| self.calibrations.row(&foot, case.coupling).ok());
        let solve =
            |springs: &substrate::RowStiffness| puncture::snapshots(&case.design, springs, &case.common, &case.puncture, at);
        let states = springs.filter(|_| !at.is_empty()).and_then(|springs| solve(&springs).ok());
        states.map_or_else(Vec::new, |states| states.at.into_iter().flatten().collect())
    }
}

/// The states of a strip at the end rotations `at`.
fn strip_states(case: &Case, at: &[f64]) -> Vec<flexure::StripSnapshot> {
    if at.is_empty() {
        return Vec::new();
    }
    let states = flexure::snapshots(&case.design, &case.common, &case.flexure, at);
    states.map_or_else(|_| Vec::new(), |states| states.into_iter().flatten().collect())
}

/// `count` equal parts of the way to the largest value of a path, and rest.
fn places<T>(values: impl Iterator<Item = f64>, count: usize, place: fn(f64) -> T) -> Vec<T> {
    let largest = values.fold(0.0, f64::max);
    let parts = if largest > 0.0 { 1..=count } else { 1..=0 };
    parts.map(|k| place(largest * k as f64 / count as f64)).collect()
}

fn sweep_of(request: &Request) -> Result<Sweep, String> {
    let settings = request.set.iter().map(|text| Setting::parse(text));
    let settings: Vec<_> = settings.collect::<Result<_, _>>().map_err(|error| error.to_string())?;
    Sweep::parse(&request.definition, "definition", &settings).map_err(|error| error.to_string())
}

/// The columns of the tables of a design that have a value.
fn values(sweep: &Sweep, row: &DesignRow) -> Vec<Value> {
    let columns = design_columns(sweep);
    let with_cell = columns.into_iter().map(|column| (column.cell(row), column));
    with_cell.filter(|(cell, _)| *cell != Cell::Empty).map(|(cell, column)| Value::new(&column, &cell)).collect()
}
