//! One notation of tolerances, wherever a number may have one: in one piece, in the long form, of a robot's number, on
//! the command line.

use mbint::Model;

/// Text of a tolerance, and the interval about 0.5 that it stands for.
const WHOLE: [(&str, [f64; 2]); 9] = [
    ("0.5 kg ± 1%", [0.495, 0.505]),
    ("0.5 kg +/- 1%", [0.495, 0.505]),
    ("0.5 kg +- 5 g", [0.495, 0.505]),
    ("500 g ± 5 g", [0.495, 0.505]),
    ("(500 ± 5) g", [0.495, 0.505]),
    ("0.5 kg +0.01 -0.02", [0.48, 0.51]),
    ("500 g +10 -20", [0.48, 0.51]),
    ("[0.49, 0.51] kg", [0.49, 0.51]),
    ("[490 g, 0.51 kg]", [0.49, 0.51]),
];

/// The deviation alone.
const ALONE: [(&str, [f64; 2]); 5] = [
    ("±1%", [0.495, 0.505]),
    ("± 1%", [0.495, 0.505]),
    ("1%", [0.495, 0.505]),
    ("± 5 g", [0.495, 0.505]),
    ("+10 g -20 g", [0.48, 0.51]),
];

const ROBOT: &str = r#"<robot name="arm">
  <link name="base"/>
  <joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 0 1"/></joint>
  <link name="rod"><inertial><mass value="0.5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>"#;

/// The interval of a parameter.
fn interval(model: &Model, name: &str) -> [f64; 2] {
    model.uncertain().find(|(known, _)| *known == name).unwrap_or_else(|| panic!("{name} is certain")).1
}

fn rod(parameter: &str) -> Model {
    let text = format!(
        "model: rod
parameters: {{ m: {parameter} }}
bodies: {{ rod: {{ mass: m, inertia: 1 }} }}
joints: {{ hinge: {{ revolute: [ground, rod] }} }}
outputs: {{ angle: rod.angle }}
simulation: {{ duration: 0.1, step: 1e-3 }}
bounds: {{ chebyshev: {{ order: 2 }} }}
"
    );
    Model::from_yaml_str("test.yaml", &text).unwrap_or_else(|error| panic!("{parameter}: {error}"))
}

#[track_caller]
fn assert_near(found: [f64; 2], expected: [f64; 2], form: &str) {
    let fine = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12);
    assert!(fine, "{form}: {found:?} instead of {expected:?}");
}

#[test]
fn parameters_accept_every_notation() {
    for (form, expected) in WHOLE {
        for place in [format!("\"{form}\""), format!("{{ value: \"{form}\" }}")] {
            assert_near(interval(&rod(&place), "m"), expected, &place);
        }
    }
    for (form, expected) in ALONE {
        let place = format!("{{ value: 0.5 kg, tolerance: {form} }}");
        assert_near(interval(&rod(&place), "m"), expected, &place);
    }
    // Numbers are in the unit of the key if it has one.
    let place = "{ value: 500, unit: g, tolerance: +10 -20 }";
    assert_near(interval(&rod(place), "m"), [0.48, 0.51], place);
}

#[test]
fn command_line_accepts_every_notation() {
    for (form, expected) in WHOLE.into_iter().chain(ALONE) {
        // A whole number replaces the number in the file, a deviation alone is of the file's value.
        let file = if WHOLE.contains(&(form, expected)) { "3 kg" } else { "0.5 kg" };
        let model = rod(file).with("m", form).unwrap_or_else(|error| panic!("{form}: {error}"));
        assert_near(interval(&model, "m"), expected, form);
    }
}

#[test]
fn numbers_of_a_robot_accept_every_notation() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.urdf"), ROBOT).unwrap();
    for (form, expected) in WHOLE.into_iter().chain(ALONE) {
        for place in [format!("\"{form}\""), format!("{{ tolerance: \"{form}\" }}")] {
            if place.starts_with('{') && WHOLE.contains(&(form, expected)) {
                continue;
            }
            let text = format!(
                "model: arm
urdf: arm.urdf
parameters: {{ link.rod.mass: {place} }}
outputs: {{ angle: hinge.angle }}
simulation: {{ duration: 0.1, step: 1e-3 }}
bounds: {{ chebyshev: {{ order: 2 }} }}
"
            );
            let path = folder.path().join("arm.yaml");
            std::fs::write(&path, text).unwrap();
            let description = Model::from_file(&path).unwrap_or_else(|error| panic!("{place}: {error}"));
            assert_near(interval(&description, "link.rod.mass"), expected, &place);
        }
    }
}
