//! Tests of rows on a neo-Hookean substrate.

use approx::assert_relative_eq;
use geometry::{Parallelogram, Row};
use solver::{BandMatrix, Residual, System, check_tangent};
use substrate::{Coupling, SubstrateLaw};

use super::*;

/// Starts the path of a row of 21 scales on a neo-Hookean substrate.
fn bar_path(design: &Design, constants: Law, coupling: Coupling) -> Continuation<Chain> {
    let stiffness = RowStiffness::compute(&design.footprint(0.5).unwrap(), coupling).unwrap();
    let path = path_on(&stiffness, design, law(design, constants, HARD), 1.0);
    let mut chain = path.system().clone();
    chain.bars = chain.neighbours.first().map(|nearest| -nearest.direct[0]);
    let rest = SkinState::at_rest(&chain);
    Continuation::new(chain, rest, Settings::default())
}

const CASES: [(Design, Coupling); 6] = [
    (LIVELY, Coupling::Nearest),
    (FOLDING, Coupling::Nearest),
    (SLIDING, Coupling::Nearest),
    (DOMINO, Coupling::Nearest),
    (LIVELY, Coupling::Full),
    (DOMINO, Coupling::Full),
];

#[test]
fn tangent_matches_finite_differences() {
    let mut farthest = 0.0_f64;
    for (design, coupling) in CASES {
        for_segments(bar_path(&design, Law::EXCHANGED, coupling), |path, from, to| {
            let state = path.between(from, to, 0.5).unwrap().state;
            let stretch = path.system().gap_stretches(&state).unwrap();
            farthest = farthest.max((stretch.min - 1.0).abs()).max(stretch.max - 1.0);
            check_tangent(path.system(), &state, 1e-6).unwrap();
        });
    }
    // The paths must contain gap strains at which bars differ from springs.
    assert!(farthest > 1.0, "{farthest}");
}

#[test]
fn work_of_the_load_equals_stored_energy() {
    for (design, coupling) in CASES {
        for constants in [Law::PRINTED, Law::EXCHANGED] {
            let Balance { work, off, .. } = balance(bar_path(&design, constants, coupling));
            assert!(off < 1e-6 * work, "{:e} {design:?} {constants:?}", off / work);
        }
    }
}

/// The neo-Hookean law has the same tangent at rest as the linear springs.
#[test]
fn bars_match_linear_springs_at_rest() {
    let linear = path(&LIVELY, law(&LIVELY, Law::PRINTED, HARD), 1.0);
    let bars = bar_path(&LIVELY, Law::PRINTED, Coupling::Nearest);
    let [linear, bars] = [linear.system(), bars.system()].map(|chain| {
        let mut matrix = BandMatrix::new(chain.size(), chain.half_bandwidth());
        chain.tangent(&SkinState::at_rest(chain), &mut matrix);
        matrix
    });
    for row in 0..linear.size() {
        for column in linear.columns(row) {
            assert_relative_eq!(linear.get(row, column), bars.get(row, column), epsilon = 1e-14);
        }
    }
}

/// A row that leans to the left has the mirrored forces of a row that leans to the right.
#[test]
fn a_row_and_its_mirror_image_have_mirrored_forces() {
    let layout = RowLayout { left: 3, right: 3, needle: 0, contacts: 6 };
    let last = layout.scales() - 1;
    let stiffness =
        RowStiffness::compute(&LIVELY.footprint(0.5).unwrap(), Coupling::Nearest).unwrap();
    let mut energies = Vec::new();
    for substrate_law in [SubstrateLaw::Linear, SubstrateLaw::NeoHookean] {
        let parameters = PunctureParameters { substrate_law, ..PunctureParameters::default() };
        // The mirror image leans to the left, with the scales in reverse order.
        let [(ours, energy), (theirs, mirrored)] = [1.0, -1.0].map(|side| {
            let scale =
                Parallelogram::leaning(LIVELY.half_base(), side * LIVELY.slant_deg).unwrap();
            let row = Arrangement::Even(Row::new(scale, LIVELY.gap).unwrap());
            let law = law(&LIVELY, Law::PRINTED, HARD);
            let exterior = RowExterior::default();
            let chain = Chain::new(row, &stiffness, law, layout, exterior, &parameters, &LIVELY);
            let nodes = (0..=last).map(|k| layout.scale(if side > 0.0 { k } else { last - k }));
            let mut state = SkinState::at_rest(&chain);
            for (k, at) in nodes.clone().enumerate() {
                let k = k as f64;
                state.z[at] = side * 0.2 * LIVELY.gap * (3.0 * k).sin();
                state.z[at + 1] = 0.1 * (5.0 * k).cos();
                state.z[at + 2] = side * 0.3 * (2.0 * k).sin();
            }
            let mut residual = Residual::new(chain.size());
            chain.residual(&state, &mut residual);
            let forces = nodes.map(|at| {
                let [x, y, moment] = [0, 1, 2].map(|k| residual.value[at + k]);
                [side * x, y, side * moment]
            });
            (forces.collect::<Vec<_>>(), chain.substrate_energy(&state))
        });
        for (ours, theirs) in ours.iter().zip(&theirs) {
            assert_relative_eq!(ours[..], theirs[..], max_relative = 1e-12, epsilon = 1e-14);
        }
        assert_relative_eq!(energy, mirrored, max_relative = 1e-12);
        energies.push(energy);
    }
    assert!((energies[0] / energies[1] - 1.0).abs() > 0.01, "{energies:?}");
}
