//! Joint and absolute coordinates are two ways to write down one motion: at the start they agree to rounding, in
//! positions, velocities, accelerations and reactions, and later to the scheme's error.

use mbint::Formulation;
use mbint::inner::assemble;
use mbint::inner::compile::Scheme;
use mbint::inner::model::Stepping;
use mbint::inner::simulate::{SimulationError, Simulator};
use mbint::inner::study;

use crate::common::{Subject, curve, largest, load, model_files, nominal, output, read, richardson, run};

fn within(description: Subject, formulation: Formulation) -> Subject {
    description.formulation(formulation)
}

fn has_both(description: &Subject) -> bool {
    assemble::in_joint_coordinates(&assemble::Questions::of(description.study().description()), None, None)
        .unwrap()
        .is_ok()
}

/// Every output's course.
fn courses(description: Subject) -> Vec<Vec<f64>> {
    nominal(&description).outputs.into_iter().map(|output| output.nominal).collect()
}

/// Differences between the formulations of each output, relative to the largest value of it: at the start, and over all
/// rows of the extrapolation from two step sizes.
fn differences(description: &Subject, h: f64) -> Vec<(String, f64, f64)> {
    let [absolute, joint] = [Formulation::Absolute, Formulation::Joint].map(|formulation| {
        let course = |h: f64| courses(within(description.clone(), formulation).step(h));
        let (coarse, fine) = (course(h), course(0.5 * h));
        let limit: Vec<Vec<f64>> = coarse.iter().zip(&fine).map(|(coarse, fine)| richardson(coarse, fine)).collect();
        (fine, limit)
    });
    let names = description.model.outputs().map(|(name, _)| name.to_owned());
    let pairs = absolute.0.iter().zip(&joint.0).zip(absolute.1.iter().zip(&joint.1));
    names
        .zip(pairs)
        .map(|(name, ((a, b), (a_limit, b_limit)))| {
            let size = largest(a.iter().copied()).max(1e-3);
            let apart = largest(a_limit.iter().zip(b_limit).map(|(a, b)| a - b));
            (name, (a[0] - b[0]).abs() / size, apart / size)
        })
        .collect()
}

/// A tree of bodies with every joint that can carry one, frames that stand askew, and bodies that are a joint's first
/// as well as its second; on the ground or floating.
fn tree(floating: bool) -> String {
    let base = if floating { "" } else { "  hold: { fixed: [ground.O, base] }\n" };
    let thrown = if floating {
        "  base.x: 0.1\n  base.y: 0\n  base.z: -0.3\n  base.orientation: { rpy: [0.1, 0.4, -0.2] }
  base.vx: 1\n  base.vy: 0\n  base.vz: 0.5\n  base.omega: [0.4, -0.3, 1]\n"
    } else {
        ""
    };
    format!(
        "
parameters:
  m: {{ value: 1.2, unit: kg, tolerance: 5% }}
bodies:
  ground: {{ points: {{ O: [0.1, -0.2, 0.3] }} }}
  base:
    mass: 2
    inertia: {{ xx: 0.03, yy: 0.05, zz: 0.04, xy: 0.004, xz: -0.003, yz: 0.002 }}
    center_of_mass: [0.02, 0.03, -0.01]
    points: {{ A: {{ position: [0.2, 0.1, 0], rotation: {{ rpy: [0.3, -0.4, 0.5] }} }}, B: [-0.2, 0, 0.1] }}
  upper:
    mass: m
    inertia: {{ xx: 0.02, yy: 0.03, zz: 0.025, xy: 0.002, xz: 0.001, yz: -0.001 }}
    center_of_mass: [0.1, 0.02, 0]
    points: {{ S: {{ position: [-0.1, 0, 0.05], rotation: {{ rpy: [0, 0.2, 0.1] }} }}, T: {{ position: [0.3, 0, 0], rotation: {{ rpy: [1, 0, 0.2] }} }} }}
  slide:
    mass: 0.7
    inertia: [0.01, 0.012, 0.008]
    center_of_mass: [0, 0.05, 0.01]
    points: {{ S: [0.05, 0, 0], T: {{ position: [0, 0.1, 0], rotation: {{ rpy: [0, 0, 0.7] }} }} }}
  tube:
    mass: 0.5
    inertia: [0.005, 0.006, 0.004]
    points: {{ S: [0, 0, 0.1], T: [0.02, 0, -0.1] }}
  nut:
    mass: 0.4
    inertia: [0.003, 0.002, 0.004]
    points: {{ S: [0.05, 0, 0], E: [-0.1, 0.1, 0] }}
  plate:
    mass: 0.3
    inertia: [0.002, 0.004, 0.003]
    center_of_mass: [0.1, 0, 0]
joints:
{base}  shoulder: {{ revolute: {{ between: [base.A, upper.S], axis: [1, 2, -0.5] }} }}
  rail: {{ prismatic: {{ between: [slide.S, upper.T], axis: [0.3, 1, 0.2], angle: 20 deg }} }}
  barrel: {{ cylindrical: {{ between: [tube.S, slide.T], axis: z }} }}
  thread: {{ screw: {{ between: [tube.T, nut.S], axis: [0, 1, 0.2], pitch: 0.3 }} }}
  weld: {{ fixed: {{ between: [base.B, plate], angle: 35 deg }} }}
effects:
  weight: {{ gravity: {{ acceleration: [1, -2, -9.81] }} }}
  spring: {{ spring_damper: {{ between: [ground.O, nut.E], stiffness: 30, damping: 0.3, free_length: 0.2 }} }}
  twist: {{ torsional_spring_damper: {{ on: shoulder, stiffness: 2, damping: 0.1, free_angle: 0.2 }} }}
  push: {{ force: {{ on: slide.T, value: [0.3, 0.2*sin(3*t), -0.5], frame: body }} }}
initial:
{thrown}  shoulder.angle: 0.3
  shoulder.angular_velocity: 0.5
  rail.displacement: 0.05
  rail.velocity: -0.2
  barrel.angle: 0.4
  barrel.displacement: 0.02
  barrel.angular_velocity: 0.3
  barrel.velocity: 0.1
  thread.angle: 0.1
  thread.angular_velocity: 1
outputs:
  x: nut.E.x
  vy: nut.E.vy
  az: nut.E.az
  p: slide.p2
  p_rate: slide.omega.x
  alpha: nut.alpha_body.y
  slide_x: slide.x
  angle: shoulder.angle
  s: rail.displacement
  shoulder_x: shoulder.force.x
  shoulder_torque_y: shoulder.torque.y
  rail_force: rail.force
  rail_torque_z: rail.torque.z
  barrel_force_y: barrel.force.y
  barrel_torque_x: barrel.torque.x
  thread_force_z: thread.force.z
  thread_torque_y: thread.torque.y
  weld_force: weld.force
  weld_torque: weld.torque.x
  energy: energy
simulation: {{ duration: 0.5, step: 1e-3, output_step: 0.05 }}
"
    )
}

