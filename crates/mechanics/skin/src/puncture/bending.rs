//! Scales that bend under the forces of their neighbours and of a load (B7–B9).
//!
//! Each scale is a beam, clamped at its base. The forces `Λ` on a scale have the complementary
//! energy `U = ½ Σ C_kl Λ_k Λ_l` (B7). The flexibilities `C_kl` depend on the unknowns, because the
//! unknowns determine the positions and directions of the forces in the frame of the scale. With
//! the substrate energy `V`, all equations are derivatives of one function `L = V − Σ Λ g − U`:
//!
//! ```text
//! contact k           g_k + δ(Λ_k) + ∂U/∂Λ_k = 0
//! equilibrium         ∂V/∂u − Σ Λ_k ∇g_k − ∂U/∂u = 0                                 (B8)
//! depth, total tilt   D = D_rigid + ∂U/∂F,   ϑ = φ + ∂U/∂M                           (B9)
//! ```
//!
//! `M` is a moment at the tip, of value 0. The tangent is symmetric, and the work of the load
//! equals the energy of substrate, contacts and scales.

mod flexibility;

use contact::COORDINATES;
use geometry::Vec2;
use solver::{Residual, Tangent};

use self::flexibility::{BeamLoad, Flexibility, Section};
use super::beam::Beam;
use super::system::Chain;
use crate::contacts::SkinState;

/// Number of unknowns after the load of a free needle on elastic scales: depth and total tilt.
pub(super) const BENDING_UNKNOWNS: usize = 2;

/// Half of the length on which a shear force falls to 0 around its load, in beam depths.
///
/// The shear force of a point load jumps at the load. If two such loads passed each other, the
/// energy would have a kink and the equilibrium would jump.
const SPREAD: f64 = 0.25;

/// Largest relative difference between the end of a complete path and the critical tilt.
const AT_THE_TILT: f64 = 1e-9;

/// Displacement of the beam at one load `k`, caused by all loads of its scale.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Displacement `Σ C_kl Λ_l` in the direction of load `k`.
    displacement: f64,
    /// First derivative of the displacement with respect to the position of load `k`.
    slope: f64,
    /// Second derivative of the displacement with respect to the position of load `k`.
    curvature: f64,
}

/// One scale as a beam, with its loads.
struct BentScale {
    /// Index of the scale in the row.
    scale: usize,
    beam: Beam,
    section: Section,
    loads: Vec<BeamLoad>,
}

/// Loads of a scale with the flexibilities between them, for the tangent.
///
/// Many loads depend on the same unknowns, so their entries are summed in a short row of
/// `3 nodes + loads` entries before they enter the tangent.
struct Coupling<'a> {
    loads: &'a [BeamLoad],
    /// `C_kl` row by row; the first derivative is with respect to the position of load `k`.
    flexibilities: Vec<Flexibility>,
    /// Index of the unknown `x` of each scale on which the loads depend.
    nodes: Vec<usize>,
    /// Positions in the short row of the six unknowns on which each load depends.
    positions: Vec<[usize; COORDINATES]>,
}

impl BentScale {
    /// Computes the flexibilities between all loads of the scale.
    fn coupling(&self) -> Coupling<'_> {
        let loads = &self.loads[..];
        let mut nodes = Vec::with_capacity(3);
        for node in loads.iter().flat_map(|load| [load.at[0], load.at[3]]) {
            if !nodes.contains(&node) {
                nodes.push(node);
            }
        }
        let positions = loads.iter().map(|load| {
            let [left, right] = [load.at[0], load.at[3]]
                .map(|node| 3 * nodes.iter().position(|other| *other == node).unwrap_or_default());
            [left, left + 1, left + 2, right, right + 1, right + 2]
        });
        let positions = positions.collect();
        let pairs = loads.iter().flat_map(|k| loads.iter().map(move |l| (k, l)));
        let flexibilities = pairs.map(|(k, l)| self.section.flexibility(k, l)).collect();
        Coupling { loads, flexibilities, nodes, positions }
    }

    /// Computes the displacement at a load `k`, which need not be one of the loads of the scale.
    fn sums(&self, k: &BeamLoad) -> Sums {
        let flexibilities = self.loads.iter().map(|l| self.section.flexibility(k, l));
        summed(&self.loads, flexibilities)
    }

    /// Computes the displacement at a load `k`, and its derivative along a direction of unknowns.
    fn moving(&self, k: &BeamLoad, direction: &[f64]) -> [f64; 2] {
        let own = k.along(direction);
        let [mut displacement, mut rate] = [0.0; 2];
        for l in &self.loads {
            let flexibility = self.section.flexibility(k, l);
            let by_other = self.section.flexibility(l, k).by_first;
            displacement += l.force * flexibility.value;
            rate += l.force * (flexibility.by_first * own + by_other * l.along(direction));
            rate += flexibility.value * l.unknown.map_or(0.0, |unknown| direction[unknown]);
        }
        [displacement, rate]
    }
}

