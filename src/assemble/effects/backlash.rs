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

use symdiff::{Builder, Expr, Scalar};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::{Backlash, Coordinate, JointCoordinate, Measure, Referent, TimeOrder, Turning};

use super::Loads;
use super::positive_part::PositivePart;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, gear: &Backlash) -> Result<(), BuildError> {
    let (ratio, offset) = (m.value(g, &gear.ratio)?, m.value(g, &gear.offset)?);
    let (play, corner) = (m.value(g, &gear.backlash)?, m.value(g, &gear.transition)?);
    let (stiffness, damping) = (m.value(g, &gear.stiffness)?, m.value(g, &gear.damping)?);
    let between = |order: TimeOrder| {
        let [first, second] = gear.between.map(|angle_of| g.scalar(angle(g, m, angle_of, order)));
        second - ratio * first
    };
    let (place, rate) = (between(TimeOrder::Position), between(TimeOrder::Velocity));
    let place = place - offset;
    let half = 0.5 * play;
    let (ahead, behind) = (place - half, -place - half);
    // |x| − b/2 + ε
    let bearing_at = place.abs() - (half - corner);
    loads.only_where(bearing_at.expr());
    let [ahead, behind] = [ahead, behind].map(|depth| PositivePart::of(depth, corner));
    let torque = stiffness * (ahead.value - behind.value) + damping * (ahead.slope + behind.slope) * rate;
    let (back, forth) = (-torque, ratio * torque);
    add_torque(g, m, loads, gear.between[0], forth.expr())?;
    add_torque(g, m, loads, gear.between[1], back.expr())?;
    let torque = torque.only_where(bearing_at);
    let potential = (stiffness * (ahead.integral + behind.integral)).only_where(bearing_at);
    loads.add_potential(g, m, &[stiffness, play, corner, ratio, offset].map(Scalar::expr), potential.expr());
    for (measure, value) in [(Measure::ANGLE, place), (Measure::RATE, rate), (Measure::TORQUE, torque)] {
        loads.measure(measure, value.expr());
    }
    Ok(())
}

/// An angle, or its rate.
fn angle(g: &Builder, m: &Mechanism, angle_of: Turning, order: TimeOrder) -> Expr {
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
