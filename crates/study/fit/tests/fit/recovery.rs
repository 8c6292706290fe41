//! Fits recover the parameters of synthetic curves, within the reported intervals.

use std::fmt::Write as _;
use std::ops::Range;

use fit::Fitted;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;
use run::Evaluator;
use sweep::{Parameter, Sweep};

use crate::synthetic_curves::{Place, SyntheticCurve};

/// A skin with known parameters, and a fit that should recover some of them.
struct Trial {
    /// Definition of the skin, with the true values.
    skin: String,
    /// Definition of the fit, with `[variables]` instead of the true values.
    sought: String,
    /// Synthetic curves, with further keys of their `[[curve]]` tables.
    curves: Vec<(SyntheticCurve<'static>, &'static str)>,
    /// True values of the unknowns.
    truth: Vec<f64>,
}

const PUNCTURE: SyntheticCurve<'_> = SyntheticCurve {
    file: "a.csv",
    bending: false,
    to: 0.5,
    points: 60,
    noise: 0.0,
    correlation: 0.0,
    seed: 1,
    offsets: [0.0; 2],
};

const STRIP: SyntheticCurve<'_> =
    SyntheticCurve { file: "c.csv", bending: true, to: 0.03, points: 60, seed: 3, ..PUNCTURE };

/// Returns a definition of scales with a thickness of 2 mm.
fn scales(gap: f64, length: f64, slant: f64) -> String {
    format!(
        "name = 'palm'\ndesigns.gap_over_t = {gap}\ndesigns.length_over_t = {length}\n\
         designs.slant_deg = {slant}\nmaterial.thickness_mm = 2\n"
    )
}

/// Returns a definition of scales with a thickness of 2 mm under a guided needle.
fn skin(gap: f64, length: f64, slant: f64) -> String {
    scales(gap, length, slant) + "puncture.needle = 'guided'\npuncture.load_inset_over_t = 0.05\n"
}

