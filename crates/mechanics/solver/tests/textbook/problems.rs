//! Problems with known answers.

use solver::{Change, Control, Residual, State, System, Tangent};

/// Unconstrained system of a few unknowns, given by functions.
///
/// The functions are the equations (one fewer than unknowns; the load is the last unknown) and
/// their derivatives.
#[derive(Clone)]
pub struct Smooth<const N: usize> {
    pub controls: Vec<Control>,
    pub equations: fn(&[f64]) -> Vec<f64>,
    pub derivatives: fn(&[f64]) -> Vec<[f64; N]>,
    pub load_only_pushes: bool,
}

impl<const N: usize> System for Smooth<N> {
    type Mode = ();

    fn size(&self) -> usize {
        N
    }

    fn half_bandwidth(&self) -> usize {
        N - 1
    }

    fn load(&self) -> usize {
        N - 1
    }

    fn load_only_pushes(&self) -> bool {
        self.load_only_pushes
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&[1.0; N]);
        for (row, value) in (self.equations)(z).into_iter().enumerate() {
            residual.add(row, value);
        }
    }

    fn tangent(&self, State { z, .. }: &State, matrix: &mut impl Tangent) {
        for (row, values) in (self.derivatives)(z).into_iter().enumerate() {
            for (column, value) in values.into_iter().enumerate() {
                matrix.add(row, column, value);
            }
        }
    }
}

fn controls(controls: &[(usize, f64)]) -> Vec<Control> {
    controls.iter().map(|&(index, scale)| Control { index, scale }).collect()
}

/// Shallow arch pushed down by `u`: `p = u (1 − u)(2 − u)`.
///
/// The load has its extrema `± 2/(3√3)` at `u = 1 ∓ 1/√3`.
pub fn arch() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 2.5)]),
        equations: |z| vec![z[0] * (1.0 - z[0]) * (2.0 - z[0]) - z[1]],
        derivatives: |z| vec![[3.0 * z[0] * z[0] - 6.0 * z[0] + 2.0, -1.0]],
        load_only_pushes: false,
    }
}

/// Arch under a load that only pushes and returns to zero at `u = 1`.
pub fn pushed_arch() -> Smooth<2> {
    Smooth { load_only_pushes: true, ..arch() }
}

/// Stiffness of the spring of [`arch_on_spring`].
pub const SPRING: f64 = 0.25;

/// Arch pushed through a soft spring: `p = w (1 − w)(2 − w) = k (d − w)`.
///
/// The control parameter `d` turns back at `w = 1/2`, `d = 2`, and forward again at `w = 3/2`,
/// `d = 0`. Unknowns `w, d, p`.
pub fn arch_on_spring() -> Smooth<3> {
    Smooth {
        controls: controls(&[(1, 3.0), (0, 1.0)]),
        equations: |z| {
            vec![z[0] * (1.0 - z[0]) * (2.0 - z[0]) - z[2], SPRING * (z[1] - z[0]) - z[2]]
        },
        derivatives: |z| {
            vec![[3.0 * z[0] * z[0] - 6.0 * z[0] + 2.0, 0.0, -1.0], [-SPRING, SPRING, -1.0]]
        },
        load_only_pushes: false,
    }
}

/// Circle `x² + y² = 1`, driven by `x`, which never reaches its target 2.
pub fn circle() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 2.0), (1, 2.0)]),
        equations: |z| vec![z[0] * z[0] + z[1] * z[1] - 1.0],
        derivatives: |z| vec![[2.0 * z[0], 2.0 * z[1]]],
        load_only_pushes: false,
    }
}

/// Column with the shortening `x = F` and the deflection `y (1 − F + y²) = 0`.
pub fn column() -> Smooth<3> {
    Smooth {
        controls: controls(&[(0, 2.0)]),
        equations: |z| vec![z[0] - z[2], z[1] * (1.0 - z[2] + z[1] * z[1])],
        derivatives: |z| vec![[1.0, 0.0, -1.0], [0.0, 1.0 - z[2] + 3.0 * z[1] * z[1], -z[1]]],
        load_only_pushes: false,
    }
}

