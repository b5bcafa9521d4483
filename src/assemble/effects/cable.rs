//! A cable between two points A and B: it pulls, and does not push.
//!
//! ```text
//! T = ⟨k p(x) + c p'(x) ℓ̇⟩,   x = ℓ − ℓ₀,   ℓ = |r_B − r_A|,   V = k ∫p dx          N, J
//! F_A = T (r_B − r_A)/ℓ,   F_B = −F_A
//! ```
//!
//! p is the positive part with its corner rounded (`positive_part`): the cable becomes taut over ±ε of stretch. Slack, it
//! does nothing, and only its length is computed. Points that coincide have no line between them.

use symdiff::{Builder, Scalar};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::{Cable, Measure};
use crate::multibody::Vector;

use super::Loads;
use super::positive_part::{PositivePart, clipped};

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, cable: &Cable) -> Result<(), BuildError> {
    let (free, corner) = (m.value(g, &cable.free_length)?, m.value(g, &cable.transition)?);
    let (stiffness, damping) = (m.value(g, &cable.stiffness)?, m.value(g, &cable.damping)?);
    let [a, b] = cable.between.map(|point| m.point(g, point));
    let line = Vector::of(g, b.position) - Vector::of(g, a.position);
    let length = line.norm();
    let direction = line / length;
    let rate = direction.dot(Vector::of(g, b.velocity) - Vector::of(g, a.velocity));
    let stretch = length - free;
    // ℓ > ℓ₀ − ε, by squares.
    let slack = clipped(free - corner);
    let tight = line.dot(line) - slack * slack;
    loads.only_where(tight.expr());
    let taut = PositivePart::of(stretch, corner);
    let tension = clipped(stiffness * taut.value + damping * taut.slope * rate);
    loads.add_force_pair(g, &b, &a, (tension * direction).exprs());
    let tension = tension.only_where(tight);
    let potential = (stiffness * taut.integral).only_where(tight);
    loads.add_potential(g, m, &[stiffness, free, corner].map(Scalar::expr), potential.expr());
    for (measure, value) in [(Measure::LENGTH, length), (Measure::RATE, rate), (Measure::FORCE, tension)] {
        loads.measure(measure, value.expr());
    }
    Ok(())
}
