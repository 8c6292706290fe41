//! The solver for interactive pages: JSON requests and answers.
//!
//! A page has no file system and no threads. This crate takes a definition as text and the values
//! of the sliders, and solves one design with the evaluator of runs. It returns the columns of the
//! tables, the paths, and the states to draw.
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
//! | [`Solver`] | answers requests; keeps the springs of each footprint |
//! | [`Request`], [`Setting`], [`Follow`] | requests |
//! | [`Answer`], [`Value`], [`Required`], [`Units`], [`Slope`], [`Closest`], [`Followed`] | answers |
//! | [`PuncturedRow`], [`BentStrip`] | paths, and the drawn states |
//! | [`exports`] | functions exported by the WebAssembly module |
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

pub use answer::{Answer, Closest, Followed, Required, Slope, Units, Value};
pub use path::{BentStrip, PuncturedRow};
pub use request::{Follow, Request, Setting};
pub use solver::Solver;
