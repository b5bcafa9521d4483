//! The first question to a program: the nominal point.

use super::no_answer;
use crate::simulate::SimulationError;
use crate::study::problem::Study;

/// Asks the program for the nominal point, once: a program that cannot answer that one is asked for no other.
///
/// # Errors
/// If it has no answer, or cannot be started.
pub(in crate::study) fn ask_nominal(study: &Study) -> Result<(), SimulationError> {
    let Some(source) = &study.source else { return Ok(()) };
    let nominal = study.domain.nominal.clone();
    // A part of the box without it may have answers.
    if !study.domain.contains(&nominal) {
        return Ok(());
    }
    let answers = source.answers(std::slice::from_ref(&nominal), 1.0, study.interruption, &|_| ());
    match answers {
        Err(SimulationError::Interrupted) => Ok(()),
        Err(error) => Err(error),
        Ok(answers) => answers.into_iter().try_for_each(|answer| match answer {
            Ok(_) => Ok(()),
            Err(why) => Err(no_answer(study, &nominal, why.to_string())),
        }),
    }
}
