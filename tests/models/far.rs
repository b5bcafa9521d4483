//! Effects that act only sometimes: their cost while they do not act. No sample's numbers depend on which other samples
//! touch.

use std::fmt::Write as _;

use mbint::inner::export::bounds_csv;
use mbint::inner::numerics::Sample;
use mbint::inner::simulate::{Simulator, Stepper};
use mbint::inner::study::prepare;
use symdiff::Tape;

use crate::common::{Subject, read, run};

const STEP: f64 = 1e-3;

/// The paper's slider crank, with more effects.
fn slider_crank(points: &str, effects: &str) -> Subject {
    let text = include_str!("../../models/slider_crank.yaml")
        .replace("bodies:\n", &format!("bodies:\n  ground: {{ points: {{ O: [0, 0]{points} }} }}\n"))
        .replace("initial:", &format!("{effects}initial:"));
    read(&text)
}

/// Floors far below the crank and the rod.
fn floors(count: usize) -> Subject {
    let (mut points, mut effects) = (String::new(), String::new());
    for i in 0..count {
        let point = ["crank.B", "rod.C", "rod", "crank"][i % 4];
        let _ = write!(points, ", F{i}: [0, -{}]", 1 + i);
        let _ = writeln!(
            effects,
            "  floor{i}: {{ contact: {{ between: [ground.F{i}, {point}], plane: y, radius: 0.05, impact: {{ stiffness: 1e6, \
             dissipation: 0.3 }}, friction: {{ coefficient: 0.3, breakaway: 1.2, stribeck_velocity: 0.1 }} }} }}"
        );
    }
    slider_crank(&points, &effects)
}

/// Instructions of a step with one correction, where everything touches or nothing does.
fn instructions(simulator: &Simulator, active: bool) -> usize {
    let p = &simulator.program;
    [p.step(), p.factor(), p.first_correction(), p.advance()]
        .map(|tape: &Tape| tape.len_where(active))
        .into_iter()
        .sum()
}

/// Bare, and then a few instructions for each contact: its gap and the greatest of the gaps, when the matrix is
/// factorised and in each iteration.
#[test]
fn distant_contact_costs_only_its_gap() {
    let bare = prepare(slider_crank("", "").study().description()).unwrap();
    assert_eq!(instructions(&bare, true), instructions(&bare, false));
    let mut before = instructions(&bare, true);
    for count in [1, 2, 4, 16] {
        let simulator = prepare(floors(count).study().description()).unwrap();
        let [all, apart] = [true, false].map(|active| instructions(&simulator, active));
        println!("{count} contacts: {all} instructions, {apart} while apart, {before} before");
        assert!(all > instructions(&bare, true) + 30 * count, "{count}: {all}");
        assert!(apart <= instructions(&bare, true) + 8 + 10 * count, "{count}: {apart}");
        before = apart;
    }
}

/// Numbers of samples, jets of parameters and closures alike: far contacts change nothing but the last digits.
#[test]
fn distant_contacts_leave_every_method_unchanged() {
    let [bare, far] = [0, 3].map(|count| run(&floors(count).duration(0.3)));
    assert!(bare.outputs[0].bands.len() >= 3);
    for (a, b) in bare.outputs[0].bands.iter().zip(&far.outputs[0].bands) {
        assert_eq!(a.method, b.method);
        for (a, b) in a.lower.iter().chain(&a.upper).zip(b.lower.iter().chain(&b.upper)) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }
}

