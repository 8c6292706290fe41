//! Tests of elastic scales.

use super::*;
use crate::puncture::bending::BENDING_UNKNOWNS;
use crate::puncture::{Bending, RowLength, Strengths};

const SLENDER: Design =
    Design { gap: 0.1, length: 0.2, slant_deg: 60.0, base: Base::L, width: 1.0 };

const UPRIGHT: Design =
    Design { gap: 0.05, length: 0.2, slant_deg: 0.0, base: Base::L, width: 1.0 };

const GLOVE: Design = Design { gap: 0.3, length: 1.0, slant_deg: 60.0, base: Base::L, width: 1.0 };

fn elastic(modulus: f64) -> PunctureParameters {
    PunctureParameters {
        bending: Bending::Elastic,
        contact_modulus_over_substrate: modulus,
        failure: Some(Strengths::default()),
        ..PunctureParameters::default()
    }
}

/// Starts the path of a row of 21 elastic scales on a body; `modulus` is `E_c/E_s`.
fn elastic_path(design: &Design, modulus: f64, curvature: f64) -> Continuation<Chain> {
    let law = law(design, Law::EXCHANGED, HARD);
    let needle = BENDING_UNKNOWNS;
    let layout = RowLayout { left: 10, right: 10, needle, contacts: pair_constraints(&law) };
    let stiffness = (&calibrate(&design.footprint(0.5).unwrap()).unwrap()).into();
    let parameters = PunctureParameters { curvature, ..elastic(modulus) };
    let chain = whole(&stiffness, design, law, layout, &parameters);
    let rest = SkinState::at_rest(&chain);
    let settings = Settings { max_step: 0.02, ..Settings::default() };
    Continuation::new(chain, rest, settings)
}

/// Design, `E_c/E_s` of its scales, and curvature of the body.
const SOFT: [(Design, f64, f64); 6] = [
    (SLENDER, 3e4, 0.0),
    (UPRIGHT, 5e3, 0.0),
    (GLOVE, 100.0, 0.0),
    (DOMINO, 1e6, 0.0),
    (GLOVE, 100.0, 0.05),
    (LIVELY, 300.0, 0.0),
];

#[test]
fn tangent_of_elastic_scales_matches_differences() {
    let (mut most, mut checked, mut segments) = (0, 0, 0);
    for (design, modulus, curvature) in SOFT {
        for_segments(elastic_path(&design, modulus, curvature), |path, from, to| {
            // Check only every second segment, because the difference quotients are slow.
            segments += 1;
            if segments % 2 == 0 {
                return;
            }
            let state = path.between(from, to, 0.5).unwrap().state;
            let chain = path.system();
            let forces = chain.contacts.closed_edges(&state).into_iter().map(|edge| edge.force);
            // The step of the difference is a fraction of the force, so the result for a tiny force
            // is round-off.
            if forces.fold(1.0, f64::min) > 1e-5 * state.z[chain.load()] {
                check_tangent(chain, &state, 1e-6).unwrap();
                checked += 1;
            }
            let loads = (0..21).map(|scale| chain.loads(&state, scale).len());
            most = most.max(loads.max().unwrap());
        });
    }
    // Some scales must carry two loads: the needle and a contact, or a contact on each side.
    assert!(most >= 2 && checked > 100, "{most} {checked}");
}

#[test]
fn work_equals_the_energy_of_springs_contacts_and_scales() {
    for (design, modulus, curvature) in SOFT {
        let (mut done, mut off, mut bent) = (0.0, 0.0_f64, 0.0_f64);
        for_segments(elastic_path(&design, modulus, curvature), |path, from, to| {
            done += work(path, from, to);
            let chain = path.system();
            off = off.max((done - chain.stored(&to.state)).abs());
            bent = bent.max(chain.bending_energy(&to.state));
        });
        assert!(off < 1e-8 * done, "{:e} {design:?}", off / done);
        assert!(bent > 1e-3 * done, "{:e} {design:?}", bent / done);
    }
}

fn solve(design: &Design, parameters: &PunctureParameters) -> crate::puncture::Puncture {
    let springs = calibrate(&design.footprint(0.5).unwrap()).unwrap();
    crate::puncture::solve(design, &springs, &Common::default(), parameters).unwrap()
}

/// Cantilever on springs under a dead load at the right corner of its top.
struct Isolated {
    /// Slant, radians.
    slant: f64,
    /// Length of the beam.
    length: f64,
    /// Vector from the node to the loaded point.
    arm: [f64; 2],
    /// Bending stiffness of a section.
    bending: f64,
    /// Shear stiffness of a section.
    shear: f64,
    /// Spring constant of the rotation.
    rotation: f64,
}

