//! Choice of the coordinates of a mechanism: if the model leaves it open, those whose program is shorter.
//!
//! Joint coordinates are few and their matrices dense, or eliminated link by link; absolute ones are many and theirs
//! sparse. The number of instructions is only known when both are compiled, so both are; but for the longest
//! chains, and not to the end where absolute coordinates turn out to take many times as much. Where joints close loops,
//! absolute coordinates are assembled first, and joint ones start from there, so that both close the loops in the same
//! branch. A start in a singular configuration, a motion that passes one, and redundant constraints are left to
//! absolute coordinates.

mod alike;
mod candidates;
mod comparison;
mod loop_cuts;
mod singular;
pub mod tuning;

use super::{RunError, first_step, scheme};
use crate::assemble::{self, FormulationInfo, Questions, System};
use crate::model::Formulation;
use crate::simulate::{Assembled, Samples, SimulationError, Simulator};

use candidates::{Candidate, Compiled, asked, because, other_way, where_absolute_are_singular};
use comparison::starts_alike;
use singular::passes_singular;
use tuning::TUNING;

pub use alike::{assembled_alike, compiled_alike};
pub use comparison::instructions;

/// Builds and compiles a model in the formulation that it asks for, or in the shorter one. A formulation that takes too
/// many operations is given up for the other.
///
/// # Errors
/// If the mechanism cannot be built or assembled, or takes too many operations in both formulations.
pub fn compiled(questions: &Questions) -> Result<Simulator, RunError> {
    if questions.formulation != Formulation::Auto {
        return in_shortest_cut(questions, asked(questions)?);
    }
    let absolute = assemble::in_absolute_coordinates(questions)?;
    match assemble::closes_loops(questions) {
        true => of_loops(questions, absolute),
        false => of_trees(questions, absolute),
    }
}

/// Joint coordinates that are asked for, with the cut of the loops whose steps are shortest if the cut is left open.
fn in_shortest_cut(questions: &Questions, asked: Simulator) -> Result<Simulator, RunError> {
    if !questions.is_cut_open() || !asked.system.formulation.joint {
        return Ok(asked);
    }
    let why = asked.system.formulation.why.clone();
    let shorter = loop_cuts::shortest(questions, &asked, false, |other| assemble::build(other).ok());
    Ok(chosen(shorter.unwrap_or(asked), why))
}

/// Formulation of a mechanism without loops: joint coordinates first; their length determines when absolute ones are
/// given up.
fn of_trees(questions: &Questions, absolute: System) -> Result<Simulator, RunError> {
    let joint = match Candidate::<Simulator>::in_joint_coordinates(questions, TUNING.operations, None)? {
        Candidate::Runs(joint) => joint,
        Candidate::Refused(why) => {
            return match Compiled::of(because(absolute, why), questions.description) {
                Err(SimulationError::TooLong) => other_way(questions, Formulation::Joint),
                compiled => Ok(compiled?),
            };
        }
        // A position singular in one formulation may be regular in the other.
        Candidate::TooLong | Candidate::Singular(_) => return Ok(Compiled::of(absolute, questions.description)?),
    };
    if joint.system.space.spatial && joint.system.is_mass_left_out() {
        let why = "long trees in space take several times as many instructions in absolute ones";
        return Ok(chosen(joint, why.to_owned()));
    }
    match Candidate::of(absolute, questions, enough(&joint)) {
        Candidate::Runs(absolute) if assemble::has_joints_of_several_axes(questions.description) => {
            // Start values of bodies behind such joints are conditions.
            Ok(shortest(questions, absolute, joint, None))
        }
        Candidate::Runs(absolute) => Ok(shorter(absolute, joint)),
        Candidate::TooLong => Ok(several_times_shorter(joint)),
        Candidate::Refused(_) | Candidate::Singular(_) => Ok(joint),
    }
}

