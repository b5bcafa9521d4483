//! Chebyshev bounds within a tolerance: the degree grows parameter by parameter where the response needs it, and where
//! that does not help, the box is split.
//!
//! Each box has a sparse grid (Gerstner & Griebel, Computing 71 (2003) 65). A round adds the indices with the largest
//! expected hierarchical surplus. The surplus of an index is the error of the surrogate at its node before the node is
//! added: for nested nodes, the difference of the polynomials without and with it. The expected surplus is that of the
//! indices before, times the change by one degree more if the response depended on a single weighted sum of the
//! parameters, as it does to first order. Validation samples decide whether the surrogate is good enough, new ones each
//! time it seems to be (`challenge`).

mod assessment;
mod challenge;
pub(crate) mod tuning;

use std::borrow::Cow;

use rustc_hash::FxHashMap;

use super::combined::Combined;
use super::composition::{Composer, courses, turning};
use super::detail::Detail;
use super::range_search::RangeSearch;
use super::sub_box::{SubBox, highest};
use crate::methods::ensemble::{Ensemble, EnsembleError, Observed, Sampling, Simulated, Until};
use crate::methods::kept::KeptSurrogate;
use crate::methods::request::Budget;
use crate::methods::result::Estimate;
use crate::methods::validation::{Validation, ValidationTable};
use crate::numerics::clock::Instant;
use crate::numerics::{EMPTY, ParameterBox, Range, SAFETY_OF_SURROGATE, SparseGrid, Surrogate, largest, union};
use tuning::TUNING;

/// Requirements on a surrogate.
pub(super) struct Goal {
    pub outputs: Vec<OutputGoal>,
    pub budget: Budget,
    /// Simulations before the first of these.
    pub spent: usize,
}

/// Requirements on the surrogate of an output.
pub(super) struct OutputGoal {
    pub allowed: f64,
    /// Rows that count: from the next one on the steps miss the tolerance.
    pub rows: usize,
}

impl Goal {
    /// Rows that count for one output at least.
    pub fn rows(&self) -> usize {
        self.outputs.iter().map(|output| output.rows).max().unwrap_or(0)
    }

    /// Largest error of the outputs for which a row counts, over the one that is allowed; NaN if one is.
    pub fn share(&self, row: usize, errors: impl IntoIterator<Item = f64>) -> f64 {
        let counting = self.outputs.iter().zip(errors).filter(|(output, _)| row < output.rows);
        largest(counting.map(|(output, error)| error / output.allowed))
    }
}

/// Result of an adaptive search.
pub(super) struct Adapted {
    /// Estimates by row and output; with sensitivities only if the box was not split.
    pub found: Vec<Estimate>,
    /// Simulations of these and those before.
    pub simulations: usize,
    /// Boxes that the whole was split into.
    pub boxes: usize,
    /// Highest degree along each axis.
    pub order: Vec<usize>,
    /// Outcome of the simulations.
    pub simulated: Simulated,
    /// The surrogate, if it is to be stored.
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
    /// Interval of the rows in which surrogates are examined.
    every: usize,
    search: RangeSearch,
    /// The ensemble, if it is one over lines through a box.
    combined: Option<&'r Combined<'r>>,
    /// Validation samples of the whole box.
    validation: &'r Validation,
    /// The stored surrogate, box by box, if one is to be stored.
    kept: Option<KeptSurrogate>,
}

/// A surrogate within a goal: over lines through the box where parameters act through one number, else over the box.
/// None over lines can be stored.
///
/// # Errors
/// If a sample cannot be assembled or a closure not be compiled, and at an interruption.
pub(super) fn search(
    ensemble: &dyn Ensemble,
    goal: Goal,
    validation: &Validation,
    keep: bool,
) -> Result<Adapted, EnsembleError> {
    let Some(combined) = Some(ensemble).filter(|_| !keep).and_then(Combined::new) else {
        return Adaptation::new(ensemble, goal, validation, keep).search();
    };
    let on_lines = combined.validation(validation);
    let adapted = Adaptation::over(&combined, goal, &on_lines).search()?;
    Ok(Adapted { order: combined.of_parameters(&adapted.order), ..adapted })
}

