//! Motions that follow from motors, against closed forms.

use mbint::results::{Method, Verdict};

use crate::common::{nominal, ran, read, refused, run, study_of};
use crate::statics::{close, example};

/// Position, velocity and acceleration of a slider crank's slider at the crank's angle θ = ω t.
fn slider(r: f64, l: f64, omega: f64, time: f64) -> [f64; 3] {
    let theta = omega * time;
    let root = (l * l - (r * theta.sin()).powi(2)).sqrt();
    let x = r * theta.cos() + root;
    let slope = -r * r * theta.sin() * theta.cos() / root;
    let v = omega * (-r * theta.sin() + slope);
    let second = -r * r * (2.0 * theta).cos() / root - slope * slope / root;
    [x, v, omega * omega * (-r * theta.cos() + second)]
}

#[test]
fn motion_and_bounds_of_a_slider_crank_match_trigonometry() {
    let bounds = run(&example("kinematics.yaml"));
    for (row, &time) in bounds.times.iter().enumerate() {
        let wanted = slider(0.1, 0.3, 10.0, time);
        for (output, wanted) in bounds.outputs.iter().zip(wanted) {
            assert!((output.nominal[row] - wanted).abs() < 1e-9 * (1.0 + wanted.abs()), "{} {time}", output.name);
        }
        for (r, l) in [(0.099, 0.2985), (0.099, 0.3015), (0.101, 0.2985), (0.101, 0.3015), (0.1003, 0.3002)] {
            for (output, value) in bounds.outputs.iter().zip(slider(r, l, 10.0, time)) {
                for band in output.bands.iter().filter(|band| band.method != Method::Scan) {
                    let error = band.error.total[row] + 1e-10 * (1.0 + value.abs());
                    let is_inside = band.lower[row] - error <= value && value <= band.upper[row] + error;
                    assert!(is_inside, "{} {:?} at {time}: {value}", output.name, band.method);
                    assert!(error < 1e-3, "{} {:?} at {time}: {error}", output.name, band.method);
                }
            }
        }
    }
    let page = include_str!("../../docs/guides/kinematics.md");
    assert!(page.contains(include_str!("../../docs/examples/kinematics.yaml")), "the page shows the example");
}

#[test]
fn rows_far_apart_stay_on_their_branch() {
    let text = include_str!("../../docs/examples/kinematics.yaml").replace("output_step: 0.01", "output_step: 0.21");
    let bounds = nominal(&read(&text));
    for (row, &time) in bounds.times.iter().enumerate() {
        close(bounds.outputs[0].nominal[row], slider(0.1, 0.3, 10.0, time)[0], 1e-10);
    }
}

#[test]
fn coordinates_not_driven_by_motors_are_named() {
    let text = "
analysis: kinematics
bodies: { rod: { points: { O: [-0.5, 0] } } }
joints: { hinge: { revolute: [ground, rod.O] } }
outputs: { angle: rod.angle }
simulation: { duration: 1 }
";
    let message = refused(text);
    assert!(message.contains("`rod.angle`") || message.contains("`hinge.angle`"), "{message}");
    assert!(message.contains("motor"), "{message}");
}

#[test]
fn locking_is_reported_with_its_time() {
    // The rod is shorter than the crank: it is taut where r sin θ = l.
    let text = include_str!("../../docs/examples/kinematics.yaml").replace("value: 0.3,", "value: 0.08,");
    let (bounds, summary) = ran(study_of(&text).nominal());
    let locks = f64::asin(0.8) / 10.0;
    assert!(summary.failure.unwrap().contains("locks"));
    let last = *bounds.times.last().unwrap();
    assert!((locks - 0.011..=locks).contains(&last), "{last} {locks}");
}

#[test]
fn reduced_outputs_are_bounded_between_coarse_rows() {
    // A row every 0.2 rad: the greatest speed lies between rows.
    let text = include_str!("../../docs/examples/kinematics.yaml").replace("output_step: 0.01", "output_step: 0.02");
    let text = text.replace(
        "a: slider.ax }",
        "a: slider.ax, stroke: { range: x }, fastest: { max: v }, top: { time_of_max: v } }",
    );
    let text =
        format!("{text}requirements: {{ slow: v <= 1.1 m/s, near: {{ output: x, max: 0.401 m, from: 0.1 }} }}\n");
    let (_, summary) = ran(study_of(&text));
    let fine = |r: f64, l: f64| -> f64 {
        (0..=63_000).map(|place| slider(r, l, 10.0, 1e-5 * f64::from(place))[1]).fold(0.0, f64::max)
    };
    // The shortest rod and the longest crank are the fastest.
    let (least, most) = (fine(0.099, 0.3015), fine(0.101, 0.2985));
    let ends = |name: &str| {
        let own = summary.reduced.iter().find(|own| own.name == name).unwrap();
        let band = own.bands.iter().find(|band| band.method == "chebyshev").unwrap();
        assert!(!band.unresolved, "{name}");
        [band.lower, band.upper, band.error]
    };
    for (name, lower, upper, small) in [("stroke", 0.198, 0.202, 1e-4), ("fastest", least, most, 1e-3)] {
        let [found_lower, found_upper, error] = ends(name);
        assert!((found_lower - lower).abs() <= error + 1e-9, "{name}: {found_lower} {lower} {error}");
        assert!((found_upper - upper).abs() <= error + 1e-9, "{name}: {found_upper} {upper} {error}");
        assert!(error < small, "{name}: {error}");
    }
    let [slow, near] = &summary.requirements[..] else { panic!() };
    assert_eq!((slow.verdict, near.verdict), (Verdict::Holds, Verdict::Violated));
    assert!((slow.margin - (1.1 - most)).abs() <= slow.error + 1e-9, "{} {}", slow.margin, slow.error);
    // From 0.1 s on x is greatest where the crank is stretched again, at the end of the turn.
    let nearest = near.nearest.as_ref().unwrap();
    let end = slider(0.101, 0.3015, 10.0, 0.2 * std::f64::consts::PI)[0];
    assert!((nearest.margin - (0.401 - end)).abs() < 2e-5, "{} {end}", nearest.margin);
}

