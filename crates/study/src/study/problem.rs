//! A subsystem's question: the compiled mechanism, its box, and the methods that are asked for.

use std::sync::{Arc, OnceLock};

use super::black_box::source::ProgramSource;
use super::ensemble::{Motions, Progress, Stored};
use super::reduced::Store;
use super::{Options, RunError, zones};
use crate::methods::{BoundsRequest, Problem, Refusal, can_compose};
use crate::model::{Description, SchemeChoice, Stepping};
use crate::numerics::ParameterBox;
use crate::simulate::{Interruption, Schedule, Simulator, Steps};

/// A compiled subsystem, and its questions.
pub(super) struct Study<'a> {
    pub(super) description: &'a Description,
    pub(super) simulator: Simulator,
    pub(super) domain: ParameterBox,
    pub(super) request: BoundsRequest,
    /// Whether all samples are simulated with halved steps too.
    pub(super) certify_time: bool,
    /// Whether derivatives at the nominal parameters are wanted.
    pub(super) derivatives: bool,
    /// Reductions of outputs to one number, and their values in samples, if any.
    pub(super) store: OnceLock<Store>,
    pub(super) progress: &'a (dyn Fn(f64) + Sync),
    /// Called with the current activity.
    pub(super) stage: &'a (dyn Fn(&str) + Sync),
    /// Whether to stop with the finished parts.
    pub(super) interruption: Interruption<'a>,
    /// Where simulations are stored, if they are.
    pub(super) stored: Option<Stored<'a>>,
    /// The program that answers instead of a mechanism, if one does.
    pub(super) source: Option<Arc<ProgramSource>>,
}

/// Properties of a subsystem that its bounding methods need.
pub(super) fn problem(description: &Description, simulator: &Simulator) -> Problem {
    let parameters = simulator.system.parameters.len();
    let visits = simulator.system.analysis.visits();
    Problem {
        parameters,
        composes: !visits && can_compose(parameters, simulator.system.q.len()),
        has_fixed_steps: matches!(description.simulation.stepping, Stepping::Fixed(_))
            && description.simulation.extrapolation.is_none()
            && description.simulation.scheme != SchemeChoice::Explicit,
        has_equations: description.black_box.is_none(),
        tolerance: description.bounds.tolerance,
    }
}

impl<'a> Study<'a> {
    /// The study of a subsystem that is compiled already.
    ///
    /// # Errors
    /// If a method cannot bound it.
    pub(super) fn new(
        description: &'a Description,
        simulator: Simulator,
        options: &Options<'a>,
    ) -> Result<Self, RunError> {
        let parameters = &simulator.system.parameters;
        let domain = ParameterBox {
            nominal: parameters.iter().map(|parameter| parameter.nominal).collect(),
            lower: parameters.iter().map(|parameter| parameter.lower).collect(),
            upper: parameters.iter().map(|parameter| parameter.upper).collect(),
            zones: zones::of_names(description, parameters.iter().map(|parameter| parameter.name.as_str())),
        };
        let problem = problem(description, &simulator);
        let request = description.bounds.fitted(options.methods.as_deref(), &problem)?;
        let excited = || description.trajectories.iter().any(|own| own.excitation().is_some());
        if request.certified.is_some() && excited() {
            let why =
                "`certified` bounds are of constants, and the model has excitations that are functions of the time";
            return Err(Refusal(why.to_owned()).into());
        }
        let Options { certify_time, derivatives, progress, stage, interrupted, .. } = *options;
        let store = OnceLock::new();
        Ok(Self {
            description,
            simulator,
            domain,
            request,
            certify_time,
            derivatives,
            store,
            progress,
            stage,
            interruption: Interruption::new(interrupted),
            stored: None,
            source: ProgramSource::of(description).map(Arc::new),
        })
    }

    /// The same over a part of the box.
    pub(super) fn over<'b>(&'b self, part: &ParameterBox, progress: &'b (dyn Fn(f64) + Sync)) -> Study<'b> {
        let mut request = self.request.clone();
        request.methods_mut().into_iter().for_each(|(_, method)| method.restrict(part, &self.domain));
        let (simulator, store, source) = (self.simulator.clone(), OnceLock::new(), self.source.clone());
        Study { domain: part.clone(), derivatives: false, request, progress, simulator, store, source, ..*self }
    }

    /// Rows of output that are asked for.
    pub(super) fn rows(&self) -> usize {
        Schedule::rows_of(self.description.simulation.duration, self.description.simulation.output_step)
    }

    /// Whether several ensembles may be simulated at once: stored simulations and questions to a program are in order.
    pub(super) fn is_simulated_at_once(&self) -> bool {
        self.stored.is_none() && self.source.is_none()
    }

    /// The motions with these steps.
    pub(super) fn motions<'s>(&'s self, steps: Steps<'s>, progress: &'s Progress<'s>) -> Motions<'s> {
        let motions = Motions::new(&self.simulator, &self.domain, steps, progress, self.interruption);
        motions.keeping(self.store.get()).stored(self.stored).answered_by(self.source.as_deref())
    }
}
