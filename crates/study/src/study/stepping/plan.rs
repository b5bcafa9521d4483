//! The steps that a study's samples share.

use crate::simulate::{Controller, Schedule, Steps};

/// Steps of all samples, and control of the local error of each.
#[derive(Clone, Debug)]
pub struct StepPlan {
    /// Rows, and the steps between them.
    pub schedule: Schedule,
    /// Controller of the steps, if a tolerance determines them: a sample that exceeds its share takes shorter ones.
    pub controller: Option<Controller>,
}

impl StepPlan {
    /// Steps that every sample takes as they are.
    pub fn fixed(schedule: Schedule) -> Self {
        Self { schedule, controller: None }
    }

    /// The steps of a run.
    pub fn steps(&self) -> Steps<'_> {
        Steps { schedule: &self.schedule, controller: self.controller }
    }

    /// The same with each step halved.
    pub fn halved(&self) -> Self {
        Self { schedule: self.schedule.refined(2), controller: self.controller_of_halves() }
    }

    /// The same rows with between two and three steps for each, whose ends differ.
    pub fn at_odds(&self) -> Self {
        Self { schedule: self.schedule.at_odds(), controller: self.controller_of_halves() }
    }

    fn controller_of_halves(&self) -> Option<Controller> {
        self.controller.map(|controller| controller.for_parts(2))
    }
}
