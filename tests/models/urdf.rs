//! Robots from URDF, against the dynamics of Pinocchio, closed forms, and the same mechanism said in other ways.

use std::path::{Path, PathBuf};

use mbint::Model;
use symdiff::{Builder, Formula};

use crate::common::measured::Case;
use crate::common::{
    Findings, Subject, curve, distance, distance_from, largest, load, nominal, order, reference, rows, run, third_party,
};

/// A URDF, and perhaps a model, in a folder of their own.
pub(crate) struct Files(tempfile::TempDir);

impl Files {
    pub(crate) fn new(urdf: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("robot.urdf"), urdf).unwrap();
        Self(folder)
    }

    fn path(&self, file: &str) -> PathBuf {
        self.0.path().join(file)
    }

    pub(crate) fn alone(&self) -> Subject {
        load(&self.path("robot.urdf"))
    }

    pub(crate) fn model(&self, yaml: &str) -> Subject {
        let simulation = "\nsimulation: { duration: 0.5, step: 1e-3, output_step: 0.01 }\n";
        let path = self.path("model.yaml");
        std::fs::write(&path, format!("urdf: robot.urdf\n{yaml}{simulation}")).unwrap();
        load(&path)
    }
}

pub(crate) const GRAVITY: &str = "effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }\n";

/// Origin of `urdf/*.csv` of the third-party results.
const PINOCCHIO: &str = "Pinocchio's articulated-body algorithm, DOP853 at 1e-11";

pub(crate) fn link(name: &str, mass: f64, xyz: &str, inertia: [f64; 3]) -> String {
    let [x, y, z] = inertia;
    format!(
        "<link name='{name}'><inertial><origin xyz='{xyz}'/><mass value='{mass}'/>\
         <inertia ixx='{x}' iyy='{y}' izz='{z}' ixy='0' ixz='0' iyz='0'/></inertial></link>\n"
    )
}

pub(crate) fn joint(name: &str, kind: &str, parent: &str, child: &str, details: &str) -> String {
    format!("<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{details}</joint>\n")
}

pub(crate) fn robot(parts: &[String]) -> Files {
    Files::new(&format!("<robot name='r' xmlns:mbint='urn:mbint'><link name='base'/>\n{}</robot>", parts.concat()))
}

/// Errors at h = 1e-3 s and at half of it of a robot that swings from rest at q_i = 0.3 sin(1 + i), against `rows`.
fn errors_of_swinging(urdf: &Path, starts: &[&str], rows: &[Vec<f64>]) -> [f64; 2] {
    let initial = starts.iter().enumerate();
    let initial = initial.map(|(i, start)| format!("  {start}: {}\n", 0.3 * (1.0 + i as f64).sin()));
    let initial: String = initial.collect();
    [1e-3, 5e-4].map(|h| {
        let text = format!(
            "urdf: {}\n{GRAVITY}initial:\n{initial}simulation: {{ duration: 1, step: {h}, output_step: 0.01 }}",
            urdf.file_name().unwrap().display()
        );
        // A model names files of its own folder.
        let name = urdf.with_file_name("swinging.yaml");
        let model = Model::from_yaml_str(name.to_str().unwrap(), &text).unwrap_or_else(|report| panic!("{report}"));
        let bounds = nominal(&model.into());
        largest(starts.iter().enumerate().map(|(i, start)| {
            let exact: Vec<f64> = rows.iter().map(|row| row[i + 1]).collect();
            distance(curve(&bounds, start.split('.').next().unwrap()), &exact)
        }))
    })
}

/// At most 1e-4 rad or m off at h = 1e-3 s, and of second order at half of it.
fn second_order(case: Case, [coarse, fine]: [f64; 2]) -> Case {
    case.at_most("largest distance, m or rad", coarse, 1e-4).order("order", order(coarse, fine), 2.0)
}

