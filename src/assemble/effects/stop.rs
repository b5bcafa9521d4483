//! Stops at the ends of a joint's way.
//!
//! ```text
//! f = f(lower − s) − f(s − upper)          N or N m, on the joint's coordinate s; f is that of `impact`
//! ```
//!
//! Between the stops nothing acts, and nothing is computed but where s is.

use symdiff::{Builder, Scalar};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::{Measure, Stop};

use super::Loads;
use super::impact::Impact;

pub fn apply(g: &Builder, m: &Mechanism, loads: &mut Loads, stop: &Stop) -> Result<(), BuildError> {
    let on = stop.on;
    let impact = Impact::of(g, m, &stop.impact)?;
    let [place, rate] = m.coordinate_and_rate(g, on);
    let back = -rate;
    let mut push = g.number(0.0);
    let mut ends: Vec<Scalar> = Vec::new();
    if let Some(lower) = &stop.lower {
        let depth = m.given(g, lower)? - place;
        push += impact.force(depth, back).only_where(depth);
        ends.push(depth);
    }
    if let Some(upper) = &stop.upper {
        let depth = place - m.given(g, upper)?;
        push -= impact.force(depth, rate).only_where(depth);
        ends.push(depth);
    }
    if let Some(overlap) = ends.iter().copied().reduce(Scalar::max) {
        loads.only_where(overlap.expr());
    }
    loads.add_joint_effort(g, m, on, push.expr())?;
    for depth in ends {
        let potential = impact.potential(depth).only_where(depth);
        loads.add_potential(g, m, &[impact.stiffness.expr()], potential.expr());
    }
    loads.measure(Measure::of_effort(on.coordinate), push.expr());
    Ok(())
}
