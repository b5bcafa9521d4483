//! Instances within instances that are placed and mirrored in the plane, against the same mechanism written by hand.

use nalgebra::{Matrix2, Rotation2, Vector2};

use super::parts_nested::{ASKED, bounds, same};

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
fn three_levels_match_the_mechanism_written_by_hand() {
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
