//! Whether results are used that are not whole.

use clap::Args;
use results::Completeness;

/// Whether results are used that are not whole.
#[derive(Debug, Args)]
pub struct Partial {
    /// Use the designs that are done, though others are missing; what is made from them says so
    #[arg(long)]
    pub partial: bool,
}

impl Partial {
    /// The results that will do.
    pub fn completeness(&self) -> Completeness {
        if self.partial { Completeness::Partial } else { Completeness::Whole }
    }
}
