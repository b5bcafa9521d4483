//! How much a study has to simulate, before it does.

use super::single::Study;
use crate::methods::{BoundingMethod, Method};
use crate::numerics::{step_validation, validation};
use crate::simulate::Schedule;

impl Study<'_> {
    /// Simulations of the methods whose samples are given; those that a tolerance decides are within the budget.
    pub(super) fn planned_simulations(&self) -> f64 {
        let parts = if self.certify_time { 3.0 } else { 1.0 };
        let methods = self.request.methods();
        parts * methods.into_iter().filter_map(|(_, method)| method.samples()).sum::<f64>()
    }

    /// Samples × rows of all methods.
    pub(super) fn total_work(&self, schedule: &Schedule) -> usize {
        let work = |(_, method): &(Method, &dyn BoundingMethod)| method.work(&self.request.budget);
        let methods: usize = self.request.methods().iter().map(work).sum();
        let k = self.domain.dimension();
        let held_out = if self.request.is_empty() {
            0
        } else {
            step_validation(k).len() + validation(k, self.request.degree()).len()
        };
        (1 + held_out + methods * if self.certify_time { 2 } else { 1 }) * schedule.rows
    }
}
