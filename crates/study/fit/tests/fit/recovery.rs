//! What was put into curves comes out of them, as surely as is said.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::time::{Duration, Instant};

use fit::{Estimate, Fitted};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;

use crate::synthetic_curves::{Place, SyntheticCurve};

/// A skin, the same with what is to be found again, and the curves that it has, each with what its table says besides.
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

/// A skin of printed scales on foam under a guided needle.
fn skin(gap: f64, length: f64, slant: f64) -> String {
    format!(
        "name = 'palm'\ndesigns.gap_over_t = {gap}\ndesigns.length_over_t = {length}\ndesigns.slant_deg = {slant}\n\
         puncture.needle = 'guided'\npuncture.load_inset_over_t = 0.05\nmaterial.thickness_mm = 2\n"
    )
}

/// Modulus of the foam and friction of the needle, from one puncture.
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

/// Both moduli and a displacement offset, from two specimens with other gaps and a bent strip.
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

/// Modulus and the place of a load that is free.
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

/// Gap and force offset under a load that is free, and friction between scales, from a puncture.
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

/// The specimen that a curve is of: the skin with the gap that the curve's table says.
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
    /// Makes the curves with noise, a part of the largest value, and finds the skin behind them.
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

/// What came of an unknown of a trial.
enum Came {
    /// It has an interval; whether that holds the truth.
    Interval { holds: bool },
    /// The curves do not tell it.
    Untold,
    /// It stands at an end of its range.
    AtEnd,
}

/// What came of each unknown of a trial, by name.
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
fn curves_without_noise_give_back_what_they_were_made_of() {
    for number in 100..104 {
        let truth = trial(number).truth;
        let fitted = trial(number).fitted(number, 0.0);
        assert!(fitted.untold.is_empty());
        for (estimate, truth) in fitted.estimates.iter().zip(truth) {
            let range = estimate.unknown.to - estimate.unknown.from;
            let off = (estimate.value - truth).abs() / range;
            assert!(off < 1e-5, "{number}: {} is off by {off:e}", estimate.unknown.name);
        }
        assert!(fitted.curves.iter().all(|curve| curve.beyond + curve.differenced == 0));
    }
}

/// How many trials are made with each noise, and for how long they are begun: with `SQUAMA_CAMPAIGNS=endless` a thousand, with `long` those
/// that can be begun in six seconds, else a few.
fn campaign() -> (u64, Duration) {
    match std::env::var("SQUAMA_CAMPAIGNS").as_deref() {
        Ok("endless") => (1000, Duration::MAX),
        Ok("long") => (1000, Duration::from_secs(6)),
        _ => (FEW, Duration::MAX),
    }
}

/// Trials that are always made.
const FEW: u64 = 4;

/// Those of one trial hang together, so that chance makes more of them fail at once than of a coin.
const TOGETHER: f64 = 2.0;

#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
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
            "noise {noise}: {:.2} % of {intervals} intervals of {} trials; hold, miss, untold, at an end:",
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

/// A modulus and a thickness of the membrane, which scale the moment together until scales touch.
#[test]
fn what_cannot_be_told_apart_is_named() {
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
    assert_eq!(fitted.untold, [vec![0, 1]]);
    assert!(fitted.estimates.iter().all(|estimate| estimate.interval.is_none()));
    assert!(fitted.correlations[0][1] < -0.999_999, "{:?}", fitted.correlations);
    // Their product E h³ is what the curve tells.
    let [modulus, thickness] = [0, 1].map(|j| fitted.estimates[j].value);
    assert!((modulus * thickness.powi(3) / (4.0 * 0.1_f64.powi(3)) - 1.0).abs() < 0.02);
    // One of the two alone is told.
    let one = sought.replace(
        "membrane_thickness_over_t = { from = 0.05, to = 0.3 }\n",
        "[flexure]\nmembrane_thickness_over_t = 0.1\n",
    );
    let fitted = place.fit(&one).expect("an answer");
    let [low, high] = fitted.estimates[0].interval.expect("an interval");
    assert!(fitted.untold.is_empty() && low > 3.9 && high < 4.1, "{low} {high}");
}

/// What a curve does not follow at all is said to be so, alone.
#[test]
fn what_no_curve_follows_is_named() {
    let Trial { skin, curves, .. } = trial(0);
    let sought = skin.clone()
        + "[variables]\nmembrane_modulus_MPa = { from = 1, to = 10 }\nfriction = { from = 0, to = 0.5 }\n";
    let trial = Trial { skin, sought, curves, truth: Vec::new() };
    assert!(trial.fitted(0, 0.01).untold.contains(&vec![0]));
}

/// Thickness and modulus of tissue on bone, which a narrow and a wide gap tell apart.
#[test]
fn tissue_is_found_behind_two_specimens() {
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

/// Strips that rub have no derivatives where a contact sticks: differences take their place, and are counted.
#[test]
fn where_something_sticks_differences_are_taken() {
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
