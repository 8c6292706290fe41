//! Unit tests of the puncture model: tangent, energy, growth of rows, stability.

mod bending;
mod failure;
mod friction;
mod layers;
mod needle;
mod neo_hookean;
mod reach;

use std::collections::HashSet;

use approx::assert_relative_eq;
use contact::{ContactLaw, CornerContact, FORCES, Law};
use geometry::Body;
use nalgebra::{DMatrix, DVector};
use solver::{BandMatrix, Continuation, Settings, System, check_tangent};
use substrate::{Coupling, RowStiffness, calibrate};

use self::needle::integral;
use super::exterior_motion::Reach;
use super::row_exterior::{Beyond, RowExterior};
use super::row_layout::RowLayout;
use super::rows::Rows;
use super::stability::Instability;
use super::system::Chain;
use super::{Problem, PunctureParameters};
use crate::arrangement::Arrangement;
use crate::contacts::{SkinPoint, SkinState, pair_constraints};
use crate::record::Skin;
use crate::{Base, Common, Design, Status};

/// Steep row in which contacts open, close, and slide past corners to other edges.
const LIVELY: Design =
    Design { gap: 0.1, length: 1.0, slant_deg: 75.0, base: Base::TwoL, width: 1.0 };

/// Row of scales so steep and long that sides become flush with bases, and tips touch bases.
const FOLDING: Design =
    Design { gap: 0.2, length: 2.8, slant_deg: 79.5, base: Base::TwoL, width: 1.0 };

/// Steep row of short scales in which a tip slides along a base to its end and past its corner.
const SLIDING: Design =
    Design { gap: 0.05, length: 0.2, slant_deg: 82.0, base: Base::TwoL, width: 1.0 };

/// Steep row that snaps, and returns to zero load before the tilt reaches 40°.
const STEEP: Design = Design { gap: 0.6, length: 1.0, slant_deg: 60.0, base: Base::L, width: 1.0 };

/// Row of upright cubes.
const BLOCKS: Design = Design { gap: 0.1, length: 1.0, slant_deg: 0.0, base: Base::L, width: 1.0 };

/// Row of thin steep scales, in which contact spreads over many scales.
const DOMINO: Design = Design { gap: 0.1, length: 0.1, slant_deg: 75.0, base: Base::L, width: 1.0 };

/// Contact modulus `E_ct/E*` of Shafiei et al. (2021).
const HARD: f64 = 9677.0 * 0.75;

fn law(design: &Design, law: Law, modulus: f64) -> ContactLaw {
    ContactLaw::new(law, design.length, design.width, modulus).unwrap()
}

/// Starts the path of a row of 21 scales to a tilt of 10°, with nearest coupling.
fn path(design: &Design, law: ContactLaw, load_position: f64) -> Continuation<Chain> {
    path_on(
        &(&calibrate(&design.footprint(0.5).unwrap()).unwrap()).into(),
        design,
        law,
        load_position,
    )
}

/// Starts the path of a row of 21 scales with full coupling.
fn coupled_path(design: &Design, law: ContactLaw, load_position: f64) -> Continuation<Chain> {
    let stiffness = RowStiffness::compute(&design.footprint(0.5).unwrap(), Coupling::Full).unwrap();
    path_on(&stiffness, design, law, load_position)
}

/// Starts the path of a row of 21 scales on a substrate with this stiffness.
fn path_on(
    stiffness: &RowStiffness,
    design: &Design,
    law: ContactLaw,
    load_position: f64,
) -> Continuation<Chain> {
    let layout = RowLayout { left: 10, right: 10, needle: 0, contacts: pair_constraints(&law) };
    let parameters = PunctureParameters { load_position, ..PunctureParameters::default() };
    let chain = whole(stiffness, design, law, layout, &parameters);
    let rest = SkinState::at_rest(&chain);
    Continuation::new(chain, rest, Settings::default())
}

/// Builds a row that is solved as a whole.
fn whole(
    stiffness: &RowStiffness,
    design: &Design,
    law: ContactLaw,
    layout: RowLayout,
    parameters: &PunctureParameters,
) -> Chain {
    let row = Arrangement::Even(design.row().unwrap());
    Chain::new(row, stiffness, law, layout, RowExterior::default(), parameters, design)
}

