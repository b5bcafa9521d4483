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

use symdiff::{Binary, Builder, Expr, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space::{self, Vector};
use crate::model::{Beam, Measure, PointRef};

use super::Loads;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, beam: &Beam) -> Result<(), BuildError> {
    let number = |g: &Builder, formula| m.formula(g, formula, Context::Motion);
    let (free, damping) = (number(g, &beam.length)?, number(g, &beam.damping)?);
    let (axial, bending) = (number(g, &beam.axial_stiffness)?, number(g, &beam.bending_stiffness)?);
    let (axial, bending) = (g.div(axial, free), g.div(bending, free));
    let [a, b] = beam.between.map(|point| m.point(g, point));
    let line = space::sub(g, b.position, a.position);
    let growth = space::sub(g, b.velocity, a.velocity);
    let length = space::norm(g, line);
    let chord = line.map(|component| g.div(component, length));
    let across = space::perpendicular(g, chord);
    let rate = space::dot(g, chord, growth);
    let turning = space::dot(g, across, growth);
    let turning = g.div(turning, length);

    let ends = beam.between.map(|point| bent(g, m, point, &beam.axis, line, turning));
    let [first, second] = ends;
    let [first, second] = [first?, second?];
    // ∂e/∂φ₁, ∂e/∂φ₂
    let thirtieth = g.scale(1.0 / 30.0, free);
    let slopes = [(first, second), (second, first)].map(|((own, _), (other, _))| {
        let own = g.scale(4.0, own);
        let difference = g.sub(own, other);
        g.mul(thirtieth, difference)
    });
    // A form of second degree is half of its slopes times what it is of.
    let bow = g.dot(&slopes, &[first.0, second.0]);
    let bow = g.scale(0.5, bow);
    let straight = g.sub(length, free);
    let stretch = g.add(straight, bow);
    let bowing = g.dot(&slopes, &[first.1, second.1]);
    let stretching = g.add(rate, bowing);
    let felt = delayed(g, damping, stretch, stretching);
    let tension = g.mul(axial, felt);
    let felt = [first, second].map(|(angle, rate)| delayed(g, damping, angle, rate));
    let mut moments = [[4.0, 2.0], [2.0, 4.0]].map(|row| {
        let (near, far) = (g.scale(row[0], felt[0]), g.scale(row[1], felt[1]));
        let sum = g.add(near, far);
        g.mul(bending, sum)
    });
    for (moment, slope) in moments.iter_mut().zip(slopes) {
        let stiffening = g.mul(tension, slope);
        *moment = g.add(*moment, stiffening);
    }

    let total = g.add(moments[0], moments[1]);
    let shear = g.div(total, length);
    let (pull, lift) = (space::scale(g, tension, chord), space::scale(g, shear, across));
    let force = space::sub(g, lift, pull);
    loads.add_force_pair(g, &a, &b, force);
    let zero = g.constant(0.0);
    for (point, moment) in beam.between.into_iter().zip(moments) {
        let back = g.neg(moment);
        loads.add_torque_pair(g, 0, point.body, [zero, zero, back]);
    }

    let square = g.mul(stretch, stretch);
    let stretched = g.mul(axial, square);
    let stretched = g.scale(0.5, stretched);
    let both = g.add(first.0, second.0);
    let (whole, mixed) = (g.mul(both, both), g.mul(first.0, second.0));
    let sum = g.sub(whole, mixed);
    let bent = g.mul(bending, sum);
    let bent = g.scale(2.0, bent);
    let potential = g.add(stretched, bent);
    loads.add_potential(g, m, &[axial, bending, free], potential);
    let at_start = g.neg(moments[0]);
    let torques = [(Measure::TORQUE, moments[1]), (Measure::START_TORQUE, at_start)];
    for (measure, value) in [(Measure::LENGTH, length), (Measure::FORCE, tension)].into_iter().chain(torques) {
        loads.measure(measure, value);
    }
    Ok(())
}

/// x + τ ẋ
fn delayed(g: &Builder, damping: Expr, value: Expr, rate: Expr) -> Expr {
    let viscous = g.mul(damping, rate);
    g.add(value, viscous)
}

/// φ and φ̇ of an end, the chord turning by `turning`.
fn bent(
    g: &Builder,
    m: &Mechanism,
    end: PointRef,
    axis: &[Formula; 3],
    line: Vector,
    turning: Expr,
) -> Result<(Expr, Expr), BuildError> {
    let body = &m.bodies[end.body];
    let axis = m.vector(g, axis, Context::Time)?;
    let axis = body.rotate(g, axis);
    let (along, beside) = (space::dot(g, line, axis), space::cross(g, line, axis)[2]);
    let angle = g.binary(Binary::Atan2, beside, along);
    let spin = body.angular_velocity(g)[2];
    Ok((angle, g.sub(spin, turning)))
}
