//! A study: the methods that bound a model, and their settings.

use super::{Error, Samples, StudyResult};
use crate::applications::{
    AllocateOptions, CostOptions, DesignOptions, Measurements, NoiseBound, allocate, cost, design, explain, fit,
};
use crate::methods::{BoundsRequest, Certified, Chebyshev, Expand, Method, Proof, Scan, Taylor};
use crate::model::{Description, Formulation, NOT_OF_EXPLICIT, SchemeChoice, Stepping, refused_alpha, refused_levels};
use crate::numerics::RangeKind;
use crate::results::{Allocation, CostStudy, Criterion, DesignStudy, Explanation, Fit};
use crate::study::{Options, run};

/// A run of a model in preparation. Methods add up; the first chosen one replaces those of the model's `bounds:`. A
/// setting outside of its range is an [`Error::Setting`] of every question to the study.
pub struct Study<'a> {
    description: Description,
    options: Options<'a>,
    /// Whether the methods are no longer the model's.
    chosen: bool,
    /// The first setting that is outside of its range.
    wrong: Option<String>,
}

impl<'a> Study<'a> {
    pub(super) fn new(description: Description) -> Self {
        Self { description, options: Options { costly: false, ..Options::default() }, chosen: false, wrong: None }
    }

    fn choose(&mut self) -> &mut BoundsRequest {
        let bounds = &mut self.description.bounds;
        if !std::mem::replace(&mut self.chosen, true) {
            *bounds = BoundsRequest { tolerance: bounds.tolerance, budget: bounds.budget, ..BoundsRequest::default() };
        }
        bounds
    }

    fn parameters(&self) -> usize {
        self.description.uncertain().count()
    }

    /// Chebyshev bounds with polynomials of a degree in each parameter: (order + 1)^k simulations of k parameters.
    #[must_use]
    pub fn chebyshev(mut self, order: usize) -> Self {
        let request = Chebyshev::of_order(order, self.parameters());
        self.choose().chebyshev = Some(request);
        self
    }

    /// Taylor bounds of a total degree: one simulation, in polynomials of the parameters.
    #[must_use]
    pub fn taylor(mut self, order: usize) -> Self {
        self.choose().taylor = Some(Taylor { order, ..Taylor::default() });
        self
    }

    /// The nominal motion without the model's bounds and statistics; chosen methods run in addition.
    #[must_use]
    pub fn nominal(mut self) -> Self {
        self.choose();
        // Statistics are evaluated on a surrogate, which belongs to a bounding method.
        self.description.statistics.asked = false;
        self
    }

    /// The smallest and largest values on a grid with `points` points per parameter: points^k simulations, always too
    /// narrow.
    #[must_use]
    pub fn scan(mut self, points: usize) -> Self {
        let request = Scan::of_points(points, self.parameters());
        self.choose().scan = Some(request);
        self
    }

    /// Proven bounds of the true motion: at most three parameters.
    #[must_use]
    pub fn certified(mut self) -> Self {
        self.choose().certified = Some(Certified { proof: Proof::Motion });
        self
    }

    /// Proven bounds of the discretised motion: one or two parameters, a fixed step.
    #[must_use]
    pub fn certified_scheme(mut self) -> Self {
        self.choose().certified = Some(Certified { proof: Proof::Scheme });
        self
    }

