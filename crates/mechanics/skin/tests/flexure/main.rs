//! Tests of the bending model.
//!
//! | File | Tests |
//! |---|---|
//! | `closed_forms` | the strip before contact and first contact of upright blocks, compared with closed forms |
//! | `elastica` | strips compared with an extensible elastica that another method solves |
//! | `first_contact` | the closed form of first contact compared with solved strips; bending with scales on the outside |
//! | `chain` | the assembled chain compared with the unit cell |
//! | `gap_by_gap` | strips of unequal gaps: separately solved gaps compared with the assembled chain |
//! | `locking` | strips locked by friction, compared with plates on torsional springs |
//! | `friction` | strips with friction: end moments of independent programs, unloading, corners that meet |
//! | `steps` | results with ten times smaller steps, and with a tolerance at round-off |
//! | `robustness` | the 720 designs of the reference study; strips that stop early, and the reasons |

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
