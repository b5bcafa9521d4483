//! How far values elsewhere may be beyond an end at a corner of the box, however the polynomials err.

use super::ends::Rival;
use super::row::SegmentRow;
use super::surrogate::Point;
use super::tuning::TUNING;
use crate::numerics::{Range, SAFETY_OF_SURROGATE, STEP_NODES, largest};

/// An end of an output's range that is at a corner.
pub(super) struct Corner<'c> {
    pub output: usize,
    /// −1 for the least value, 1 for the largest.
    pub sign: f64,
    pub segment: usize,
    pub point: &'c Point,
    pub value: f64,
    /// How far the polynomials' errors move it.
    pub error: f64,
}

/// Samples that differ in one parameter only.
pub(super) struct AxisLines<'p> {
    points: &'p [Vec<f64>],
    /// By axis, the samples on each line along it.
    of_axes: Vec<Vec<Vec<usize>>>,
    /// Samples at −1, 0 and 1 along all axes; none if one of them is missing.
    lattice: Vec<usize>,
}

/// Differences of polynomials from such samples in a row.
pub(super) struct Misses<'l> {
    lines: &'l AxisLines<'l>,
    /// Predicted less simulated outputs (output, sample); NaN at samples that are not in the part.
    values: Vec<f64>,
    /// Segments of the samples at the row's time.
    segments: Vec<usize>,
}

/// Misses of an output: a parabola along each axis through those on the lattice, and the rest.
struct Missed<'m> {
    /// Misses on the lattice; none if parabolas do not give those of other samples.
    on_lattice: Vec<f64>,
    /// Largest distance of other samples from the parabolas, if there are any.
    rest: Option<f64>,
    misses: &'m Misses<'m>,
    /// All misses, by sample.
    values: Vec<f64>,
}

/// Points that are examined in their segments, with the outputs there and how far errors move these (output, place).
pub(super) struct Looked {
    places: Vec<(usize, Point)>,
    values: Vec<f64>,
    errors: Vec<f64>,
}

impl<'p> AxisLines<'p> {
    pub fn new(points: &'p [Vec<f64>]) -> Self {
        let k = points.first().map_or(0, Vec::len);
        let along = |axis: usize| {
            let others = |xi: &[f64]| [&xi[..axis], &xi[axis + 1..]].concat();
            let mut lines: Vec<(Vec<f64>, Vec<usize>)> = Vec::new();
            for (index, xi) in points.iter().enumerate() {
                let own = others(xi);
                match lines.iter_mut().find(|(others, _)| *others == own) {
                    Some((_, line)) => line.push(index),
                    None => lines.push((own, vec![index])),
                }
            }
            lines.into_iter().map(|(_, line)| line).filter(|line| line.len() > 1).collect()
        };
        let is_on_lattice = |sample: &usize| points[*sample].iter().all(|xi| [-1.0, 0.0, 1.0].contains(xi));
        let mut lattice: Vec<usize> = (0..points.len()).filter(is_on_lattice).collect();
        if 3_usize.checked_pow(k as u32) != Some(lattice.len()) {
            lattice.clear();
        }
        Self { points, of_axes: (0..k).map(along).collect(), lattice }
    }
}

impl<'l> Misses<'l> {
    /// Misses in a row, whose outputs at the samples (output, sample) have been simulated; `at` are their points.
    pub fn new(
        lines: &'l AxisLines<'l>,
        row: &SegmentRow,
        at: &[Point],
        simulated: impl Fn(usize) -> Vec<f64>,
    ) -> Self {
        let predicted = row.outputs_at(at);
        let of_output = |output: usize| {
            let own = predicted[output * at.len()..][..at.len()].iter().zip(simulated(output)).zip(at);
            own.map(|((own, value), point)| if point.is_inside() { own - value } else { f64::NAN }).collect::<Vec<_>>()
        };
        let values = (0..row.outputs).flat_map(of_output).collect();
        Self { lines, values, segments: at.iter().map(|point| point.segment(row.time)).collect() }
    }

