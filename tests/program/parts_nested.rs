//! Instances within instances that are placed and mirrored, against the same mechanisms written by hand.

use std::fs;
use std::path::Path;

use mbint::Model;
use mbint::results::{Bounds, Summary};
use nalgebra::{Matrix2, Matrix3, Quaternion, Rotation2, Rotation3, UnitQuaternion, Vector2, Vector3};

#[track_caller]
fn read(text: &str, set: &[&str]) -> Model {
    let model = Model::from_yaml_str("test.yaml", text);
    let model = set.iter().fold(model, |model, setting| {
        let (name, value) = setting.split_once('=').unwrap();
        model?.with(name, value)
    });
    model.unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn run(model: &Model) -> (Bounds, Summary) {
    let result = model.study().allow_costly().run().unwrap();
    (result.bounds().clone(), result.summary().clone())
}

#[track_caller]
fn bounds(text: &str) -> Bounds {
    run(&read(text, &[])).0
}

/// The output's nominal course and its bounds.
fn courses(bounds: &Bounds, output: &str) -> [Vec<f64>; 3] {
    let found = bounds.outputs.iter().find(|found| found.name == output).unwrap();
    [found.nominal.clone(), found.bands[0].lower.clone(), found.bands[0].upper.clone()]
}

/// Compares all outputs of two models.
#[track_caller]
fn same(first: &Bounds, second: &Bounds) {
    assert_eq!(first.outputs.len(), second.outputs.len());
    for output in &first.outputs {
        let [one, other] = [first, second].map(|bounds| courses(bounds, &output.name));
        let size = one[0].iter().fold(1e-3, |size: f64, value| size.max(value.abs()));
        for (value, other) in one.iter().flatten().zip(other.iter().flatten()) {
            assert!((value - other).abs() < 1e-9 * size, "{}: {value} and {other}", output.name);
        }
    }
}

const ASKED: &str = "
simulation: { duration: 0.3, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 3 } }
";

/// A suspension of the plane that uses all features of an assembly: its own coordinates, directions, and quantities
/// that effects measure.
const CORNER: &str = r#"
assemblies:
  corner:
    shared: [l]
    parameters: { l: 0.3 m ± 1% }
    bodies:
      ground: { points: { A: [0.1, 0.2], D: [0.5, 0.3] } }
      bar: { mass: 2, inertia: 2 kg * l^2/12, center_of_mass: [0.01, 0.02], points: { A: [-l/2, 0.01], B: [l/2, 0.03] } }
      slide: { mass: 1, inertia: 0.01 }
      bob: { mass: 0.5, coordinates: [x, y], points: { P: [0.1, 0.02] } }
    joints:
      pin: { revolute: [ground.A, bar.A] }
      guide: { prismatic: { between: [ground, slide], axis: [1, 0.4], angle: 0.2 } }
    effects:
      pull: { spring_damper: { between: [bar.B, slide], stiffness: 200, free_length: 0.2 } }
      along: { spring_damper: { between: [ground.D, bar.B], along: x, stiffness: 50, free_length: 0.1 } }
      coil: { torsional_spring_damper: { on: pin, stiffness: 3, free_angle: 0.5, torque: "0.1 N*m*s/rad*coil.rate" } }
      push: { force: { on: bar.B, value: ["1 N + 1 N/m*bar.x", "3 N - 2 N*s/m*bar.B.vy"] } }
      hold: { force: { on: bob, value: ["-20 N/m*bob.x - 2 N*s/m*bob.vx", "-30 N/m*(bob.y - 0.1 m)"] } }
      rope: { spring_damper: { between: [bob.P, slide], stiffness: 10 } }
      turn: { torque: { on: bar, value: "-0.5 N*m/rad*bar.angle + 0.1 N*m*s/rad*pin.angular_velocity" } }
      motor: { pid: { on: pin, target: 0.3*sin(3*t), proportional: 1, integral: 2, derivative: 0.1 } }
      nudge: { torque: { on: pin, value: 0.3*motor.integral } }
      wind: { drag: { on: slide, linear: 0.5, wind: [1, 2] } }
    initial: { pin.angle: 0.4, pin.angular_velocity: -1, slide.x: 0.4, slide.y: 0.16, slide.vx: 0.1, slide.vy: 0.04, bob.x: 0.1, bob.y: 0.2, bob.vx: 0, bob.vy: 0.3 }
    ports: { tip: { on: bar, position: [l/2, 0.05] } }
