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
use crate::model::{Drag, Measure};
use crate::multibody::Vector;

use super::Loads;

/// ε, m/s
const AT_REST: f64 = 1e-6;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, drag: &Drag) -> Result<(), BuildError> {
    let point = m.point(g, drag.on);
    let wind = Vector::of(g, m.vector(g, &drag.wind, Context::Motion)?);
    let linear = m.value(g, &drag.linear)?;
    let mut quadratic = g.number(1.0);
    for factor in &drag.factors() {
        quadratic *= m.value(g, factor)?;
    }
    let u = Vector::of(g, point.velocity) - wind;
    let speed = (u.dot(u) + AT_REST * AT_REST).sqrt();
    let resistance = linear + quadratic * speed;
    loads.add_force(g, &point, (-resistance * u).exprs());
    loads.measure(Measure::FORCE, (resistance * speed).expr());
    Ok(())
}
