//! Fits recover the parameters of synthetic curves, within the reported intervals.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::time::{Duration, Instant};

use fit::{Estimate, Fitted};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;

use crate::synthetic_curves::{Place, SyntheticCurve};

/// A skin, its definition with unknowns, and its curves with keys for their tables.
struct Trial {
    skin: String,
    sought: String,
    curves: Vec<(SyntheticCurve<'static>, &'static str)>,
    truth: Vec<f64>,
}

const PUNCTURE: SyntheticCurve<'_> = SyntheticCurve {
    file: "a.csv",
    bending: false,
    to: 0.5,
    points: 40,
    noise: 0.0,
    seed: 1,
    offsets: [0.0; 2],
};

/// Returns the definition of printed scales on foam under a guided needle.
fn skin(gap: f64, length: f64, slant: f64) -> String {
    format!(
        "name = 'palm'\ndesigns.gap_over_t = {gap}\ndesigns.length_over_t = {length}\ndesigns.slant_deg = {slant}\n\
         puncture.needle = 'guided'\npuncture.load_inset_over_t = 0.05\nmaterial.thickness_mm = 2\n"
    )
}

/// Fits the foam modulus and the needle friction to one puncture curve.
fn modulus_and_needle_friction(random: &mut ChaCha12Rng) -> Trial {
    let (modulus, friction) = (random.random_range(0.2..1.0), random.random_range(0.15..0.5));
    let skin = skin(0.2, 0.8, 60.0);
    Trial {
        sought: format!(
            "{skin}[variables]\nsubstrate_modulus_MPa = {{ from = 0.05, to = 2 }}\nneedle_friction = {{ from = 0.02, to = 0.9 }}\n"
        ),
        skin: format!(
            "{skin}material.substrate_modulus_MPa = {modulus}\npuncture.needle_friction = {friction}\n"
        ),
        curves: vec![(PUNCTURE, "")],
        truth: vec![modulus, friction],
    }
}

/// Fits both moduli and a displacement offset to two punctures and a bending test.
fn both_moduli_and_an_offset(random: &mut ChaCha12Rng) -> Trial {
    let (modulus, membrane) = (random.random_range(0.2..1.0), random.random_range(2.0..8.0));
    let offset = random.random_range(-0.05..0.08);
    let skin = |gap| format!("{}puncture.needle_friction = 0.3\n", skin(gap, 1.0, 45.0));
    let known = format!(
        "material.substrate_modulus_MPa = {modulus}\nmaterial.membrane_modulus_MPa = {membrane}\n"
    );
    let second =
        SyntheticCurve { file: "b.csv", to: 0.6, offsets: [offset, 0.0], seed: 2, ..PUNCTURE };
    let strip =
        SyntheticCurve { file: "c.csv", bending: true, to: 0.03, points: 25, seed: 3, ..PUNCTURE };
    Trial {
        sought: format!(
            "{}[variables]\nsubstrate_modulus_MPa = {{ from = 0.05, to = 2 }}\nmembrane_modulus_MPa = {{ from = 0.5, to = 20 }}\n",
            skin(0.2)
        ),
        skin: format!("{}{known}", skin(0.2)),
        curves: vec![
            (PUNCTURE, ""),
            (second, "gap_over_t = 0.4\noffsets = ['displacement']\n"),
            (strip, ""),
        ],
        truth: vec![modulus, membrane, offset],
    }
}

/// Fits the modulus and the position of a free load.
fn modulus_and_place(random: &mut ChaCha12Rng) -> Trial {
    let (modulus, place) = (random.random_range(0.2..1.0), random.random_range(0.7..0.95));
    let shared = "name = 'place'\ndesigns.gap_over_t = 0.3\ndesigns.length_over_t = 0.6\ndesigns.slant_deg = 30\n\
                  material.thickness_mm = 2\n";
    Trial {
        sought: format!(
            "{shared}[variables]\nsubstrate_modulus_MPa = {{ from = 0.05, to = 2 }}\nload_position = {{ from = 0.55, to = 1 }}\n"
        ),
        skin: format!(
            "{shared}material.substrate_modulus_MPa = {modulus}\npuncture.load_position = {place}\n"
        ),
        curves: vec![(PUNCTURE, "")],
        truth: vec![modulus, place],
    }
}

