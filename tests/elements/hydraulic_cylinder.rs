//! Hydraulic cylinders against scipy, a sealed cylinder's closed form, and the steady speed behind an open valve.

use mbint::results::Method;

use crate::common::{band, curve, distance, largest, nominal, output, read, row, run};

fn carriage(cylinder: &str, effects: &str, simulation: &str) -> String {
    format!(
        "
parameters: {{ bore: {{ value: 40 mm, tolerance: 1% }} }}
bodies: {{ carriage: {{ mass: 500, inertia: 1 }} }}
joints: {{ rail: {{ prismatic: {{ between: [ground, carriage], axis: x }} }} }}
effects:
  ram: {{ hydraulic_cylinder: {{ between: [ground, carriage], bore: bore, retracted: 0.5, stroke: 0.6, dead_volume: 0.2 L,
    rated_flow: 20 L/min, rated_drop: 35 bar, {cylinder} }} }}
{effects}
initial: {{ carriage.x: 0.8, carriage.vx: 0 }}
outputs: {{ x: carriage.x, v: carriage.vx, p: ram.piston_pressure, q: ram.rod_pressure, force: ram.force, length: ram.length, in: ram.piston_flow, out: ram.rod_flow }}
simulation: {{ output_step: 0.05, {simulation} }}
"
    )
}

/// SciPy 1.17, `solve_ivp`, DOP853, rtol 1e-12 (Radau at 1e-9 agrees in seven digits): position, velocity and
/// pressures.
#[test]
fn motion_behind_a_valve_matches_scipy() {
    let wanted = [
        (0.1, [0.808368409, 0.174975986, 5117954.88, 4434846.38]),
        (0.25, [0.845200127, 0.288332108, 4558568.08, 4471624.97]),
        (0.5, [0.891840214, -2.62568965e-5, 3773818.3, 4809460.57]),
        (0.7, [0.863551648, -0.239575915, 8947719.02, 12727887.4]),
        (1.0, [0.809981813, 0.000374806852, 9796404.03, 12376282.9]),
    ];
    let cylinder = "rod: 25 mm, valve: 0.6*sin(2*pi*t), supply: 160 bar, tank: 2 bar, leakage: 1e-13, piston_pressure: 50 bar, rod_pressure: 60 bar";
    let load = "  load: { force: { on: carriage, value: [-2000 N - 1000 N*s/m*carriage.vx, 0] } }";
    for (simulation, allowed) in
        [("duration: 1, step: 1e-4", 2e-4), ("duration: 1, scheme: explicit, tolerance: 1e-8", 1e-6)]
    {
        let bounds = nominal(&read(&carriage(cylinder, load, simulation)));
        for (time, values) in wanted {
            for ((name, value), size) in ["x", "v", "p", "q"].into_iter().zip(values).zip([1.0, 1.0, 1e7, 1e7]) {
                let found = curve(&bounds, name)[row(&bounds, time)];
                assert!((found - value).abs() < allowed * size, "{simulation}: {name} at {time}: {found}, not {value}");
            }
        }
    }
}

/// The valve passes zero, where both of its edges begin to pass oil at once. SciPy 1.17, `solve_ivp`, Radau:
/// 0.926590599 m at 0.5 s.
#[test]
fn a_valve_passes_zero() {
    let model = |simulation: &str| {
        format!(
            "
bodies: {{ b: {{ mass: 50, coordinates: [x] }} }}
effects:
  c: {{ hydraulic_cylinder: {{ between: [ground, b], bore: 0.04, rod: 0.025, retracted: 0.5, stroke: 1, dead_volume: 1e-4, valve: 0.3*sin(8*t),
    rated_flow: 20 L/min, rated_drop: 35 bar, supply: 100 bar, piston_pressure: 30 bar, rod_pressure: 45 bar, leakage: 1e-12 }} }}
  l: {{ spring_damper: {{ between: [ground, b], along: x, damping: 2000, free_length: 0 }} }}
initial: {{ b.x: 0.9, b.vx: 0 }}
outputs: {{ x: b.x }}
simulation: {{ duration: 0.5, output_step: 0.025, {simulation} }}
"
        )
    };
    for simulation in ["tolerance: 1e-4", "tolerance: 1e-6", "tolerance: 1e-4, scheme: explicit"] {
        let bounds = run(&read(&model(simulation)));
        let x = band(output(&bounds, "x"), Method::Chebyshev);
        let last = bounds.times.len() - 1;
        let (off, stated) = ((x.lower[last] - 0.926590599).abs(), x.error.total[last]);
        assert!(off <= stated + 1e-9 && stated < 1e-5, "{simulation}: off by {off:e}, stated {stated:e}");
    }
}

