//! Compares first contact with a linear chain of springs under a load with a rotating arm.
//!
//! The Green's functions of [`analytical::linear_chain`] give the poses of all scales as functions
//! of the tilt. First contact is the point at which a gap closes.

use analytical::linear_chain;
use approx::assert_relative_eq;
use contact::{CornerEdge, Pair, Pose};
use skin::{Base, Design};
use substrate::{Calibrations, Springs};

use crate::samples::{design, on_row, solve_with, springs};

const SCALES: usize = 41;

/// Computes the depth of the loaded corner and its gap to the right neighbour at the tilt `ψ`.
fn before_contact(design: &Design, springs: &Springs, psi: f64) -> [f64; 2] {
    let scale = *design.row().unwrap().scale();
    let a = scale.half_base();
    let [normal, rotation] = [(1, a), (2, a.powi(3))].map(|(k, unit)| {
        linear_chain::compliance(SCALES, unit * springs.direct[k], unit * springs.coupling[k])
    });
    let arm = [a + scale.shift(), 1.0];
    let lever = arm[0] * psi.cos() + arm[1] * psi.sin();
    let force = psi / (rotation.middle * lever);
    let (y, y_next) = (-force * normal.middle, -force * normal.neighbour);
    let psi_next = psi * rotation.neighbour / rotation.middle;
    let (left, right) = (Pose::new(0.0, y, -psi), Pose::new(0.0, y_next, -psi_next));
    let pair = Pair::new(scale, design.row().unwrap().pitch());
    let depth = -y + arm[0] * psi.sin() + arm[1] * (1.0 - psi.cos());
    [depth, pair.distance(CornerEdge::TopRightOnLeftEdge, &left, &right)]
}

fn first_contact(design: &Design, springs: &Springs) -> f64 {
    let (mut low, mut high) = (1e-9, 0.2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if before_contact(design, springs, middle)[1] > 0.0 { low = middle } else { high = middle }
    }
    before_contact(design, springs, low)[0]
}

/// Compares the displacement at first contact, also with rounded values.
///
/// Fig. 6b of Shafiei et al. (2021) shows first contact at "about 0.08", for `L/t = 1`, `d/t = 0.1`
/// and slants of 0° and 45°. A base of `L` gives 0.081 and 0.059, a base of `2L` 0.154 and 0.070.
#[test]
fn first_contact_matches_the_linear_chain() {
    let known = Calibrations::default();
    for (base, slant, rounded) in [
        (Base::L, 0.0, 0.0809),
        (Base::L, 45.0, 0.0588),
        (Base::TwoL, 0.0, 0.1540),
        (Base::TwoL, 45.0, 0.0700),
    ] {
        let (design, parameters) = (design(0.1, 1.0, slant, base), on_row(SCALES));
        let puncture = solve_with(&known, &design, &parameters);
        let exact = first_contact(&design, &springs(&design, &parameters, &known));
        let ours = crate::complete(&puncture).first_contact_displacement.unwrap();
        assert_relative_eq!(ours, exact, max_relative = 1e-9);
        assert_relative_eq!(ours, rounded, epsilon = 5e-5);
        assert_eq!(puncture.events[0].corner_edge, CornerEdge::TopRightOnLeftEdge);
        assert_eq!(puncture.events[0].left_scale, Some(0));
    }
}
