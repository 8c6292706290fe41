//! Compares path ends solved from the end of a similar design with paths from rest.

use contact::Law;
use geometry::Body;
use rayon::prelude::*;
use skin::puncture::{self, Puncture, PunctureInput, PunctureParameters};
use skin::{Common, Design, PathDetail, Status};
use substrate::{Calibrations, Coupling, SubstrateLaw};

use super::samples::{BASES, SplitMix64, design, long_campaigns};

/// Relative difference within which two measures count as equal.
///
/// It exceeds the tolerance of Newton's method, which refers to contact forces: contacts are about
/// ten thousand times stiffer than the substrate.
const SAME: f64 = 1e-7;

/// Two similar designs with the same other parameters.
#[derive(Debug)]
struct Pair {
    designs: [Design; 2],
    law: Law,
    coupling: Coupling,
    parameters: PunctureParameters,
}

/// Draws random pairs of similar designs.
struct Draw(SplitMix64);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.next()
    }

    fn is_true(&mut self, probability: f64) -> bool {
        self.0.next() < probability
    }

    /// Draws designs that differ by up to 15 % in gap and length, and by up to 6° in slant.
    fn designs(&mut self) -> [Design; 2] {
        let (gap, length) = (self.between(0.05, 1.0), self.between(0.05, 1.5));
        let (slant, base) = (self.between(6.0, 74.0), BASES[usize::from(self.is_true(0.5))]);
        let size = 10_f64.powf(self.between(-3.0, 0.0));
        let by = [0.15 * gap, 0.15 * length, 6.0].map(|by| size * by * self.between(-1.0, 1.0));
        [design(gap, length, slant, base), design(gap + by[0], length + by[1], slant + by[2], base)]
    }

    fn pair(&mut self) -> Pair {
        let curvature = if self.is_true(0.5) { 0.0 } else { self.between(-0.05, 0.2) };
        let is_linear = curvature != 0.0 || self.is_true(0.8);
        let substrate_law = if is_linear { SubstrateLaw::Linear } else { SubstrateLaw::NeoHookean };
        let load_position = self.between(0.0, 1.0);
        let contact_modulus_over_substrate = 10_f64.powf(self.between(1.5, 5.0));
        let critical_tilt_deg = self.between(3.0, 25.0);
        Pair {
            designs: self.designs(),
            law: [Law::PRINTED, Law::EXCHANGED][usize::from(self.is_true(0.3))],
            coupling: [Coupling::Nearest, Coupling::Full][usize::from(self.is_true(0.2))],
            parameters: PunctureParameters {
                curvature,
                substrate_law,
                load_position,
                contact_modulus_over_substrate,
                critical_tilt_deg,
                ..Default::default()
            },
        }
    }
}

/// Draws pairs of similar designs that have no overlapping scales at rest.
fn random_pairs(count: usize, seed: u64) -> Vec<Pair> {
    let mut draw = Draw(SplitMix64(seed));
    let mut pairs = Vec::new();
    while pairs.len() < count {
        let pair = draw.pair();
        let body = Body { curvature: pair.parameters.curvature };
        if !pair.designs.iter().any(|one| puncture::overlaps_at_rest(one, body).unwrap()) {
            pairs.push(pair);
        }
    }
    pairs
}

/// Outcome of solving the end of the second design from the end of the first design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// The first design has no usable end.
    NoStart,
    /// The end of the second design was not found.
    NotFound,
    /// The end of the second design agrees with its path from rest.
    Agrees,
    /// The end of the second design differs from its path from rest.
    Differs,
}

impl Pair {
    fn inputs(&self, known: &Calibrations) -> [PunctureInput; 2] {
        let common = Common { law: self.law, detail: PathDetail::Critical, ..Common::default() };
        let parameters = self.parameters;
        self.designs.map(|design| {
            let footprint = design.footprint(parameters.poisson_ratio).unwrap();
            let stiffness = known.row(&footprint, self.coupling).unwrap().as_ref().clone();
            PunctureInput { design, stiffness, common, parameters, perturbed: None }
        })
    }

    /// Solves the end of the second design with the measures of `detail`.
    fn outcome(&self, known: &Calibrations, detail: PathDetail) -> Outcome {
        let mut inputs = self.inputs(known);
        inputs[1].common.detail = detail;
        let [first, second] = inputs.each_ref().map(from_rest);
        let Some(end) = &first.end else { return Outcome::NoStart };
        let near = puncture::solve_near(&inputs[1], end).unwrap();
        match near {
            None => Outcome::NotFound,
            Some(near) if agree(&near, &second) => Outcome::Agrees,
            Some(_) => Outcome::Differs,
        }
    }
}

fn from_rest(input: &PunctureInput) -> Puncture {
    let PunctureInput { design, stiffness, common, parameters, .. } = input;
    puncture::solve(design, stiffness.clone(), common, parameters).unwrap()
}

/// Returns true if both punctures are complete and have the same measures.
fn agree(near: &Puncture, whole: &Puncture) -> bool {
    whole.status == Status::Complete
        && counts(near) == counts(whole)
        && numbers(near).into_iter().zip(numbers(whole)).all(|(near, whole)| is_same(near, whole))
}

