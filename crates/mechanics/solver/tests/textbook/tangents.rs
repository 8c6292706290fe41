//! Comparison of the tangents of the problems with differences of their residuals.

use solver::{Change, Control, Residual, State, System, Tangent, check_tangent};

use crate::problems::{
    Bratu, OneConstraint, StringOverFloor, arch, arch_on_spring, bump, circle, corner, kink,
    parabola, root, step,
};

/// Returns the state with the unknowns `z` and with all constraints active.
fn state<S: System<Mode = ()>>(system: &S, z: &[f64]) -> State {
    State { z: z.to_vec(), active: vec![true; system.constraints().len()], mode: () }
}

/// Checks the tangent of `system` at the unknowns `z`.
fn check<S: System<Mode = ()>>(system: &S, z: &[f64]) {
    check_tangent(system, &state(system, z), 2e-9).unwrap();
}

#[test]
fn tangents_are_derivatives_of_the_residuals() {
    check(&arch(), &[0.3, 0.2]);
    check(&arch_on_spring(), &[0.3, 0.4, 0.2]);
    check(&circle(), &[0.3, 0.4]);
    check(&step(), &[0.5, 0.2]);
    check(&parabola(), &[0.5, 0.2]);
    check(&root(), &[0.2, 0.2]);
    check(&bump(), &[1.3, 0.4, 0.2]);
    check(&corner(), &[1.3, 0.4, 0.2]);
    check(&kink::<5>(), &[1.3, 0.4, 0.2]);
    check(&Bratu::new(6), &[0.1, 0.2, 0.3, 0.4, 0.5, 1.5]);
    let string = StringOverFloor::halved(6, 1.0);
    check(&string, &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
}

/// System with an error in one entry of its tangent or in its slope.
struct Wrong {
    /// System with correct derivatives.
    right: OneConstraint,
    /// Row and column of the wrong entry, if any.
    entry: Option<(usize, usize)>,
    /// Error of the slope.
    slope: f64,
}

impl System for Wrong {
    type Mode = ();

    fn size(&self) -> usize {
        self.right.size()
    }

    fn half_bandwidth(&self) -> usize {
        self.right.half_bandwidth()
    }

    fn load(&self) -> usize {
        self.right.load()
    }

    fn controls(&self) -> &[Control] {
        self.right.controls()
    }

    fn constraints(&self) -> &[usize] {
        self.right.constraints()
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, state: &State, residual: &mut Residual) {
        self.right.residual(state, residual);
    }

    fn tangent(&self, state: &State, matrix: &mut impl Tangent) {
        self.right.tangent(state, matrix);
        if let Some((row, column)) = self.entry {
            matrix.add(row, column, 1e-6);
        }
    }

    fn slope(&self, state: &State, constraint: usize, direction: &[f64]) -> f64 {
        self.right.slope(state, constraint, direction) + self.slope
    }

    fn transition(&self, state: &mut State, change: Change) -> Option<usize> {
        self.right.transition(state, change)
    }
}

#[test]
fn a_wrong_derivative_is_reported() {
    let entries = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)].map(Some);
    let mut cases = entries.map(|entry| (entry, 0.0, true, entry)).to_vec();
    cases.extend([(None, 0.0, true, None), (None, 1e-6, true, Some((1, 0)))]);
    // Of an inactive constraint the solver uses only the slope, so errors in its row and column of
    // the tangent are accepted.
    cases.push((None, 1e-6, false, Some((1, 0))));
    cases.extend([(1, 0), (1, 2), (0, 1)].map(|entry| (Some(entry), 0.0, false, None)));
    for (entry, slope, active, expected) in cases {
        let wrong = Wrong { right: bump(), entry, slope };
        let state = State { active: vec![active], ..state(&wrong, &[1.3, 0.4, 0.2]) };
        let found = check_tangent(&wrong, &state, 1e-8).err();
        assert_eq!(found.map(|wrong| (wrong.row, wrong.column)), expected, "{entry:?} {slope}");
    }
}