"#;

/// Placement of an assembly: r = g + A s.
#[derive(Clone, Copy)]
struct Planar {
    g: Vector2<f64>,
    a: Matrix2<f64>,
}

impl Planar {
    fn new(g: [f64; 2], degrees: f64, signs: [f64; 2]) -> Self {
        let turned = Rotation2::new(degrees.to_radians()).into_inner();
        Self { g: g.into(), a: turned * Matrix2::from_diagonal(&signs.into()) }
    }

    fn then(self, inner: Self) -> Self {
        Self { g: self.g + self.a * inner.g, a: self.a * inner.a }
    }
}

/// A corner by hand, mirrored across its y where it is, with the lines of bodies, points of the ground, joints, effects
/// and starts.
fn corner(name: &str, at: Planar) -> [String; 5] {
    let s = at.a.determinant().round();
    let phi = at.a[(1, 0)].atan2(at.a[(0, 0)]);
    let (sin, cos) = phi.sin_cos();
    let turned = |x: f64, y: f64| at.a * Vector2::new(x, y);
    let list = |v: Vector2<f64>| format!("[{}, {}]", v[0], v[1]);
    let place = |x: f64, y: f64| at.g + turned(x, y);
    // Coordinates of a point in the corner's frame.
    let x = |of: &str| format!("(({cos})*({of}.x - ({})) + ({sin})*({of}.y - ({})))", at.g[0], at.g[1]);
    let y = |of: &str| format!("(({s})*(({cos})*({of}.y - ({})) - ({sin})*({of}.x - ({}))))", at.g[1], at.g[0]);
    let vx = |of: &str| format!("(({cos})*{of}.vx + ({sin})*{of}.vy)");
    let vy = |of: &str| format!("(({s})*(({cos})*{of}.vy - ({sin})*{of}.vx))");
    let force = |fx: String, fy: String| {
        format!(r#"["({cos})*({fx}) - ({sin})*({s})*({fy})", "({sin})*({fx}) + ({cos})*({s})*({fy})"]"#)
    };
    let (bar, bob) = (format!("{name}_bar"), format!("{name}_bob"));
    let push = force(format!("1 N + 1 N/m*{}", x(&bar)), format!("3 N - 2 N*s/m*{}", vy(&format!("{bar}.B"))));
    let hold = force(format!("-20 N/m*{} - 2 N*s/m*{}", x(&bob), vx(&bob)), format!("-30 N/m*({} - 0.1 m)", y(&bob)));
    let bodies = format!(
        "  {name}_bar: {{ mass: 2, inertia: 2 kg * l^2/12, center_of_mass: [0.01, {s}*0.02], points: {{ A: [-l/2, {s}*0.01], B: [l/2, {s}*0.03], tip: [l/2, {s}*0.05] }} }}
  {name}_slide: {{ mass: 1, inertia: 0.01 }}
  {name}_bob: {{ mass: 0.5, coordinates: [x, y], held: {{ angle: {phi} }}, points: {{ P: [0.1, {s}*0.02] }} }}
"
    );
    let points =
        format!("{name}_G: {}, {name}_A: {}, {name}_D: {}, ", list(at.g), list(place(0.1, 0.2)), list(place(0.5, 0.3)));
    let joints = format!(
        "  {name}_pin: {{ revolute: [ground.{name}_A, {name}_bar.A] }}
  {name}_guide: {{ prismatic: {{ between: [ground.{name}_G, {name}_slide], axis: {}, angle: {} }} }}
",
        list(turned(1.0, 0.4)),
        phi + s * 0.2
    );
    let effects = format!(
        r#"  {name}_pull: {{ spring_damper: {{ between: [{name}_bar.B, {name}_slide], stiffness: 200, free_length: 0.2 }} }}
  {name}_along: {{ spring_damper: {{ between: [ground.{name}_D, {name}_bar.B], along: {}, stiffness: 50, free_length: 0.1 }} }}
  {name}_coil: {{ torsional_spring_damper: {{ on: {name}_pin, stiffness: 3, free_angle: {}, torque: "0.1 N*m*s/rad*{name}_coil.rate" }} }}
  {name}_push: {{ force: {{ on: {name}_bar.B, value: {push} }} }}
  {name}_hold: {{ force: {{ on: {name}_bob, value: {hold} }} }}
  {name}_rope: {{ spring_damper: {{ between: [{name}_bob.P, {name}_slide], stiffness: 10 }} }}
  {name}_turn: {{ torque: {{ on: {name}_bar, value: "-0.5 N*m/rad*({name}_bar.angle - ({phi})) + 0.1 N*m*s/rad*{name}_pin.angular_velocity" }} }}
  {name}_motor: {{ pid: {{ on: {name}_pin, target: "{phi} + ({s})*0.3*sin(3*t)", proportional: 1, integral: 2, derivative: 0.1 }} }}
  {name}_nudge: {{ torque: {{ on: {name}_pin, value: 0.3*{name}_motor.integral }} }}
  {name}_wind: {{ drag: {{ on: {name}_slide, linear: 0.5, wind: {} }} }}
"#,
        list(turned(1.0, 0.0)),
        phi + s * 0.5,
        list(turned(1.0, 2.0))
    );
    let ([slide, v], [bob, w]) = ([place(0.4, 0.16), turned(0.1, 0.04)], [place(0.1, 0.2), turned(0.0, 0.3)]);
    let starts = format!(
        "{name}_pin.angle: {}, {name}_pin.angular_velocity: {}, {name}_slide.x: {}, {name}_slide.y: {}, {name}_slide.vx: {}, {name}_slide.vy: {}, {name}_bob.x: {}, {name}_bob.y: {}, {name}_bob.vx: {}, {name}_bob.vy: {}, ",
        phi + s * 0.4,
        -s,
        slide[0],
        slide[1],
        v[0],
        v[1],
        bob[0],
        bob[1],
        w[0],
        w[1]
    );
    [bodies, points, joints, effects, starts]
}

/// Outputs of four corners, whose names end so.
fn outputs(names: [&str; 4], part: impl Fn(&str, &str) -> String) -> String {
    let of = |(number, name): (usize, &&str)| {
        let p = |of: &str| part(name, of);
        format!(
            "x{number}: {}.x, y{number}: {}.y, w{number}: {}.angular_velocity, i{number}: {}.integral, a{number}: {}.length, b{number}: {}.x, s{number}: {}.y, ",
            p("tip"),
            p("tip"),
            p("pin"),
            p("motor"),
            p("along"),
            p("bob"),
            p("slide")
        )
    };
    names.iter().enumerate().map(of).collect()
}

/// Axles of two corners, one the other's image, in a train that is mirrored as a whole: left corners of the axle behind
/// are mirrored twice.
#[test]
fn three_levels_are_the_mechanism_written_by_hand() {
    let nested = format!(
        "{CORNER}
  axle:
    instances:
      left: {{ of: corner, at: {{ position: [0.2, 0.7], angle: 20 deg }} }}
      right: {{ of: corner, at: {{ position: [0.2, -0.7], angle: -20 deg }}, mirror: y }}
    effects: {{ tie: {{ spring_damper: {{ between: [left.tip, right.tip], stiffness: 20 }} }} }}
  train:
    instances:
      fore: {{ of: axle }}
      aft: {{ of: axle, at: {{ position: [-2, 0.3], angle: 15 deg }}, mirror: x }}
instances: {{ whole: {{ of: train, at: {{ position: [1, 2], angle: 30 deg }}, mirror: y }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [1, -9.81] }} }} }}
outputs: {{ {} }}
{ASKED}",
        outputs(["fore.left", "fore.right", "aft.left", "aft.right"], |name, of| format!("whole.{name}.{of}"))
    );
    let whole = Planar::new([1.0, 2.0], 30.0, [1.0, -1.0]);
    let aft = whole.then(Planar::new([-2.0, 0.3], 15.0, [-1.0, 1.0]));
    let left = Planar::new([0.2, 0.7], 20.0, [1.0, 1.0]);
    let right = Planar::new([0.2, -0.7], -20.0, [1.0, -1.0]);
    let corners = [
        corner("c0", whole.then(left)),
        corner("c1", whole.then(right)),
        corner("c2", aft.then(left)),
        corner("c3", aft.then(right)),
    ];
    let [bodies, points, joints, effects, starts] =
        [0, 1, 2, 3, 4].map(|part| corners.each_ref().map(|c| c[part].as_str()).concat());
    let by_hand = format!(
        "parameters: {{ l: 0.3 m ± 1% }}
bodies:
  ground: {{ points: {{ {points} }} }}
{bodies}joints:
{joints}effects:
{effects}  tie_0: {{ spring_damper: {{ between: [c0_bar.tip, c1_bar.tip], stiffness: 20 }} }}
  tie_1: {{ spring_damper: {{ between: [c2_bar.tip, c3_bar.tip], stiffness: 20 }} }}
  weight: {{ gravity: {{ acceleration: [1, -9.81] }} }}
initial: {{ {starts} }}
outputs: {{ {} }}
{ASKED}",
        outputs(["c0", "c1", "c2", "c3"], |name, of| if of == "tip" {
            format!("{name}_bar.tip")
        } else {
            format!("{name}_{of}")
        })
    );
    same(&bounds(&nested), &bounds(&by_hand));
}

