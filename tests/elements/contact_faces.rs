//! Cylinders and boxes of the second body on blocks, hulls and bars: weights, rolling, tipping, impacts, energies.

use crate::common::{curve, largest, nominal, read};
use mbint::results::Bounds;
const DAMPED: &str = "impact: { stiffness: 1e5, exponent: 1, dissipation: 20 }, friction: { coefficient: 0.9, transition_velocity: 2e-3 }";
const UPRIGHT: &str = "cylinder: [[0, 0, -0.25], [0, 0, 0.25]], radius: 0.1";
const LYING: &str = "cylinder: [[0, -0.25, 0], [0, 0.25, 0]], radius: 0.1";
const OF_CYLINDER: &str = "[0.0466666, 0.0466666, 0.01]";
const OF_LYING: &str = "[0.0466666, 0.01, 0.0466666]";
/// A slab of 1.2 × 0.8 × 0.4 m, as a block with 1 mm of rounding on each side.
const SLAB: &str = "block: [1.198, 0.798, 0.398], rounding: 1 mm";
const SLAB_AS_HULL: &str = "hull: [[0.599, 0.399, 0.199], [0.599, 0.399, -0.199], [0.599, -0.399, 0.199], [0.599, -0.399, -0.199], \
     [-0.599, 0.399, 0.199], [-0.599, 0.399, -0.199], [-0.599, -0.399, 0.199], [-0.599, -0.399, -0.199]], rounding: 1 mm";

/// A body of 2 kg whose weight leans by a slope along x, on a surface about the origin.
fn on(surface: &str, shape: &str, (inertia, slope): (&str, f64), start: &str, duration: f64) -> Bounds {
    let (along, down) = (9.81 * slope.sin(), -9.81 * slope.cos());
    nominal(&read(&format!(
        "
space: spatial
bodies: {{ body: {{ mass: 2, inertia: {inertia} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [{along}, 0, {down}] }} }}
  it: {{ contact: {{ between: [ground, body], {surface}, {shape}, {DAMPED} }} }}
initial: {{ {start} }}
outputs: {{ x: body.x, z: body.z, force: it.force, wx: body.omega.x, wy: body.omega.y, wz: body.omega.z }}
simulation: {{ duration: {duration}, step: 2e-4, output_step: 0.01 }}
"
    )))
}

fn last(bounds: &Bounds, name: &str) -> f64 {
    *curve(bounds, name).last().unwrap()
}

/// On its face a cylinder stands on three points of its rim, by m g/3K.
#[test]
#[ignore = "2 s"]
fn a_cylinder_stands_on_a_face() {
    for surface in [SLAB, SLAB_AS_HULL] {
        let bounds = on(surface, UPRIGHT, (OF_CYLINDER, 0.0), "body.x: 0.1, body.y: 0.05, body.z: 0.45", 1.0);
        assert!((last(&bounds, "force") - 2.0 * 9.81).abs() < 1e-4, "{}", last(&bounds, "force"));
        assert!((last(&bounds, "z") - 0.45 + 2.0 * 9.81 / 3e5).abs() < 1e-8, "{}", last(&bounds, "z"));
        assert!(largest(["wx", "wy", "wz"].map(|name| last(&bounds, name))) < 1e-8);
    }
}

/// It rolls by 2/3 g sin(slope) on a face, on both rims, and along a bar.
#[test]
fn a_cylinder_rolls_on_a_face_and_on_a_bar() {
    let slope = 0.2_f64;
    let weight = 2.0 * 9.81 * slope.cos();
    for (surface, top, points) in [
        ("block: [1.8, 0.8, 0.398], rounding: 1 mm", 0.2, 2.0),
        ("capsule: [[-1, 0, 0], [1, 0, 0]], rounding: 0.2", 0.2, 1.0),
    ] {
        let start = format!("body.x: -0.2, body.y: 0, body.z: {}", top + 0.1 - weight / (points * 1e5));
        let bounds = on(surface, LYING, (OF_LYING, slope), &start, 0.8);
        let expected = 9.81 * slope.sin() / 3.0 * 0.8 * 0.8;
        assert!((last(&bounds, "x") + 0.2 - expected).abs() < 3e-3 * expected, "{surface}: {}", last(&bounds, "x"));
        assert!((last(&bounds, "force") - weight).abs() < 2e-3 * weight, "{surface}: {}", last(&bounds, "force"));
    }
}

