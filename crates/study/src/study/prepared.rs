//! A model's subsystems, reduced to the parts that are simulated, and compiled.

use symdiff::Formula;

use super::{Options, RunError, formulation};
use crate::assemble::{self, BuildError};
use crate::model::{Analysis, Description, Formulation, ParameterValue};
use crate::reduce::{Choices, Reduction, Subsystem, narrow, required};
use crate::simulate::Simulator;

/// A subsystem, compiled.
pub struct Prepared {
    /// Model of the subsystem.
    pub subsystem: Subsystem,
    /// Its programs.
    pub simulator: Simulator,
}

impl Prepared {
    /// Compiles. A parameter that the subsystem names, but on which no equation of it depends, nor a requirement, gets
    /// its nominal value.
    ///
    /// # Errors
    /// Where it cannot be built or assembled.
    pub fn new(mut subsystem: Subsystem) -> Result<Self, RunError> {
        let simulator = formulation::compiled(&subsystem.description)?;
        let required = required(&subsystem.description);
        let is_required: Vec<bool> = subsystem.description.uncertain().map(|(index, _)| required[index]).collect();
        let mut unused = simulator.system.unused_parameters();
        unused.retain(|&number| !is_required[number]);
        if unused.is_empty() {
            return Ok(Self { subsystem, simulator });
        }
        let mut uncertain = 0..;
        for parameter in &mut subsystem.description.parameters {
            let ParameterValue::Interval { nominal, .. } = parameter.value else { continue };
            if uncertain.next().is_some_and(|number| unused.contains(&number)) {
                parameter.value = ParameterValue::Formula(Formula::number(nominal));
            }
        }
        let left: Vec<usize> = (0..subsystem.parameters.len()).filter(|number| !unused.contains(number)).collect();
        narrow(&mut subsystem.description, &left);
        subsystem.parameters = left.into_iter().map(|number| subsystem.parameters[number]).collect();
        let simulator = formulation::compiled(&subsystem.description)?;
        Ok(Self { subsystem, simulator })
    }
}

/// Reduces a model to its simulated part, and compiles that.
///
/// # Errors
/// Where a subsystem cannot be built or assembled.
pub(super) fn prepare(description: &Description, choices: Choices) -> Result<(Reduction, Vec<Prepared>), RunError> {
    let mut reduction = Reduction::of(description, choices);
    let subsystems = std::mem::take(&mut reduction.subsystems).into_iter();
    let prepared = subsystems.map(|subsystem| as_far_as_joints_go(description, subsystem, Prepared::new));
    let prepared = prepared.collect::<Result<Vec<_>, _>>()?;
    Ok((reduction, prepared))
}

/// Makes something of a subsystem. Joint coordinates that the model asks for may not exist in every one: then it has
/// absolute ones.
fn as_far_as_joints_go<T>(
    description: &Description,
    subsystem: Subsystem,
    make: impl Fn(Subsystem) -> Result<T, RunError>,
) -> Result<T, RunError> {
    let by_joints = description.simulation.formulation == Formulation::Joint;
    let absolute = by_joints.then(|| subsystem.clone());
    match (make(subsystem), absolute) {
        (Err(RunError::Build(BuildError::NoJointCoordinates { .. })), Some(mut subsystem))
            if assemble::build(description).is_ok() =>
        {
            subsystem.description.simulation.formulation = Formulation::Absolute;
            make(subsystem)
        }
        (made, _) => made,
    }
}

/// How a model is reduced to be run.
pub(super) fn choices(description: &Description, options: &Options) -> Choices {
    // Stability and modes are those of the whole.
    let is_whole = matches!(description.analysis, Analysis::Statics | Analysis::Modes(_));
    Choices { part: !options.skip_infeasible && !is_whole, ..Choices::default() }
}

/// The budget is divided evenly among the subsystems with uncertain parameters.
pub(super) fn share_budget(prepared: &mut [Prepared]) {
    let uncertain = prepared.iter().filter(|prepared| !prepared.subsystem.parameters.is_empty()).count().max(1);
    for prepared in prepared {
        let budget = &mut prepared.subsystem.description.bounds.budget;
        budget.simulations /= uncertain;
        budget.seconds = budget.seconds.map(|seconds| seconds / uncertain as f64);
    }
}
