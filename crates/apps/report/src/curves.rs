//! Curves of designs: force–displacement, moment–curvature and energies.
//!
//! A cross marks a contact event, a ring the first fold of the surface, a triangle the passage of a
//! guided needle, and a dot with a name a limit of failure.

mod energies;
mod limits;
mod values;

use results::{bending_units, puncture_units};
use skin::flexure::Flexure;
use skin::puncture::Puncture;
use sweep::Case;

use crate::axis::ChartAxis;
use crate::chart::{Area, ChartPanel};
use crate::colors::{INK, RED, shaded};
use crate::drawings::geometry_label;
use crate::figures::{Figure, sheet};
use crate::label::{Anchor, fitting, label, wrapped};
use crate::palette::SlantPalette;
use crate::paper::Paper;
use crate::svg::{Element, Spot, circle, line, polygon, polyline};
use limits::limits;
use values::{CurveValues, bodies, flexure, load_positions, puncture};

pub use limits::FailureLimit;

const WIDTH: f64 = 760.0;
/// Margins for the axes, px: left, right, below.
const MARGINS: [f64; 3] = [78.0, 24.0, 62.0];
/// Height of a panel on wide paper, px.
const HEIGHT: f64 = 292.0;
/// Height of a panel on narrow paper, px.
const NARROW_HEIGHT: f64 = 230.0;
/// Vertical position of the first line of the legend, px.
const LEGEND: f64 = 70.0;
/// Minimum distance between crosses, px.
const CROSS: f64 = 9.0;

/// Dash patterns that distinguish designs of the same slant.
const DASHES: [&str; 5] = ["none", "7 4", "2 3", "9 3 2 3", "12 5"];
/// Dashes of parts of a path that are unstable under a held depth.
const UNSTABLE: &str = "1 2.5";
/// Dashes of an unloading path.
const UNLOADING: &str = "5 3";
/// Arguments of [`shaded`] that distinguish designs of the same slant.
const SHADES: [f64; 4] = [0.0, -0.35, -0.6, 0.3];

/// A solved design, with the results that are drawn as curves.
#[derive(Clone, Debug)]
pub struct DesignCurves<'a> {
    /// The number of the design.
    pub number: String,
    /// Parameters of the design.
    ///
    /// Curves are in mm and N if all designs have a thickness and a modulus.
    pub case: &'a Case,
    /// The path in puncture, if it was solved.
    pub puncture: Option<&'a Puncture>,
    /// The path in bending, if it was solved.
    pub flexure: Option<&'a Flexure>,
    /// Curvature `t/R` of each body, and the critical force of the design on this body.
    ///
    /// The force is `None` if the design has no critical tilt on this body.
    pub on_bodies: &'a [(f64, Option<f64>)],
    /// The limits of failure, marked on the curve of the puncture.
    pub limits: &'a [FailureLimit],
}

/// Measured curves, overlaid on the curves of designs.
#[derive(Clone, Debug)]
pub struct MeasuredCurves {
    /// True for bending, false for puncture.
    ///
    /// Bending: moment against curvature. Puncture: force against displacement.
    pub bending: bool,
    /// True for physical units (mm and N, or 1/mm and N mm), false for dimensionless curves.
    pub is_physical: bool,
    /// Name and points of each curve.
    pub curves: Vec<(String, Vec<[f64; 2]>)>,
    /// Mean curve of several specimens: position, mean and standard deviation; may be empty.
    pub band: Vec<[f64; 3]>,
}

/// A curve of a panel, with its name and style.
struct Curve {
    name: String,
    color: String,
    dashes: &'static str,
    values: CurveValues,
}