/// Unknown parameter: its key, the range of its true values, and the range of the fit.
type Sought = (&'static str, Range<f64>, [f64; 2]);

const MODULUS: Sought = ("material.substrate_modulus_MPa", 0.2..1.0, [0.05, 2.0]);

impl Trial {
    /// Creates a trial with random true values of the unknowns.
    ///
    /// The definitions of skin and fit both begin with `shared`.
    fn new(
        random: &mut ChaCha12Rng,
        shared: &str,
        unknowns: &[Sought],
        curves: &[(SyntheticCurve<'static>, &'static str)],
    ) -> Self {
        let (mut skin, mut sought, mut truth) = (String::new(), String::new(), Vec::new());
        for (key, values, [from, to]) in unknowns {
            let value = random.random_range(values.clone());
            let name = key.split('.').next_back().unwrap_or(key);
            let success = "writing to a string succeeds";
            writeln!(skin, "{key} = {value}").expect(success);
            writeln!(sought, "{name} = {{ from = {from}, to = {to} }}").expect(success);
            truth.push(value);
        }
        Self {
            skin: format!("{shared}{skin}"),
            sought: format!("{shared}[variables]\n{sought}"),
            curves: curves.to_vec(),
            truth,
        }
    }
}

fn modulus_alone(random: &mut ChaCha12Rng) -> Trial {
    let shared = skin(0.2, 0.8, 60.0) + "puncture.needle_friction = 0.3\n";
    Trial::new(random, &shared, &[MODULUS], &[(PUNCTURE, "")])
}

/// Creates a trial with an unknown gap. Many of these gaps do not close within the curve.
fn modulus_and_gap(random: &mut ChaCha12Rng) -> Trial {
    let shared = skin(0.2, 0.8, 45.0) + "puncture.needle_friction = 0.3\n";
    let shared = shared.replace("designs.gap_over_t = 0.2\n", "");
    let gap = ("designs.gap_over_t", 0.1..0.8, [0.05, 2.0]);
    Trial::new(random, &shared, &[MODULUS, gap], &[(PUNCTURE, "")])
}

fn modulus_and_needle_radius(random: &mut ChaCha12Rng) -> Trial {
    let shared = skin(0.2, 0.8, 45.0) + "puncture.needle_friction = 0.3\n";
    let radius = ("puncture.needle_radius_over_t", 0.05..1.0, [0.02, 2.0]);
    Trial::new(random, &shared, &[MODULUS, radius], &[(PUNCTURE, "")])
}

fn modulus_and_needle_friction(random: &mut ChaCha12Rng) -> Trial {
    let friction = ("puncture.needle_friction", 0.15..0.5, [0.02, 0.9]);
    Trial::new(random, &skin(0.2, 0.8, 60.0), &[MODULUS, friction], &[(PUNCTURE, "")])
}

fn modulus_and_tissue_thickness(random: &mut ChaCha12Rng) -> Trial {
    let shared = skin(0.3, 0.8, 45.0) + "puncture.needle_friction = 0.3\n";
    let thickness = ("substrate.tissue_thickness_over_t", 1.0..6.0, [0.5, 12.0]);
    Trial::new(random, &shared, &[MODULUS, thickness], &[(PUNCTURE, "")])
}

/// Creates a trial of bending in which only the moments after contact separate both unknowns.
fn modulus_and_membrane_thickness(random: &mut ChaCha12Rng) -> Trial {
    let modulus = ("material.membrane_modulus_MPa", 2.0..8.0, [0.5, 20.0]);
    let thickness = ("flexure.membrane_thickness_over_t", 0.06..0.25, [0.03, 0.5]);
    let strip = SyntheticCurve { to: 0.04, ..STRIP };
    Trial::new(random, &scales(0.2, 1.0, 60.0), &[modulus, thickness], &[(strip, "")])
}

/// Creates a trial with two unknown moduli and a displacement offset.
///
/// The curves are two punctures of different gaps and a bending test.
fn both_moduli_and_an_offset(random: &mut ChaCha12Rng) -> Trial {
    let shared = skin(0.2, 1.0, 45.0) + "puncture.needle_friction = 0.3\n";
    let membrane = ("material.membrane_modulus_MPa", 2.0..8.0, [0.5, 20.0]);
    let offset = random.random_range(-0.05..0.08);
    let second =
        SyntheticCurve { file: "b.csv", to: 0.6, offsets: [offset, 0.0], seed: 2, ..PUNCTURE };
    let curves =
        [(PUNCTURE, ""), (second, "gap_over_t = 0.4\noffsets = ['displacement']\n"), (STRIP, "")];
    let mut trial = Trial::new(random, &shared, &[MODULUS, membrane], &curves);
    trial.truth.push(offset);
    trial
}

fn modulus_and_load_position(random: &mut ChaCha12Rng) -> Trial {
    let position = ("puncture.load_position", 0.7..0.95, [0.55, 1.0]);
    Trial::new(random, &scales(0.3, 0.6, 30.0), &[MODULUS, position], &[(PUNCTURE, "")])
}

/// Creates a trial with unknown gap, scale friction and force offset, under a free needle.
fn gap_and_friction(random: &mut ChaCha12Rng) -> Trial {
    let offset = random.random_range(-0.02..0.02);
    let shared = "name = 'free'\ndesigns.length_over_t = 1\ndesigns.slant_deg = 60\n\
                  material.thickness_mm = 1\nmaterial.substrate_modulus_MPa = 0.3\n";
    let curve = SyntheticCurve { to: 0.4, offsets: [0.0, offset], ..PUNCTURE };
    let unknowns = [
        ("designs.gap_over_t", 0.15..0.3, [0.08, 0.5]),
        ("contact.friction", 0.05..0.4, [0.01, 0.8]),
    ];
    let mut trial = Trial::new(random, shared, &unknowns, &[(curve, "offsets = ['force']\n")]);
    trial.truth.push(offset);
    trial
}

/// Returns the definition of a skin with the gap that the keys of a curve set, if any.
fn specimen(skin: &str, keys: &str) -> String {
    let Some(own) = keys.lines().find(|line| line.starts_with("gap_over_t")) else {
        return skin.to_owned();
    };
    let lines = skin.lines().map(|line| {
        if line.starts_with("designs.gap_over_t") {
            format!("designs.{own}\n")
        } else {
            format!("{line}\n")
        }
    });
    lines.collect()
}

/// Result of a fit, and how it compares with the true values.
struct Outcome {
    fitted: Fitted,
    /// `2 ln L` of the true values minus `2 ln L` of the fitted values.
    ///
    /// A positive value shows that the fit missed the best minimum.
    excess: f64,
}

impl Trial {
    /// Fits synthetic curves with random noise; `number` is its seed.
    ///
    /// `noise` is the standard deviation divided by the largest value of the curve, `correlation`
    /// the correlation of neighbouring points.
    fn outcome(&self, number: u64, [noise, correlation]: [f64; 2]) -> Outcome {
        let place = Place::new();
        let mut text = self.sought.clone();
        let mut squares = Vec::new();
        for (curve, keys) in &self.curves {
            let kind = if curve.bending { "bending" } else { "puncture" };
            let curve =
                SyntheticCurve { noise, correlation, seed: 10 * number + curve.seed, ..*curve };
            squares.push(place.make(&specimen(&self.skin, keys), &curve));
            let file = curve.file;
            write!(text, "[[curve]]\nfile = '{file}'\nkind = '{kind}'\n{keys}")
                .expect("writing to a string succeeds");
        }
        let fitted = place.fit(&text).expect("a fit");
        let excess = fitted.curves.iter().zip(squares).map(|(curve, true_squares)| {
            let squares: f64 = curve.points.iter().map(|[_, y, fitted]| (y - fitted).powi(2)).sum();
            curve.points.len() as f64 * (squares / true_squares).ln()
        });
        Outcome { excess: excess.sum(), fitted }
    }

    fn fitted(&self, number: u64, noise: f64) -> Fitted {
        self.outcome(number, [noise, 0.0]).fitted
    }
}

/// Function that creates a random trial.
type Draw = fn(&mut ChaCha12Rng) -> Trial;

const KINDS: [(&str, Draw); 9] = [
    ("modulus", modulus_alone),
    ("modulus, gap", modulus_and_gap),
    ("modulus, needle radius", modulus_and_needle_radius),
    ("modulus, needle friction", modulus_and_needle_friction),
    ("modulus, tissue thickness", modulus_and_tissue_thickness),
    ("modulus, membrane thickness", modulus_and_membrane_thickness),
    ("moduli, offset", both_moduli_and_an_offset),
    ("modulus, load position", modulus_and_load_position),
    ("gap, friction, offset", gap_and_friction),
];

fn trial(kind: usize, number: u64) -> Trial {
    KINDS[kind].1(&mut ChaCha12Rng::seed_from_u64(number))
}

/// Counts over the trials of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Counts {
    /// Intervals that contain the true value: two-sided, one-sided and undetermined ones.
    hold: [usize; 3],
    /// Intervals that do not contain the true value.
    miss: usize,
    /// Trials in which the true values are better by more than 3.84 in `2 ln L`.
    false_minima: usize,
    /// Number of solved skins.
    solutions: usize,
}

