//! Scaled skins under load: puncture on a soft substrate, bending on a membrane.
//!
//! Rigid parallelogram scales stand in a row. Their bases are bonded to a soft substrate or to a
//! membrane, and their sides meet in compliant contacts that follow a power law. This crate
//! assembles the geometry ([`geometry`]), substrate springs ([`substrate`]), membrane
//! ([`membrane`]) and contacts ([`contact`]) into a mixed complementarity system. The solver
//! ([`solver`]) follows its equilibrium path from rest to a critical tilt or rotation, and the
//! measures are computed from that path.
//!
//! Lengths are in units of the scale thickness `t`. Forces on the substrate are in units of `E* t²`
//! with `E* = E_s/(1−ν²)`, membrane forces in units of `E_m t²`.
//!
//! | Type | Role |
//! |---|---|
//! | [`Design`], [`Base`] | the geometry of one design |
//! | [`puncture::solve`] | a row of scales under a point load, up to the critical tilt |
//! | [`Common`] | contact law and solver settings, for puncture and bending |
//! | [`puncture::PunctureParameters`] | moduli, row length, load, critical tilt |
//! | [`puncture::RowLength`] | number of scales: given, or as many as contact reaches |
//! | [`puncture::PerturbedScale`] | one scale of a row with a changed gap or slant |
//! | [`puncture::Snap`], [`puncture::Instability`] | snap-through and loss of stability along the path |
//! | [`puncture::TiltMeasures`] | measures at one of several critical tilts |
//! | [`puncture::LoadPosition`], [`puncture::Weakest`] | puncture at one of several load positions; the weakest position |
//! | [`puncture::Puncture`], [`puncture::PunctureMeasures`] | path, events, scales and measures of a puncture |
//! | [`puncture::Fold`], [`puncture::GapStretch`] | folds of the substrate surface; stretch of the gaps |
//! | [`puncture::PunctureEnd`] | the end of a path, from which the ends of similar designs are solved |
//! | [`puncture::snapshots`] | the row at chosen points of the path |
//! | [`flexure::solve`] | a strip of membrane with scales in pure bending |
//! | [`flexure::FlexureParameters`] | moduli, strip, resolution of the membrane, largest rotation |
//! | [`flexure::Flexure`], [`flexure::FlexureMeasures`] | path, events and measures of a bent strip |
//! | [`flexure::contact_curvature`] | curvature of first contact, in closed form |
//! | [`puncture::differentiate`], [`flexure::differentiate`] | derivatives of all measures |
//! | [`puncture::PunctureInput`], [`flexure::FlexureInput`] | complete input of a solution, for derivatives |
//! | [`Neighbours`], [`Derivative`] | inputs with one parameter decreased and increased; the resulting derivative |
//! | [`Imperfection`], [`Sample`] | random scatter of gaps and slants; one row drawn with this scatter |
//! | [`puncture::solve_sample`], [`flexure::bend_sample`] | puncture and bending of an imperfect row |
//! | [`Status`], [`Iteration`] | outcome of a path; one Newton iteration |
//! | [`ContactEvent`], [`ContactChange`], [`Contact`] | a change of a contact along the path; a closed contact in a state |
//!
//! ```
//! use skin::puncture::{self, PunctureParameters};
//! use skin::{Base, Common, Design, Status};
//!
//! let design = Design { gap: 0.2, length: 0.5, slant_deg: 60.0, base: Base::L, width: 1.0 };
//! let parameters = PunctureParameters::default();
//! let springs = substrate::calibrate(&design.footprint(parameters.poisson_ratio)?)?;
//! let puncture = puncture::solve(&design, &springs, &Common::default(), &parameters)?;
//! assert_eq!(puncture.status, Status::Complete);
//!
//! // Several scales share the load, not only the punctured one.
//! assert!(puncture.measures.engaged_scales > Some(2));
//! // The load at the critical tilt is the largest: no instability precedes it.
//! assert_eq!(puncture.measures.peak_force, puncture.measures.critical_force);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arrangement;
mod common;
mod contacts;
mod design;
pub mod flexure;
mod imperfection;
mod path_location;
pub mod puncture;
mod record;
mod sensitivity;
mod status;
mod unloading;

pub use common::{Common, PathDetail};
pub use contacts::{Contact, ContactChange};
pub use design::{Base, Design};
pub use imperfection::{Imperfection, Sample};
pub use record::{ContactEvent, Iteration};
pub use sensitivity::{CurvePoint, Derivative};
pub use solver::Neighbours;
pub use status::Status;
pub use unloading::{Remains, Unloading};
