//! Order in which a run solves its designs, so that its remaining time can be estimated.

use std::ops::Range;

/// Number of blocks into which a run of medium size is divided.
///
/// The remaining time is estimated from the blocks that are finished.
const BLOCKS: u64 = 1024;

/// Maximum number of designs in a block.
///
/// The designs of a block are neighbours, which share springs in a cache of limited size.
const LARGEST: u64 = 64;

/// The golden section: its multiples modulo 1 are evenly spread over `0..1`.
const GOLDEN_SECTION: f64 = 0.618_033_988_749_894_9;

/// Returns the positions in `ranges` block by block, with consecutive blocks far from each other.
///
/// The slowest designs of a grid are neighbours. In this order, the solved designs are a sample of
/// all designs, from which the remaining time can be extrapolated. The order depends on `ranges`
/// only.
pub(crate) fn interleaved(ranges: Vec<Range<u64>>) -> impl Iterator<Item = u64> + Clone + Send {
    // Number of positions before each range.
    let (mut starts, mut count) = (Vec::new(), 0);
    for range in &ranges {
        starts.push(count);
        count += range.end - range.start;
    }
    let length = count.div_ceil(BLOCKS).clamp(1, LARGEST);
    let blocks = count.div_ceil(length);
    let stride = stride(blocks);
    let blocks = (0..blocks).flat_map(move |k| {
        let first = nth_block(k, stride, blocks) * length;
        first..count.min(first + length)
    });
    blocks.map(move |ordinal| {
        let k = starts.partition_point(|start| *start <= ordinal) - 1;
        ranges[k].start + (ordinal - starts[k])
    })
}

/// Returns the index of the block that is solved after `k` other blocks.
///
/// The first block is in the middle, because the first designs of a grid are often the slowest.
fn nth_block(k: u64, stride: u64, blocks: u64) -> u64 {
    // Use 128 bits, because the product exceeds 64 bits for large runs.
    let multiple = u128::from(k) * u128::from(stride) + u128::from(blocks / 2);
    (multiple % u128::from(blocks)) as u64
}

/// Returns a number near the golden section of `blocks` that is coprime with `blocks`.
fn stride(blocks: u64) -> u64 {
    let golden = (GOLDEN_SECTION * blocks as f64) as u64;
    let mut larger = golden.max(1)..blocks;
    larger.find(|stride| greatest_common_divisor(*stride, blocks) == 1).unwrap_or(1)
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_position_occurs_once() {
        let cases: [&[Range<u64>]; 6] = [
            &[],
            &[3..4; 1],
            &[0..2; 1],
            &[0..720; 1],
            &[5..5, 7..8, 10..200],
            &[0..10_001, 20_000..20_300],
        ];
        for ranges in cases {
            let mut found: Vec<_> = interleaved(ranges.to_vec()).collect();
            found.sort_unstable();
            assert!(found.into_iter().eq(ranges.iter().cloned().flatten()), "{ranges:?}");
        }
    }

    #[test]
    fn the_first_solved_designs_are_representative_of_all_designs() {
        for count in [720_u64, 5_000, 300_000] {
            // The first tenth of the designs takes two thirds of the time.
            let costs: Vec<_> =
                (0..count).map(|design| (-10.0 * design as f64 / count as f64).exp()).collect();
            let all: f64 = costs.iter().sum();
            let sample: Vec<f64> = interleaved(vec![0..count; 1])
                .take(count as usize / 10)
                .map(|design| costs[design as usize])
                .collect();
            let estimate = sample.iter().sum::<f64>() * count as f64 / sample.len() as f64;
            // Without interleaving this ratio is 6.3.
            assert!((estimate / all - 1.0).abs() < 0.35, "{count}: {}", estimate / all);
        }
    }

    #[test]
    fn the_order_of_a_huge_run_is_computed_lazily() {
        let first: Vec<_> = interleaved(vec![0..1_000_000_000_000; 1]).take(65).collect();
        assert_eq!((first[0], first[63]), (500_000_000_000, 500_000_000_063));
        assert!((110_000_000_000..120_000_000_000).contains(&first[64]), "{}", first[64]);
    }
}