/// Fits gap, friction between scales and a force offset to a free puncture load.
fn gap_and_friction(random: &mut ChaCha12Rng) -> Trial {
    let (gap, friction) = (random.random_range(0.15..0.3), random.random_range(0.05..0.4));
    let offset = random.random_range(-0.02..0.02);
    let shared = "name = 'free'\ndesigns.length_over_t = 1\ndesigns.slant_deg = 60\nmaterial.thickness_mm = 1\n\
                  material.substrate_modulus_MPa = 0.3\n";
    let curve = SyntheticCurve { to: 0.4, offsets: [0.0, offset], ..PUNCTURE };
    Trial {
        sought: format!(
            "{shared}[variables]\ngap_over_t = {{ from = 0.08, to = 0.5 }}\nfriction = {{ from = 0.01, to = 0.8 }}\n"
        ),
        skin: format!("{shared}designs.gap_over_t = {gap}\ncontact.friction = {friction}\n"),
        curves: vec![(curve, "offsets = ['force']\n")],
        truth: vec![gap, friction, offset],
    }
}

/// Returns the skin with the gap in the keys of a curve, if they contain one.
fn specimen(skin: &str, keys: &str) -> String {
    let Some(own) = keys.lines().find(|line| line.starts_with("gap_over_t")) else {
        return skin.to_owned();
    };
    let is_gap = |line: &str| line.starts_with("designs.gap_over_t");
    let line =
        |line: &str| if is_gap(line) { format!("designs.{own}\n") } else { format!("{line}\n") };
    skin.lines().map(line).collect()
}

impl Trial {
    /// Computes the curves with noise, a fraction of the largest value, and fits them.
    fn fitted(self, number: u64, noise: f64) -> Fitted {
        let place = Place::new();
        let mut text = self.sought;
        for (curve, keys) in self.curves {
            let kind = if curve.bending { "bending" } else { "puncture" };
            let file = curve.file;
            let seed = 10 * number + curve.seed;
            place.make(&specimen(&self.skin, keys), &SyntheticCurve { noise, seed, ..curve });
            write!(text, "[[curve]]\nfile = '{file}'\nkind = '{kind}'\n{keys}").expect("a text");
        }
        place.fit(&text).expect("an answer")
    }
}

const KINDS: [fn(&mut ChaCha12Rng) -> Trial; 4] =
    [modulus_and_needle_friction, both_moduli_and_an_offset, modulus_and_place, gap_and_friction];

fn trial(number: u64) -> Trial {
    KINDS[number as usize % KINDS.len()](&mut ChaCha12Rng::seed_from_u64(number))
}

/// Result for an unknown of a trial.
enum Came {
    /// The interval, and whether it contains the true value.
    Interval { holds: bool },
    /// The curves do not determine the unknown.
    Untold,
    /// The estimate is at a bound.
    AtEnd,
}

/// Fits a trial, and returns the result for each unknown by name.
fn held(number: u64, noise: f64) -> Vec<(String, Came)> {
    let truth = trial(number).truth;
    let fitted = trial(number).fitted(number, noise);
    let came = |(estimate, truth): (&Estimate, &f64)| {
        let came = match estimate.interval {
            None => Came::Untold,
            Some(_) if estimate.at_end => Came::AtEnd,
            Some([low, high]) => Came::Interval { holds: (low..=high).contains(truth) },
        };
        (format!("{} of kind {}", estimate.unknown.name, number % KINDS.len() as u64), came)
    };
    fitted.estimates.iter().zip(&truth).map(came).collect()
}

