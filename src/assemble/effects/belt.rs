//! The forces of a belt: see `elements::effects::belt` for the equations.

use symdiff::{Builder, Expr, Scalar};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::belt::Run;
use crate::model::{Belt, Coordinate, JointCoordinate, OnJoint, Referent, TimeOrder, Turning};
use crate::multibody::Vector;

use super::Loads;
use super::positive_part::{PositivePart, clipped};

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, belt: &Belt) -> Result<(), BuildError> {
    let radius = [m.value(g, &belt.first_radius)?, m.value(g, &belt.second_radius)?];
    let (stiffness, damping) = (m.value(g, &belt.stiffness)?, m.value(g, &belt.damping)?);
    let (preload, corner) = (m.value(g, &belt.preload)?, m.value(g, &belt.transition)?);
    // −σ r₂
    let opposite = match belt.run {
        Run::Open => -radius[1],
        Run::Crossed => radius[1],
    };
    let [first, second] = belt.between.map(|pulley| angle_and_rate(g, m, pulley));
    let shift = radius[0] * first[0] + opposite * (second[0] - m.value(g, &belt.offset)?);
    let rate = radius[0] * first[1] + opposite * second[1];

    let mut parting = preload / stiffness;
    let mut parting_rate = g.number(0.0);
    let mut line = None;
    if let (Some(centers), Some(distance)) = (belt.centers, &belt.distance) {
        let [a, b] = centers.map(|point| m.point(g, point));
        let offset = Vector::of(g, b.position) - Vector::of(g, a.position);
        let across = (radius[0] + opposite) * (radius[0] + opposite);
        let strand = (offset.dot(offset) - across).sqrt();
        let distance = m.value(g, distance)?;
        parting += strand - (distance * distance - across).sqrt();
        // ∂L/∂r_B
        let direction = offset / strand;
        parting_rate = direction.dot(Vector::of(g, b.velocity) - Vector::of(g, a.velocity));
        line = Some((a, b, direction));
    }
    // The longer strand is taut.
    let taut = parting + shift.abs() + corner;
    loads.only_where(taut.expr());
    let strand = |stretch, rate| {
        let taut = PositivePart::of(stretch, corner);
        (clipped(stiffness * taut.value + damping * taut.slope * rate), stiffness * taut.integral)
    };
    let (first, first_energy) = strand(parting + shift, parting_rate + rate);
    let (second, second_energy) = strand(parting - shift, parting_rate - rate);

    let carried = second - first;
    for (pulley, arm) in belt.between.into_iter().zip([radius[0], opposite]) {
        add_torque(g, m, loads, pulley, (arm * carried).expr())?;
    }
    if let Some((a, b, direction)) = line {
        loads.add_force_pair(g, &b, &a, ((first + second) * direction).exprs());
    }
    let coefficients = [stiffness, preload, corner, radius[0], radius[1]].map(Scalar::expr);
    loads.add_potential(g, m, &coefficients, (first_energy + second_energy).only_where(taut).expr());
    loads.measure(Belt::FIRST_TENSION, first.only_where(taut).expr());
    loads.measure(Belt::SECOND_TENSION, second.only_where(taut).expr());
    Ok(())
}

fn angle_and_rate<'g>(g: &'g Builder, m: &Mechanism, pulley: Turning) -> [Scalar<'g>; 2] {
    match pulley {
        Turning::Body(body) => [TimeOrder::Position, TimeOrder::Velocity]
            .map(|order| g.scalar(m.observe(g, Referent::Coordinate { body, coordinate: Coordinate::Angle, order }))),
        Turning::Joint(joint) => m.coordinate_and_rate(g, OnJoint { joint, coordinate: JointCoordinate::Angle }),
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
