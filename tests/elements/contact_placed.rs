//! Contacts in instances of assemblies, and the example of their page.

use mbint::results::Method;

use crate::common::{band, curve, largest, nominal, output, read, row, run};

/// A mirrored instance bounces off mirrored surfaces.
#[test]
fn a_mirrored_instance_has_mirrored_surfaces() {
    let text = "
assemblies:
  ramp:
    bodies: { foot: { mass: 1e3, inertia: 1e3 }, ball: { mass: 1, inertia: 0.004 } }
    joints: { base: { fixed: [ground, foot] } }
    effects:
      slope: { contact: { between: [foot, ball], plane: [1, 2], radius: 0.1, impact: { stiffness: 1e5 }, friction: { coefficient: 0.3 } } }
      step: { contact: { between: [foot, ball], path: [[0.3, 0], [0.6, 0.1], [1, 0]], rounding: 0.02, radius: 0.1, impact: { stiffness: 1e5 } } }
    initial: { ball.x: -0.2, ball.y: 0.4, ball.angle: 0, ball.vx: 0.3, ball.vy: 0, ball.angular_velocity: 0 }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
instances:
  left: { of: ramp, at: { position: [1, 0] } }
  right: { of: ramp, at: { position: [-1, 0] }, mirror: x }
outputs: { x: left.ball.x, image: right.ball.x, y: left.ball.y, its: right.ball.y, force: left.slope.force }
simulation: { duration: 0.8, step: 1e-4, output_step: 0.01 }
";
    let bounds = nominal(&read(text));
    let apart = |a: &str, b: &str, sign: f64| {
        largest(curve(&bounds, a).iter().zip(curve(&bounds, b)).map(|(a, b)| a - sign * b))
    };
    let errors = [apart("x", "image", -1.0), apart("y", "its", 1.0)];
    assert!(largest(errors) < 1e-9, "{errors:?}");
    assert!(curve(&bounds, "force").iter().any(|force| *force > 1.0));
}

#[test]
#[ignore = "4 s"]
fn the_guide_shows_its_example() {
    let text = include_str!("../../docs/examples/contact.yaml");
    assert!(include_str!("../../docs/guides/contact.md").contains(text), "the page shows the example");
    let bounds = run(&read(text));
    let band = band(output(&bounds, "spin"), Method::Chebyshev);
    let rolling = row(&bounds, 0.22);
    let ends = [0.98, 1.02].map(|share| share * 5.0 / 7.0 * 0.9 / 0.05);
    let off = largest([band.lower[rolling] - ends[0], band.upper[rolling] - ends[1]]);
    assert!(off < 5e-3, "{off:e}");
}
