//! Polynomials of the instants of events, and of the motion between them, of one word.

use super::basis::{Basis, End};
use super::tuning::TUNING;
use crate::numerics::{LeastSquares, STEP_NODES, SegmentMotions, largest, step_nodes, step_weights};

/// Motions of one word, as functions of the parameters in a part of the box.
#[derive(Clone, Debug)]
pub(super) struct SegmentSurrogate {
    basis: Basis,
    /// Surfaces that end the part.
    pub ends: Vec<End>,
    /// Ends of the steps of each segment, as shares of its length.
    steps: Vec<Vec<f64>>,
    /// Coefficients of the times at which segments begin, and at which the last ends.
    times: Vec<Vec<f64>>,
    /// Coefficients of each of the 2n lines, by segment and node.
    nodes: Vec<Vec<Vec<f64>>>,
    lines: usize,
    /// Fit of the coefficients, if they were fitted.
    squares: Option<LeastSquares>,
    /// For a jet, the largest distance from its centre, along each axis, of the samples that give its errors.
    reach: Vec<f64>,
}

/// A half of a jet's part.
pub(super) struct HalfBox {
    pub middle: Vec<f64>,
    /// Along each axis.
    pub half_widths: Vec<f64>,
    pub ends: Vec<End>,
}

/// A point of the box with its values that do not depend on the time.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub xi: Vec<f64>,
    /// Values of the basis.
    terms: Vec<f64>,
    /// Times at which segments begin, and at which the last ends, s.
    pub times: Vec<f64>,
    /// Distance from each surface that ends the part, in its own units; negative beyond it.
    pub margins: Vec<f64>,
}

/// Largest errors at validation samples, or of truncation.
#[derive(Clone, Debug)]
pub(super) struct SegmentErrors {
    /// Errors of the instants, s.
    pub times: Vec<f64>,
    /// Errors of each line at a time, by segment and step.
    pub lines: Vec<Vec<Vec<f64>>>,
    /// Errors of each line at a share of its segment, by segment and step.
    pub shares: Vec<Vec<Vec<f64>>>,
}

/// Shares between which the branch of a segment is known: it goes on beyond its ends by a part of the segment, and of
/// the step there.
fn branch(steps: &[f64]) -> [f64; 2] {
    let last = 1.0 - steps.len().checked_sub(2).map_or(0.0, |before| steps[before]);
    let beyond = |step: f64| TUNING.beyond_branch.min(TUNING.beyond_step * step);
    [-beyond(steps[0]), 1.0 + beyond(last)]
}

/// A share on the branch of a segment.
fn beside(steps: &[f64], share: f64) -> f64 {
    let [first, last] = branch(steps);
    if share.is_nan() { 0.0 } else { share.clamp(first, last) }
}

/// The share of a segment at which a node of its steps is.
fn share_of_node(steps: &[f64], node: usize) -> f64 {
    let step = (node / (STEP_NODES - 1)).min(steps.len() - 1);
    let begin = if step == 0 { 0.0 } else { steps[step - 1] };
    begin + (steps[step] - begin) * step_nodes()[node - step * (STEP_NODES - 1)]
}

