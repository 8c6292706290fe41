//! Arguments of `squama rerun`.

use std::path::PathBuf;

use clap::Args;

use super::{Format, Work};

/// Arguments of `squama rerun`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama rerun results/paper --failed --dry-run
  squama rerun results/paper --failed --set solver.max_step=0.01
  squama rerun results/paper --design 0417,0533 --set puncture.scales=801
  squama rerun results/paper --where slant_deg=75 --where 'puncture_status=row limit'

Replaces the rows of these designs in every table. Their column `settings` then says what was set;
it is empty where the settings are the sweep's own. reruns.csv says which values have changed.
Without --set designs are solved with the sweep's own settings.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or disk, 130, 143 or 129 ended by
SIGINT, SIGTERM or SIGHUP.")]
#[command(group(clap::ArgGroup::new("which").required(true).multiple(true)))]
pub struct RerunArguments {
    /// Folder of a run, or the definition of its sweep
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Designs that lack a value
    #[arg(long, group = "which")]
    pub failed: bool,

    /// Designs with these numbers, e.g. 0417 or 1-12,0417
    #[arg(long = "design", value_name = "NUMBERS", group = "which", value_delimiter = ',')]
    pub numbers: Option<Vec<String>>,

    /// Designs with this value in a column of designs.csv (may be repeated: all must hold)
    #[arg(long = "where", value_name = "COLUMN=VALUE", group = "which")]
    pub conditions: Vec<run::ColumnFilter>,

    /// Set a key of the definition for these designs, e.g. `solver.max_step=0.01` (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,

    /// Say what would be solved, and solve nothing
    #[arg(long)]
    pub dry_run: bool,

    #[command(flatten)]
    pub work: Work,

    #[command(flatten)]
    pub format: Format,
}
