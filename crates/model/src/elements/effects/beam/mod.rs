//! An element of a beam between two frames: Euler and Bernoulli's or Timoshenko's bending, with large rotations. In
//! space it is that of `spatial_beam`, in the plane
//!
//! ```text
//! d = r_B − r_A,   ℓ = |d|,   c = d/ℓ
//! φᵢ: angle from c to the beam's axis aᵢ at its end, fixed in that end's body
//! e = ℓ − L + L (2 φ₁² − φ₁ φ₂ + 2 φ₂²)/30     m
//! N = (EA/L) (e + τ ė)
//! M₁ = (EI/L) (4 φ₁ + 2 φ₂ + τ (4 φ̇₁ + 2 φ̇₂)) + N L (4 φ₁ − φ₂)/30          N m
//! M₂ = (EI/L) (2 φ₁ + 4 φ₂ + τ (2 φ̇₁ + 4 φ̇₂)) + N L (4 φ₂ − φ₁)/30
//! F_B = −N c + (M₁ + M₂)/ℓ c⊥,   F_A = −F_B,   −M₁ on the first body, −M₂ on the second
//! V = ½ (EA/L) e² + 2 (EI/L) (φ₁² + φ₁ φ₂ + φ₂²)          J
//! ```
//!
//! The element turns with its chord (Crisfield, *Non-linear Finite Element Analysis of Solids and Structures* 1 (1991),
//! ch. 7). Its cubic bends by small angles against that and is longer than the chord by ½ ∫ v'²: e is how much it is
//! stretched, on average, so bending does not stretch it, and tension stiffens it. L is its length, τ Kelvin and
//! Voigt's damping, φ between −π and π. With shear, 4 and 2 become (4 + Φ)/(1 + Φ) and (2 − Φ)/(1 + Φ) (Przemieniecki,
//! *Theory of Matrix Structural Analysis* (1968), ch. 5), and e has b ((φ₁ + φ₂)/2)² + L (φ₂ − φ₁)²/24 after ℓ − L,
//! with Φ and b as in space. A massless one is an effect; of those with mass (`flexible`) a flexible body is made.

mod spatial;

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use self::spatial::{SpatialBeam, bow_of_shear, shear_number};
use super::{ForceElement, Forces, LineMass, Section, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Direction, Fields, PointRef, Reader, Sensor, SymbolTable};
use crate::multibody::{BuildError, Vector};
use crate::syntax::codes::Code;

/// A massless beam that bends between two bodies, in space with `torsional_stiffness`.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "beam",
    what = "a beam",
    equation = "N = EA e/L, e = ℓ − L + L (2 φ₁² − φ₁ φ₂ + 2 φ₂²)/30, φ against the chord",
    equation = "M₁ = (EI/L) (4 φ₁ + 2 φ₂) + N L (4 φ₁ − φ₂)/30, M₂ = (EI/L) (2 φ₁ + 4 φ₂) + N L (4 φ₂ − φ₁)/30",
    equation = "with damping τ: of each number plus τ times its rate",
    equation = "in space V = ½ (EA/L) e² + ½ (k_y c_y² + k_z c_z²) + ½ (GJ ψ_x² + EI_y ψ_y² + EI_z ψ_z²)/L, k = 12 EI/(L (1 + Φ))",
    source = "Crisfield, Non-linear Finite Element Analysis of Solids and Structures 1 (1991), ch. 7",
    example = "{ between: [arm.tip, ball], length: 0.3, axial_stiffness: 1e6, bending_stiffness: 20 N*m^2, damping: 1e-4 }",
    checked
)]
pub struct Beam {
    /// Two points, each `body.point` or `body`; in space x of their frames is along the beam.
    pub between: [PointRef; 2],
    /// Direction of the straight beam in both bodies' frames, in the plane.
    #[key(default = Direction::along(0))]
    pub axis: Direction,
    /// Length without tension.
    #[quantity(unit = "m", constant, positive)]
    pub length: Formula,
    /// Axial stiffness EA.
    #[quantity(unit = "N")]
    pub axial_stiffness: Formula,
    /// Bending stiffness EI, about z.
    #[quantity(unit = "N*m^2")]
    pub bending_stiffness: Formula,
    /// Bending stiffness EI about y of the frames, in space; by default that about z.
    #[quantity(unit = "N*m^2")]
    pub bending_stiffness_y: Option<Formula>,
    /// Torsional stiffness GJ: the beam bends and twists in space.
    #[quantity(unit = "N*m^2")]
    #[key(image = Unknown)]
    pub torsional_stiffness: Option<Formula>,
    /// GA of shear, with the section's shear coefficient in it; by default the beam does not shear.
    #[quantity(unit = "N", positive)]
    pub shear_stiffness: Option<Formula>,
    /// Stiffness-proportional: force by rate over force by displacement.
    #[quantity(unit = "s", default = 0)]
    pub damping: Formula,
    /// The flexible body whose element it is; a file has such elements among its bodies.
    #[derived]
    pub flexible: Option<Flexible>,
}

