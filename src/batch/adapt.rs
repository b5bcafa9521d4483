//! Chebyshev bounds within a tolerance: the degree grows parameter by parameter where the response asks for it, and where
//! that does not help, the box is split.
//!
//! Each box has a sparse grid (Gerstner & Griebel, Computing 71 (2003) 65). In a round, the indices that taught most are
//! followed by their neighbours of higher level. What a new index teaches is how far the surrogate was off at its nodes: for
//! nested nodes that is |p_n − p_2n|, the error of the surrogate as it was. Whether it is good enough as it is now is told by
//! held-out samples.

use std::time::Instant;

use super::compose::{Composer, Row, Seeker};
use super::methods::{FleetRun, Run};
use super::probe::Table;
use crate::bounds::{
    Extent, ParameterBox, Range, SAFETY_OF_SURROGATE, SparseGrid, Surrogate, held_out, largest, probes, surrogate_error,
};
use crate::integrate::{Observed, SimulationError};
use crate::model::Budget;

/// Highest level of an axis, of 17 nodes; then the box is split.
const HIGHEST: u8 = 4;

/// Of the indices not yet followed, those are that taught at least this share of what the best did.
const FOLLOWED: f64 = 0.25;

/// What surrogates have to meet.
pub(super) struct Goal {
    /// Error allowed of each output.
    pub allowed: Vec<f64>,
    /// Rows that count: the others are lost already.
    pub rows: usize,
    pub budget: Budget,
    /// Simulations before the first of these.
    pub spent: usize,
}

/// What was found of every output in every row, row by row.
pub(super) struct Adapted {
    /// Range and error of the surrogate.
    pub found: Vec<(Range, f64)>,
    /// Simulations of these and those before.
    pub solves: usize,
    /// Boxes that the whole was split into.
    pub boxes: usize,
    /// Highest degree along each axis.
    pub order: Vec<usize>,
    /// What the simulations took.
    pub done: FleetRun,
}

/// A part of the box with its surrogate.
struct Part {
    domain: ParameterBox,
    grid: SparseGrid,
    /// Motions and outputs at the grid's nodes: so many of them, then row by row, line by line, node by node.
    nodes: Vec<(usize, Vec<f64>)>,
    /// Indices whose neighbours are not in the grid yet, and how much they taught.
    unfollowed: Vec<(Vec<u8>, f64)>,
    followed: Vec<Vec<u8>>,
    /// Samples that the surrogate is held against.
    points: Vec<Vec<f64>>,
    direct: Table,
    /// Largest error at those over the one that is allowed.
    error: f64,
}

/// The search for a surrogate within a goal.
pub(super) struct Adaptation<'a, 'r> {
    run: &'r Run<'a>,
    goal: Goal,
    begun: Instant,
    composer: Composer<'a>,
    done: FleetRun,
    /// Whether the budget had no room for something.
    exhausted: bool,
}

impl<'a, 'r> Adaptation<'a, 'r> {
    /// Before the first simulation.
    pub fn new(run: &'r Run<'a>, goal: Goal) -> Self {
        let composer = Composer::new(&run.study.simulator);
        Self { run, goal, begun: Instant::now(), composer, done: FleetRun::default(), exhausted: false }
    }

    /// Refines until the goal is met or the budget is spent. `points` and `direct` are held-out samples of the whole box.
    ///
    /// # Errors
    /// Where a sample cannot be assembled or a closure not be compiled.
    pub fn search(mut self, points: Vec<Vec<f64>>, direct: Table) -> Result<Adapted, SimulationError> {
        let mut parts = vec![self.part(self.run.study.domain.clone(), points, direct)?];
        loop {
            let worst = (0..parts.len()).max_by(|&a, &b| parts[a].error.total_cmp(&parts[b].error)).unwrap_or(0);
            // Not a number is not met.
            if parts[worst].error <= 1.0 || self.is_spent() || self.done.stop.is_some() {
                break;
            }
            match self.axis_to_split(&parts[worst]) {
                Some(axis) => {
                    let whole = parts.swap_remove(worst);
                    for half in halves(&whole.domain, axis) {
                        let (points, direct) = self.hold_out(&half)?;
                        parts.push(self.part(half, points, direct)?);
                    }
                }
                None => self.refine(&mut parts[worst])?,
            }
        }
        self.conclude(parts)
    }

