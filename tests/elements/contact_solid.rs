//! Contacts with capsules and blocks, against planes, spheres, cylinders, outlines, closed forms, and their images.

use crate::common::{band, curve, largest, nominal, output, read, row, run};
use mbint::results::{Bounds, Method};

const LAWS: &str = "radius: 0.1, impact: { stiffness: 1e6, dissipation: 0.3 }, friction: { coefficient: 0.2 }";

/// A ball of 1 kg under its weight in space, thrown at a surface at `at`, in a frame that lies askew where it says so.
fn thrown(at: &str, surface: &str, [x, y, z]: [f64; 3], [vx, vy, vz]: [f64; 3]) -> Bounds {
    nominal(&read(&format!(
        "
space: spatial
bodies:
  ground:
    points:
      top: [0, 0, 0.22]
      corner: [0.5, 0.2, 0.2]
      middle: {{ position: [0.1, 0.2, -0.1], rotation: {{ rpy: [0.3, -0.4, 0.5] }} }}
      end: {{ position: [0.5, 0, 0], rotation: {{ rpy: [0.3, -0.4, 0.5] }} }}
  ball: {{ mass: 1, inertia: [0.004, 0.004, 0.004] }}
effects:
  weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}
  it: {{ contact: {{ between: [{at}, ball], {surface}, {LAWS} }} }}
initial: {{ ball.x: {x}, ball.y: {y}, ball.z: {z}, ball.vx: {vx}, ball.vy: {vy}, ball.vz: {vz} }}
outputs:
  {{ x: ball.x, y: ball.y, z: ball.z, spin: ball.omega.y, gap: it.gap, rate: it.rate, force: it.force, friction: it.friction }}
simulation: {{ duration: 0.4, step: 1e-4, output_step: 1e-3 }}
"
    )))
}

#[track_caller]
fn assert_same(a: &Bounds, b: &Bounds, names: &[&str]) {
    for name in names {
        let (one, other) = (curve(a, name), curve(b, name));
        let error = largest(one.iter().zip(other).map(|(a, b)| a - b));
        let size = largest(other.iter().copied());
        // Newton's iteration stops at 1e-10 m, which are this share of a force with 1e6 N/m^1.5.
        let allowed = if matches!(*name, "force" | "friction") { 1e-6 } else { 1e-7 };
        assert!(error <= allowed * size.max(1.0), "{name}: {error:e} of {size}");
    }
    assert!(curve(b, "force").iter().any(|force| *force > 1.0), "no contact");
}

const ALL: [&str; 8] = ["x", "y", "z", "spin", "gap", "rate", "force", "friction"];

/// The face of a block is a plane, below it and askew.
#[test]
fn faces_are_planes() {
    let (start, speed) = ([0.05, 0.1, 0.5], [0.6, 0.2, 0.0]);
    let block = thrown("ground", "block: [2, 3, 0.4], rounding: 0.02", start, speed);
    assert_same(&block, &thrown("ground.top", "plane: z", start, speed), &ALL);
    let block = thrown("ground.middle", "block: [4, 4, 1e-3], rounding: 0.02", start, speed);
    let plane = thrown("ground.middle", "plane: z", [0.05, 0.1, 0.5], speed);
    // The plane is 20.5 mm lower along its normal: the same impact later on.
    let [first, later] = [&block, &plane].map(|bounds| largest(curve(bounds, "force").iter().copied()));
    assert!(first > 100.0 && later > first, "{first} {later}");
}

/// A capsule is a cylinder between its ends, and a sphere about each of them.
#[test]
fn a_capsule_is_a_cylinder_and_two_spheres() {
    let capsule = "capsule: [[0, 0, 0], [0, 0, 3]], rounding: 0.05";
    let (start, speed) = ([0.12, 0.2, 0.4], [0.0, 0.0, -0.5]);
    let cylinder = thrown("ground.middle", "circle: 0.05, axis: z", start, speed);
    let long = capsule.replace("[0, 0, 0]", "[0, 0, -3]");
    assert_same(&thrown("ground.middle", &long, start, speed), &cylinder, &ALL);
    let (start, speed) = ([0.52, 0.01, 0.4], [0.0, 0.0, -0.5]);
    let sphere = thrown("ground.end", "circle: 0.05", start, speed);
    // In the axes of the middle, −z points down and away from the ball.
    for (from, to) in [("[0, 0, 0]", "[0, 0, -3]"), ("[0, 0, -3]", "[0, 0, 0]")] {
        let capsule = format!("capsule: [{from}, {to}], rounding: 0.05");
        assert_same(&thrown("ground.end", &capsule, start, speed), &sphere, &["x", "y", "z", "force", "friction"]);
    }
}

