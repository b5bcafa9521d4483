//! Verification of a model by manufactured solutions (Salari & Knupp, Sandia report SAND2000-1444; ASME V&V 10 and
//! 20): does *this* mechanism, with *these* effects, integrate as theory predicts?
//!
//! `motion` makes a smooth motion on the constraints, near the nominal one (`fit`), and the loads with which it
//! fulfils the equations of motion; `derivatives` compares the derivatives of all programs on it with differences,
//! and `balance` the powers of all effects with the mechanism's energy; `loaded` is the system with these loads,
//! whose exact solution is then known; `orders` measures how its errors fall with the steps. Where equations switch
//! there is no smooth motion: `windows` finds parts of the run between such instants.

mod balance;
mod derivatives;
mod fit;
mod loaded;
mod motion;
mod orders;
pub(crate) mod tuning;
mod windows;

use rayon::prelude::*;

use crate::assemble::{BuildError, Questions};
use crate::compile::compile_equations;
use crate::model::{Analysis, Description, Formulation, Stepping};
use crate::numerics::Sample;
use crate::results::{FormulationVerification, SchemeVerification, Verification};
use crate::simulate::{
    Integration, Observed, Schedule, SimulationError, Simulator, Steps, choose_independent, integrator,
};
use crate::study::black_box::needs_mechanism;
use crate::study::formulation::compiled;
use crate::study::{Options, RunError, first_step, pool, scheme};
use crate::syntax::{Code, Coded};

use balance::balance;
use derivatives::derivatives;
use fit::Nominal;
use loaded::{loaded, observed};
use motion::{EquationsAtPoint, Manufactured};
use orders::convergence;
use tuning::TUNING;
use windows::later;

/// Ways to integrate.
const INTEGRATIONS: [Integration; 3] =
    [Integration::Plain, Integration::Extrapolated { levels: 3 }, Integration::Explicit];

/// Why a formulation could not be verified.
#[derive(Clone, Debug, thiserror::Error)]
pub enum NotVerified {
    /// Not a single row.
    #[error("the nominal motion stops at once")]
    NoMotion,
    /// Its velocities or states jump.
    #[error("states of sampled controllers change at instants: no smooth motion has them")]
    Sampled,
    /// The constraints cannot be fulfilled near the motion.
    #[error("near t = {time} s no position on the constraints is found: the motion passes a singular configuration")]
    NotClosed {
        /// s
        time: f64,
    },
    /// The motion on the constraints is not smooth.
    #[error("the motion up to t = {end} s is not smooth enough")]
    NotSmooth {
        /// s
        end: f64,
    },
    /// The equations have no values.
    #[error("the equations of motion have no finite values up to t = {end} s")]
    NotFinite {
        /// s
        end: f64,
    },
    /// The equations are not smooth along the motion.
    #[error(
        "the equations of motion are not smooth up to t = {end} s: a contact, a stop or a condition switches, or friction is steep near rest"
    )]
    Kink {
        /// s
        end: f64,
    },
}