    fn is_spent(&self) -> bool {
        let Budget { solves, seconds } = self.goal.budget;
        self.exhausted
            || self.goal.spent >= solves
            || seconds.is_some_and(|seconds| self.begun.elapsed().as_secs_f64() >= seconds)
    }

    /// The whole of a part is known at its middle alone.
    fn part(&mut self, domain: ParameterBox, points: Vec<Vec<f64>>, direct: Table) -> Result<Part, SimulationError> {
        let grid = SparseGrid::new(&vec![HIGHEST; domain.dimension()]);
        let nodes = vec![self.simulate(&domain, &[grid.sample(0)])?];
        let unfollowed = vec![(vec![0; domain.dimension()], f64::INFINITY)];
        let mut part =
            Part { domain, grid, nodes, unfollowed, followed: Vec::new(), points, direct, error: f64::INFINITY };
        self.check(&mut part)?;
        Ok(part)
    }

    /// Samples of a part to hold its surrogate against.
    fn hold_out(&mut self, domain: &ParameterBox) -> Result<(Vec<Vec<f64>>, Table), SimulationError> {
        let mut points = probes(domain.dimension());
        points.extend(held_out(domain.dimension()));
        let samples: Vec<Vec<f64>> = points.iter().map(|xi| domain.point(xi)).collect();
        let (direct, done) = Table::of(self.run, &samples)?;
        self.done.add(self.goal.spent, done);
        self.goal.spent += samples.len();
        Ok((points, direct))
    }

    /// Motions and outputs of new nodes.
    fn simulate(&mut self, domain: &ParameterBox, nodes: &[Vec<f64>]) -> Result<(usize, Vec<f64>), SimulationError> {
        let samples: Vec<Vec<f64>> = nodes.iter().map(|xi| domain.point(xi)).collect();
        let mut motions = Vec::new();
        let done = self.run.fleet(&samples, Observed::Motion, |_, values| motions.extend_from_slice(values))?;
        self.done.add(self.goal.spent, done);
        self.goal.spent += samples.len();
        Ok((samples.len(), motions))
    }

    /// The axis along which a part is to be split: one whose level can no longer rise where that would teach most.
    fn axis_to_split(&self, part: &Part) -> Option<usize> {
        let best = part.unfollowed.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        match best {
            Some((levels, _)) => levels.iter().position(|&level| level == HIGHEST),
            // Everything has been followed: split what reaches highest.
            None => {
                let highest = |axis: &usize| part.followed.iter().map(|levels| levels[*axis]).max();
                (0..part.domain.dimension()).max_by_key(highest)
            }
        }
    }

    /// A round: the indices that taught most are followed.
    fn refine(&mut self, part: &mut Part) -> Result<(), SimulationError> {
        let most = part.unfollowed.iter().map(|(_, taught)| *taught).fold(0.0, f64::max);
        let (follow, rest): (Vec<_>, Vec<_>) =
            std::mem::take(&mut part.unfollowed).into_iter().partition(|(_, taught)| *taught >= FOLLOWED * most);
        part.unfollowed = rest;
        part.followed.extend(follow.into_iter().map(|(levels, _)| levels));
        let before = Surrogate::sparse(&part.grid);
        let motions = part.motions(self.lines());
        let first = part.grid.len();
        let mut room = self.goal.budget.solves.saturating_sub(self.goal.spent);
        let mut added = Vec::new();
        for candidate in part.grid.candidates() {
            if !part.is_followed_by(&candidate.levels) {
                continue;
            }
            if candidate.cost > room {
                self.exhausted = true;
                continue;
            }
            room -= candidate.cost;
            let nodes = part.grid.add(&candidate.levels);
            added.push((candidate.levels, nodes));
        }
        if added.is_empty() {
            return Ok(());
        }
        let nodes: Vec<Vec<f64>> = (first..part.grid.len()).map(|node| part.grid.sample(node)).collect();
        let new = self.simulate(&part.domain, &nodes)?;
        let taught = self.errors_at(&before, &part.domain, &motions, &nodes, &new.1)?;
        part.unfollowed.extend(added.into_iter().map(|(levels, range)| {
            let taught = &taught[range.start - first..range.end - first];
            (levels, largest(taught.iter().copied()))
        }));
        part.nodes.push(new);
        self.check(part)
    }