#[track_caller]
fn agree(description: &Subject, h: f64, later: f64) {
    assert!(
        has_both(description),
        "{}: {:?}",
        description.name(),
        assemble::in_joint_coordinates(&assemble::Questions::of(description.study().description()), None, None)
            .unwrap()
            .err()
    );
    for (name, at_start, apart) in differences(description, h) {
        println!("{} {name}: {at_start:.1e} {apart:.1e}", description.name());
        assert!(at_start < 1e-9, "{} {name}: {at_start:.1e} at the start", description.name());
        assert!(apart < later, "{} {name}: {apart:.1e} apart", description.name());
    }
}

#[test]
fn formulations_agree_on_a_tree_of_every_joint() {
    agree(&read(&tree(false)), 1e-3, 1e-5);
}

#[test]
fn formulations_agree_on_a_floating_tree() {
    agree(&read(&tree(true)), 1e-3, 1e-5);
}

#[test]
#[ignore = "10 s"]
fn formulations_agree_on_every_model_with_both() {
    let models: Vec<Subject> = model_files().iter().map(|path| load(path)).filter(has_both).collect();
    let names: Vec<&str> = models.iter().map(|model| model.name()).collect();
    println!("{names:?}");
    for description in &models {
        let duration = description.model.duration().min(0.5);
        // Impacts take the short steps that their model asks for.
        let step = match description.study().description().simulation.stepping {
            Stepping::Fixed(step) => duration / 1000.0 / (duration / 1000.0 / step).ceil(),
            Stepping::Tolerance(_) => duration / 1000.0,
        };
        agree(&description.clone().duration(duration).rows_every(duration / 10.0), step, 1e-4);
    }
}

/// Bars of 0.3 m one hanging from the other, by pins about y and z in turn, or all about z in the plane.
fn chain(links: usize, spatial: bool, formulation: &str) -> Subject {
    let mut bodies = String::new();
    let mut joints = String::new();
    for i in 0..links {
        let (inertia, along) = if spatial { ("[0.001, 0.008, 0.008]", ", 0") } else { ("0.008", "") };
        let points = format!("points: {{ a: [-0.15, 0{along}], e: [0.15, 0{along}] }}");
        bodies += &format!("  b{i}: {{ mass: 1, inertia: {inertia}, {points} }}\n");
        let before = if i == 0 { "ground".to_owned() } else { format!("b{}.e", i - 1) };
        let axis = if spatial { ["axis: y", "axis: z"][i % 2] } else { "axis: z" };
        joints += &format!("  j{i}: {{ revolute: {{ between: [{before}, b{i}.a], {axis} }} }}\n");
    }
    let down = if spatial { "[0, 0, -9.81]" } else { "[0, -9.81]" };
    let last = links - 1;
    read(&format!(
        "bodies:\n{bodies}joints:\n{joints}effects: {{ weight: {{ gravity: {{ acceleration: {down} }} }} }}
outputs: {{ y: b{last}.e.y }}
simulation: {{ duration: 0.01, step: 1e-3, output_step: 1e-3, formulation: {formulation} }}\n"
    ))
}

