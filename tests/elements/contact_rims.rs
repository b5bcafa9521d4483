//! Cylinders on a plane: standing, tipping, rolling; hulls of points.

use crate::common::{curve, largest, nominal, read};
use mbint::results::Bounds;

/// A cylinder (or the body of another `shape`) of 2 kg, radius 0.1 m, on a floor; the direction of gravity stands for
/// its slope along x.
fn on_slope(slope: f64, shape: &str, inertia: &str, start: &str, duration: f64) -> Bounds {
    let (sin, cos) = slope.sin_cos();
    let (along, down) = (9.81 * sin, -9.81 * cos);
    nominal(&read(&format!(
        "
bodies: {{ body: {{ mass: 2, inertia: {inertia} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [{along}, 0, {down}] }} }}
  floor: {{ contact: {{ between: [ground, body], plane: z, {shape}, impact: {{ stiffness: 1e5, exponent: 1, dissipation: 20 }}, friction: {{ coefficient: 0.9, transition_velocity: 2e-3 }} }} }}
initial: {{ {start} }}
outputs: {{ x: body.x, z: body.z, force: floor.force, gap: floor.gap, wx: body.omega.x, wy: body.omega.y, wz: body.omega.z, friction: floor.friction }}
simulation: {{ duration: {duration}, step: 2e-4, output_step: 0.01 }}
"
    )))
}

const UPRIGHT: &str = "cylinder: [[0, 0, -0.25], [0, 0, 0.25]], radius: 0.1";
const INERTIA: &str = "[0.0466666, 0.0466666, 0.01]";

fn last(bounds: &Bounds, name: &str) -> f64 {
    *curve(bounds, name).last().unwrap()
}

/// It stands on its face and carries its weight, spread over three points.
#[test]
fn a_cylinder_stands() {
    let bounds = on_slope(0.0, UPRIGHT, INERTIA, "body.x: 0, body.y: 0, body.z: 0.25", 1.0);
    assert!((last(&bounds, "force") - 2.0 * 9.81).abs() < 1e-4, "{}", last(&bounds, "force"));
    assert!((last(&bounds, "z") - 0.25 + 2.0 * 9.81 / 3e5).abs() < 1e-8, "{}", last(&bounds, "z"));
    assert!(["wx", "wy", "wz", "x"].iter().all(|name| last(&bounds, name).abs() < 1e-8));
}

/// It tips where the slope is above r/(h/2), and not below.
#[test]
fn a_cylinder_tips_about_its_rim() {
    let limit = (0.1_f64 / 0.25).atan();
    let start = "body.x: 0, body.y: 0, body.z: 0.25";
    let stands = on_slope(0.93 * limit, UPRIGHT, INERTIA, start, 1.5);
    assert!((last(&stands, "z") - 0.25).abs() < 2e-3, "{}", last(&stands, "z"));
    let tips = on_slope(1.07 * limit, UPRIGHT, INERTIA, start, 1.5);
    assert!(last(&tips, "z") < 0.2, "{}", last(&tips, "z"));
}

/// On its side it rolls by 2/3 g sin(slope), and on both rims.
#[test]
fn a_cylinder_rolls() {
    let slope = 0.2_f64;
    let lying = "cylinder: [[0, -0.25, 0], [0, 0.25, 0]], radius: 0.1";
    let depth = 2.0 * 9.81 * slope.cos() / 2e5;
    let start = format!("body.x: 0, body.y: 0, body.z: {}", 0.1 - depth);
    let bounds = on_slope(slope, lying, "[0.0466666, 0.01, 0.0466666]", &start, 1.0);
    let t = 1.0;
    let expected = 9.81 * slope.sin() / 3.0 * t * t;
    assert!((last(&bounds, "x") - expected).abs() < 2e-3 * expected, "{} not {expected}", last(&bounds, "x"));
    assert!((last(&bounds, "force") - 2.0 * 9.81 * slope.cos()).abs() < 1e-3, "{}", last(&bounds, "force"));
    assert!((last(&bounds, "friction") - 2.0 * 9.81 * slope.sin() / 3.0).abs() < 1e-2, "{}", last(&bounds, "friction"));
}

