//! Outputs over time at chosen samples, in lockstep, a chunk of samples after the other, so that memory does not grow
//! with their number.

use std::ops::Range;

use super::bounding::simulation_error;
use super::problem::Study;
use super::stepping::{StepPlan, balance, controlling_samples, divided, planned, segmented_samples};

use super::ensemble::{Motions, Progress, Stored, samples_of_part};
use super::prepared::{Prepared, choices, prepare};
use super::reduced::{plan_reduction, values_of_samples};
use super::tuning::TUNING;
use super::{Options, RunError, pool, reduced};
use crate::methods::{Ensemble, Observed, Sampling, Until};
use crate::model::Description;
use crate::numerics::Sample;
use crate::reduce::Subsystem;
use crate::simulate::SimulationError;

/// Samples of the uncertain parameters, in the model's order, which are made when they are needed.
#[derive(Clone, Copy)]
pub struct ChosenSamples<'c> {
    /// Number of samples.
    pub count: usize,
    /// Returns the samples of a range.
    pub at: &'c (dyn Fn(Range<usize>) -> Vec<Sample> + Sync),
}

/// Numbers of samples that are incomplete.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sampled {
    /// Samples that cannot be assembled.
    pub closed: usize,
    /// Samples that stopped before the end.
    pub stopped: usize,
}

/// Numbers of the columns of a subsystem's lines; `None` if a line is not shown.
type Columns = Vec<Option<usize>>;

/// A compiled model, and the samples that it is to be simulated at.
pub struct Trajectories<'t> {
    pub(super) studies: &'t [Study<'t>],
    pub(super) subsystems: &'t [Subsystem],
    pub(super) steps: &'t [StepPlan],
    progress: &'t Progress<'t>,
    chosen: ChosenSamples<'t>,
    /// Columns of each subsystem.
    pub(super) columns: Vec<Columns>,
    /// Names and units of the outputs.
    pub outputs: Vec<(String, String)>,
    /// Times of the rows, s.
    pub times: Vec<f64>,
    /// Why the rows end before the motion does, if no step fulfils the tolerance from there on.
    pub ended: Option<SimulationError>,
}

/// Compiles a model, chooses its steps as a run does, and gives them to `write`, which asks for the samples by
/// `Trajectories::each`.
///
/// # Errors
/// If the mechanism cannot be built or stepped, and those of `write`.
pub fn sample<T: Send, E: From<RunError> + Send>(
    description: &Description,
    options: &Options,
    chosen: ChosenSamples,
    write: impl FnOnce(&Trajectories) -> Result<T, E> + Send,
) -> Result<T, E> {
    let pool = pool(options.threads);
    let pool = pool.map_err(RunError::from)?;
    let model = reduced::expanded(description);
    pool.install(|| {
        (options.stage)("compiling");
        let (_, prepared) = prepare(&model, choices(&model, options))?;
        let (mut subsystems, mut simulators) = (Vec::new(), Vec::new());
        for Prepared { subsystem, simulator } in prepared {
            subsystems.push(subsystem);
            simulators.push(simulator);
        }
        // Only the steps are those of a run.
        let options = Options { methods: Some(Vec::new()), ..*options };
        let studies = subsystems.iter().zip(simulators).enumerate().map(|(number, (subsystem, simulator))| {
            let mut study = Study::new(&subsystem.description, simulator, &options)?;
            study.stored = options.store.map(|store| Stored { store, subsystem: number, assembles_first: false });
            Ok(study)
        });
        let studies = studies.collect::<Result<Vec<Study>, RunError>>()?;
        let first = (chosen.at)(0..chosen.count.min(TUNING.samples_of_events));
        let steps = studies.iter().zip(&subsystems).map(|(study, subsystem)| {
            let own: Vec<Sample> = first.iter().map(|sample| of_subsystem(subsystem, sample)).collect();
            let can = study.simulator.can_assemble(&own);
            let own: Vec<Sample> = own.into_iter().zip(can).filter(|(_, can)| *can).map(|(own, _)| own).collect();
            steps_of_samples(study, &own)
        });
        let steps = steps.collect::<Result<Vec<_>, _>>();
        let (steps, ended): (Vec<StepPlan>, Vec<_>) = steps.map_err(RunError::from)?.into_iter().unzip();
        let rows = steps.iter().map(|plan| plan.schedule.rows).max().unwrap_or(0);
        let times = steps.iter().find(|plan| plan.schedule.rows == rows);
        let times = times.map_or_else(Vec::new, |plan| (0..rows).map(|row| plan.schedule.time(row)).collect());
        let (columns, outputs) = columns(description, &subsystems, &studies);
        if options.store.is_some() {
            let bytes = |(study, plan): (&Study, &StepPlan)| {
                let samples = if study.domain.dimension() == 0 { 1 } else { chosen.count };
                (8 * study.simulator.system.outputs.len() * plan.schedule.rows * samples) as u64
            };
            (options.disk)(studies.iter().zip(&steps).map(bytes).sum());
        }
        let progress = Progress::new(studies.len() * chosen.count * rows, options.progress);
        (options.stage)("samples");
        write(&Trajectories {
            studies: &studies,
            subsystems: &subsystems,
            steps: &steps,
            progress: &progress,
            chosen,
            columns,
            outputs,
            times,
            ended: ended.into_iter().flatten().next(),
        })
    })
}

