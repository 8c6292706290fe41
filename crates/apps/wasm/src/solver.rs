//! The solver that answers requests.

use ranking::Requirement;
use results::columns::name;
use results::{DesignRow, SolvedDesign};
use run::{Evaluator, GapChange, Patience, validity_warnings};
use skin::Imperfection;
use skin::flexure::{self, Flexure};
use skin::puncture::{self, Puncture, PunctureParameters};
use sweep::{Case, Measure, Sweep};

use crate::answer::{Answer, Required, Slope, Units, Value, definition};
use crate::follow::follow;
use crate::path::{BentStrip, PuncturedRow};
use crate::request::Request;

/// Largest step along the curves of a complete answer, as a fraction of the path.
const CURVE_STEP: f64 = 0.02;

/// Answers requests, and keeps the definition and the springs between requests.
#[derive(Debug, Default)]
pub struct Solver {
    /// The definition of the last request.
    sweep: Option<(String, Sweep)>,
    /// The evaluators used so far, each with its measures; they keep calibrated springs.
    evaluators: Vec<(Vec<Measure>, Evaluator)>,
}

impl Solver {
    /// Answers a request in JSON with JSON; errors become `{"id": …, "error": "…"}`.
    pub fn answer(&mut self, request: &str) -> String {
        let request = match serde_json::from_str::<Request>(request) {
            Ok(request) => request,
            Err(error) => {
                return serde_json::json!({ "error": format!("the request: {error}") }).to_string();
            }
        };
        let answer = self.solve(&request);
        answer.map_or_else(
            |error| serde_json::json!({ "id": request.id, "error": error }).to_string(),
            |answer| serde_json::to_string(&answer).unwrap_or_default(),
        )
    }

    /// Solves the design of a request.
    ///
    /// # Errors
    /// If the definition, a parameter or a requirement is rejected, with the message of the
    /// commands.
    pub fn solve(&mut self, request: &Request) -> Result<Answer, String> {
        let sweep = self.sweep(&request.definition)?;
        // Omit imperfect samples, which would take hundreds of times as long.
        let base = Case { imperfection: Imperfection::default(), ..sweep.grid().case(0) };
        let case = request.case(&base)?;
        let single = definition::alone(&sweep, &base, &case)?;
        let requirements = request.require.iter().map(|text| text.parse());
        let requirements: Vec<Requirement> = requirements
            .collect::<Result<_, ranking::InvalidRequirement>>()
            .map_err(|error| error.to_string())?;
        let evaluator = self.evaluator(request.measures(&case));
        let number = single.grid().number(0);
        let solved = if request.bare {
            SolvedDesign { row: evaluator.row(number, &case), puncture: None, flexure: None }
        } else {
            evaluator.solve(number, &case)
        };
        let drawn = request.drawn.unwrap_or_default();
        // Measures use the steps of the definition, like the command; finer steps are only for
        // curves.
        let mut smooth = case;
        if request.fine {
            smooth.common.solver.max_step = case.common.solver.max_step.min(CURVE_STEP);
        }
        let puncture = solved.puncture.as_ref();
        let puncture =
            puncture.and_then(|path| punctured(evaluator, &case, &smooth, path, drawn[0]));
        let flexure =
            solved.flexure.as_ref().map(|path| bent(&smooth, request.fine, path, drawn[1]));
        let row = &solved.row;
        let values = Value::all(&single, row);
        let change = request.fine.then(|| gap_change(&single, row)).flatten();
        let followed = request
            .follow
            .as_ref()
            .map(|request| follow(&single, &case, request, &requirements, evaluator));
        Ok(Answer {
            id: request.id,
            fine: request.fine,
            requirements: Required::all(&requirements, &values),
            warnings: validity_warnings(&case, row, None, change.as_ref()),
            values,
            units: Units::of(&case),
            puncture,
            flexure,
            slopes: row.result.sensitivity.iter().map(Slope::new).collect(),
            closest: definition::closest(&sweep, &case),
            settings: definition::settings(&sweep, &base, &case),
            toml: definition::definition(&single, &requirements),
            follow: followed.transpose()?,
        })
    }

    /// Returns the sweep of a definition, parsed only if the definition has changed.
    fn sweep(&mut self, definition: &str) -> Result<Sweep, String> {
        // Requests while the user drags have the same definition, so the last definition is kept.
        if let Some((text, sweep)) = &self.sweep
            && text == definition
        {
            return Ok(sweep.clone());
        }
        let sweep =
            Sweep::parse(definition, "definition", &[]).map_err(|error| error.to_string())?;
        self.sweep = Some((definition.to_owned(), sweep.clone()));
        Ok(sweep)
    }

    fn evaluator(&mut self, measures: Vec<Measure>) -> &Evaluator {
        // There are at most two evaluators, for fast and for complete answers.
        let known = self.evaluators.iter().position(|(others, _)| *others == measures);
        let index = known.unwrap_or_else(|| {
            let evaluator = Evaluator::new(&measures);
            self.evaluators.push((measures, evaluator));
            self.evaluators.len() - 1
        });
        &self.evaluators[index].1
    }
}

/// Solves the puncture of `case` again, with the steps of `smooth`.
///
/// `path` is the path with larger steps, and `drawn` the fraction of it at which the row is drawn.
/// Unloading is omitted.
fn punctured(
    evaluator: &Evaluator,
    case: &Case,
    smooth: &Case,
    path: &Puncture,
    drawn: f64,
) -> Option<PuncturedRow> {
    let substrate = evaluator.substrate(case).ok()?;
    let parameters = PunctureParameters { unload: false, ..smooth.punctured() };
    let Case { design, common, .. } = smooth;
    PuncturedRow::new(case, path, drawn, |at| {
        puncture::snapshots_to_end(design, &*substrate, common, &parameters, at)
    })
}

/// Returns the changes of critical force and compliance for a smaller and a larger gap.
fn gap_change(sweep: &Sweep, row: &DesignRow) -> Option<GapChange> {
    let columns = [name::CRITICAL_FORCE, name::COMPLIANCE];
    GapChange::solve(sweep, &row.number.to_string(), &columns, Patience::Milliseconds)
}

/// Returns the bent strip of `case`, with the path solved again if `is_fine`.
///
/// `path` is the path with larger steps, and the strip is drawn at the fraction `drawn` of it.
fn bent(case: &Case, is_fine: bool, path: &Flexure, drawn: f64) -> BentStrip {
    let Case { design, common, flexure: parameters, .. } = case;
    let fine = is_fine.then(|| flexure::solve(design, common, parameters).ok()).flatten();
    BentStrip::new(case, fine.as_ref().unwrap_or(path), drawn, |rotation| {
        flexure::snapshots(design, common, parameters, &[rotation]).ok()?.pop()?
    })
}
