//! The closure as methods see it.

use crate::methods;
use crate::simulate::{Closure, Points};

impl methods::Closure for Closure<'_> {
    fn independent(&self) -> &[usize] {
        Closure::independent(self)
    }

    fn needs_velocities(&self) -> bool {
        Closure::needs_velocities(self)
    }

    fn outputs(&self, time: f64, count: usize, parameters: Vec<f64>, motion: Vec<f64>) -> Vec<f64> {
        let mut values = Vec::new();
        Closure::outputs(self, time, &Points { count, parameters, motion }, &mut values);
        values
    }
}