/// With its valve closed, oil is a spring: p = p₀ − E ln(V/V₀) in either chamber, whatever the motion is, and
/// oscillations about the middle have ω² = E (A₁²/V₁ + A₂²/V₂)/m.
#[test]
fn sealed_oil_is_a_spring() {
    let cylinder =
        "rod: 25 mm, valve: 0, supply: 160 bar, piston_pressure: 50 bar, rod_pressure: 60 bar, modulus: 1 GPa";
    let push = "  push: { force: { on: carriage, value: [2000, 0] } }";
    let bounds = nominal(&read(&carriage(cylinder, push, "duration: 0.5, step: 2e-4")));
    let quarter = std::f64::consts::FRAC_PI_4;
    let areas = [quarter * 0.04_f64.powi(2), quarter * (0.04_f64.powi(2) - 0.025_f64.powi(2))];
    let sealed = |p: f64, v: f64, now: f64| p - 1e9 * (now / v).ln();
    let lengths = curve(&bounds, "length");
    let expected = |chamber: usize| -> Vec<f64> {
        let at = |length: f64| [areas[0] * (length - 0.5), areas[1] * (1.1 - length)][chamber] + 2e-4;
        lengths.iter().map(|&length| sealed([50e5, 60e5][chamber], at(0.8), at(length))).collect()
    };
    assert!(largest(lengths.iter().map(|length| length - 0.8)) > 1e-3, "it moves");
    for (name, chamber) in [("p", 0), ("q", 1)] {
        let off = distance(curve(&bounds, name), &expected(chamber));
        assert!(off < 2e3, "{name}: {off} Pa");
    }
    for flow in ["in", "out"] {
        assert_eq!(largest(curve(&bounds, flow).iter().copied()), 0.0);
    }
    let volumes = areas.map(|area| area * 0.3 + 2e-4);
    let stiffness: f64 = areas.iter().zip(volumes).map(|(area, volume)| 1e9 * area * area / volume).sum();
    // From 1 mm/s about the position where the pressures are in balance, within 0.1 % of its frequency.
    let balanced = 50e5 * areas[0] / areas[1];
    let cylinder = format!(
        "rod: 25 mm, valve: 0, supply: 160 bar, piston_pressure: 50 bar, rod_pressure: {balanced}, modulus: 1 GPa"
    );
    let text = carriage(&cylinder, "", "duration: 0.2, step: 1e-4").replace("carriage.vx: 0", "carriage.vx: 0.001");
    let bounds = nominal(&read(&text));
    let omega = (stiffness / 500.0).sqrt();
    let off = largest(bounds.times.iter().zip(curve(&bounds, "v")).map(|(t, v)| v / 0.001 - (omega * t).cos()));
    assert!(off < 5e-3, "{off}");
}

