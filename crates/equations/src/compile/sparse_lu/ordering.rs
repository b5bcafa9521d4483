//! The order in which blocks of coordinates are eliminated.

use std::collections::BTreeSet;

/// The order of each coordinate's block in `[M Φᵀ; Φ 0]`, from 1. A block holds the coordinates that M couples (a
/// body); `block` has each coordinate's, `coordinates_of_row` the coordinates of each constraint.
///
/// The next block is the one that shares constraints with the fewest other blocks, where blocks joined by an eliminated
/// one count as neighbours (minimum degree; Tinney & Walker, Proc. IEEE 55 (1967) 1801). A chain is eliminated from an
/// end.
pub fn block_order(block: &[usize], coordinates_of_row: &[BTreeSet<usize>]) -> Vec<usize> {
    let n = block.len();
    let mut neighbours: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); n];
    for coordinates in coordinates_of_row {
        let blocks: BTreeSet<usize> = coordinates.iter().map(|&coordinate| block[coordinate]).collect();
        for &a in &blocks {
            neighbours[a].extend(blocks.iter().filter(|&&b| b != a));
        }
    }
    let mut left: BTreeSet<(usize, usize)> = block.iter().map(|&block| (neighbours[block].len(), block)).collect();
    let mut order = vec![0; n];
    let mut next = 1;
    while let Some((_, first)) = left.pop_first() {
        order[first] = next;
        next += 1;
        let around = std::mem::take(&mut neighbours[first]);
        for &a in &around {
            left.remove(&(neighbours[a].len(), a));
            neighbours[a].extend(around.iter().filter(|&&b| b != a));
            neighbours[a].remove(&first);
            left.insert((neighbours[a].len(), a));
        }
    }
    block.iter().map(|&block| order[block]).collect()
}