#[test]
fn exact_curves_recover_the_parameters() {
    for number in 100..104 {
        let truth = trial(number).truth;
        let fitted = trial(number).fitted(number, 0.0);
        assert!(fitted.undetermined.is_empty());
        for (estimate, truth) in fitted.estimates.iter().zip(truth) {
            let range = estimate.unknown.to - estimate.unknown.from;
            let off = (estimate.value - truth).abs() / range;
            assert!(off < 1e-5, "{number}: {} is off by {off:e}", estimate.unknown.name);
        }
        assert!(fitted.curves.iter().all(|curve| curve.beyond + curve.differenced == 0));
    }
}

/// Returns the number of trials for each noise, and the time to start them.
///
/// `SQUAMA_CAMPAIGNS=endless` runs a thousand trials, `long` those that start within six seconds,
/// and otherwise a few run.
fn campaign() -> (u64, Duration) {
    match std::env::var("SQUAMA_CAMPAIGNS").as_deref() {
        Ok("endless") => (1000, Duration::MAX),
        Ok("long") => (1000, Duration::from_secs(6)),
        _ => (FEW, Duration::MAX),
    }
}

/// Minimum number of trials.
const FEW: u64 = 4;

/// Factor on the binomial variance: intervals of one trial are correlated.
const TOGETHER: f64 = 2.0;

#[test]
fn confidence_intervals_have_their_nominal_coverage() {
    let (count, longest) = campaign();
    for noise in [0.01, 0.03, 0.1] {
        let begun = Instant::now();
        let has_time = |number: &u64| *number < FEW || begun.elapsed() < longest;
        let numbers = (0..count).into_par_iter().filter(has_time);
        let trials: Vec<_> = numbers.map(|number| held(number, noise)).collect();
        let mut counts = BTreeMap::<&str, [usize; 4]>::new();
        for (name, came) in trials.iter().flatten() {
            let column = match came {
                Came::Interval { holds: true } => 0,
                Came::Interval { holds: false } => 1,
                Came::Untold => 2,
                Came::AtEnd => 3,
            };
            counts.entry(name).or_default()[column] += 1;
        }
        let [hold, miss] = [0, 1].map(|k| counts.values().map(|count| count[k]).sum::<usize>());
        let intervals = hold + miss;
        let share = hold as f64 / intervals as f64;
        println!(
            "noise {noise}: {:.2} % of {intervals} intervals of {} trials; hold, miss, undetermined, at an end:",
            100.0 * share,
            trials.len()
        );
        for (name, counts) in counts {
            println!("  {name}: {counts:?}");
        }
        let chance = 3.5 * (TOGETHER * 0.95 * 0.05 / intervals as f64).sqrt();
        assert!((share - 0.95).abs() <= chance.max(0.02), "{noise}: {share} of {intervals}");
    }
}

/// Before scales touch, the moment depends on E h³ of the membrane alone.
#[test]
fn unknowns_that_only_occur_as_a_product_are_undetermined_together() {
    let place = Place::new();
    let shared = "name = 'strip'\ndesigns.gap_over_t = 1\ndesigns.length_over_t = 0.5\ndesigns.slant_deg = 30\n\
                  material.thickness_mm = 2\n";
    let skin = format!(
        "{shared}material.membrane_modulus_MPa = 4\nflexure.membrane_thickness_over_t = 0.1\n"
    );
    let strip = SyntheticCurve { bending: true, to: 0.005, points: 30, noise: 0.01, ..PUNCTURE };
    place.make(&skin, &strip);
    let sought = format!(
        "{shared}[variables]\nmembrane_modulus_MPa = {{ from = 1, to = 10 }}\nmembrane_thickness_over_t = {{ from = 0.05, to = 0.3 }}\n\
         [[curve]]\nfile = 'a.csv'\nkind = 'bending'\n"
    );
    let fitted = place.fit(&sought).expect("an answer");
    assert_eq!(fitted.undetermined, [vec![0, 1]]);
    assert!(fitted.estimates.iter().all(|estimate| estimate.interval.is_none()));
    assert!(fitted.correlations[0][1] < -0.999_999, "{:?}", fitted.correlations);
    // The curve determines the product E h³.
    let [modulus, thickness] = [0, 1].map(|j| fitted.estimates[j].value);
    assert!((modulus * thickness.powi(3) / (4.0 * 0.1_f64.powi(3)) - 1.0).abs() < 0.02);
    // If one of the two is known, the other is determined.
    let one = sought.replace(
        "membrane_thickness_over_t = { from = 0.05, to = 0.3 }\n",
        "[flexure]\nmembrane_thickness_over_t = 0.1\n",
    );
    let fitted = place.fit(&one).expect("an answer");
    let [low, high] = fitted.estimates[0].interval.expect("an interval");
    assert!(fitted.undetermined.is_empty() && low > 3.9 && high < 4.1, "{low} {high}");
}