/// Its gap is that of the deepest rim point, n·c − h/2 |cos θ| − r sin θ, at whatever angle.
#[test]
fn gap_is_that_of_the_deepest_rim_point() {
    for angle in [0.05_f64, 0.4, 1.0, 1.5, 2.0, 2.9] {
        let bounds = nominal(&read(&format!(
            "
bodies: {{ body: {{ mass: 2, inertia: {INERTIA}, points: {{ at: {{ position: [0, 0, 0], rotation: {{ axis: [1, 0.5, 0], angle: {angle} rad }} }} }} }} }}
effects: {{ it: {{ contact: {{ between: [ground, body.at], plane: z, {UPRIGHT}, impact: {{ stiffness: 1e5 }} }} }} }}
initial: {{ body.x: 0, body.y: 0, body.z: 1 }}
outputs: {{ gap: it.gap }}
simulation: {{ duration: 0.01, step: 1e-3 }}
"
        )));
        let expected = 1.0 - 0.25 * angle.cos().abs() - 0.1 * angle.sin().abs();
        let gap = curve(&bounds, "gap")[0];
        assert!((gap - expected).abs() < 1e-8, "{angle}: {gap} not {expected}");
    }
}

/// A hull of points on a plane: each of its corners may touch. A tetrahedron stands on three, at m g/3K.
#[test]
fn a_tetrahedron_stands_on_its_face() {
    let hull =
        "corners: [[0.2, 0, -0.1], [-0.1, 0.17320508075688773, -0.1], [-0.1, -0.17320508075688773, -0.1], [0, 0, 0.3]]";
    let bounds = on_slope(0.0, hull, "[0.02, 0.02, 0.02]", "body.x: 0, body.y: 0, body.z: 0.12", 1.0);
    assert!((last(&bounds, "force") - 2.0 * 9.81).abs() < 1e-4, "{}", last(&bounds, "force"));
    assert!((last(&bounds, "z") - 0.1 + 2.0 * 9.81 / 3e5).abs() < 1e-8, "{}", last(&bounds, "z"));
    assert!(largest(["wx", "wy", "wz"].map(|name| last(&bounds, name))) < 1e-7);
    // On a slope it slides or stays by friction as a whole.
    let held = on_slope(0.3, hull, "[0.02, 0.02, 0.02]", "body.x: 0, body.y: 0, body.z: 0.1", 0.5);
    assert!(last(&held, "x").abs() < 5e-3, "{}", last(&held, "x"));
}