impl<'r> Adaptation<'r> {
    /// The search before the first simulation.
    pub fn new(ensemble: &'r dyn Ensemble, goal: Goal, validation: &'r Validation, keep: bool) -> Self {
        let every = goal.rows().div_ceil(TUNING.checked_rows).max(1);
        Self {
            ensemble,
            goal,
            begun: Instant::now(),
            composer: Composer::new(ensemble),
            simulated: Simulated::default(),
            exhausted: false,
            every,
            search: RangeSearch::new(ensemble.domain().dimension()),
            combined: None,
            validation,
            kept: keep.then(KeptSurrogate::default),
        }
    }

    /// The search over lines through a box, before the first simulation.
    pub fn over(combined: &'r Combined<'r>, goal: Goal, validation: &'r Validation) -> Self {
        Self { combined: Some(combined), ..Self::new(combined, goal, validation, false) }
    }

    /// Refines until the goal is met or the budget is spent.
    ///
    /// # Errors
    /// If a sample cannot be assembled or a closure not be compiled, and at an interruption.
    pub fn search(mut self) -> Result<Adapted, EnsembleError> {
        let Validation { points, direct, spread, .. } = self.validation;
        let whole = self.ensemble.domain().clone();
        let mut boxes = vec![self.sub_box(whole, Cow::Borrowed(points.as_slice()), Cow::Borrowed(direct), *spread)?];
        loop {
            let worst = (0..boxes.len()).max_by(|&a, &b| boxes[a].error.total_cmp(&boxes[b].error)).unwrap_or(0);
            // NaN is not met.
            let met = boxes[worst].error <= 1.0;
            self.ensemble.go_on()?;
            let stopped = self.simulated.stop.is_some();
            if (met || self.is_spent()) && !stopped && boxes.iter().any(|sub_box| !sub_box.challenged) {
                boxes.iter_mut().try_for_each(|sub_box| self.challenge(sub_box))?;
                continue;
            }
            if met && self.every > 1 {
                // Met at some rows: now look at all of them.
                self.every = 1;
                boxes.iter_mut().try_for_each(|sub_box| self.check(sub_box))?;
                continue;
            }
            if met && boxes.iter().any(|sub_box| sub_box.estimates.is_none()) {
                // A glance alone finds that they meet it.
                let detail = Detail::of(&boxes);
                boxes.iter_mut().try_for_each(|sub_box| self.conclude_box(sub_box, detail))?;
                continue;
            }
            let doubted = met && !stopped && !self.is_spent() && self.is_contradicted(&boxes);
            if (met && !doubted) || stopped || self.is_spent() {
                return self.conclude(boxes);
            }
            // A box that is refined is to be challenged again.
            boxes[worst].challenged = false;
            let reserve = boxes.iter().map(Self::reserve).sum();
            if doubted {
                let enough = boxes[worst].grid.len() + boxes[worst].grid.len().div_ceil(TUNING.doubted);
                while boxes[worst].grid.len() < enough && !self.is_spent() {
                    let before = boxes[worst].grid.len();
                    self.refine(&mut boxes[worst], reserve)?;
                    // A grid that is full can do no more.
                    self.exhausted |= boxes[worst].grid.len() == before;
                }
                continue;
            }
            match boxes[worst].axis_to_split() {
                Some(axis) => {
                    let whole = boxes.swap_remove(worst);
                    for (half, side) in whole.domain.halves(axis).into_iter().zip([-1.0, 1.0]) {
                        let direct = self.hold_out(&half, &self.validation.points)?;
                        let (inherited, known) = whole.validation_in_half(axis, side);
                        let points = [self.validation.points.as_slice(), &inherited].concat();
                        let direct = if inherited.is_empty() { direct } else { direct.with(&known) };
                        let spread = self.validation.spread;
                        boxes.push(self.sub_box(half, Cow::Owned(points), Cow::Owned(direct), spread)?);
                    }
                }
                None => self.refine(&mut boxes[worst], reserve)?,
            }
        }
    }

    /// Whether something was simulated elsewhere that lies outside of the ranges over all sub-boxes by more than is
    /// allowed.
    fn is_contradicted(&self, boxes: &[SubBox]) -> bool {
        let outputs = self.ensemble.outputs();
        let of = |sub_box: &SubBox, index: usize| {
            let known = sub_box.estimates.as_ref().and_then(|(known, _)| known.get(index));
            known.map_or(Range::UNKNOWN, |known| known.range)
        };
        let beyond = |index: usize| {
            let ranges = boxes.iter().map(|sub_box| (of(sub_box, index), 0.0));
            let (range, _) = ranges.fold((EMPTY, 0.0), union);
            SAFETY_OF_SURROGATE * range.misses(self.ensemble.seen(index / outputs, index % outputs))
        };
        (0..self.goal.rows())
            .any(|row| self.goal.share(row, (0..outputs).map(|output| beyond(row * outputs + output))) > 1.0)
    }

