//! Behaviour of the bending model.
//!
//! | File | Against |
//! |---|---|
//! | `closed_forms` | the strip before contact, and first contact of upright blocks, in closed form |
//! | `elastica` | strips with an extensible elastica, solved by another method |
//! | `first_contact` | curvature of first contact in closed form, and bending to the outside |
//! | `chain` | the assembled chain against the unit cell |
//! | `gap_by_gap` | strips of unequal gaps: gap by gap against the assembled chain |
//! | `locking` | strips locked by friction, next to plates on torsional springs |
//! | `friction` | end moments of independent programs |
//! | `steps` | ten times smaller steps, and a tolerance at round-off |
//! | `robustness` | the 720 designs of the reference study; strips that stop early, and why |

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
