//! By which coordinates a mechanism is simulated: where the model leaves it open, by those whose program is shorter.
//!
//! Joint coordinates are few and their matrices dense, absolute ones many and theirs sparse. What that comes to in
//! instructions is only known when both are compiled, so both are; but for long chains, where it is known before, and not to
//! the end where absolute coordinates turn out to take many times as much. Where
//! joints close loops, absolute coordinates are kept: joint ones may be shorter there too, but lose their way where a loop
//! passes a position in which it can branch off (a flat parallelogram), and absolute ones do not.

use crate::assemble::{self, FormulationInfo, System};
use crate::model::{Description, Formulation};
use crate::simulate::{SimulationError, Simulator};

use super::{RunError, first_step, scheme};

/// Joints on the way from a body to its root, on average, beyond which joint coordinates are not tried: M has as many
/// entries for each body. Spatial chains break even at 15, planar ones at 3.
const DEEPEST: usize = 25;

/// Absolute coordinates are given up where the start's three eliminations, or the step's one, take so many times the
/// operations that a step takes in joint coordinates, and more than no one has to wait for.
const GIVEN_UP: usize = 10;

/// Operations that are compiled in a moment.
const SOON: usize = 100_000;

/// Builds and compiles a model in the formulation that it asks for, or in the shorter one.
///
/// # Errors
/// Where the mechanism cannot be built or assembled.
pub(super) fn compiled(description: &Description) -> Result<Simulator, RunError> {
    let within = |system: System, operations: Option<usize>| {
        Simulator::within(system, scheme(description), first_step(description), operations)
    };
    let compile = |system: System| within(system, None);
    if description.simulation.formulation != Formulation::Auto {
        return Ok(compile(assemble::build(description)?)?);
    }
    let absolute = assemble::in_absolute_coordinates(description)?;
    let joint = match assemble::in_joint_coordinates(description, Some(DEEPEST))? {
        Ok(joint) => joint,
        Err(why) => return Ok(compile(because(absolute, why))?),
    };
    // What is singular in one formulation may be regular in the other.
    let Ok(mut joint) = compile(joint) else { return Ok(compile(absolute)?) };
    let absolute = match within(absolute, Some((GIVEN_UP * instructions(&joint)).max(SOON))) {
        Ok(absolute) => absolute,
        Err(why) => {
            if why == SimulationError::TooLong {
                joint.system.formulation.why =
                    format!("{} instructions a step instead of several times as many", instructions(&joint));
            }
            return Ok(joint);
        }
    };
    let [many, few] = [&absolute, &joint].map(instructions);
    let (mut chosen, (least, most)) = if few < many { (joint, (few, many)) } else { (absolute, (many, few)) };
    chosen.system.formulation.why = format!("{least} instructions a step instead of {most}");
    Ok(chosen)
}

/// A copy of the description with the formulation that was chosen for it.
pub(super) fn as_chosen(description: &Description, chosen: &Simulator) -> Description {
    let mut description = description.clone();
    let joint = chosen.system.formulation.joint;
    description.simulation.formulation = if joint { Formulation::Joint } else { Formulation::Absolute };
    description
}

fn because(mut system: System, why: String) -> System {
    system.formulation = FormulationInfo { why, ..system.formulation };
    system
}

/// Of a step with one correction.
pub(super) fn instructions(simulator: &Simulator) -> usize {
    let p = &simulator.program;
    [p.step(), p.factor(), p.correct(), p.advance()].into_iter().map(symdiff::Tape::len).sum()
}