/// A body that stands over an edge tips if its middle is beyond the edge.
#[test]
#[ignore = "3 s"]
fn body_tips_if_its_centre_is_beyond_the_edge() {
    let cube = "box: [0.2, 0.2, 0.5]";
    for (shape, inertia) in [(UPRIGHT, OF_CYLINDER), (cube, "[0.0483, 0.0483, 0.0133]")] {
        // A box on a hull has the edges of a box on the block.
        let surfaces = if shape == cube { &[SLAB][..] } else { &[SLAB, SLAB_AS_HULL] };
        for surface in surfaces {
            let tilt = |x: f64| {
                let start = format!("body.x: {x}, body.y: 0.02, body.z: 0.45");
                let bounds = on(surface, shape, (inertia, 0.0), &start, 0.5);
                largest(curve(&bounds, "z").iter().map(|z| z - 0.45))
            };
            let [held, falls] = [0.585, 0.606].map(tilt);
            assert!(held < 2e-3 && falls > 2.5e-3, "{shape} {surface}: {held} {falls}");
        }
    }
}

/// A box on a face carries its weight on four corners, as on a plane; flush with the block below, on the corners of
/// both and on all edges that end there.
#[test]
#[ignore = "4 s"]
fn a_box_stands_on_a_face() {
    let cube = "box: [0.196, 0.196, 0.196], radius: 2 mm";
    let inertia = "[0.0133, 0.0133, 0.0133]";
    for (surface, corners) in [
        (SLAB, 4.0),
        (SLAB_AS_HULL, 4.0),
        ("plane: [0, 0, 1]", 4.0),
        ("block: [0.196, 0.196, 0.398], rounding: 1 mm", 40.0),
    ] {
        let top = if surface.starts_with("plane") { 0.0 } else { 0.2 };
        let start = format!("body.x: 0, body.y: 0, body.z: {}", top + 0.1);
        let bounds = on(surface, cube, (inertia, 0.0), &start, 1.0);
        assert!((last(&bounds, "force") - 2.0 * 9.81).abs() < 1e-3, "{surface}: {}", last(&bounds, "force"));
        let depth = top + 0.1 - last(&bounds, "z");
        let expected = 2.0 * 9.81 / (corners * 1e5);
        assert!((depth - expected).abs() < 1e-3 * expected, "{surface}: {depth}, not {expected}");
    }
}

/// A plank across a beam rests on the four crossings of edges, and tips if its middle is beyond the beam.
#[test]
#[ignore = "4 s"]
fn a_plank_lies_across_a_beam() {
    let plank = "box: [1, 0.2, 0.05], radius: 1 mm";
    let beam = "block: [0.3, 1.5, 0.398], rounding: 1 mm";
    let inertia = "[0.0071, 0.1671, 0.1733]";
    for (x, is_held) in [(0.0, true), (0.1, true), (0.14, true), (0.16, false)] {
        let start = format!("body.x: {x}, body.y: 0.1, body.z: 0.226");
        let bounds = on(beam, plank, (inertia, 0.0), &start, 0.6);
        let lean = largest(curve(&bounds, "wy").iter().copied());
        assert_eq!(lean < 0.1, is_held, "{x}: {lean}");
        if is_held {
            assert!((last(&bounds, "force") - 2.0 * 9.81).abs() < 0.02, "{x}: {}", last(&bounds, "force"));
        }
        if x == 0.0 {
            let depth = 0.226 - last(&bounds, "z");
            assert!((depth - 2.0 * 9.81 / 4e5).abs() < 1e-3 * depth, "{depth}");
        }
    }
}

