//! Scaled skins under load: puncture of scales on a soft substrate, bending of scales on a membrane.
//!
//! Rigid parallelogram scales stand in a row. Their bases are bonded to something soft, and their sides
//! meet in contacts that give way by a power law. Here the parts come together: shape ([`geometry`]),
//! substrate springs ([`substrate`]), membrane ([`membrane`]) and contacts ([`contact`]) make a mixed
//! complementarity system, whose equilibrium path ([`solver`]) is followed from rest to a critical
//! tilt or rotation, and comes down to a few measures.
//!
//! Lengths are in units of the scale thickness `t`. Forces on the substrate are in units of `E* t²` with
//! `E* = E_s/(1−ν²)`, those in the membrane in units of `E_m t²`.
//!
//! | Type | Role |
//! |---|---|
//! | [`Design`], [`Base`] | the geometry of one design |
//! | [`puncture::solve`] | a row of scales under a point load, until the loaded one tilts by 10° |
//! | [`Common`] | contact law and solver settings, of puncture and bending |
//! | [`puncture::PunctureParameters`] | moduli, row length, load, critical tilt |
//! | [`puncture::RowLength`] | how many scales are solved for: a number, or as many as contact reaches |
//! | [`puncture::PerturbedScale`] | one scale of a row that differs from all others, for derivatives with respect to single scales |
//! | [`puncture::Snap`], [`puncture::Instability`], [`puncture::TiltMeasures`] | snaps and losses of stability along the path; measures at other critical tilts |
//! | [`puncture::LoadPosition`], [`puncture::Weakest`] | the puncture at other places of the load, and the weakest of them |
//! | [`puncture::Puncture`], [`puncture::PunctureMeasures`] | its path, events, scales and measures |
//! | [`puncture::Fold`], [`puncture::GapStretch`] | a gap in which the surface of the substrate folds over; how far gaps are stretched |
//! | [`puncture::snapshots`] | the row at chosen places of the path |
//! | [`flexure::solve`] | a strip of membrane with scales in pure bending |
//! | [`flexure::FlexureParameters`] | moduli, strip, resolution of the membrane, largest rotation |
//! | [`flexure::Flexure`], [`flexure::FlexureMeasures`] | its path, events and measures |
//! | [`flexure::contact_curvature`] | the curvature at which scales touch, in closed form |
//! | [`puncture::differentiate`], [`flexure::differentiate`] | the same with the derivatives of all measures |
//! | [`puncture::PunctureInput`], [`flexure::FlexureInput`], [`Neighbours`], [`Derivative`] | all that a path depends on, near a value of a parameter, and what comes of it |
//! | [`Imperfection`], [`Sample`] | random gaps and slants, and one row that has them |
//! | [`puncture::solve_sample`], [`flexure::bend_sample`] | puncture and bending of an imperfect row |
//! | [`Status`], [`Iteration`] | how a path ended; one Newton iteration of it |
//! | [`ContactEvent`], [`ContactChange`], [`Contact`] | a change of a contact along the path; a contact of a state |
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
//! // More scales share the load than the one that carries it.
//! assert!(puncture.measures.engaged_scales > Some(2));
//! // The load at the critical tilt is the largest: no instability before.
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

pub use common::Common;
pub use contacts::{Contact, ContactChange};
pub use design::{Base, Design};
pub use imperfection::{Imperfection, Sample};
pub use record::{ContactEvent, Iteration};
pub use sensitivity::{CurvePoint, Derivative};
pub use solver::Neighbours;
pub use status::Status;
pub use unloading::{Remains, Unloading};
