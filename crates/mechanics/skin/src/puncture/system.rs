//! Equations of a row of scales on springs under a needle: a mixed complementarity system.

use std::array;

use contact::ContactLaw;
use geometry::{Corner, Vec2};
use solver::{Blocks, Change, Control, FARTHEST_LINK, Residual, System, Tangent};
use substrate::{Neighbour, RowStiffness, SubstrateLaw};

use super::needle::GuidedNeedle;
use super::parameters::{Bending, Needle, PunctureParameters, Strengths};
use super::row_exterior::RowExterior;
use super::row_layout::RowLayout;
use crate::arrangement::Arrangement;
use crate::contacts::{Contacts, NeedleMode, SkinMode, SkinState};
use crate::{Design, PathDetail};

/// Largest scale of the depth of a guided needle as the control parameter, in units of `t`.
///
/// Steps of the solver are fractions of this scale. A scale tilts by about 10° at this depth.
const DEPTH: f64 = 0.5;

/// Largest scale of the depth of a guided needle, divided by the length of the top of a scale.
///
/// A needle soon leaves a narrow top, which requires smaller steps.
const TOPS: f64 = 4.0;

/// Depth of a guided needle at which its path ends at the latest, in units of `t`.
const DEEPEST: f64 = 2.0;

/// Number of the marker that is zero at the requested depth.
pub(super) const DEPTH_MARK: usize = usize::MAX;

/// Number of the marker that is zero at the requested force.
pub(super) const FORCE_MARK: usize = usize::MAX - 1;

/// Smallest number of the markers that are zero where a failure limit is reached.
///
/// Smaller numbers are markers of gaps, numbered by the scale on their left.
pub(super) const FIRST_LIMIT_MARK: usize = usize::MAX / 2;

/// Number of the rate that is zero at an extremum of the load.
pub(super) const LOAD_RATE: usize = 0;

/// Number of the rate that is zero at an extremum of the depth.
pub(super) const DEPTH_RATE: usize = 1;

/// A row of scales on a substrate under a needle, as a [`System`] of equations.
///
/// The unknowns are the displacements and rotations of the scales, the contact forces, and the
/// load `F`. Lengths are in `t`, forces in `E* t²`.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub(crate) layout: RowLayout,
    pub(crate) contacts: Contacts,
    /// Length of a scale, `L/t`.
    pub(crate) length: f64,
    /// Width of a scale out of the plane, `b/t`.
    pub(super) width: f64,
    /// Young's modulus of the scales in bending, `E_c/E_s`.
    pub(super) scale_modulus: f64,
    /// True if the scales bend under the forces on them.
    pub(super) is_elastic: bool,
    pub(super) strengths: Strengths,
    /// Tip radius of a guided needle, in units of `t`; `None` for a sharp one.
    pub(super) needle_radius: Option<f64>,
    /// `E*/E_s`, to convert a stiffness in units of `E*` to units of `E_s`.
    pub(crate) plane_modulus: f64,
    /// Half-width of a base, `a/t`.
    pub(super) half_base: f64,
    /// Springs of a scale in `x`, `y` and `φ`: `a α_x, a α_y, a³ α_φ`.
    pub(super) direct: [f64; 3],
    /// Coupling of `x` and `φ` of the same scale, `a² r_0` of (S21); 0 on a half-space.
    pub(super) roll: f64,
    /// Coupling with the neighbours on one side, the nearest first.
    ///
    /// With nearest coupling the entries are `−a β_x, −a β_y, −a³ β_φ`, with full coupling
    /// `a K_x, a K_y, a³ K_φ, a² c` of (S9). A layer adds `a l` and `a² r` of (S21).
    pub(super) neighbours: Vec<Neighbour>,
    /// Stiffness `a β_x` of the neo-Hookean bars that replace the springs along the row.
    ///
    /// `None` for a linear substrate.
    pub(super) bars: Option<f64>,
    /// The scales beyond the solved part of a longer row.
    pub(super) exterior: RowExterior,
    /// Vector from the node of the punctured scale to the loaded point.
    pub(super) load_arm: Vec2,
    /// Depth, in units of `t`, at which the force is to be reported.
    marked_depth: Option<f64>,
    /// Force `F*` at which the pressure on the tissue is to be reported.
    marked_force: Option<f64>,
    /// Guided needle; `None` for a free needle, which only adds the load to the equations.
    pub(super) needle: Option<GuidedNeedle>,
    /// Unknowns that are constraints: contact forces, then unknowns of a guided needle.
    constraints: Vec<usize>,
    /// Numbers of the constraints with unknowns that cannot decrease: the slip distances.
    monotone: Vec<usize>,
    pub(super) controls: Vec<Control>,
    /// Computed measures and point data, as in [`Common::detail`](crate::Common::detail).
    pub(super) detail: PathDetail,
    /// Block structure of the tangent; `None` if it has entries outside such blocks.
    blocks: Option<Blocks>,
    /// Unit of each equation, for the convergence criterion (N2).
    units: Vec<f64>,
}

