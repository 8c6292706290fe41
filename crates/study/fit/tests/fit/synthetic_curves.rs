//! Synthetic test curves: computed curves of known skins, with added noise.

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

/// Temporary folder for a definition and its curves.
pub struct Place {
    folder: TempDir,
}

/// A synthetic curve, in mm and N or in 1/mm and N mm.
#[derive(Clone, Copy)]
pub struct SyntheticCurve<'a> {
    pub file: &'a str,
    pub bending: bool,
    /// Last displacement in mm, or last curvature in 1/mm.
    pub to: f64,
    /// Number of points, equally spaced up to `to`.
    pub points: usize,
    /// Standard deviation of the noise, as a fraction of the largest value.
    pub noise: f64,
    /// Correlation of the noise of neighbouring points.
    pub correlation: f64,
    pub seed: u64,
    /// Offset added to each column.
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

    /// Writes the curve of a skin, with noise, to a file. Returns the sum of the squared noise.
    pub fn make(&self, skin: &str, curve: &SyntheticCurve) -> f64 {
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
        let (mut squares, mut error) = (0.0, 0.0);
        for (k, value) in values.iter().enumerate() {
            // Autoregressive noise. The factor `share` makes its standard deviation independent of
            // the correlation.
            let share = if k == 0 { 1.0 } else { (1.0 - curve.correlation.powi(2)).sqrt() };
            error = curve.correlation * error + share * noise.sample(&mut random);
            squares += error * error;
            let [x, y] = [place(curve, k) + curve.offsets[0], value + curve.offsets[1] + error];
            writeln!(text, "{x:.9},{y:.12}").expect("writing to a string succeeds");
        }
        self.write(curve.file, &text);
        squares
    }

    pub fn fit(&self, text: &str) -> Result<Fitted, FitError> {
        self.write("test.toml", text);
        let definition = FitDefinition::read(&self.path("test.toml"), &[]);
        let work = WorkMeter::default();
        let fitted = definition.expect("a definition").fit(&AtomicBool::new(false), &work);
        // Progress may end below 1, because the noise of several curves may converge faster than
        // predicted.
        assert!(
            fitted.is_err() || work.completed_fraction() > 0.5,
            "{}",
            work.completed_fraction()
        );
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

/// Computes the curve without noise, independently of `FitDefinition`.
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
    // Write no points beyond the end of the path.
    let reached = points.expect("a curve").into_iter().map_while(|point| point);
    let values: Vec<_> = reached.map(|point| unit * point.value).collect();
    assert!(values.len() > 8, "too short: {case:?}");
    values
}
