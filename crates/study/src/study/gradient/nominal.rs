//! Derivatives along the nominal motion, of all outputs in all rows: forwards by jets or backwards by adjoints,
//! whichever costs less.

use symdiff::jet::JetSpace;

use super::GradientError;
use super::tuning::TUNING;
use crate::numerics::Sample;
use crate::simulate::{
    JetBox, Schedule, SimulationError, Steps, Wanted, gradients, outputs_of_jets, segment_jets, switched_from,
};
use crate::study::ensemble::{Progress, jet_about};
use crate::study::problem::Study;
use crate::study::stepping::{StepPlan, segmented_nominal};

/// An output's value in a row of the nominal motion, and its derivatives.
#[derive(Clone, Debug)]
pub struct AtRow {
    /// SI.
    pub value: f64,
    /// By the parameters of the subsystem, SI.
    pub by_parameters: Vec<f64>,
}

/// Derivatives along the nominal motion.
pub struct AlongNominal {
    /// Row by row, of each output that is wanted.
    pub rows: Vec<AtRow>,
    /// First time from which they cannot be trusted, s.
    pub unreliable_from: Option<f64>,
}

/// Derivatives of some outputs in all rows of a plan. Between events if the nominal motion has some; if it cannot be
/// followed through them, the derivatives are compared with those of halved steps.
///
/// # Errors
/// If there are no derivatives, and at an interruption.
pub fn along_nominal(study: &Study, plan: &StepPlan, outputs: &[usize]) -> Result<AlongNominal, GradientError> {
    let between_events = segmented_nominal(study)?;
    let schedule = between_events.as_ref().unwrap_or(&plan.schedule);
    let rows = followed(study, schedule, outputs)?;
    let mut unreliable_from = None;
    if between_events.is_none()
        && let Some(row) = switched_within_steps(study, plan)?
    {
        let refined = followed(study, &schedule.refined(2), outputs)?;
        let differs = differs_from(study, outputs.len(), [&rows, &refined]);
        unreliable_from = differs.map(|differs| schedule.time(row.max(differs)));
    }
    Ok(AlongNominal { rows, unreliable_from })
}

/// Derivatives under a schedule.
fn followed(study: &Study, schedule: &Schedule, outputs: &[usize]) -> Result<Vec<AtRow>, GradientError> {
    let parameters = study.domain.dimension() as f64;
    let backwards = TUNING.backwards * (schedule.rows * outputs.len()) as f64;
    if !study.simulator.system.analysis.visits() && parameters < backwards {
        // If jets stop or are no numbers, adjoints may go on.
        if let Some(found) = forwards(study, schedule, outputs)? {
            return Ok(found);
        }
    }
    self::backwards(study, schedule, outputs)
}

/// Derivatives by a jet of the first order; `None` if it stops, or is not finite.
fn forwards(study: &Study, schedule: &Schedule, outputs: &[usize]) -> Result<Option<Vec<AtRow>>, SimulationError> {
    let space = JetSpace::new(study.domain.dimension(), 1);
    // Instants of events are solved for to shares of the duration, for changes of parameters within their tolerances.
    let unit = |axis: usize| if schedule.integration.is_cut() { study.domain.half_width(axis) } else { 1.0 };
    let half_width: Vec<f64> = (0..study.domain.dimension()).map(unit).collect();
    let about = JetBox { center: &study.domain.nominal, half_width: &half_width };
    let rows = match schedule.segments() {
        Some(segments) => {
            let jets = segment_jets(&study.simulator, &space, about, segments, schedule.end())?;
            let times = (0..schedule.rows).map(|row| schedule.time(row));
            jets.map(|(_, jets)| outputs_of_jets(&study.simulator, &space, about, &jets, times)).transpose()?.flatten()
        }
        None => by_steps(study, schedule, &space, about)?,
    };
    if study.interruption.is_asked() {
        return Err(SimulationError::Interrupted);
    }
    let lines = study.simulator.system.outputs.len() * space.len();
    let of_row = |row: &[f64]| -> Vec<AtRow> {
        let jets = outputs.iter().map(|&output| &row[output * space.len()..][..space.len()]);
        let derivatives = |jet: &[f64]| jet[1..].iter().zip(&half_width).map(|(by, unit)| by / unit).collect();
        jets.map(|jet| AtRow { value: jet[0], by_parameters: derivatives(jet) }).collect()
    };
    let found = rows.map(|rows| rows.chunks_exact(lines).flat_map(of_row).collect::<Vec<AtRow>>());
    let is_known = |own: &AtRow| own.value.is_finite() && own.by_parameters.iter().all(|by| by.is_finite());
    Ok(found.filter(|found| found.iter().all(is_known)))
}

