//! Motions cut at events: segments between them, on a time of their own that runs from 0 to 1.
//!
//! All samples divide a segment at the same shares of its length into steps. Within a step a motion is the polynomial
//! through its values at Chebyshev–Lobatto nodes, so that segments of different lengths have their nodes at the same
//! shares, and the value at a node is a smooth function of the sample.

use std::f64::consts::PI;
use std::sync::LazyLock;

use symdiff::jet::JetSpace;
use symdiff::math;

/// Nodes of a step, both ends included: those of a dense output of order 7.
pub const STEP_NODES: usize = 8;

/// Motions of some samples, cut at the events that they meet.
#[derive(Clone, Debug, Default)]
pub struct CutMotions {
    /// Motions of the samples of each word, which is a sequence of events.
    pub words: Vec<SegmentMotions>,
    /// Surfaces between words.
    pub boundaries: Vec<BoundaryMargins>,
    /// Time from which some sample meets the events of no word, or at which words end, s.
    pub known_to: f64,
}

/// Margins by which samples miss an event, or by how much they would pass it: a function of the parameters that is zero
/// where the event is just grazed.
#[derive(Clone, Debug, Default)]
pub struct BoundaryMargins {
    /// Indices of the words that have the event.
    pub met: Vec<usize>,
    /// Indices of those that do not.
    pub missed: Vec<usize>,
    /// Margin of each sample: positive without the event; NaN for samples of other words.
    pub values: Vec<f64>,
}

/// Motions of the samples of one word.
#[derive(Clone, Debug, Default)]
pub struct SegmentMotions {
    /// Indices of the samples, in the order of their values.
    pub samples: Vec<usize>,
    /// Ends of the steps of each segment, as shares of its length; the last is 1.
    pub steps: Vec<Vec<f64>>,
    /// Times at which segments begin, and at which the last ends, s: by segment, each of all samples.
    pub times: Vec<Vec<f64>>,
    /// Positions and velocities at the nodes: by segment, by node (neighbouring steps share one), line by line, sample
    /// by sample.
    pub nodes: Vec<Vec<Vec<f64>>>,
}

/// Motions of samples at a time on the branch of a segment.
#[derive(Clone, Debug)]
pub struct BranchMotion {
    /// Positions and velocities, line by line, sample by sample.
    pub values: Vec<f64>,
    /// Largest error of each line, if samples are beyond the segment.
    pub doubts: Vec<f64>,
}

impl CutMotions {
    /// Adds other samples, which follow these.
    pub fn append(&mut self, other: Self, own: usize) {
        for (word, other) in self.words.iter_mut().zip(other.words) {
            word.append(other, own);
        }
        for (boundary, other) in self.boundaries.iter_mut().zip(other.boundaries) {
            boundary.values.extend(other.values);
        }
        self.known_to = self.known_to.min(other.known_to);
    }
}

impl SegmentMotions {
    /// Motions of some of the samples, by their indices.
    #[must_use]
    pub fn picked(&self, places: &[usize]) -> Self {
        let count = self.samples.len();
        let pick = |line: &[f64]| places.iter().map(|&index| line[index]).collect::<Vec<f64>>();
        let of_node = |node: &Vec<f64>| node.chunks_exact(count.max(1)).flat_map(pick).collect();
        Self {
            samples: places.iter().map(|&index| self.samples[index]).collect(),
            steps: self.steps.clone(),
            times: self.times.iter().map(|times| pick(times)).collect(),
            nodes: self.nodes.iter().map(|nodes| nodes.iter().map(of_node).collect()).collect(),
        }
    }

    /// Positions and velocities at a time on a segment's branch, which goes on beyond its ends; `None` if a sample is
    /// beyond all steps there by more than `most_beyond` times their length.
    pub fn at(&self, segment: usize, time: f64, most_beyond: f64) -> Option<BranchMotion> {
        let (steps, count) = (&self.steps[segment], self.samples.len());
        let lines = self.nodes[segment].first().map_or(0, |node| node.len() / count.max(1));
        let (mut values, mut doubts) = (vec![0.0; lines * count], vec![0.0_f64; lines]);
        for sample in 0..count {
            let [begin, end] = [segment, segment + 1].map(|number| self.times[number][sample]);
            let BranchWeights { step, all, others } =
                BranchWeights::new(steps, (time - begin) / (end - begin), most_beyond)?;
            let nodes = &self.nodes[segment][step * (STEP_NODES - 1)..][..STEP_NODES];
            for (line, doubt) in doubts.iter_mut().enumerate() {
                let at = line * count + sample;
                values[at] = all.iter().zip(nodes).map(|(weight, node)| weight * node[at]).sum();
                if let Some((first, weights)) = &others {
                    let other: f64 = weights.iter().zip(&nodes[*first..]).map(|(weight, node)| weight * node[at]).sum();
                    *doubt = doubt.max((values[at] - other).abs());
                }
            }
        }
        Some(BranchMotion { values, doubts })
    }

