//! Polynomials of the instants of events, and of the motion between them, of one word.

use super::basis::{Basis, End};
use super::tuning::TUNING;
use crate::numerics::{LeastSquares, STEP_NODES, SegmentMotions, largest, step_weights};

/// Motions of one word, as functions of the parameters in a part of the box.
pub(super) struct SegmentSurrogate<'a> {
    basis: Basis<'a>,
    /// Surfaces that end the part.
    pub ends: Vec<End>,
    /// Ends of the steps of each segment, as shares of its length.
    steps: Vec<Vec<f64>>,
    /// Coefficients of the times at which segments begin, and at which the last ends.
    times: Vec<Vec<f64>>,
    /// Coefficients of each of the 2n lines, by segment and node.
    nodes: Vec<Vec<Vec<f64>>>,
    lines: usize,
    /// By what coefficients were fitted, where they were.
    squares: Option<LeastSquares>,
}

/// A point of the box with its values that do not depend on the time.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub xi: Vec<f64>,
    /// Values of the basis.
    terms: Vec<f64>,
    /// When segments begin, and when the last ends, s.
    pub times: Vec<f64>,
    /// Distance from each surface that ends the part, in its own units; negative beyond it.
    pub margins: Vec<f64>,
}

/// Largest errors at validation samples, or what the polynomials lack.
#[derive(Clone, Debug)]
pub(super) struct SegmentErrors {
    /// Of the instants, s.
    pub times: Vec<f64>,
    /// Of each line, by segment.
    pub lines: Vec<Vec<f64>>,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<'a> SegmentSurrogate<'a> {
    /// From what gives the coefficients of values at the motions' samples, line by line.
    pub fn new(
        basis: Basis<'a>,
        ends: Vec<End>,
        motions: &SegmentMotions,
        mut coefficients: impl FnMut(&[f64]) -> Vec<f64>,
    ) -> Self {
        let times = motions.times.iter().map(|times| coefficients(times)).collect();
        let nodes: Vec<Vec<Vec<f64>>> =
            motions.nodes.iter().map(|nodes| nodes.iter().map(|node| coefficients(node)).collect()).collect();
        let lines = nodes.first().and_then(|nodes| nodes.first()).map_or(0, |node| node.len() / basis.len());
        Self { basis, ends, steps: motions.steps.clone(), times, nodes, lines, squares: None }
    }

    /// The same, whose coefficients were fitted by these.
    pub fn fitted_by(self, squares: LeastSquares) -> Self {
        Self { squares: Some(squares), ..self }
    }

    /// How far some ξ is outside of the samples of a fit: by the square of so many times the errors of samples may the
    /// fit be off there; at most 1 among them.
    pub fn leverage(&self, xi: &[f64]) -> f64 {
        let of = |squares: &LeastSquares| {
            self.basis.values(&[xi.to_vec()]).first().map_or(f64::NAN, |terms| squares.leverage(terms))
        };
        self.squares.as_ref().map_or(0.0, of)
    }

    /// Number of positions and velocities, 2n.
    pub fn lines(&self) -> usize {
        self.lines
    }

    /// Number of segments.
    pub fn segments(&self) -> usize {
        self.steps.len()
    }

    /// Points with the instants of their events.
    pub fn points(&self, xi: Vec<Vec<f64>>) -> Vec<Point> {
        let values = self.basis.values(&xi);
        let point = |(xi, terms): (Vec<f64>, Vec<f64>)| {
            let times = self.times.iter().map(|time| dot(time, &terms)).collect();
            let margins = self.ends.iter().map(|end| end.margin(&xi)).collect();
            Point { xi, terms, times, margins }
        };
        xi.into_iter().zip(values).map(point).collect()
    }

    /// The motion (2n) of a point at a time on the branch of a segment, which goes on a little beyond its ends: the
    /// shortest segments are no longer than their errors.
    pub fn motion(&self, point: &Point, segment: usize, time: f64) -> impl Iterator<Item = f64> {
        let [begin, end] = [point.times[segment], point.times[segment + 1]];
        let share = ((time - begin) / (end - begin)).clamp(-TUNING.beyond_branch, 1.0 + TUNING.beyond_branch);
        let (step, weights) = step_weights(&self.steps[segment], if share.is_nan() { 0.0 } else { share });
        let nodes = &self.nodes[segment][step * (STEP_NODES - 1)..][..STEP_NODES];
        let terms = point.terms.clone();
        (0..self.lines).map(move |line| {
            let value = |node: &Vec<f64>| dot(&node[line * terms.len()..][..terms.len()], &terms);
            weights.iter().zip(nodes).map(|(weight, node)| weight * value(node)).sum()
        })
    }

    /// The motion (2n) of some ξ at a time.
    pub fn motion_at(&self, xi: &[f64], time: f64) -> Vec<f64> {
        let points = self.points(vec![xi.to_vec()]);
        points.iter().flat_map(|point| self.motion(point, point.segment(time), time)).collect()
    }
}

impl Point {
    /// The segment that it is in at a time.
    pub fn segment(&self, time: f64) -> usize {
        let inner = &self.times[1..self.times.len() - 1];
        inner.iter().take_while(|&&begin| begin <= time).count()
    }