/// Why a model was not verified at all.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// It cannot be run either.
    #[error(transparent)]
    Run(#[from] RunError),
    /// It takes no steps.
    #[error("`analysis: {0}` takes no steps: there is nothing to verify")]
    NoSteps(&'static str),
    /// It was asked to stop.
    #[error("interrupted before there was a result")]
    Interrupted,
}

/// Verifies a model in all formulations that it has, by all ways to integrate it.
///
/// # Errors
/// If the model cannot be built or assembled, and at an interruption.
pub fn verify(description: &Description, options: &Options) -> Result<Verification, VerifyError> {
    needs_mechanism(description, "a verification").map_err(RunError::from)?;
    match description.analysis {
        Analysis::Statics => return Err(VerifyError::NoSteps("statics")),
        Analysis::Kinematics => return Err(VerifyError::NoSteps("kinematics")),
        Analysis::Modes(_) => return Err(VerifyError::NoSteps("modes")),
        _ => (),
    }
    let of = |formulation: Formulation| {
        (options.stage)("compiling");
        let questions = Questions { formulation, powers: true, ..Questions::of(description) };
        match compiled(&questions) {
            // Absolute coordinates are there already.
            Err(RunError::Build(BuildError::NoJointCoordinates { .. })) => Ok(Vec::new()),
            compiled => of_formulation(description, &compiled?, options),
        }
    };
    let pool = pool(options.threads);
    let found: Result<Vec<Vec<FormulationVerification>>, VerifyError> = pool
        .map_err(RunError::from)?
        .install(|| [Formulation::Absolute, Formulation::Joint].into_par_iter().map(of).collect());
    Ok(Verification { model: description.name.clone(), formulations: found?.into_iter().flatten().collect() })
}

fn of_formulation(
    description: &Description,
    simulator: &Simulator,
    options: &Options,
) -> Result<Vec<FormulationVerification>, VerifyError> {
    let (system, mobility) = (&simulator.system, &simulator.mobility);
    let mut found = FormulationVerification {
        formulation: system.formulation.name().to_owned(),
        coordinates: system.q.len(),
        constraints: system.lambda.len(),
        redundant: system.constraint_names(&mobility.redundant),
        singular_at_start: system.constraint_names(&mobility.singular_at_start),
        begin: 0.0,
        duration: 0.0,
        derivatives: Vec::new(),
        balance: None,
        schemes: Vec::new(),
        failure: None,
    };
    if !system.sampled.is_empty() {
        found.failure = Some(NotVerified::Sampled.to_string());
        return Ok(vec![found]);
    }
    (options.stage)("manufactured motion");
    let parameters: Sample = system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let nominal = nominal_motion(description, simulator, &parameters).map_err(RunError::from)?;
    let redundant: Vec<usize> = mobility.redundant.iter().map(|constraint| constraint.number()).collect();
    let mut equations = EquationsAtPoint::new(system, compile_equations(system), &parameters, redundant);
    let whole = nominal.times.last().copied().unwrap_or(0.0);
    let first = Manufactured::near(&nominal, &mut equations, [0.0, whole], TUNING.halvings_of_motion);
    let reached = first.as_ref().map_or(0.0, |motion| motion.end);
    let later = later(&nominal, &mut equations, reached);
    let motions = match (first, later) {
        (Err(why), None) => {
            found.failure = Some(why.to_string());
            return Ok(vec![found]);
        }
        (first, later) => first.ok().into_iter().chain(later),
    };
    motions.map(|motion| along(description, simulator, &mut equations, motion, &found, options)).collect()
}

/// Verifies along a motion; along a shorter one, or with more steps, if something is so stiff that orders do not
/// show with the steps of the first.
fn along(
    description: &Description,
    simulator: &Simulator,
    equations: &mut EquationsAtPoint,
    mut motion: Manufactured,
    found: &FormulationVerification,
    options: &Options,
) -> Result<FormulationVerification, VerifyError> {
    let mut own = found.clone();
    let whole = motion.clone();
    for attempt in 0..=TUNING.shortenings + 1 {
        let most = if attempt > TUNING.shortenings { TUNING.many_steps } else { TUNING.few_steps };
        motion = match attempt {
            1.. if attempt <= TUNING.shortenings => match whole.shortened(TUNING.shorter.powi(attempt), equations) {
                Some(shorter) => shorter,
                None => continue,
            },
            _ => whole.clone(),
        };
        match of_motion(description, simulator, &motion, most, options)? {
            Ok(schemes) => own.schemes = schemes,
            Err(error) => own.failure = Some(format!("the manufactured motion does not start: {error}")),
        }
        if own.is_verified() || own.failure.is_some() {
            break;
        }
    }
    (own.begin, own.duration) = (motion.begin, motion.length());
    (options.stage)("derivatives");
    own.derivatives = derivatives(simulator, equations, &motion);
    (options.stage)("balance of power");
    let parameters: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    own.balance = balance(&simulator.system, &motion, &parameters, equations.redundant());
    Ok(own)
}

/// Orders of all ways to integrate along a motion; why it does not start.
fn of_motion(
    description: &Description,
    simulator: &Simulator,
    motion: &Manufactured,
    most: usize,
    options: &Options,
) -> Result<Result<Vec<SchemeVerification>, SimulationError>, VerifyError> {
    let system = &simulator.system;
    let parameters: Sample = system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let start: Vec<f64> = motion.positions.iter().map(|own| own.at(motion.begin)).collect();
    let independent = choose_independent(simulator, &parameters, &start, motion.begin);
    let independent: Vec<usize> = independent.into_iter().map(|coordinate| coordinate.number()).collect();
    let loaded = loaded(system, motion, &independent);
    let loaded = Simulator::new(loaded, scheme(description), first_step(description).min(1e-2 * motion.length()));
    let loaded = match loaded {
        Ok(loaded) => loaded,
        Err(error) => return Ok(Err(error)),
    };
    let of = |integration: Integration| {
        (options.stage)("orders");
        let scheme = integration.name().unwrap_or_else(|| "HHT-I3".to_owned());
        match convergence(&loaded, motion, integration, most, options.interrupted) {
            Ok(convergence) => Ok(SchemeVerification { scheme, convergence, failure: None }),
            Err(SimulationError::Interrupted) => Err(VerifyError::Interrupted),
            Err(error) => Ok(SchemeVerification { scheme, convergence: Vec::new(), failure: Some(error.to_string()) }),
        }
    };
    INTEGRATIONS.into_par_iter().map(of).collect::<Result<_, _>>().map(Ok)
}

/// The nominal motion in rows, as far as steps of a fixed length go.
fn nominal_motion(
    description: &Description,
    simulator: &Simulator,
    parameters: &Sample,
) -> Result<Nominal, SimulationError> {
    let duration = description.simulation.duration;
    let row = duration / TUNING.rows_of_nominal as f64;
    let step = match description.simulation.stepping {
        Stepping::Fixed(step) => step,
        Stepping::Tolerance(_) => row,
    };
    let steps = (row / step).ceil().max(1.0);
    let schedule = Schedule::fixed(duration, row / steps, row);
    let observed = Simulator::new(observed(&simulator.system), scheme(description), schedule.first_step())?;
    let mut run = integrator(&observed, std::slice::from_ref(parameters), &schedule)?;
    let mut values = Vec::new();
    let stops =
        run.advance(Steps { schedule: &schedule, controller: None }, 0..schedule.rows, Observed::Outputs, &mut values);
    let count = observed.system.outputs.len();
    let reached = stops.first().map_or(schedule.rows, |stop| stop.row);
    let n = observed.system.q.len();
    let state = |row: &[f64]| [&row[..2 * n], &row[3 * n..]].concat();
    Ok(Nominal {
        times: (0..reached).map(|row| schedule.time(row)).collect(),
        states: values.chunks_exact(count).take(reached).map(state).collect(),
    })
}

impl Coded for VerifyError {
    fn code(&self) -> Option<Code> {
        match self {
            Self::Run(error) => error.code(),
            Self::NoSteps(_) => Some(Code::NoSteps),
            Self::Interrupted => None,
        }
    }
}
