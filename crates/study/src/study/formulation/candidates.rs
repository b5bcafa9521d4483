//! Formulations as candidates: each is compiled within a number of operations, or not at all.

use super::tuning::TUNING;
use crate::assemble::{self, BuildError, FormulationInfo, Questions, System};
use crate::model::{Description, Formulation};
use crate::simulate::{Assembled, Samples, SimulationError, Simulator};
use crate::study::{RunError, first_step, scheme};

/// Result of compiling a system: the steps too, or only the start.
pub trait Compiled: Sized {
    /// Most operations that it may take, in joint coordinates or in absolute ones.
    fn operations(is_joint: bool) -> usize;

    /// Compiles within a number of operations.
    fn within(system: System, description: &Description, operations: usize) -> Result<Self, SimulationError>;

    /// Compiles within the most operations.
    fn of(system: System, description: &Description) -> Result<Self, SimulationError> {
        let operations = Self::operations(system.formulation.joint);
        Self::within(system, description, operations)
    }
}

impl Compiled for Simulator {
    fn operations(_: bool) -> usize {
        TUNING.operations
    }

    fn within(system: System, description: &Description, operations: usize) -> Result<Self, SimulationError> {
        Self::within(system, scheme(description), first_step(description), Some(operations))
    }
}

impl Compiled for Assembled {
    fn operations(is_joint: bool) -> usize {
        if is_joint { TUNING.operations_of_check } else { TUNING.operations }
    }

    fn within(system: System, description: &Description, operations: usize) -> Result<Self, SimulationError> {
        Self::within(Samples::Nominal, system, scheme(description), first_step(description), Some(operations))
    }
}

/// A formulation that was tried.
pub enum Candidate<T> {
    /// It is compiled.
    Runs(T),
    /// Its equations cannot be written down, for this reason.
    Refused(String),
    /// It takes too many operations.
    TooLong,
    /// It has no start.
    Singular(SimulationError),
}

impl<T: Compiled> Candidate<T> {
    /// A system, compiled within a number of operations.
    pub fn of(system: System, questions: &Questions, operations: usize) -> Self {
        match T::within(system, questions.description, operations) {
            Ok(compiled) => Self::Runs(compiled),
            Err(SimulationError::TooLong) => Self::TooLong,
            Err(error) => Self::Singular(error),
        }
    }

    /// Joint coordinates, with loops closed from a start in absolute ones if there are any.
    pub fn in_joint_coordinates(
        questions: &Questions,
        operations: usize,
        start: Option<&[f64]>,
    ) -> Result<Self, BuildError> {
        let system = assemble::in_joint_coordinates(questions, Some(deepest(questions)), start)?;
        Ok(system.map_or_else(Self::Refused, |system| Self::of(system, questions, operations)))
    }
}

/// The formulation that is asked for; if that takes too many operations, the other one.
pub fn asked<T: Compiled>(questions: &Questions) -> Result<T, RunError> {
    let is_joint = questions.formulation == Formulation::Joint;
    if is_joint && assemble::joint_elimination(questions) > T::operations(true) / TUNING.eliminations {
        return other_way(questions, Formulation::Absolute);
    }
    match T::of(assemble::build(questions)?, questions.description) {
        Err(SimulationError::TooLong) => {
            other_way(questions, if is_joint { Formulation::Absolute } else { Formulation::Joint })
        }
        found => Ok(found?),
    }
}

/// The other formulation, in place of one that takes too many instructions.
pub fn other_way<T: Compiled>(questions: &Questions, formulation: Formulation) -> Result<T, RunError> {
    let system = match assemble::build(&Questions { formulation, ..questions.clone() }) {
        Err(BuildError::NoJointCoordinates { .. }) => return Err(SimulationError::TooLong.into()),
        built => built?,
    };
    let other = if formulation == Formulation::Joint { "absolute" } else { "joint" };
    let system = because(system, format!("{other} coordinates take too many instructions"));
    Ok(T::of(system, questions.description)?)
}

/// Loops in joint coordinates, where absolute ones have no start: bodies without mass, as between the axes of an MJCF's
/// body, are singular there if constraints are redundant.
pub fn where_absolute_are_singular<T: Compiled>(questions: &Questions) -> Option<T> {
    let joint = assemble::in_joint_coordinates(questions, Some(deepest(questions)), None).ok()?.ok()?;
    T::of(because(joint, "absolute coordinates are singular at the start".to_owned()), questions.description).ok()
}

/// A system with the reason for its formulation.
pub fn because(mut system: System, why: String) -> System {
    system.formulation = FormulationInfo { why, ..system.formulation };
    system
}

/// Joints from the root beyond which joint coordinates are not tried.
fn deepest(questions: &Questions) -> usize {
    let deepest = if assemble::closes_loops(questions) { TUNING.deepest_of_loops } else { TUNING.deepest };
    deepest[usize::from(questions.description.space.spatial)]
}
