//! The designs that a run solves: the whole grid, a random sample, or a shard of grid or sample.

use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use serde::{Deserialize, Serialize};

/// The part of a grid that a run solves. The default is the whole grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Subset {
    /// Random sample of the designs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<RandomSample>,
    /// One shard of the designs or of the sample.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<Shard>,
}

/// A random sample, identical for the same seed on any machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RandomSample {
    /// Number of designs.
    pub designs: u64,
    /// Seed of the generator.
    pub seed: u64,
}

/// The shard `i/N`: every N-th design, starting with the i-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Shard {
    index: u64,
    count: u64,
}

/// A text that is not a shard.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is not a shard, expected i/N with i from 1 to N, e.g. 3/8")]
pub struct NoShard(String);

/// The sample is larger than the grid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("--sample {requested}: there are only {designs} designs, expected from 1 to {designs}")]
pub struct SampleTooLarge {
    requested: u64,
    designs: u64,
}

impl FromStr for Shard {
    type Err = NoShard;

    fn from_str(text: &str) -> Result<Self, NoShard> {
        text.split_once('/')
            .and_then(|(index, count)| {
                Some(Self { index: index.parse().ok()?, count: count.parse().ok()? })
            })
            .filter(|shard| (1..=shard.count).contains(&shard.index))
            .ok_or_else(|| NoShard(text.to_owned()))
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl TryFrom<String> for Shard {
    type Error = NoShard;

    fn try_from(text: String) -> Result<Self, NoShard> {
        text.parse()
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

impl fmt::Display for RandomSample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "--sample {} --seed {}", self.designs, self.seed)
    }
}

impl fmt::Display for Subset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.sample, self.shard) {
            (None, None) => f.write_str("all designs"),
            (Some(sample), None) => write!(f, "{sample}"),
            (None, Some(shard)) => write!(f, "--shard {shard}"),
            (Some(sample), Some(shard)) => write!(f, "{sample} --shard {shard}"),
        }
    }
}

/// The designs of a [`Subset`] of a grid, in ascending order.
///
/// Stores the indices of a sample, if there is one, but never the indices of the whole grid.
#[derive(Clone, Debug)]
pub struct SubsetDesigns {
    /// Grid indices of the sample, ascending.
    sample: Option<Vec<u64>>,
    /// Number of designs in the sample or the grid, before the shard is selected.
    whole: u64,
    first: u64,
    step: u64,
}

impl SubsetDesigns {
    /// Selects the designs of `part` from a grid with `designs` designs.
    ///
    /// # Errors
    ///
    /// If the grid has fewer designs than the sample.
    pub fn new(designs: u64, part: Subset) -> Result<Self, SampleTooLarge> {
        let sample = part.sample.map(|sample| draw(designs, sample)).transpose()?;
        let whole = sample.as_ref().map_or(designs, |sample| sample.len() as u64);
        let (first, step) = part.shard.map_or((0, 1), |shard| (shard.index - 1, shard.count));
        Ok(Self { sample, whole, first, step })
    }

    /// Returns the number of selected designs, which may be 0 for a shard of a small grid.
    pub fn len(&self) -> u64 {
        self.whole.saturating_sub(self.first).div_ceil(self.step)
    }

    /// Returns true if the subset has no designs.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the grid index of the selected design at `position`, which is below [`Self::len`].
    pub fn design(&self, position: u64) -> u64 {
        let position = self.first + position * self.step;
        // An invalid position returns `u64::MAX`, which is not the index of any design.
        self.sample
            .as_ref()
            .map_or(Some(position), |sample| {
                usize::try_from(position).ok().and_then(|position| sample.get(position)).copied()
            })
            .unwrap_or(u64::MAX)
    }

    /// Returns the position of the design with grid index `index`, if it is selected.
    pub fn position(&self, index: u64) -> Option<u64> {
        let position = match &self.sample {
            // `draw` returns an ascending sample.
            Some(sample) => sample.binary_search(&index).ok()? as u64,
            None => index,
        };
        let offset = position.checked_sub(self.first).filter(|offset| offset % self.step == 0)?;
        // Without a sample, `index` may be beyond the grid, so check the position.
        Some(offset / self.step).filter(|position| *position < self.len())
    }
}

/// Draws a random sample by Floyd's algorithm, which stores only the sample.
///
/// See Bentley & Floyd 1987, doi 10.1145/30401.315746.
fn draw(designs: u64, sample: RandomSample) -> Result<Vec<u64>, SampleTooLarge> {
    if !(1..=designs).contains(&sample.designs) {
        return Err(SampleTooLarge { requested: sample.designs, designs });
    }
    // The output of ChaCha8 never changes; a default generator of `rand` may change.
    let mut random = ChaCha8Rng::seed_from_u64(sample.seed);
    let mut chosen = BTreeSet::new();
    for last in designs - sample.designs..designs {
        if !chosen.insert(random.random_range(0..=last)) {
            chosen.insert(last);
        }
    }
    Ok(chosen.into_iter().collect())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn all(selection: &SubsetDesigns) -> Vec<u64> {
        (0..selection.len()).map(|position| selection.design(position)).collect()
    }

    fn part(sample: Option<(u64, u64)>, shard: Option<&str>) -> Subset {
        let sample = sample.map(|(designs, seed)| RandomSample { designs, seed });
        Subset { sample, shard: shard.map(|text| text.parse().expect("a shard")) }
    }

    #[test]
    fn the_sample_of_a_seed_never_changes() {
        let drawn =
            |seed| all(&SubsetDesigns::new(720, part(Some((8, seed)), None)).expect("a sample"));
        assert_eq!(drawn(7), [59, 112, 119, 258, 431, 503, 520, 611]);
        assert_ne!(drawn(8), drawn(7));
    }

    #[test]
    fn a_sample_of_a_huge_grid_needs_little_memory() {
        let huge = SubsetDesigns::new(u64::MAX, part(Some((1000, 1)), None)).expect("a sample");
        assert_eq!(huge.len(), 1000);
        let error = SubsetDesigns::new(5, part(Some((6, 0)), None)).expect_err("too large");
        let message = "--sample 6: there are only 5 designs, expected from 1 to 5";
        assert_eq!(error.to_string(), message);
    }

    #[test]
    fn invalid_shards_are_refused() {
        for text in ["", "1", "0/3", "4/3", "1/0", "-1/3", "1/3/5", "a/b"] {
            let message =
                format!("{text:?} is not a shard, expected i/N with i from 1 to N, e.g. 3/8");
            assert_eq!(text.parse::<Shard>().expect_err("no shard").to_string(), message);
        }
    }

    proptest! {
        #[test]
        fn every_design_is_in_exactly_one_shard(designs in 1..500_u64, count in 1..9_u64, half: bool) {
            let sample = half.then_some((designs.div_ceil(2), 3));
            let whole = all(&SubsetDesigns::new(designs, part(sample, None)).expect("a sample"));
            let mut dealt = Vec::new();
            for index in 1..=count {
                let shard = format!("{index}/{count}");
                let shard = SubsetDesigns::new(designs, part(sample, Some(&shard))).expect("shard");
                for (position, design) in all(&shard).into_iter().enumerate() {
                    prop_assert_eq!(shard.position(design), Some(position as u64));
                    dealt.push(design);
                }
                let others = (0..designs).filter(|d| shard.position(*d).is_some()).count();
                prop_assert_eq!(others as u64, shard.len());
            }
            dealt.sort_unstable();
            prop_assert_eq!(dealt, whole);
        }
    }
}
