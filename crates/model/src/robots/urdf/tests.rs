//! Reading of a URDF: versions of the format, limits of size, and the checks that urdf-rs does not make.

use std::fmt::Write;
use std::time::{Duration, Instant};

use super::read::read;
use super::robot::Robot;
use crate::robots::algebra::{self, Value};
use crate::robots::number::Number;
use crate::syntax::Diagnostics;

fn robot(text: &str) -> Robot {
    let mut diagnostics = Diagnostics::new("robot.urdf", text);
    let robot = read(text, 0, &mut diagnostics);
    assert!(diagnostics.is_empty(), "{diagnostics}");
    robot.unwrap()
}

fn messages(text: &str) -> Vec<String> {
    let mut diagnostics = Diagnostics::new("robot.urdf", text);
    let robot = read(text, 0, &mut diagnostics);
    assert_eq!(robot.is_none(), diagnostics.has_errors());
    diagnostics.iter().map(|found| found.message.clone()).collect()
}

/// Two links and a joint with some attributes of `<robot>` and elements in `<joint>`.
fn hinge(version: &str, details: &str) -> String {
    format!(
        "<robot name='r' {version}><link name='a'/><link name='b'/>\
         <joint name='j' type='revolute'><parent link='a'/><child link='b'/>{details}</joint></robot>"
    )
}

fn plain(values: [f64; 3]) -> [Value; 3] {
    values.map(Value::Number)
}

/// Rows of the rotation matrix.
fn matrix(angles: [f64; 3]) -> Vec<f64> {
    let rows = algebra::matrix(&algebra::roll_pitch_yaw(&plain(angles)));
    let number = |value: &Value| match value {
        Value::Number(number) => *number,
        Value::Text(text) => panic!("{text}"),
    };
    rows.iter().flatten().map(number).collect()
}

#[test]
fn a_quaternion_is_its_rotation_at_every_pitch() {
    let right = std::f64::consts::FRAC_PI_2;
    for pitch in [0.0, 1.2, -1.2, right, -right, right - 1e-3, 1e-6 - right, right - 1e-12] {
        for (roll, yaw) in [(0.0, 0.0), (0.4, -2.0), (-3.0, 3.0), (2.0, 2.5)] {
            let [w, x, y, z] = algebra::roll_pitch_yaw(&plain([roll, pitch, yaw])).map(|part| match part {
                Value::Number(number) => 3.0 * number,
                Value::Text(text) => panic!("{text}"),
            });
            let text = hinge("version='1.1'", &format!("<origin xyz='1 2 3' quat_xyzw='{x:?} {y:?} {z:?} {w:?}'/>"));
            let found = robot(&text).joints[0].origin.rpy.each_ref().map(|number| number.value);
            let differences = matrix(found).into_iter().zip(matrix([roll, pitch, yaw])).map(|(a, b)| (a - b).abs());
            let error = differences.fold(0.0, f64::max);
            assert!(error < 2e-15, "{error:e} at {roll} {pitch} {yaw}");
        }
    }
}

#[test]
fn quaternions_are_refused_where_they_would_be_ignored() {
    let quaternion = "<origin quat_xyzw='0 0 1 0'/>";
    let earlier = ["`quat_xyzw` belongs to URDF 1.1, and this file is of an earlier version"];
    assert_eq!(messages(&hinge("", quaternion)), earlier);
    assert_eq!(messages(&hinge("version='1.0'", quaternion)), earlier);
    let both = "<origin rpy='0 0 1' quat_xyzw='0 0 1 0'/>";
    assert_eq!(messages(&hinge("version='1.1'", both)), ["`rpy` and `quat_xyzw` exclude each other"]);
    let zero = "<origin quat_xyzw='0 0 0 0'/>";
    assert_eq!(messages(&hinge("version='1.2'", zero)), ["a quaternion of zeros is no rotation"]);
    assert_eq!(messages(&hinge("version='one'", "")), ["`one` is not a version of URDF"]);
    assert_eq!(messages(&hinge("version='1.3'", "")), ["URDF 1.3 is not known: it is read as URDF 1.2"]);
}

#[test]
fn absent_limits_follow_the_version() {
    let limits = |version: &str, details: &str| {
        let value = |number: &Option<Number>| number.as_ref().map(|number| number.value);
        let mut robot = robot(&hinge(version, details));
        robot.joints.remove(0).limits.map(|l| [&l.lower, &l.upper, &l.effort, &l.velocity].map(value))
    };
    for version in ["", "version='1.1'", "version='1.2'"] {
        assert_eq!(limits(version, ""), None, "no limit is not a limit of 0");
        let all = "<limit lower='-1' upper='2' effort='3' velocity='4'/>";
        assert_eq!(limits(version, all), Some([-1.0, 2.0, 3.0, 4.0].map(Some)));
    }
    assert_eq!(limits("", "<limit upper='2'/>"), Some([Some(0.0), Some(2.0), None, None]));
    assert_eq!(limits("version='1.2'", "<limit upper='2' jerk='1'/>"), Some([None, Some(2.0), None, None]));
    assert_eq!(limits("version='1.2'", "<limit/>"), Some([None; 4]));
    // Files in use say so for no limit; URDF 1.2 forbids it.
    let negative = "<limit lower='1' effort='-1' upper='2'/>";
    assert_eq!(limits("", negative), Some([Some(1.0), Some(2.0), Some(-1.0), None]));
    assert_eq!(messages(&hinge("version='1.2'", negative)), ["`effort` cannot be negative"]);
    assert_eq!(messages(&hinge("", "<limit upper='-2'/>")), ["the limits of joint `j` are reversed"]);
}

