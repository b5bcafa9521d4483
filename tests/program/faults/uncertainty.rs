//! Intervals without width, parameters of very different sizes, bifurcations.

use mbint::Model;
use mbint::results::{Bounds, Method};

fn read(text: &str) -> Model {
    Model::from_yaml_str("test", text).unwrap_or_else(|error| panic!("{error}"))
}

fn run(model: &Model) -> Bounds {
    let result = model.study().threads(2).allow_costly().run().unwrap();
    assert_eq!(result.failure(), None);
    result.bounds().clone()
}

fn pendulum(length: &str, mass: &str, bounds: &str) -> Model {
    read(&format!(
        "
parameters: {{ l: {{ value: 0.5, {length} }}, m: {{ value: 1, {mass} }} }}
bodies: {{ rod: {{ mass: m, inertia: m*l^2/12, points: {{ pivot: [-l/2, 0], tip: [l/2, 0] }} }} }}
joints: {{ hinge: {{ revolute: [ground, rod.pivot] }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ rod.angle: 0, rod.angular_velocity: 0 }}
outputs: {{ y: rod.tip.y, load: hinge.force }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.05 }}
bounds: {{ {bounds} }}
"
    ))
}

/// Every method gives the nominal motion, without a flag.
#[test]
fn intervals_without_width_are_the_nominal_motion() {
    for request in
        ["chebyshev: { order: 4 }, taylor: { order: 3 }, scan: { points: 5 }", "tolerance: 1e-2, scan: { points: 3 }"]
    {
        let bounds = run(&pendulum("interval: [0.5, 0.5]", "tolerance: 0%", request));
        for output in &bounds.outputs {
            let size = output.nominal.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
            for band in &output.bands {
                for row in 0..bounds.times.len() {
                    let (value, what) = (output.nominal[row], (band.method.name(), row, request));
                    let off = (band.lower[row] - value).abs().max((band.upper[row] - value).abs());
                    // Reactions of composed bounds are those of the closure, without the scheme's transient.
                    let allowed = if output.name == "load" { band.error.total[row] } else { 0.0 };
                    assert!(off <= allowed.max(1e-9 * size), "{off:e}, {what:?}");
                    assert!(!band.error.unresolved[row], "{what:?}: {}", band.error.total[row]);
                }
            }
        }
        let parts = bounds.contributions.iter().flatten().flat_map(|part| part.total.iter());
        assert!(parts.into_iter().all(|&share| share == 0.0), "nothing varies, so nobody has a share");
    }
}

/// An interval without width next to a proper one changes nothing.
#[test]
fn an_interval_without_width_is_a_number() {
    let request = "chebyshev: { order: 5 }, taylor: { order: 3 }, scan: { points: 5 }";
    let (with, without) = (
        run(&pendulum("tolerance: 1%", "tolerance: 0", request)),
        run(&pendulum("tolerance: 1%", "unit: kg", request)),
    );
    for (a, b) in with.outputs.iter().zip(&without.outputs) {
        for (a, b) in a.bands.iter().zip(&b.bands) {
            for row in 0..with.times.len() {
                let off = (a.lower[row] - b.lower[row]).abs().max((a.upper[row] - b.upper[row]).abs());
                // A range's proven margin depends on the number of parameters.
                let allowed = 1e-3 * (a.upper[row] - a.lower[row]) + 1e-9 * (1.0 + a.upper[row].abs());
                assert!(off < allowed, "{} {row}: {off:e}", a.method.name());
            }
        }
    }
}