/// Calls `show` for each segment of a path.
fn for_segments(
    mut path: Continuation<Chain>,
    mut show: impl FnMut(&mut Continuation<Chain>, &SkinPoint, &SkinPoint),
) {
    loop {
        let from = path.point().clone();
        let Some(to) = path.next() else { return };
        show(&mut path, &from, &to);
    }
}

/// Returns the name of the state of a contact.
fn name(contact: CornerContact) -> &'static str {
    match contact {
        CornerContact::Open => "open",
        CornerContact::Edge(_) => "edge",
        CornerContact::Corner(_) => "corner",
        CornerContact::Flush(_) => "flush",
    }
}

#[test]
fn tangent_matches_finite_differences_in_every_contact_state() {
    let mut seen = HashSet::new();
    for constants in [Law::PRINTED, Law::EXCHANGED] {
        for design in [LIVELY, FOLDING, SLIDING] {
            // Compare half-way between points. At events some contact forces are zero, and the
            // contact law has a kink at zero force.
            for_segments(path(&design, law(&design, constants, HARD), 1.0), |path, from, to| {
                let state = path.between(from, to, 0.5).unwrap().state;
                seen.extend(state.mode.contacts.iter().copied().map(name));
                check_tangent(path.system(), &state, 1e-6).unwrap();
            });
        }
    }
    assert_eq!(seen, ["open", "edge", "corner", "flush"].into());
}

/// The active flags of a state must mark the contact forces that act in its mode.
#[test]
fn active_flags_match_contact_modes() {
    for design in [LIVELY, FOLDING, SLIDING] {
        for point in path(&design, law(&design, Law::EXCHANGED, HARD), 1.0) {
            for (contact, acting) in
                point.state.mode.contacts.iter().zip(point.state.active.chunks(FORCES))
            {
                assert_eq!(contact.acting(), acting);
            }
        }
    }
}

#[test]
fn slopes_of_inactive_conditions_match_finite_differences() {
    let mut compared = [0; FORCES];
    for_segments(path(&FOLDING, law(&FOLDING, Law::EXCHANGED, HARD), 1.0), |path, from, to| {
        let state = path.between(from, to, 0.5).unwrap().state;
        let chain = path.system();
        let [low, high] = [-1e-7, 1e-7].map(|shift| {
            let mut conditions = Vec::new();
            chain.conditions(&state.moved(shift, &from.leaving), &mut conditions);
            conditions
        });
        for constraint in 0..chain.constraints().len() {
            let difference = (high[constraint] - low[constraint]) / 2e-7;
            // Conditions of forces that cannot become active next are constant; leave them out.
            if !state.active[constraint] && difference != 0.0 {
                let slope = chain.slope(&state, constraint, &from.leaving);
                assert_relative_eq!(slope, difference, epsilon = 1e-6, max_relative = 1e-6);
                compared[constraint % FORCES] += 1;
            }
        }
    });
    assert!(compared.iter().all(|&count| count > 10), "{compared:?}");
}

/// Integrates `F du` between two points by Boole's rule on five equilibria.
fn work(path: &mut Continuation<Chain>, from: &SkinPoint, to: &SkinPoint) -> f64 {
    let inner = [0.25, 0.5, 0.75].map(|x| path.between(from, to, x).unwrap().state);
    let states = [&from.state, &inner[0], &inner[1], &inner[2], &to.state];
    let chain = path.system();
    integral(states.map(|state| [state.z[chain.load()], chain.depth(&state.z)]))
}

/// Work and energies at the end of a path.
#[derive(Default)]
struct Balance {
    /// Work of the load.
    work: f64,
    /// Energy of the substrate.
    springs: f64,
    /// Energy of the contacts.
    contacts: f64,
    /// Largest difference between work and energy at any point of the path.
    off: f64,
}

