//! `squama calibrate`.

use anyhow::{Context as _, ensure};
use clap::Args;
use substrate::{Footprint, Springs};
use sweep::{Setting, Sweep};

use super::DONE;
use crate::print::{aligned, print};

/// Arguments of `squama calibrate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama calibrate --gap 0.1 --length 1
  squama calibrate --gap 0.1 --length 1 --width 2 --base 2L --poisson-ratio 0.3")]
pub struct Arguments {
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

/// Prints the springs under a row of scales.
pub fn calibrate(arguments: &Arguments) -> anyhow::Result<u8> {
    let footprint = footprint_of(arguments)?;
    let springs = substrate::calibrate(&footprint)?;
    print(&report(&footprint, &springs))?;
    Ok(DONE)
}

/// The arguments are validated as the keys of a sweep that they are.
fn footprint_of(arguments: &Arguments) -> anyhow::Result<Footprint> {
    let options = [
        ("--gap", "designs.gap_over_t", &arguments.gap),
        ("--length", "designs.length_over_t", &arguments.length),
        ("--width", "scale.width_over_t", &arguments.width),
        ("--base", "scale.base", &arguments.base),
        ("--poisson-ratio", "substrate.poisson_ratio", &arguments.poisson_ratio),
    ];
    let setting = |(option, key, value): (&str, &str, &String)| {
        Setting::from_option(&format!("{option} {value}"), &format!("{key}={value}"))
    };
    // A sweep of one design: its keys know their bounds, and how to refuse what is beyond.
    let settings: Vec<_> = options.into_iter().map(setting).collect::<Result<_, _>>()?;
    let sweep =
        Sweep::parse("name = \"calibrate\"\ndesigns.slant_deg = 0", "calibrate", &settings)?;
    let several = "--gap and --length: several values, expected one of each";
    ensure!(sweep.grid().len() == 1, several);
    let case = sweep.grid().case(0);
    case.footprint().context("the lengths differ too much for the boundary elements")
}

fn report(footprint: &Footprint, springs: &Springs) -> String {
    let header = ["", "x", "y", "phi"].map(str::to_owned);
    let rows = [header, row("alpha", springs.direct), row("beta", springs.coupling)];
    format!(
        "d/a = {:.6}, b/a = {:.6}, nu = {}\n\n{}\nestimated relative error {:.1e}\n",
        footprint.gap_over_a(),
        footprint.width_over_a(),
        footprint.poisson_ratio(),
        aligned(&rows),
        springs.error
    )
}

fn row(name: &str, values: [f64; 3]) -> [String; 4] {
    let [x, y, phi] = values.map(|value| format!("{value:.6}"));
    [name.to_owned(), x, y, phi]
}
