//! A mechanism that depends on no uncertain parameter: simulated once, and once more with halved steps for its error, whatever
//! is asked for.

use std::sync::atomic::AtomicUsize;
use std::time::Instant;

use super::methods::{Outcome, Progress, Run};
use super::probe::Probes;
use super::run::{Results, Study};
use super::step_search::StepSearch;
use crate::results::Method;
use crate::simulate::{Counters, Schedule, SimulationError};

impl Study<'_> {
    /// Every method's bounds are the one course that there is.
    pub(super) fn deterministic(
        &self,
        schedule: &Schedule,
        tolerance: Option<f64>,
    ) -> Result<Results, SimulationError> {
        let progress = Progress { done: AtomicUsize::new(0), total: 3 * schedule.rows };
        let mut steps = StepSearch::new(schedule);
        loop {
            let schedule = steps.schedule();
            let run = Run { study: self, schedule: &schedule, tolerance, progress: &progress, finish: true };
            let nominal = run.nominal()?;
            if self.request.is_empty() {
                return Ok(Results { schedule, nominal, probes: None, methods: Vec::new(), halved: Vec::new() });
            }
            let probes = Probes::of_course(&run, &nominal)?;
            if let Some(allowed) = self.request.tolerance
                && steps.adjust(probes.worst_share(allowed, schedule.rows))
            {
                continue;
            }
            let asked = [
                (Method::Chebyshev, self.request.chebyshev.is_some()),
                (Method::Taylor, self.request.taylor.is_some()),
                (Method::Scan, self.request.scan.is_some()),
            ];
            let asked = asked.into_iter().filter(|(_, asked)| *asked);
            let mut methods: Vec<(Method, Outcome)> =
                asked.map(|(method, _)| (method, run.same(&nominal, method))).collect();
            if self.request.certified && !(self.interrupted)() {
                methods.push((Method::Certified, run.certified()));
            }
            return Ok(Results { schedule, nominal, probes: Some(probes), methods, halved: Vec::new() });
        }
    }
}

impl Run<'_> {
    /// A method's bounds that are one course: no wider, and exact but for the steps.
    fn same(&self, course: &Outcome, method: Method) -> Outcome {
        let known = |range: &crate::numerics::Range| if range.lower.is_nan() { f64::NAN } else { 0.0 };
        Outcome {
            bands: course.bands.clone(),
            surrogate: course.bands.iter().map(|ranges| ranges.iter().map(known).collect()).collect(),
            steps: course.steps.clone(),
            parts: course.parts.clone(),
            stop: course.stop.clone(),
            reached: course.reached,
            note: None,
            summary: self.method_summary(
                method.name(),
                0,
                Counters::default(),
                course.stop.as_ref().map(|(stop, _)| stop),
                Instant::now(),
            ),
            strained: None,
            singular: Vec::new(),
        }
    }
}