/// Jets of all outputs by the steps of a schedule, row by row; `None` if they stop.
fn by_steps(
    study: &Study,
    schedule: &Schedule,
    space: &JetSpace,
    about: JetBox,
) -> Result<Option<Vec<f64>>, SimulationError> {
    // The bounds' progress is at its end.
    let progress = Progress::new(usize::MAX, &|_| ());
    let motions = study.motions(Steps { schedule, controller: None }, &progress);
    let mut rows = Vec::new();
    let simulated = jet_about(&motions, space, about, &mut |_, values| rows.extend_from_slice(values))?;
    Ok((simulated.missing == 0).then_some(rows))
}

/// Derivatives by adjoints.
fn backwards(study: &Study, schedule: &Schedule, outputs: &[usize]) -> Result<Vec<AtRow>, GradientError> {
    let wanted: Vec<Wanted> = (0..schedule.rows)
        .flat_map(|row| outputs.iter().map(move |&output| Wanted { sample: 0, row, output }))
        .collect();
    let center: Sample = study.domain.nominal.clone();
    let found = gradients(&study.simulator, schedule, &[center], &wanted, study.interruption)?;
    match found.iter().filter_map(|gradient| gradient.lost).reduce(f64::min) {
        Some(time) => Err(GradientError::Lost { time }),
        None => Ok(found.into_iter().map(|own| AtRow { value: own.value, by_parameters: own.by_parameters }).collect()),
    }
}

/// The first row before which equations switch within a step of the nominal motion.
fn switched_within_steps(study: &Study, plan: &StepPlan) -> Result<Option<usize>, SimulationError> {
    let at_rows = plan.schedule.ending_at_rows();
    let steps = Steps { schedule: &at_rows, ..plan.steps() };
    switched_from(&study.simulator, &study.domain, steps, study.interruption)
}

/// The first row in which gradients with other steps are others: by more than a share of the largest influence that a
/// parameter has on the output. Where a step contains a contact that closes, its derivatives depend on when it does
/// within the step; where equations only bend, they agree.
fn differs_from(study: &Study, outputs: usize, [found, others]: [&[AtRow]; 2]) -> Option<usize> {
    let influences = |own: &AtRow| -> Vec<f64> {
        let by = own.by_parameters.iter().enumerate();
        by.map(|(axis, by)| by * study.domain.half_width(axis)).collect()
    };
    let mut largest = vec![0.0; outputs];
    for (number, own) in found.iter().enumerate() {
        let own = influences(own).into_iter().map(f64::abs);
        largest[number % outputs] = own.fold(largest[number % outputs], f64::max);
    }
    let differs = |(number, (own, other)): &(usize, (&AtRow, &AtRow))| {
        let pairs = influences(own).into_iter().zip(influences(other));
        // Written so that NaN differs.
        !pairs
            .map(|(own, other)| (own - other).abs())
            .all(|change| change <= TUNING.agreement * largest[number % outputs])
    };
    let mut pairs = found.iter().zip(others).enumerate();
    pairs.find(differs).map(|(number, _)| number / outputs)
}
