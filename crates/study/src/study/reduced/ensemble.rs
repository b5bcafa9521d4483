//! Reduced outputs as an ensemble of one row, whose coordinates are the channels: methods that bound outputs bound
//! these too.
//!
//! The samples of rows are those of reduced outputs. The values to which each is reduced are stored, so that it is not
//! simulated twice.

use std::collections::BTreeMap;
use std::ops::Range as Rows;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use symdiff::jet::JetSpace;
use symdiff::taylor_model::ModelSpace;

use super::plan::ReductionPlan;
use super::tuning::TUNING;
use super::values::ChannelValues;
use crate::methods::{
    self, EnclosedRow, EnclosureEnd, Ensemble, EnsembleError, FollowedEnds, Observed, Proof, Sampling, Simulated, Until,
};
use crate::numerics::{CutMotions, Ledger, ParameterBox, Range, Sample};
use crate::simulate::Schedule;

/// A schedule: number of its steps, its longest one's bits, and how many are taken for each.
pub type StepCounts = (usize, u64, usize);

/// Steps, and the bits of a sample's parameters.
type Key = (StepCounts, Vec<u64>);

/// The steps of a schedule.
pub fn steps_of(schedule: &Schedule) -> StepCounts {
    (schedule.steps_before(schedule.rows - 1), schedule.longest_step().to_bits(), schedule.integration.steps())
}

/// Values to which samples were reduced.
#[derive(Debug)]
pub struct Store {
    pub plan: Arc<ReductionPlan>,
    /// By steps and the bits of the parameters.
    kept: Mutex<BTreeMap<Key, Vec<f64>>>,
}

fn bits(sample: &Sample) -> Vec<u64> {
    sample.iter().map(|value| value.to_bits()).collect()
}

impl Store {
    /// An empty store.
    pub fn new(plan: ReductionPlan) -> Self {
        Self { plan: Arc::new(plan), kept: Mutex::default() }
    }

    /// Stores the values to which samples were reduced, channel by channel, sample by sample.
    pub fn keep(&self, steps: StepCounts, samples: &[Sample], values: &[f64]) {
        // Stored values are whole, whoever panicked.
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        for (index, sample) in samples.iter().enumerate() {
            if kept.len() * (self.plan.channels.len() + sample.len()) < TUNING.most_kept {
                let channels = values.iter().skip(index).step_by(samples.len()).copied().collect();
                kept.insert((steps, bits(sample)), channels);
            }
        }
    }

    /// Values to which a sample was reduced.
    pub fn get(&self, steps: StepCounts, sample: &Sample) -> Option<Vec<f64>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).get(&(steps, bits(sample))).cloned()
    }

    /// All samples of a schedule, in an order that does not depend on that of their simulations.
    pub fn samples(&self, steps: StepCounts) -> Vec<(Sample, Vec<f64>)> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let of = |((own, sample), channels): (&Key, &Vec<f64>)| {
            (*own == steps).then(|| (sample.iter().map(|&bits| f64::from_bits(bits)).collect(), channels.clone()))
        };
        kept.iter().filter_map(of).collect()
    }
}

/// An ensemble's reduced outputs.
pub struct ReducedEnsemble<'a> {
    motions: &'a dyn Ensemble,
    store: &'a Store,
    steps: StepCounts,
    scales: Vec<f64>,
    /// Values of all samples of the box that reached the end.
    seen: Ledger,
    /// Ends of the values that were followed along gradients, once they are.
    followed: OnceLock<FollowedEnds>,
}

impl<'a> ReducedEnsemble<'a> {
    /// An ensemble for motions whose reductions are in the store.
    pub fn new(motions: &'a dyn Ensemble, store: &'a Store, schedule: &Schedule) -> Self {
        let (steps, scales) = (steps_of(schedule), vec![1.0; store.plan.expanded]);
        let ensemble = Self {
            motions,
            store,
            steps,
            scales,
            seen: Ledger::new(1, store.plan.values.count()),
            followed: OnceLock::new(),
        };
        store.samples(steps).iter().for_each(|(sample, channels)| ensemble.note(sample, channels));
        ensemble
    }

    /// Adds ends that were followed along gradients.
    pub fn follow(&self, ends: FollowedEnds) {
        self.followed.get_or_init(|| ends);
    }

    /// Notes a sample's values.
    fn note(&self, sample: &Sample, channels: &[f64]) {
        if self.domain().contains(sample) && channels.iter().all(|value| value.is_finite()) {
            let mut values = Vec::new();
            self.store.plan.values.evaluate(channels, sample, &mut values);
            self.seen.note(0, values.len(), 1, &values);
        }
    }

    /// Accumulated reductions.
    pub fn plan(&self) -> &ReductionPlan {
        &self.store.plan
    }

