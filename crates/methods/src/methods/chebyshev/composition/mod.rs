//! Composition: the smooth functions are expanded. The independent coordinates and their velocities become polynomials
//! of the parameters; every output follows from them through the loop closure and its own formula.
//!
//! If an output that is composed in this way is the same polynomial as the one through its own samples, that polynomial
//! replaces it: its range costs no closure. If it is NaN, or differs from the simulated samples, that polynomial
//! replaces it too, as with `expand: output`.

mod composer;
mod errors;
mod evaluation;
mod phases;
pub(crate) mod tuning;

pub(super) use composer::{Composer, NodeMotions};
use phases::{as_times, phases, with_turns};
pub(super) use phases::{courses, turning};

use super::range_search::{Evaluate, Functions, Previous, RangeSearch, block};
use crate::methods::closure::Closure;
use crate::methods::ensemble::Ensemble;
use crate::methods::expansion::Moves;
use crate::numerics::{
    Course, Extent, ParameterBox, Phase, Range, Surrogate, SurrogateWork, corners, largest, limits, surrogate_error,
};
use tuning::TUNING;

/// Whether outputs can be composed: there are uncertain parameters, and not too many coordinates.
pub fn can_compose(parameters: usize, coordinates: usize) -> bool {
    parameters > 0 && (1..=TUNING.most_coordinates).contains(&coordinates)
}

/// Motions and outputs of a surrogate's samples in one row.
struct RowMotion<'r> {
    /// s.
    time: f64,
    /// Line by line, sample by sample.
    motion: &'r [f64],
    courses: &'r [Option<Course>],
    /// Whether velocities are expanded.
    velocities: bool,
}

/// One row of output.
pub(super) struct Row<'r> {
    ensemble: &'r dyn Ensemble,
    surrogate: &'r Surrogate,
    domain: &'r ParameterBox,
    closure: &'r dyn Closure,
    time: f64,
    /// Coefficients of each of the 2n lines, and then of each output; zero for velocities that are not expanded.
    coefficients: Vec<f64>,
    velocities: bool,
    /// Least and largest of each of the 2n lines over the samples.
    extent: Vec<(f64, f64)>,
    /// Each output's values at the samples.
    at_samples: &'r [f64],
    /// Coordinates that are expanded as times of their courses.
    phases: Vec<(usize, Phase<'r>)>,
}

/// The outputs' ranges in a row.
pub(super) struct Found {
    pub extents: Vec<Extent>,
    /// Whether an output does not follow from the coordinates here, and was expanded itself.
    pub expanded: Vec<bool>,
    /// Whether an output is the polynomial through its own samples, or was expanded itself.
    pub own: Vec<bool>,
}

/// Outputs by how their ranges are found.
#[derive(Default)]
struct Sorted {
    /// They are the polynomials through their own samples,
    alike: Vec<usize>,
    /// they follow from the coordinates,
    composed: Vec<usize>,
    /// or they differ from the values that follow from the coordinates.
    lost: Vec<usize>,
    /// Distance of each from its own polynomial.
    defects: Vec<f64>,
}

impl<'r> Row<'r> {
    fn new(
        ensemble: &'r dyn Ensemble,
        surrogate: &'r Surrogate,
        domain: &'r ParameterBox,
        closure: &'r dyn Closure,
        RowMotion { time, motion, courses, velocities }: RowMotion<'r>,
        work: &mut SurrogateWork,
    ) -> Self {
        let count = surrogate.samples().len();
        let (coordinates, others) = motion.split_at(2 * ensemble.scales().len() * count);
        let (at_samples, times) = others.split_at(ensemble.outputs() * count);
        let extent: Vec<(f64, f64)> = coordinates.chunks_exact(count).map(limits).collect();
        let phases = phases(closure, courses, &extent);
        let wanted = if velocities { coordinates } else { &coordinates[..coordinates.len() / 2] };
        let expanded = as_times(wanted, &phases, courses, times, count);
        let mut coefficients = surrogate.coefficients(&[&expanded, at_samples].concat(), work);
        if !velocities {
            let of_outputs = coefficients.split_off(ensemble.scales().len() * surrogate.basis().len());
            coefficients.resize(2 * coefficients.len(), 0.0);
            coefficients.extend(of_outputs);
        }
        Self { ensemble, surrogate, domain, closure, time, coefficients, velocities, extent, at_samples, phases }
    }

