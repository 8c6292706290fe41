//! A strip of membrane with scales, bent by a moment, as a mixed complementarity system.

use contact::{ContactLaw, CornerContact};
use geometry::Vec2;
use membrane::{Ends, GapMembrane, Response, Section};
use nalgebra::DVector;
use solver::{Blocks, Change, Control, Residual, System, Tangent};

use super::frame::Step;
use crate::arrangement::Arrangement;
use crate::contacts::{Contacts, PAIR_FORCES, Part, State};

/// The order of the unknowns of a strip of `n` gaps of `m` elements. The first scale is held.
///
/// ```text
/// λ λ' λ" λ λ' λ" · node 1 … node m−1 · x y φ | … | λ λ' λ" λ λ' λ" · nodes · x y φ · M
/// └─────────── gap 0 and scale 1 ───────────┘     └─────── gap n − 1 and scale n ─────┘
/// ```
///
/// Positions `x y`, and the nodes, are those in the frame of the scale to the left of the gap; the
/// rotation `φ` of a scale is counted from the first scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    gaps: usize,
    elements: usize,
}

impl Layout {
    fn block(self) -> usize {
        PAIR_FORCES + 3 * self.elements
    }

    fn size(self) -> usize {
        self.gaps * self.block() + 1
    }

    /// First unknown of a scale; the first scale has none.
    fn scale(self, scale: usize) -> Option<usize> {
        Some(self.block() * scale.checked_sub(1)? + self.block() - 3)
    }

    /// Rotation of a scale; the first scale has none.
    fn rotation(self, scale: usize) -> Option<usize> {
        Some(self.scale(scale)? + 2)
    }

    /// First unknown of the `i`-th pose of a gap's membrane: its interior nodes, its right scale. The
    /// left scale is the frame, and has none.
    fn node(self, gap: usize, i: usize) -> Option<usize> {
        Some(self.block() * gap + PAIR_FORCES + 3 * i.checked_sub(1)?)
    }

    fn force(self, force: usize) -> usize {
        self.block() * (force / PAIR_FORCES) + force % PAIR_FORCES
    }

    /// A block for each scale that is not held, with the forces of its contacts with the next one. The first has those with
    /// the scale that is held, too. Interior nodes would make blocks too large.
    fn blocks(self) -> Option<Blocks> {
        let links: Vec<_> = (1..=self.gaps).filter_map(|scale| self.scale(scale)).collect();
        let starts = [0].into_iter().chain(links.iter().copied().skip(1)).collect();
        (self.elements == 1).then_some(Blocks { starts, links, root: self.gaps - 1 })
    }

    fn moment(self) -> usize {
        self.size() - 1
    }
}

/// The part of a strip that is solved for, and the rotation to which it is bent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// Gaps that are solved for.
    pub(crate) gaps: usize,
    /// Gaps of the whole strip for each gap that is solved for.
    pub(crate) repeats: usize,
    /// Rotation (radians) of the ends of what is solved for against each other at which the bending ends.
    pub(crate) rotation: f64,
}

/// Elastic energy of a membrane, over `E_m t³`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MembraneEnergy {
    pub(crate) bending: f64,
    pub(crate) axial: f64,
}

/// A strip of gaps in pure bending, the first scale held, a moment on the last.
///
/// One gap is the unit cell: every cut of a strip in pure bending carries the same moment and no
/// force, so every gap deforms alike. Unknowns are in `t` and radians, the moment and the contact forces in
/// `E_m t³` and `E_m t²`.
#[derive(Clone, Debug)]
pub(crate) struct Strip {
    layout: Layout,
    /// The membrane of each gap, or one for all where they are alike.
    membranes: Vec<GapMembrane>,
    pub(crate) contacts: Contacts,
    /// Gaps of the whole strip for each gap that is solved for.
    repeats: usize,
    /// Mean pitch `p` of the scales.
    pitch: f64,
    /// `E_m I_m`, over `E_m t⁴`.
    bending_stiffness: f64,
    controls: [Control; 3],
    blocks: Option<Blocks>,
    units: Vec<f64>,
}

