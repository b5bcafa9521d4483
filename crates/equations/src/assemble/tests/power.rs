//! Two bodies, and the power of the effects between them.

use super::model::Model;
use super::numbers::{State, output};
use crate::assemble::System;

/// Two free bodies with an offset point and centre of mass each.
pub fn two_bodies() -> Model {
    let mut m = Model::new();
    m.interval("k", [40.0, 50.0, 60.0]);
    m.body("a", "2", "0.1", "xya", &[("P", "0.3", "-0.5")]);
    m.center_of_mass("0.1", "0.2");
    m.body("b", "1", "0.2", "xya", &[("P", "-0.2", "0.6")]);
    for point in ["a.P", "b.P"] {
        for name in ["x", "y", "vx", "vy"] {
            m.output(&format!("{point}.{name}"));
        }
    }
    m.output("b.angular_velocity - a.angular_velocity");
    m.output("potential_energy");
    m
}

/// Σ Q v of the effects alone, without the inertial forces of the same bodies.
pub fn power(with: &System, state: &State) -> f64 {
    let inertial = two_bodies().build();
    let force = state.values(&with.graph, &with.force);
    let by_name = |symbol: symdiff::Expr| {
        let name = inertial.graph.symbol_name(symbol).unwrap();
        *state.0.iter().find(|(known, _)| with.graph.symbol_name(**known) == Some(name)).unwrap().1
    };
    let felt = inertial.graph.evaluate(&inertial.force, by_name);
    let applied = force.iter().zip(felt).map(|(all, felt)| all - felt);
    applied.zip(state.list(&with.v)).map(|(force, velocity)| force * velocity).sum()
}

pub fn value(system: &System, state: &State, name: &str) -> f64 {
    state.value(&system.graph, output(system, name))
}

/// dV/dt along a motion, by finite differences.
pub fn potential_rate(system: &System, state: &State) -> f64 {
    let h = 1e-5;
    let ends = [h, -h].map(|h| {
        let mut moved = state.later(system, h);
        moved.0.insert(system.time, state.0[&system.time]);
        value(system, &moved, "potential_energy")
    });
    (ends[0] - ends[1]) / (2.0 * h)
}