fn summed(loads: &[BeamLoad], flexibilities: impl Iterator<Item = Flexibility>) -> Sums {
    let mut sums = Sums::default();
    for (l, flexibility) in loads.iter().zip(flexibilities) {
        sums.displacement += l.force * flexibility.value;
        sums.slope += l.force * flexibility.by_first;
        sums.curvature += l.force * flexibility.by_first_twice;
    }
    sums
}

impl Coupling<'_> {
    /// Counts the entries of a short row: motions of scales, then forces of loads.
    fn width(&self) -> usize {
        3 * self.nodes.len() + self.loads.len()
    }

    fn flexibility(&self, k: usize, l: usize) -> &Flexibility {
        &self.flexibilities[k * self.loads.len() + l]
    }

    fn sums(&self, k: usize) -> Sums {
        let flexibilities = self.flexibilities[k * self.loads.len()..].iter().copied();
        summed(self.loads, flexibilities)
    }

    /// Adds `value` times the derivatives of the coordinate of a load to a short row.
    fn add_slopes(&self, load: usize, value: f64, row: &mut [f64]) {
        for (position, slope) in self.positions[load].into_iter().zip(self.loads[load].slopes) {
            row[position] += value * slope;
        }
    }

    /// Adds a short row to the tangent.
    fn add_row(&self, row: usize, values: &[f64], matrix: &mut impl Tangent) {
        let (motions, forces) = values.split_at(3 * self.nodes.len());
        for (node, values) in self.nodes.iter().zip(motions.chunks_exact(3)) {
            if *values != [0.0; 3] {
                matrix.add_row(row, *node, values.iter().copied());
            }
        }
        for (load, value) in self.loads.iter().zip(forces) {
            if let Some(unknown) = load.unknown {
                matrix.add(row, unknown, *value);
            }
        }
    }

    /// Adds `sign` times the displacement at load `k` to the equation `row`, and to its tangent.
    fn add_displacement(
        &self,
        (row, sign): (usize, f64),
        k: usize,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let sums = self.sums(k);
        residual.add(row, sign * sums.displacement);
        let mut values = vec![0.0; self.width()];
        self.add_slopes(k, sign * sums.slope, &mut values);
        for (l, load) in self.loads.iter().enumerate() {
            self.add_slopes(l, sign * load.force * self.flexibility(l, k).by_first, &mut values);
            values[3 * self.nodes.len() + l] += sign * self.flexibility(k, l).value;
        }
        self.add_row(row, &values, matrix);
    }

    /// Adds the forces `−∂U/∂u` to the equilibrium equations of the scales.
    fn add_balance(&self, residual: &mut Residual, matrix: &mut impl Tangent) {
        let (width, motions) = (self.width(), 3 * self.nodes.len());
        let mut square = vec![0.0; motions * width];
        let mut row = vec![0.0; width];
        for (k, load) in self.loads.iter().enumerate() {
            let sums = self.sums(k);
            for (row, slope) in load.varying() {
                residual.add(row, -load.force * sums.slope * slope);
            }
            // The short row holds the derivatives of the force along the coordinate of load `k`.
            row.fill(0.0);
            self.add_slopes(k, -load.force * sums.curvature, &mut row);
            row[motions + k] -= sums.slope;
            for (l, other) in self.loads.iter().enumerate() {
                let flexibility = self.flexibility(k, l);
                row[motions + l] -= load.force * flexibility.by_first;
                self.add_slopes(l, -load.force * other.force * flexibility.by_both, &mut row);
            }
            let positions = &self.positions[k];
            for (i, &position) in positions.iter().enumerate() {
                let entries = &mut square[position * width..][..width];
                if load.slopes[i] != 0.0 {
                    for (entry, value) in entries.iter_mut().zip(&row) {
                        *entry += load.slopes[i] * value;
                    }
                }
                for (&column, curvature) in positions.iter().zip(load.curvature[i]) {
                    entries[column] -= load.force * sums.slope * curvature;
                }
            }
        }
        for (k, values) in square.chunks_exact(width).enumerate() {
            self.add_row(self.nodes[k / 3] + k % 3, values, matrix);
        }
    }
}

