//! System of equations of a bent strip: a mixed complementarity system.

use contact::ContactLaw;
use geometry::{Body, Vec2};
use membrane::{Derivatives, GapEnergies, Membrane, Section};
use solver::{Blocks, Change, Condition, Control, LARGEST_BLOCK, LINK, Residual, System, Tangent};

use super::frame::Step;
use crate::arrangement::Arrangement;
use crate::contacts::{Contacts, SkinMode, SkinState, pair_constraints};

/// Layout of the unknowns of a strip of `n` gaps. The first scale is fixed.
///
/// ```text
/// λ λ' λ" λ λ' λ" · interior · x y φ | … | λ λ' λ" λ λ' λ" · interior · x y φ · M
/// └──────── gap 0 and scale 1 ───────┘     └──── gap n − 1 and scale n ────┘
/// ```
///
/// The order of a single gap with few interior unknowns is `interior · λ λ' λ" λ λ' λ" · x y φ · M`.
///
/// `interior` stands for the unknowns of the membrane of a gap. The interior unknowns and the
/// displacements `x y` are in the frame of the scale on the left of the gap. The rotation `φ` of a
/// scale is relative to the first scale. With friction each contact has two further unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct StripLayout {
    gaps: usize,
    /// Number of membrane unknowns of each gap.
    interior: usize,
    /// Number of contact unknowns of each gap.
    pair: usize,
}

impl StripLayout {
    fn block(self) -> usize {
        self.pair + self.interior + 3
    }

    fn size(self) -> usize {
        self.gaps * self.block() + 1
    }

    /// Returns the index of the first unknown of a scale; `None` for the first scale.
    fn scale(self, scale: usize) -> Option<usize> {
        Some(self.block() * scale.checked_sub(1)? + self.block() - 3)
    }

    /// Returns the index of the unknown rotation of a scale; `None` for the first scale.
    fn rotation(self, scale: usize) -> Option<usize> {
        Some(self.scale(scale)? + 2)
    }

    /// Returns the index of the first membrane unknown of a gap.
    fn membrane(self, gap: usize) -> usize {
        self.block() * gap + if self.has_interior_block() { 0 } else { self.pair }
    }

    /// Returns the indices of the unknowns of a membrane: interior, then right scale.
    fn of_membrane(self, gap: usize) -> impl Iterator<Item = usize> {
        let (start, end) = (self.membrane(gap), self.block() * (gap + 1));
        (start..start + self.interior).chain(end - 3..end)
    }

    fn force(self, force: usize) -> usize {
        let before = if self.has_interior_block() { self.interior } else { 0 };
        self.block() * (force / self.pair) + before + force % self.pair
    }

    /// Returns true if the interior unknowns form a block.
    ///
    /// In a single gap they are coupled only with the displacements of the right scale. In a chain
    /// they are also coupled with the rotation of the left scale.
    fn has_interior_block(self) -> bool {
        self.gaps == 1 && (LINK..=LARGEST_BLOCK).contains(&self.interior)
    }

    /// Returns the block structure, or `None` if blocks would be too large.
    ///
    /// Without interior unknowns there is one block for each free scale. A block holds the
    /// displacements of a scale and the contact forces between this scale and the next one. The
    /// first block also holds the contact forces between the fixed scale and its neighbour.
    ///
    /// A single gap has two blocks: its interior unknowns, and all others.
    fn blocks(self) -> Option<Blocks> {
        let mut links: Vec<_> = (1..=self.gaps).filter_map(|scale| self.scale(scale)).collect();
        let mut starts: Vec<_> = [0].into_iter().chain(links.iter().copied().skip(1)).collect();
        if self.has_interior_block() {
            // No block is farther from the root than the interior, so its link is not used.
            links.insert(0, 0);
            starts.push(self.interior);
        } else if self.interior > 0 {
            return None;
        }
        // The moment and the controls belong to the last scale, so its block must be the root.
        Some(Blocks { root: starts.len() - 1, starts, links, reach: 1 })
    }

    fn moment(self) -> usize {
        self.size() - 1
    }
}

/// Solved part of a strip, and the rotation to which it is bent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StripExtent {
    /// Number of gaps that are solved for.
    pub(crate) gaps: usize,
    /// Number of gaps of the whole strip divided by `gaps`; 1 for a chain.
    pub(crate) repeats: f64,
    /// Relative rotation (radians) of the ends of the solved part at the end of bending.
    pub(crate) rotation: f64,
    /// Rotation at the end of the path as a multiple of `rotation`.
    ///
    /// It is 1, except for one of several unequal gaps. Such a gap may rotate by more than its
    /// fraction of the rotation of the whole strip.
    pub(crate) farthest: f64,
}

