//! A gas spring between two points A and B: gas behind a piston, which pushes the points apart.
//!
//! ```text
//! f = (p − p_a) A,    p = p₀ (V₀/V)ⁿ,    V = V₀ + A (ℓ − ℓ₀),    A = π/4 d²          N
//! V_pot = p₀ V₀ (V₀/V)ⁿ⁻¹/(n − 1) + p_a A ℓ,    for n = 1: −p₀ V₀ ln V + p_a A ℓ            J
//! ```
//!
//! n = 1 is gas at a constant temperature, n = 1.4 air that exchanges no heat, slower changes lie between. p and V are
//! absolute, for all the gas that is there: in a spring whose piston oil passes through, d is the diameter of the rod.
//! Nothing moves where V would be negative: the force is no number there.

use std::f64::consts::FRAC_PI_4;

use mbint_derive::Element;
use symdiff::Formula;

use super::{ForceElement, Forces, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{PointRef, Requirement, Sensor};
use crate::multibody::BuildError;

/// p, absolute.
const PRESSURE: Sensor = Sensor::of_motion("pressure");

const ABOVE_ONE: Requirement = Requirement {
    holds: |value| value > 1.0,
    message: "must be above 1 (leave it out for gas at a constant temperature)",
};

/// Gas behind a piston.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "gas_spring",
    what = "a gas spring",
    equation = "f = (p − p_a) A,  p = p₀ (V₀/V)ⁿ,  V = V₀ + A (ℓ − ℓ₀),  A = π/4 d²",
    source = "Poisson, Ann. Chim. Phys. 23 (1823) 337",
    example = "{ between: [arm.tip, cart.hook], diameter: 10 mm, length: 0.8, pressure: 60 bar, volume: 0.1 L, exponent: 1.3 }"
)]
pub struct GasSpring {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Diameter of the piston, or of a rod in a cylinder full of gas.
    #[quantity(unit = "m", constant, positive)]
    pub diameter: Formula,
    /// Distance of the points for which pressure and volume hold.
    #[quantity(unit = "m", constant, positive)]
    pub length: Formula,
    /// Pressure of the gas at that distance, absolute.
    #[quantity(unit = "Pa", constant, positive)]
    pub pressure: Formula,
    /// Volume of the gas at that distance.
    #[quantity(unit = "m^3", constant, positive)]
    pub volume: Formula,
    /// n, 1.4 for air without exchange of heat.
    #[quantity(unit = "1", constant, requires = ABOVE_ONE, otherwise = "1: its temperature is constant")]
    pub exponent: Option<Formula>,
    /// Pressure around it.
    #[quantity(unit = "Pa", constant, nonnegative, default = 101325)]
    pub ambient: Formula,
}

impl ForceElement for GasSpring {
    const GLYPH: Glyph = Glyph::Spring;
    const SENSORS: &'static [TypedSensor] = &[
        (Sensor::LENGTH, Dimension::LENGTH),
        (Sensor::RATE, Dimension::VELOCITY),
        (Sensor::FORCE, Dimension::FORCE),
        (Sensor::AXIAL, Dimension::FORCE),
        (PRESSURE, Dimension::PRESSURE),
    ];

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let [a, b] = self.between.map(|point| forces.point(point));
        let line = b.position - a.position;
        let length = line.norm();
        let direction = line / length;
        let rate = direction.dot(b.velocity - a.velocity);
        let diameter = forces.value(&self.diameter)?;
        let area = FRAC_PI_4 * (diameter * diameter);
        let (filled, volume) = (forces.value(&self.pressure)?, forces.value(&self.volume)?);
        let (free, ambient) = (forces.value(&self.length)?, forces.value(&self.ambient)?);
        let now = volume + area * (length - free);
        let ratio = volume / now;
        let (pressure, stored) = match &self.exponent {
            None => (filled * ratio, filled * volume * ratio.ln()),
            Some(exponent) => {
                let exponent = forces.value(exponent)?;
                let pressure = filled * ratio.pow(exponent);
                (pressure, pressure * now / (exponent - 1.0))
            }
        };
        let push = (pressure - ambient) * area;
        forces.between(&a, &b, push * direction);
        forces.potential(&[filled, volume, ambient, area, free], stored + ambient * area * length);
        forces.sensors([(Sensor::LENGTH, length), (Sensor::RATE, rate), (PRESSURE, pressure)]);
        forces.sensors([(Sensor::FORCE, push), (Sensor::AXIAL, -push)]);
        Ok(())
    }
}
