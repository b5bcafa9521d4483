//! The range of a term's channels over its box: a dense grid, and from its best points a local search. The search
//! evaluates closed forms directly, and integrated terms by polynomials through the grid's points. Nothing here is
//! mbint's.

use crate::draw::{Parameter, Term};
use crate::random::Random;
use crate::ridge::along_ridge;
use crate::truth::Range;

/// Candidates of each end that are refined.
const CANDIDATES: usize = 6;

/// About how many of those more points are drawn where a band seems to be missed.
const DRAWN_ABOUT: usize = 2;

/// Points about an end.
#[derive(Clone, Copy)]
struct Looks {
    /// Drawn at once.
    drawn: usize,
    /// The least distance, in cells.
    nearest: f64,
}

/// For closed forms, and for motions, which have two parameters at most.
const DRAWN: Looks = Looks { drawn: 1500, nearest: FINEST };
const DRAWN_MOTIONS: Looks = Looks { drawn: 24, nearest: 1e-3 };

/// Share of their coordinates that are at an end of the parameter's interval.
const AT_ENDS: f64 = 0.25;

/// Most stages of a local search, and its smallest step, in cells.
const STAGES: usize = 60;
const FINEST: f64 = 1e-8;

/// Points along a parameter, after the first, at which its influence is tested.
const LOOKS: usize = 16;

/// Samples of a term on a grid over its uncertain parameters.
struct Grid<'t> {
    term: &'t Term,
    parameters: Vec<Parameter>,
    uncertain: Vec<usize>,
    /// Points along each.
    points: usize,
    level: u32,
    /// Sample by sample, channel by channel, row by row; the first uncertain parameter varies fastest.
    values: Vec<Vec<Vec<f64>>>,
}

/// Range of every needed channel at every time; each level has about twice as many points along each parameter.
pub fn ranges(term: &Term, times: &[f64], level: u32, needed: &dyn Fn(usize) -> bool) -> Vec<Vec<Range>> {
    let grid = Grid::new(term, times, level);
    let range = |channel, row| {
        let end = |sign: f64| sign * grid.greatest(channel, row, times[row], sign);
        Range { lower: end(-1.0), upper: end(1.0) }
    };
    let of_channel = |channel| (0..times.len()).map(|row| range(channel, row)).collect();
    (0..term.channels.len()).map(|channel| if needed(channel) { of_channel(channel) } else { Vec::new() }).collect()
}

/// Whether the curves change with a parameter, in the middle of the others' intervals or at a corner of these: the
/// fewer parameters a grid has, the more points it has. Motions at both its ends may miss an obstacle that those
/// between them meet, and only those at one corner may meet it at all.
fn matters(term: &Term, parameters: &[Parameter], which: usize, times: &[f64]) -> bool {
    let curves = |others: &dyn Fn(usize) -> f64, own: f64| {
        let value = |(i, parameter): (usize, &Parameter)| {
            parameter.value + parameter.half * if i == which { own } else { others(i) }
        };
        (term.curves)(&parameters.iter().enumerate().map(value).collect::<Vec<f64>>(), times)
    };
    let changes = |others: &dyn Fn(usize) -> f64| {
        let first = curves(others, -1.0);
        (1..=LOOKS).any(|look| curves(others, 2.0 * look as f64 / LOOKS as f64 - 1.0) != first)
    };
    let others: Vec<usize> = (0..parameters.len()).filter(|&i| i != which && parameters[i].half > 0.0).collect();
    let corner = |number: usize, i: usize| {
        let place = others.iter().position(|&other| other == i).unwrap_or(0);
        if number >> place & 1 == 0 { -1.0 } else { 1.0 }
    };
    let at_corners = || (0..1_usize << others.len()).any(|number| changes(&|i| corner(number, i)));
    parameters[which].half > 0.0 && (changes(&|_| 0.0) || at_corners())
}

