//! Dry friction at a speed of sliding: Coulomb's law with Stribeck's excess at rest, without its jump.
//!
//! ```text
//! F = −R u,   R = μ N s(|u|) / √(|u|² + u₀²),   s = 1 + (b − 1) exp(−(|u|/u_s)²)          N
//! ```
//!
//! u is the velocity of sliding, a number or a vector, N the load, b the breakaway ratio. The sign u/|u| of Coulomb's
//! law is u/√(|u|² + u₀²) (Oden & Martins, Comput. Methods Appl. Mech. Eng. 52 (1985) 527), which is smooth and falls
//! short of it by ½(u₀/u)²; s is that of Armstrong-Hélouvry, *Control of Machines with Friction* (1991). What sticks
//! creeps: under a part κ of the friction that it could bear at u₀ κ/√(1 − κ²).
//!
//! With another coefficient μ_e along a direction e, μ u becomes μ u + (μ_e − μ) (e · u) e: an ellipse of friction, of
//! which the force stands against u along its axes alone (Zmitrowicz, Int. J. Solids Struct. 25 (1989) 837).

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use crate::elements::effects::Forces;
use crate::grammar::{Checked, Direction, Fields, Reader, Requirement, SymbolTable};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

const AT_LEAST_SLIDING: Requirement = Requirement {
    holds: |value| value >= 1.0,
    message: "must be at least 1: friction at rest is not less than sliding",
};

/// Dry friction.
#[derive(Clone, Debug, Element)]
#[element(what = "`friction`")]
pub struct Friction {
    /// Over the force across the contact, while sliding.
    #[quantity(unit = "1", constant, nonnegative)]
    pub coefficient: Formula,
    /// How it depends on the speed.
    #[group]
    pub speed: DryFriction,
}

/// Another coefficient of friction along a direction.
#[derive(Clone, Debug, Element)]
#[element(what = "`friction_along`")]
pub struct FrictionAlong {
    /// Direction along the surface, in the first point's frame.
    pub direction: Direction,
    /// Over the force across the contact, while sliding along that direction; `friction` holds across it.
    #[quantity(unit = "1", constant, nonnegative)]
    pub coefficient: Formula,
}

/// How dry friction depends on the speed of sliding.
#[derive(Clone, Debug, Element)]
#[element(checked)]
pub struct DryFriction {
    /// Dry friction at rest over that while sliding.
    #[quantity(unit = "1", constant, requires = AT_LEAST_SLIDING, default = 1)]
    pub breakaway: Formula,
    /// Speed at which the excess at rest has fallen to 1/e.
    #[quantity(unit = "m/s or rad/s", constant, positive)]
    pub stribeck_velocity: Option<Formula>,
    /// Speed that counts as rest: friction is 71 % of itself there.
    #[quantity(unit = "m/s or rad/s", constant, positive, default = 1e-3)]
    pub transition_velocity: Formula,
}

impl Checked for DryFriction {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let given = ["stribeck_velocity", "breakaway"].map(|key| fields.get(key).is_some());
        let (key, message) = match given {
            [true, false] => (
                "stribeck_velocity",
                "`stribeck_velocity` goes with `breakaway`, the friction at rest over that while sliding",
            ),
            [false, true] => {
                ("breakaway", "`breakaway` needs `stribeck_velocity`, the speed at which its excess fades")
            }
            _ => return,
        };
        reader.error(Code::MissingKey, fields.key_span(key), message, None);
    }
}

impl Friction {
    /// The law's numbers.
    pub fn resistance<'g>(&self, forces: &dyn Forces<'g>) -> Result<Resistance<'g>, BuildError> {
        Resistance::of(forces, &self.coefficient, &self.speed)
    }
}

/// The law's numbers.
#[derive(Clone, Copy, Debug)]
pub struct Resistance<'g> {
    /// μ
    pub coefficient: Scalar<'g>,
    breakaway: Scalar<'g>,
    stribeck: Option<Scalar<'g>>,
    transition: Scalar<'g>,
}

impl<'g> Resistance<'g> {
    pub fn of(forces: &dyn Forces<'g>, coefficient: &Formula, law: &DryFriction) -> Result<Self, BuildError> {
        let stribeck = law.stribeck_velocity.as_ref().map(|speed| forces.value(speed)).transpose()?;
        Ok(Self {
            coefficient: forces.value(coefficient)?,
            breakaway: forces.value(&law.breakaway)?,
            stribeck,
            transition: forces.value(&law.transition_velocity)?,
        })
    }

    /// s/√(|u|² + u₀²): dry friction by its bound and the velocity of sliding; `square` is |u|².
    pub fn by_speed(&self, square: Scalar<'g>) -> Scalar<'g> {
        let smooth = (square + self.transition * self.transition).sqrt();
        let strength = match self.stribeck {
            Some(speed) => {
                let fading = (-(square / (speed * speed))).exp();
                1.0 + (self.breakaway - 1.0) * fading
            }
            None => square.builder().number(1.0),
        };
        strength / smooth
    }
}
