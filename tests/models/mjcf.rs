//! Robots from MJCF, against MuJoCo and closed forms.
//!
//! The CSV files were made by `tests/reference/mjcf/motion.py NAME.xml [ACTUATOR=CONTROL …]`: MuJoCo 4.0, implicitfast
//! at 1e-5 s, the error of first order in the step extrapolated away.

use std::path::{Path, PathBuf};

use mbint::{Error, Model};

use crate::common::measured::Case;
use crate::common::{Findings, Subject, curve, distance, largest, load, nominal, row, rows};

/// Files of the tests with commands to their actuators.
const ROBOTS: [(&str, &str); 15] = [
    ("actuators", "controls: { hold: 0.5*sin(3*t), turn: 0.8, push: 0.15*cos(5*t), spring: 0.3 }"),
    ("attached", "controls: { push: 2*sin(3*t), kick: cos(2*t), right_lift: 0.5*sin(2*t), left_lift: -0.1 }"),
    ("ball_and_free", ""),
    ("cart_pole", ""),
    ("coupled", "controls: { drive: 1.5*sin(4*t) }"),
    (
        "damping_ratios",
        "controls: { hold_a: 0.4*sin(3*t), hold_b: 0.5, hold_c: 0.1*cos(4*t), pushed_c: 0.2, hold_both: 0.3*t, hold_arm: 0.2*sin(5*t) }",
    ),
    ("double_pendulum", ""),
    ("floating_base", "controls: { hold_left: 0.4*sin(3*t), kick: -2*cos(6*t), push_right: 0.5*sin(5*t) }"),
    ("frames", ""),
    ("linkage", ""),
    (
        "memories",
        "controls: { lag: sin(3*t), sum: cos(4*t), piston: 0.5*sin(2*t), hold: 2*sin(2*t), strong: sin(5*t), weak: cos(3*t), \
         alone: sin(4*t), turn: 0.5*sin(3*t), slide: cos(2*t) }",
    ),
    ("several_joints", ""),
    ("spatial_arm", ""),
    ("tendons", "controls: { muscle: -0.3*t }"),
    ("welded", ""),
];

/// Origin of `tests/reference/mjcf/*.csv`.
const MUJOCO: &str = "MuJoCo 4.0, implicitfast at 1e-5 and 2e-5 s, extrapolated";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/mjcf")
}

/// A model that names a file of a folder.
fn model_of(folder: &Path, name: &str, yaml: &str) -> Result<Model, Error> {
    let text = format!("mjcf: {name}.xml\n{yaml}\nsimulation: {{ duration: 1, step: 5e-4, output_step: 0.05 }}\n");
    let path = folder.join("model.yaml");
    Model::from_yaml_str(&path.display().to_string(), &text)
}

#[track_caller]
fn description(reading: Result<Model, Error>) -> Subject {
    reading.unwrap_or_else(|error| panic!("{error}")).into()
}

#[test]
fn robots_move_as_in_mujoco() {
    let mut findings = Findings::default();
    for (name, yaml) in ROBOTS {
        let bounds = nominal(&description(model_of(&folder(), name, yaml)));
        let path = folder().join(format!("{name}.csv"));
        let (text, rows) = (std::fs::read_to_string(&path).unwrap(), rows(&path));
        let names = text.lines().next().unwrap().split(',').enumerate().skip(1);
        let apart = largest(names.map(|(column, output)| {
            let exact: Vec<f64> = rows.iter().map(|row| row[column]).collect();
            distance(curve(&bounds, output), &exact)
        }));
        println!("{name}: {apart:e}");
        let case = Case::new("peers", &format!("MuJoCo, `{name}`")).source(MUJOCO);
        findings.note(case.at_most("largest distance, m or rad", apart, 1e-4));
    }
    findings.none();
}

/// An MJCF, and perhaps a model, in a folder of their own.
struct Files(tempfile::TempDir);

impl Files {
    fn new(mjcf: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("robot.xml"), mjcf).unwrap();
        Self(folder)
    }

    fn with(&self, yaml: &str) -> Result<Model, Error> {
        model_of(self.0.path(), "robot", yaml)
    }
}

const PENDULUM: &str = "<mujoco><worldbody><body name='arm'><joint name='hinge' axis='0 1 0' damping='0.1'/>\
    <geom type='sphere' size='0.1' pos='0 0 -1' mass='2'/></body></worldbody></mujoco>";

#[test]
fn a_file_by_itself_is_a_model() {
    let files = Files::new(PENDULUM);
    let description = load(&files.0.path().join("robot.xml"));
    assert_eq!(description.model.outputs().next().unwrap().0, "hinge");
    assert_eq!(description.study().description().bodies.len(), 2);
}

#[test]
fn only_numbers_that_are_named_are_parameters() {
    let files = Files::new(PENDULUM);
    let none = description(files.with(""));
    assert!(none.study().description().parameters.is_empty());
    let found = description(files.with("parameters: { body.arm.mass: 5%, joint.hinge.damping: [0.05, 0.2] }"));
    let study = found.study();
    let mut names: Vec<&str> = study.description().parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["body.arm.mass", "joint.hinge.damping"]);
    assert_eq!(found.uncertain_count(), 2);
}

/// The mass of a body without damping does not change how it swings: its inertia is in proportion.
#[test]
fn inertias_of_geoms_follow_the_mass() {
    let files = Files::new(&PENDULUM.replace("damping='0.1'", ""));
    let angles = |mass: &str| {
        let yaml = format!("parameters: {{ body.arm.mass: {mass} }}\ninitial: {{ hinge.angle: 1 }}");
        curve(&nominal(&description(files.with(&yaml))), "hinge").to_vec()
    };
    assert!(distance(&angles("2"), &angles("7")) < 1e-9);
}