/// Steep step `p = tanh 4 (u − 0.6)`, with the maximum slope 4 at `u = 0.6`.
pub fn step() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 1.0)]),
        equations: |z| vec![(4.0 * (z[0] - 0.6)).tanh() - z[1]],
        derivatives: |z| vec![[4.0 / (4.0 * (z[0] - 0.6)).cosh().powi(2), -1.0]],
        load_only_pushes: false,
    }
}

/// Parabola `y² = u`: its control parameter `u` turns at the start.
pub fn parabola() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 1.0)]),
        equations: |z| vec![z[1] * z[1] - z[0]],
        derivatives: |z| vec![[-1.0, 2.0 * z[1]]],
        load_only_pushes: false,
    }
}

/// Square root `p = √(1/2 − u)`, which ends at `u = 1/2`.
pub fn root() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 1.0)]),
        equations: |z| vec![(0.5 - z[0]).sqrt() - z[1]],
        derivatives: |z| vec![[-0.5 / (0.5 - z[0]).sqrt(), -1.0]],
        load_only_pushes: false,
    }
}

/// Discontinuous path `p = u`, with a drop of `p` by 1 at `u = 1/2`.
pub fn jump() -> Smooth<2> {
    Smooth {
        controls: controls(&[(0, 1.0), (1, 1.0)]),
        equations: |z| vec![z[0] - f64::from(z[0] > 0.5) - z[1]],
        derivatives: |_| vec![[1.0, -1.0]],
        load_only_pushes: false,
    }
}

/// Bratu's problem `u″ + λ eᵘ = 0` on the unit interval, by central differences.
///
/// `u = 0` at the ends (Bratu 1914); driven by `u` in the middle. `λ` has its maximum 3.513 830 719
/// where `cosh θ = θ sinh θ`.
#[derive(Clone)]
pub struct Bratu {
    intervals: usize,
    controls: [Control; 1],
}

impl Bratu {
    pub fn new(intervals: usize) -> Self {
        Self { intervals, controls: [Control { index: intervals / 2 - 1, scale: 3.0 }] }
    }

    fn h(&self) -> f64 {
        1.0 / self.intervals as f64
    }
}

impl System for Bratu {
    type Mode = ();

    fn size(&self) -> usize {
        self.intervals
    }

    fn half_bandwidth(&self) -> usize {
        self.intervals - 1
    }

    fn load(&self) -> usize {
        self.intervals - 1
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&vec![1.0; self.size()]);
        let (load, inside) = (self.load(), self.intervals - 1);
        for i in 0..inside {
            residual.add(i, -2.0 * z[i] + self.h().powi(2) * z[load] * z[i].exp());
            if i > 0 {
                residual.add(i, z[i - 1]);
            }
            if i + 1 < inside {
                residual.add(i, z[i + 1]);
            }
        }
    }

    fn tangent(&self, State { z, .. }: &State, matrix: &mut impl Tangent) {
        let (load, inside) = (self.load(), self.intervals - 1);
        for i in 0..inside {
            let source = self.h().powi(2) * z[i].exp();
            matrix.add(i, i, -2.0 + z[load] * source);
            matrix.add(i, load, source);
            if i > 0 {
                matrix.add(i, i - 1, 1.0);
            }
            if i + 1 < inside {
                matrix.add(i, i + 1, 1.0);
            }
        }
    }
}

/// String above a floor, by linear elements of length `h = 1/n`.
///
/// The string has unit length and tension, carries a uniform load `q`, and hangs from its ends at
/// the height `D` above the floor:
///
/// ```text
/// (2 u_i − u_{i−1} − u_{i+1})/h + λ_i = q h,     0 ≤ λ_i  ⟂  D − u_i ≥ 0
/// ```
///
/// Nodes are counted from the left end. The floor supports node `j` from `q = 2D/(h² j (j+1))` on,
/// the middle one of `n = 2m` from `8 D` on. Unknowns `u_1, λ_1, u_2, λ_2 … q`.
#[derive(Clone)]
pub struct StringOverFloor {
    intervals: usize,
    /// True if the right half is omitted by symmetry.
    halved: bool,
    constraints: Vec<usize>,
    controls: [Control; 1],
}

/// Depth of the floor below the string.
pub const DEPTH: f64 = 0.1;

impl StringOverFloor {
    /// Creates a string of `intervals` (even) elements, loaded up to `q = load`.
    pub fn whole(intervals: usize, load: f64) -> Self {
        Self::new(intervals, load, false)
    }