/// An arm in space, and a body that flies and is tied by a spring.
const ARM: &str = r#"
assemblies:
  arm:
    shared: [l]
    parameters: { l: 0.3 m ± 1% }
    bodies:
      base: { mass: 2, inertia: { xx: 0.02, yy: 0.03, zz: 0.04, xy: 0.002, yz: -0.003, xz: 0.001 }, center_of_mass: [0.02, 0.03, 0.01],
              points: { A: [-0.1, 0.02, 0.03], B: { position: [l, 0.05, -0.02], rotation: { rpy: [0.3, -0.4, 0.5] } } } }
      fore: { mass: 1, inertia: [0.01, 0.02, 0.015], points: { B: { position: [-0.1, 0, 0.02], rotation: { axis: [1, 2, -1], angle: 0.7 } } } }
      puck: { mass: 1, inertia: [0.01, 0.02, 0.015], points: { P: [0.1, 0.05, 0.02] } }
    joints:
      shoulder: { revolute: { between: [ground, base.A], axis: [0.3, 1, 0.5] } }
      elbow: { revolute: [base.B, fore.B] }
    effects:
      drive: { servo: { on: elbow, target: 0.5*sin(4*t), proportional: 3, derivative: 0.2 } }
      brake: { torque: { on: fore, value: [0.1, 0.2, -0.3] } }
      push: { force: { on: base.B, value: ["-2 N/m*base.x", "0.3 N*s/m*base.B.vz", "0.1 N*s/rad*fore.omega.y"] } }
      hold: { spring_damper: { between: [ground, puck.P], stiffness: 30 } }
    initial:
      { shoulder.angle: 0.2, shoulder.angular_velocity: 1, elbow.angle: -0.3, elbow.angular_velocity: 0,
        puck.x: 0.3, puck.y: 0.1, puck.z: -0.2, puck.vx: 0.1, puck.vy: -0.2, puck.vz: 0.3, puck.orientation: { rpy: [0.2, 0.3, 0.4] }, puck.omega: [1, -2, 0.5] }
    ports: { hand: { on: fore, position: [0.05, 0.1, 0.02] } }