fn is_same(near: Option<f64>, whole: Option<f64>) -> bool {
    match (near, whole) {
        (Some(a), Some(b)) => (a - b).abs() <= SAME * a.abs().clamp(1e-3, 1.0),
        (a, b) => a == b,
    }
}

fn counts(puncture: &Puncture) -> (Status, Option<usize>, Option<usize>) {
    (puncture.status, puncture.measures.contacts, puncture.measures.engaged_scales)
}

fn numbers(puncture: &Puncture) -> [Option<f64>; 9] {
    let of = &puncture.measures;
    [
        of.critical_force,
        of.critical_displacement,
        of.penetration,
        of.sink,
        of.sound_force,
        of.fold_displacement,
        of.fold_tilt_deg,
        of.gap_stretch_min,
        of.gap_stretch_max,
    ]
}

/// A load above the middle of the base hardly tilts the scale, so the path has no usable end.
#[test]
fn a_path_with_the_load_above_the_middle_of_the_base_stores_no_end() {
    let known = Calibrations::default();
    let mut tested = 0;
    for mut pair in random_pairs(20, 5) {
        let [design, _] = &pair.designs;
        let shift = design.slant_deg.to_radians().tan() / (2.0 * design.half_base());
        pair.parameters.load_position = 0.52 - shift;
        if pair.parameters.load_position > 0.0 {
            assert_eq!(pair.outcome(&known, PathDetail::Critical), Outcome::NoStart, "{pair:?}");
            tested += 1;
        }
    }
    assert!(tested > 3);
}

/// An end that differs from the path from rest would lie on another branch.
///
/// Tests 400 pairs, or 10,000 in a long campaign.
#[test]
fn ends_solved_from_similar_designs_agree_with_paths_from_rest() {
    let known = Calibrations::default();
    let pairs = random_pairs(if long_campaigns() { 10_000 } else { 400 }, 49);
    let found = [PathDetail::Critical, PathDetail::End].map(|detail| {
        let outcomes: Vec<_> = pairs.par_iter().map(|pair| pair.outcome(&known, detail)).collect();
        let [agree, not_found, no_start] = [Outcome::Agrees, Outcome::NotFound, Outcome::NoStart]
            .map(|outcome| outcomes.iter().filter(|of| **of == outcome).count());
        println!("{detail:?}: {agree} agree, {not_found} not found, {no_start} without a start");
        for (pair, outcome) in pairs.iter().zip(&outcomes) {
            assert_ne!(*outcome, Outcome::Differs, "{pair:?}");
        }
        agree
    });
    assert!(4 * found[0] > 3 * pairs.len());
    // Without folds, more ends are usable and found.
    assert!(found[1] > found[0]);
}

/// The end solved from this path would lie on another branch, with a force 9 % larger.
#[test]
fn a_path_with_a_gap_that_almost_folds_stores_no_end() {
    let base = BASES[1];
    let designs = [design(0.67935, 0.87844, 71.7306, base), design(0.6935, 0.89251, 72.7911, base)];
    let parameters = PunctureParameters {
        load_position: 0.539_76,
        contact_modulus_over_substrate: 79.9696,
        critical_tilt_deg: 21.6098,
        ..Default::default()
    };
    let pair = Pair { designs, law: Law::PRINTED, coupling: Coupling::Nearest, parameters };
    assert_eq!(pair.outcome(&Calibrations::default(), PathDetail::End), Outcome::NoStart);
}

/// Tests 40 pairs at five load positions each, or 1,000 pairs in a long campaign.
#[test]
fn load_positions_solved_from_similar_designs_agree_with_paths_from_rest() {
    let known = Calibrations::default();
    let mut pairs = random_pairs(if long_campaigns() { 1000 } else { 40 }, 11);
    for (number, pair) in pairs.iter_mut().enumerate() {
        pair.parameters.places = Some(5);
        if number % 2 == 0 {
            pair.parameters.load_position = 1.0;
        }
    }
    let near = pairs.par_iter().map(|pair| {
        let inputs = pair.inputs(&known);
        let [first, second] = inputs.each_ref().map(from_rest);
        let near = puncture::solve_near(&inputs[1], first.end.as_ref()?).unwrap()?;
        let [weakest, expected] = [&near, &second].map(|of| of.measures.weakest);
        assert_eq!(weakest.position, expected.position, "{pair:?}");
        assert!(is_same(weakest.force, expected.force), "{weakest:?} {expected:?} {pair:?}");
        for near in &near.places {
            let whole = second.places.iter().find(|of| of.position == near.position).unwrap();
            assert_eq!(near.status, whole.status, "{pair:?}");
            assert!(is_same(near.force, whole.force), "{near:?} {whole:?} {pair:?}");
            assert!(is_same(near.displacement, whole.displacement), "{near:?} {whole:?} {pair:?}");
            assert!(is_same(near.tilt_deg, whole.tilt_deg), "{near:?} {whole:?} {pair:?}");
        }
        Some(())
    });
    assert!(near.flatten().count() > 3 * pairs.len() / 4);
}
