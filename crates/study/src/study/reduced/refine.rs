//! A study that refines itself until every requirement is decided.

use std::borrow::Cow;

use super::super::{Kept, Options, RunError, subsystems};
use super::tuning::TUNING;
use crate::methods::{Chebyshev, Degree, Keep};
use crate::model::{Description, Stepping};
use crate::numerics::clock::Instant;
use crate::results::{Bounds, MethodSummary, RequirementSummary, Summary, Verdict};

/// Failure of a summary whose refining round was interrupted.
const UNFINISHED: &str = "interrupted in a refining round: results are those of the round before";

/// Runs a model; if some requirement is undecided and no tolerance is asked for, again with a higher order or
/// shorter steps, within the budget.
///
/// # Errors
/// As for any run.
pub fn run(model: &Description, options: &Options, keep: Keep) -> Result<(Bounds, Summary, Option<Kept>), RunError> {
    let mut found = subsystems::run(model, options, keep)?;
    if model.bounds.tolerance.is_some() {
        return Ok(found);
    }
    let mut model = Cow::Borrowed(model);
    let budget = model.bounds.budget;
    let begun = Instant::now();
    let (mut before, mut spent, mut rounds) = (simulations(&found.1), 0, 0);
    while rounds < TUNING.rounds && !(options.interrupted)() {
        let undecided = found.1.requirements.iter().filter(|own| own.verdict == Verdict::Undecided);
        let Some(finer) = undecided.map(|own| refined(&model, own, &found.1)).find_map(|finer| finer) else { break };
        // The next round takes about as much again for each node.
        if spent + 2 * before > budget.simulations
            || budget.seconds.is_some_and(|seconds| begun.elapsed().as_secs_f64() > 0.5 * seconds)
        {
            break;
        }
        spent += before;
        let next = subsystems::run(&finer, options, keep)?;
        if (options.interrupted)() {
            found.1.failure.get_or_insert_with(|| UNFINISHED.to_owned());
            break;
        }
        before = simulations(&next.1);
        (found, model, rounds) = (next, Cow::Owned(finer), rounds + 1);
    }
    if rounds > 0 {
        found.1.methods.push(MethodSummary {
            method: match rounds {
                1 => "an earlier round".to_owned(),
                rounds => format!("{rounds} earlier rounds"),
            },
            simulations: spent,
            steps: 0,
            ..MethodSummary::default()
        });
    }
    Ok(found)
}

fn simulations(summary: &Summary) -> usize {
    summary.methods.iter().map(|method| method.simulations).sum()
}

/// A finer request: a higher order if the surrogate's error is the larger one, shorter steps if theirs is. `None` if
/// neither can help: the errors are small relative to the margin, which is itself on both sides of the limit.
fn refined(model: &Description, own: &RequirementSummary, summary: &Summary) -> Option<Description> {
    let mut finer = model.clone();
    let by_steps = own.time > own.surrogate;
    match finer.simulation.stepping {
        Stepping::Fixed(step) if by_steps => finer.simulation.stepping = Stepping::Fixed(0.5 * step),
        Stepping::Tolerance(tolerance) if by_steps => {
            finer.simulation.stepping = Stepping::Tolerance(tolerance / TUNING.smaller_tolerance);
        }
        _ => match &mut finer.bounds.chebyshev {
            Some(Chebyshev { degree: Degree::Fixed { order, nodes }, .. }) => {
                order.iter_mut().chain(nodes).for_each(|count| *count += TUNING.more_degrees);
            }
            Some(_) => {
                let known = finer.bounds.tolerance.unwrap_or(crate::methods::BoundsRequest::TOLERANCE);
                finer.bounds.tolerance = Some(known / TUNING.smaller_tolerance);
            }
            None => return None,
        },
    }
    // If nothing varies there is no surrogate.
    (by_steps || !summary.parameters.is_empty()).then_some(finer)
}
