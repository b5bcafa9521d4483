//! Only the requested outputs are simulated: parts that no output needs change nothing, welded bodies are one.

use std::fmt::Write as _;

use mbint::inner::compile::Tapes;
use mbint::inner::export::bounds_csv;
use mbint::inner::study;
use mbint::results::{Bounds, Summary};

use crate::common::{Subject, read, run_methods};

#[track_caller]
pub(crate) fn run(description: &Subject) -> (Bounds, Summary) {
    run_methods(description, None)
}

pub(crate) fn csv(bounds: &Bounds) -> String {
    String::from_utf8(bounds_csv(bounds).unwrap()).unwrap()
}

/// Instructions of every tape.
fn instructions(description: &Subject) -> [usize; 10] {
    let simulator = study::prepare(description.study().description()).unwrap();
    let (p, s) = (&simulator.program, &simulator.start);
    [
        p.sample().len(),
        p.step_size().len(),
        p.step().len(),
        p.factor().len(),
        p.first_correction().len(),
        p.advance().len(),
        p.correct().len(),
        p.observe().len(),
        p.matrix().len(),
        s.position().len(),
    ]
}

/// Sections of a model file.
#[derive(Clone, Default)]
pub(crate) struct Sections {
    pub(crate) parameters: String,
    pub(crate) ground: String,
    pub(crate) bodies: String,
    pub(crate) joints: String,
    pub(crate) effects: String,
    pub(crate) initial: String,
    pub(crate) outputs: String,
    pub(crate) simulation: String,
    pub(crate) bounds: String,
}

impl Sections {
    pub(crate) fn add(&mut self, other: &Self) {
        self.parameters += &other.parameters;
        self.ground += &other.ground;
        self.bodies += &other.bodies;
        self.joints += &other.joints;
        self.effects += &other.effects;
        self.initial += &other.initial;
        self.outputs += &other.outputs;
    }

    pub(crate) fn with(&self, other: &Self) -> Self {
        let mut all = self.clone();
        all.add(other);
        all
    }

    pub(crate) fn model(&self) -> Subject {
        let Self { parameters, ground, bodies, joints, effects, initial, outputs, simulation, bounds } = self;
        read(&format!(
            "model: test\nparameters:\n{parameters}bodies:\n  ground: {{ points: {{ O: [0, 0]{ground} }} }}\n{bodies}\
             joints:\n{joints}effects:\n  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}\n{effects}\
             initial:\n{initial}outputs:\n{outputs}simulation: {simulation}\nbounds: {bounds}\n"
        ))
    }
}

/// A pendulum at x, its length uncertain where a tolerance is given.
pub(crate) fn pendulum(name: &str, x: f64, tolerance: &str) -> Sections {
    let l = format!("l_{name}");
    Sections {
        parameters: format!("  {l}: {{ value: 0.5, unit: m{tolerance} }}\n  m_{name}: {{ value: 1.2, unit: kg }}\n"),
        ground: format!(", P_{name}: [{x}, 0]"),
        bodies: format!(
            "  {name}: {{ mass: m_{name}, inertia: m_{name}*{l}^2/12, points: {{ A: [-{l}/2, 0], B: [{l}/2, 0] }} }}\n"
        ),
        joints: format!("  hinge_{name}: {{ revolute: [ground.P_{name}, {name}.A] }}\n"),
        initial: format!("  {name}.angle: 0.3\n  {name}.angular_velocity: 0\n"),
        outputs: format!("  x_{name}: {name}.B.x\n  load_{name}: hinge_{name}.force\n"),
        simulation: "{ duration: 0.5, step: 1e-3 }".to_owned(),
        bounds: "{ chebyshev: { order: 4 }, scan: { points: 5 }, taylor: { order: 2 } }".to_owned(),
        ..Sections::default()
    }
}

