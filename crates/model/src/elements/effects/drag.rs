//! Resistance of a fluid at a point of a body.
//!
//! ```text
//! F = −(b + k |u|) u,   u = ṙ − wind,   k = ½ ρ c_d A          N
//! ```
//!
//! |u| is √(u² + ε²), ε = 1 µm/s: the square law has no second derivative at rest. It has no potential.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ForceElement, Forces, TypedSensor};
use crate::elements::tuning::TUNING;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Components, Fields, PointRef, Reader, Sensor, SymbolTable};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

/// Resistance of a fluid.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "drag",
    what = "a drag",
    equation = "F = −(b + ½ ρ c_d A |u|) u, u = ṙ − wind",
    source = "Rayleigh, Phil. Mag. 2 (1876) 430",
    example = "{ on: ball, density: 1.2 kg/m^3, drag_coefficient: 0.47, area: 0.03 m^2, wind: [5, 0] }",
    checked
)]
pub struct Drag {
    /// Where it acts: `body.point` or `body`.
    on: PointRef,
    /// Force by the square of the speed; or `density`, `drag_coefficient` and `area`.
    #[quantity(unit = "N*s^2/m^2")]
    quadratic: Option<Formula>,
    /// Density of the fluid.
    #[quantity(unit = "kg/m^3")]
    density: Option<Formula>,
    /// c_d, a pure number.
    #[quantity(unit = "1")]
    drag_coefficient: Option<Formula>,
    /// Area that c_d refers to.
    #[quantity(unit = "m^2")]
    area: Option<Formula>,
    /// Force by the speed.
    #[quantity(unit = "N*s/m", default = 0)]
    linear: Formula,
    /// Velocity of the fluid in the ground's frame.
    #[quantity(unit = "m/s", default = 0)]
    #[key(in_ground)]
    wind: Components,
}

/// Keys that together give the force by the square of the speed.
const AERODYNAMIC: [&str; 3] = ["density", "drag_coefficient", "area"];

impl Drag {
    /// The factors of the force by the square of the speed.
    pub fn factors(&self) -> Vec<Formula> {
        let given: Vec<&Formula> = [&self.density, &self.drag_coefficient, &self.area].into_iter().flatten().collect();
        if given.is_empty() {
            return vec![self.quadratic.clone().unwrap_or_else(|| Formula::number(0.0))];
        }
        [Formula::number(0.5)].into_iter().chain(given.into_iter().cloned()).collect()
    }
}

impl ForceElement for Drag {
    const RESISTS: bool = true;
    const SENSORS: &'static [TypedSensor] = &[(Sensor::FORCE, Dimension::FORCE)];

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let point = forces.point(self.on);
        let wind = forces.vector(&self.wind)?;
        let linear = forces.value(&self.linear)?;
        let mut quadratic = forces.graph().number(1.0);
        for factor in &self.factors() {
            quadratic *= forces.value(factor)?;
        }
        let u = point.velocity - wind;
        let speed = (u.dot(u) + TUNING.drag_at_rest * TUNING.drag_at_rest).sqrt();
        let resistance = linear + quadratic * speed;
        forces.at(&point, -resistance * u);
        forces.sensor(Sensor::FORCE, resistance * speed);
        Ok(())
    }
}

impl Checked for Drag {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let given = |key: &str| fields.get(key).is_some();
        if AERODYNAMIC.into_iter().any(given) {
            if given("quadratic") {
                let message = "`quadratic` excludes `density`, `drag_coefficient` and `area`";
                reader.error(Code::OutOfRange, fields.key_span("quadratic"), message, None);
            }
            for key in AERODYNAMIC {
                reader.required(fields, key);
            }
        } else if fields.lacks_all(&["quadratic", "linear"]) {
            let help = "or `density`, `drag_coefficient` and `area`".to_owned();
            reader.error(Code::IncompleteElement, fields.at.clone(), "a drag needs `quadratic` or `linear`", help);
        }
    }
}
