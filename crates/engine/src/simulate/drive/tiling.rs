//! How samples are divided among tiles.

use super::tuning::TUNING;
use symdiff::WIDTHS;

/// Tiles of `samples` with this many registers each for `threads`: (first, count, width). Results do not depend on the
/// tiling.
pub(in crate::simulate) fn tiles(samples: usize, registers: usize, threads: usize) -> Vec<(usize, usize, usize)> {
    let fits = TUNING.tile_memory / (registers * size_of::<f64>()).max(1);
    let widths = TUNING.narrowest_tile..=fits.clamp(TUNING.narrowest_tile, TUNING.widest_tile);
    // Time until the last thread ends; of widths with equal times, the widest takes least of all threads.
    let until_last = |width: &usize| samples.div_ceil(*width).div_ceil(threads) * (TUNING.dispatch + width);
    let width = WIDTHS.into_iter().rev().filter(|width| widths.contains(width)).min_by_key(until_last).unwrap_or(1);
    let mut tiles = Vec::new();
    let mut first = 0;
    while first < samples {
        let count = width.min(samples - first);
        let width = WIDTHS.into_iter().find(|&width| width >= count).unwrap_or(width);
        tiles.push((first, count, width));
        first += count;
    }
    tiles
}

/// Puts lines of a tile (line, lane) among those of `all` samples (line, sample). The first lanes are `samples`, others
/// are omitted.
pub(super) fn put_lanes(values: &[f64], width: usize, samples: &[usize], into: &mut [f64], all: usize) {
    for (of_tile, line) in values.chunks_exact(width).zip(into.chunks_exact_mut(all.max(1))) {
        samples.iter().zip(of_tile).for_each(|(&sample, &value)| line[sample] = value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_all_samples_once() {
        for samples in 1..200 {
            for (threads, registers) in [(1, 100), (2, 100), (7, 100), (2, 100_000)] {
                let mut next = 0;
                for (first, count, width) in tiles(samples, registers, threads) {
                    assert_eq!(first, next);
                    assert!(count >= 1 && count <= width && WIDTHS.contains(&width));
                    next += count;
                }
                assert_eq!(next, samples);
            }
        }
    }
}