    /// Misses of an output in a segment, whose rest is to be less than this error.
    fn of(&self, output: usize, segment: usize, error: f64) -> Missed<'_> {
        let lattice = &self.lines.lattice;
        let count = self.lines.points.len();
        let own = self.values[output * count..][..count].iter().zip(&self.segments);
        let values: Vec<f64> = own.map(|(miss, own)| if *own == segment { *miss } else { f64::NAN }).collect();
        let on_lattice: Vec<f64> = lattice.iter().map(|&sample| values[sample]).collect();
        let is_known = !on_lattice.is_empty() && on_lattice.iter().all(|miss| miss.is_finite());
        let parted = Missed { on_lattice, rest: None, misses: self, values };
        let others: Vec<usize> =
            (0..count).filter(|sample| !lattice.contains(sample) && parted.values[*sample].is_finite()).collect();
        let apart = |&sample: &usize| parted.values[sample] - parted.parabolas(&self.lines.points[sample]);
        // The other samples show how much is left between the lattice's points.
        let rest = (is_known && !others.is_empty()).then(|| largest(others.iter().map(apart)));
        match rest.filter(|rest| *rest < error) {
            Some(rest) => Missed { rest: Some(rest), ..parted },
            None => Missed { on_lattice: Vec::new(), ..parted },
        }
    }
}

impl Missed<'_> {
    /// The parabolas at some ξ.
    fn parabolas(&self, xi: &[f64]) -> f64 {
        let lines = self.misses.lines;
        let weight = |sample: usize| -> f64 {
            let of_axis = |(x, node): (&f64, &f64)| {
                if *node == 0.0 { 1.0 - x * x } else { 0.5 * x * (x + node) }
            };
            xi.iter().zip(&lines.points[sample]).map(of_axis).product()
        };
        self.on_lattice.iter().zip(&lines.lattice).map(|(miss, &sample)| weight(sample) * miss).sum()
    }

    /// Largest change of all misses along an axis; `None` if no such line goes through the corner.
    fn of_lines(&self, axis: usize, corner: &[f64]) -> Option<f64> {
        let AxisLines { points, of_axes, .. } = self.misses.lines;
        let known = |line: &Vec<usize>| -> Vec<usize> {
            line.iter().copied().filter(|&sample| self.values[sample].is_finite()).collect()
        };
        let lines: Vec<Vec<usize>> = of_axes[axis].iter().map(known).filter(|line| line.len() > 1).collect();
        let is_told = lines.iter().flatten().any(|&sample| points[sample] == corner);
        let range =
            |line: &Vec<usize>| Range::of(&line.iter().map(|&sample| self.values[sample]).collect::<Vec<_>>()).width();
        is_told.then(|| largest(lines.iter().map(range)))
    }

    /// Largest change of the rest along an axis.
    fn along(&self, axis: usize, corner: &[f64]) -> Option<f64> {
        [self.of_lines(axis, corner), self.rest].into_iter().flatten().reduce(f64::min)
    }
}

impl Looked {
    pub fn at(row: &SegmentRow, places: Vec<(usize, Point)>) -> Self {
        let values = row.outputs_in(&places);
        let errors = row.errors(&places, &values);
        Self { places, values, errors }
    }

