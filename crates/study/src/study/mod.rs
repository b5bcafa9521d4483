//! Runs the requests of a model, on all cores and in bounded memory.
//!
//! `subsystems` separates a model into parts that do not interact; each becomes a `problem`: compiled (`formulation`
//! chooses the coordinates, `prepared` and `ready` go up to the start), with a box and methods. A `single` study of it
//! chooses the steps (`stepping`) and has the requested methods bound (`bounding`) the [`Ensemble`] of its motions
//! (`ensemble`), block by block of output rows, so that memory does not grow with samples × steps; `attained` searches
//! ends along gradients, `reduced` bounds numbers of a motion and decides requirements, and `deterministic` is the case
//! without uncertain parameters. `answers` makes bounds, a summary and stored surrogates of the findings. `feasible`
//! bounds the part of a box in which there is a motion, and `price` estimates a run. `drawing` and `motion` show the
//! mechanism, `internal` confines a panic, and `statistics` evaluates stored surrogates.
//!
//! A type has its methods in its own file; other files have functions that take it. So the imports of a file are
//! all that it uses, and a test finds circles.
//!
//! [`Ensemble`]: crate::methods::Ensemble

mod answers;
mod attained;
pub mod black_box;
mod bounding;
mod chains;
mod code;
mod deterministic;
mod drawing;
mod ensemble;
mod excited;
mod feasible;
pub mod formulation;
mod gradient;
mod internal;
mod motion;
pub mod prepared;
mod price;
mod problem;
mod ready;
pub mod reduced;
mod sample;
mod shard;
mod single;
mod sources;
pub mod statistics;
mod stepping;
mod structure;
pub mod subsystems;
mod threads;
mod tuning;
mod zones;

use crate::assemble::{BuildError, Questions};
use crate::compile::Scheme;
use crate::methods::{Keep, Method, Refusal};
use crate::model::{Description, Stepping};
use crate::reduce::Reduction;
use crate::results::{Bounds, Summary};
use crate::simulate::{SimulationError, Simulator};
use crate::store::PartStore;
use crate::syntax::{Code, Coded};

use prepared::Prepared;

pub use answers::{Evaluator, Kept, assemblies};
pub use code::{CodeError, code};
pub use drawing::drawing;
pub use feasible::Survey;
pub use gradient::{GradientError, gradient};
pub use internal::{InternalError, caught, record_panics};
pub use motion::{Grip, Hand, Held, MotionOptions, Movable, REPORT_SIZE, report_motion};
pub use price::{Allowance, Memory, Price};
pub use ready::{COMPILING, Ready, built, equations, ready};
pub use sample::{ChosenSamples, Sampled, sample};
pub use shard::simulate_parts;
pub use sources::sources;
pub use stepping::integration_decision;
pub use structure::structure;
pub use subsystems::uncertain;
pub use threads::{Threads, pool};
pub use tuning::tuning;

/// Options of a run.
pub struct Options<'a> {
    /// Instead of the methods that the model asks for.
    pub methods: Option<Vec<Method>>,
    /// Threads; all cores if absent.
    pub threads: Option<usize>,
    /// Whether the time steps' error is found by simulating every sample with halved steps too, instead of a few.
    pub certify_time: bool,
    /// Whether derivatives of the outputs at the nominal parameters are found too.
    pub derivatives: bool,
    /// Whether to omit the part of the box in which the mechanism cannot be assembled, or does not move to the end.
    pub skip_infeasible: bool,
    /// Whether to start a long run that the model does not allow; otherwise a run ends if it takes much longer than was
    /// estimated.
    pub costly: bool,
    /// Time limit of a run that nobody has allowed to take long.
    pub allowance: Option<&'a Allowance>,
    /// Store of simulations, if they are stored.
    pub store: Option<&'a PartStore>,
    /// Called before the first stored simulation with the disk space that all of them may need, bytes.
    pub disk: &'a (dyn Fn(u64) + Sync),
    /// Called now and then with the fraction that is done; 0 begins a new count, as for statistics after simulations.
    pub progress: &'a (dyn Fn(f64) + Sync),
    /// Called with the current activity, in a few words, whenever it changes.
    pub stage: &'a (dyn Fn(&str) + Sync),
    /// Called with the index of a subsystem before it is run, and with `None` before the work for all of them.
    pub subsystem: &'a (dyn Fn(Option<usize>) + Sync),
    /// Asked now and then whether to stop; methods that are done, and rows of those that are not, remain.
    pub interrupted: &'a (dyn Fn() -> bool + Sync),
}

