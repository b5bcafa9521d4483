//! Composition: what is expanded is what is smooth. The independent coordinates and their velocities become polynomials of
//! the parameters; every output follows from them through the loop closure and its own formula.
//!
//! Where an output that is composed in this way is the same polynomial as the one through its own samples, that polynomial takes its
//! place: its range costs no closure. Where it is NaN, or not what the samples' simulations say, so does that polynomial, as
//! with `expand: output`.

mod evaluation;

use std::convert::Infallible;

use rayon::prelude::*;

use super::range_search::{Evaluate, Functions, Previous, RangeSearch, extent};
use crate::methods::ensemble::{Closure, Ensemble, EnsembleError};
use crate::methods::validation::ValidationTable;
use crate::numerics::{
    Extent, Extremes, ParameterBox, Range, Surrogate, SurrogateWork, corners, extremes_near, largest, step_error,
    surrogate_error, truncation,
};

/// Largest mechanism, in coordinates, whose independent coordinates are searched for in every row.
const MOST_COORDINATES: usize = 300;

/// An output is the polynomial through its samples where both differ by less than this share of its range, and so many units of
/// rounding of its values.
const ALIKE: f64 = 1e-10;
const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// An output does not follow from the coordinates where it differs from its simulated samples by this share of their range and this
/// one of their values. (Accelerations and reactions of the samples have errors of the scheme that those which follow do not have.)
const DISAGREES: (f64, f64) = (0.25, 1e-3);

/// So many independent coordinates are moved one by one.
const MOST_MOVED: usize = 4;

/// What moves an end by less than this share of the range's width moves the place of the extreme by so little that it does not matter.
const FAR: f64 = 0.1;

/// Samples at which outputs are held against the simulation, at most.
const COMPARED: usize = 24;

/// Samples, for either end of an output, near which it is searched for, and how far they are apart along some axis.
const SEEDS: usize = 4;
const APART: f64 = 0.5;

/// Whether outputs can be composed: there are uncertain parameters, and not too many coordinates.
pub fn can_compose(parameters: usize, coordinates: usize) -> bool {
    parameters > 0 && coordinates <= MOST_COORDINATES
}

/// One mechanism's closures, and what is evaluated through them.
pub(super) struct Composer<'a> {
    ensemble: &'a dyn Ensemble,
    /// Those used so far.
    closures: Vec<Box<dyn Closure + 'a>>,
}

impl<'a> Composer<'a> {
    /// Without any closure yet.
    pub fn new(ensemble: &'a dyn Ensemble) -> Self {
        Self { ensemble, closures: Vec::new() }
    }

    /// Applies `look` to rows, in parallel block by block (with the extremes of the row before in the same block), given the
    /// motions and outputs of a surrogate's samples over a box (`stride` values a row, line by line).
    ///
    /// # Errors
    /// Where a closure cannot be compiled.
    pub fn rows<T: Send>(
        &mut self,
        surrogate: &Surrogate,
        domain: &ParameterBox,
        times: &[f64],
        (motions, stride): (&[f64], usize),
        look: impl Fn(usize, &Row, &mut Previous) -> T + Sync,
    ) -> Result<Vec<T>, EnsembleError> {
        let coordinates = 2 * self.ensemble.scales().len() * surrogate.samples().len();
        let mut chosen = Vec::with_capacity(times.len());
        for (&time, motion) in times.iter().zip(motions.chunks_exact(stride)) {
            chosen.push(self.choose(surrogate, domain, time, &motion[..coordinates])?);
        }
        let look_at_block = |(block, times): (usize, &[f64])| {
            let (mut work, mut previous) = (SurrogateWork::default(), Previous::default());
            let first = block * BLOCK;
            let at = |(place, &time): (usize, &f64)| {
                let row = first + place;
                let (closure, motion) = (self.closures[chosen[row]].as_ref(), &motions[row * stride..][..stride]);
                let at = Row::new(self.ensemble, surrogate, domain, closure, time, motion, &mut work);
                look(row, &at, &mut previous)
            };
            times.iter().enumerate().map(at).collect::<Vec<T>>()
        };
        let blocks: Vec<Vec<T>> = times.par_chunks(BLOCK).enumerate().map(look_at_block).collect();
        Ok(blocks.into_iter().flatten().collect())
    }

