//! A cable between two points A and B: it pulls, and does not push.
//!
//! ```text
//! T = ⟨k p(x) + c p'(x) ℓ̇⟩,   x = ℓ − ℓ₀,   ℓ = |r_B − r_A|,   V = k ∫p dx          N, J
//! F_A = T (r_B − r_A)/ℓ,   F_B = −F_A
//! ```
//!
//! p is the positive part with its corner rounded (`positive_part`): the cable becomes taut over ±ε of stretch. Slack, it
//! does nothing, and only its length is computed. Points that coincide have no line between them.

use symdiff::Builder;

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::{Cable, Measure};

use super::Loads;
use super::positive_part::{PositivePart, clipped};

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, cable: &Cable) -> Result<(), BuildError> {
    let number = |g: &Builder, formula| m.formula(g, formula, Context::Motion);
    let (free, corner) = (number(g, &cable.free_length)?, number(g, &cable.transition)?);
    let (stiffness, damping) = (number(g, &cable.stiffness)?, number(g, &cable.damping)?);
    let [a, b] = cable.between.map(|point| m.point(g, point));
    let line = space::sub(g, b.position, a.position);
    let length = space::norm(g, line);
    let direction = line.map(|component| g.div(component, length));
    let relative = space::sub(g, b.velocity, a.velocity);
    let rate = space::dot(g, direction, relative);
    let stretch = g.sub(length, free);
    // ℓ > ℓ₀ − ε, told by squares.
    let slack = g.sub(free, corner);
    let slack = clipped(g, slack);
    let (square, reach) = (space::dot(g, line, line), g.mul(slack, slack));
    let tight = g.sub(square, reach);
    loads.only_where(tight);
    let taut = PositivePart::of(g, stretch, corner);
    let elastic = g.mul(stiffness, taut.value);
    let felt = g.mul(damping, taut.slope);
    let viscous = g.mul(felt, rate);
    let tension = g.add(elastic, viscous);
    let tension = clipped(g, tension);
    let pull = space::scale(g, tension, direction);
    loads.add_force_pair(g, &b, &a, pull);
    let tension = g.only_where(tight, tension);
    let potential = g.mul(stiffness, taut.integral);
    let potential = g.only_where(tight, potential);
    loads.add_potential(g, m, &[stiffness, free, corner], potential);
    for (measure, value) in [(Measure::Length, length), (Measure::Rate, rate), (Measure::Force, tension)] {
        loads.measure(measure, value);
    }
    Ok(())
}
