//! Resistance of a fluid at a point of a body.
//!
//! ```text
//! F = −(b + k |u|) u,   u = ṙ − wind,   k = ½ ρ c_d A          N
//! ```
//!
//! |u| is √(u² + ε²), ε = 1 µm/s: the square law has no second slope at rest. It has no potential.

use symdiff::Builder;

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::{Drag, Measure};

use super::Loads;

/// ε, m/s
const AT_REST: f64 = 1e-6;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, drag: &Drag) -> Result<(), BuildError> {
    let point = m.point(g, drag.on);
    let wind = m.vector(g, &drag.wind, Context::Motion)?;
    let linear = m.formula(g, &drag.linear, Context::Motion)?;
    let mut quadratic = g.constant(1.0);
    for factor in &drag.factors() {
        let factor = m.formula(g, factor, Context::Motion)?;
        quadratic = g.mul(quadratic, factor);
    }
    let relative = space::sub(g, point.velocity, wind);
    let square = space::dot(g, relative, relative);
    let rest = g.constant(AT_REST * AT_REST);
    let smooth = g.add(square, rest);
    let speed = g.sqrt(smooth);
    let inertial = g.mul(quadratic, speed);
    let resistance = g.add(linear, inertial);
    let against = g.neg(resistance);
    let force = space::scale(g, against, relative);
    loads.add_force(g, &point, force);
    let felt = g.mul(resistance, speed);
    loads.measure(Measure::Force, felt);
    Ok(())
}
