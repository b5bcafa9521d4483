//! Contacts that become too deep, and surfaces that pass through one another within a step: the run reports it, and
//! flags the following rows.

use mbint::results::{Bounds, Method, Summary};

use crate::common::{band, output, read, run_methods};

/// A ball of 1 kg and radius 5 mm that flies at `speed` along x from 0.1 m before the origin towards a surface there.
fn flight(surface: &str, stiffness: &str, speed: f64, simulation: &str) -> (Bounds, Summary) {
    run_methods(
        &read(&format!(
            "
space: spatial
bodies: {{ ball: {{ mass: 1, inertia: [1e-3, 1e-3, 1e-3] }} }}
effects: {{ it: {{ contact: {{ between: [ground, ball], {surface}, radius: 5 mm, impact: {{ stiffness: {stiffness}, exponent: 1 }} }} }} }}
initial: {{ ball.x: -0.1, ball.vx: {speed} }}
outputs: {{ x: ball.x }}
simulation: {{ duration: 0.2, output_step: 0.01, {simulation} }}
"
        )),
        None,
    )
}

fn first_flagged(bounds: &Bounds) -> Option<f64> {
    let x = band(output(bounds, "x"), Method::Chebyshev);
    x.error.unresolved.iter().position(|&flagged| flagged).map(|row| bounds.times[row])
}

/// At 2 m/s a ball of 1 kg goes v/√K = 20 mm into a spring of 10 kN/m, which is more than a capsule's 10 mm and its own
/// 5 mm, and less than the radii of two balls.
#[test]
fn a_contact_that_is_too_soft_is_too_deep() {
    let capsule = "capsule: [[0, -0.1, 0], [0, 0.1, 0]], rounding: 10 mm";
    let (bounds, summary) = flight(capsule, "1e4", 2.0, "step: 1e-4");
    let found = summary.too_deep.unwrap();
    assert_eq!(found.contact, "it");
    assert!((found.deepest - 0.015).abs() < 1e-12 && (0.0147..0.0151).contains(&found.depth.unwrap()), "{found:?}");
    // x = 15 mm sin(ωt) of the 20 mm, 42.5 ms after the start.
    let touched = 0.085 / 2.0 + (0.75_f64 * 0.98).asin() / 100.0;
    assert!((found.time - touched).abs() < 2e-4, "{found:?}");
    assert_eq!(first_flagged(&bounds), Some(0.06));
    for (surface, stiffness) in [(capsule, "1e5"), ("circle: 30 mm", "1e4"), ("plane: [-1, 0, 0]", "1e4")] {
        let (bounds, summary) = flight(surface, stiffness, 2.0, "step: 1e-4");
        assert_eq!((summary.too_deep, first_flagged(&bounds)), (None, None), "{surface}");
    }
}

/// A ball at 20 m/s that meets a capsule of 10 mm by steps of 10 ms, hits it by shorter ones and by those of a
/// tolerance, and flies past another one.
#[test]
fn missed_penetration_within_a_step_is_reported() {
    let wall = "capsule: [[0, -0.1, 0], [0, 0.1, 0]], rounding: 5 mm";
    let (bounds, summary) = flight(wall, "1e8", 20.0, "step: 0.01");
    let found = summary.too_deep.unwrap();
    assert!(found.depth.is_none() && (found.time - 0.01).abs() < 1e-12, "{found:?}");
    assert_eq!(first_flagged(&bounds), Some(0.01));
    for simulation in ["step: 1e-5", "tolerance: 1e-3"] {
        let (bounds, summary) = flight(wall, "1e8", 20.0, simulation);
        let x = band(output(&bounds, "x"), Method::Chebyshev);
        assert_eq!(summary.too_deep, None, "{simulation}");
        assert!(x.upper.iter().all(|&x| x < 0.0), "{simulation}");
    }
    let past = "capsule: [[-0.01, -0.1, 0.02], [-0.01, 0.1, 0.02]], rounding: 5 mm";
    let (bounds, summary) = flight(past, "1e8", 20.0, "step: 0.01");
    assert_eq!((summary.too_deep, first_flagged(&bounds)), (None, None));
}

/// A ball of 1 kg and radius 5 mm over a floor of 10 kN/m: 4 mm within it, 40 N push it up and 9.81 N down; at
/// 0.981 mm both balance, and 1 mm within they nearly do.
#[test]
fn unbalanced_overlap_at_the_start_is_reported() {
    let start = |initial: &str, weight: f64| {
        let (_, summary) = run_methods(
            &read(&format!(
                "
bodies: {{ ball: {{ mass: 1, inertia: 1e-3 }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, {weight}] }} }}
  floor: {{ contact: {{ between: [ground, ball], plane: y, radius: 5 mm, impact: {{ stiffness: 1e4, exponent: 1 }} }} }}
initial: {initial}
outputs: {{ y: ball.y }}
simulation: {{ duration: 0.02, output_step: 0.01, step: 1e-4 }}
"
            )),
            None,
        );
        summary.overlaps_at_start
    };
    let found = start("{ ball.y: 1 mm }", -9.81);
    assert_eq!(found.len(), 1);
    assert!(found[0].contact == "floor" && (found[0].depth - 4e-3).abs() < 1e-12, "{found:?}");
    for balanced in ["{ ball.y: 4 mm }", "{ ball.y: 4.019 mm }", "{ ball.y: 6 mm }"] {
        assert_eq!(start(balanced, -9.81), [], "{balanced}");
    }
    // Surfaces that touch to rounding, and are parted by another force.
    assert_eq!(start("{ ball.y: 5 mm - 1e-18 }", 9.81), []);
    assert_eq!(start("{ ball.y: 5 mm - 1e-9 }", 9.81).len(), 1);
}