    /// The motions of samples, cut at the events that they meet; `None` if they are not cut.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    pub fn cut(&self, samples: &[Sample]) -> Result<Option<CutMotions>, EnsembleError> {
        self.motions.segments(samples)
    }

    /// The channels of samples; NaN of those that do not reach the end.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    pub fn channels(&self, samples: &[Sample], whole: bool) -> Result<(Vec<Vec<f64>>, Simulated), EnsembleError> {
        let unknown: Vec<Sample> =
            samples.iter().filter(|sample| self.store.get(self.steps, sample).is_none()).cloned().collect();
        let mut simulated = Simulated::default();
        if !unknown.is_empty() {
            let sampling = Sampling { observed: Observed::Outputs, until: Until::End, whole };
            let own = self.motions.simulate(&unknown, sampling, &mut |_, _| ())?;
            simulated = Simulated { stop: None, stopped: Vec::new(), missing: 0, ..own };
        }
        let nothing = || vec![f64::NAN; self.store.plan.channels.len()];
        let of_sample = |sample| {
            let channels = self.store.get(self.steps, sample).unwrap_or_else(nothing);
            self.note(sample, &channels);
            channels
        };
        Ok((samples.iter().map(of_sample).collect(), simulated))
    }
}

impl Ensemble for ReducedEnsemble<'_> {
    fn domain(&self) -> &ParameterBox {
        self.motions.domain()
    }

    fn outputs(&self) -> usize {
        self.store.plan.values.count()
    }

    fn rows(&self) -> usize {
        1
    }

    fn time(&self, _: usize) -> f64 {
        self.motions.time(self.motions.rows() - 1)
    }

    fn rounding(&self, _: usize) -> f64 {
        0.0
    }

    fn has_kink(&self, _: usize) -> bool {
        false
    }

    fn is_extreme(&self, output: usize) -> bool {
        self.store.plan.values.is_extreme(output)
    }

    fn jumps(&self, _: usize) -> bool {
        false
    }

    fn seen(&self, row: usize, output: usize) -> Range {
        self.seen.range(row, output)
    }

    fn followed(&self) -> Option<&FollowedEnds> {
        self.followed.get()
    }

    fn is_interrupted(&self) -> bool {
        self.motions.is_interrupted()
    }

    fn simulate(
        &self,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Result<Simulated, EnsembleError> {
        let (channels, simulated) = self.channels(samples, sampling.whole)?;
        let motions = if sampling.observed == Observed::Motion { 2 * self.scales.len() } else { 0 };
        let mut block = vec![0.0; (motions + self.outputs()) * samples.len()];
        let mut values = Vec::new();
        for (index, (sample, channels)) in samples.iter().zip(&channels).enumerate() {
            let coordinates = channels[..self.scales.len()].iter().take(motions);
            coordinates.enumerate().for_each(|(line, &value)| block[line * samples.len() + index] = value);
            self.store.plan.values.evaluate(channels, sample, &mut values);
            for (line, &value) in values.iter().enumerate() {
                block[(motions + line) * samples.len() + index] = value;
            }
        }
        reduce(0..1, &block);
        Ok(simulated)
    }

    fn jets(&self, _: &JetSpace, _: &mut dyn FnMut(Rows<usize>, &[f64])) -> Result<Simulated, EnsembleError> {
        Err("a reduced output has no Taylor polynomial: it has kinks".into())
    }

    fn obstacle_to_enclosure(&self, _: Proof) -> Option<String> {
        Some("a reduced output".to_owned())
    }

    fn enclose(&self, _: Proof, _: &ModelSpace, _: &ParameterBox, _: &mut EnclosedRow) -> EnclosureEnd {
        EnclosureEnd::default()
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn independent(&self, _: &[f64], _: &[f64], _: f64) -> Vec<usize> {
        (0..self.scales.len()).collect()
    }

    fn closure(&self, independent: Vec<usize>) -> Result<Box<dyn methods::Closure + '_>, EnsembleError> {
        Ok(Box::new(Composition { values: &self.store.plan.values, independent }))
    }
}

/// Values from channels.
pub(super) struct Composition<'a> {
    pub values: &'a ChannelValues,
    pub independent: Vec<usize>,
}

impl methods::Closure for Composition<'_> {
    fn independent(&self) -> &[usize] {
        &self.independent
    }

    fn needs_velocities(&self) -> bool {
        false
    }

    fn outputs(&self, _: f64, count: usize, parameters: Vec<f64>, motion: Vec<f64>) -> Vec<f64> {
        let mut outputs = vec![0.0; self.values.count() * count];
        let (mut channels, mut own, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for point in 0..count {
            channels.clear();
            channels.extend(self.independent.iter().map(|line| motion[line * count + point]));
            own.clear();
            own.extend(parameters.iter().skip(point).step_by(count));
            self.values.evaluate(&channels, &own, &mut values);
            values.iter().enumerate().for_each(|(line, &value)| outputs[line * count + point] = value);
        }
        outputs
    }
}
