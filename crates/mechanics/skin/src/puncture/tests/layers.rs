//! Tests of rows on a layer, which couples `x` with `y` and with `φ` of a scale.

use approx::assert_relative_eq;
use contact::Law;
use solver::{BandMatrix, Continuation, Settings, System};
use substrate::{Coupling, RowStiffness, SubstrateLaw};

use super::{BLOCKS, Balance, DOMINO, HARD, LIVELY, balance, law, whole};
use crate::Design;
use crate::contacts::SkinState;
use crate::puncture::PunctureParameters;
use crate::puncture::row_layout::RowLayout;
use crate::puncture::system::Chain;

/// Designs with coupling and law of the substrate.
const CASES: [(Design, Coupling, SubstrateLaw); 5] = [
    (LIVELY, Coupling::Nearest, SubstrateLaw::Linear),
    (BLOCKS, Coupling::Nearest, SubstrateLaw::NeoHookean),
    (DOMINO, Coupling::Nearest, SubstrateLaw::NeoHookean),
    (LIVELY, Coupling::Full, SubstrateLaw::NeoHookean),
    (DOMINO, Coupling::Full, SubstrateLaw::Linear),
];

/// Starts the path of a row of 21 scales on a layer that is as thick as the scales.
fn layer_path(
    (design, coupling, substrate_law): &(Design, Coupling, SubstrateLaw),
) -> Continuation<Chain> {
    let layer = design.footprint(0.5).unwrap().on_layer(1.0 / design.half_base()).unwrap();
    let stiffness = RowStiffness::compute(&layer, *coupling).unwrap();
    let layout = RowLayout { left: 10, right: 10, needle: 0, contacts: 6 };
    let parameters =
        PunctureParameters { substrate_law: *substrate_law, ..PunctureParameters::default() };
    let law = law(design, Law::PRINTED, HARD);
    let chain = whole(&stiffness, design, law, layout, &parameters);
    let rest = SkinState::at_rest(&chain);
    Continuation::new(chain, rest, Settings::default())
}

#[test]
fn work_of_the_load_equals_stored_energy() {
    for case in CASES {
        let Balance { work, off, .. } = balance(layer_path(&case));
        assert!(off < 1e-6 * work, "{:e} {case:?}", off / work);
    }
}

/// At rest the tangent contains only the substrate, including its coupling of `x` with `φ`.
#[test]
fn tangent_at_rest_is_symmetric() {
    for case in CASES {
        let path = layer_path(&case);
        let (chain, state) = (path.system(), &path.point().state);
        let mut tangent = BandMatrix::new(chain.size(), chain.half_bandwidth());
        chain.tangent(state, &mut tangent);
        let first = chain.layout.scale(4);
        assert!(tangent.get(first, first + 2) < 0.0, "{case:?}");
        for row in first..first + 3 {
            for column in (3..6).map(|scale| chain.layout.scale(scale)).flat_map(|at| at..at + 3) {
                assert_eq!(tangent.get(row, column), tangent.get(column, row), "{case:?}");
            }
        }
    }
}

/// The reported reactions must be the forces of the stiffness in the equations.
#[test]
fn reactions_match_the_stiffness() {
    for case in CASES {
        let mut path = layer_path(&case);
        while path.next().is_some() {}
        let (chain, z) = (path.system(), &path.point().state.z);
        let mut forces = vec![0.0; z.len()];
        chain.constant_tangent(&mut |row: usize, column: usize, value: f64| {
            forces[row] += value * z[column];
        });
        for scale in 0..chain.layout.scales() {
            let reaction = chain.reaction(z, scale.cast_signed());
            for (k, reaction) in reaction.into_iter().enumerate() {
                let force = forces[chain.layout.scale(scale) + k];
                assert_relative_eq!(reaction, -force, epsilon = 1e-14, max_relative = 1e-9);
            }
        }
    }
}
