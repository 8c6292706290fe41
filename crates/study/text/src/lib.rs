//! Text helpers shared by the crates of a study.
//!
//! The crate depends on no other crate of the workspace.
//!
//! | Item | Role |
//! |---|---|
//! | [`number`] | equality up to round-off; numbers as the shortest text, or rounded |
//! | [`visible`], [`shortened`], [`one_line`], [`reason`] | prepare text for messages |
//! | [`nearest`], [`has_part`] | suggest the name that a misspelled one may mean |
//! | [`shell_word`], [`shell_quoted`] | quote words for a POSIX shell |
//! | [`toml_source`] | parses TOML and keeps the line of each key |

mod message;
mod nearest;
pub mod number;
mod shell;
pub mod toml_source;

pub use message::{one_line, reason, shortened, visible};
pub use nearest::{has_part, nearest};
pub use shell::{shell_quoted, shell_word};
