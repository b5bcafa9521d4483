//! Only what is asked for is simulated: parts that no output needs change nothing, islands are models of their own, welded bodies are one.

use std::fmt::Write as _;

use mbint::batch::{self, Options};
use mbint::bounds::{Bounds, Method};
use mbint::model::{self, Description};
use mbint::report::{MethodSummary, Summary, bounds_csv};

fn read(text: &str) -> Description {
    model::load_str("test", text, &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

#[track_caller]
fn run(description: &Description) -> (Bounds, Summary) {
    let (bounds, summary) = batch::run(description, Options { threads: Some(2), ..Options::default() }).unwrap();
    assert_eq!(summary.failure, None);
    (bounds, summary)
}

fn csv(bounds: &Bounds) -> String {
    String::from_utf8(bounds_csv(bounds).unwrap()).unwrap()
}

/// Instructions of every tape.
fn instructions(description: &Description) -> [usize; 9] {
    let simulator = batch::prepare(description).unwrap();
    let (p, s) = (&simulator.program, &simulator.start);
    [
        p.sample().len(),
        p.step_size().len(),
        p.step().len(),
        p.factor().len(),
        p.correct().len(),
        p.advance().len(),
        p.observe().len(),
        p.matrix().len(),
        s.position().len(),
    ]
}

/// Sections of a model file.
#[derive(Clone, Default)]
struct Sections {
    parameters: String,
    ground: String,
    bodies: String,
    joints: String,
    effects: String,
    initial: String,
    outputs: String,
    simulation: String,
    bounds: String,
}

impl Sections {
    fn add(&mut self, other: &Self) {
        self.parameters += &other.parameters;
        self.ground += &other.ground;
        self.bodies += &other.bodies;
        self.joints += &other.joints;
        self.effects += &other.effects;
        self.initial += &other.initial;
        self.outputs += &other.outputs;
    }

    fn with(&self, other: &Self) -> Self {
        let mut all = self.clone();
        all.add(other);
        all
    }

    fn model(&self) -> Description {
        let Self { parameters, ground, bodies, joints, effects, initial, outputs, simulation, bounds } = self;
        read(&format!(
            "model: test\nparameters:\n{parameters}bodies:\n  ground: {{ points: {{ O: [0, 0]{ground} }} }}\n{bodies}\
             joints:\n{joints}effects:\n  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}\n{effects}\
             initial:\n{initial}outputs:\n{outputs}simulation: {simulation}\nbounds: {bounds}\n"
        ))
    }
}

/// A pendulum at x, its length uncertain where a tolerance is given.
fn pendulum(name: &str, x: f64, tolerance: &str) -> Sections {
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
fn bodies_that_no_output_needs_change_nothing() {
    let bare = pendulum("a", 0.0, ", tolerance: 2%");
    let full = bare.with(&chain_of_ten());
    let (bare, full) = (bare.model(), full.model());
    assert_eq!(instructions(&bare), instructions(&full));
    let ((bounds, summary), (full_bounds, full_summary)) = (run(&bare), run(&full));
    assert_eq!(csv(&bounds), csv(&full_bounds));
    assert_eq!(summary.not_simulated, Vec::<String>::new());
    assert_eq!(full_summary.not_simulated.len(), 10 + 10 + 11);
    assert_eq!(full_summary.not_simulated[0], "body idle0");
    let solves = |summary: &Summary| summary.methods.iter().map(|method| method.solves).collect::<Vec<_>>();
    assert_eq!(solves(&summary), solves(&full_summary));
    assert_eq!(full_summary.parameters.len(), 2);
    // The one that nothing depends on has no part in anything.
    let idle = &full_bounds.contributions[0][1];
    assert_eq!(idle.parameter, "m_idle");
    assert!(idle.main.iter().all(|share| *share == 0.0));
    for (of_bare, of_full) in bounds.contributions.iter().zip(&full_bounds.contributions) {
        assert_eq!(of_bare[0], of_full[0]);
    }
}

#[test]
fn islands_are_models_run_apart() {
    let (a, b) = (pendulum("a", 0.0, ", tolerance: 2%"), pendulum("b", 0.3, ", tolerance: 1%"));
    let c = pendulum("c", 0.1, "");
    let both = a.with(&b).with(&c).model();
    let (together, summary) = run(&both);
    assert_eq!(summary.islands.len(), 3);
    for (island, one) in summary.islands.iter().zip([a, b, c]) {
        let (apart, of_one) = run(&one.model());
        let without_seconds = |methods: &[MethodSummary]| {
            let without = |method: &MethodSummary| MethodSummary { seconds: None, ..method.clone() };
            methods.iter().map(without).collect::<Vec<_>>()
        };
        assert_eq!(without_seconds(&island.methods), without_seconds(&of_one.methods));
        for output in &apart.outputs {
            let found = together.outputs.iter().find(|known| known.name == output.name).unwrap();
            assert_eq!(found, output, "{}", output.name);
        }
    }
    // 5 nodes of one parameter twice, and not 25; and the certain one not at all.
    let solves = |name: &str| summary.methods.iter().find(|method| method.method == name).unwrap().solves;
    assert_eq!((solves("nominal"), solves("chebyshev"), solves("scan")), (3, 10, 10));
    // Its own, and one with halved steps for its error.
    let certain = &summary.islands[2];
    assert_eq!(certain.parameters, Vec::<String>::new());
    let solves: Vec<(&str, usize)> =
        certain.methods.iter().map(|method| (method.method.as_str(), method.solves)).collect();
    assert_eq!(solves, [("nominal", 1), ("probes", 1), ("chebyshev", 0), ("taylor", 0), ("scan", 0)]);
    for output in together.outputs.iter().filter(|output| output.name.ends_with("_c")) {
        for band in &output.bands {
            assert_eq!(band.lower, output.nominal);
            assert_eq!(band.upper, output.nominal);
            assert!(band.error.total.iter().all(|error| *error >= 0.0), "{:?}", band.error);
        }
    }
}

/// An output that is no different, and makes the islands one.
#[test]
fn islands_simulated_together_give_the_same() {
    let (a, b) = (pendulum("a", 0.0, ", tolerance: 2%"), pendulum("b", 0.3, ", tolerance: 1%"));
    let apart = a.with(&b);
    let mut joined = apart.clone();
    joined.outputs += "  mixed: a.B.x - b.B.x\n";
    let ((apart, of_apart), (joined, of_joined)) = (run(&apart.model()), run(&joined.model()));
    assert_eq!((of_apart.islands.len(), of_joined.islands.len()), (2, 0));
    let solves = |summary: &Summary| summary.methods.iter().find(|method| method.method == "chebyshev").unwrap().solves;
    assert_eq!((solves(&of_apart), solves(&of_joined)), (10, 25));
    for (apart, joined) in apart.outputs.iter().zip(&joined.outputs) {
        assert_eq!(apart.name, joined.name);
        for (one, other) in apart.bands.iter().zip(&joined.bands) {
            let width = one.upper.iter().zip(&one.lower).map(|(upper, lower)| upper - lower).fold(0.0, f64::max);
            // What composition seeks on a grid over two parameters is coarser than over one.
            let allowed = if one.method == Method::Chebyshev { 1e-6 } else { 1e-9 };
            for (x, y) in one.lower.iter().zip(&other.lower).chain(one.upper.iter().zip(&other.upper)) {
                assert!((x - y).abs() <= allowed * width + 1e-12, "{} {:?}: {x} {y}", apart.name, one.method);
            }
        }
    }
    for (apart, joined) in apart.contributions.iter().zip(&joined.contributions) {
        for (one, other) in apart.iter().zip(joined) {
            assert_eq!(one.parameter, other.parameter);
            for (x, y) in one.total.iter().zip(&other.total).filter(|(x, _)| x.is_finite()) {
                assert!((x - y).abs() < 1e-6, "{x} {y}");
            }
        }
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
outputs: { x: plate.D.x, z: plate.D.z, omega: plate.omega.x, alpha: plate.alpha_body.y, vy: plate.vy, load: hinge.force, energy: energy, moment: hinge.torque }
simulation: { duration: 0.3, step: STEP, output_step: 0.02, formulation: FORMULATION }
bounds: { scan: { points: 2 } }
";

/// Largest difference of two runs' bounds, output by output, relative to the output's size.
fn difference(a: &Bounds, b: &Bounds) -> Vec<(String, f64)> {
    let of = |(a, b): (&mbint::bounds::OutputBounds, &mbint::bounds::OutputBounds)| {
        assert_eq!(a.name, b.name);
        let size = a.nominal.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        let band = |one: &mbint::bounds::Band, other: &mbint::bounds::Band| {
            let lower = one.lower.iter().zip(&other.lower);
            lower.chain(one.upper.iter().zip(&other.upper)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
        };
        let nominal = a.nominal.iter().zip(&b.nominal).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        let bands = a.bands.iter().zip(&b.bands).map(|(a, b)| band(a, b));
        (a.name.clone(), bands.fold(nominal, f64::max) / size)
    };
    let same = |output: &&mbint::bounds::OutputBounds| a.outputs.iter().any(|known| known.name == output.name);
    a.outputs.iter().zip(b.outputs.iter().filter(same)).map(of).collect()
}

#[test]
fn welded_bodies_are_one_where_nothing_asks_for_the_weld() {
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
        // In absolute coordinates the discretisation differs, by what falls with the square of the step.
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
        let sizes = |weld: bool| batch::prepare(&model("absolute", "1e-3", weld)).unwrap().system.q.len();
        assert_eq!((sizes(false), sizes(true)), unknowns);
    }
}

/// What is welded to the ground moves nothing and connects nothing.
#[test]
fn a_base_that_is_welded_to_the_ground_is_the_ground() {
    let text = |outputs: &str| {
        read(&format!(
            "
model: base
parameters: {{ l: {{ value: 0.5, unit: m, tolerance: 2% }}, m_base: {{ value: 5, unit: kg, tolerance: 10% }} }}
bodies:
  base: {{ mass: m_base, inertia: 1, points: {{ O: [0, 0], A: [0.2, 0.1], B: [0.7, 0.1] }} }}
  left: {{ mass: 1, inertia: 0.1, points: {{ P: [-l, 0] }} }}
  right: {{ mass: 1, inertia: 0.1, points: {{ P: [-0.4, 0] }} }}
joints:
  foot: {{ fixed: [ground, base.O] }}
  a: {{ revolute: [base.A, left.P] }}
  b: {{ revolute: [base.B, right.P] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ left.angle: 0.1, right.angle: -0.2 }}
outputs: {outputs}
simulation: {{ duration: 0.3, step: 1e-3 }}
bounds: {{ scan: {{ points: 3 }} }}
"
        ))
    };
    let (apart, summary) = run(&text("{ x: left.x, y: right.y }"));
    let bodies: Vec<Vec<String>> = summary.islands.iter().map(|island| island.bodies.clone()).collect();
    assert_eq!(bodies, [["base", "left"], ["base", "right"]]);
    assert_eq!(summary.islands[0].parameters, ["l"]);
    assert!(summary.islands[1].parameters.is_empty());
    // The reaction at the foot is that of all.
    let (whole, summary) = run(&text("{ x: left.x, y: right.y, foot: foot.force }"));
    assert!(summary.islands.is_empty() && summary.not_simulated.is_empty());
    assert_eq!(summary.parameters.len(), 2);
    for (name, off) in difference(&apart, &Bounds { outputs: whole.outputs[..2].to_vec(), ..whole.clone() }) {
        assert!(off < 1e-9, "{name} is off by {off} of its size");
    }
}