    /// Whether it is in the word's part of the box.
    pub fn is_inside(&self) -> bool {
        self.margins.iter().all(|margin| *margin >= 0.0)
    }
}

impl SegmentErrors {
    /// At samples that were cut at the same events.
    pub fn new(surrogate: &SegmentSurrogate, xi: &[Vec<f64>], direct: &SegmentMotions) -> Self {
        let points = surrogate.points(xi.to_vec());
        let differences = |coefficients: &[f64], values: &[f64]| {
            let own = points.iter().zip(values).map(|(point, value)| dot(coefficients, &point.terms) - value);
            largest(own.chain([surrogate.basis.truncation(coefficients)]))
        };
        let times = surrogate.times.iter().zip(&direct.times).map(|(own, values)| differences(own, values)).collect();
        let terms = surrogate.basis.len();
        let of_line = |(own, values): (&Vec<Vec<f64>>, &Vec<Vec<f64>>), line: usize| {
            largest(own.iter().zip(values).map(|(own, values)| {
                differences(&own[line * terms..][..terms], &values[line * points.len()..][..points.len()])
            }))
        };
        let of_segment = |nodes| (0..surrogate.lines).map(|line| of_line(nodes, line)).collect();
        let lines = surrogate.nodes.iter().zip(&direct.nodes).map(of_segment).collect();
        Self { times, lines }
    }

    /// From the differences of values at the motions' samples, line by line.
    pub fn of_samples(motions: &SegmentMotions, mut differences: impl FnMut(&[f64]) -> Vec<f64>) -> Self {
        let count = motions.samples.len();
        let times = motions.times.iter().map(|times| largest(differences(times))).collect();
        let mut of_segment = |nodes: &Vec<Vec<f64>>| {
            let mut lines: Vec<f64> = Vec::new();
            for node in nodes {
                let own: Vec<f64> =
                    differences(node).chunks_exact(count).map(|line| largest(line.iter().copied())).collect();
                lines.resize(own.len(), 0.0);
                lines.iter_mut().zip(own).for_each(|(line, own)| *line = largest([*line, own]));
            }
            lines
        };
        Self { times, lines: motions.nodes.iter().map(&mut of_segment).collect() }
    }

    /// The larger of both.
    #[must_use]
    pub fn or(mut self, other: &Self) -> Self {
        let raise = |own: &mut Vec<f64>, other: &Vec<f64>| {
            own.iter_mut().zip(other).for_each(|(own, other)| *own = largest([*own, *other]));
        };
        raise(&mut self.times, &other.times);
        self.lines.iter_mut().zip(&other.lines).for_each(|(own, other)| raise(own, other));
        self
    }
}