/// Draws the curves of `designs` as figures, with `measured` curves overlaid.
pub fn curves(
    name: &str,
    designs: &[DesignCurves],
    measured: Option<&MeasuredCurves>,
    paper: Paper,
) -> Vec<Figure> {
    let [measured_force, measured_moment] =
        [false, true].map(|bending| measured.filter(|measured| measured.bending == bending));
    let one_panel =
        |text, values, measured| one_panel(name, text, designs, values, measured, paper);
    let candidates = [
        ("force-displacement-curves", one_panel(&FORCE, puncture, measured_force)),
        ("force-over-place", one_panel(&POSITIONS, load_positions, None)),
        ("force-over-radius", one_panel(&BODIES, bodies, None)),
        ("moment-curvature-curves", one_panel(&MOMENT, flexure, measured_moment)),
        ("puncture-energies", energies::puncture(name, designs, paper)),
        ("flexure-energies", energies::flexure(name, designs, paper)),
    ];
    let drawn = candidates.into_iter();
    drawn.filter_map(|(name, svg)| Some(Figure::new(name, svg?))).collect()
}

/// The texts and units of one kind of figure.
struct FigureText {
    title: &'static str,
    /// Labels of the x axis and the y axis: first dimensionless, then in physical units.
    axes: [[&'static str; 2]; 2],
    /// Notes below the title: the first is always shown, the second if a curve has a ring, the
    /// third if a curve has a dotted part.
    notes: [&'static str; 3],
    /// Returns factors that convert both axes to physical units; `None` without a material.
    units: fn(&Case) -> Option<[f64; 2]>,
}

const POSITION: &str = "load position: 0 left corner of the top, 1 right corner";

const FORCE: FigureText = FigureText {
    title: "puncture force against displacement",
    axes: [
        [
            "displacement $u^*$ = $u/t$, dimensionless",
            "force $F^*$ = $F$(1 − $ν$^2)/($E_s L t$), dimensionless",
        ],
        ["displacement $u$, mm", "force $F$, N"],
    ],
    notes: [
        "× a contact closes, opens or passes a corner",
        "○ the surface folds over",
        "fine dots: unstable under a held depth",
    ],
    units: |case| puncture_units(case).map(|[mm, newton, _]| [mm, newton]),
};
const POSITIONS: FigureText = FigureText {
    title: "puncture force against the load position",
    axes: [[POSITION, FORCE.axes[0][1]], [POSITION, FORCE.axes[1][1]]],
    notes: ["", "○ the weakest position", "fine dots: positions without a critical force"],
    units: |case| puncture_units(case).map(|[_, newton, _]| [1.0, newton]),
};
const BODIES: FigureText = FigureText {
    title: "critical force against the curvature of the body",
    axes: [
        ["$t/R$: below 0 concave, 0 flat, above 0 convex", FORCE.axes[0][1]],
        ["1/$R$, 1/mm: below 0 concave, 0 flat, above 0 convex", FORCE.axes[1][1]],
    ],
    notes: ["", "○ the worst body", "fine dots: bodies without a critical force"],
    units: |case| puncture_units(case).map(|[mm, newton, _]| [mm.recip(), newton]),
};
const MOMENT: FigureText = FigureText {
    title: "moment against curvature",
    axes: [
        [
            "curvature $κ^*$ = $κ t$, dimensionless",
            "moment $M^*$ = $M t$/($E_m I_m$), dimensionless",
        ],
        ["curvature $κ$, 1/mm", "moment $M$, N mm"],
    ],
    notes: ["× a contact closes, opens or passes a corner", "", ""],
    units: |case| bending_units(case).map(|[per_mm, moment, _]| [per_mm, moment]),
};
impl FigureText {
    /// Returns for each design the factors that convert both axes to physical units.
    ///
    /// `None` if any design has no material.
    fn physical(&self, designs: &[DesignCurves]) -> Option<Vec<[f64; 2]>> {
        designs.iter().map(|solved| (self.units)(solved.case)).collect()
    }
}

/// A function that returns the curve of a design; `None` if the curve was not solved.
type ValuesOf = fn(&DesignCurves) -> Option<CurveValues>;

fn one_panel(
    name: &str,
    text: &FigureText,
    designs: &[DesignCurves],
    values: ValuesOf,
    measured: Option<&MeasuredCurves>,
    paper: Paper,
) -> Option<String> {
    // If the measured curves are dimensionless, the computed curves are dimensionless, too.
    let may_have_units = measured.is_none_or(|measured| measured.is_physical);
    let units = text.physical(designs).filter(|_| may_have_units);
    let labels = text.axes[usize::from(units.is_some())];
    let curves = curves_of(designs, values, &units.unwrap_or_default());
    if curves.is_empty() {
        return None;
    }
    let band = measured.map_or(&[][..], |measured| &measured.band);
    let measured = measured.map_or(&[][..], |measured| &measured.curves);
    let solved = curves.iter().flat_map(|curve| curve.values.all());
    let points = solved.chain(measured.iter().flat_map(|(_, points)| points)).copied();
    let points = points.chain(band.iter().map(|[x, mean, deviation]| [*x, mean + deviation]));
    let (x, y) = axes(labels, &points.collect::<Vec<_>>());
    let y = logarithmic(labels[1], &curves).unwrap_or(y);
    let lines = curves.len() + measured.len() + usize::from(!band.is_empty());
    let full = paper.width(WIDTH);
    // On narrow paper the legend starts at the left edge.
    let left = if paper.is_narrow(WIDTH) { 20.0 } else { MARGINS[0] };
    let words = wrapped(&notes(text, &curves), 12.0, full - left - 12.0);
    // Each further line of notes moves the legend down.
    let entries = LEGEND + 16.0 * words.len().saturating_sub(1) as f64;
    let entries = [left, entries];
    let area = Area {
        left: MARGINS[0],
        top: entry(entries, lines)[1] + 6.0,
        width: full - MARGINS[0] - MARGINS[1],
        height: if paper.is_narrow(WIDTH) { NARROW_HEIGHT } else { HEIGHT },
    };
    let panel = ChartPanel::new(area, &x, &y);
    let mut inside = panel.axes(56.0).to_vec();
    inside.extend(words.iter().enumerate().map(|(k, words)| {
        label(words, [left, 48.0 + 16.0 * k as f64], 12.0, Anchor::Start).with("fill", INK)
    }));
    if !band.is_empty() {
        let spot = entry(entries, curves.len() + measured.len());
        inside.extend(mean_band(&panel, band, spot, measured.len()));
    }
    for (k, curve) in curves.iter().enumerate() {
        let room = full - left - 60.0;
        inside.extend([drawn(&panel, curve), legend(curve, entry(entries, k), room)]);
    }
    inside.extend(limits(&panel, &curves));
    for (k, (name, points)) in measured.iter().enumerate() {
        let dashes = DASHES[k % DASHES.len()];
        let curve = thin_line(&panel.spots(points.iter().copied()), dashes);
        inside.push(Element::group("measured").containing([curve]));
        inside.extend(measured_legend(name, dashes, entry(entries, curves.len() + k), full));
    }
    let height = area.bottom() + MARGINS[2] - 8.0;
    Some(sheet(full, height, &format!("{name}: {}", text.title), inside))
}

/// A function that returns true if a curve has a certain kind of mark.
type IsMarked = fn(&CurveValues) -> bool;

/// Returns the notes that apply to at least one curve.
///
/// Other notes are omitted, because all notes together are wider than the figure.
fn notes(text: &FigureText, curves: &[Curve]) -> String {
    let [always, ring, dotted] = text.notes;
    let notes: [(&str, IsMarked); 6] = [
        (always, |_| true),
        (ring, |values| !values.rings.is_empty()),
        (dotted, |values| values.unstable.contains(&true)),
        ("▼ passing", |values| !values.passing.is_empty()),
        ("thin dashes: unloading", |values| !values.unloading.is_empty()),
        ("dots: limits of failure, the first one bold", |values| !values.limits.is_empty()),
    ];
    let shown = notes.into_iter().filter(|(words, occurs)| {
        !words.is_empty() && curves.iter().any(|curve| occurs(&curve.values))
    });
    shown.map(|(words, _)| words).collect::<Vec<_>>().join("; ")
}

/// Returns the position of entry `k` of a legend that starts at `(x, y)`.
fn entry([x, y]: Spot, k: usize) -> Spot {
    [x, y + 20.0 * k as f64]
}

/// Colour of measured curves.
const BLACK: &str = "#000";

/// Draws a measured curve.
fn thin_line(points: &[Spot], dashes: &'static str) -> Element {
    let line = polyline(points).with("stroke", BLACK).at("stroke-width", 0.9);
    line.with("stroke-dasharray", dashes).with("stroke-linejoin", "round")
}

/// Returns the legend of a measured curve: a line and the name of its file.
fn measured_legend(name: &str, dashes: &'static str, [x, y]: Spot, right: f64) -> [Element; 2] {
    // File names are plain text, without formulas.
    let size = 12.0 * ((right - x - 60.0) / (6.4 * name.chars().count() as f64)).min(1.0);
    let text = Element::new("text").at("x", x + 50.0).at("y", y + 4.0);
    let text = text.at("font-size", size).with("fill", INK).text(name);
    [thin_line(&[[x, y], [x + 40.0, y]], dashes), text]
}

/// Draws the mean curve of several specimens, with a band of one standard deviation around it.
///
/// The result includes an entry of the legend, at `(x, y)`.
fn mean_band(
    panel: &ChartPanel,
    band: &[[f64; 3]],
    [x, y]: Spot,
    specimens: usize,
) -> [Element; 4] {
    let [low, middle, high] = [-1.0, 0.0, 1.0].map(|side| {
        panel.spots(band.iter().map(|[x, mean, deviation]| [*x, mean + side * deviation]))
    });
    let around: Vec<Spot> = high.into_iter().chain(low.into_iter().rev()).collect();
    let mark = [x + 5.0, x + 37.0];
    let legend = [[mark[0], y - 5.0], [mark[1], y - 5.0], [mark[1], y + 5.0], [mark[0], y + 5.0]];
    let [around, legend] = [around.as_slice(), &legend].map(|points| {
        polygon(points).with("class", "band").with("fill", RED).with("fill-opacity", "0.16")
    });
    let mean = polyline(&middle).with("stroke", RED).at("stroke-width", 1.2);
    let words = format!("mean of {specimens} specimens ± standard deviation");
    let words = label(&words, [x + 50.0, y + 4.0], 12.0, Anchor::Start);
    [around, mean, legend, words.with("fill", INK)]
}

/// Returns the curve of each solved design.
///
/// Designs of the same slant differ in shade and dashes. `units` holds the factors of each design
/// to physical units; it is empty for dimensionless curves.
fn curves_of(designs: &[DesignCurves], values: ValuesOf, units: &[[f64; 2]]) -> Vec<Curve> {
    let palette = palette(designs);
    let mut curves: Vec<Curve> = Vec::new();
    for (k, solved) in designs.iter().enumerate() {
        let Some(mut values) = values(solved) else { continue };
        values.in_units(units.get(k).copied().unwrap_or([1.0; 2]));
        let slant = solved.case.design.slant_deg;
        // Designs without a curve count too, so that a design has the same style in every figure.
        let before = designs[..k].iter().filter(|other| other.case.design.slant_deg == slant);
        let before = before.count();
        let color = shaded(&palette.color(slant), SHADES[before % SHADES.len()]);
        let dashes = DASHES[before % DASHES.len()];
        let name = curve_name(solved);
        curves.push(Curve { name, color, dashes, values });
    }
    curves
}

fn curve_name(solved: &DesignCurves) -> String {
    format!("{}:  {}", solved.number, geometry_label(solved.case))
}

/// Returns the colours of the slants of some designs.
fn palette(designs: &[DesignCurves]) -> SlantPalette {
    SlantPalette::new(designs.iter().map(|solved| solved.case.design.slant_deg))
}

/// Fits both axes to `points` and zero.
fn axes(labels: [&str; 2], points: &[[f64; 2]]) -> (ChartAxis, ChartAxis) {
    let [x, y] = [0, 1].map(|k| {
        let (low, high) = crate::axis::ends(points.iter().map(|point| point[k]));
        ChartAxis::linear(labels[k], low.min(0.0), high)
    });
    (x, y)
}

/// Returns a logarithmic y axis if the maxima of the curves differ by more than a factor of 30.
///
/// `None` otherwise.
fn logarithmic(label: &str, curves: &[Curve]) -> Option<ChartAxis> {
    let ends = curves.iter().map(|curve| curve.values.all().map(|p| p[1]).fold(0.0, f64::max));
    let (low, high) = crate::axis::ends(ends);
    // Curves start at zero, which a logarithmic axis cannot show. The axis therefore starts a
    // factor of 30 below the smallest maximum of a curve.
    (low > 0.0 && high > 30.0 * low).then(|| ChartAxis::fit(label, [low / 30.0, high].into_iter()))
}

impl Curve {
    /// Splits the curve into stable and unstable parts, and adds the unloading path.
    ///
    /// Returns points, dash pattern and line width of each part.
    fn parts(&self) -> Vec<(&[[f64; 2]], &'static str, f64)> {
        let CurveValues { points, unloading, .. } = &self.values;
        let mut parts = Vec::new();
        let mut start = 0;
        for end in 1..points.len() {
            if end + 1 == points.len()
                || self.values.is_unstable(end) != self.values.is_unstable(start)
            {
                let dashes = if self.values.is_unstable(start) { UNSTABLE } else { self.dashes };
                parts.push((&points[start..=end], dashes, 1.8));
                start = end;
            }
        }
        // The stability of the unloading path is unknown.
        parts.extend((!unloading.is_empty()).then_some((&unloading[..], UNLOADING, 1.1)));
        parts
    }
}

fn drawn(panel: &ChartPanel, curve: &Curve) -> Element {
    let values = &curve.values;
    let [crosses, rings, passing] = [&values.crosses, &values.rings, &values.passing]
        .map(|points| panel.spots(points.iter().copied()));
    let paths = curve.parts().into_iter().map(|(points, dashes, width)| {
        polyline(&panel.spots(points.iter().copied()))
            .with("stroke", curve.color.as_str())
            .at("stroke-width", width)
            .with("stroke-dasharray", dashes)
            .with("stroke-linejoin", "round")
    });
    let crosses = apart(crosses).into_iter().flat_map(|[x, y]| {
        [1.0, -1.0].map(|s| line([x - 3.0, y - 3.0 * s], [x + 3.0, y + 3.0 * s], INK, 0.8))
    });
    let rings = rings
        .into_iter()
        .map(|at| circle(at, 6.5).with("fill", "none").with("stroke", RED).at("stroke-width", 2.2));
    // The tip of the triangle touches the curve.
    let passing = passing.into_iter().map(|[x, y]| {
        let mark = polygon(&[[x, y], [x - 5.0, y - 9.0], [x + 5.0, y - 9.0]]);
        mark.with("fill", curve.color.as_str()).with("stroke", INK).with("class", "passing")
    });
    Element::group("curve")
        .containing(paths)
        .containing(crosses)
        .containing(rings)
        .containing(passing)
}

/// Removes spots within [`CROSS`] of the previous spot, so that crosses do not hide the curve.
fn apart(spots: Vec<Spot>) -> Vec<Spot> {
    let mut kept: Vec<Spot> = Vec::new();
    for [x, y] in spots {
        if kept.last().is_none_or(|last| (x - last[0]).hypot(y - last[1]) > CROSS) {
            kept.push([x, y]);
        }
    }
    kept
}

fn legend(curve: &Curve, [x, y]: Spot, room: f64) -> Element {
    let sample =
        line([x, y], [x + 40.0, y], &curve.color, 2.2).with("stroke-dasharray", curve.dashes);
    let size = fitting(&curve.name, 12.0, room);
    let name = label(&curve.name, [x + 50.0, y + 4.0], size, Anchor::Start);
    Element::group("legend").containing([sample, name.with("fill", INK)])
}