impl Isolated {
    /// Returns the moment at the base and the transverse force per unit load, at a rotation `phi`.
    fn of_load(&self, phi: f64) -> (f64, f64) {
        let [x, y] = [-phi.sin(), -phi.cos()];
        let (sin, cos) = self.slant.sin_cos();
        (self.arm[0] * y - self.arm[1] * x, sin * y - cos * x)
    }

    /// Returns the displacement of the loaded point along the load by bending, per unit load.
    fn flexibility(&self, phi: f64) -> f64 {
        let ((m, v), l) = (self.of_load(phi), self.length);
        (m * m * l - m * v * l.powi(2) + v * v * l.powi(3) / 3.0) / self.bending
            + v * v * l / self.shear
    }

    /// Returns the residual of the equilibrium of moments on the springs.
    fn balance(&self, force: f64, phi: f64) -> f64 {
        let slope = (self.flexibility(phi + 1e-5) - self.flexibility(phi - 1e-5)) / 2e-5;
        let arm = self.arm[0] * phi.cos() - self.arm[1] * phi.sin();
        self.rotation * phi + force * arm - 0.5 * force * force * slope
    }
}

/// The rotation follows from the equilibrium of moments, tilt and depth from a clamped beam.
#[test]
fn an_isolated_elastic_scale_follows_its_closed_form() {
    let design = Design { gap: 0.1, length: 0.3, slant_deg: 50.0, base: Base::L, width: 0.8 };
    let modulus = 2e3;
    let parameters = PunctureParameters { scales: RowLength::Scales(1), ..elastic(modulus) };
    let puncture = solve(&design, &parameters);
    let springs = calibrate(&design.footprint(0.5).unwrap()).unwrap();
    let [_, normal, rotation] = RowStiffness::from(&springs).with_lengths_over(0.15).direct;
    let slant = 50.0_f64.to_radians();
    let (length, depth) = (1.0 / slant.cos(), 0.3 * slant.cos());
    // `E*/E_s` is 4/3, so the modulus in units of `E*` is 0.75 times the modulus in units of `E_s`.
    let bending = modulus * 0.75 * 0.8 * depth.powi(3) / 12.0;
    let shear = 5.0 / 6.0 * modulus * 0.75 / 2.7 * 0.8 * depth;
    let exact =
        Isolated { slant, length, arm: [slant.tan() + 0.15, 1.0], bending, shear, rotation };
    assert!(puncture.path.len() > 5);
    let mut largest = 0.0_f64;
    for point in &puncture.path[1..] {
        let force = point.force * 0.3;
        let (mut low, mut high) = (-0.5, 0.0);
        for _ in 0..100 {
            let middle = f64::midpoint(low, high);
            *(if exact.balance(force, middle) < 0.0 { &mut low } else { &mut high }) = middle;
        }
        let (m, v) = exact.of_load(low);
        let bent = force * (m * length - v * length.powi(2) / 2.0) / bending;
        largest = largest.max((bent / low).abs());
        assert_relative_eq!(point.tilt_deg, -(low + bent).to_degrees(), max_relative = 1e-7);
        let [x, y] = exact.arm;
        let rigid = force / normal + y - (x * low.sin() + y * low.cos());
        let depth = rigid + force * exact.flexibility(low);
        assert_relative_eq!(point.displacement, depth, max_relative = 1e-7);
    }
    assert!(largest > 0.01, "{largest}");
}

fn critical_force(design: &Design, bending: Bending, modulus: f64) -> f64 {
    let solved = solve(design, &PunctureParameters { bending, ..elastic(modulus) });
    assert_eq!(solved.status, Status::Complete, "{design:?} {modulus}");
    solved.measures.critical_force.unwrap()
}

/// With the same contact law, the difference from rigid scales decreases as `1/E_c`.
#[test]
fn stiff_elastic_scales_converge_to_rigid_ones() {
    for design in [SLENDER, GLOVE, DOMINO, UPRIGHT] {
        let off = [1e9, 1e10].map(|modulus| {
            let elastic = critical_force(&design, Bending::Elastic, modulus);
            elastic / critical_force(&design, Bending::Rigid, modulus) - 1.0
        });
        assert!(off[0].abs() < 1e-2 && off[1] != 0.0, "{design:?} {off:?}");
        assert_relative_eq!(off[0] / off[1], 10.0, max_relative = 0.05);
    }
}

/// The design of the paper with the largest critical force reaches the limit of bending first.
#[test]
fn a_slender_scale_fails_by_bending() {
    let design = Design { gap: 0.1, length: 0.1, slant_deg: 75.0, base: Base::L, width: 1.0 };
    let solved = solve(&design, &elastic(9677.0));
    assert_eq!(solved.status, Status::Bent);
    assert_eq!(solved.measures.critical_force, None);
    assert_eq!(solved.measures.failure.mode, Some(crate::puncture::FailureMode::Bend));
    let force = solved.measures.failure.force.unwrap();
    assert_eq!(solved.path.last().unwrap().force, force);
    assert!(force > 0.0);
}
