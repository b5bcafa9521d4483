//! Composition: what is expanded is what is smooth. The independent coordinates and their velocities become polynomials of
//! the parameters; every output is evaluated from them through the loop closure and its own formula, on a grid over the
//! box as fine as the motion asks for, and its extremes are then sharpened.

use rayon::prelude::*;

use crate::bounds::{ChebyshevBasis, ParameterBox, Peak, Range, TensorGrid, Work};
use crate::integrate::{Closure, Points, SimulationError, Simulator, choose_independent};

/// More parameters than this make too large a grid; then the outputs themselves are expanded.
const MOST_PARAMETERS: usize = 3;

/// Largest mechanism, in coordinates, whose independent coordinates are searched for in every row.
const MOST_COORDINATES: usize = 300;

/// An independent coordinate moves by this share of its scale from one point of the grid to the next.
const RESOLUTION: f64 = 0.15;

/// Fewest and most points along an axis, by the number of parameters.
const POINTS: [(usize, usize); MOST_PARAMETERS] = [(9, 129), (9, 33), (7, 15)];

/// Composed bounds of one mechanism over one box.
pub(super) struct Composition<'a> {
    simulator: &'a Simulator,
    domain: &'a ParameterBox,
    basis: &'a ChebyshevBasis,
    /// ξ at which the outputs are wanted besides.
    probes: &'a [Vec<f64>],
    /// Those used so far.
    closures: Vec<Closure<'a>>,
}

/// What is found in one row.
pub(super) struct Composed {
    /// Of every output.
    pub ranges: Vec<Range>,
    /// How far the search for each range's ends may have missed them.
    pub gaps: Vec<f64>,
    /// Every output's values at the probes.
    pub at_probes: Vec<Vec<f64>>,
}

impl<'a> Composition<'a> {
    /// `None` where there are too many parameters or coordinates for it, or nothing is uncertain.
    pub fn new(
        simulator: &'a Simulator,
        domain: &'a ParameterBox,
        basis: &'a ChebyshevBasis,
        probes: &'a [Vec<f64>],
    ) -> Option<Self> {
        let fits = (1..=MOST_PARAMETERS).contains(&domain.dimension()) && simulator.system.q.len() <= MOST_COORDINATES;
        fits.then(|| Self { simulator, domain, basis, probes, closures: Vec::new() })
    }

    /// Each row's findings, from the samples' motions (`stride` values a row, the first 2n lines of samples).
    ///
    /// # Errors
    /// Where a closure cannot be compiled.
    pub fn rows(&mut self, times: &[f64], motions: &[f64], stride: usize) -> Result<Vec<Composed>, SimulationError> {
        let lines = 2 * self.simulator.system.q.len() * self.basis.grid().len();
        let mut chosen = Vec::with_capacity(times.len());
        for (&time, motion) in times.iter().zip(motions.chunks_exact(stride)) {
            chosen.push(self.choose(time, &motion[..lines])?);
        }
        let this = &*self;
        let rows = times.par_iter().zip(motions.par_chunks_exact(stride)).zip(&chosen);
        let find = |((&time, motion), &closure): ((&f64, &[f64]), &usize)| {
            Row::new(this, &this.closures[closure], time, &motion[..lines]).find()
        };
        Ok(rows.map(find).collect())
    }

    /// The closure over the coordinates that are best taken as independent at the middle sample's motion.
    fn choose(&mut self, time: f64, motion: &[f64]) -> Result<usize, SimulationError> {
        let samples = self.basis.grid();
        let middle = samples.len() / 2;
        let mut parameters = vec![0.0; self.domain.dimension()];
        self.domain.map(&samples.sample(middle), &mut parameters);
        let values: Vec<f64> = motion.chunks_exact(samples.len()).map(|line| line[middle]).collect();
        let independent = choose_independent(self.simulator, &parameters, &values, time);
        if let Some(known) = self.closures.iter().position(|closure| closure.independent() == independent) {
            return Ok(known);
        }
        self.closures.push(Closure::new(self.simulator, independent)?);
        Ok(self.closures.len() - 1)
    }
}

/// One row of output.
struct Row<'r, 'a> {
    composition: &'r Composition<'a>,
    closure: &'r Closure<'a>,
    time: f64,
    /// Coefficients of each of the 2n lines.
    coefficients: Vec<Vec<f64>>,
    /// Least and largest of each line over the samples.
    extent: Vec<(f64, f64)>,
}