/// Properties of a beam that is an element of a flexible body.
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
        (Sensor::AXIAL, Dimension::FORCE),
        (Sensor::TORQUE, Dimension::TORQUE),
        (Sensor::START_TORQUE, Dimension::TORQUE),
    ];

    fn inertia(&self) -> Option<LineMass<'_>> {
        let Flexible { body, mass_per_length } = self.flexible.as_ref()?;
        let section = self.torsional_stiffness.as_ref().map(|_| Section {
            axial_stiffness: &self.axial_stiffness,
            bending_stiffness: [
                self.bending_stiffness_y.as_ref().unwrap_or(&self.bending_stiffness),
                &self.bending_stiffness,
            ],
        });
        Some(LineMass { body, between: self.between, axis: &self.axis, length: &self.length, mass_per_length, section })
    }

    fn sensors(&self) -> Vec<TypedSensor> {
        let of_space = self.torsional_stiffness.as_ref().map(|_| OF_SPACE);
        Self::SENSORS.iter().copied().chain(of_space.into_iter().flatten()).collect()
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        if let Some(torsional) = &self.torsional_stiffness {
            return self.apply_in_space(torsional, forces);
        }
        let (free, damping) = (forces.value(&self.length)?, forces.value(&self.damping)?);
        let (axial, bending) = (forces.value(&self.axial_stiffness)?, forces.value(&self.bending_stiffness)?);
        let shears = self.shear_stiffness.as_ref().map(|shear| forces.value(shear)).transpose()?;
        let shear_number = shears.map(|shear| shear_number(bending, shear, free));
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
        let gradient = match shear_number {
            None => {
                let thirtieth = 1.0 / 30.0 * free;
                [(first, second), (second, first)].map(|(own, other)| thirtieth * (4.0 * own.angle - other.angle))
            }
            Some(number) => {
                let slope = 0.5 * bow_of_shear(number) * (first.angle + second.angle);
                let bend = 1.0 / 12.0 * (second.angle - first.angle);
                [free * (slope - bend), free * (slope + bend)]
            }
        };
        // A quadratic form is half of its gradient times its argument.
        let bow = 0.5 * sum_of_products(gradient, [first.angle, second.angle]);
        let stretch = length - free + bow;
        let stretching = rate + sum_of_products(gradient, [first.rate, second.rate]);
        let tension = axial * (stretch + damping * stretching);
        let felt = [first, second].map(|end| end.angle + damping * end.rate);
        let bending_moments = |of: [Scalar<'g>; 2]| match shear_number {
            None => [[4.0, 2.0], [2.0, 4.0]].map(|row| bending * (row[0] * of[0] + row[1] * of[1])),
            Some(number) => {
                let [own, other] = [4.0 + number, 2.0 - number].map(|part| bending / (1.0 + number) * part);
                [own * of[0] + other * of[1], other * of[0] + own * of[1]]
            }
        };
        let mut moments = bending_moments(felt);
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
        let angles = [first.angle, second.angle];
        let bent = match shears {
            None => {
                let both = first.angle + second.angle;
                let (whole, mixed) = (both * both, first.angle * second.angle);
                2.0 * (bending * (whole - mixed))
            }
            Some(_) => 0.5 * sum_of_products(bending_moments(angles), angles),
        };
        let given: Vec<_> = [axial, bending, free].into_iter().chain(shears).collect();
        forces.potential(&given, stretched + bent);
        let at_start = -moments[0];
        forces.sensors([
            (Sensor::LENGTH, length),
            (Sensor::FORCE, tension),
            (Sensor::AXIAL, tension),
            (Sensor::TORQUE, moments[1]),
            (Sensor::START_TORQUE, at_start),
        ]);
        Ok(())
    }
}

