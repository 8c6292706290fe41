//! Tests of the loads on single scales, from which stresses are computed.

use super::needle::CASES;
use super::*;
use crate::puncture::Needle;
use crate::puncture::needle::unknowns;

/// Asserts that the loads on each scale and the reaction of the substrate are in equilibrium.
///
/// Checks every point of a path. Returns the largest number of loads on a scale.
fn compare_loads(path: Continuation<Chain>) -> usize {
    let (chain, mut most) = (path.system().clone(), 0);
    for point in path {
        let z = &point.state.z;
        let size = z[chain.layout.load()].abs().max(1e-3);
        for scale in 0..chain.layout.scales() {
            let loads = chain.loads(&point.state, scale);
            most = most.max(loads.len());
            let pose = chain.contacts.pose(z, scale);
            let mut sum = chain.reaction(z, scale.cast_signed());
            for load in loads {
                let force = pose.turn(load.force);
                sum[0] += force.x;
                sum[1] += force.y;
                sum[2] += load.arm.perp(&load.force);
            }
            for sum in sum {
                assert!(sum.abs() < 1e-7 * size, "{sum} {size} scale {scale}");
            }
        }
    }
    most
}

#[test]
fn loads_on_a_scale_balance_its_springs() {
    let mut most = Vec::new();
    for (design, modulus) in [(LIVELY, 30.0), (FOLDING, HARD), (SLIDING, 300.0), (DOMINO, HARD)] {
        let hard = law(&design, Law::PRINTED, modulus);
        most.push(compare_loads(path(&design, hard, 1.0)));
        let rough = hard.with_friction(0.2).unwrap();
        most.push(compare_loads(path(&design, rough, 1.0)));
    }
    // The paths must cover a scale with contacts on both sides and at both levels.
    assert!(most.iter().any(|&loads| loads >= 4), "{most:?}");
}

#[test]
fn loads_under_a_guided_needle_balance_the_springs() {
    for (gap, length, slant, friction, inside) in CASES {
        let design = needle::design(gap, length, slant);
        compare_loads(needle::guided_path(&design, friction, inside, 0.1));
        for friction in [0.0, 0.3] {
            let design = needle::design(gap, length, slant);
            let law = law(&design, Law::PRINTED, HARD);
            let parameters = PunctureParameters {
                needle: Needle::Guided { friction },
                needle_radius: Some(0.3),
                ..PunctureParameters::default()
            };
            let reach = crate::puncture::needle::reach(0.3, length + gap).unwrap();
            let needle = unknowns(reach, friction > 0.0);
            let side = reach.max(10);
            let layout = RowLayout { left: side, right: side, needle, contacts: 6 };
            let springs = (&calibrate(&design.footprint(0.5).unwrap()).unwrap()).into();
            let chain = whole(&springs, &design, law, layout, &parameters);
            let rest = chain.at_rest();
            compare_loads(Continuation::new(chain, rest, Settings::default()));
        }
    }
}
