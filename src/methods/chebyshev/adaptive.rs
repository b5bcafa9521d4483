//! Chebyshev bounds within a tolerance: the degree grows parameter by parameter where the response needs it, and where
//! that does not help, the box is split.
//!
//! Each box has a sparse grid (Gerstner & Griebel, Computing 71 (2003) 65). A round adds the indices with the largest expected
//! hierarchical surplus. The surplus of an index is the error of the surrogate at its node before the node is added: for nested
//! nodes, the difference of the polynomials without and with it. The expected surplus is that of the indices before, times what one
//! degree more would change if the response depended on a single weighted sum of the parameters, as it does to first order.
//! Validation samples decide whether the surrogate is good enough.

use std::borrow::Cow;
use std::time::Instant;

use rustc_hash::FxHashMap;

use super::composition::{Composer, Row};
use super::estimator::RangeEstimator;
use super::range_search::{Previous, RangeSearch};
use super::sensitivity::SensitivityAnalysis;
use super::sub_box::{HIGHEST, SubBox};
use crate::methods::ensemble::{Ensemble, EnsembleError, Observed, Sampling, Simulated, Until, lines};
use crate::methods::kept::{KeptRow, KeptSurrogate};
use crate::methods::request::Budget;
use crate::methods::result::Estimate;
use crate::methods::validation::{Validation, ValidationTable};
use crate::numerics::{EMPTY, ParameterBox, Range, SAFETY_OF_SURROGATE, SparseGrid, Surrogate, largest, union};

/// Indices are added whose expected surplus is at least this share of the largest.
const ADDED: f64 = 0.3;

/// Rows in which a surrogate is checked between rounds.
const CHECKED: usize = 48;

/// What a surrogate has to meet.
pub(super) struct Goal {
    /// Error allowed of each output.
    pub allowed: Vec<f64>,
    /// Rows that count: in the others the steps miss the tolerance.
    pub rows: usize,
    pub budget: Budget,
    /// Simulations before the first of these.
    pub spent: usize,
}

/// What an adaptive search finds.
pub(super) struct Adapted {
    /// By row and output; with sensitivities only where the box was not split.
    pub found: Vec<Estimate>,
    /// Simulations of these and those before.
    pub simulations: usize,
    /// Boxes that the whole was split into.
    pub boxes: usize,
    /// Highest degree along each axis.
    pub order: Vec<usize>,
    /// What came of the simulations.
    pub simulated: Simulated,
    /// The surrogate, where it is to be kept.
    pub kept: Option<KeptSurrogate>,
}

/// What is estimated besides ranges and the surrogate's errors.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Detail {
    /// Nothing.
    Errors,
    /// The time steps' errors.
    StepErrors,
    /// These, and the parameters' sensitivities.
    Sensitivities,
}

/// The search for a surrogate within a goal.
pub(super) struct Adaptation<'r> {
    ensemble: &'r dyn Ensemble,
    goal: Goal,
    begun: Instant,
    composer: Composer<'r>,
    simulated: Simulated,
    /// Whether the budget had no room for something.
    exhausted: bool,
    /// Surrogates are checked in every so many rows.
    every: usize,
    search: RangeSearch,
    /// Of the whole box.
    validation: &'r Validation,
    /// The surrogate that is kept, box by box, where one is.
    kept: Option<KeptSurrogate>,
}

impl<'r> Adaptation<'r> {
    /// Before the first simulation.
    pub fn new(ensemble: &'r dyn Ensemble, goal: Goal, validation: &'r Validation, keep: bool) -> Self {
        let every = goal.rows.div_ceil(CHECKED).max(1);
        Self {
            ensemble,
            goal,
            begun: Instant::now(),
            composer: Composer::new(ensemble),
            simulated: Simulated::default(),
            exhausted: false,
            every,
            search: RangeSearch::new(ensemble.domain().dimension()),
            validation,
            kept: keep.then(KeptSurrogate::default),
        }
    }

