//! Flexible bodies by matrices of finite elements: statics, frequencies, weights and motions against the textbook and
//! against beams.

use std::path::Path;

use mbint::results::Method;

use crate::common::finite_elements::Beam;
use crate::common::{Subject, band, curve, distance, largest, load, nominal, output, read, run};

const STEEL: Beam = Beam { length: 0.8, axial: 4e6, bending: [60.0, 90.0], torsional: 45.0, mass: 1.2, turning: 1e-4 };

/// The matrices of a beam between its ends, with `modes` modes.
fn between_ends(beam: &Beam, modes: usize) -> String {
    let elements = 20;
    beam.of_elements(elements).reduced(&[0, elements], modes).yaml(&[[0.0; 3], [beam.length, 0.0, 0.0]], modes)
}

/// A cantilever of space whose free end is body `tip`.
fn cantilever(modes: usize, parameters: &str, rest: &str) -> Subject {
    let matrices = between_ends(&STEEL, modes);
    read(&format!(
        "
space: spatial
parameters: {{ {parameters} }}
bodies:
  root: {{ mass: 0, inertia: 0 }}
  tip: {{ mass: 0, inertia: 0 }}
joints: {{ clamp: {{ fixed: [ground, root] }} }}
{rest}
    rod: {{ superelement: {{ nodes: [root, tip], stiffness: s, matrices: {matrices} }} }}
"
    ))
}

const FREE: &str = "s: 1";

/// P L³/3EI, P L²/2EI, T L/GJ: by constraint modes alone. The stiffness is uncertain, so bounds are those of 1/s.
#[test]
fn bending_and_torsion_match_the_textbook() {
    let description = cantilever(
        3,
        "s: { interval: [0.8, 1.2] }",
        "
analysis: statics
outputs: { y: tip.y, z: tip.z, slope: tip.p3*2, twist: tip.p1*2 }
bounds: { chebyshev: { order: 6 } }
effects:
    load: { force: { on: tip, value: [0, 0.01, -0.02] } }
    turn: { torque: { on: tip, value: [1e-3, 0, 0] } }",
    );
    let bounds = run(&description);
    let Beam { length: l, bending: [about_y, about_z], torsional, .. } = STEEL;
    let exact = [
        ("y", 0.01 * l.powi(3) / (3.0 * about_z)),
        ("z", -0.02 * l.powi(3) / (3.0 * about_y)),
        ("slope", 0.01 * l.powi(2) / (2.0 * about_z)),
        ("twist", 1e-3 * l / torsional),
    ];
    for (name, value) in exact {
        let found = band(output(&bounds, name), Method::Chebyshev);
        let ends = [value / 0.8, value / 1.2];
        let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        assert!(
            (curve(&bounds, name)[0] - value).abs() < 1e-4 * value.abs(),
            "{name}: {} {value}",
            curve(&bounds, name)[0]
        );
        assert!((found.lower[0] - low).abs() < 1e-4 * value.abs() + found.error.total[0], "{name}");
        assert!((found.upper[0] - high).abs() < 1e-4 * value.abs() + found.error.total[0], "{name}");
    }
}

/// ω = λ² √(EI/μ)/L², cos λ cosh λ = −1; along and about x π/2 √(EA/μ)/L and π/2 √(GJ/I)/L.
#[test]
fn frequencies_of_a_cantilever_match_the_textbook() {
    let description =
        cantilever(12, FREE, "analysis: modes\nmodes: { at: start, number: 6 }\noutputs: { y: tip.y }\neffects:");
    let bounds = nominal(&description);
    let Beam { length: l, bending: [about_y, about_z], axial, torsional, mass, turning } = STEEL;
    let bent = |lambda: f64, stiffness: f64| lambda.powi(2) * (stiffness / mass).sqrt() / l.powi(2);
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut exact = vec![quarter * (axial / mass).sqrt() / l, quarter * (torsional / turning).sqrt() / l];
    for lambda in [1.875_104_068_7, 4.694_091_133_0, 7.854_757_438_2, 10.995_540_734_9] {
        exact.extend([bent(lambda, about_y), bent(lambda, about_z)]);
    }
    exact.sort_by(f64::total_cmp);
    for (mode, exact) in exact.into_iter().take(6).enumerate() {
        let found = std::f64::consts::TAU * curve(&bounds, &format!("mode{}.frequency", mode + 1))[0];
        // The omitted modes make the difference; each frequency is an upper bound.
        assert!(found > exact * (1.0 - 1e-6) && found < exact * 1.005, "{mode}: {found} {exact}");
    }
}