/// A model with elements that a flag disables moves as a model without these elements.
#[test]
fn flags_disable_their_elements() {
    let robot = |flags: &str, joint: &str, rest: &str| {
        Files::new(&format!(
            "<mujoco><option><flag {flags}/></option><worldbody><body name='a'><joint name='one' axis='0 1 0' {joint}/>\
             <geom type='capsule' size='0.03' fromto='0 0 0 0.4 0 0' mass='1'/><body name='b' pos='0.4 0 0'>\
             <joint name='two' axis='0 1 0'/><geom type='capsule' size='0.03' fromto='0 0 0 0.3 0 0.1' mass='1'/></body></body></worldbody>{rest}</mujoco>"
        ))
    };
    let motion = |files: Files, yaml: &str| curve(&nominal(&description(files.with(yaml))), "one").to_vec();
    let coupled = "<equality><joint joint1='two' joint2='one' polycoef='0 0.5 0 0 0'/></equality>";
    let driven = "<actuator><motor name='drive' joint='one' ctrlrange='-1 1'/></actuator>";
    let tendon = "<tendon><fixed name='t' stiffness='8' damping='0.4'><joint joint='two' coef='1'/></fixed></tendon>";
    let bare = motion(robot("", "", ""), "");
    for (flags, joint, rest) in [
        ("damper='disable'", "damping='0.4'", ""),
        ("spring='disable'", "stiffness='5'", ""),
        ("passive='disable'", "stiffness='5' damping='0.4'", tendon),
        ("frictionloss='disable'", "frictionloss='0.4'", ""),
        ("equality='disable'", "", coupled),
        ("constraint='disable'", "frictionloss='0.4'", coupled),
        ("actuation='disable'", "", driven),
    ] {
        let apart = distance(&motion(robot(flags, joint, rest), ""), &bare);
        assert!(apart < 1e-12, "{flags}: {apart:e}");
        assert!(distance(&motion(robot("", joint, rest), ""), &bare) > 1e-3 || rest == driven, "{flags}");
    }
    let three = "controls: { drive: 3 }";
    let clamped = motion(robot("", "", driven), three);
    let free = motion(robot("clampctrl='disable'", "", driven), three);
    let wide = motion(robot("", "", &driven.replace("-1 1", "-4 4")), three);
    assert!(distance(&free, &wide) < 1e-12 && distance(&clamped, &wide) > 1e-3);
    let weightless = motion(robot("gravity='disable'", "", ""), "");
    assert!(weightless.iter().all(|angle| angle.abs() < 1e-12));
}

#[test]
fn the_model_gives_points_to_bodies() {
    let files = Files::new(
        "<mujoco><worldbody><body name='arm' pos='0 0 1'><joint name='h' type='hinge' axis='0 1 0'/>\
         <geom type='capsule' size='0.02' fromto='0 0 0 0.3 0 0' mass='1'/><site name='mark' pos='0.1 0 0'/></body></worldbody></mujoco>",
    );
    let yaml = "bodies: { arm: { points: { tip: [0.3, 0, 0.1] } } }\n\
                outputs: { angle: h.angle, x: arm.tip.x, z: arm.tip.z, mark: arm.mark.x }";
    let bounds = nominal(&description(files.with(yaml)));
    let angle = curve(&bounds, "angle");
    let expected = |x: f64, z: f64| -> [Vec<f64>; 2] {
        let across = angle.iter().map(|a| x * a.cos() + z * a.sin()).collect();
        [across, angle.iter().map(|a| 1.0 + z * a.cos() - x * a.sin()).collect()]
    };
    let [x, z] = expected(0.3, 0.1);
    assert!(distance(curve(&bounds, "x"), &x) < 1e-12 && distance(curve(&bounds, "z"), &z) < 1e-12);
    assert!(distance(curve(&bounds, "mark"), &expected(0.1, 0.0)[0]) < 1e-12);
}

/// MuJoCo 4.0.0, `implicitfast` at 1e-5 s, contacts off: joints and the crate's floor after each second; it is of order
/// one.
#[test]
fn crane_matches_mujoco() {
    let bounds = nominal(&crate::common::model("crane"));
    let wanted = [
        (1.0, [0.18612467, 0.063016236, -0.0058981674, -0.032910286, 0.26071602]),
        (2.0, [1.1613674, 0.16381799, -0.0066289721, 0.70392536, 0.29022889]),
        (3.0, [1.9951626, -0.24593244, -0.00022306089, 2.6057226, 0.32204572]),
        (4.0, [2.1038881, -0.15255151, -0.0050745657, 2.483967, 0.27773817]),
    ];
    for (time, values) in wanted {
        for (name, value) in ["trolley", "swing", "sway", "floor_x", "floor_z"].into_iter().zip(values) {
            let found = curve(&bounds, name)[row(&bounds, time)];
            assert!((found - value).abs() < 1e-5, "{name} at {time}: {found}, not {value}");
        }
    }
}

/// MuJoCo takes one of both.
#[test]
fn a_drive_has_one_damping() {
    let drive = "<actuator><position joint='hinge' kp='3' kv='1' dampratio='1'/></actuator></mujoco>";
    let files = Files::new(&PENDULUM.replace("</mujoco>", drive));
    let message = files.with("").unwrap_err().to_string();
    assert!(message.contains("an actuator has `kv` or `dampratio`"), "{message}");
}
