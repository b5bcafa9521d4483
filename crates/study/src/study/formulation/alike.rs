//! Other questions of a mechanism whose formulation is chosen: it is not chosen again.

use super::candidates::{Compiled, because};
use super::{assembled, compiled};
use crate::assemble::{self, FormulationInfo, Questions, System};
use crate::compile::Layout;
use crate::simulate::{Assembled, Simulator};
use crate::study::RunError;

/// Compiles in the known formulation, so that the steps are the same; in one of their own if the questions cannot be
/// answered in it, as reactions of inboard joints.
///
/// # Errors
/// As for [`compiled`].
pub fn compiled_alike(questions: &Questions, known: &FormulationInfo) -> Result<Simulator, RunError> {
    match alike(questions, known)? {
        Some(system) => Ok(Compiled::of(system, questions.description)?),
        None => compiled(questions),
    }
}

/// The start that is known, with other outputs.
///
/// # Errors
/// As for [`compiled`].
pub fn assembled_alike(questions: &Questions, known: &Simulator) -> Result<Assembled, RunError> {
    match alike(questions, &known.system.formulation)? {
        Some(system) if Layout::of(&system) == known.start.layout => Ok(Assembled {
            system,
            start: known.start.clone(),
            nominal: known.nominal.clone(),
            mobility: known.mobility.clone(),
            undetermined: Vec::new(),
            shared: known.shared.clone(),
            equilibrium: known.equilibrium.clone(),
            vibrations: known.vibrations.clone(),
            derived: None,
        }),
        _ => assembled(questions),
    }
}

/// The equations for other questions; `None` if the formulation does not allow them.
fn alike(questions: &Questions, known: &FormulationInfo) -> Result<Option<System>, RunError> {
    let FormulationInfo { joint, why, cut, closed_from } = known;
    let questions = questions.cut_at(cut.clone());
    let built = match joint {
        true => assemble::in_joint_coordinates(&questions, None, closed_from.as_deref())?.ok(),
        false => Some(assemble::in_absolute_coordinates(&questions)?),
    };
    Ok(built.map(|system| because(system, why.clone())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model;

    /// A tree, loops with a cut that was searched for, and loops in absolute coordinates.
    #[test]
    fn equal_questions_compile_to_equal_steps_and_start() {
        for name in ["double_pendulum", "slider_crank", "four_bar", "excavator", "bricard"] {
            let path = format!("{}/../../models/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
            let description = model::load(std::path::Path::new(&path), &[]).unwrap_or_else(|errors| panic!("{errors}"));
            let questions = Questions::of(&description);
            let chosen = compiled(&questions).unwrap();
            let alike = compiled_alike(&questions, &chosen.system.formulation).unwrap();
            assert_eq!(alike.system.formulation, chosen.system.formulation, "{name}");
            assert_eq!(alike.program.instructions(), chosen.program.instructions(), "{name}");
            let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
            assert_eq!(bits(&alike.nominal), bits(&chosen.nominal), "{name}");
            let assembled = assembled_alike(&questions, &chosen).unwrap();
            let nominal = chosen.system.parameters.iter().map(|parameter| parameter.nominal).collect();
            let count = chosen.system.outputs.len();
            let found = assembled.outputs_at_start(0..count, &nominal);
            assert_eq!(bits(&found), bits(&chosen.outputs_at_start()), "{name}");
        }
    }
}
