//! Figures of energies against displacement or curvature, with a panel for each design.

use results::{bending_units, puncture_units};

use super::{
    Curve, CurveValues, DesignCurves, FORCE, FigureText, MARGINS, MOMENT, NARROW_HEIGHT, axes,
    curve_name, drawn, palette,
};
use crate::chart::{Area, ChartPanel};
use crate::colors::INK;
use crate::figures::{columns, sheet};
use crate::label::{Anchor, label, width};
use crate::paper::Paper;

/// Width and height of a panel of energies, px.
const ENERGY_PANEL: [f64; 2] = [330.0, 300.0];
/// Minimum width of a panel of energies on narrow paper, px.
const LEAST_ENERGY_PANEL: f64 = 220.0;

const PUNCTURE_ENERGY: FigureText = FigureText {
    title: "energies of a puncture",
    axes: [
        [FORCE.axes[0][0], "energy $U$(1 − $ν$^2)/($E_s t$^3), dimensionless"],
        [FORCE.axes[1][0], "energy $U$, mJ"],
    ],
    notes: ["solid: substrate, dotted: contacts", "", ""],
    units: |case| puncture_units(case).map(|[mm, _, energy]| [mm, energy]),
};
const FLEXURE_ENERGY: FigureText = FigureText {
    title: "energies of bending",
    axes: [
        [MOMENT.axes[0][0], "energy $U$/($E_m t$^3), dimensionless"],
        [MOMENT.axes[1][0], "energy $U$, mJ"],
    ],
    notes: ["solid: bending, dashed: axial, dotted: contacts", "", ""],
    units: |case| bending_units(case).map(|[per_mm, _, energy]| [per_mm, energy]),
};

/// The energies of a design: dash pattern and points of each curve.
type Energies = Vec<(&'static str, Vec<[f64; 2]>)>;

/// Draws the energies of punctures; `None` if no puncture was solved.
pub(super) fn puncture(name: &str, designs: &[DesignCurves], paper: Paper) -> Option<String> {
    panels(name, &PUNCTURE_ENERGY, designs, puncture_energies, paper)
}

/// Draws the energies of bending; `None` if no bending was solved.
pub(super) fn flexure(name: &str, designs: &[DesignCurves], paper: Paper) -> Option<String> {
    panels(name, &FLEXURE_ENERGY, designs, flexure_energies, paper)
}

fn puncture_energies(solved: &DesignCurves) -> Option<Energies> {
    let path = &solved.puncture?.path;
    Some(vec![
        ("none", path.iter().map(|p| [p.displacement, p.substrate_energy]).collect()),
        ("2 3", path.iter().map(|p| [p.displacement, p.contact_energy]).collect()),
    ])
}

fn flexure_energies(solved: &DesignCurves) -> Option<Energies> {
    let path = &solved.flexure?.path;
    Some(vec![
        ("none", path.iter().map(|p| [p.curvature, p.bending_energy]).collect()),
        ("7 4", path.iter().map(|p| [p.curvature, p.axial_energy]).collect()),
        ("2 3", path.iter().map(|p| [p.curvature, p.contact_energy]).collect()),
    ])
}

/// Draws a panel with its own axes for each solved design; `None` if no design was solved.
fn panels(
    name: &str,
    text: &FigureText,
    designs: &[DesignCurves],
    values: fn(&DesignCurves) -> Option<Energies>,
    paper: Paper,
) -> Option<String> {
    let units = text.physical(designs);
    let labels = text.axes[usize::from(units.is_some())];
    let solved = energy_curves(designs, values, units.as_deref());
    if solved.is_empty() {
        return None;
    }
    let [w, h] = ENERGY_PANEL;
    let wanted = columns(solved.len()).min(3);
    let natural = MARGINS[0] + wanted as f64 * (w + 84.0) - 60.0;
    let full = paper.width(natural);
    let room = full - MARGINS[0] - MARGINS[1];
    let columns = paper.columns(wanted, room, LEAST_ENERGY_PANEL, 84.0);
    let (w, h) = if paper.is_narrow(natural) {
        ((room - 84.0 * (columns - 1) as f64) / columns as f64, NARROW_HEIGHT)
    } else {
        (w, h)
    };
    let first = Area { left: MARGINS[0], top: 86.0, width: w, height: h };
    let mut inside =
        vec![label(text.notes[0], [20.0, 48.0], 12.0, Anchor::Start).with("fill", INK)];
    for (k, curves) in solved.iter().enumerate() {
        let area = first.panel(k, columns, [84.0; 2]);
        let points = curves.iter().flat_map(|curve| curve.values.all()).copied();
        let (x, y) = axes(labels, &points.collect::<Vec<_>>());
        let title = curves[0].name.clone();
        let panel = ChartPanel { title, ..ChartPanel::new(area, &x, &y) };
        inside.extend(panel.axes(58.0));
        inside.extend(curves.iter().map(|curve| drawn(&panel, curve)));
    }
    let rows = solved.len().div_ceil(columns) as f64;
    let title = format!("{name}: {}", text.title);
    // The title of the figure may be wider than a single panel.
    let full =
        if paper.is_narrow(natural) { full } else { natural.max(width(&title, 15.0) + 60.0) };
    Some(sheet(full, 86.0 + rows * (h + 84.0) - 20.0, &title, inside))
}

/// Returns the energy curves of each solved design.
///
/// `units` holds the factors of each design to physical units; `None` gives dimensionless curves.
fn energy_curves(
    designs: &[DesignCurves],
    energies: fn(&DesignCurves) -> Option<Energies>,
    units: Option<&[[f64; 2]]>,
) -> Vec<Vec<Curve>> {
    let palette = palette(designs);
    let mut all = Vec::new();
    for (k, solved) in designs.iter().enumerate() {
        let Some(energies) = energies(solved) else { continue };
        let curves = energies.into_iter().map(|(dashes, points)| {
            let mut values = CurveValues { points, ..CurveValues::default() };
            values.in_units(units.map_or([1.0; 2], |units| units[k]));
            let color = palette.color(solved.case.design.slant_deg);
            Curve { name: curve_name(solved), color, dashes, values }
        });
        all.push(curves.collect());
    }
    all
}
