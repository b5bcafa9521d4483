//! Beams with mass.

use super::model::{Model, formula, pair};
use super::numbers::{State, output, time_derivative};
use super::power::{potential_rate, power, two_bodies};
use crate::grammar::Direction;
use crate::model::Beam;
use crate::model::beam::Flexible;

/// An element between points off both bodies' origins, its axis askew.
fn heavy_beam(m: &Model, stiffness: &str) -> Beam {
    Beam {
        between: m.between("a.P", "b.P"),
        axis: Direction(pair("1", "0.5")),
        length: formula("0.7"),
        axial_stiffness: formula(stiffness),
        bending_stiffness: formula(stiffness),
        damping: formula("0"),
        flexible: Some(Flexible { body: "rod".to_owned(), mass_per_length: formula("k/30") }),
    }
}

/// Gravity pulls at the mass along beams too.
#[test]
fn weights_of_beams_have_their_potential() {
    let mut m = two_bodies();
    m.effect(heavy_beam(&m, "3"));
    m.gravity();
    let system = m.build();
    for seed in 0..4 {
        let state = State::random(&system, seed);
        let (power, rate) = (power(&system, &state), potential_rate(&system, &state));
        assert!(power.abs() > 1e-3 && (power + rate).abs() <= 1e-6 * (1.0 + power.abs()), "{power} is not {}", -rate);
    }
}

/// M w and what depends on velocities of a beam is d/dt ∂T/∂v − ∂T/∂q, and M its slope by w.
#[test]
fn inertia_of_beams_agrees_with_lagrange() {
    let mut m = two_bodies();
    m.effect(heavy_beam(&m, "0"));
    m.output("kinetic_energy");
    let mut system = m.build();
    let kinetic = output(&system, "kinetic_energy");
    for seed in 0..4 {
        let state = State::random(&system, seed);
        let force = state.values(&system.graph, &system.force);
        let inertia = state.values(&system.graph, &system.inertia);
        for row in 0..system.q.len() {
            let momentum = system.graph.derivative(kinetic, system.v[row]);
            let rate = time_derivative(&mut system, momentum);
            let slope = system.graph.derivative(kinetic, system.q[row]);
            let lagrange = state.value(&system.graph, rate) - state.value(&system.graph, slope);
            assert!((inertia[row] - force[row] - lagrange).abs() < 1e-11 * (1.0 + lagrange.abs()), "row {row}");
        }
        let mut doubled = 0.0;
        for &(row, column, value) in &system.mass {
            doubled += state.0[&system.v[row]] * state.value(&system.graph, value) * state.0[&system.v[column]];
        }
        assert!((state.value(&system.graph, kinetic) - 0.5 * doubled).abs() < 1e-12 * (1.0 + doubled.abs()));
    }
}
