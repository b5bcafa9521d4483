//! Orders of manufactured motions: models with known theory, and obstacles to a verification.

use mbint::{Error, Exchange, Model, Quantity, Verification};

fn of_file(path: &str) -> Model {
    Model::from_file(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn of_model(name: &str) -> Verification {
    of_file(&format!("models/{name}")).verify().unwrap()
}

/// Orders of all quantities by a scheme of a formulation.
fn orders(found: &Verification, formulation: usize, scheme: usize) -> Vec<(Quantity, f64)> {
    let convergence = &found.formulations[formulation].schemes[scheme].convergence;
    convergence.iter().map(|own| (own.quantity, own.order.unwrap())).collect()
}

#[test]
fn slider_crank_has_theoretical_orders_in_both_formulations() {
    let found = of_model("slider_crank.yaml");
    assert!(found.is_verified(), "{found:?}");
    assert_eq!(found.formulations.len(), 2);
    for formulation in 0..2 {
        for (scheme, theory, within) in [(0, 2.0, 0.05), (1, 4.0, 0.15)] {
            let orders = orders(&found, formulation, scheme);
            assert_eq!(orders.len(), 4, "positions, velocities, accelerations and reactions");
            assert!(orders.iter().all(|(_, order)| (order - theory).abs() < within), "{scheme}: {orders:?}");
        }
        // Order 8, until errors are those of rounding.
        let explicit = orders(&found, formulation, 2);
        assert!(explicit.iter().all(|(_, order)| *order > 7.5), "{explicit:?}");
    }
}

#[test]
fn rolling_states_and_redundant_loops_are_verified() {
    for (name, quantity) in [
        ("coin.yaml", Quantity::Reactions),
        ("held_arm.yaml", Quantity::States),
        ("planetary_gear.yaml", Quantity::Reactions),
        ("four_bar.yaml", Quantity::Reactions),
    ] {
        let found = of_model(name);
        assert!(found.is_verified(), "{name}: {found:?}");
        let has = |own: &&mbint::Convergence| own.quantity == quantity;
        let convergence = &found.formulations[0].schemes[0].convergence;
        assert!(convergence.iter().any(|own| has(&own)), "{name}");
    }
}

#[test]
fn a_model_that_takes_no_steps_is_refused() {
    let error = of_file("docs/examples/statics.yaml").verify().unwrap_err();
    assert!(matches!(error, Error::Verify(_)), "{error}");
    assert!(error.to_string().contains("takes no steps"), "{error}");
}

/// A force with a corner in the middle of every part of the run.
#[test]
fn a_kink_is_named() {
    let text = "model: kink\nbodies:\n  block: { mass: 1, coordinates: [x] }\neffects:\n  \
                push: { force: { on: block, value: [\"abs(sin(4000*t))\", 0] } }\noutputs: { x: block.x }\n\
                simulation: { duration: 1, step: 1e-3 }\n";
    let found = Model::from_yaml_str("kink.yaml", text).unwrap().verify().unwrap();
    assert!(!found.is_verified());
    let why = found.formulations[0].failure.as_deref().unwrap();
    assert!(why.contains("not smooth"), "{why}");
}

/// Exchange of energy of each effect of a block on a spring; the equations' rows are balanced.
fn exchanges(effects: &str) -> Vec<Exchange> {
    let text = format!(
        "model: block\nbodies:\n  block: {{ mass: 2, inertia: 0.1, coordinates: [x, y, angle], points: {{ P: [0.3, -0.2] }} }}\n\
         effects:\n{effects}initial: {{ block.x: 0.4, block.y: 0.1, block.angle: 0.2, block.vx: 1, block.angular_velocity: 3 }}\n\
         outputs: {{ x: block.x }}\nsimulation: {{ duration: 0.5, step: 1e-3 }}\n"
    );
    let found = Model::from_yaml_str("block.yaml", &text).unwrap().verify().unwrap();
    let balance = found.formulations[0].balance.as_ref().unwrap();
    assert!(balance.size > 1.0 && balance.defect < 1e-14, "{balance:?}");
    balance.effects.iter().map(|effect| effect.exchange()).collect()
}

#[test]
fn effects_conserve_dissipate_or_supply_energy() {
    let found = exchanges(
        "  weight: { gravity: { acceleration: [0, -9.81] } }
  spring: { spring_damper: { between: [ground, block.P], stiffness: 80, free_length: 0.1 } }
  damper: { spring_damper: { between: [ground, block.P], damping: 3 } }
  air: { drag: { on: block.P, linear: 2, quadratic: 0.5 } }
  wind: { drag: { on: block, linear: 2, wind: [5, 0] } }
  push: { force: { on: block.P, value: [\"cos(40*t)\", 3] } }
  nothing: { force: { on: block.P, value: [0, 0] } }
",
    );
    use Exchange::{Conserves, Dissipates, Drives, None};
    assert_eq!(found, [Conserves, Conserves, Dissipates, Dissipates, Drives, Drives, None]);
}

#[test]
#[ignore = "2 s"]
fn powers_are_balanced_in_every_formulation() {
    // Joints of several axes, rolling, gear teeth, states, and contacts that open.
    for name in
        ["delta_robot.yaml", "coin.yaml", "planetary_gear.yaml", "held_arm.yaml", "heavy_top.yaml", "wiper.yaml"]
    {
        let found = of_model(name);
        for formulation in &found.formulations {
            let balance = formulation.balance.as_ref().unwrap();
            assert!(
                balance.is_verified() && balance.defect < 1e-12,
                "{name}, {}: {balance:?}",
                formulation.formulation
            );
        }
    }
}

/// Symbolic derivatives, the Newton matrix with and without links, jets and adjoints are those of differences.
#[test]
#[ignore = "4 s"]
fn derivatives_match_differences() {
    for name in ["slider_crank.yaml", "humanoid.yaml", "coin.yaml", "held_arm.yaml", "quarter_car.yaml"] {
        let found = of_model(name);
        for formulation in &found.formulations {
            let checked: Vec<(&str, &str)> =
                formulation.derivatives.iter().map(|check| (check.of.as_str(), check.by.as_str())).collect();
            for expected in [
                ("equations of motion", "velocities"),
                ("outputs", "motion and parameters, backwards"),
                ("step of HHT-I3", "accelerations and reactions"),
            ] {
                assert!(checked.contains(&expected), "{name}: {expected:?} of {checked:?}");
            }
            for check in &formulation.derivatives {
                assert!(check.difference < 1e-13, "{name}, {}: {check:?}", formulation.formulation);
            }
        }
    }
}

/// A stop that is met in the middle of the run: a part before it and one behind are verified, and neither has it.
#[test]
fn parts_before_and_after_a_stop_are_verified() {
    let text = "model: stop\nbodies:\n  block: { mass: 1, coordinates: [x] }\njoints: { guide: { prismatic: { between: [ground, block], axis: x } } }\n\
                effects:\n  end: { stop: { on: guide, upper: 0.5, impact: { stiffness: 1e3, dissipation: 0.2 } } }\n\
                initial: { block.x: 0, block.vx: 1 }\noutputs: { x: block.x }\nsimulation: { duration: 1.2, step: 1e-3 }\n";
    let found = Model::from_yaml_str("stop.yaml", text).unwrap().verify().unwrap();
    assert!(found.is_verified(), "{found:?}");
    let parts: Vec<[f64; 2]> = found
        .formulations
        .iter()
        .filter(|own| own.formulation == "absolute")
        .map(|own| [own.begin, own.begin + own.duration])
        .collect();
    // It is met at 0.5 s, and left after half a period of the stop, 0.1 s.
    assert!(parts.len() == 2 && parts[0][0] == 0.0 && parts[0][1] <= 0.5 && parts[1][0] > 0.5, "{parts:?}");
}

/// A parallelogram with a third crank that starts at an angle.
fn parallelogram(angle: f64) -> Verification {
    let text = format!(
        "model: parallelogram\nbodies:\n  ground: {{ points: {{ B: [1, 0], C: [2, 0] }} }}\n\
             {}  bar: {{ mass: 1, inertia: 0.1, points: {{ A: [-1, 0], B: [0, 0], C: [1, 0] }} }}\n\
             joints: {{ ja: {{ revolute: [ground, a.A] }}, jb: {{ revolute: [ground.B, b.A] }}, jc: {{ revolute: [ground.C, c.A] }}, \
             pa: {{ revolute: [a.P, bar.A] }}, pb: {{ revolute: [b.P, bar.B] }}, pc: {{ revolute: [c.P, bar.C] }} }}\n\
             effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}\n\
             initial: {{ a.angle: {angle}, a.angular_velocity: 0 }}\nguess: {{ b.angle: {angle}, c.angle: {angle}, bar.angle: 0 }}\n\
             outputs: {{ x: bar.x }}\nsimulation: {{ duration: 0.5, step: 1e-3 }}\n",
        ["a", "b", "c"]
            .map(|name| format!("  {name}: {{ mass: 1, inertia: 0.1, points: {{ A: [-0.5, 0], P: [0.5, 0] }} }}\n"))
            .concat()
    );
    Model::from_yaml_str("parallelogram.yaml", &text).unwrap().verify().unwrap()
}

/// A constraint follows from others.
#[test]
fn redundant_constraints_are_named() {
    let found = parallelogram(1.0);
    assert!(found.is_verified(), "{found:?}");
    assert!(found.formulations.iter().all(|own| own.redundant.len() == 1 && own.singular_at_start.is_empty()));
}

/// Where all cranks lie along the bar, two more constraints depend on others at the start.
#[test]
#[ignore = "a minute: orders do not show so near to a singular position"]
fn singular_constraints_are_named() {
    let found = parallelogram(0.0);
    assert!(found.formulations.iter().all(|own| own.redundant.len() == 1 && own.singular_at_start.len() == 2));
}
