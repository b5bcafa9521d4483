//! Chebyshev bounds within a tolerance: the degree grows parameter by parameter where the response asks for it, and where
//! that does not help, the box is split.
//!
//! Each box has a sparse grid (Gerstner & Griebel, Computing 71 (2003) 65), to which in a round those indices are added that
//! are expected to teach most. What an index teaches is how far the surrogate was off at its node: for nested nodes the
//! difference of the polynomials without and with it. Expected is what those before it taught, times what one degree more
//! would change if the response depended on a single weighted sum of the parameters, as it does to first order. Whether the
//! surrogate is good enough is told by held-out samples.

use std::borrow::Cow;
use std::time::Instant;

use rustc_hash::FxHashMap;

use super::apportion::Apportion;
use super::compose::{Composer, Known, Row, Seeker};
use super::finding::{Finder, Finding};
use super::methods::{FleetRun, Run, Until};
use super::probe::{Probes, Table};
use crate::model::Budget;
use crate::numerics::{EMPTY, ParameterBox, Range, SAFETY_OF_SURROGATE, SparseGrid, Surrogate, largest, union};
use crate::simulate::{Observed, SimulationError};

/// Highest degree in a parameter, of 17 nodes; then the box is split.
const HIGHEST: u8 = 16;

/// Indices are added that are expected to teach at least this share of what the best is.
const ADDED: f64 = 0.3;

/// The box is split where indices of a higher degree than is allowed would teach so many times what the best allowed one would.
const SPLIT: f64 = 4.0;

/// Rows at which a surrogate is looked at between rounds.
const CHECKED: usize = 48;

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
    /// Parts only where the box was not split.
    pub found: Vec<Finding>,
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
struct Part<'r> {
    domain: ParameterBox,
    grid: SparseGrid,
    /// Motions and outputs at the grid's nodes: so many of them, then row by row, line by line, node by node.
    nodes: Vec<(usize, Vec<f64>)>,
    /// What each index of the grid taught.
    taught: FxHashMap<Vec<u8>, f64>,
    /// Samples that the surrogate is held against, at the probes' ξ.
    direct: Cow<'r, Table>,
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
    /// Surrogates are held against samples in every so many rows.
    every: usize,
    seeker: Seeker,
    /// Of the whole box.
    probes: &'r Probes,
}

impl<'a, 'r> Adaptation<'a, 'r> {
    /// Before the first simulation.
    pub fn new(run: &'r Run<'a>, goal: Goal, probes: &'r Probes) -> Self {
        let composer = Composer::new(&run.study.simulator);
        let every = goal.rows.div_ceil(CHECKED).max(1);
        let seeker = Seeker::new(run.study.domain.dimension());
        Self {
            run,
            goal,
            begun: Instant::now(),
            composer,
            done: FleetRun::default(),
            exhausted: false,
            every,
            seeker,
            probes,
        }
    }

    /// Refines until the goal is met or the budget is spent.
    ///
    /// # Errors
    /// Where a sample cannot be assembled or a closure not be compiled.
    pub fn search(mut self) -> Result<Adapted, SimulationError> {
        let mut parts = vec![self.part(self.run.study.domain.clone(), Cow::Borrowed(&self.probes.direct))?];
        loop {
            let worst = (0..parts.len()).max_by(|&a, &b| parts[a].error.total_cmp(&parts[b].error)).unwrap_or(0);
            // Not a number is not met.
            let met = parts[worst].error <= 1.0;
            if met && self.every > 1 {
                // Met at some rows: now look at all of them.
                self.every = 1;
                parts.iter_mut().try_for_each(|part| self.check(part))?;
                continue;
            }
            if met || self.is_spent() || self.done.stop.is_some() {
                return self.conclude(&parts);
            }
            match parts[worst].axis_to_split() {
                Some(axis) => {
                    let whole = parts.swap_remove(worst);
                    for half in whole.domain.halves(axis) {
                        let direct = Cow::Owned(self.hold_out(&half)?);
                        parts.push(self.part(half, direct)?);
                    }
                }
                None => self.refine(&mut parts[worst])?,
            }
        }
    }

    fn is_spent(&self) -> bool {
        let Budget { solves, seconds } = self.goal.budget;
        self.exhausted
            || (self.run.study.interrupted)()
            || self.goal.spent >= solves
            || seconds.is_some_and(|seconds| self.begun.elapsed().as_secs_f64() >= seconds)
    }

