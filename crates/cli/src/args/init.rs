//! Arguments of `squama init`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::templates;

/// Arguments of `squama init`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama init                       the sweep of the paper, in paper.toml
  squama init smoke mine.toml       a dozen designs, as a sweep of the name mine

Every key that may be set is explained in the definition of the paper. A file that exists is left alone.
Exit code: 0 done, 2 bad input or disk.")]
pub struct InitArguments {
    /// Definition to begin with
    #[arg(value_name = "TEMPLATE", default_value = "paper", value_parser = PossibleValuesParser::new(templates::names()))]
    pub template: String,

    /// File of the definition; its name becomes that of the sweep [default: TEMPLATE.toml]
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
}
