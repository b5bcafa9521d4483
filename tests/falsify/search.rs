//! The range of a term's channels over its box: a dense grid, and from its best points a local search. For closed forms
//! the search evaluates them; for what is integrated it evaluates polynomials through the grid's points. Nothing here
//! is mbint's.

use crate::draw::{Parameter, Term};
use crate::truth::Range;

/// Candidates of each end that are refined.
const CANDIDATES: usize = 3;

/// Samples of a term on a grid over its uncertain parameters.
struct Grid<'t> {
    term: &'t Term,
    parameters: Vec<Parameter>,
    uncertain: Vec<usize>,
    /// Points along each.
    points: usize,
    /// Sample by sample, channel by channel, row by row; the first uncertain parameter varies fastest.
    values: Vec<Vec<Vec<f64>>>,
}

/// Of every channel its range at every time; at each level with about twice as many points along each parameter.
pub fn ranges(term: &Term, times: &[f64], level: u32) -> Vec<Vec<Range>> {
    let grid = Grid::new(term, times, level);
    let channels = term.channels.len();
    let range = |channel, row| {
        let end = |sign: f64| sign * grid.greatest(channel, row, times[row], sign);
        Range { lower: end(-1.0), upper: end(1.0) }
    };
    (0..channels).map(|channel| (0..times.len()).map(|row| range(channel, row)).collect()).collect()
}

/// Whether the curves change with a parameter, in the middle of the others' intervals or at their ends: a grid has the
/// more points the fewer parameters it has.
fn matters(term: &Term, parameters: &[Parameter], which: usize, times: &[f64]) -> bool {
    let curves = |others: usize, own: usize| {
        let value = |(i, parameter): (usize, &Parameter)| {
            let [lower, upper] = parameter.interval();
            [lower, upper, parameter.value][if i == which { own } else { others }]
        };
        (term.curves)(&parameters.iter().enumerate().map(value).collect::<Vec<f64>>(), times)
    };
    parameters[which].half > 0.0 && (0..3).any(|others| curves(others, 0) != curves(others, 1))
}

impl<'t> Grid<'t> {
    fn new(term: &'t Term, times: &[f64], level: u32) -> Self {
        let parameters = term.seen();
        let uncertain: Vec<usize> = (0..parameters.len()).filter(|&i| matters(term, &parameters, i, times)).collect();
        let few = match (uncertain.len(), term.integrated) {
            (0 | 1, false) => 512,
            (0 | 1, true) => 96,
            (2, false) => 48,
            (2, true) => 20,
            (3, false) => 14,
            (3, true) => 8,
            (_, false) => 8,
            (_, true) => 4,
        };
        let points = (few << level) + 1;
        let mut grid = Self { term, parameters, uncertain, points, values: Vec::new() };
        let samples = points.pow(grid.uncertain.len() as u32);
        grid.values = (0..samples).map(|sample| (term.curves)(&grid.at(&grid.place(sample)), times)).collect();
        grid
    }

    /// Coordinates of a sample, in cells.
    fn place(&self, sample: usize) -> Vec<f64> {
        let mut rest = sample;
        let mut coordinate = || {
            let coordinate = rest % self.points;
            rest /= self.points;
            coordinate as f64
        };
        self.uncertain.iter().map(|_| coordinate()).collect()
    }

    /// Values of the parameters there.
    fn at(&self, place: &[f64]) -> Vec<f64> {
        let mut values: Vec<f64> = self.parameters.iter().map(|parameter| parameter.value).collect();
        for (&which, &cell) in self.uncertain.iter().zip(place) {
            let [lower, upper] = self.parameters[which].interval();
            let share = cell / (self.points - 1) as f64;
            values[which] = lower + (upper - lower) * share;
        }
        values
    }

    /// The greatest value of sign times a channel.
    fn greatest(&self, channel: usize, row: usize, time: f64, sign: f64) -> f64 {
        let value = |sample: usize| sign * self.values[sample][channel][row];
        let mut candidates: Vec<usize> =
            (0..self.values.len()).filter(|&sample| self.is_local(sample, &value)).collect();
        candidates.sort_by(|&a, &b| value(b).total_cmp(&value(a)));
        candidates.truncate(CANDIDATES);
        let refined = candidates.iter().map(|&sample| {
            let known = value(sample);
            if self.uncertain.is_empty() {
                return known;
            }
            let exact = |place: &[f64]| sign * (self.term.curves)(&self.at(place), &[time])[channel][0];
            let between = |place: &[f64]| sign * self.interpolated(sample, place, channel, row);
            let f: &dyn Fn(&[f64]) -> f64 = if self.term.integrated { &between } else { &exact };
            self.climb(self.place(sample), known, f)
        });
        refined.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether no neighbour along a parameter is greater.
    fn is_local(&self, sample: usize, value: &impl Fn(usize) -> f64) -> bool {
        let here = value(sample);
        let mut stride = 1;
        for _ in &self.uncertain {
            let coordinate = sample / stride % self.points;
            let below = coordinate > 0 && value(sample - stride) > here;
            let above = coordinate + 1 < self.points && value(sample + stride) > here;
            if below || above {
                return false;
            }
            stride *= self.points;
        }
        true
    }

    /// From a point of the grid uphill, in steps that fall from half a cell, at most one cell away.
    fn climb(&self, start: Vec<f64>, known: f64, f: &dyn Fn(&[f64]) -> f64) -> f64 {
        let last = (self.points - 1) as f64;
        let (mut best, mut place, mut step) = (known, start.clone(), 0.5);
        while step > 1e-7 {
            let mut moved = false;
            for axis in 0..place.len() {
                for direction in [-1.0, 1.0] {
                    let mut next = place.clone();
                    next[axis] = (place[axis] + direction * step)
                        .clamp((start[axis] - 1.0).max(0.0), (start[axis] + 1.0).min(last));
                    let value = f(&next);
                    if value > best {
                        (best, place, moved) = (value, next, true);
                    }
                }
            }
            if !moved {
                step *= 0.5;
            }
        }
        best
    }

    /// By the polynomial of degree 4 in each parameter through the points around a sample.
    fn interpolated(&self, sample: usize, place: &[f64], channel: usize, row: usize) -> f64 {
        const WIDTH: usize = 5;
        let corner: Vec<usize> = (0..place.len())
            .map(|axis| {
                let centre = sample / self.points.pow(axis as u32) % self.points;
                centre.saturating_sub(WIDTH / 2).min(self.points - WIDTH)
            })
            .collect();
        let weights: Vec<[f64; WIDTH]> = place
            .iter()
            .zip(&corner)
            .map(|(&x, &first)| {
                std::array::from_fn(|i| {
                    let others = (0..WIDTH).filter(|&j| j != i);
                    others.map(|j| (x - (first + j) as f64) / (i as f64 - j as f64)).product()
                })
            })
            .collect();
        let mut total = 0.0;
        for node in 0..WIDTH.pow(place.len() as u32) {
            let (mut weight, mut index, mut rest, mut stride) = (1.0, 0, node, 1);
            for (axis, weights) in weights.iter().enumerate() {
                let i = rest % WIDTH;
                rest /= WIDTH;
                weight *= weights[i];
                index += (corner[axis] + i) * stride;
                stride *= self.points;
            }
            total += weight * self.values[index][channel][row];
        }
        total
    }
}
