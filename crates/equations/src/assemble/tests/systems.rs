use std::collections::HashSet;

use crate::model::TimeOrder;

use super::model::{Model, slider_crank};
use super::numbers::{State, assert_close, output, solve_motion, time_derivative};

const GRAVITY: f64 = 9.81;

#[test]
fn the_slider_crank_has_seven_coordinates_and_six_constraints() {
    let system = slider_crank().build();
    let names: Vec<&str> = system.coordinates.iter().map(|info| info.name.as_str()).collect();
    assert_eq!(names, ["crank.x", "crank.y", "crank.angle", "rod.x", "rod.y", "rod.angle", "slider.x"]);
    let names: Vec<&str> = system.constraints.iter().map(|info| info.name.as_str()).collect();
    assert_eq!(names, ["pivot.x", "pivot.y", "pin.x", "pin.y", "wrist.x", "wrist.y"]);
    assert_eq!(system.mass.len(), 7);
    let parameters: Vec<&str> = system.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    assert_eq!(parameters, ["l1", "tau"]);

    // By hand, with the crank straight up.
    let (l1, l2) = (0.15f64, 0.56f64);
    let reach = (l2 * l2 - l1 * l1).sqrt();
    let rod = (-l1).atan2(reach);
    let positions = [0.0, l1 / 2.0, std::f64::consts::FRAC_PI_2, reach / 2.0, l1 / 2.0, rod, reach];
    let state = State::at(&system, &positions);
    for gap in state.values(&system.graph, &system.constraint) {
        assert_close(gap, 0.0, 1e-15);
    }
}

#[test]
fn symbols_are_named_after_their_kind() {
    let system = slider_crank().build();
    let g = &system.graph;
    let all = [&system.q, &system.v, &system.w, &system.lambda].into_iter().flatten();
    let names: HashSet<&str> = all.map(|&symbol| g.symbol_name(symbol).unwrap()).collect();
    assert_eq!(names.len(), 3 * 7 + 6);
    for name in ["q:crank.angle", "v:rod.x", "w:slider.x", "lambda:pin.x"] {
        assert!(names.contains(name), "{name}");
    }
    assert_eq!(g.symbol_name(system.parameters[0].symbol), Some("p:l1"));
    assert_eq!(g.symbol_name(system.time), Some("t"));
}

/// A rod on a pin at one end: φ̈ = −m g (l/2) sin φ / (m l²/3) from straight down.
fn pendulum() -> Model {
    let mut m = Model::new();
    m.parameter("m", "2.5");
    m.parameter("l", "0.8");
    m.body("rod", "m", "m*l^2/12", "xya", &[("A", "-l/2", "0")]);
    m.revolute("pin", "ground", "rod.A");
    m.gravity();
    for name in ["pin.force", "pin.force.x", "pin.force.y", "pin.torque", "energy", "kinetic_energy"] {
        m.output(name);
    }
    m
}

#[test]
fn pin_force_of_a_hanging_pendulum_equals_its_weight() {
    let mut system = pendulum().build();
    let mut state = State::at(&system, &[0.0, -0.4, -std::f64::consts::FRAC_PI_2]);
    solve_motion(&mut system, &mut state);
    let value = |name: &str| state.value(&system.graph, output(&system, name));
    assert_close(value("pin.force"), 2.5 * GRAVITY, 1e-14);
    assert_close(value("pin.force.x"), 0.0, 1e-14);
    // On the second body, the rod: upwards.
    assert_close(value("pin.force.y"), 2.5 * GRAVITY, 1e-14);
    assert_close(value("pin.torque"), 0.0, 0.0);
}

#[test]
fn a_swinging_pendulum_follows_its_closed_form() {
    let mut system = pendulum().build();
    let (angle, rate): (f64, f64) = (-0.9, 1.7);
    let (half, mass) = (0.4, 2.5);
    let (sin, cos) = angle.sin_cos();
    let mut state = State::at(&system, &[half * cos, half * sin, angle]);
    state.0.extend(system.v.iter().copied().zip([-half * sin * rate, half * cos * rate, rate]));
    solve_motion(&mut system, &mut state);
    let acceleration = -GRAVITY * half * cos / (4.0 * half * half / 3.0);
    assert_close(state.0[&system.w[2]], acceleration, 1e-13);
    // Newton's law for the centre, along the rod: the pin carries the weight and the centripetal force.
    let value = |name: &str| state.value(&system.graph, output(&system, name));
    let along = value("pin.force.x") * cos + value("pin.force.y") * sin;
    assert_close(along, mass * GRAVITY * sin - mass * half * rate * rate, 1e-13);
}