impl Default for Options<'_> {
    /// The requests of the model, on all cores, without a limit of time: an interactive caller sets `costly`.
    fn default() -> Self {
        Self {
            methods: None,
            threads: None,
            certify_time: false,
            derivatives: false,
            skip_infeasible: false,
            costly: true,
            allowance: None,
            store: None,
            disk: &|_| (),
            progress: &|_| (),
            stage: &|_| (),
            subsystem: &|_| (),
            interrupted: &|| false,
        }
    }
}

/// Why nothing could be run at all.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The equations cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A simulation cannot start.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A method cannot bound this problem.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// Some samples cannot be assembled: their ranges.
    #[error("{0}. Narrow the intervals, or bound the rest with --skip-infeasible")]
    Infeasible(Box<Survey>),
    /// It would take long, and nobody has allowed it.
    #[error(transparent)]
    Costly(Price),
    /// Its results would not fit into memory.
    #[error(transparent)]
    Memory(Memory),
    /// An error of this program.
    #[error(transparent)]
    Internal(#[from] InternalError),
    /// The threads could not be started.
    #[error("the threads could not be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Runs every method asked for. A sample that stops early ends the bounds that need it: the rows reached are returned,
/// and the summary's `failure` gives the reason. The same holds if a method panics: the other methods' bounds remain.
///
/// # Errors
/// If the mechanism cannot be built, assembled or stepped at all.
pub fn run(description: &Description, options: Options) -> Result<(Bounds, Summary), RunError> {
    let pool = pool(options.threads)?;
    let model = reduced::expanded(description);
    let allowance = Allowance::begin();
    // The time of a program is unknown.
    let is_limited = !options.costly && description.black_box.is_none();
    let interrupted = || (options.interrupted)() || (is_limited && allowance.is_spent());
    let options = Options { interrupted: &interrupted, allowance: Some(&allowance), ..options };
    let found = pool.install(|| {
        if model.statistics.asked {
            return statistics::run(&model, description.outputs.len(), &options);
        }
        let (bounds, summary, _) = reduced::run(&model, &options, Keep::Nothing)?;
        Ok((bounds, summary))
    });
    let (bounds, summary) = found?;
    let (mut bounds, mut summary) = reduced::shown(description, &model, bounds, summary);
    summary.chains = chains::chains(description, &bounds);
    zones::joined(description, &mut bounds, &mut summary);
    summary.is_cut = interrupted();
    if let Some(why) = allowance.ended() {
        summary.failure = Some(why);
    }
    Ok((bounds, summary))
}

/// The same, and stores the surrogates, to be evaluated anywhere in the box. `None` if none covers the whole box: with
/// `skip_infeasible`, or if a subsystem's method ended at once.
///
/// # Errors
/// As for [`run`].
pub fn run_keeping(description: &Description, options: Options) -> Result<(Bounds, Summary, Option<Kept>), RunError> {
    let pool = pool(options.threads)?;
    let model = reduced::expanded(description);
    let (bounds, summary, kept) = pool.install(|| reduced::run(&model, &options, Keep::WholeBox))?;
    let (mut bounds, mut summary) = reduced::shown(description, &model, bounds, summary);
    zones::joined(description, &mut bounds, &mut summary);
    Ok((bounds, summary, kept))
}

/// Compiles all that `run` simulates into one model.
///
/// # Errors
/// As for [`run`].
pub fn prepare(description: &Description) -> Result<Simulator, RunError> {
    Ok(Prepared::new(Reduction::joined(description))?.simulator)
}

/// A whole model compiled, with the parts that no output depends on, and nothing merged.
///
/// # Errors
/// As for [`run`].
pub fn prepare_whole(description: &Description) -> Result<Simulator, RunError> {
    formulation::compiled(&Questions::of(description))
}

/// The model's scheme.
pub fn scheme(description: &Description) -> Scheme {
    Scheme::Hht { alpha: description.simulation.alpha }
}

/// Step size for computations before the first step.
pub fn first_step(description: &Description) -> f64 {
    match description.simulation.stepping {
        Stepping::Fixed(step) => step,
        Stepping::Tolerance(_) => 1e-2 * description.simulation.output_step,
    }
}

impl Coded for RunError {
    fn code(&self) -> Option<Code> {
        match self {
            Self::Build(error) => error.code(),
            Self::Simulation(error) => error.code(),
            Self::Refused(error) => error.code(),
            Self::Infeasible(_) => Some(Code::Infeasible),
            Self::Costly(_) | Self::Memory(_) => Some(Code::TooCostly),
            Self::Internal(_) | Self::Threads(_) => None,
        }
    }
}
