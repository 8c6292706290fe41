//! Rows that are not perfect: random gaps and slants.

use geometry::{OutOfRange, Parallelogram, UnevenRow, clearance};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use sha2::{Digest as _, Sha256};

use crate::{Base, Design};

/// Slants of single scales stay below this, to either side, degrees.
const STEEPEST_DEG: f64 = 89.0;

/// Draws after which a scale that would stand clear of its neighbour is no longer looked for.
const DRAWS: usize = 100_000;

/// Scatter of the gaps and slants of a row.
///
/// With independent standard normal numbers `z`, a gap and a slant are
///
/// ```text
/// d_i = d exp(s z − s²/2),   s² = ln(1 + cv²)                                      (I1)
/// α_i = α + sd z'                                                                  (I2)
/// ```
///
/// A gap is log-normal: positive, with the mean `d` and the coefficient of variation `cv`. Scales do
/// not overlap at rest: gap and slant of a scale are drawn again, together, until
///
/// ```text
/// d_i + t (tan α_right − tan α_left) > 0,   |α_i| < 89°                            (I3)
/// ```
///
/// from the middle of a row outwards, so of the rows that (I1) and (I2) would give only some remain that
/// can be made. Where the slants scatter by more than the gap is wide (`d < sd/cos² α`) these lean
/// more to the right of the middle than to its left, and where they scatter by much more, none is found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Imperfection {
    /// Coefficient of variation `cv` of the gaps.
    pub gap_cv: f64,
    /// Standard deviation of the slants, degrees.
    pub slant_sd_deg: f64,
}

impl Imperfection {
    /// Whether nothing scatters.
    pub fn is_none(&self) -> bool {
        self.gap_cv == 0.0 && self.slant_sd_deg == 0.0
    }

    /// Sample `number` of the rows of `design`.
    ///
    /// A sample depends on the seed, the number and the geometry of the design alone, not on where
    /// or in which order samples are drawn. The normal numbers do not depend on how far the row
    /// scatters: they are the same for another `cv` or `sd`, but where (I3) refuses them.
    ///
    /// # Errors
    /// If a number is negative or not finite, or the design has no geometrical meaning.
    pub fn sample(&self, design: &Design, seed: u64, number: u64) -> Result<Sample, OutOfRange> {
        self.drawn(design, key(Some(design), seed, number))
    }

    /// As [`Self::sample`], with normal numbers that do not depend on the design either: what differs between the samples of
    /// that number of two designs is what the designs make of it.
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
        // Only the check.
        design.row()?;
        Ok(Sample { imperfection: *self, design: *design, key })
    }
}

/// The key of the random numbers of a sample, of one design or of all.
fn key(design: Option<&Design>, seed: u64, number: u64) -> [u8; 32] {
    // `L` and `2L` are different designs, with samples of their own.
    let base = |design: &Design| match design.base {
        Base::L => 1.0,
        Base::TwoL => 2.0,
    };
    let numbers =
        |design: &Design| [design.gap, design.length, design.slant_deg, base(design), design.width];
    // A zero is added to each below: of −0 the bits differ, and the same design would have other samples.
    let numbers = design.into_iter().flat_map(numbers);
    let mut digest = Sha256::new();
    for word in [seed, number].into_iter().chain(numbers.map(|x| (x + 0.0).to_bits())) {
        // The byte order is fixed, so that a sample is the same on every machine.
        digest.update(word.to_le_bytes());
    }
    digest.finalize().into()
}

/// One imperfect row, as long as one wants it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    imperfection: Imperfection,
    design: Design,
    key: [u8; 32],
}

/// Which of the random numbers of a sample.
#[derive(Clone, Copy)]
enum Stream {
    Centre,
    Right,
    Left,
}

impl Sample {
    /// A scale with `left` scales to its left and `right` to its right. A longer row has the same scales
    /// in its middle.
    ///
    /// # Errors
    /// If no scale is found that stands clear of its neighbour.
    pub fn row(&self, left: usize, right: usize) -> Result<UnevenRow, OutOfRange> {
        let centre = self.centre()?;
        let to_right = self.side(Stream::Right, centre, right)?;
        let mut to_left = self.side(Stream::Left, centre, left)?;
        // Scales were drawn from the centre outwards, and a row is listed from the left.
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

    /// The next scales on one side of the centre, from it outwards, each with the gap before it.
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

    /// A scale beside `last` and the gap between them; `None` if they would overlap (I3).
    fn next(
        &self,
        random: &mut ChaCha8Rng,
        stream: Stream,
        last: &Parallelogram,
    ) -> Option<(Parallelogram, f64)> {
        // Both before either is judged: a draw that is refused takes as many numbers as one that stands.
        let (for_gap, for_slant) = (normal(random), normal(random));
        let gap = self.gap(for_gap);
        let scale = self.slanted(for_slant)?;
        let between = match stream {
            Stream::Left => clearance(&scale, last, gap),
            Stream::Centre | Stream::Right => clearance(last, &scale, gap),
        };
        (between > 0.0).then_some((scale, gap))
    }

    /// (I1).
    fn gap(&self, z: f64) -> f64 {
        // Lognormal: no gap is drawn below zero, and their mean is that of the design.
        let variance = self.imperfection.gap_cv.powi(2).ln_1p();
        self.design.gap * (variance.sqrt() * z - 0.5 * variance).exp()
    }

    /// (I2); `None` if it leans too far.
    fn slanted(&self, z: f64) -> Option<Parallelogram> {
        let slant = self.design.slant_deg + self.imperfection.slant_sd_deg * z;
        // A design may itself be steeper than that: without scatter its slant stays.
        let leans_too_far = slant.abs() >= STEEPEST_DEG && self.imperfection.slant_sd_deg > 0.0;
        let scale = Parallelogram::leaning(self.design.half_base(), slant).ok();
        scale.filter(|_| !leans_too_far)
    }

    fn random(&self, stream: Stream) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::from_seed(self.key);
        // A stream for each side, so that a row that grows to one side keeps what was drawn for the other.
        random.set_stream(stream as u64);
        random
    }

    fn crowded(&self) -> OutOfRange {
        OutOfRange {
            quantity: "standard deviation of the slants",
            value: self.imperfection.slant_sd_deg,
            expected: "one small enough for scales to stand clear of each other",
        }
    }
}

fn normal(random: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(random)
}
