//! From text to description.

use super::*;
use crate::elements::joints::*;
use crate::grammar::Direction;
use crate::methods::Degree;
use crate::syntax::diagnostic::Severity;
use symdiff::Formula;

const SLIDER_CRANK: &str = include_str!("../../../../models/slider_crank.yaml");

/// A body with everything, to be varied by replacing parts.
const BAR: &str = "\
parameters:
  l: { value: 0.2, unit: m, tolerance: 1% }
bodies:
  bar: { mass: 1, inertia: 0.01, points: { A: [-l/2, 0] } }
joints: {}
effects: {}
outputs: { angle: bar.angle }
simulation: { duration: 1 }
";

fn good(text: &str) -> Description {
    load_str("x.yaml", text, &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

fn interval(description: &Description, name: &str) -> [f64; 3] {
    let parameter = description.parameters.iter().find(|parameter| parameter.name == name).unwrap();
    match parameter.value {
        ParameterValue::Interval { nominal, lower, upper } => [nominal, lower, upper],
        ParameterValue::Formula(_) => panic!("`{name}` is deterministic"),
    }
}

fn close(found: [f64; 3], wanted: [f64; 3]) {
    assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= 1e-15), "{found:?} is not {wanted:?}");
}

#[test]
fn slider_crank_is_read_from_its_file() {
    let reading = read_str("models/slider_crank.yaml", SLIDER_CRANK, &[]);
    assert!(reading.diagnostics.is_empty(), "{}", reading.diagnostics);
    let model = reading.description.unwrap();
    assert_eq!(model.name, "slider_crank");
    let names: Vec<&str> = model.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    assert_eq!(names, ["l1", "l2", "m1", "m2", "m3", "c", "k", "tau"]);
    assert_eq!(model.parameters[5].unit, "N*s/m");
    close(interval(&model, "l1"), [0.15, 0.1485, 0.1515]);
    close(interval(&model, "tau"), [-0.5, -0.505, -0.495]);
    let names: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["ground", "crank", "rod", "slider"]);
    assert!(model.bodies[0].coordinates.is_empty());
    assert_eq!(model.bodies[1].coordinates, [Coordinate::X, Coordinate::Y, Coordinate::Angle]);
    assert_eq!(model.bodies[3].coordinates, [Coordinate::X]);
    let JointKind::Revolute(Revolute { between, .. }) = &model.joints[2].kind else { panic!("revolute") };
    assert_eq!(*between, [PointRef { body: 2, point: Some(1) }, PointRef { body: 3, point: None }]);
    let EffectKind::SpringDamper(SpringDamper { along: Some(Direction([x, y, _])), free_length, .. }) =
        &model.effects[1].kind
    else {
        panic!("a spring along x")
    };
    assert_eq!((x.as_number(), y.as_number()), (Some(1.0), Some(0.0)));
    assert_eq!(free_length.names().count(), 2);
    assert!(matches!(model.initial[1], StartValue::Coordinate { order: TimeOrder::Velocity, .. }));
    assert_eq!((model.outputs[0].name.as_str(), model.outputs[0].unit.as_str()), ("x3", "m"));
    assert_eq!(model.simulation.stepping, Stepping::Fixed(1e-3));
    assert_eq!(model.simulation.output_step, 0.01);
    assert_eq!(model.bounds.chebyshev.as_ref().unwrap().degree, Degree::Fixed { order: vec![5, 5], nodes: vec![6, 6] });
    assert_eq!(model.bounds.taylor.as_ref().unwrap().order, 2);
    assert_eq!(model.bounds.scan.as_ref().unwrap().points, [30, 30]);
}