/// A crank of 0.1 m and a rod, whose slider passes near the crank's pivot.
fn near_a_change_point(rod: &str, bounds: &str) -> String {
    format!(
        "
analysis: kinematics
parameters: {{ rod: {{ {rod}, unit: m }} }}
bodies:
  crank: {{ points: {{ A: [0, 0], B: [0.1, 0] }} }}
  rod: {{ points: {{ B: [0, 0], C: [rod, 0] }} }}
  slider: {{ coordinates: [x] }}
joints:
  pivot: {{ revolute: [ground, crank.A] }}
  pin: {{ revolute: [crank.B, rod.B] }}
  wrist: {{ revolute: [rod.C, slider] }}
  drive: {{ motor: {{ on: pivot, position: 4*t }} }}
guess: {{ slider.x: 0.2 }}
outputs: {{ x: slider.x }}
simulation: {{ duration: 1.5, output_step: 0.05 }}
{bounds}
"
    )
}

#[test]
fn neighbouring_branches_are_not_confused() {
    for rod in [0.100_02, 0.101, 0.1001] {
        let bounds = nominal(&read(&near_a_change_point(&format!("value: {rod}"), "")));
        assert_eq!(bounds.times.len(), 31);
        for (row, &time) in bounds.times.iter().enumerate() {
            close(bounds.outputs[0].nominal[row], slider(0.1, rod, 4.0, time)[0], 1e-9);
        }
    }
}

#[test]
fn locked_samples_do_not_continue_on_another_branch() {
    // Rods shorter than the crank lock before the slider reaches the pivot: the remaining samples stay where x ≥ 0.
    let text =
        near_a_change_point("interval: [0.093, 0.12]", "bounds: { chebyshev: { order: 6 }, scan: { points: 19 } }");
    let (bounds, _) = ran(study_of(&text).skip_infeasible());
    let mut rows = 0;
    for (row, &time) in bounds.times.iter().enumerate() {
        for band in &bounds.outputs[0].bands {
            let (lower, error) = (band.lower[row], band.error.total[row]);
            if band.error.unresolved[row] || lower.is_nan() {
                continue;
            }
            assert!(lower + error >= -1e-9, "{:?} at {time}: {lower} ± {error}", band.method);
            rows += 1;
        }
    }
    assert!(rows > 30, "{rows}");
}

#[test]
fn parallelogram_passes_and_reports_its_change_points() {
    let text = "
analysis: kinematics
bodies:
  ground: { points: { left: [0, 0], right: [0.3, 0] } }
  a: { points: { A: [0, 0], B: [0.1, 0] } }
  b: { points: { B: [0, 0], C: [0.3, 0] } }
  c: { points: { D: [0, 0], C: [0.1, 0] } }
joints:
  pivot: { revolute: [ground.left, a.A] }
  first: { revolute: [a.B, b.B] }
  second: { revolute: [b.C, c.C] }
  other: { revolute: [ground.right, c.D] }
  drive: { motor: { on: pivot, position: 0.5 + 2*t } }
guess: { c.angle: 0.5 }
outputs: { turned: c.angle - a.angle, y: c.C.y }
simulation: { duration: 4, output_step: 0.1 }
";
    let (bounds, summary) = ran(study_of(text).nominal());
    assert!(summary.failure.is_none(), "{:?}", summary.failure);
    for (row, &time) in bounds.times.iter().enumerate() {
        assert!(bounds.outputs[0].nominal[row].abs() < 1e-7, "{time}: {}", bounds.outputs[0].nominal[row]);
    }
    // Where the cranks lie along the coupler: 0.5 + 2 t = π and 2π.
    let times: Vec<f64> = summary.singular_configurations.iter().map(|pass| pass.time).collect();
    assert_eq!(times.len(), 2, "{times:?}");
    for (time, turns) in times.iter().zip([1.0, 2.0]) {
        assert!((time - 0.5 * (turns * std::f64::consts::PI - 0.5)).abs() < 1e-4, "{times:?}");
    }
}