#[test]
fn misspelt_names_are_errors_and_unknown_names_warnings() {
    assert_eq!(messages(&hinge("", "<limits lower='1'/>")), ["`<joint>` has no element `<limits>`"]);
    assert_eq!(messages(&hinge("", "<limit lowr='1'/>")), ["`<limit>` has no attribute `lowr`"]);
    let extension = "<dynamics stiffness_of_gears='3'/>";
    assert_eq!(messages(&hinge("", extension)), ["`<dynamics>` has no attribute `stiffness_of_gears`: it is ignored"]);
    assert_eq!(messages(&hinge("", "<loop/>")), ["`<joint>` has no element `<loop>`: it is ignored"]);
    assert_eq!(messages(&hinge("", "<axis xyz='0 0 1'/><axis xyz='0 1 0'/>")), ["a second `<axis>` in one `<joint>`"]);
    assert_eq!(messages(&hinge("", "<axis xyz='0 x 0 1'/>")), ["`xyz` has three numbers, but here are 4"]);
    let foreign = "<x:axis x:xyz='no'/><axis x:xyz='no' xyz='0 0 1'/><safety_controller k_velocity='x'/>";
    assert_eq!(robot(&hinge("xmlns:x='urn:x'", foreign)).joints[0].axis, [0.0, 0.0, 1.0]);
}

#[test]
fn mbint_attributes_do_not_hide_attributes_of_urdf() {
    let text = hinge("xmlns:mbint='urn:mbint'", "<dynamics mbint:damping='5%' damping='0.25' friction='&#49;'/>");
    let robot = robot(&text);
    let joint = &robot.joints[0];
    assert_eq!((joint.damping.value, joint.friction.value), (0.25, 1.0));
    assert_eq!(joint.damping.uncertain.as_ref().map(|(text, _)| text.as_str()), Some("5%"));
    assert_eq!(&text[joint.damping.span.clone()], "0.25");
}

#[test]
fn names_are_any_text() {
    let text = "<robot><link name='a &amp; &lt;b&gt; &quot;c&quot;'/></robot>";
    assert_eq!(robot(text).links[0].name, "a____b___c_");
}

#[test]
fn large_files_are_refused_early() {
    let many =
        |count: usize| (0..count).fold(String::new(), |mut text, i| write!(text, " a{i}='1'").map(|()| text).unwrap());
    let cases = [
        (format!("<robot><link{}/></robot>", many(600_000)), "this element has more than 100 attributes"),
        (
            format!("<robot>{}</robot>", format!("<link{}/>", many(60)).repeat(10_000)),
            "the file has more than 200000 attributes",
        ),
        (format!("<robot>{}</robot>", "<a/>".repeat(300_000)), "the file has more than 200000 elements"),
        ("<a>".repeat(100_000), "elements nest deeper than 100 levels"),
    ];
    for (text, message) in cases {
        let start = Instant::now();
        assert_eq!(messages(&text), [message]);
        assert!(start.elapsed() < Duration::from_secs(1), "{:?}: {message}", start.elapsed());
    }
    // Markup in comments and values counts for nothing.
    let noise = format!("<!-- {} --><![CDATA[{}]]>", "<a>".repeat(200), "<a>".repeat(200));
    assert!(messages(&format!("<robot><link name='{}'/>{noise}</robot>", "&lt;>".repeat(200))).is_empty());
}

/// Exporters of robots write them so.
#[test]
fn undeclared_prefixes_are_ignored() {
    let head = "<?xml version='1.0'?><!-- <a:b> -->\n";
    let limit = "<limit drake:acceleration='2.5' lower='-3' upper='3' effort='1' velocity='1'/>";
    let found = robot(&format!("{head}{}", hinge("gz:version='2'", &format!("<ros:x y='1'/>{limit}"))));
    assert_eq!(found.joints[0].limits.as_ref().unwrap().upper.as_ref().unwrap().value, 3.0);
    // Places behind the outermost element are those of the file.
    let text = hinge("gz:version='2'", "<limit lower='x' upper='3' effort='1' velocity='1'/>");
    let mut diagnostics = Diagnostics::new("robot.urdf", &text);
    assert!(read(&text, 0, &mut diagnostics).is_none());
    let spans: Vec<_> = diagnostics.iter().map(|found| found.span.clone().unwrap()).collect();
    assert_eq!(spans.iter().map(|span| &text[span.clone()]).collect::<Vec<_>>(), ["x"]);
    assert!(messages(&hinge("a:b='1'", "<link"))[0].starts_with("this is not XML"));
    let many: String = (0..30).map(|index| format!("p{index}:x='1' ")).collect();
    assert!(messages(&hinge(&many, ""))[0].contains("an unknown namespace prefix"));
}
