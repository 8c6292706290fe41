//! What a page gets.

use results::{Cell, Column, DesignRow, ParameterDerivative};
use serde::Serialize;
use skin::flexure::{Flexure, StripSnapshot};
use skin::puncture::{Puncture, RowSnapshot};
use skin::Contact;
use sweep::Case;

/// A solved design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    /// The number of the request.
    pub id: u64,
    /// The columns of `designs.csv` that have a value.
    pub values: Vec<Value>,
    /// The puncture, if it was asked for and ran.
    pub puncture: Option<PuncturePath>,
    /// The bending, if it was asked for and ran.
    pub flexure: Option<FlexurePath>,
    /// The derivatives of the measures, if they were asked for.
    pub slopes: Vec<Slope>,
}

/// A column of the design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Value {
    /// Name of the column.
    pub name: String,
    /// Unit, `-` if it has none.
    pub unit: &'static str,
    /// The meaning, in half a sentence.
    pub meaning: &'static str,
    /// The number, if it is one.
    pub value: Option<f64>,
    /// The text as tables have it.
    pub text: String,
}

impl Value {
    pub(crate) fn new(column: &Column<DesignRow>, cell: &Cell) -> Self {
        let (name, text) = (column.name.clone().into_owned(), cell.to_string());
        Self { name, unit: column.unit, meaning: column.meaning, value: cell.number(), text }
    }
}

/// A row of scales on its way to the critical tilt. Lengths over `t`, angles in degrees, forces as in the tables.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PuncturePath {
    /// `u*`, `F*`, tilt and closed contacts of every equilibrium.
    pub path: Vec<[f64; 4]>,
    /// `u*` and `F*` where a contact closes, opens or passes a corner.
    pub events: Vec<[f64; 2]>,
    /// `u*` and `F*` where the surface of the substrate first folds over.
    pub fold: Option<[f64; 2]>,
    /// States between rest and the end.
    pub frames: Vec<PunctureFrame>,
    /// Place of the load on the top of the punctured scale: 0 the left corner, 1 the right one.
    pub load_position: f64,
}

/// A row in equilibrium.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PunctureFrame {
    /// `u*`.
    pub displacement: f64,
    /// `F*`.
    pub force: f64,
    /// Tilt of the punctured scale, degrees.
    pub tilt: f64,
    /// Number, displacement and rotation (degrees, counter-clockwise) of every scale.
    pub scales: Vec<[f64; 4]>,
    /// Place and force of every closed contact.
    pub contacts: Vec<[f64; 4]>,
}

/// A strip on its way to the largest end rotation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlexurePath {
    /// `κ*`, `M*`, end rotation and closed contacts of every equilibrium.
    pub path: Vec<[f64; 4]>,
    /// `κ*` and `M*` where a contact closes, opens or passes a corner.
    pub events: Vec<[f64; 2]>,
    /// States between rest and the end.
    pub frames: Vec<FlexureFrame>,
}

/// A strip in equilibrium.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlexureFrame {
    /// `κ*`.
    pub curvature: f64,
    /// `M*`.
    pub moment: f64,
    /// Rotation of each end, degrees.
    pub rotation: f64,
    /// Displacement and rotation (radians, counter-clockwise) of every scale.
    pub scales: Vec<[f64; 3]>,
    /// Axis of the membrane in every gap.
    pub membrane: Vec<Vec<[f64; 2]>>,
    /// Place and force of every closed contact.
    pub contacts: Vec<[f64; 4]>,
}

/// The derivative of a measure with respect to a parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Slope {
    /// The measure, as its column.
    pub measure: &'static str,
    /// The key of the parameter.
    pub parameter: &'static str,
    /// Where the parameter decreases.
    pub left: Option<f64>,
    /// Where the parameter increases.
    pub right: Option<f64>,
    /// What changes at a kink, if there is one.
    pub kink: Option<String>,
}

impl PuncturePath {
    pub(crate) fn new(case: &Case, puncture: &Puncture, states: Vec<RowSnapshot>) -> Self {
        let point = |p: &skin::puncture::PuncturePoint| {
            [p.displacement, p.force, p.tilt_deg, p.contacts as f64]
        };
        let events = puncture.events.iter().map(|e| [e.point.displacement, e.point.force]);
        Self {
            path: puncture.path.iter().map(point).collect(),
            events: events.collect(),
            fold: puncture.folds.first().map(|f| [f.point.displacement, f.point.force]),
            frames: states.into_iter().map(PunctureFrame::new).collect(),
            load_position: case.puncture.load_position,
        }
    }
}

impl PunctureFrame {
    fn new(state: RowSnapshot) -> Self {
        let scale = |s: &skin::puncture::ScaleState| {
            drawn([s.scale as f64, s.displacement[0], s.displacement[1], s.rotation_deg])
        };
        Self {
            displacement: state.displacement,
            force: state.force,
            tilt: state.tilt_deg,
            scales: state.scales.iter().map(scale).collect(),
            contacts: state.contacts.iter().map(contact).collect(),
        }
    }
}

impl FlexurePath {
    pub(crate) fn new(flexure: &Flexure, states: Vec<StripSnapshot>) -> Self {
        let point = |p: &skin::flexure::FlexurePoint| {
            [p.curvature, p.moment, p.end_rotation_deg, p.contacts as f64]
        };
        let events = flexure.events.iter().map(|e| [e.point.curvature, e.point.moment]);
        Self {
            path: flexure.path.iter().map(point).collect(),
            events: events.collect(),
            frames: states.into_iter().map(FlexureFrame::new).collect(),
        }
    }
}

impl FlexureFrame {
    fn new(state: StripSnapshot) -> Self {
        Self {
            curvature: state.curvature,
            moment: state.moment,
            rotation: state.end_rotation_deg,
            scales: state.scales.into_iter().map(drawn).collect(),
            membrane: state.membrane.iter().map(|axis| axis.iter().copied().map(drawn).collect()).collect(),
            contacts: state.contacts.iter().map(contact).collect(),
        }
    }
}

impl Slope {
    pub(crate) fn new(derivative: &ParameterDerivative) -> Self {
        let ParameterDerivative { measure, parameter, left, right, ref kink, .. } = *derivative;
        Self { measure, parameter, left, right, kink: kink.clone() }
    }
}

fn contact(contact: &Contact) -> [f64; 4] {
    let ([x, y], [fx, fy]) = (contact.point, contact.force);
    drawn([x, y, fx, fy])
}

/// Numbers as a drawing needs them. A frame of a strip has thousands, and each with all its digits would make an answer of megabytes.
fn drawn<const N: usize>(numbers: [f64; N]) -> [f64; N] {
    numbers.map(|number| (number * 1e5).round() / 1e5)
}