    /// The closure over the coordinates that are best taken as independent at the middle sample's motion.
    fn choose(
        &mut self,
        surrogate: &Surrogate,
        domain: &ParameterBox,
        time: f64,
        motion: &[f64],
    ) -> Result<usize, EnsembleError> {
        let middle = surrogate.middle();
        let parameters = domain.sample(&surrogate.samples()[middle]);
        let values: Vec<f64> = motion.chunks_exact(surrogate.samples().len()).map(|line| line[middle]).collect();
        let independent = self.ensemble.independent(&parameters, &values, time);
        if let Some(known) = self.closures.iter().position(|closure| closure.independent() == independent) {
            return Ok(known);
        }
        self.closures.push(self.ensemble.closure(independent)?);
        Ok(self.closures.len() - 1)
    }
}

/// Corners of the box at which a search looks first: all of eight parameters', and of more such that any two meet at all
/// their ends.
const CORNERS: usize = 256;

/// Rows looked at one after the other, so that each can begin where the one before ended. Fixed, so that results do not depend
/// on the number of threads.
const BLOCK: usize = 16;

/// One row of output.
pub(super) struct Row<'r> {
    ensemble: &'r dyn Ensemble,
    surrogate: &'r Surrogate,
    domain: &'r ParameterBox,
    closure: &'r dyn Closure,
    time: f64,
    /// Of each of the 2n lines, and then of each output.
    coefficients: Vec<f64>,
    /// Least and largest of each of the 2n lines over the samples.
    extent: Vec<(f64, f64)>,
    /// Each output's values at the samples.
    at_samples: &'r [f64],
}

/// The outputs' ranges in a row.
pub(super) struct Found {
    pub extents: Vec<Extent>,
    /// Whether an output does not follow from the coordinates here, and was expanded itself.
    pub expanded: Vec<bool>,
}

