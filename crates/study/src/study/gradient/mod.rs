//! Derivatives of all outputs in all rows, of reduced outputs and of requirements' margins by all uncertain parameters,
//! at their nominal values.

mod curve;
mod reduced;

pub(super) use self::reduced::{InRows, in_rows};
use crate::model::{Description, Parameter, ParameterValue};
use crate::numerics::Sample;
use crate::results::{GradientParameter, Gradients, OutputGradients};
use crate::simulate::{Gradient, NoGradient, Schedule, SimulationError, Steps, Wanted, gradients, switched_from};
use crate::study::black_box::needs_equations;
use crate::study::problem::Study;
use crate::study::reduced::expanded;
use crate::study::sample::{Chosen, Trajectories, sample};
use crate::study::stepping::{StepPlan, segmented_nominal};
use crate::study::{Options, RunError};
use crate::syntax::{Code, Coded};

/// Gradients with two kinds of steps agree to this share of the largest influence.
const AGREEMENT: f64 = 0.01;

/// Why a model has no gradients.
#[derive(Debug, thiserror::Error)]
pub enum GradientError {
    /// It cannot be run either.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Its motion has none.
    #[error(transparent)]
    None(#[from] NoGradient),
    /// A step does not converge, or is singular.
    #[error("the motion has no derivatives from t = {time} s on: a step does not converge or is singular there")]
    Lost {
        /// End of the step, s.
        time: f64,
    },
    /// Nothing to differentiate by.
    #[error(
        "no parameter is uncertain: give an interval or a tolerance to those by which outputs are to be differentiated"
    )]
    NoParameter,
    /// Nothing to differentiate.
    #[error("the model has no outputs over time, reduced outputs or requirements")]
    NoOutput,
}

/// The derivatives, with the steps of a run.
///
/// # Errors
/// Where there are none, and at an interruption.
pub fn gradient(description: &Description, options: &Options) -> Result<Gradients, GradientError> {
    needs_equations(description, "a gradient").map_err(RunError::from)?;
    if description.uncertain().next().is_none() {
        return Err(GradientError::NoParameter);
    }
    let shown = description.outputs.len();
    let description = &*expanded(description);
    if description.outputs.is_empty() {
        return Err(GradientError::NoOutput);
    }
    let none = Chosen { count: 0, at: &|_| Vec::new() };
    let mut found = sample(description, options, none, |trajectories| of_trajectories(trajectories, description))?;
    found.reduced = reduced::of_sources(description, &found);
    found.outputs.truncate(shown);
    Ok(found)
}

/// A parameter as it is differentiated by.
fn described(description: &Description, parameter: &Parameter) -> Option<GradientParameter> {
    let ParameterValue::Interval { nominal, lower, upper } = parameter.value else { return None };
    Some(GradientParameter {
        name: parameter.name.clone(),
        unit: parameter.unit.clone(),
        display: description.parameter_units.get(&parameter.name).cloned(),
        value: nominal,
        half_width: 0.5 * (upper - lower),
    })
}

