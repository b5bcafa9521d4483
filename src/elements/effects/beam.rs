//! An element of a beam in the plane between two frames: Euler and Bernoulli's bending, with large rotations.
//!
//! ```text
//! d = r_B − r_A,   ℓ = |d|,   c = d/ℓ          φᵢ: angle from c to the beam's axis aᵢ at its end, fixed in that end's body
//! e = ℓ − L + L (2 φ₁² − φ₁ φ₂ + 2 φ₂²)/30     m
//! N = (EA/L) (e + τ ė)
//! M₁ = (EI/L) (4 φ₁ + 2 φ₂ + τ (4 φ̇₁ + 2 φ̇₂)) + N L (4 φ₁ − φ₂)/30          N m
//! M₂ = (EI/L) (2 φ₁ + 4 φ₂ + τ (2 φ̇₁ + 4 φ̇₂)) + N L (4 φ₂ − φ₁)/30
//! F_B = −N c + (M₁ + M₂)/ℓ c⊥,   F_A = −F_B,   −M₁ on the first body, −M₂ on the second
//! V = ½ (EA/L) e² + 2 (EI/L) (φ₁² + φ₁ φ₂ + φ₂²)          J
//! ```
//!
//! The element turns with its chord (Crisfield, *Non-linear Finite Element Analysis of Solids and Structures* 1 (1991), ch. 7). Its
//! cubic bends by small angles against that and is longer than the chord by ½ ∫ v'²: e is how much it is stretched, on
//! average, so bending does not stretch it, and tension stiffens it. L is its length, τ Kelvin and Voigt's damping, φ between −π
//! and π. A massless one is an effect; of those with mass (`flexible`) a flexible body is made.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ForceElement, LineMass, Sensor};
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Direction, Fields, Measure, PointRef, Reader, SymbolTable};

/// A massless beam of the plane that bends between two bodies.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "beam",
    what = "a beam",
    equation = "N = EA e/L, e = ℓ − L + L (2 φ₁² − φ₁ φ₂ + 2 φ₂²)/30, φ against the chord",
    equation = "M₁ = (EI/L) (4 φ₁ + 2 φ₂) + N L (4 φ₁ − φ₂)/30, M₂ = (EI/L) (2 φ₁ + 4 φ₂) + N L (4 φ₂ − φ₁)/30",
    equation = "with damping τ: of each number plus τ times its rate",
    source = "Crisfield, Non-linear Finite Element Analysis of Solids and Structures 1 (1991), ch. 7",
    example = "{ between: [arm.tip, ball], length: 0.3, axial_stiffness: 1e6, bending_stiffness: 20 N*m^2, damping: 1e-4 }",
    checked
)]
pub struct Beam {
    /// Two points, each `body.point` or `body`, of bodies that turn about z only.
    pub between: [PointRef; 2],
    /// Direction of the straight beam in both bodies' frames.
    #[key(default = Direction::along(0))]
    pub axis: Direction,
    /// Without tension.
    #[quantity(unit = "m", constant, positive)]
    pub length: Formula,
    /// EA.
    #[quantity(unit = "N")]
    pub axial_stiffness: Formula,
    /// EI.
    #[quantity(unit = "N*m^2")]
    pub bending_stiffness: Formula,
    /// Stiffness-proportional: force by rate over force by displacement.
    #[quantity(unit = "s", default = 0)]
    pub damping: Formula,
    /// The flexible body whose element it is; a file has such elements among its bodies.
    #[derived]
    pub flexible: Option<Flexible>,
}

/// What makes a beam an element of a flexible body.
#[derive(Clone, Debug)]
pub struct Flexible {
    /// The name of the body.
    pub body: String,
    /// kg/m. The bodies at the ends need no mass of their own.
    pub mass_per_length: Formula,
}

impl Flexible {
    /// Every formula in it.
    fn formulas(&self) -> [&Formula; 1] {
        [&self.mass_per_length]
    }
}

impl ForceElement for Beam {
    const SENSORS: &'static [Sensor] = &[
        (Measure::LENGTH, Dimension::LENGTH),
        (Measure::FORCE, Dimension::FORCE),
        (Measure::TORQUE, Dimension::TORQUE),
        (Measure::START_TORQUE, Dimension::TORQUE),
    ];

    fn inertia(&self) -> Option<LineMass<'_>> {
        let Flexible { body, mass_per_length } = self.flexible.as_ref()?;
        Some(LineMass { body, between: self.between, axis: &self.axis, length: &self.length, mass_per_length })
    }
}

impl Checked for Beam {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let turning = self.between.iter().find(|end| reader.model.has_orientation(end.body));
        if let (Some(end), Some(node)) = (turning, fields.get("between")) {
            let message = format!("`{}` turns about more than z", reader.model.body_name(end.body));
            let help = "a beam bends in the plane: use a `bushing` in space".to_owned();
            reader.error(node.span.clone(), message, help);
        }
    }
}
