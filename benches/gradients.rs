//! Gradients of 64 samples by all parameters, in the last row, compared with as many simulations: the ratio of both is
//! the cost of a gradient in simulations.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

use divan::Bencher;
use divan::counter::ItemsCount;
use mbint::inner::assemble;
use mbint::inner::compile::Scheme;
use mbint::inner::model::load_str;
use mbint::inner::numerics::Sample;
use mbint::inner::simulate::{
    Integration, Interruption, Observed, Schedule, Simulator, Steps, Wanted, gradients, integrator,
};

const SAMPLES: usize = 64;
const STEPS: usize = 200;

/// Methods of integration, by name.
const METHODS: [&str; 3] = ["plain", "two levels", "explicit"];

fn main() {
    divan::main();
}

/// A compiled model, its schedule by a method, and samples over its box.
struct Case {
    simulator: Simulator,
    schedule: Schedule,
    samples: Vec<Sample>,
}

impl Case {
    fn new(name: &str, text: &str, method: &str) -> Self {
        let description = load_str(name, text, &[]).expect("shipped models are right");
        let duration = description.simulation.duration.min(0.5);
        let scheme = Schedule::fixed(duration, duration / STEPS as f64, duration / 10.0);
        let ends: Vec<f64> = (1..=STEPS / 10).map(|step| duration * (10 * step) as f64 / STEPS as f64).collect();
        let schedule = match method {
            "plain" => scheme,
            "two levels" => scheme.taken(Integration::Extrapolated { levels: 2 }),
            _ => Schedule::passing(duration, duration / 10.0, ends, Vec::new()).taken(Integration::Explicit),
        };
        let system = assemble::build(&assemble::Questions::of(&description)).expect("shipped models are built");
        let simulator = Simulator::new(system, Scheme::Hht { alpha: -0.1 }, schedule.first_step());
        let simulator = simulator.expect("shipped models are assembled");
        let sample = |number: usize| -> Sample {
            let share = number as f64 / SAMPLES as f64;
            simulator.system.parameters.iter().map(|own| own.lower + share * (own.upper - own.lower)).collect()
        };
        let samples = (0..SAMPLES).map(sample).collect();
        Self { simulator, schedule, samples }
    }

    fn simulate(&self, bencher: Bencher) {
        bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
            let mut run = integrator(&self.simulator, &self.samples, &self.schedule).expect("samples assemble");
            let steps = Steps { schedule: &self.schedule, controller: None };
            run.advance(steps, 0..self.schedule.rows, Observed::Outputs, &mut Vec::new());
        });
    }

    fn differentiate(&self, bencher: Bencher) {
        let row = self.schedule.rows - 1;
        let wanted: Vec<Wanted> = (0..SAMPLES).map(|sample| Wanted { sample, row, output: 0 }).collect();
        bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
            gradients(&self.simulator, &self.schedule, &self.samples, &wanted, Interruption::default())
                .expect("the motion has gradients")
        });
    }
}

macro_rules! model {
    ($name:ident) => {
        mod $name {
            use super::*;

            const TEXT: &str = include_str!(concat!("../models/", stringify!($name), ".yaml"));

            #[divan::bench(args = METHODS)]
            fn simulations(bencher: Bencher, method: &str) {
                Case::new(stringify!($name), TEXT, method).simulate(bencher);
            }

            #[divan::bench(args = METHODS)]
            fn gradients(bencher: Bencher, method: &str) {
                Case::new(stringify!($name), TEXT, method).differentiate(bencher);
            }
        }
    };
}

model!(slider_crank);
model!(quarter_car);
model!(six_axis_arm);
