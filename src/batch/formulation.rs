//! By which coordinates a mechanism is simulated: where the model leaves it open, by those whose program is shorter.
//!
//! Joint coordinates are few and their matrices dense, absolute ones many and theirs sparse. What that comes to in
//! instructions is only known when both are compiled, so both are; but for long chains, where it is known before. Where
//! joints close loops, absolute coordinates are kept: joint ones may be shorter there too, but lose their way where a loop
//! passes a position in which it can branch off (a flat parallelogram), and absolute ones do not.

use crate::integrate::Simulator;
use crate::mechanics::{self, FormulationInfo, System};
use crate::model::{Description, Formulation};

use super::{RunError, first_step, scheme};

/// Joints on the way from a body to its root, on average, beyond which joint coordinates are not tried: M has as many
/// entries for each body. Spatial chains break even at 15, planar ones at 3.
const DEEPEST: usize = 25;

/// Builds and compiles a model in the formulation that it asks for, or in the shorter one.
///
/// # Errors
/// Where the mechanism cannot be built or assembled.
pub(super) fn compiled(description: &Description) -> Result<Simulator, RunError> {
    let compile = |system: System| Simulator::new(system, scheme(description), first_step(description));
    if description.simulation.formulation != Formulation::Auto {
        return Ok(compile(mechanics::build(description)?)?);
    }
    let absolute = mechanics::in_absolute_coordinates(description)?;
    let joint = match mechanics::in_joint_coordinates(description, Some(DEEPEST))? {
        Ok(joint) => joint,
        Err(why) => return Ok(compile(because(absolute, why))?),
    };
    let (absolute, joint) = match (compile(absolute), compile(joint)) {
        (Ok(absolute), Ok(joint)) => (absolute, joint),
        // What is singular in one formulation may be regular in the other.
        (Err(_), Ok(joint)) => return Ok(joint),
        (absolute, Err(_)) => return Ok(absolute?),
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