/// Largest error of a line in a step and its neighbours.
fn beside_step(steps: &[Vec<f64>], step: usize, line: usize) -> f64 {
    largest(steps.iter().take(step + 2).skip(step.saturating_sub(1)).map(|errors| errors[line]))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl SegmentSurrogate {
    /// Surrogate from a function that gives the coefficients of values at the motions' samples, line by line.
    pub fn new(
        basis: Basis,
        ends: Vec<End>,
        motions: &SegmentMotions,
        mut coefficients: impl FnMut(&[f64]) -> Vec<f64>,
    ) -> Self {
        let times = motions.times.iter().map(|times| coefficients(times)).collect();
        let nodes: Vec<Vec<Vec<f64>>> =
            motions.nodes.iter().map(|nodes| nodes.iter().map(|node| coefficients(node)).collect()).collect();
        let lines = nodes.first().and_then(|nodes| nodes.first()).map_or(0, |node| node.len() / basis.len());
        Self { basis, ends, steps: motions.steps.clone(), times, nodes, lines, squares: None, reach: Vec::new() }
    }

    /// Adds the fit of the coefficients.
    pub fn fitted_by(self, squares: LeastSquares) -> Self {
        Self { squares: Some(squares), ..self }
    }

    /// Sets the samples that give the errors of a jet.
    pub fn told_at(self, xi: &[Vec<f64>]) -> Self {
        let Basis::Taylor { centre, .. } = &self.basis else { return self };
        let of_axis = |(axis, centre): (usize, &f64)| largest(xi.iter().map(|xi| xi[axis] - centre));
        let reach = centre.iter().enumerate().map(of_axis).collect();
        Self { reach, ..self }
    }

    /// Leverage of some ξ outside of the samples that give errors: the square of the factor on these by which a fit, or
    /// a jet, may be off there; at most 1 for a fit among them.
    pub fn leverage(&self, xi: &[f64]) -> f64 {
        if let Basis::Taylor { monomials, centre } = &self.basis {
            let ratios = xi.iter().zip(centre).zip(&self.reach).map(|((xi, centre), reach)| (xi - centre) / reach);
            return largest(ratios).powi(2 * (monomials.order() as i32 + 1));
        }
        let of = |squares: &LeastSquares| {
            self.basis.values(&[xi.to_vec()]).first().map_or(f64::NAN, |terms| squares.leverage(terms))
        };
        self.squares.as_ref().map_or(0.0, of)
    }

    /// Both halves of a jet's part, across the axis in which it lacks most: in which its last terms are largest, as
    /// shares of all of their line. Its centre is the middle of the part.
    pub fn halves(&self) -> Option<[HalfBox; 2]> {
        let Basis::Taylor { monomials, centre } = &self.basis else { return None };
        let (k, order) = (centre.len(), monomials.order());
        // Corners of the part are among the samples.
        let half_widths = self.reach.clone();
        let mut lacks = vec![0.0; k];
        let lines = self.times.iter().map(Vec::as_slice);
        let lines = lines.chain(self.nodes.iter().flatten().flat_map(|node| node.chunks_exact(monomials.len())));
        for line in lines {
            let last = (0..monomials.len()).filter(|&term| monomials.exponents(term).iter().sum::<usize>() == order);
            let mut of_axes = vec![0.0; k];
            for term in last {
                let exponents = monomials.exponents(term);
                let widths = exponents.iter().zip(&half_widths).map(|(&exponent, width)| width.powi(exponent as i32));
                let size = line[term].abs() * widths.product::<f64>();
                of_axes.iter_mut().zip(exponents).for_each(|(own, &exponent)| *own += size * exponent as f64);
            }
            let sum: f64 = of_axes.iter().sum();
            if sum > 0.0 {
                lacks.iter_mut().zip(of_axes).for_each(|(lacks, own)| *lacks += own / sum);
            }
        }
        let axis = (0..k).max_by(|&a, &b| lacks[a].total_cmp(&lacks[b]))?;
        let half = |sign: f64| {
            let (mut middle, mut half_widths) = (centre.clone(), half_widths.clone());
            half_widths[axis] *= 0.5;
            middle[axis] += sign * half_widths[axis];
            let mut ends = self.ends.clone();
            ends.push(End::across(axis, centre[axis], sign, k));
            HalfBox { middle, half_widths, ends }
        };
        Some([half(-1.0), half(1.0)])
    }

    /// Number of positions and velocities, 2n.
    pub fn lines(&self) -> usize {
        self.lines
    }

    /// Fit of the coefficients, if they were fitted.
    pub fn squares(&self) -> Option<&LeastSquares> {
        self.squares.as_ref()
    }

    /// Whether it is a jet.
    pub fn is_jet(&self) -> bool {
        matches!(self.basis, Basis::Taylor { .. })
    }

    /// Size of the terms beyond the coefficients, estimated from these.
    pub fn truncation(&self, coefficients: &[f64]) -> f64 {
        self.basis.truncation(coefficients)
    }

    /// Number of terms.
    pub fn terms(&self) -> usize {
        self.basis.len()
    }

    /// Highest degree in an axis of its polynomials.
    pub fn degree(&self) -> usize {
        self.basis.degree()
    }

    /// Whether it was fitted in a layer behind a surface.
    pub fn is_layer(&self) -> bool {
        self.squares.is_some() && self.ends.iter().any(|end| end.offset != 0.0)
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
    pub fn motion<'p>(&'p self, point: &'p Point, segment: usize, time: f64) -> impl Iterator<Item = f64> + 'p {
        let (step, weights) = self.weights(point, segment, time);
        let nodes = &self.nodes[segment][step * (STEP_NODES - 1)..][..STEP_NODES];
        let terms = &point.terms;
        (0..self.lines).map(move |line| {
            let value = |node: &Vec<f64>| dot(&node[line * terms.len()..][..terms.len()], terms);
            weights.iter().zip(nodes).map(|(weight, node)| weight * value(node)).sum()
        })
    }

    /// The share of a segment that a point is at at a time, and the length of the step there.
    pub fn share(&self, point: &Point, segment: usize, time: f64) -> (f64, f64) {
        let [begin, end] = [point.times[segment], point.times[segment + 1]];
        let (steps, step) = (&self.steps[segment], self.step(point, segment, time));
        ((time - begin) / (end - begin), steps[step] - step.checked_sub(1).map_or(0.0, |before| steps[before]))
    }

    /// The step of a segment in which a point is at a time.
    pub fn step(&self, point: &Point, segment: usize, time: f64) -> usize {
        self.weights(point, segment, time).0
    }

    /// The step of a segment in which a point is at a time, and the weights of its nodes.
    fn weights(&self, point: &Point, segment: usize, time: f64) -> (usize, [f64; STEP_NODES]) {
        let [begin, end] = [point.times[segment], point.times[segment + 1]];
        let steps = &self.steps[segment];
        step_weights(steps, beside(steps, (time - begin) / (end - begin)))
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

    /// Number of terms.
    pub fn terms(&self) -> usize {
        self.terms.len()
    }

    /// The polynomial with these coefficients.
    pub fn value(&self, coefficients: &[f64]) -> f64 {
        dot(coefficients, &self.terms)
    }

    /// Whether it is in the word's part of the box.
    pub fn is_inside(&self) -> bool {
        self.margins.iter().all(|margin| *margin >= 0.0)
    }
}

impl SegmentErrors {
    /// Errors at samples that were cut at the same events.
    pub fn new(surrogate: &SegmentSurrogate, xi: &[Vec<f64>], direct: &SegmentMotions) -> Self {
        let points = surrogate.points(xi.to_vec());
        let terms = surrogate.basis.len();
        let values = |coefficients: &Vec<f64>| -> Vec<f64> {
            let line = |line| points.iter().map(move |point| dot(line, &point.terms));
            coefficients.chunks_exact(terms).flat_map(line).collect()
        };
        let predicted = SegmentMotions {
            samples: direct.samples.clone(),
            steps: direct.steps.clone(),
            times: surrogate.times.iter().map(values).collect(),
            nodes: surrogate.nodes.iter().map(|nodes| nodes.iter().map(values).collect()).collect(),
        };
        let truncation = |coefficients: &[f64]| surrogate.basis.truncation(coefficients);
        let of_line = |nodes: &[Vec<f64>], line: usize| {
            largest(nodes.iter().map(|node| truncation(&node[line * terms..][..terms])))
        };
        let of_step = |nodes: &[Vec<f64>]| (0..surrogate.lines).map(|line| of_line(nodes, line)).collect();
        let of_segment = |nodes: &Vec<Vec<f64>>| {
            let steps = 0..nodes.len() / (STEP_NODES - 1);
            steps.map(|step| of_step(&nodes[step * (STEP_NODES - 1)..][..STEP_NODES])).collect()
        };
        let times = surrogate.times.iter().map(|time| truncation(time)).collect();
        let lines: Vec<Vec<Vec<f64>>> = surrogate.nodes.iter().map(of_segment).collect();
        Self::between(direct, &predicted).or(&Self { times, shares: lines.clone(), lines })
    }

    /// Errors of predicted motions. Lines are compared at the times of the direct nodes: where an instant is late, the
    /// motion at the same share of the segment is that of a later time. If most of a segment is predicted, times in
    /// another one say nothing of this one: there a row is in that one, and the instants' errors count.
    pub fn between(direct: &SegmentMotions, predicted: &SegmentMotions) -> Self {
        let count = direct.samples.len();
        let difference = |(own, values): (&Vec<f64>, &Vec<f64>)| largest(own.iter().zip(values).map(|(a, b)| a - b));
        let times = predicted.times.iter().zip(&direct.times).map(difference).collect();
        let of_segment = |segment: usize| {
            let steps = &direct.steps[segment];
            let lines = direct.nodes[segment].first().map_or(0, |node| node.len() / count.max(1));
            let mut errors = vec![vec![0.0; lines]; steps.len()];
            let mut of_shares = errors.clone();
            for (node, values) in direct.nodes[segment].iter().enumerate() {
                let share = share_of_node(steps, node);
                // A node between two steps is of both.
                let of_steps = node.saturating_sub(1) / (STEP_NODES - 1)..=node / (STEP_NODES - 1);
                let at_share = &predicted.nodes[segment][node];
                for of_step in of_shares.iter_mut().take(of_steps.end() + 1).skip(*of_steps.start()) {
                    for (line, error) in of_step.iter_mut().enumerate() {
                        let samples = line * count..(line + 1) * count;
                        let differences = at_share[samples.clone()].iter().zip(&values[samples]).map(|(a, b)| a - b);
                        *error = largest(differences.chain([*error]));
                    }
                }
                for sample in 0..count {
                    let ends = |times: &[Vec<f64>]| [segment, segment + 1].map(|number| times[number][sample]);
                    let ([begin, end], [from, to]) = (ends(&direct.times), ends(&predicted.times));
                    let other = (begin + share * (end - begin) - from) / (to - from);
                    let is_beside = beside(steps, other) != other;
                    if is_beside && end.min(to) - begin.max(from) >= TUNING.shared_segment * (end - begin) {
                        continue;
                    }
                    let (step, weights) = step_weights(steps, beside(steps, other));
                    let nodes = &predicted.nodes[segment][step * (STEP_NODES - 1)..][..STEP_NODES];
                    for line in 0..lines {
                        let at = line * count + sample;
                        let value: f64 = weights.iter().zip(nodes).map(|(weight, node)| weight * node[at]).sum();
                        for error in errors.iter_mut().take(of_steps.end() + 1).skip(*of_steps.start()) {
                            error[line] = largest([error[line], value - values[at]]);
                        }
                    }
                }
            }
            (errors, of_shares)
        };
        let (lines, shares) = (0..direct.nodes.len()).map(of_segment).unzip();
        Self { times, lines, shares }
    }

    /// The larger of both.
    #[must_use]
    pub fn or(mut self, other: &Self) -> Self {
        let raise = |own: &mut Vec<f64>, other: &Vec<f64>| {
            own.iter_mut().zip(other).for_each(|(own, other)| *own = largest([*own, *other]));
        };
        raise(&mut self.times, &other.times);
        for (own, other) in [(&mut self.lines, &other.lines), (&mut self.shares, &other.shares)] {
            let steps = own.iter_mut().zip(other).flat_map(|(own, other)| own.iter_mut().zip(other));
            steps.for_each(|(own, other)| raise(own, other));
        }
        self
    }

    /// The largest of all steps of each segment behind an event, in each of them.
    #[must_use]
    pub fn of_segments_behind_events(mut self) -> Self {
        for steps in self.lines.iter_mut().skip(1).chain(self.shares.iter_mut().skip(1)) {
            let most = |line: usize| largest(steps.iter().map(|errors| errors[line]));
            let all: Vec<f64> = (0..steps.first().map_or(0, Vec::len)).map(most).collect();
            steps.iter_mut().for_each(|errors| errors.clone_from(&all));
        }
        self
    }

    /// Error of a line in a step of a segment and its neighbours.
    pub fn of_line(&self, segment: usize, step: usize, line: usize) -> f64 {
        beside_step(&self.lines[segment], step, line)
    }

    /// The same at a share of the segment.
    pub fn of_share(&self, segment: usize, step: usize, line: usize) -> f64 {
        beside_step(&self.shares[segment], step, line)
    }
}
