//! Flexible bodies by their matrices.

use nalgebra::DMatrix;

use super::model::{Model, formula, vector};
use super::numbers::{State, output, time_derivative};
use super::power::{potential_rate, value};
use super::spatial;
use crate::assemble::System;
use crate::elements::effects::superelement::matrices::Matrices;
use crate::grammar::Components;
use crate::model::{Gravity, Rotation, Superelement};

/// Made-up symmetric matrices with large diagonals; no body has such a mass, but every law that is tested here holds
/// for any.
fn matrices(nodes: Vec<[f64; 3]>, modes: usize) -> Matrices {
    let size = 6 * nodes.len() + modes;
    let entry = |seed: f64, i: usize, j: usize| {
        let (i, j) = (i.min(j) as f64, i.max(j) as f64);
        (seed * (3.7 * i + 1.3 * j + 0.4)).sin() + if i == j { 3.0 + i } else { 0.0 }
    };
    let [mass, stiffness] = [1.0, 2.3].map(|seed| DMatrix::from_fn(size, size, |i, j| entry(seed, i, j)));
    Matrices { nodes, modes, mass, stiffness }
}

/// Three massless frames askew, with two modes between them.
fn between_frames(is_spatial: bool, stiffness: &str) -> Model {
    let mut m = if is_spatial { Model::spatial() } else { Model::new() };
    m.interval("k", [1.0, 1.5, 2.0]);
    let letters = if is_spatial { "xyzo" } else { "xya" };
    for (name, angles) in [("a", ["0.3", "0.5", "-0.4"]), ("b", ["-0.9", "0.2", "1.1"]), ("c", ["0.1", "-0.3", "0.2"])]
    {
        m.body(name, "0", "0", letters, &[]);
        let turned = Rotation::RollPitchYaw(vector(if is_spatial { angles } else { ["0", "0", angles[2]] }));
        let height = if is_spatial { "0.2" } else { "0" };
        m.frame("P", ["0.3", "-0.5", height], Some(turned));
    }
    let nodes = ["a.P", "b.P", "c.P"].map(|name| m.point(name)).to_vec();
    let places = vec![[0.1, 0.0, 0.0], [0.8, 0.2, 0.3], [0.4, -0.6, 0.1]];
    let places = places.into_iter().map(|[x, y, z]| [x, y, if is_spatial { z } else { 0.0 }]).collect();
    let matrices = matrices(places, 2);
    let (mass, stiffness, damping) = (formula("k"), formula(stiffness), formula("0"));
    m.effect(Superelement { nodes, matrices, mass, stiffness, damping });
    m.output("kinetic_energy");
    m.output("potential_energy");
    m
}

fn state_of(system: &System, is_spatial: bool, seed: u64) -> State {
    // Three bodies of seven coordinates, then the modes: `on_sphere` handles whole bodies only.
    if is_spatial { spatial::on_sphere(system, seed) } else { State::random(system, seed) }
}

/// Forces of deformation and of weight are the gradient of V.
#[test]
fn forces_have_their_potential() {
    for is_spatial in [false, true] {
        for (stiffness, weight) in [("3", "0"), ("1e-9", "-9.81"), ("2*k", "4")] {
            let mut m = between_frames(is_spatial, stiffness);
            let depth = if is_spatial { "2" } else { "0" };
            m.effect(Gravity { acceleration: Components(vector(["1", weight, depth])) });
            let system = m.build();
            for seed in 0..4 {
                let state = state_of(&system, is_spatial, seed);
                let force = state.values(&system.graph, &system.force);
                let power: f64 = force.iter().zip(state.list(&system.v)).map(|(force, v)| force * v).sum();
                let rate = potential_rate(&system, &state);
                let off = (power + rate).abs();
                assert!(power.abs() > 1e-3 && off <= 1e-6 * (1.0 + power.abs()), "{power} is not {}", -rate);
            }
        }
    }
}

/// M w with velocity-dependent terms is d/dt ∂T/∂v − ∂T/∂q except along Euler parameters, and T is ½ vᵀ M v.
#[test]
fn inertia_agrees_with_lagrange() {
    for is_spatial in [false, true] {
        let m = between_frames(is_spatial, "1e-18");
        let mut system = m.build();
        let kinetic = output(&system, "kinetic_energy");
        for seed in 0..3 {
            let state = state_of(&system, is_spatial, seed);
            let inertia = state.values(&system.graph, &system.inertia);
            let force = state.values(&system.graph, &system.force);
            let mut off = Vec::new();
            for row in 0..system.q.len() {
                let momentum = system.graph.derivative(kinetic, system.v[row]);
                let rate = time_derivative(&mut system, momentum);
                let slope = system.graph.derivative(kinetic, system.q[row]);
                let lagrange = state.value(&system.graph, rate) - state.value(&system.graph, slope);
                off.push(inertia[row] - force[row] - lagrange);
            }
            let size = value(&system, &state, "kinetic_energy");
            let mut left: Vec<f64> = off[off.len() - 2..].to_vec();
            if is_spatial {
                let q = state.list(&system.q);
                for body in 0..3 {
                    let index = spatial::SIZE * body;
                    let range = index + 3..index + spatial::SIZE;
                    left.extend(&off[index..index + 3]);
                    left.extend(spatial::torque(&q[range.clone()], &off[range]).iter());
                }
            } else {
                left.extend(&off);
            }
            assert!(left.iter().all(|off| off.abs() < 1e-11 * (1.0 + size)), "{left:?} of {size}");
        }
    }
}

/// Inertial forces are the same from a frame that moves steadily.
#[test]
fn inertia_is_independent_of_steady_motion() {
    for is_spatial in [false, true] {
        let system = between_frames(is_spatial, "1e-18").build();
        let mut state = state_of(&system, is_spatial, 3);
        let at_rest = state.values(&system.graph, &system.inertia);
        let of_body = if is_spatial { spatial::SIZE } else { 3 };
        for body in 0..3 {
            for (axis, speed) in [(0, 40.0), (1, -30.0), (2, 20.0)].into_iter().take(if is_spatial { 3 } else { 2 }) {
                *state.0.get_mut(&system.v[of_body * body + axis]).unwrap() += speed;
            }
        }
        let moving = state.values(&system.graph, &system.inertia);
        let size = at_rest.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let off = at_rest.iter().zip(&moving).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        assert!(size > 1.0 && off < 1e-11 * size, "{off} of {size}");
    }
}