/// Instructions of a step with one correction.
fn instructions(description: &Subject) -> (bool, usize) {
    let simulator = study::prepare(description.study().description()).unwrap();
    (simulator.system.formulation.joint, simulator.program.instructions())
}

#[test]
#[ignore = "10 s: chains of up to a hundred links"]
fn instructions_grow_linearly_in_absolute_coordinates() {
    for spatial in [false, true] {
        let [(_, short), (_, long)] = [20, 100].map(|links| instructions(&chain(links, spatial, "absolute")));
        println!("spatial {spatial}: {short} instructions for 20 links, {long} for 100");
        assert!(10 * long < 53 * short, "{short} instructions for 20 links, {long} for 100");
        let (joint, few) = instructions(&chain(2, spatial, "auto"));
        let (_, many) = instructions(&chain(2, spatial, "absolute"));
        assert!(joint && few < many, "{few} against {many}");
        // Long spatial chains are shorter link by link, planar ones are not.
        let (joint, of_auto) = instructions(&chain(90, spatial, "auto"));
        assert!(joint == spatial && 4 * of_auto < if spatial { 90 * 3600 } else { 90 * 800 });
    }
}

#[test]
fn open_start_of_a_chain_costs_linear_instructions() {
    // The first angle is given, and the others are nearest to zero: the distances couple each link with the next.
    let corrections = [60, 120].map(|links| {
        let mut bodies = String::new();
        let mut joints = String::new();
        for i in 0..links {
            bodies += &format!("  b{i}: {{ mass: 1, inertia: 0.008, points: {{ a: [-0.15, 0], e: [0.15, 0] }} }}\n");
            let before = if i == 0 { "ground".to_owned() } else { format!("b{}.e", i - 1) };
            joints += &format!("  j{i}: {{ revolute: [{before}, b{i}.a] }}\n");
        }
        let model = read(&format!(
            "bodies:\n{bodies}joints:\n{joints}initial: {{ b0.angle: 0.1 }}\noutputs: {{ y: b1.y }}
simulation: {{ duration: 0.01, step: 1e-3, output_step: 1e-3, formulation: absolute }}\n"
        ));
        study::prepare(model.study().description()).unwrap().start.position().len()
    });
    println!("{corrections:?}");
    assert!(corrections[1] < 23 * corrections[0] / 10, "{corrections:?}");
}

/// A compilation beyond its limit is given up; one within its limit gives the usual program.
#[test]
fn program_is_abandoned_only_beyond_its_limit() {
    let system =
        assemble::in_absolute_coordinates(&assemble::Questions::of(read(&tree(false)).study().description())).unwrap();
    let within = |limit| Simulator::within(system.clone(), Scheme::Hht { alpha: -0.1 }, 1e-3, limit);
    assert_eq!(within(Some(1000)).map(|_| ()), Err(SimulationError::TooLong));
    let [free, limited] = [None, Some(1_000_000)].map(|limit| within(limit).unwrap());
    let instructions = |simulator: &Simulator| {
        let program = &simulator.program;
        [program.step(), program.factor(), program.first_correction(), program.advance()].map(|tape| tape.len())
    };
    assert_eq!(instructions(&free), instructions(&limited));
}

