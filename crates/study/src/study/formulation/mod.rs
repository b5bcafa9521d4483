//! By which coordinates a mechanism is simulated: where the model leaves it open, by those whose program is shorter.
//!
//! Joint coordinates are few and their matrices dense, or eliminated link by link; absolute ones are many and theirs
//! sparse. The number of instructions is only known when both are compiled, so both are; but for the longest
//! chains, and not to the end where absolute coordinates turn out to take many times as much. Where joints close loops,
//! absolute coordinates are assembled first, and joint ones start from there, so that both close the loops in the same
//! branch. A start in a singular configuration, a motion that passes one, and redundant constraints are left to
//! absolute coordinates.

mod comparison;
mod loop_cuts;
pub mod tuning;

use crate::assemble::{self, BuildError, FormulationInfo, Questions, System};
use crate::model::{Formulation, Stepping};
use crate::numerics::Sample;
use crate::simulate::{Assembled, Schedule, SimulationError, Simulator, SingularWatch, Stepper};
use crate::study::formulation::tuning::TUNING;

use super::{RunError, first_step, scheme};
use comparison::starts_alike;

pub use comparison::instructions;

/// Builds and compiles a model in the formulation that it asks for, or in the shorter one. A formulation that takes too
/// many operations is given up for the other.
///
/// # Errors
/// Where the mechanism cannot be built or assembled, or takes too many operations in both formulations.
pub fn compiled(questions: &Questions) -> Result<Simulator, RunError> {
    let within = |system: System, operations: usize| {
        Simulator::within(system, scheme(questions.description), first_step(questions.description), Some(operations))
    };
    let compile = |system: System| within(system, TUNING.operations);
    if questions.formulation != Formulation::Auto {
        let first = within_budget(questions, TUNING.operations, &|system| Ok(compile(system)?))?;
        let is_open = questions.is_cut_open();
        if !is_open || !first.system.formulation.joint {
            return Ok(first);
        }
        let why = first.system.formulation.why.clone();
        let mut shortest = loop_cuts::shortest(questions, first, false, |other, best| {
            within(assemble::build(other).ok()?, enough(best)).ok()
        });
        shortest.system.formulation.why = why;
        return Ok(shortest);
    }
    let absolute = assemble::in_absolute_coordinates(questions)?;
    if assemble::closes_loops(questions) {
        return of_loops(questions, absolute);
    }
    let joint = match assemble::in_joint_coordinates(questions, Some(deepest(questions)), None)? {
        Ok(joint) => joint,
        Err(why) => {
            return match compile(because(absolute, why)) {
                Err(SimulationError::TooLong) => other_way(questions, Formulation::Joint, &|joint| Ok(compile(joint)?)),
                compiled => Ok(compiled?),
            };
        }
    };
    // A position singular in one formulation may be regular in the other.
    let Ok(mut joint) = compile(joint) else { return Ok(compile(absolute)?) };
    if joint.system.space.spatial && joint.system.is_mass_left_out() {
        joint.system.formulation.why =
            "long trees in space take several times as many instructions in absolute ones".to_owned();
        return Ok(joint);
    }
    let absolute = match within(absolute, enough(&joint)) {
        Ok(absolute) => absolute,
        Err(why) => {
            if why == SimulationError::TooLong {
                joint.system.formulation.why =
                    format!("{} instructions a step instead of several times as many", instructions(&joint));
            }
            return Ok(joint);
        }
    };
    if !assemble::has_joints_of_several_axes(questions.description) {
        return Ok(shorter(absolute, joint));
    }
    // What the start says of bodies behind such joints are conditions.
    if !starts_alike(&absolute, &joint) {
        return Ok(kept(absolute, "outputs start elsewhere in joint coordinates".to_owned()));
    }
    let joint = loop_cuts::shortest(questions, joint, true, |other, best| {
        let system = assemble::in_joint_coordinates(other, None, None).ok()?.ok()?;
        within(system, enough(best)).ok()
    });
    Ok(shorter(absolute, joint))
}

/// A simulator in absolute coordinates, with the reason.
fn kept(mut absolute: Simulator, why: String) -> Simulator {
    absolute.system.formulation.why = why;
    absolute
}