#[test]
fn a_crane_swings_as_by_recursive_newton_euler_dynamics() {
    let mut findings = Findings::default();
    let urdf = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/urdf/crane.urdf");
    let starts = ["slew.angle", "luff.angle", "stretch.displacement", "counterweight_hinge.angle"];
    let case = Case::new("peers", "recursive Newton–Euler dynamics, crane").source("`tests/reference/urdf/swing.py`");
    findings.note(second_order(case, errors_of_swinging(&urdf, &starts, &reference("urdf/crane.csv"))));
    findings.none();
}

#[test]
#[ignore = "third-party robots: MBINT_REFERENCE=folder"]
fn robots_swing_as_those_of_pinocchio() {
    let mut findings = Findings::default();
    let ur5 = ["shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"]
        .map(|joint| format!("{joint}_joint.angle"));
    let ur5 = ur5.each_ref().map(String::as_str);
    for (name, starts) in [("double_pendulum_simple", &["joint1.angle", "joint2.angle"][..]), ("ur5_robot", &ur5)] {
        let file = |ending: &str| third_party().join(format!("urdf/{name}.{ending}"));
        let case = Case::new("peers", &format!("Pinocchio, `{name}`")).source(PINOCCHIO);
        findings.note(second_order(case, errors_of_swinging(&file("urdf"), starts, &rows(&file("csv")))));
    }
    findings.none();
}

/// A formula without names.
fn number(formula: &Formula) -> f64 {
    let builder = Builder::new();
    let built = formula.build(&builder, |name| Err(name.to_owned())).unwrap();
    built.as_constant().unwrap()
}

/// Two point-like links welded with a quarter turn between them.
fn welded(second: &str) -> Files {
    robot(&[
        joint("hinge", "revolute", "base", "a", "<axis xyz='0 1 0'/>"),
        link("a", 2.0, "0 0 -0.5", [0.03, 0.02, 0.01]),
        joint("weld", "fixed", "a", "b", "<origin xyz='0.1 0 -1' rpy='0 0 1.5707963267948966'/>"),
        second.to_owned(),
    ])
}