/// An unknown without influence on any curve is undetermined on its own.
#[test]
fn unknowns_without_influence_are_undetermined() {
    let Trial { skin, curves, .. } = trial(0);
    let sought = skin.clone()
        + "[variables]\nmembrane_modulus_MPa = { from = 1, to = 10 }\nfriction = { from = 0, to = 0.5 }\n";
    let trial = Trial { skin, sought, curves, truth: Vec::new() };
    assert!(trial.fitted(0, 0.01).undetermined.contains(&vec![0]));
}

/// A narrow and a wide gap determine thickness and modulus of tissue on bone.
#[test]
fn two_specimens_determine_thickness_and_modulus_of_tissue() {
    let shared = skin(0.3, 0.6, 30.0) + "puncture.needle_friction = 0.3\n";
    let second = SyntheticCurve { file: "b.csv", to: 0.4, points: 10, seed: 2, ..PUNCTURE };
    let trial = Trial {
        sought: format!(
            "{shared}[variables]\nsubstrate_modulus_MPa = {{ from = 0.2, to = 1 }}\ntissue_thickness_over_t = {{ from = 1, to = 4 }}\n"
        ),
        skin: format!(
            "{shared}material.substrate_modulus_MPa = 0.5\nsubstrate.tissue_thickness_over_t = 2\n"
        ),
        curves: vec![
            (SyntheticCurve { points: 10, ..PUNCTURE }, ""),
            (second, "gap_over_t = 0.8\n"),
        ],
        truth: vec![0.5, 2.0],
    };
    let fitted = trial.fitted(0, 0.0);
    let values: Vec<_> = fitted.estimates.iter().map(|estimate| estimate.value).collect();
    assert!((values[0] - 0.5).abs() < 1e-4 && (values[1] - 2.0).abs() < 1e-3, "{values:?}");
}

/// Strips with friction have no derivatives while a contact sticks.
///
/// Differences replace them.
#[test]
fn differences_replace_derivatives_while_a_contact_sticks() {
    let shared = "name = 'rubs'\ndesigns.gap_over_t = 0.2\ndesigns.length_over_t = 1\ndesigns.slant_deg = 75\n\
                  material.thickness_mm = 2\nmaterial.membrane_modulus_MPa = 4\n";
    let strip = SyntheticCurve { bending: true, to: 0.03, ..PUNCTURE };
    let trial = Trial {
        sought: format!("{shared}[variables]\nfriction = {{ from = 0.02, to = 0.9 }}\n"),
        skin: format!("{shared}contact.friction = 0.3\n"),
        curves: vec![(strip, "")],
        truth: vec![0.3],
    };
    let fitted = trial.fitted(0, 0.0);
    assert!((fitted.estimates[0].value - 0.3).abs() < 1e-4, "{}", fitted.estimates[0].value);
    assert!(fitted.curves[0].differenced > 0);
}