    /// Creates the left half of the string.
    pub fn halved(intervals: usize, load: f64) -> Self {
        Self::new(intervals, load, true)
    }

    fn new(intervals: usize, load: f64, halved: bool) -> Self {
        let nodes = if halved { intervals / 2 } else { intervals - 1 };
        Self {
            intervals,
            halved,
            constraints: (0..nodes).map(|i| 2 * i + 1).collect(),
            controls: [Control { index: 2 * nodes, scale: load }],
        }
    }

    pub fn h(&self) -> f64 {
        1.0 / self.intervals as f64
    }

    pub fn nodes(&self) -> usize {
        self.constraints.len()
    }

    /// Returns the load at which the floor begins to support a node of the left half.
    pub fn touching_load(&self, node: usize) -> f64 {
        let next = if 2 * node == self.intervals { node } else { node + 1 };
        2.0 * DEPTH / (self.h().powi(2) * (node * next) as f64)
    }

    /// Returns the deflection of a node under a load.
    ///
    /// The floor supports the nodes from number `m` on, and the string hangs freely between there
    /// and its end.
    pub fn deflection(&self, node: usize, load: f64) -> f64 {
        let middle = self.intervals / 2;
        let node = node.min(self.intervals - node);
        let held = (1..=middle).find(|&m| self.touching_load(m) <= load);
        let x = node as f64 * self.h();
        match held {
            Some(m) if node >= m => DEPTH,
            Some(m) => {
                let length = m as f64 * self.h();
                0.5 * load * x * (length - x) + DEPTH * x / length
            }
            None => 0.5 * load * x * (1.0 - x),
        }
    }

    /// Returns the fraction of an element's load and stiffness assigned to a node.
    fn fraction(&self, i: usize) -> f64 {
        if self.halved && i + 1 == self.nodes() { 0.5 } else { 1.0 }
    }
}

impl System for StringOverFloor {
    type Mode = ();

    fn size(&self) -> usize {
        2 * self.nodes() + 1
    }

    fn half_bandwidth(&self) -> usize {
        self.size() - 1
    }

    fn load(&self) -> usize {
        2 * self.nodes()
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn constraints(&self) -> &[usize] {
        &self.constraints
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&vec![1.0; self.size()]);
        for i in 0..self.nodes() {
            let fraction = self.fraction(i);
            residual.add(2 * i, 2.0 * fraction * z[2 * i] / self.h());
            residual.add(2 * i, z[2 * i + 1]);
            residual.add(2 * i, -fraction * self.h() * z[self.load()]);
            if i > 0 {
                residual.add(2 * i, -z[2 * i - 2] / self.h());
            }
            if i + 1 < self.nodes() {
                residual.add(2 * i, -z[2 * i + 2] / self.h());
            }
            residual.add(2 * i + 1, DEPTH - z[2 * i]);
        }
    }

    fn tangent(&self, _state: &State, matrix: &mut impl Tangent) {
        for i in 0..self.nodes() {
            let fraction = self.fraction(i);
            matrix.add(2 * i, 2 * i, 2.0 * fraction / self.h());
            matrix.add(2 * i, 2 * i + 1, 1.0);
            matrix.add(2 * i, self.load(), -fraction * self.h());
            if i > 0 {
                matrix.add(2 * i, 2 * i - 2, -1.0 / self.h());
            }
            if i + 1 < self.nodes() {
                matrix.add(2 * i, 2 * i + 2, -1.0 / self.h());
            }
            matrix.add(2 * i + 1, 2 * i, -1.0);
        }
    }
}

