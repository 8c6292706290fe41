//! The solver as a page calls it: a request in, an answer out, both JSON.
//!
//! A page has no file system, no threads and no time to lose, but it has a definition and the hand of a designer. So this crate
//! takes the definition as text, with the values under the hand as settings, solves that one design by the evaluator of runs, and
//! answers with the columns of its tables, its paths, and as many states along them as are to be drawn.
//!
//! ```text
//! {"definition": "name = 'x' …", "set": ["designs.gap_over_t=0.2"], "frames": 12}
//!      │  Request ─► Sweep ─► Case ─► Evaluator, snapshots ─► Answer
//!      ▼
//! {"values": [{"name": "critical_force", "unit": …, "value": 0.41}, …], "puncture": {…}, "flexure": {…}, "slopes": […]}
//! ```
//!
//! | Item | Role |
//! |---|---|
//! | [`Solver`] | answers requests; the springs of one footprint are solved for once |
//! | [`Request`] | what is to be solved |
//! | [`Answer`], [`Value`], [`PuncturePath`], [`FlexurePath`], [`Slope`] | what came out |
//! | [`exports`] | the names under which a module of WebAssembly has it |
//!
//! ```
//! let request = r#"{"definition": "name = 'x'", "set": ["designs.gap_over_t=0.1", "designs.length_over_t=1", "designs.slant_deg=45"]}"#;
//! let answer: serde_json::Value = serde_json::from_str(&live::Solver::default().answer(request))?;
//! let coverage = answer["values"].as_array().and_then(|values| values.iter().find(|value| value["name"] == "coverage"));
//! assert_eq!(coverage.expect("a coverage")["value"].as_f64().map(|value| (value * 10.0).round()), Some(9.0));
//! # Ok::<(), serde_json::Error>(())
//! ```

mod answer;
pub mod exports;
mod request;

pub use answer::{Answer, FlexureFrame, FlexurePath, PunctureFrame, PuncturePath, Slope, Value};
pub use request::{Request, Solver};