impl Counts {
    fn add(self, other: Self) -> Self {
        Self {
            hold: [0, 1, 2].map(|k| self.hold[k] + other.hold[k]),
            miss: self.miss + other.miss,
            false_minima: self.false_minima + other.false_minima,
            solutions: self.solutions + other.solutions,
        }
    }
}

fn counted(kind: usize, number: u64, noise: [f64; 2]) -> Counts {
    let trial = trial(kind, number);
    let Outcome { fitted, excess } = trial.outcome(number, noise);
    let mut counts = Counts {
        false_minima: usize::from(excess > 3.84),
        solutions: fitted.solutions,
        ..Counts::default()
    };
    for (estimate, truth) in fitted.estimates.iter().zip(&trial.truth) {
        let [low, high] = estimate.interval;
        let holds = low.is_none_or(|low| low <= *truth) && high.is_none_or(|high| *truth <= high);
        let open = usize::from(low.is_none()) + usize::from(high.is_none());
        if holds {
            counts.hold[open] += 1;
        } else {
            counts.miss += 1;
        }
        if std::env::var_os("SQUAMA_MISSES").is_some() && (!holds || excess > 3.84) {
            println!(
                "{} points, kind {kind} number {number}: {} truth {truth} value {} interval {low:?} {high:?} excess {excess}",
                fitted.curves[0].points.len(),
                estimate.unknown.name,
                estimate.value
            );
        }
    }
    counts
}

#[test]
fn fits_of_exact_curves_recover_the_parameters() {
    // Kind 4, the tissue thickness, is slow. The test
    // `two_specimens_determine_thickness_and_modulus_of_tissue` covers the tissue.
    let step = if campaign()[0] == 0 { 2 } else { 1 };
    let kinds = KINDS.iter().enumerate().filter(|(kind, _)| *kind != 4);
    for (kind, (name, _)) in kinds.step_by(step) {
        let trial = trial(kind, 100);
        let fitted = trial.fitted(100, 0.0);
        assert!(fitted.undetermined.is_empty(), "{name}");
        for (estimate, truth) in fitted.estimates.iter().zip(&trial.truth) {
            let range = estimate.unknown.to - estimate.unknown.from;
            let off = (estimate.value - truth).abs() / range;
            assert!(off < 1e-5, "{name}: {} is off by {off:e}", estimate.unknown.name);
        }
        assert!(fitted.curves.iter().all(|curve| curve.beyond + curve.differenced == 0), "{name}");
    }
}