/// One or several gaps in pure bending: the first scale is fixed, a moment acts on the last scale.
///
/// A single gap is the unit cell: in pure bending every cut carries the same moment and no force,
/// so equal gaps have equal deformations. Lengths are in units of `t`, rotations in radians, the
/// moment in `E_m t³` and contact forces in `E_m t²`.
#[derive(Clone, Debug)]
pub(crate) struct Strip {
    layout: StripLayout,
    /// One membrane for each gap, or a single one if all gaps are equal.
    membranes: Vec<Membrane>,
    pub(crate) contacts: Contacts,
    /// Number of gaps of the whole strip divided by the number of solved gaps.
    pub(super) repeats: f64,
    /// Mean pitch `p` of the scales.
    pitch: f64,
    /// Bending stiffness `E_m I_m` of the membrane, in units of `E_m t⁴`.
    bending_stiffness: f64,
    controls: [Control; 3],
    farthest: f64,
    blocks: Option<Blocks>,
    units: Vec<f64>,
}

impl Strip {
    /// Assembles a strip.
    ///
    /// `membranes` holds one membrane for each gap, or a single one for all equal gaps. All
    /// membranes have the same number of unknowns.
    pub(crate) fn new(
        row: Arrangement,
        membranes: Vec<Membrane>,
        law: ContactLaw,
        section: Section,
        StripExtent { gaps, repeats, rotation, farthest }: StripExtent,
    ) -> Self {
        let layout =
            StripLayout { gaps, interior: membranes[0].interior(), pair: pair_constraints(&law) };
        let scales = (0..=gaps).map(|scale| layout.scale(scale)).collect();
        let forces = (0..layout.pair * gaps).map(|force| layout.force(force)).collect();
        // The round-off of the equations of a fine mesh is proportional to the stiffness of its
        // elements. The units of these equations, which scale their tolerance, account for this.
        let mut units = vec![1.0; layout.size()];
        for gap in 0..gaps {
            let of_gap = membranes[gap.min(membranes.len() - 1)].units();
            for (unknown, unit) in layout.of_membrane(gap).zip(of_gap.iter()) {
                units[unknown] = *unit;
            }
        }
        let last = layout.moment() - 3;
        // Displacements of the last scale are relative to its neighbour, so scale them with the
        // pitch of both.
        let pitch = row.pitch(gaps - 1);
        Self {
            layout,
            membranes,
            repeats,
            pitch: row.mean_pitch(),
            bending_stiffness: section.bending_stiffness(),
            contacts: Contacts::new(row, Body::default(), law, scales, forces, true),
            blocks: layout.blocks(),
            // The first control is the control parameter of the path: the rotation.
            controls: [(2, rotation), (0, pitch), (1, pitch)]
                .map(|(k, scale)| Control { index: last + k, scale }),
            farthest,
            units,
        }
    }

    /// Returns the number of solved gaps.
    pub(crate) fn gaps(&self) -> usize {
        self.layout.gaps
    }

    /// Returns the rotation of the last scale relative to the first scale, radians.
    pub(crate) fn rotation(&self, z: &[f64]) -> f64 {
        z[self.controls[0].index]
    }

    /// Returns the moment `M`, in units of `E_m t³`.
    pub(crate) fn moment(&self, z: &[f64]) -> f64 {
        z[self.layout.moment()]
    }

    /// Returns the number of gaps of the whole strip, rounded.
    pub(crate) fn whole_gaps(&self) -> usize {
        (self.repeats * self.layout.gaps as f64).round() as usize
    }

    /// Returns the curvature `κ*`: the rotation of the solved gaps divided by their length.
    pub(crate) fn curvature(&self, z: &[f64]) -> f64 {
        self.rotation(z) / (self.layout.gaps as f64 * self.pitch)
    }

    /// Returns the moment `M*`.
    pub(crate) fn normalised_moment(&self, z: &[f64]) -> f64 {
        self.moment(z) / self.bending_stiffness
    }

    /// Converts `dM/dΦ` of the solved gaps to `dM*/dκ*`.
    ///
    /// `M* = M/(E_m I_m)` and `κ* = Φ/(n p)`, in units of `t`.
    pub(crate) fn normalised_stiffness(&self, stiffness: f64) -> f64 {
        stiffness * self.layout.gaps as f64 * self.pitch / self.bending_stiffness
    }

