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

use super::composition::{Composer, Row, courses, turning};
use super::detail::Detail;
use super::estimator::RangeEstimator;
use super::range_search::{Previous, RangeSearch};
use super::sensitivity::SensitivityAnalysis;
use super::sub_box::{SubBox, highest};
use crate::methods::ensemble::{Ensemble, EnsembleError, Observed, Sampling, Simulated, Until, lines};
use crate::methods::kept::{KeptRow, KeptSurrogate};
use crate::methods::request::Budget;
use crate::methods::result::Estimate;
use crate::methods::validation::{Validation, ValidationTable};
use crate::numerics::{EMPTY, ParameterBox, Range, SAFETY_OF_SURROGATE, SparseGrid, Surrogate, largest, union};

/// Indices are added whose expected surplus is at least this share of the largest.
const ADDED: f64 = 0.3;

/// Nodes that are simulated together, at least, and how many of those that are there may be as many as all new ones.
const TOGETHER: usize = 8;
const GROWTH: usize = 8;

/// Rows in which a surrogate is looked at between rounds.
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

/// The search for a surrogate within a goal.
pub(super) struct Adaptation<'r> {
    ensemble: &'r dyn Ensemble,
    goal: Goal,
    begun: Instant,
    composer: Composer<'r>,
    simulated: Simulated,
    /// Whether the budget had no room for something.
    exhausted: bool,
    /// Surrogates are looked at in every so many rows.
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
            if met && boxes.iter().any(|sub_box| sub_box.estimates.is_none()) {
                // Met as far as a glance tells.
                let detail = Detail::of(&boxes);
                boxes.iter_mut().try_for_each(|sub_box| self.conclude_box(sub_box, detail))?;
                continue;
            }
            if met || self.is_spent() || self.simulated.stop.is_some() {
                return self.conclude(boxes);
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
        let grid = SparseGrid::new(&vec![highest(domain.dimension()); domain.dimension()]);
        let nodes = vec![self.simulate(&domain, &[grid.sample(0)])?];
        let surplus = FxHashMap::from_iter([(vec![0; domain.dimension()], f64::INFINITY)]);
        // What is kept has polynomials of the coordinates themselves.
        let wanted =
            if self.kept.is_some() { Vec::new() } else { turning(&direct, &self.validation.points, self.ensemble) };
        let (count, courses) = courses(self.ensemble, &domain, &wanted)?;
        self.goal.spent += count;
        Ok(SubBox { domain, grid, nodes, surplus, courses, direct, error: f64::INFINITY, estimates: None })
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

    /// A round: adds the indices with the largest expected surplus, and, so that as many nodes are simulated together as go well
    /// together, those that would come next.
    fn refine(&mut self, sub_box: &mut SubBox) -> Result<(), EnsembleError> {
        let room = self.goal.budget.simulations.saturating_sub(self.goal.spent);
        let wanted = TOGETHER.max(sub_box.grid.len() / GROWTH);
        let mut generations = sub_box.next(ADDED, wanted);
        let mut count = 0;
        for added in &mut generations {
            self.exhausted |= added.len() > room - count;
            added.truncate(room - count);
            count += added.len();
        }
        generations.retain(|added| !added.is_empty());
        if generations.is_empty() {
            return Ok(());
        }
        let first = sub_box.grid.len();
        let mut grown = sub_box.grid.clone();
        generations.iter().flatten().for_each(|levels| grown.add(levels));
        let nodes: Vec<Vec<f64>> = (first..grown.len()).map(|node| grown.sample(node)).collect();
        let (count, values) = self.simulate(&sub_box.domain, &nodes)?;
        for added in generations {
            let before = Surrogate::sparse(&sub_box.grid);
            let done = before.samples().len() - first;
            let places = done..done + added.len();
            let own = of_samples(&values, count, places.clone());
            let surplus = self.errors_at(&before, sub_box, &nodes[places], &own)?;
            added.iter().for_each(|levels| sub_box.grid.add(levels));
            sub_box.nodes.push((added.len(), own));
            sub_box.surplus.extend(added.into_iter().zip(surplus));
        }
        self.check(sub_box)
    }

    /// Values a row and sample of what is observed.
    fn lines(&self) -> usize {
        lines(self.ensemble, Observed::Motion)
    }

    /// Largest error of a sub-box's surrogate at new nodes, over the one that is allowed: that of the outputs that follow from its
    /// motion, against those that follow from the nodes' own.
    fn errors_at(
        &mut self,
        surrogate: &Surrogate,
        sub_box: &SubBox,
        nodes: &[Vec<f64>],
        own: &[f64],
    ) -> Result<Vec<f64>, EnsembleError> {
        let stride = self.lines() * surrogate.samples().len();
        let own_stride = self.lines() * nodes.len();
        let reached = self.goal.rows.min(sub_box.rows(self.lines())).min(own.len() / own_stride.max(1));
        let rows = self.looked_at(reached);
        let motions = sub_box.motions(self.lines(), rows.iter().copied());
        let times: Vec<f64> = rows.iter().map(|&row| self.ensemble.time(row)).collect();
        let allowed = &self.goal.allowed;
        let look = |place: usize, composed: &Row, _: &mut Previous| {
            let own = &own[rows[place] * own_stride..];
            let (expected, found) = (composed.evaluate_motion(nodes, own), composed.evaluate(nodes));
            let mut errors = vec![0.0_f64; nodes.len()];
            for (line, &allowed) in allowed.iter().enumerate() {
                for (node, error) in errors.iter_mut().enumerate() {
                    let place = line * nodes.len() + node;
                    *error = largest([*error, (expected[place] - found[place]) / allowed]);
                }
            }
            errors
        };
        let by_row = self.composer.rows(
            surrogate,
            &sub_box.domain,
            &times,
            (&motions, stride, &sub_box.courses),
            false,
            look,
        )?;
        Ok((0..nodes.len()).map(|node| largest(by_row.iter().map(|errors| errors[node]))).collect())
    }

    /// The rows that are looked at of so many, the last ones first.
    fn looked_at(&self, rows: usize) -> Vec<usize> {
        (0..rows).rev().step_by(self.every).collect()
    }

    /// Estimates a sub-box's error. A glance at some rows tells where it may be too large; those are looked at closely, the worst first,
    /// until one of them is.
    fn check(&mut self, sub_box: &mut SubBox) -> Result<(), EnsembleError> {
        sub_box.estimates = None;
        let rows = self.looked_at(self.goal.rows.min(sub_box.rows(self.lines())));
        let glance = self.glance(sub_box, &rows)?;
        let mut suspects: Vec<usize> = (0..rows.len()).filter(|&place| is_missed(glance[place])).collect();
        suspects.sort_by(|&a, &b| glance[b].total_cmp(&glance[a]).then(a.cmp(&b)));
        sub_box.error = glance.iter().filter(|error| **error <= 1.0).fold(0.0, |most, error| error.max(most));
        for place in suspects {
            let found = self.estimates(sub_box, &rows[place..=place], Detail::Errors)?.0;
            sub_box.error = largest([sub_box.error, self.worst(&found)]);
            if is_missed(sub_box.error) {
                break;
            }
        }
        Ok(())
    }

    /// Largest error of some rows' estimates over the one that is allowed, with its safety.
    fn worst(&self, found: &[Estimate]) -> f64 {
        let allowed = self.goal.allowed.iter().cycle();
        largest(found.iter().zip(allowed).map(|(found, allowed)| SAFETY_OF_SURROGATE * found.error / allowed))
    }

    /// For each of some rows the largest error at the samples with the least and the largest values, over the one that is allowed.
    fn glance(&mut self, sub_box: &SubBox, rows: &[usize]) -> Result<Vec<f64>, EnsembleError> {
        let surrogate = Surrogate::sparse(&sub_box.grid);
        let motions = sub_box.motions(self.lines(), rows.iter().copied());
        let stride = self.lines() * surrogate.samples().len();
        let times: Vec<f64> = rows.iter().map(|&row| self.ensemble.time(row)).collect();
        let (points, allowed) = (&self.validation.points, &self.goal.allowed);
        let look = |place: usize, row: &Row, _: &mut Previous| {
            let errors = row.errors_at_samples((points, &sub_box.direct), rows[place]);
            largest(errors.iter().zip(allowed).map(|(error, allowed)| SAFETY_OF_SURROGATE * error / allowed))
        };
        self.composer.rows(&surrogate, &sub_box.domain, &times, (&motions, stride, &sub_box.courses), false, look)
    }

    /// Estimates over a sub-box in some rows, by row and output, and what is kept of them.
    fn estimates(
        &mut self,
        sub_box: &SubBox,
        rows: &[usize],
        detail: Detail,
    ) -> Result<(Vec<Estimate>, Vec<KeptRow>), EnsembleError> {
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
        let velocities = detail != Detail::Errors;
        let found = self.composer.rows(
            &surrogate,
            &sub_box.domain,
            &times,
            (&motions, stride, &sub_box.courses),
            velocities,
            look,
        )?;
        let (found, kept): (Vec<Vec<Estimate>>, Vec<Option<KeptRow>>) = found.into_iter().unzip();
        Ok((found.concat(), kept.into_iter().flatten().collect()))
    }

    /// Estimates over a sub-box in all rows, where they are not known.
    fn conclude_box(&mut self, sub_box: &mut SubBox, detail: Detail) -> Result<(), EnsembleError> {
        if sub_box.estimates.is_none() {
            let rows: Vec<usize> = (0..sub_box.rows(self.lines())).collect();
            let found = self.estimates(sub_box, &rows, detail)?;
            let goal = self.goal.rows.min(rows.len()) * self.goal.allowed.len();
            sub_box.error = self.worst(&found.0[..goal]);
            sub_box.estimates = Some(found);
        }
        Ok(())
    }

    /// Ranges over all sub-boxes together, with their errors.
    fn conclude(mut self, mut boxes: Vec<SubBox>) -> Result<Adapted, EnsembleError> {
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
        let detail = Detail::of(&boxes);
        for sub_box in &mut boxes {
            let indices = (0..sub_box.grid.len()).flat_map(|index| sub_box.grid.levels(index).iter().enumerate());
            indices.for_each(|(axis, &degree)| order[axis] = order[axis].max(degree.into()));
            self.conclude_box(sub_box, detail)?;
            let Some((known, kept)) = sub_box.estimates.take() else { continue };
            if let Some(all) = &mut self.kept {
                all.add(&sub_box.domain, Surrogate::sparse(&sub_box.grid).basis(), kept);
            }
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

/// Whether an error is more than the one that is allowed, which is 1; NaN is.
fn is_missed(error: f64) -> bool {
    error > 1.0 || error.is_nan()
}

/// Values of a part of some samples, line by line.
fn of_samples(values: &[f64], samples: usize, part: std::ops::Range<usize>) -> Vec<f64> {
    values.chunks_exact(samples).flat_map(|line| &line[part.clone()]).copied().collect()
}
