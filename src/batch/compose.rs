//! Composition: what is expanded is what is smooth. The independent coordinates and their velocities become polynomials of
//! the parameters; every output follows from them through the loop closure and its own formula.

use std::convert::Infallible;

use rayon::prelude::*;

use crate::bounds::{Extent, ExtremeSearch, ParameterBox, Range, SparseWork, Surrogate, SurrogateWork, extremes};
use crate::integrate::{Closure, Points, SimulationError, Simulator, choose_independent};

/// For so many parameters ranges are found on a grid; for more, by a search.
const MOST_PARAMETERS: usize = 3;

/// Largest mechanism, in coordinates, whose independent coordinates are searched for in every row.
const MOST_COORDINATES: usize = 300;

/// An independent coordinate moves by this share of its scale from one point of the grid to the next.
const RESOLUTION: f64 = 0.15;

/// Fewest and most points of the grid along an axis, by the number of parameters.
const POINTS: [(usize, usize); MOST_PARAMETERS] = [(9, 129), (9, 33), (7, 15)];

/// Whether outputs of a mechanism can be composed over so many parameters.
pub(super) fn fits(simulator: &Simulator, k: usize) -> bool {
    k > 0 && simulator.system.q.len() <= MOST_COORDINATES
}

/// One mechanism's closures, and what is evaluated through them.
pub(super) struct Composer<'a> {
    simulator: &'a Simulator,
    /// Those used so far.
    closures: Vec<Closure<'a>>,
}

impl<'a> Composer<'a> {
    /// Which has used none yet.
    pub fn new(simulator: &'a Simulator) -> Self {
        Self { simulator, closures: Vec::new() }
    }

    /// Looks at rows, in parallel, given the motions of a surrogate's samples over a box (`stride` values a row, the first 2n
    /// lines of samples).
    ///
    /// # Errors
    /// Where a closure cannot be compiled.
    pub fn rows<T: Send>(
        &mut self,
        surrogate: &Surrogate,
        domain: &ParameterBox,
        times: &[f64],
        (motions, stride): (&[f64], usize),
        look: impl Fn(usize, &Row) -> T + Sync,
    ) -> Result<Vec<T>, SimulationError> {
        let lines = 2 * self.simulator.system.q.len() * surrogate.samples().len();
        let mut chosen = Vec::with_capacity(times.len());
        for (&time, motion) in times.iter().zip(motions.chunks_exact(stride)) {
            chosen.push(self.choose(surrogate, domain, time, &motion[..lines])?);
        }
        let rows = times.par_iter().zip(motions.par_chunks_exact(stride)).zip(&chosen).enumerate();
        let look = |work: &mut SurrogateWork, (row, ((&time, motion), &closure)): (usize, ((&f64, &[f64]), &usize))| {
            let closure = &self.closures[closure];
            look(row, &Row::new(self.simulator, surrogate, domain, closure, time, &motion[..lines], work))
        };
        Ok(rows.map_init(SurrogateWork::default, look).collect())
    }

    /// The closure over the coordinates that are best taken as independent at the middle sample's motion.
    fn choose(
        &mut self,
        surrogate: &Surrogate,
        domain: &ParameterBox,
        time: f64,
        motion: &[f64],
    ) -> Result<usize, SimulationError> {
        let middle = surrogate.middle();
        let parameters = domain.point(&surrogate.samples()[middle]);
        let values: Vec<f64> = motion.chunks_exact(surrogate.samples().len()).map(|line| line[middle]).collect();
        let independent = choose_independent(self.simulator, &parameters, &values, time);
        if let Some(known) = self.closures.iter().position(|closure| closure.independent() == independent) {
            return Ok(known);
        }
        self.closures.push(Closure::new(self.simulator, independent)?);
        Ok(self.closures.len() - 1)
    }
}

/// How ranges over a box are found.
pub(super) enum Seeker {
    Grid,
    Search(ExtremeSearch),
}

impl Seeker {
    /// For k parameters.
    pub fn new(k: usize) -> Self {
        if k <= MOST_PARAMETERS { Self::Grid } else { Self::Search(ExtremeSearch::new(k)) }
    }
}

/// One row of output.
pub(super) struct Row<'r> {
    simulator: &'r Simulator,
    surrogate: &'r Surrogate,
    domain: &'r ParameterBox,
    closure: &'r Closure<'r>,
    time: f64,
    /// Of each of the 2n lines.
    coefficients: Vec<f64>,
    /// Least and largest of each line over the samples.
    extent: Vec<(f64, f64)>,
}

impl<'r> Row<'r> {
    fn new(
        simulator: &'r Simulator,
        surrogate: &'r Surrogate,
        domain: &'r ParameterBox,
        closure: &'r Closure<'r>,
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
        Self { simulator, surrogate, domain, closure, time, coefficients, extent }
    }

    /// Points along each axis.
    fn resolution(&self) -> usize {
        let scale = &self.simulator.program.scale;
        let moved = self.closure.independent().iter().map(|&i| (self.extent[i].1 - self.extent[i].0) / scale[i]);
        let (least, most) = POINTS[self.domain.dimension().clamp(1, MOST_PARAMETERS) - 1];
        let wanted = moved.fold(0.0, f64::max) / RESOLUTION;
        if wanted.is_finite() { (least + wanted as usize).min(most) } else { least }
    }

    /// Every output's range over the box.
    pub fn ranges(&self, seeker: &Seeker) -> Vec<Extent> {
        match seeker {
            Seeker::Grid => extremes(self.domain.dimension(), self.resolution(), |points| self.evaluate(points)),
            Seeker::Search(search) => {
                let evaluate = |points: &[Vec<f64>], values: &mut [f64]| {
                    values.copy_from_slice(&self.evaluate(points));
                    Ok::<(), Infallible>(())
                };
                let Ok(found) = search.extremes(self.simulator.program.outputs.len(), &[], evaluate);
                let extent = |range: Range| Extent { range, gap: ExtremeSearch::TOLERANCE * range.width() };
                found.into_iter().map(|found| extent(found.range)).collect()
            }
        }
    }

    /// Every output at some ξ as it follows from the motion there: 2n lines of points.
    pub fn evaluate_motion(&self, points: &[Vec<f64>], motion: &[f64]) -> Vec<f64> {
        let motion = motion[..self.extent.len() * points.len()].to_vec();
        self.close(points, motion)
    }

    /// Every output at some ξ, output by output.
    pub fn evaluate(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let count = points.len();
        let mut motion = vec![0.0; self.extent.len() * count];
        self.surrogate.basis().values(points, &self.coefficients, &mut motion, &mut SparseWork::default());
        // Dependent coordinates are only a guess, and are kept within what the samples have.
        let n = self.extent.len() / 2;
        for (line, (values, &(low, high))) in motion.chunks_exact_mut(count.max(1)).zip(&self.extent).enumerate() {
            if !self.closure.independent().contains(&(line % n)) && low <= high {
                values.iter_mut().for_each(|value| *value = value.clamp(low, high));
            }
        }
        self.close(points, motion)
    }

    fn close(&self, points: &[Vec<f64>], motion: Vec<f64>) -> Vec<f64> {
        let parameters = (0..self.domain.dimension())
            .flat_map(|parameter| points.iter().map(move |xi| self.domain.value(parameter, xi[parameter])))
            .collect();
        let mut values = Vec::new();
        self.closure.outputs(self.time, &Points { count: points.len(), parameters, motion }, &mut values);
        values
    }
}