/// Columns of the subsystems' lines, with names and units: the model's own outputs, then those of an analysis.
fn columns(
    description: &Description,
    subsystems: &[Subsystem],
    studies: &[Study],
) -> (Vec<Columns>, Vec<(String, String)>) {
    let own = description.outputs.len();
    let mut outputs: Vec<_> =
        description.outputs.iter().map(|output| (output.name.clone(), output.unit.clone())).collect();
    let of_study = |(subsystem, study): (&Subsystem, &Study)| {
        let lines = study.simulator.system.outputs.iter().enumerate();
        let column = |(line, output): (usize, &crate::assemble::OutputInfo)| match subsystem.outputs.get(line) {
            // Outputs that only reduced outputs need are not shown.
            Some(&number) => (number < own).then_some(number),
            None => {
                outputs.push((output.name.clone(), output.unit.clone()));
                Some(outputs.len() - 1)
            }
        };
        lines.map(column).collect()
    };
    let columns = subsystems.iter().zip(studies).map(of_study).collect();
    (columns, outputs)
}

impl Trajectories<'_> {
    /// Simulates all samples. `keep` gets values (sample, row, output) of consecutive samples; NaN if a sample
    /// cannot be assembled, and from where it stops. `None` after an interruption.
    ///
    /// # Errors
    /// If samples cannot be simulated, are deferred to shards, or of `keep`.
    pub fn each<E: From<RunError>>(&self, mut keep: impl FnMut(&[f64]) -> Result<(), E>) -> Result<Option<Sampled>, E> {
        let steps = self.studies.iter().zip(self.steps);
        let motions: Vec<Motions> = steps.map(|(study, plan)| study.motions(plan.steps(), self.progress)).collect();
        let lines = self.columns.iter().map(Vec::len).sum();
        let size = samples_of_part(lines, self.times.len());
        let closed = self.closed(size);
        if closed.len() < self.chosen.count {
            return Ok(None);
        }
        match self.store(&motions, size, &closed) {
            Err(SimulationError::Interrupted) => return Ok(None),
            done => done.map_err(RunError::from)?,
        }
        let width = self.outputs.len();
        let mut stopped = 0;
        let mut values = Vec::new();
        for first in (0..self.chosen.count).step_by(size) {
            let indices = first..(first + size).min(self.chosen.count);
            values.clear();
            values.resize(indices.len() * self.times.len() * width, f64::NAN);
            let mut stops = vec![false; indices.len()];
            for (number, motions) in motions.iter().enumerate() {
                self.chunk(number, motions, indices.clone(), &closed, &mut values, &mut stops)
                    .map_err(RunError::from)?;
            }
            if motions.iter().any(Ensemble::is_interrupted) {
                return Ok(None);
            }
            stopped += stops.into_iter().filter(|stopped| *stopped).count();
            keep(&values)?;
        }
        Ok(Some(Sampled { closed: closed.into_iter().filter(|closed| *closed).count(), stopped }))
    }

    /// Whether the motion has switches.
    pub fn has_switches(&self) -> bool {
        self.studies.iter().any(|study| study.simulator.switches().is_some())
    }

    /// Also reduces all samples that are simulated from now on.
    ///
    /// # Errors
    /// If the nominal motion cannot be assembled.
    pub(super) fn plan_reductions(&self) -> Result<(), SimulationError> {
        self.studies.iter().zip(self.steps).try_for_each(|(study, plan)| plan_reduction(study, plan))
    }

    /// Values of `reduced` reduced outputs and then `requirements` requirements, sample by sample; NaN if one is
    /// unknown.
    pub(super) fn numbers(&self, reduced: usize, requirements: usize) -> Vec<f64> {
        let width = reduced + requirements;
        let mut all = vec![f64::NAN; self.chosen.count * width];
        let samples = (self.chosen.at)(0..self.chosen.count);
        for ((study, plan), subsystem) in self.studies.iter().zip(self.steps).zip(self.subsystems) {
            let own: Vec<Sample> = samples.iter().map(|sample| of_subsystem(subsystem, sample)).collect();
            let numbers = subsystem.reduced.iter().copied();
            let numbers: Vec<usize> = numbers.chain(subsystem.requirements.iter().map(|own| reduced + own)).collect();
            let found = values_of_samples(study, &plan.schedule, &own);
            for (of_sample, found) in all.chunks_exact_mut(width.max(1)).zip(found) {
                numbers.iter().zip(found).for_each(|(&number, value)| of_sample[number] = value);
            }
        }
        all
    }

    /// Whether each sample cannot be assembled; of fewer samples after an interruption.
    fn closed(&self, size: usize) -> Vec<bool> {
        let mut closed = Vec::with_capacity(self.chosen.count);
        for first in (0..self.chosen.count).step_by(size) {
            if self.studies.iter().any(|study| study.interruption.is_asked()) {
                break;
            }
            let samples = (self.chosen.at)(first..(first + size).min(self.chosen.count));
            closed.resize(first + samples.len(), false);
            for (study, subsystem) in self.studies.iter().zip(self.subsystems) {
                let own: Vec<Sample> = samples.iter().map(|sample| of_subsystem(subsystem, sample)).collect();
                for (closed, can) in closed[first..].iter_mut().zip(study.simulator.can_assemble(&own)) {
                    *closed |= !can;
                }
            }
        }
        closed
    }

    /// Simulates the missing parts, or leaves all of them to shards.
    fn store(&self, motions: &[Motions], size: usize, closed: &[bool]) -> Result<(), SimulationError> {
        let mut deferred = false;
        for (number, (study, motions)) in self.studies.iter().zip(motions).enumerate() {
            let Some(stored) = &study.stored else { continue };
            let count = if study.domain.dimension() == 0 { size.min(self.chosen.count) } else { self.chosen.count };
            let chunks = (0..count).step_by(size);
            let parts = chunks.map(|first| self.own(number, first..(first + size).min(count), closed).1);
            match stored.prepare(motions, parts.filter(|samples| !samples.is_empty())) {
                Err(SimulationError::Deferred) => deferred = true,
                done => done?,
            }
        }
        if deferred { Err(SimulationError::Deferred) } else { Ok(()) }
    }

    /// Samples of a subsystem that can be assembled, with their indices from the first; one if it depends on none.
    fn own(&self, number: usize, indices: Range<usize>, closed: &[bool]) -> (Vec<usize>, Vec<Sample>) {
        let first = indices.start;
        let all = (self.chosen.at)(indices.clone());
        let going: Vec<usize> = indices.filter(|&index| !closed[index]).map(|index| index - first).collect();
        let subsystem = &self.subsystems[number];
        let once = self.studies[number].domain.dimension() == 0;
        let simulated = &going[..if once { going.len().min(1) } else { going.len() }];
        let samples = simulated.iter().map(|&index| of_subsystem(subsystem, &all[index])).collect();
        (going, samples)
    }

    /// Values of a subsystem's outputs at some samples, into those of all outputs.
    fn chunk(
        &self,
        number: usize,
        motions: &Motions,
        indices: Range<usize>,
        closed: &[bool],
        values: &mut [f64],
        stops: &mut [bool],
    ) -> Result<(), SimulationError> {
        let (going, samples) = self.own(number, indices, closed);
        if samples.is_empty() {
            return Ok(());
        }
        let (rows_of_sample, width, columns) = (self.times.len(), self.outputs.len(), &self.columns[number]);
        let sampling = Sampling { observed: Observed::Outputs, until: Until::End, whole: false };
        let simulated = motions.simulate(&samples, sampling, &mut |rows, block| {
            let lines = rows.flat_map(|row| columns.iter().map(move |column| (row, *column)));
            for ((row, column), of_line) in lines.zip(block.chunks_exact(samples.len())) {
                let Some(column) = column else { continue };
                for (index, value) in going.iter().zip(of_line.iter().cycle()) {
                    values[(index * rows_of_sample + row) * width + column] = *value;
                }
            }
        });
        let simulated = simulated.map_err(simulation_error)?;
        for (index, sample) in going.iter().zip((0..samples.len()).cycle()) {
            stops[*index] |= simulated.stopped.contains(&sample);
        }
        Ok(())
    }
}

