//! Errors of the ends of composed ranges: the surrogate's, and the time steps'.

use super::tuning::TUNING;
use super::{Found, Row};
use crate::methods::chebyshev::range_search::{RangeSearch, block, extent};
use crate::methods::expansion::Moves;
use crate::methods::tuning::TUNING as METHODS;
use crate::methods::validation::{HeldOut, ValidationTable};
use crate::numerics::{Extent, Extremes, extremes_near, largest, step_error, surrogate_error, truncation};

impl Row<'_> {
    /// The part of an output's error that no sample makes smaller: that of the search for ends at jumps.
    pub fn of_search(&self, output: usize, found: &Extent) -> f64 {
        if self.ensemble.jumps(output) { found.gap } else { 0.0 }
    }

    /// Errors of the outputs at a glance: how far the coordinates' errors move them where the samples have their least
    /// and largest values. Near an extreme that is an upper bound of the move of the extreme itself.
    pub fn errors_at_samples(&self, HeldOut { points, direct }: HeldOut<'_>, row: usize) -> Vec<f64> {
        let outputs = self.ensemble.outputs();
        if row >= direct.rows() {
            return vec![f64::NAN; outputs];
        }
        let errors = self.coordinate_errors(points, direct.motion(row));
        let extents: Vec<Extent> = (0..outputs).map(|output| self.extent_of_samples(output)).collect();
        let moves: Vec<Moves> = errors
            .iter()
            .filter(|error| self.closure.needs_velocities() || error.0 < self.extent.len() / 2)
            .flat_map(|&(line, error)| [error, -error].map(|by| Moves { by: vec![(line, by)], ..Moves::default() }))
            .collect();
        let moved = self.moved_at_extremes(&extents, &moves);
        let compared = self.compared();
        let nodes: Vec<Vec<f64>> = compared.iter().map(|&sample| self.surrogate.samples()[sample].clone()).collect();
        let values = self.evaluate(&nodes);
        let error = |output: usize| {
            if self.disagrees(output, &compared, &values[output * nodes.len()..][..nodes.len()]) {
                return surrogate_error(&self.own_polynomials(&[output], points), &direct.at(row, output));
            }
            moved.chunks_exact(2).map(|ways| largest(ways.iter().map(|moved| moved[output]))).sum()
        };
        (0..outputs).map(error).collect()
    }

    /// Errors of the outputs' ranges: that of the search, the moves of the ends by the coordinates' errors, and how far
    /// the validation samples lie outside in row `row`.
    pub fn errors(
        &self,
        range_search: &RangeSearch,
        HeldOut { points, direct }: HeldOut<'_>,
        row: usize,
        Found { extents, expanded, .. }: &Found,
    ) -> Vec<f64> {
        if row >= direct.rows() {
            return vec![f64::NAN; extents.len()];
        }
        let errors = self.coordinate_errors(points, direct.motion(row));
        let moves: Vec<Moves> =
            errors.chunks_exact(2).map(|by| Moves { by: by.to_vec(), ..Moves::default() }).collect();
        let moved = self.moved(range_search, extents, &moves);
        let error = |(output, (found, moved)): (usize, (&Extent, f64))| {
            let simulated = direct.at(row, output);
            if expanded[output] {
                let own = self.own_polynomials(&[output], points);
                let tail = truncation(self.surrogate.basis(), self.own_coefficients(output));
                let between = if self.ensemble.has_kink(output) { METHODS.between_kinks } else { 1.0 };
                return found.gap + largest([between * surrogate_error(&own, &simulated), tail]);
            }
            let compared = self.compared_extreme(output, points, &simulated);
            let moved = if compared < moved { compared } else { moved };
            let outside = simulated.into_iter().map(|value| found.range.distance(value));
            found.gap + largest(outside.chain([moved]))
        };
        extents.iter().zip(moved).enumerate().map(error).collect()
    }

    /// How far off an extreme of coordinates is wherever it is compared, and between these points: no end of it is off
    /// by more, however far off a coordinate is where another one is larger. Infinite for other outputs.
    fn compared_extreme(&self, output: usize, points: &[Vec<f64>], simulated: &[f64]) -> f64 {
        if !self.ensemble.is_extreme(output) {
            return f64::INFINITY;
        }
        METHODS.between_kinks * surrogate_error(&self.predict_some(&[output], points), simulated)
    }

    /// The time steps' errors of the outputs' ranges: how far those of the coordinates, from samples with the steps as
    /// they are and with halved ones, move the ends.
    ///
    /// A coordinate that is too early or too late is so by about the same time over many turns. An end of a band that
    /// is full of turns is at rest, and such a shift moves it by next to nothing. The part of the errors that is no
    /// such shift may move an end wherever it is.
    pub fn step_errors(
        &self,
        range_search: &RangeSearch,
        direct: &ValidationTable,
        halved: &ValidationTable,
        row: usize,
        Found { extents, expanded, .. }: &Found,
    ) -> Vec<f64> {
        if row >= direct.rows() || row >= halved.rows() {
            return vec![f64::NAN; extents.len()];
        }
        let mut errors = self.of_independent(|line| step_error(direct.line(row, line), halved.line(row, line)));
        let mut in_time = Vec::new();
        for (coordinate, error) in errors.iter_mut().step_by(2) {
            if let Some(split) = direct.time_shift(halved, row, *coordinate) {
                in_time.push(Moves { ahead: vec![(*coordinate, split.shift)], ..Moves::default() });
                *error = split.remainder;
            }
        }
        let mut moved = self.moved_by(range_search, extents, &errors);
        if !in_time.is_empty() {
            let in_time = self.moved(range_search, extents, &in_time);
            moved.iter_mut().zip(in_time).for_each(|(moved, in_time)| *moved += in_time);
        }
        // The coordinates' errors say nothing about outputs that do not follow from them.
        moved.into_iter().zip(expanded).map(|(moved, &expanded)| if expanded { f64::NAN } else { moved }).collect()
    }

    /// How far errors of the independent coordinates and of their velocities (pairwise) move the ends of the outputs'
    /// ranges. The effects of positions and velocities add up, too, since their errors may have either sign.
    fn moved_by(&self, range_search: &RangeSearch, found: &[Extent], errors: &[(usize, f64)]) -> Vec<f64> {
        let lines = |first: usize| errors.iter().skip(first).step_by(2);
        let moves = |first: usize| -> Vec<Moves> {
            lines(first).map(|&error| Moves { by: vec![error], ..Moves::default() }).collect()
        };
        let mut moved = self.moved(range_search, found, &moves(0));
        if self.closure.needs_velocities() {
            let by_velocities = self.moved(range_search, found, &moves(1));
            moved.iter_mut().zip(by_velocities).for_each(|(moved, own)| *moved += own);
        }
        moved
    }

    /// How far moves of the independent coordinates, one for each, move the ends of the outputs' ranges.
    ///
    /// Each coordinate is moved one way and the other, and their effects add up, whichever way each of them moves an
    /// output. Many are moved together: all one way, or every other one against the rest. Where that moves an end by
    /// little, the extreme stays where it is, to first order; else it is searched for again.
    fn moved(&self, range_search: &RangeSearch, found: &[Extent], moves: &[Moves]) -> Vec<f64> {
        let one_by_one = moves.len() <= TUNING.most_moved;
        let rounds = if one_by_one { moves.len() } else { 2 };
        let weight = |round: usize, index: usize| match (one_by_one, index == round) {
            (true, is_its_turn) => f64::from(u8::from(is_its_turn)),
            (false, _) if round == 1 && index % 2 == 1 => -1.0,
            (false, _) => 1.0,
        };
        let way = |round: usize, sign: f64| {
            Moves::sum(moves.iter().enumerate().map(|(index, moves)| (moves, sign * weight(round, index))))
        };
        let ways: Vec<Moves> = (0..rounds).flat_map(|round| [1.0, -1.0].map(|sign| way(round, sign))).collect();
        let mut moved = vec![0.0; found.len()];
        let at_extremes = self.moved_at_extremes(found, &ways);
        for (ways, at_extremes) in ways.chunks_exact(2).zip(at_extremes.chunks_exact(2)) {
            let mut own = vec![0.0; found.len()];
            for (way, at_extremes) in ways.iter().zip(at_extremes) {
                let moves_far = |&output: &usize| at_extremes[output] > TUNING.far * found[output].range.width();
                let far: Vec<usize> = (0..found.len()).filter(moves_far).collect();
                for (output, (own, &moved)) in own.iter_mut().zip(at_extremes).enumerate() {
                    // At a brink the least of moves leads to the other side.
                    if !(moves_far(&output) && self.ensemble.jumps(output)) {
                        *own = largest([*own, moved]);
                    }
                }
                for (&output, shifted) in far.iter().zip(self.range_near(range_search, &far, found, way)) {
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

    /// For each way of moving, how far it moves every output at its extremes.
    fn moved_at_extremes(&self, found: &[Extent], ways: &[Moves]) -> Vec<Vec<f64>> {
        let all: Vec<Moves> = [Moves::default()].into_iter().chain(ways.iter().cloned()).collect();
        let outputs: Vec<usize> = (0..found.len()).collect();
        let ends = self.at_own_ends(&outputs, found, &all);
        let at = |output: usize, way: usize, end: usize| ends[output * all.len() + way][end];
        let of_output =
            |way: usize, output: usize| largest([0, 1].map(|end| at(output, way, end) - at(output, 0, end)));
        (1..all.len()).map(|way| outputs.iter().map(|&output| of_output(way, output)).collect()).collect()
    }

    /// Ranges of some outputs with the motion moved, near those that are known of all.
    fn range_near(&self, range_search: &RangeSearch, outputs: &[usize], known: &[Extent], way: &Moves) -> Vec<Extent> {
        let by_block = outputs.chunk_by(|a, b| block(*a) == block(*b));
        let near = |outputs: &[usize]| {
            let mut ranges = self.block_near(range_search, outputs, known, way);
            self.to_brinks(outputs, &mut ranges, way);
            ranges
        };
        by_block.flat_map(near).collect()
    }

    /// The same of outputs that are searched together.
    fn block_near(&self, range_search: &RangeSearch, outputs: &[usize], known: &[Extent], way: &Moves) -> Vec<Extent> {
        let evaluate = |points: &[Vec<f64>]| self.evaluate_some(outputs, points, std::slice::from_ref(way));
        let near = outputs.iter().map(|&output| &known[output]);
        let Some(search) = range_search.climbs() else {
            return extremes_near(&near.cloned().collect::<Vec<_>>(), &evaluate);
        };
        let near: Vec<Extremes> = near.map(|near| Extremes::at(near.range, near.places.clone())).collect();
        let found = search.extremes(outputs.len(), &near, &[], &evaluate);
        found.into_iter().map(extent).collect()
    }
}
