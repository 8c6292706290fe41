//! Model of the membrane in a gap between two scales as co-rotational elements.

use geometry::{OutOfRange, Vec2};
use nalgebra::{DMatrix, DVector};

use crate::section::positive;
use crate::{CorotationalBeam, Ends, GapEnergies, Local, OffsetBeam, Response, RigidArm, Section};

/// Undeformed dimensions of a gap and the adjacent bases, in units of `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Half-width `a ≥ 0` of the bases, under which the membrane is rigid.
    pub half_base: f64,
    /// Gap `d` between two bases, the free length of the membrane.
    pub gap: f64,
    /// Depth `e` of the membrane axis below the bases; positive away from the scales.
    pub axis_offset: f64,
}

/// Membrane in a gap, modelled by `m` equal co-rotational elements.
///
/// The membrane is rigid under the bases.
///
/// ```text
///  ┌───────┐           ┌───────┐
///  │ left  │           │ right │        scale nodes ○ at the midpoints of the bases
///  └───○───┘           └───○───┘
///      ┆ e                 ┆
///      ╰┄┄┄●━━━●━━━●━━━●┄┄┄╯            m = 3 elements, 2 interior nodes
///        a │     d     │ a
/// ```
///
/// The first element starts at the arm `(a, −e)` of the left scale, and the last one ends at the
/// arm `(−a, −e)` of the right scale. The state consists of displacements and rotations,
///
/// ```text
/// u = (left; node 1; …; node m−1; right),   three numbers (uₓ, u_y, φ) each     (M13)
/// W(u) = Σₖ Wₖ(u₃ₖ … u₃ₖ₊₅),   k = 0 … m−1,   each element of length d/m        (M14)
/// ```
///
/// so element `k` contributes to the six entries of `u` from `3k` on, and the tangent of a row of
/// gaps is block-tridiagonal. An element only uses the difference between the displacements of its
/// two bodies and the distance of the bodies at rest. The precision therefore does not depend
/// on the position of the gap in a long row, except for the rounding of the displacements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapMembrane {
    section: Section,
    beam: CorotationalBeam,
    elements: usize,
    span: Span,
}

/// Energies of the membrane in a gap, and the derivatives of their sum with respect to `u`.
#[derive(Clone, Debug, PartialEq)]
pub struct GapResponse {
    /// Stretching energy of all elements.
    pub axial_energy: f64,
    /// Bending energy of all elements.
    pub bending_energy: f64,
    /// Gradient of the sum of both energies.
    pub force: DVector<f64>,
    /// Symmetric matrix of second derivatives of the sum of both energies.
    pub tangent: DMatrix<f64>,
}

impl GapMembrane {
    /// Creates a membrane of `elements` equal elements in the gap `span`.
    ///
    /// # Errors
    /// If the gap is not positive and finite, the half-base is negative, the offset is not finite,
    /// or the number of elements is zero.
    pub fn new(section: Section, span: Span, elements: usize) -> Result<Self, OutOfRange> {
        let count = elements as f64;
        OutOfRange::unless(elements > 0, "number of elements per gap", count, "at least 1")?;
        check(&span)?;
        let beam = CorotationalBeam::new(
            span.gap / count,
            section.axial_stiffness(),
            section.bending_stiffness(),
        )?;
        Ok(Self { section, beam, elements, span })
    }

    /// Returns the number `m` of elements.
    pub fn elements(&self) -> usize {
        self.elements
    }

    /// Returns the number `3(m + 1)` of entries of the state.
    pub fn unknowns(&self) -> usize {
        3 * (self.elements + 1)
    }

    /// Returns the distance `2a + d` between the nodes of the two scales at rest, in units of `t`.
    pub fn pitch(&self) -> f64 {
        2.0 * self.span.half_base + self.span.gap
    }

    /// Returns the poses `(x, y, φ)` of all nodes at rest, in the order of the state.
    ///
    /// The node of the left scale is the origin.
    pub fn rest(&self) -> DVector<f64> {
        let mut poses = DVector::zeros(self.unknowns());
        for node in 0..=self.elements {
            let position = self.rest_position(node);
            poses[3 * node] = position.x;
            poses[3 * node + 1] = position.y;
        }
        poses
    }

    /// Returns element `k`, including the rigid arm of an end that is attached to a scale.
    pub fn element(&self, k: usize) -> OffsetBeam {
        let Span { half_base, axis_offset, .. } = self.span;
        let mut arms = [RigidArm::NONE; 2];
        if k == 0 {
            arms[0] = RigidArm::new(Vec2::new(half_base, -axis_offset));
        }
        if k + 1 == self.elements {
            arms[1] = RigidArm::new(Vec2::new(-half_base, -axis_offset));
        }
        OffsetBeam { beam: self.beam, arms }
    }

    /// Returns energies, force and tangent of element `k`.
    ///
    /// `displacements` are the entries `3k … 3k + 5` of the state.
    pub fn element_response(&self, k: usize, displacements: &Ends) -> Response {
        self.element(k).response(&self.bodies(k, displacements))
    }

    /// Returns energies, force and tangent of the whole gap (M14).
    ///
    /// # Panics
    /// If `u` is shorter than [`Self::unknowns`].
    pub fn response(&self, u: &DVector<f64>) -> GapResponse {
        let size = self.unknowns();
        let mut sum = GapResponse {
            axial_energy: 0.0,
            bending_energy: 0.0,
            force: DVector::zeros(size),
            tangent: DMatrix::zeros(size, size),
        };
        for k in 0..self.elements {
            sum.add(3 * k, &self.element_response(k, &entries(u, k)));
        }
        sum
    }