"#;

#[derive(Clone, Copy)]
struct Spatial {
    g: Vector3<f64>,
    a: Matrix3<f64>,
}

impl Spatial {
    fn new(g: [f64; 3], turned: Rotation3<f64>, signs: [f64; 3]) -> Self {
        Self { g: g.into(), a: turned.into_inner() * Matrix3::from_diagonal(&signs.into()) }
    }

    fn then(self, inner: Self) -> Self {
        Self { g: self.g + self.a * inner.g, a: self.a * inner.a }
    }
}

/// An arm by hand, mirrored across its z where it is.
fn arm(name: &str, at: Spatial) -> [String; 5] {
    let s = at.a.determinant().round();
    let signs = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, s));
    let r = at.a * signs;
    // For axial vectors.
    let axial = r * Matrix3::from_diagonal(&Vector3::new(s, s, 1.0));
    let list = |v: Vector3<f64>| format!("[{}, {}, {}]", v[0], v[1], v[2]);
    let frame = UnitQuaternion::from_matrix(&r);
    let quaternion = |q: UnitQuaternion<f64>| format!("[{}, {}, {}, {}]", q.w, q.i, q.j, q.k);
    let row = |m: &Matrix3<f64>, column: usize, of: [String; 3]| {
        format!(
            "(({})*({}) + ({})*({}) + ({})*({}))",
            m[(0, column)],
            of[0],
            m[(1, column)],
            of[1],
            m[(2, column)],
            of[2]
        )
    };
    let axes = ["x", "y", "z"];
    let base_x = row(&at.a, 0, [0, 1, 2].map(|axis| format!("{name}_base.{} - ({})", axes[axis], at.g[axis])));
    let speed_z = row(&at.a, 2, axes.map(|axis| format!("{name}_base.B.v{axis}")));
    let omega_y = row(&axial, 1, axes.map(|axis| format!("{name}_fore.omega.{axis}")));
    let parts = [format!("-2 N/m*{base_x}"), format!("0.3 N*s/m*{speed_z}"), format!("0.1 N*s/rad*{omega_y}")];
    let push = [0, 1, 2].map(|axis| {
        format!(
            "\"({})*({}) + ({})*({}) + ({})*({})\"",
            at.a[(axis, 0)],
            parts[0],
            at.a[(axis, 1)],
            parts[1],
            at.a[(axis, 2)],
            parts[2]
        )
    });
    let bodies = format!(
        "  {name}_base: {{ mass: 2, inertia: {{ xx: 0.02, yy: 0.03, zz: 0.04, xy: 0.002, yz: {s}*(-0.003), xz: {s}*0.001 }}, center_of_mass: [0.02, 0.03, {s}*0.01],
          points: {{ A: [-0.1, 0.02, {s}*0.03], B: {{ position: [l, 0.05, {s}*(-0.02)], rotation: {{ rpy: [{s}*0.3, {s}*(-0.4), 0.5] }} }} }} }}
  {name}_fore: {{ mass: 1, inertia: [0.01, 0.02, 0.015], points: {{ B: {{ position: [-0.1, 0, {s}*0.02], rotation: {{ axis: [{s}*1, {s}*2, -1], angle: 0.7 }} }}, hand: [0.05, 0.1, {s}*0.02] }} }}
  {name}_puck: {{ mass: 1, inertia: [0.01, 0.02, 0.015], points: {{ P: [0.1, 0.05, {s}*0.02] }} }}
