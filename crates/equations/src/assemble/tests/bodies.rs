use super::model::Model;
use super::numbers::{State, assert_all_close, assert_close, inertia_times, output, time_derivative};

/// Bodies with an offset centre of mass: free, one with a prescribed coordinate that moves, one that only turns.
fn assorted() -> Model {
    let mut m = Model::new();
    m.interval("s", [0.2, 0.3, 0.4]);
    m.body("free", "2", "0.1", "xya", &[("P", "s", "-0.5")]);
    m.center_of_mass("0.4", "-s");
    m.body("driven", "3", "0.2", "xy", &[("P", "0.7", "0.2")]);
    m.center_of_mass("0.1", "s");
    m.hold('a', "0.5 + 2*t + 0.3*t^2");
    m.body("rotor", "1.5", "0.3", "a", &[("P", "0.1", "0.6")]);
    m.center_of_mass("0.2", "0.1");
    m.hold('x', "1 + 0.4*t^3");
    m
}

#[test]
fn velocity_and_acceleration_are_the_derivatives_of_position() {
    let mut m = assorted();
    for body in ["free", "driven", "rotor"] {
        for name in ["x", "y", "vx", "vy", "ax", "ay"] {
            m.output(&format!("{body}.P.{name}"));
        }
        for name in ["angle", "angular_velocity", "angular_acceleration"] {
            m.output(&format!("{body}.{name}"));
        }
    }
    let system = m.build();
    let state = State::random(&system, 3);
    let h = 1e-5;
    let (before, after) = (state.later(&system, -h), state.later(&system, h));
    let chains = [["P.x", "P.vx", "P.ax"], ["P.y", "P.vy", "P.ay"]];
    let turning = ["angle", "angular_velocity", "angular_acceleration"];
    for body in ["free", "driven", "rotor"] {
        for chain in chains.iter().chain([&turning]) {
            for link in chain.windows(2) {
                let [low, high] = [link[0], link[1]].map(|name| output(&system, &format!("{body}.{name}")));
                let slope = (after.value(&system.graph, low) - before.value(&system.graph, low)) / (2.0 * h);
                assert_close(slope, state.value(&system.graph, high), 1e-8);
            }
        }
    }
}

/// M w − Q is d/dt ∂T/∂v − ∂T/∂q where no force is applied.
#[test]
fn inertia_agrees_with_lagrange() {
    let mut m = assorted();
    m.output("kinetic_energy");
    let mut system = m.build();
    let kinetic = output(&system, "kinetic_energy");
    for seed in 0..5 {
        let state = State::random(&system, seed);
        let force = state.values(&system.graph, &system.force);
        for (row, moved) in inertia_times(&system, &state).into_iter().enumerate() {
            let momentum = system.graph.derivative(kinetic, system.v[row]);
            let rate = time_derivative(&mut system, momentum);
            let slope = system.graph.derivative(kinetic, system.q[row]);
            let lagrange = state.value(&system.graph, rate) - state.value(&system.graph, slope);
            assert_close(moved - force[row], lagrange, 1e-12);
        }
    }
}

#[test]
fn kinetic_energy_is_half_v_m_v() {
    let mut m = Model::new();
    m.body("free", "2", "0.1", "xya", &[]);
    m.center_of_mass("0.4", "-0.3");
    m.body("rotor", "1.5", "0.3", "a", &[]);
    m.center_of_mass("0.2", "0.1");
    m.output("kinetic_energy");
    let system = m.build();
    let state = State::random(&system, 11);
    let mut doubled = 0.0;
    for &(row, column, value) in &system.mass {
        doubled += state.0[&system.v[row]] * state.value(&system.graph, value) * state.0[&system.v[column]];
    }
    assert_close(state.value(&system.graph, output(&system, "kinetic_energy")), doubled / 2.0, 1e-14);
}

#[test]
fn mass_is_constant_where_the_origin_is_the_center() {
    let mut m = Model::new();
    m.body("free", "2", "0.1", "xya", &[]);
    let system = m.build();
    let entries: Vec<_> =
        system.mass.iter().map(|&(row, column, value)| (row, column, system.graph.as_constant(value))).collect();
    assert_eq!(entries, [(0, 0, Some(2.0)), (1, 1, Some(2.0)), (2, 2, Some(0.1))]);
    assert!(system.force.iter().all(|&force| system.graph.is_zero(force)));
}

/// A spinning body whose frame is not at its centre of mass: the frame's origin circles around it.
#[test]
fn a_free_body_turns_about_its_center() {
    let mut m = Model::new();
    m.body("free", "2", "0.1", "xya", &[]);
    m.center_of_mass("0.4", "0");
    let mut system = m.build();
    let mut state = State::at(&system, &[0.0, 0.0, 0.0]);
    let spin = 3.0;
    state.0.insert(system.v[1], -0.4 * spin);
    state.0.insert(system.v[2], spin);
    super::numbers::solve_motion(&mut system, &mut state);
    assert_all_close(&state.list(&system.w), &[0.4 * spin * spin, 0.0, 0.0], 1e-14);
}
