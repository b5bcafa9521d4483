//! The outputs at a time, through events.

use super::piece::Piece;
use super::pieces::Pieces;
use super::surrogate::Point;
use super::tuning::TUNING;
use crate::methods::chebyshev::sensitivity::Predicted;
use crate::methods::closure::Closure;
use crate::numerics::{ParameterBox, Surrogate, largest};

/// A row of output in one part of the box.
pub(super) struct SegmentRow<'r> {
    pub domain: &'r ParameterBox,
    /// Number of outputs.
    pub outputs: usize,
    pub piece: &'r Piece,
    pub closure: &'r dyn Closure,
    /// s
    pub time: f64,
}

/// A row of output in all of it.
pub(super) struct BoxRow<'r> {
    pub domain: &'r ParameterBox,
    /// Number of outputs.
    pub outputs: usize,
    pub pieces: &'r Pieces,
    pub closure: &'r dyn Closure,
    /// s
    pub time: f64,
}

/// The same for sensitivities.
pub(super) struct SensedRow<'r> {
    pub row: &'r BoxRow<'r>,
    /// By which instants and motions of a box of one word are expanded.
    pub grid: &'r Surrogate,
}

impl SegmentRow<'_> {
    /// All outputs (output, point), given the point's segment, and the time at which its motion is taken there.
    pub fn outputs_on(&self, points: &[(&Point, usize, f64)]) -> Vec<f64> {
        let surrogate = &self.piece.surrogate;
        let (count, lines) = (points.len(), surrogate.lines());
        let mut motion = vec![0.0; lines * count];
        for (index, (point, segment, time)) in points.iter().enumerate() {
            let values = surrogate.motion(point, *segment, *time);
            values.enumerate().for_each(|(line, value)| motion[line * count + index] = value);
        }
        self.closed(points.iter().map(|(point, ..)| point.xi.as_slice()), count, motion)
    }

    /// The same of points in the segments that they are in at the row's time.
    fn outputs_at(&self, points: &[Point]) -> Vec<f64> {
        let at: Vec<_> = points.iter().map(|point| (point, point.segment(self.time), self.time)).collect();
        self.outputs_on(&at)
    }

    fn closed<'x>(&self, xi: impl Iterator<Item = &'x [f64]>, count: usize, motion: Vec<f64>) -> Vec<f64> {
        let domain = self.domain;
        let mut parameters = vec![0.0; domain.dimension() * count];
        for (index, xi) in xi.enumerate() {
            for (parameter, &xi) in xi.iter().enumerate() {
                parameters[parameter * count + index] = domain.value(parameter, xi);
            }
        }
        self.closure.outputs(self.time, count, parameters, motion)
    }

    /// How far the polynomials' errors move outputs at points (output, point), each in the segment in which its value was
    /// taken: there an event that is near may have been already, or not yet, each line may be off by its own error, and a
    /// surface beside it by its.
    pub fn errors(&self, places: &[(usize, Point)]) -> Vec<f64> {
        let surrogate = &self.piece.surrogate;
        let (count, n) = (places.len(), surrogate.lines() / 2);
        let at = |shift: f64| {
            let shifted = |(segment, point): &(usize, Point)| {
                let times = &self.piece.errors_at(point).times;
                self.time + shift * times[*segment].max(times[segment + 1])
            };
            places.iter().map(|own| (&own.1, own.1.segment(shifted(own)), self.time)).collect::<Vec<_>>()
        };
        let own: Vec<_> = places.iter().map(|(segment, point)| (point, *segment, self.time)).collect();
        let here = self.outputs_on(&own);
        let mut moved: Vec<Vec<f64>> = vec![vec![0.0; count]; self.outputs];
        let mut add = |ways: [Vec<f64>; 2]| {
            for (output, moved) in moved.iter_mut().enumerate() {
                for (index, moved) in moved.iter_mut().enumerate() {
                    let value = |way: &Vec<f64>| way[output * count + index] - here[output * count + index];
                    *moved += largest(ways.iter().map(value));
                }
            }
        };
        add([-1.0, 1.0].map(|shift| self.outputs_on(&at(shift))));
        for line in self.closure.independent().iter().flat_map(|&coordinate| [coordinate, n + coordinate]) {
            add([-1.0, 1.0].map(|sign| {
                let mut motion = vec![0.0; 2 * n * count];
                for (index, (segment, point)) in places.iter().enumerate() {
                    let step = surrogate.step(point, *segment, self.time);
                    let error = self.piece.errors_at(point).of_line(*segment, step, line);
                    for (number, value) in surrogate.motion(point, *segment, self.time).enumerate() {
                        let by = if number == line { sign * error } else { 0.0 };
                        motion[number * count + index] = value + by;
                    }
                }
                self.closed(places.iter().map(|(_, point)| point.xi.as_slice()), count, motion)
            }));
        }
        for end in 0..surrogate.ends.len() {
            add([-1.0, 1.0].map(|sign| self.outputs_at(&self.beside(places, end, sign))));
        }
        // Outside of the samples of a fit errors are larger.
        let far = |(_, point): &(usize, Point)| surrogate.leverage(&point.xi).max(1.0).sqrt();
        let far: Vec<f64> = places.iter().map(far).collect();
        moved.iter().flat_map(|moved| moved.iter().zip(&far).map(|(moved, far)| far * moved)).collect()
    }

    /// Points that are beside a surface, moved across it as far as its error is.
    fn beside(&self, places: &[(usize, Point)], end: usize, sign: f64) -> Vec<Point> {
        let surface = &self.piece.surrogate.ends[end];
        let across = |point: &Point| {
            let mut xi = point.xi.clone();
            if point.margins[end].abs() > TUNING.near_end * surface.error() {
                return xi;
            }
            let of = |axis: usize| {
                let mut beside = point.xi.clone();
                beside[axis] += TUNING.step_of_surfaces;
                (surface.margin(&beside) - point.margins[end]) / TUNING.step_of_surfaces
            };
            let slopes: Vec<f64> = (0..xi.len()).map(of).collect();
            let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
            let by = sign * surface.error() / square;
            if by.is_finite() {
                xi.iter_mut().zip(&slopes).for_each(|(xi, slope)| *xi = (*xi + by * slope).clamp(-1.0, 1.0));
            }
            xi
        };
        self.piece.surrogate.points(places.iter().map(|(_, point)| across(point)).collect())
    }
}