    /// Surrogate of its polynomials.
    pub fn surrogate(&self) -> &Surrogate {
        self.surrogate
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.ensemble.outputs()
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
        let at = |output: usize| {
            let (here, at_nodes) = values[output * all.len()..][..all.len()].split_at(points.len());
            (here, at_nodes, &own[output * points.len()..][..points.len()])
        };
        let Sorted { alike, mut composed, mut lost, defects } = self.sorted(&compared, &rounding, at);
        let of = |outputs: &[usize], values: &[f64], stride: usize| -> Vec<Vec<f64>> {
            outputs.iter().map(|&output| values[output * stride..][..points.len()].to_vec()).collect()
        };
        let degrees = self.degrees();
        let mut extents = vec![Extent::unknown(self.domain.dimension()); outputs];
        let places = if range_search.climbs().is_some() { self.seeds() } else { Vec::new() };
        let by_closure =
            |wanted: &[usize], points: &[Vec<f64>]| self.evaluate_some(wanted, points, &[Moves::default()]);
        let by_coefficients = |wanted: &[usize], points: &[Vec<f64>]| self.own_polynomials(wanted, points);
        let of_polynomials = |outputs: &[usize], previous: &mut Previous| {
            let functions = self.functions(outputs.to_vec(), None, &rounding, &places, &by_coefficients);
            range_search.range(&functions, &of(outputs, &own, points.len()), previous)
        };
        let found = of_polynomials(&alike, previous);
        let mut is_own = vec![false; outputs];
        for ((&output, mut extent), apart) in alike.iter().zip(found.clone()).zip(self.apart_at_ends(&alike, &found)) {
            // A kink between all samples shows at the end of the range. Written so that NaN does too.
            if apart <= self.alike(output, &rounding) + extent.gap {
                extent.gap += largest([defects[output], apart]);
                extents[output] = extent;
                is_own[output] = true;
            } else {
                composed.push(output);
            }
        }
        composed.sort_unstable();
        let composed_values = of(&composed, &values, all.len());
        let functions = self.functions(composed, Some(&degrees), &rounding, &places, &by_closure);
        let mut ranges = range_search.range(&functions, &composed_values, previous);
        self.to_brinks(&functions.outputs, &mut ranges, &Moves::default());
        for (&output, extent) in functions.outputs.iter().zip(ranges) {
            if extent.range.width().is_finite() {
                extents[output] = extent;
            } else {
                lost.push(output);
            }
        }
        let mut expanded = vec![false; outputs];
        for (&output, extent) in lost.iter().zip(of_polynomials(&lost, previous)) {
            (extents[output], expanded[output], is_own[output]) = (extent, true, true);
        }
        Found { extents, expanded, own: is_own }
    }

    /// Sorts the outputs, given the values of each at some points and at the compared samples, and those of its own
    /// polynomial at the points.
    fn sorted<'v>(
        &self,
        compared: &[usize],
        rounding: &[f64],
        at: impl Fn(usize) -> (&'v [f64], &'v [f64], &'v [f64]),
    ) -> Sorted {
        let mut sorted = Sorted::default();
        for output in 0..self.ensemble.outputs() {
            let (here, at_nodes, own) = at(output);
            let defect = surrogate_error(own, here);
            sorted.defects.push(defect);
            if self.disagrees(output, compared, at_nodes) {
                sorted.lost.push(output);
            } else if defect <= self.alike(output, rounding) && !self.ensemble.jumps(output) {
                sorted.alike.push(output);
            } else {
                sorted.composed.push(output);
            }
        }
        sorted
    }

    /// Largest difference of an output from its own polynomial with which they are the same.
    fn alike(&self, output: usize, rounding: &[f64]) -> f64 {
        TUNING.alike * Range::of(self.own_samples(output)).width() + rounding[output]
    }

    /// Distances of outputs, as they follow from the coordinates, from the ends of these ranges where those are
    /// attained.
    fn apart_at_ends(&self, outputs: &[usize], found: &[Extent]) -> Vec<f64> {
        let ends = self.at_own_ends(outputs, found, &[Moves::default()]);
        let apart = |([least, most], found): (&[f64; 2], &Extent)| {
            largest([least - found.range.lower, most - found.range.upper])
        };
        ends.iter().zip(found).map(apart).collect()
    }

