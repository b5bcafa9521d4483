//! Tables in formulas: recorded excitations and measured characteristics.

use std::fmt::Write as _;

use mbint::model;
use mbint::results::Method;

use super::common::{band, curve, distance, distance_from, nominal, output, read, run};

/// A recording of a sine drives a mass as the sine itself does, but for what a spline of its samples leaves.
#[test]
fn a_recording_drives_like_what_was_recorded() {
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
        nominal(&model::load(&path, &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}")))
    };
    let table = run("amplitude*gust((t + late)/stretch)");
    let formula = run("amplitude*3*sin(2*(t + late)/stretch)");
    let apart = distance(curve(&table, "x"), curve(&formula, "x"));
    assert!(apart < 1e-7, "{apart:e}");
}

/// A prescribed motion by a table: the motor's coordinate is the spline.
#[test]
fn a_motor_follows_a_table() {
    let bounds = nominal(&read(
        "
tables: { cam: { points: [[0, 0], [0.5, 0.1], [1, 0.3], [1.5, 0.2], [2, 0]], units: [s, rad] } }
bodies: { wheel: { mass: 1, inertia: 0.02 } }
joints:
  shaft: { revolute: [ground, wheel] }
  drive: { motor: { on: shaft, position: cam(t) } }
outputs: { angle: wheel.angle, wanted: cam(t) }
simulation: { duration: 2, step: 1e-3, output_step: 0.1 }
",
    ));
    assert!(distance(curve(&bounds, "angle"), curve(&bounds, "wanted")) < 1e-12);
    assert!((curve(&bounds, "angle")[10] - 0.3).abs() < 1e-12);
}

/// A spring by a table of a parabola's slope keeps the energy that the parabola's integral says.
#[test]
fn a_spring_may_have_a_measured_characteristic() {
    let mut points = String::new();
    for i in -20..=20 {
        let x = 0.02 * f64::from(i);
        write!(points, "[{x}, {}], ", 50.0 * x + 400.0 * x.powi(3)).unwrap();
    }
    let bounds = nominal(&read(&format!(
        "
tables: {{ measured: {{ points: [{points}], units: [m, N] }} }}
bodies: {{ mass: {{ mass: 0.5, coordinates: [x] }} }}
effects: {{ hard: {{ spring_damper: {{ between: [ground, mass], along: x, force: measured(hard.length) }} }} }}
initial: {{ mass.x: 0.3, mass.vx: 0 }}
outputs: {{ energy: 0.25*mass.vx^2 + 25*mass.x^2 + 100*mass.x^4 }}
simulation: {{ duration: 2, step: 5e-4, output_step: 0.01 }}
"
    )));
    let start = 25.0 * 0.09 + 100.0 * 0.0081;
    let error = distance_from(&bounds.times, curve(&bounds, "energy"), |_| start);
    // HHT's dissipation at this step and the spline's natural ends.
    assert!(error < 2e-3 * start, "{error:e}");
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