    /// Values a row and sample of what is observed.
    fn lines(&self) -> usize {
        Observed::Motion.count(&self.run.study.simulator)
    }

    fn times(&self, rows: usize) -> Vec<f64> {
        (0..rows).map(|row| self.run.schedule.time(row)).collect()
    }

    /// Largest error of a surrogate at new nodes, over the one that is allowed: that of the outputs that follow from its
    /// motion, against those that follow from the nodes' own.
    fn errors_at(
        &mut self,
        surrogate: &Surrogate,
        domain: &ParameterBox,
        motions: &[f64],
        nodes: &[Vec<f64>],
        own: &[f64],
    ) -> Result<Vec<f64>, SimulationError> {
        let stride = self.lines() * surrogate.samples().len();
        let own_stride = self.lines() * nodes.len();
        let rows = self.goal.rows.min(motions.len() / stride).min(own.len() / own_stride);
        let times = self.times(rows);
        let allowed = &self.goal.allowed;
        let look = |row: usize, composed: &Row| {
            let (expected, found) =
                (composed.evaluate_motion(nodes, &own[row * own_stride..]), composed.evaluate(nodes));
            let mut errors = vec![0.0_f64; nodes.len()];
            for (line, &allowed) in allowed.iter().enumerate() {
                for (node, error) in errors.iter_mut().enumerate() {
                    let place = line * nodes.len() + node;
                    *error = largest([*error, (expected[place] - found[place]) / allowed]);
                }
            }
            errors
        };
        let by_row = self.composer.rows(surrogate, domain, &times, (motions, stride), look)?;
        Ok((0..nodes.len()).map(|node| largest(by_row.iter().map(|errors| errors[node]))).collect())
    }

    /// Holds a part's surrogate against its held-out samples.
    fn check(&mut self, part: &mut Part) -> Result<(), SimulationError> {
        let surrogate = Surrogate::sparse(&part.grid);
        let motions = part.motions(self.lines());
        let stride = self.lines() * surrogate.samples().len();
        let rows = self.goal.rows.min(motions.len() / stride);
        let (times, allowed) = (self.times(rows), &self.goal.allowed);
        let count = part.points.len();
        let look = |row: usize, composed: &Row| {
            let found = composed.evaluate(&part.points);
            let errors = found.chunks_exact(count).zip(allowed).enumerate().map(|(output, (found, allowed))| {
                SAFETY_OF_SURROGATE * surrogate_error(found, &part.direct.at(row, output)) / allowed
            });
            largest(errors)
        };
        let errors = self.composer.rows(&surrogate, &part.domain, &times, (&motions, stride), look)?;
        part.error = largest(errors);
        Ok(())
    }

    /// Ranges over all parts, with their errors.
    fn conclude(mut self, parts: Vec<Part>) -> Result<Adapted, SimulationError> {
        let outputs = self.run.outputs();
        let seeker = Seeker::new(self.run.study.domain.dimension());
        let mut found = vec![(EMPTY, 0.0); self.run.schedule.rows * outputs];
        let mut order = vec![0; self.run.study.domain.dimension()];
        for part in &parts {
            let surrogate = Surrogate::sparse(&part.grid);
            for (order, &of_part) in order.iter_mut().zip(surrogate.basis().orders()) {
                *order = usize::from(of_part).max(*order);
            }
            let motions = part.motions(self.lines());
            let stride = self.lines() * surrogate.samples().len();
            let times = self.times(motions.len() / stride);
            let look = |row: usize, composed: &Row| {
                let at_points = composed.evaluate(&part.points);
                let errors = at_points.chunks_exact(part.points.len()).enumerate();
                let errors = errors.map(|(output, found)| surrogate_error(found, &part.direct.at(row, output)));
                let with_gap = |(Extent { range, gap }, error)| (range, gap + error);
                composed.ranges(&seeker).into_iter().zip(errors).map(with_gap).collect::<Vec<_>>()
            };
            let of_part = self.composer.rows(&surrogate, &part.domain, &times, (&motions, stride), look)?;
            let of_part = of_part.into_iter().flatten().chain(std::iter::repeat((Range::UNKNOWN, f64::NAN)));
            found.iter_mut().zip(of_part).for_each(|(all, part)| *all = union(*all, part));
        }
        Ok(Adapted { found, solves: self.goal.spent, boxes: parts.len(), order, done: self.done })
    }
}

