//! The command `squama draw`, which draws designs at rest, punctured and bent.

use anyhow::{Context as _, bail, ensure};
use clap::Args;
use report::drawings;
use skin::flexure;
use skin::puncture::{self, Snapshots};
use substrate::RowStiffness;
use sweep::Case;

use super::DONE;
use super::figure_file::{FigureFiles, FigureOutput, check_sizes, joined};
use super::options::decimal;
use super::selection::{SelectedDesign, Selection, select};
use super::source::{Definition, folder_within};

/// Arguments of `squama draw`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama draw sweeps/paper.toml --design 0417
  squama draw sweeps/paper.toml --design 0417 --at 0.1,0.4,0.7 --png
  squama draw sweeps/paper.toml --design 0417,0418 --flexure
  squama draw sweeps/paper.toml --design 0067,0070,0072 --force 0.1
  squama draw sweeps/paper.toml --design 0417 --animate
  squama draw results/paper --gap 0.1 --length 1 --slant 15..60

Draws the row at rest and at the critical tilt, or at the displacements u/t given by --at. Contacts are red,
arrows are forces between scales, and bars are reactions of the substrate. A guided needle moves straight down;
a ring marks the point of the scale that it touched first. With --flexure, draws the strip with its ends
rotated by the angles given by --at, in degrees.")]
pub struct Arguments {
    #[command(flatten)]
    pub definition: Definition,

    #[command(flatten)]
    pub selection: Selection,

    /// Displacements u/t of the punctured point, or rotations of the ends in degrees
    #[arg(long, value_name = "VALUES", value_delimiter = ',', allow_hyphen_values = true, value_parser = decimal)]
    pub at: Vec<f64>,

    /// Puncture forces F* instead of displacements
    #[arg(long, value_name = "VALUES", value_delimiter = ',', allow_hyphen_values = true, value_parser = decimal, conflicts_with_all = ["at", "flexure", "animate"])]
    pub force: Vec<f64>,

    /// Draw the strip in bending instead of the puncture
    #[arg(long)]
    pub flexure: bool,

    /// Write one page that plays the path as an animation
    #[arg(long)]
    pub animate: bool,

    #[command(flatten)]
    pub output: FigureOutput,
}

/// Number of equal steps into which the frames of an animation divide the path.
const FRAMES: u32 = 60;

/// End rotations at which a strip is drawn by default, in degrees, before the end of the path.
const ROTATIONS_DEG: [f64; 3] = [0.0, 45.0, 90.0];

/// Draws the selected designs.
pub fn draw(arguments: &Arguments) -> anyhow::Result<u8> {
    check_positions(arguments)?;
    check_sizes(&arguments.output)?;
    let designs = select(&arguments.definition, &arguments.selection)?;
    let mut files = FigureFiles::new(&arguments.output, || {
        folder_within(&arguments.definition, &designs[0].sweep, "drawings")
    })?;
    for design in &designs {
        let drawing = Drawing { design, case: design.case(), arguments };
        if arguments.flexure {
            drawing.flexure(&mut files)?;
        } else {
            drawing.puncture(&mut files)?;
        }
    }
    files.print()?;
    Ok(DONE)
}

/// Rejects negative or infinite displacements and forces of a puncture.
fn check_positions(arguments: &Arguments) -> anyhow::Result<()> {
    // End rotations may be negative, because a strip can bend in both directions.
    let displacements = if arguments.flexure { &[] } else { arguments.at.as_slice() };
    require_non_negative("--at", "a displacement u/t", displacements)?;
    require_non_negative("--force", "a force F*", &arguments.force)
}

/// Rejects negative or infinite `values` of an option.
///
/// `option` and `quantity` describe the values in the error message.
pub fn require_non_negative(option: &str, quantity: &str, values: &[f64]) -> anyhow::Result<()> {
    for value in values {
        ensure!(
            *value >= 0.0 && value.is_finite(),
            "{option} {value}: out of range, expected {quantity} of at least 0"
        );
    }
    Ok(())
}

/// A design to draw, with the arguments of the command.
struct Drawing<'a> {
    design: &'a SelectedDesign,
    case: Case,
    arguments: &'a Arguments,
}