    /// Returns the pose of the right scale relative to the left scale, for each solved gap.
    pub(crate) fn steps(&self, z: &[f64]) -> Vec<Step> {
        let poses = (1..=self.layout.gaps).map(|scale| self.contacts.pose(z, scale));
        poses.map(|pose| [pose.displacement.x, pose.displacement.y, pose.rotation]).collect()
    }

    /// Computes the membrane energy of the solved gaps.
    pub(crate) fn membrane_energy(&self, state: &SkinState) -> GapEnergies {
        let mut energy = GapEnergies { axial: 0.0, bending: 0.0 };
        for gap in 0..self.layout.gaps {
            let of_gap = self.membrane(gap).energies(&self.acting(state, gap));
            energy.axial += of_gap.axial;
            energy.bending += of_gap.bending;
        }
        energy
    }

    /// Computes the axial fraction of the elastic energy.
    pub(crate) fn axial_energy_share(&self, state: &SkinState) -> f64 {
        let GapEnergies { axial, bending } = self.membrane_energy(state);
        axial / (bending + axial + self.contacts.energy(state))
    }

    /// Computes the largest strain at the surface of the membrane of any gap.
    pub(crate) fn largest_strain(&self, state: &SkinState) -> f64 {
        (0..self.layout.gaps)
            .map(|gap| self.membrane(gap).largest_strain(&self.acting(state, gap)))
            .fold(0.0, f64::max)
    }

    /// Samples points of the deformed membrane axis in a gap, in the frame of its left scale.
    ///
    /// Each element is divided into `intervals`. Points are relative to the node of the left scale.
    pub(crate) fn axis(&self, state: &SkinState, gap: usize, intervals: usize) -> Vec<Vec2> {
        self.membrane(gap).axis(&self.acting(state, gap), intervals)
    }

    /// Transfers a state to `finer`, the same strip with more membrane unknowns.
    ///
    /// `None` for co-rotational elements, which are not refined.
    pub(crate) fn transferred(&self, state: &SkinState, finer: &Self) -> Option<SkinState> {
        let (ours, theirs) = (self.layout, finer.layout);
        let mut z = vec![state.z[ours.moment()]; theirs.size()];
        for gap in 0..ours.gaps {
            let membrane: Vec<_> = ours.of_membrane(gap).map(|unknown| state.z[unknown]).collect();
            let membrane = self.membrane(gap).transferred(&membrane, finer.membrane(gap))?;
            theirs.of_membrane(gap).zip(membrane).for_each(|(unknown, value)| z[unknown] = value);
        }
        for force in 0..ours.pair * ours.gaps {
            z[theirs.force(force)] = state.z[ours.force(force)];
        }
        // Constraints and modes belong to contacts, so they do not depend on the resolution.
        Some(SkinState { z, active: state.active.clone(), mode: state.mode.clone() })
    }

    /// Returns the condition that the relative rotation of the ends is the one in `state`.
    pub(crate) fn same_rotation(&self, state: &SkinState) -> Condition {
        Condition::through(vec![(self.controls[0].index, 1.0)], &state.z)
    }

    /// Returns the condition that a moment of magnitude `size` acts in the direction of bending.
    pub(crate) fn under_moment(&self, size: f64) -> Condition {
        Condition::new(vec![(self.layout.moment(), self.direction())], size)
    }

    /// Returns 1 with the scales on the inside of the bend, −1 with the scales on the outside.
    pub(crate) fn direction(&self) -> f64 {
        self.controls[0].scale.signum()
    }

    fn membrane(&self, gap: usize) -> &Membrane {
        match self.membranes.as_slice() {
            [membrane] => membrane,
            membranes => &membranes[gap],
        }
    }

    /// Counts the membrane unknowns at the start of a gap that vanish because no contact is closed.
    ///
    /// In pure bending no cut of the strip carries a force. Without a contact force the membrane of
    /// a gap therefore carries no force and bends to an arc.
    fn straight(&self, active: &[bool], gap: usize) -> usize {
        let forces = &active[self.layout.pair * gap..][..self.layout.pair];
        // A single active contact force loads the membrane.
        if forces.contains(&true) { 0 } else { self.membrane(gap).vanishing() }
    }

    /// Returns the membrane unknowns of a gap in the frame of its left scale.
    ///
    /// Unknowns that vanish by [`Self::straight`] are omitted.
    fn acting(&self, state: &SkinState, gap: usize) -> Vec<f64> {
        let (start, end) = (self.layout.membrane(gap), self.layout.block() * (gap + 1));
        let first = start + self.straight(&state.active, gap);
        // Copy slices, because this is called for each tangent.
        let mut seen =
            [&state.z[first..start + self.layout.interior], &state.z[end - 3..end]].concat();
        if let (Some(frame), Some(rotation)) = (self.layout.rotation(gap), seen.last_mut()) {
            *rotation -= state.z[frame];
        }
        seen
    }

