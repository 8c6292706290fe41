//! The command `squama make`, which writes a patch of skin for manufacture or finite elements.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail, ensure};
use clap::Args;
use fabrication::{Format, Patch, Puncture, Sheet, deck};
use ranking::CRITERIA;
use results::columns::{measure_name, mode_column, name};
use results::{DesignRow, Quantity};
use run::Evaluator;
use sweep::{Case, JudgedModes, Measure};
use uncertainty::{Analysis, SampleStore};

use super::answer::{DesignAnswer, SearchedDesign};
use super::figure_file::write_file;
use super::options::decimal;
use super::own_files::require_own;
use super::selection::{SelectedDesign, Selection, select};
use super::source::{Definition, require_folder_of};
use super::{DONE, PROGRAM};
use crate::interrupt::Interrupt;
use crate::print::{FAILED, aligned, marked, note, print, rounded};

/// Arguments of `squama make`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama make sweeps/glove.toml --design 0072 --out skin.3mf
  squama make results/palm --design 1 --scales 8x6 --out palm.step
  squama make results/pin --patch 60x40 --brick --out pin.3mf
  squama make results/palm --design 1 --kerf 0.12 --template-mm 0.1 --out palm.dxf

Writes a patch of skin in millimetres: scales on their membrane, which extends one gap beyond their bases on every
side. The design needs a thickness (material.thickness_mm). If it has a [body], solids lie on its arc, unless
--flat; outlines and decks are flat. The extension of --out selects the format:
  .3mf          printers; states its unit; scales and membrane are two parts, for two materials
  .stl          printers; has no unit, so tell the slicer that lengths are in mm
  .step, .stp   CAD programs; exact solids
  .dxf, .svg    laser cutters: the profile of each scale, to be cut from a sheet as thick as the scales are wide;
                a template with a hole for each base, to glue the scales at their pitch; and a square to
                check the size after import, 100 mm wide. Profiles, template and square are on separate layers
  .inp          CalculiX and Abaqus: a finite-element deck of one row with contact; --scales gives the number of scales,
                and the middle scale is pushed down by 0.1 t. To compare it, solve the design with the same puncture.scales
Also writes a list of parts: sizes, counts, mass if scale_density_kg_m3 is known, and, if the definition has
[tolerance], the deviations that change the measures most (from derivatives; squama tolerance gives the yield).
The patch has the nominal gaps and slants, without scatter.")]
pub struct Arguments {
    #[command(flatten)]
    pub definition: Definition,

    #[command(flatten)]
    pub selection: Selection,

    /// File to write; its extension is .3mf, .stl, .step, .dxf, .svg or .inp
    #[arg(long, value_name = "FILE", default_value = "skin.3mf")]
    pub out: PathBuf,

    /// Number of scales along and across
    #[arg(long, value_name = "ALONGxACROSS", default_value = "5x4", value_parser = along_and_across)]
    pub scales: [usize; 2],

    /// Size of the patch along and across, mm; the patch gets as many scales as fit
    #[arg(long, value_name = "LENGTHxWIDTH", conflicts_with = "scales", value_parser = length_and_width)]
    pub patch: Option<[f64; 2]>,

    /// Shift every second row by half a pitch, like bricks
    #[arg(long)]
    pub brick: bool,

    /// Lay the patch flat, to be glued round the body of the design
    #[arg(long)]
    pub flat: bool,

    /// Gap between neighbouring rows, mm [default: the gap across of the design, or its gap along]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = decimal)]
    pub gap_across_mm: Option<f64>,

    /// Width of the cut of the laser, mm [default: 0]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = decimal)]
    pub kerf: Option<f64>,

    /// Thickness of the sheet of the glue template, mm [default: 0.1]
    ///
    /// Slanted scales need longer holes in thicker sheets.
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = decimal)]
    pub template_mm: Option<f64>,
}

/// Default thickness of the sheet of the glue template, mm.
// The default sheet is a film: in thicker sheets the holes of slanted scales leave no webs.
const TEMPLATE_MM: f64 = 0.1;

/// Parses numbers of scales such as `5x4`.
fn along_and_across(text: &str) -> Result<[usize; 2], String> {
    pair(text).ok_or_else(|| "expected the numbers of scales along and across, e.g. 5x4".to_owned())
}

