//! A controlled drive: proportional and derivative control of a joint's coordinate, with a limit.
//!
//! ```text
//! f = sat(k_p (target − s) + k_d (d target/dt − ṡ))          N or N m, pushes s up
//! sat(x) = ½ [√((x + L)² + ε²) − √((x − L)² + ε²)],   ε = L/100
//! ```
//!
//! sat is x well within the limit L (its slope there is 1 − 5·10⁻⁵), L beyond, and smooth between. The target is a formula of t.

use symdiff::{Builder, Scalar};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::{Measure, Servo};

use super::Loads;

/// ε over L.
const CORNER: f64 = 0.01;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, servo: &Servo) -> Result<(), BuildError> {
    let on = servo.on;
    let target = m.given(g, &servo.target)?;
    let proportional = m.value(g, &servo.proportional)?;
    let derivative = m.value(g, &servo.derivative)?;
    let target_rate = target.derivative(g.scalar(m.time));
    let [place, rate] = m.coordinate_and_rate(g, on);
    let mut effort = proportional * (target - place) + derivative * (target_rate - rate);
    if let Some(limit) = &servo.limit {
        effort = saturated(effort, m.value(g, limit)?);
    }
    loads.measure(Measure::of_effort(on.coordinate), effort.expr());
    loads.add_joint_effort(g, m, on, effort.expr())
}

fn saturated<'g>(x: Scalar<'g>, limit: Scalar<'g>) -> Scalar<'g> {
    let corner = CORNER * limit;
    let corner = corner * corner;
    let [above, below] = [x + limit, x - limit].map(|distance| (distance * distance + corner).sqrt());
    0.5 * (above - below)
}
