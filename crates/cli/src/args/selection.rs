//! The designs that a command looks at.

use clap::Args;

/// Numbers of designs, or their values.
#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
pub struct Selection {
    /// Numbers of designs in the grid of the sweep, e.g. 0417 or 1-12,0417
    #[arg(long = "design", value_name = "NUMBERS", value_delimiter = ',', conflicts_with_all = ["gap", "length", "slant"])]
    pub numbers: Vec<String>,

    /// Gap d/t: a value, several as 0.1,0.2, or those of the sweep between two as 0.1..0.3
    #[arg(long, value_name = "GAP", allow_hyphen_values = true)]
    pub gap: Option<String>,

    /// Length L/t: as --gap
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub length: Option<String>,

    /// Slant in degrees: as --gap
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub slant: Option<String>,
}
