//! Joints of robots from URDF, with their limits, damping and friction, against closed forms.

use crate::common::{curve, distance_from, largest, nominal, order, row};
use crate::urdf::{Files, GRAVITY, joint, link, robot};

#[test]
fn a_floating_base_falls() {
    let files = Files::new(&format!("<robot name='r'>{}</robot>", link("ball", 2.0, "0 0 0", [0.1, 0.2, 0.25])));
    // By itself it has nothing else to do.
    for model in [files.model(&format!("base: floating\n{GRAVITY}")), files.alone()] {
        let bounds = nominal(&model);
        let fall = distance_from(&bounds.times, curve(&bounds, "ball_z"), |t| -9.81 / 2.0 * t * t);
        assert!(fall < 1e-9, "{fall}");
    }
}

#[test]
fn a_floating_joint_begins_at_its_origin() {
    let files = robot(&[
        joint("free", "floating", "base", "ball", "<origin xyz='1 2 3' rpy='0.1 0.2 0.3'/>"),
        link("ball", 2.0, "0 0 0", [0.1, 0.2, 0.25]),
    ]);
    let bounds = nominal(&files.model(GRAVITY));
    assert!(distance_from(&bounds.times, curve(&bounds, "free_x"), |_| 1.0) < 1e-9);
    assert!(distance_from(&bounds.times, curve(&bounds, "free_z"), |t| 3.0 - 9.81 / 2.0 * t * t) < 1e-9);
}

#[test]
fn a_sliding_joint_is_damped_and_pushes_back() {
    // Two carriages without gravity: m₂ moves against m₁, both free along x; their relative velocity dies away with
    // d (1/m₁ + 1/m₂), and their momentum stays.
    let files = robot(&[
        joint("first", "prismatic", "base", "one", "<origin rpy='0 0 0.7'/>"),
        link("one", 2.0, "0 0 0", [0.1; 3]),
        joint("second", "prismatic", "one", "two", "<origin rpy='0 0 3.141592653589793'/><dynamics damping='3'/>"),
        link("two", 1.0, "0 0 0", [0.1; 3]),
    ]);
    let text = "initial: { second.velocity: 1, first.velocity: 0 }\noutputs: { relative: second.velocity, first: first.velocity }";
    let bounds = nominal(&files.model(text));
    let rate = 3.0 * (1.0 / 2.0 + 1.0);
    assert!(distance_from(&bounds.times, curve(&bounds, "relative"), |t| (-rate * t).exp()) < 1e-5);
    // Momentum: 2 v₁ + 1 (v₁ − u) = −1, as the second's axis points backwards.
    let first = |t: f64| ((-rate * t).exp() - 1.0) / 3.0;
    assert!(distance_from(&bounds.times, curve(&bounds, "first"), first) < 1e-5);
}

#[test]
fn a_planar_joint_slides_down_its_plane() {
    let tilt = 0.5_f64;
    let files = robot(&[
        joint("plane", "planar", "base", "puck", &format!("<origin xyz='0 0 1' rpy='0 {tilt} 0'/><axis xyz='0 0 1'/>")),
        link("puck", 2.0, "0 0 0", [0.1; 3]),
    ]);
    let bounds = nominal(&files.model(GRAVITY));
    let fallen = |t: f64| 1.0 - 9.81 * tilt.sin().powi(2) * t * t / 2.0;
    let error = distance_from(&bounds.times, curve(&bounds, "plane_z"), fallen);
    assert!(error < 1e-6, "{error}");
}

#[test]
fn an_arm_lies_on_its_limit() {
    // It has come to rest on the stop, which carries the weight's torque.
    let limit = "<axis xyz='0 -1 0'/><limit lower='-0.2' upper='1' effort='1' velocity='1'/><dynamics damping='20'/>";
    let files = robot(&[joint("hinge", "revolute", "base", "arm", limit), link("arm", 2.0, "0.5 0 0", [0.05; 3])]);
    let text = "limits: { impact: { stiffness: 1e5, exponent: 1 } }
effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }
initial: { hinge.angle: -0.2 }
outputs: { angle: hinge.angle, stop: hinge.limit.torque }";
    let bounds = nominal(&files.model(text).duration(2.0));
    let [angle, torque] = ["angle", "stop"].map(|name| *curve(&bounds, name).last().unwrap());
    let expected = 2.0 * 9.81 * 0.5 * angle.cos();
    assert!((torque - expected).abs() < 1e-6 * expected, "{torque} instead of {expected} N m");
}