/// q L⁴/8EI, and the clamp carries m g and m g L/2.
#[test]
fn a_cantilever_sags_under_its_weight() {
    let description = cantilever(
        4,
        FREE,
        "
analysis: statics
outputs: { y: tip.y, lift: clamp.force.y, moment: clamp.torque.z }
effects:
    weight: { gravity: { acceleration: [0, -0.1] } }",
    );
    let bounds = nominal(&description);
    let Beam { length: l, bending: [_, about_z], mass, .. } = STEEL;
    let close = |name: &str, exact: f64| {
        let found = curve(&bounds, name)[0];
        assert!((found - exact).abs() < 2e-4 * exact.abs(), "{name}: {found} {exact}");
    };
    close("y", -0.1 * mass * l.powi(4) / (8.0 * about_z));
    close("lift", 0.1 * mass * l);
    close("moment", 0.1 * mass * l * l / 2.0);
}

/// Thrown and spinning: the energy stays, and the centre of mass falls freely.
#[test]
fn a_free_body_keeps_its_energy() {
    let matrices = between_ends(&STEEL, 2);
    let description = read(&format!(
        "
space: spatial
bodies: {{ a: {{ mass: 0, inertia: 0 }}, b: {{ mass: 0, inertia: 0 }} }}
effects:
  rod: {{ superelement: {{ nodes: [a, b], matrices: {matrices} }} }}
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
initial: {{ a.x: 0, a.y: 0, a.z: 0, a.vx: 1, a.vy: 3, a.vz: -1, a.orientation: {{ rpy: [0.3, -0.2, 0.5] }}, a.omega: [2, 5, -3] }}
outputs: {{ energy: energy, kinetic: kinetic_energy, x: a.x/2 + b.x/2 }}
simulation: {{ duration: 0.4, step: 1e-4, output_step: 0.04 }}
"
    ));
    let bounds = nominal(&description);
    let (energy, kinetic) = (curve(&bounds, "energy"), curve(&bounds, "kinetic"));
    let drift = largest(energy.iter().map(|value| value - energy[0]));
    assert!(drift < 1e-5 * kinetic[0], "{drift} of {}", kinetic[0]);
}

/// An arm that a torque swings to and fro, against one that is a beam of eight elements: the tip is off the rigid arm's
/// line.
#[test]
fn an_arm_by_matrices_moves_like_a_beam() {
    let soft = Beam { length: 0.9, axial: 1e6, bending: [200.0, 200.0], torsional: 1.0, mass: 1.4, turning: 1e-5 };
    let arm = |bodies: &str, effect: &str, [start, end]: [&str; 2]| {
        nominal(&read(&format!(
            "
bodies:
  hub: {{ mass: 1, inertia: 0.1 }}
{bodies}
joints:
  pivot: {{ revolute: [ground, hub] }}
  clamp: {{ fixed: [hub, {start}] }}
effects:
  drive: {{ torque: {{ on: hub, value: 4*sin(20*t) }} }}
{effect}
outputs: {{ off: {end}.y*cos(hub.angle) - {end}.x*sin(hub.angle), angle: hub.angle }}
simulation: {{ duration: 0.3, step: 1e-4, output_step: 0.01 }}
"
        )))
    };
    let keys = "length: 0.9, mass_per_length: 1.4, axial_stiffness: 1e6, bending_stiffness: 200, elements: 8";
    let by_beam = arm(&format!("  rod: {{ beam: {{ {keys} }} }}"), "", ["rod.start", "rod.end"]);
    let matrices = between_ends(&soft, 5);
    let element = format!("  rod: {{ superelement: {{ nodes: [a, b], matrices: {matrices} }} }}");
    let by_matrices = arm("  a: { mass: 0, inertia: 0 }\n  b: { mass: 0, inertia: 0 }", &element, ["a", "b"]);
    for (name, share) in [("off", 1e-3), ("angle", 3e-5)] {
        let (beam, found) = (curve(&by_beam, name), curve(&by_matrices, name));
        let size = largest(beam.iter().copied());
        assert!(size > 1e-3, "{name}: {size}");
        assert!(distance(beam, found) < share * size, "{name}: {} of {size}", distance(beam, found));
    }
}

