//! Hard cases of contact: a block that rocks on its corners, a stack at rest, a ball that grazes a post.

use crate::common::runge_kutta::runge_kutta;
use crate::common::{curve, largest, nominal, read, row};

/// Housner's block (*Bull. Seismol. Soc. Am.* 53 (1963) 403): about a corner 4/3 m R² θ̈ = −m g R sin(α − θ); a block
/// that lands on the other corner without rebound continues with 1 − 3/2 sin² α of its angular velocity.
#[test]
fn a_block_rocks_on_its_corners() {
    let (half_width, half_height, g) = (0.1_f64, 0.4_f64, 9.81);
    let radius = half_width.hypot(half_height);
    let slender = half_width.atan2(half_height);
    let tilt = 0.5 * slender;
    // On the right corner, turned clockwise about it: its centre is at the angle α − θ from the vertical.
    let (x, y) = (half_width - radius * (slender - tilt).sin(), radius * (slender - tilt).cos());
    let bounds = nominal(&read(&format!(
        "
bodies: {{ block: {{ mass: 2, inertia: 2*{radius:?}^2/3 }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -{g}] }} }}
  floor:
    contact:
      between: [ground, block]
      plane: y
      corners: [[-{half_width}, -{half_height}], [{half_width}, -{half_height}]]
      impact: {{ stiffness: 1e7, exponent: 1, dissipation: 200 }}
      friction: {{ coefficient: 0.9, transition_velocity: 1e-4 }}
initial: {{ block.x: {x:?}, block.y: {y:?}, block.angle: {:?}, block.vx: 0, block.vy: 0, block.angular_velocity: 0 }}
outputs: {{ angle: block.angle, speed: block.angular_velocity }}
simulation: {{ duration: 0.7, step: 2e-5, output_step: 0.005 }}
",
        -tilt
    )));
    let angles: Vec<f64> = curve(&bounds, "angle").iter().map(|angle| -angle).collect();
    let expected = runge_kutta(
        |[angle, speed]: [f64; 2]| [speed, -0.75 * g / radius * (slender - angle).sin()],
        [tilt, 0.0],
        0.005,
        bounds.times.len(),
        50,
    );
    let landing = expected.iter().position(|state| state[0] < 0.0).unwrap();
    for (found, state) in angles[..landing].iter().zip(&expected) {
        assert!((found - state[0]).abs() < 2e-4, "{found}, not {}", state[0]);
    }
    let speeds = curve(&bounds, "speed");
    let before = expected[landing - 1];
    // At the landing, by energy; after it, a little later, by energy about the other corner.
    let at_landing = (before[1].powi(2) + 1.5 * g / radius * ((slender - before[0]).cos() - slender.cos())).sqrt();
    let after = landing + 6;
    let found = (speeds[after].powi(2) + 1.5 * g / radius * ((slender + angles[after]).cos() - slender.cos())).sqrt();
    let kept = found / at_landing;
    let housner = 1.0 - 1.5 * slender.sin().powi(2);
    assert!(angles[after] < 0.0, "it rocks on the other corner");
    assert!((kept - housner).abs() < 0.01, "{kept}, not {housner}");
}

