//! Gradients, pulled backwards from one output in one row, are the first derivatives that jets push forwards: the same
//! discrete motion, differentiated the other way round.

use std::path::{Path, PathBuf};

use mbint::Formulation;
use mbint::inner::assemble;
use mbint::inner::compile::Scheme;
use mbint::inner::model::{Analysis, Stepping};
use mbint::inner::numerics::Sample;
use mbint::inner::simulate::{
    Gradient, Integration, Interruption, JetBox, NoGradient, Observed, Schedule, Simulator, Steps, Wanted, gradients,
    jet_integrator,
};
use symdiff::jet::JetSpace;

use crate::common::{Subject, load_all, model_files};

const HHT: Scheme = Scheme::Hht { alpha: -0.1 };

/// Steps of the scheme, and rows.
const STEPS: usize = 48;
const ROWS: usize = 4;

/// Largest difference, relative to the largest derivative of the output by a parameter over its interval. By the scheme
/// jets have a centre that is solved to Newton's tolerance, which over h² is in accelerations; with one more correction
/// of the centre they differ by 1.8e-9 at most.
const DIFFERENCE: f64 = 1e-9;
const OF_SCHEME: f64 = 3e-8;

/// An influence on an output that is less than this share of its values (of 1, where these are smaller; SI) counts as
/// this much: the rest is rounding.
const SMALL: f64 = 1e-5;

/// The models and the examples of the documentation.
fn files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples");
    let examples = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut examples: Vec<PathBuf> =
        examples.filter(|path| path.extension().is_some_and(|extension| extension == "yaml")).collect();
    examples.sort();
    model_files().into_iter().chain(examples).collect()
}

/// Comparison of a model's gradients with jets.
#[derive(Debug, PartialEq)]
enum Found {
    /// Largest difference from jets.
    Agree(f64),
    /// Neither jets nor gradients exist: a step does not converge, is singular, or is no number.
    Neither,
    /// No motion.
    Refused,
}

/// First derivatives by jets, row by row, output by output, parameter by parameter, times half widths; `None` where
/// jets stop.
fn by_jets(simulator: &Simulator, schedule: &Schedule, about: JetBox<'_>) -> Option<Vec<f64>> {
    let space = JetSpace::new(about.center.len(), 1);
    let mut jets = Vec::new();
    let mut run = jet_integrator(simulator, &space, about, schedule).unwrap();
    let stops = run.advance(Steps { schedule, controller: None }, 0..schedule.rows, Observed::Outputs, &mut jets);
    let derivatives = jets.chunks_exact(space.len()).flat_map(|jet| jet[1..].to_vec()).collect();
    stops.is_empty().then_some(derivatives)
}

fn compared(simulator: &Simulator, schedule: &Schedule) -> Found {
    let parameters = &simulator.system.parameters;
    let center: Sample = parameters.iter().map(|parameter| parameter.nominal).collect();
    let half_width: Vec<f64> = parameters.iter().map(|parameter| 0.5 * (parameter.upper - parameter.lower)).collect();
    let (outputs, k) = (simulator.system.outputs.len(), parameters.len());
    let allowed = allowed(schedule);
    let wanted: Vec<Wanted> =
        (0..schedule.rows).flat_map(|row| (0..outputs).map(move |output| Wanted { sample: 0, row, output })).collect();
    let found = gradients(simulator, schedule, std::slice::from_ref(&center), &wanted, Interruption::default());
    let found: Vec<Gradient> = match found {
        Ok(found) => found,
        Err(NoGradient::NoMotion { .. }) => return Found::Refused,
        Err(other) => panic!("{other}"),
    };
    let is_lost = found.iter().any(|gradient| gradient.lost.is_some());
    let Some(jets) = by_jets(simulator, schedule, JetBox { center: &center, half_width: &half_width }) else {
        return Found::Neither;
    };
    assert!(!is_lost, "jets go on where gradients do not");
    let mut worst = 0.0_f64;
    for output in 0..outputs {
        let of_output = || (0..schedule.rows).map(move |row| row * outputs + output);
        let scale = of_output().flat_map(|at| &jets[at * k..][..k]).fold(0.0_f64, |most, jet| most.max(jet.abs()));
        let size = of_output().fold(1.0_f64, |most, at| most.max(found[at].value.abs()));
        let scale = scale.max(SMALL * size);
        for at in of_output() {
            for parameter in 0..k {
                let (gradient, jet) =
                    (found[at].by_parameters[parameter] * half_width[parameter], jets[at * k + parameter]);
                if !jet.is_finite() {
                    continue;
                }
                let difference = (gradient - jet).abs() / scale;
                if difference > worst || difference.is_nan() {
                    worst = difference;
                    if difference > allowed || difference.is_nan() {
                        println!(
                            "  {} row {} by {}: {gradient:e}, not {jet:e} (of {scale:e})",
                            simulator.system.outputs[output].name,
                            at / outputs,
                            parameters[parameter].name
                        );
                    }
                }
            }
        }
    }
    Found::Agree(worst)
}