/// Parses the length and width of a patch in mm, such as `60x40`.
fn length_and_width(text: &str) -> Result<[f64; 2], String> {
    let lengths =
        pair(text).filter(|lengths: &[f64; 2]| lengths.iter().all(|l| *l > 0.0 && l.is_finite()));
    lengths.ok_or_else(|| "expected length and width of the patch in mm, e.g. 60x40".to_owned())
}

/// Parses two numbers separated by `x` or by the multiplication sign `×`.
///
/// Users copy the multiplication sign from other texts.
fn pair<T: std::str::FromStr>(text: &str) -> Option<[T; 2]> {
    let (along, across) = text.split_once(['x', '×'])?;
    Some([along.trim().parse().ok()?, across.trim().parse().ok()?])
}

/// Writes the file of a patch of skin, and the list of its parts.
pub fn make(arguments: &Arguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let out = &arguments.out;
    let format = format(arguments)?;
    let is_flat = format.is_some_and(Format::is_flat);
    require_folder_of("--out", out)?;
    let list_file = out.with_extension("parts.txt");
    for file in [out, &list_file] {
        require_own(file)?;
    }
    let designs = select(&arguments.definition, &arguments.selection)?;
    let [design] = designs.as_slice() else {
        bail!(
            "{} designs are selected, but a file holds one; choose it with --design",
            designs.len()
        );
    };
    let searched = SearchedDesign::read(&arguments.definition.path)?;
    let case = design.case();
    let is_solid = format.is_some_and(|format| !format.is_flat());
    let mut patch = patch(&case, arguments)?;
    if is_solid && !arguments.flat {
        patch = patch.on_body(case.body())?;
    }
    if format.is_none() && !case.body().is_flat() {
        note("the finite-element deck is flat, although the design has a body");
    }
    // Build the deck before the slow analysis, because `deck` rejects rows that are too long.
    let deck = match format {
        None => deck(&patch, &puncture(&case), &design.title())?,
        Some(_) => String::new(),
    };
    let (kerf, template) =
        (arguments.kerf.unwrap_or(0.0), arguments.template_mm.unwrap_or(TEMPLATE_MM));
    let sheet = Sheet::new(&patch, kerf, template)?;
    let mut list = format!("{}\n\n{}", design.title(), parts(&patch, &case));
    if is_flat && !sheet.has_template() {
        let missing = no_template(&sheet, template);
        note(&missing);
        list = format!("{list}\n{missing}\n");
    }
    list.push_str(&answer(design, &searched));
    // Analyse the tolerances before writing any file, because the analysis may fail.
    list.push_str(&tolerances(design, out, interrupt)?);
    // Write the list first: if this fails, the earlier file of the patch stays unchanged.
    write_file(&list_file, format!("{list}\nWritten by squama make.\n").as_bytes())?;
    let bytes = format.map_or(deck.into_bytes(), |format| format.bytes(&patch, &sheet));
    write_file(out, &bytes)?;
    print(&format!("{list}\n{} {}\n", out.display(), list_file.display()))?;
    Ok(DONE)
}

/// Returns the format for the extension of `--out`; `None` for a finite-element deck.
fn format(arguments: &Arguments) -> anyhow::Result<Option<Format>> {
    let out = &arguments.out;
    let extension = out.extension().unwrap_or_default().to_string_lossy();
    let format = Format::of_extension(&extension);
    ensure!(
        format.is_some() || extension.eq_ignore_ascii_case("inp"),
        "--out {}: expected a file that ends in .3mf, .stl, .step, .dxf, .svg or .inp",
        out.display()
    );
    for (option, value) in [("--kerf", arguments.kerf), ("--template-mm", arguments.template_mm)] {
        ensure!(
            format.is_some_and(Format::is_flat) || value.is_none(),
            "{option} has no effect on {}: it applies to outlines for laser cutters, .dxf and .svg",
            out.display()
        );
    }
    Ok(format)
}

