//! Skins that are known, found again behind curves that were made of them.

mod made;
mod recovery;
mod refusals;
