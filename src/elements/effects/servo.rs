//! A controlled drive: proportional and derivative control of a joint's coordinate, with a limit.
//!
//! ```text
//! f = sat(k_p (target − s) + k_d (d target/dt − ṡ))          N or N m, pushes s up
//! sat(x) = ½ [√((x + L)² + ε²) − √((x − L)² + ε²)],   ε = L/100
//! ```
//!
//! sat is x well within the limit L (its slope there is 1 − 5·10⁻⁵), L beyond, and smooth between. The target is a formula of t.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ForceElement, Sensor, effort};
use crate::grammar::quantity::Dimension;
use crate::grammar::{Measure, OnJoint};

/// A drive that controls a joint's coordinate, with a limit.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "servo",
    what = "a servo",
    equation = "f = sat(k_p (target − s) + k_d (d target/dt − ṡ))",
    source = "Åström & Murray, Feedback Systems, 2nd ed. (2021)",
    example = "{ on: hinge, target: 0.5*sin(2*t), proportional: 200, derivative: 8, limit: 30 N*m }"
)]
pub struct Servo {
    /// The joint's coordinate.
    #[group]
    pub on: OnJoint,
    /// What the coordinate should be; may depend on t.
    #[quantity(unit = "m or rad", time)]
    pub target: Formula,
    /// Force by error.
    #[quantity(unit = "N/m or N*m/rad")]
    pub proportional: Formula,
    /// Force by rate of error.
    #[quantity(unit = "N*s/m or N*m*s/rad", default = 0)]
    pub derivative: Formula,
    /// Largest force or torque.
    #[quantity(unit = "N or N*m", constant, positive, otherwise = "none")]
    pub limit: Option<Formula>,
}

impl ForceElement for Servo {
    const SENSORS: &'static [Sensor] = &[(Measure::FORCE, Dimension::FORCE), (Measure::TORQUE, Dimension::TORQUE)];

    fn sensors(&self) -> Vec<Sensor> {
        vec![effort(self.on)]
    }

    fn coordinates(&self) -> Vec<OnJoint> {
        vec![self.on]
    }
}