/// Follows a path to its end, and compares the work of the load with the stored energy.
fn balance(path: Continuation<Chain>) -> Balance {
    let mut balance = Balance::default();
    for_segments(path, |path, from, to| {
        balance.work += work(path, from, to);
        let chain = path.system();
        balance.springs = chain.substrate_energy(&to.state);
        balance.contacts = chain.contacts.energy(&to.state);
        let off = (balance.work - balance.springs - balance.contacts).abs();
        balance.off = balance.off.max(off);
    });
    balance
}

#[test]
fn work_of_the_load_equals_stored_energy() {
    for design in [LIVELY, FOLDING, SLIDING, BLOCKS, DOMINO] {
        for constants in [Law::PRINTED, Law::EXCHANGED] {
            for load_position in [1.0, 0.9] {
                let law = law(&design, constants, HARD);
                let Balance { work, off, .. } = balance(path(&design, law, load_position));
                assert!(off < 1e-6 * work, "{:e} {design:?} {constants:?}", off / work);
            }
        }
    }
}

#[test]
fn tangent_of_a_coupled_row_matches_differences_and_is_symmetric_at_rest() {
    let mut points = 0;
    for_segments(coupled_path(&LIVELY, law(&LIVELY, Law::PRINTED, HARD), 1.0), |path, from, to| {
        let state = path.between(from, to, 0.5).unwrap().state;
        check_tangent(path.system(), &state, 1e-6).unwrap();
        points += 1;
    });
    assert!(points > 10);
    // At rest the tangent contains only the substrate.
    let path = coupled_path(&BLOCKS, law(&BLOCKS, Law::PRINTED, HARD), 1.0);
    let (chain, state) = (path.system(), &path.point().state);
    let mut tangent = BandMatrix::new(chain.size(), chain.half_bandwidth());
    chain.tangent(state, &mut tangent);
    let mut coupled = 0;
    for row in (0..chain.size()).filter(|&row| row != chain.load()) {
        for column in tangent.columns(row).filter(|&column| column != chain.load()) {
            let value = tangent.get(row, column);
            assert_eq!(value, tangent.get(column, row));
            coupled += usize::from(value != 0.0);
        }
    }
    // 21 scales with 3 direct terms each, and pairs of scales up to 8 apart. Each pair has 3 direct
    // and 2 cross terms in both triangles.
    let pairs: usize = (1..=8).map(|k| 21 - k).sum();
    assert_eq!(coupled, 3 * 21 + 2 * pairs * 5);
}

#[test]
fn work_equals_stored_energy_in_a_coupled_row() {
    for design in [LIVELY, BLOCKS, DOMINO] {
        let law = law(&design, Law::PRINTED, HARD);
        let Balance { work, off, .. } = balance(coupled_path(&design, law, 1.0));
        assert!(off < 1e-6 * work, "{:e} {design:?}", off / work);
    }
}

#[test]
fn coupling_with_one_neighbour_and_no_cross_terms_matches_nearest_coupling() {
    for design in [LIVELY, BLOCKS] {
        let footprint = design.footprint(0.5).unwrap();
        let mut one = RowStiffness::solve(&footprint, 1).unwrap();
        one.neighbours[0].cross = 0.0;
        let springs = calibrate(&footprint).unwrap();
        let parameters = PunctureParameters {
            scales: super::RowLength::Scales(21),
            ..PunctureParameters::default()
        };
        let full = RowStiffness::compute(&footprint, Coupling::Full).unwrap();
        let [ours, paper, full] = [one, (&springs).into(), full].map(|stiffness| {
            let solved = super::solve(&design, stiffness, &Common::default(), &parameters);
            solved.unwrap().measures.critical_force.unwrap()
        });
        // The stiffness for `ours` has the error of the default mesh, up to 2e-4. The stiffness for
        // `paper` is taken from the table.
        assert_relative_eq!(ours, paper, max_relative = 2e-4);
        assert_ne!(full, paper);
    }
}