"
    );
    let points =
        format!("{name}_G: {{ position: {}, rotation: {{ quaternion: {} }} }}, ", list(at.g), quaternion(frame));
    let joints = format!(
        "  {name}_shoulder: {{ revolute: {{ between: [ground.{name}_G, {name}_base.A], axis: [0.3, 1, {s}*0.5] }} }}
  {name}_elbow: {{ revolute: {{ between: [{name}_base.B, {name}_fore.B], axis: [0, 0, {s}] }} }}
"
    );
    let effects = format!(
        "  {name}_drive: {{ servo: {{ on: {name}_elbow, target: \"{s}*0.5*sin(4*t)\", proportional: 3, derivative: 0.2 }} }}
  {name}_brake: {{ torque: {{ on: {name}_fore, value: {} }} }}
  {name}_push: {{ force: {{ on: {name}_base.B, value: [{}] }} }}
  {name}_hold: {{ spring_damper: {{ between: [ground.{name}_G, {name}_puck.P], stiffness: 30 }} }}
",
        list(axial * Vector3::new(0.1, 0.2, -0.3)),
        push.join(", ")
    );
    let puck = at.g + at.a * Vector3::new(0.3, 0.1, -0.2);
    let speed = at.a * Vector3::new(0.1, -0.2, 0.3);
    let own = signs * Rotation3::from_euler_angles(0.2, 0.3, 0.4).into_inner() * signs;
    let starts = format!(
        "{name}_shoulder.angle: {}, {name}_shoulder.angular_velocity: {s}, {name}_elbow.angle: {}, {name}_elbow.angular_velocity: 0, \
         {name}_puck.x: {}, {name}_puck.y: {}, {name}_puck.z: {}, {name}_puck.vx: {}, {name}_puck.vy: {}, {name}_puck.vz: {}, \
         {name}_puck.orientation: {{ quaternion: {} }}, {name}_puck.omega: {}, ",
        0.2 * s,
        -0.3 * s,
        puck[0],
        puck[1],
        puck[2],
        speed[0],
        speed[1],
        speed[2],
        quaternion(frame * UnitQuaternion::from_matrix(&own)),
        list(axial * Vector3::new(1.0, -2.0, 0.5))
    );
    [bodies, points, joints, effects, starts]
}