    /// Returns the reference sizes of forces and moments for tolerances on residuals.
    ///
    /// The vector has three entries for each interior node and for the right scale. Sizes grow with
    /// the number of elements, because shorter elements are stiffer and have larger round-off.
    pub fn units(&self) -> DVector<f64> {
        let axial = self.section.axial_stiffness() / self.beam.length();
        let bending = self.section.bending_stiffness() / self.beam.length();
        // The left scale is the reference frame and has no equations.
        DVector::from_fn(3 * self.elements, |k, _| if k % 3 == 2 { bending } else { axial })
    }

    /// Returns the stretching and the bending energy of the gap.
    ///
    /// # Panics
    /// If `u` is shorter than [`Self::unknowns`].
    pub fn energies(&self, u: &DVector<f64>) -> GapEnergies {
        let GapResponse { axial_energy: axial, bending_energy: bending, .. } = self.response(u);
        GapEnergies { axial, bending }
    }

    /// Returns the largest value of `|N|/EA + h max(|M₁|, |M₂|)/2EI` among all elements.
    ///
    /// This is the largest strain at the surface of the membrane.
    ///
    /// # Panics
    /// If `u` is shorter than [`Self::unknowns`].
    pub fn largest_strain(&self, u: &DVector<f64>) -> f64 {
        let half_thickness = 0.5 * self.section.thickness();
        let strains = self.local(u).into_iter().map(|local| {
            // The moment varies linearly along an element, so its maximum is at an end.
            let curvature = local.moments[0].abs().max(local.moments[1].abs())
                / self.section.bending_stiffness();
            local.axial_force.abs() / self.section.axial_stiffness() + half_thickness * curvature
        });
        strains.fold(0.0, f64::max)
    }

    /// Returns deformations and forces of each element in the frame of its chord.
    ///
    /// # Panics
    /// If `u` is shorter than [`Self::unknowns`].
    pub fn local(&self, u: &DVector<f64>) -> Vec<Local> {
        (0..self.elements).map(|k| self.element(k).local(&self.bodies(k, &entries(u, k)))).collect()
    }

    /// Returns points of the deformed axis from the left to the right base.
    ///
    /// The points divide each element into `intervals ≥ 1` intervals. Positions are relative to the
    /// node of the left scale at rest.
    ///
    /// # Panics
    /// If `u` is shorter than [`Self::unknowns`].
    pub fn axis(&self, u: &DVector<f64>, intervals: usize) -> Vec<Vec2> {
        let mut axis = Vec::new();
        for k in 0..self.elements {
            let displacements = entries(u, k);
            let first = self.rest_position(k) + Vec2::new(displacements[0], displacements[1]);
            let (element, bodies) = (self.element(k), self.bodies(k, &displacements));
            // The first point of an element is the last point of the previous element.
            for i in usize::from(k > 0)..=intervals {
                axis.push(first + element.axis_point(&bodies, i as f64 / intervals as f64));
            }
        }
        axis
    }

    /// Returns the position at rest of node `i`, relative to the node of the left scale.
    ///
    /// Nodes 0 and `m` are the nodes of the scales.
    fn rest_position(&self, i: usize) -> Vec2 {
        let Span { half_base, axis_offset, .. } = self.span;
        if i == 0 {
            Vec2::zeros()
        } else if i == self.elements {
            Vec2::new(self.pitch(), 0.0)
        } else {
            Vec2::new(half_base + i as f64 * self.beam.length(), -axis_offset)
        }
    }

    /// Returns the poses of the two nodes that element `k` connects, relative to the first node.
    ///
    /// `u` contains the displacements and rotations of both nodes.
    fn bodies(&self, k: usize, u: &Ends) -> Ends {
        let at_rest = self.rest_position(k + 1) - self.rest_position(k);
        Ends::new(0.0, 0.0, u[2], at_rest.x + (u[3] - u[0]), at_rest.y + (u[4] - u[1]), u[5])
    }
}

impl GapResponse {
    /// Adds the contribution of an element to the six entries from `start` on.
    fn add(&mut self, start: usize, element: &Response) {
        self.axial_energy += element.axial_energy;
        self.bending_energy += element.bending_energy;
        let mut force = self.force.fixed_rows_mut::<6>(start);
        force += element.force;
        let mut tangent = self.tangent.fixed_view_mut::<6, 6>(start, start);
        tangent += element.tangent;
    }
}

/// Returns the six entries of the state `u` that belong to the nodes of element `k`.
fn entries(u: &DVector<f64>, k: usize) -> Ends {
    u.fixed_rows::<6>(3 * k).into_owned()
}

/// Returns an error if a dimension of `span` is invalid.
pub(crate) fn check(span: &Span) -> Result<(), OutOfRange> {
    let Span { half_base, gap, axis_offset } = *span;
    positive("gap", gap)?;
    OutOfRange::unless(
        half_base >= 0.0 && half_base.is_finite(),
        "half-width of the base",
        half_base,
        "a length of at least 0",
    )?;
    let axis = "offset of the membrane's axis";
    OutOfRange::unless(axis_offset.is_finite(), axis, axis_offset, "a finite length")
}