/// Compares eight with sixteen coupled neighbours on each side, the truncation (S11).
#[test]
fn doubling_the_coupled_neighbours_changes_results_by_less_than_half_a_percent() {
    // The slant does not change the footprint, so one stiffness serves all slants.
    let rows = [substrate::NEIGHBOURS, 2 * substrate::NEIGHBOURS].map(|neighbours| {
        RowStiffness::solve(&BLOCKS.footprint(0.5).unwrap(), neighbours).unwrap()
    });
    for slant_deg in [0.0, 45.0, 75.0] {
        let design = Design { slant_deg, ..BLOCKS };
        let [ours, more] = rows.each_ref().map(|row| {
            super::solve(&design, row, &Common::default(), &PunctureParameters::default())
                .unwrap()
                .measures
        });
        for (ours, more) in
            [(ours.critical_force, more.critical_force), (ours.penetration, more.penetration)]
        {
            assert_relative_eq!(ours.unwrap(), more.unwrap(), max_relative = 0.005);
        }
    }
}

/// Contacts with a small modulus must store more than 2 % of the work.
#[test]
fn soft_contacts_store_part_of_the_work() {
    for (design, constants, modulus) in [
        (LIVELY, Law::PRINTED, 3.0),
        (LIVELY, Law::EXCHANGED, 30.0),
        (FOLDING, Law::EXCHANGED, 300.0),
    ] {
        let law = law(&design, constants, modulus);
        let Balance { work, contacts, off, .. } = balance(path(&design, law, 1.0));
        assert!(contacts > 0.02 * work, "{:e}", contacts / work);
        assert!(off < 1e-6 * work, "{:e} {constants:?}", off / work);
    }
}

#[test]
fn rows_grow_within_their_limit() {
    use Reach::{Beyond, Near, Short};
    let layout = RowLayout { left: 14, right: 17, needle: 0, contacts: 6 };
    for (reach, longest, expected) in [
        ([Near, Short], 100, [22, 17]),
        ([Short, Beyond], 100, [14, 25]),
        ([Beyond, Near], 100, [22, 25]),
        ([Near, Near], 42, [16, 25]),
        ([Near, Near], 37, [14, 22]),
        ([Near, Near], 32, [14, 17]),
    ] {
        let RowLayout { left, right, .. } = layout.grown(reach, longest);
        assert_eq!([left, right], expected);
    }
}

#[test]
fn a_row_that_reaches_its_length_limit_has_no_final_measures() {
    let springs = calibrate(&DOMINO.footprint(0.5).unwrap()).unwrap();
    let parameters = &PunctureParameters::default();
    let row = Rows::Even(DOMINO.row().unwrap());
    let problem =
        Problem::new(row, &DOMINO, (&springs).into(), &Common::default(), parameters).unwrap();
    let [cut, whole] = [60, 4001].map(|longest| {
        let start = problem.start(1).unwrap().0;
        problem.follow_row(start, longest, &[], &[]).unwrap().puncture(false)
    });
    assert_eq!(cut.status, Status::RowLimit);
    assert_eq!(cut.measures.scales, 60);
    assert!(cut.measures.first_contact_displacement.is_some());
    assert!(cut.measures.initial_stiffness.is_some());
    assert_eq!(cut.measures.critical_force, None);
    assert_eq!(cut.measures.peak_force, cut.path.last().map(|end| end.force));
    assert!(cut.path.last().unwrap().tilt_deg < 10.0);
    assert_eq!(whole.status, Status::Complete);
    assert!(whole.measures.scales > 60);
}

#[test]
fn parameters_out_of_range_are_rejected() {
    let springs = calibrate(&BLOCKS.footprint(0.5).unwrap()).unwrap();
    let cases: [(fn(&mut PunctureParameters), _); 6] = [
        (|p| p.critical_tilt_deg = 0.0, "critical tilt is 0, expected an angle between 0° and 90°"),
        (
            |p| p.critical_tilt_deg = f64::NAN,
            "critical tilt is NaN, expected an angle between 0° and 90°",
        ),
        (|p| p.scales = super::RowLength::Scales(0), "number of scales is 0, expected at least 1"),
        (|p| p.poisson_ratio = 0.6, "poisson's ratio is 0.6, expected a ratio from 0 to 0.5"),
        (|p| p.load_position = f64::INFINITY, "load position is inf, expected a finite number"),
        (
            |p| p.contact_modulus_over_substrate = -1.0,
            "modulus of the contact law is -0.75, expected a positive number",
        ),
    ];
    for (change, message) in cases {
        let mut parameters = PunctureParameters::default();
        change(&mut parameters);
        let error = super::solve(&BLOCKS, &springs, &Common::default(), &parameters).unwrap_err();
        assert_eq!(error.to_string(), message);
    }
}