#[test]
fn welded_links_are_one_body() {
    let files = welded(&link("b", 3.0, "0.2 0 0", [0.05, 0.04, 0.03]));
    let study = files.alone().study();
    let description = study.description();
    assert_eq!(description.bodies.len(), 2, "ground and a");
    let body = &description.bodies[1];
    // b's centre is at (0.1, 0, −1) + R_z(90°) (0.2, 0, 0) = (0.1, 0.2, −1) of a; its x and y are exchanged.
    let center = [0.3 / 5.0, 0.6 / 5.0, -4.0 / 5.0];
    let found = body.center_of_mass.as_ref().unwrap().each_ref().map(number);
    let reduced = 2.0 * 3.0 / 5.0;
    let d = [0.1, 0.2, -0.5];
    let inertia = body.inertia.as_ref().unwrap();
    let expected = [
        (number(body.mass.as_ref().unwrap()), 5.0),
        (found[0], center[0]),
        (found[1], center[1]),
        (found[2], center[2]),
        (number(&inertia.xx), 0.03 + 0.04 + reduced * (d[1] * d[1] + d[2] * d[2])),
        (number(&inertia.yy), 0.02 + 0.05 + reduced * (d[0] * d[0] + d[2] * d[2])),
        (number(&inertia.zz), 0.01 + 0.03 + reduced * (d[0] * d[0] + d[1] * d[1])),
        (number(&inertia.xy), -reduced * d[0] * d[1]),
        (number(&inertia.xz), -reduced * d[0] * d[2]),
        (number(&inertia.yz), -reduced * d[1] * d[2]),
    ];
    for (found, expected) in expected {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}

#[test]
fn the_model_gives_points_to_links() {
    let files = welded(&link("b", 3.0, "0.2 0 0", [0.05, 0.04, 0.03]));
    let description = files.model(&format!(
        "{GRAVITY}parameters: {{ l: 0.3 }}
bodies:
  base: {{ points: {{ foot: [1, 2, 3] }} }}
  a: {{ points: {{ tip: [0.1, 0, -l] }} }}
  b: {{ points: {{ edge: [l, 0.05, 0.01] }} }}
  ball: {{ mass: 0.1, inertia: 1e-3 }}
joints: {{ glue: {{ fixed: [b.edge, ball] }} }}
initial: {{ hinge.angle: 0.4 }}
outputs: {{ angle: hinge.angle, tip_x: a.tip.x, tip_z: a.tip.z, edge_x: b.edge.x, edge_y: b.edge.y, edge_z: link.b.edge.z, glued: ball.x, foot: base.foot.y + 0*a.x, torque: glue.torque_at.b.edge.x }}"
    ));
    let bounds = nominal(&description);
    let angle = curve(&bounds, "angle");
    // The hinge turns about y: (x, z) → (x cos + z sin, z cos − x sin). b's axes are turned by 90° about z.
    let turned = |x: f64, z: f64| angle.iter().map(move |a| (x * a.cos() + z * a.sin(), z * a.cos() - x * a.sin()));
    let expected = |name: &str| -> Vec<f64> {
        match name {
            "tip_x" => turned(0.1, -0.3).map(|place| place.0).collect(),
            "tip_z" => turned(0.1, -0.3).map(|place| place.1).collect(),
            "edge_x" | "glued" => turned(0.1 - 0.05, -1.0 + 0.01).map(|place| place.0).collect(),
            "edge_z" => turned(0.1 - 0.05, -1.0 + 0.01).map(|place| place.1).collect(),
            "edge_y" => vec![0.3; angle.len()],
            _ => vec![2.0; angle.len()],
        }
    };
    for name in ["tip_x", "tip_z", "edge_x", "edge_y", "edge_z", "glued", "foot"] {
        assert!(distance(curve(&bounds, name), &expected(name)) < 1e-10, "{name}");
    }
    assert!((angle[angle.len() - 1] - 0.4).abs() > 0.1);
}

#[test]
fn uncertain_mass_of_a_welded_link_matches_files() {
    let at = |mass: f64| {
        let files = welded(&link("b", mass, "0.2 0 0", [0.05, 0.04, 0.03]));
        nominal(&files.model(&format!("{GRAVITY}initial: {{ hinge.angle: 1 }}")))
    };
    let files = welded(&link("b", 3.0, "0.2 0 0", [0.05, 0.04, 0.03]));
    let text = format!(
        "parameters: {{ link.b.mass: 20% }}\n{GRAVITY}initial: {{ hinge.angle: 1 }}\nbounds: {{ scan: {{ points: 2 }} }}"
    );
    let bounds = run(&files.model(&text));
    let band = &bounds.outputs[0].bands[0];
    let ends = [at(2.4), at(3.6)].map(|bounds| bounds.outputs[0].nominal.clone());
    let at_least =
        |pick: fn(f64, f64) -> f64| -> Vec<f64> { ends[0].iter().zip(&ends[1]).map(|(a, b)| pick(*a, *b)).collect() };
    assert!(distance(&band.lower, &at_least(f64::min)) < 1e-9);
    assert!(distance(&band.upper, &at_least(f64::max)) < 1e-9);
    assert!(largest(band.upper.iter().zip(&band.lower).map(|(a, b)| a - b)) > 1e-4, "the mass matters");
}

#[test]
fn attributes_match_keys_of_a_model() {
    let hinge = |own: &str| {
        joint("hinge", "revolute", "base", "a", &format!("<axis xyz='0 1 0'/><dynamics damping='0.1'{own}/>"))
    };
    let body = |own: &str| {
        format!(
            "<link name='a'><inertial><origin xyz='0 0 -0.5'/><mass value='2'{own}/><inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link>"
        )
    };
    let rest = format!("{GRAVITY}initial: {{ hinge.angle: 1 }}");
    let own = robot(&[hinge(" mbint:damping='[0.05, 0.2]'"), body(" mbint:mass='5%'")]);
    let plain = robot(&[hinge(""), body("")]);
    let said = "parameters: { link.a.mass: 5%, joint.hinge.damping: [0.05, 0.2] }\n";
    let [a, b] = [own.model(&rest), plain.model(&format!("{said}{rest}"))].map(|model| run(&model));
    let (a, b) = (&a.outputs[0].bands[0], &b.outputs[0].bands[0]);
    assert_eq!(a.lower, b.lower);
    assert_eq!(a.upper, b.upper);
    assert!(a.upper.last() > a.lower.last());
}

#[test]
fn formulas_may_contain_names_of_links_and_joints() {
    let files = welded("<link name='b'/>");
    let description = files.model(&format!(
        "{GRAVITY}outputs: {{ x: b.x, same: link.b.x, a: joint.hinge.angle, b: hinge.angle, m: link.a.mass + 0*a.x }}"
    ));
    let bounds = nominal(&description);
    assert_eq!(curve(&bounds, "x"), curve(&bounds, "same"));
    assert_eq!(curve(&bounds, "a"), curve(&bounds, "b"));
    assert!(distance_from(&bounds.times, curve(&bounds, "m"), |_| 2.0) < 1e-12);
}

#[test]
fn massless_link_at_the_end_is_omitted() {
    let files = robot(&[
        joint("hinge", "revolute", "base", "a", "<axis xyz='0 1 0'/>"),
        link("a", 1.0, "0.3 0 0", [0.1; 3]),
        joint("end", "revolute", "a", "tip", ""),
        "<link name='tip'/>".to_owned(),
    ]);
    let description = files.model(GRAVITY);
    let records = description.model.warnings().records();
    assert_eq!(records.len(), 1);
    assert_eq!(records[0].message, "link `tip` moves, but has no mass: it is omitted, with its joint `end`");
    assert_eq!(nominal(&description).outputs.len(), 1);
}

/// Numbers of urdf-rs, another reader of the format, for the same text.
#[test]
fn numbers_match_urdf_rs() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/arm.urdf");
    let other = urdf_rs::read_file(&path).unwrap();
    let ours = load(&path).study();
    let tree = ours.description().robot.as_ref().unwrap();
    assert_eq!(tree.links.len(), other.links.len());
    for link in &other.links {
        let found = tree.links.iter().find(|known| known.name == link.name).unwrap();
        assert_eq!(found.mass.unwrap_or(0.0), link.inertial.mass.value);
    }
    for joint in &other.joints {
        let found = tree.links.iter().filter_map(|link| link.joint.as_ref()).find(|known| known.name == joint.name);
        let found = found.unwrap();
        let dynamics = joint.dynamics.as_ref();
        assert_eq!(found.damping, dynamics.map_or(0.0, |dynamics| dynamics.damping));
        assert_eq!(found.friction, dynamics.map_or(0.0, |dynamics| dynamics.friction));
        if let Some(axis) = found.axis {
            assert_eq!(axis, *joint.axis.xyz);
            assert_eq!(found.limits, [joint.limit.lower, joint.limit.upper].map(Some));
        }
    }
}

/// Every URDF below the folder MBINT_ROBOTS runs 0.1 s, e.g. the unpacked package example-robot-data.
#[test]
#[ignore = "by hand: MBINT_ROBOTS=folder"]
fn robots_of_a_collection_run() {
    let mut folders = vec![PathBuf::from(std::env::var_os("MBINT_ROBOTS").expect("MBINT_ROBOTS is a folder"))];
    let mut findings = Findings::default();
    let mut count = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "urdf") {
                count += 1;
                let name = path.display();
                match Model::from_file(&path) {
                    Err(report) => findings.check(false, format_args!("{name}: {report}")),
                    Ok(model) => match Subject::from(model).duration(0.1).study().methods(&[]).threads(2).run() {
                        Err(error) => findings.check(false, format_args!("{name}: {error}")),
                        Ok(result) => {
                            findings.check(result.failure().is_none(), format_args!("{name}: {:?}", result.failure()));
                        }
                    },
                }
            }
        }
    }
    println!("{count} robots");
    findings.none();
}
