//! Runs: how the designs of a sweep are solved, and how their results come into a folder.
//!
//! Designs are solved in parallel, each by one thread, and noted in a journal as they are done. The
//! tables are written from the journal, in the order of the designs, one row at a time: so they are
//! the same for any number of threads, shards and interruptions, and memory hardly grows with the
//! grid.
//!
//! ```text
//! Sweep ─► Workbench ─► Journal ─► tables
//! ```

mod filter;
mod journal;
mod merge;
mod options;
mod progress;
mod rerun;
mod run;
mod session;
mod solve;
mod status;
mod tables;

pub use filter::{Choice, Condition, NoCondition, WrongChoice};
pub use journal::{Archive, Entry, Header, Journal, JournalError, Latest, Start};
pub use merge::{MergeError, Merged, merge};
pub use options::{Options, Program};
pub use progress::{Finished, News, RunError};
pub use rerun::{Rerun, WrongRerun};
pub use run::run;
pub use solve::evaluator::Workbench;
pub use status::Status;
pub use tables::summary::{Best, Summary};
