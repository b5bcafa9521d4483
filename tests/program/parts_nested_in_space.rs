//! Instances within instances that are placed and mirrored in space, against the same mechanism written by hand.

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use super::parts_nested::{ASKED, bounds, same};

/// An arm in space, and a body that flies and is tied by a spring.
pub(super) const ARM: &str = r#"
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