/// The same pendulum in the angle alone, its frame at the pin: no constraint is left.
#[test]
fn a_pendulum_in_its_angle_has_the_same_acceleration() {
    let mut m = Model::new();
    m.body("rod", "2.5", "2.5*0.8^2/12", "a", &[]);
    m.center_of_mass("0.4", "0");
    m.revolute("pin", "ground", "rod");
    m.gravity();
    let mut system = m.build();
    assert_eq!((system.q.len(), system.lambda.len()), (1, 0));
    let mut state = State::at(&system, &[-0.9]);
    state.0.insert(system.v[0], 1.7);
    solve_motion(&mut system, &mut state);
    assert_close(state.0[&system.w[0]], -GRAVITY * 1.5 * (-0.9f64).cos() / 0.8, 1e-13);
}

/// Along the motion dE/dt = 0 with gravity, and the power of torque and damper in the slider crank.
#[test]
fn energy_changes_by_the_power_put_in() {
    let mut m = slider_crank();
    m.gravity();
    m.output("energy");
    m.output("tau*crank.angular_velocity - c*slider.vx^2");
    let mut system = m.build();
    let (l1, l2) = (0.15f64, 0.56f64);
    let crank = 0.8f64;
    let rod = -(l1 * crank.sin() / l2).asin();
    let tip = [l1 * crank.cos(), l1 * crank.sin()];
    let end = tip[0] + l2 * rod.cos();
    let positions = [tip[0] / 2.0, tip[1] / 2.0, crank, (tip[0] + end) / 2.0, tip[1] / 2.0, rod, end];
    let mut state = State::at(&system, &positions);
    let rate = 6.0;
    let rod_rate = -l1 * crank.cos() * rate / (l2 * rod.cos());
    let tip_rate = [-tip[1] * rate, tip[0] * rate];
    let end_rate = tip_rate[0] - l2 * rod.sin() * rod_rate;
    let velocities = [
        tip_rate[0] / 2.0,
        tip_rate[1] / 2.0,
        rate,
        (tip_rate[0] + end_rate) / 2.0,
        tip_rate[1] / 2.0,
        rod_rate,
        end_rate,
    ];
    state.0.extend(system.v.iter().copied().zip(velocities));
    for phi in system.constraint.clone() {
        let rate = time_derivative(&mut system, phi);
        assert_close(state.value(&system.graph, rate), 0.0, 1e-14);
    }
    solve_motion(&mut system, &mut state);
    let energy = output(&system, "energy");
    let change = time_derivative(&mut system, energy);
    let power = output(&system, "tau*crank.angular_velocity - c*slider.vx^2");
    assert_close(state.value(&system.graph, change), state.value(&system.graph, power), 1e-12);
}

/// Four-bar loops side by side, each on the last one's rocker.
fn chain(loops: usize) -> Model {
    let mut m = Model::new();
    m.interval("l", [0.9, 1.0, 1.1]);
    m.gravity();
    let ends = [("A", "-l/2", "0"), ("B", "l/2", "0")];
    let mut left = "ground".to_owned();
    for index in 0..loops {
        let [crank, coupler, rocker] = ["crank", "coupler", "rocker"].map(|name| format!("{name}{index}"));
        m.ground_point(&format!("G{index}"), &format!("{}*l", index + 1), "0");
        for name in [&crank, &coupler, &rocker] {
            m.body(name, "1", "l^2/12", "xya", &ends);
        }
        m.revolute(&format!("turn{index}"), &left, &format!("{crank}.A"));
        m.revolute(&format!("first{index}"), &format!("{crank}.B"), &format!("{coupler}.A"));
        m.revolute(&format!("second{index}"), &format!("{coupler}.B"), &format!("{rocker}.B"));
        m.revolute(&format!("rock{index}"), &format!("ground.G{index}"), &format!("{rocker}.A"));
        left = format!("ground.G{index}");
    }
    m.initial("crank0", 'a', TimeOrder::Position, "1");
    m.output("energy");
    m
}

#[test]
fn a_chain_of_loops_grows_linearly() {
    let [small, large] = [50, 100].map(|loops| chain(loops).build().graph.len() as f64);
    assert!(large / small < 2.05, "{small} and {large} nodes");
}