/// Three stacked boxes stay, and each carries the boxes above it.
#[test]
fn a_stack_stays_at_rest() {
    let law = "impact: { stiffness: 1e6, exponent: 1, dissipation: 20 }, friction: { coefficient: 0.5, transition_velocity: 1e-3 }";
    let corners = "corners: [[-0.1, -0.05], [0.1, -0.05]]";
    let bounds = nominal(&read(&format!(
        "
bodies:
  a: {{ mass: 1, inertia: 4e-3, points: {{ top: [0, 0.05] }} }}
  b: {{ mass: 2, inertia: 8e-3, points: {{ top: [0, 0.05] }} }}
  c: {{ mass: 3, inertia: 12e-3 }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  low: {{ contact: {{ between: [ground, a], plane: y, {corners}, {law} }} }}
  middle: {{ contact: {{ between: [a.top, b], plane: y, {corners}, {law} }} }}
  high: {{ contact: {{ between: [b.top, c], plane: y, {corners}, {law} }} }}
initial: {{ a.x: 0, a.y: 0.05, a.angle: 0, b.x: 0.01, b.y: 0.15, b.angle: 0, c.x: -0.01, c.y: 0.25, c.angle: 0,
           a.vx: 0, a.vy: 0, a.angular_velocity: 0, b.vx: 0, b.vy: 0, b.angular_velocity: 0, c.vx: 0, c.vy: 0, c.angular_velocity: 0 }}
outputs: {{ x: c.x, y: c.y, angle: c.angle, vy: c.vy, low: low.force, middle: middle.force, high: high.force }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.05 }}
"
    )));
    let last = bounds.times.len() - 1;
    for (name, mass) in [("low", 6.0), ("middle", 5.0), ("high", 3.0)] {
        let found = curve(&bounds, name)[last];
        assert!((found - 9.81 * mass).abs() < 1e-5 * found, "{name}: {found}");
    }
    // It settles by the penetrations: F/2k at each corner of each floor.
    let sunk = 9.81 / 2e6 * (6.0 + 5.0 + 3.0);
    assert!((curve(&bounds, "y")[last] - (0.25 - sunk)).abs() < 2e-6, "{}", curve(&bounds, "y")[last]);
    assert!((curve(&bounds, "x")[last] + 0.01).abs() < 1e-5 && curve(&bounds, "angle")[last].abs() < 1e-4);
    let half = row(&bounds, 1.0);
    assert!(largest(curve(&bounds, "vy")[half..].iter().copied()) < 1e-7);
}

/// A ball that narrowly misses a post goes straight on; one that touches it a little is turned little, and as fast as
/// before.
#[test]
fn a_ball_grazes_a_post() {
    let thrown = |depth: f64| {
        nominal(&read(&format!(
            "
bodies: {{ ball: {{ mass: 1, inertia: 1e-3 }} }}
effects: {{ post: {{ contact: {{ between: [ground, ball], circle: 0.2, radius: 0.1, impact: {{ stiffness: 1e6, exponent: 1 }} }} }} }}
initial: {{ ball.x: -0.5, ball.y: {:?}, ball.angle: 0, ball.vx: 3, ball.vy: 0, ball.angular_velocity: 0 }}
outputs: {{ y: ball.y, vx: ball.vx, vy: ball.vy, force: post.force }}
simulation: {{ duration: 0.4, step: 1e-5, output_step: 0.01 }}
",
            0.3 - depth
        )))
    };
    let beside = thrown(-1e-9);
    assert_eq!(largest(curve(&beside, "vy").iter().copied()), 0.0);
    let mut before = 0.0;
    for depth in [1e-7, 1e-6, 1e-5, 1e-4] {
        let bounds = thrown(depth);
        let last = bounds.times.len() - 1;
        let [vx, vy] = ["vx", "vy"].map(|name| curve(&bounds, name)[last]);
        // No loss: it leaves at the speed with which it came.
        assert!((vx.hypot(vy) - 3.0).abs() < 1e-6, "{depth:e}: {}", vx.hypot(vy));
        assert!(vy > before && vy < 0.2, "{depth:e}: {vy:e}");
        // While it hardly yields, depth over the way is d − x²/2(R + r), and the push ∫ k (d − x²/0.6) dx/v = 4/3 k d
        // √(0.6 d)/v.
        let push = 4.0 / 3.0 * 1e6 * depth * (0.6 * depth).sqrt() / 3.0;
        if depth < 2e-6 {
            assert!((vy / push - 1.0).abs() < 0.05, "{depth:e}: {vy:e}, not {push:e}");
        }
        before = vy;
    }
}