/// System with coordinate `u`, constraint `0 ≤ c ⟂ r(u, c) ≥ 0`, `p = f(u, c)`.
///
/// Unknowns `u, c, p`; driven by `u`.
#[derive(Clone)]
pub struct OneConstraint {
    pub controls: Vec<Control>,
    /// `r` and its derivatives with respect to `u` and `c`.
    pub condition: fn(f64, f64) -> [f64; 3],
    /// `f` and its derivatives with respect to `u` and `c`.
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

/// Bead drawn along a wire over a bump `1 − (u − 2)²`, held down by a unit spring.
///
/// The bump lifts it by `c` from `u = 1` to `u = 3`, and `p = u/2 + 2 c (2 − u)`.
pub fn bump() -> OneConstraint {
    OneConstraint {
        controls: controls(&[(0, 4.0)]),
        condition: |u, c| [c - 1.0 + (u - 2.0).powi(2), 2.0 * (u - 2.0), 1.0],
        load: |u, c| [0.5 * u + 2.0 * c * (2.0 - u), 0.5 - 2.0 * c, 2.0 * (2.0 - u)],
    }
}

/// Corner: `0 ≤ c ⟂ 1 − u − c + c² ≥ 0`, `p = u + 3 c`.
///
/// The path arrives at `u = 1`, reverses to `u = 3/4`, and then reaches its target `u = 2` with
/// `c = (1 + √5)/2`.
pub fn corner() -> OneConstraint {
    OneConstraint {
        controls: controls(&[(0, 2.0), (1, 1.0)]),
        condition: |u, c| [1.0 - u - c + c * c, -1.0, 2.0 * c - 1.0],
        load: |u, c| [u + 3.0 * c, 1.0, 3.0],
    }
}

/// Kink: a constraint that acts from `u = 0.5` on with a force `c^1.1 e^(−kc)`.
///
/// `c = u − 0.5` and the decay is `k`. The force has infinite curvature at first and its maximum
/// slope soon after.
pub fn kink<const DECAY: u32>() -> OneConstraint {
    OneConstraint {
        controls: controls(&[(0, 1.0)]),
        condition: |u, c| [0.5 - u + c, -1.0, 1.0],
        load: |u, c| {
            // Odd continuation below zero, through which Newton's method may pass.
            let (size, decay) = (c.abs(), (-f64::from(DECAY) * c).exp());
            let slope = decay * (1.1 * size.powf(0.1) - f64::from(DECAY) * size.powf(1.1));
            [u + decay * size.powf(1.1).copysign(c), 1.0, slope]
        },
    }
}

/// System with two laws, before and after a constraint activates at `u = 0.5`.
///
/// `p = u + 0.2 (tanh 10 (u − 0.2) + tanh 2)` before, and `p = u` plus a constant after. The first
/// law has its maximum slope 3 at `u = 0.2`.
#[derive(Clone)]
pub struct TwoLaws {
    before: OneConstraint,
    after: OneConstraint,
}

/// Current law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhichLaw {
    Before,
    After,
}

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

fn without_mode<M>(state: &State<M>) -> State {
    State { z: state.z.clone(), active: state.active.clone(), mode: () }
}

/// Kink with a constraint that cannot become active.
#[derive(Clone)]
pub enum Unwilling {
    /// The constraint is violated in both directions of the path.
    Refusing(OneConstraint),
    /// The constraint cannot change sides.
    Stuck(OneConstraint),
}

impl Unwilling {
    fn kink(&self) -> &OneConstraint {
        let (Self::Refusing(kink) | Self::Stuck(kink)) = self;
        kink
    }
}

impl System for Unwilling {
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
            Self::Refusing(_) => -direction[0].abs(),
            Self::Stuck(kink) => kink.slope(state, constraint, direction),
        }
    }

    fn transition(&self, state: &mut State, change: Change) -> Option<usize> {
        state.active[change.constraint] = false;
        matches!(self, Self::Refusing(_)).then_some(change.constraint)
    }
}

/// System `10¹⁵ (sin u − p) = 0`, driven by `u` to 1.
///
/// Its two large terms leave a round-off of about 0.1.
#[derive(Clone)]
pub struct Stiff;

impl System for Stiff {
    type Mode = ();

    fn size(&self) -> usize {
        2
    }

    fn half_bandwidth(&self) -> usize {
        1
    }

    fn load(&self) -> usize {
        1
    }

    fn controls(&self) -> &[Control] {
        &[Control { index: 0, scale: 1.0 }]
    }

    fn mode_at_rest(&self) {}

    fn residual(&self, State { z, .. }: &State, residual: &mut Residual) {
        residual.clear(&[1.0; 2]);
        residual.add(0, 1e15 * z[0].sin());
        residual.add(0, -1e15 * z[1]);
    }

    fn tangent(&self, State { z, .. }: &State, matrix: &mut impl Tangent) {
        matrix.add(0, 0, 1e15 * z[0].cos());
        matrix.add(0, 1, -1e15);
    }
}
