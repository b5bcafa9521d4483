//! A cable between two points A and B: it pulls, and does not push.
//!
//! ```text
//! T = ⟨k p(x) + c p'(x) ℓ̇⟩,   x = ℓ − ℓ₀,   ℓ = |r_B − r_A|,   V = k ∫p dx          N, J
//! F_A = T (r_B − r_A)/ℓ,   F_B = −F_A
//! ```
//!
//! p is the positive part with its corner rounded (`positive_part`): the cable becomes taut over ±ε of stretch. Slack,
//! it does nothing, and only its length is computed. Points that coincide have no line between them.

use mbint_derive::Element;
use symdiff::{Binary, Formula};

use super::laws::positive_part::{PositivePart, clipped};
use super::{ForceElement, Forces, TypedSensor};
use crate::elements::Glyph;
use crate::elements::tuning::TUNING;
use crate::grammar::quantity::Dimension;
use crate::grammar::{PointRef, Sensor};
use crate::multibody::BuildError;

/// A cable: it pulls, and does not push.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "cable",
    what = "a cable",
    equation = "T = ⟨k p(x) + c p'(x) ℓ̇⟩, x = ℓ − ℓ₀, p the positive part with a rounded corner",
    source = "Hooke",
    example = "{ between: [arm.tip, cart.hook], free_length: 0.8, stiffness: 1e4, damping: 10 }"
)]
pub struct Cable {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Length without tension.
    #[quantity(unit = "m", constant, positive)]
    pub free_length: Formula,
    /// Tension by stretch.
    #[quantity(unit = "N/m")]
    pub stiffness: Formula,
    /// While taut, tension by rate of stretch.
    #[quantity(unit = "N*s/m", default = 0)]
    pub damping: Formula,
    /// Stretch over which it becomes taut, either way.
    #[quantity(
        unit = "m",
        constant,
        positive,
        default_with("a ten-thousandth of `free_length`", Formula::number(TUNING.taut_cable).combined(Binary::Mul, &free_length))
    )]
    pub transition: Formula,
}

impl ForceElement for Cable {
    const GLYPH: Glyph = Glyph::Cable;
    const SENSORS: &'static [TypedSensor] = &[
        (Sensor::LENGTH, Dimension::LENGTH),
        (Sensor::RATE, Dimension::VELOCITY),
        (Sensor::FORCE, Dimension::FORCE),
        (Sensor::AXIAL, Dimension::FORCE),
    ];

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let (free, corner) = (forces.value(&self.free_length)?, forces.value(&self.transition)?);
        let (stiffness, damping) = (forces.value(&self.stiffness)?, forces.value(&self.damping)?);
        let [a, b] = self.between.map(|point| forces.point(point));
        let line = b.position - a.position;
        let length = line.norm();
        let direction = line / length;
        let rate = direction.dot(b.velocity - a.velocity);
        let stretch = length - free;
        // ℓ > ℓ₀ − ε, by squares.
        let slack = clipped(free - corner);
        let tight = line.dot(line) - slack * slack;
        forces.only_where(tight);
        let taut = PositivePart::of(stretch, corner);
        let tension = clipped(stiffness * taut.value + damping * taut.derivative * rate);
        forces.between(&b, &a, tension * direction);
        let tension = tension.only_where(tight);
        let potential = (stiffness * taut.integral).only_where(tight);
        forces.potential(&[stiffness, free, corner], potential);
        forces.sensors([
            (Sensor::LENGTH, length),
            (Sensor::RATE, rate),
            (Sensor::FORCE, tension),
            (Sensor::AXIAL, tension),
        ]);
        Ok(())
    }
}