impl Strip {
    /// A strip of a membrane of this `section`, of the given extent. `membranes` are those of the gaps, all of equally many elements, or one for all.
    pub(crate) fn new(
        row: Arrangement,
        membranes: Vec<GapMembrane>,
        law: ContactLaw,
        section: Section,
        Extent { gaps, repeats, rotation }: Extent,
    ) -> Self {
        let layout = Layout { gaps, elements: membranes[0].elements() };
        let scales = (0..=gaps).map(|scale| layout.scale(scale)).collect();
        let forces = (0..PAIR_FORCES * gaps).map(|force| layout.force(force)).collect();
        let mut units = vec![1.0; layout.size()];
        for gap in 0..gaps {
            // Forces of an element: a finer mesh is stiffer, and rounds off as much more.
            let element = row.gap(gap) / layout.elements as f64;
            let axial = section.axial_stiffness() / element;
            let bending = section.bending_stiffness() / element;
            for node in (1..=layout.elements).filter_map(|node| layout.node(gap, node)) {
                units[node..node + 3].copy_from_slice(&[axial, axial, bending]);
            }
        }
        let last = layout.moment() - 3;
        let control = |k: usize, scale| Control { index: last + k, scale };
        let pitch = row.pitch(gaps - 1);
        Self {
            layout,
            membranes,
            repeats,
            pitch: row.mean_pitch(),
            bending_stiffness: section.bending_stiffness(),
            contacts: Contacts::relative(row, law, scales, forces),
            blocks: layout.blocks(),
            controls: [control(2, rotation), control(0, pitch), control(1, pitch)],
            units,
        }
    }

    /// Number of gaps.
    pub(crate) fn gaps(&self) -> usize {
        self.layout.gaps
    }

    /// Rotation of the last scale against the first, radians.
    pub(crate) fn rotation(&self, z: &[f64]) -> f64 {
        z[self.controls[0].index]
    }

    /// The moment `M`, over `E_m t³`.
    pub(crate) fn moment(&self, z: &[f64]) -> f64 {
        z[self.layout.moment()]
    }

    /// Gaps of the whole strip for each gap that is solved for.
    pub(crate) fn repeats(&self) -> usize {
        self.repeats
    }

    /// `κ*`, from the rotation and the length of the gaps that are solved for.
    pub(crate) fn curvature(&self, z: &[f64]) -> f64 {
        self.rotation(z) / (self.layout.gaps as f64 * self.pitch)
    }

    /// `M*`.
    pub(crate) fn normalised_moment(&self, z: &[f64]) -> f64 {
        self.moment(z) / self.bending_stiffness
    }

    /// `dM*/dκ*` from `dM/dΦ` of the gaps that are solved for: `M* = M/(E_m I_m)` and `κ* = Φ/(n p)`, in units of `t`.
    pub(crate) fn normalised_stiffness(&self, stiffness: f64) -> f64 {
        stiffness * self.layout.gaps as f64 * self.pitch / self.bending_stiffness
    }

    /// Displacement and rotation of the right scale of each gap, seen from the left one.
    pub(crate) fn steps(&self, z: &[f64]) -> Vec<Step> {
        let poses = (1..=self.layout.gaps).map(|scale| self.contacts.pose(z, scale));
        poses.map(|pose| [pose.displacement.x, pose.displacement.y, pose.rotation]).collect()
    }

    /// Energy of the membrane of the gaps that are solved for.
    pub(crate) fn membrane_energy(&self, state: &State) -> MembraneEnergy {
        let mut energy = MembraneEnergy::default();
        for (gap, element) in self.all_elements() {
            let response = self.response(&state.z, gap, element);
            energy.bending += response.bending_energy;
            energy.axial += response.axial_energy;
        }
        energy
    }

    /// The deformed axis of the membrane in a gap, in intervals of its elements, from the node of the
    /// left scale and seen from it.
    pub(crate) fn axis(&self, z: &[f64], gap: usize, intervals: usize) -> Vec<Vec2> {
        let membrane = self.membrane(gap);
        let mut state = DVector::zeros(membrane.unknowns());
        for element in 0..self.layout.elements {
            state.fixed_rows_mut::<6>(3 * element).copy_from(&self.ends(z, gap, element));
        }
        membrane.axis(&state, intervals)
    }

    fn membrane(&self, gap: usize) -> &GapMembrane {
        match self.membranes.as_slice() {
            [membrane] => membrane,
            membranes => &membranes[gap],
        }
    }

    fn all_elements(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let elements = self.layout.elements;
        (0..self.layout.gaps).flat_map(move |gap| (0..elements).map(move |element| (gap, element)))
    }

