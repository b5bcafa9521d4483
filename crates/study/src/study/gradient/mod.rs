//! Derivatives of all outputs in all rows, of reduced outputs and of requirements' margins by all uncertain parameters,
//! at their nominal values.

mod curve;
mod reduced;

pub(super) use self::reduced::{InRows, in_rows};
use crate::model::{Description, Parameter, ParameterValue};
use crate::numerics::Sample;
use crate::results::{GradientParameter, Gradients, OutputGradients};
use crate::simulate::{NoGradient, SimulationError, Wanted, gradients};
use crate::study::black_box::needs_equations;
use crate::study::reduced::expanded;
use crate::study::sample::{Chosen, Trajectories, sample};
use crate::study::stepping::segmented_nominal;
use crate::study::{Options, RunError};

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
    for (number, (study, subsystem)) in trajectories.studies.iter().zip(trajectories.subsystems).enumerate() {
        let between_events = segmented_nominal(study).map_err(RunError::from)?;
        let schedule = between_events.as_ref().unwrap_or(&trajectories.steps[number].schedule);
        let center: Sample = study.simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
        let columns = trajectories.columns[number].iter().enumerate();
        let shown: Vec<(usize, usize)> = columns.filter_map(|(line, column)| Some((line, (*column)?))).collect();
        let wanted: Vec<Wanted> = (0..trajectories.steps[number].schedule.rows)
            .flat_map(|row| shown.iter().map(move |&(output, _)| Wanted { sample: 0, row, output }))
            .collect();
        let found = gradients(&study.simulator, schedule, &[center], &wanted, study.interruption)?;
        if let Some(time) = found.iter().filter_map(|gradient| gradient.lost).reduce(f64::min) {
            return Err(GradientError::Lost { time });
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
    Ok(Gradients { model, times, parameters, outputs, reduced: Vec::new() })
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
