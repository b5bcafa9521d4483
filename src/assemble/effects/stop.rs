//! Stops at the ends of a joint's way.
//!
//! ```text
//! f = f(lower − s) − f(s − upper)          N or N m, on the joint's coordinate s; f is that of `impact`
//! ```
//!
//! Between the stops nothing acts, and nothing is computed but where s is.

use symdiff::{Binary, Builder, Expr};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::{Measure, Stop, TimeOrder};

use super::Loads;
use super::impact::Impact;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, stop: &Stop) -> Result<(), BuildError> {
    let on = stop.on;
    let impact = Impact::of(g, m, &stop.impact)?;
    let place = m.joint_coordinate(g, on.joint, on.coordinate, TimeOrder::Position);
    let rate = m.joint_coordinate(g, on.joint, on.coordinate, TimeOrder::Velocity);
    let back = g.neg(rate);
    let mut push = g.constant(0.0);
    let mut ends: Vec<Expr> = Vec::new();
    if let Some(lower) = &stop.lower {
        let lower = m.formula(g, lower, Context::Time)?;
        let depth = g.sub(lower, place);
        let force = impact.force(g, depth, back);
        let force = g.only_where(depth, force);
        push = g.add(push, force);
        ends.push(depth);
    }
    if let Some(upper) = &stop.upper {
        let upper = m.formula(g, upper, Context::Time)?;
        let depth = g.sub(place, upper);
        let force = impact.force(g, depth, rate);
        let force = g.only_where(depth, force);
        push = g.sub(push, force);
        ends.push(depth);
    }
    if let Some(overlap) = ends.iter().copied().reduce(|a, b| g.binary(Binary::Max, a, b)) {
        loads.only_where(overlap);
    }
    loads.add_joint_effort(g, m, on, push)?;
    for depth in ends {
        let potential = impact.potential(g, depth);
        let potential = g.only_where(depth, potential);
        loads.add_potential(g, m, &[impact.stiffness], potential);
    }
    loads.measure(Measure::of_effort(on.coordinate), push);
    Ok(())
}