#[test]
fn parameters_can_be_written_in_several_ways() {
    for (written, wanted) in [
        ("{ value: 200, unit: mm, tolerance: 1% }", [0.2, 0.198, 0.202]),
        ("{ value: 200, unit: mm, tolerance: 2 }", [0.2, 0.198, 0.202]),
        ("{ value: 200 mm, tolerance: 2 mm }", [0.2, 0.198, 0.202]),
        ("{ value: 0.2, unit: m, tolerance: 2 mm }", [0.2, 0.198, 0.202]),
        ("{ value: 0.2, tolerance: 0.002 }", [0.2, 0.198, 0.202]),
        ("{ interval: [0.198, 0.202] }", [0.2, 0.198, 0.202]),
        ("{ interval: [198 mm, 20.2 cm] }", [0.2, 0.198, 0.202]),
        ("{ value: 0.199, unit: m, interval: [0.198, 0.202] }", [0.199, 0.198, 0.202]),
        ("{ value: 0.2, plus: 0.01 }", [0.2, 0.2, 0.21]),
        ("{ value: 0.2, plus: 1%, minus: 2% }", [0.2, 0.196, 0.202]),
        ("{ value: -0.2, tolerance: 10% }", [-0.2, -0.22, -0.18]),
        ("{ value: 2*0.1, tolerance: 1% }", [0.2, 0.198, 0.202]),
        ("0.2 m ± 1%", [0.2, 0.198, 0.202]),
        ("0.2 m ±1%", [0.2, 0.198, 0.202]),
        ("20 cm +/- 2 mm", [0.2, 0.198, 0.202]),
        ("20 cm +- 0.2", [0.2, 0.198, 0.202]),
        ("(200 ± 2) mm", [0.2, 0.198, 0.202]),
        ("0.2 m +0.01 -0.02", [0.2, 0.18, 0.21]),
        ("200 mm -2% +10", [0.2, 0.196, 0.21]),
        ("0.2 m +1 cm / -20 mm", [0.2, 0.18, 0.21]),
        ("\"[0.198, 0.202] m\"", [0.2, 0.198, 0.202]),
        ("\"[198, 202] mm\"", [0.2, 0.198, 0.202]),
        ("[0.198, 0.202]", [0.2, 0.198, 0.202]),
        ("[198 mm, 0.202 m]", [0.2, 0.198, 0.202]),
        ("{ value: 0.2 m, tolerance: ± 1% }", [0.2, 0.198, 0.202]),
        ("{ value: 200, unit: mm, tolerance: +10 -20 }", [0.2, 0.18, 0.21]),
        ("{ value: 0.2 m, tolerance: +1 cm -20 mm }", [0.2, 0.18, 0.21]),
        ("{ value: 0.2 m ± 1%, description: its length }", [0.2, 0.198, 0.202]),
        ("{ value: 200 ± 2, unit: mm }", [0.2, 0.198, 0.202]),
        ("{ interval: \"[198, 202] mm\" }", [0.2, 0.198, 0.202]),
        ("-0.2 m ± 1%", [-0.2, -0.202, -0.198]),
        ("2*0.1 ± 1%", [0.2, 0.198, 0.202]),
    ] {
        let model = good(&BAR.replace("{ value: 0.2, unit: m, tolerance: 1% }", written));
        close(interval(&model, "l"), wanted);
    }
}

/// An interval without width is a certain parameter, wherever it is written.
#[test]
fn an_interval_without_width_is_a_certain_parameter() {
    let certain = |model: &Description| match &model.parameters[0].value {
        ParameterValue::Formula(formula) => formula.as_number(),
        ParameterValue::Interval { .. } => None,
    };
    for written in [
        "0.2 m ± 0",
        "0.2 m ± 0%",
        "\"[0.2, 0.2] m\"",
        "[0.2, 0.2]",
        "{ value: 0.2, tolerance: 0 }",
        "{ value: 200 mm, plus: 0%, minus: 0 mm }",
        "0.2 m +0 -0",
        "{ interval: [200 mm, 0.2 m] }",
    ] {
        let model = good(&BAR.replace("{ value: 0.2, unit: m, tolerance: 1% }", written));
        assert_eq!(certain(&model), Some(0.2), "{written}");
        assert_eq!(model.uncertain().count(), 0, "{written}");
    }
    // Numbers of points may stay that the file gives to an uncertain parameter.
    let counted = format!("{BAR}bounds: {{ scan: {{ points: {{ l: 7 }} }} }}\n");
    let model = load_str("x.yaml", &counted, &[Override::parse("l=0.2±0").unwrap()]).unwrap();
    assert!(model.bounds.scan.unwrap().points.is_empty());
}

#[test]
fn scenes_accept_every_notation_of_tolerances() {
    for (written, wanted) in [
        ("0.3 ± 1%", [0.3, 0.297, 0.303]),
        ("± 5%", [0.2, 0.19, 0.21]),
        ("5%", [0.2, 0.19, 0.21]),
        ("+1 cm -20 mm", [0.2, 0.18, 0.21]),
        ("[0.1, 0.3]", [0.2, 0.1, 0.3]),
        ("\"[10, 30] cm\"", [0.2, 0.1, 0.3]),
        ("{ tolerance: ± 5% }", [0.2, 0.19, 0.21]),
    ] {
        for model in ["{ value: 0.2, unit: m, tolerance: 1% }", "{ value: 0.2 ± 3%, unit: m }", "0.2 m ± 1%"] {
            let text = BAR.replace("{ value: 0.2, unit: m, tolerance: 1% }", model);
            let text = format!("{text}scenes: {{ other: {{ parameters: {{ l: {written} }} }} }}\n");
            let reading = read_str("x.yaml", &text, &[]);
            assert!(!reading.diagnostics.has_errors(), "{model}, {written}: {}", reading.diagnostics);
            close(interval(&reading.scenes[0].description, "l"), wanted);
        }
    }
}

