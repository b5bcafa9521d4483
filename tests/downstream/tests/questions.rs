//! Every question of the command line, asked from Rust.

use mbint::results::{Criterion, Verdict};
use mbint::{Axis, Error, Formulation, Method, Model, RangeKind, SchemeChoice, Study};

/// A gap c − a − 2b of 1 mm, whose normal parts add to σ² = (0.1² + 0.4² + 0.1²)/9 mm².
const STACK: &str = "
model: stack
parameters:
  a: { value: 30 mm, tolerance: 0.1 mm, cost: { reciprocal: 1 }, distribution: normal }
  b: { value: 10 mm, tolerance: 0.2 mm, cost: { reciprocal: 4 }, distribution: normal }
  c: { value: 51 mm, tolerance: 0.1 mm, cost: { reciprocal: 2 }, distribution: normal }
bodies: { block: { mass: 1, coordinates: [x] } }
initial: { block.x: c - a - 2*b, block.vx: 0 }
outputs: { gap: block.x, widest: { max: gap } }
requirements: { fits: { output: gap, min: 0.4 mm, max: 1.5 mm } }
simulation: { duration: 0.02, step: 0.01 }
bounds: { chebyshev: { order: 1 } }
statistics: { quantiles: [0.5] }
";

fn stack() -> Model {
    Model::from_yaml_str("stack.yaml", STACK).unwrap()
}

#[track_caller]
fn near(found: f64, wanted: f64) {
    assert!((found - wanted).abs() <= 1e-6 * wanted.abs().max(1e-3), "{found} {wanted}");
}

#[test]
fn bounds_and_statistics_of_a_stack_match_sums() {
    let result = stack().study().run().unwrap();
    let gap = result.output("gap").unwrap();
    let band = gap.band(Method::Chebyshev).unwrap();
    near(band.lower()[0], 0.4e-3);
    near(band.upper()[0], 1.6e-3);
    let [fits] = result.verdicts() else { panic!("{:?}", result.verdicts()) };
    assert_eq!(fits.verdict, Verdict::Violated);
    near(fits.margin, -0.1e-3);
    let [widest] = result.reduced() else { panic!("{:?}", result.reduced()) };
    near(widest.nominal, 1e-3);
    let statistics = result.statistics().unwrap();
    let deviation = statistics.outputs[0].deviation[0];
    let off = (deviation.value - (0.01_f64 + 0.16 + 0.01).sqrt() / 3.0 * 1e-3).abs();
    assert!(off <= 3.0 * deviation.sampling + deviation.error, "{deviation:?}");
    assert!(result.snapshot().contains("gap [m]"), "{}", result.snapshot());
    assert_eq!(result.summary().model, "stack");
}

#[test]
fn a_model_is_checked_and_explained_before_it_runs() {
    stack().check().unwrap();
    let explanation = stack().study().explain().unwrap();
    assert_eq!(explanation.coordinates.len(), 1, "{explanation:?}");
    // A bar of 1 m does not reach over 3 m.
    let apart = "
bodies: { bar: { mass: 1, inertia: 1, points: { left: [-0.5, 0], right: [0.5, 0] } }, ground: { points: { far: [3, 0] } } }
joints: { one: { revolute: [ground, bar.left] }, two: { revolute: [ground.far, bar.right] } }
outputs: { angle: bar.angle }
simulation: { duration: 1, step: 0.1 }
";
    let error = Model::from_yaml_str("apart.yaml", apart).unwrap().check().unwrap_err();
    assert!(matches!(error, Error::Run(_)), "{error}");
}

#[test]
fn the_nominal_motion_alone_has_no_bands() {
    let result = stack().study().nominal().run().unwrap();
    let gap = result.output("gap").unwrap();
    near(gap.nominal()[0], 1e-3);
    assert_eq!(gap.bands().count(), 0);
    assert!(result.statistics().is_none());
    assert_eq!(result.bounds().outputs.len(), 1);
    // A method that is chosen afterwards is run.
    let result = stack().study().nominal().chebyshev(1).run().unwrap();
    assert!(result.output("gap").unwrap().band(Method::Chebyshev).is_some());
}