    /// Refines until the goal is met or the budget is spent.
    ///
    /// # Errors
    /// Where a sample cannot be assembled or a closure not be compiled.
    pub fn search(mut self) -> Result<Adapted, EnsembleError> {
        let mut boxes = vec![self.sub_box(self.ensemble.domain().clone(), Cow::Borrowed(&self.validation.direct))?];
        loop {
            let worst = (0..boxes.len()).max_by(|&a, &b| boxes[a].error.total_cmp(&boxes[b].error)).unwrap_or(0);
            // NaN is not met.
            let met = boxes[worst].error <= 1.0;
            if met && self.every > 1 {
                // Met at some rows: now look at all of them.
                self.every = 1;
                boxes.iter_mut().try_for_each(|sub_box| self.check(sub_box))?;
                continue;
            }
            if met || self.is_spent() || self.simulated.stop.is_some() {
                return self.conclude(&boxes);
            }
            match boxes[worst].axis_to_split() {
                Some(axis) => {
                    let whole = boxes.swap_remove(worst);
                    for half in whole.domain.halves(axis) {
                        let direct = Cow::Owned(self.hold_out(&half)?);
                        boxes.push(self.sub_box(half, direct)?);
                    }
                }
                None => self.refine(&mut boxes[worst])?,
            }
        }
    }

    fn is_spent(&self) -> bool {
        let Budget { simulations, seconds } = self.goal.budget;
        self.exhausted
            || self.ensemble.is_interrupted()
            || self.goal.spent >= simulations
            || seconds.is_some_and(|seconds| self.begun.elapsed().as_secs_f64() >= seconds)
    }