/// Ten bodies that no output needs: a chain on springs, its masses uncertain, some welded, and a driven one.
fn chain_of_ten() -> Sections {
    let mut s =
        Sections { parameters: "  m_idle: { value: 2, unit: kg, tolerance: 10% }\n".to_owned(), ..Sections::default() };
    s.ground = ", Far: [17, 3]".to_owned();
    for i in 0..10 {
        _ = writeln!(s.bodies, "  idle{i}: {{ mass: m_idle, inertia: 0.1, points: {{ A: [-0.4, 0], B: [0.4, 0] }} }}");
        let before = if i == 0 { "ground.Far".to_owned() } else { format!("idle{}.B", i - 1) };
        let kind = if i % 3 == 1 { "fixed" } else { "revolute" };
        _ = writeln!(s.joints, "  idle_joint{i}: {{ {kind}: [{before}, idle{i}.A] }}");
        _ = writeln!(
            s.effects,
            "  idle_spring{i}: {{ spring_damper: {{ between: [ground.Far, idle{i}.B], stiffness: 20, free_length: 0.5 }} }}"
        );
        if i % 3 != 1 {
            _ = writeln!(s.initial, "  idle{i}.angle: 0.1");
        }
    }
    s.effects += "  idle_push: { force: { on: idle9.B, value: [3*sin(9*t), 0] } }\n";
    s
}

#[test]
fn bodies_needed_by_no_output_change_no_result() {
    let bare = pendulum("a", 0.0, ", tolerance: 2%");
    let full = bare.with(&chain_of_ten());
    let (bare, full) = (bare.model(), full.model());
    assert_eq!(instructions(&bare), instructions(&full));
    let ((bounds, summary), (full_bounds, full_summary)) = (run(&bare), run(&full));
    assert_eq!(csv(&bounds), csv(&full_bounds));
    assert_eq!(summary.not_simulated, Vec::<String>::new());
    assert_eq!(full_summary.not_simulated.len(), 10 + 10 + 11);
    assert_eq!(full_summary.not_simulated[0], "body idle0");
    let simulations = |summary: &Summary| summary.methods.iter().map(|method| method.simulations).collect::<Vec<_>>();
    assert_eq!(simulations(&summary), simulations(&full_summary));
    assert_eq!(full_summary.parameters.len(), 2);
    // The one that nothing depends on has no part in anything.
    let idle = &full_bounds.contributions[0][1];
    assert_eq!(idle.parameter, "m_idle");
    assert!(idle.main.iter().all(|share| *share == 0.0));
    for (of_bare, of_full) in bounds.contributions.iter().zip(&full_bounds.contributions) {
        assert_eq!(of_bare[0], of_full[0]);
    }
}

/// A bar and a plate that is welded to it at an angle, hanging from a hinge.
const WELDED: &str = "
model: welded
parameters: { m: { value: 1.2, unit: kg, tolerance: 5% }, d: { value: 0.2, unit: m, tolerance: 5% } }
bodies:
  bar: { mass: m, inertia: 0.05, center_of_mass: [0.1, 0.02], points: { A: [-0.3, 0], B: [d, 0.1] } }
  plate: { mass: 0.8, inertia: 0.02, center_of_mass: [0, 0.05], points: { C: [0.1, -0.1], D: [0.3, 0.2] } }