#[test]
fn overrides_replace_value_and_tolerance() {
    let with = |text: &str| {
        let wanted = Override::parse(text).unwrap();
        load_str("x.yaml", &BAR.replace("value: 0.2, unit: m", "value: 200, unit: mm"), &[wanted]).unwrap()
    };
    close(interval(&with("l=160±2%"), "l"), [0.16, 0.1568, 0.1632]);
    close(interval(&with("l = 160 +- 2"), "l"), [0.16, 0.158, 0.162]);
    close(interval(&with("l=[100,0.2 m]"), "l"), [0.15, 0.1, 0.2]);
    close(interval(&with("l=[10, 20] cm"), "l"), [0.15, 0.1, 0.2]);
    close(interval(&with("l=160 +2 -1"), "l"), [0.16, 0.159, 0.162]);
    close(interval(&with("l=0.16 m +/- 2"), "l"), [0.16, -1.84, 2.16]);
    // A deviation alone is that of the file's value.
    close(interval(&with("l=±2%"), "l"), [0.2, 0.196, 0.204]);
    close(interval(&with("l=2%"), "l"), [0.2, 0.196, 0.204]);
    close(interval(&with("l = +1 -2"), "l"), [0.2, 0.198, 0.201]);
    close(interval(&with("l=15 cm±1 mm"), "l"), [0.15, 0.149, 0.151]);
    let ParameterValue::Formula(value) = with("l=150").parameters.remove(0).value else { panic!("deterministic") };
    assert_eq!(value.as_number(), Some(0.15));
}

#[test]
fn a_bare_number_in_place_of_one_with_a_unit_is_suspicious() {
    let warnings = |own: &str, given: &str| -> Vec<String> {
        let bar = BAR.replace("{ value: 0.2, unit: m, tolerance: 1% }", own);
        let with_scene = format!("{bar}scenes: {{ other: {{ parameters: {{ l: \"{given}\" }} }} }}\n");
        let option = Override::parse(&format!("l={given}")).unwrap();
        let [option, scene] = [read_str("x.yaml", &bar, &[option]), read_str("x.yaml", &with_scene, &[])].map(|read| {
            let found = read.diagnostics.records().into_iter().filter(|record| record.code.id() == "W0305");
            found.filter_map(|record| record.help).collect::<Vec<_>>()
        });
        assert_eq!(option, scene, "{own}, {given}");
        option
    };
    for (own, given) in [("200 mm", "210"), ("200 mm ± 1 mm", "210 ± 2"), ("\"[190, 210] mm\"", "[210, 230]")] {
        assert_eq!(warnings(own, given), ["write `210 mm`, or `210 m` where that is meant"], "{own}, {given}");
    }
    for given in ["0.21", "210 mm", "± 1 mm", "0"] {
        assert_eq!(warnings("200 mm", given), [] as [&str; 0], "{given}");
    }
    for own in ["0.2 m", "{ value: 200, unit: mm }"] {
        assert_eq!(warnings(own, "210"), [] as [&str; 0], "{own}");
    }
}

#[test]
fn parameters_are_sorted_by_dependence() {
    let order = |parameters: &str| -> Vec<String> {
        let text = BAR.replace("parameters:\n", &format!("parameters:\n{parameters}"));
        good(&text).parameters.into_iter().map(|parameter| parameter.name).collect()
    };
    assert_eq!(order("  a: 1\n  b: 2*a\n"), ["a", "b", "l"]);
    assert_eq!(order("  b: 2*a\n  a: 1\n"), ["l", "a", "b"]);
    // Uncertain ones keep the file's order, as the bounds count them by it.
    let u = "{ value: 1, tolerance: 1% }";
    assert_eq!(order(&format!("  d: e + f\n  f: {u}\n  e: {u}\n")), ["f", "e", "l", "d"]);
}