/// The example of the page, against the same strip as a beam of eight elements.
#[test]
fn the_strip_of_the_page_moves_like_a_beam() {
    let page = include_str!("../../docs/guides/flexible.md");
    let [model, matrices] = [
        include_str!("../../docs/examples/flexible_arm.yaml"),
        include_str!("../../docs/examples/matrices/strip.yaml"),
    ];
    assert!(page.contains(model) && page.contains(matrices), "the page shows the example");
    let found = nominal(&load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples/flexible_arm.yaml")));
    // E A = 2.1e11 · 6e-5, E I = 2.1e11 · 4.5e-11, μ = 7850 · 6e-5.
    let strip = "beam: { length: 0.6, mass_per_length: 0.471, axial_stiffness: 1.26e7, bending_stiffness: 9.45, damping: 1e-4, elements: 8 }";
    let lines = model.lines().filter(|line| !["  strip:", "  tip:"].iter().any(|key| line.starts_with(key)));
    let text = lines.collect::<Vec<_>>().join("\n").replace(
        "root: { mass: 0, inertia: 0 }",
        &format!("root: {{ {strip} }}\n  ball: {{ mass: load, inertia: 1e-5 }}"),
    );
    let text = text
        .replace("hub.rim, root]", "hub.rim, root.start]\n  glue: { fixed: [root.end, ball] }")
        .replace("tip.", "ball.");
    let text = text
        .replace("glue: { fixed: [root.end, ball] } }", "glue: { fixed: [root.end, ball] }")
        .replace("root.start]\n", "root.start] }\n");
    let beam = nominal(&read(&text));
    for (name, share) in [("angle", 2e-3), ("bent", 1e-2), ("height", 2e-3)] {
        let [beam, found] = [&beam, &found].map(|bounds| curve(bounds, name));
        let size = largest(beam.iter().copied());
        eprintln!("{name} {} of {size}", distance(beam, found));
        assert!(distance(beam, found) < share * size, "{name}: {} of {size}", distance(beam, found));
    }
}

/// A free rod flies and spins in space: the centre moves steadily, and it turns about itself as one that does not fly.
#[test]
fn translation_leaves_deformation_unchanged() {
    let soft = Beam { length: 0.8, axial: 2e4, bending: [6.0, 9.0], torsional: 4.5, mass: 1.2, turning: 1e-3 };
    let matrices = between_ends(&soft, 4);
    let spins = |velocity: [f64; 3]| {
        let [x, y, z] = velocity;
        nominal(&read(&format!(
            "
space: spatial
bodies: {{ a: {{ mass: 0, inertia: 0 }}, b: {{ mass: 0, inertia: 0 }} }}
effects: {{ rod: {{ superelement: {{ nodes: [a, b], matrices: {matrices} }} }} }}
initial: {{ a.x: 0, a.y: 0, a.z: 0, a.vx: {x}, a.vy: {y}, a.vz: {z}, a.orientation: {{ rpy: [0.3, -0.2, 0.5] }}, a.omega: [2, 5, -3] }}
outputs: {{ x: a.x - {x}*t, y: a.y - {y}*t, z: a.z - {z}*t, far: b.x - {x}*t, p1: a.p1, p3: b.p3, spin: b.omega.y }}
simulation: {{ duration: 0.3, step: 2e-4, output_step: 0.03 }}
"
        )))
    };
    let (in_place, flying) = (spins([0.0; 3]), spins([20.0, -15.0, 8.0]));
    for name in ["x", "y", "z", "far", "p1", "p3", "spin"] {
        let [rests, flies] = [&in_place, &flying].map(|bounds| curve(bounds, name));
        assert!(largest(rests.iter().map(|value| value - rests[0])) > 0.01, "{name} moves");
        assert!(distance(rests, flies) < 1e-7, "{name}: {}", distance(rests, flies));
    }
}

/// ½ ρA ω² (l² − x²) pulls at x of a rod that spins about its middle, by which each half is longer by ρA ω² l³/3EA.
#[test]
fn elongation_of_a_spinning_rod_matches_the_textbook() {
    let rod = Beam { length: 0.8, axial: 3e4, bending: [4e3, 4e3], torsional: 10.0, mass: 1.2, turning: 1e-3 };
    let matrices = between_ends(&rod, 0);
    let omega = 20.0;
    let half = 0.4 * omega;
    let bounds = nominal(&read(&format!(
        "
bodies: {{ a: {{ mass: 0, inertia: 0 }}, b: {{ mass: 0, inertia: 0 }} }}
effects: {{ rod: {{ superelement: {{ nodes: [a, b], matrices: {matrices}, damping: 1e-3 }} }} }}
initial: {{ a.x: 0, a.y: 0, a.angle: 0, a.vx: 30, a.vy: -{half}, a.angular_velocity: {omega} }}
outputs: {{ longer: sqrt((b.x - a.x)^2 + (b.y - a.y)^2) - 0.8, turned: a.angle - {omega}*t }}
simulation: {{ duration: 0.2, step: 2e-4, output_step: 0.01 }}
"
    )));
    let exact = 2.0 * rod.mass * omega * omega * 0.4_f64.powi(3) / (3.0 * rod.axial);
    let longer = curve(&bounds, "longer").last().copied().unwrap_or_default();
    // As it gets longer it turns slower, and pulls itself further by as much.
    assert!((longer - exact).abs() < 3.0 * exact / 0.8 * exact + 1e-3 * exact, "{longer} {exact}");
}

/// The coupler of a slow slider crank bends under the acceleration across it, which is linear along it: at the middle
/// by 5 μ (a_A + a_B)/2 l⁴/384 EI of a beam on two pins.
#[test]
fn a_coupler_bends_under_its_own_inertia() {
    let coupler =
        Beam { length: 0.5, axial: 1e6, bending: [1500.0, 1500.0], torsional: 10.0, mass: 1.0, turning: 1e-4 };
    let (radius, speed) = (0.1, 10.0);
    let crank = |bodies: &str, effects: &str, [start, middle, end]: [&str; 3]| {
        nominal(&read(&format!(
            "
bodies:
  crank: {{ mass: 1, inertia: 0.01, points: {{ A: [{radius}, 0] }} }}
  slider: {{ mass: 0.5, inertia: 0.01 }}
{bodies}
joints:
  shaft: {{ revolute: [ground, crank] }}
  big: {{ revolute: [crank.A, {start}] }}
  small: {{ revolute: [{end}, slider] }}
  guide: {{ prismatic: {{ between: [ground, slider], axis: x }} }}
  drive: {{ motor: {{ on: shaft, position: {speed}*t }} }}
{effects}
guess: {{ slider.x: 0.6, {end}.x: 0.6, {middle}.x: 0.35, {start}.x: 0.1 }}
outputs:
  bent: (({end}.x - {start}.x)*({middle}.y - {start}.y) - ({end}.y - {start}.y)*({middle}.x - {start}.x))/0.5
simulation: {{ duration: 0.7, step: 1e-3, output_step: 0.02 }}
"
        )))
    };
    let elements = 20;
    let nodes = [[0.0; 3], [0.25, 0.0, 0.0], [0.5, 0.0, 0.0]];
    let matrices = coupler.of_elements(elements).reduced(&[0, elements / 2, elements], 2).yaml(&nodes, 2);
    let found = crank(
        "  a: { mass: 0, inertia: 0 }\n  m: { mass: 0, inertia: 0 }\n  b: { mass: 0, inertia: 0 }",
        &format!("effects: {{ rod: {{ superelement: {{ nodes: [a, m, b], damping: 2e-4, matrices: {matrices} }} }} }}"),
        ["a", "m", "b"],
    );
    let keys = "length: 0.5, mass_per_length: 1, axial_stiffness: 1e6, bending_stiffness: 1500, damping: 2e-4";
    let rod = format!("  rod: {{ beam: {{ {keys}, elements: 8 }} }}");
    let by_beam = crank(&rod, "", ["rod.start", "rod.node4", "rod.end"]);
    let closed = |time: f64| {
        let (l, at) = (0.5_f64, radius * (speed * time).sin() / 0.5);
        let rod = -at.asin();
        // The pin at the crank has −r ω² (cos, sin), the slider moves along x alone: across the rod by sin and cos of
        // its angle.
        let rate = -radius * speed * (speed * time).cos() / (l * rod.cos());
        let gain = (radius * speed * speed * (speed * time).sin() + l * rate * rate * rod.sin()) / (l * rod.cos());
        let across = -radius * speed * speed * (-(speed * time).cos() * rod.sin() + (speed * time).sin() * rod.cos());
        let mean = across + 0.5 * l * gain;
        -5.0 * coupler.mass * mean * l.powi(4) / (384.0 * coupler.bending[1])
    };
    let (found, beam) = (curve(&found, "bent"), curve(&by_beam, "bent"));
    let exact: Vec<f64> = (0..found.len()).map(|row| closed(0.02 * row as f64)).collect();
    let size = largest(exact.iter().copied());
    // The first rows contain the vibration that the start from the straight rod excites.
    let (found, beam, exact) = (&found[3..], &beam[3..], &exact[3..]);
    assert!(distance(found, exact) < 0.01 * size, "{found:?} {exact:?}");
    assert!(distance(found, beam) < 0.01 * size, "{found:?} {beam:?}");
}