/// Magnitude above which an eigenvalue of the dense stiffness belongs to a rigid contact.
const RIGID: f64 = 1e6;

/// Computes the dense stiffness with respect to the displacements of scales and needle.
///
/// Contact forces are eliminated from the tangent. For this, rigid contacts get a compliance of
/// 1e-8.
fn dense_stiffness(chain: &Chain, state: &SkinState) -> DMatrix<f64> {
    let mut tangent = BandMatrix::new(chain.size(), chain.half_bandwidth());
    chain.tangent(state, &mut tangent);
    let mut dense = DMatrix::from_fn(chain.size(), chain.size(), |row, column| {
        if tangent.columns(row).contains(&column) { tangent.get(row, column) } else { 0.0 }
    });
    let scales = (0..chain.layout.scales()).map(|scale| chain.layout.scale(scale));
    let mut coordinates: Vec<usize> = scales.flat_map(|at| at..at + 3).collect();
    let constraints = chain.constraints().iter().zip(&state.active);
    let mut forces: Vec<usize> =
        constraints.filter(|(_, active)| **active).map(|(&f, _)| f).collect();
    // For a guided needle, add the depth, and the tangential force of a tip that does not slide.
    let depth = chain.needle.as_ref().map(|needle| needle.depth);
    coordinates.extend(depth);
    let of_needle = chain.needle_in_stiffness(state).into_iter();
    forces.extend(of_needle.filter(|f| Some(*f) != depth && !chain.constraints().contains(f)));
    // The equilibrium equations of needle and scales have opposite signs.
    if let Some(row) = depth {
        dense.row_mut(row).neg_mut();
    }
    let [on_coordinates, on_forces] = [&coordinates, &forces].map(|rows| dense.select_rows(rows));
    let mut compliance = on_forces.select_columns(&forces);
    for k in 0..forces.len() {
        if compliance.row(k).iter().all(|entry| *entry == 0.0) {
            compliance[(k, k)] = 1e-8;
        }
    }
    let by_forces = compliance.try_inverse().unwrap() * on_forces.select_columns(&coordinates);
    on_coordinates.select_columns(&coordinates) - on_coordinates.select_columns(&forces) * by_forces
}

/// Counts the negative eigenvalues of a dense stiffness, for motions orthogonal to `held`.
fn negative_eigenvalues(stiffness: &DMatrix<f64>, held: Option<&DVector<f64>>) -> usize {
    let symmetric = 0.5 * (stiffness + stiffness.transpose());
    let n = symmetric.nrows();
    let projection = held.map_or_else(
        || DMatrix::identity(n, n),
        |held| DMatrix::identity(n, n) - held * held.transpose() / held.norm_squared(),
    );
    let eigenvalues = (&projection * symmetric * &projection).symmetric_eigenvalues();
    let largest = eigenvalues.amax();
    // The small compliance of a rigid contact gives a huge eigenvalue of either sign, which is not
    // an unstable motion.
    eigenvalues.iter().filter(|value| (-RIGID..-1e-13 * largest).contains(*value)).count()
}

