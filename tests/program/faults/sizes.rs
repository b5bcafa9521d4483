//! Models of one to many bodies: a chain, swinging from one end.

use mbint::Model;
use mbint::inner::study;

use crate::place::Place;

fn chain(bodies: usize, duration: f64) -> Model {
    let each = |line: &dyn Fn(usize) -> String| (0..bodies).map(line).collect::<Vec<_>>().join("\n  ");
    let text = format!(
        "
parameters: {{ l: {{ value: 0.1, tolerance: 1% }} }}
bodies:
  {}
joints:
  {}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial:
  {}
outputs: {{ x: b{last}.b.x, energy: energy, gap_x: j{last}.force.x, gap: b{last}.a.x - {before} }}
simulation: {{ duration: {duration}, step: 1e-3, output_step: {duration} }}
bounds: {{ chebyshev: {{ order: 1, expand: output }} }}
",
        each(&|i| format!("b{i}: {{ mass: 0.1, inertia: 1e-4, points: {{ a: [-l/2, 0], b: [l/2, 0] }} }}")),
        each(&|i| {
            let before = if i == 0 { "ground".to_owned() } else { format!("b{}.b", i - 1) };
            format!("j{i}: {{ revolute: [{before}, b{i}.a] }}")
        }),
        each(&|i| format!("b{i}.angle: -{} deg, b{i}.angular_velocity: 0", i % 90).replace(", ", "\n  ")),
        last = bodies - 1,
        before = if bodies == 1 { "0".to_owned() } else { format!("b{}.b.x", bodies - 2) },
    );
    Model::from_yaml_str("chain", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// Pivots that were freely chosen let errors grow from body to body: 100 bodies did not make a step, 1000 were
/// called singular.
#[test]
fn long_chains_swing_and_keep_their_energy() {
    for (bodies, duration) in [(1, 0.1), (10, 0.1), (100, 0.02), (500, 0.005)] {
        let study = chain(bodies, duration).study().threads(2).allow_costly();
        let result = study.run().unwrap_or_else(|error| panic!("{bodies} bodies: {error}"));
        let (bounds, summary) = (result.bounds(), result.summary());
        assert_eq!((summary.failure.as_deref(), summary.degrees_of_freedom), (None, bodies));
        let of = |output: usize| &bounds.outputs[output].nominal;
        let moved = (of(0)[1] - of(0)[0]).abs();
        let lost = (of(1)[1] - of(1)[0]).abs();
        // Energy of the whole chain after a free fall of the same time.
        let turnover = 0.5 * bodies as f64 * 0.1 * (9.81 * duration).powi(2);
        println!("{bodies} bodies: {lost:.2e} of {turnover:.2e} J, tip moved {moved:.2e} m");
        assert!(lost < 2e-2 * turnover && of(3).iter().all(|gap| gap.abs() < 1e-10), "{lost:e} of {turnover:e} J");
        assert!(moved.is_finite() && bounds.outputs.iter().all(|output| output.bands[0].upper[1].is_finite()));
    }
}

/// A file of this size is read and assembled.
#[test]
#[ignore = "7 s"]
fn ten_thousand_bodies_are_counted() {
    let model = chain(if cfg!(debug_assertions) { 2000 } else { 10_000 }, 1e-3);
    let simulator = study::prepare(model.study().description()).unwrap();
    assert_eq!(simulator.mobility.degrees_of_freedom, simulator.system.q.len() / 3);
}

/// A robot of links in series, each joint with a coordinate.
fn robot(links: usize) -> String {
    let mut text = String::from("<robot name=\"snake\"><link name=\"base\"/>");
    for link in 0..links {
        let (parent, axis) =
            (if link == 0 { "base".to_owned() } else { format!("s{}", link - 1) }, ["0 1 0", "1 0 0"][link % 2]);
        text += &format!(
            "<link name=\"s{link}\"><inertial><origin xyz=\"0 0 0.07\"/><mass value=\"0.8\"/>\
             <inertia ixx=\"0.02\" iyy=\"0.02\" izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\
             <joint name=\"k{link}\" type=\"continuous\"><parent link=\"{parent}\"/><child link=\"s{link}\"/>\
             <origin xyz=\"0 0 0.15\"/><axis xyz=\"{axis}\"/></joint>"
        );
    }
    text + "</robot>"
}

/// A chain so deep that joint coordinates are not tried, and one whose absolute coordinates include the joints'.
#[test]
fn check_of_a_long_robot_takes_linear_instructions() {
    let place = Place::new();
    std::fs::write(place.path().join("snake.urdf"), robot(60)).unwrap();
    let (told, _) = place.run("check snake.urdf", 0);
    assert!(told.contains("60 degrees of freedom"), "{told}");
    std::fs::write(
        place.path().join("few.yaml"),
        "urdf: few.urdf\nsimulation: { duration: 0.1, step: 1e-3, formulation: absolute }\n",
    )
    .unwrap();
    std::fs::write(place.path().join("few.urdf"), robot(6)).unwrap();
    let instructions = |links: usize| {
        std::fs::write(place.path().join("few.urdf"), robot(links)).unwrap();
        let model = Model::from_file(place.path().join("few.yaml")).unwrap();
        let simulator = study::prepare(model.study().description()).unwrap();
        simulator.start.position().len() + simulator.start.velocity().len() + simulator.start.acceleration().len()
    };
    let [few, twice] = [8, 16].map(instructions);
    assert!((twice as f64) < 2.5 * few as f64, "{few} and {twice} instructions: they grow with the chain, not faster");
}
