//! Rounding errors of the constraints at an iterate.

use std::collections::BTreeMap;

use symdiff::Tile;

use super::tuning::TUNING;
use crate::compile::Program;

/// Entries of the Newton matrix of a lane, after its tape has run: row, column, value.
pub fn matrix_entries(program: &Program, tile: &Tile, lane: usize) -> Vec<(usize, usize, f64)> {
    let entries = program.matrix_entries.iter();
    let entries = entries.map(|&(row, column, register)| (row, column, tile.lane(register)[lane])).collect();
    without_links(entries, program.residual.len())
}

/// The derivatives by the unknowns, of which there are `size`: those by values of links replaced by their expressions.
fn without_links(entries: Vec<(usize, usize, f64)>, size: usize) -> Vec<(usize, usize, f64)> {
    if entries.last().is_none_or(|&(row, ..)| row < size) {
        return entries;
    }
    let first = entries.partition_point(|&(row, ..)| row < size);
    let mut values: Vec<BTreeMap<usize, f64>> = Vec::new();
    let add = |sums: &mut BTreeMap<usize, f64>, values: &[BTreeMap<usize, f64>], column: usize, slope: f64| match column
        .checked_sub(size)
    {
        None => *sums.entry(column).or_default() += slope,
        Some(value) => values[value].iter().for_each(|(&by, of)| *sums.entry(by).or_default() += slope * of),
    };
    for row in entries[first..].chunk_by(|a, b| a.0 == b.0) {
        let mut sums = BTreeMap::new();
        for &(row, column, slope) in row.iter().filter(|(row, column, _)| row != column) {
            debug_assert!(column < row || column < size);
            add(&mut sums, &values, column, slope);
        }
        values.push(sums);
    }
    let mut condensed = Vec::new();
    for row in entries[..first].chunk_by(|a, b| a.0 == b.0) {
        let mut sums = BTreeMap::new();
        row.iter().for_each(|&(_, column, slope)| add(&mut sums, &values, column, slope));
        condensed.extend(sums.into_iter().map(|(column, slope)| (row[0].0, column, slope)));
    }
    condensed
}

/// Rounding error of each of the n + m residuals, zero for those of motion: by rounding of positions, and by that of
/// the constraints' terms, which counts where no coordinate changes their sum. `gain` is that of positions.
pub fn rounding_of_residuals(
    program: &Program,
    tile: &Tile,
    lane: usize,
    entries: &[(usize, usize, f64)],
    gain: f64,
) -> Vec<f64> {
    let n = program.scale.len();
    let mut rounding = vec![0.0; n];
    rounding.extend(program.rounding.iter().map(|error| error / gain));
    for &(row, column, slope) in entries.iter().filter(|(row, column, _)| *row >= n && *column < n) {
        let position = tile.lane(program.layout.q.start + column)[lane].abs() + program.scale[column];
        rounding[row] += TUNING.round_off * slope.abs() * position / gain;
    }
    rounding
}

/// Whether a lane's constraints hold to rounding, and its last correction may be nothing else, after the matrix' tape
/// has run.
pub fn is_rounding(program: &Program, tile: &Tile, lane: usize, last: f64, gain: f64) -> bool {
    let entries = matrix_entries(program, tile, lane);
    let rounding = rounding_of_residuals(program, tile, lane, &entries, gain);
    let mut constraints = program.residual.iter().zip(&rounding).skip(program.scale.len());
    last <= TUNING.stalled && constraints.all(|(&register, rounding)| tile.lane(register)[lane].abs() <= *rounding)
}
