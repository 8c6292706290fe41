//! Formats and parses text for messages, tables and definitions.
//!
//! The crate depends on no other crate of the workspace.
//!
//! | Item | Role |
//! |---|---|
//! | [`number`] | equality up to round-off; numbers as the shortest text, or rounded |
//! | [`visible`], [`shortened`], [`one_line`], [`reason`] | prepare text for messages |
//! | [`nearest`], [`has_part`] | suggest a known name for a misspelled or shortened name |
//! | [`shell_word`], [`shell_quoted`] | quote words for a POSIX shell |
//! | [`toml_source`] | parses TOML and records the line of each key |

mod message;
mod nearest;
pub mod number;
mod shell;
pub mod toml_source;

pub use message::{one_line, reason, shortened, visible};
pub use nearest::{has_part, nearest};
pub use shell::{shell_quoted, shell_word};