/// Every lane of a wide tile against the same sample alone, where lanes touch at different times, or not at all.
fn agrees_with_samples_alone(description: &Subject, width: usize, steps: usize) -> (usize, usize) {
    let simulator = prepare(description.study().description()).unwrap();
    let sample = |lane: usize| -> Sample {
        let share = (lane as f64 + 0.5) / width as f64;
        simulator.system.parameters.iter().map(|p| p.lower + share * (p.upper - p.lower)).collect()
    };
    let stepper = |width: usize, first: usize| {
        let start = simulator.assemble(width, STEP, |lane| sample(first + lane)).unwrap();
        Stepper::new(&simulator.program, &start)
    };
    let mut together = stepper(width, 0);
    let mut alone: Vec<Stepper> = (0..width).map(|lane| stepper(1, lane)).collect();
    let outputs = simulator.program.outputs.len();
    let (mut observed, mut one) = (vec![0.0; outputs * width], vec![0.0; outputs]);
    let (mut mixed, mut touched) = (0, 0);
    for step in 1..=steps {
        let end = step as f64 * STEP;
        assert!(together.step(STEP, end).is_empty(), "step {step}");
        together.observe(&mut observed);
        let state = together.save();
        let registers = state.len() / width;
        let mut active = 0;
        for (lane, alone) in alone.iter_mut().enumerate() {
            assert!(alone.step(STEP, end).is_empty(), "step {step}, lane {lane}");
            for (register, value) in alone.save().iter().enumerate() {
                let found = state[register * width + lane];
                assert_eq!(
                    found.to_bits(),
                    value.to_bits(),
                    "step {step}, lane {lane}, register {register} of {registers}"
                );
            }
            alone.observe(&mut one);
            for (output, value) in one.iter().enumerate() {
                assert_eq!(observed[output * width + lane].to_bits(), value.to_bits(), "step {step}, lane {lane}");
            }
            // The last output is the force that pushes.
            active += usize::from(one[outputs - 1] != 0.0);
        }
        touched += active;
        mixed += usize::from(active > 0 && active < width);
    }
    (mixed, touched)
}

#[test]
#[ignore = "10 s: every lane alone"]
fn results_of_a_sample_do_not_depend_on_other_contacts() {
    // A slider that runs into a buffer, deeper the longer the crank is; one crank is too short.
    let buffer = "  buffer: { contact: { between: [ground.W, slider], plane: [-1, 0], impact: { stiffness: 1e4, dissipation: 0.1 }, \
                  friction: { coefficient: 0.2 } } }\n";
    let crank = slider_crank(", W: [l2 + 0.1488, 0]", buffer);
    let text = |outputs: &str| {
        format!(
            "
parameters: {{ h: {{ interval: [0.3, 1.2], unit: m }} }}
bodies:
  ball: {{ mass: 1, inertia: 0.004 }}
  other: {{ mass: 2, inertia: 0.004 }}
joints: {{ rail: {{ prismatic: {{ between: [ground, other], axis: y }} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  floor:
    contact:
      {{ between: [ground, ball], plane: y, radius: 0.1, impact: {{ stiffness: 1e5, exponent: 1.3, restitution: 0.8, impact_velocity: 3, law: hunt_crossley }},
        friction: {{ coefficient: 0.3, breakaway: 1.2, stribeck_velocity: 0.1 }} }}
  meeting: {{ contact: {{ between: [other, ball], circle: 0.1, radius: 0.1, impact: {{ stiffness: 1e5 }} }} }}
  ends: {{ stop: {{ on: rail, lower: 0.1, upper: 3, impact: {{ stiffness: 1e5, dissipation: 0.2 }} }} }}
  leash: {{ cable: {{ between: [ground, ball], free_length: 0.9, stiffness: 1e4, damping: 5, transition: 1 mm }} }}
initial:
  {{ ball.x: 0.05, ball.y: h, ball.angle: 0, ball.vx: 0.4, ball.vy: 0, ball.angular_velocity: 3, other.y: h + 0.4, other.vy: 0 }}
outputs: {{ {outputs} }}
simulation: {{ duration: 1, step: 1e-3 }}
bounds: {{ scan: {{ points: 5 }} }}
"
        )
    };
    let balls = read(&text(
        "x: ball.x, rim: leash.force, ends: ends.force, met: meeting.force, energy: energy, push: floor.force",
    ));
    let runs = [1, 2, 7].map(|threads| {
        let result = balls.clone().duration(0.6).scan(37).study().threads(threads).run().unwrap();
        bounds_csv(result.bounds()).unwrap()
    });
    assert!(runs[0] == runs[1] && runs[0] == runs[2], "results depend on the number of threads");
    for (description, steps) in [(crank.observing(&["slider.x", "buffer.force"]), 700), (balls, 900)] {
        for width in [4, 32] {
            let (mixed, touched) = agrees_with_samples_alone(&description, width, steps);
            println!("{}: width {width}: {mixed} of {steps} steps mixed, {touched} lanes touched", description.name());
            assert!(mixed > 20 && touched < steps * width / 2, "{mixed} mixed, {touched} touched");
        }
    }
}
