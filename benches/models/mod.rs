//! The mechanisms of the measurements.

#![allow(dead_code)] // no bench uses all of it

use std::fmt::Write;

use mbint::Model;
use mbint::inner::simulate::{Simulator, Stepper};
use mbint::inner::study;

/// Step size of all runs, s.
pub const STEP: f64 = 1e-3;

/// The slider crank of Wu, Luo & Zhang.
pub fn slider_crank() -> Model {
    read("slider_crank.yaml", include_str!("../../models/slider_crank.yaml"))
}

/// The IFToMM benchmark's chain of four-bar loops: 2N+1 uniform bars of 1 m and 1 kg, the upper end of the first moving
/// at 1 m/s, under gravity.
pub fn four_bar(loops: usize) -> Model {
    read("four_bar.yaml", &four_bar_yaml(loops))
}

/// The model file of [`four_bar`].
pub fn four_bar_yaml(loops: usize) -> String {
    let (mut bodies, mut joints) = (String::new(), String::new());
    let mut ground = Vec::new();
    for i in 0..=loops {
        ground.push(format!("P{i}: [{i}, 0]"));
        _ = writeln!(bodies, "  bar{i}: {{ mass: m, inertia: m*l^2/12, points: {{ A: [0, -l/2], B: [0, l/2] }} }}");
        _ = writeln!(joints, "  pivot{i}: {{ revolute: [ground.P{i}, bar{i}.A] }}");
    }
    for i in 0..loops {
        let next = i + 1;
        _ = writeln!(bodies, "  link{i}: {{ mass: m, inertia: m*l^2/12, points: {{ A: [-l/2, 0], B: [l/2, 0] }} }}");
        _ = writeln!(joints, "  left{i}: {{ revolute: [bar{i}.B, link{i}.A] }}");
        _ = writeln!(joints, "  right{i}: {{ revolute: [link{i}.B, bar{next}.B] }}");
    }
    let guess: Vec<String> = (0..=loops)
        .map(|i| format!("bar{i}.x: {i}, bar{i}.y: 0.5"))
        .chain((0..loops).map(|i| format!("link{i}.x: {i}.5, link{i}.y: 1")))
        .collect();
    format!(
        "model: four_bar_{loops}\n\
         parameters:\n  m: {{ value: 1, unit: kg, tolerance: 1% }}\n  l: {{ value: 1, unit: m }}\n\
         bodies:\n  ground: {{ points: {{ {} }} }}\n{bodies}\
         joints:\n{joints}\
         effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}\n\
         initial: {{ bar0.angle: 0, bar0.angular_velocity: -1 }}\n\
         guess: {{ {} }}\n\
         outputs: {{ x: bar0.B.x, y: bar0.B.y }}\n\
         simulation: {{ duration: 10, step: 1e-3, output_step: 0.1 }}\n",
        ground.join(", "),
        guess.join(", "),
    )
}

/// A compiled and assembled model.
pub fn prepare(model: &Model) -> Simulator {
    study::prepare(model.study().description()).unwrap_or_else(|error| panic!("{}: {error}", model.name()))
}

/// A tile of samples spread over the parameters' intervals, ready to step.
pub fn stepper(simulator: &Simulator, width: usize) -> Stepper<'_> {
    let sample = |lane: usize| {
        let share = (lane as f64 + 0.5) / width as f64;
        simulator.system.parameters.iter().map(|p| p.lower + share * (p.upper - p.lower)).collect()
    };
    let start = simulator.assemble(width, STEP, sample).expect("every sample can be assembled");
    Stepper::new(&simulator.program, &start)
}

fn read(name: &str, text: &str) -> Model {
    Model::from_yaml_str(name, text).unwrap_or_else(|error| panic!("{error}"))
}