impl Chain {
    /// Returns the indices of depth and total tilt; `None` for rigid scales.
    pub(super) fn bending_unknowns(&self) -> Option<[usize; 2]> {
        self.is_elastic.then(|| [self.layout.load() + 1, self.layout.load() + 2])
    }

    /// Returns a scale as a beam, without its loads.
    fn unloaded(&self, scale: usize) -> BentScale {
        let beam = Beam::new(&self.contacts.arrangement.scale(scale), self.width);
        let [bending, shear_stiffness] = beam.stiffness(self.scale_modulus / self.plane_modulus);
        let (length, spread) = (beam.length, SPREAD * beam.depth);
        let section = Section { length, spread, bending, shear_stiffness };
        BentScale { scale, beam, section, loads: Vec::new() }
    }

    /// Lists the loaded scales, the punctured one first.
    fn bent_scales(&self, state: &SkinState) -> Vec<BentScale> {
        let punctured = self.layout.left;
        let mut bent = vec![self.unloaded(punctured)];
        let load = self.free_load(&bent[0].beam, state);
        bent[0].loads.push(load);
        let mut indices = vec![None; self.layout.scales()];
        indices[punctured] = Some(0);
        for touching in self.contacts.closed_edges(state) {
            for scale in touching.ends {
                let at = *indices[scale].get_or_insert_with(|| {
                    bent.push(self.unloaded(scale));
                    bent.len() - 1
                });
                let load = BeamLoad::of_contact(&bent[at].beam, &touching, scale);
                bent[at].loads.extend(load);
            }
        }
        bent
    }

    /// Returns a scale as a beam, with its loads.
    fn bent_scale(&self, state: &SkinState, scale: usize) -> BentScale {
        let mut bent = self.unloaded(scale);
        if scale == self.layout.left {
            bent.loads.push(self.free_load(&bent.beam, state));
        }
        let touching = self.contacts.closed_edges_of(state, scale);
        let loads =
            touching.filter_map(|touching| BeamLoad::of_contact(&bent.beam, &touching, scale));
        bent.loads.extend(loads);
        bent
    }

    /// Returns the dead load in the frame of the punctured scale.
    ///
    /// Its direction in this frame turns as the scale rotates.
    fn free_load(&self, beam: &Beam, state: &SkinState) -> BeamLoad {
        let at = self.layout.scale(self.layout.left);
        let back = contact::Pose::new(0.0, 0.0, -state.z[at + 2]);
        let arm = self.load_arm;
        let direction = back.turn(Vec2::new(0.0, -1.0));
        let mut slopes = [0.0; COORDINATES];
        slopes[2] = -1.0;
        let load = self.layout.load();
        BeamLoad {
            unknown: Some(load),
            force: state.z[load],
            at: [at, at + 1, at + 2, at, at + 1, at + 2],
            slopes,
            ..BeamLoad::at_point(beam, arm, direction, arm.dot(&beam.along))
        }
    }

