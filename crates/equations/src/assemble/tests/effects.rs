//! Forces, torques, springs and dampers.

use super::model::{Model, formula, pair, vector};
use super::numbers::{State, assert_close, output};
use super::power::{potential_rate, power, two_bodies, value};
use crate::grammar::{BodyRef, Components, Direction};
use crate::model::force::ForceFrame;
use crate::model::torque::{AboutAxes, TorqueOn};
use crate::model::{Force, SpringDamper, Torque, TorsionalSpringDamper};

#[test]
fn a_force_has_the_power_of_its_point() {
    let mut m = two_bodies();
    m.effect(Force { on: m.point("a.P"), value: Components(pair("3 + t", "-2*b.x")), frame: ForceFrame::Ground });
    let system = m.build();
    let state = State::random(&system, 1);
    let force = [3.7, -2.0 * state.0[&system.q[3]]];
    let expected = force[0] * value(&system, &state, "a.P.vx") + force[1] * value(&system, &state, "a.P.vy");
    assert_close(power(&system, &state), expected, 1e-13);
}

#[test]
fn a_force_in_the_body_turns_with_it() {
    let mut m = two_bodies();
    m.effect(Force { on: m.point("a.P"), value: Components(pair("3", "-2")), frame: ForceFrame::Body });
    let system = m.build();
    let state = State::random(&system, 2);
    let (sin, cos) = state.0[&system.q[2]].sin_cos();
    let force = [3.0 * cos + 2.0 * sin, 3.0 * sin - 2.0 * cos];
    let expected = force[0] * value(&system, &state, "a.P.vx") + force[1] * value(&system, &state, "a.P.vy");
    assert_close(power(&system, &state), expected, 1e-13);
}

#[test]
fn a_torque_drives_one_body_against_the_other() {
    let mut m = two_bodies();
    m.effect(Torque {
        on: TorqueOn::Body(m.body_index("b")),
        from: Some(BodyRef(m.body_index("a"))),
        value: AboutAxes(vector(["0", "0", "4"])),
        frame: ForceFrame::Ground,
    });
    let system = m.build();
    let state = State::random(&system, 3);
    let rate = value(&system, &state, "b.angular_velocity - a.angular_velocity");
    assert_close(power(&system, &state), 4.0 * rate, 1e-13);
}

#[test]
fn gravity_pulls_down_and_has_its_potential() {
    let mut m = two_bodies();
    m.gravity();
    let system = m.build();
    assert_close(system.graph.as_constant(system.force[4]).unwrap(), -9.81, 0.0);
    let state = State::random(&system, 4);
    assert_close(power(&system, &state), -potential_rate(&system, &state), 1e-8);
}

fn spring(m: &Model, along: Option<[symdiff::Formula; 3]>, stiffness: &str, damping: &str) -> SpringDamper {
    SpringDamper {
        between: m.between("a.P", "b.P"),
        along: along.map(Direction),
        stiffness: formula(stiffness),
        damping: formula(damping),
        free_length: formula("0.4"),
        force: None,
    }
}

#[test]
fn springs_have_their_potential() {
    for along in [None, Some(pair("3", "4"))] {
        let mut m = two_bodies();
        m.effect(spring(&m, along, "k", "0"));
        let system = m.build();
        // Only the centripetal force of a's centre of mass: no damper is left behind.
        assert_eq!(system.graph.symbols_of(&system.force).iter().filter(|symbol| system.v.contains(symbol)).count(), 1);
        for seed in 0..5 {
            let state = State::random(&system, seed);
            assert_close(power(&system, &state), -potential_rate(&system, &state), 1e-7);
        }
    }
}

/// The power of a damper is −c ℓ̇².
#[test]
fn dampers_take_power_along_their_line() {
    for along in [None, Some(pair("3", "4"))] {
        let mut m = two_bodies();
        m.effect(spring(&m, along.clone(), "0", "7"));
        let system = m.build();
        let state = State::random(&system, 5);
        let between = |name: &str| {
            value(&system, &state, &format!("b.P.{name}")) - value(&system, &state, &format!("a.P.{name}"))
        };
        let (dx, dy) = match along {
            Some(_) => (0.6, 0.8),
            None => (between("x"), between("y")),
        };
        let rate = (dx * between("vx") + dy * between("vy")) / f64::hypot(dx, dy);
        assert_close(power(&system, &state), -7.0 * rate * rate, 1e-13);
        assert_close(value(&system, &state, "potential_energy"), 0.0, 0.0);
    }
}

/// A stretched spring pulls: the second point back, the first forth.
#[test]
fn tension_pulls_the_points_together() {
    for along in [None, Some(pair("1", "0"))] {
        let mut m = Model::new();
        m.body("a", "1", "1", "x", &[]);
        m.body("b", "1", "1", "x", &[]);
        m.effect(SpringDamper {
            between: m.between("a", "b"),
            along: along.map(Direction),
            stiffness: formula("10"),
            damping: formula("3"),
            free_length: formula("2"),
            force: None,
        });
        let system = m.build();
        let mut state = State::at(&system, &[1.0, 4.0]);
        state.0.insert(system.v[1], 0.5);
        let force = state.values(&system.graph, &system.force);
        super::numbers::assert_all_close(&force, &[11.5, -11.5], 1e-14);
    }
}

#[test]
fn a_torsional_spring_turns_back() {
    let mut m = two_bodies();
    m.effect(TorsionalSpringDamper {
        between: Some([BodyRef(m.body_index("a")), BodyRef(m.body_index("b"))]),
        on: None,
        stiffness: formula("k"),
        damping: formula("0.3"),
        free_angle: formula("0.2"),
        torque: None,
    });
    let system = m.build();
    let state = State::random(&system, 6);
    let rate = value(&system, &state, "b.angular_velocity - a.angular_velocity");
    let expected = -potential_rate(&system, &state) - 0.3 * rate * rate;
    assert_close(power(&system, &state), expected, 1e-8);
}

#[test]
fn spring_without_stiffness_adds_no_terms() {
    let mut m = Model::new();
    m.body("a", "1", "1", "xya", &[]);
    m.effect(SpringDamper {
        between: m.between("ground", "a"),
        along: None,
        stiffness: formula("0"),
        damping: formula("0"),
        free_length: formula("2"),
        force: None,
    });
    let system = m.build();
    assert!(system.force.iter().all(|&force| system.graph.is_zero(force)));
}

/// ½ k s² is no potential of a force whose k depends on where the spring is.
#[test]
fn a_stiffness_that_depends_on_the_motion_leaves_no_potential() {
    let mut m = two_bodies();
    m.effect(spring(&m, Some(pair("1", "0")), "k*(1 + a.x^2)", "0"));
    let system = m.build();
    assert!(system.graph.is_zero(output(&system, "potential_energy")));
}

/// Coulomb's friction, smoothed, of a pin: effects may depend on reactions.
#[test]
fn effects_may_depend_on_reactions() {
    let mut m = Model::new();
    m.body("a", "1", "1", "xya", &[("P", "1", "0")]);
    m.revolute("pin", "ground", "a.P");
    let friction = vector(["0", "0", "-0.01*pin.force*tanh(100*a.angular_velocity)"]);
    m.effect(Torque { on: TorqueOn::Body(1), from: None, value: AboutAxes(friction), frame: ForceFrame::Ground });
    let system = m.build();
    let symbols = system.graph.symbols_of(&[system.force[2]]);
    assert!(system.lambda.iter().all(|lambda| symbols.contains(lambda)));
}