    /// Adds the membrane equations of a gap, and their derivatives.
    fn add_membrane(
        &self,
        state: &SkinState,
        gap: usize,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let acting = self.acting(state, gap);
        let Derivatives { gradient, hessian } = self.membrane(gap).derivatives(&acting);
        let last = acting.len() - 1;
        let (interior, scale) = (last - 2, self.layout.block() * (gap + 1) - 3);
        let first = self.layout.membrane(gap) + self.layout.interior - interior;
        // The membrane depends on the rotation of the right scale minus the rotation of the left
        // scale, so its equations also contribute to the rotation of the left scale, with sign −1.
        let frame = self.layout.rotation(gap).map(|frame| (frame, last, -1.0));
        let own = (first..first + interior).chain(scale..scale + 3).zip(0..);
        for (unknown, row, sign) in own.map(|(unknown, row)| (unknown, row, 1.0)).chain(frame) {
            residual.add(unknown, sign * gradient[row]);
            // The matrix is symmetric, and its columns are contiguous.
            let entries = &hessian.as_slice()[acting.len() * row..][..acting.len()];
            // Contact forces may separate the columns.
            let successive = if first + interior == scale { acting.len() } else { interior };
            let (by_first, by_scale) = entries.split_at(successive);
            matrix.add_row(unknown, first, by_first.iter().map(|entry| sign * entry));
            matrix.add_row(unknown, scale, by_scale.iter().map(|entry| sign * entry));
            if let Some((frame, ..)) = frame {
                matrix.add(unknown, frame, -sign * entries[last]);
            }
        }
    }
}

impl System for Strip {
    type Mode = SkinMode;

    fn size(&self) -> usize {
        self.layout.size()
    }

    fn half_bandwidth(&self) -> usize {
        // Distance from the unknown `φ` of a scale to `φ` of the next scale.
        self.layout.block()
    }

    fn blocks(&self) -> Option<&Blocks> {
        self.blocks.as_ref()
    }

    fn is_in_blocks(&self, state: &SkinState) -> bool {
        // Without a force, the interior block would be singular at zero rotation.
        !self.layout.has_interior_block() || self.straight(&state.active, 0) == 0
    }

    fn load(&self) -> usize {
        self.layout.moment()
    }

    fn target(&self) -> f64 {
        self.farthest
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn constraints(&self) -> &[usize] {
        &self.contacts.forces
    }

    fn vanishing(&self, state: &SkinState) -> impl Iterator<Item = usize> {
        (0..self.layout.gaps).flat_map(|gap| {
            let start = self.layout.membrane(gap);
            start..start + self.straight(&state.active, gap)
        })
    }

    fn monotone(&self) -> &[usize] {
        &self.contacts.slip_distances
    }

    fn stop_sliding(&self, state: &mut SkinState) {
        self.contacts.stop_sliding(state);
    }

    fn coupled(&self, constraint: usize) -> std::ops::Range<usize> {
        self.contacts.coupled(constraint)
    }

    fn is_same_form(&self, one: &SkinMode, other: &SkinMode) -> bool {
        one.is_same_form(other)
    }

    fn mode_at_rest(&self) -> SkinMode {
        self.contacts.open()
    }

    fn linearise(&self, state: &SkinState, residual: &mut Residual, matrix: &mut impl Tangent) {
        residual.clear(&self.units);
        for gap in 0..self.layout.gaps {
            self.add_membrane(state, gap, residual, matrix);
        }
        // The moment `M` acts on the rotation of the last scale only (F1).
        let (moment, turned) = (self.layout.moment(), self.controls[0].index);
        residual.add(turned, -state.z[moment]);
        matrix.add(turned, moment, -1.0);
        self.contacts.linearise(state, residual, matrix);
    }

    fn conditions(&self, state: &SkinState, values: &mut Vec<f64>) {
        self.contacts.conditions(state, values);
    }

    fn condition_slopes(
        &self,
        state: &SkinState,
        direction: &[f64],
        values: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
    ) {
        self.contacts.condition_slopes(state, direction, values, slopes);
    }

    fn condition(&self, state: &SkinState, constraint: usize) -> f64 {
        self.contacts.condition(state, constraint)
    }

    fn slope(&self, state: &SkinState, constraint: usize, direction: &[f64]) -> f64 {
        self.contacts.slope(state, constraint, direction)
    }

    fn transition(&self, state: &mut SkinState, change: Change) -> Option<usize> {
        self.contacts.transition(state, change)
    }
}
