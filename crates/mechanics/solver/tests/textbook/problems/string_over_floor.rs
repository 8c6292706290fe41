//! String above a floor, which supports the string under large loads.

use solver::{Control, Residual, State, System, Tangent};

/// String above a floor, modelled by `n` linear elements of length `h = 1/n`.
///
/// The string has unit length and unit tension and carries a uniform load `q`. Its ends are fixed
/// at the height `D` above the floor. With the deflection `u_i` and the contact force `λ_i` of node
/// `i`,
///
/// ```text
/// (2 u_i − u_{i−1} − u_{i+1})/h + λ_i = q h,     0 ≤ λ_i  ⟂  D − u_i ≥ 0
/// ```
///
/// Nodes are numbered from the left end. The floor supports node `j` of the left half from
/// `q = 2D/(h² j (j+1))` on, and the middle node from `q = 8 D` on. The unknowns are
/// `u_1, λ_1, u_2, λ_2 … q`.
#[derive(Clone)]
pub struct StringOverFloor {
    intervals: usize,
    /// True if only the left half is modelled, because of symmetry.
    halved: bool,
    constraints: Vec<usize>,
    controls: [Control; 1],
}

/// Depth `D` of the floor below the ends of the string.
pub const DEPTH: f64 = 0.1;

impl StringOverFloor {
    /// Creates a string of `intervals` elements, an even number, with the target `q = load`.
    pub fn whole(intervals: usize, load: f64) -> Self {
        Self::new(intervals, load, false)
    }

    /// Creates the left half of a string of `intervals` elements with the target `q = load`.
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

    /// Returns the length of an element.
    pub fn h(&self) -> f64 {
        1.0 / self.intervals as f64
    }

    /// Returns the number of nodes that are modelled.
    pub fn nodes(&self) -> usize {
        self.constraints.len()
    }

    /// Returns the load at which the floor begins to support a node of the left half.
    pub fn touching_load(&self, node: usize) -> f64 {
        let next = if 2 * node == self.intervals { node } else { node + 1 };
        2.0 * DEPTH / (self.h().powi(2) * (node * next) as f64)
    }

    /// Returns the deflection of a node under a load in closed form.
    ///
    /// The floor supports the nodes of the left half from some number `m` on. Between its end and
    /// node `m` the string is a parabola.
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

    /// Returns the fraction of the load and stiffness of node `i` that is modelled.
    ///
    /// The fraction is one half for the middle node of a halved string, else 1.
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
