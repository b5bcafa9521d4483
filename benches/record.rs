//! Time of a step of every shipped model, one sample on one thread, next to that of a reference loop: a line of JSON
//! each, which `cargo xtask bench` reads.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use mbint::inner::model::{Description, Stepping, read};
use mbint::inner::simulate::Stepper;
use mbint::inner::study::prepare;

/// Repetitions, of which the fastest counts.
const REPETITIONS: usize = 25;

/// Steps of a repetition, if the model's run has that many.
const STEPS: usize = 2000;

/// Step of models with a tolerance instead, s.
const STEP: f64 = 1e-3;

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let files = std::fs::read_dir(&folder).expect("the models are there");
    let mut files: Vec<_> = files.map(|file| file.expect("the folder can be read").path()).collect();
    files.retain(|file| file.is_file());
    files.sort();
    let mut loops = Vec::new();
    for file in files {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let Ok(models) = read(&file, &[]).chosen(&[]) else { continue };
        for (scene, description) in models {
            loops.push(reference());
            let name = scene.map_or_else(|| name.clone(), |scene| format!("{name}, {scene}"));
            if let Some(nanoseconds) = step(&description) {
                println!("{}", serde_json::json!({ "case": name, "nanoseconds": nanoseconds }));
            }
        }
    }
    let fastest = loops.into_iter().fold(f64::INFINITY, f64::min);
    println!("{}", serde_json::json!({ "case": "reference loop", "nanoseconds": fastest }));
}

/// Time of a dependent product and sum, ns: a measure of the processor's clock that no compiler and no width of
/// registers changes.
fn reference() -> f64 {
    const COUNT: u32 = 2_000_000;
    let (mut x, a, b) = black_box((0.5_f64, 0.999_f64, 1e-3_f64));
    let begun = Instant::now();
    for _ in 0..COUNT {
        x = x * a + b;
    }
    black_box(x);
    begun.elapsed().as_secs_f64() * 1e9 / f64::from(COUNT)
}

/// Time of a step of HHT-I3 with its iteration, ns; `None` if the model takes no steps.
fn step(description: &Description) -> Option<f64> {
    let simulator = prepare(description).ok()?;
    let simulation = &description.simulation;
    let h = match simulation.stepping {
        Stepping::Fixed(h) => h,
        Stepping::Tolerance(_) => STEP,
    };
    let middle = |_| simulator.system.parameters.iter().map(|p| 0.5 * (p.lower + p.upper)).collect();
    let start = simulator.assemble(1, h, middle).ok()?;
    let steps = STEPS.min((simulation.duration / h).round() as usize);
    let mut fastest = f64::INFINITY;
    for _ in 0..REPETITIONS {
        let mut stepper = Stepper::new(&simulator.program, &start);
        let begun = Instant::now();
        let mut taken = 0;
        while taken < steps && stepper.step(h, (taken + 1) as f64 * h).is_empty() {
            taken += 1;
        }
        fastest = fastest.min(begun.elapsed().as_secs_f64() * 1e9 / taken as f64);
    }
    fastest.is_finite().then_some(fastest)
}
