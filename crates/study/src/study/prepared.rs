//! A model's subsystems, reduced to the parts that are simulated, and compiled.

use std::borrow::Cow;

use symdiff::Formula;

use super::formulation::compiled;
use super::{Options, RunError};
use crate::assemble::{self, BuildError, Questions};
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
    /// If it cannot be built or assembled.
    pub fn new(subsystem: Subsystem) -> Result<Self, RunError> {
        let formulation = subsystem.description.simulation.formulation;
        Self::within(formulation, subsystem)
    }

    /// The same in a formulation.
    fn within(formulation: Formulation, mut subsystem: Subsystem) -> Result<Self, RunError> {
        let compiled = |subsystem: &Subsystem| compiled(&Questions { formulation, ..questions(subsystem) });
        let simulator = compiled(&subsystem)?;
        let required = required(&subsystem.description);
        let is_required: Vec<bool> = subsystem.description.uncertain().map(|(index, _)| required[index]).collect();
        let mut unused = simulator.system.unused_parameters();
        unused.retain(|&number| !is_required[number]);
        if simulator.system.is_excited && !unused.is_empty() {
            // As a constant, an excitation may be nothing but its middle, so that parameters of its force do nothing.
            let as_functions = Questions { formulation, as_functions: true, ..questions(&subsystem) };
            let of_functions = assemble::in_absolute_coordinates(&as_functions)?.unused_parameters();
            unused.retain(|number| of_functions.contains(number));
        }
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
        let simulator = compiled(&subsystem)?;
        Ok(Self { subsystem, simulator })
    }
}

/// Questions to a subsystem's equations.
pub fn questions(subsystem: &Subsystem) -> Questions<'_> {
    Questions { merged: Cow::Borrowed(&subsystem.merged), ..Questions::of(&subsystem.description) }
}

/// Reduces a model to its simulated part, and compiles that.
///
/// # Errors
/// If a subsystem cannot be built or assembled.
pub fn prepare(description: &Description, choices: Choices) -> Result<(Reduction, Vec<Prepared>), RunError> {
    let mut reduction = Reduction::of(description, choices);
    let subsystems = std::mem::take(&mut reduction.subsystems).into_iter();
    let prepared = subsystems.map(|subsystem| as_far_as_joints_go(description, subsystem));
    let prepared = prepared.collect::<Result<Vec<_>, _>>()?;
    Ok((reduction, prepared))
}

/// Compiles a subsystem. Joint coordinates that the model asks for may not exist in every one: then it has absolute
/// ones.
fn as_far_as_joints_go(description: &Description, subsystem: Subsystem) -> Result<Prepared, RunError> {
    let by_joints = description.simulation.formulation == Formulation::Joint;
    let absolute = by_joints.then(|| subsystem.clone());
    match (Prepared::new(subsystem), absolute) {
        (Err(RunError::Build(BuildError::NoJointCoordinates { .. })), Some(subsystem))
            if assemble::build(&Questions::of(description)).is_ok() =>
        {
            Prepared::within(Formulation::Absolute, subsystem)
        }
        (made, _) => made,
    }
}

/// Reductions of a model before it is run.
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
