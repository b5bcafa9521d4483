//! Reactions of joints that a robot's file welds: the force and torque on the second body, in its own frame.

use mbint::Model;

use crate::common::curve;

fn first_values<const N: usize>(files: &[(&str, &str)], yaml: &str, outputs: [&str; N]) -> [f64; N] {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).unwrap());
    let listed = outputs.iter().enumerate().map(|(i, output)| format!("o{i}: {output}")).collect::<Vec<_>>().join(", ");
    let simulation = "simulation: { duration: 1e-3, step: 1e-3, output_step: 1e-3 }";
    let text = format!("{yaml}\noutputs: {{ {listed} }}\n{simulation}\n");
    let model = Model::from_yaml_str(&folder.path().join("model.yaml").display().to_string(), &text);
    let result = model.and_then(|model| model.study().nominal().run()).unwrap_or_else(|error| panic!("{error}"));
    std::array::from_fn(|i| curve(result.bounds(), &format!("o{i}"))[0])
}

#[track_caller]
fn near<const N: usize>(found: [f64; N], exact: [f64; N]) {
    (0..N).for_each(|i| assert!((found[i] - exact[i]).abs() < 1e-6, "{found:?} for {exact:?}"));
}

const MJCF: &str = "<mujoco><worldbody><body name='arm' pos='0 0 1'><joint name='elbow' axis='0 1 0' damping='0.2'/>\
    <inertial mass='2' pos='0.2 0 0' diaginertia='0.002 0.03 0.03'/>\
    <body name='hand' pos='0.4 0.1 0' euler='20 90 0'><inertial mass='1' pos='0 0 0.05' diaginertia='0.002 0.002 0.001'/>\
    <body name='tool' pos='0 0.2 0.1' euler='0 30 0'><inertial mass='0.5' pos='0.1 0 0' diaginertia='0.001 0.003 0.002'/>\
    </body></body></body></worldbody></mujoco>";

const OF_HAND: [&str; 6] = ["x", "y", "z", "x", "y", "z"];

/// Sensors `force` and `torque` of MuJoCo 4.0 at a site in the origin of `hand`, which it holds itself: the opposite of
/// the arm's wrench on the hand.
#[test]
fn wrench_on_a_welded_body_matches_mujocos_sensors() {
    let yaml = "mjcf: robot.xml\ninitial: { elbow.angle: 0.3, elbow.angular_velocity: 0.6 }";
    let names: [String; 6] = std::array::from_fn(|i| {
        let member = if i < 3 { "force_body" } else { "torque_body" };
        format!("hand_weld.{member}.{}", OF_HAND[i])
    });
    let found = first_values(&[("robot.xml", MJCF)], yaml, names.each_ref().map(String::as_str));
    near(found, [1.84238656, -0.67057387, -4.74556572, -0.27694133, 0.34949949, -0.13812729]);
}

/// A payload on an arm that turns with ω = 0.6 rad/s and without acceleration, level: it is carried against its weight
/// along the sensor's −x, and pulled inwards along its −z.
#[test]
fn a_fixed_joint_of_a_urdf_is_a_force_torque_sensor() {
    let inertial = |at: &str, mass: &str| {
        format!(
            "<inertial><origin xyz='{at}'/><mass value='{mass}'/>\
             <inertia ixx='0.002' iyy='0.03' izz='0.03' ixy='0' ixz='0' iyz='0'/></inertial>"
        )
    };
    let robot = |flange: &str| {
        format!(
            "<robot name='r'><link name='base'/><link name='arm'>{}</link><link name='flange'>{flange}</link>\
             <link name='payload'>{}</link>\
             <joint name='elbow' type='continuous'><parent link='base'/><child link='arm'/><axis xyz='0 1 0'/></joint>\
             <joint name='mount' type='fixed'><parent link='arm'/><child link='flange'/><origin xyz='0.3 0 0'/></joint>\
             <joint name='sensor' type='fixed'><parent link='flange'/><child link='payload'/>\
             <origin xyz='0.1 0 0' rpy='0 1.5707963267948966 0'/></joint></robot>",
            inertial("0.2 0 0", "2"),
            inertial("0 0 0.05", "1")
        )
    };
    let yaml = "urdf: robot.urdf\njoints: { hold: { motor: { on: elbow, position: 0.3*sin(2*t) } } }\n\
                effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }";
    let outputs = ["sensor.force_body.x", "joint.sensor.force_body.z", "sensor.torque_body.y", "mount.force_body.z"];
    let exact = [-9.81, -0.36 * 0.45, -9.81 * 0.05, 9.81];
    // A flange without mass carries the same.
    near(first_values(&[("robot.urdf", &robot(""))], yaml, outputs), exact);
    let heavy = robot(&inertial("0 0 0", "2"));
    near(first_values(&[("robot.urdf", &heavy)], yaml, outputs), [exact[0], exact[1], exact[2], 3.0 * 9.81]);
}
