//! Numbers that are no finite numbers: in a model's file, at the start, in a run.

use std::fs;

use crate::place::Place;

fn rod(tolerance: &str, torque: &str) -> String {
    format!(
        "parameters: {{ length: {{ value: 0.6, unit: m, tolerance: {tolerance} }}, tau: {{ value: 1, unit: s }} }}\n\
         bodies: {{ rod: {{ mass: 1.4, inertia: 0.05, points: {{ pivot: [-length/2, 0] }} }} }}\n\
         joints: {{ hinge: {{ revolute: [ground, rod.pivot] }} }}\n\
         effects: {{ e: {{ torque: {{ on: rod, value: {torque} }} }} }}\n\
         initial: {{ rod.angle: 0, rod.angular_velocity: 0 }}\noutputs: {{ h: rod.y }}\n\
         simulation: {{ duration: 0.03, step: 1e-3 }}\nbounds: {{ scan: {{ points: 2 }} }}\n"
    )
}

#[test]
fn limits_of_a_parameter_are_finite() {
    let place = Place::new();
    for tolerance in ["1e400%", "1e308", "1e309 m"] {
        fs::write(place.path().join("rod.yaml"), rod(tolerance, "0")).unwrap();
        let (_, errors) = place.run("check rod.yaml", 2);
        assert!(errors.contains("finite"), "{tolerance}: {errors}");
    }
}

#[test]
fn non_finite_term_is_reported_with_its_time() {
    let place = Place::new();
    for (torque, term) in [("1/t", "`1/t`"), ("3 + 2*log(t/tau)", "`log(t)`")] {
        fs::write(place.path().join("rod.yaml"), rod("2%", torque)).unwrap();
        for command in ["check rod.yaml", "run rod.yaml -o out"] {
            let done = place.command(command).output().unwrap();
            let errors = String::from_utf8(done.stderr).unwrap();
            assert_ne!(done.status.code(), Some(0), "{errors}");
            assert!(errors.contains(term) && errors.contains("t = 0 s") && errors.contains("motion of"), "{errors}");
        }
    }
    fs::write(place.path().join("rod.yaml"), rod("2%", "log(0.0145 - t/tau)")).unwrap();
    let (_, errors) = place.run("run -q rod.yaml -o out", 1);
    assert!(errors.contains("`log(0.0145 - t)`") && errors.contains("t = 0.015 s"), "{errors}");
    let table = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
    assert!(table.lines().count() > 10, "what was reached is kept: {table}");
}
