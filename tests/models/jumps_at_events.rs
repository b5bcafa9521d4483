//! Forces that jump at events: steps that end there see one side only. Truths are closed forms.

use mbint::results::Method;

use crate::common::{band, largest, output, ran, study_of};

/// A mass on a track, whose force is constant between two positions; its energy is known at each.
fn track(speed: &str, request: &str) -> String {
    let force = "if(b.x > 0.9, 0.5, if(b.x > 0.4, -0.7, 0.3))";
    let work = "if(b.x > 0.9, -0.23 + 0.5*(b.x - 0.9), if(b.x > 0.4, 0.12 - 0.7*(b.x - 0.4), 0.3*b.x))";
    format!(
        "
parameters: {{ v0: {speed} }}
bodies: {{ b: {{ mass: 1, coordinates: [x] }} }}
effects: {{ f: {{ force: {{ on: b, value: [\"{force}\", 0] }} }} }}
initial: {{ b.x: 0, b.vx: v0 }}
outputs: {{ v: b.vx, lost: \"(b.vx^2 - v0^2)/2 - ({work})\" }}
simulation: {{ duration: 2, tolerance: 1e-6, output_step: 0.01 }}
{request}
"
    )
}

#[test]
fn force_jumps_lose_no_energy() {
    let (bounds, summary) = ran(study_of(&track("1", "")));
    assert!(summary.integration.is_some_and(|name| name.contains("between events")));
    let lost = largest(output(&bounds, "lost").nominal.iter().copied());
    assert!(lost < 1e-13, "{lost:e}");
}

/// Constant forces are integrated exactly: steps err by rounding alone, also in rows next to the events.
#[test]
fn step_errors_at_force_jumps_are_rounding() {
    let (bounds, summary) = ran(study_of(&track("1 ± 5%", "bounds: { chebyshev: { order: 6 } }")));
    assert!(summary.integration.is_some_and(|name| name.contains("between events")));
    for own in &bounds.outputs {
        let time = band(own, Method::Chebyshev).error.time;
        assert!(time < 1e-11, "{}: {time:e}", own.name);
    }
}
