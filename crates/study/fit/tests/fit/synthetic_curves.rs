//! Curves made of known skins, with noise.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use fit::{FitDefinition, FitError, Fitted};
use rand::SeedableRng as _;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution as _, Normal};
use run::{Evaluator, WorkMeter};
use sweep::{Case, Sweep};
use tempfile::TempDir;

/// A place for a definition and its curves.
pub struct Place {
    folder: TempDir,
}

/// A curve to be made of a skin: in mm and N, or 1/mm and N mm.
pub struct SyntheticCurve<'a> {
    pub file: &'a str,
    pub bending: bool,
    /// Where it ends, in mm or 1/mm, and how many points it has.
    pub to: f64,
    pub points: usize,
    /// Noise as a part of the largest value.
    pub noise: f64,
    pub seed: u64,
    /// What is added to both columns.
    pub offsets: [f64; 2],
}

impl Place {
    pub fn new() -> Self {
        Self { folder: TempDir::new().expect("a folder") }
    }

    pub fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    pub fn write(&self, file: &str, text: &str) {
        fs::write(self.path(file), text).expect("writable");
    }

    /// Writes the curve that the skin of a definition has.
    pub fn make(&self, skin: &str, curve: &SyntheticCurve) {
        let case = Sweep::parse(skin, "skin.toml", &[]).expect("a skin").grid().case(0);
        let values = exact(&case, curve);
        let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
        let mut random = ChaCha12Rng::seed_from_u64(curve.seed);
        let noise = Normal::new(0.0, curve.noise * largest).expect("a distribution");
        let mut text = if curve.bending {
            "curvature_per_mm,moment_N_mm\n"
        } else {
            "displacement_mm,force_N\n"
        }
        .to_owned();
        for (k, value) in values.iter().enumerate() {
            let [x, y] = [
                place(curve, k) + curve.offsets[0],
                value + curve.offsets[1] + noise.sample(&mut random),
            ];
            writeln!(text, "{x:.9},{y:.12}").expect("a text");
        }
        self.write(curve.file, &text);
    }

    pub fn fit(&self, text: &str) -> Result<Fitted, FitError> {
        self.write("test.toml", text);
        let definition = FitDefinition::read(&self.path("test.toml"), &[]);
        let work = WorkMeter::default();
        let fitted = definition.expect("a definition").fit(&AtomicBool::new(false), &work);
        // The noise of several curves may settle sooner than is foreseen.
        assert!(fitted.is_err() || work.share() > 0.7, "{}", work.share());
        fitted
    }

    pub fn refused(&self, text: &str) -> String {
        self.write("test.toml", text);
        let read = FitDefinition::read(&self.path("test.toml"), &[]);
        let message = read.expect_err("wrong").to_string();
        message.replace(&format!("{}/", self.folder.path().display()), "")
    }
}

fn place(curve: &SyntheticCurve, k: usize) -> f64 {
    curve.to * (k as f64 + 1.0) / curve.points as f64
}

/// The values of a curve, without noise: solved one by one, apart from what a fit does.
fn exact(case: &Case, curve: &SyntheticCurve) -> Vec<f64> {
    use results::Quantity::{Force, Length, Moment, Radius};
    let unit = |quantity: results::Quantity| quantity.physical(1.0, case).expect("a material");
    let evaluator = Evaluator::new(&[]);
    let places = (0..curve.points).map(|k| place(curve, k));
    let (points, unit) = if curve.bending {
        let places: Vec<_> = places.map(|place| place * unit(Radius)).collect();
        (evaluator.moment_curve(case, &[], &places), unit(Moment))
    } else {
        let places: Vec<_> = places.map(|place| place / unit(Length)).collect();
        (evaluator.force_curve(case, &[], &places), unit(Force))
    };
    // A curve ends where its path does, as on the machine.
    let reached = points.expect("a curve").into_iter().map_while(|point| point);
    let values: Vec<_> = reached.map(|point| unit * point.value).collect();
    assert!(values.len() > 8, "too short: {case:?}");
    values
}
