//! An order that is given for more parameters than a full grid can have, in every kind of analysis: a mass on fourteen
//! springs side by side, whose stiffnesses count by their sum alone, so that ends are closed forms.

use mbint::results::Method;

use crate::common::{read, run};

const SPRINGS: usize = 14;
/// N/m, each ± 10 %.
const STIFFNESS: f64 = 20.0;
const MASS: f64 = 2.0;
const GRAVITY: f64 = 9.81;

fn model(analysis: &str) -> String {
    let each = |line: fn(usize) -> String| (0..SPRINGS).map(line).collect::<String>();
    let parameters = each(|spring| format!("  k{spring}: {{ value: 20, unit: N/m, tolerance: 10% }}\n"));
    let springs = each(|spring| {
        format!(
            "  s{spring}: {{ spring_damper: {{ between: [ground, mass], along: y, stiffness: k{spring}, free_length: 0 }} }}\n"
        )
    });
    format!(
        "{analysis}
parameters:
{parameters}
bodies: {{ mass: {{ mass: 2, coordinates: [y] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
{springs}
outputs: {{ y: mass.y }}
bounds: {{ chebyshev: {{ order: 3 }} }}
"
    )
}

/// Ends of an output in its last row, and the error.
fn ends(text: &str, output: &str) -> ([f64; 2], f64) {
    let bounds = run(&read(text));
    let output = bounds.outputs.iter().find(|own| own.name == output).unwrap();
    let band = output.bands.iter().find(|band| band.method == Method::Chebyshev).unwrap();
    let last = band.lower.len() - 1;
    assert!(!band.error.unresolved[last]);
    ([band.lower[last], band.upper[last]], band.error.total[last])
}

fn close([lower, upper]: [f64; 2], error: f64, expected: [f64; 2]) {
    let width = expected[1] - expected[0];
    assert!(error < 0.01 * width, "{error} of {width}");
    let off = [lower - expected[0], upper - expected[1]];
    assert!(off.iter().all(|off| off.abs() <= error + 1e-9), "{lower}, {upper} ± {error}, not {expected:?}");
}

/// Least and greatest sum of all stiffnesses.
fn sums() -> [f64; 2] {
    [0.9, 1.1].map(|share| share * SPRINGS as f64 * STIFFNESS)
}

#[test]
fn statics_of_fourteen_parameters_have_an_order() {
    let (found, error) = ends(&model("analysis: statics"), "y");
    close(found, error, sums().map(|sum| -MASS * GRAVITY / sum));
}

#[test]
fn modes_of_fourteen_parameters_have_an_order() {
    let text = model("analysis: modes\nmodes: { at: equilibrium }");
    let (found, error) = ends(&text, "mode1.frequency");
    close(found, error, sums().map(|sum| (sum / MASS).sqrt() / std::f64::consts::TAU));
}

#[test]
fn motions_of_fourteen_parameters_have_an_order() {
    let text = model("simulation: { duration: 0.2, step: 1e-3, output_step: 0.1 }\ninitial: { mass.y: 0, mass.vy: 0 }");
    let (found, error) = ends(&text, "y");
    // y = −g/ω² (1 − cos ω t), which the sum makes greater.
    let at = |sum: f64| {
        let omega = (sum / MASS).sqrt();
        -GRAVITY / (omega * omega) * (1.0 - (0.2 * omega).cos())
    };
    close(found, error, sums().map(at));
}