#[test]
fn a_mimic_follows() {
    let files = robot(&[
        joint("lead", "revolute", "base", "a", "<axis xyz='0 1 0'/>"),
        link("a", 1.0, "0.3 0 0", [0.1; 3]),
        joint(
            "turn",
            "continuous",
            "base",
            "b",
            "<axis xyz='0 1 0'/><mimic joint='lead' multiplier='-2' offset='0.3'/>",
        ),
        link("b", 1.0, "0 0 0", [0.1; 3]),
        joint("slide", "prismatic", "base", "c", "<axis xyz='0 1 0'/><mimic joint='lead' multiplier='0.1'/>"),
        link("c", 1.0, "0 0 0", [0.1; 3]),
    ]);
    let bounds = nominal(&files.model(GRAVITY));
    let [lead, turn, slide] = ["lead", "turn", "slide"].map(|name| curve(&bounds, name));
    assert!(lead[row(&bounds, 0.5)] > 0.1, "it moves");
    assert!(largest(lead.iter().zip(turn).map(|(lead, turn)| turn - (-2.0 * lead + 0.3))) < 1e-9);
    assert!(largest(lead.iter().zip(slide).map(|(lead, slide)| slide - 0.1 * lead)) < 1e-9);
}

#[test]
fn friction_exists_only_if_the_file_has_it() {
    let parts = |details: &str| [joint("hinge", "revolute", "base", "a", details), link("a", 1.0, "0 0 0", [0.1; 3])];
    let frictionless = robot(&parts("")).model("");
    assert!(frictionless.study().description().effects.is_empty());
    let files = robot(&parts("<dynamics friction='0.5'/>"));
    let description = files.model("initial: { hinge.angular_velocity: 4 }");
    let study = description.study();
    let effects = study.description().effects.iter();
    let names: Vec<(&str, &str)> = effects.map(|own| (own.name.as_str(), own.kind.keyword())).collect();
    assert_eq!(names, [("hinge.friction", "joint_friction")]);
    // ω̇ = −(f/J) ω/s, s = √(ω² + v₀²): s − v₀ log((v₀ + s)/ω) falls by f/J a second. The remaining error is the
    // scheme's own of a spin, of second order.
    let of_speed = |omega: f64| {
        let slow = 0.05;
        let s = omega.hypot(slow);
        s - slow * ((slow + s) / omega).ln()
    };
    let error = |h: f64| {
        let bounds = nominal(&description.clone().observing(&["hinge.angular_velocity"]).step(h));
        let falls: Vec<f64> = bounds.outputs[0].nominal.iter().map(|&omega| of_speed(omega)).collect();
        distance_from(&bounds.times, &falls, |t| of_speed(4.0) - 5.0 * t)
    };
    let (coarse, fine) = (error(1e-3), error(5e-4));
    assert!((order(coarse, fine) - 2.0).abs() < 0.1 && fine < 2e-6, "{coarse} {fine}");
}

/// A formula of a documentation page as model files write it.
fn from_page(formula: &str) -> String {
    let written = [("−", "-"), ("·", "*"), ("√", "sqrt"), ("²", "^2"), ("v₀", "v0")];
    written.iter().fold(formula.to_owned(), |text, (from, to)| text.replace(from, to))
}

/// Friction in a robot is the guide's formula with the guide's numbers, written as a torque and as a force.
#[test]
fn friction_is_the_documented_formula() {
    let page = include_str!("../../docs/guides/urdf.md");
    let row = page.lines().find(|line| line.starts_with("| `friction` |")).unwrap();
    let law = row.split('|').nth(2).unwrap();
    let (formula, numbers) = law.split_once(", v₀ = ").unwrap();
    let mut numbers = numbers.split([' ', ';']).filter_map(|word| word.parse::<f64>().ok());
    for (kind, rate, inertia) in [("revolute", "angular_velocity", 0.02), ("prismatic", "velocity", 0.5)] {
        let v0 = numbers.next().unwrap();
        let files = |dynamics: &str| {
            robot(&[
                link("arm", 0.5, "0 0 0", [0.02; 3]),
                joint(
                    "hinge",
                    kind,
                    "base",
                    "arm",
                    &format!("<axis xyz='0 0 1'/><limit lower='-3' upper='3' effort='1' velocity='1'/>{dynamics}"),
                ),
            ])
        };
        // It starts at some times v₀, and friction takes most of that in the half second of the run.
        let start = format!("initial: {{ hinge.{rate}: {} }}\noutputs: {{ v: hinge.{rate} }}", 5.0 * v0);
        let friction = 9.0 * v0 * inertia;
        let law = format!("({})", from_page(formula.trim()))
            .replace('f', &friction.to_string())
            .replace("v0", &v0.to_string())
            .replace('v', &format!("hinge.{rate}"));
        let acts = match kind {
            "revolute" => format!("torque: {{ on: hinge, value: \"{law}\" }}"),
            _ => format!("force: {{ on: arm, value: [0, 0, \"{law}\"] }}"),
        };
        let own = nominal(&files(&format!("<dynamics friction='{friction}'/>")).model(&start));
        let written = nominal(&files("").model(&format!("{start}\neffects: {{ f: {{ {acts} }} }}")));
        let slowed = curve(&own, "v").last().unwrap() / (5.0 * v0);
        assert!(slowed < 0.9, "{kind}: friction hardly acts: {slowed}");
        assert!(largest_distance(curve(&own, "v"), curve(&written, "v")) < 1e-12 * v0.max(1.0), "{kind}");
    }
}

fn largest_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
