use crate::assemble::System;
use crate::elements::effects::{Exponent, RestitutionLaw};
use crate::grammar::{BodyRef, Components, Direction, PerAxis, Rotating};
use crate::model::beam::Flexible;
use crate::model::bushing::SixBySix;
use crate::model::force::Frame;
use crate::model::torque::{AboutAxes, TorqueOn};
use crate::model::{
    Backlash, Beam, Bushing, Cable, Contact, DryFriction, EffectKind, Force, Friction, Impact, Preload, SpringDamper,
    Torque, TorsionalSpringDamper,
};

use super::model::{Model, formula, pair, vector};
use super::numbers::{State, assert_close, output, time_derivative};

/// Two free bodies with an offset point and centre of mass each.
fn two_bodies() -> Model {
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

/// Σ Q v of the effects alone: without what the same bodies feel by inertia.
fn power(with: &System, state: &State) -> f64 {
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

fn value(system: &System, state: &State, name: &str) -> f64 {
    state.value(&system.graph, output(system, name))
}

/// dV/dt along a motion, by finite differences.
fn potential_rate(system: &System, state: &State) -> f64 {
    let h = 1e-5;
    let ends = [h, -h].map(|h| {
        let mut moved = state.later(system, h);
        moved.0.insert(system.time, state.0[&system.time]);
        value(system, &moved, "potential_energy")
    });
    (ends[0] - ends[1]) / (2.0 * h)
}

#[test]
fn a_force_has_the_power_of_its_point() {
    let mut m = two_bodies();
    m.effect(Force { on: m.point("a.P"), value: Components(pair("3 + t", "-2*b.x")), frame: Frame::Ground });
    let system = m.build();
    let state = State::random(&system, 1);
    let force = [3.7, -2.0 * state.0[&system.q[3]]];
    let expected = force[0] * value(&system, &state, "a.P.vx") + force[1] * value(&system, &state, "a.P.vy");
    assert_close(power(&system, &state), expected, 1e-13);
}

#[test]
fn a_force_in_the_body_turns_with_it() {
    let mut m = two_bodies();
    m.effect(Force { on: m.point("a.P"), value: Components(pair("3", "-2")), frame: Frame::Body });
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
        frame: Frame::Ground,
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
fn nothing_is_left_of_a_spring_without_stiffness() {
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

/// Coulomb's friction, smoothed, of a pin: effects may speak of reactions.
#[test]
fn effects_may_speak_of_reactions() {
    let mut m = Model::new();
    m.body("a", "1", "1", "xya", &[("P", "1", "0")]);
    m.revolute("pin", "ground", "a.P");
    let friction = vector(["0", "0", "-0.01*pin.force*tanh(100*a.angular_velocity)"]);
    m.effect(Torque { on: TorqueOn::Body(1), from: None, value: AboutAxes(friction), frame: Frame::Ground });
    let system = m.build();
    let symbols = system.graph.symbols_of(&[system.force[2]]);
    assert!(system.lambda.iter().all(|lambda| symbols.contains(lambda)));
}

fn elastic(stiffness: &str) -> Impact {
    Impact {
        stiffness: formula(stiffness),
        exponent: Exponent(1.5),
        dissipation: None,
        restitution: None,
        impact_velocity: None,
        law: RestitutionLaw::HuntCrossley,
    }
}

/// What pulls, touches, meshes and presses without loss: its power is minus the rate of its energy. Radii and lengths are
/// such that it acts wherever the bodies are, and nowhere just at its corner.
#[test]
fn what_takes_nothing_has_its_potential() {
    let m = two_bodies();
    let between = m.between("a.P", "b.P");
    let contact = || {
        let (radius, impact) = (formula("0.9"), elastic("k"));
        Contact { between, plane: None, circle: None, hollow: None, radius, axis: None, impact, friction: None }
    };
    let cable = Cable {
        between,
        free_length: formula("0.05"),
        stiffness: formula("k"),
        damping: formula("0"),
        transition: formula("0.01"),
    };
    let backlash = Backlash {
        between: [Rotating::Body(m.body_index("a")), Rotating::Body(m.body_index("b"))],
        ratio: formula("-1.7"),
        offset: formula("0.1"),
        backlash: formula("0.02"),
        stiffness: formula("k"),
        damping: formula("0"),
        transition: formula("0.3"),
    };
    // A symmetric matrix with everything in it that the plane has.
    let row = |texts: [&str; 6]| texts.map(formula);
    let matrix = [
        row(["30", "4", "0", "0", "0", "2"]),
        row(["4", "50", "0", "0", "0", "-3"]),
        row(["0"; 6]),
        row(["0"; 6]),
        row(["0"; 6]),
        row(["2", "-3", "0", "0", "0", "k/10"]),
    ];
    let beam = Beam {
        between,
        axis: Direction(pair("1", "0.5")),
        length: formula("0.7"),
        axial_stiffness: formula("k"),
        bending_stiffness: formula("3"),
        damping: formula("0"),
        flexible: None,
    };
    let nothing = || PerAxis([0.0; 3].map(symdiff::Formula::number));
    let bushing = Bushing {
        between,
        stiffness: nothing(),
        damping: nothing(),
        torsional_stiffness: nothing(),
        torsional_damping: nothing(),
        stiffness_matrix: Some(SixBySix(Box::new(matrix))),
        damping_matrix: None,
    };
    let kinds = [
        Contact { plane: Some(Direction(pair("1", "2"))), ..contact() }.into(),
        Contact { circle: Some(formula("3")), ..contact() }.into(),
        Contact { hollow: Some(formula("0.91")), ..contact() }.into(),
        EffectKind::Cable(cable),
        EffectKind::Backlash(backlash),
        EffectKind::Preload(Preload { between: Some(between), on: None, value: formula("k/3") }),
        EffectKind::Beam(beam),
        EffectKind::Bushing(bushing),
    ];
    for (index, kind) in kinds.into_iter().enumerate() {
        let mut m = two_bodies();
        m.effect(kind);
        let system = m.build();
        let mut acting = 0;
        for seed in 0..6 {
            let state = State::random(&system, seed);
            let (power, rate) = (power(&system, &state), potential_rate(&system, &state));
            assert!((power + rate).abs() <= 1e-6 * (1.0 + power.abs()), "effect {index}: {power} is not {}", -rate);
            acting += usize::from(power.abs() > 1e-3);
        }
        assert!(acting >= 2, "effect {index} did nothing");
    }
}

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

/// Friction of a contact takes power, and no more than the load times the speed.
#[test]
fn rubbing_takes_power() {
    let contact = |friction: Option<Friction>| {
        let mut m = two_bodies();
        let between = m.between("a.P", "b.P");
        let (circle, radius, impact) = (Some(formula("3")), formula("0.9"), elastic("k"));
        m.effect(Contact { between, plane: None, circle, hollow: None, radius, axis: None, impact, friction });
        m.output("effect0.force");
        m.build()
    };
    let speed = DryFriction {
        breakaway: formula("1.5"),
        stribeck_velocity: Some(formula("0.1")),
        transition_velocity: formula("0.01"),
    };
    let law = Friction { coefficient: formula("0.3"), speed };
    let (smooth, rough) = (contact(None), contact(Some(law)));
    for seed in 0..5 {
        let [without, with] = [&smooth, &rough].map(|system| power(system, &State::random(system, seed)));
        let load = value(&rough, &State::random(&rough, seed), "effect0.force");
        assert!(load > 1.0 && with < without, "{with} {without}");
        assert!(without - with < 0.3 * 1.5 * load * 10.0);
    }
}
