//! Rows on a neo-Hookean substrate surface.

use approx::assert_relative_eq;
use geometry::{Parallelogram, Row};
use solver::{BandMatrix, Residual, System, check_tangent};
use substrate::{Coupling, SubstrateLaw};

use super::*;

/// Starts the path of a row of 21 scales.
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
    // Strains far beyond the range in which bars behave like springs.
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

/// At rest the neo-Hookean law has the tangent of the linear springs.
#[test]
fn at_rest_bars_match_the_springs() {
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

/// A row leaning to the left deforms as the mirror image of one leaning right.
#[test]
fn mirrored_rows_have_mirrored_forces() {
    let layout = RowLayout { left: 3, right: 3, needle: 0, contacts: 6 };
    let last = layout.scales() - 1;
    let stiffness =
        RowStiffness::compute(&LIVELY.footprint(0.5).unwrap(), Coupling::Nearest).unwrap();
    let chain = |slant_deg: f64, of_substrate: SubstrateLaw| {
        let scale = Parallelogram::leaning(LIVELY.half_base(), slant_deg).unwrap();
        let row = Arrangement::Even(Row::new(scale, LIVELY.gap).unwrap());
        let law = law(&LIVELY, Law::PRINTED, HARD);
        let parameters =
            PunctureParameters { substrate_law: of_substrate, ..PunctureParameters::default() };
        let beyond = RowExterior::default();
        Chain::new(row, &stiffness, law, layout, beyond, &parameters, &LIVELY)
    };
    let forces = |chain: &Chain, displacement: &dyn Fn(usize) -> [f64; 3]| {
        let (mut state, mut residual) = (SkinState::at_rest(chain), Residual::new(chain.size()));
        for scale in 0..=last {
            state.z[layout.scale(scale)..][..3].copy_from_slice(&displacement(scale));
        }
        chain.residual(&state, &mut residual);
        let force =
            |scale: usize| -> Vec<f64> { residual.value[layout.scale(scale)..][..3].into() };
        ((0..=last).map(force).collect::<Vec<_>>(), chain.substrate_energy(&state))
    };
    let displacement = |scale: usize| {
        let k = scale as f64;
        [0.2 * LIVELY.gap * (3.0 * k).sin(), 0.1 * (5.0 * k).cos(), 0.3 * (2.0 * k).sin()]
    };
    let reflected = |[x, y, rotation]: [f64; 3]| [-x, y, -rotation];
    let mut energies = Vec::new();
    for of_substrate in [SubstrateLaw::Linear, SubstrateLaw::NeoHookean] {
        let [right, left] = [1.0, -1.0].map(|side| chain(side * LIVELY.slant_deg, of_substrate));
        let (ours, energy) = forces(&right, &displacement);
        let (theirs, mirrored) = forces(&left, &|scale| reflected(displacement(last - scale)));
        for (scale, ours) in ours.iter().enumerate() {
            let image = reflected(theirs[last - scale].clone().try_into().unwrap());
            assert_relative_eq!(ours[..], image[..], max_relative = 1e-12, epsilon = 1e-14);
        }
        assert_relative_eq!(energy, mirrored, max_relative = 1e-12);
        energies.push(energy);
    }
    assert!((energies[0] / energies[1] - 1.0).abs() > 0.01, "{energies:?}");
}