/// Values of the start that the model leaves open are nearest to rest in joint coordinates: neither the formulation nor
/// the outputs change them.
#[test]
fn start_is_independent_of_formulation_and_outputs() {
    let planar = "
bodies:
  rod: { mass: 1.4, inertia: 0.15, points: { a: [0.25, 0.05], c: [-0.3, 0] } }
  bob: { mass: 0.9, inertia: 0.08, points: { a: [0.2, 0.1] } }
joints: { S: { revolute: [ground, rod.a] }, R: { revolute: [rod.c, bob.a] } }
effects: { g: { gravity: { acceleration: [1, -9.81] } } }
";
    let spatial = "
bodies:
  ground: { points: { p: { position: [0.1, 0.2, 0], rotation: { rpy: [0.3, -0.4, 0.8] } } } }
  rod: { mass: 1.4, inertia: [0.15, 0.1, 0.12], points: { a: [0.25, 0.05, 0.1], c: { position: [-0.3, 0, 0.1], rotation: { rpy: [1, 0, 0.2] } } } }
  bob: { mass: 0.9, inertia: [0.08, 0.05, 0.06], points: { a: [0.2, 0.1, 0] } }
joints:
  S: { revolute: { between: [ground.p, rod.a], axis: y } }
  R: { cylindrical: { between: [rod.c, bob.a], axis: x } }
effects: { g: { gravity: { acceleration: [1, 0, -9.81] } } }
";
    let starts = [
        "R.angle: 0.3, R.angular_velocity: 1.2",
        "S.angle: 1.1",
        "S.angular_velocity: -0.7",
        "R.angle: -0.4, S.angular_velocity: 2",
    ];
    for (mechanism, start) in [planar, spatial].into_iter().flat_map(|mechanism| starts.map(|start| (mechanism, start)))
    {
        let run_as = |formulation: &str, outputs: &str| {
            nominal(&read(&format!(
                "{mechanism}initial: {{ {start} }}\noutputs: {{ x: bob.x, y: bob.y, vx: bob.vx, vy: bob.vy{outputs} }}\n\
                 simulation: {{ duration: 0.2, step: 1e-3, output_step: 0.02, formulation: {formulation} }}\n"
            )))
        };
        let joint = run_as("joint", "");
        for outputs in ["", ", s: S.angle", ", e: energy, s: S.angle, r: R.angle"] {
            let absolute = run_as("absolute", outputs);
            for name in ["x", "y", "vx", "vy"] {
                let pairs = curve(&absolute, name).iter().zip(curve(&joint, name));
                let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // The steps' errors differ between the formulations; at the start there are none.
                let first = (curve(&absolute, name)[0] - curve(&joint, name)[0]).abs();
                assert!(first < 1e-10 && apart < 1e-4, "{start}{outputs}: {name} {first:e} {apart:e}");
            }
        }
    }
}

/// Named joints are where they are named and others at 0, in every sample.
#[test]
fn unnamed_joints_start_at_zero_in_every_sample() {
    let description = read(
        "
parameters: { reach: { value: 0.3, tolerance: 20% }, up: { value: 0.1, tolerance: 20% } }
bodies:
  rod: { mass: 1.4, inertia: 0.15, points: { a: [-reach, up], c: [0.3, 0] } }
  bob: { mass: 0.9, inertia: 0.08, points: { a: [up, reach] } }
joints: { S: { revolute: [ground, rod.a] }, R: { revolute: [rod.c, bob.a] } }
effects: { g: { gravity: { acceleration: [0, -9.81] } } }
initial: { R.angle: 0.5, R.angular_velocity: 1 }
outputs: { s: rod.angle, w: rod.angular_velocity, r: bob.angle - rod.angle }
simulation: { duration: 0.01, step: 1e-3, output_step: 0.01, formulation: absolute }
bounds: { scan: { points: 3 } }
",
    );
    let bounds = run(&description);
    for (name, expected) in [("s", 0.0), ("w", 0.0), ("r", 0.5)] {
        let band = output(&bounds, name).bands[0].clone();
        let ends = [band.lower[0], band.upper[0]];
        assert!(ends.iter().all(|end| (end - expected).abs() < 1e-11), "{name}: {ends:?}, not {expected}");
    }
}

/// A floating body and a joint of one name have multipliers of their own: the closed chain is not singular, and the
/// motion that of other names and of absolute coordinates.
#[test]
fn a_joint_may_be_called_like_a_floating_body() {
    let outputs = |joint: &str, formulation: &str| {
        let text = format!(
            "
parameters: {{ k: {{ value: 100, unit: N/m, tolerance: 5% }} }}
bodies:
  arm: {{ mass: 1, inertia: [0.1, 0.1, 0.1], points: {{ b: [0.2, 0, 0] }} }}
  wheel: {{ mass: 5, inertia: [1, 2, 3], points: {{ a: [0.5, 0, 0] }} }}
joints: {{ {joint}: {{ spherical: [arm, wheel.a] }} }}
effects:
  hold: {{ bushing: {{ between: [ground, arm.b], stiffness: [k, k, k], torsional_stiffness: 1 }} }}
  push: {{ force: {{ on: wheel, value: [1, 2, 3] }} }}
guess: {{ wheel.x: 0, wheel.y: 0, wheel.z: 0 }}
outputs: {{ x: wheel.x, z: wheel.z, s: arm.b.y }}
simulation: {{ formulation: {formulation}, duration: 0.2, step: 2e-3, output_step: 0.02 }}
bounds: {{ chebyshev: {{ order: 2 }} }}
"
        );
        courses(read(&text))
    };
    let [same, other, absolute] = [("arm", "joint"), ("ball", "joint"), ("arm", "absolute")]
        .map(|(joint, formulation)| outputs(joint, formulation));
    assert_eq!(same, other);
    let values = same.iter().flatten().zip(absolute.iter().flatten());
    values.for_each(|(a, b)| assert!((a - b).abs() < 1e-6, "{a} and {b}"));
}
