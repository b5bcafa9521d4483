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
//! ℓ = 0: the force is NaN there, unless ℓ₀ = 0 and c = 0. A zero stiffness or damping leaves nothing behind.
//! A further tension is a formula of the spring's own length ℓ (or s) and rate, and whatever else a formula may refer to.
//! With one, or where k or ℓ₀ depend on the motion, there is no potential and none is counted.

use symdiff::{Builder, Scalar};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::{Measure, SpringDamper};
use crate::multibody::Vector;

use super::Loads;

/// Its numbers.
#[derive(Clone, Copy)]
struct Spring<'g> {
    /// k, N/m
    stiffness: Scalar<'g>,
    /// c, N s/m
    damping: Scalar<'g>,
    /// ℓ₀, m
    free_length: Scalar<'g>,
}

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, effect: &SpringDamper) -> Result<(), BuildError> {
    let spring = Spring {
        stiffness: m.value(g, &effect.stiffness)?,
        damping: m.value(g, &effect.damping)?,
        free_length: m.value(g, &effect.free_length)?,
    };
    let [a, b] = effect.between.map(|point| m.point(g, point));
    let axis = effect.along.as_ref().map(|axis| m.vector(g, axis, Context::Motion)).transpose()?;
    let line = Vector::of(g, b.position) - Vector::of(g, a.position);
    let growth = Vector::of(g, b.velocity) - Vector::of(g, a.velocity);
    let Stretched { mut pull, direction, length, rate, mut tension } = match axis {
        Some(axis) => along_axis(line, growth, Vector::of(g, axis), spring),
        None => along_line(line, growth, spring),
    };
    if let Some(further) = &effect.force {
        let own = [(Measure::LENGTH, length.expr()), (Measure::RATE, rate.expr())];
        let further = g.scalar(m.own_formula(g, further, &own)?);
        pull += further * direction;
        tension += further;
    }
    // The tension pulls A towards B.
    loads.add_force_pair(g, &b, &a, pull.exprs());
    let stretch = length - spring.free_length;
    let potential = 0.5 * (spring.stiffness * (stretch * stretch));
    if effect.force.is_none() {
        loads.add_potential(g, m, &[spring.stiffness.expr(), spring.free_length.expr()], potential.expr());
    }
    for (measure, value) in [(Measure::LENGTH, length), (Measure::RATE, rate), (Measure::FORCE, tension)] {
        loads.measure(measure, value.expr());
    }
    Ok(())
}

/// A spring in its place.
struct Stretched<'g> {
    /// F_A
    pull: Vector<'g>,
    /// Of F_A under tension.
    direction: Vector<'g>,
    /// ℓ or s
    length: Scalar<'g>,
    /// ℓ̇ or ṡ
    rate: Scalar<'g>,
    /// f
    tension: Scalar<'g>,
}

/// By d and ḋ.
fn along_line<'g>(line: Vector<'g>, growth: Vector<'g>, spring: Spring<'g>) -> Stretched<'g> {
    let square = line.dot(line);
    let length = square.sqrt();
    let elastic = spring.stiffness * (1.0 - spring.free_length / length);
    let growth = line.dot(growth);
    let density = elastic + spring.damping * (growth / square);
    let (pull, direction) = (density * line, line / length);
    Stretched { pull, direction, length, rate: growth / length, tension: density * length }
}

/// By d and ḋ.
fn along_axis<'g>(line: Vector<'g>, growth: Vector<'g>, axis: Vector<'g>, spring: Spring<'g>) -> Stretched<'g> {
    let direction = axis.unit();
    let (length, rate) = (direction.dot(line), direction.dot(growth));
    let tension = spring.stiffness * (length - spring.free_length) + spring.damping * rate;
    Stretched { pull: tension * direction, direction, length, rate, tension }
}
