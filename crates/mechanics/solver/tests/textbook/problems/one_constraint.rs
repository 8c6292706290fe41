//! Systems with one constraint: kinks, a change of mode, constraints that cannot become active.

use solver::{Change, Control, Residual, State, System, Tangent};

use super::controls;

/// System with the unknowns `u, c, p`, given by two functions.
///
/// The constraint is `0 ≤ c ⟂ r(u, c) ≥ 0`, the load is `p = f(u, c)`, and the control parameter
/// is `u`.
#[derive(Clone)]
pub struct OneConstraint {
    pub controls: Vec<Control>,
    /// Function `r` with its derivatives with respect to `u` and `c`.
    pub condition: fn(f64, f64) -> [f64; 3],
    /// Function `f` with its derivatives with respect to `u` and `c`.
    pub load: fn(f64, f64) -> [f64; 3],
}

impl System for OneConstraint {
    type Mode = ();

    fn size(&self) -> usize {
        3
    }

    fn half_bandwidth(&self) -> usize {
        2
    }

    fn load(&self) -> usize {
        2
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn constraints(&self) -> &[usize] {
        &[1]
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&[1.0; 3]);
        residual.add(0, (self.load)(z[0], z[1])[0]);
        residual.add(0, -z[2]);
        residual.add(1, (self.condition)(z[0], z[1])[0]);
    }

    fn tangent(&self, State { z, active, .. }: &State, matrix: &mut impl Tangent) {
        let [_, by_u, by_c] = (self.load)(z[0], z[1]);
        for (column, value) in [by_u, by_c, -1.0].into_iter().enumerate() {
            matrix.add(0, column, value);
        }
        if active[0] {
            let [_, by_u, by_c] = (self.condition)(z[0], z[1]);
            matrix.add(1, 0, by_u);
            matrix.add(1, 1, by_c);
        }
    }
}

/// Bead that is pulled along a straight wire over a bump of height `1 − (u − 2)²`.
///
/// From `u = 1` to `u = 3` the bump lifts the bead by `c` against a unit spring. The load is
/// `p = u/2 + 2 c (2 − u)`.
pub fn bump() -> OneConstraint {
    OneConstraint {
        controls: controls(&[(0, 4.0)]),
        condition: |u, c| [c - 1.0 + (u - 2.0).powi(2), 2.0 * (u - 2.0), 1.0],
        load: |u, c| [0.5 * u + 2.0 * c * (2.0 - u), 0.5 - 2.0 * c, 2.0 * (2.0 - u)],
    }
}

/// Constraint `0 ≤ c ⟂ 1 − u − c + c² ≥ 0` with the load `p = u + 3 c`.
///
/// The control parameter increases to `u = 1`, where the constraint becomes active. From there it
/// decreases to `u = 3/4`, and then increases to its target `u = 2`, with `c = (1 + √5)/2`.
pub fn corner() -> OneConstraint {
    OneConstraint {
        controls: controls(&[(0, 2.0), (1, 1.0)]),
        condition: |u, c| [1.0 - u - c + c * c, -1.0, 2.0 * c - 1.0],
        load: |u, c| [u + 3.0 * c, 1.0, 3.0],
    }
}

/// Constraint that becomes active at `u = 0.5` and then adds `c^1.1 e^(−kc)` to the load.
///
/// `c = u − 0.5`, and `k` is `DECAY`. The curvature of the load is infinite just behind the kink,
/// and the maximum slope is close behind it.
pub fn kink<const DECAY: u32>() -> OneConstraint {
    OneConstraint {
        controls: controls(&[(0, 1.0)]),
        condition: |u, c| [0.5 - u + c, -1.0, 1.0],
        load: |u, c| {
            // Newton iterations may pass through negative `c`, so the force continues as an odd
            // function.
            let (size, decay) = (c.abs(), (-f64::from(DECAY) * c).exp());
            let slope = decay * (1.1 * size.powf(0.1) - f64::from(DECAY) * size.powf(1.1));
            [u + decay * size.powf(1.1).copysign(c), 1.0, slope]
        },
    }
}