/// Three stacked boxes rest, and each carries the boxes above it.
#[test]
#[ignore = "6 s"]
fn a_stack_rests() {
    let cube = "box: [0.3, 0.3, 0.2], radius: 1 mm";
    let on_cube = "block: [0.3, 0.3, 0.2], rounding: 1 mm";
    let bounds = nominal(&read(&format!(
        "
space: spatial
bodies:
  a: {{ mass: 5, inertia: [0.054, 0.054, 0.075] }}
  b: {{ mass: 2, inertia: [0.022, 0.022, 0.03] }}
  c: {{ mass: 3, inertia: [0.033, 0.033, 0.045] }}
effects:
  weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}
  low: {{ contact: {{ between: [ground, a], plane: z, {cube}, {DAMPED} }} }}
  middle: {{ contact: {{ between: [a, b], {on_cube}, {cube}, {DAMPED} }} }}
  high: {{ contact: {{ between: [b, c], {on_cube}, {cube}, {DAMPED} }} }}
initial: {{ a.x: 0, a.y: 0, a.z: 0.101, b.x: 0.03, b.y: 0.02, b.z: 0.303, c.x: -0.02, c.y: 0.01, c.z: 0.505 }}
outputs: {{ x: c.x, z: c.z, w: c.omega.y, low: low.force, middle: middle.force, high: high.force }}
simulation: {{ duration: 0.4, step: 1e-3, output_step: 0.1 }}
"
    )));
    for (name, mass) in [("low", 10.0), ("middle", 5.0), ("high", 3.0)] {
        assert!((last(&bounds, name) - 9.81 * mass).abs() < 0.02, "{name}: {}", last(&bounds, name));
    }
    assert!((last(&bounds, "x") + 0.02).abs() < 1e-3 && (last(&bounds, "z") - 0.505).abs() < 1e-3);
    assert!(last(&bounds, "w").abs() < 1e-3, "{}", last(&bounds, "w"));
}

/// A body that hits a surface at rest along a normal through its middle flies back as fast, and does not turn: an edge
/// on an edge across it, a corner on the side of a cylinder, a corner on a corner, a box on a bar and on a ball.
#[test]
#[ignore = "2 s"]
fn central_impacts_reverse_the_speed() {
    let cube = "box: [0.2, 0.2, 0.2], radius: 5 mm";
    let solid = "block: [0.4, 0.4, 0.4], rounding: 5 mm";
    let on_edge = "position: [0, 0, 0], rotation: { axis: [1, 0, 0], angle: 45 deg }";
    let across = "position: [0, 0, 0], rotation: { axis: [0, 1, 0], angle: 45 deg }";
    // The diagonal of a cube upwards: about x − y by the angle between it and z.
    let on_corner = "position: [0, 0, 0], rotation: { axis: [1, -1, 0], angle: -0.9553166181245093 rad }";
    let half = |size: f64, share: f64| size * share;
    for (what, first, surface, second, shape, reach) in [
        ("edges", on_edge, solid, across, cube, half(0.3, 2.0_f64.sqrt()) + 0.01),
        (
            "corner and side",
            on_corner,
            solid,
            on_edge,
            "cylinder: [[0, -0.15, 0.15], [0, 0.15, -0.15]], radius: 0.1",
            0.2 * 3.0_f64.sqrt() + 0.105,
        ),
        ("corners", on_corner, solid, on_corner, cube, half(0.3, 3.0_f64.sqrt()) + 0.01),
        (
            "bar",
            on_edge,
            "capsule: [[-1, 0, 0], [1, 0, 0]], rounding: 0.05",
            across,
            cube,
            0.1 * 2.0_f64.sqrt() + 0.055,
        ),
        ("ball", on_edge, "circle: 0.05", on_corner, cube, 0.1 * 3.0_f64.sqrt() + 0.055),
    ] {
        let bounds = nominal(&read(&format!(
            "
space: spatial
bodies:
  ground: {{ points: {{ at: {{ {first} }} }} }}
  body: {{ mass: 2, inertia: [0.02, 0.02, 0.02], points: {{ at: {{ {second} }} }} }}
effects:
  it: {{ contact: {{ between: [ground.at, body.at], {surface}, {shape}, impact: {{ stiffness: 1e7, exponent: 1 }} }} }}
initial: {{ body.x: 0, body.y: 0, body.z: {}, body.vz: -1 }}
outputs: {{ gap: it.gap, force: it.force, v: body.vz, across: body.vx^2 + body.vy^2, spin: body.omega.x^2 + body.omega.y^2 + body.omega.z^2 }}
simulation: {{ duration: 0.02, step: 5e-6, output_step: 1e-4 }}
",
            reach + 0.005
        )));
        assert!((curve(&bounds, "gap")[0] - 0.005).abs() < 1e-9, "{what}: {}", curve(&bounds, "gap")[0]);
        assert!((last(&bounds, "v") - 1.0).abs() < 1e-3, "{what}: {}", last(&bounds, "v"));
        assert!(last(&bounds, "across") < 1e-6 && last(&bounds, "spin") < 1e-4, "{what}: {}", last(&bounds, "spin"));
        assert!(largest(curve(&bounds, "force").iter().copied()) > 100.0, "{what}");
    }
}