#[test]
fn frames_in_space_compose() {
    let places = [
        "at: { position: [0.1, -0.2, 0.3], rotation: { rpy: [0.3, -0.4, 0.5] } }, mirror: y",
        "at: { position: [-1, 0, 0.5], rotation: { quaternion: [0.9, 0.1, -0.2, 0.3] } }",
        "mirror: z",
    ];
    let inner = [
        Spatial::new([0.1, -0.2, 0.3], Rotation3::from_euler_angles(0.3, -0.4, 0.5), [1.0, -1.0, 1.0]),
        Spatial::new(
            [-1.0, 0.0, 0.5],
            UnitQuaternion::from_quaternion(Quaternion::new(0.9, 0.1, -0.2, 0.3)).to_rotation_matrix(),
            [1.0; 3],
        ),
        Spatial::new([0.0; 3], Rotation3::identity(), [1.0, 1.0, -1.0]),
    ];
    let axis = nalgebra::Unit::new_normalize(Vector3::new(1.0, 2.0, -1.0));
    let outer = [
        (
            "at: { position: [1, 2, 3], rotation: { axis: [1, 2, -1], angle: 40 deg } }, mirror: x",
            Spatial::new([1.0, 2.0, 3.0], Rotation3::from_axis_angle(&axis, 40_f64.to_radians()), [-1.0, 1.0, 1.0]),
        ),
        (
            "at: { position: [0, 1, 0], angle: 25 deg }",
            Spatial::new(
                [0.0, 1.0, 0.0],
                Rotation3::from_axis_angle(&Vector3::z_axis(), 25_f64.to_radians()),
                [1.0; 3],
            ),
        ),
    ];
    for (index, outer) in outer {
        let outputs = |part: &dyn Fn(usize, &str, &str) -> String| -> String {
            let of = |number: usize| {
                let axes = ["x", "y", "z"].map(|axis| {
                    format!(
                        "h{axis}{number}: {}.{axis}, p{axis}{number}: {}.{axis}, ",
                        part(number, "fore", "hand"),
                        part(number, "puck", "P")
                    )
                });
                format!("{}w{number}: {}.angular_velocity, ", axes.concat(), part(number, "elbow", ""))
            };
            (0..3).map(of).collect()
        };
        let nested = format!(
            "{ARM}
  crew:
    instances: {{ a0: {{ of: arm, {} }}, a1: {{ of: arm, {} }}, a2: {{ of: arm, {} }} }}
instances: {{ all: {{ of: crew, {index} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [1, 2, -9.81] }} }} }}
outputs: {{ {} }}
{ASKED}",
            places[0],
            places[1],
            places[2],
            outputs(&|number, body, point| match point {
                "" => format!("all.a{number}.{body}"),
                "hand" => format!("all.a{number}.hand"),
                _ => format!("all.a{number}.{body}.{point}"),
            })
        );
        let arms = [0, 1, 2].map(|number| arm(&format!("a{number}"), outer.then(inner[number])));
        let [bodies, points, joints, effects, starts] =
            [0, 1, 2, 3, 4].map(|part| arms.each_ref().map(|arm| arm[part].as_str()).concat());
        let by_hand = format!(
            "parameters: {{ l: 0.3 m ± 1% }}
bodies:
  ground: {{ points: {{ {points} }} }}
{bodies}joints:
{joints}effects:
{effects}  weight: {{ gravity: {{ acceleration: [1, 2, -9.81] }} }}
initial: {{ {starts} }}
outputs: {{ {} }}
{ASKED}",
            outputs(&|number, body, point| match point {
                "" => format!("a{number}_{body}"),
                _ => format!("a{number}_{body}.{point}"),
            })
        );
        same(&bounds(&nested), &bounds(&by_hand));
    }
}

