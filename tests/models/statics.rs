//! Equilibria, against closed forms and against the motion that settles there.

use std::path::Path;

use mbint::results::{Bounds, Method, Verdict};

use crate::common::{Subject, load, nominal, ran, read, refused, run, study_of};

/// A model of the guide.
pub fn example(name: &str) -> Subject {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples").join(name))
}

/// The first nominal value of an output.
#[track_caller]
pub fn value(bounds: &Bounds, name: &str) -> f64 {
    let names: Vec<&str> = bounds.outputs.iter().map(|output| output.name.as_str()).collect();
    let output = bounds.outputs.iter().find(|output| output.name == name);
    output.unwrap_or_else(|| panic!("no output {name} among {names:?}")).nominal[0]
}

/// Lower and upper bound and error of an output in the first row.
#[track_caller]
pub fn ends(bounds: &Bounds, name: &str, method: Method) -> [f64; 3] {
    let output = bounds.outputs.iter().find(|output| output.name == name).unwrap();
    let band = output.bands.iter().find(|band| band.method == method).unwrap();
    [band.lower[0], band.upper[0], band.error.total[0]]
}

#[track_caller]
pub fn close(found: f64, wanted: f64, tolerance: f64) {
    assert!((found - wanted).abs() <= tolerance * wanted.abs().max(1e-12), "{found} instead of {wanted}");
}

fn why_not(text: &str) -> String {
    refused(text)
}

