//! The path up to the first contact: a linear chain under a load whose arm turns.
//!
//! Without contact each of `y` and `φ` obeys a tridiagonal system of its own. With its Green's
//! functions `G` (displacement of scale `i` for a unit on the middle one), all poses follow from
//! the tilt alone, and the first contact is where one gap closes.

use approx::assert_relative_eq;
use contact::{CornerEdge, Pair, Pose};
use skin::{Base, Design};
use substrate::{Calibrations, Springs};

use crate::samples::{design, on_row, solve_with, springs};

const SCALES: usize = 41;

/// Displacements of the middle scale and its right neighbour for a unit on the middle one, by the
/// Thomas algorithm on `direct u_i − coupling (u_{i−1} + u_{i+1}) = δ_im`.
fn green(direct: f64, coupling: f64) -> [f64; 2] {
    let middle = SCALES / 2;
    let (mut above, mut right) = (vec![0.0; SCALES], vec![0.0; SCALES]);
    for i in 0..SCALES {
        let [c, r] = if i > 0 { [above[i - 1], right[i - 1]] } else { [0.0; 2] };
        let pivot = direct + coupling * c;
        above[i] = -coupling / pivot;
        right[i] = (f64::from(u8::from(i == middle)) + coupling * r) / pivot;
    }
    let mut u = right;
    for i in (0..SCALES - 1).rev() {
        u[i] -= above[i] * u[i + 1];
    }
    [u[middle], u[middle + 1]]
}

/// Depth of the loaded corner and gap of the right neighbour at a tilt `ψ`.
fn before_contact(design: &Design, springs: &Springs, psi: f64) -> [f64; 2] {
    let scale = *design.row().unwrap().scale();
    let a = scale.half_base();
    let [middle, next] = green(a.powi(3) * springs.direct[2], a.powi(3) * springs.coupling[2]);
    let arm = [a + scale.shift(), 1.0];
    let lever = arm[0] * psi.cos() + arm[1] * psi.sin();
    let force = psi / (middle * lever);
    let [y, y_next] =
        green(a * springs.direct[1], a * springs.coupling[1]).map(|compliance| -force * compliance);
    let (left, right) = (Pose::new(0.0, y, -psi), Pose::new(0.0, y_next, -psi * next / middle));
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

/// Fig. 6b of Shafiei et al. (2021) puts it at "about 0.08" for `L/t = 1`, `d/t = 0.1` and slants of 0° and
/// 45°. With a base of `L` it is at 0.081 and 0.059, with a base of `2L` at 0.154 and 0.070.
#[test]
fn happens_where_the_linear_chain_closes_the_gap() {
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
