//! Targets of the fuzzer. Each takes any text and may report anything about it, but must not panic, hang or take much
//! memory.

use mbint::inner::methods::{BoundsRequest, Chebyshev, Scan, Taylor};
use mbint::inner::model::{self, Description, Override, Stepping};
use mbint::inner::study::{self, Options};

/// Reads a model, and renders its diagnostics.
pub fn model(text: &str) {
    report(&model::read_str("fuzz.yaml", text, &[]));
}

/// Reads a URDF by itself, and renders its diagnostics.
pub fn robot(text: &str) {
    by_itself(text, "urdf");
}

/// Reads an MJCF by itself, and renders its diagnostics.
pub fn mjcf(text: &str) {
    by_itself(text, "xml");
}

/// Reads a robot's file by itself.
fn by_itself(text: &str, ending: &str) {
    let path = std::env::temp_dir().join(format!("mbint-fuzz-{}.{ending}", std::process::id()));
    std::fs::write(&path, text).expect("the folder for temporary files can be written");
    report(&model::read(&path, &[]));
    // A file that cannot be removed is overwritten.
    let _ = std::fs::remove_file(&path);
}

/// Asserts that errors are reported if there is no model, and only then.
fn report(reading: &model::Reading) {
    if !reading.diagnostics.is_empty() {
        assert!(!reading.diagnostics.render(false).is_empty());
        assert!(reading.diagnostics.records().iter().all(|record| !record.message.is_empty()));
    }
    assert_eq!(reading.description.is_none(), reading.diagnostics.has_errors(), "errors are report, and nothing else");
}

/// Reads a formula, evaluates and differentiates it; and reads it as a setting of the command line.
pub fn formula(text: &str) {
    if let Ok(formula) = symdiff::Formula::parse(text)
        && formula.terms().len() < 1000
    {
        let builder = symdiff::Builder::new();
        let x = builder.variable("x");
        let built = formula.build(&builder, |_| Ok::<_, ()>(x)).expect("every name is known");
        let slope = built.derivative(x);
        builder.graph().evaluate(&[built.expr(), slope.expr()], |_| 0.3);
    }
    if let Ok(setting) = Override::parse(text) {
        model::read_str("fuzz.yaml", "model: a", &[setting]);
    }
}

/// Runs a model for a few steps, if it is one, by all methods.
pub fn short_run(text: &str) {
    if let Some(description) = model::read_str("fuzz.yaml", text, &[]).description
        && let Some(description) = shortened(description)
    {
        // Whether it can be run is not asked.
        let _ = study::run(&description, Options { threads: Some(1), ..Options::default() });
    }
}

/// The same mechanism with little to do; `None` if it is large.
fn shortened(mut description: Description) -> Option<Description> {
    let uncertain = description.uncertain().count();
    if description.bodies.len() > 8 || description.joints.len() > 16 || uncertain > 3 {
        return None;
    }
    let simulation = &mut description.simulation;
    match &mut simulation.stepping {
        Stepping::Fixed(step) => simulation.output_step = *step,
        // A tolerance near rounding errors may take any number of steps.
        Stepping::Tolerance(tolerance) => *tolerance = tolerance.max(1e-6),
    }
    simulation.duration = 3.0 * simulation.output_step;
    let BoundsRequest { chebyshev, taylor, scan, certified, .. } = std::mem::take(&mut description.bounds);
    description.bounds.chebyshev = chebyshev.map(|_| Chebyshev::of_order(1, uncertain));
    description.bounds.taylor = taylor.map(|request| Taylor { order: 1, ..request });
    description.bounds.scan = scan.map(|_| Scan::of_points(2, uncertain));
    description.bounds.certified = certified.filter(|_| uncertain < 2);
    Some(description)
}
