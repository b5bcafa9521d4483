//! Beams with mass.

use super::model::{Model, formula, pair};
use super::numbers::{State, output, time_derivative};
use super::power::{potential_rate, power, two_bodies};
use super::spatial;
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
        bending_stiffness_y: None,
        torsional_stiffness: None,
        shear_stiffness: None,
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

/// M w with the velocity-dependent terms of a beam is d/dt ∂T/∂v − ∂T/∂q, and M its slope by w.
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

/// An element of the plane that shears.
#[test]
fn beams_that_shear_have_their_potential() {
    let mut m = two_bodies();
    m.effect(Beam { flexible: None, shear_stiffness: Some(formula("9")), ..heavy_beam(&m, "3") });
    let system = m.build();
    for seed in 0..4 {
        let state = State::random(&system, seed);
        let (power, rate) = (power(&system, &state), potential_rate(&system, &state));
        assert!(power.abs() > 1e-3 && (power + rate).abs() <= 1e-6 * (1.0 + power.abs()), "{power} is not {}", -rate);
    }
}

/// An element of space between frames askew, with uneven stiffness about y and z.
fn spatial_beam(m: &Model, stiffness: [&str; 4], shear: Option<&str>) -> Beam {
    let [axial, about_z, about_y, torsional] = stiffness.map(formula);
    Beam {
        between: m.between("a.P", "b.P"),
        axis: Direction::along(0),
        length: formula("d"),
        axial_stiffness: axial,
        bending_stiffness: about_z,
        bending_stiffness_y: Some(about_y),
        torsional_stiffness: Some(torsional),
        shear_stiffness: shear.map(formula),
        damping: formula("0"),
        flexible: None,
    }
}

/// Forces and moments of space are the gradient of V, with and without shear, and turn nothing as a whole.
#[test]
fn beams_of_space_have_their_potential() {
    for shear in [None, Some("70")] {
        let mut m = spatial::two_lumps();
        m.effect(spatial_beam(&m, ["30", "2", "5", "3"], shear));
        let system = m.build();
        for seed in 0..6 {
            let state = spatial::on_sphere(&system, seed);
            let (power, rate) = (spatial::power(&system, &state), spatial::potential_rate(&system, &state));
            assert!(
                power.abs() > 1e-3 && (power + rate).abs() <= 1e-6 * (1.0 + power.abs()),
                "{power} is not {}",
                -rate
            );
        }
    }
}

/// The mass along it, which moves by Hermite's cubics, and its sections, against Lagrange's equations.
#[test]
fn inertia_of_beams_of_space_agrees_with_lagrange() {
    let mut m = spatial::two_lumps();
    let flexible = Some(Flexible { body: "rod".to_owned(), mass_per_length: formula("d*4") });
    // No forces but of inertia: tiny stiffness, with radii of gyration of 0.4 and 0.6.
    m.effect(Beam { flexible, ..spatial_beam(&m, ["1e-18", "0.16e-18", "0.36e-18", "0"], None) });
    let mut system = m.build();
    let kinetic = output(&system, "kinetic_energy");
    for seed in 0..4 {
        let state = spatial::on_sphere(&system, seed);
        let force = state.values(&system.graph, &system.force);
        let inertia = state.values(&system.graph, &system.inertia);
        let mut off = Vec::new();
        for row in 0..system.q.len() {
            let momentum = system.graph.derivative(kinetic, system.v[row]);
            let rate = time_derivative(&mut system, momentum);
            let slope = system.graph.derivative(kinetic, system.q[row]);
            let lagrange = state.value(&system.graph, rate) - state.value(&system.graph, slope);
            off.push(inertia[row] - force[row] - lagrange);
        }
        let q = state.list(&system.q);
        for body in 0..2 {
            let index = spatial::SIZE * body;
            let turning = spatial::torque(&q[index + 3..index + spatial::SIZE], &off[index + 3..index + spatial::SIZE]);
            let largest =
                off[index..index + 3].iter().chain(turning.iter()).fold(0.0_f64, |all, one| all.max(one.abs()));
            assert!(largest < 1e-10, "body {body} off by {largest:e}");
        }
    }
}
