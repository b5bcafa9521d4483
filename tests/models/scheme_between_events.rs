//! Motions between events by HHT-I3: where a model asks for the scheme, and where forces are stiff. Truths are closed
//! forms, a rigid limit, and the explicit method.

use mbint::results::{Method, Summary};

use crate::common::{band, distance, largest, output, ran, study_of};
use crate::through_events::{ELASTIC, assert_true, elastic, over_box};

/// The elastic ball with other steps.
fn elastic_ball(simulation: &str) -> String {
    ELASTIC.replace("step: 1e-3", simulation)
}

/// A ball with a bolt that is fastened stiffly: 22 000 oscillations in 1.4 s if they were not damped.
fn fastened(request: &str) -> String {
    format!(
        "
parameters: {{ h0: {{ value: 1, unit: m, tolerance: 2% }}, K: {{ value: 1e5, unit: N/m, tolerance: 5% }} }}
bodies: {{ ball: {{ mass: 1, coordinates: [y] }}, bolt: {{ mass: 0.01, coordinates: [y] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  ground: {{ force: {{ on: ball, value: [0, \"K*max(-ball.y, 0)\"] }} }}
  tight: {{ spring_damper: {{ between: [ball, bolt], stiffness: 1e8, damping: 300, free_length: 0.1 }} }}
initial: {{ ball.y: h0, ball.vy: 0, bolt.y: h0 + 0.1, bolt.vy: 0 }}
outputs: {{ y: ball.y, v: ball.vy }}
simulation: {{ duration: 1.4, step: 1e-4, output_step: 0.02 }}
{request}
"
    )
}

/// Whether motions were cut at events and integrated by the scheme.
fn is_by_scheme(summary: &Summary) -> bool {
    summary.integration.as_ref().is_some_and(|name| name.starts_with("HHT-I3") && name.contains("between events"))
}

#[test]
#[ignore = "3 s"]
fn requested_scheme_is_used_between_events() {
    for (simulation, stated) in [
        ("step: 1e-3, scheme: hht", 2e-2),
        ("tolerance: 1e-6, scheme: hht", 1e-5),
        ("step: 1e-2, extrapolation: 4", 1e-6),
    ] {
        let (bounds, summary) = ran(study_of(&elastic_ball(simulation)));
        assert!(is_by_scheme(&summary), "{:?}", summary.integration);
        for (line, name) in ["y", "v"].into_iter().enumerate() {
            assert_true(&bounds, name, stated, f64::INFINITY, |t| over_box(line, t));
        }
        let chebyshev = summary.methods.iter().find(|own| own.method == "chebyshev").unwrap();
        assert!(chebyshev.simulations == 16 && chebyshev.newton_iterations > chebyshev.steps as u64, "{chebyshev:?}");
    }
}

/// Halved steps have a quarter of the error.
#[test]
#[ignore = "7 s"]
fn the_scheme_is_of_second_order_through_events() {
    let error = |step: &str| {
        let (bounds, _) =
            ran(study_of(&elastic_ball(&format!("step: {step}, scheme: hht")).replace("duration: 2", "duration: 0.6")));
        let truth: Vec<f64> = bounds.times.iter().map(|&t| elastic(1.0, 1e5, t)[1]).collect();
        distance(&output(&bounds, "v").nominal, &truth)
    };
    let errors = ["4e-5", "2e-5", "1e-5"].map(error);
    for pair in errors.windows(2) {
        assert!((3.6..4.4).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

/// Bodies fastened by 1e8 N/m move as one body but for 1e-7 m: as the closed form's ball with 1.01 of its mass.
#[test]
fn a_stiff_body_bounces_as_a_rigid_one() {
    let request = "bounds: { chebyshev: { order: 4 }, taylor: { order: 4 } }";
    let (bounds, summary) = ran(study_of(&fastened(request)));
    assert!(is_by_scheme(&summary), "{:?}", summary.integration);
    let rigid = |height: f64, stiffness: f64, t: f64| elastic(height, stiffness / 1.01, t);
    for (method, stated) in [(Method::Chebyshev, 1e-6), (Method::Taylor, 1e-4)] {
        for line in 0..2 {
            let band = band(&bounds.outputs[line], method);
            assert!(!band.error.unresolved.contains(&true), "{method:?} of line {line} is flagged");
            assert!(largest(band.error.total.iter().copied()) < stated, "{:?}", band.error.total);
            let nominal: Vec<f64> = bounds.times.iter().map(|&t| rigid(1.0, 1e5, t)[line]).collect();
            let off = distance(&bounds.outputs[line].nominal, &nominal);
            assert!(off < 1e-4, "line {line}: {off:e}");
        }
    }
}

/// A door on a hinge in absolute coordinates, whose constraints the scheme holds, with a stop: as the explicit method
/// has it in the angle.
#[test]
#[ignore = "4 s"]
fn constraints_hold_through_events() {
    let door = |simulation: &str| {
        format!(
            "
parameters: {{ w0: {{ value: -2, unit: rad/s, tolerance: 3% }} }}
bodies: {{ door: {{ mass: 10, inertia: 2, points: {{ hinge: [-0.5, 0] }} }} }}
joints: {{ hinge: {{ revolute: [ground, door.hinge] }} }}
effects:
  buffer: {{ stop: {{ on: hinge, lower: 0, impact: {{ stiffness: 2e4, exponent: 1, dissipation: 0.2 }} }} }}
  closer: {{ torsional_spring_damper: {{ on: hinge, stiffness: 3, damping: 0.1 }} }}
initial: {{ hinge.angle: 0.5, hinge.angular_velocity: w0 }}
outputs: {{ angle: hinge.angle, speed: hinge.angular_velocity, x: door.x }}
simulation: {{ duration: 1, output_step: 0.02, {simulation} }}
bounds: {{ chebyshev: {{ order: 4 }} }}
"
        )
    };
    let (explicit, _) = ran(study_of(&door("tolerance: 1e-6, formulation: joint")));
    let (bounds, summary) = ran(study_of(&door("tolerance: 1e-6, extrapolation: 4, formulation: absolute")));
    assert!(is_by_scheme(&summary), "{:?}", summary.integration);
    for (own, other) in bounds.outputs.iter().zip(&explicit.outputs) {
        let (own, other) = (band(own, Method::Chebyshev), band(other, Method::Chebyshev));
        for row in 0..own.lower.len() {
            let allowed = own.error.total[row] + other.error.total[row] + 1e-12;
            assert!(allowed < 1e-5, "{allowed:e}");
            let off = (own.lower[row] - other.lower[row]).abs().max((own.upper[row] - other.upper[row]).abs());
            assert!(off <= allowed, "row {row}: {off:e}, {allowed:e} stated");
        }
    }
}
