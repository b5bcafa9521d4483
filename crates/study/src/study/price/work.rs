//! Number of simulations of a study, before it begins.

use crate::methods::{BoundingMethod, Method, Observed};
use crate::numerics::{step_validation, validation};
use crate::simulate::Schedule;
use crate::study::ensemble::{bytes_of_scan, bytes_of_values};
use crate::study::problem::{Study, problem};

/// Simulations of the methods whose samples are given; those that a tolerance decides are within the budget.
pub fn planned_simulations(study: &Study) -> f64 {
    let parts = if study.certify_time { 3.0 } else { 1.0 };
    let methods = study.request.methods();
    parts * methods.into_iter().filter_map(|(_, method)| method.samples()).sum::<f64>()
}

/// Simulations, at most, of the methods whose samples a tolerance decides.
pub fn decided_simulations(study: &Study) -> f64 {
    let decided =
        |(method, asked): &(Method, &dyn BoundingMethod)| method.about().is_sampled && asked.samples().is_none();
    study.request.methods().iter().filter(|own| decided(own)).count() as f64 * study.request.budget.simulations as f64
}

/// Values that are fitted and bounded: of every output, row and sample of a method that has a surrogate.
pub fn planned_values(study: &Study) -> f64 {
    let samples = |(method, asked): (Method, &dyn BoundingMethod)| {
        (method != Method::Scan).then(|| asked.samples()).flatten().unwrap_or(0.0)
    };
    let samples: f64 = study.request.methods().into_iter().map(samples).sum();
    samples * study.rows() as f64 * study.simulator.system.outputs.len() as f64
}

/// Bytes that the stored simulations take. If a tolerance determines their number, it is the one that the budget
/// allows.
pub fn stored_bytes(study: &Study) -> u64 {
    let problem = problem(study.description, &study.simulator);
    let (outputs, rows, methods) = (study.simulator.system.outputs.len(), study.rows(), study.request.methods());
    let observes_motion = methods.iter().any(|(_, asked)| asked.observes(&problem) == Observed::Motion);
    let lines = if observes_motion { 2 * study.simulator.system.q.len() + outputs } else { outputs };
    let of_method = |(method, asked): &(Method, &dyn BoundingMethod)| {
        let samples = asked.samples().map_or(study.request.budget.simulations, |samples| samples as usize);
        match method {
            Method::Scan => bytes_of_scan(outputs, rows, samples),
            _ => bytes_of_values(lines, rows, samples),
        }
    };
    let methods: u64 = methods.iter().map(of_method).sum();
    let parts = if study.certify_time { 3 } else { 1 };
    // Each with whole and with halved steps.
    parts * methods + 2 * bytes_of_values(lines, rows, held_out(study))
}

/// Samples that only measure errors.
pub fn held_out(study: &Study) -> usize {
    let k = study.domain.dimension();
    if study.request.is_empty() {
        return 0;
    }
    step_validation(k).len() + validation(k, study.request.degree()).len()
}

/// Samples × rows of all methods.
pub fn total_work(study: &Study, schedule: &Schedule) -> usize {
    let work = |(_, method): &(Method, &dyn BoundingMethod)| method.work(&study.request.budget);
    let methods: usize = study.request.methods().iter().map(work).sum();
    (1 + held_out(study) + methods * if study.certify_time { 2 } else { 1 }) * schedule.rows
}