const SWING: &str = "
model: swing
parameters: { l: { value: 0.8, unit: m, tolerance: 2% } }
bodies: { rod: { mass: 1, inertia: 0.05, points: { pin: [-l/2, 0] } } }
joints: { hinge: { revolute: [ground, rod.pin] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { rod.angle: 0, rod.angular_velocity: 0 }
outputs: { angle: rod.angle }
simulation: { duration: 0.4, step: 1e-3, output_step: 0.1 }
bounds: { chebyshev: { order: 3 }, scan: { points: 4 } }
";

fn swing() -> Model {
    Model::from_yaml_str("swing.yaml", SWING).unwrap()
}

/// The angle at the end.
fn end(study: Study) -> f64 {
    *study.run().unwrap().output("angle").unwrap().nominal().last().unwrap()
}

/// Coordinates, schemes, steps and rows are the study's: the motion stays, to the errors of the steps.
#[test]
fn study_sets_the_integration() {
    let plain = end(swing().study().nominal().step(1e-4));
    let studies = [
        swing().study().formulation(Formulation::Absolute).extrapolation(3),
        swing().study().scheme(SchemeChoice::Explicit).step_tolerance(1e-8),
        swing().study().alpha(-0.05).step(2e-4),
    ];
    for study in studies {
        let found = end(study.nominal());
        assert!((found - plain).abs() < 1e-5, "{found}, not {plain}");
    }
    let result = swing().study().nominal().output_step(0.05).run().unwrap();
    assert_eq!(result.times().len(), 9);
    let coordinates = |formulation| swing().study().formulation(formulation).explain().unwrap().coordinates.len();
    assert_eq!((coordinates(Formulation::Joint), coordinates(Formulation::Absolute)), (1, 3));
}

#[test]
fn settings_outside_of_their_ranges_are_errors() {
    for (study, message) in [
        (swing().study().step(0.0), "the step must be positive, but is 0"),
        (swing().study().output_step(f64::NAN), "the output step must be positive, but is NaN"),
        (swing().study().duration(-1.0), "the duration must be positive, but is -1"),
        (swing().study().step_tolerance(-1.0), "the tolerance of the steps must be positive, but is -1"),
        (swing().study().alpha(0.0), "α = 0 is outside [-1/3, 0)"),
        (swing().study().extrapolation(5), "`extrapolation` combines 2, 3 or 4 step lengths, not 5"),
        (
            swing().study().extrapolation(2).scheme(SchemeChoice::Explicit),
            "`extrapolation` is of HHT-I3, but the `scheme` is `explicit`",
        ),
    ] {
        let error = study.run().unwrap_err();
        assert!(matches!(error, Error::Setting(_)), "{error}");
        assert_eq!((error.to_string().as_str(), error.code()), (message, Some("E0307")));
    }
}

#[test]
fn methods_of_a_study_override_those_of_the_model() {
    let methods = |study: Study| -> Vec<Method> {
        study.run().unwrap().output("angle").unwrap().bands().map(|band| band.method()).collect()
    };
    assert_eq!(methods(swing().study()), [Method::Chebyshev, Method::Scan]);
    assert_eq!(methods(swing().study().methods(&[Method::Scan, Method::Taylor])), [Method::Taylor, Method::Scan]);
    let simulations = |study: Study, name: &str| {
        let result = study.run().unwrap();
        result.summary().methods.iter().find(|own| own.method == name).unwrap().simulations
    };
    // As the model requests.
    assert_eq!(simulations(swing().study().methods(&[Method::Scan]), "scan"), 4);
    // An interval evaluation is wider than the polynomial's own range.
    let widths = [RangeKind::Tight, RangeKind::Interval].map(|range| {
        let result = swing().study().chebyshev(4).range(range).run().unwrap();
        let band = result.output("angle").unwrap().best().unwrap();
        band.upper().last().unwrap() - band.lower().last().unwrap()
    });
    assert!(widths[1] > widths[0], "{widths:?}");
    let [few, enough] = [3, 1000].map(|most| simulations(swing().study().tolerance(1e-7).budget(most), "chebyshev"));
    assert!(few <= 3 && enough > 3, "{few} {enough}");
}

#[test]
fn requested_outputs_are_observed() {
    let model = swing().observing(&[("tip", "rod.x + 0.1 m"), ("energy", "energy")]).unwrap();
    assert_eq!(model.outputs().collect::<Vec<_>>(), [("tip", "m"), ("energy", "J")]);
    assert_eq!(model.duration(), 0.4);
    // They stay where a parameter is set.
    let longer = model.with("l", "1 m ± 1%").unwrap();
    near(longer.study().nominal().run().unwrap().output("tip").unwrap().nominal()[0], 0.6);
    let error = swing().observing(&[("tip", "rad.x")]).unwrap_err();
    assert!(error.to_string().contains("unknown body or joint `rad`"), "{error}");
}

/// The worst function of an excitation, replayed.
#[test]
fn witnesses_are_replayed() {
    let text = SWING.replace(
        "effects: { ",
        "excitations: { push: { within: ± 1 N } }\neffects: { shove: { force: { on: rod, value: [push, 0] } }, ",
    );
    let model = Model::from_yaml_str("pushed.yaml", &text).unwrap();
    let worst = model.study().run().unwrap().bounds().functions.first().unwrap().clone();
    let rows = worst.functions[0].points.iter().map(|(time, value)| format!("{time},{value}\n"));
    let replayed = model.clone().replaying(&format!("t,push\n{}", rows.collect::<String>())).unwrap();
    let result = replayed.study().nominal().run().unwrap();
    let row = result.times().iter().position(|time| Some(*time) == worst.time).unwrap();
    let found = result.output("angle").unwrap().nominal()[row];
    assert!((found - worst.value).abs() < 0.05 * worst.value.abs(), "{found}, not {}", worst.value);
    let error = model.replaying("t,pull\n0,1\n1,1\n").unwrap_err();
    assert!(matches!(error, Error::Witness(_)), "{error}");
}

#[test]
fn costly_study_needs_permission() {
    // 30³ simulations.
    let scan = |study: Study<'static>| study.nominal().scan(30).interrupted(&|| true);
    let error = scan(stack().study()).run().unwrap_err();
    assert!(matches!(error, Error::Run(_)) && error.code() == Some("E1003"), "{error}");
    assert!(error.to_string().contains("allow_costly"), "{error}");
    scan(stack().study().allow_costly()).run().unwrap();
    // A sweep does not pass over it as over a mechanism that cannot be assembled.
    let axis = Axis::new("a", &[30.0, 30.1]).with("mm ± 0.1 mm");
    let error = stack().sweep(&[axis], scan).err().unwrap();
    assert_eq!(error.code(), Some("E1003"), "{error}");
}

#[test]
fn tolerances_that_meet_requirements_fill_the_margin() {
    let found = stack().study().allocate(Criterion::WorstCase, 3.0).unwrap();
    assert!(found.is_confirmed && found.not_met.is_empty());
    let after: Vec<f64> = found.tolerances.iter().map(|own| own.after.above).collect();
    // All of the 0.5 mm to the nearer limit, and to a part in a thousand.
    let taken = after[0] + 2.0 * after[1] + after[2];
    assert!(taken <= 0.5e-3 && taken > 0.4995e-3, "{after:?}");
    let error = Model::from_yaml_str("stack.yaml", &STACK.replace("requirements:", "# ")).unwrap();
    let error = error.study().allocate(Criterion::Share(0.99), 3.0).unwrap_err();
    assert!(matches!(error, Error::Unsuitable(_)), "{error}");
}

#[test]
fn samples_and_sweeps_take_chosen_values() {
    let model = stack();
    let names: Vec<&str> = model.uncertain().map(|(name, _)| name).collect();
    assert_eq!(names, ["a", "b", "c"]);
    let samples = model.study().sample(&[vec![0.03, 0.01, 0.051], vec![0.0301, 0.0102, 0.051]]).unwrap();
    near(samples.course(0, "gap").unwrap()[0], 1e-3);
    near(samples.course(1, "gap").unwrap()[0], 0.5e-3);
    assert_eq!((samples.course(2, "gap"), samples.course(0, "gaps")), (None, None));
    assert_eq!((samples.not_assembled(), samples.stopped()), (0, 0));
    let error = model.study().sample(&[vec![0.03]]).unwrap_err();
    assert_eq!(error.to_string(), "point 0 needs a finite value for each of a, b, c");

    let axes = [Axis::new("a", &[29.8, 30.2]).with("mm"), Axis::new("b", &[10.0, 10.1]).with("mm ± 0.1 mm")];
    let sweep = model.sweep(&axes, |study| study.chebyshev(1).threads(1)).unwrap();
    let widest = |index: usize| {
        let (values, summary) = sweep.points().nth(index).unwrap();
        (values.to_vec(), summary.unwrap().reduced[0].nominal)
    };
    // The last parameter changes fastest.
    assert_eq!(widest(1).0, [29.8, 10.1]);
    near(widest(1).1, 51e-3 - 29.8e-3 - 20.2e-3);
    near(widest(2).1, 51e-3 - 30.2e-3 - 20e-3);
}

#[test]
fn costs_are_measured_against_a_reference() {
    let text = "
parameters: { k: 9 N/m ± 5% }
bodies: { b: { mass: 1, coordinates: [x] } }
effects: { s: { spring_damper: { between: [ground, b], along: x, stiffness: k, free_length: 0 } } }
initial: { b.x: 1 }
outputs: { x: b.x }
simulation: { duration: 2, step: 1e-3 }
bounds: { chebyshev: { order: 3 } }
";
    let model = Model::from_yaml_str("oscillator.yaml", text).unwrap();
    let study = model.study().threads(1).cost(1e-2, 6.0).unwrap();
    // On a busy machine the budget may not allow a reference: nothing is measured then, and this is reported.
    assert_eq!(study.has_reference(), !study.trajectories.is_empty());
    assert!(study.has_reference() || !study.left_out.is_empty());
    assert!(study.trajectories.iter().filter(|point| point.failure.is_none()).all(|point| point.seconds > 0.0));
}

#[test]
fn interrupted_run_reports_interruption() {
    let error = stack().study().interrupted(&|| true).sample(&[vec![0.03, 0.01, 0.051]]).unwrap_err();
    assert!(error.to_string().contains("interrupted"), "{error}");
}

#[test]
fn models_with_errors_show_their_lines() {
    let error = Model::from_yaml_str("stack.yaml", &STACK.replace("block.x,", "blok.x,")).unwrap_err();
    assert!(error.to_string().contains("stack.yaml:9:17"), "{error}");
}

#[test]
fn a_study_of_costs_is_written() {
    let place = std::env::temp_dir().join("mbint_downstream_cost");
    let study = swing().study().cost(1e-2, 1.0).unwrap();
    let files = mbint::write_cost(&study, &place).unwrap();
    assert!(!files.is_empty() && files.iter().all(|file| file.is_file()), "{files:?}");
    std::fs::remove_dir_all(place).unwrap();
}

#[test]
fn certificate_of_a_study_is_valid() {
    use mbint::certificate::{Certificate, check};
    let result = swing().study().certified().run().unwrap();
    let systems = result.bounds().certified.clone();
    assert!(!systems.is_empty());
    check(&Certificate { model: "swing".to_owned(), files: Vec::new(), systems }).unwrap();
}
