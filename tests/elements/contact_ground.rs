//! Ground by its height, as a formula or a table, moving too: against the exact distance of a hollow, minimal
//! coordinates, and a plane that a motor moves.

use crate::common::runge_kutta::runge_kutta;
use crate::common::{curve, distance, largest, nominal, read};

/// Balls along a hollow of radius 2, a bump of radius 1.5 and a slope have their exact distances.
#[test]
fn gaps_are_exact_distances() {
    // (R, ±): height of a hollow R − √(R² − x²), of a bump √(R² − x²) − R.
    let cases = [("2 - sqrt(4 - x^2)", 2.0, 2.0, -1.0), ("sqrt(2.25 - x^2) - 1.5", -1.5, 1.5, 1.0)];
    for (height, middle, radius, side) in cases {
        for (x, y) in [(0.0, 0.4), (0.3, 0.35), (-0.5, 0.5), (0.6, 0.31)] {
            for space in ["planar", "spatial"] {
                let up = if space == "planar" { "y" } else { "z" };
                let bounds = nominal(&read(&format!(
                    "
space: {space}
bodies: {{ ball: {{ mass: 1, coordinates: [x, {up}] }} }}
effects: {{ it: {{ contact: {{ between: [ground, ball], height: {height}, radius: 0.1, impact: {{ stiffness: 1 }} }} }} }}
initial: {{ ball.x: {x}, ball.{up}: {y} }}
outputs: {{ gap: it.gap }}
simulation: {{ duration: 0.001, step: 0.001, output_step: 0.001 }}
"
                )));
                let exact = side * (f64::hypot(x, y - middle) - radius) - 0.1;
                let gap = curve(&bounds, "gap")[0];
                assert!((gap - exact).abs() < 1e-6, "{height} at {x}, {y}: {gap}, not {exact}");
            }
        }
    }
}

/// A bead on y = A cos(k x): (1 + h'²) ẍ + h' h'' ẋ² + g h' = 0. Of a table of the same heights, too.
#[test]
fn a_bead_slides_on_waves() {
    let (a, k, g) = (0.05_f64, 4.0_f64, 9.81_f64);
    let rates = |[x, v]: [f64; 2]| {
        let (h1, h2) = (-a * k * (k * x).sin(), -a * k * k * (k * x).cos());
        [v, -(h1 * h2 * v * v + g * h1) / (1.0 + h1 * h1)]
    };
    let points: Vec<String> =
        (0..=160).map(|i| f64::from(i) / 40.0 - 1.0).map(|x| format!("[{x}, {}]", a * (k * x).cos())).collect();
    let table = format!("tables: {{ road: {{ points: [{}] }} }}\n", points.join(", "));
    for (tables, height, allowed) in [("", "0.05*cos(4*x)", 1e-6), (table.as_str(), "road(x)", 1e-6)] {
        let bounds = nominal(&read(&format!(
            "
{tables}bodies: {{ bead: {{ mass: 1, coordinates: [x, y] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  it: {{ contact: {{ between: [ground, bead], height: {height}, impact: {{ stiffness: 1e7, exponent: 1, dissipation: 5 }} }} }}
initial: {{ bead.x: 0.1, bead.y: 0.05*cos(0.4), bead.vx: 0.9, bead.vy: -0.18*sin(0.4) }}
outputs: {{ x: bead.x, force: it.force }}
simulation: {{ duration: 1, step: 2e-5, output_step: 0.05 }}
"
        )));
        let expected = runge_kutta(rates, [0.1, 0.9], 0.05, bounds.times.len(), 500);
        let expected: Vec<f64> = expected.iter().map(|state| state[0]).collect();
        assert!(curve(&bounds, "force")[1..].iter().all(|force| *force > 1.0), "it stays on the road");
        let off = distance(curve(&bounds, "x"), &expected);
        assert!(off < allowed, "{height}: {off:e}");
    }
}

/// A plane that shakes, by its height and by a motor; a slope that shakes pushes along its normal, with friction.
#[test]
fn moving_ground_pushes_like_a_moving_body() {
    let laws = "radius: 0.1, impact: { stiffness: 1e5, dissipation: 0.5 }, friction: { coefficient: 0.3 }";
    let ball = |table: &str, contact: &str| {
        nominal(&read(&format!(
            "
bodies:
  ball: {{ mass: 1, inertia: 0.004 }}
{table}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  it: {{ contact: {{ {contact}, {laws} }} }}
initial: {{ ball.x: 0, ball.y: 0.12, ball.vx: 0.5, ball.angular_velocity: 2 }}
outputs: {{ x: ball.x, y: ball.y, spin: ball.angular_velocity, force: it.force, rate: it.rate }}
simulation: {{ duration: 0.5, step: 1e-4, output_step: 0.01 }}
"
        )))
    };
    let moved = "  table: { mass: 1, inertia: 1 }
joints:
  rail: { prismatic: { between: [ground, table], axis: y } }
  shaker: { motor: { on: rail, position: 0.01*sin(30*t) } }";
    for (slope, normal) in [("", "[0, 1]"), (" - 0.5*x", "[0.5, 1]")] {
        let by_motor = ball(moved, &format!("between: [table, ball], plane: {normal}"));
        let by_height = ball("", &format!("between: [ground, ball], height: 0.01*sin(30*t){slope}"));
        for name in ["x", "y", "spin", "force", "rate"] {
            let [a, b] = [&by_motor, &by_height].map(|bounds| curve(bounds, name));
            let size = largest(a.iter().copied()).max(1.0);
            // Newton's iteration stops at 1e-10 m, which are 1e-7 of a force; a motor's velocity is off by h².
            let allowed = if slope.is_empty() && !matches!(name, "force" | "rate") { 1e-7 } else { 1e-6 };
            assert!(distance(a, b) < allowed * size, "{slope} {name}: {:e} of {size}", distance(a, b));
        }
        assert!(curve(&by_motor, "force").iter().filter(|force| **force > 1.0).count() > 5);
    }
}
