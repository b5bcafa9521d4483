//! A simulator's closure under the trait that methods use.

use crate::methods;
use crate::simulate::{Closure, Points, SimulationError, Simulator};

/// Closes motions of a simulator over its independent coordinates.
pub(in crate::study) struct MotionClosure<'s>(Closure<'s>);

impl<'s> MotionClosure<'s> {
    pub(in crate::study) fn new(simulator: &'s Simulator, independent: Vec<usize>) -> Result<Self, SimulationError> {
        Closure::new(simulator, independent).map(Self)
    }
}

impl methods::Closure for MotionClosure<'_> {
    fn independent(&self) -> &[usize] {
        self.0.independent()
    }

    fn needs_velocities(&self) -> bool {
        self.0.needs_velocities()
    }

    fn outputs(&self, time: f64, count: usize, parameters: Vec<f64>, motion: Vec<f64>) -> Vec<f64> {
        let mut values = Vec::new();
        self.0.outputs(time, &Points { count, parameters, motion }, &mut values);
        values
    }
}
