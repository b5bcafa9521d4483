//! Prismatic joints: a slope, and MSC Adams.

use crate::common::adams::{Case, compared_with_adams};
use crate::common::closed_forms::{assert_exact, assert_exact_force};
use crate::common::power::{assert_balance, pair, spatial_pair};
use crate::common::{curve, nominal, read};

#[test]
fn a_body_slides_down_an_incline() {
    // x = ½ g sin β t² along the slope; the slope carries m g cos β.
    let bounds = nominal(&read(
        "
parameters: { slope: 30 deg, g: 9.81 }
bodies: { box: { mass: 4, inertia: 0.2 } }
joints:
  slide: { prismatic: { between: [ground, box], axis: [cos(slope), -sin(slope)] } }
effects: { weight: { gravity: { acceleration: [0, -g] } } }
initial: { box.x: 0, box.vx: 0 }
outputs:
  along: box.x*cos(slope) - box.y*sin(slope)
  off: box.x*sin(slope) + box.y*cos(slope)
  angle: box.angle
  up: slide.force.y
  across: slide.force.x
  torque: slide.torque
  axial: slide.axial
  radial: slide.radial
simulation: { duration: 1, step: 0.01, output_step: 0.1 }
",
    ));
    let beta = 30.0_f64.to_radians();
    let normal = 4.0 * 9.81 * beta.cos();
    assert_exact(&bounds, "along", |t| 0.5 * 9.81 * beta.sin() * t * t);
    assert_exact(&bounds, "off", |_| 0.0);
    assert_exact(&bounds, "angle", |_| 0.0);
    assert_exact_force(&bounds, "up", |_| normal * beta.cos());
    assert_exact_force(&bounds, "across", |_| normal * beta.sin());
    assert_exact_force(&bounds, "torque", |_| 0.0);
    assert_exact_force(&bounds, "axial", |_| 0.0);
    // The axis turned by +90° points up from the slope.
    assert_exact_force(&bounds, "radial", |_| normal);
}

const ADAMS: Case = Case {
    name: "prismatic_joint/Prismatic",
    velocities: "prismatic_joint/Prismatic",
    text: "bodies:
  a: { mass: 1, inertia: [0.04, 0.1, 0.1], points: { P: [-2, 0, 0] } }
joints: { j: { prismatic: { between: [ground, a.P], axis: z } } }
initial: { j.displacement: 0 }",
    at_one: [2.0, 0.0, -4.90332, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
};

compared_with_adams!(ADAMS);

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &pair(
            "  j: { prismatic: { between: [a.P, b.P], axis: [1, 2], angle: 0.3 } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  j.displacement: 0.3\n  j.velocity: -0.8",
        ),
        "0",
    );
    assert_balance(
        &spatial_pair(
            "  j: { prismatic: { between: [a.P, b.P], axis: [1, 2, -0.5], angle: 0.3 } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  j.displacement: 0.3\n  j.velocity: -0.8",
        ),
        "0",
    );
}

/// A named displacement is a coordinate without inertia: every placement of the joint starts in absolute coordinates,
/// and moves as in joint coordinates.
#[test]
fn a_named_displacement_starts_with_dampers_and_drag() {
    let acting = [
        "d: { spring_damper: { between: [ground.q, slider], stiffness: 7, damping: 0.4, free_length: 0.1 } }",
        "d: { drag: { on: slider.a, quadratic: 0.3 } }, g: { gravity: { acceleration: [1, 2, -3] } }",
    ];
    for (index, effect) in (0..6).flat_map(|index| acting.map(|effect| (index, effect))) {
        let [a, b, c] = std::array::from_fn(|axis| (1.3 * f64::from(index) + 2.1 * axis as f64).sin());
        let kind = if index % 2 == 0 { "prismatic" } else { "cylindrical" };
        let turning = if index % 2 == 0 { "" } else { ", slide.angle: 0.3" };
        let [absolute, joint] = ["absolute", "joint"].map(|formulation| {
            let bounds = nominal(&read(&format!(
                "
bodies:
  ground: {{ points: {{ p: {{ position: [{a}, 0.2, {b}], rotation: {{ rpy: [{b}, {c}, {a}] }} }}, q: [1, 0.5, 0.2] }} }}
  slider: {{ mass: 1.5, inertia: [0.1, 0.2, 0.15], points: {{ a: [{c}, -0.2, {a}] }} }}
joints: {{ slide: {{ {kind}: {{ between: [ground.p, slider.a], axis: x }} }} }}
effects: {{ {effect} }}
initial: {{ slide.displacement: 0.15, slide.velocity: -0.2{turning} }}
outputs: {{ x: slider.x, y: slider.y, z: slider.z, s: slide.displacement }}
simulation: {{ duration: 0.2, step: 1e-3, output_step: 0.02, formulation: {formulation} }}
"
            )));
            ["x", "y", "z", "s"].map(|name| curve(&bounds, name).to_vec())
        });
        for (found, expected) in absolute.iter().flatten().zip(joint.iter().flatten()) {
            // The steps' errors, (ωh)², differ with the coordinates where the body turns.
            assert!((found - expected).abs() < 1e-6, "{kind} {index}: {found}, not {expected}");
        }
    }
}