    /// Coefficients of the lines of a jet, whose terms are the samples, at a time on a segment's branch, line by line:
    /// the polynomial through a step's nodes, at the jet of the share. `None` if the centre is beyond all steps by more
    /// than `most_beyond` times their length.
    pub fn jet_at(&self, space: &JetSpace, segment: usize, time: f64, most_beyond: f64) -> Option<Vec<f64>> {
        let terms = space.len();
        let product = |a: &[f64], b: &[f64]| {
            let mut out = vec![0.0; terms];
            space.mul(a, b, &mut out);
            out
        };
        let [begin, end] = [&self.times[segment], &self.times[segment + 1]];
        let length: Vec<f64> = end.iter().zip(begin).map(|(end, begin)| end - begin).collect();
        let mut since: Vec<f64> = begin.iter().map(|begin| -begin).collect();
        since[0] += time;
        let mut share = vec![0.0; terms];
        space.div(&since, &length, &mut share);
        let steps = &self.steps[segment];
        let (step, at_centre) = nearest_step(steps, share[0], most_beyond)?;
        let first = step.checked_sub(1).map_or(0.0, |before| steps[before]);
        let mut local: Vec<f64> = share.iter().map(|share| share / (steps[step] - first)).collect();
        local[0] = at_centre;
        // Lagrange's polynomials, which do not divide by the distance to a node.
        let nodes = step_nodes();
        let mut motion = vec![0.0; self.nodes[segment][0].len()];
        for (number, node) in nodes.iter().enumerate() {
            let mut weight = vec![0.0; terms];
            weight[0] = 1.0;
            for other in nodes.iter().filter(|other| *other != node) {
                let mut factor: Vec<f64> = local.iter().map(|own| own / (node - other)).collect();
                factor[0] -= other / (node - other);
                weight = product(&weight, &factor);
            }
            let values = &self.nodes[segment][step * (STEP_NODES - 1) + number];
            for (line, own) in motion.chunks_exact_mut(terms).zip(values.chunks_exact(terms)) {
                space.accumulate(&weight, own, line);
            }
        }
        Some(motion)
    }

    /// Largest size of each line over all nodes and samples.
    pub fn scales(&self) -> Vec<f64> {
        let count = self.samples.len().max(1);
        let mut scales = Vec::new();
        for node in self.nodes.iter().flatten() {
            scales.resize(node.len() / count, 0.0);
            for (scale, line) in scales.iter_mut().zip(node.chunks_exact(count)) {
                *scale = line.iter().fold(*scale, |most: f64, value| most.max(value.abs()));
            }
        }
        scales
    }

    /// The motions with other times, and other values at nodes.
    #[must_use]
    pub fn mapped(&self, values: impl Fn(&Vec<f64>) -> Vec<f64>) -> Self {
        Self {
            samples: self.samples.clone(),
            steps: self.steps.clone(),
            times: self.times.iter().map(&values).collect(),
            nodes: self.nodes.iter().map(|nodes| nodes.iter().map(&values).collect()).collect(),
        }
    }

    fn append(&mut self, other: Self, offset: usize) {
        if other.samples.is_empty() {
            return;
        }
        if self.samples.is_empty() {
            *self = Self { samples: Vec::new(), ..other.clone() };
        } else {
            for (times, other) in self.times.iter_mut().zip(&other.times) {
                times.extend(other);
            }
            let (own, others) = (self.samples.len(), other.samples.len());
            let joined = |node: &Vec<f64>, other: &Vec<f64>| -> Vec<f64> {
                let lines = node.chunks_exact(own).zip(other.chunks_exact(others));
                lines.flat_map(|(own, other)| own.iter().chain(other).copied()).collect()
            };
            for (nodes, other) in self.nodes.iter_mut().zip(&other.nodes) {
                *nodes = nodes.iter().zip(other).map(|(node, other)| joined(node, other)).collect();
            }
        }
        self.samples.extend(other.samples.iter().map(|sample| offset + sample));
    }
}

static NODES: LazyLock<[f64; STEP_NODES]> =
    LazyLock::new(|| std::array::from_fn(|node| 0.5 * (1.0 - math::cos(PI * node as f64 / (STEP_NODES - 1) as f64))));