    /// The whole of a part is known at its middle alone.
    fn part(&mut self, domain: ParameterBox, direct: Cow<'r, Table>) -> Result<Part<'r>, SimulationError> {
        let grid = SparseGrid::new(&vec![HIGHEST; domain.dimension()]);
        let nodes = vec![self.simulate(&domain, &[grid.sample(0)])?];
        let taught = FxHashMap::from_iter([(vec![0; domain.dimension()], f64::INFINITY)]);
        Ok(Part { domain, grid, nodes, taught, direct, error: f64::INFINITY })
    }

    /// Samples of a part to hold its surrogate against.
    fn hold_out(&mut self, domain: &ParameterBox) -> Result<Table, SimulationError> {
        let samples = domain.points(&self.probes.points);
        let (direct, done) = Table::of(self.run, &samples, Observed::Motion)?;
        self.done.add(self.goal.spent, done);
        self.goal.spent += samples.len();
        Ok(direct)
    }

    /// Motions and outputs of new nodes.
    fn simulate(&mut self, domain: &ParameterBox, nodes: &[Vec<f64>]) -> Result<(usize, Vec<f64>), SimulationError> {
        let samples = domain.points(nodes);
        let mut motions = Vec::new();
        let done =
            self.run.fleet(&samples, Observed::Motion, Until::First, |_, values| motions.extend_from_slice(values))?;
        self.done.add(self.goal.spent, done);
        self.goal.spent += samples.len();
        Ok((samples.len(), motions))
    }

    /// A round: the indices that are expected to teach most are added.
    fn refine(&mut self, part: &mut Part) -> Result<(), SimulationError> {
        let room = self.goal.budget.solves.saturating_sub(self.goal.spent);
        let mut added = part.expected(part.grid.candidates());
        let most = added.first().map_or(0.0, |(_, expected)| *expected);
        added.retain(|(_, expected)| *expected >= ADDED * most);
        self.exhausted |= added.len() > room;
        added.truncate(room);
        if added.is_empty() {
            return Ok(());
        }
        let before = Surrogate::sparse(&part.grid);
        let motions = part.motions(self.lines(), 0..part.rows(self.lines()));
        let first = part.grid.len();
        added.iter().for_each(|(levels, _)| part.grid.add(levels));
        let nodes: Vec<Vec<f64>> = (first..part.grid.len()).map(|node| part.grid.sample(node)).collect();
        let new = self.simulate(&part.domain, &nodes)?;
        let taught = self.errors_at(&before, &part.domain, &motions, &nodes, &new.1)?;
        part.taught.extend(added.into_iter().map(|(levels, _)| levels).zip(taught));
        part.nodes.push(new);
        self.check(part)
    }

    /// Values a row and sample of what is observed.
    fn lines(&self) -> usize {
        Observed::Motion.count(&self.run.study.simulator)
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
        let times: Vec<f64> = (0..rows).map(|row| self.run.schedule.time(row)).collect();
        let allowed = &self.goal.allowed;
        let look = |row: usize, composed: &Row, _: &mut Known| {
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

    /// Finds a part's error in some rows.
    fn check(&mut self, part: &mut Part) -> Result<(), SimulationError> {
        let rows: Vec<usize> = (0..self.goal.rows.min(part.rows(self.lines()))).rev().step_by(self.every).collect();
        let found = self.findings(part, &rows, (false, false))?;
        let allowed = self.goal.allowed.iter().cycle();
        let share = |(found, allowed): (&Finding, &f64)| SAFETY_OF_SURROGATE * found.error / allowed;
        part.error = largest(found.iter().zip(allowed).map(share));
        Ok(())
    }

    /// What is found of a part in some rows, output by output; at last with the steps' errors, and if the box was not split
    /// with the parameters' parts.
    fn findings(
        &mut self,
        part: &Part,
        rows: &[usize],
        (last, unsplit): (bool, bool),
    ) -> Result<Vec<Finding>, SimulationError> {
        let surrogate = Surrogate::sparse(&part.grid);
        let motions = part.motions(self.lines(), rows.iter().copied());
        let stride = self.lines() * surrogate.samples().len();
        let times: Vec<f64> = rows.iter().map(|&row| self.run.schedule.time(row)).collect();
        let finder = Finder {
            seeker: &self.seeker,
            held_out: (&self.probes.points, &part.direct),
            halved: last.then_some((&self.probes.direct, &self.probes.halved)),
            apportion: (last && unsplit).then(|| Apportion::new(&part.domain, &surrogate)),
        };
        let look = |place: usize, row: &Row, known: &mut Known| finder.find(row, rows[place], known);
        Ok(self.composer.rows(&surrogate, &part.domain, &times, (&motions, stride), look)?.concat())
    }

    /// Ranges over all parts, with their errors.
    fn conclude(mut self, parts: &[Part]) -> Result<Adapted, SimulationError> {
        let nothing = Finding { range: EMPTY, error: 0.0, step_error: 0.0, parts: None };
        let mut found = vec![nothing; self.run.schedule.rows * self.run.outputs()];
        let mut order = vec![0; self.run.study.domain.dimension()];
        for part in parts {
            for (axis, &degree) in (0..part.grid.len()).flat_map(|index| part.grid.levels(index).iter().enumerate()) {
                order[axis] = order[axis].max(degree.into());
            }
            let rows: Vec<usize> = (0..part.rows(self.lines())).collect();
            let of_part = self.findings(part, &rows, (true, parts.len() == 1))?;
            let unknown = Finding { range: Range::UNKNOWN, error: f64::NAN, step_error: f64::NAN, parts: None };
            let of_part = of_part.into_iter().chain(std::iter::repeat(unknown));
            for (all, part) in found.iter_mut().zip(of_part) {
                let range = all.range;
                (all.range, all.error) = union((range, all.error), (part.range, part.error));
                all.step_error = union((range, all.step_error), (part.range, part.step_error)).1;
                all.parts = part.parts;
            }
        }
        Ok(Adapted { found, solves: self.goal.spent, boxes: parts.len(), order, done: self.done })
    }
}

impl Part<'_> {
    /// Rows that all nodes have reached.
    fn rows(&self, lines: usize) -> usize {
        self.nodes.iter().map(|(count, values)| values.len() / (lines * count)).min().unwrap_or(0)
    }

    /// Motions and outputs of all nodes: row by row, line by line, node by node.
    fn motions(&self, lines: usize, rows: impl Iterator<Item = usize>) -> Vec<f64> {
        let mut motions = Vec::new();
        for line in rows.flat_map(|row| row * lines..(row + 1) * lines) {
            for (count, values) in &self.nodes {
                motions.extend_from_slice(&values[line * count..][..*count]);
            }
        }
        motions
    }

    /// What indices are expected to teach, the most first.
    fn expected(&self, indices: Vec<Vec<u8>>) -> Vec<(Vec<u8>, f64)> {
        let expect = |levels: Vec<u8>| {
            let expected = self.extrapolated(&levels);
            (levels, expected)
        };
        let mut expected: Vec<(Vec<u8>, f64)> = indices.into_iter().map(expect).collect();
        // Of equals, the first in the alphabet.
        expected.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        expected
    }

    /// The least of what those before an index let expect, as of a power of Σ aᵢ ξᵢ: from ξ^(l − eᵢ) to ξ^l the multinomial
    /// coefficient times the weights changes by aᵢ |l|/lᵢ.
    fn extrapolated(&self, levels: &[u8]) -> f64 {
        let k = levels.len();
        let weight = |axis: usize| {
            let mut first = vec![0; k];
            first[axis] = 1;
            self.taught.get(&first).copied()
        };
        let total: f64 = (0..k).filter_map(weight).sum();
        let degree: f64 = levels.iter().map(|&level| f64::from(level)).sum();
        let from = |axis: usize| {
            let mut before = levels.to_vec();
            before[axis] -= 1;
            let share = weight(axis).map_or(1.0, |weight| if total > 0.0 { weight / total } else { 1.0 });
            self.taught.get(&before).map(|taught| taught * share * degree / f64::from(levels[axis]))
        };
        (0..k).filter(|&axis| levels[axis] > 0).filter_map(from).fold(f64::INFINITY, f64::min)
    }

    /// The axis along which the part is to be split: where its degree is as high as is allowed, and a higher one would teach
    /// much more than whatever else can be added.
    fn axis_to_split(&self) -> Option<usize> {
        let beyond = |levels: &Vec<u8>| {
            let axis = levels.iter().position(|&level| level == HIGHEST)?;
            let mut higher = levels.clone();
            higher[axis] += 1;
            Some((axis, self.extrapolated(&higher)))
        };
        let most = self.taught.keys().filter_map(beyond).max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        let candidates = self.grid.candidates();
        let allowed = candidates.iter().map(|levels| self.extrapolated(levels)).fold(0.0, f64::max);
        match most {
            Some((axis, beyond)) if candidates.is_empty() || beyond > SPLIT * allowed => Some(axis),
            _ => None,
        }
    }
}