impl Part {
    /// Motions and outputs of all nodes: row by row, line by line, node by node.
    fn motions(&self, lines: usize) -> Vec<f64> {
        let count: usize = self.nodes.iter().map(|(count, _)| count).sum();
        let rows = self.nodes.iter().map(|(count, values)| values.len() / (lines * count)).min().unwrap_or(0);
        let mut motions = Vec::with_capacity(rows * lines * count);
        for line in 0..rows * lines {
            for (count, values) in &self.nodes {
                motions.extend_from_slice(&values[line * count..][..*count]);
            }
        }
        motions
    }

    /// Whether all that come before an index have been followed.
    fn is_followed_by(&self, levels: &[u8]) -> bool {
        (0..levels.len()).filter(|&axis| levels[axis] > 0).all(|axis| {
            let mut before = levels.to_vec();
            before[axis] -= 1;
            self.followed.contains(&before)
        })
    }
}

/// Of no part yet.
const EMPTY: Range = Range { lower: f64::INFINITY, upper: f64::NEG_INFINITY };

/// The range of two parts together. Its error is how far its ends may lie from the true ones, given those of the parts'.
fn union((a, of_a): (Range, f64), (b, of_b): (Range, f64)) -> (Range, f64) {
    if a == EMPTY || b.lower.is_nan() {
        return (b, of_b);
    }
    if a.lower.is_nan() {
        return (a, of_a);
    }
    let range = Range { lower: a.lower.min(b.lower), upper: a.upper.max(b.upper) };
    let outer = |x: f64, y: f64, end: f64| (x.max(y) - end).abs();
    let above =
        outer(a.upper + of_a, b.upper + of_b, range.upper).max(outer(a.upper - of_a, b.upper - of_b, range.upper));
    let below =
        outer(of_a - a.lower, of_b - b.lower, -range.lower).max(outer(-of_a - a.lower, -of_b - b.lower, -range.lower));
    let error = if of_a.is_nan() || of_b.is_nan() { f64::NAN } else { above.max(below) };
    (range, error)
}

/// Both halves of a box. Each has its middle for its nominal.
fn halves(domain: &ParameterBox, axis: usize) -> [ParameterBox; 2] {
    let middle = domain.midpoint(axis);
    let mut halves = [domain.clone(), domain.clone()];
    halves[0].upper[axis] = middle;
    halves[1].lower[axis] = middle;
    halves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_union_has_the_error_of_its_ends() {
        let range = |lower, upper| Range { lower, upper };
        let (all, error) = union((range(0.0, 1.0), 0.1), (range(0.5, 2.0), 0.01));
        assert_eq!(all, range(0.0, 2.0));
        assert!((error - 0.1).abs() < 1e-15);
        // An end that another part might go beyond.
        let (_, error) = union((range(0.0, 1.0), 0.01), (range(0.5, 0.99), 0.2));
        assert!((error - 0.19).abs() < 1e-15);
        assert!(union((range(0.0, 1.0), 0.0), (Range::UNKNOWN, f64::NAN)).0.lower.is_nan());
        assert_eq!(union((EMPTY, 0.0), (range(0.0, 1.0), 0.5)), (range(0.0, 1.0), 0.5));
    }
}
