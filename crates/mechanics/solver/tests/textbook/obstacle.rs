//! Tests with a string above a floor, which has many contacts.

use approx::assert_relative_eq;
use solver::{Condition, Newton, Settings, State, System, Termination};

use crate::problems::{DEPTH, StringOverFloor};
use crate::{changes, follow, steps};

#[test]
fn deflections_of_a_string_on_the_floor_agree_with_the_closed_form() {
    for load in [0.5, 0.9, 3.0, 40.0] {
        let string = StringOverFloor::whole(40, load);
        let (points, stop) = follow(string.clone(), Settings::default());
        assert_eq!(stop, Termination::Reached);
        let state = &points.last().unwrap().state;
        for node in 1..40 {
            let deflection = state.z[2 * (node - 1)];
            assert_relative_eq!(deflection, string.deflection(node, load), epsilon = 1e-12);
            let held = string.touching_load(node.min(40 - node)) <= load;
            assert_eq!(state.active[node - 1], held, "node {node} under {load}");
            assert!(state.z[2 * node - 1] >= 0.0);
        }
    }
}

/// Starts Newton's method with non-zero forces at inactive constraints.
///
/// At the prescribed load the middle node just touches the floor.
#[test]
fn newtons_method_sets_the_forces_of_inactive_constraints_to_zero() {
    let string = StringOverFloor::whole(4, 1.0);
    let mut newton = Newton::new(&string);
    let touching = string.touching_load(2);
    let condition = Condition::new(vec![(string.load(), 1.0)], touching);
    let z = (0..string.size()).map(|i| if i % 2 == 1 { 0.3 } else { 0.0 }).collect();
    let mut state = State { z, active: vec![false; 3], mode: () };
    newton.solve(&string, &mut state, &condition, &Settings::default()).unwrap();
    let guards = Newton::guards(&string, &state);
    assert!(guards.iter().all(|guard| *guard > -1e-12), "{guards:?}");
    assert_relative_eq!(state.z[2], DEPTH, max_relative = 1e-12);
    assert_eq!([state.z[1], state.z[3], state.z[5]], [0.0; 3]);
}

#[test]
fn the_floor_supports_nodes_one_after_the_other() {
    let string = StringOverFloor::halved(40, 20.0);
    let (points, stop) = follow(string.clone(), Settings::default());
    assert_eq!(stop, Termination::Reached);
    let changes = changes(&points);
    let expected: Vec<usize> =
        (1..=20).rev().filter(|&node| string.touching_load(node) < 20.0).collect();
    assert_eq!(expected.len(), 17);
    assert_eq!(changes.len(), expected.len());
    for ((point, changed), node) in changes.into_iter().zip(expected) {
        assert_eq!(changed, [(node - 1, true)]);
        let load = point.state.z[string.load()];
        assert_relative_eq!(load, string.touching_load(node), max_relative = 1e-10);
    }
    let end = &points.last().unwrap().state;
    for node in 1..=20 {
        assert_relative_eq!(end.z[2 * node - 2], string.deflection(node, 20.0), epsilon = 1e-12);
    }
}

#[test]
fn contacts_of_symmetric_nodes_close_at_the_same_event() {
    let string = StringOverFloor::whole(20, 10.0);
    let (points, stop) = follow(string.clone(), Settings::default());
    assert_eq!(stop, Termination::Reached);
    for (point, changed) in changes(&points) {
        let node = changed[0].0 + 1;
        let near = node.min(20 - node);
        let mut together: Vec<usize> = changed.iter().map(|(c, _)| c + 1).collect();
        together.sort_unstable();
        together.dedup();
        assert_eq!(together, if near == 10 { vec![10] } else { vec![near, 20 - near] });
        assert!(changed.iter().all(|(_, activated)| *activated));
        let load = point.state.z[string.load()];
        assert_relative_eq!(load, string.touching_load(near), max_relative = 1e-10);
    }
    let held = (1..20).filter(|&node| string.touching_load(node.min(20 - node)) < 10.0).count();
    let end = &points.last().unwrap().state;
    assert_eq!(end.active.iter().filter(|active| **active).count(), held);
}

#[test]
fn events_do_not_depend_on_the_step_size() {
    let loads = [0.1, 0.01].map(|step| {
        let (points, _) = follow(StringOverFloor::halved(40, 20.0), steps(step));
        let loads = changes(&points).into_iter().map(|(point, _)| point.state.z[40]);
        loads.collect::<Vec<f64>>()
    });
    assert_eq!(loads[0].len(), 17);
    for (coarse, fine) in loads[0].iter().zip(&loads[1]) {
        assert_relative_eq!(coarse, fine, max_relative = 1e-10);
    }
}