/// Across its edges a block is a polygon of the plane: a ball rolls over the edge, and one falls on it.
#[test]
fn edges_of_a_block_match_those_of_a_polygon() {
    for ([x, y], [vx, vy]) in [([0.35, 0.33], [0.8, 0.0]), ([0.53, 0.45], [-0.3, -1.0]), ([0.75, 0.05], [-1.5, 0.5])] {
        let motion = |space: &str, surface: &str, more: &str, inertia: &str, turn: &str| {
            nominal(&read(&format!(
                "
space: {space}
bodies: {{ ball: {{ mass: 1, inertia: {inertia} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  it: {{ contact: {{ between: [ground, ball], {surface}, rounding: 0.03, {LAWS} }} }}
initial: {{ ball.x: {x}, ball.y: {y}, ball.vx: {vx}, ball.vy: {vy}, {more} }}
outputs: {{ x: ball.x, y: ball.y, spin: {turn}, gap: it.gap, force: it.force }}
simulation: {{ duration: 0.5, step: 1e-4, output_step: 1e-3 }}
"
            )))
        };
        let planar = motion(
            "planar",
            "polygon: [[0.5, 0.2], [-0.5, 0.2], [-0.5, -0.2], [0.5, -0.2]]",
            "ball.angle: 0, ball.angular_velocity: 0",
            "0.004",
            "ball.angular_velocity",
        );
        let flat = motion(
            "planar",
            "block: [1, 0.4]",
            "ball.angle: 0, ball.angular_velocity: 0",
            "0.004",
            "ball.angular_velocity",
        );
        assert_same(&flat, &planar, &["x", "y", "spin", "gap", "force"]);
        let spatial = motion("spatial", "block: [1, 0.4, 2]", "ball.z: 0.3", "[0.004, 0.004, 0.004]", "ball.omega.z");
        assert_same(&spatial, &planar, &["x", "y", "spin", "gap", "force"]);
    }
}

/// A corner reflects as the sphere about it does.
#[test]
fn corners_are_spheres() {
    let (start, speed) = ([0.51, 0.22, 0.6], [0.0, 0.0, -0.5]);
    let sphere = thrown("ground.corner", "circle: 0.05", start, speed);
    let block = thrown("ground", "block: [1, 0.4, 0.4], rounding: 0.05", start, speed);
    // Below its height the corner continues as an edge.
    let beside = curve(&sphere, "z").iter().position(|z| *z < 0.2).unwrap_or(400);
    for name in ALL {
        let off = largest(curve(&block, name)[..beside].iter().zip(curve(&sphere, name)).map(|(a, b)| a - b));
        assert!(off < 1e-9, "{name}: {off:e}");
    }
    assert!(curve(&block, "force")[..beside].iter().any(|force| *force > 1.0), "no contact");
}

/// From within a block the nearest face pushes; all of K δⁿ⁺¹/(n + 1) becomes speed, wherever the centre is, also in
/// the middle of a cube.
#[test]
fn a_centre_inside_is_pushed_out() {
    for (index, depth) in
        [([0.05, 0.02, 0.12], 0.08), ([0.0, 0.0, 0.0], 0.2), ([-0.15, 0.0, 0.0], 0.05), ([0.1, 0.1, 0.0], 0.1)]
    {
        let [x, y, z] = index;
        let bounds = nominal(&read(&format!(
            "
bodies: {{ ball: {{ mass: 2, inertia: [0.004, 0.004, 0.004] }} }}
effects: {{ it: {{ contact: {{ between: [ground, ball], block: [0.4, 0.4, 0.4], rounding: 0.01, radius: 0.02, impact: {{ stiffness: 1e4, exponent: 1 }} }} }} }}
initial: {{ ball.x: {x}, ball.y: {y}, ball.z: {z} }}
outputs: {{ vx: ball.vx, vy: ball.vy, vz: ball.vz, gap: it.gap, energy: kinetic_energy + potential_energy }}
simulation: {{ duration: 0.1, step: 2e-5, output_step: 0.01 }}
"
        )));
        let v = ["vx", "vy", "vz"].map(|name| *curve(&bounds, name).last().unwrap());
        let speed = v.iter().map(|v| v * v).sum::<f64>().sqrt();
        let expected = (1e4_f64 / 2.0).sqrt() * (depth + 0.03);
        assert!((speed - expected).abs() < 1e-3 * expected, "{index:?}: {v:?}, not {expected}");
        assert!((curve(&bounds, "gap")[0] + depth + 0.03).abs() < 1e-12);
        let energy = curve(&bounds, "energy");
        assert!(largest(energy.iter().map(|e| e / energy[0] - 1.0)) < 1e-4);
    }
}

/// A block on a block on the floor: the corners of each on the other's face; they rest, and carry their weights.
#[test]
fn a_stack_rests() {
    let corners = "corners: [[0.15, 0.15, -0.1], [-0.15, 0.15, -0.1], [0.15, -0.15, -0.1], [-0.15, -0.15, -0.1]]";
    let law = "impact: { stiffness: 1e5, exponent: 1, dissipation: 20 }, friction: { coefficient: 0.5, transition_velocity: 5e-3 }";
    let bounds = nominal(&read(&format!(
        "
bodies: {{ lower: {{ mass: 5, inertia: [0.1, 0.1, 0.1] }}, upper: {{ mass: 2, inertia: [0.04, 0.04, 0.04] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}
  floor: {{ contact: {{ between: [ground, lower], plane: z, {corners}, radius: 0.01, {law} }} }}
  joint: {{ contact: {{ between: [lower, upper], block: [0.36, 0.36, 0.18], rounding: 0.01, {corners}, radius: 0.01, {law} }} }}
initial: {{ lower.z: 0.11, upper.z: 0.32, upper.x: 0.02 }}
outputs: {{ z: upper.z, x: upper.x, w: upper.omega.y, floor: floor.force, joint: joint.force }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.1 }}
"
    )));
    let last = row(&bounds, 1.0);
    let of = |name: &str| curve(&bounds, name)[last];
    assert!(
        (of("floor") - 7.0 * 9.81).abs() < 1e-3 && (of("joint") - 2.0 * 9.81).abs() < 1e-3,
        "{} {}",
        of("floor"),
        of("joint")
    );
    // The lower one tilts by M/4Ka² = 4.4e-5 under the load off its middle, and the upper one with it.
    assert!(
        (of("x") - 0.02).abs() < 3e-5 && of("w").abs() < 1e-5 && (of("z") - 0.32).abs() < 1e-3,
        "{} {}",
        of("x"),
        of("z")
    );
}

/// A mirrored instance bounces off mirrored solids.
#[test]
fn mirrored_instance_moves_symmetrically() {
    let bar = "capsule: [[-0.2, 0.1, 0.3], [0.3, 0, 0.3]]";
    let rock = "hull: [[-0.3, -0.2, 0.2], [0.4, -0.1, 0.25], [0, 0.3, 0.3], [0.05, 0.05, 0.35], [0, 0, 0]]";
    for (axis, surface) in [("x", bar), ("y", bar), ("x", rock), ("y", rock)] {
        let sign = |letter: &str| if letter == axis { -1.0 } else { 1.0 };
        let bounds = nominal(&read(&format!(
            "
assemblies:
  yard:
    bodies: {{ foot: {{ mass: 1e3, inertia: [10, 10, 10], points: {{ at: {{ position: [0.1, 0.05, 0], rotation: {{ rpy: [0.3, -0.2, 0.4] }} }} }} }}, ball: {{ mass: 1, inertia: [0.004, 0.004, 0.004] }} }}
    joints: {{ base: {{ fixed: [ground, foot] }} }}
    effects:
      bar: {{ contact: {{ between: [foot.at, ball], {surface}, rounding: 0.03, {LAWS} }} }}
      box: {{ contact: {{ between: [foot.at, ball], block: [0.5, 0.3, 0.2], rounding: 0.03, {LAWS} }} }}
    initial: {{ ball.x: 0.05, ball.y: 0.1, ball.z: 0.6, ball.vz: 0 }}
instances: {{ one: {{ of: yard }}, two: {{ of: yard, mirror: {axis} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }} }}
outputs: {{ x: one.ball.x, y: one.ball.y, z: one.ball.z, a: two.ball.x, b: two.ball.y, c: two.ball.z, force: one.bar.force, box: one.box.force }}
simulation: {{ duration: 0.6, step: 1e-4, output_step: 0.01 }}
"
        )));
        for (name, image) in [("x", "a"), ("y", "b"), ("z", "c")] {
            let off = largest(curve(&bounds, name).iter().zip(curve(&bounds, image)).map(|(a, b)| a - sign(name) * b));
            assert!(off < 1e-6, "{axis} {name}: {off:e}");
        }
        let touches = |name: &str| curve(&bounds, name).iter().any(|force| *force > 1.0);
        assert!(if surface == rock { touches("force") } else { touches("force") || touches("box") });
    }
}

/// The chapter's ball rolls 5/14 g sin(slope) t² down its ramp before it meets the bar.
#[test]
fn the_chapter_shows_its_example() {
    let text = include_str!("../../docs/examples/ramp.yaml");
    let chapter = include_str!("../../docs/shapes.md");
    assert!(chapter.contains(text), "the page shows the example");
    let bounds = run(&read(text));
    let band = band(output(&bounds, "x"), Method::Chebyshev);
    let place = |slope: f64, t: f64| {
        let (sin, cos) = slope.to_radians().sin_cos();
        (5.0 / 14.0 * 9.81 * sin * t * t - 0.4) * cos + 0.1 * sin
    };
    for t in [0.3, 0.6, 0.9] {
        let row = row(&bounds, t);
        let off = largest([band.lower[row] - place(9.0, t), band.upper[row] - place(11.0, t)]);
        // It sinks in by m g/K = 5e-5 m, and slides until it rolls.
        assert!(off < 5e-4, "{t}: {off:e}");
    }
    let width = |t: f64| band.upper[row(&bounds, t)] - band.lower[row(&bounds, t)];
    assert!(chapter.contains(&format!("the bounds are {:.0} mm apart", 1e3 * width(0.9))), "{}", width(0.9));
    let last = row(&bounds, 1.4);
    let rest = format!("{:.3} to {:.3} m", band.lower[last], band.upper[last]);
    assert!(chapter.contains(&rest), "{rest}");
}
