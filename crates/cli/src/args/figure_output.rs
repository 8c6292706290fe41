//! Where figures and drawings go, and as what.

use std::path::PathBuf;

use clap::Args;

/// Where figures go, and as what.
#[derive(Debug, Args)]
pub struct FigureOutput {
    /// An image beside each figure, if squama is built with --features png
    #[arg(long)]
    pub png: bool,

    /// Dots per inch of images, of which a figure has 96 px
    #[arg(long, value_name = "DPI", default_value = "192", allow_hyphen_values = true)]
    pub dpi: f64,

    /// Leave the title of each figure out, for a caption of your own
    #[arg(long)]
    pub no_title: bool,

    /// Folder of the figures [default: a folder in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}
