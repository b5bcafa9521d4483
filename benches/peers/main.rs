//! Times and errors of mbint and of the plain scalar implementation, for `benches/peers/run`, as JSON. With an argument
//! N: the model file of the N-four-bar.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

#[path = "../models/mod.rs"]
mod models;
mod scalar;

use std::time::Instant;

use mbint::inner::numerics::Sample;
use mbint::inner::simulate::{EnsembleRun, Integrator, JetBox, Observed, Schedule, Simulator, Steps, jet_integrator};
use mbint::results::Method;
use models::STEP;
use serde_json::{Value, json};
use symdiff::jet::JetSpace;

/// Samples of a batch.
const BATCH: usize = 64;

fn main() {
    let wanted = std::env::args().nth(1);
    if let Some(loops) = wanted.and_then(|loops| loops.parse().ok()) {
        print!("{}", models::four_bar_yaml(loops));
        return;
    }
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let mut report = one.install(|| {
        json!({
            "slider": slider_crank(),
            "taylor": taylor(),
            "four_bar_2": four_bar(2, 10.0, 10_000),
            "four_bar_40": four_bar(40, 10.0, 60),
            "scaling": scaling(),
        })
    });
    report["scan"] = scan();
    println!("{report}");
}

/// Smallest time of several runs, s, and the result of the last one.
fn best<T>(repetitions: usize, mut run: impl FnMut() -> T) -> (f64, T) {
    let mut timed = || {
        let begun = Instant::now();
        let result = run();
        (begun.elapsed().as_secs_f64(), result)
    };
    let mut best = timed();
    for _ in 1..repetitions {
        let (seconds, result) = timed();
        best = (best.0.min(seconds), result);
    }
    best
}

/// Samples over the parameters' intervals; the nominal one for a count of one.
fn samples(simulator: &Simulator, count: usize) -> Vec<Sample> {
    let parameters = &simulator.system.parameters;
    if count == 1 {
        return vec![parameters.iter().map(|parameter| parameter.nominal).collect()];
    }
    let share = |sample: usize| sample as f64 / (count - 1) as f64;
    (0..count)
        .map(|sample| parameters.iter().map(|p| p.lower + share(sample) * (p.upper - p.lower)).collect())
        .collect()
}

/// A whole run, assembly included: the outputs of all rows.
fn run(simulator: &Simulator, count: usize, schedule: &Schedule) -> Vec<f64> {
    let mut ensemble =
        EnsembleRun::start(simulator, &samples(simulator, count), STEP).expect("all samples can be assembled");
    let mut values = Vec::new();
    let stops =
        ensemble.advance(Steps { schedule, controller: None }, 0..schedule.rows, Observed::Outputs, &mut values);
    assert!(stops.is_empty(), "all samples reach the end");
    values
}

fn slider_crank() -> Value {
    let description = models::slider_crank();
    let (preparation, simulator) = best(5, || models::prepare(&description));
    // A row every 0.25 s, as in the reference.
    let schedule = Schedule::fixed(2.0, STEP, 0.25);
    let (single, values) = best(20, || run(&simulator, 1, &schedule));
    let (batch, _) = best(10, || run(&simulator, BATCH, &schedule));
    let (scalar, positions) = best(5, || {
        let (crank, mut state) = scalar::SliderCrank::start();
        let mut positions = vec![state.q[6]];
        for _ in 1..schedule.rows {
            scalar::advance(&crank, &mut state, STEP, 250);
            positions.push(state.q[6]);
        }
        positions
    });
    json!({
        "preparation": preparation, "single": single, "batch": batch / BATCH as f64, "values": values,
        "scalar": scalar, "scalar_values": positions,
    })
}

fn taylor() -> Value {
    let simulator = models::prepare(&models::slider_crank());
    let schedule = Schedule::fixed(2.0, STEP, 0.01);
    let parameters = &simulator.system.parameters;
    let space = JetSpace::new(parameters.len(), 2);
    let center: Vec<f64> = parameters.iter().map(|p| 0.5 * (p.lower + p.upper)).collect();
    let half_width: Vec<f64> = parameters.iter().map(|p| 0.5 * (p.upper - p.lower)).collect();
    let (seconds, _) = best(10, || {
        let about = JetBox { center: &center, half_width: &half_width };
        let mut jet = jet_integrator(&simulator, &space, about, &schedule).expect("the centre can be assembled");
        let mut values = Vec::new();
        let steps = Steps { schedule: &schedule, controller: None };
        assert!(jet.advance(steps, 0..schedule.rows, Observed::Outputs, &mut values).is_empty());
        values
    });
    json!(seconds)
}

/// The scalar implementation takes `scalar_steps` steps; its time is scaled to the whole duration.
fn four_bar(loops: usize, duration: f64, scalar_steps: usize) -> Value {
    let simulator = models::prepare(&models::four_bar(loops));
    let schedule = Schedule::fixed(duration, STEP, duration);
    let (single, values) = best(3, || run(&simulator, 1, &schedule));
    let (batch, _) = best(1, || run(&simulator, BATCH, &schedule));
    let (scalar, end) = best(1, || {
        let (bars, mut state) = scalar::Bars::four_bar(loops);
        scalar::advance(&bars, &mut state, STEP, scalar_steps);
        [-state.q[2].sin(), state.q[2].cos()]
    });
    let steps = duration / STEP;
    let complete = scalar_steps as f64 >= steps;
    json!({
        "single": single, "batch": batch / BATCH as f64, "values": &values[2..],
        "scalar": scalar * steps / scalar_steps as f64, "scalar_values": complete.then_some(end),
    })
}

/// Time to compile and time a step, against N.
fn scaling() -> Value {
    const STEPS: usize = 20;
    let rows = [10, 32, 100, 320, 1000].map(|loops| {
        let description = models::four_bar(loops);
        let (compilation, simulator) = best(2, || models::prepare(&description));
        let mut stepper = models::stepper(&simulator, 1);
        let mut time = 0.0;
        let (seconds, ()) = best(10, || {
            for _ in 0..STEPS {
                time += STEP;
                assert!(stepper.step(STEP, time).is_empty(), "every step converges");
            }
        });
        json!({ "loops": loops, "compilation": compilation, "step": seconds / STEPS as f64 })
    });
    json!(rows)
}

/// A scan of 900 samples on one and on two threads: seconds.
fn scan() -> Value {
    let model = models::slider_crank();
    let with = |threads: usize| {
        let (seconds, result) = best(5, || {
            let study = model.study().methods(&[Method::Scan]).threads(threads).allow_costly();
            study.run().expect("the model runs")
        });
        let ends = |bounds: &mbint::results::Bounds| {
            let bands = bounds.outputs.iter().flat_map(|output| &output.bands);
            bands.flat_map(|band| band.lower.iter().chain(&band.upper)).map(|end| end.to_bits()).collect::<Vec<_>>()
        };
        (seconds, ends(result.bounds()))
    };
    let ((one, first), (two, second)) = (with(1), with(2));
    json!({ "one": one, "two": two, "identical": first == second })
}