/// Compiles a model in which joints close loops in the shorter formulation.
fn of_loops(questions: &Questions, absolute: System) -> Result<Simulator, RunError> {
    let within = |system: System, operations: usize| {
        Simulator::within(system, scheme(questions.description), first_step(questions.description), Some(operations))
    };
    let absolute = match within(absolute, TUNING.operations) {
        Err(SimulationError::TooLong) => {
            return other_way(questions, Formulation::Joint, &|joint| Ok(within(joint, TUNING.operations)?));
        }
        Err(singular) => {
            return regular_in_joint_coordinates(questions, &|joint| within(joint, TUNING.operations))
                .ok_or(singular.into());
        }
        Ok(absolute) => absolute,
    };
    let keep = |absolute: Simulator, why: String| Ok(kept(absolute, why));
    if !absolute.mobility.singular_at_start.is_empty() {
        return keep(absolute, "the start is singular".to_owned());
    }
    // Joint coordinates do not have them, and would not show the undetermined ones.
    if !absolute.mobility.redundant.is_empty() {
        return keep(absolute, "constraints are redundant".to_owned());
    }
    let start = &absolute.nominal[absolute.start.layout.q.clone()];
    let joint = match assemble::in_joint_coordinates(questions, Some(deepest(questions)), Some(start))? {
        Ok(joint) => joint,
        Err(why) => return keep(absolute, why),
    };
    match within(joint, enough(&absolute)) {
        Ok(joint) if starts_alike(&absolute, &joint) => {
            // The nominal motion is looked at only where joint coordinates would be taken, and before other cuts are:
            // of many loops it takes longer than all else, of few the cuts do.
            let singular = "the nominal motion passes singular configurations";
            let is_first_shorter = is_shorter(&joint, &absolute);
            if is_first_shorter && passes_singular(questions, &absolute) {
                return keep(absolute, singular.to_owned());
            }
            let joint = loop_cuts::shortest(questions, joint, true, |other, best| {
                let system = assemble::in_joint_coordinates(other, None, Some(start)).ok()?.ok()?;
                within(system, enough(best)).ok()
            });
            if !is_first_shorter && is_shorter(&joint, &absolute) && passes_singular(questions, &absolute) {
                return keep(absolute, singular.to_owned());
            }
            Ok(shorter(absolute, joint))
        }
        Ok(_) => keep(absolute, "outputs start elsewhere in joint coordinates".to_owned()),
        Err(SimulationError::TooLong) => {
            let why = format!("{} instructions a step instead of several times as many", instructions(&absolute));
            keep(absolute, why)
        }
        Err(_) => keep(absolute, "joint coordinates have no start".to_owned()),
    }
}

/// Loops in joint coordinates, where absolute ones have no start: bodies without mass, as between the axes of an MJCF's
/// body, are singular there where constraints are redundant.
fn regular_in_joint_coordinates<T>(
    questions: &Questions,
    of_system: &dyn Fn(System) -> Result<T, SimulationError>,
) -> Option<T> {
    let joint = assemble::in_joint_coordinates(questions, Some(deepest(questions)), None).ok()?.ok()?;
    of_system(because(joint, "absolute coordinates are singular at the start".to_owned())).ok()
}

/// Whether the nominal motion passes a singular configuration, or does not get to its end: there joint coordinates
/// amplify rounding more the shorter the steps are.
fn passes_singular(questions: &Questions, simulator: &Simulator) -> bool {
    let simulation = &questions.description.simulation;
    if simulator.system.analysis.is_without_steps() {
        return false;
    }
    let step = match simulation.stepping {
        Stepping::Fixed(step) => step,
        Stepping::Tolerance(_) => TUNING.longest_look.min(simulation.output_step),
    };
    let step = step.max(simulation.duration / TUNING.looks);
    let steps = (simulation.output_step / step).round().max(1.0);
    let schedule = Schedule::fixed(simulation.duration, simulation.output_step / steps, simulation.output_step);
    let nominal: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let Ok(start) = simulator.assemble(1, schedule.first_step(), |_| nominal.clone()) else { return true };
    let mut stepper = Stepper::new(&simulator.program, &start);
    let mut watch = SingularWatch::new(simulator, &stepper);
    for (h, end) in (0..schedule.rows).flat_map(|row| schedule.steps_to(row)) {
        if !stepper.step(h, end).is_empty() {
            return true;
        }
        watch.look(&stepper, end);
        if watch.has_passed() {
            return true;
        }
    }
    false
}

/// Joints from the root beyond which joint coordinates are not tried.
fn deepest(questions: &Questions) -> usize {
    let deepest = if assemble::closes_loops(questions) { TUNING.deepest_of_loops } else { TUNING.deepest };
    deepest[usize::from(questions.description.space.spatial)]
}

/// Operations after which the other formulation is given up.
fn enough(simulator: &Simulator) -> usize {
    (TUNING.given_up * instructions(simulator)).clamp(TUNING.soon, TUNING.operations)
}