joints:
  hinge: { revolute: [ground, bar.A] }
  weld: { fixed: { between: [bar.B, plate.C], angle: 40 deg } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  spring: { spring_damper: { between: [ground, plate.D], stiffness: 30, damping: 0.2, free_length: 0.3 } }
  twist: { torque: { on: plate, value: 0.3*plate.angular_velocity } }
initial: { bar.angle: 0.4, bar.angular_velocity: 1 }
outputs: { x: plate.D.x, angle: plate.angle, vy: plate.vy, ax: plate.ax, load: hinge.force, energy: energy }
simulation: { duration: 0.4, step: STEP, output_step: 0.02, formulation: FORMULATION }
bounds: { scan: { points: 2 } }
";

/// The same in space, with one more body on a spherical joint, and a plate that is welded the other way round.
const WELDED_IN_SPACE: &str = "
model: welded
space: spatial
parameters: { m: { value: 1.2, unit: kg, tolerance: 5% }, d: { value: 0.2, unit: m, tolerance: 5% } }
bodies:
  bar: { mass: m, inertia: [0.05, 0.06, 0.02], center_of_mass: [0.1, 0.02, -0.03], points: { A: [-0.3, 0, 0], B: { position: [d, 0.1, 0.05], rotation: { rpy: [0.2, 0.3, -0.4] } } } }
  plate: { mass: 0.8, inertia: { xx: 0.02, yy: 0.03, zz: 0.04, xy: 0.004, xz: -0.003, yz: 0.001 }, center_of_mass: [0, 0.05, 0.02], points: { C: { position: [0.1, -0.1, 0], rotation: { rpy: [0, 0.5, 0.1] } }, D: [0.3, 0.2, 0.1] } }
joints:
  hinge: { revolute: { between: [ground, bar.A], axis: [0, 0.6, 0.8] } }
  weld: { fixed: { between: [plate.C, bar.B], angle: 40 deg } }
effects:
  weight: { gravity: { acceleration: [0, 0, -9.81] } }
  spring: { spring_damper: { between: [ground, plate.D], stiffness: 30, damping: 0.2, free_length: 0.3 } }
  twist: { torque: { on: plate, value: [0.1, 0.2, 0.3] } }
initial: { hinge.angle: 0.4, hinge.angular_velocity: 1 }
outputs: { x: plate.D.x, z: plate.D.z, omega: plate.omega.y, alpha: plate.alpha_body.y, vy: plate.vy, load: hinge.force, energy: energy, moment: hinge.torque }
simulation: { duration: 0.3, step: STEP, output_step: 0.02, formulation: FORMULATION }
bounds: { scan: { points: 2 } }
";

/// Largest difference of two runs' bounds, output by output, relative to the output's size.
pub(crate) fn difference(a: &Bounds, b: &Bounds) -> Vec<(String, f64)> {
    let of = |(a, b): (&mbint::results::OutputBounds, &mbint::results::OutputBounds)| {
        assert_eq!(a.name, b.name);
        let size = a.nominal.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        let band = |one: &mbint::results::Band, other: &mbint::results::Band| {
            let lower = one.lower.iter().zip(&other.lower);
            lower.chain(one.upper.iter().zip(&other.upper)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
        };
        let nominal = a.nominal.iter().zip(&b.nominal).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        let bands = a.bands.iter().zip(&b.bands).map(|(a, b)| band(a, b));
        (a.name.clone(), bands.fold(nominal, f64::max) / size)
    };
    let same = |output: &&mbint::results::OutputBounds| a.outputs.iter().any(|known| known.name == output.name);
    a.outputs.iter().zip(b.outputs.iter().filter(same)).map(of).collect()
}

#[test]
fn welded_bodies_are_merged_if_no_output_needs_the_weld() {
    for (text, unknowns) in [(WELDED, (3, 6)), (WELDED_IN_SPACE, (8, 15))] {
        let model = |formulation: &str, step: &str, weld: bool| {
            let mut text = text.replace("FORMULATION", formulation).replace("STEP", step);
            if weld {
                text = text.replace("load: hinge.force,", "load: hinge.force, weld: weld.force,");
            }
            read(&text)
        };
        let joint = |step: &str, weld: bool| run(&model("joint", step, weld)).0;
        // In joint coordinates both are the same equations.
        for (name, off) in difference(&joint("1e-3", false), &joint("1e-3", true)) {
            assert!(off < 1e-9, "{name} is off by {off} of its size");
        }
        // In absolute coordinates the discretisation differs, with the square of the step.
        let absolute = |step: &str, weld: bool| run(&model("absolute", step, weld)).0;
        let coarse = difference(&absolute("1e-3", false), &absolute("1e-3", true));
        let fine = difference(&absolute("5e-4", false), &absolute("5e-4", true));
        for ((name, coarse), (_, fine)) in coarse.iter().zip(&fine) {
            assert!(*coarse < 1e-3, "{name} is off by {coarse} of its size");
            assert!(*fine < 0.3 * coarse || *fine < 1e-9, "{name}: {coarse}, {fine}");
        }
        // And merged, both formulations tend to the same.
        let across = |step: &str| difference(&absolute(step, false), &joint(step, false));
        for ((name, coarse), (_, fine)) in across("1e-3").iter().zip(&across("5e-4")) {
            assert!(*fine < 0.3 * coarse || *fine < 1e-9, "{name}: {coarse}, {fine}");
        }
        let sizes =
            |weld: bool| study::prepare(model("absolute", "1e-3", weld).study().description()).unwrap().system.q.len();
        assert_eq!((sizes(false), sizes(true)), unknowns);
    }
}

/// Sliders between linear springs and dampers: nothing of the Newton matrix changes with the motion, so nothing of it
/// is factorised in a step.
#[test]
fn constant_parts_are_eliminated_before_the_steps() {
    let sliders = |inertia: &str| {
        read(&format!(
            "
model: sliders
parameters: {{ m: {{ value: 2, unit: kg, tolerance: 10% }}, k: {{ value: 300, unit: N/m, tolerance: 10% }} }}
bodies:
  a: {{ mass: m, coordinates: [x] }}
  b: {{ mass: 2*m, coordinates: [x] }}
  bar: {{ mass: m, {inertia} }}
joints: {{ pin: {{ revolute: [b, bar] }} }}
effects:
  left: {{ spring_damper: {{ between: [ground, a], along: x, stiffness: k, damping: 2, free_length: 0.1 }} }}
  right: {{ spring_damper: {{ between: [a, b], along: x, stiffness: 2*k, damping: 1, free_length: 0.2 }} }}
  turn: {{ torque: {{ on: bar, value: 1 }} }}
initial: {{ a.x: 0.2, b.x: 0.3 }}
outputs: {{ a: a.x, b: b.x, turn: bar.angle }}
simulation: {{ duration: 1, step: 1e-3, formulation: absolute }}
"
        ))
    };
    let simulator = study::prepare(sliders("inertia: 0.3").study().description()).unwrap();
    let (program, system) = (&simulator.program, &simulator.system);
    let constant = |simulator: &mbint::inner::simulate::Simulator| {
        let system = &simulator.system;
        system.mass.iter().all(|&(_, _, value)| {
            let symbols = system.graph.symbols_of(&[value]);
            symbols.iter().all(|symbol| system.parameters.iter().any(|parameter| parameter.symbol == *symbol))
        })
    };
    assert!(constant(&simulator) && !system.mass.is_empty());
    let watched: usize = program.watched.iter().map(|version| version.pivots.len()).sum();
    assert_eq!((program.factor().len(), watched), (0, 0));
    assert!(program.sample().len() + program.step_size().len() > 0);
    // With a centre of mass off the frame's origin M depends on the angle, and the matrix with it.
    let simulator = study::prepare(sliders("inertia: 0.3, center_of_mass: [0.1, 0]").study().description()).unwrap();
    assert!(!constant(&simulator) && !simulator.program.factor().is_empty());
}

#[test]
fn every_decision_is_explained_with_its_saving() {
    let (a, b, c) =
        (pendulum("a", 0.0, ", tolerance: 2%"), pendulum("b", 0.3, ", tolerance: 1%"), pendulum("c", 0.1, ""));
    let model = a.with(&b).with(&c).with(&chain_of_ten()).model();
    let explanation = model.study().explain().unwrap();
    let find = |what: &str| {
        let decision = explanation.decisions.iter().find(|decision| decision.what.contains(what));
        decision.unwrap_or_else(|| panic!("{what}: {:#?}", explanation.decisions))
    };
    let saves = |what: &str| find(what).saves.unwrap().instructions;
    assert!(saves("31 parts not simulated: body idle0") > 0);
    assert_eq!(
        find("c moves on its own, simulated once").why,
        "nothing but the ground connects it to the rest; no uncertain parameter reaches it"
    );
    // 125 nodes and 125 points of three parameters, against 5 and 5 of one; each pendulum's instructions are counted
    // alone.
    let alone = |one: &Sections| -> usize { instructions(&one.model())[2..6].iter().sum() };
    assert_eq!(saves("a moves on its own"), (251 - 11) * alone(&a) as i64);
    assert_eq!(saves("c moves on its own"), (251 - 1) * alone(&c) as i64);
    assert!(saves("no output uses") > 0 && saves("once a sample") > 0, "{:#?}", explanation.decisions);
    assert!(find("folded into the instructions").saves.is_some());
    assert!(explanation.coordinates.iter().all(|name| !name.starts_with("idle")), "{:?}", explanation.coordinates);
    let left_out =
        |what: &str| explanation.left_out.iter().find(|item| item.what == what).map(|item| item.why.as_str());
    assert_eq!(left_out("parameter m_idle"), Some("nothing depends on it"));
    assert_eq!(left_out("joint idle_joint3"), Some("no output depends on it"));

    let welded = read(&WELDED.replace("FORMULATION", "absolute").replace("STEP", "1e-3"));
    let explanation = welded.study().explain().unwrap();
    let merged = explanation.decisions.iter().find(|decision| decision.what.contains("are one: weld")).unwrap();
    let mut kept = WELDED.replace("FORMULATION", "absolute").replace("STEP", "1e-3");
    kept = kept.replace("load: hinge.force,", "load: hinge.force, weld: weld.force,");
    let explanation = read(&kept).study().explain().unwrap();
    let stays = explanation.decisions.iter().find(|decision| decision.what == "bodies of joint weld stay two").unwrap();
    assert_eq!((stays.why.as_str(), stays.saves), ("its reaction is needed", None));
    let count = |text: &str| -> i64 { instructions(&read(text))[2..6].iter().sum::<usize>() as i64 };
    let merged_count = count(&WELDED.replace("FORMULATION", "absolute").replace("STEP", "1e-3"));
    assert_eq!(merged.saves.unwrap().instructions, count(&kept) - merged_count);
}

/// A number that the equations do not have is no dimension of the box.
#[test]
fn parameters_that_no_equation_has_are_not_sampled() {
    let model = read(
        "
model: slider
parameters: { m: { value: 2, unit: kg, tolerance: 10% }, J: { value: 1, unit: kg*m^2, tolerance: 10% } }
bodies: { slider: { mass: m, inertia: J, coordinates: [x] } }
effects: { spring: { spring_damper: { between: [ground, slider], along: x, stiffness: 30, free_length: 0.1 } } }
initial: { slider.x: 0.3 }
outputs: { x: slider.x, force: spring.force }
simulation: { duration: 0.5, step: 1e-3 }
bounds: { chebyshev: { order: 4 } }
",
    );
    let (bounds, summary) = run(&model);
    let simulations = summary.methods.iter().find(|method| method.method == "chebyshev").unwrap().simulations;
    assert_eq!((simulations, summary.parameters.len()), (5, 2));
    let total = |number: usize| bounds.contributions[0][number].total[20];
    assert!((total(0) - 1.0).abs() < 1e-9 && total(1) == 0.0, "{} {}", total(0), total(1));
}

/// Outputs can be observed even if nothing can move.
#[test]
fn bodies_at_rest_can_be_observed() {
    let text = |outputs: &str| {
        read(&format!(
            "
model: still
parameters: {{ d: {{ value: 0.2, unit: m, tolerance: 10% }} }}
bodies:
  ground: {{ points: {{ A: [1, 0] }} }}
  post: {{ mass: 1, inertia: 1, points: {{ P: [-d, 0], Q: [1 - d, d] }} }}
  free: {{ mass: 1, inertia: 1 }}
joints: {{ foot: {{ fixed: [ground, post.P] }} }}
effects: {{ tie: {{ spring_damper: {{ between: [ground.A, post.Q], stiffness: 10, free_length: 0 }} }} }}
outputs: {outputs}
simulation: {{ duration: 0.1, step: 1e-2 }}
bounds: {{ scan: {{ points: 3 }} }}
"
        ))
    };
    let ends = |description: &Subject, name: &str| {
        let bounds = run(description).0;
        let output = bounds.outputs.iter().find(|output| output.name == name).unwrap();
        (output.bands[0].lower[3], output.bands[0].upper[3])
    };
    let near = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() + (b - d).abs() < 1e-12;
    assert!(near(ends(&text("{ x: post.x }"), "x"), (0.18, 0.22)));
    assert!(near(ends(&text("{ pull: tie.force }"), "pull"), (1.8, 2.2)));
    assert!(near(ends(&text("{ pull: tie.force, x: free.x }"), "pull"), (1.8, 2.2)));
    assert!(near(ends(&text("{ d: d }"), "d"), (0.18, 0.22)));
}
