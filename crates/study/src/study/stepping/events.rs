//! Whether motions are cut at events, and the steps between them.

use super::controlled::controlling_samples;
use super::validated::may_leave_scheme;
use crate::methods::Keep;
use crate::model::{Analysis, Description, Stepping};
use crate::numerics::{Sample, spread};
use crate::results::{EventSummary, EventsFollowed, MethodSummary};
use crate::simulate::{
    Boundary, Counters, Following, Integration, Schedule, SegmentMethod, SimulationError, SwitchSearch, WordsEnd,
    cut_at_events,
};
use crate::study::bounding::Switches;
use crate::study::problem::{Study, problem};
use crate::study::stepping::tuning::TUNING;

/// Steps between the events that all samples meet, if there are any and all that is asked for follows from motions
/// that are cut there.
pub fn segmented(study: &Study) -> Result<Option<Schedule>, SimulationError> {
    let Some(method) = method_between_events(study).filter(|_| may_be_cut(study)) else { return Ok(None) };
    (study.stage)("searching for events");
    let schedule = segments_of_samples(study, &event_samples(study), method)?;
    // A number that is accumulated over a motion is one of the whole of it.
    let accumulates = !study.description.reduced.is_empty() || !study.description.requirements.is_empty();
    Ok(schedule.filter(|schedule| !accumulates || lasts(study, schedule)))
}

/// Steps between the events that single samples meet, if there are any and these can be cut there up to the end.
/// Samples show their events themselves if they are fewer than those that show the box's. A random motion meets more
/// than are followed. Steps of the scheme that is asked for are the model's, as those of its source code.
pub fn segmented_samples(study: &Study, samples: &[Sample]) -> Result<Option<Schedule>, SimulationError> {
    let may_be_cut = may_leave_scheme(study) && opens_nothing(study) && !has_given_steps(study);
    if !may_be_cut || is_random(study.description) {
        return Ok(None);
    }
    let of_box = event_samples(study);
    let shown = if samples.len() < of_box.len() { samples } else { &of_box };
    let schedule = segments_of_samples(study, shown, SegmentMethod::Explicit)?;
    Ok(schedule.filter(|schedule| lasts(study, schedule)))
}

/// Whether motions are cut up to their end.
fn lasts(study: &Study, schedule: &Schedule) -> bool {
    let duration = study.description.simulation.duration;
    schedule.segments().is_none_or(|segments| segments.horizon >= duration)
}

/// Steps of the explicit method between the events of the nominal motion, if there are any and it can follow it,
/// whatever the model's scheme.
pub fn segmented_nominal(study: &Study) -> Result<Option<Schedule>, SimulationError> {
    if !opens_nothing(study) {
        return Ok(None);
    }
    let found = segments_of_samples(study, std::slice::from_ref(&study.domain.nominal), SegmentMethod::Explicit)?;
    Ok(found.filter(|schedule| schedule.integration == Integration::Segments))
}

/// How motions between events are integrated; `None` if a method asks for the scheme's own steps: certified bounds
/// enclose the scheme, and jets that are requested with it go across its steps.
fn method_between_events(study: &Study) -> Option<SegmentMethod> {
    if may_leave_scheme(study) {
        return Some(SegmentMethod::Explicit);
    }
    let levels = study.description.simulation.extrapolation.unwrap_or(1);
    let only_sampled = study.request.methods().iter().all(|(method, _)| method.about().is_sampled);
    (only_sampled && study.request.taylor.is_none()).then_some(SegmentMethod::Scheme { levels })
}

/// Steps between the events that some samples meet.
fn segments_of_samples(
    study: &Study,
    samples: &[Sample],
    method: SegmentMethod,
) -> Result<Option<Schedule>, SimulationError> {
    let simulation = &study.description.simulation;
    let (duration, output_step) = (simulation.duration, simulation.output_step);
    let of_steps = match simulation.stepping {
        Stepping::Tolerance(tolerance) => Some(tolerance),
        Stepping::Fixed(_) => None,
    };
    let asked = of_steps.into_iter().chain(study.request.tolerance).map(|tolerance| TUNING.event_share * tolerance);
    let tolerance = asked.fold(TUNING.event_error, f64::min);
    let following = Following { tolerance, method, of_steps };
    let longest = match simulation.stepping {
        Stepping::Tolerance(_) => None,
        Stepping::Fixed(step) => Some(step),
    };
    let found = cut_at_events(&study.simulator, &study.domain, samples, duration, following, longest)?;
    Ok(found.map(|steps| Schedule::ending_at_events(duration, output_step, steps)))
}

/// The search for events, as a line of the summary: no sample met others.
pub fn event_search(study: &Study, schedule: &Schedule) -> Switches {
    let simulations = event_samples(study).len();
    let found = SwitchSearch { unmet_from: None, switched_from: None, simulations, counters: Counters::default() };
    let summary = MethodSummary {
        method: "switches".to_owned(),
        simulations,
        steps: schedule.steps_before(schedule.rows - 1) * schedule.integration.steps(),
        ..MethodSummary::default()
    };
    (found, summary)
}

/// Events that a part of the samples meets.
pub fn events_of_parts(study: &Study, schedule: &Schedule) -> Vec<EventSummary> {
    let parameters = &study.simulator.system.parameters;
    let boundaries = schedule.segments().map_or(&[][..], |segments| &segments.boundaries);
    let of_boundary = |boundary: &Boundary| {
        let grazed = parameters.iter().zip(&boundary.grazed_at);
        EventSummary {
            event: boundary.event.name(&study.simulator).unwrap_or_default(),
            samples: boundary.samples.iter().sum(),
            met: boundary.samples[0],
            grazed_at: grazed.filter_map(|(own, value)| Some((own.name.clone(), (*value)?))).collect(),
        }
    };
    boundaries.iter().map(of_boundary).collect()
}

/// The time up to which events are followed, if it is before the end of the rows.
pub fn events_followed(schedule: &Schedule) -> Option<EventsFollowed> {
    let segments = schedule.segments()?;
    let why = match segments.end? {
        WordsEnd::MoreWords => "parameter values meet more sequences of events than are followed",
        WordsEnd::MoreEvents => "a sample meets more events than are followed",
    };
    Some(EventsFollowed { until: segments.horizon, why: why.to_owned() })
}

/// Samples that show the events: the controlling ones, and some spread over the box.
fn event_samples(study: &Study) -> Vec<Sample> {
    let mut samples = controlling_samples(study);
    let k = study.domain.dimension();
    samples.extend(study.domain.samples(&spread(k, TUNING.event_samples * k)));
    samples
}

fn may_be_cut(study: &Study) -> bool {
    let problem = problem(study.description, &study.simulator);
    let methods = study.request.methods();
    (study.domain.dimension() == 0 || methods.iter().all(|(_, method)| method.follows_events(&problem)))
        && !methods.is_empty()
        && !(study.request.keep == Keep::WholeBox && is_random(study.description))
        && opens_nothing(study)
        && !has_given_steps(study)
}

/// Whether a motion depends on nothing, and keeps the steps that it is given.
fn has_given_steps(study: &Study) -> bool {
    let is_fixed = matches!(study.description.simulation.stepping, Stepping::Fixed(_));
    study.domain.dimension() == 0 && study.request.tolerance.is_none() && is_fixed
}

/// Whether motions are random: each has a seed.
pub fn is_random(description: &Description) -> bool {
    description.analysis == Analysis::Motion && description.trajectories.iter().any(|own| own.random().is_some())
}

/// Constraints that open later are not watched for.
fn opens_nothing(study: &Study) -> bool {
    study.simulator.mobility.redundant.is_empty()
}