/// Whether joint coordinates take fewer instructions, those in a joint's Euler parameters counted `longer_steps`
/// times.
fn is_shorter(joint: &Simulator, absolute: &Simulator) -> bool {
    let has_parameters = joint.system.links.iter().any(|link| link.normalisation.is_some());
    let weight = if has_parameters { TUNING.longer_steps } else { 1 };
    instructions(joint) < instructions(absolute) && weight * instructions(joint) <= instructions(absolute)
}

/// The shorter formulation, with the reason.
fn shorter(absolute: Simulator, joint: Simulator) -> Simulator {
    let [many, few] = [&absolute, &joint].map(instructions);
    let is_joint = is_shorter(&joint, &absolute);
    let why = match (is_joint, few < many) {
        (true, _) => format!("{few} instructions a step instead of {many}"),
        (false, true) => {
            format!("steps in Euler parameters of a joint err more; they take {few} instructions instead of {many}")
        }
        (false, false) => format!("{many} instructions a step instead of {few}"),
    };
    let mut chosen = if is_joint { joint } else { absolute };
    chosen.system.formulation.why = why;
    chosen
}

/// Builds and assembles a model, without its steps' program where that is not needed to choose the formulation.
///
/// # Errors
/// As for [`compiled`].
pub fn assembled(questions: &Questions) -> Result<Assembled, RunError> {
    let within = |system: System, operations: usize| {
        Assembled::within(system, scheme(questions.description), first_step(questions.description), Some(operations))
    };
    let of_system = |system: System| {
        let operations = if system.formulation.joint { TUNING.operations_of_check } else { TUNING.operations };
        Ok(within(system, operations)?)
    };
    if questions.formulation != Formulation::Auto {
        return within_budget(questions, TUNING.operations_of_check, &of_system);
    }
    if questions.description.bodies.len() <= TUNING.few_bodies {
        let Simulator {
            system, start, nominal, mobility, undetermined, shared, equilibrium, vibrations, derived, ..
        } = compiled(questions)?;
        return Ok(Assembled {
            system,
            start,
            nominal,
            mobility,
            undetermined,
            shared,
            equilibrium,
            vibrations,
            derived,
        });
    }
    if assemble::closes_loops(questions) {
        let absolute = assemble::in_absolute_coordinates(questions)?;
        return within(absolute, TUNING.operations).or_else(|singular| {
            regular_in_joint_coordinates(questions, &|joint| within(joint, TUNING.operations_of_check))
                .ok_or(singular.into())
        });
    }
    let why = match assemble::in_joint_coordinates(questions, Some(deepest(questions)), None)? {
        Ok(joint) => match of_system(joint) {
            Err(RunError::Simulation(SimulationError::TooLong)) => "joint coordinates take too long".to_owned(),
            assembled => return assembled,
        },
        Err(why) => why,
    };
    of_system(because(assemble::in_absolute_coordinates(questions)?, why))
}

/// What a model asks for; where that takes too many operations, the other formulation. Where joint coordinates take
/// more than `most`, they are not tried.
fn within_budget<T>(
    questions: &Questions,
    most: usize,
    of_system: &dyn Fn(System) -> Result<T, RunError>,
) -> Result<T, RunError> {
    let asked = questions.formulation;
    if asked == Formulation::Joint && assemble::joint_elimination(questions) > most / TUNING.eliminations {
        return other_way(questions, Formulation::Absolute, of_system);
    }
    match of_system(assemble::build(questions)?) {
        Err(RunError::Simulation(SimulationError::TooLong)) => {
            let other = if asked == Formulation::Joint { Formulation::Absolute } else { Formulation::Joint };
            other_way(questions, other, of_system)
        }
        found => found,
    }
}

/// A formulation in place of one that takes too many operations.
fn other_way<T>(
    questions: &Questions,
    formulation: Formulation,
    of_system: &dyn Fn(System) -> Result<T, RunError>,
) -> Result<T, RunError> {
    let system = match assemble::build(&Questions { formulation, ..questions.clone() }) {
        Err(BuildError::NoJointCoordinates { .. }) => return Err(SimulationError::TooLong.into()),
        built => built?,
    };
    let other = if formulation == Formulation::Joint { "absolute" } else { "joint" };
    of_system(because(system, format!("{other} coordinates take too many instructions")))
}

/// The same questions in the formulation that was chosen for them, with its cut of the loops.
pub fn as_chosen<'d>(questions: &Questions<'d>, chosen: &Simulator) -> Questions<'d> {
    let FormulationInfo { joint, cut, .. } = &chosen.system.formulation;
    let formulation = if *joint { Formulation::Joint } else { Formulation::Absolute };
    Questions { formulation, ..questions.cut_at(cut.clone()) }
}

fn because(mut system: System, why: String) -> System {
    system.formulation = FormulationInfo { why, ..system.formulation };
    system
}
