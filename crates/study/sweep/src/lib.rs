//! Sweep definitions: from TOML to the cases of the designs.
//!
//! A sweep is a grid of designs, every combination of the values of its axes. It is never stored:
//! the number of a design gives its parameters, and its parameters give its number.
//!
//! ```text
//! file ─► text::toml_source ─► Sweep ─► Grid ─► Case
//!        settings ─┘   (valid)  number ─┘
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`Setting`] | a key set from outside, which replaces the value in the file |
//! | [`PARAMETERS`], [`Parameter`], [`Scalar`] | the list of all parameters with their accepted values; a value |
//! | [`Role`], [`key`] | roles of parameters in the model; the keys that code refers to |
//! | [`Measure`] | the measures: coverage, puncture, flexure, and their derivatives |
//! | [`Sweep`] | the validated definition |
//! | [`Grid`], [`Axis`], [`DesignNumber`] | the designs, by number |
//! | [`Case`] | all parameters of the solution of one design |
//! | [`Variable`], [`VariableValues`] | a parameter that is searched over or drawn, of `[variables]` |
//! | [`Deviation`], [`BatchDeviation`] | manufacturing deviations, of `[tolerance]` |
//! | [`Material`] | thickness, moduli and density of the skin, in physical units |
//! | [`JudgedModes`] | the failure modes that a puncture is judged by |
//! | [`NamedValues`], [`SCALE_MATERIALS`], [`TISSUE_MATERIALS`], [`BODIES`] | named values |
//! | [`Subset`], [`RandomSample`], [`Shard`], [`SubsetDesigns`] | the designs that a run solves |
//!
//! ```
//! use sweep::Sweep;
//!
//! let text = "name = 'thick'\ndesigns.slant_deg = { from = 0, to = 60, step = 15 }\nscale.width_over_t = 2";
//! let sweep = Sweep::parse(text, "thick.toml", &[])?;
//! assert_eq!(sweep.grid().len(), 10 * 12 * 5);
//! let case = sweep.grid().case(3);
//! assert_eq!((case.design.slant_deg, case.design.width), (45.0, 2.0));
//! assert_eq!(sweep.grid().find(&case), Some(3));
//! assert_eq!(sweep.grid().number(3).to_string(), "0004");
//!
//! let error = Sweep::parse("name = 'thin'\ncontact.c2 = 0", "thin.toml", &[]).unwrap_err();
//! assert_eq!(
//!     error.to_string(),
//!     "thin.toml:2: contact.c2: 0 is out of range, expected a number of at least 0.05 and at most 1.5"
//! );
//! # Ok::<(), sweep::InvalidDefinition>(())
//! ```

mod case;
mod decimal;
mod definition;
mod deviation;
mod grid;
mod input;
mod judged_modes;
mod material;
mod named_values;
mod parameter;
mod scalar;
mod subset;
mod variable;

pub use case::{Case, Samples};
pub use definition::invalid::{InvalidDefinition, Problem, refuse};
pub use definition::measure::Measure;
pub use definition::schema::definition_schema;
pub use definition::setting::{InvalidSetting, Setting};
pub use definition::{Sweep, entries, read_entries, read_text};
pub use deviation::{BatchDeviation, Deviation};
pub use grid::{Axis, DesignNumber, Grid, NoSuchDesign, TooManyDesigns};
pub use input::{read_input, read_input_bytes};
pub use judged_modes::JudgedModes;
pub use material::Material;
pub use named_values::{BODIES, NamedValues, SCALE_MATERIALS, TISSUE_MATERIALS};
pub use parameter::{PARAMETERS, Parameter, Role, WrongValue, key};
pub use scalar::Scalar;
pub use subset::{NoShard, RandomSample, SampleTooLarge, Shard, Subset, SubsetDesigns};
pub use variable::{Variable, VariableValues};
