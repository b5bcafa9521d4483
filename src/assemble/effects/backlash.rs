//! A gear pair whose teeth have play.
//!
//! ```text
//! x = θ₂ − ratio θ₁ − offset          rad, zero in the middle of the play b
//! τ = k [p(x − b/2) − p(−x − b/2)] + c ẋ [p'(x − b/2) + p'(−x − b/2)]          N m
//! −τ on the second wheel, +ratio τ on the first
//! ```
//!
//! p is the positive part with its corner rounded (`positive_part`): within the play nothing acts, and only x is
//! computed. The reactions of the
//! shafts on their frames (the ground, or the joints' first bodies) carry the difference of the torques, as of a rigid gear.

use symdiff::{Builder, Expr, Unary};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::{Backlash, Coordinate, JointCoordinate, Measure, Referent, TimeOrder, Turning};

use super::Loads;
use super::positive_part::PositivePart;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, gear: &Backlash) -> Result<(), BuildError> {
    let number = |g: &Builder, formula| m.formula(g, formula, Context::Motion);
    let (ratio, offset) = (number(g, &gear.ratio)?, number(g, &gear.offset)?);
    let (play, corner) = (number(g, &gear.backlash)?, number(g, &gear.transition)?);
    let (stiffness, damping) = (number(g, &gear.stiffness)?, number(g, &gear.damping)?);
    let between = |order: TimeOrder| {
        let [first, second] = gear.between.map(|angle_of| turned(g, m, angle_of, order));
        let wanted = g.mul(ratio, first);
        g.sub(second, wanted)
    };
    let (place, rate) = (between(TimeOrder::Position), between(TimeOrder::Velocity));
    let place = g.sub(place, offset);
    let half = g.scale(0.5, play);
    let (ahead, opposite) = (g.sub(place, half), g.neg(place));
    let behind = g.sub(opposite, half);
    // |x| − b/2 + ε
    let (far, inside) = (g.unary(Unary::Abs, place), g.sub(half, corner));
    let bearing_at = g.sub(far, inside);
    loads.only_where(bearing_at);
    let [ahead, behind] = [ahead, behind].map(|depth| PositivePart::of(g, depth, corner));
    let twist = g.sub(ahead.value, behind.value);
    let elastic = g.mul(stiffness, twist);
    let bearing = g.add(ahead.slope, behind.slope);
    let felt = g.mul(damping, bearing);
    let viscous = g.mul(felt, rate);
    let torque = g.add(elastic, viscous);
    let (back, forth) = (g.neg(torque), g.mul(ratio, torque));
    add_torque(g, m, loads, gear.between[0], forth)?;
    add_torque(g, m, loads, gear.between[1], back)?;
    let torque = g.only_where(bearing_at, torque);
    let stored = g.add(ahead.integral, behind.integral);
    let potential = g.mul(stiffness, stored);
    let potential = g.only_where(bearing_at, potential);
    loads.add_potential(g, m, &[stiffness, play, corner, ratio, offset], potential);
    for (measure, value) in [(Measure::Angle, place), (Measure::Rate, rate), (Measure::Torque, torque)] {
        loads.measure(measure, value);
    }
    Ok(())
}

/// An angle, or its rate.
fn turned(g: &Builder, m: &Mechanism, angle_of: Turning, order: TimeOrder) -> Expr {
    match angle_of {
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
