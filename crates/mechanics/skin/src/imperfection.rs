//! Imperfect rows: rows with random gaps and slants.

use geometry::{OutOfRange, Parallelogram, UnevenRow, clearance};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use sha2::{Digest as _, Sha256};

use crate::{Base, Design};

/// Upper limit of the magnitude of a random slant, degrees.
const STEEPEST_DEG: f64 = 89.0;

/// Maximum number of draws of one scale; a draw that overlaps the neighbour is rejected.
const DRAWS: usize = 100_000;

/// Random scatter of the gaps and slants of a row.
///
/// With independent standard normal numbers `z` and `z'`, a gap and a slant are
///
/// ```text
/// d_i = d exp(s z − s²/2),   s² = ln(1 + cv²)                                      (I1)
/// α_i = α + sd z'                                                                  (I2)
/// ```
///
/// A gap is log-normal: positive, with mean `d` and coefficient of variation `cv`. A slant is
/// normal, with mean `α` and standard deviation `sd`. Scales must not overlap at rest, so gap and
/// slant of a scale are redrawn together until
///
/// ```text
/// d_i + t (tan α_right − tan α_left) > 0,   |α_i| < 89°                            (I3)
/// ```
///
/// Scales are drawn one after the other from the middle of the row outwards, each so that (I3)
/// holds. If the slants scatter by more than the gap allows (`d < sd/cos² α`), these rejections
/// bias the row: slants increase from its left end to its right end. With much larger scatter no
/// row that satisfies (I3) is found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Imperfection {
    /// Coefficient of variation `cv` of the gaps.
    pub gap_cv: f64,
    /// Standard deviation of the slants, degrees.
    pub slant_sd_deg: f64,
}

impl Imperfection {
    /// Returns true if neither gaps nor slants scatter.
    pub fn is_none(&self) -> bool {
        self.gap_cv == 0.0 && self.slant_sd_deg == 0.0
    }

    /// Returns the imperfect row with this sample `number` for `design`.
    ///
    /// A sample depends only on the seed, the number and the geometry of the design, not on the
    /// machine, the thread or the order in which samples are drawn. The normal deviates do not
    /// depend on the amount of scatter: another `cv` or `sd` multiplies the same deviates, except
    /// after draws that (I3) rejects.
    ///
    /// # Errors
    /// If `cv` or `sd` is negative or not finite, or the geometry of the design is invalid.
    pub fn sample(&self, design: &Design, seed: u64, number: u64) -> Result<Sample, OutOfRange> {
        self.drawn(design, key(Some(design), seed, number))
    }

    /// Returns a sample with normal deviates that depend only on `seed` and `number`.
    ///
    /// Unlike [`Self::sample`], all designs share the deviates of a sample number, which reduces
    /// the noise of comparisons between designs.
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
        // Building the perfect row rejects an invalid design; the row itself is not needed.
        design.row()?;
        Ok(Sample { imperfection: *self, design: *design, key })
    }
}

/// Derives the random key of a sample from seed, number and design.
///
/// Without a design the key is common to all designs.
fn key(design: Option<&Design>, seed: u64, number: u64) -> [u8; 32] {
    let numbers = design.into_iter().flat_map(|design| {
        // Bases `L` and `2L` are different designs and get different samples.
        let base = match design.base {
            Base::L => 1.0,
            Base::TwoL => 2.0,
        };
        [design.gap, design.length, design.slant_deg, base, design.width]
    });
    // −0 and +0 have different bits but denote the same design. Adding zero turns −0 into +0, so
    // both get the same samples.
    let mut digest = Sha256::new();
    for word in [seed, number].into_iter().chain(numbers.map(|x| (x + 0.0).to_bits())) {
        // A fixed byte order makes a sample identical on every machine.
        digest.update(word.to_le_bytes());
    }
    digest.finalize().into()
}

/// One imperfect row; its scales are generated on demand, for any length.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    imperfection: Imperfection,
    design: Design,
    key: [u8; 32],
}

/// Independent random streams for the three parts of a row.
#[derive(Clone, Copy)]
enum Stream {
    Centre,
    Right,
    Left,
}

impl Sample {
    /// Builds the row with `left` scales on the left and `right` scales on the right of its centre.
    ///
    /// Longer rows of a sample contain the same scales around the centre.
    ///
    /// # Errors
    /// If every draw of a scale violates (I3).
    pub fn row(&self, left: usize, right: usize) -> Result<UnevenRow, OutOfRange> {
        let centre = self.centre()?;
        let to_right = self.side(Stream::Right, centre, right)?;
        let mut to_left = self.side(Stream::Left, centre, left)?;
        // The scales on the left were drawn from the centre outwards, but `UnevenRow` lists scales
        // from left to right.
        to_left.reverse();
        let scales = to_left.iter().map(|(scale, _)| *scale).chain([centre]);
        let scales = scales.chain(to_right.iter().map(|(scale, _)| *scale)).collect();
        let gaps = to_left.iter().chain(&to_right).map(|(_, gap)| *gap).collect();
        UnevenRow::new(scales, gaps)
    }

    fn centre(&self) -> Result<Parallelogram, OutOfRange> {
        let mut random = self.random(Stream::Centre);
        // The central scale needs no gap: each gap is drawn with the scale on its outer side.
        let drawn = (0..DRAWS).find_map(|_| self.slanted(normal(&mut random)));
        drawn.ok_or_else(|| self.crowded())
    }

    /// Draws `count` scales on one side of `centre`, from the centre outwards.
    ///
    /// Each scale is returned with the gap on its side towards the centre.
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

    /// Draws the scale next to `last` and the gap between both; `None` if they violate (I3).
    fn next(
        &self,
        random: &mut ChaCha8Rng,
        stream: Stream,
        last: &Parallelogram,
    ) -> Option<(Parallelogram, f64)> {
        // Draw the numbers for gap and slant before any check, so that rejected and accepted draws
        // consume equally many random numbers.
        let (for_gap, for_slant) = (normal(random), normal(random));
        let gap = self.gap(for_gap);
        let scale = self.slanted(for_slant)?;
        let between = match stream {
            Stream::Left => clearance(&scale, last, gap),
            Stream::Centre | Stream::Right => clearance(last, &scale, gap),
        };
        (between > 0.0).then_some((scale, gap))
    }

    /// Computes a gap by (I1) from the standard normal number `z`.
    fn gap(&self, z: f64) -> f64 {
        let variance = self.imperfection.gap_cv.powi(2).ln_1p();
        self.design.gap * (variance.sqrt() * z - 0.5 * variance).exp()
    }

    /// Creates the scale with the slant (I2) for the standard normal number `z`.
    ///
    /// `None` if the magnitude of the slant reaches [`STEEPEST_DEG`].
    fn slanted(&self, z: f64) -> Option<Parallelogram> {
        let slant = self.design.slant_deg + self.imperfection.slant_sd_deg * z;
        // The slant of the design may itself exceed the limit. Accept it if slants do not scatter.
        let leans_too_far = slant.abs() >= STEEPEST_DEG && self.imperfection.slant_sd_deg > 0.0;
        let scale = Parallelogram::leaning(self.design.half_base(), slant).ok();
        scale.filter(|_| !leans_too_far)
    }

    fn random(&self, stream: Stream) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::from_seed(self.key);
        // Each side has its own stream, so that lengthening a row on one side leaves the scales of
        // the other side unchanged.
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