    /// Returns true if a path on elastic scales ended before the critical tilt.
    ///
    /// A contact has then reached the end of its edge.
    pub(super) fn ends_at_a_corner(&self, state: &SkinState) -> bool {
        let tilt = self.controls[0];
        self.is_elastic && state.z[tilt.index] / tilt.scale < 1.0 - AT_THE_TILT
    }

    /// Adds the bending of all scales to the equations and the tangent.
    pub(super) fn add_bending(
        &self,
        state: &SkinState,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let Some([depth, tilt]) = self.bending_unknowns() else { return };
        let at = self.layout.scale(self.layout.left);
        let arm = self.loaded_arm(&state.z);
        residual.add(depth, state.z[depth]);
        residual.add(depth, -self.rigid_depth(&state.z));
        residual.add(tilt, state.z[tilt]);
        residual.add(tilt, -state.z[at + 2]);
        for (row, column, value) in [
            (depth, depth, 1.0),
            (depth, at + 1, 1.0),
            (depth, at + 2, arm.x),
            (tilt, tilt, 1.0),
            (tilt, at + 2, -1.0),
        ] {
            matrix.add(row, column, value);
        }
        let mut bent = self.bent_scales(state);
        let punctured = &mut bent[0];
        punctured.loads.push(BeamLoad::tip_moment(&punctured.beam, punctured.loads[0].at));
        for scale in &bent {
            let coupling = scale.coupling();
            coupling.add_balance(residual, matrix);
            for (k, load) in scale.loads.iter().enumerate() {
                // The displacement at the needle enters the equation of the depth, the rotation at
                // the tip moment enters the equation of the total tilt, and the displacement at a
                // contact enters the equation of this contact.
                let condition = match load.unknown {
                    Some(row) if row == self.layout.load() => (depth, -1.0),
                    Some(row) => (row, 1.0),
                    None => (tilt, -1.0),
                };
                coupling.add_displacement(condition, k, residual, matrix);
            }
        }
    }

    /// Computes the part of the gap of each contact that is due to bending of its two scales.
    pub(super) fn openings(&self, state: &SkinState) -> Vec<f64> {
        let mut openings = vec![0.0; state.mode.contacts.len()];
        let bent = self.bent_scales(state);
        self.for_openings(state, &bent, |contact, scale, load| {
            openings[contact] += scale.sums(load).displacement;
        });
        for touching in self.contacts.closed_edges(state) {
            for scale in bent.iter().filter(|bent| touching.ends.contains(&bent.scale)) {
                let load = BeamLoad::of_contact(&scale.beam, &touching, scale.scale);
                openings[touching.contact] += load.map_or(0.0, |k| scale.sums(&k).displacement);
            }
        }
        openings
    }

    /// Calls `show` for each open contact of each loaded scale.
    ///
    /// The arguments of `show` are the number of the contact, the scale, and the load that the
    /// contact would exert on this scale.
    fn for_openings(
        &self,
        state: &SkinState,
        bent: &[BentScale],
        mut show: impl FnMut(usize, &BentScale, &BeamLoad),
    ) {
        let mut is_bent = vec![false; self.layout.scales()];
        for bent in bent {
            is_bent[bent.scale] = true;
        }
        for contact in self.contacts.contacts_beside(&is_bent) {
            let Some(touching) = self.contacts.facing_edge(state, contact) else { continue };
            for scale in bent.iter().filter(|bent| touching.ends.contains(&bent.scale)) {
                if let Some(load) = BeamLoad::of_contact(&scale.beam, &touching, scale.scale) {
                    show(contact, scale, &load);
                }
            }
        }
    }

    /// Adds the bending of the scales to the gaps of open contacts.
    pub(super) fn add_openings(&self, state: &SkinState, values: &mut [f64]) {
        let bent = self.bent_scales(state);
        self.for_openings(state, &bent, |contact, scale, load| {
            values[self.contacts.own_force(contact)] += scale.sums(load).displacement;
        });
    }