/// A bar on a hinge with a torsional spring, its weight m g at the distance c: k θ = −m g c cos θ.
fn hinged(formulation: &str, stiffness: &str, guess: f64) -> String {
    format!(
        "
analysis: statics
parameters: {{ k: {stiffness} }}
bodies: {{ bar: {{ mass: 3, inertia: 0.25, points: {{ hinge: [-0.4, 0] }} }} }}
joints: {{ hinge: {{ revolute: [ground, bar.hinge] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  spring: {{ torsional_spring_damper: {{ on: hinge, stiffness: k, damping: 0.1 }} }}
guess: {{ bar.angle: {guess} }}
outputs: {{ angle: bar.angle, fx: hinge.force.x, fy: hinge.force.y }}
simulation: {{ duration: 1, formulation: {formulation} }}
bounds: {{ chebyshev: {{ order: 7 }}, taylor: {{ order: 4 }}, scan: {{ points: 12 }} }}
"
    )
}

/// By bisection.
fn angle_of(k: f64) -> f64 {
    let [mut low, mut high] = [-1.5, 0.0];
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let torque = k * middle + 3.0 * 9.81 * 0.4 * f64::cos(middle);
        if torque < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn a_hinged_bar_rests_where_the_torques_are_equal() {
    for formulation in ["absolute", "joint"] {
        let bounds = run(&read(&hinged(formulation, "{ value: 20, tolerance: 10% }", 0.0)));
        close(value(&bounds, "angle"), angle_of(20.0), 1e-12);
        assert!(value(&bounds, "fx").abs() < 1e-10);
        close(value(&bounds, "fy").abs(), 3.0 * 9.81, 1e-12);
        // k − m g c sin θ over the inertia about the hinge.
        let stiffness = 20.0 - 3.0 * 9.81 * 0.4 * f64::sin(angle_of(20.0));
        close(value(&bounds, "stability"), stiffness / (0.25 + 3.0 * 0.16), 1e-10);
        for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
            let [lower, upper, error] = ends(&bounds, "angle", method);
            assert!((lower - angle_of(18.0)).abs() <= error + 1e-12, "{formulation} {method:?} {lower} {error}");
            assert!((upper - angle_of(22.0)).abs() <= error + 1e-12, "{formulation} {method:?} {upper} {error}");
            assert!(error < 1e-4, "{method:?} {error}");
        }
    }
}

#[test]
fn guess_selects_the_equilibrium_and_its_stability() {
    // Upright, with a spring too weak to hold it: π/2 is not quite it, since the spring pulls.
    let text = hinged("absolute", "0.5", 1.55);
    let bounds = nominal(&read(&text));
    let angle = value(&bounds, "angle");
    close(0.5 * angle, -3.0 * 9.81 * 0.4 * angle.cos(), 1e-9);
    assert!((angle - 1.6).abs() < 0.1, "{angle}");
    assert!(value(&bounds, "stability") < 0.0);
    // From far above it falls to the stable one.
    let bounds = nominal(&read(&hinged("absolute", "0.5", 0.9)));
    assert!(value(&bounds, "stability") > 0.0);
    let angle = value(&bounds, "angle");
    close(0.5 * angle, -3.0 * 9.81 * 0.4 * angle.cos(), 1e-9);
}

#[test]
fn missing_equilibrium_is_reported_with_its_force() {
    let text = "
analysis: statics
bodies: { ball: { mass: 2, inertia: 1 } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
outputs: { y: ball.y }
";
    let message = why_not(text);
    assert!(
        message.contains("no equilibrium") && message.contains("1.962e1 N") && message.contains("`ball.y`"),
        "{message}"
    );
    assert!(message.contains("no force changes as it moves"), "{message}");
}

#[test]
fn indifferent_coordinates_are_named() {
    let text = "
analysis: statics
bodies: { wheel: { mass: 2, inertia: 1 } }
joints: { axle: { revolute: [ground, wheel] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
outputs: { angle: wheel.angle, fy: axle.force.y }
simulation: { duration: 1, formulation: absolute }
";
    let (bounds, summary) = ran(study_of(text));
    assert_eq!(summary.analysis.unwrap().indifferent, ["wheel.angle"]);
    close(value(&bounds, "fy").abs(), 2.0 * 9.81, 1e-12);
}

#[test]
fn a_motion_from_an_equilibrium_stays_there() {
    for formulation in ["absolute", "joint"] {
        let text = hinged(formulation, "{ value: 20, tolerance: 10% }", 0.0)
            .replace("analysis: statics", "initial: equilibrium")
            .replace("duration: 1,", "duration: 0.5, step: 1e-3, output_step: 0.1,");
        let bounds = run(&read(&text));
        let angle = &bounds.outputs[0];
        for row in 0..bounds.times.len() {
            close(angle.nominal[row], angle_of(20.0), 1e-9);
            for band in &angle.bands {
                let error = band.error.total[row] + 1e-9;
                assert!((band.lower[row] - angle_of(18.0)).abs() <= error, "{formulation} {:?} {row}", band.method);
                assert!((band.upper[row] - angle_of(22.0)).abs() <= error, "{formulation} {:?} {row}", band.method);
            }
        }
    }
}

#[test]
fn closed_loop_rests_equally_in_plane_and_space() {
    // A plate on two links, pulled sideways by a spring: the same in both.
    let model = |space: &str| {
        format!(
            "
space: {space}
analysis: statics
bodies:
  ground: {{ points: {{ a: [0, 0], c: [1, 0], wall: [2, -0.5] }} }}
  left: {{ mass: 1, inertia: 0.02, points: {{ a: [0, 0.25], b: [0, -0.25] }} }}
  right: {{ mass: 1, inertia: 0.02, points: {{ a: [0, 0.25], b: [0, -0.25] }} }}
  plate: {{ mass: 4, inertia: 0.3, points: {{ a: [-0.5, 0], b: [0.5, 0] }} }}
joints:
  a: {{ revolute: [ground.a, left.a] }}
  c: {{ revolute: [ground.c, right.a] }}
  b: {{ revolute: [left.b, plate.a] }}
  d: {{ revolute: [right.b, plate.b] }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81{}] }} }}
  pull: {{ spring_damper: {{ between: [ground.wall, plate.b], stiffness: 40, damping: 1, free_length: 0.2 }} }}
guess: {{ plate.x: 0.5, plate.y: -0.5{} }}
outputs: {{ x: plate.x, y: plate.y, pull: pull.force }}
",
            if space == "spatial" { ", 0" } else { "" },
            // In the plane the links may cross.
            if space == "spatial" { "" } else { ", left.angle: 0, right.angle: 0, plate.angle: 0" },
        )
    };
    let [plane, spatial] = ["planar", "spatial"].map(|space| nominal(&read(&model(space))));
    for name in ["x", "y", "pull", "stability"] {
        close(value(&spatial, name), value(&plane, name), 1e-8);
    }
    // Horizontal forces: the links carry the spring's pull; by virtual work of the one freedom φ of both links.
    let (x, y) = (value(&plane, "x"), value(&plane, "y"));
    let sine = (x - 0.5) / 0.5;
    let (bx, by) = (x + 0.5, y);
    let length = ((2.0 - bx).powi(2) + (-0.5 - by).powi(2)).sqrt();
    let force = 40.0 * (length - 0.2) / length;
    let cosine = (1.0 - sine * sine).sqrt();
    let work = force * ((2.0 - bx) * 0.5 * cosine + (-0.5 - by) * 0.5 * sine) - 9.81 * (4.0 + 1.0) * 0.5 * sine;
    assert!(work.abs() < 1e-8, "{work}");
}

#[test]
fn example_of_the_guide_has_its_values() {
    let bounds = run(&example("statics.yaml"));
    for (name, wanted) in [("angle", 45.531_592), ("spring", 9.175_084)] {
        close(value(&bounds, name), wanted, 1e-6);
    }
    let page = include_str!("../../docs/guides/statics.md");
    assert!(page.contains(include_str!("../../docs/examples/statics.yaml")), "the page shows the example");
}

#[test]
fn margins_of_an_equilibrium_match_closed_forms() {
    let text = format!(
        "{}requirements: {{ high: angle >= -0.5 rad, low: {{ output: angle, max: -0.35 rad }} }}\n",
        hinged("joint", "{ value: 30, tolerance: 10% }", -0.3)
    );
    let (bounds, summary) = ran(study_of(&text));
    let names: Vec<&str> = bounds.outputs.iter().map(|output| output.name.as_str()).collect();
    assert_eq!(names, ["angle", "fx", "fy", "stability"]);
    assert_eq!(summary.analysis.unwrap().values.len(), 4);
    let [high, low] = &summary.requirements[..] else { panic!() };
    assert_eq!((high.verdict, low.verdict), (Verdict::Holds, Verdict::Violated));
    assert!((high.margin - (angle_of(27.0) + 0.5)).abs() <= high.error + 1e-9, "{} {}", high.margin, high.error);
    assert!(high.error < 1e-5, "{}", high.error);
    let nearest = low.nearest.as_ref().unwrap();
    assert!((nearest.margin - (-0.35 - angle_of(33.0))).abs() < 1e-9, "{}", nearest.margin);
}

/// Many parameters of a body at rest, or moved by motors, take as few simulations as those of a motion. The ends of a
/// sum are the sums of ends; of the product, in logarithms, too.
#[test]
fn many_parameters_take_few_simulations() {
    let count = 12;
    let names: Vec<String> = (0..count).map(|i| format!("p{i}")).collect();
    let parameters = names.iter().map(|name| format!("{name}: {{ value: 2, tolerance: 1% }}")).collect::<Vec<_>>();
    let sum = names.iter().enumerate().map(|(i, name)| format!("{} {name}", if i % 3 == 0 { "-" } else { "+" }));
    let (parameters, sum) = (parameters.join(", "), sum.collect::<Vec<_>>().join(" "));
    // 8 signs are positive and 4 negative: 8 ± 0.24.
    for analysis in ["kinematics", "statics"] {
        let joint = format!("joints: {{ e: {{ equation: \"b.x = 0 {sum}\" }} }}");
        let spring = format!("effects: {{ f: {{ force: {{ on: b, value: [\"0 {sum} - 1 N/m*b.x\", 0] }} }} }}");
        let element = if analysis == "statics" { spring } else { joint };
        let text = format!(
            "
analysis: {analysis}
parameters: {{ {parameters} }}
bodies: {{ b: {{ mass: 1, coordinates: [x] }} }}
{element}
outputs: {{ gap: b.x }}
requirements: {{ open: gap >= 7.7 }}
simulation: {{ duration: 1, output_step: 1 }}
"
        );
        let (bounds, summary) = ran(study_of(&text));
        let [lower, upper, error] = ends(&bounds, "gap", Method::Chebyshev);
        assert!(
            (lower - 7.76).abs() <= error + 1e-9 && (upper - 8.24).abs() <= error + 1e-9,
            "{lower} {upper} {error}"
        );
        assert!(error < 1e-3, "{error}");
        assert_eq!(summary.requirements[0].verdict, Verdict::Holds, "{analysis}");
        let simulations: usize = summary.methods.iter().map(|method| method.simulations).sum();
        assert!(simulations < 500, "{analysis}: {simulations}");
        // Every parameter has an equal part of the spread.
        let contributions = &bounds.contributions[0];
        assert_eq!(contributions.len(), count);
        for own in contributions {
            close(own.main[0], 1.0 / count as f64, 1e-6);
        }
    }
}