/// Coordinates that a body does not have are those of its instance.
#[test]
fn bodies_without_some_coordinates_are_where_their_instance_is() {
    let text = format!(
        "
assemblies:
  hanger:
    parameters: {{ mass: 2 kg ± 1% }}
    bodies: {{ bob: {{ mass: mass, coordinates: [y], held: {{ angle: 0.1 }}, points: {{ P: [0.1, 0] }} }} }}
    effects: {{ spring: {{ force: {{ on: bob, value: [0, -300 N/m*bob.y] }} }} }}
    initial: {{ bob.y: 10 mm, bob.vy: 0 }}
instances: {{ one: {{ of: hanger }}, two: {{ of: hanger, at: [1, 2], mirror: y, parameters: {{ mass: one.mass }} }} }}
outputs: {{ y1: one.bob.y, y2: 2 - two.bob.y, x1: one.bob.P.x + 1, x2: two.bob.P.x, z1: one.bob.P.y, z2: 2 - two.bob.P.y }}
{ASKED}"
    );
    let found = bounds(&text);
    for name in ["y", "x", "z"] {
        let [one, two] = ["1", "2"].map(|number| courses(&found, &format!("{name}{number}")));
        for (one, two) in one.iter().flatten().zip(two.iter().flatten()) {
            assert!((one - two).abs() < 1e-12, "{name}: {one} and {two}");
        }
    }
}

/// All numbers of a placement are parameters, in the frame of the instance around it.
#[test]
fn numbers_of_places_are_set_and_have_tolerances() {
    let text = format!(
        "{ARM}
  pair: {{ instances: {{ one: {{ of: arm, at: {{ position: [0.1, 0, 0], rotation: {{ rpy: [0, 0, 10 deg ± 1 deg] }} }} }} }} }}
instances: {{ left: {{ of: pair, at: {{ position: [1, 2, 3 m ± 1 mm], angle: 90 deg }}, mirror: x }} }}
outputs: {{ x: left.one.ground.x, y: left.one.ground.y, z: left.one.ground.z, hand: left.one.hand.x }}
{ASKED}"
    );
    let at = |set: &[&str]| {
        let model = read(&text, set);
        let (found, _) = run(&model);
        ["x", "y", "z"].map(|output| courses(&found, output)[0][0])
    };
    // The image of 0.1 along x is −0.1, which a quarter turn has along −y.
    let near = |found: [f64; 3], wanted: [f64; 3]| {
        assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-12), "{found:?}");
    };
    near(at(&[]), [1.0, 1.9, 3.0]);
    near(at(&["left.one.at.x=0.3"]), [1.0, 1.7, 3.0]);
    near(at(&["left.at.angle=0", "left.at.z=4"]), [0.9, 2.0, 4.0]);
    let mut names: Vec<String> =
        read(&text, &["left.at.angle=90±1 deg"]).uncertain().map(|(name, _)| name.to_owned()).collect();
    names.sort_unstable();
    assert_eq!(names, ["arm.l", "left.at.angle", "left.at.z", "left.one.at.yaw"]);
    let assemblies = run(&read(&text, &[])).1.assemblies;
    assert_eq!(assemblies[0].independent, ["left.at.z"]);
    assert_eq!(assemblies[1].independent, ["left.one.at.yaw"]);
}