/// A subsystem's parameters among those of the whole model.
fn of_subsystem(subsystem: &Subsystem, sample: &Sample) -> Sample {
    subsystem.parameters.iter().map(|&number| sample[number]).collect()
}

/// The steps of chosen samples, each of which is cut at its own events if that can be done: else those of
/// [`steps_and_end`].
pub(super) fn steps_of_samples(
    study: &Study,
    samples: &[Sample],
) -> Result<(StepPlan, Option<SimulationError>), SimulationError> {
    match segmented_samples(study, samples)? {
        Some(schedule) => Ok((StepPlan::fixed(schedule), None)),
        None => steps_and_end(study),
    }
}

/// The model's steps, divided if they do not resolve a function of the time; with a tolerance those that a run would
/// try first. With them the error that ended their control before the last row, if there is one.
pub(super) fn steps_and_end(study: &Study) -> Result<(StepPlan, Option<SimulationError>), SimulationError> {
    let (plan, ended) = planned(study, controlling_samples)?;
    if study.request.tolerance.is_some() && study.domain.dimension() > 0 {
        let progress = Progress::new(usize::MAX, study.progress);
        return Ok((balance(study, &plan, &progress)?.plan, ended));
    }
    Ok((StepPlan { schedule: divided(study, plan.schedule).schedule, ..plan }, ended))
}