/// Largest difference under a schedule.
fn allowed(schedule: &Schedule) -> f64 {
    if schedule.integration == Integration::Explicit { DIFFERENCE } else { OF_SCHEME }
}

/// Schedules of the first steps of a model, taken in the three ways.
fn schedules(description: &Subject) -> Vec<Schedule> {
    let study = description.study();
    let simulation = &study.description().simulation;
    let step = match simulation.stepping {
        Stepping::Fixed(step) => step,
        Stepping::Tolerance(_) => simulation.output_step / 4.0,
    };
    let duration = simulation.duration.min(STEPS as f64 * step);
    let output_step = duration / (ROWS - 1) as f64;
    let scheme = Schedule::fixed(duration, output_step / (STEPS / (ROWS - 1)) as f64, output_step);
    // Steps that pass over rows.
    let ends: Vec<f64> = (1..=STEPS / 4).map(|step| duration * step as f64 / (STEPS / 4) as f64).collect();
    let explicit = Schedule::passing(duration, duration / 5.0, ends, Vec::new());
    vec![scheme.clone(), scheme.taken(Integration::Extrapolated { levels: 2 }), explicit.taken(Integration::Explicit)]
}

#[test]
fn gradients_are_jets_of_first_order() {
    let mut failed = Vec::new();
    let [mut agreed, mut neither, mut refused] = [0; 3];
    for path in files() {
        // Stack-ups have no steps; their derivatives are compared in `stacks.rs`.
        let descriptions =
            load_all(&path).into_iter().filter(|own| own.study().description().analysis != Analysis::Dimensions);
        for description in descriptions {
            for formulation in [Formulation::Absolute, Formulation::Joint] {
                let system = match formulation {
                    Formulation::Absolute => {
                        assemble::in_absolute_coordinates(&assemble::Questions::of(description.study().description()))
                            .ok()
                    }
                    _ => assemble::in_joint_coordinates(
                        &assemble::Questions::of(description.study().description()),
                        None,
                        None,
                    )
                    .ok()
                    .and_then(Result::ok),
                };
                let Some(system) = system else { continue };
                if system.parameters.is_empty() || system.outputs.is_empty() {
                    continue;
                }
                for schedule in schedules(&description) {
                    let Ok(simulator) = Simulator::new(system.clone(), HHT, schedule.first_step()) else { continue };
                    let name = format!("{} {formulation:?} {:?}", description.name(), schedule.integration);
                    match compared(&simulator, &schedule) {
                        Found::Agree(difference) => {
                            agreed += 1;
                            if difference > allowed(&schedule) || difference.is_nan() {
                                println!("{name}: {difference:.2e}");
                                failed.push(name);
                            }
                        }
                        Found::Neither => {
                            println!("{name}: neither");
                            neither += 1;
                        }
                        Found::Refused => refused += 1,
                    }
                }
            }
        }
    }
    println!("{agreed} agree, {neither} have neither, {refused} are no motions");
    assert!(failed.is_empty(), "{failed:?}");
    assert!(agreed > 100, "only {agreed} were compared");
}