/// A body that narrowly misses a corner goes straight on; one that touches it a little is as fast as before.
#[test]
#[ignore = "10 s"]
fn a_corner_is_grazed() {
    for shape in ["cylinder: [[0, 0.02, -0.25], [0, 0.02, 0.25]], radius: 0.1", "box: [0.2, 0.2, 0.3], radius: 0"] {
        let flight = |depth: f64| {
            let y = 0.305 + if shape.starts_with("box") { 0.1 } else { 0.08 };
            nominal(&read(&format!(
                "
space: spatial
bodies: {{ body: {{ mass: 1, inertia: [1e3, 1e3, 1e3] }} }}
effects: {{ it: {{ contact: {{ between: [ground, body], block: [0.4, 0.6, 0.4], rounding: 5 mm, {shape}, impact: {{ stiffness: 1e5, exponent: 1 }} }} }} }}
initial: {{ body.x: -0.35, body.y: {}, body.z: 0.05, body.vx: 3 }}
outputs: {{ vx: body.vx, vy: body.vy, vz: body.vz }}
simulation: {{ duration: 0.24, step: 2e-5, output_step: 0.01 }}
",
                y - depth
            )))
        };
        assert_eq!(largest(curve(&flight(-1e-9), "vy").iter().copied()), 0.0);
        for depth in [1e-6, 1e-4] {
            let bounds = flight(depth);
            let [x, y, z] = ["vx", "vy", "vz"].map(|name| last(&bounds, name));
            assert!(((x * x + y * y + z * z).sqrt() - 3.0).abs() < 1e-5 && y > 0.0, "{shape} {depth:e}: {x} {y} {z}");
        }
    }
}

