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
use symdiff::{Formula, Scalar};

use super::{ForceElement, Forces, LineMass, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Direction, Fields, Sensor, PointRef, Reader, SymbolTable};
use crate::multibody::{BuildError, Vector};

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
    const GLYPH: Glyph = Glyph::Beam;
    const SENSORS: &'static [TypedSensor] = &[
        (Sensor::LENGTH, Dimension::LENGTH),
        (Sensor::FORCE, Dimension::FORCE),
        (Sensor::TORQUE, Dimension::TORQUE),
        (Sensor::START_TORQUE, Dimension::TORQUE),
    ];

    fn inertia(&self) -> Option<LineMass<'_>> {
        let Flexible { body, mass_per_length } = self.flexible.as_ref()?;
        Some(LineMass { body, between: self.between, axis: &self.axis, length: &self.length, mass_per_length })
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let (free, damping) = (forces.value(&self.length)?, forces.value(&self.damping)?);
        let (axial, bending) = (forces.value(&self.axial_stiffness)?, forces.value(&self.bending_stiffness)?);
        let (axial, bending) = (axial / free, bending / free);
        let [a, b] = self.between.map(|point| forces.point(point));
        let (line, growth) = (b.position - a.position, b.velocity - a.velocity);
        let length = line.norm();
        let chord = line / length;
        let across = chord.perpendicular();
        let rate = chord.dot(growth);
        let turn_rate = across.dot(growth) / length;

        let ends = self.between.map(|end| self.bent(forces, end, line, turn_rate));
        let [first, second] = ends;
        let [first, second] = [first?, second?];
        // ∂e/∂φ₁, ∂e/∂φ₂
        let thirtieth = 1.0 / 30.0 * free;
        let gradient = [(first, second), (second, first)].map(|(own, other)| thirtieth * (4.0 * own.angle - other.angle));
        // A form of second degree is half of its gradient times what it is of.
        let bow = 0.5 * sum_of_products(gradient, [first.angle, second.angle]);
        let stretch = length - free + bow;
        let stretching = rate + sum_of_products(gradient, [first.rate, second.rate]);
        let tension = axial * (stretch + damping * stretching);
        let felt = [first, second].map(|end| end.angle + damping * end.rate);
        let mut moments = [[4.0, 2.0], [2.0, 4.0]].map(|row| bending * (row[0] * felt[0] + row[1] * felt[1]));
        for (moment, derivative) in moments.iter_mut().zip(gradient) {
            *moment += tension * derivative;
        }

        let shear = (moments[0] + moments[1]) / length;
        let (pull, lift) = (tension * chord, shear * across);
        forces.between(&a, &b, lift - pull);
        let zero = forces.graph().number(0.0);
        for (point, moment) in self.between.into_iter().zip(moments) {
            forces.torque(0, point.body, [zero, zero, -moment].into());
        }

        let stretched = 0.5 * (axial * (stretch * stretch));
        let both = first.angle + second.angle;
        let (whole, mixed) = (both * both, first.angle * second.angle);
        let bent = 2.0 * (bending * (whole - mixed));
        forces.potential(&[axial, bending, free], stretched + bent);
        let at_start = -moments[0];
        forces.sensors([
            (Sensor::LENGTH, length),
            (Sensor::FORCE, tension),
            (Sensor::TORQUE, moments[1]),
            (Sensor::START_TORQUE, at_start),
        ]);
        Ok(())
    }
}

/// The rotation of an end against the chord.
#[derive(Clone, Copy)]
struct End<'g> {
    /// φ, rad
    angle: Scalar<'g>,
    /// φ̇, rad/s
    rate: Scalar<'g>,
}

impl Beam {
    /// An end against the chord, which turns at a rate.
    fn bent<'g>(
        &self,
        forces: &dyn Forces<'g>,
        end: PointRef,
        line: Vector<'g>,
        turn_rate: Scalar<'g>,
    ) -> Result<End<'g>, BuildError> {
        let axis = forces.rotated(end.body, forces.prescribed_vector(&self.axis)?);
        let (along, beside) = (line.dot(axis), line.cross(axis)[2]);
        let angle = beside.atan2(along);
        Ok(End { angle, rate: forces.angular_velocity(end.body)[2] - turn_rate })
    }
}

/// a₁ b₁ + a₂ b₂
fn sum_of_products<'g>(a: [Scalar<'g>; 2], b: [Scalar<'g>; 2]) -> Scalar<'g> {
    a[0] * b[0] + a[1] * b[1]
}

impl Checked for Beam {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let free = self.between.iter().find(|end| reader.model.has_orientation(end.body));
        if let (Some(end), Some(node)) = (free, fields.get("between")) {
            let message = format!("`{}` turns about more than z", reader.model.body_name(end.body));
            let help = "a beam bends in the plane: use a `bushing` in space".to_owned();
            reader.error(node.span.clone(), message, help);
        }
    }
}
