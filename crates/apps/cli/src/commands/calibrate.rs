//! The command `squama calibrate`, which prints the stiffness of the substrate springs.

use anyhow::{Context as _, ensure};
use clap::Args;
use substrate::{Coupling, Footprint, RowStiffness, Springs};
use sweep::{Setting, Sweep};

use super::DONE;
use crate::print::{aligned, print};

/// Arguments of `squama calibrate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama calibrate --gap 0.1 --length 1
  squama calibrate --gap 0.1 --length 1 --width 2 --base 2L --poisson-ratio 0.3
  squama calibrate --gap 0.1 --length 1 --tissue-thickness 2

On tissue of finite thickness, forces along the row are coupled to rotations and to displacements across the row.
Three more lines give these stiffnesses: r0 is the force along the row from a rotation of the scale itself, r the
force from a rotation of a neighbour, and l the force across the row on the right scale of a pair from a displacement
of the left scale along the row.")]
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

    /// Thickness h/t of the substrate on a rigid base [default: infinite]
    #[arg(long, value_name = "THICKNESS", allow_hyphen_values = true)]
    pub tissue_thickness: Option<String>,
}

/// Prints the stiffness of the springs under a row of scales.
pub fn calibrate(arguments: &Arguments) -> anyhow::Result<u8> {
    let footprint = footprint_of(arguments)?;
    // Compute only the coupling of nearest neighbours, because the output shows no other springs,
    // and full coupling takes much longer.
    let row = RowStiffness::compute(&footprint, Coupling::Nearest)?;
    print(&report(&footprint, &row))?;
    Ok(DONE)
}

/// Builds the footprint, after validating the arguments as keys of a sweep.
fn footprint_of(arguments: &Arguments) -> anyhow::Result<Footprint> {
    let options = [
        ("--gap", "designs.gap_over_t", &arguments.gap),
        ("--length", "designs.length_over_t", &arguments.length),
        ("--width", "scale.width_over_t", &arguments.width),
        ("--base", "scale.base", &arguments.base),
        ("--poisson-ratio", "substrate.poisson_ratio", &arguments.poisson_ratio),
    ];
    let tissue = arguments.tissue_thickness.iter();
    let tissue = tissue.map(|h| ("--tissue-thickness", "substrate.tissue_thickness_over_t", h));
    // Parse a sweep of one design: the keys of a sweep check their bounds and report errors.
    let settings: Vec<_> = options
        .into_iter()
        .chain(tissue)
        .map(|(option, key, value)| {
            Setting::from_option(&format!("{option} {value}"), &format!("{key}={value}"))
        })
        .collect::<Result<_, _>>()?;
    // Set any slant, because a sweep needs one; the springs do not depend on the slant.
    let sweep =
        Sweep::parse("name = \"calibrate\"\ndesigns.slant_deg = 0", "calibrate", &settings)?;
    // Reject a list of values in an option, which makes the key an axis of several values.
    let several = "--gap and --length: several values, expected one of each";
    ensure!(sweep.grid().len() == 1, several);
    let case = sweep.grid().case(0);
    case.footprint().context("the lengths differ too much for the boundary elements")
}

fn report(footprint: &Footprint, stiffness: &RowStiffness) -> String {
    let springs = Springs::from(stiffness);
    let header = ["", "x", "y", "phi"].map(str::to_owned);
    let rows = [header, row("alpha", springs.direct), row("beta", springs.coupling)];
    let [mut thickness, mut coupled] = [String::new(), String::new()];
    if footprint.is_on_layer() {
        thickness = format!(", h/a = {:.6}", footprint.thickness_over_a());
        let nearest = stiffness.neighbours.first().copied().unwrap_or_default();
        let numbers = [("r0", stiffness.roll), ("r", nearest.roll), ("l", nearest.lift)];
        coupled.extend(numbers.map(|(name, value)| format!("{name} = {value:.6}\n")));
    }
    format!(
        "d/a = {:.6}, b/a = {:.6}, nu = {}{thickness}\n\n{}{coupled}\nestimated relative error {:.1e}\n",
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
