//! Sweep definitions: from TOML to the cases of the designs.
//!
//! A sweep is a grid of designs: all combinations of the values of its axes. The grid is never
//! stored, because the number of a design determines its parameters, and its parameters determine
//! its number.
//!
//! ```text
//! definition in TOML ─► keys and values ─► validated Sweep ─► Grid ─► Case
//!                         settings ─┘                design number ─┘
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`Setting`] | a key with a value that replaces the value in the file, e.g. from `--set` |
//! | [`PARAMETERS`], [`Parameter`] | all parameters, with keys, units and accepted values |
//! | [`Scalar`] | the value of one parameter |
//! | [`Role`] | the roles of parameters in the model |
//! | [`key`] | the keys of parameters that code refers to |
//! | [`Measure`] | the measures: coverage, puncture, flexure, and their derivatives |
//! | [`Sweep`] | the validated definition |
//! | [`Grid`], [`Axis`], [`DesignNumber`] | the numbered designs and their axes |
//! | [`Case`] | all parameters from which one design is solved |
//! | [`Variable`], [`VariableValues`] | an entry of `[variables]`: a parameter that a search or a random draw varies |
//! | [`Deviation`], [`BatchDeviation`] | an entry of `[tolerance]`: a manufacturing deviation |
//! | [`Material`] | thickness, moduli, strengths and density of the skin, in physical units |
//! | [`JudgedModes`] | the failure modes; for each mode that is not judged, the reason |
//! | [`NamedValues`] | values that a name, such as `PLA`, supplies to a definition |
//! | [`SCALE_MATERIALS`], [`TISSUE_MATERIALS`], [`BODIES`] | the named materials and bodies |
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