    /// By how much values in the part may be beyond a corner; infinite if unknown.
    pub fn beyond(&self, row: &SegmentRow, corner: &Corner, misses: Option<&Misses>) -> f64 {
        let Some(slope) = row.piece.slope_of_errors() else { return f64::INFINITY };
        let surrogate = &row.piece.surrogate;
        let xi = &corner.point.xi;
        // Where an event passes through the part, errors change with the share of the segment, too: in a step as a
        // polynomial does by the square of its degree. Errors in other segments say nothing of those in its own.
        let passes = self.places.iter().any(|(segment, _)| *segment != corner.segment);
        let by_share = passes && !row.has_branch(corner.segment);
        let (share, step) = surrogate.share(corner.point, corner.segment, row.time);
        let of_share = if by_share { 2.0 * ((STEP_NODES - 1) as f64).powi(2) / step } else { 0.0 };
        let change = |point: &Point| {
            let distance = largest(point.xi.iter().zip(xi).map(|(a, b)| a - b));
            let shares = if by_share { surrogate.share(point, corner.segment, row.time).0 - share } else { 0.0 };
            slope * distance + of_share * shares.abs()
        };
        // Samples of the segment give the errors at corners, and the change of errors on the way. Where errors change
        // with the share, no parabola gives them, and the change may be anywhere on the way.
        let told = misses.map(|own| own.of(corner.output, corner.segment, if by_share { 0.0 } else { corner.error }));
        let missed = |xi: &[f64]| told.as_ref().map_or(0.0, |own| own.parabolas(xi));
        let along: Vec<Option<f64>> = (0..xi.len()).map(|axis| told.as_ref()?.along(axis, xi)).collect();
        let of_axes = |point: &Point| {
            let of_axis = |(along, (a, b)): (&Option<f64>, (&f64, &f64))| match (a - b).abs() {
                0.0 => Some(0.0),
                _ if by_share => *along,
                // A polynomial changes by the square of its degree times half of its range.
                distance => along.map(|along| along * (0.5 * slope * distance).min(1.0)),
            };
            along.iter().zip(point.xi.iter().zip(xi)).map(of_axis).sum::<Option<f64>>()
        };
        let own = corner.value - missed(xi);
        let rest = told.as_ref().and_then(|own| own.rest);
        let own_error = rest.unwrap_or(corner.error);
        let count = self.places.len();
        let of_place = |(index, (segment, point)): (usize, &(usize, Point))| {
            let at = corner.output * count + index;
            let is_own = *segment == corner.segment;
            Rival {
                within: corner.sign * (own - self.values[at] + missed(&point.xi)),
                error: rest.map_or(self.errors[at], |rest| rest.min(self.errors[at])),
                change: if is_own { change(point) } else { f64::INFINITY },
                along: if is_own { of_axes(point) } else { None },
            }
        };
        let moved = |axis: usize| {
            let mut xi = xi.clone();
            xi[axis] -= TUNING.beside_corner * xi[axis].signum();
            xi
        };
        let beside = surrogate.points((0..xi.len()).map(moved).collect());
        let at: Vec<(&Point, usize, f64)> = beside.iter().map(|point| (point, corner.segment, row.time)).collect();
        let values = row.outputs_on(&at);
        let within =
            |axis: usize| corner.sign * (own - values[corner.output * at.len() + axis] + missed(&beside[axis].xi));
        let rises = |axis: &usize| {
            let rival = Rival { within: within(*axis), error: own_error, change: change(&beside[*axis]), along: None };
            rival.beyond(own_error) > 0.0
        };
        // Where slopes are too small to decide, as far from the corner as errors may go on rising.
        let of_axis = |axis: usize| {
            let along = along[axis].unwrap_or(f64::INFINITY);
            let way = if by_share { 0.0 } else { 2.0 / (slope * TUNING.beside_corner) };
            (along - within(axis) * way / SAFETY_OF_SURROGATE).max(0.0)
        };
        let near: f64 = (0..xi.len()).filter(rises).map(of_axis).sum();
        let places = self.places.iter().enumerate().map(of_place);
        places.map(|rival| rival.beyond(own_error)).fold(near, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::{spread, validation};

    fn misses<'l>(lines: &'l AxisLines<'l>, of: impl Fn(&[f64]) -> f64) -> Misses<'l> {
        let values: Vec<f64> = lines.points.iter().map(|xi| of(xi)).collect();
        Misses { lines, segments: vec![1; values.len()], values }
    }

    #[test]
    fn parabolas_interpolate_misses_on_the_lattice() {
        let points = validation(2, 4);
        let lines = AxisLines::new(&points);
        let of = |xi: &[f64]| 0.3 - xi[0] + 0.5 * xi[0] * xi[0] * xi[1] - 0.2 * xi[1] * xi[1];
        let own = misses(&lines, of);
        let missed = own.of(0, 1, 2.0);
        for xi in spread(2, 20) {
            assert!((missed.parabolas(&xi) - of(&xi)).abs() < 1e-15);
        }
        assert!(missed.rest.unwrap() < 1e-15);
        // They lack a cube, by at most 2/√27 of it.
        let own = misses(&lines, |xi| of(xi) + 0.1 * xi[0].powi(3));
        let rest = own.of(0, 1, 2.0).rest.unwrap();
        assert!(rest > 0.03 && rest <= 0.1 * 2.0 / 27_f64.sqrt(), "{rest}");
    }

    /// A parameter that misses do not depend on, and one that samples outside of the part hide.
    #[test]
    fn misses_change_along_influential_axes_only() {
        let points = validation(2, 4);
        let lines = AxisLines::new(&points);
        let own = misses(&lines, |xi| 1e-3 * xi[1].powi(2));
        let along = |own: &Misses, axis: usize| own.of(0, 1, 2.0).of_lines(axis, &[1.0, -1.0]);
        assert_eq!(along(&own, 0), Some(0.0));
        assert_eq!(along(&own, 1), Some(1e-3));
        let hidden = misses(&lines, |xi| if xi[1] > -1.0 { f64::NAN } else { 1e-3 * xi[0] });
        assert_eq!(along(&hidden, 0), Some(2e-3));
        assert_eq!(along(&hidden, 1), None);
        assert!(hidden.of(0, 1, 2.0).on_lattice.is_empty());
        // Those in other segments say nothing of this one.
        let segments = points.iter().map(|xi| if xi[1] > -1.0 { 2 } else { 1 }).collect();
        let elsewhere = Misses { segments, ..misses(&lines, |xi| 1e-3 * xi[0]) };
        assert_eq!((along(&elsewhere, 0), along(&elsewhere, 1)), (Some(2e-3), None));
    }
}