/// Part of the substrate stiffness matrix.
///
/// A part holds consecutive entries along a diagonal, or a full block that couples two scales.
#[derive(Clone, Copy)]
enum Part<'a> {
    Diagonal(&'a [f64]),
    Block(&'a [[f64; 3]; 3]),
}

/// Returns the control parameters of a path: the tilt and the displacements of the punctured scale.
///
/// For a guided needle the first control parameter is its depth. `top` is the length of the top of
/// the scale, in units of `t`.
fn controls(
    parameters: &PunctureParameters,
    layout: RowLayout,
    is_guided: bool,
    top: f64,
) -> Vec<Control> {
    let punctured = layout.scale(layout.left);
    // The tilt is clockwise and so decreases the rotation.
    let critical_tilt = parameters.critical_tilt_deg.to_radians();
    let mut controls = [(2, -critical_tilt), (0, 1.0), (1, 1.0)]
        .map(|(k, scale)| Control { index: punctured + k, scale })
        .to_vec();
    if parameters.bending == Bending::Elastic {
        // The tilt is the rotation of the bent tip under the load, the second unknown after the
        // load, and not the rotation of the base.
        controls[0].index = layout.load() + 2;
    }
    if is_guided {
        // Scales under a guided needle may tilt in either direction, or not at all.
        controls.insert(0, Control { index: layout.load() + 1, scale: DEPTH.min(TOPS * top) });
    }
    controls
}

/// Creates the guided needle of a row; `None` for a free needle.
///
/// `contacts` is the number of contact constraints. The constraints of the needle follow them.
fn guided_needle(
    parameters: &PunctureParameters,
    load_arm: Vec2,
    layout: RowLayout,
    contacts: usize,
) -> Option<GuidedNeedle> {
    match parameters.needle {
        Needle::Free => None,
        Needle::Guided { friction } => {
            Some(GuidedNeedle::new(friction, parameters, load_arm, layout, contacts))
        }
    }
}

/// Returns the stiffness of the bars along the row; `None` for a linear substrate.
fn bar_stiffness(law: SubstrateLaw, neighbours: &[Neighbour]) -> Option<f64> {
    match law {
        SubstrateLaw::Linear => None,
        // Couplings are stored as `−β`, but the stiffness of a bar is positive.
        SubstrateLaw::NeoHookean => neighbours.first().map(|nearest| -nearest.direct[0]),
    }
}

/// Returns the block structure of the tangent; `None` if it has entries outside such blocks.
///
/// The substrate couples a scale with the nearest `neighbours` scales on each side. A round tip
/// couples more scales, and so do contacts between distant scales. The solver then eliminates the
/// tangent as a band matrix.
fn tangent_blocks(
    parameters: &PunctureParameters,
    layout: RowLayout,
    contact_reach: usize,
    neighbours: usize,
) -> Option<Blocks> {
    let reach = neighbours.max(1);
    let has_blocks = contact_reach <= reach && reach <= FARTHEST_LINK;
    (has_blocks && parameters.needle_radius.is_none()).then(|| layout.blocks(reach))
}

impl Chain {
    /// Sets up the equations of the solved part of a row of this `design`.
    pub(crate) fn new(
        arrangement: Arrangement,
        stiffness: &RowStiffness,
        law: ContactLaw,
        layout: RowLayout,
        exterior: RowExterior,
        parameters: &PunctureParameters,
        design: &Design,
    ) -> Self {
        let scale = arrangement.scale(layout.left);
        let a = scale.half_base();
        let RowStiffness { direct, roll, neighbours, .. } = stiffness.with_lengths_over(a);
        let scales = (0..layout.scales()).map(|i| Some(layout.scale(i))).collect();
        let forces: Vec<usize> =
            (0..layout.contacts * (layout.scales() - 1)).map(|i| layout.force(i)).collect();
        let (left, right) = (scale.corner(Corner::TopLeft), scale.corner(Corner::TopRight));
        let load_arm = left + parameters.load_position * (right - left);
        let constraints = forces.len();
        let needle = guided_needle(parameters, load_arm, layout, constraints);
        let of_needle = needle.iter().flat_map(GuidedNeedle::constraints);
        let constraints = forces.iter().copied().chain(of_needle).collect();
        let bars = bar_stiffness(parameters.substrate_law, &neighbours);
        let body = parameters.body();
        let contacts = Contacts::new(arrangement, body, law, scales, forces, false);
        let of_needle = needle.iter().flat_map(|needle| needle.slip_distances.iter().copied());
        let monotone = contacts.slip_distances.iter().copied().chain(of_needle).collect();
        let mut chain = Self {
            layout,
            blocks: tangent_blocks(parameters, layout, contacts.reach, neighbours.len()),
            contacts,
            monotone,
            length: design.length,
            width: design.width,
            scale_modulus: parameters.contact_modulus_over_substrate,
            is_elastic: parameters.bending == Bending::Elastic,
            strengths: parameters.failure.unwrap_or_default(),
            needle_radius: parameters.needle_radius,
            plane_modulus: 1.0 / (1.0 - parameters.poisson_ratio.powi(2)),
            half_base: a,
            direct,
            roll,
            neighbours,
            bars,
            exterior,
            load_arm,
            marked_depth: parameters.depth,
            marked_force: parameters.force,
            controls: controls(parameters, layout, needle.is_some(), (right - left).norm()),
            needle,
            constraints,
            detail: PathDetail::Whole,
            units: layout.units(direct),
        };
        chain.set_down_round_tip();
        chain
    }

    /// Moves a round tip to its rest position, which depends on the scales of the row.
    fn set_down_round_tip(&mut self) {
        let round = self.needle.as_ref().filter(|needle| needle.is_round());
        let centre = round.map(|needle| self.centre_at_rest(needle, self.load_arm.x));
        if let (Some(needle), Some(centre)) = (&mut self.needle, centre) {
            needle.tip = centre;
        }
    }

    /// Returns true if at most the measures of [`PathDetail::Critical`] are computed.
    pub(super) fn is_critical_only(&self) -> bool {
        self.detail <= PathDetail::Critical
    }

    /// Returns true if folds of the surface are measured.
    pub(super) fn measures_folds(&self) -> bool {
        self.detail >= PathDetail::Critical
    }

    /// Returns true if all data of path tables and drawings are recorded.
    pub(super) fn is_recorded_whole(&self) -> bool {
        self.detail == PathDetail::Whole
    }

    /// Returns the displacements `x` and `y` and the rotation `φ` of a scale.
    pub(crate) fn displacement(&self, z: &[f64], scale: usize) -> [f64; 3] {
        let at = self.layout.scale(scale);
        [z[at], z[at + 1], z[at + 2]]
    }

    /// Computes the depth of the loaded point below its position at rest.
    pub(crate) fn depth(&self, z: &[f64]) -> f64 {
        if let Some(needle) = &self.needle {
            return z[needle.depth];
        }
        self.bending_unknowns().map_or_else(|| self.rigid_depth(z), |[depth, _]| z[depth])
    }

    /// Computes the depth of the loaded point without the bending of its scale.
    pub(super) fn rigid_depth(&self, z: &[f64]) -> f64 {
        // Depth is positive downward, `y` upward.
        let pose = self.contacts.pose(z, self.layout.left);
        -(pose.displacement.y + pose.turn(self.load_arm).y - self.load_arm.y)
    }

    /// Computes the vector from the node of the rotated punctured scale to its loaded point.
    pub(crate) fn loaded_arm(&self, z: &[f64]) -> Vec2 {
        self.contacts.pose(z, self.layout.left).turn(self.load_arm)
    }

    /// Computes the derivative of [`Chain::depth`] along a `direction` of the unknowns.
    pub(crate) fn depth_slope(&self, z: &[f64], direction: &[f64]) -> f64 {
        if let Some(needle) = &self.needle {
            return direction[needle.depth];
        }
        if let Some([depth, _]) = self.bending_unknowns() {
            return direction[depth];
        }
        let at = self.layout.scale(self.layout.left);
        let arm = self.loaded_arm(z);
        -(direction[at + 1] + arm.x * direction[at + 2])
    }

    /// Computes the depth of the deeper base corner of a scale below its rest position.
    pub(crate) fn base_depth(&self, z: &[f64], scale: usize) -> f64 {
        let [_, y, rotation] = self.displacement(z, scale);
        self.half_base * rotation.sin().abs() - y
    }

    /// Computes the depth of the deepest base corner of any scale.
    pub(crate) fn penetration(&self, z: &[f64]) -> f64 {
        let depths = (0..self.layout.scales()).map(|scale| self.base_depth(z, scale));
        depths.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Calls `part` for each part of the substrate stiffness.
    ///
    /// The arguments of `part` are row and column of the first entry, and the entries.
    fn for_spring_parts(&self, mut part: impl FnMut(usize, usize, Part)) {
        for i in 0..self.layout.scales() {
            let at = self.layout.scale(i);
            part(at, at, Part::Diagonal(&self.direct));
            // This coupling is zero on a half-space.
            if self.roll != 0.0 {
                part(at, at + 2, Part::Diagonal(&[self.roll]));
                part(at + 2, at, Part::Diagonal(&[self.roll]));
            }
        }
        for (before, neighbour) in self.neighbours.iter().enumerate() {
            let (on_left, is_diagonal) = (neighbour.on_left(), neighbour.is_diagonal());
            let on_right = array::from_fn(|k| on_left.map(|row| row[k]));
            // Each pair is visited once and writes both triangles.
            for i in before + 1..self.layout.scales() {
                let (left, right) = (self.layout.scale(i - 1 - before), self.layout.scale(i));
                let parts = if is_diagonal {
                    [Part::Diagonal(&neighbour.direct); 2]
                } else {
                    [Part::Block(&on_right), Part::Block(&on_left)]
                };
                part(right, left, parts[0]);
                part(left, right, parts[1]);
            }
        }
        // The direct springs are valid for fixed neighbours. Scales beyond an end move, which
        // reduces the stiffness at this end.
        for (row, column, values) in &self.exterior.relief {
            part(*row, *column, Part::Block(values));
        }
    }

    /// Returns the guided needle and the number of `constraint` among its own constraints.
    ///
    /// `None` for a contact constraint.
    fn of_needle(&self, constraint: usize) -> Option<(&GuidedNeedle, usize)> {
        self.needle.as_ref().zip(constraint.checked_sub(self.contacts.forces.len()))
    }

    /// Returns the dimensionless load `F* = F/(E* L t)`.
    pub(crate) fn force(&self, state: &SkinState) -> f64 {
        state.z[self.layout.load()] / self.length
    }

    /// Computes the elastic energy of springs and bars, in `E* t³`.
    ///
    /// The energy of the scales beyond the solved part is included.
    pub(crate) fn substrate_energy(&self, state: &SkinState) -> f64 {
        let mut twice = 0.0;
        self.constant_tangent(&mut |row: usize, column: usize, value: f64| {
            twice += value * state.z[row] * state.z[column];
        });
        0.5 * twice + self.bar_energy(&state.z)
    }
}

impl System for Chain {
    type Mode = SkinMode;

    fn size(&self) -> usize {
        self.layout.size()
    }

    fn half_bandwidth(&self) -> usize {
        // The band reaches from x of a scale to φ of the farthest scale coupled with it, with the
        // unknowns of load and needle in between. A guided needle couples all scales in its reach.
        let coupled = self.needle.as_ref().map_or(0, GuidedNeedle::farthest);
        let touched = if self.is_elastic { 2 } else { 1 } * self.contacts.reach;
        let coupled = self.neighbours.len().max(touched).max(coupled);
        self.layout.block() * coupled + 3 + self.layout.needle
    }

    fn blocks(&self) -> Option<&Blocks> {
        self.blocks.as_ref()
    }

    /// Returns true if the tangent has no entries outside its blocks.
    ///
    /// A guided needle adds such entries if it touches scales other than the punctured one. An
    /// elastic scale adds such entries if it has closed contacts, because the forces of its two
    /// neighbours then act on the same bent scale.
    fn is_in_blocks(&self, state: &SkinState) -> bool {
        if self.is_elastic && Contacts::closed(state) > 0 {
            return false;
        }
        state.mode.needle.tip_contacts.iter().flatten().all(|touch| touch.scale == 0)
    }

    fn load(&self) -> usize {
        self.layout.load()
    }

    /// Returns the value of the control parameter at which the path ends.
    ///
    /// A guided needle stops at the depth [`DEEPEST`] if no constraint has ended its path before.
    fn target(&self) -> f64 {
        if self.needle.is_some() { DEEPEST / self.controls[0].scale } else { 1.0 }
    }

    fn ends(&self, state: &SkinState, constraint: usize) -> bool {
        // At the end of an edge two corners share the force. The beam model gives them different
        // positions, so an elastic scale would jump at this point.
        if self.is_elastic && self.contacts.contact_of_own_force(constraint).is_none() {
            return true;
        }
        self.needle.as_ref().is_some_and(|needle| needle.ends(self, state, constraint))
    }

    fn monotone(&self) -> &[usize] {
        &self.monotone
    }

    fn stop_sliding(&self, state: &mut SkinState) {
        self.contacts.stop_sliding(state);
        if let Some(needle) = &self.needle {
            self.stop_tip(needle, state);
        }
    }

    fn coupled(&self, constraint: usize) -> std::ops::Range<usize> {
        match self.of_needle(constraint) {
            Some((needle, _)) => needle.coupled(constraint),
            None => self.contacts.coupled(constraint),
        }
    }

    fn load_only_pushes(&self) -> bool {
        true
    }

    fn controls(&self) -> &[Control] {
        &self.controls
    }

    fn coordinates(&self) -> Vec<usize> {
        let scales = (0..self.layout.scales()).map(|scale| self.layout.scale(scale));
        // Displacements in units of `t` and rotations in radians have comparable magnitudes. Forces
        // have other magnitudes, so leave them out.
        scales.flat_map(|at| at..at + 3).collect()
    }

    fn constraints(&self) -> &[usize] {
        &self.constraints
    }

    fn is_neutral(&self, state: &SkinState, constraint: usize) -> bool {
        let mut needle = self.needle.iter();
        needle.any(|needle| self.sticks_beside_face(needle, state, constraint))
    }

    fn is_same_form(&self, one: &SkinMode, other: &SkinMode) -> bool {
        one.is_same_form(other)
    }

    fn mode_at_rest(&self) -> SkinMode {
        let slots = self.needle.as_ref().map_or(0, |needle| needle.slots);
        SkinMode { needle: NeedleMode { tip_contacts: vec![None; slots] }, ..self.contacts.open() }
    }

    fn constant_tangent(&self, matrix: &mut impl Tangent) {
        self.for_spring_parts(|row, column, part| match part {
            Part::Diagonal(values) => matrix.add_diagonal(row, column, values),
            Part::Block(values) => matrix.add_block(row, column, values),
        });
    }

    fn linearise(&self, state: &SkinState, residual: &mut Residual, matrix: &mut impl Tangent) {
        let (z, load) = (&state.z, self.layout.load());
        residual.clear(&self.units);
        // The spring tangent is the constant part, which the matrix already holds.
        self.for_spring_parts(|row, column, part| match part {
            Part::Diagonal(values) => residual.add_products(row, values, &z[column..]),
            Part::Block(values) => residual.add_block_products(row, values, &z[column..]),
        });
        self.for_bars(z, |nodes, bar| bar.linearise(nodes, residual, matrix));
        if let Some(needle) = &self.needle {
            self.add_needle(needle, state, residual, matrix);
        } else {
            let at = self.layout.scale(self.layout.left);
            let arm = self.loaded_arm(z);
            // The residual is spring forces minus applied forces, so a downward load is positive.
            residual.add(at + 1, z[load]);
            residual.add(at + 2, z[load] * arm.x);
            matrix.add_block(at + 1, load, &[[1.0], [arm.x]]);
            // The arm turns with the scale, `∂(F ρ_x)/∂φ = −F ρ_y`.
            matrix.add(at + 2, at + 2, -z[load] * arm.y);
        }
        self.contacts.linearise(state, residual, matrix);
        if self.is_elastic {
            self.add_bending(state, residual, matrix);
        }
    }

    fn conditions(&self, state: &SkinState, values: &mut Vec<f64>) {
        self.contacts.conditions(state, values);
        if self.is_elastic {
            self.add_openings(state, values);
        }
        // Needle constraints follow contact constraints, so append their values.
        if let Some(needle) = &self.needle {
            self.needle_conditions(needle, state, values);
        }
    }

    fn condition_slopes(
        &self,
        state: &SkinState,
        direction: &[f64],
        values: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
    ) {
        self.contacts.condition_slopes(state, direction, values, slopes);
        if self.is_elastic {
            self.add_opening_slopes(state, direction, [values, slopes]);
        }
        if let Some(needle) = &self.needle {
            self.needle_conditions(needle, state, values);
            self.needle_slopes(needle, state, direction, slopes);
        }
    }

    fn condition(&self, state: &SkinState, constraint: usize) -> f64 {
        let Some((needle, number)) = self.of_needle(constraint) else {
            let value = self.contacts.condition(state, constraint);
            return value + self.opening_of(state, constraint, None);
        };
        let mut values = Vec::new();
        self.needle_conditions(needle, state, &mut values);
        values[number]
    }

    fn slope(&self, state: &SkinState, constraint: usize, direction: &[f64]) -> f64 {
        let Some((needle, number)) = self.of_needle(constraint) else {
            let slope = self.contacts.slope(state, constraint, direction);
            return slope + self.opening_of(state, constraint, Some(direction));
        };
        let mut slopes = Vec::new();
        self.needle_slopes(needle, state, direction, &mut slopes);
        slopes[number]
    }

    /// Evaluates a marker: the stretch of a gap, or the excess over a requested value or a limit.
    ///
    /// Requested values are a depth and a force; limits belong to failure modes. A gap has the
    /// number of the scale on its left. Where its stretch is zero, the surface begins to fold.
    fn marker(&self, state: &SkinState, number: usize) -> f64 {
        match number {
            DEPTH_MARK => self.marked_depth.map_or(f64::NAN, |depth| self.depth(&state.z) - depth),
            FORCE_MARK => self.marked_force.map_or(f64::NAN, |force| self.force(state) - force),
            pair if pair < FIRST_LIMIT_MARK => self.gap_stretch(state, pair),
            limit => self.limit_marker(state, limit - FIRST_LIMIT_MARK),
        }
    }

    /// Evaluates the rate of the load or of the depth.
    fn rate(&self, state: &SkinState, direction: &[f64], number: usize) -> f64 {
        match number {
            LOAD_RATE => direction[self.layout.load()],
            _ => self.depth_slope(&state.z, direction),
        }
    }

    fn transition(&self, state: &mut SkinState, change: Change) -> Option<usize> {
        let Some(needle) = &self.needle else { return self.contacts.transition(state, change) };
        if change.constraint >= self.contacts.forces.len() {
            return self.needle_transition(needle, state, change);
        }
        let valid = self.contacts.transition(state, change);
        // The change may have opened the contact that holds the tip in a notch.
        self.release_notch(needle, state);
        valid
    }
}