/// Formulation of a mechanism with loops: absolute coordinates first, from whose start joint ones close the loops in
/// the same branch.
fn of_loops(questions: &Questions, absolute: System) -> Result<Simulator, RunError> {
    let given_up = |error: SimulationError| match error {
        SimulationError::TooLong => other_way(questions, Formulation::Joint),
        error => where_absolute_are_singular(questions).ok_or(error.into()),
    };
    let (scheme, first_step) = (scheme(questions.description), first_step(questions.description));
    let assembled = match Assembled::within(Samples::All, absolute, scheme, first_step, Some(TUNING.operations)) {
        Ok(assembled) => assembled,
        Err(error) => return given_up(error),
    };
    let start = assembled.nominal[assembled.start.layout.q.clone()].to_vec();
    let is_regular = assembled.mobility.singular_at_start.is_empty() && assembled.mobility.redundant.is_empty();
    let in_joint = |operations: usize| Candidate::in_joint_coordinates(questions, operations, Some(&start));
    // Joint coordinates need the start alone; only if they take long, the length of absolute steps limits theirs.
    let (absolute, joint) =
        rayon::join(|| Simulator::of(assembled, scheme, first_step), || is_regular.then(|| in_joint(TUNING.soon)));
    let absolute = match absolute {
        Ok(absolute) => absolute,
        Err(error) => return given_up(error),
    };
    if !absolute.mobility.singular_at_start.is_empty() {
        return Ok(chosen(absolute, "the start is singular".to_owned()));
    }
    // Joint coordinates do not have them, and would not show the undetermined ones.
    let Some(joint) = joint else { return Ok(chosen(absolute, "constraints are redundant".to_owned())) };
    let joint = match joint? {
        Candidate::TooLong if enough(&absolute) > TUNING.soon => in_joint(enough(&absolute))?,
        joint => joint,
    };
    Ok(match joint {
        Candidate::Runs(joint) => shortest(questions, absolute, joint, Some(&start)),
        Candidate::Refused(why) => chosen(absolute, why),
        Candidate::TooLong => several_times_shorter(absolute),
        Candidate::Singular(_) => chosen(absolute, "joint coordinates have no start".to_owned()),
    })
}

/// The shortest of absolute coordinates and of joint ones with all cuts of the loops. `start`: coordinates from which
/// loops are closed, if there are any.
fn shortest(questions: &Questions, absolute: Simulator, joint: Simulator, start: Option<&[f64]>) -> Simulator {
    if !starts_alike(&absolute, &joint) {
        return chosen(absolute, "outputs start elsewhere in joint coordinates".to_owned());
    }
    // The nominal motion is examined only where joint coordinates would be taken, and before other cuts are: of many
    // loops it takes longer than all else, of few the cuts do. It is that of the first cut, or of the only one that is
    // short.
    let passes = |joint: &Simulator| start.is_some() && passes_singular(questions, joint);
    let singular = "the nominal motion passes singular configurations";
    let is_first_shorter = is_shorter(&joint, &absolute);
    let cut_better = || {
        let assemble = |other: &Questions| assemble::in_joint_coordinates(other, None, start).ok()?.ok();
        loop_cuts::shortest(questions, &joint, true, assemble)
    };
    let better = if is_first_shorter && rayon::current_num_threads() > 1 {
        // Singular motions are rare: cuts are seldom compiled for nothing.
        let (is_singular, better) = rayon::join(|| passes(&joint), cut_better);
        if is_singular {
            return chosen(absolute, singular.to_owned());
        }
        better
    } else if is_first_shorter && passes(&joint) {
        return chosen(absolute, singular.to_owned());
    } else {
        cut_better()
    };
    let joint = better.unwrap_or(joint);
    if !is_first_shorter && is_shorter(&joint, &absolute) && passes(&joint) {
        return chosen(absolute, singular.to_owned());
    }
    shorter(absolute, joint)
}

/// A simulator with the reason for its formulation.
fn chosen(mut simulator: Simulator, why: String) -> Simulator {
    simulator.system.formulation.why = why;
    simulator
}

/// The same if the other formulation was given up.
fn several_times_shorter(simulator: Simulator) -> Simulator {
    let why = format!("{} instructions a step instead of several times as many", instructions(&simulator));
    chosen(simulator, why)
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
    chosen(if is_joint { joint } else { absolute }, why)
}

/// Builds and assembles a model, without its steps' program if that is not needed to choose the formulation.
///
/// # Errors
/// As for [`compiled`].
pub fn assembled(questions: &Questions) -> Result<Assembled, RunError> {
    if questions.formulation != Formulation::Auto {
        return asked(questions);
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
        return Compiled::of(absolute, questions.description)
            .or_else(|singular| where_absolute_are_singular(questions).ok_or(singular.into()));
    }
    let why = match Candidate::in_joint_coordinates(questions, Assembled::operations(true), None)? {
        Candidate::Runs(joint) => return Ok(joint),
        Candidate::Singular(error) => return Err(error.into()),
        Candidate::TooLong => "joint coordinates take too long".to_owned(),
        Candidate::Refused(why) => why,
    };
    let absolute = because(assemble::in_absolute_coordinates(questions)?, why);
    Ok(Compiled::of(absolute, questions.description)?)
}

/// The same questions in the formulation that was chosen for them, with its cut of the loops.
pub fn as_chosen<'d>(questions: &Questions<'d>, chosen: &Simulator) -> Questions<'d> {
    let FormulationInfo { joint, cut, .. } = &chosen.system.formulation;
    let formulation = if *joint { Formulation::Joint } else { Formulation::Absolute };
    Questions { formulation, ..questions.cut_at(cut.clone()) }
}
