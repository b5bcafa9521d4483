//! Points on planes.

use crate::common::power::{assert_balance, spatial_pair};
use crate::common::{read, run};

/// The orientation depends on h, which is uncertain, and the Euler parameters' rates on both; ω is preserved.
#[test]
fn assembly_of_the_orientation_keeps_angular_velocity() {
    let description = read(
        "
parameters: { h: { value: 0.5, unit: m, tolerance: 10% } }
bodies:
  ground: { points: { floor: [0, 0, -h] } }
  a: { mass: 1, inertia: [0.1, 0.2, 0.3], points: { foot: [0, 0, 0], tip: [1, 0, 0] } }
joints:
  ball: { spherical: [ground, a.foot] }
  floor: { point_on_plane: [ground.floor, a.tip] }
effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }
initial: { a.omega: [0, 0, 2] }
outputs: { spin: a.omega.z, across: a.omega.x, height: a.tip.z }
simulation: { duration: 0.5, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 6 }, taylor: { order: 4 }, scan: { points: 9 } }
",
    );
    let bounds = run(&description);
    for (output, wanted) in bounds.outputs[..2].iter().zip([2.0, 0.0]) {
        for band in &output.bands {
            let off = (band.lower[0] - wanted).abs().max((band.upper[0] - wanted).abs());
            // A surrogate may be off by its error.
            assert!(off < band.error.total[0].max(1e-12), "{} {:?}: {off:e}", output.name, band.method);
        }
    }
    let height = &bounds.outputs[2].bands[0];
    assert!((height.lower[5] + 0.55).abs() < 1e-9 && (height.upper[5] + 0.45).abs() < 1e-9, "{height:?}");
}

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &spatial_pair(
            "  j: { point_on_plane: { between: [a.P, b.P], normal: [1, 2, -0.5] } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  b.orientation: { rpy: [-0.3, 0.1, 0.5] }\n  b.omega: [-0.2, 0.5, 1.3]\n  b.x: 0.9\n  b.vx: 0.3\n  b.y: 0.5\n  b.vy: 0.8",
        ),
        "0",
    );
}
