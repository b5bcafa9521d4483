//! Friction that is another along a direction.

use crate::common::{curve, largest, nominal, read};
use mbint::results::Bounds;

/// A block on three feet that slides on a plane, pushed by nothing.
fn sliding(friction: &str, surface: &str) -> Bounds {
    nominal(&read(&format!(
        "
space: spatial
bodies: {{ ground: {{ points: {{ floor: {{ position: [0, 0, 0], rotation: {{ axis: [0, 0, 1], angle: 30 deg }} }} }} }}, puck: {{ mass: 2, inertia: [0.01, 0.01, 0.02] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}
  floor: {{ contact: {{ between: [ground.floor, puck], {surface}, impact: {{ stiffness: 1e5, exponent: 1, dissipation: 50 }}, {friction} }} }}
initial: {{ puck.x: 0, puck.y: 0, puck.z: {}, puck.vx: 1.2, puck.vy: 0.9, puck.vz: 0 }}
outputs: {{ vx: puck.vx, vy: puck.vy, energy: kinetic_energy }}
simulation: {{ duration: 0.25, step: 1e-4, output_step: 0.01 }}
",
        -2.0 * 9.81 / 1e5
    )))
}

const FRICTION: &str = "friction: { coefficient: 0.6, transition_velocity: 1e-3 }";

/// A sliding point has dv₁/dt : dv₂/dt = μ₁ v₁ : μ₂ v₂ along the axes, so that v₂/v₂₀ = (v₁/v₁₀)^(μ₂/μ₁) wherever it
/// goes.
#[test]
fn a_puck_turns_towards_the_smooth_direction() {
    let friction = format!("{FRICTION}, friction_along: {{ direction: x, coefficient: 0.2 }}");
    let bounds = sliding(&friction, "plane: z");
    let (sin, cos) = 30.0_f64.to_radians().sin_cos();
    let velocities: Vec<[f64; 2]> = curve(&bounds, "vx")
        .iter()
        .zip(curve(&bounds, "vy"))
        .map(|(x, y)| [cos * x + sin * y, cos * y - sin * x])
        .collect();
    let [first, last] = [velocities[0], velocities[velocities.len() - 1]];
    assert!(last[0] < 0.7 * first[0] && last[1] < 0.4 * first[1], "{first:?} {last:?}");
    let off = largest(velocities.iter().map(|v| v[1] / first[1] - (v[0] / first[0]).powi(3)));
    assert!(off < 1e-6, "{off:e}");
}

/// With the same coefficient along both axes the friction is isotropic; an axis off the plane counts by its projection
/// onto the plane.
#[test]
fn equal_coefficients_give_isotropic_friction() {
    let plain = sliding(FRICTION, "plane: z");
    for along in [
        "friction_along: { direction: [1, 2, 0], coefficient: 0.6 }",
        "friction_along: { direction: z, coefficient: 0.1 }",
    ] {
        let same = sliding(&format!("{FRICTION}, {along}"), "plane: z");
        for name in ["vx", "vy"] {
            let off = largest(curve(&plain, name).iter().zip(curve(&same, name)).map(|(a, b)| a - b));
            assert!(off < 1e-10, "{along} {name}: {off:e}");
        }
    }
}

/// In an image the direction is mirrored, too.
#[test]
fn mirrored_instance_slides_symmetrically() {
    let text = "
space: spatial
assemblies:
  table:
    bodies: { foot: { mass: 1, inertia: [1, 1, 1] }, puck: { mass: 2, inertia: [0.01, 0.01, 0.02] } }
    joints: { base: { fixed: [ground, foot] } }
    effects:
      floor: { contact: { between: [foot, puck], plane: z, impact: { stiffness: 1e5, exponent: 1, dissipation: 50 }, friction: { coefficient: 0.6 }, friction_along: { direction: [1, 0.4, 0], coefficient: 0.1 } } }
    initial: { puck.x: 0, puck.y: 0, puck.z: 0, puck.vx: 1.2, puck.vy: 0.5, puck.vz: 0 }
instances: { one: { of: table }, two: { of: table, mirror: x } }
effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }
outputs: { x: one.puck.x, y: one.puck.y, a: two.puck.x, b: two.puck.y }
simulation: { duration: 0.2, step: 1e-4, output_step: 0.02 }
";
    let bounds = nominal(&read(text));
    for (name, image, sign) in [("x", "a", -1.0), ("y", "b", 1.0)] {
        let off = largest(curve(&bounds, name).iter().zip(curve(&bounds, image)).map(|(a, b)| a - sign * b));
        assert!(off < 1e-9, "{name}: {off:e}");
    }
}