impl<'r> Row<'r> {
    fn new(
        ensemble: &'r dyn Ensemble,
        surrogate: &'r Surrogate,
        domain: &'r ParameterBox,
        closure: &'r dyn Closure,
        time: f64,
        motion: &'r [f64],
        work: &mut SurrogateWork,
    ) -> Self {
        let extent = |line: &[f64]| {
            line.iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)))
        };
        let (coordinates, at_samples) = motion.split_at(2 * ensemble.scales().len() * surrogate.samples().len());
        let extent = coordinates.chunks_exact(surrogate.samples().len()).map(extent).collect();
        let coefficients = surrogate.coefficients(motion, work);
        Self { ensemble, surrogate, domain, closure, time, coefficients, extent, at_samples }
    }

    /// What its polynomials are made by.
    pub fn surrogate(&self) -> &Surrogate {
        self.surrogate
    }

    /// Errors of the outputs' ranges: what the search may have missed, how far the coordinates' errors move the ends, and how
    /// far the validation samples at `points`, whose values in row `row` are in `direct`, lie outside.
    pub fn errors(
        &self,
        range_search: &RangeSearch,
        (points, direct): (&[Vec<f64>], &ValidationTable),
        row: usize,
        Found { extents, expanded }: &Found,
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
        Found { extents, expanded }: &Found,
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

    /// Every output's range over the box.
    pub fn range(&self, range_search: &RangeSearch, previous: &mut Previous) -> Found {
        let outputs = self.ensemble.outputs();
        let points = range_search.points();
        let compared: Vec<usize> = self.compared();
        let nodes = compared.iter().map(|&sample| self.surrogate.samples()[sample].clone());
        let all: Vec<Vec<f64>> = points.iter().cloned().chain(nodes).collect();
        let values = self.evaluate(&all);
        let every: Vec<usize> = (0..outputs).collect();
        let rounding: Vec<f64> = every.iter().map(|&output| self.rounding(output)).collect();
        let own = self.own_polynomials(&every, points);
        let (mut polynomials, mut composed) = (Vec::new(), Vec::new());
        let (mut defects, mut expanded) = (vec![0.0; outputs], vec![false; outputs]);
        for output in 0..outputs {
            let (here, at_nodes) = values[output * all.len()..][..all.len()].split_at(points.len());
            let own = &own[output * points.len()..][..points.len()];
            expanded[output] = self.disagrees(output, &compared, at_nodes);
            let defect = surrogate_error(own, here);
            if expanded[output] {
                polynomials.push(output);
            } else if defect <= ALIKE * Range::of(self.own_samples(output)).width() + rounding[output] {
                defects[output] = defect;
                polynomials.push(output);
            } else {
                composed.push(output);
            }
        }
        let of = |outputs: &[usize], values: &[f64], stride: usize| -> Vec<Vec<f64>> {
            outputs.iter().map(|&output| values[output * stride..][..points.len()].to_vec()).collect()
        };
        let mut extents = vec![Extent::unknown(self.domain.dimension()); outputs];
        let places = if range_search.climbs().is_some() { self.seeds(previous) } else { Vec::new() };
        let by_closure = |wanted: &[usize], points: &[Vec<f64>]| {
            let values = self.evaluate(points);
            wanted.iter().flat_map(|&output| values[output * points.len()..][..points.len()].to_vec()).collect()
        };
        let composed_values = of(&composed, &values, all.len());
        let functions = self.functions(composed, false, (&rounding, &places), &by_closure);
        for (&output, extent) in
            functions.outputs.iter().zip(range_search.range(&functions, &composed_values, previous))
        {
            if extent.range.width().is_finite() {
                extents[output] = extent;
            } else {
                expanded[output] = true;
                polynomials.push(output);
            }
        }
        let by_coefficients = |wanted: &[usize], points: &[Vec<f64>]| self.own_polynomials(wanted, points);
        let own_values = of(&polynomials, &own, points.len());
        let functions = self.functions(polynomials, true, (&rounding, &places), &by_coefficients);
        for (&output, mut extent) in functions.outputs.iter().zip(range_search.range(&functions, &own_values, previous))
        {
            extent.gap += defects[output];
            extents[output] = extent;
        }
        Found { extents, expanded }
    }

    fn functions<'f>(
        &'f self,
        outputs: Vec<usize>,
        are_polynomials: bool,
        (rounding, places): (&'f [f64], &'f [Vec<f64>]),
        evaluate: &'f Evaluate<'f>,
    ) -> Functions<'f> {
        Functions { outputs, degrees: self.surrogate.basis().orders(), are_polynomials, rounding, places, evaluate }
    }

    /// What of an output is too small a difference to be one.
    fn rounding(&self, output: usize) -> f64 {
        let range = Range::of(self.own_samples(output));
        // Of what is not a number nothing is known.
        ROUNDING * range.lower.abs().max(range.upper.abs()).max(0.0)
    }

    /// Samples at which outputs are held against the simulation, spread over all.
    fn compared(&self) -> Vec<usize> {
        let count = self.surrogate.samples().len();
        (0..count).step_by(count.div_ceil(COMPARED)).collect()
    }

    /// Whether an output that follows from the coordinates is not what was simulated; NaN is not.
    fn disagrees(&self, output: usize, compared: &[usize], values: &[f64]) -> bool {
        let simulated = self.own_samples(output);
        let range = Range::of(simulated);
        if range.lower.is_nan() {
            return false;
        }
        let allowed = DISAGREES.0 * range.width() + DISAGREES.1 * range.lower.abs().max(range.upper.abs());
        let differs = |(&sample, value): (&usize, &f64)| {
            let difference = (value - simulated[sample]).abs();
            difference.is_nan() || difference > allowed
        };
        compared.iter().zip(values).any(differs)
    }

    /// The samples with the least and the largest values of each output, some apart from each other, and the best corners.
    fn seeds(&self, previous: &Previous) -> Vec<Vec<f64>> {
        let samples = self.surrogate.samples();
        let mut seeds: Vec<Vec<f64>> = Vec::new();
        for output in 0..self.ensemble.outputs() {
            let values = self.own_samples(output);
            for sign in [-1.0, 1.0] {
                let mut order: Vec<usize> = (0..values.len()).collect();
                order.sort_by(|&a, &b| (sign * values[b]).total_cmp(&(sign * values[a])));
                let mut chosen: Vec<usize> = Vec::new();
                for sample in order {
                    let apart = |&other: &usize| {
                        samples[other].iter().zip(&samples[sample]).any(|(a, b)| (a - b).abs() > APART)
                    };
                    if chosen.len() < SEEDS && chosen.iter().all(apart) {
                        chosen.push(sample);
                    }
                }
                seeds.extend(chosen.into_iter().map(|sample| samples[sample].clone()));
            }
        }
        if previous.is_empty() {
            seeds.extend(self.best_corners());
        }
        seeds
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

    /// For each output the corners of the box at which it is least and largest.
    fn best_corners(&self) -> Vec<Vec<f64>> {
        let places = corners(self.domain.dimension(), CORNERS);
        let values = self.evaluate(&places);
        let of_output = |values: &[f64]| {
            let best =
                |sign: f64| (0..values.len()).fold(0, |a, b| if sign * values[b] > sign * values[a] { b } else { a });
            [best(-1.0), best(1.0)]
        };
        values.chunks_exact(places.len()).flat_map(of_output).map(|place| places[place].clone()).collect()
    }
}