    /// A sub-box of which only the middle is known.
    fn sub_box(&mut self, domain: ParameterBox, direct: Cow<'r, ValidationTable>) -> Result<SubBox<'r>, EnsembleError> {
        let grid = SparseGrid::new(&vec![HIGHEST; domain.dimension()]);
        let nodes = vec![self.simulate(&domain, &[grid.sample(0)])?];
        let surplus = FxHashMap::from_iter([(vec![0; domain.dimension()], f64::INFINITY)]);
        Ok(SubBox { domain, grid, nodes, surplus, direct, error: f64::INFINITY })
    }

    /// Validation samples of a sub-box.
    fn hold_out(&mut self, domain: &ParameterBox) -> Result<ValidationTable, EnsembleError> {
        let samples = domain.samples(&self.validation.points);
        let (direct, simulated) = ValidationTable::of(self.ensemble, &samples, Observed::Motion, true)?;
        self.simulated.add(self.goal.spent, simulated);
        self.goal.spent += samples.len();
        Ok(direct)
    }

    /// Motions and outputs of new nodes.
    fn simulate(&mut self, domain: &ParameterBox, nodes: &[Vec<f64>]) -> Result<(usize, Vec<f64>), EnsembleError> {
        let samples = domain.samples(nodes);
        let mut motions = Vec::new();
        let sampling = Sampling { observed: Observed::Motion, until: Until::FirstStop, finish: true };
        let simulated =
            self.ensemble.simulate(&samples, sampling, &mut |_, values| motions.extend_from_slice(values))?;
        self.simulated.add(self.goal.spent, simulated);
        self.goal.spent += samples.len();
        Ok((samples.len(), motions))
    }

    /// A round: adds the indices with the largest expected surplus.
    fn refine(&mut self, sub_box: &mut SubBox) -> Result<(), EnsembleError> {
        let room = self.goal.budget.simulations.saturating_sub(self.goal.spent);
        let mut added = sub_box.expected(sub_box.grid.candidates());
        let most = added.first().map_or(0.0, |(_, expected)| *expected);
        added.retain(|(_, expected)| *expected >= ADDED * most);
        self.exhausted |= added.len() > room;
        added.truncate(room);
        if added.is_empty() {
            return Ok(());
        }
        let before = Surrogate::sparse(&sub_box.grid);
        let motions = sub_box.motions(self.lines(), 0..sub_box.rows(self.lines()));
        let first = sub_box.grid.len();
        added.iter().for_each(|(levels, _)| sub_box.grid.add(levels));
        let nodes: Vec<Vec<f64>> = (first..sub_box.grid.len()).map(|node| sub_box.grid.sample(node)).collect();
        let new = self.simulate(&sub_box.domain, &nodes)?;
        let surplus = self.errors_at(&before, &sub_box.domain, &motions, &nodes, &new.1)?;
        sub_box.surplus.extend(added.into_iter().map(|(levels, _)| levels).zip(surplus));
        sub_box.nodes.push(new);
        self.check(sub_box)
    }

    /// Values a row and sample of what is observed.
    fn lines(&self) -> usize {
        lines(self.ensemble, Observed::Motion)
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
    ) -> Result<Vec<f64>, EnsembleError> {
        let stride = self.lines() * surrogate.samples().len();
        let own_stride = self.lines() * nodes.len();
        let rows = self.goal.rows.min(motions.len() / stride).min(own.len() / own_stride);
        let times: Vec<f64> = (0..rows).map(|row| self.ensemble.time(row)).collect();
        let allowed = &self.goal.allowed;
        let look = |row: usize, composed: &Row, _: &mut Previous| {
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

    /// Estimates a sub-box's error in some rows.
    fn check(&mut self, sub_box: &mut SubBox) -> Result<(), EnsembleError> {
        let rows: Vec<usize> = (0..self.goal.rows.min(sub_box.rows(self.lines()))).rev().step_by(self.every).collect();
        let found = self.estimates(sub_box, &rows, Detail::Errors)?;
        let allowed = self.goal.allowed.iter().cycle();
        let share = |(found, allowed): (&Estimate, &f64)| SAFETY_OF_SURROGATE * found.error / allowed;
        sub_box.error = largest(found.iter().zip(allowed).map(share));
        Ok(())
    }

    /// Estimates over a sub-box in some rows, by row and output.
    fn estimates(&mut self, sub_box: &SubBox, rows: &[usize], detail: Detail) -> Result<Vec<Estimate>, EnsembleError> {
        let surrogate = Surrogate::sparse(&sub_box.grid);
        let motions = sub_box.motions(self.lines(), rows.iter().copied());
        let stride = self.lines() * surrogate.samples().len();
        let times: Vec<f64> = rows.iter().map(|&row| self.ensemble.time(row)).collect();
        let estimator = RangeEstimator {
            search: &self.search,
            validation: (&self.validation.points, &sub_box.direct),
            halved: (detail != Detail::Errors).then_some((&self.validation.direct, &self.validation.halved)),
            sensitivity: (detail == Detail::Sensitivities)
                .then(|| SensitivityAnalysis::new(&sub_box.domain, &surrogate)),
        };
        let keeps = self.kept.is_some() && detail != Detail::Errors;
        let look = |place: usize, row: &Row, previous: &mut Previous| {
            let found = estimator.estimate(row, rows[place], previous);
            let kept = keeps.then(|| row.kept(found.iter().map(|estimate| estimate.is_own).collect()));
            (found, kept)
        };
        let found = self.composer.rows(&surrogate, &sub_box.domain, &times, (&motions, stride), look)?;
        let (found, kept): (Vec<Vec<Estimate>>, Vec<Option<KeptRow>>) = found.into_iter().unzip();
        if let (true, Some(all)) = (keeps, &mut self.kept) {
            all.add(&sub_box.domain, surrogate.basis(), kept.into_iter().flatten().collect());
        }
        Ok(found.concat())
    }

    /// Ranges over all sub-boxes together, with their errors.
    fn conclude(mut self, boxes: &[SubBox]) -> Result<Adapted, EnsembleError> {
        let nothing = Estimate {
            range: EMPTY,
            error: 0.0,
            step_error: 0.0,
            sensitivity: None,
            is_expanded: false,
            is_own: false,
        };
        let mut found = vec![nothing.clone(); self.ensemble.rows() * self.ensemble.outputs()];
        let mut order = vec![0; self.ensemble.domain().dimension()];
        let detail = if boxes.len() == 1 { Detail::Sensitivities } else { Detail::StepErrors };
        for sub_box in boxes {
            let indices = (0..sub_box.grid.len()).flat_map(|index| sub_box.grid.levels(index).iter().enumerate());
            indices.for_each(|(axis, &degree)| order[axis] = order[axis].max(degree.into()));
            let rows: Vec<usize> = (0..sub_box.rows(self.lines())).collect();
            let known = self.estimates(sub_box, &rows, detail)?;
            let unknown = Estimate { range: Range::UNKNOWN, error: f64::NAN, step_error: f64::NAN, ..nothing.clone() };
            for (all, own) in found.iter_mut().zip(known.into_iter().chain(std::iter::repeat(unknown))) {
                let range = all.range;
                (all.range, all.error) = union((range, all.error), (own.range, own.error));
                all.step_error = union((range, all.step_error), (own.range, own.step_error)).1;
                all.sensitivity = own.sensitivity;
                all.is_expanded |= own.is_expanded;
            }
        }
        let (simulations, boxes) = (self.goal.spent, boxes.len());
        Ok(Adapted { found, simulations, boxes, order, simulated: self.simulated, kept: self.kept })
    }
}
