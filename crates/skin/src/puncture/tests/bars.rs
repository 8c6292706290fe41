//! Rows whose surface is a chain of neo-Hookean bars.

use approx::assert_relative_eq;
use solver::{BandMatrix, System, check_tangent};
use substrate::{Coupling, SubstrateLaw};

use super::*;

/// The path of a row of 21 scales.
fn bar_path(design: &Design, constants: Law, coupling: Coupling) -> Path<Chain> {
    let stiffness = RowStiffness::of(&design.footprint(0.5).unwrap(), coupling).unwrap();
    let path = path_on(&stiffness, design, law(design, constants, HARD), 1.0);
    let chain = path.system().clone().with_law(SubstrateLaw::NeoHookean);
    let rest = SkinState::at_rest(&chain);
    Path::new(chain, rest, Settings::default())
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
fn the_tangent_agrees_with_finite_differences() {
    let mut farthest = 0.0_f64;
    for (design, coupling) in CASES {
        for_segments(bar_path(&design, Law::EXCHANGED, coupling), |path, from, to| {
            let state = path.between(from, to, 0.5).unwrap().state;
            let stretch = path.system().gap_stretches(&state).unwrap();
            farthest = farthest.max((stretch.min - 1.0).abs()).max(stretch.max - 1.0);
            check_tangent(path.system(), &state, 1e-6).unwrap();
        });
    }
    // Far from where the bars are springs.
    assert!(farthest > 1.0, "{farthest}");
}

#[test]
fn the_work_of_the_load_is_stored() {
    for (design, coupling) in CASES {
        for constants in [Law::PRINTED, Law::EXCHANGED] {
            let Balance { work, off, .. } = balance(bar_path(&design, constants, coupling));
            assert!(off < 1e-6 * work, "{:e} {design:?} {constants:?}", off / work);
        }
    }
}

/// At rest bars are springs: the law does not change the tangent.
#[test]
fn at_rest_bars_are_the_springs_that_they_replace() {
    let tangent = |chain: &Chain| {
        let mut matrix = BandMatrix::new(chain.size(), chain.half_bandwidth());
        chain.tangent(&SkinState::at_rest(chain), &mut matrix);
        matrix
    };
    let linear = path(&LIVELY, law(&LIVELY, Law::PRINTED, HARD), 1.0);
    let bars = bar_path(&LIVELY, Law::PRINTED, Coupling::Nearest);
    let (linear, bars) = (tangent(linear.system()), tangent(bars.system()));
    let rows = 0..path(&LIVELY, law(&LIVELY, Law::PRINTED, HARD), 1.0).system().size();
    for row in rows {
        for column in linear.columns(row) {
            assert_relative_eq!(linear.get(row, column), bars.get(row, column), epsilon = 1e-14);
        }
    }
}
