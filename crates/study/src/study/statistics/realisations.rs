//! Motions at samples of the laws: of all uncertain parameters, and of the seeds of random excitations.

use crate::elements::RandomFunction;
use crate::methods::{Ensemble, Observed, Sampling, Until};
use crate::model::{Description, ParameterValue, Trajectory};
use crate::numerics::statistics::Normals;
use crate::numerics::{PointSet, Points, SAFETY_OF_STEPS, Sample, step_error};
use crate::reduce::Subsystem;
use crate::simulate::SimulationError;
use crate::study::ensemble::{Progress, samples_of_part};
use crate::study::problem::Study;
use crate::study::reduced::{plan_reduction, values_of_samples};
use crate::study::sample::steps_of_samples;
use crate::study::stepping::StepPlan;

use super::Laws;
use super::tuning::TUNING;

/// Seeds between which samples draw: ends whose products with the whole numbers of realisations are no whole numbers.
const SEEDS: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];

/// A model whose realisations are uncertain.
pub(super) fn varied(description: &Description) -> Description {
    let random: Vec<&RandomFunction> = description.trajectories.iter().filter_map(Trajectory::random).collect();
    let mut varied = description.clone();
    for parameter in
        varied.parameters.iter_mut().filter(|own| random.iter().any(|random| random.is_chosen_by(&own.name)))
    {
        if let ParameterValue::Formula(formula) = &parameter.value
            && let Some(nominal) = formula.as_number()
        {
            parameter.value = ParameterValue::Interval { nominal, lower: SEEDS[0], upper: SEEDS[1] };
        }
    }
    varied
}

/// Independent samples of laws.
pub(super) fn samples(laws: &Laws, seed: usize, count: usize) -> PointSet {
    let scores = |number: usize| Normals::new(seed * TUNING.most_realisations + number).draw(laws.dimension());
    laws.of_scores(&(0..count).map(scores).collect::<Vec<_>>())
}

/// Responses of a subsystem's samples.
pub(super) struct Realisations {
    /// Times of the rows, s.
    pub times: Vec<f64>,
    /// By row and output, sample by sample.
    rows: Vec<Vec<f64>>,
    outputs: usize,
    /// By row and output, error of the steps.
    errors: Vec<f64>,
    /// By reduced output, then by requirement: values or margins, and the error of the steps.
    pub numbers: Vec<(Vec<f64>, f64)>,
}

impl Realisations {
    /// Values of an output in a row, sample by sample, and the error of the steps.
    pub fn of_row(&self, row: usize, output: usize) -> (&[f64], f64) {
        let index = row * self.outputs + output;
        (&self.rows[index], self.errors[index])
    }
}

/// Simulates a subsystem at samples of all parameters; `None` after an interruption.
///
/// # Errors
/// If a sample cannot be assembled.
pub(super) fn realisations(
    study: &Study,
    subsystem: &Subsystem,
    samples: Points,
    progress: &Progress,
) -> Result<Option<Realisations>, SimulationError> {
    let own = |sample: &[f64]| subsystem.parameters.iter().map(|&number| sample[number]).collect();
    // Without parameters and seeds, one motion is that of all samples.
    let count = if study.domain.dimension() == 0 { 1 } else { samples.len() };
    let all: Vec<Sample> = samples.iter().take(count).map(own).collect();
    let (plan, _) = steps_of_samples(study, &all)?;
    plan_reduction(study, &plan)?;
    let Some(direct) = simulated(study, &plan, &all, progress)? else { return Ok(None) };
    let few = &all[..count.min(TUNING.halved)];
    let Some(halved) = simulated(study, &plan.halved(), few, progress)? else { return Ok(None) };
    let error = |(direct, halved): (&Vec<f64>, &Vec<f64>)| SAFETY_OF_STEPS * step_error(direct, halved);
    let whole = |values: Vec<f64>| values.iter().copied().cycle().take(samples.len()).collect::<Vec<f64>>();
    let errors = direct.rows.iter().zip(&halved.rows).map(error).collect();
    let of_numbers: Vec<f64> = direct.numbers.iter().zip(&halved.numbers).map(error).collect();
    Ok(Some(Realisations {
        times: (0..plan.schedule.rows).map(|row| plan.schedule.time(row)).collect(),
        rows: direct.rows.into_iter().map(whole).collect(),
        outputs: study.simulator.system.outputs.len(),
        errors,
        numbers: direct.numbers.into_iter().map(whole).zip(of_numbers).collect(),
    }))
}

/// Values by row and output, and by number, sample by sample.
struct Simulated {
    rows: Vec<Vec<f64>>,
    numbers: Vec<Vec<f64>>,
}

fn simulated(
    study: &Study,
    plan: &StepPlan,
    samples: &[Sample],
    progress: &Progress,
) -> Result<Option<Simulated>, SimulationError> {
    let motions = study.motions(plan.steps(), progress);
    let (lines, rows) = (study.simulator.system.outputs.len(), plan.schedule.rows);
    let numbers = study.description.reduced.len() + study.description.requirements.len();
    let mut found =
        Simulated { rows: vec![vec![f64::NAN; samples.len()]; lines * rows], numbers: vec![Vec::new(); numbers] };
    let size = samples_of_part(lines, rows);
    for (part, chunk) in samples.chunks(size).enumerate() {
        let first = part * size;
        let sampling = Sampling { observed: Observed::Outputs, until: Until::End, whole: false };
        motions
            .simulate(chunk, sampling, &mut |rows, block| {
                let into = &mut found.rows[rows.start * lines..];
                for (into, values) in into.iter_mut().zip(block.chunks_exact(chunk.len())) {
                    into[first..][..chunk.len()].copy_from_slice(values);
                }
            })
            .map_err(crate::study::bounding::simulation_error)?;
        if motions.is_interrupted() {
            return Ok(None);
        }
        for of_sample in values_of_samples(study, &plan.schedule, chunk) {
            found.numbers.iter_mut().zip(of_sample).for_each(|(all, value)| all.push(value));
        }
    }
    Ok(Some(found))
}