/// The derivatives at the nominal values, by output and row.
fn of_trajectories(trajectories: &Trajectories, description: &Description) -> Result<Gradients, GradientError> {
    let parameters: Vec<GradientParameter> =
        description.uncertain().filter_map(|(_, parameter)| described(description, parameter)).collect();
    let empty = |(name, unit): &(String, String)| OutputGradients {
        name: name.clone(),
        unit: unit.clone(),
        display: description.display.get(name).cloned(),
        values: vec![f64::NAN; trajectories.times.len()],
        by_parameters: vec![vec![0.0; parameters.len()]; trajectories.times.len()],
    };
    let mut outputs: Vec<OutputGradients> = trajectories.outputs.iter().map(empty).collect();
    let mut unreliable_from = None;
    for (number, (study, subsystem)) in trajectories.studies.iter().zip(trajectories.subsystems).enumerate() {
        let plan = &trajectories.steps[number];
        let between_events = segmented_nominal(study).map_err(RunError::from)?;
        let schedule = between_events.as_ref().unwrap_or(&plan.schedule);
        let columns = trajectories.columns[number].iter().enumerate();
        let shown: Vec<(usize, usize)> = columns.filter_map(|(line, column)| Some((line, (*column)?))).collect();
        let wanted: Vec<Wanted> = (0..plan.schedule.rows)
            .flat_map(|row| shown.iter().map(move |&(output, _)| Wanted { sample: 0, row, output }))
            .collect();
        let found = followed(study, schedule, &wanted)?;
        if between_events.is_none()
            && let Some(row) = switched_within_steps(study, plan)?
        {
            let refined = followed(study, &schedule.refined(2), &wanted)?;
            let differs =
                differs_from(study, &wanted, [&found, &refined]).map(|differs| schedule.time(row.max(differs)));
            unreliable_from = [unreliable_from, differs].into_iter().flatten().reduce(f64::min);
        }
        let columns = shown.iter().map(|&(_, column)| column).cycle();
        for ((wanted, found), column) in wanted.iter().zip(found).zip(columns) {
            outputs[column].values[wanted.row] = found.value;
            let by_parameters = &mut outputs[column].by_parameters[wanted.row];
            for (&parameter, by) in subsystem.parameters.iter().zip(found.by_parameters) {
                by_parameters[parameter] = by;
            }
        }
    }
    let (model, times) = (description.name.clone(), trajectories.times.clone());
    Ok(Gradients { model, times, parameters, outputs, reduced: Vec::new(), unreliable_from })
}

/// Gradients at the nominal values.
fn followed(study: &Study, schedule: &Schedule, wanted: &[Wanted]) -> Result<Vec<Gradient>, GradientError> {
    let center: Sample = study.simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let found = gradients(&study.simulator, schedule, &[center], wanted, study.interruption)?;
    match found.iter().filter_map(|gradient| gradient.lost).reduce(f64::min) {
        Some(time) => Err(GradientError::Lost { time }),
        None => Ok(found),
    }
}

/// The first row before which equations switch within a step of the nominal motion.
fn switched_within_steps(study: &Study, plan: &StepPlan) -> Result<Option<usize>, GradientError> {
    let at_rows = plan.schedule.ending_at_rows();
    let steps = Steps { schedule: &at_rows, ..plan.steps() };
    let row = switched_from(&study.simulator, &study.domain, steps, study.interruption);
    Ok(row.map_err(RunError::from)?)
}

/// The first row in which gradients with other steps are others: by more than a share of the largest influence that a
/// parameter has on the output. Where a step contains a contact that closes, its derivatives depend on when it does
/// within the step; where equations only bend, they agree.
fn differs_from(study: &Study, wanted: &[Wanted], [found, others]: [&[Gradient]; 2]) -> Option<usize> {
    let influences = |gradient: &Gradient| -> Vec<f64> {
        let by = gradient.by_parameters.iter().enumerate();
        by.map(|(axis, by)| by * study.domain.half_width(axis)).collect()
    };
    let mut largest = vec![0.0; study.simulator.system.outputs.len()];
    for (wanted, gradient) in wanted.iter().zip(found) {
        let own = influences(gradient).into_iter().map(f64::abs);
        largest[wanted.output] = own.fold(largest[wanted.output], f64::max);
    }
    let differs = |(wanted, (own, other)): &(&Wanted, (&Gradient, &Gradient))| {
        let pairs = influences(own).into_iter().zip(influences(other));
        // Written so that NaN differs.
        !pairs.map(|(own, other)| (own - other).abs()).all(|change| change <= AGREEMENT * largest[wanted.output])
    };
    let pairs = wanted.iter().zip(found.iter().zip(others));
    pairs.filter(differs).map(|(wanted, _)| wanted.row).min()
}

impl GradientError {
    /// Whether it was asked to end.
    pub fn is_interruption(&self) -> bool {
        let interrupted = SimulationError::Interrupted;
        match self {
            Self::None(NoGradient::Simulation(error)) | Self::Run(RunError::Simulation(error)) => *error == interrupted,
            _ => false,
        }
    }
}

impl Coded for GradientError {
    fn code(&self) -> Option<Code> {
        match self {
            Self::Run(error) => error.code(),
            Self::None(NoGradient::Simulation(error)) => error.code(),
            Self::None(_) | Self::Lost { .. } => Some(Code::NoDerivatives),
            Self::NoParameter => Some(Code::NoParameter),
            Self::NoOutput => Some(Code::Unsuitable),
        }
    }
}
