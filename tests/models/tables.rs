//! Tables in formulas: recorded excitations and measured characteristics.

use crate::common::{band, curve, distance, load, nominal, output, read, run};
use mbint::results::Method;
use std::fmt::Write as _;

/// A recording of a sine drives a mass as the sine itself does, but for the error of a spline through its samples.
#[test]
fn recorded_signal_drives_like_the_original() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = "# recorded\ntime;other;force\n".to_owned();
    for i in 0..=150 {
        let t = 20.0 * f64::from(i);
        writeln!(text, "{t};7;{}", 3e-3 * (2.0 * t * 1e-3).sin()).unwrap();
    }
    std::fs::write(folder.path().join("gust.csv"), text).unwrap();
    let model_text = |force: &str| {
        format!(
            "
tables: {{ gust: {{ file: gust.csv, columns: [time, force], units: [ms, kN] }} }}
parameters: {{ amplitude: 2, late: 0.1 s, stretch: 1.25 }}
bodies: {{ mass: {{ mass: 0.5, coordinates: [x] }} }}
effects:
  mount: {{ spring_damper: {{ between: [ground, mass], along: x, stiffness: 50, damping: 1 }} }}
  wind: {{ force: {{ on: mass, value: [{force}, 0] }} }}
initial: {{ mass.x: 0, mass.vx: 0 }}
outputs: {{ x: mass.x }}
simulation: {{ duration: 3, step: 1e-3, output_step: 0.01 }}
"
        )
    };
    let run = |force: &str| {
        let path = folder.path().join("model.yaml");
        std::fs::write(&path, model_text(force)).unwrap();
        nominal(&load(&path))
    };
    let table = run("amplitude*gust((t + late)/stretch)");
    let formula = run("amplitude*3*sin(2*(t + late)/stretch)");
    let apart = distance(curve(&table, "x"), curve(&formula, "x"));
    assert!(apart < 1e-7, "{apart:e}");
}

/// Amplitude, offset and time scale of a recording may be uncertain: all methods run over the table, and agree.
#[test]
fn a_recording_may_be_uncertain() {
    let bounds = run(&read(
        "
tables: { gust: { points: [[0, 0], [0.4, 1], [0.8, 3], [1.2, 2], [1.6, 0.5], [2, 0]], units: [s, N] } }
parameters:
  amplitude: { value: 1, tolerance: 2% }
  offset: { value: 0, plus: 0.02, minus: 0.02, unit: s }
  stretch: { value: 1, tolerance: 1% }
bodies: { mass: { mass: 0.5, coordinates: [x] } }
effects:
  mount: { spring_damper: { between: [ground, mass], along: x, stiffness: 50, damping: 1 } }
  wind: { force: { on: mass, value: [amplitude*gust((t - offset)/stretch), 0] } }
initial: { mass.x: 0, mass.vx: 0 }
outputs: { x: mass.x }
simulation: { duration: 2, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 4 }, taylor: { order: 3 }, scan: { points: 7 } }
",
    ));
    let x = output(&bounds, "x");
    let [chebyshev, taylor, scan] = [Method::Chebyshev, Method::Taylor, Method::Scan].map(|method| band(x, method));
    let widest = scan.upper.iter().zip(&scan.lower).map(|(upper, lower)| upper - lower).fold(0.0, f64::max);
    assert!(widest > 1e-3);
    for row in 0..bounds.times.len() {
        for (method, band, share) in [("chebyshev", chebyshev, 0.02), ("taylor", taylor, 0.05)] {
            assert!((band.upper[row] - scan.upper[row]).abs() < share * widest, "{method} in row {row}");
            assert!((band.lower[row] - scan.lower[row]).abs() < share * widest, "{method} in row {row}");
        }
    }
}
