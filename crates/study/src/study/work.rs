//! How much a study has to simulate, before it does.

use super::ensemble::{bytes_of_scan, bytes_of_values};
use super::single::{Study, problem};
use crate::methods::{BoundingMethod, Method, Observed};
use crate::numerics::{step_validation, validation};
use crate::simulate::Schedule;

impl Study<'_> {
    /// Simulations of the methods whose samples are given; those that a tolerance decides are within the budget.
    pub(super) fn planned_simulations(&self) -> f64 {
        let parts = if self.certify_time { 3.0 } else { 1.0 };
        let methods = self.request.methods();
        parts * methods.into_iter().filter_map(|(_, method)| method.samples()).sum::<f64>()
    }

    /// Simulations, at most, of the methods whose samples a tolerance decides.
    pub(super) fn decided_simulations(&self) -> f64 {
        let decided =
            |(method, asked): &(Method, &dyn BoundingMethod)| method.about().is_sampled && asked.samples().is_none();
        self.request.methods().iter().filter(|own| decided(own)).count() as f64 * self.request.budget.simulations as f64
    }

    /// Values that are fitted and bounded: of every output, row and sample of a method that has a surrogate.
    pub(super) fn planned_values(&self) -> f64 {
        let samples = |(method, asked): (Method, &dyn BoundingMethod)| {
            (method != Method::Scan).then(|| asked.samples()).flatten().unwrap_or(0.0)
        };
        let samples: f64 = self.request.methods().into_iter().map(samples).sum();
        samples * self.rows() as f64 * self.simulator.system.outputs.len() as f64
    }

    /// Bytes that the simulations take where they are stored. Where a tolerance decides how many there are, as many as
    /// the budget allows.
    pub(super) fn stored_bytes(&self) -> u64 {
        let problem = problem(self.description, &self.simulator);
        let (outputs, rows, methods) = (self.simulator.system.outputs.len(), self.rows(), self.request.methods());
        let observes_motion = methods.iter().any(|(_, asked)| asked.observes(&problem) == Observed::Motion);
        let lines = if observes_motion { 2 * self.simulator.system.q.len() + outputs } else { outputs };
        let of_method = |(method, asked): &(Method, &dyn BoundingMethod)| {
            let samples = asked.samples().map_or(self.request.budget.simulations, |samples| samples as usize);
            match method {
                Method::Scan => bytes_of_scan(outputs, rows, samples),
                _ => bytes_of_values(lines, rows, samples),
            }
        };
        let methods: u64 = methods.iter().map(of_method).sum();
        let parts = if self.certify_time { 3 } else { 1 };
        // Each with whole and with halved steps.
        parts * methods + 2 * bytes_of_values(lines, rows, self.held_out())
    }

    /// Samples that only measure errors.
    pub(super) fn held_out(&self) -> usize {
        let k = self.domain.dimension();
        if self.request.is_empty() {
            return 0;
        }
        step_validation(k).len() + validation(k, self.request.degree()).len()
    }

    /// Samples × rows of all methods.
    pub(super) fn total_work(&self, schedule: &Schedule) -> usize {
        let work = |(_, method): &(Method, &dyn BoundingMethod)| method.work(&self.request.budget);
        let methods: usize = self.request.methods().iter().map(work).sum();
        (1 + self.held_out() + methods * if self.certify_time { 2 } else { 1 }) * schedule.rows
    }
}
