//! Choice of the joint at which a loop is cut: a step becomes as short as the search finds, and the motion does not
//! change.

use mbint::Formulation;
use mbint::inner::assemble::{self, Questions};
use mbint::inner::compile::Scheme;
use mbint::inner::reduce::Reduction;
use mbint::inner::simulate::Simulator;
use mbint::inner::study;
use mbint::results::Method;

use crate::common::{
    Subject, band, curve, distance, largest, load, model, model_files, nominal, output, read, richardson, run,
};

/// Step for which programs are compiled, s; their length does not depend on it.
const STEP: f64 = 1e-3;

fn within(description: Subject, formulation: Formulation) -> Subject {
    description.formulation(formulation)
}

/// Instructions of a step with one correction.
fn instructions(simulator: &Simulator) -> usize {
    simulator.program.instructions()
}

fn cut(description: &Subject, simulator: &Simulator) -> Vec<String> {
    simulator
        .system
        .formulation
        .cut
        .iter()
        .map(|&joint| description.study().description().joints[joint].name.clone())
        .collect()
}

#[test]
#[ignore = "2 s"]
fn chosen_cut_is_never_longer_than_the_shallowest() {
    let mut shorter = Vec::new();
    for path in model_files() {
        let description = within(load(&path), Formulation::Joint);
        let study = description.study();
        let whole = Reduction::joined(study.description());
        let questions = Questions { merged: whole.merged.clone().into(), ..Questions::of(&whole.description) };
        let shallow = assemble::in_joint_coordinates(&questions, None, None).unwrap();
        let Some(shallow) = shallow.ok().filter(|system| !system.formulation.cut.is_empty()) else { continue };
        let scheme = Scheme::Hht { alpha: study.description().simulation.alpha };
        let shallow = Simulator::new(shallow, scheme, STEP).unwrap();
        let chosen = study::prepare(study.description()).unwrap();
        let [before, after] = [&shallow, &chosen].map(instructions);
        println!(
            "{}: {before} instructions, then {after}, cut at {:?}",
            description.name(),
            cut(&description, &chosen)
        );
        assert!(after <= before, "{}: {after} instructions instead of {before}", description.name());
        if after < before {
            shorter.push((description.name().to_owned(), cut(&description, &chosen)));
        }
    }
    let cut_of = |name: &str| shorter.iter().find(|(known, _)| known == name).map(|(_, cut)| cut.join(" "));
    // With both cylinders in the trees their lengths are coordinates, which the motors prescribe.
    assert_eq!(cut_of("excavator").as_deref(), Some("boom_eye stick_eye"));
    let excavator = study::prepare(model("excavator").study().description()).unwrap();
    assert!(excavator.system.formulation.joint && instructions(&excavator) < 800);
}

/// Bounds do not depend on the cut.
#[test]
fn bounds_match_those_of_absolute_coordinates() {
    for name in ["excavator", "peaucellier"] {
        let [absolute, joint] = [Formulation::Absolute, Formulation::Joint]
            .map(|formulation| run(&within(model(name).at_most(0.5), formulation).rows_every(0.05).scan(3)));
        for wanted in &absolute.outputs {
            let (a, b) = (band(wanted, Method::Scan), band(output(&joint, &wanted.name), Method::Scan));
            let size = largest(wanted.nominal.iter().copied()).max(1e-3);
            for (a, b) in [(&a.lower, &b.lower), (&a.upper, &b.upper)] {
                let apart = distance(a, b) / size;
                assert!(apart < 1e-3, "{name} {}: {apart:e}", wanted.name);
            }
        }
    }
}

/// Friction by the load of a joint needs the joint's multiplier: it is cut there.
fn rubbing(joint: &str) -> String {
    format!(
        "
bodies:
  ground: {{ points: {{ A: [0, 0], D: [0.4, 0] }} }}
  crank: {{ mass: 1, inertia: 0.01, points: {{ A: [-0.05, 0], B: [0.05, 0] }} }}
  coupler: {{ mass: 1, inertia: 0.03, points: {{ B: [-0.175, 0], C: [0.175, 0] }} }}
  rocker: {{ mass: 1, inertia: 0.02, points: {{ D: [-0.15, 0], C: [0.15, 0] }} }}
joints:
  A: {{ revolute: [ground.A, crank.A] }}
  B: {{ revolute: [crank.B, coupler.B] }}
  C: {{ revolute: [coupler.C, rocker.C] }}
  D: {{ revolute: [ground.D, rocker.D] }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  rub: {{ joint_friction: {{ on: {joint}, coefficient: 0.2, radius: 0.02, transition_velocity: 0.5 }} }}
initial: {{ crank.angle: 0.5, crank.angular_velocity: 6 }}
guess: {{ coupler.angle: 0.8, rocker.angle: 1.8 }}
outputs: {{ crank: crank.angle, rocker: rocker.angle, force: {joint}.force.x }}
simulation: {{ duration: 0.5, step: 1e-3, output_step: 0.05 }}
bounds: {{ }}
"
    )
}

#[test]
fn loops_are_cut_at_joints_with_friction() {
    for joint in ["A", "B", "C", "D"] {
        let description = read(&rubbing(joint));
        let chosen = study::prepare(within(description.clone(), Formulation::Joint).study().description()).unwrap();
        assert_eq!(cut(&description, &chosen), [joint]);
        let [absolute, in_joint] = [Formulation::Absolute, Formulation::Joint].map(|formulation| {
            let runs = [1e-3, 5e-4].map(|h| nominal(&within(description.clone(), formulation).step(h)));
            ["crank", "rocker", "force"].map(|name| richardson(curve(&runs[0], name), curve(&runs[1], name)))
        });
        for (a, b) in absolute.iter().zip(&in_joint) {
            let apart = distance(a, b) / largest(a.iter().copied());
            assert!(apart < 1e-4, "{joint}: {apart:e}");
        }
    }
}

/// The start value of a body's angle is not measured against the guess of its parent's.
#[test]
fn start_angles_do_not_depend_on_other_guesses() {
    let text = rubbing("C").replace("crank.angle: 0.5, crank.angular_velocity: 6", "coupler.angle: 0.7");
    for guess in ["crank.angle: 0.6, rocker.angle: 1.8", "crank.angle: 0.8, rocker.angle: 1.6"] {
        let text = text.replace("coupler.angle: 0.8, rocker.angle: 1.8", guess);
        for formulation in [Formulation::Absolute, Formulation::Joint] {
            let bounds = nominal(&within(read(&text), formulation).observing(&["coupler.angle"]).duration(0.01));
            let angle = bounds.outputs[0].nominal[0];
            assert!((angle - 0.7).abs() < 1e-10, "{formulation:?}, {guess}: {angle}");
        }
    }
}