/// Builds the flat patch of a design, with lengths in mm.
fn patch(case: &Case, arguments: &Arguments) -> anyhow::Result<Patch> {
    let thickness = case.material.thickness_mm.with_context(|| {
        let path = arguments.definition.path.display();
        format!("{path}: has no thickness in mm; add --set material.thickness_mm=2, for scales 2 mm thick")
    })?;
    let membrane = case.flexure.membrane_thickness * thickness;
    let across = case.gap_across.unwrap_or(case.design.gap) * thickness;
    let across = arguments.gap_across_mm.unwrap_or(across);
    let lengths = [case.design.width * thickness, membrane, across];
    let row = case.design.row()?;
    let scales = match arguments.patch {
        Some(size) => {
            // Measure two rows, because `--brick` shifts the second row along and so lengthens the
            // patch.
            let two = laid(Patch::new(row, thickness, lengths, [1, 2])?, arguments.brick);
            within(&two, size)?
        }
        None => arguments.scales,
    };
    Ok(laid(Patch::new(row, thickness, lengths, scales)?, arguments.brick))
}

/// Shifts every second row of `patch` by half a pitch if `is_brick`.
fn laid(patch: Patch, is_brick: bool) -> Patch {
    if is_brick { patch.brick_laid() } else { patch }
}

/// Returns the largest numbers of scales, along and across, on a membrane of at most `size` in mm.
///
/// `two` is a patch with the same lengths and two rows of one scale each.
fn within(two: &Patch, size: [f64; 2]) -> anyhow::Result<[usize; 2]> {
    let ([length, width, _], pitches) = (two.membrane_size(), two.pitches());
    let smallest = [length, width - pitches[1]];
    let mut scales = [0; 2];
    for k in 0..2 {
        // Add 1e-9, because round-off may reduce the quotient to just below an integer.
        let more = ((size[k] - smallest[k]) / pitches[k] + 1e-9).floor();
        ensure!(
            more >= 0.0,
            "--patch: smaller than one scale with a gap on every side, {} mm x {} mm",
            rounded(smallest[0]),
            rounded(smallest[1])
        );
        scales[k] = 1 + more as usize;
    }
    Ok(scales)
}

/// Returns the materials and the load of a finite-element deck.
///
/// If the modulus of the substrate is not defined, it is 1 `MPa`.
fn puncture(case: &Case) -> Puncture {
    let punctured = case.punctured();
    let substrate = case.material.substrate_modulus_mpa.unwrap_or(1.0);
    let thickness = case.material.thickness_mm.unwrap_or(1.0);
    Puncture {
        substrate,
        poisson_ratio: punctured.poisson_ratio,
        scale: punctured.contact_modulus_over_substrate * substrate,
        tissue: case.tissue_thickness.map(|tissue| tissue * thickness),
        friction: case.common.friction,
        load_position: punctured.load_position,
    }
}

/// Formats a table of the sizes, counts and masses of scales and membrane.
fn parts(patch: &Patch, case: &Case) -> String {
    let [along, across] = patch.scales();
    let count = (along * across) as f64;
    let ([gap, gap_across], [pitch, pitch_across]) = (patch.gaps(), patch.pitches());
    let [length, width, height] = patch.membrane_size();
    let mut rows = vec![
        ("scales", count, ""),
        ("  along", along as f64, ""),
        ("  across", across as f64, ""),
        ("  base along the row", patch.base(), "mm"),
        ("  thickness", patch.thickness(), "mm"),
        ("  width across the row", patch.width(), "mm"),
        ("  slant from the vertical", patch.slant_deg(), "deg"),
        ("  shift of the top", patch.shift(), "mm"),
        ("  gap along, between bases", gap, "mm"),
        ("  gap across", gap_across, "mm"),
        ("  pitch along", pitch, "mm"),
        ("  pitch across", pitch_across, "mm"),
        ("  volume of one scale", patch.scale_volume(), "mm3"),
    ];
    if let Some(density) = case.material.scale_density_kg_m3 {
        // 1 kg/m3 is 1e-6 g/mm3.
        let mass = density * patch.scale_volume() * 1e-6;
        rows.push(("  mass of one scale", mass, "g"));
        rows.push(("  mass of all scales", mass * count, "g"));
    }
    rows.extend([
        ("membrane", 1.0, ""),
        ("  length along the rows", length, "mm"),
        ("  width", width, "mm"),
        ("  thickness", height, "mm"),
    ]);
    if let Some(radius) = patch.radius() {
        rows.extend([
            ("on a body with the radius", radius, "mm"),
            ("  angle around it", patch.arc_deg(), "deg"),
            ("  distance of the faces of neighbours", patch.clearance(), "mm"),
        ]);
    }
    let row =
        |(name, value, unit): (&str, f64, &str)| [name.to_owned(), rounded(value), unit.to_owned()];
    aligned(&rows.into_iter().map(row).collect::<Vec<_>>())
}

