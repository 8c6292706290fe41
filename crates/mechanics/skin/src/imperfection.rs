//! Imperfect rows: random gaps and slants.

use geometry::{OutOfRange, Parallelogram, UnevenRow, clearance};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use sha2::{Digest as _, Sha256};

use crate::{Base, Design};

/// Limit of the slant of single scales to either side, degrees.
const STEEPEST_DEG: f64 = 89.0;

/// Maximum number of draws for a scale that does not overlap its neighbour.
const DRAWS: usize = 100_000;

/// Random scatter of the gaps and slants of a row.
///
/// With independent standard normal numbers `z`, a gap and a slant are
///
/// ```text
/// d_i = d exp(s z − s²/2),   s² = ln(1 + cv²)                                      (I1)
/// α_i = α + sd z'                                                                  (I2)
/// ```
///
/// A gap is log-normal: positive, with mean `d` and coefficient of variation `cv`. Scales must not
/// overlap at rest, so gap and slant of a scale are redrawn together until
///
/// ```text
/// d_i + t (tan α_right − tan α_left) > 0,   |α_i| < 89°                            (I3)
/// ```
///
/// Scales are drawn from the middle of the row outwards, so rows are conditioned on being feasible.
/// If the slants scatter by more than the gap allows (`d < sd/cos² α`), scales lean more to the
/// right on the right of the middle than on its left, and with much larger scatter no feasible row
/// is found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Imperfection {
    /// Coefficient of variation `cv` of the gaps.
    pub gap_cv: f64,
    /// Standard deviation of the slants, degrees.
    pub slant_sd_deg: f64,
}

impl Imperfection {
    /// Returns true if nothing scatters.
    pub fn is_none(&self) -> bool {
        self.gap_cv == 0.0 && self.slant_sd_deg == 0.0
    }

    /// Returns sample `number` of the rows of `design`.
    ///
    /// A sample depends only on the seed, the number and the geometry of the design, not on the
    /// machine, the thread or the order of drawing. The normal deviates do not depend on the amount
    /// of scatter: another `cv` or `sd` scales the same deviates, except where (I3) rejects them.
    ///
    /// # Errors
    /// If a number is negative or not finite, or the design has no geometrical meaning.
    pub fn sample(&self, design: &Design, seed: u64, number: u64) -> Result<Sample, OutOfRange> {
        self.drawn(design, key(Some(design), seed, number))
    }

    /// Returns a sample with normal deviates that do not depend on the design either.
    ///
    /// Samples of the same number then differ between designs only through the designs themselves.
    ///
    /// # Errors
    /// As [`Self::sample`].
    pub fn common_sample(
        &self,
        design: &Design,
        seed: u64,
        number: u64,
    ) -> Result<Sample, OutOfRange> {
        self.drawn(design, key(None, seed, number))
    }

    fn drawn(&self, design: &Design, key: [u8; 32]) -> Result<Sample, OutOfRange> {
        let rules = [
            ("coefficient of variation of the gaps", self.gap_cv),
            ("standard deviation of the slants", self.slant_sd_deg),
        ];
        for (quantity, value) in rules {
            let is_legal = value >= 0.0 && value.is_finite();
            OutOfRange::unless(is_legal, quantity, value, "a number of at least 0")?;
        }
        // Reject an invalid design now; the row is not needed.
        design.row()?;
        Ok(Sample { imperfection: *self, design: *design, key })
    }
}

/// Derives the random key of a sample, for one design or for all.
fn key(design: Option<&Design>, seed: u64, number: u64) -> [u8; 32] {
    let numbers = design.into_iter().flat_map(|design| {
        // `L` and `2L` are different designs with separate samples.
        let base = match design.base {
            Base::L => 1.0,
            Base::TwoL => 2.0,
        };
        [design.gap, design.length, design.slant_deg, base, design.width]
    });
    // Adding zero below turns −0 into +0, which has other bits; the same design would get other
    // samples.
    let mut digest = Sha256::new();
    for word in [seed, number].into_iter().chain(numbers.map(|x| (x + 0.0).to_bits())) {
        // Fix the byte order, so that a sample is the same on every machine.
        digest.update(word.to_le_bytes());
    }
    digest.finalize().into()
}

