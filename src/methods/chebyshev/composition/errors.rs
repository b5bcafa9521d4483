//! How far the ends of composed ranges may be off: by the surrogate's errors, and by the time steps'.

use std::convert::Infallible;

use super::{Found, Row};
use crate::methods::chebyshev::range_search::{RangeSearch, extent};
use crate::methods::validation::ValidationTable;
use crate::numerics::{Extent, Extremes, extremes_near, largest, step_error, surrogate_error, truncation};

/// So many independent coordinates are moved one by one.
const MOST_MOVED: usize = 4;

/// What moves an end by less than this share of the range's width moves the place of the extreme by so little that it does not matter.
const FAR: f64 = 0.1;

impl Row<'_> {
    /// Errors of the outputs' ranges: what the search may have missed, how far the coordinates' errors move the ends, and how
    /// far the validation samples at `points`, whose values in row `row` are in `direct`, lie outside.
    pub fn errors(
        &self,
        range_search: &RangeSearch,
        (points, direct): (&[Vec<f64>], &ValidationTable),
        row: usize,
        Found { extents, expanded, .. }: &Found,
    ) -> Vec<f64> {
        if row >= direct.rows() {
            return vec![f64::NAN; extents.len()];
        }
        let moved = self.moved(range_search, extents, &self.coordinate_errors(points, direct.motion(row)));
        let error = |(output, (found, moved)): (usize, (&Extent, f64))| {
            let simulated = direct.at(row, output);
            if expanded[output] {
                let own = self.own_polynomials(&[output], points);
                let tail = truncation(self.surrogate.basis(), self.own_coefficients(output));
                return found.gap + largest([surrogate_error(&own, &simulated), tail]);
            }
            let outside = simulated.into_iter().map(|value| found.range.distance(value));
            found.gap + largest(outside.chain([moved]))
        };
        extents.iter().zip(moved).enumerate().map(error).collect()
    }

    /// The time steps' errors of the outputs' ranges: how far those of the coordinates, from samples with the steps as they are
    /// and with halved ones, move the ends.
    pub fn step_errors(
        &self,
        range_search: &RangeSearch,
        (direct, halved): (&ValidationTable, &ValidationTable),
        row: usize,
        Found { extents, expanded, .. }: &Found,
    ) -> Vec<f64> {
        if row >= direct.rows() || row >= halved.rows() {
            return vec![f64::NAN; extents.len()];
        }
        let errors = self.of_independent(|line| step_error(direct.line(row, line), halved.line(row, line)));
        let moved = self.moved(range_search, extents, &errors);
        // Of what does not follow from coordinates, their errors say nothing.
        moved.into_iter().zip(expanded).map(|(moved, &expanded)| if expanded { f64::NAN } else { moved }).collect()
    }

    /// How far errors of the independent coordinates and their velocities (pairwise) move the ends of the outputs' ranges.
    ///
    /// Each coordinate is moved one way and the other, and what they do adds up, whichever way each of them moves an output. Many are
    /// moved together: all one way, or every other one against the rest. Where that moves an end by little, the extreme stays where it
    /// is, to first order; else it is searched for again.
    fn moved(&self, range_search: &RangeSearch, found: &[Extent], errors: &[(usize, f64)]) -> Vec<f64> {
        let coordinates = errors.len() / 2;
        let one_by_one = coordinates <= MOST_MOVED;
        let rounds = if one_by_one { coordinates } else { 2 };
        let weight = |round: usize, coordinate: usize| match (one_by_one, coordinate == round) {
            (true, is_its_turn) => f64::from(u8::from(is_its_turn)),
            (false, _) if round == 1 && coordinate % 2 == 1 => -1.0,
            (false, _) => 1.0,
        };
        let shift = |round: usize, sign: f64| -> Vec<(usize, f64)> {
            let of_line = |(place, &(line, error)): (usize, &(usize, f64))| match weight(round, place / 2) {
                0.0 => None,
                weight => Some((line, sign * weight * error)),
            };
            errors.iter().enumerate().filter_map(of_line).collect()
        };
        let shifts: Vec<Vec<(usize, f64)>> =
            (0..rounds).flat_map(|round| [1.0, -1.0].map(|sign| shift(round, sign))).collect();
        let mut moved = vec![0.0; found.len()];
        let at_extremes = self.moved_at_extremes(found, &shifts);
        for (shifts, at_extremes) in shifts.chunks_exact(2).zip(at_extremes.chunks_exact(2)) {
            let mut own = vec![0.0; found.len()];
            for (shift, at_extremes) in shifts.iter().zip(at_extremes) {
                own.iter_mut().zip(at_extremes).for_each(|(own, &moved)| *own = largest([*own, moved]));
                let moves_far = |&output: &usize| at_extremes[output] > FAR * found[output].range.width();
                let far: Vec<usize> = (0..found.len()).filter(moves_far).collect();
                for (&output, shifted) in far.iter().zip(self.range_near(range_search, (&far, found), shift)) {
                    let (from, to) = (found[output].range, shifted.range);
                    own[output] = largest([from.lower - to.lower, from.upper - to.upper, own[output]]);
                }
            }
            for (moved, own) in moved.iter_mut().zip(own) {
                *moved = if one_by_one { *moved + own } else { largest([*moved, own]) };
            }
        }
        moved
    }

    /// For each shift of lines, how far it moves every output at the places of its extremes.
    fn moved_at_extremes(&self, found: &[Extent], shifts: &[Vec<(usize, f64)>]) -> Vec<Vec<f64>> {
        let places: Vec<Vec<f64>> = found.iter().flat_map(|found| found.places.iter().cloned()).collect();
        let all: Vec<Vec<(usize, f64)>> = [Vec::new()].into_iter().chain(shifts.iter().cloned()).collect();
        let values = self.evaluate_shifted(&places, &all);
        let at = |output: usize, shift: usize, end: usize| {
            values[(output * all.len() + shift) * places.len() + 2 * output + end]
        };
        let of_output =
            |shift: usize, output: usize| largest([0, 1].map(|end| at(output, shift, end) - at(output, 0, end)));
        (1..all.len()).map(|shift| (0..found.len()).map(|output| of_output(shift, output)).collect()).collect()
    }

    /// Ranges of some outputs with some lines shifted, near those that are known of all.
    fn range_near(
        &self,
        range_search: &RangeSearch,
        (outputs, known): (&[usize], &[Extent]),
        shift: &[(usize, f64)],
    ) -> Vec<Extent> {
        if outputs.is_empty() {
            return Vec::new();
        }
        let shifts = [shift.to_vec()];
        let evaluate = |points: &[Vec<f64>]| -> Vec<f64> {
            let values = self.evaluate_shifted(points, &shifts);
            outputs.iter().flat_map(|&output| values[output * points.len()..][..points.len()].to_vec()).collect()
        };
        let near = outputs.iter().map(|&output| &known[output]);
        let Some(search) = range_search.climbs() else {
            return extremes_near(&near.cloned().collect::<Vec<_>>(), evaluate);
        };
        let near: Vec<Extremes> = near.map(|near| Extremes::at(near.range, near.places.clone())).collect();
        let evaluate = |points: &[Vec<f64>], values: &mut [f64]| {
            values.copy_from_slice(&evaluate(points));
            Ok::<(), Infallible>(())
        };
        let Ok(found) = search.extremes(outputs.len(), &near, &[], evaluate);
        found.into_iter().map(extent).collect()
    }
}