#[test]
fn units_of_outputs_follow_from_their_formulas() {
    let unit = |formula: &str| {
        let text = BAR.replace("joints: {}", "joints: { j: { revolute: [ground, bar.A] } }");
        good(&text.replace("bar.angle }", &format!("{formula} }}"))).outputs.remove(0).unit
    };
    for (formula, wanted) in [
        ("bar.x", "m"),
        ("bar.angle", "rad"),
        ("bar.angular_velocity", "rad/s"),
        ("bar.angular_acceleration", "rad/s^2"),
        ("bar.A.vx", "m/s"),
        ("bar.ay", "m/s^2"),
        ("sqrt(bar.vx^2 + bar.vy^2)", "m/s"),
        ("bar.x - bar.A.x", "m"),
        ("bar.x/l", ""),
        ("j.force", "N"),
        ("j.force.y", "N"),
        ("j.torque", "N*m"),
        ("energy", "J"),
        ("t", "s"),
        ("l", "m"),
        ("180/pi*bar.angle", ""),
        ("\"j.force*bar.vx\"", "W"),
    ] {
        assert_eq!(unit(formula), wanted, "{formula}");
    }
}

#[test]
fn every_kind_of_joint_and_effect_can_be_read() {
    let text = BAR
        .replace(
            "joints: {}",
            r#"joints:
  a: { revolute: { between: [ground, bar] } }
  b: { prismatic: { between: [ground.O, bar], axis: y, angle: 30 deg } }
  c: { fixed: [ground, bar] }
  d: { fixed: { between: [ground, bar], angle: pi } }
  e: { pin_in_slot: { between: [ground, bar], axis: [1, 0.5*l] } }
  f: { distance: { between: [ground, bar], length: 10 cm } }
  g: { gear: { between: [ground, bar], ratio: -2, offset: 1 rad } }
  h: { equation: "bar.angle = 2*t + sin(3*t)" }"#,
        )
        .replace(
            "effects: {}",
            r#"effects:
  a: { gravity: { acceleration: [0, -9.81 m/s^2] } }
  b: { force: { on: bar.A, value: [10*sin(2*t), -5*bar.vx], frame: body } }
  c: { torque: { on: bar, value: 1 kNm, from: arm } }
  d: { spring_damper: { between: [ground, bar], stiffness: 5 N/mm } }
  e: { spring_damper: { between: [ground, bar], along: [1, 1], damping: 3*bar.x^2, free_length: l } }
  f: { torsional_spring_damper: { between: [ground, bar], stiffness: 2 N*m/rad, damping: 2, free_angle: 45° } }
initial: { bar.x: 1 cm, bar.vx: 2*1 }
guess: { bar.y: 2 }"#,
        )
        .replace("bodies:\n", "bodies:\n  ground: { points: { O: [0, 1] } }\n  arm: { inertia: 1, coordinates: [angle], held: { x: 1 } }\n");
    let model = good(&text);
    assert_eq!((model.joints.len(), model.effects.len()), (8, 6));
    let JointKind::Equation(Equation { left, right }) = &model.joints[7].kind else { panic!("an equation") };
    assert_eq!((left, right.terms().len()), (&Formula::parse("bar.angle ").unwrap(), 8));
    let JointKind::Prismatic(Prismatic { angle, .. }) = &model.joints[1].kind else { panic!("prismatic") };
    assert!((angle.as_number().unwrap() - std::f64::consts::PI / 6.0).abs() < 1e-15);
    assert_eq!(model.bodies[0].points[0].name, "O");
    assert!(model.bodies[1].mass.is_none());
    let EffectKind::Torque(torque) = &model.effects[2].kind else { panic!("a torque") };
    let (from, value) = (&torque.reaction_on(), &torque.value.0);
    assert_eq!((*from, value[2].as_number()), (1, Some(1000.0)));
}

#[test]
fn defaults_are_sensible() {
    let model = good(BAR);
    assert_eq!(model.simulation.stepping, Stepping::Fixed(1e-3));
    assert_eq!((model.simulation.alpha, model.simulation.output_step), (-0.1, 0.005));
    assert_eq!(model.bounds.chebyshev.as_ref().unwrap().degree, Degree::Fixed { order: vec![5], nodes: vec![6] });
    assert!(model.bounds.taylor.is_none() && model.bounds.scan.is_none());
    assert_eq!(model.name, "x");
    let model = good(&BAR.replace("duration: 1", "duration: 1, tolerance: 1e-6"));
    assert_eq!(model.simulation.stepping, Stepping::Tolerance(1e-6));
    let model = good(&BAR.replace("duration: 1", "duration: 1 min, alpha: -1/3"));
    assert_eq!((model.simulation.duration, model.simulation.alpha), (60.0, -1.0 / 3.0));
    let model = good(&format!("{BAR}bounds: {{ scan: {{ points: {{ l: 7 }} }}, taylor: }}\n"));
    assert!(model.bounds.chebyshev.is_none());
    assert_eq!(model.bounds.scan.unwrap().points, [7]);
    assert_eq!(model.bounds.taylor.unwrap().order, 2);
}