/// Elastic bodies thrown askew at edges and corners keep their energy over all of their bounces.
#[test]
#[ignore = "7 s"]
fn elastic_bodies_keep_their_energy() {
    for (shape, inertia) in [(UPRIGHT, OF_CYLINDER), ("box: [0.3, 0.2, 0.4], radius: 0.01", "[0.033, 0.042, 0.022]")] {
        for surface in [
            "block: [0.5, 0.4, 0.3], rounding: 0.03",
            "hull: [[-0.3, -0.2, -0.2], [0.3, -0.2, -0.2], [0, 0.3, -0.2], [0, 0, 0.2]], rounding: 0.03",
        ] {
            let bounds = nominal(&read(&format!(
                "
space: spatial
bodies: {{ body: {{ mass: 2, inertia: {inertia} }} }}
effects:
  spring: {{ spring_damper: {{ between: [ground, body], stiffness: 80, free_length: 0.2 }} }}
  it: {{ contact: {{ between: [ground, body], {surface}, {shape}, impact: {{ stiffness: 2e6, exponent: 1.5 }} }} }}
initial: {{ body.x: 0.3, body.y: 0.25, body.z: 0.7, body.omega: [2, 0.7, 3] }}
outputs: {{ energy: kinetic_energy + potential_energy, force: it.force, gap: it.gap }}
simulation: {{ duration: 2.5, step: 1e-4, output_step: 1e-3 }}
"
            )));
            let energy = curve(&bounds, "energy");
            let bounces = curve(&bounds, "force").windows(2).filter(|pair| pair[0] == 0.0 && pair[1] > 0.0).count();
            let off = largest(energy.iter().map(|e| e / energy[0] - 1.0));
            println!("{shape} {surface}: {bounces} bounces, {off:e}");
            assert!(bounces >= 4, "{shape} {surface}: {bounces}");
            assert!(off < 5e-3, "{shape} {surface}: {off:e}");
        }
    }
}

/// Through rims, sides, edges and corners the force has no jumps: its change over a step falls with the step.
#[test]
#[ignore = "10 s"]
fn forces_are_continuous() {
    let starts = [
        "body.x: 0.35, body.y: -0.5, body.z: 0.15, body.vy: 1, body.omega: [1, 3, 7]",
        "body.x: -0.5, body.y: 0.1, body.z: 0.42, body.vx: 1, body.omega: [5, -2, 1]",
    ];
    let mut pairs = 0;
    for shape in [
        UPRIGHT,
        "box: [0.3, 0.2, 0.4], radius: 0.02",
        "polyhedron: [[0.2, 0, 0], [-0.2, 0.05, 0], [0, 0.2, 0], [0, -0.2, 0.1], [0, 0, 0.3]], radius: 0.02",
    ] {
        for surface in [
            "block: [0.5, 0.4, 0.3], rounding: 0.05",
            "hull: [[-0.3, -0.2, -0.2], [0.3, -0.2, -0.2], [0, 0.3, -0.2], [0, 0, 0.2]], rounding: 0.05",
            "capsule: [[-0.3, 0, 0], [0.3, 0.1, 0]], rounding: 0.15",
        ] {
            pairs += 1;
            let start = starts[pairs % 2];
            let [coarse, fine] = [2e-4, 5e-5].map(|step| {
                    let bounds = nominal(&read(&format!(
                        "
space: spatial
bodies: {{ body: {{ mass: 1, inertia: [1, 1, 1] }} }}
effects: {{ it: {{ contact: {{ between: [ground, body], {surface}, {shape}, impact: {{ stiffness: 1e-9, exponent: 1 }} }} }} }}
initial: {{ {start} }}
outputs: {{ force: 1e9*it.force, gap: it.gap }}
simulation: {{ duration: 1, step: {step:e}, output_step: {step:e} }}
"
                    )));
                    // Deeper than nine tenths of the rounding nothing is promised.
                    let shallow = curve(&bounds, "gap").iter().map(|gap| *gap > -0.04).collect::<Vec<_>>();
                    let jumps = curve(&bounds, "force").windows(2).zip(shallow.windows(2));
                    largest(jumps.filter(|(_, ok)| ok[0] && ok[1]).map(|(pair, _)| pair[1] - pair[0]))
                });
            println!("{shape} {surface}: {coarse:e} {fine:e}");
            assert!(fine < 0.5 * coarse || coarse < 1e-9, "{shape} {surface} {start}: {coarse:e} {fine:e}");
        }
    }
}

