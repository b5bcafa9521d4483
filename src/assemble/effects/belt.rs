//! The forces of a belt: see `elements::effects::belt` for the equations.

use symdiff::{Builder, Expr};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::model::belt::Run;
use crate::model::{Belt, Coordinate, JointCoordinate, Referent, TimeOrder, Turning};

use super::Loads;
use super::positive_part::{PositivePart, clipped};

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, belt: &Belt) -> Result<(), BuildError> {
    let number = |formula| m.formula(g, formula, Context::Motion);
    let radius = [number(&belt.first_radius)?, number(&belt.second_radius)?];
    let (stiffness, damping) = (number(&belt.stiffness)?, number(&belt.damping)?);
    let (preload, corner) = (number(&belt.preload)?, number(&belt.transition)?);
    // −σ r₂
    let opposite = match belt.run {
        Run::Open => g.neg(radius[1]),
        Run::Crossed => radius[1],
    };
    let run = |order: TimeOrder| {
        let [first, second] = belt.between.map(|turning| turned(g, m, turning, order));
        g.add(g.mul(radius[0], first), g.mul(opposite, second))
    };
    let shift = g.sub(run(TimeOrder::Position), g.mul(opposite, number(&belt.offset)?));
    let rate = run(TimeOrder::Velocity);

    let mut parting = g.div(preload, stiffness);
    let mut parting_rate = g.constant(0.0);
    let mut line = None;
    if let (Some(centers), Some(distance)) = (belt.centers, &belt.distance) {
        let [a, b] = centers.map(|point| m.point(g, point));
        let offset = space::sub(g, b.position, a.position);
        let across = g.add(radius[0], opposite);
        let across = g.mul(across, across);
        let strand = g.sqrt(g.sub(space::dot(g, offset, offset), across));
        let distance = number(distance)?;
        let original = g.sqrt(g.sub(g.mul(distance, distance), across));
        parting = g.add(parting, g.sub(strand, original));
        // ∂L/∂r_B
        let direction = offset.map(|component| g.div(component, strand));
        parting_rate = space::dot(g, direction, space::sub(g, b.velocity, a.velocity));
        line = Some((a, b, direction));
    }
    let strand = |stretch: Expr, rate: Expr| {
        let taut = PositivePart::of(g, stretch, corner);
        let elastic = g.mul(stiffness, taut.value);
        let viscous = g.mul(g.mul(damping, taut.slope), rate);
        (clipped(g, g.add(elastic, viscous)), g.mul(stiffness, taut.integral))
    };
    let (first, first_energy) = strand(g.add(parting, shift), g.add(parting_rate, rate));
    let (second, second_energy) = strand(g.sub(parting, shift), g.sub(parting_rate, rate));

    let carried = g.sub(second, first);
    for (turning, arm) in belt.between.into_iter().zip([radius[0], opposite]) {
        add_torque(g, m, loads, turning, g.mul(arm, carried))?;
    }
    if let Some((a, b, direction)) = line {
        let pull = space::scale(g, g.add(first, second), direction);
        loads.add_force_pair(g, &b, &a, pull);
    }
    let coefficients = [stiffness, preload, corner, radius[0], radius[1]];
    loads.add_potential(g, m, &coefficients, g.add(first_energy, second_energy));
    loads.measure(Belt::FIRST_TENSION, first);
    loads.measure(Belt::SECOND_TENSION, second);
    Ok(())
}

/// An angle, or its rate.
fn turned(g: &Builder, m: &Mechanism, turning: Turning, order: TimeOrder) -> Expr {
    match turning {
        Turning::Body(body) => m.observe(g, Referent::Coordinate { body, coordinate: Coordinate::Angle, order }),
        Turning::Joint(joint) => m.joint_coordinate(g, joint, JointCoordinate::Angle, order),
    }
}

fn add_torque(g: &Builder, m: &Mechanism, loads: &mut Loads, on: Turning, torque: Expr) -> Result<(), BuildError> {
    match on {
        Turning::Body(body) => {
            let zero = g.constant(0.0);
            loads.add_torque_pair(g, 0, body, [zero, zero, torque]);
            Ok(())
        }
        Turning::Joint(joint) => loads.add_joint_torque(g, m, joint, torque),
    }
}