impl<'r, 'a> Row<'r, 'a> {
    fn new(composition: &'r Composition<'a>, closure: &'r Closure<'a>, time: f64, motion: &[f64]) -> Self {
        let mut work = Work::default();
        let lines = motion.chunks_exact(composition.basis.grid().len());
        let coefficients = lines.clone().map(|line| composition.basis.coefficients(line, &mut work).to_vec()).collect();
        let extent = lines.map(|line| {
            line.iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)))
        });
        Self { composition, closure, time, coefficients, extent: extent.collect() }
    }

    /// Points along each axis.
    fn resolution(&self) -> usize {
        let scale = &self.composition.simulator.program.scale;
        let moved = self.closure.independent().iter().map(|&i| (self.extent[i].1 - self.extent[i].0) / scale[i]);
        let (least, most) = POINTS[self.composition.domain.dimension() - 1];
        let wanted = moved.fold(0.0, f64::max) / RESOLUTION;
        if wanted.is_finite() { (least + wanted as usize).min(most) } else { least }
    }

    fn find(&self) -> Composed {
        let k = self.composition.domain.dimension();
        let points = self.resolution();
        let grid = TensorGrid::full_factorial(&vec![points; k]);
        let on_grid = self.composition.basis.on(&grid);
        let motion = |line: usize| on_grid.values(&self.coefficients[line]);
        let mut values = Vec::new();
        self.closure.outputs(self.time, &self.points(&grid, motion), &mut values);
        let mut ends: Vec<End> = values
            .chunks_exact(grid.len())
            .flat_map(|line| SIGNS.map(|sign| End::on_grid(line, &grid, sign)))
            .collect();

        for _ in 0..ROUNDS {
            let searched: Vec<usize> = (0..ends.len()).filter(|&end| !ends[end].found).collect();
            let points: Vec<Vec<f64>> = searched.iter().flat_map(|&end| ends[end].points()).collect();
            if points.is_empty() {
                break;
            }
            let values = self.evaluate(&points);
            let mut first = 0;
            for end in searched {
                let count = ends[end].points().len();
                let width = ends[end | 1].best - ends[end & !1].best;
                ends[end].refine(&values[end / 2 * points.len() + first..][..count], width);
                first += count;
            }
        }
        let probes = self.composition.probes;
        let ends = ends.chunks_exact(2);
        Composed {
            ranges: ends.clone().map(|ends| Range { lower: ends[0].best, upper: ends[1].best }).collect(),
            gaps: ends.map(|ends| if ends[0].gap > ends[1].gap { ends[0].gap } else { ends[1].gap }).collect(),
            at_probes: self.evaluate(probes).chunks_exact(probes.len()).map(<[f64]>::to_vec).collect(),
        }
    }

    /// Every output at some ξ, output by output.
    fn evaluate(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let at: Vec<&Vec<f64>> = points.iter().collect();
        let motion = |line: usize| -> Vec<f64> {
            at.iter().map(|xi| self.composition.basis.evaluate(&self.coefficients[line], xi)).collect()
        };
        let mut values = Vec::new();
        self.closure.outputs(self.time, &self.scattered(&at, motion), &mut values);
        values
    }

    fn points(&self, grid: &TensorGrid, motion: impl Fn(usize) -> Vec<f64>) -> Points {
        let samples: Vec<Vec<f64>> = (0..grid.len()).map(|index| grid.sample(index)).collect();
        self.scattered(&samples.iter().collect::<Vec<_>>(), motion)
    }

    /// Points at the given ξ. Dependent coordinates are only a guess, and are kept within what the samples have.
    fn scattered(&self, at: &[&Vec<f64>], motion: impl Fn(usize) -> Vec<f64>) -> Points {
        let domain = self.composition.domain;
        let parameters = (0..domain.dimension())
            .flat_map(|parameter| at.iter().map(move |xi| domain.value(parameter, xi[parameter])))
            .collect();
        let n = self.extent.len() / 2;
        let mut values = Vec::with_capacity(self.extent.len() * at.len());
        for (line, &(low, high)) in self.extent.iter().enumerate() {
            let mut motion = motion(line);
            if !self.closure.independent().contains(&(line % n)) && low <= high {
                motion.iter_mut().for_each(|value| *value = value.clamp(low, high));
            }
            values.extend(motion);
        }
        Points { count: at.len(), parameters, motion: values }
    }
}

/// The least and the largest value are sought.
const SIGNS: [f64; 2] = [-1.0, 1.0];

/// Most steps of the search for an end.
const ROUNDS: usize = 10;

/// An end is found when a step changes less than this share of the range's width.
const SETTLED: f64 = 1e-6;

/// One end of an output's range, as it is found.
struct End {
    sign: f64,
    /// Where the peak is looked for, and where it is believed to be.
    around: Peak,
    xi: Vec<f64>,
    /// The best value seen, and where; not a number where one was not.
    best: f64,
    best_xi: Vec<f64>,
    /// What the last step of the search changed.
    gap: f64,
    found: bool,
}

impl End {
    /// The best of the values on a grid, and the peak that its neighbours tell.
    fn on_grid(values: &[f64], grid: &TensorGrid, sign: f64) -> Self {
        let better = |a: usize, b: usize| if sign * values[b] > sign * values[a] { b } else { a };
        let place = (0..values.len()).fold(0, better);
        let unknown = values.iter().any(|value| value.is_nan());
        let best = if unknown { f64::NAN } else { values[place] };

        let peak = Peak::new(grid.sample(place), grid.spacing());
        let middle = grid.inner(place);
        let stencil: Vec<f64> = peak.stencil().iter().map(|offsets| values[grid.beside(middle, offsets)]).collect();
        let xi = peak.vertex(&stencil, sign);
        Self { sign, around: peak.next(&xi), xi, best, best_xi: grid.sample(place), gap: 0.0, found: unknown }
    }

    /// Where the function is needed for the next step: around the peak, and on it.
    fn points(&self) -> Vec<Vec<f64>> {
        let stencil = self.around.stencil();
        stencil.iter().map(|offsets| self.around.neighbour(offsets)).chain([self.xi.clone()]).collect()
    }

    /// Takes in the values there. `width` is that of the range so far.
    fn refine(&mut self, values: &[f64], width: f64) {
        let best = (0..values.len()).fold(0, |a, b| if self.sign * values[b] > self.sign * values[a] { b } else { a });
        let gain = self.sign * (values[best] - self.best);
        // Not a number beside the grid's points changes nothing.
        if gain > 0.0 {
            self.gap = gain;
            self.found = gain <= SETTLED * width;
            self.best = values[best];
            self.best_xi = self.points().swap_remove(best);
            self.xi = self.around.vertex(&values[..values.len() - 1], self.sign);
            self.around = self.around.next(&self.xi);
        } else {
            // Nothing better around the best, or the quadratic led away from it.
            self.gap = 0.0;
            self.found = self.xi == self.best_xi;
            self.xi.clone_from(&self.best_xi);
            self.around = self.around.nearer(&self.xi);
        }
    }
}
