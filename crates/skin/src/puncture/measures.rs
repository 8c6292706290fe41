//! The numbers that a puncture comes down to.

use serde::{Deserialize, Serialize};
use solver::Path;

use super::system::Chain;
use crate::contacts::Contacts;
use crate::record::{Record, Skin};

/// The measures of a puncture; `None` where the value does not exist.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PunctureMeasures {
    /// `F_c* = F (1−ν²)/(E_s L t)` at the critical tilt.
    pub critical_force: Option<f64>,
    /// Largest `F*` up to the critical tilt.
    pub peak_force: Option<f64>,
    /// `u_c* = u/t` of the punctured point at the critical tilt.
    pub critical_displacement: Option<f64>,
    /// Depth of the deepest base corner of any scale at the critical tilt, over `t`.
    pub penetration: Option<f64>,
    /// Depth of the deepest node at the critical tilt, over `t`.
    pub sink: Option<f64>,
    /// `u*` at the first contact.
    pub first_contact_displacement: Option<f64>,
    /// Contacts at the critical tilt.
    pub contacts: Option<usize>,
    /// Scales that touch a neighbour at the critical tilt.
    pub engaged_scales: Option<usize>,
    /// Scales in the row.
    pub scales: usize,
    /// `K* = K/(E_s t)` at rest.
    pub initial_stiffness: Option<f64>,
    /// Largest `K*` on the path.
    pub max_stiffness: Option<f64>,
    /// Secant `K*` at the critical tilt.
    pub secant_stiffness: Option<f64>,
}

impl PunctureMeasures {
    /// The measures of a path that came to its end. Stiffness is measured in `E_s t`, the force in `E* t²`.
    pub(crate) fn new(record: &Record<Chain>, path: &mut Path<Chain>) -> Self {
        let max_stiffness = record.largest_stiffness(path);
        let (chain, state) = (path.system(), &path.point().state);
        let (end, modulus) = (chain.path_point(path.point()), chain.plane_modulus);
        let scales = 0..chain.layout.scales();
        let nodes = scales.clone().map(|i| -chain.displacement(&state.z, i)[1]);
        Self {
            critical_force: Some(end.force),
            peak_force: record.path.iter().map(|point| point.force).reduce(f64::max),
            critical_displacement: Some(end.displacement),
            penetration: scales.map(|i| chain.base_depth(&state.z, i)).reduce(f64::max),
            sink: nodes.reduce(f64::max),
            first_contact_displacement: record.first_contact().map(|point| point.displacement),
            contacts: Some(end.contacts),
            engaged_scales: Some(engaged(&Contacts::touching(state).collect::<Vec<_>>())),
            scales: chain.layout.scales(),
            initial_stiffness: Some(modulus * record.initial_stiffness()),
            max_stiffness: max_stiffness.map(|stiffness| modulus * stiffness),
            secant_stiffness: Some(modulus * end.force * chain.length / end.displacement),
        }
    }

    /// The measures of the beginning of a path, for one that did not end as it should.
    pub(crate) fn without_final_values(self) -> Self {
        Self {
            first_contact_displacement: self.first_contact_displacement,
            scales: self.scales,
            initial_stiffness: self.initial_stiffness,
            ..Self::default()
        }
    }
}

/// Scales that touch a neighbour, from which pairs are `touching`.
fn engaged(touching: &[bool]) -> usize {
    let touches = |pair: Option<usize>| pair.is_some_and(|pair| touching.get(pair) == Some(&true));
    (0..=touching.len()).filter(|&i| touches(Some(i)) || touches(i.checked_sub(1))).count()
}