/// Shares of a step at which its nodes are.
pub fn step_nodes() -> [f64; STEP_NODES] {
    *NODES
}

/// The step of a segment that holds a share, and the weights of its nodes there; a share beyond the segment's ends is
/// extrapolated.
pub fn step_weights(ends: &[f64], share: f64) -> (usize, [f64; STEP_NODES]) {
    let step = ends.partition_point(|&end| end < share).min(ends.len().saturating_sub(1));
    let begin = if step == 0 { 0.0 } else { ends[step - 1] };
    let local = (share - begin) / (ends[step] - begin);
    let nodes = step_nodes();
    if let Some(node) = nodes.iter().position(|&node| node == local) {
        let mut weights = [0.0; STEP_NODES];
        weights[node] = 1.0;
        return (step, weights);
    }
    // Barycentric weights of Chebyshev–Lobatto nodes: alternating signs, halved at the ends.
    let mut weights: [f64; STEP_NODES] = std::array::from_fn(|node| {
        let end = node == 0 || node + 1 == STEP_NODES;
        let sign = if node % 2 == 0 { 1.0 } else { -1.0 };
        sign * if end { 0.5 } else { 1.0 } / (local - nodes[node])
    });
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    (step, weights)
}

/// Weights of the nodes of a step on the branch of a segment.
struct BranchWeights {
    step: usize,
    all: [f64; STEP_NODES],
    /// Beyond the segment, the number of the first and the weights of all nodes but the farthest: the difference of the
    /// polynomial through these estimates the error of that through all.
    others: Option<(usize, Vec<f64>)>,
}

impl BranchWeights {
    fn new(steps: &[f64], share: f64, most_beyond: f64) -> Option<Self> {
        if (0.0..=1.0).contains(&share) {
            let (step, all) = step_weights(steps, share);
            return Some(Self { step, all, others: None });
        }
        let (step, local) = nearest_step(steps, share, most_beyond)?;
        let (nodes, first) = (step_nodes(), usize::from(local > 0.0));
        let others = lagrange_weights(&nodes[first..first + STEP_NODES - 1], local);
        let all = lagrange_weights(&nodes, local).try_into().ok()?;
        Some(Self { step, all, others: Some((first, others)) })
    }
}

/// The step of a segment that a share exceeds least, in lengths of the step, and the share within it: steps next to
/// events are shorter, so that a longer one before them reaches farther. `None` if the share is beyond the step by more
/// than `most_beyond` times its length.
fn nearest_step(ends: &[f64], share: f64, most_beyond: f64) -> Option<(usize, f64)> {
    let local = |step: usize| {
        let begin = step.checked_sub(1).map_or(0.0, |before| ends[before]);
        (share - begin) / (ends[step] - begin)
    };
    let beyond = |step: usize| (local(step) - 0.5).abs();
    let nearer = |a: usize, b: usize| if beyond(b) < beyond(a) { b } else { a };
    let step = (0..ends.len()).reduce(nearer)?;
    (beyond(step) <= 0.5 + most_beyond).then(|| (step, local(step)))
}

/// Weights of values at nodes in the polynomial through them.
fn lagrange_weights(nodes: &[f64], at: f64) -> Vec<f64> {
    let weight = |own: &f64| nodes.iter().filter(|node| *node != own).map(|node| (at - node) / (own - node)).product();
    nodes.iter().map(weight).collect()
}

