//! Punctures solved from the end of a similar design, against paths from rest.

use contact::Law;
use geometry::Body;
use rayon::prelude::*;
use skin::puncture::{self, Puncture, PunctureInput, PunctureParameters};
use skin::{Common, Design, PathDetail, Status};
use substrate::{Calibrations, Coupling, SubstrateLaw};

use super::samples::{BASES, SplitMix64, design, long_campaigns};

/// Relative difference within which two measures agree.
///
/// Contacts are ten thousand times stiffer than the substrate, and the tolerance of Newton's method
/// refers to their forces.
const SAME: f64 = 1e-7;

/// Two similar designs on one substrate.
#[derive(Debug)]
struct Pair {
    designs: [Design; 2],
    law: Law,
    coupling: Coupling,
    parameters: PunctureParameters,
}

/// Draws numbers for pairs of designs.
struct Draw(SplitMix64);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.next()
    }

    fn is_true(&mut self, share: f64) -> bool {
        self.0.next() < share
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
        let load_position = self.between(0.6, 1.0);
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

/// Draws pairs of similar designs without overlapping scales.
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

/// Result of the second design from the end of the first one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// The first design has no usable end.
    NoStart,
    /// The end of the second design was not found from the end of the first one.
    NotFound,
    Agrees,
    Differs,
}

impl Pair {
    fn outcome(&self, known: &Calibrations) -> Outcome {
        let Self { designs, law, coupling, parameters } = self;
        let common = Common { law: *law, detail: PathDetail::Critical, ..Common::default() };
        let inputs = designs.map(|design| {
            let footprint = design.footprint(parameters.poisson_ratio).unwrap();
            let stiffness = known.row(&footprint, *coupling).unwrap().as_ref().clone();
            PunctureInput { design, stiffness, common, parameters: *parameters, odd: None }
        });
        let [first, second] = inputs.each_ref().map(|input| {
            let PunctureInput { design, stiffness, .. } = input;
            puncture::solve(design, stiffness.clone(), &common, parameters).unwrap()
        });
        let Some(end) = &first.end else { return Outcome::NoStart };
        let near = puncture::solve_near(&inputs[1], end).unwrap();
        match near {
            None => Outcome::NotFound,
            Some(near) if agree(&near, &second) => Outcome::Agrees,
            Some(_) => Outcome::Differs,
        }
    }
}

/// Returns true if both punctures were completed with the same measures.
fn agree(near: &Puncture, whole: &Puncture) -> bool {
    whole.status == Status::Complete
        && counts(near) == counts(whole)
        && numbers(near).into_iter().zip(numbers(whole)).all(|pair| match pair {
            (Some(a), Some(b)) => (a - b).abs() <= SAME * a.abs().clamp(1e-3, 1.0),
            (a, b) => a == b,
        })
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

/// Left of the middle a scale may tilt either way, so its path is followed.
#[test]
fn a_load_left_of_the_middle_leaves_no_end() {
    let known = Calibrations::default();
    for mut pair in random_pairs(20, 5) {
        pair.parameters.load_position *= 0.5;
        assert_eq!(pair.outcome(&known), Outcome::NoStart, "{pair:?}");
    }
}

/// Four hundred pairs; ten thousand in a long campaign.
///
/// No end lies on another branch than the end of the path from rest.
#[test]
fn ends_of_similar_designs_agree_with_their_paths() {
    let known = Calibrations::default();
    let pairs = random_pairs(if long_campaigns() { 10_000 } else { 400 }, 49);
    let outcomes: Vec<_> = pairs.par_iter().map(|pair| pair.outcome(&known)).collect();
    let [agree, not_found, no_start] = [Outcome::Agrees, Outcome::NotFound, Outcome::NoStart]
        .map(|outcome| outcomes.iter().filter(|of| **of == outcome).count());
    println!("{agree} agree, {not_found} not found, {no_start} without a start");
    for (pair, outcome) in pairs.iter().zip(&outcomes) {
        assert_ne!(*outcome, Outcome::Differs, "{pair:?}");
    }
    assert!(5 * agree > 4 * pairs.len());
}
