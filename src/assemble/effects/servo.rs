//! A controlled drive: proportional and derivative control of a joint's coordinate, with a limit.
//!
//! ```text
//! f = sat(k_p (target − s) + k_d (d target/dt − ṡ))          N or N m, pushes s up
//! sat(x) = ½ [√((x + L)² + ε²) − √((x − L)² + ε²)],   ε = L/100
//! ```
//!
//! sat is x well within the limit L (its slope there is 1 − 5·10⁻⁵), L beyond, and smooth between. The target is a formula of t.

use symdiff::{Builder, Expr};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::{Measure, Servo, TimeOrder};

use super::Loads;

/// ε over L.
const CORNER: f64 = 0.01;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, servo: &Servo) -> Result<(), BuildError> {
    let on = servo.on;
    let target = m.formula(g, &servo.target, Context::Time)?;
    let proportional = m.formula(g, &servo.proportional, Context::Motion)?;
    let derivative = m.formula(g, &servo.derivative, Context::Motion)?;
    let wanted_rate = g.derivative(target, m.time);
    let place = m.joint_coordinate(g, on.joint, on.coordinate, TimeOrder::Position);
    let rate = m.joint_coordinate(g, on.joint, on.coordinate, TimeOrder::Velocity);
    let (behind, slow) = (g.sub(target, place), g.sub(wanted_rate, rate));
    let (stiff, damped) = (g.mul(proportional, behind), g.mul(derivative, slow));
    let mut effort = g.add(stiff, damped);
    if let Some(limit) = &servo.limit {
        let limit = m.formula(g, limit, Context::Motion)?;
        effort = saturated(g, effort, limit);
    }
    loads.measure(Measure::of_effort(on.coordinate), effort);
    loads.add_joint_effort(g, m, on, effort)
}

fn saturated(g: &Builder, x: Expr, limit: Expr) -> Expr {
    let corner = g.scale(CORNER, limit);
    let corner = g.mul(corner, corner);
    let (above, below) = (g.add(x, limit), g.sub(x, limit));
    let [above, below] = [above, below].map(|distance| {
        let square = g.mul(distance, distance);
        let smooth = g.add(square, corner);
        g.sqrt(smooth)
    });
    let doubled = g.sub(above, below);
    g.scale(0.5, doubled)
}
