//! Skins that are known, found again behind curves that were made of them.

mod recovery;
mod refusals;
mod synthetic_curves;