/// Climbs from a point of a grid with `points` points along each axis, at most one cell away, by Rosenbrock's method
/// (Computer Journal 3 (1960) 175): after each stage the first direction is that of its progress, since along a ridge
/// that no axis follows the axes alone gain next to nothing. Returns the greatest value and its position.
fn climb(start: &[f64], points: usize, known: f64, f: &dyn Fn(&[f64]) -> f64) -> (f64, Vec<f64>) {
    let (n, last) = (start.len(), (points - 1) as f64);
    let (mut best, mut place, mut size) = (known, start.to_vec(), 0.25_f64);
    let mut directions = axes(n);
    for _ in 0..STAGES {
        let (mut steps, mut progress) = (vec![size; n], vec![0.0; n]);
        let (mut gained, mut failed) = (vec![false; n], vec![false; n]);
        // A direction is done with once it has failed after a gain, or at the finest step: one that never gains would
        // else keep the others at it, rounding by rounding.
        let is_done = |along: usize, steps: &[f64], gained: &[bool], failed: &[bool]| {
            (gained[along] && failed[along]) || steps[along].abs() <= FINEST
        };
        while !(0..n).all(|along| is_done(along, &steps, &gained, &failed)) {
            for along in 0..n {
                let moved = place.iter().zip(&directions[along]).zip(start).map(|((at, direction), start)| {
                    (at + steps[along] * direction).clamp((start - 1.0).max(0.0), (start + 1.0).min(last))
                });
                let next: Vec<f64> = moved.collect();
                let value = f(&next);
                if value > best {
                    (best, place, gained[along]) = (value, next, true);
                    progress[along] += steps[along];
                    steps[along] *= 3.0;
                } else {
                    failed[along] = true;
                    steps[along] *= -0.5;
                }
            }
        }
        let length = length(&progress);
        if length < FINEST {
            break;
        }
        size = (0.5 * length).min(0.5);
        directions = turned(&directions, &progress);
    }
    (best, place)
}

/// Greatest value found about a point, a quarter of the box each way and then ever nearer to the best so far, at random
/// points: on a ridge with a kink, where a contact begins or ends, no direction leads a climb on, and its end is many
/// cells away. Mostly it is where some parameter is at an end of its interval.
fn narrowed(
    (known, place): &(f64, Vec<f64>),
    points: usize,
    Looks { drawn, nearest }: Looks,
    f: &dyn Fn(&[f64]) -> f64,
) -> f64 {
    let (mut random, mut best, mut at) = (Random::new(1, 0), *known, place.clone());
    let mut reach = 0.25 * points as f64;
    while reach > nearest {
        let centre = at.clone();
        for _ in 0..drawn {
            let near = |middle: &f64| {
                let (end, moved) = (random.chance(0.5), middle + reach * (2.0 * random.unit() - 1.0));
                let last = (points - 1) as f64;
                let at_end = if end { last } else { 0.0 };
                if random.chance(AT_ENDS) { at_end } else { moved.clamp(0.0, last) }
            };
            let next: Vec<f64> = centre.iter().map(near).collect();
            let value = f(&next);
            if value > best {
                (best, at) = (value, next);
            }
        }
        reach *= 0.7;
    }
    best
}

fn axes(n: usize) -> Vec<Vec<f64>> {
    (0..n).map(|axis| (0..n).map(|other| f64::from(u8::from(other == axis))).collect()).collect()
}

fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|along| along * along).sum::<f64>().sqrt()
}