/// One imperfect row of any length.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    imperfection: Imperfection,
    design: Design,
    key: [u8; 32],
}

/// Random stream of a part of a row.
#[derive(Clone, Copy)]
enum Stream {
    Centre,
    Right,
    Left,
}

impl Sample {
    /// Builds the row with `left` and `right` scales beside the centre.
    ///
    /// A longer row has the same scales in its middle.
    ///
    /// # Errors
    /// If no scale is found that does not overlap its neighbour.
    pub fn row(&self, left: usize, right: usize) -> Result<UnevenRow, OutOfRange> {
        let centre = self.centre()?;
        let to_right = self.side(Stream::Right, centre, right)?;
        let mut to_left = self.side(Stream::Left, centre, left)?;
        // Scales were drawn from the centre outwards, but a row is listed from the left.
        to_left.reverse();
        let scales = to_left.iter().map(|(scale, _)| *scale).chain([centre]);
        let scales = scales.chain(to_right.iter().map(|(scale, _)| *scale)).collect();
        let gaps = to_left.iter().chain(&to_right).map(|(_, gap)| *gap).collect();
        UnevenRow::new(scales, gaps)
    }

    fn centre(&self) -> Result<Parallelogram, OutOfRange> {
        let mut random = self.random(Stream::Centre);
        // The centre needs no gap: each gap is drawn with the scale on its outer side.
        let drawn = (0..DRAWS).find_map(|_| self.slanted(normal(&mut random)));
        drawn.ok_or_else(|| self.crowded())
    }

    /// Draws the scales on one side, from the centre outwards, each with its inner gap.
    fn side(
        &self,
        stream: Stream,
        centre: Parallelogram,
        count: usize,
    ) -> Result<Vec<(Parallelogram, f64)>, OutOfRange> {
        let mut random = self.random(stream);
        let mut last = centre;
        let mut side = Vec::with_capacity(count);
        for _ in 0..count {
            let drawn = (0..DRAWS).find_map(|_| self.next(&mut random, stream, &last));
            let (scale, gap) = drawn.ok_or_else(|| self.crowded())?;
            side.push((scale, gap));
            last = scale;
        }
        Ok(side)
    }

    /// Draws a scale beside `last` and the gap; `None` if they overlap (I3).
    fn next(
        &self,
        random: &mut ChaCha8Rng,
        stream: Stream,
        last: &Parallelogram,
    ) -> Option<(Parallelogram, f64)> {
        // Draw both numbers before checking: a rejected draw must consume as many numbers as an
        // accepted one.
        let (for_gap, for_slant) = (normal(random), normal(random));
        let gap = self.gap(for_gap);
        let scale = self.slanted(for_slant)?;
        let between = match stream {
            Stream::Left => clearance(&scale, last, gap),
            Stream::Centre | Stream::Right => clearance(last, &scale, gap),
        };
        (between > 0.0).then_some((scale, gap))
    }

    /// Computes a gap by (I1).
    fn gap(&self, z: f64) -> f64 {
        // Log-normal: no gap is negative, and the mean is the gap of the design.
        let variance = self.imperfection.gap_cv.powi(2).ln_1p();
        self.design.gap * (variance.sqrt() * z - 0.5 * variance).exp()
    }

    /// Computes a slant by (I2); `None` if the scale leans too far.
    fn slanted(&self, z: f64) -> Option<Parallelogram> {
        let slant = self.design.slant_deg + self.imperfection.slant_sd_deg * z;
        // A design may itself be steeper than the limit: without scatter its slant is kept.
        let leans_too_far = slant.abs() >= STEEPEST_DEG && self.imperfection.slant_sd_deg > 0.0;
        let scale = Parallelogram::leaning(self.design.half_base(), slant).ok();
        scale.filter(|_| !leans_too_far)
    }

    fn random(&self, stream: Stream) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::from_seed(self.key);
        // Separate streams per side, so that a row growing on one side keeps the scales of the
        // other.
        random.set_stream(stream as u64);
        random
    }

    fn crowded(&self) -> OutOfRange {
        OutOfRange {
            quantity: "standard deviation of the slants",
            value: self.imperfection.slant_sd_deg,
            expected: "a smaller value, so that scales do not overlap",
        }
    }
}

fn normal(random: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(random)
}