/// Returns the number of trials of each kind for the noise of 1, 3 and 10 %.
///
/// `SQUAMA_CAMPAIGNS=endless` runs all trials of `docs/fit.md`, `long` a twentieth of them.
fn campaign() -> [u64; 3] {
    match std::env::var("SQUAMA_CAMPAIGNS").as_deref() {
        Ok("endless") => [60, 200, 60],
        Ok("long") => [3, 10, 3],
        _ => [0, 1, 0],
    }
}

/// Kinds of trials that take more than 10 s each; only campaigns run them.
const SLOW_KINDS: [usize; 2] = [4, 8];

/// Checks that 95 % intervals contain the true values in trials with independent noise.
fn check_coverage(kind: usize) {
    let (name, _) = KINDS[kind];
    if SLOW_KINDS.contains(&kind) && campaign()[0] == 0 {
        return;
    }
    for (noise, trials) in [0.01, 0.03, 0.1].into_iter().zip(campaign()) {
        let first = u64::from(trials == 1);
        let numbers = (first..first + trials).into_par_iter();
        let counts = numbers.map(|number| counted(kind, number, [noise, 0.0]));
        let counts = counts.reduce(Counts::default, Counts::add);
        let Counts { hold, miss, false_minima, .. } = counts;
        let intervals = hold.iter().sum::<usize>() + miss;
        println!("{noise} {name}: {counts:?}");
        // Expect 5 % of misses, and allow three standard deviations of a binomial distribution. A
        // single trial must have no misses.
        let expected = 0.05 * intervals as f64;
        let allowed = if trials > 1 { expected + 3.0 * expected.sqrt() + 1.0 } else { 0.0 };
        assert!(miss as f64 <= allowed, "{name}: {miss}");
        assert!(false_minima as f64 <= 0.01 * trials as f64 + 1.0, "{name}: {false_minima}");
    }
}

#[test]
fn intervals_cover_a_modulus() {
    check_coverage(0);
}

#[test]
fn intervals_cover_a_modulus_and_a_gap() {
    check_coverage(1);
}

#[test]
fn intervals_cover_a_modulus_and_a_needle_radius() {
    check_coverage(2);
}

#[test]
fn intervals_cover_a_modulus_and_a_needle_friction() {
    check_coverage(3);
}

#[test]
fn intervals_cover_a_modulus_and_a_tissue_thickness() {
    check_coverage(4);
}

#[test]
fn intervals_cover_a_modulus_and_a_membrane_thickness() {
    check_coverage(5);
}

#[test]
fn intervals_cover_two_moduli_and_an_offset() {
    check_coverage(6);
}

#[test]
fn intervals_cover_a_modulus_and_a_load_position() {
    check_coverage(7);
}

#[test]
fn intervals_cover_a_gap_a_friction_and_an_offset() {
    check_coverage(8);
}

/// Correlated points must count as fewer independent points.
///
/// Only campaigns test a correlation of 0.5, because ten trials are too few to detect its misses.
#[test]
fn intervals_cover_the_truth_under_correlated_noise() {
    let trials = 10 + campaign()[1] / 2;
    let weak = (campaign()[1] > 1).then_some(0.5);
    for correlation in weak.into_iter().chain([0.8]) {
        let counts = (0..trials).into_par_iter().map(|k| counted(0, k, [0.03, correlation]));
        let counts = counts.reduce(Counts::default, Counts::add);
        println!("correlation {correlation}: {counts:?}");
        // Intervals that assume independent noise miss the true value in a fifth of the trials at
        // a correlation of 0.5, and in half of them at 0.8.
        assert!(counts.miss as f64 <= 0.15 * trials as f64 + 1.0, "{correlation}: {counts:?}");
    }
}