/// The bending moment about y, of the frame at the end and of that at the start.
const TORQUE_Y: Sensor = Sensor::of_force("torque_y");
const START_TORQUE_Y: Sensor = Sensor::of_force("start_torque_y");
/// The moment about x at the end.
const TORSION: Sensor = Sensor::of_force("torsion");
/// Further sensors in space.
const OF_SPACE: [TypedSensor; 3] =
    [(TORQUE_Y, Dimension::TORQUE), (START_TORQUE_Y, Dimension::TORQUE), (TORSION, Dimension::TORQUE)];

/// The rotation of an end against the chord.
#[derive(Clone, Copy)]
struct End<'g> {
    /// φ, rad
    angle: Scalar<'g>,
    /// φ̇, rad/s
    rate: Scalar<'g>,
}

impl Beam {
    fn apply_in_space<'g>(&self, torsional: &Formula, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let about_z = forces.value(&self.bending_stiffness)?;
        let about_y = self.bending_stiffness_y.as_ref().map(|about_y| forces.value(about_y)).transpose()?;
        let element = SpatialBeam {
            length: forces.value(&self.length)?,
            axial: forces.value(&self.axial_stiffness)?,
            torsional: forces.value(torsional)?,
            bending: [about_y.unwrap_or(about_z), about_z],
            shear: self.shear_stiffness.as_ref().map(|shear| forces.value(shear)).transpose()?,
            damping: forces.value(&self.damping)?,
        };
        let measured = element.apply(forces, self.between);
        let [start, end] = measured.moments;
        forces.sensors([
            (Sensor::LENGTH, measured.length),
            (Sensor::FORCE, measured.tension),
            (Sensor::AXIAL, measured.tension),
            (Sensor::TORQUE, end[2]),
            (Sensor::START_TORQUE, start[2]),
            (TORQUE_Y, end[1]),
            (START_TORQUE_Y, start[1]),
            (TORSION, end[0]),
        ]);
        Ok(())
    }

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
        let at = |key: &str| fields.get(key).map(|node| node.span.clone());
        let free = self.between.iter().find(|end| reader.model.has_orientation(end.body));
        if self.torsional_stiffness.is_some() {
            if let Some(span) = at("axis") {
                let help = "give the points frames whose x is along the beam".to_owned();
                reader.error(Code::NotPlanar, span, "in space a beam lies along x of the frames at its ends", help);
            }
            return;
        }
        if let (Some(end), Some(span)) = (free, at("between")) {
            let message = format!("`{}` turns about more than z", reader.model.body_name(end.body));
            reader.error(Code::NotPlanar, span, message, NEEDS_TORSION.to_owned());
        } else if let Some(span) = at("bending_stiffness_y") {
            reader.error(Code::NotPlanar, span, "in the plane a beam bends about z alone", NEEDS_TORSION.to_owned());
        }
    }
}

/// Message for a beam in space without `torsional_stiffness`.
const NEEDS_TORSION: &str = "in space a beam has a `torsional_stiffness`";
