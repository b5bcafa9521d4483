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
//! ℓ = 0: the force is not a number there, unless ℓ₀ = 0 and c = 0. A zero stiffness or damping leaves nothing behind.
//! A further tension is a formula of the spring's own length ℓ (or s) and rate, and of what else a formula may speak of.
//! With one, or where k or ℓ₀ depend on the motion, there is no potential and none is counted.

use symdiff::{Builder, Expr, Formula};

use crate::assemble::body::MaterialPoint;
use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space::{self, Vector};
use crate::model::{Measure, PointRef};

use super::Loads;

/// Its numbers.
#[derive(Clone, Copy)]
pub struct Spring<T> {
    /// k, N/m
    pub stiffness: T,
    /// c, N s/m
    pub damping: T,
    /// ℓ₀, m
    pub free_length: T,
}

pub fn apply(
    g: &Builder,
    m: &Mechanism,
    loads: &mut Loads,
    between: [PointRef; 2],
    along: Option<&[Formula; 3]>,
    spring: Spring<&Formula>,
    further: Option<&Formula>,
) -> Result<(), BuildError> {
    let spring = Spring {
        stiffness: m.formula(g, spring.stiffness, Context::Motion)?,
        damping: m.formula(g, spring.damping, Context::Motion)?,
        free_length: m.formula(g, spring.free_length, Context::Motion)?,
    };
    let [a, b] = between.map(|point| m.point(g, point));
    let Stretched { mut pull, direction, length, rate, tension } = match along {
        Some(axis) => {
            let axis = m.vector(g, axis, Context::Motion)?;
            along_axis(g, &a, &b, axis, spring)
        }
        None => along_line(g, &a, &b, spring),
    };
    let mut tension = tension;
    if let Some(further) = further {
        let further = m.own_formula(g, further, &[(Measure::Length, length), (Measure::Rate, rate)])?;
        let further_pull = space::scale(g, further, direction);
        pull = space::add(g, pull, further_pull);
        tension = g.add(tension, further);
    }
    // The tension pulls A towards B.
    loads.add_force_pair(g, &b, &a, pull);
    let stretch = g.sub(length, spring.free_length);
    let square = g.mul(stretch, stretch);
    let doubled = g.mul(spring.stiffness, square);
    let potential = g.scale(0.5, doubled);
    if further.is_none() {
        loads.add_potential(g, m, &[spring.stiffness, spring.free_length], potential);
    }
    for (measure, value) in [(Measure::Length, length), (Measure::Rate, rate), (Measure::Force, tension)] {
        loads.measure(measure, value);
    }
    Ok(())
}

/// A spring in its place.
struct Stretched {
    /// F_A
    pull: Vector,
    /// Of F_A under tension.
    direction: Vector,
    /// ℓ or s
    length: Expr,
    /// ℓ̇ or ṡ
    rate: Expr,
    /// f
    tension: Expr,
}

fn along_line(g: &Builder, a: &MaterialPoint, b: &MaterialPoint, spring: Spring<Expr>) -> Stretched {
    let line = space::sub(g, b.position, a.position);
    let rate = space::sub(g, b.velocity, a.velocity);
    let square = space::dot(g, line, line);
    let length = g.sqrt(square);
    let one = g.constant(1.0);
    let share = g.div(spring.free_length, length);
    let strain = g.sub(one, share);
    let elastic = g.mul(spring.stiffness, strain);
    let growth = space::dot(g, line, rate);
    let relative = g.div(growth, square);
    let viscous = g.mul(spring.damping, relative);
    let density = g.add(elastic, viscous);
    let pull = space::scale(g, density, line);
    let direction = line.map(|component| g.div(component, length));
    Stretched { pull, direction, length, rate: g.div(growth, length), tension: g.mul(density, length) }
}

fn along_axis(g: &Builder, a: &MaterialPoint, b: &MaterialPoint, axis: Vector, spring: Spring<Expr>) -> Stretched {
    let axis = space::unit(g, axis);
    let line = space::sub(g, b.position, a.position);
    let rate = space::sub(g, b.velocity, a.velocity);
    let (extent, growth) = (space::dot(g, axis, line), space::dot(g, axis, rate));
    let stretch = g.sub(extent, spring.free_length);
    let elastic = g.mul(spring.stiffness, stretch);
    let viscous = g.mul(spring.damping, growth);
    let tension = g.add(elastic, viscous);
    Stretched { pull: space::scale(g, tension, axis), direction: axis, length: extent, rate: growth, tension }
}