/// The curve is the same for all gaps that do not close, so no upper end can be determined.
#[test]
fn a_gap_that_never_closes_has_a_one_sided_interval() {
    let trial = modulus_and_gap(&mut ChaCha12Rng::seed_from_u64(2));
    let shared = trial.skin.lines().filter(|line| !line.starts_with("designs.gap_over_t"));
    let skin = shared.collect::<Vec<_>>().join("\n") + "\ndesigns.gap_over_t = 0.9\n";
    let fitted = Trial { skin, ..trial }.fitted(1, 0.01);
    let gap = &fitted.estimates[1];
    let [low, high] = gap.interval;
    assert!(high.is_none() && low.is_some_and(|low| low > 0.3 && low < 0.9), "{gap:?}");
    assert!(fitted.undetermined.is_empty());
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
    let strip = SyntheticCurve { to: 0.005, points: 30, noise: 0.01, file: "a.csv", ..STRIP };
    place.make(&skin, &strip);
    let sought = format!(
        "{shared}[variables]\nmembrane_modulus_MPa = {{ from = 1, to = 10 }}\nmembrane_thickness_over_t = {{ from = 0.05, to = 0.3 }}\n\
         [[curve]]\nfile = 'a.csv'\nkind = 'bending'\n"
    );
    let fitted = place.fit(&sought).expect("a fit");
    assert_eq!(fitted.undetermined, [vec![0, 1]]);
    // The interval of the thickness ends where the modulus reaches its bounds.
    assert_eq!(fitted.estimates[0].interval, [None; 2]);
    assert_eq!(fitted.estimates[1].depends_on_range_of, [0]);
    let [thinnest, thickest] = fitted.estimates[1].interval.map(|end| end.expect("an end"));
    assert!((thinnest * 2.5_f64.cbrt() / 0.1 - 1.0).abs() < 0.03, "{thinnest}");
    assert!((thickest / 4.0_f64.cbrt() / 0.1 - 1.0).abs() < 0.03, "{thickest}");
    assert!(fitted.correlations[0][1] < -0.999_999, "{:?}", fitted.correlations);
    // The curve determines the product E h³.
    let [modulus, thickness] = [0, 1].map(|j| fitted.estimates[j].value);
    assert!((modulus * thickness.powi(3) / (4.0 * 0.1_f64.powi(3)) - 1.0).abs() < 0.02);
    // If the thickness is known, the curve determines the modulus.
    let one = sought.replace(
        "membrane_thickness_over_t = { from = 0.05, to = 0.3 }\n",
        "[flexure]\nmembrane_thickness_over_t = 0.1\n",
    );
    let fitted = place.fit(&one).expect("a fit");
    let [low, high] = fitted.estimates[0].interval.map(|end| end.expect("an end"));
    assert!(fitted.undetermined.is_empty() && low > 3.9 && high < 4.1, "{low} {high}");
}

/// The membrane modulus does not influence a puncture curve, so it is undetermined on its own.
#[test]
fn unknowns_without_influence_are_undetermined() {
    let Trial { skin, curves, .. } = trial(3, 0);
    let sought = skin.clone()
        + "[variables]\nmembrane_modulus_MPa = { from = 1, to = 10 }\nfriction = { from = 0, to = 0.5 }\n";
    let trial = Trial { skin, sought, curves, truth: Vec::new() };
    assert!(trial.fitted(0, 0.01).undetermined.contains(&vec![0]));
}

/// Two specimens, with a narrow and a wide gap, determine thickness and modulus of their tissue.
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

/// In bending with friction, the path has no derivatives while a contact sticks.
#[test]
fn differences_replace_derivatives_while_a_contact_sticks() {
    let shared = "name = 'rubs'\ndesigns.gap_over_t = 0.2\ndesigns.length_over_t = 1\ndesigns.slant_deg = 75\n\
                  material.thickness_mm = 2\nmaterial.membrane_modulus_MPa = 4\n";
    let trial = Trial {
        sought: format!("{shared}[variables]\nfriction = {{ from = 0.02, to = 0.9 }}\n"),
        skin: format!("{shared}contact.friction = 0.3\n"),
        curves: vec![(SyntheticCurve { points: 40, ..STRIP }, "")],
        truth: vec![0.3],
    };
    let fitted = trial.fitted(0, 0.0);
    assert!((fitted.estimates[0].value - 0.3).abs() < 1e-4, "{}", fitted.estimates[0].value);
    assert!(fitted.curves[0].differenced > 0);
}

