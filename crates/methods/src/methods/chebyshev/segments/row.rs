//! The outputs at a time, through events.

use super::surrogate::{Point, SegmentErrors, SegmentSurrogate};
use crate::methods::chebyshev::sensitivity::Predicted;
use crate::methods::ensemble::{Closure, Ensemble};
use crate::numerics::{Extent, Surrogate, largest};

/// A row of output.
pub(super) struct SegmentRow<'r> {
    pub ensemble: &'r dyn Ensemble,
    /// By which instants and motions are expanded.
    pub tensor: &'r Surrogate,
    pub surrogate: &'r SegmentSurrogate<'r>,
    pub closure: &'r dyn Closure,
    /// s
    pub time: f64,
}

impl SegmentRow<'_> {
    /// All outputs (output, point), given the point's segment, and the time at which its motion is taken there.
    pub fn outputs_on(&self, points: &[(&Point, usize, f64)]) -> Vec<f64> {
        let (count, lines) = (points.len(), self.surrogate.lines());
        let mut motion = vec![0.0; lines * count];
        for (place, (point, segment, time)) in points.iter().enumerate() {
            let values = self.surrogate.motion(point, *segment, *time);
            values.enumerate().for_each(|(line, value)| motion[line * count + place] = value);
        }
        self.closed(points.iter().map(|(point, ..)| point.xi.as_slice()), count, motion)
    }

    fn closed<'x>(&self, xi: impl Iterator<Item = &'x [f64]>, count: usize, motion: Vec<f64>) -> Vec<f64> {
        let domain = self.ensemble.domain();
        let mut parameters = vec![0.0; domain.dimension() * count];
        for (place, xi) in xi.enumerate() {
            for (parameter, &xi) in xi.iter().enumerate() {
                parameters[parameter * count + place] = domain.value(parameter, xi);
            }
        }
        self.closure.outputs(self.time, count, parameters, motion)
    }

    /// How far the polynomials' errors move the ends of ranges: an end is where a point is, and there the motion may be
    /// what it is a little earlier or later, behind the event too, and each line may be off by its own error.
    pub fn moved(&self, extents: &[Extent], errors: &SegmentErrors) -> Vec<f64> {
        let xi = extents.iter().flat_map(|extent| extent.places.iter().cloned()).collect();
        let points = self.surrogate.points(xi);
        let (count, n) = (points.len(), self.surrogate.lines() / 2);
        let at = |shift: f64| {
            let shifted = |point: &Point| {
                let segment = point.segment(self.time);
                self.time + shift * errors.times[segment].max(errors.times[segment + 1])
            };
            points.iter().map(|point| (point, point.segment(shifted(point)), shifted(point))).collect::<Vec<_>>()
        };
        let here = self.outputs_on(&at(0.0));
        let mut moved: Vec<Vec<f64>> = vec![vec![0.0; count]; extents.len()];
        let mut add = |ways: [Vec<f64>; 2]| {
            for (output, moved) in moved.iter_mut().enumerate() {
                for (place, moved) in moved.iter_mut().enumerate() {
                    let value = |way: &Vec<f64>| way[output * count + place] - here[output * count + place];
                    *moved += largest(ways.iter().map(value));
                }
            }
        };
        add([-1.0, 1.0].map(|shift| self.outputs_on(&at(shift))));
        for line in self.closure.independent().iter().flat_map(|&coordinate| [coordinate, n + coordinate]) {
            add([-1.0, 1.0].map(|sign| {
                let mut motion = vec![0.0; 2 * n * count];
                for (place, point) in points.iter().enumerate() {
                    let segment = point.segment(self.time);
                    for (number, value) in self.surrogate.motion(point, segment, self.time).enumerate() {
                        let by = if number == line { sign * errors.lines[segment][line] } else { 0.0 };
                        motion[number * count + place] = value + by;
                    }
                }
                self.closed(points.iter().map(|point| point.xi.as_slice()), count, motion)
            }));
        }
        let own = |(output, moved): (usize, &Vec<f64>)| largest(moved[2 * output..][..2].iter().copied());
        moved.iter().enumerate().map(own).collect()
    }
}

impl Predicted for SegmentRow<'_> {
    fn outputs(&self) -> usize {
        self.ensemble.outputs()
    }

    fn surrogate(&self) -> &Surrogate {
        self.tensor
    }

    fn predict_some(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        let points = self.surrogate.points(points.to_vec());
        let at: Vec<_> = points.iter().map(|point| (point, point.segment(self.time), self.time)).collect();
        let values = self.outputs_on(&at);
        outputs.iter().flat_map(|output| values[output * at.len()..][..at.len()].iter().copied()).collect()
    }
}