    /// Highest degree along each axis, or the one that stands for it if a coordinate turns more often.
    fn degrees(&self) -> Vec<u8> {
        with_turns(self.surrogate.basis(), &self.coefficients, &self.phases, &self.extent, self.ensemble.scales())
    }

    /// Outputs as polynomials, or, where degrees are given that stand for them, as they are composed.
    fn functions<'f>(
        &'f self,
        outputs: Vec<usize>,
        composed: Option<&'f [u8]>,
        rounding: &'f [f64],
        places: &'f [Vec<Vec<f64>>],
        evaluate: &'f Evaluate<'f>,
    ) -> Functions<'f> {
        let degrees = composed.unwrap_or(self.surrogate.basis().orders());
        Functions { outputs, degrees, are_polynomials: composed.is_none(), rounding, places, evaluate }
    }

    /// Differences of an output below this are rounding.
    fn rounding(&self, output: usize) -> f64 {
        let range = Range::of(self.own_samples(output));
        // Where it is NaN, nothing is known.
        TUNING.rounding * range.lower.abs().max(range.upper.abs()).max(0.0)
    }

    /// Samples at which outputs are compared with the simulation, spread over all.
    fn compared(&self) -> Vec<usize> {
        let count = self.surrogate.samples().len();
        (0..count).step_by(count.div_ceil(TUNING.compared)).collect()
    }

    /// Whether an output that follows from the coordinates differs from the simulated one; NaN counts as different.
    fn disagrees(&self, output: usize, compared: &[usize], values: &[f64]) -> bool {
        let simulated = self.own_samples(output);
        let range = Range::of(simulated);
        if range.lower.is_nan() {
            return false;
        }
        let allowed =
            TUNING.disagrees.0 * range.width() + TUNING.disagrees.1 * range.lower.abs().max(range.upper.abs());
        let differs = |(&sample, value): (&usize, &f64)| {
            let difference = (value - simulated[sample]).abs();
            difference.is_nan() || difference > allowed
        };
        compared.iter().zip(values).any(differs)
    }

    /// Points at which outputs are known to be large or small, block by block of those that are searched together:
    /// those with the least and the largest values of each output, some apart from each other, and the best corners.
    fn seeds(&self) -> Vec<Vec<Vec<f64>>> {
        let every: Vec<usize> = (0..self.ensemble.outputs()).collect();
        // In every row: the row before knows the corner that was best there, and where the best changes to another, no
        // sample may be near it.
        let corners = self.best_corners();
        let of_block = |outputs: &[usize]| -> Vec<Vec<f64>> {
            let samples = outputs.iter().flat_map(|&output| self.best_samples(output));
            samples.chain(outputs.iter().flat_map(|&output| corners[2 * output..][..2].to_vec())).collect()
        };
        every.chunk_by(|a, b| block(*a) == block(*b)).map(of_block).collect()
    }

    /// The samples with the least and the largest values of an output, some apart from each other.
    fn best_samples(&self, output: usize) -> Vec<Vec<f64>> {
        let (samples, values) = (self.surrogate.samples(), self.own_samples(output));
        let best = |sign: f64| {
            let mut order: Vec<usize> = (0..values.len()).collect();
            order.sort_by(|&a, &b| (sign * values[b]).total_cmp(&(sign * values[a])));
            let mut chosen: Vec<usize> = Vec::new();
            for sample in order {
                let apart = |&other: &usize| {
                    samples[other].iter().zip(&samples[sample]).any(|(a, b)| (a - b).abs() > TUNING.seeds_apart)
                };
                if chosen.len() < TUNING.seeds && chosen.iter().all(apart) {
                    chosen.push(sample);
                }
            }
            chosen
        };
        [-1.0, 1.0].into_iter().flat_map(best).map(|sample| samples[sample].clone()).collect()
    }

    /// For each output the corners of the box at which it is least and largest.
    pub fn best_corners(&self) -> Vec<Vec<f64>> {
        let places = corners(self.domain.dimension(), TUNING.corners);
        let values = self.predict(&places);
        let of_output = |values: &[f64]| {
            let best =
                |sign: f64| (0..values.len()).fold(0, |a, b| if sign * values[b] > sign * values[a] { b } else { a });
            [best(-1.0), best(1.0)]
        };
        values.chunks_exact(places.len()).flat_map(of_output).map(|index| places[index].clone()).collect()
    }
}
