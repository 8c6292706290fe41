//! The sweep definition that a command reads.

use std::path::PathBuf;

use clap::Args;

/// A definition and what is put in its place.
#[derive(Debug, Args)]
pub struct Definition {
    /// Sweep definition in TOML, or the folder of an earlier run
    #[arg(value_name = "SWEEP.toml")]
    pub path: PathBuf,

    /// Set a key of the definition, e.g. puncture.scales=41 (may be repeated)
    ///
    /// The key is dotted, the value is TOML; a single word needs no quotes. A parameter under
    /// `designs` becomes an axis of the grid, e.g. `designs.width_over_t=[1,2]`.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,
}
