//! One scale without neighbours.
//!
//! With the load `F` down at `r` from the node of a scale that has turned by `ψ` clockwise, and
//! nothing that holds it but its own springs,
//!
//! ```text
//! a α_y y = −F,    a³ α_φ ψ = F (r_x cos ψ + r_y sin ψ)
//! u = −y + r_x sin ψ + r_y (1 − cos ψ)
//! ```
//!
//! so that `F(ψ)` and `u(ψ)` are known in closed form, as are the energies `½ a α_y y²` and `½ a³ α_φ ψ²`.

use approx::assert_relative_eq;
use contact::Law;
use skin::Base;
use skin::Status;
use skin::puncture::Parameters;
use solver::Stop;
use substrate::Calibrations;

use crate::samples::{design, on_row, small_steps, solve_with, springs};

/// What the path of a scale must follow.
struct ClosedForm {
    /// `a α_y`, `a³ α_φ`.
    stiffness: [f64; 2],
    /// `r`.
    arm: [f64; 2],
}

impl ClosedForm {
    /// `F` and `u` at a tilt.
    fn at(&self, psi: f64) -> [f64; 2] {
        let ([normal, rotation], [x, y]) = (self.stiffness, self.arm);
        let (sin, cos) = psi.sin_cos();
        let force = rotation * psi / (x * cos + y * sin);
        [force, force / normal + x * sin + y * (1.0 - cos)]
    }

    /// `dF/du` at rest.
    fn initial_stiffness(&self) -> f64 {
        let ([normal, rotation], [x, _]) = (self.stiffness, self.arm);
        1.0 / (1.0 / normal + x * x / rotation)
    }
}

fn closed_form(design: &skin::Design, parameters: &Parameters, known: &Calibrations) -> ClosedForm {
    let (a, springs) = (design.half_base(), springs(design, parameters, known));
    let shift = design.slant_deg.to_radians().tan();
    ClosedForm {
        stiffness: [a * springs.direct[1], a.powi(3) * springs.direct[2]],
        arm: [shift - a + 2.0 * a * parameters.load_position, 1.0],
    }
}

#[test]
fn the_whole_path_follows_the_closed_form() {
    let known = Calibrations::default();
    for base in [Base::L, Base::TwoL] {
        for (gap, length, slant) in
            [(0.1, 1.0, 0.0), (0.1, 0.025, 75.0), (1.0, 0.5, 45.0), (0.05, 3.0, 80.0)]
        {
            for load_position in [1.0, 0.8] {
                let design = design(gap, length, slant, base);
                let parameters = Parameters { load_position, solver: small_steps(), ..on_row(1) };
                let exact = closed_form(&design, &parameters, &known);
                let puncture = solve_with(&known, &design, &parameters);
                assert_eq!(puncture.status, Status::Complete);
                assert!(puncture.path.len() > 10);
                for point in &puncture.path {
                    let psi = point.tilt_deg.to_radians();
                    let [force, displacement] = exact.at(psi);
                    assert_relative_eq!(point.force * length, force, max_relative = 1e-9);
                    assert_relative_eq!(point.displacement, displacement, max_relative = 1e-9);
                    let [normal, rotation] = exact.stiffness;
                    let energy = 0.5 * (force.powi(2) / normal + rotation * psi.powi(2));
                    assert_relative_eq!(point.substrate_energy, energy, max_relative = 1e-9);
                    assert_eq!((point.contact_energy, point.contacts), (0.0, 0));
                }
            }
        }
    }
}

#[test]
fn its_measures_are_those_of_the_closed_form() {
    let known = Calibrations::default();
    let (design, parameters) = (design(0.3, 0.4, 30.0, Base::L), on_row(1));
    let exact = closed_form(&design, &parameters, &known);
    let measures = solve_with(&known, &design, &parameters).measures;
    let psi = 10.0_f64.to_radians();
    let [force, displacement] = exact.at(psi);
    let near = |ours: Option<f64>, exact| {
        assert_relative_eq!(ours.unwrap(), exact, max_relative = 1e-9);
    };
    // Incompressible: E*/E_s = 4/3.
    near(measures.initial_stiffness, 4.0 / 3.0 * exact.initial_stiffness());
    near(measures.secant_stiffness, 4.0 / 3.0 * force / displacement);
    near(measures.critical_force, force / 0.4);
    near(measures.critical_displacement, displacement);
    near(measures.sink, force / exact.stiffness[0]);
    near(measures.penetration, force / exact.stiffness[0] + 0.2 * psi.sin());
    assert_eq!(measures.first_contact_displacement, None);
    assert_eq!((measures.contacts, measures.engaged_scales), (Some(0), Some(0)));
}

/// A load above the node of an upright block has no arm: the block sinks and does not tilt, until
/// it buckles. The tilt cannot drive it.
#[test]
fn a_load_over_the_node_does_not_tilt_a_block() {
    let parameters = Parameters { load_position: 0.5, law: Law::EXCHANGED, ..on_row(1) };
    let puncture = crate::samples::solve(&design(0.1, 1.0, 0.0, Base::L), &parameters);
    assert_eq!(puncture.status, Status::Stopped(Stop::Singular));
    assert_eq!(puncture.measures.critical_force, None);
}