/// Without rod and load, half of the supply's pressure falls at either edge: v = K x √(p_S/2)/A, which the bore
/// determines.
#[test]
fn an_open_valve_gives_a_steady_speed() {
    let cylinder = "valve: 0.3, supply: 70 bar, piston_pressure: 35 bar, rod_pressure: 35 bar";
    let bounds = run(&read(&carriage(cylinder, "", "duration: 1, step: 1e-3")));
    let band = band(output(&bounds, "v"), Method::Chebyshev);
    let last = bounds.times.len() - 1;
    let speed = |bore: f64| 0.299 * (20e-3 / 60.0) / (std::f64::consts::FRAC_PI_4 * bore * bore);
    let off = largest([band.lower[last] - speed(0.0404), band.upper[last] - speed(0.0396)]);
    assert!(off < 1e-4, "{off:e}");
    assert_eq!(["p", "in"].map(|name| output(&bounds, name).unit.clone()), ["Pa", "m^3/s"]);
}

/// A mirrored instance pushes to the other side.
#[test]
fn mirrored_instance_moves_symmetrically() {
    let text = "
assemblies:
  lift:
    bodies: { arm: { mass: 20, inertia: 3, points: { eye: [0.4, 0.1], foot: [0, 0] } }, ground: { points: { foot: [0.1, -0.6] } } }
    joints: { hinge: { revolute: [ground, arm.foot] } }
    effects:
      ram: { hydraulic_cylinder: { between: [ground.foot, arm.eye], bore: 30 mm, rod: 15 mm, retracted: 0.5, stroke: 0.5, dead_volume: 0.2 L,
        valve: 0.4*sin(8*t) + 0.2*hinge.angle, rated_flow: 10 L/min, rated_drop: 35 bar, supply: 60 bar, piston_pressure: 30 bar, rod_pressure: 30 bar } }
    initial: { hinge.angle: 0.1, hinge.angular_velocity: 0 }
instances:
  one: { of: lift }
  two: { of: lift, at: [2, 0], mirror: x }
outputs: { a: one.arm.x, angle: one.hinge.angle, image: two.hinge.angle, p: one.ram.piston_pressure, q: two.ram.piston_pressure }
simulation: { duration: 0.4, step: 1e-3, output_step: 0.02 }
";
    let bounds = nominal(&read(text));
    let [angle, image] = ["angle", "image"].map(|name| curve(&bounds, name));
    assert!(largest(angle.iter().zip(image).map(|(one, two)| one + two)) < 1e-10);
    assert!(distance(curve(&bounds, "p"), curve(&bounds, "q")) < 1e-2);
    assert!(largest(angle.iter().map(|angle| angle - 0.1)) > 0.02, "it moves");
}

/// The chapter shows its example and the figures of the example.
#[test]
fn the_chapter_shows_its_example() {
    let text = include_str!("../../docs/examples/boom.yaml");
    let chapter = include_str!("../../docs/controllers.md");
    assert!(chapter.contains(text), "the page shows the example");
    let bounds = run(&read(text));
    let last = row(&bounds, 4.0);
    let ends = |name: &str| {
        let band = band(output(&bounds, name), Method::Chebyshev);
        [band.lower[last], band.upper[last]]
    };
    let [low, high] = ends("angle").map(f64::to_degrees);
    assert!(chapter.contains(&format!("{low:.2}° to {high:.2}°")), "{low} {high}");
    let [low, high] = ends("force").map(|force| force / 1e3);
    assert!(chapter.contains(&format!("{low:.1} to {high:.1} kN")), "{low} {high}");
    // With the integral and the follower that it shows.
    let integral = text
        .replace("effects:\n", "states: { integral: { rate: target - pivot.angle, initial: 0 } }\neffects:\n")
        .replace("input: gain*(target - pivot.angle)", "input: gain*(target - pivot.angle) + 2*integral/(1 s)");
    assert!(chapter.contains("input: gain*(target - pivot.angle) + 2*integral/(1 s)"));
    let bounds = nominal(&read(&integral.replace("duration: 4", "duration: 20")));
    let angle = curve(&bounds, "angle")[row(&bounds, 20.0)].to_degrees();
    assert!((angle - 40.0).abs() < 0.02, "{angle}");
}
