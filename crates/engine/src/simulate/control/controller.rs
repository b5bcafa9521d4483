//! Step-size control by a tolerance.

use serde::{Deserialize, Serialize};

use super::schedule::Schedule;
use super::tuning::TUNING;

/// Steps of a motion.
#[derive(Clone, Copy, Debug)]
pub struct Steps<'s> {
    /// Rows, and the steps between them.
    pub schedule: &'s Schedule,
    /// Control of the local error of each step; none for steps of fixed length.
    pub controller: Option<Controller>,
}

/// Step-size control for HHT.
///
/// The local position error δ of a step (Negrut et al. 2007, §5) is of third order. Each step may have its share of the
/// tolerance, δ ≤ tolerance · h / duration (an error per unit step), so that the error at the end is proportional to
/// the tolerance. With δ ≤ tolerance for every step, as in the paper, the errors of ever more steps would add up, and
/// the error at the end would fall with tolerance^(2/3) only.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Controller {
    /// Wanted position error over the duration, relative to max(1, |q|) of each coordinate's scale.
    pub tolerance: f64,
    /// s
    pub duration: f64,
}

impl Controller {
    /// A switch is located to this, s: shorter steps are left to the errors that they make.
    pub fn event(self) -> f64 {
        TUNING.event_width * self.duration
    }

    /// Smallest step, s.
    pub fn least(self) -> f64 {
        TUNING.smallest_step * self.duration
    }

    /// Controller of steps that are divided into `parts` parts: the scheme is of second order.
    #[must_use]
    pub fn for_parts(self, parts: usize) -> Self {
        Self { tolerance: self.tolerance / (parts as f64).powi(2), ..self }
    }

    /// A step's local error over its share of the tolerance; the step is accepted where this is at most 1.
    pub fn error_ratio(self, error: f64, h: f64) -> f64 {
        error / (self.tolerance * h / self.duration).max(TUNING.round_off_of_errors)
    }

    /// Factor for the next step size after a step with this error ratio (the worst sample's): δ/h is of second order.
    pub fn factor(self, error_ratio: f64) -> f64 {
        if !error_ratio.is_finite() {
            return 0.25;
        }
        (0.9 / error_ratio.sqrt()).clamp(0.2, 2.0)
    }
}