/// With friction between scales, the unloading force is smaller than the loading force.
#[test]
fn loading_and_unloading_branches_are_fitted() {
    let place = Place::new();
    let shared = "name = 'loop'\ndesigns.gap_over_t = 0.2\ndesigns.length_over_t = 0.8\n\
                  designs.slant_deg = 45\n";
    let skin = format!("{shared}contact.friction = 0.3\n");
    let case = Sweep::parse(&skin, "skin.toml", &[]).expect("a skin").grid().case(0);
    let evaluator = Evaluator::new(&[]);
    let places: Vec<_> = (1..=10).map(|k| 0.04 * f64::from(k)).collect();
    let back: Vec<_> = places.iter().rev().skip(1).copied().collect();
    let loading = evaluator.force_curve(&case, &[], &places).expect("a curve");
    let unloading = evaluator.unloading_force_curve(&case, 0.4, &back).expect("a curve");
    let forces: Vec<f64> = loading
        .iter()
        .chain(&unloading)
        .map(|point| point.as_ref().map_or(0.0, |point| point.value))
        .collect();
    assert!(forces[places.len() + 4] < 0.9 * forces[4], "{forces:?}");
    let mut text = "displacement,force\n".to_owned();
    for (x, force) in places.iter().chain(&back).zip(forces) {
        writeln!(text, "{x},{force}").expect("writing to a string succeeds");
    }
    place.write("a.csv", &text);
    let variables = "[variables]\nfriction = { from = 0.02, to = 0.9 }\n";
    let curve = "[[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n";
    for (unload, branch, points) in [
        ("", "", 10),
        ("", "branch = 'both'\n", 19),
        ("", "branch = 'unloading'\n", 9),
        ("puncture.unload = true\n", "", 19),
    ] {
        let text = format!("{shared}{unload}{variables}{curve}{branch}");
        let fitted = place.fit(&text).expect("a fit");
        let friction = fitted.estimates[0].value;
        assert!((friction - 0.3).abs() < 1e-3, "{unload}{branch}: {friction}");
        assert_eq!(fitted.curves[0].points.len(), points, "{unload}{branch}");
    }
}

/// Each specimen has its own modulus; the friction of the needle is the same for all specimens.
#[test]
fn a_parameter_may_differ_from_specimen_to_specimen() {
    let place = Place::new();
    let shared = skin(0.2, 0.8, 60.0);
    let moduli = [0.40, 0.45, 0.52, 0.58];
    let mut curves = String::new();
    for (k, modulus) in (0..).zip(moduli) {
        let skin = format!(
            "{shared}material.substrate_modulus_MPa = {modulus}\npuncture.needle_friction = 0.3\n"
        );
        let file = ["a.csv", "b.csv", "c.csv", "d.csv"][k as usize];
        let curve = SyntheticCurve { file, points: 20, noise: 0.01, seed: k, ..PUNCTURE };
        place.make(&skin, &curve);
        writeln!(curves, "[[curve]]\nfile = '{file}'\nkind = 'puncture'")
            .expect("writing to a string succeeds");
    }
    let sought = format!(
        "per_specimen = ['substrate_modulus_MPa']\n{shared}[variables]\n\
         substrate_modulus_MPa = {{ from = 0.05, to = 2 }}\n\
         needle_friction = {{ from = 0.02, to = 0.9 }}\n{curves}"
    );
    let fitted = place.fit(&sought).expect("a fit");
    assert_eq!(fitted.estimates.len(), 5);
    assert_eq!(fitted.estimates[1].unknown.name, "substrate_modulus_MPa of b.csv");
    for (estimate, modulus) in fitted.estimates.iter().zip(moduli) {
        assert!((estimate.value / modulus - 1.0).abs() < 0.1, "{estimate:?}");
    }
    let scatter = &fitted.scatter[0];
    assert_eq!(scatter.specimens, [0, 1, 2, 3]);
    let mean = fitted.estimates[..4].iter().map(|estimate| estimate.value).sum::<f64>() / 4.0;
    assert!((scatter.mean - mean).abs() < 1e-12);
    // The standard deviation of the true moduli is 0.0793.
    let [low, high] = scatter.deviation_interval;
    assert!((scatter.deviation - 0.0793).abs() < 0.02 && low < 0.0793 && high > 0.0793);
    // The fitted definition has the mean modulus of the specimens.
    let case = fitted.sweep.grid().case(0);
    let modulus = Parameter::named("substrate_modulus_MPa").expect("a parameter").get(&case);
    assert!((modulus.number().expect("a number") - mean).abs() < 1e-12);
    assert_eq!((fitted.means.len(), fitted.means[0].files.len()), (1, 4));
}
