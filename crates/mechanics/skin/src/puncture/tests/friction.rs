//! Tests of friction between scales: tangent, friction cone and mirror images.

use std::collections::BTreeSet;

use approx::assert_relative_eq;
use contact::{CornerContact, Law};
use solver::{System as _, check_tangent};
use substrate::calibrate;

use super::{BLOCKS, DOMINO, FOLDING, HARD, LIVELY, SLIDING, for_segments, law, path};
use crate::contacts::Contacts;
use crate::puncture::{Needle, Problem, PunctureParameters, RowLength, Rows};
use crate::{Common, Design, Status};

#[test]
fn tangent_matches_finite_differences_in_stick_and_slip() {
    let mut seen = BTreeSet::new();
    for constants in [Law::PRINTED, Law::EXCHANGED] {
        for (design, friction) in [(LIVELY, 0.1), (FOLDING, 0.2), (SLIDING, 0.1), (BLOCKS, 0.4)] {
            let law = law(&design, constants, HARD).with_friction(friction).unwrap();
            for_segments(path(&design, law, 1.0), |path, from, to| {
                let Some(point) = path.between(from, to, 0.5) else { return };
                let [sticking, slipping] = Contacts::stick_slip_counts(&point.state);
                seen.extend(
                    [("sticks", sticking), ("slips", slipping)]
                        .iter()
                        .filter(|s| s.1 > 0)
                        .map(|s| s.0),
                );
                // Increase small stick multipliers and slip distances, because differences near
                // zero consist of round-off.
                let (chain, mut state) = (path.system(), point.state);
                for number in (0..chain.constraints().len()).filter(|&c| state.active[c]) {
                    let unknown = chain.constraints()[number];
                    if chain.contacts.is_friction(number) {
                        state.z[unknown] = state.z[unknown].max(1e-3);
                    }
                }
                check_tangent(chain, &state, 1e-6).unwrap();
            });
        }
    }
    assert_eq!(seen, BTreeSet::from(["slips", "sticks"]));
}

/// Checks the angle between force and normal at every point of the path.
#[test]
fn forces_stay_within_the_friction_cone() {
    let mut compared = 0;
    for (design, friction) in [(LIVELY, 0.1), (DOMINO, 0.2), (BLOCKS, 0.4)] {
        let law = law(&design, Law::PRINTED, HARD).with_friction(friction).unwrap();
        for_segments(path(&design, law, 1.0), |path, _, to| {
            let contacts = path.system().contacts.closed_contacts(&to.state);
            let friction_angle = friction.atan();
            for contact in contacts {
                let name = contact.corner_edge.name();
                let of_right = name == "TR on left edge" || name == "BR on left edge";
                if !of_right && name != "TL on right edge" && name != "BL on right edge" {
                    continue;
                }
                let scale = contact.left + usize::from(of_right);
                let turned = path.system().contacts.pose(&to.state.z, scale).rotation;
                let normal = std::f64::consts::PI - design.slant_deg.to_radians() + turned;
                let [x, y] = contact.force;
                if x.hypot(y) < 1e-6 {
                    continue;
                }
                // The force between two corners rotates from one normal to the other, so compare
                // only pairs with a single contact on an edge.
                let angle = (y.atan2(x) - normal).sin().asin();
                let pair = &to.state.mode.contacts[2 * contact.left..2 * contact.left + 2];
                let closed: Vec<_> = pair.iter().filter(|c| **c != CornerContact::Open).collect();
                if matches!(closed[..], [CornerContact::Edge(_)]) {
                    assert!(angle.abs() <= friction_angle + 1e-9, "{name} {angle} {design:?}");
                    compared += 1;
                }
            }
        });
    }
    assert!(compared > 20, "{compared}");
}

/// A row that leans to the left has its needle at the mirrored position.
#[test]
fn rows_with_friction_have_mirror_images() {
    for (gap, length, slant, needle) in
        [(0.1, 1.0, 45.0, 0.3), (0.2, 0.4, 60.0, 0.3), (0.1, 0.7, 30.0, 0.0)]
    {
        let [right, left] = [slant, -slant].map(|slant_deg| {
            let design = Design { gap, length, slant_deg, ..BLOCKS };
            let position = 1.0 - 0.05 / length;
            let parameters = PunctureParameters {
                scales: RowLength::Scales(31),
                needle: Needle::Guided { friction: needle },
                load_position: if slant_deg < 0.0 { 1.0 - position } else { position },
                ..PunctureParameters::default()
            };
            let row = design.leaning_row().unwrap();
            let common = Common { friction: 0.15, ..Common::default() };
            let upright = Design { slant_deg: slant, ..design };
            let stiffness = (&calibrate(&upright.footprint(0.5).unwrap()).unwrap()).into();
            Problem::new(Rows::Even(row), &design, stiffness, &common, &parameters)
                .unwrap()
                .solve()
                .unwrap()
        });
        assert_eq!([left.status, right.status], [Status::Complete; 2]);
        assert!(right.measures.friction_work.unwrap() > 0.0);
        assert_relative_eq!(
            left.measures.friction_work.unwrap(),
            right.measures.friction_work.unwrap(),
            max_relative = 1e-6
        );
        let [left, right] = [left, right].map(|puncture| *puncture.path.last().unwrap());
        assert_relative_eq!(left.force, right.force, max_relative = 1e-8);
        assert_relative_eq!(left.displacement, right.displacement, max_relative = 1e-8);
        assert_relative_eq!(left.tilt_deg, -right.tilt_deg, max_relative = 1e-8);
    }
}
