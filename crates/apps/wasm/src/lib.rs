//! The solver for interactive pages: JSON requests and answers.
//!
//! A page has no file system and no threads. This crate takes a definition as text and the values of
//! the sliders, solves one design with the evaluator of runs, and returns the columns of its tables, its
//! paths, and the states to draw.
//!
//! ```text
//! {"definition": "name = 'x' …", "set": {"gap_over_t": 0.2}, "drawn": [1, 0.5]}
//!      │  Request ─► Sweep ─► Case ─► Evaluator, snapshots ─► Answer
//!      ▼
//! {"values": [{"name": "critical_force", "unit": …, "value": 0.41}, …], "puncture": {…}, "flexure": {…}, "warnings": […]}
//! ```
//!
//! | Item | Role |
//! |---|---|
//! | [`Solver`] | answers requests; the springs of one footprint are solved for once |
//! | [`Request`], [`Setting`], [`Follow`] | what is to be solved |
//! | [`Answer`], [`Value`], [`Required`], [`Units`], [`Slope`], [`Closest`], [`Followed`] | what came out |
//! | [`PuncturedRow`], [`BentStrip`] | paths, and the states that are drawn |
//! | [`exports`] | the names under which a module of WebAssembly has it |
//!
//! ```
//! let request = r#"{"definition": "name = 'x'\ndesigns.gap_over_t = 1\ndesigns.length_over_t = 1\ndesigns.slant_deg = 45", "set": {"gap_over_t": 0.1}}"#;
//! let answer: serde_json::Value = serde_json::from_str(&wasm::Solver::default().answer(request))?;
//! let coverage = answer["values"].as_array().and_then(|values| values.iter().find(|value| value["name"] == "coverage"));
//! let coverage = coverage.and_then(|coverage| coverage["value"].as_f64());
//! assert!(coverage.is_some_and(|coverage| (coverage - 0.9).abs() < 1e-12), "{answer}");
//! # Ok::<(), serde_json::Error>(())
//! ```

mod answer;
pub mod exports;
mod follow;
mod path;
mod request;
mod solver;
mod warnings;

pub use answer::{Answer, Closest, Required, Slope, Units, Value};
pub use follow::Followed;
pub use path::{BentStrip, PuncturedRow};
pub use request::{Follow, Request, Setting};
pub use solver::Solver;