impl<'r> BoxRow<'r> {
    /// The row in one part.
    pub fn in_part(&self, piece: &'r Piece) -> SegmentRow<'r> {
        let Self { domain, outputs, closure, time, .. } = *self;
        SegmentRow { domain, outputs, piece, closure, time }
    }

    /// Some of the outputs at points of the box: output, point.
    pub fn some_outputs(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        let mut values = vec![f64::NAN; outputs.len() * points.len()];
        for piece in &self.pieces.all {
            let is_own =
                |point: &usize| self.pieces.part_of(&points[*point]).is_some_and(|own| std::ptr::eq(own, piece));
            let own: Vec<usize> = (0..points.len()).filter(is_own).collect();
            let at = piece.surrogate.points(own.iter().map(|&point| points[point].clone()).collect());
            let found = self.in_part(piece).outputs_at(&at);
            for (line, output) in outputs.iter().enumerate() {
                for (index, point) in own.iter().enumerate() {
                    values[line * points.len() + point] = found[output * own.len() + index];
                }
            }
        }
        values
    }
}

impl Predicted for SensedRow<'_> {
    fn outputs(&self) -> usize {
        self.row.outputs
    }

    fn surrogate(&self) -> &Surrogate {
        self.grid
    }

    fn predict_some(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        self.row.some_outputs(outputs, points)
    }
}

#[cfg(test)]
mod tests {
    use super::super::basis::Basis;
    use super::super::climb;
    use super::super::of_part::Number;
    use super::super::seeds::Lattice;
    use super::super::surrogate::{SegmentErrors, SegmentSurrogate};
    use super::*;
    use crate::numerics::{STEP_NODES, SegmentMotions, SurrogateWork};

    /// Polynomials have a ball leave a post before it meets it: −6 behind it is no more known there than 0 before it.
    #[test]
    fn an_end_in_another_segment_than_its_place_has_the_difference_for_error() {
        let grid = Surrogate::tensor(&[1], &[2]);
        let of_xi = |at: &dyn Fn(f64) -> f64| grid.samples().iter().map(|xi| at(xi[0])).collect::<Vec<f64>>();
        let node = |value: f64| [of_xi(&|_| value), of_xi(&|_| 0.0)].concat();
        let motions = SegmentMotions {
            samples: vec![0, 1],
            steps: vec![vec![1.0]; 3],
            times: vec![of_xi(&|_| 0.0), of_xi(&|xi| 0.5 + 0.3 * xi), of_xi(&|xi| 0.6 - 0.3 * xi), of_xi(&|_| 1.0)],
            nodes: [0.0, 0.0, -6.0].map(|value| vec![node(value); STEP_NODES]).to_vec(),
        };
        let mut work = SurrogateWork::default();
        let coefficients = |values: &[f64]| grid.coefficients(values, &mut work);
        let surrogate = SegmentSurrogate::new(Basis::Grid(grid.basis().clone()), Vec::new(), &motions, coefficients);
        let errors = SegmentErrors { times: vec![1e-3; 4], lines: vec![vec![vec![1e-9; 2]]; 3] };
        let piece = Piece::new(surrogate, errors, Vec::new());
        let domain =
            ParameterBox { nominal: vec![0.0].into(), lower: vec![-1.0], upper: vec![1.0], ..ParameterBox::default() };
        let row = SegmentRow { domain: &domain, outputs: 1, piece: &piece, closure: &Number, time: 0.4 };
        let [ends] = &climb::ends(&row, &Lattice::new(&piece.surrogate, &[], 1))[..] else { panic!() };
        let (lower, error) = (ends.extent.range.lower, ends.errors[0]);
        assert!((lower + 6.0).abs() < 1e-9 && error >= 6.0 - 1e-9, "{lower} ± {error}");
    }
}