/// Returns a message that explains why there is no glue template, and names alternatives.
fn no_template(sheet: &Sheet, template: f64) -> String {
    format!(
        "no glue template: a sheet of {} mm would have webs of only {} mm; choose a thinner sheet (--template-mm), \
         or space the scales with shims",
        rounded(template),
        rounded(sheet.web())
    )
}

/// Solves the design again, and formats required values, warnings and the first failure.
///
/// Designs on tissue of finite thickness or with imperfections are slow to solve; for them, only
/// the coverage is computed.
fn answer(design: &SelectedDesign, searched: &SearchedDesign) -> String {
    let (sweep, case) = (&design.sweep, design.case());
    let modes = case.judged_modes();
    let is_quick = case.tissue_thickness.is_none() && case.imperfection.is_none();
    let measures = if is_quick { sweep.plain_measures() } else { vec![Measure::Coverage] };
    let row = Evaluator::new(&measures).row(sweep.grid().number(0), &case);
    let answer = DesignAnswer::new(sweep, &row, &searched.requirements);
    let mut text = String::new();
    match answer.rows() {
        rows if rows.is_empty() => {}
        rows => text = format!("\nRequirements\n{}", aligned(&rows)),
    }
    text += &answer.warnings_text(None);
    text += &marked(FAILED, &searched.failed_checks);
    text + &modes.map_or_else(String::new, |modes| first_failure(&row, &case, &modes))
}

/// Describes the first failure mode of a design, its force, and the failure modes that are judged.
fn first_failure(row: &DesignRow, case: &Case, modes: &JudgedModes) -> String {
    let failure = row.result.puncture.as_ref().map(|puncture| puncture.measures.failure);
    let first = failure.and_then(|failure| Some((failure.mode?.name(), failure.force?)));
    let first = first.map_or_else(
        || "First failure unknown: the puncture could not be solved\n".to_owned(),
        |(mode, force)| match Quantity::Force.physical(force, case) {
            Some(newton) => format!("First failure: {mode}, at {} N\n", rounded(newton)),
            None => format!("First failure: {mode}, at a force of {}\n", rounded(force)),
        },
    );
    format!("\n{first}{modes}")
}

/// Lists the standard deviations of the main measures due to the deviations in `[tolerance]`.
///
/// The standard deviations follow from derivatives, without samples. The text is empty without
/// `[tolerance]`.
fn tolerances(
    design: &SelectedDesign,
    out: &Path,
    interrupt: &Interrupt,
) -> anyhow::Result<String> {
    let sweep = &design.sweep;
    if sweep.deviations().is_empty() {
        return Ok(String::new());
    }
    let analysis = Analysis::new(sweep, &[], 0, PROGRAM, interrupt.stop());
    // The analysis solves no samples, so nothing is written to the store.
    let analysed = analysis.design(0, &SampleStore::new(out))?;
    let shown = analysed.measures.iter().filter(|measure| is_for_a_maker(&measure.name));
    let varying = shown.filter_map(|measure| {
        let linear = measure.linear.as_ref().filter(|linear| linear.spread > 0.0)?;
        let deviation = format!("+- {}", rounded(linear.spread));
        let value = rounded(measure.value?);
        let unit = if measure.unit == "-" { "" } else { measure.unit };
        Some([measure.name.clone(), value, deviation, unit.to_owned(), linear.sources_text()])
    });
    let rows: Vec<_> = varying.collect();
    Ok(format!(
        "\nStandard deviations from [tolerance], and their sources; squama tolerance lists all measures\n{}",
        aligned(&rows)
    ))
}

/// Returns true for the criteria of the paper, failure forces, the mass and the bend radius.
fn is_for_a_maker(measure: &str) -> bool {
    let is_criterion =
        || CRITERIA.iter().any(|criterion| criterion.column == measure_name(measure));
    is_criterion()
        || mode_column(measure).is_some()
        || ["bend_radius_mm", name::AREAL_MASS].contains(&measure)
}