impl Drawing<'_> {
    /// Returns the file name of a drawing of this design, without extension.
    fn file(&self, what: &str) -> String {
        format!("design-{}-{what}", self.design.label())
    }

    /// Draws the puncture of the design.
    fn puncture(&self, files: &mut FigureFiles<'_>) -> anyhow::Result<()> {
        let case = &self.case;
        let Arguments { at, force, .. } = self.arguments;
        let states = if at.is_empty() && force.is_empty() {
            self.states_to_end()?
        } else {
            let depths = at.iter().copied().map(puncture::At::Displacement);
            let at: Vec<_> = depths.chain(force.iter().copied().map(puncture::At::Force)).collect();
            self.puncture_states(&at)?
        };
        let name = self.design.title();
        let drawing = drawings::PunctureDrawing { name: &name, case, states: &states };
        if self.arguments.animate {
            let file = self.file("puncture-animation");
            return files.html(&file, &drawing.animation()?);
        }
        let positions = if self.arguments.force.is_empty() {
            position_names(&self.arguments.at, "u", "critical-tilt")
        } else {
            position_names(&self.arguments.force, "force", "")
        };
        let file = self.file(&format!("puncture-at-{positions}"));
        files.svg(&file, &drawing.svg()?)
    }

    /// Returns the state at the critical tilt; for an animation, also all frames before it.
    fn states_to_end(&self) -> anyhow::Result<Vec<puncture::RowSnapshot>> {
        let Snapshots { end, is_critical, .. } = solve(&self.case, &[])?;
        ensure!(
            is_critical,
            "design {}: the path does not reach the critical tilt",
            self.design.label()
        );
        if !self.arguments.animate {
            return Ok(vec![end]);
        }
        // Solve the path a second time, because the displacements of the frames depend on the end
        // of the path.
        let step = end.displacement / f64::from(FRAMES);
        let frames = (0..FRAMES).map(|k| puncture::At::Displacement(step * f64::from(k)));
        let mut states = self.puncture_states(&frames.collect::<Vec<_>>())?;
        states.push(end);
        Ok(states)
    }

    /// Returns the states at the points `at`; a point that the path does not reach is an error.
    fn puncture_states(&self, at: &[puncture::At]) -> anyhow::Result<Vec<puncture::RowSnapshot>> {
        let solved = solve(&self.case, at)?;
        at.iter()
            .zip(solved.at)
            .map(|(at, state)| match state {
                Some(state) => Ok(state),
                None => {
                    bail!(
                        "design {}: the path does not reach {}",
                        self.design.label(),
                        position(*at)
                    )
                }
            })
            .collect()
    }

    /// Draws the bending of the design.
    fn flexure(&self, files: &mut FigureFiles<'_>) -> anyhow::Result<()> {
        let parameters = self.case.flexure;
        let last = parameters.max_end_rotation_deg;
        let at = self.rotations_deg(last);
        let solved = flexure::snapshots(&self.case.design, &self.case.common, &parameters, &at)?;
        let states = at
            .iter()
            .zip(solved)
            .map(|(at, state)| match state {
                Some(state) => Ok(state),
                None => {
                    bail!(
                        "design {}: the path of bending does not reach an end rotation of {at}°",
                        self.design.label()
                    )
                }
            })
            .collect::<anyhow::Result<Vec<_>>>()?;
        let name = self.design.title();
        let drawing = drawings::FlexureDrawing { name: &name, case: &self.case, states: &states };
        if self.arguments.animate {
            let file = self.file("flexure-animation");
            return files.html(&file, &drawing.animation()?);
        }
        let positions = position_names(
            &self.arguments.at,
            "end-rotation",
            &format!("0-to-{}-deg", last.to_string().replace('-', "minus-")),
        );
        let file = self.file(&format!("flexure-at-{positions}"));
        files.svg(&file, &drawing.svg()?)
    }

    /// Returns the end rotations to draw, in degrees; `last` is the last end rotation of the path.
    fn rotations_deg(&self, last: f64) -> Vec<f64> {
        match self.arguments.at.as_slice() {
            [] if self.arguments.animate => {
                (0..=FRAMES).map(|k| last * f64::from(k) / f64::from(FRAMES)).collect()
            }
            [] => {
                let before = ROTATIONS_DEG.into_iter().filter(|&size| size < last.abs());
                // Add 0 to turn −0 into 0, because a label would show the sign.
                before.map(|size| size * last.signum() + 0.0).chain([last]).collect()
            }
            at => at.to_vec(),
        }
    }
}

/// Draws the row of a case at rest, and at the critical tilt if `with_load`.
///
/// If the path does not reach the critical tilt, only the row at rest is drawn.
pub fn draw_row(name: &str, case: &Case, with_load: bool) -> anyhow::Result<String> {
    let solved = with_load.then(|| solve(case, &[])).transpose()?;
    let end = solved.filter(|solved| solved.is_critical).map(|solved| solved.end);
    let drawing = drawings::PunctureDrawing { name, case, states: end.as_slice() };
    Ok(drawing.svg()?)
}

/// Solves the puncture of a case, and returns the states at the points `at` of the path.
fn solve(case: &Case, at: &[puncture::At]) -> anyhow::Result<Snapshots> {
    let substrate = substrate(case)?;
    Ok(puncture::snapshots(&case.design, &substrate, &case.common, &case.punctured(), at)?)
}

/// Computes the stiffness of the substrate under a row.
pub fn substrate(case: &Case) -> anyhow::Result<RowStiffness> {
    let footprint = case.footprint();
    let footprint = footprint.context("the lengths differ too much for the boundary elements")?;
    Ok(RowStiffness::compute(&footprint, case.coupling)?)
}

/// Formats the values of points on a path for a file name.
///
/// `quantity` is the name of the values `at`; without values, the text is `otherwise`.
fn position_names(at: &[f64], quantity: &str, otherwise: &str) -> String {
    if at.is_empty() {
        return otherwise.to_owned();
    }
    let values: Vec<_> = at.iter().map(ToString::to_string).collect();
    format!("{quantity}-{}", joined(&values, "positions"))
}

/// Describes a point on a path for an error message.
fn position(at: puncture::At) -> String {
    match at {
        puncture::At::Displacement(u) => format!("u/t = {u}"),
        puncture::At::Force(force) => format!("F* = {force}"),
        puncture::At::Tilt(tilt) => format!("a tilt of {tilt}°"),
        puncture::At::Limit(mode) => format!("the limit of {}", mode.name()),
    }
}
