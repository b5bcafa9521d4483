//! Forces that change very fast with the time, under a tolerance: they are resolved where that is possible, and
//! otherwise refused in words and at once.

use std::sync::atomic::{AtomicUsize, Ordering};

use mbint::Model;

use crate::common::{curve, distance_from, nominal, read};

/// A block of 3 kg on a spring of 48 N/m, released 0.02 m from its equilibrium, under a force.
fn pushed(force: &str, duration: f64) -> String {
    format!(
        "
parameters: {{ m: {{ value: 3, unit: kg, tolerance: 2% }}, p: {{ interval: [0.3, 0.31] }} }}
bodies: {{ block: {{ mass: m, coordinates: [x] }} }}
effects: {{ drive: {{ force: {{ on: block, value: [\"-48*block.x + {force}\", 0] }} }} }}
initial: {{ block.x: 0.02, block.vx: 0 }}
outputs: {{ x: block.x }}
simulation: {{ duration: {duration}, output_step: 0.5, tolerance: 1e-4 }}
bounds: {{ scan: {{ points: 3 }} }}
"
    )
}

/// Why a model is not simulated.
fn refusal(text: &str) -> String {
    Model::from_yaml_str("pushed", text).unwrap().study().run().unwrap_err().to_string()
}

#[test]
fn a_force_of_very_short_periods_is_refused_at_once() {
    for (force, formula) in [
        ("90*cos(2.3e7*t + p)", "`cos(p + (23000000*t))` in the motion of `block.x` has a period near "),
        ("90*sign(sin(2.3e7*t + p))", "`sin(p + (23000000*t))` in the motion of `block.x` has a period near "),
        ("90*(3.66e6*t + p - floor(3.66e6*t + p))", " has a period near "),
    ] {
        let message = refusal(&pushed(force, 5.0));
        let (_, rest) = message.split_once(formula).unwrap_or_else(|| panic!("{message}"));
        let period: f64 = rest.split_once(' ').unwrap().0.parse().unwrap();
        assert!((0.3..3.0).contains(&(period / 2.73e-7)), "{message}");
        assert!(message.contains("2000000 are the most"), "{message}");
    }
}

/// Ten thousand oscillations within a millisecond of five seconds, which move nothing.
#[test]
fn a_burst_is_resolved() {
    let text = pushed("90*cos(2e6*t)*exp(-((t - 2.2)/5e-4)^2)", 5.0);
    let bounds = nominal(&read(&text));
    let off = distance_from(&bounds.times, curve(&bounds, "x"), |t| 0.02 * (4.0 * t).cos());
    assert!(off < 1e-4 * 0.04, "{off:e}");
}

/// A condition and its negative change at the same time, whatever the parameters are: that is one jump. Here the signs'
/// sum is 10 to the jump, and −10 then.
#[test]
fn coinciding_jumps_are_one_jump() {
    let text = pushed("5*sign(sin(2*t) + 1e-3 - 1e-3) - 5*sign(-sin(2*t))", 2.0);
    let bounds = nominal(&read(&text));
    let (jump, force) = (0.5 * std::f64::consts::PI, 10.0 / 48.0);
    // About the equilibrium 10/48 m until sin(2t) changes its sign, about −10/48 m then.
    let first = |t: f64| (force + (0.02 - force) * (4.0 * t).cos(), -4.0 * (0.02 - force) * (4.0 * t).sin());
    let x = |t: f64| {
        if t < jump {
            return first(t).0;
        }
        let (at, speed) = first(jump);
        let since = 4.0 * (t - jump);
        -force + (at + force) * since.cos() + speed / 4.0 * since.sin()
    };
    let off = distance_from(&bounds.times, curve(&bounds, "x"), x);
    assert!(off < 1e-4 * 0.6, "{off:e}");
}

/// Two square waves whose jumps coincide for some phases: no step separates these, however short.
#[test]
fn possibly_coinciding_jumps_do_not_shorten_steps() {
    let text = pushed("9*sign(sin(20*t + p)) + 9*sign(sin(20*t + 1.01*p))", 2.0);
    let bounds = nominal(&read(&text));
    // Each half period has a constant force: amplitudes about its equilibrium.
    let jumps: Vec<f64> = [0.305, 0.305 * 1.01]
        .iter()
        .flat_map(|phase| (1..14).map(move |k| (f64::from(k) * std::f64::consts::PI - phase) / 20.0))
        .collect();
    let exact = |t: f64| {
        // A step of force F at t0 adds F/k (1 − cos ω(t − t0)).
        let step = |force: f64, at: f64| if t > at { force / 48.0 * (1.0 - (4.0 * (t - at)).cos()) } else { 0.0 };
        let later: f64 =
            jumps.iter().enumerate().map(|(index, &at)| step(if index % 13 % 2 == 0 { -18.0 } else { 18.0 }, at)).sum();
        0.02 * (4.0 * t).cos() + step(18.0, 0.0) + later
    };
    let off = distance_from(&bounds.times, curve(&bounds, "x"), exact);
    assert!(off < 1e-4 * 0.5, "{off:e}");
}

#[test]
fn interruption_ends_a_search_for_steps() {
    let asked = AtomicUsize::new(0);
    let interrupted = || asked.fetch_add(1, Ordering::Relaxed) > 20;
    // Some hundred thousand steps, which take seconds.
    let model = Model::from_yaml_str("pushed", &pushed("90*cos(3e4*t + p)", 5.0)).unwrap();
    let result = model.study().threads(1).interrupted(&interrupted).run();
    let rows = result.as_ref().map_or(0, |result| result.times().len());
    assert!(rows < 11, "{rows} rows");
    assert!(asked.load(Ordering::Relaxed) < 1000, "{asked:?}");
    if let Ok(result) = result {
        assert!(result.failure().is_some());
    }
}