    /// Chebyshev bounds of the degrees that meet an error, relative to the range of each output over the run.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        let bounds = self.choose();
        bounds.tolerance = Some(tolerance);
        bounds.chebyshev = Some(Chebyshev::ADAPTIVE);
        self
    }

    /// Most simulations of the search for bounds within a tolerance.
    #[must_use]
    pub fn budget(mut self, simulations: usize) -> Self {
        self.description.bounds.budget.simulations = simulations;
        self
    }

    /// Kind of ranges of polynomials: of those by Taylor, and of those by Chebyshev, which then expands outputs instead
    /// of coordinates. It applies to the methods chosen before, otherwise to the model's.
    #[must_use]
    pub fn range(mut self, range: RangeKind) -> Self {
        let bounds = &mut self.description.bounds;
        if let Some(taylor) = &mut bounds.taylor {
            taylor.range = range;
        }
        if let Some(chebyshev) = &mut bounds.chebyshev {
            (chebyshev.expand, chebyshev.range) = (Expand::Output, range);
        }
        self
    }

    /// Runs these bounding methods only, each as requested before, otherwise with its defaults.
    #[must_use]
    pub fn methods(mut self, methods: &[Method]) -> Self {
        self.options.methods = Some(methods.to_vec());
        self
    }

    /// Stores an error if a setting is not positive.
    fn positive(&mut self, what: &str, value: f64) {
        if !(value > 0.0 && value.is_finite()) {
            self.wrong.get_or_insert_with(|| format!("{what} must be positive, but is {value}"));
        }
    }

    /// Another duration, s.
    #[must_use]
    pub fn duration(mut self, seconds: f64) -> Self {
        self.positive("the duration", seconds);
        self.description.simulation.duration = seconds;
        self
    }

    /// Another fixed time step, s.
    #[must_use]
    pub fn step(mut self, seconds: f64) -> Self {
        self.positive("the step", seconds);
        self.description.simulation.stepping = Stepping::Fixed(seconds);
        self
    }

    /// Time steps of variable length that keep their error within a tolerance, relative to the coordinates or to the
    /// model's size.
    #[must_use]
    pub fn step_tolerance(mut self, tolerance: f64) -> Self {
        self.positive("the tolerance of the steps", tolerance);
        self.description.simulation.stepping = Stepping::Tolerance(tolerance);
        self
    }

    /// Another time between rows of output, s; a multiple of the step if that is fixed.
    #[must_use]
    pub fn output_step(mut self, seconds: f64) -> Self {
        self.positive("the output step", seconds);
        self.description.simulation.output_step = seconds;
        self
    }

    /// Coordinates of the motion.
    #[must_use]
    pub fn formulation(mut self, formulation: Formulation) -> Self {
        self.description.simulation.formulation = formulation;
        self
    }

    /// The scheme that integrates the motion.
    #[must_use]
    pub fn scheme(mut self, scheme: SchemeChoice) -> Self {
        self.description.simulation.scheme = scheme;
        self
    }

    /// Numerical damping of HHT-I3: α from -1/3, the most, to below 0.
    #[must_use]
    pub fn alpha(mut self, alpha: f64) -> Self {
        self.wrong = self.wrong.or_else(|| refused_alpha(alpha));
        self.description.simulation.alpha = alpha.max(-1.0 / 3.0);
        self
    }

    /// Extrapolation over `levels` step lengths, 2 to 4, by HHT-I3; 1 for none.
    #[must_use]
    pub fn extrapolation(mut self, levels: usize) -> Self {
        self.wrong = self.wrong.or_else(|| refused_levels(levels as f64).filter(|_| levels != 1));
        self.description.simulation.extrapolation = (levels > 1).then_some(levels);
        self
    }

    /// Threads to run on; by default all cores. Results are the same for any number.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.options.threads = Some(threads);
        self
    }

    /// Bounds the rest if the mechanism cannot be assembled, or locks, in a part of the parameters' box.
    #[must_use]
    pub fn skip_infeasible(mut self) -> Self {
        self.options.skip_infeasible = true;
        self
    }

    /// Estimates the time steps' error by all samples with halved steps, instead of a few.
    #[must_use]
    pub fn certify_steps(mut self) -> Self {
        self.options.certify_time = true;
        self
    }

    /// Also runs studies of more than 20 000 simulations or about a minute, which are refused otherwise ([`Error::Run`]
    /// with the code `E1003`), and lets a run take much longer than estimated.
    #[must_use]
    pub fn allow_costly(mut self) -> Self {
        self.options.costly = true;
        self
    }

    /// Calls a function now and then with the finished fraction.
    #[must_use]
    pub fn progress(mut self, progress: &'a (dyn Fn(f64) + Sync)) -> Self {
        self.options.progress = progress;
        self
    }

    /// Calls a function with the current activity, in a few words, whenever it changes.
    #[must_use]
    pub fn stage(mut self, stage: &'a (dyn Fn(&str) + Sync)) -> Self {
        self.options.stage = stage;
        self
    }

    /// Polls a function for a stop. The result has the parts finished by then.
    #[must_use]
    pub fn interrupted(mut self, interrupted: &'a (dyn Fn() -> bool + Sync)) -> Self {
        self.options.interrupted = interrupted;
        self
    }

    /// The study, if all settings are within their ranges.
    fn checked(mut self) -> Result<Self, Error> {
        let simulation = &self.description.simulation;
        if simulation.scheme == SchemeChoice::Explicit && simulation.extrapolation.is_some() {
            self.wrong.get_or_insert_with(|| NOT_OF_EXPLICIT.to_owned());
        }
        self.wrong.take().map_or(Ok(self), |message| Err(Error::Setting(message)))
    }

    /// The compiled form of the model, with the study's settings: coordinates, instructions of a step, costs of
    /// effects, and the reasons.
    ///
    /// # Errors
    /// [`Error::Run`]: it cannot be built or assembled, or a program answers instead of a mechanism.
    pub fn explain(self) -> Result<Explanation, Error> {
        Ok(explain(&self.checked()?.description)?)
    }

    /// The cheapest, or loosest, tolerances with which all requirements hold in every case or in a share of the
    /// production; none is more than `widest` times the model's. A study of its own confirms them.
    ///
    /// # Errors
    /// [`Error::Unsuitable`]: the model has no requirement, or no tolerance that may change. [`Error::Run`]: it cannot
    /// be run.
    pub fn allocate(self, criterion: Criterion, widest: f64) -> Result<Allocation, Error> {
        let own = self.checked()?;
        let share = match criterion {
            Criterion::WorstCase => None,
            Criterion::Share(share) => Some(share),
        };
        Ok(allocate(&own.description, AllocateOptions { share, widest }, &own.options)?)
    }

    /// The parameters that agree with measured values. `data` is a table: a heading with `time` and names of outputs,
    /// optionally with units (`x3 [mm]`) and columns `x3_noise`, then rows. `noise` has bounds for outputs without such
    /// a column: name and quantity, such as `("x3", "0.1 mm")`.
    ///
    /// # Errors
    /// [`Error::Data`]: the table or a bound cannot be used. [`Error::Fit`]: no parameter is uncertain, or the model
    /// cannot be run over its box.
    pub fn fit(self, data: &str, noise: &[(&str, &str)]) -> Result<Fit, Error> {
        let own = self.checked()?;
        let bound = |own: &(&str, &str)| NoiseBound { output: own.0.to_owned(), value: own.1.to_owned() };
        let noise: Vec<NoiseBound> = noise.iter().map(bound).collect();
        let measurements = Measurements::read(data, &own.description, &noise)?;
        Ok(fit(&own.description, &measurements, &own.options)?)
    }

    /// The nominal values, within the ranges of the model's `design`, that are best in its `objective` with their
    /// tolerances: in every case, or for a share of the production.
    ///
    /// # Errors
    /// [`Error::Unsuitable`]: the model has no `design`. [`Error::Run`]: it cannot be run. [`Error::Design`]: its
    /// margins have no surrogate over any part of the ranges.
    pub fn design(self, criterion: Criterion) -> Result<DesignStudy, Error> {
        let own = self.checked()?;
        let share = match criterion {
            Criterion::WorstCase => None,
            Criterion::Share(share) => Some(share),
        };
        Ok(design(&own.description, DesignOptions { share }, &own.options)?)
    }

    /// Outputs over time at points: each has a value, SI, for each of [`Model::uncertain`](super::Model::uncertain).
    ///
    /// # Errors
    /// [`Error::Point`]: a point has too few or too many values. [`Error::Run`]: the mechanism cannot be stepped.
    pub fn sample(self, points: &[Vec<f64>]) -> Result<Samples, Error> {
        let own = self.checked()?;
        Samples::of(&own.description, points, &own.options)
    }

    /// Cost of accuracy in time: settings of all methods, their errors against a reference, and the cheapest setting
    /// for an error relative to each output's range. `budget` is approximate, in seconds.
    ///
    /// # Errors
    /// [`Error::Run`]: the model cannot be run. [`Error::Cost`]: a reference takes too long.
    pub fn cost(self, tolerance: f64, budget: f64) -> Result<CostStudy, Error> {
        let own = self.checked()?;
        let Options { threads, progress, interrupted, .. } = own.options;
        Ok(cost(&own.description, &CostOptions { tolerance, budget, threads, progress, interrupted })?)
    }

    /// Runs every method. A simulation that fails midway ends the bounds that need it there: see
    /// [`StudyResult::failure`].
    ///
    /// # Errors
    /// [`Error::Run`]: the mechanism cannot be built, assembled or stepped at all, a method would need too many
    /// simulations, or the study is costly and [`allow_costly`](Self::allow_costly) was not called.
    pub fn run(self) -> Result<StudyResult, Error> {
        let own = self.checked()?;
        let (bounds, summary) = run(&own.description, own.options)?;
        Ok(StudyResult::new(bounds, summary))
    }

    /// The checked model of the run.
    #[doc(hidden)]
    pub fn description(&self) -> &Description {
        &self.description
    }
}
