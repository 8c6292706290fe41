//! Behaviour of the bending model.
//!
//! | File | Against |
//! |---|---|
//! | `closed_forms` | the strip before contact, and the first contact of upright blocks |
//! | `elastica` | strips of an extensible elastica, solved by another method |
//! | `first_touch` | the curvature of first contact in closed form, and bending to the outside |
//! | `chain` | the assembled chain against the unit cell |
//! | `uneven` | strips whose gaps differ, gap by gap against the chain of all |
//! | `locking` | strips that rub, beside the lock of plates on torsional roots |
//! | `rubbing` | strips that rub, beside end moments of other programs |
//! | `steps` | the same path with steps a tenth as long, and with a tolerance at round-off |
//! | `robustness` | the 720 designs of the reference study; strips that end early, and why |

mod chain;
mod closed_forms;
mod elastica;
mod first_contact;
mod friction;
mod gap_by_gap;
mod locking;
mod robustness;
#[path = "../samples/mod.rs"]
mod samples;
mod steps;