    fn response(&self, z: &[f64], gap: usize, element: usize) -> Response {
        self.membrane(gap).element_response(element, &self.ends(z, gap, element))
    }

    /// Displacements of the ends of an element.
    fn ends(&self, z: &[f64], gap: usize, element: usize) -> Ends {
        let mut ends = Ends::zeros();
        for Part { unknown, coordinate, sign } in self.parts(gap, element).into_iter().flatten() {
            ends[coordinate] += sign * z[unknown];
        }
        ends
    }

    /// The unknowns that the six displacements of an element are made of: those of its nodes and, where it
    /// ends at the right scale, the rotation of the left one.
    fn parts(&self, gap: usize, element: usize) -> [Option<Part>; 7] {
        let layout = self.layout;
        let [first, second] = [element, element + 1].map(|node| layout.node(gap, node));
        let frame = layout.rotation(gap).filter(|_| element + 1 == layout.elements);
        std::array::from_fn(|k| match k {
            0..3 => Some(Part::new(first? + k, k)),
            3..6 => Some(Part::new(second? + k - 3, k)),
            _ => Some(Part::new(frame?, 5).opposite()),
        })
    }
}

impl System for Strip {
    type Mode = Vec<CornerContact>;

    fn size(&self) -> usize {
        self.layout.size()
    }

    fn half_bandwidth(&self) -> usize {
        // From φ of a scale to φ of the next.
        self.layout.block()
    }

    fn blocks(&self) -> Option<&Blocks> {
        self.blocks.as_ref()
    }

    fn load(&self) -> usize {
        self.layout.moment()
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn constraints(&self) -> &[usize] {
        self.contacts.forces()
    }

    fn mode_at_rest(&self) -> Vec<CornerContact> {
        self.contacts.open()
    }

    fn residual(&self, state: &State, residual: &mut Residual) {
        let z = &state.z;
        residual.clear(&self.units);
        for (gap, element) in self.all_elements() {
            let force = self.response(z, gap, element).force;
            for Part { unknown, coordinate, sign } in self.parts(gap, element).into_iter().flatten()
            {
                residual.add(unknown, sign * force[coordinate]);
            }
        }
        residual.add(self.controls[0].index, -z[self.layout.moment()]);
        self.contacts.add_residual(state, residual);
    }

    fn tangent(&self, state: &State, matrix: &mut impl Tangent) {
        let z = &state.z;
        for (gap, element) in self.all_elements() {
            let tangent = self.response(z, gap, element).tangent;
            let entries = self.parts(gap, element);
            for row in entries.iter().flatten() {
                for column in entries.iter().flatten() {
                    let value = tangent[(row.coordinate, column.coordinate)];
                    matrix.add(row.unknown, column.unknown, row.sign * column.sign * value);
                }
            }
        }
        matrix.add(self.controls[0].index, self.layout.moment(), -1.0);
        self.contacts.add_tangent(state, matrix);
    }

    fn linearise(&self, state: &State, residual: &mut Residual, matrix: &mut impl Tangent) {
        residual.clear(&self.units);
        for (gap, element) in self.all_elements() {
            let response = self.response(&state.z, gap, element);
            let parts = self.parts(gap, element);
            for row in parts.iter().flatten() {
                residual.add(row.unknown, row.sign * response.force[row.coordinate]);
                for column in parts.iter().flatten() {
                    let value = response.tangent[(row.coordinate, column.coordinate)];
                    matrix.add(row.unknown, column.unknown, row.sign * column.sign * value);
                }
            }
        }
        let moment = self.layout.moment();
        residual.add(self.controls[0].index, -state.z[moment]);
        matrix.add(self.controls[0].index, moment, -1.0);
        self.contacts.linearise(state, residual, matrix);
    }

    fn conditions(&self, state: &State, values: &mut Vec<f64>) {
        self.contacts.conditions(state, values);
    }

    fn condition_slopes(&self, state: &State, direction: &[f64], slopes: &mut Vec<f64>) {
        self.contacts.condition_slopes(state, direction, slopes);
    }

    fn condition(&self, state: &State, constraint: usize) -> f64 {
        self.contacts.condition(state, constraint)
    }

    fn slope(&self, state: &State, constraint: usize, direction: &[f64]) -> f64 {
        self.contacts.slope(state, constraint, direction)
    }

    fn transition(&self, state: &mut State, change: Change) -> Option<usize> {
        self.contacts.transition(state, change)
    }
}