/// Orthonormal directions, of which the first is that of all the progress, the second that of the progress along all
/// but the first, and so on.
fn turned(directions: &[Vec<f64>], progress: &[f64]) -> Vec<Vec<f64>> {
    let n = progress.len();
    let rest = |first: usize| -> Vec<f64> {
        (0..n).map(|axis| (first..n).map(|along| progress[along] * directions[along][axis]).sum()).collect()
    };
    let mut found: Vec<Vec<f64>> = Vec::new();
    for wanted in (0..n).map(rest).chain(axes(n)) {
        let mut own = wanted.clone();
        for known in &found {
            let along: f64 = own.iter().zip(known).map(|(a, b)| a * b).sum();
            own.iter_mut().zip(known).for_each(|(own, known)| *own -= along * known);
        }
        let length_left = length(&own);
        if found.len() < n && length_left > 1e-3 * length(&wanted) && length_left > FINEST {
            found.push(own.into_iter().map(|along| along / length_left).collect());
        }
    }
    found
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
        let mut grid = Self { term, parameters, uncertain, points, level, values: Vec::new() };
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
        if self.uncertain.is_empty() {
            return candidates.first().map_or(f64::NEG_INFINITY, |&sample| value(sample));
        }
        let climbed = |f: &dyn Fn(&[f64], usize) -> f64| {
            let from = |&sample: &usize| {
                climb(&self.place(sample), self.points, value(sample), &|place: &[f64]| f(place, sample))
            };
            let mut all: Vec<(f64, Vec<f64>)> = candidates.iter().map(from).collect();
            all.sort_by(|a, b| b.0.total_cmp(&a.0));
            all
        };
        if !self.term.integrated {
            let exact = |place: &[f64]| sign * (self.term.curves)(&self.at(place), &[time])[channel][0];
            let mut found = climbed(&|place, _| exact(place));
            if self.level > 0 {
                found.truncate(DRAWN_ABOUT);
                found.iter_mut().for_each(|own| own.0 = narrowed(own, self.points, DRAWN, &exact));
            }
            return found.into_iter().map(|(value, _)| value).fold(f64::NEG_INFINITY, f64::max);
        }
        // A polynomial overshoots near kinks: its promise counts as far as the motion there attains it.
        let moved = |place: &[f64]| sign * (self.term.curves)(&self.at(place), &[0.0, time])[channel][1];
        let mut best = candidates.first().map_or(f64::NEG_INFINITY, |&sample| value(sample));
        for (promised, place) in climbed(&|place, sample| sign * self.interpolated(sample, place, channel, row)) {
            if promised <= best {
                break;
            }
            best = best.max(moved(&place));
        }
        if self.level > 0 {
            // Nor does it follow kinks: where a band seems to be missed, motions are integrated on the way.
            for &sample in candidates.iter().take(DRAWN_ABOUT) {
                let found = climb(&self.place(sample), self.points, value(sample), &moved);
                best = best.max(narrowed(&found, self.points, DRAWN_MOTIONS, &moved));
                if found.1.len() == 2 {
                    let ways = [0, 1].map(|axis| along_ridge(&found.1, axis, self.points, &moved));
                    best = ways.into_iter().fold(best, f64::max);
                }
            }
        }
        best
    }

    /// Whether no neighbour along a parameter is greater. Of equals, as along a parameter that does not matter to the
    /// channel, the first.
    fn is_local(&self, sample: usize, value: &impl Fn(usize) -> f64) -> bool {
        let here = value(sample);
        let mut stride = 1;
        for _ in &self.uncertain {
            let coordinate = sample / stride % self.points;
            let below = coordinate > 0 && value(sample - stride) >= here;
            let above = coordinate + 1 < self.points && value(sample + stride) > here;
            if below || above {
                return false;
            }
            stride *= self.points;
        }
        true
    }

    /// Value by the polynomial of degree 4 in each parameter through the points around a sample.
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

#[cfg(test)]
mod tests {
    use super::{DRAWN_MOTIONS, climb, narrowed};

    /// A bent ridge as of r cos(ω t + α(r) t²): the best point, where it leaves the cell, is off the axes.
    #[test]
    fn a_bent_ridge_is_followed_to_its_end() {
        let beside = |p: &[f64]| p[1] - 1.0 - 0.7 * (p[0] - 1.0) - 0.2 * (p[0] - 1.0).powi(2);
        let f = |p: &[f64]| 0.01 * p[0] - 50.0 * beside(p).powi(2) - 3.0 * (p[2] - 1.2).powi(2);
        let (found, _) = climb(&[1.0; 3], 3, f(&[1.0; 3]), &f);
        // At p₀ = 2 the ridge is at p₁ = 1.9.
        assert!((found - 0.02).abs() < 1e-9, "{found}");
    }

    /// An event that passes through the box: the greatest value is on its ridge, at an end of an interval.
    #[test]
    fn a_ridge_with_a_kink_is_followed_to_an_end() {
        let f = |p: &[f64]| 0.1 * p[1] - (p[0] - 3.7 - 0.3 * p[1]).abs();
        let start = vec![10.0, 19.0];
        let best = narrowed(&(f(&start), start), 21, DRAWN_MOTIONS, &f);
        assert!((best - 2.0).abs() < 1e-3, "{best}");
    }
}