/// A drive of many joints that turn counts the other way in a mirror as that of one does.
#[test]
fn drives_of_many_turn_the_other_way_in_a_mirror() {
    let text = format!(
        "
assemblies:
  arm:
    shared: all
    parameters: {{ m: 1 kg ± 2% }}
    bodies:
      upper: {{ mass: m, inertia: 0.02, points: {{ end: [0.3, 0] }} }}
      lower: {{ mass: m, inertia: 0.02 }}
    joints: {{ hip: {{ revolute: [ground, upper] }}, knee: {{ revolute: [upper.end, lower] }} }}
    effects:
      hold: {{ servo: {{ on: all revolute, target: 0.5*sin(3*t), proportional: 20, derivative: 1 }} }}
      hold_knee: {{ pid: {{ on: all kn*, target: 0.2, proportional: 2, integral: 3 }} }}
      nudge: {{ torque: {{ on: knee, value: 0.2*hold_knee.knee.integral }} }}
    initial: {{ hip.angle: 0.1, hip.angular_velocity: 0, knee.angle: 0.2, knee.angular_velocity: 0 }}
instances: {{ one: {{ of: arm }}, two: {{ of: arm, mirror: y }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [9.81, 0] }} }} }}
outputs: {{ h1: one.hip.angle, h2: -two.hip.angle, k1: one.knee.angle, k2: -two.knee.angle }}
{ASKED}"
    );
    let found = bounds(&text);
    for name in ["h", "k"] {
        let [one, two] = ["1", "2"].map(|number| courses(&found, &format!("{name}{number}")));
        for (one, two) in one.iter().flatten().zip(two.iter().flatten()) {
            assert!((one - two).abs() < 1e-9, "{name}: {one} and {two}");
        }
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The gripper of the guide is that of the models, whose fingers are written without parts.
#[test]
fn a_gripper_of_linkages_is_the_gripper() {
    let file = "docs/examples/gripper_of_parts.yaml";
    let page = fs::read_to_string(root().join("docs/guides/parts.md")).unwrap();
    assert!(page.contains(&fs::read_to_string(root().join(file)).unwrap()));
    let [parts, whole] = [file, "models/gripper.yaml"].map(|file| {
        let model = Model::from_file(root().join(file)).unwrap();
        run(&model).0
    });
    same(&parts, &whole);
}

/// Legs that differ by their placements alone move alike, and start where plane geometry says.
#[test]
fn legs_around_a_body_move_alike() {
    let model = Model::from_file(root().join("docs/examples/hexapod.yaml")).unwrap();
    let (found, _) = run(&model);
    let bend = 80_f64.to_radians();
    for (output, start) in [("foot", -0.16 * bend.sin()), ("reach", 0.1 + 0.12 + 0.16 * bend.cos())] {
        let first = courses(&found, &format!("{output}_1"));
        assert!((first[0][0] - start).abs() < 1e-12);
        assert!(first[2][0] > first[1][0] + 1e-4, "shins differ");
        for leg in 2..=6 {
            let other = courses(&found, &format!("{output}_{leg}"));
            for (one, other) in first.iter().flatten().zip(other.iter().flatten()) {
                assert!((one - other).abs() < 1e-9, "{output}_{leg}: {one} and {other}");
            }
        }
    }
}

/// An assembly gives the starts of bodies of inner instances, by their ports too, in its own frame.
#[test]
fn starts_of_inner_bodies_are_in_the_frame_in_which_they_are_said() {
    let side = |mirror: &str| {
        format!(
            r#"
assemblies:
  wheel:
    shared: all
    parameters: {{ m: 1 kg ± 2% }}
    bodies: {{ hub: {{ mass: m, inertia: 1, points: {{ P: [0.1, 0] }} }} }}
    ports: {{ centre: hub, rim: hub.P }}
  side:
    instances: {{ w: {{ of: wheel, at: [0.5, 0] }} }}
    effects:
      pull: {{ spring_damper: {{ between: [ground, w.rim], along: x, stiffness: 10 }} }}
      damp: {{ force: {{ on: w.centre, value: ["-1 N*s/m*w.rim.vx", "-1 N/m*w.centre.y"] }} }}
    initial: {{ w.rim.x: 0.7, w.rim.y: 0.1, w.centre.vx: 1, w.hub.vy: 0, w.hub.angle: 0.2, w.hub.angular_velocity: 0 }}
    ports: {{ rim: w.rim }}
instances:
  one: {{ of: side }}
  two: {{ of: side, {mirror} }}
outputs: {{ x1: one.rim.x, y1: one.rim.y, x2: two.rim.y - 1, y2: 1 - two.rim.x }}
{ASKED}"#
        )
    };
    // A quarter turn has the image's x along −y; without the mirror along y.
    for (index, sign) in
        [("at: { position: [1, 1], angle: 90 deg }", 1.0), ("at: { position: [1, 1], angle: 90 deg }, mirror: x", -1.0)]
    {
        let found = bounds(&side(index));
        for (name, sign) in [("x", sign), ("y", 1.0)] {
            let [one, two] = ["1", "2"].map(|number| courses(&found, &format!("{name}{number}"))[0].clone());
            let start = if name == "x" { 0.7 } else { 0.1 };
            assert!((one[0] - start).abs() < 1e-9, "{name}: {}", one[0]);
            for (one, two) in one.iter().zip(two) {
                // Given values of points hold at the start; the courses agree up to the steps' errors.
                assert!((one - sign * two).abs() < 1e-6, "{name}: {one} and {two}");
            }
        }
    }
}
