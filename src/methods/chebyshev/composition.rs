//! Composition: what is expanded is what is smooth. The independent coordinates and their velocities become polynomials of
//! the parameters; every output follows from them through the loop closure and its own formula.

use std::convert::Infallible;

use rayon::prelude::*;

use crate::methods::ensemble::{Closure, Ensemble, EnsembleError};
use crate::methods::validation::ValidationTable;
use crate::numerics::{
    Extent, ExtremeSearch, Extremes, ParameterBox, Range, SparseWork, Surrogate, SurrogateWork, corners, extremes,
    extremes_near, largest, step_error, surrogate_error,
};

/// For so many parameters ranges are found on a grid; for more, by a search.
const MOST_PARAMETERS: usize = 3;

/// Largest mechanism, in coordinates, whose independent coordinates are searched for in every row.
const MOST_COORDINATES: usize = 300;

/// An independent coordinate moves by this share of its scale from one point of the grid to the next.
const RESOLUTION: f64 = 0.15;

/// Fewest and most points of the grid along an axis, by the number of parameters.
const POINTS: [(usize, usize); MOST_PARAMETERS] = [(9, 129), (9, 33), (7, 15)];

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
    /// motions of a surrogate's samples over a box (`stride` values a row, the first 2n lines of samples).
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
        let lines = 2 * self.ensemble.scales().len() * surrogate.samples().len();
        let mut chosen = Vec::with_capacity(times.len());
        for (&time, motion) in times.iter().zip(motions.chunks_exact(stride)) {
            chosen.push(self.choose(surrogate, domain, time, &motion[..lines])?);
        }
        let look_at_block = |(block, times): (usize, &[f64])| {
            let (mut work, mut previous) = (SurrogateWork::default(), Previous::default());
            let first = block * BLOCK;
            let at = |(place, &time): (usize, &f64)| {
                let row = first + place;
                let (closure, motion) = (self.closures[chosen[row]].as_ref(), &motions[row * stride..][..lines]);
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
        let parameters = domain.point(&surrogate.samples()[middle]);
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

/// The extremes in the row before; nothing at first.
pub(super) type Previous = Vec<Extremes>;

/// How ranges over a box are found.
pub(super) enum RangeSearch {
    /// On a grid.
    Grid,
    /// By climbs.
    Climbs(ExtremeSearch),
}

impl RangeSearch {
    /// For k parameters.
    pub fn new(k: usize) -> Self {
        if k <= MOST_PARAMETERS { Self::Grid } else { Self::Climbs(ExtremeSearch::new(k)) }
    }
}

/// One row of output.
pub(super) struct Row<'r> {
    ensemble: &'r dyn Ensemble,
    surrogate: &'r Surrogate,
    domain: &'r ParameterBox,
    closure: &'r dyn Closure,
    time: f64,
    /// Of each of the 2n lines.
    coefficients: Vec<f64>,
    /// Least and largest of each line over the samples.
    extent: Vec<(f64, f64)>,
}

impl<'r> Row<'r> {
    fn new(
        ensemble: &'r dyn Ensemble,
        surrogate: &'r Surrogate,
        domain: &'r ParameterBox,
        closure: &'r dyn Closure,
        time: f64,
        motion: &[f64],
        work: &mut SurrogateWork,
    ) -> Self {
        let extent = |line: &[f64]| {
            line.iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)))
        };
        let extent = motion.chunks_exact(surrogate.samples().len()).map(extent).collect();
        let coefficients = surrogate.coefficients(motion, work);
        Self { ensemble, surrogate, domain, closure, time, coefficients, extent }
    }

    /// What its polynomials are made by.
    pub fn surrogate(&self) -> &Surrogate {
        self.surrogate
    }

    /// Points along each axis.
    pub fn resolution(&self) -> usize {
        let scale = self.ensemble.scales();
        let moved = self.closure.independent().iter().map(|&i| (self.extent[i].1 - self.extent[i].0) / scale[i]);
        let (least, most) = POINTS[self.domain.dimension().clamp(1, MOST_PARAMETERS) - 1];
        let wanted = moved.fold(0.0, f64::max) / RESOLUTION;
        if wanted.is_finite() { least.saturating_add(wanted as usize).min(most) } else { least }
    }

    /// Errors of the outputs' ranges: what the search may have missed, how far the coordinates' errors move the ends, and how
    /// far the validation samples at `points`, whose values in row `row` are in `direct`, lie outside.
    pub fn errors(
        &self,
        range_search: &RangeSearch,
        (points, direct): (&[Vec<f64>], &ValidationTable),
        row: usize,
        found: &[Extent],
    ) -> Vec<f64> {
        if row >= direct.rows() {
            return vec![f64::NAN; found.len()];
        }
        let moved = self.moved(range_search, found, &self.coordinate_errors(points, direct.motion(row)));
        let error = |(output, (found, moved)): (usize, (&Extent, f64))| {
            let outside = direct.at(row, output).into_iter().map(|value| found.range.distance(value));
            found.gap + largest(outside.chain([moved]))
        };
        found.iter().zip(moved).enumerate().map(error).collect()
    }

    /// The time steps' errors of the outputs' ranges: how far those of the coordinates, from samples with the steps as they are
    /// and with halved ones, move the ends.
    pub fn step_errors(
        &self,
        range_search: &RangeSearch,
        (direct, halved): (&ValidationTable, &ValidationTable),
        row: usize,
        found: &[Extent],
    ) -> Vec<f64> {
        if row >= direct.rows() || row >= halved.rows() {
            return vec![f64::NAN; found.len()];
        }
        let errors = self.of_independent(|line| step_error(direct.line(row, line), halved.line(row, line)));
        self.moved(range_search, found, &errors)
    }

    /// How far errors of the independent coordinates and their velocities (pairwise) move the ends of the outputs' ranges.
    ///
    /// All are moved together, one way and the other, and, where there are several, against each other.
    fn moved(&self, range_search: &RangeSearch, found: &[Extent], errors: &[(usize, f64)]) -> Vec<f64> {
        let several = self.closure.independent().len() > 1;
        let signs: &[[f64; 2]] =
            if several { &[[1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]] } else { &[[1.0; 2], [-1.0; 2]] };
        let mut moved = vec![0.0; found.len()];
        for signs in signs {
            let shift: Vec<(usize, f64)> =
                errors.iter().enumerate().map(|(place, &(line, error))| (line, signs[place / 2 % 2] * error)).collect();
            let shifted = self.range_near(range_search, found, &shift);
            for ((moved, found), shifted) in moved.iter_mut().zip(found).zip(&shifted) {
                let ends = [found.range.lower - shifted.range.lower, found.range.upper - shifted.range.upper];
                *moved = largest(ends.into_iter().chain([*moved]));
            }
        }
        moved
    }

    /// Every output's range over the box.
    pub fn range(&self, range_search: &RangeSearch, previous: &mut Previous) -> Vec<Extent> {
        match range_search {
            RangeSearch::Grid => {
                extremes(self.domain.dimension(), self.resolution(), |points| self.evaluate_shifted(points, &[]))
            }
            RangeSearch::Climbs(search) => {
                *previous = self.search(search, &self.starts(previous), &[]);
                previous.iter().cloned().map(extent).collect()
            }
        }
    }

    /// Ranges with some lines shifted, near those that are known.
    fn range_near(&self, range_search: &RangeSearch, near: &[Extent], shift: &[(usize, f64)]) -> Vec<Extent> {
        match range_search {
            RangeSearch::Grid => extremes_near(near, |points| self.evaluate_shifted(points, shift)),
            RangeSearch::Climbs(search) => {
                let near: Vec<Extremes> =
                    near.iter().map(|near| Extremes::at(near.range, near.places.clone())).collect();
                self.search(search, &near, shift).into_iter().map(extent).collect()
            }
        }
    }

    /// For each output the best of the box's corners and of what was best in the row before: where a search may begin.
    fn starts(&self, known: &[Extremes]) -> Vec<Extremes> {
        let mut places = corners(self.domain.dimension(), CORNERS);
        places.extend(known.iter().flat_map(|known| [known.lowest.clone(), known.highest.clone()]));
        let values = self.evaluate_shifted(&places, &[]);
        let of_output = |values: &[f64]| {
            let best =
                |sign: f64| (0..values.len()).fold(0, |a, b| if sign * values[b] > sign * values[a] { b } else { a });
            let (lowest, highest) = (best(-1.0), best(1.0));
            let range = Range { lower: values[lowest], upper: values[highest] };
            Extremes::at(range, [places[lowest].clone(), places[highest].clone()])
        };
        values.chunks_exact(places.len()).map(of_output).collect()
    }

    fn search(&self, search: &ExtremeSearch, near: &[Extremes], shift: &[(usize, f64)]) -> Vec<Extremes> {
        let evaluate = |points: &[Vec<f64>], values: &mut [f64]| {
            values.copy_from_slice(&self.evaluate_shifted(points, shift));
            Ok::<(), Infallible>(())
        };
        let Ok(found) = search.extremes(self.ensemble.outputs(), near, evaluate);
        found
    }

    /// The largest errors of the independent coordinates' polynomials, and of their velocities', at validation samples.
    fn coordinate_errors(&self, points: &[Vec<f64>], motion: &[f64]) -> Vec<(usize, f64)> {
        let expanded = self.expanded(points);
        let values = |line: usize| line * points.len()..(line + 1) * points.len();
        self.of_independent(|line| surrogate_error(&expanded[values(line)], &motion[values(line)]))
    }

    /// Lines of the independent coordinates and their velocities, pairwise, each with its error.
    fn of_independent(&self, error: impl Fn(usize) -> f64) -> Vec<(usize, f64)> {
        let n = self.extent.len() / 2;
        let lines = self.closure.independent().iter().flat_map(|&i| [i, n + i]);
        lines.map(|line| (line, error(line))).collect()
    }

    /// Every output at some ξ as it follows from the motion there: 2n lines of points.
    pub fn evaluate_motion(&self, points: &[Vec<f64>], motion: &[f64]) -> Vec<f64> {
        let motion = motion[..self.extent.len() * points.len()].to_vec();
        self.close(points, motion)
    }

    /// Every output at some ξ, output by output.
    pub fn evaluate(&self, points: &[Vec<f64>]) -> Vec<f64> {
        self.evaluate_shifted(points, &[])
    }

    fn evaluate_shifted(&self, points: &[Vec<f64>], shift: &[(usize, f64)]) -> Vec<f64> {
        let mut motion = vec![0.0; self.extent.len() * points.len()];
        let lines = if self.closure.needs_velocities() { self.extent.len() } else { self.extent.len() / 2 };
        self.expand(points, &mut motion[..lines * points.len()]);
        for &(line, shift) in shift {
            motion[line * points.len()..][..points.len()].iter_mut().for_each(|value| *value += shift);
        }
        // Dependent coordinates are only a guess, and are kept within what the samples have.
        let n = self.extent.len() / 2;
        for (line, (values, &(low, high))) in motion.chunks_exact_mut(points.len().max(1)).zip(&self.extent).enumerate()
        {
            if !self.closure.independent().contains(&(line % n)) && low <= high {
                values.iter_mut().for_each(|value| *value = value.clamp(low, high));
            }
        }
        self.close(points, motion)
    }

    /// The polynomials' values: 2n lines of points.
    fn expanded(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let mut motion = vec![0.0; self.extent.len() * points.len()];
        self.expand(points, &mut motion);
        motion
    }

    /// The first of them, as many lines as there is room for.
    fn expand(&self, points: &[Vec<f64>], motion: &mut [f64]) {
        let lines = motion.len() / points.len().max(1);
        let coefficients = &self.coefficients[..lines * self.surrogate.basis().len()];
        self.surrogate.basis().values(points, coefficients, motion, &mut SparseWork::default());
    }

    fn close(&self, points: &[Vec<f64>], motion: Vec<f64>) -> Vec<f64> {
        let parameters = (0..self.domain.dimension())
            .flat_map(|parameter| points.iter().map(move |xi| self.domain.value(parameter, xi[parameter])))
            .collect();
        self.closure.outputs(self.time, points.len(), parameters, motion)
    }
}

/// What a search found, which it may have missed by its tolerance.
fn extent(found: Extremes) -> Extent {
    Extent {
        range: found.range,
        gap: ExtremeSearch::TOLERANCE * found.range.width(),
        places: [found.lowest, found.highest],
    }
}
