//! The search for contacts and kinks in the equations that no sample meets, as a part of a study.

use super::events::event_search;
use super::validated::{divided, typical_steps};
use crate::study::bounding::Switches;
use crate::study::internal::{InternalError, caught};
use crate::study::problem::Study;

use crate::methods::Validation;
use crate::numerics::clock::Instant;
use crate::results::MethodSummary;
use crate::simulate::{Integration, SimulationError, Steps, unmet_switch};

/// Searches the box for them; `None` if the equations have none.
pub fn switches(
    study: &Study,
    steps: Steps<'_>,
    validation: &Validation,
    internal: &mut Vec<InternalError>,
) -> Result<Option<Switches>, SimulationError> {
    if study.interruption.is_asked() || study.simulator.system.analysis.is_without_steps() {
        return Ok(None);
    }
    if steps.schedule.segments().is_some() {
        return Ok(Some(event_search(study, steps.schedule)));
    }
    (study.stage)("searching for switches");
    let begun = Instant::now();
    // Steps between events are too long for the scheme.
    let at_rows = match steps.schedule.ends_at_events() {
        true => divided(study, typical_steps(&study.description.simulation)).schedule,
        false => steps.schedule.ending_at_rows(),
    };
    let by_scheme = Steps { schedule: &at_rows, ..steps };
    let found = caught("the search for switches", || {
        unmet_switch(&study.simulator, &study.domain, by_scheme, &validation.points, study.interruption)
    });
    let found = match found {
        Ok(found) => found?,
        Err(error) => {
            internal.push(error);
            None
        }
    };
    Ok(found.map(|mut found| {
        // Steps that a tolerance decides end at switches.
        if steps.controller.is_some() || steps.schedule.integration == Integration::Explicit {
            found.switched_from = None;
        }
        let summary = MethodSummary {
            method: "switches".to_owned(),
            simulations: found.simulations,
            steps: at_rows.steps_before(at_rows.rows - 1),
            newton_iterations: found.counters.iterations,
            rank_revealing_solves: found.counters.rank_revealing,
            order: None,
            boxes: None,
            expanded_outputs: Vec::new(),
            seconds: Some(begun.elapsed().as_secs_f64()),
        };
        (found, summary)
    }))
}