#[test]
fn warnings_do_not_stop_a_model() {
    let reading = read_str("x.yaml", &BAR.replace("[-l/2, 0]", "[0, 0]"), &[]);
    assert!(reading.description.is_some());
    let record = reading.diagnostics.records().remove(0);
    assert_eq!((record.message.as_str(), record.line), ("parameter `l` is used nowhere", Some(2)));
    assert_eq!(record.severity, Severity::Warning);
}

#[test]
fn diagnostics_are_serialised_as_json() {
    let diagnostics = load_str("x.yaml", &BAR.replace("bar.angle", "bra.angle"), &[]).unwrap_err();
    let json = serde_json::to_value(diagnostics.records()).unwrap();
    assert_eq!(
        json,
        serde_json::json!([{
            "severity": "error", "code": "E0401", "message": "unknown body or joint `bra`", "file": "x.yaml", "line": 7,
            "column": 19, "help": "did you mean `bar`?",
        }])
    );
}

#[test]
fn parts_outside_the_plane_make_a_model_spatial() {
    let in_bar = |part: &str| BAR.replace("points: { A: [-l/2, 0] }", part).replace("bar.angle", "bar.x");
    let joint = |joint: &str| BAR.replace("joints: {}", joint).replace("bar.angle", "bar.x");
    let effect = |effect: &str| BAR.replace("effects: {}", effect).replace("bar.angle", "bar.x");
    for (text, why) in [
        (BAR.to_owned(), None),
        (in_bar("points: { A: [l, 0, 0] }, center_of_mass: [0, l, 0.0]"), None),
        (joint("joints: { j: { revolute: { between: [ground, bar], axis: [0, 0, 2] } } }"), None),
        (effect("effects: { g: { gravity: { acceleration: [0, -9.81, 0] } } }"), None),
        (effect("effects: { m: { torque: { on: bar, value: [0, 0, 1] } } }"), None),
        (in_bar("points: { A: [l, 0, l] }"), Some("point `A` of body `bar` leaves the plane")),
        (in_bar("points: { A: { rotation: { rpy: [0, 0, 1] } } }"), Some("point `A` of body `bar` leaves the plane")),
        (in_bar("center_of_mass: [0, l, l]"), Some("the centre of mass of body `bar` leaves the plane")),
        (in_bar("coordinates: [x, z]"), Some("a coordinate of body `bar` leaves the plane")),
        (joint("joints: { j: { spherical: [ground, bar] } }"), Some("the kind of joint `j` leaves the plane")),
        (
            joint("joints: { j: { revolute: { between: [ground, bar], axis: x } } }"),
            Some("the axis of joint `j` leaves the plane"),
        ),
        (
            joint("joints: { j: { prismatic: { between: [ground, bar], axis: z } } }"),
            Some("the axis of joint `j` leaves the plane"),
        ),
        (
            effect("effects: { g: { gravity: { acceleration: [0, 0, -9.81] } } }"),
            Some("`acceleration` of effect `g` leaves the plane"),
        ),
        (
            effect("effects: { m: { torque: { on: bar, value: [1, 0, 0] } } }"),
            Some("`value` of effect `m` leaves the plane"),
        ),
        (
            in_bar("").replace("outputs", "initial: { bar.z: 1 }\noutputs"),
            Some("`bar.z` in `initial` leaves the plane"),
        ),
        (format!("space: spatial\n{}", in_bar("")), Some("the model says so")),
    ] {
        let space = good(&text).space.clone();
        assert_eq!(space.spatial, why.is_some(), "{text}");
        assert_eq!(space.why, why.unwrap_or("nothing leaves the plane"), "{text}");
    }
}

/// Names are searched for among all, and formulas checked at the ends of every interval: neither may take minutes.
#[test]
fn excessive_numbers_of_parameters_are_refused() {
    let with = |count: usize, value: &str| {
        let lines: String = (0..count).map(|index| format!("  p{index}: {value}\n")).collect();
        let text = BAR.replace("parameters:\n", &format!("parameters:\n{lines}"));
        read_str("x.yaml", &text, &[]).diagnostics.records()
    };
    let errors = |records: Vec<crate::syntax::Record>| -> Vec<String> {
        records.into_iter().filter(|record| record.severity == Severity::Error).map(|record| record.message).collect()
    };
    // `l`, which the bar needs, comes last.
    let found = errors(with(20_000, "1"));
    assert_eq!(found[0], "the model has more than 20000 parameters");
    assert_eq!(errors(with(19_999, "1")), [] as [&str; 0]);
    let found = errors(with(1000, "{ value: 1, tolerance: 1% }"));
    assert_eq!(found, ["the model has more than 1000 uncertain parameters"]);
}
