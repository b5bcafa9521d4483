//! Errors of this program itself: they cost one method of one model.

use std::sync::atomic::{AtomicBool, Ordering};

use mbint::Model;
use mbint::results::Method;

use crate::place::Place;

const TWO_PENDULUMS: &str = "
parameters: { a: { value: 0.4, unit: m, tolerance: 2% }, b: { value: 0.7, unit: m, tolerance: 2% } }
bodies:
  left: { mass: 1, inertia: 0.02, points: { pin: [-a, 0] } }
  right: { mass: 2, inertia: 0.05, points: { pin: [-b, 0] } }
joints: { p: { revolute: [ground, left.pin] }, q: { revolute: [ground, right.pin] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
outputs: { l: left.angle, r: right.angle }
simulation: { duration: 0.05, step: 1e-3 }
bounds: { chebyshev: { order: 2 }, taylor: { order: 2 }, scan: { points: 4 } }
";

/// A run whose progress callback panics once, at the first report beyond a fraction.
fn with_one_panic(text: &str, beyond: f64) -> (mbint::results::Bounds, mbint::results::Summary) {
    let model = Model::from_yaml_str("test", text).unwrap_or_else(|error| panic!("{error}"));
    let panicked = AtomicBool::new(false);
    let progress = |fraction: f64| {
        if fraction > beyond && !panicked.swap(true, Ordering::SeqCst) {
            panic!("on purpose");
        }
    };
    let result = model.study().threads(2).progress(&progress).run().unwrap_or_else(|error| panic!("{error}"));
    (result.bounds().clone(), result.summary().clone())
}

#[test]
fn a_panic_costs_one_method() {
    let one = TWO_PENDULUMS.replace(", r: right.angle", "");
    let mut lost = 0;
    for beyond in [0.6, 0.9, 0.97] {
        let (bounds, summary) = with_one_panic(&one, beyond);
        let failure = summary.failure.expect("it panicked");
        assert!(failure.starts_with("internal error in ") && failure.contains("on purpose"), "{failure}");
        assert!(failure.contains("please report it"), "{failure}");
        let bands = &bounds.outputs[0].bands;
        let known = |method: Method| {
            bands.iter().find(|band| band.method == method).unwrap().lower.iter().all(|value| value.is_finite())
        };
        let found: Vec<Method> = bands.iter().map(|band| band.method).filter(|&method| known(method)).collect();
        assert_eq!((bands.len(), found.len()), (3, 2), "beyond {beyond}: {found:?}, {failure}");
        assert_eq!(bounds.times.len(), 51);
        lost += 1;
    }
    assert_eq!(lost, 3);
}

#[test]
fn a_panic_before_the_methods_costs_one_subsystem_of_them() {
    // The first subsystem's validation samples.
    let (bounds, summary) = with_one_panic(TWO_PENDULUMS, 0.0);
    let failure = summary.failure.expect("it panicked");
    assert!(failure.contains("internal error"), "{failure}");
    let bands: Vec<usize> = bounds.outputs.iter().map(|output| output.bands.len()).collect();
    assert_eq!(bands, [0, 3], "{failure}");
    assert!(bounds.outputs.iter().all(|output| output.nominal.iter().all(|value| value.is_finite())));
}

/// A crank whose rod is a beam, in steps that are much too long: its loop opens in the run. The start's conditions of
/// the beam are no constraints then.
#[test]
#[ignore = "2 s"]
fn constraint_that_opens_next_to_a_beam_is_named() {
    let place = Place::new();
    for (speed, step) in [("3e5", "5e-5"), ("9e5", "2e-5"), ("220", "2e-3")] {
        let text = format!(
            "
parameters: {{ e: {{ value: 4e6, unit: N, tolerance: 3% }} }}
bodies:
  crank: {{ mass: 0.5, inertia: 9e-4, points: {{ A: [-0.08, 0], B: [0.08, 0] }} }}
  rod: {{ beam: {{ length: 0.35, mass_per_length: 0.3, axial_stiffness: e, bending_stiffness: 9, damping: 1e-5 s, elements: 3 }} }}
  slider: {{ mass: 0.1, coordinates: [x] }}
joints:
  pivot: {{ revolute: [ground, crank.A] }}
  pin: {{ revolute: [crank.B, rod.start] }}
  wrist: {{ revolute: [rod.end, slider] }}
  drive: {{ motor: {{ on: pivot, speed: {speed} }} }}
outputs: {{ x: slider.x, slope: rod.end.angle }}
simulation: {{ duration: 20*{step}, step: {step} }}
bounds: {{ chebyshev: {{ order: 1 }}, scan: {{ points: 2 }} }}
"
        );
        std::fs::write(place.path().join("crank.yaml"), text).unwrap();
        let done = place.command("run -q crank.yaml -o out").output().unwrap();
        let errors = String::from_utf8(done.stderr).unwrap();
        assert!(!errors.contains("panicked") && !errors.contains("internal error"), "{errors}");
        assert_eq!(done.status.code(), Some(1), "{errors}");
        assert!(errors.contains(" at t = "), "{errors}");
        if errors.contains("locks") {
            let named = ["`pivot", "`pin.", "`wrist.", "`drive"].iter().any(|name| errors.contains(name));
            assert!(named, "{errors}");
        }
        assert!(place.path().join("out/bounds.csv").exists());
    }
}
