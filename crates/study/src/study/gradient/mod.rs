//! Derivatives of all outputs in all rows, of reduced outputs and of requirements' margins by all uncertain parameters,
//! at their nominal values.

mod curve;
mod nominal;
mod reduced;
pub(crate) mod tuning;

pub(super) use self::nominal::along_nominal;
pub(super) use self::reduced::{InRows, accumulated_in_rows, in_rows};
use crate::model::{Description, Parameter, ParameterValue};
use crate::results::{GradientParameter, Gradients, OutputGradients};
use crate::simulate::{NoGradient, SimulationError};
use crate::study::black_box::needs_equations;
use crate::study::reduced::expanded;
use crate::study::sample::{ChosenSamples, Trajectories, sample};
use crate::study::{Options, RunError};
use crate::syntax::{Code, Coded};

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
/// If there are none, and at an interruption.
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
    let none = ChosenSamples { count: 0, at: &|_| Vec::new() };
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
        let columns = trajectories.columns[number].iter().enumerate();
        let (lines, columns): (Vec<usize>, Vec<usize>) =
            columns.filter_map(|(line, column)| Some((line, (*column)?))).unzip();
        if lines.is_empty() {
            continue;
        }
        let found = along_nominal(study, &trajectories.steps[number], &lines)?;
        unreliable_from = [unreliable_from, found.unreliable_from].into_iter().flatten().reduce(f64::min);
        for (row, of_row) in found.rows.chunks_exact(lines.len()).enumerate() {
            for (&column, own) in columns.iter().zip(of_row) {
                outputs[column].values[row] = own.value;
                let by_parameters = &mut outputs[column].by_parameters[row];
                for (&parameter, &by) in subsystem.parameters.iter().zip(&own.by_parameters) {
                    by_parameters[parameter] = by;
                }
            }
        }
    }
    let (model, times) = (description.name.clone(), trajectories.times.clone());
    Ok(Gradients { model, times, parameters, outputs, reduced: Vec::new(), unreliable_from })
}

impl From<SimulationError> for GradientError {
    fn from(error: SimulationError) -> Self {
        Self::Run(error.into())
    }
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