/// While balls about both bodies are apart, no pair costs more than 40 instructions a step.
#[test]
#[ignore = "4 s"]
fn distant_contact_costs_one_comparison() {
    let model = |effect: &str| {
        read(&format!(
            "
space: spatial
bodies: {{ body: {{ mass: 1, inertia: [1, 1, 1] }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}{effect} }}
initial: {{ body.x: 0, body.y: 0, body.z: 5 }}
outputs: {{ z: body.z }}
simulation: {{ duration: 0.1, step: 1e-3 }}
"
        ))
    };
    let iteration = |effect: &str| {
        let explained = model(effect).study().explain().unwrap();
        let active = explained.instructions.correct;
        [explained.inactive.map_or(active, |counts| counts.correct), active]
    };
    let [bare, _] = iteration("");
    for surface in ["circle: 0.1", "capsule: [[0, 0, 0], [1, 0, 0]], rounding: 0.1", SLAB, SLAB_AS_HULL] {
        for shape in [
            UPRIGHT,
            "box: [1, 0.2, 0.05]",
            "polyhedron: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]",
            "line: [[0, 0, 0], [1, 0, 0]], radius: 0.1",
        ] {
            let effect = format!(", it: {{ contact: {{ between: [ground, body], {surface}, {shape}, {DAMPED} }} }}");
            let [far, near] = iteration(&effect).map(|count| count - bare);
            println!("{surface} {shape}: {far} far, {near} near");
            assert!(far <= 40 && near > 100, "{surface} {shape}: {far} far, {near} near");
        }
    }
}

/// A mirrored instance has mirrored boxes, polyhedra and cylinders.
#[test]
#[ignore = "5 s"]
fn mirrored_instance_moves_symmetrically() {
    let rock =
        "hull: [[-0.3, -0.2, 0.2], [0.4, -0.1, 0.25], [0, 0.3, 0.3], [0.05, 0.05, 0.35], [0, 0, 0]], rounding: 0.02";
    for (axis, surface, shape) in [
        (
            "x",
            "block: [0.5, 0.3, 0.2], rounding: 0.02",
            "polyhedron: [[0.15, 0, 0], [-0.1, 0.05, 0], [0, 0.2, 0.1], [0, -0.15, 0], [0, 0, -0.2]], radius: 0.01",
        ),
        ("y", rock, "box: [0.2, 0.1, 0.3], radius: 0.01"),
        ("y", rock, "cylinder: [[-0.1, 0.02, 0], [0.1, 0.05, 0.1]], radius: 0.05"),
    ] {
        let sign = |letter: &str| if letter == axis { -1.0 } else { 1.0 };
        let bounds = nominal(&read(&format!(
            "
assemblies:
  yard:
    bodies:
      foot: {{ mass: 1e3, inertia: [10, 10, 10], points: {{ at: {{ position: [0.1, 0.05, 0], rotation: {{ rpy: [0.3, -0.2, 0.4] }} }} }} }}
      it: {{ mass: 1, inertia: [0.01, 0.02, 0.03], points: {{ at: {{ position: [0.01, 0.02, 0], rotation: {{ rpy: [0.5, 0.1, -0.4] }} }} }} }}
    joints: {{ base: {{ fixed: [ground, foot] }} }}
    effects:
      e: {{ contact: {{ between: [foot.at, it.at], {surface}, {shape}, impact: {{ stiffness: 1e5, dissipation: 0.3 }}, friction: {{ coefficient: 0.2 }} }} }}
    initial: {{ it.x: 0.08, it.y: 0.1, it.z: 0.6, it.vz: -1 }}
instances: {{ one: {{ of: yard }}, two: {{ of: yard, mirror: {axis} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }} }}
outputs: {{ x: one.it.x, y: one.it.y, z: one.it.z, a: two.it.x, b: two.it.y, c: two.it.z, force: one.e.force }}
simulation: {{ duration: 0.3, step: 1e-4, output_step: 0.01 }}
"
        )));
        for (name, image) in [("x", "a"), ("y", "b"), ("z", "c")] {
            let off = largest(curve(&bounds, name).iter().zip(curve(&bounds, image)).map(|(a, b)| a - sign(name) * b));
            assert!(off < 1e-6, "{axis} {shape} {name}: {off:e}");
        }
        assert!(curve(&bounds, "force").iter().any(|force| *force > 1.0), "{shape}");
    }
}
