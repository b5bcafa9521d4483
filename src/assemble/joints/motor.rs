//! Motor: a joint's coordinate moves as is prescribed.
//!
//! ```text
//! Φ = s − s(t) = 0          1 row, rad or m
//!
//! position     s(t), a formula
//! speed        s(t) = from + ∫ v(t) dt                                        where `Graph::integral` knows it
//! move         s(t) = from + (to − from) σ(u)                                 u = (t − start)/duration, kept within 0 … 1
//! run-up       s(t) = from + v [duration Σ(u) + ⟨t − start − duration⟩]       Σ = ∫σ, so that ṡ = v σ(u)
//!
//! cycloidal    σ = u − sin(2π u)/2π                       Σ = u²/2 + (cos(2π u) − 1)/4π²
//! quintic      σ = u³ (10 − 15 u + 6 u²)                  Σ = u⁴ (5/2 − 3 u + u²)
//! trapezoidal  σ = [u² − ⟨u − r⟩² − ⟨u − 1 + r⟩²]/(2 r (1 − r))      Σ = [u³ − ⟨u − r⟩³ − ⟨u − 1 + r⟩³]/(6 r (1 − r))
//! ```
//!
//! −Φ_qᵀ λ is the force or torque −λ on the coordinate: along or about the joint's axis on its second body, the opposite on its
//! first. The motor's reaction is what it has to give. Cycloidal and quintic moves have continuous accelerations;
//! trapezoidal ones jump, and with them the forces. Profiles: Biagiotti & Melchiorri, *Trajectory Planning for Automatic
//! Machines and Robots* (2008), ch. 2 and 3.

use std::f64::consts::{PI, TAU};

use symdiff::{Binary, Builder, Expr};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::assemble::space;
use crate::elements::joints::{Prescribed, Profile};
use crate::grammar::JointCoordinate;
use crate::model::TimeOrder;

use super::{Row, axis_in_ground};

pub fn rows(
    g: &Builder,
    m: &Mechanism,
    joint: usize,
    coordinate: JointCoordinate,
    motion: &Prescribed,
) -> Result<Vec<Row>, BuildError> {
    let place = m.joint_coordinate(g, joint, coordinate, TimeOrder::Position);
    let wanted = wanted(g, m, motion)?;
    let value = g.sub(place, wanted);
    let axis = axis_in_ground(g, m, joint, coordinate)?;
    let (push, none) = (space::neg(g, axis), space::zero(g));
    Ok(vec![match coordinate {
        JointCoordinate::Angle => Row { name: "", value, force: none, torque: push },
        JointCoordinate::Displacement => Row { name: "", value, force: push, torque: none },
    }])
}

/// s(t)
fn wanted(g: &Builder, m: &Mechanism, motion: &Prescribed) -> Result<Expr, BuildError> {
    let number = |g: &Builder, formula| m.formula(g, formula, Context::Time);
    match motion {
        Prescribed::Position(position) => number(g, position),
        Prescribed::Speed { from, speed } => {
            let (from, speed) = (number(g, from)?, number(g, speed)?);
            let way = g.integral(speed, m.time).ok_or(BuildError::Speed)?;
            Ok(g.add(from, way))
        }
        Prescribed::Move { profile, from, to, start, duration } => {
            let (from, to) = (number(g, from)?, number(g, to)?);
            let (start, duration) = (number(g, start)?, number(g, duration)?);
            let part = part(g, m, start, duration);
            let [shape, _] = shape(g, m, profile, part)?;
            let way = g.sub(to, from);
            let way = g.mul(way, shape);
            Ok(g.add(from, way))
        }
        Prescribed::RunUp { profile, from, speed, start, duration } => {
            let (from, speed) = (number(g, from)?, number(g, speed)?);
            let (start, duration) = (number(g, start)?, number(g, duration)?);
            let part = part(g, m, start, duration);
            let [_, integral] = shape(g, m, profile, part)?;
            let running_up = g.mul(duration, integral);
            let end = g.add(start, duration);
            let since = g.sub(m.time, end);
            let running = clipped(g, since);
            let time = g.add(running_up, running);
            let way = g.mul(speed, time);
            Ok(g.add(from, way))
        }
    }
}

/// u
fn part(g: &Builder, m: &Mechanism, start: Expr, duration: Expr) -> Expr {
    let since = g.sub(m.time, start);
    let part = g.div(since, duration);
    let (part, one) = (clipped(g, part), g.constant(1.0));
    g.binary(Binary::Min, part, one)
}

/// σ and Σ
fn shape(g: &Builder, m: &Mechanism, profile: &Profile, u: Expr) -> Result<[Expr; 2], BuildError> {
    let one = g.constant(1.0);
    match profile {
        Profile::Cycloidal => {
            let turn = g.scale(TAU, u);
            let (sin, cos) = (g.sin(turn), g.cos(turn));
            let sway = g.scale(1.0 / TAU, sin);
            let square = g.mul(u, u);
            let half = g.scale(0.5, square);
            let less = g.sub(cos, one);
            let bend = g.scale(0.25 / (PI * PI), less);
            Ok([g.sub(u, sway), g.add(half, bend)])
        }
        Profile::Quintic => {
            let polynomial = |power: i32, [a, b, c]: [f64; 3]| {
                let [a, b, c] = [a, b, c].map(|coefficient| g.constant(coefficient));
                let inner = g.mul(c, u);
                let inner = g.add(b, inner);
                let inner = g.mul(inner, u);
                let inner = g.add(a, inner);
                let power = g.powi(u, power);
                g.mul(power, inner)
            };
            Ok([polynomial(3, [10.0, -15.0, 6.0]), polynomial(4, [2.5, -3.0, 1.0])])
        }
        Profile::Trapezoidal { ramp } => {
            let ramp = m.formula(g, ramp, Context::Time)?;
            let rest = g.sub(one, ramp);
            let (after, last) = (g.sub(u, ramp), g.sub(u, rest));
            let (after, last) = (clipped(g, after), clipped(g, last));
            let area = g.mul(ramp, rest);
            let truncated = |power: i32, divisor: f64| {
                let [all, after, last] = [u, after, last].map(|part| g.powi(part, power));
                let sum = g.sub(all, after);
                let sum = g.sub(sum, last);
                let divisor = g.scale(divisor, area);
                g.div(sum, divisor)
            };
            Ok([truncated(2, 2.0), truncated(3, 6.0)])
        }
    }
}

/// max(x, 0).
fn clipped(g: &Builder, x: Expr) -> Expr {
    let zero = g.constant(0.0);
    g.binary(Binary::Max, x, zero)
}