/// Thrown askew, an elastic cylinder without friction keeps its energy over all of its bounces.
#[test]
fn an_elastic_cylinder_keeps_its_energy() {
    let bounds = nominal(&read(&format!(
        "
bodies: {{ body: {{ mass: 2, inertia: {INERTIA} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}
  it: {{ contact: {{ between: [ground, body], plane: z, {UPRIGHT}, impact: {{ stiffness: 1e4, exponent: 1 }} }} }}
initial: {{ body.x: 0, body.y: 0, body.z: 0.5, body.omega.x: 2, body.omega.y: 0.7, body.omega.z: 3 }}
outputs: {{ energy: kinetic_energy + potential_energy, force: it.force, wz: body.omega.z }}
simulation: {{ duration: 2, step: 1e-4, output_step: 1e-3 }}
"
    )));
    let energy = curve(&bounds, "energy");
    let bounces = curve(&bounds, "force").windows(2).filter(|pair| pair[0] == 0.0 && pair[1] > 0.0).count();
    assert!(bounces >= 3, "{bounces}");
    let off = largest(energy.iter().map(|e| e / energy[0] - 1.0));
    assert!(off < 1e-4, "{off:e}");
}

/// A ball next to, over and about the rim of a cylinder: the gap is the least distance from its section by brute force.
#[test]
fn gaps_to_a_ball_are_least_distances() {
    let bounds = nominal(&read(&format!(
        "
bodies: {{ body: {{ mass: 2, inertia: {INERTIA}, points: {{ a: [0, 0, -0.25], b: [0, 0, 0.25] }} }} }}
effects: {{ it: {{ contact: {{ between: [ground, body], circle: 0.05, {UPRIGHT}, impact: {{ stiffness: 1e5 }} }} }} }}
initial: {{ body.x: -0.6, body.y: 0.25, body.z: 0.2, body.vx: 0.3, body.vz: -0.1, body.omega.x: 1.3, body.omega.y: 2.1 }}
outputs: {{ gap: it.gap, ax: body.a.x, ay: body.a.y, az: body.a.z, bx: body.b.x, by: body.b.y, bz: body.b.z }}
simulation: {{ duration: 4, step: 1e-3, output_step: 0.01 }}
"
    )));
    let of = |name: &str, row: usize| curve(&bounds, name)[row];
    for (row, gap) in curve(&bounds, "gap").iter().enumerate() {
        let [a, b] = [["ax", "ay", "az"], ["bx", "by", "bz"]].map(|names| names.map(|name| of(name, row)));
        let axis = [0, 1, 2].map(|i| (b[i] - a[i]) / 0.5);
        let ahead: f64 = (0..3).map(|i| -a[i] * axis[i]).sum();
        let aside = a.iter().map(|a| a * a).sum::<f64>() - ahead * ahead;
        let aside = aside.max(0.0).sqrt();
        // Over a grid of the half section, its edge among it, and refined about the best.
        let (mut best, mut at, mut width) = (f64::INFINITY, [0.25, 0.05], [0.25, 0.05]);
        for _ in 0..40 {
            let middle = at;
            for i in -10..=10 {
                for j in -10..=10 {
                    let t = (middle[0] + width[0] * f64::from(i) / 10.0).clamp(0.0, 0.5);
                    let r = (middle[1] + width[1] * f64::from(j) / 10.0).clamp(0.0, 0.1);
                    let distance = (ahead - t).hypot(aside - r);
                    if distance < best {
                        (best, at) = (distance, [t, r]);
                    }
                }
            }
            width = width.map(|width| 0.5 * width);
        }
        assert!((gap + 0.05 - best).abs() < 1e-8, "{row}: {} not {best}", gap + 0.05);
    }
}

/// A centre within a cylinder is pushed out through the nearest of its side and faces; all of K δ²/2 becomes speed.
#[test]
fn a_centre_inside_is_pushed_out() {
    for ([x, y, z], depth, along) in [
        ([0.07, 0.0, 0.1], 0.03, "x"),
        ([0.021, 0.034, 0.2371], 0.0129, "z"),
        ([0.003, -0.0817, -0.117], 0.1 - 0.003_f64.hypot(0.0817), "y"),
    ] {
        let bounds = nominal(&read(&format!(
            "
bodies: {{ ball: {{ mass: 2, inertia: [0.01, 0.01, 0.01] }}, body: {{ mass: 1e6, inertia: [1e6, 1e6, 1e6] }} }}
effects: {{ it: {{ contact: {{ between: [ball, body], circle: 0.05, {UPRIGHT}, impact: {{ stiffness: 1e4, exponent: 1 }} }} }} }}
initial: {{ ball.x: {x}, ball.y: {y}, ball.z: {z}, body.x: 0, body.y: 0, body.z: 0, body.vx: 0, body.vy: 0, body.vz: 0 }}
outputs: {{ x: ball.vx, y: ball.vy, z: ball.vz, gap: it.gap }}
simulation: {{ duration: 0.1, step: 2e-5, output_step: 0.01 }}
"
        )));
        let expected = (1e4_f64 / 2.0).sqrt() * (depth + 0.05);
        let speed = ["x", "y", "z"].map(|name| last(&bounds, name).powi(2)).iter().sum::<f64>().sqrt();
        assert!((curve(&bounds, "gap")[0] + depth + 0.05).abs() < 1e-12, "{}", curve(&bounds, "gap")[0]);
        assert!((speed - expected).abs() < 1e-3 * expected, "{speed}, not {expected}");
        assert!(last(&bounds, along).abs() > 0.99 * expected, "not along {along}");
    }
}

/// A ball and the side of a cylinder reflect as two balls of the same masses: along the common normal through both
/// centres.
#[test]
fn a_cylinder_and_a_ball_exchange_their_velocities() {
    let bounds = nominal(&read(&format!(
        "
bodies: {{ ball: {{ mass: 2, inertia: [0.01, 0.01, 0.01] }}, body: {{ mass: 2, inertia: {INERTIA} }} }}
effects: {{ it: {{ contact: {{ between: [ball, body], circle: 0.05, {UPRIGHT}, impact: {{ stiffness: 1e7 }} }} }} }}
initial: {{ ball.x: 0, ball.y: 0, ball.z: 0, body.x: 0.16, body.y: 0, body.z: 0, body.vx: -1 }}
outputs: {{ ball: ball.vx, body: body.vx }}
simulation: {{ duration: 0.03, step: 1e-5, output_step: 1e-3 }}
"
    )));
    assert!((last(&bounds, "ball") + 1.0).abs() < 1e-4 && last(&bounds, "body").abs() < 1e-4);
}
