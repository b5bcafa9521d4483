//! Composition: what is expanded is what is smooth. The independent coordinates and their velocities become polynomials of
//! the parameters; every output is evaluated from them through the loop closure and its own formula, on a grid over the
//! box as fine as the motion asks for, and its extremes are then sharpened.

use rayon::prelude::*;

use crate::bounds::{ChebyshevBasis, ParameterBox, Range, TensorGrid, Work};
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
    /// Those used so far.
    closures: Vec<Closure<'a>>,
}

impl<'a> Composition<'a> {
    /// Whether so many parameters and coordinates can be composed: some, and not too many.
    pub fn fits(parameters: usize, coordinates: usize) -> bool {
        (1..=MOST_PARAMETERS).contains(&parameters) && coordinates <= MOST_COORDINATES
    }

    /// `None` where it does not fit.
    pub fn new(simulator: &'a Simulator, domain: &'a ParameterBox, basis: &'a ChebyshevBasis) -> Option<Self> {
        Self::fits(domain.dimension(), simulator.system.q.len()).then(|| Self {
            simulator,
            domain,
            basis,
            closures: Vec::new(),
        })
    }

    /// Ranges of the outputs, row by row, output by output, from the samples' motions (`stride` values a row: 2n lines of
    /// samples).
    ///
    /// # Errors
    /// Where a closure cannot be compiled.
    pub fn ranges(&mut self, times: &[f64], motions: &[f64], stride: usize) -> Result<Vec<Range>, SimulationError> {
        let mut chosen = Vec::with_capacity(times.len());
        for (&time, motion) in times.iter().zip(motions.chunks_exact(stride)) {
            chosen.push(self.choose(time, motion)?);
        }
        let this = &*self;
        let rows: Vec<Vec<Range>> = times
            .par_iter()
            .zip(motions.par_chunks_exact(stride))
            .zip(&chosen)
            .map(|((&time, motion), &closure)| Row::new(this, &this.closures[closure], time, motion).ranges())
            .collect();
        Ok(rows.concat())
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

    fn ranges(&self) -> Vec<Range> {
        let k = self.composition.domain.dimension();
        let points = self.resolution();
        let grid = TensorGrid::full_factorial(&vec![points; k]);
        let on_grid = self.composition.basis.on(&grid);
        let motion = |line: usize| on_grid.values(&self.coefficients[line]);
        let mut values = Vec::new();
        self.closure.outputs(self.time, &self.points(&grid, motion), &mut values);
        let found: Vec<(Range, [usize; 2])> = values.chunks_exact(grid.len()).map(extremes).collect();

        // Around each extreme of the grid a parabola along every axis says where the true one is.
        let sharper: Vec<Vec<Vec<f64>>> = values
            .chunks_exact(grid.len())
            .zip(&found)
            .map(|(line, (_, places))| places.iter().map(|&place| vertex(line, place, &grid)).collect())
            .collect();
        let axes: Vec<&Vec<f64>> = sharper.iter().flatten().collect();
        let motion = |line: usize| -> Vec<f64> {
            axes.iter().map(|xi| self.composition.basis.evaluate(&self.coefficients[line], xi)).collect()
        };
        let points = self.scattered(&axes, motion);
        self.closure.outputs(self.time, &points, &mut values);
        let lines = values.chunks_exact(axes.len()).enumerate();
        lines.zip(found).map(|((output, line), (range, _))| widen(range, &line[2 * output..2 * output + 2])).collect()
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

/// Range of values and where its ends are; not a number anywhere makes it unknown.
fn extremes(values: &[f64]) -> (Range, [usize; 2]) {
    if values.iter().any(|value| value.is_nan()) {
        return (Range::UNKNOWN, [0, 0]);
    }
    let mut places = [0, 0];
    for (place, value) in values.iter().enumerate() {
        if *value < values[places[0]] {
            places[0] = place;
        }
        if *value > values[places[1]] {
            places[1] = place;
        }
    }
    (Range { lower: values[places[0]], upper: values[places[1]] }, places)
}

/// ξ of the vertex of the parabolas through a point of the grid and its neighbours along each axis.
fn vertex(values: &[f64], place: usize, grid: &TensorGrid) -> Vec<f64> {
    let mut xi = grid.sample(place);
    let mut stride = 1;
    for axis in (0..grid.dimension()).rev() {
        let points = grid.axis(axis);
        let index = place / stride % points.len();
        if index > 0 && index + 1 < points.len() {
            let (before, here, after) = (values[place - stride], values[place], values[place + stride]);
            let bend = before - 2.0 * here + after;
            let shift = 0.5 * (before - after) / bend;
            if shift.abs() < 1.0 {
                xi[axis] += shift * (points[index + 1] - points[index]);
            }
        }
        stride *= points.len();
    }
    xi
}

fn widen(range: Range, further: &[f64]) -> Range {
    let finite = || further.iter().copied().filter(|value| value.is_finite());
    Range { lower: finite().fold(range.lower, f64::min), upper: finite().fold(range.upper, f64::max) }
}