    /// Adds the bending of the scales to the gaps of open contacts, and to their slopes.
    pub(super) fn add_opening_slopes(
        &self,
        state: &SkinState,
        direction: &[f64],
        [values, slopes]: [&mut [f64]; 2],
    ) {
        let bent = self.bent_scales(state);
        self.for_openings(state, &bent, |contact, scale, load| {
            let at = self.contacts.own_force(contact);
            let [value, slope] = scale.moving(load, direction);
            values[at] += value;
            slopes[at] += slope;
        });
    }

    /// Computes the part of a gap that is due to bending, or its rate along a `direction`.
    ///
    /// The `constraint` is the normal force of the contact. Returns 0 for other constraints.
    pub(super) fn opening_of(
        &self,
        state: &SkinState,
        constraint: usize,
        direction: Option<&[f64]>,
    ) -> f64 {
        let own = self.contacts.contact_of_own_force(constraint).filter(|_| self.is_elastic);
        let touching = own.and_then(|contact| self.contacts.edge_at(state, contact));
        let Some(touching) = touching else { return 0.0 };
        let openings = touching.ends.into_iter().filter_map(|scale| {
            let bent = self.bent_scale(state, scale);
            let load = BeamLoad::of_contact(&bent.beam, &touching, scale)?;
            Some(match direction {
                Some(direction) => bent.moving(&load, direction)[1],
                None => bent.sums(&load).displacement,
            })
        });
        openings.sum()
    }

    /// Computes the strain energy of all scales, in `E* t³`; 0 for rigid scales.
    pub(super) fn bending_energy(&self, state: &SkinState) -> f64 {
        if !self.is_elastic {
            return 0.0;
        }
        let bent = self.bent_scales(state);
        let energies = bent.iter().map(|scale| {
            let loads = scale.loads.iter();
            loads.map(|k| 0.5 * k.force * scale.sums(k).displacement).sum::<f64>()
        });
        energies.sum()
    }

    /// Returns the derivatives of depth and total tilt.
    ///
    /// Each entry lists unknowns (motions and contact forces) with the derivatives with respect to
    /// them, and holds the derivative with respect to the conjugate load. The conjugate load of the
    /// depth is the needle force; the conjugate load of the tilt is a moment at the tip.
    pub(super) fn bending_loads(&self, state: &SkinState) -> [(Vec<(usize, f64)>, f64); 2] {
        let Some(rows) = self.bending_unknowns() else { return Default::default() };
        let mut entries: [Vec<(usize, f64)>; 2] = Default::default();
        self.add_bending(
            state,
            &mut Residual::new(self.layout.size()),
            &mut |row: usize, column: usize, value: f64| {
                if let Some(k) = rows.iter().position(|&own| own == row)
                    && column != row
                {
                    entries[k].push((column, -value));
                }
            },
        );
        let load = self.layout.load();
        let [mut depth, mut tilt] = entries;
        let own = depth.iter().filter(|(column, _)| *column == load).map(|(_, value)| value).sum();
        let bent = &self.bent_scales(state)[0];
        let moment = BeamLoad::tip_moment(&bent.beam, bent.loads[0].at);
        let of_moment = bent.section.flexibility(&moment, &moment).value;
        for entries in [&mut depth, &mut tilt] {
            entries.retain(|(column, _)| *column != load);
        }
        [(depth, own), (tilt, of_moment)]
    }

    /// Calls `entry` with row, column and value of each term of bending in the stiffness.
    pub(super) fn for_bending_stiffness(
        &self,
        state: &SkinState,
        mut entry: impl FnMut(usize, usize, f64),
    ) {
        let Some(rows) = self.bending_unknowns() else { return };
        let load = self.layout.load();
        let forces = self.contacts.closed_edges(state);
        self.add_bending(
            state,
            &mut Residual::new(self.layout.size()),
            &mut |row: usize, column: usize, value: f64| {
                if rows.contains(&row) || rows.contains(&column) || column == load {
                    return;
                }
                // Contact equations are derivatives of `−L`, and equilibrium equations of `L`. For
                // a symmetric stiffness, change the sign of the former.
                let is_condition = forces.iter().any(|edge| edge.unknown == row);
                entry(row, column, if is_condition { -value } else { value });
            },
        );
    }
}
