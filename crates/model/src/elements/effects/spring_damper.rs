//! Spring and damper between two points A and B; d = r_B − r_A.
//!
//! ```text
//! along the connecting line:    f = k (ℓ − ℓ₀) + c ℓ̇,     ℓ = |d|,     V = ½ k (ℓ − ℓ₀)²          N, J
//!                               F_B = −f d/ℓ = −[k (1 − ℓ₀/ℓ) + c (d · ḋ)/ℓ²] d,                 F_A = −F_B
//! along an axis e, |e| = 1:     f = k (s − ℓ₀) + c ṡ,     s = e · d,   V = ½ k (s − ℓ₀)²
//!                               F_B = −f e,                                                      F_A = −F_B
//! ```
//!
//! f > 0 is tension: it pulls the points together. e is fixed in the ground's frame; s and ℓ₀ have a sign along it, and
//! where d is not parallel to e the pair of forces is also a couple d × F, as in a guide. The line has no direction at
//! ℓ = 0: the force is NaN there, unless ℓ₀ = 0. Then the elastic force is −k d, and the damper's is −c ḋ where the
//! points meet, which is its limit on every straight way through: ḋ is d's direction there. A zero stiffness or damping
//! adds no term. A further tension is a formula of the spring's own length ℓ (or s) and rate, and of the other
//! quantities that a formula may depend on. With one, or where k or ℓ₀ depend on the motion, there is no potential and
//! none is counted.

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use super::{ForceElement, Forces, TypedSensor};
use crate::elements::Glyph;
use crate::elements::tuning::TUNING;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Direction, Fields, PointRef, Reader, Sensor, SymbolTable};
use crate::multibody::{BuildError, Vector};
use crate::syntax::codes::Code;

/// A spring and damper between two points.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "spring_damper",
    what = "`spring_damper`",
    equation = "f = k (ℓ − ℓ₀) + c ℓ̇ + force(ℓ, ℓ̇), pulls the points together",
    source = "Hooke; Kelvin and Voigt",
    example = "{ between: [arm.tip, ball], stiffness: 500, damping: 4, free_length: 1 }",
    checked
)]
pub struct SpringDamper {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Direction in the ground's frame.
    #[key(otherwise = "the line between the points")]
    #[key(in_ground)]
    pub along: Option<Direction>,
    /// Tension by stretch.
    #[quantity(unit = "N/m", default = 0)]
    pub stiffness: Formula,
    /// Tension by rate of stretch.
    #[quantity(unit = "N*s/m", default = 0)]
    pub damping: Formula,
    /// Length without tension.
    #[quantity(unit = "m", default = 0)]
    pub free_length: Formula,
    /// Further tension; may depend on the spring's own `NAME.length` and `NAME.rate`.
    #[quantity(unit = "N")]
    pub force: Option<Formula>,
}

impl ForceElement for SpringDamper {
    const GLYPH: Glyph = Glyph::Spring;
    const SENSORS: &'static [TypedSensor] = &[
        (Sensor::LENGTH, Dimension::LENGTH),
        (Sensor::RATE, Dimension::VELOCITY),
        (Sensor::FORCE, Dimension::FORCE),
        (Sensor::AXIAL, Dimension::FORCE),
    ];

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let spring = Coefficients {
            stiffness: forces.value(&self.stiffness)?,
            damping: forces.value(&self.damping)?,
            free_length: forces.value(&self.free_length)?,
        };
        let [a, b] = self.between.map(|point| forces.point(point));
        let axis = self.along.as_ref().map(|axis| forces.vector(axis)).transpose()?;
        let (line, growth) = (b.position - a.position, b.velocity - a.velocity);
        let Stretched { mut pull, direction, length, rate, mut tension } = match axis {
            Some(axis) => along_axis(line, growth, axis, spring),
            None => along_line(line, growth, spring),
        };
        if let Some(further) = &self.force {
            let further = forces.value_with(further, &[(Sensor::LENGTH, length), (Sensor::RATE, rate)])?;
            pull += further * direction;
            tension += further;
        }
        // The tension pulls A towards B.
        forces.between(&b, &a, pull);
        let stretch = length - spring.free_length;
        let potential = 0.5 * (spring.stiffness * (stretch * stretch));
        if self.force.is_none() {
            forces.potential(&[spring.stiffness, spring.free_length], potential);
        }
        forces.sensors([
            (Sensor::LENGTH, length),
            (Sensor::RATE, rate),
            (Sensor::FORCE, tension),
            (Sensor::AXIAL, tension),
        ]);
        Ok(())
    }
}

/// The numbers of a spring and damper.
#[derive(Clone, Copy)]
struct Coefficients<'g> {
    /// k, N/m
    stiffness: Scalar<'g>,
    /// c, N s/m
    damping: Scalar<'g>,
    /// ℓ₀, m
    free_length: Scalar<'g>,
}

/// A spring with its length, rate and force.
struct Stretched<'g> {
    /// F_A
    pull: Vector<'g>,
    /// Direction of F_A under tension.
    direction: Vector<'g>,
    /// ℓ or s
    length: Scalar<'g>,
    /// ℓ̇ or ṡ
    rate: Scalar<'g>,
    /// f
    tension: Scalar<'g>,
}

/// A spring along the connecting line, by d and ḋ.
fn along_line<'g>(line: Vector<'g>, growth: Vector<'g>, spring: Coefficients<'g>) -> Stretched<'g> {
    let passes_zero = spring.free_length.is_zero();
    let mut square = line.dot(line);
    if passes_zero {
        square += square.builder().number(TUNING.coincident_points * TUNING.coincident_points);
    }
    let length = square.sqrt();
    let elastic = spring.stiffness * (1.0 - spring.free_length / length);
    let advance = line.dot(growth);
    let density = elastic + spring.damping * (advance / square);
    let (mut pull, direction) = (density * line, line / length);
    if passes_zero {
        pull += (spring.damping * (TUNING.coincident_points * TUNING.coincident_points / square)) * growth;
    }
    Stretched { pull, direction, length, rate: advance / length, tension: density * length }
}

/// A spring along an axis, by d and ḋ.
fn along_axis<'g>(line: Vector<'g>, growth: Vector<'g>, axis: Vector<'g>, spring: Coefficients<'g>) -> Stretched<'g> {
    let direction = axis.unit();
    let (length, rate) = (direction.dot(line), direction.dot(growth));
    let tension = spring.stiffness * (length - spring.free_length) + spring.damping * rate;
    Stretched { pull: tension * direction, direction, length, rate, tension }
}

impl Checked for SpringDamper {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        if fields.lacks_all(&["stiffness", "damping", "force"]) {
            reader.error(
                Code::IncompleteElement,
                fields.at.clone(),
                "a spring and damper needs `stiffness` or `damping`",
                None,
            );
        }
    }
}