/// 1e-6 kg on a rod to 1e6 kg on a spring of 1e6 N/m: x = cos √(k/big) t, whatever hangs there.
#[test]
fn twelve_decades_between_parameters_are_no_trouble() {
    let description = read(
        "
parameters:
  k: { value: 1e6, unit: N/m, tolerance: 1% }
  m: { value: 1e-6, unit: kg, tolerance: 1% }
  big: { value: 1e6, unit: kg, tolerance: 1% }
  l: { value: 0.1, unit: m }
  g: { value: 9.81, unit: m/s^2 }
bodies: { fly: { mass: m, coordinates: [x, y] }, block: { mass: big, coordinates: [x] } }
joints: { pole: { distance: { between: [block, fly], length: l } } }
effects:
  spring: { spring_damper: { between: [ground, block], along: x, stiffness: k, damping: 0, free_length: 0 } }
  weight: { gravity: { acceleration: [0, -g] } }
initial: { block.x: 1, block.vx: 0, fly.x: 1, fly.vx: 0 }
guess: { fly.y: -0.1 }
outputs: { x: block.x, fly: fly.y }
simulation: { duration: 2, step: 1e-3, output_step: 0.1 }
bounds: { chebyshev: { order: 5 }, taylor: { order: 4 }, scan: { points: 5 } }
",
    );
    let bounds = run(&description);
    for band in &bounds.outputs[0].bands {
        for (row, &t) in bounds.times.iter().enumerate() {
            // √(k/big) runs from √(0.99/1.01) to √(1.01/0.99); up to 2 s the cosine falls with it.
            let exact = [(1.01_f64 / 0.99).sqrt(), (0.99_f64 / 1.01).sqrt()].map(|rate| (rate * t).cos());
            let error = band.error.total[row] + 1e-9;
            let off = [band.lower[row] - exact[0], band.upper[row] - exact[1]];
            assert!(off.iter().all(|off| off.abs() <= error), "{} at {t}: {off:?}, {error:e}", band.method.name());
            assert!(error < 1e-4 && !band.error.unresolved[row]);
        }
    }
    assert!(bounds.outputs[1].bands.iter().flat_map(|band| &band.upper).all(|y| y.is_finite() && *y < 0.0));
}

/// A bead on a turning hoop: from w² = g/r on, the bottom is left to one side or the other. The interval of w has that
/// inside, that of the start has both sides. Unresolved rows have to be marked: every sample of a denser scan lies in
/// the others' bounds, their errors included, or the row is marked.
#[test]
fn bounds_through_a_bifurcation_hold_or_are_flagged() {
    let text = |bounds: &str| {
        format!(
            "
parameters:
  w: {{ value: 3, unit: rad/s, interval: [2, 4] }}
  start: {{ value: 0, unit: rad, interval: [-0.001, 0.001] }}
  g: {{ value: 9.81, unit: m/s^2 }}
  m: {{ value: 1, unit: kg }}
bodies: {{ bead: {{ mass: m, inertia: 1e-9, points: {{ centre: [0, 1] }} }} }}
joints: {{ hoop: {{ revolute: [ground, bead.centre] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -g] }} }}
  spin: {{ force: {{ on: bead, value: [m*w^2*bead.x, 0] }} }}
initial: {{ bead.angle: start, bead.angular_velocity: 0 }}
outputs: {{ angle: bead.angle }}
simulation: {{ duration: 8, step: 4e-3, output_step: 0.2 }}
bounds: {{ {bounds} }}
"
        )
    };
    let bounds = run(&read(&text("chebyshev: { order: 6 }, taylor: { order: 3 }, scan: { points: 9 }")));
    let dense = run(&read(&text("scan: { points: 61 }")));
    let truth = &dense.outputs[0].bands[0];
    let largest = truth.upper.iter().copied().fold(0.0, f64::max);
    assert!(largest > 1.0, "the bottom is left: {largest}");
    let mut missed = Vec::new();
    for band in &bounds.outputs[0].bands {
        let outside = |row: usize| {
            let beyond = (truth.upper[row] - band.upper[row]).max(band.lower[row] - truth.lower[row]);
            !band.error.unresolved[row] && beyond > band.error.total[row] + 1e-9
        };
        let rows: Vec<f64> = (0..bounds.times.len()).filter(|&row| outside(row)).map(|row| bounds.times[row]).collect();
        println!("{}: not held at {rows:?}", band.method.name());
        missed.extend(rows.into_iter().filter(|_| band.method != Method::Scan));
        let unresolved = band.error.unresolved_from().map(|row| bounds.times[row]);
        println!("{}: unresolved from {unresolved:?}", band.method.name());
    }
    assert!(missed.is_empty(), "{missed:?}");
}