/// System in which the load has another law after a constraint has become active at `u = 0.5`.
///
/// The load is `p = u + 0.2 (tanh 10 (u − 0.2) + tanh 2)` before, and `u` plus a constant after
/// this event. The first law has its maximum slope 3 at `u = 0.2`.
#[derive(Clone)]
pub struct TwoLaws {
    before: OneConstraint,
    after: OneConstraint,
}

/// Mode of [`TwoLaws`]: the law of the load before or after the event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhichLaw {
    Before,
    After,
}

/// Creates the system of [`TwoLaws`].
pub fn two_laws() -> TwoLaws {
    let before = OneConstraint {
        load: |u, _| {
            let x = 10.0 * (u - 0.2);
            [u + 0.2 * (x.tanh() + 2.0_f64.tanh()), 1.0 + 2.0 * x.cosh().powi(-2), 0.0]
        },
        ..kink::<5>()
    };
    let after = OneConstraint {
        load: |u, _| [u + 0.2 * (3.0_f64.tanh() + 2.0_f64.tanh()), 1.0, 0.0],
        ..kink::<5>()
    };
    TwoLaws { before, after }
}

impl TwoLaws {
    /// Returns the system with the law of a mode.
    fn law(&self, mode: WhichLaw) -> &OneConstraint {
        match mode {
            WhichLaw::Before => &self.before,
            WhichLaw::After => &self.after,
        }
    }
}

impl System for TwoLaws {
    type Mode = WhichLaw;

    fn size(&self) -> usize {
        3
    }

    fn half_bandwidth(&self) -> usize {
        2
    }

    fn load(&self) -> usize {
        2
    }

    fn controls(&self) -> &[Control] {
        &self.before.controls
    }

    fn constraints(&self) -> &[usize] {
        &[1]
    }

    fn mode_at_rest(&self) -> WhichLaw {
        WhichLaw::Before
    }

    fn residual(&self, state: &State<WhichLaw>, residual: &mut Residual) {
        self.law(state.mode).residual(&without_mode(state), residual);
    }

    fn tangent(&self, state: &State<WhichLaw>, matrix: &mut impl Tangent) {
        self.law(state.mode).tangent(&without_mode(state), matrix);
    }

    fn transition(&self, state: &mut State<WhichLaw>, change: Change) -> Option<usize> {
        state.mode = WhichLaw::After;
        Some(change.constraint)
    }
}

/// Returns the state without its mode.
fn without_mode<M>(state: &State<M>) -> State {
    State { z: state.z.clone(), active: state.active.clone(), mode: () }
}

/// Variants of [`kink`] in which the constraint cannot become active.
#[derive(Clone)]
pub enum InactiveKink {
    /// Both directions of the path violate the constraint.
    Violated(OneConstraint),
    /// The transition of the constraint fails.
    NoTransition(OneConstraint),
}

impl InactiveKink {
    fn kink(&self) -> &OneConstraint {
        let (Self::Violated(kink) | Self::NoTransition(kink)) = self;
        kink
    }
}

impl System for InactiveKink {
    type Mode = ();

    fn size(&self) -> usize {
        3
    }

    fn half_bandwidth(&self) -> usize {
        2
    }

    fn load(&self) -> usize {
        2
    }

    fn controls(&self) -> &[Control] {
        &self.kink().controls
    }

    fn constraints(&self) -> &[usize] {
        &[1]
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, state: &State, residual: &mut Residual) {
        self.kink().residual(state, residual);
    }

    fn tangent(&self, state: &State, matrix: &mut impl Tangent) {
        self.kink().tangent(state, matrix);
    }

    fn slope(&self, state: &State, constraint: usize, direction: &[f64]) -> f64 {
        match self {
            Self::Violated(_) => -direction[0].abs(),
            Self::NoTransition(kink) => kink.slope(state, constraint, direction),
        }
    }

    fn transition(&self, state: &mut State, change: Change) -> Option<usize> {
        state.active[change.constraint] = false;
        matches!(self, Self::Violated(_)).then_some(change.constraint)
    }
}