    fn is_spent(&self) -> bool {
        let Budget { simulations, seconds } = self.goal.budget;
        self.exhausted
            || self.goal.spent >= simulations
            || seconds.is_some_and(|seconds| self.begun.elapsed().as_secs_f64() >= seconds)
    }

    /// A sub-box of which only the middle is known, and validation samples, `spread` of them spread over it.
    fn sub_box(
        &mut self,
        domain: ParameterBox,
        points: Cow<'r, [Vec<f64>]>,
        direct: Cow<'r, ValidationTable>,
        spread: usize,
    ) -> Result<SubBox<'r>, EnsembleError> {
        let grid = SparseGrid::new(&vec![highest(domain.dimension()); domain.dimension()]);
        let surplus = FxHashMap::from_iter([(vec![0; domain.dimension()], f64::INFINITY)]);
        // Kept surrogates have polynomials of the coordinates themselves.
        let wanted = if self.kept.is_some() { Vec::new() } else { turning(&direct, &points, self.ensemble) };
        let (count, courses) = courses(self.ensemble, &domain, &wanted)?;
        self.goal.spent += count;
        let middle = self.simulate(&domain, &[grid.sample(0)])?;
        let mut sub_box = SubBox {
            spread,
            challenged: false,
            lines: self.lines() + courses.iter().flatten().count(),
            nodes: Vec::new(),
            error: f64::INFINITY,
            estimates: None,
            domain,
            grid,
            surplus,
            courses,
            points,
            direct,
        };
        sub_box.add(middle.0, middle.1);
        Ok(sub_box)
    }

    /// Validation samples of a sub-box.
    fn hold_out(&mut self, domain: &ParameterBox, points: &[Vec<f64>]) -> Result<ValidationTable, EnsembleError> {
        let samples = domain.samples(points);
        let (direct, simulated) = ValidationTable::of(self.ensemble, &samples, Observed::Motion, true)?;
        self.simulated.add(self.goal.spent, simulated);
        self.goal.spent += samples.len();
        Ok(direct)
    }

    /// Motions and outputs of new nodes.
    fn simulate(&mut self, domain: &ParameterBox, nodes: &[Vec<f64>]) -> Result<(usize, Vec<f64>), EnsembleError> {
        let samples = domain.samples(nodes);
        let mut motions = Vec::new();
        let sampling = Sampling { observed: Observed::Motion, until: Until::FirstStop, whole: true };
        let simulated =
            self.ensemble.simulate(&samples, sampling, &mut |_, values| motions.extend_from_slice(values))?;
        self.simulated.add(self.goal.spent, simulated);
        self.goal.spent += samples.len();
        Ok((samples.len(), motions))
    }

    /// A round: adds the indices with the largest expected surplus, and those that would come next, so that enough
    /// nodes are simulated together. Up to `reserve` simulations of the budget are left for validation samples.
    fn refine(&mut self, sub_box: &mut SubBox, reserve: usize) -> Result<(), EnsembleError> {
        let left = self.goal.budget.simulations.saturating_sub(self.goal.spent);
        let room = left.saturating_sub(reserve.min(self.goal.budget.simulations / TUNING.kept_free));
        let wanted = TUNING.together.max(sub_box.grid.len() / TUNING.growth);
        let mut generations = sub_box.next(TUNING.added, wanted);
        let mut count = 0;
        for added in &mut generations {
            self.exhausted |= added.len() > room - count;
            added.truncate(room - count);
            count += added.len();
        }
        generations.retain(|added| !added.is_empty());
        self.exhausted |= room == 0;
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
            sub_box.add(added.len(), own);
            sub_box.surplus.extend(added.into_iter().zip(surplus));
        }
        sub_box.challenged = false;
        self.check(sub_box)
    }

    /// Ranges over all sub-boxes together, with their errors.
    fn conclude(mut self, mut boxes: Vec<SubBox>) -> Result<Adapted, EnsembleError> {
        let nothing = Estimate {
            range: EMPTY,
            error: 0.0,
            of_search: 0.0,
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

/// Values of a part of some samples, line by line.
fn of_samples(values: &[f64], samples: usize, part: std::ops::Range<usize>) -> Vec<f64> {
    values.chunks_exact(samples).flat_map(|line| &line[part.clone()]).copied().collect()
}