/// Compares `Chain::instability` with the dense stiffness along a path.
///
/// The points are half-way between points of the path, because an eigenvalue is zero at a load
/// extremum. `compared` collects the numbers of negative eigenvalues.
fn compare_instability(path: Continuation<Chain>, compared: &mut HashSet<(usize, usize, usize)>) {
    for_segments(path, |path, from, to| {
        let Some(point) = path.between(from, to, 0.5) else { return };
        let (chain, state) = (path.system(), &point.state);
        let dense = dense_stiffness(chain, state);
        let punctured = 3 * chain.layout.left;
        let mut depth = DVector::zeros(dense.nrows());
        depth[punctured + 1] = 1.0;
        depth[punctured + 2] = chain.loaded_arm(&state.z).x;
        let mut tilt = DVector::zeros(dense.nrows());
        tilt[punctured + 2] = 1.0;
        let ridges = chain.contacts.ridges(state);
        let expected = Instability {
            load: negative_eigenvalues(&dense, None) + ridges,
            depth: negative_eigenvalues(&dense, Some(&depth)) + ridges,
            tilt: negative_eigenvalues(&dense, Some(&tilt)) + ridges,
        };
        // On a path from a stable state, load and depth decrease where the number of negative
        // eigenvalues is odd.
        let falls = [point.leaving[chain.load()], chain.depth_slope(&state.z, &point.leaving)];
        let odd = [expected.load, expected.depth].map(|count| count % 2 == 1);
        assert_eq!(falls.map(|rate| rate < 0.0), odd, "{:?}", chain.path_point(&point));
        let asymmetry = (&dense - dense.transpose()).amax();
        assert!(asymmetry < 1e-5 * dense.amax(), "{asymmetry:e} {:e}", dense.amax());
        assert_eq!(chain.instability(state), Some(expected), "{:?}", chain.path_point(&point));
        compared.insert((expected.load, expected.depth, expected.tilt));
    });
}

/// Covers stable and unstable states on paths to 40°, which contain snaps.
///
/// The rows are finite, or part of a row without ends, with nearest and full coupling. The contacts
/// are soft enough for an accurate dense stiffness.
#[test]
fn negative_eigenvalues_match_the_dense_stiffness() {
    let mut compared = HashSet::new();
    // Solve each design on a finite and on an endless row: one of them with nearest coupling, the
    // other with full coupling.
    for (design, modulus, is_full) in
        [(LIVELY, 30.0, true), (FOLDING, HARD, false), (SLIDING, 300.0, true), (STEEP, HARD, false)]
    {
        let law = law(&design, Law::EXCHANGED, modulus);
        let springs = calibrate(&design.footprint(0.5).unwrap()).unwrap();
        let full = RowStiffness::compute(&design.footprint(0.5).unwrap(), Coupling::Full).unwrap();
        let parameters =
            &PunctureParameters { critical_tilt_deg: 40.0, ..PunctureParameters::default() };
        let layout = RowLayout { left: 7, right: 9, needle: 0, contacts: 6 };
        let nearest: RowStiffness = (&springs).into();
        let rows = Rows::Even(design.row().unwrap());
        let [finite, part] = if is_full { [&nearest, &full] } else { [&full, &nearest] };
        let far = part.with_lengths_over(design.half_base()).far_field(None).unwrap();
        let beyond = [(); 2].map(|()| Some(Beyond { far: far.clone(), scales: None }));
        let exterior = RowExterior::new(rows, layout, beyond, Body::default()).unwrap();
        let row = rows.row(layout).unwrap();
        let endless = Chain::new(row, part, law, layout, exterior, parameters, &design);
        for chain in [whole(finite, &design, law, layout, parameters), endless] {
            let rest = SkinState::at_rest(&chain);
            compare_instability(Continuation::new(chain, rest, Settings::default()), &mut compared);
        }
    }
    for seen in [(0, 0, 0), (1, 0, 1), (1, 1, 1)] {
        assert!(compared.contains(&seen), "{seen:?} {compared:?}");
    }
}

/// `SnapObserver` relies on this stability: it counts no eigenvalues before the load decreases.
#[test]
fn a_row_is_stable_until_the_load_decreases() {
    for design in [LIVELY, FOLDING, SLIDING, STEEP, DOMINO] {
        let path = path(&design, law(&design, Law::PRINTED, HARD), 1.0);
        let chain = path.system().clone();
        for point in path {
            if point.arriving[chain.load()] < 0.0 || point.leaving[chain.load()] <= 0.0 {
                break;
            }
            let Some(instability) = chain.instability(&point.state) else { continue };
            assert_eq!(instability, Instability::default(), "{design:?}");
        }
    }
}