/// Weights of values at `N` points that divide a step into equal parts, at a share of it; a share beyond the step's
/// ends is extrapolated.
pub fn equispaced_weights<const N: usize>(share: f64) -> [f64; N] {
    let local = share * (N - 1) as f64;
    if local.fract() == 0.0 && (0.0..N as f64).contains(&local) {
        return std::array::from_fn(|point| f64::from(u8::from(point as f64 == local)));
    }
    // Barycentric weights of equispaced points: binomial coefficients with alternating signs.
    let mut binomial = -1.0;
    let mut weights: [f64; N] = std::array::from_fn(|point| {
        binomial *= if point == 0 { -1.0 } else { -((N - point) as f64) / point as f64 };
        binomial / (local - point as f64)
    });
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equispaced_weights_reproduce_polynomials() {
        let f = |s: f64| 1.0 + s * (2.0 - s * s * s) + s.powi(7);
        for share in [0.0, 0.1, 1.0 / 7.0, 0.5, 6.0 / 7.0, 1.0, 1.001] {
            let weights: [f64; STEP_NODES] = equispaced_weights(share);
            let value: f64 = weights.iter().enumerate().map(|(point, weight)| weight * f(point as f64 / 7.0)).sum();
            assert!((value - f(share)).abs() < 1e-12, "{share}: {value}");
        }
    }

    #[test]
    fn polynomials_of_degree_seven_are_exact() {
        let ends = [0.3, 1.0];
        let f = |s: f64| 1.0 + s * (2.0 - s * s * s) + s.powi(7);
        for share in [0.0, 0.1, 0.3, 0.31, 0.9, 1.0, 1.05] {
            let (step, weights) = step_weights(&ends, share);
            let (begin, end) = if step == 0 { (0.0, 0.3) } else { (0.3, 1.0) };
            let values = step_nodes().map(|node| f(begin + (end - begin) * node));
            let value: f64 = weights.iter().zip(values).map(|(weight, value)| weight * value).sum();
            assert!((value - f(share)).abs() < 1e-12, "{share}: {value}");
        }
    }

    /// Motions y = e^t, v = e^t of samples whose segments end at 0.9 and 1 s, in steps that become shorter.
    fn grown() -> SegmentMotions {
        let (steps, ends) = (vec![0.5, 0.9, 0.99, 1.0], [0.9, 1.0]);
        let node = |number: usize| {
            let step = (number / (STEP_NODES - 1)).min(steps.len() - 1);
            let begin = step.checked_sub(1).map_or(0.0, |before: usize| steps[before]);
            let share = begin + (steps[step] - begin) * step_nodes()[number - step * (STEP_NODES - 1)];
            [ends, ends].concat().iter().map(|end| (share * end).exp()).collect::<Vec<f64>>()
        };
        let nodes = vec![(0..=steps.len() * (STEP_NODES - 1)).map(node).collect()];
        SegmentMotions { samples: vec![0, 1], times: vec![vec![0.0; 2], ends.to_vec()], nodes, steps: vec![steps] }
    }

    #[test]
    fn motions_continue_beyond_their_segments() {
        let motions = grown();
        for time in [-0.3, 0.0, 0.45, 0.95, 1.3] {
            let BranchMotion { values, doubts } = motions.at(0, time, 2.0).unwrap();
            let off = values.iter().map(|value| (value - f64::exp(time)).abs()).fold(0.0, f64::max);
            assert!(off <= doubts[0].max(1e-8) && off < 1e-4, "{off:e} of {:e} at {time} s", doubts[0]);
            assert_eq!(!(0.0..=0.9).contains(&time), doubts[0] > 0.0, "{time}");
        }
        assert!(motions.at(0, 3.0, 2.0).is_none());
    }

    /// t³ + 2t in a segment that lasts 1 + 0.1 ξ + 0.02 ξ² s: at a time it depends on no parameter, and it goes on
    /// beyond the segment.
    #[test]
    fn jet_at_a_time_is_independent_of_its_segment() {
        let space = JetSpace::new(1, 3);
        let length = vec![1.0, 0.1, 0.02, 0.0];
        let steps = vec![0.6, 0.95, 1.0];
        let product = |a: &[f64], b: &[f64]| {
            let mut out = vec![0.0; space.len()];
            space.mul(a, b, &mut out);
            out
        };
        let node = |number: usize| -> Vec<f64> {
            let step = (number / (STEP_NODES - 1)).min(steps.len() - 1);
            let begin = step.checked_sub(1).map_or(0.0, |before: usize| steps[before]);
            let share = begin + (steps[step] - begin) * step_nodes()[number - step * (STEP_NODES - 1)];
            let time: Vec<f64> = length.iter().map(|term| share * term).collect();
            let cube = product(&time, &product(&time, &time));
            cube.iter().zip(&time).map(|(cube, time)| cube + 2.0 * time).collect()
        };
        let nodes = vec![(0..=steps.len() * (STEP_NODES - 1)).map(node).collect()];
        let jet =
            SegmentMotions { samples: vec![0], times: vec![vec![0.0; 4], length.clone()], nodes, steps: vec![steps] };
        for time in [0.0, 0.3, 0.98, 1.1, 1.3] {
            let found = jet.jet_at(&space, 0, time, 2.0).unwrap();
            let expected = [time.powi(3) + 2.0 * time, 0.0, 0.0, 0.0];
            let off = found.iter().zip(expected).map(|(own, other)| (own - other).abs()).fold(0.0, f64::max);
            assert!(off < 1e-10, "{found:?} at {time} s");
        }
        assert!(jet.jet_at(&space, 0, 3.0, 2.0).is_none());
    }
}
