//! What becomes of results that are there already.

use clap::Args;
use run::Start;

/// Whether a command goes on with earlier results or throws them away; it refuses to touch them if neither is said.
#[derive(Clone, Copy, Debug, Args)]
pub struct Earlier {
    /// Go on with the results that are there, if there are any
    #[arg(long, conflicts_with = "fresh")]
    resume: bool,

    /// Throw away the results that are there, if there are any
    #[arg(long)]
    fresh: bool,
}

impl Earlier {
    /// The start of the journal.
    pub fn start(self) -> Start {
        match (self.resume, self.fresh) {
            (true, _) => Start::Resume,
            (_, true) => Start::Fresh,
            _ => Start::New,
        }
    }
}
