//! Arguments of `squama calibrate`.

use clap::Args;

/// Arguments of `squama calibrate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama calibrate --gap 0.1 --length 1
  squama calibrate --gap 0.1 --length 1 --width 2 --base 2L --poisson-ratio 0.3")]
pub struct CalibrateArguments {
    /// Gap d/t
    #[arg(long, value_name = "GAP", allow_hyphen_values = true)]
    pub gap: String,

    /// Length L/t
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub length: String,

    /// Out-of-plane width b/t
    #[arg(long, value_name = "WIDTH", allow_hyphen_values = true, default_value = "1")]
    pub width: String,

    /// Base of a scale, L or 2L
    #[arg(long, value_name = "BASE", default_value = "L")]
    pub base: String,

    /// Poisson's ratio of the substrate
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true, default_value = "0.5")]
    pub poisson_ratio: String,
}
