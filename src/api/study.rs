//! A study: which methods bound a model, and how they run.

use super::{Error, Samples, StudyResult};
use crate::methods::{BoundsRequest, Certified, Chebyshev, Proof, Scan, Taylor};
use crate::model::{Description, Stepping};
use crate::results::{Allocation, CostStudy, Criterion, DesignStudy, Fit};
use crate::study::{
    AllocateOptions, CostOptions, DesignOptions, Measurements, NoiseBound, Options, allocate, cost, design, fit, run,
};

/// A run of a model in preparation. Methods add up; the first that is chosen replaces those of the model's `bounds:`.
pub struct Study<'a> {
    description: Description,
    options: Options<'a>,
    /// Whether the methods are no longer the model's.
    chosen: bool,
}

impl<'a> Study<'a> {
    pub(super) fn new(description: Description) -> Self {
        Self { description, options: Options { costly: false, ..Options::default() }, chosen: false }
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

    /// The nominal motion without the model's bounds and statistics; methods that are chosen run beside it.
    #[must_use]
    pub fn nominal(mut self) -> Self {
        self.choose();
        // Statistics are evaluated on a surrogate, which is a bounding method's.
        self.description.statistics.asked = false;
        self
    }

    /// The smallest and largest values on a grid with so many points a parameter: points^k simulations, always too
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

    /// Chebyshev bounds of whichever degrees meet an error, relative to how far each output ranges over the run.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        let bounds = self.choose();
        bounds.tolerance = Some(tolerance);
        bounds.chebyshev = Some(Chebyshev::ADAPTIVE);
        self
    }

    /// Another duration, s.
    #[must_use]
    pub fn duration(mut self, seconds: f64) -> Self {
        self.description.simulation.duration = seconds;
        self
    }

    /// Another fixed time step, s.
    #[must_use]
    pub fn step(mut self, seconds: f64) -> Self {
        self.description.simulation.stepping = Stepping::Fixed(seconds);
        self
    }

    /// Threads to run on; by default all cores. Results are the same for any number.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.options.threads = Some(threads);
        self
    }

    /// Bounds the rest where the mechanism cannot be assembled, or locks, in a part of the parameters' box.
    #[must_use]
    pub fn skip_infeasible(mut self) -> Self {
        self.options.skip_infeasible = true;
        self
    }

    /// The time steps' error by all samples with halved steps, instead of a few.
    #[must_use]
    pub fn certify_steps(mut self) -> Self {
        self.options.certify_time = true;
        self
    }

    /// Runs also what takes more than 20 000 simulations or about a minute, which is refused otherwise
    /// ([`Error::Run`] with the code `E1003`), and lets a run take much longer than was estimated.
    #[must_use]
    pub fn allow_costly(mut self) -> Self {
        self.options.costly = true;
        self
    }

    /// Calls a function now and then with the fraction that is done.
    #[must_use]
    pub fn progress(mut self, progress: &'a (dyn Fn(f64) + Sync)) -> Self {
        self.options.progress = progress;
        self
    }

    /// Asks a function now and then whether to stop. The result has the parts finished by then.
    #[must_use]
    pub fn interrupted(mut self, interrupted: &'a (dyn Fn() -> bool + Sync)) -> Self {
        self.options.interrupted = interrupted;
        self
    }

    /// The cheapest, or loosest, tolerances with which all requirements hold in every case or in a share of the
    /// production; none is more than `widest` times the model's. A study of its own confirms them.
    ///
    /// # Errors
    /// [`Error::Unsuitable`]: the model has no requirement, or no tolerance that may change. [`Error::Run`]: it cannot
    /// be run.
    pub fn allocate(self, criterion: Criterion, widest: f64) -> Result<Allocation, Error> {
        let share = match criterion {
            Criterion::WorstCase => None,
            Criterion::Share(share) => Some(share),
        };
        Ok(allocate(&self.description, AllocateOptions { share, widest }, &self.options)?)
    }

    /// The parameters that agree with measured values. `data` is a table: a heading with `time` and names of outputs,
    /// perhaps with units (`x3 [mm]`) and columns `x3_noise`, then rows. `noise` has bounds for outputs without such a
    /// column: name and quantity, as `("x3", "0.1 mm")`.
    ///
    /// # Errors
    /// [`Error::Data`]: the table or a bound cannot be used. [`Error::Fit`]: no parameter is uncertain, or the model
    /// cannot be run over its box.
    pub fn fit(self, data: &str, noise: &[(&str, &str)]) -> Result<Fit, Error> {
        let bound = |own: &(&str, &str)| NoiseBound { output: own.0.to_owned(), value: own.1.to_owned() };
        let noise: Vec<NoiseBound> = noise.iter().map(bound).collect();
        let measurements = Measurements::read(data, &self.description, &noise)?;
        Ok(fit(&self.description, &measurements, &self.options)?)
    }

    /// The nominal values, within the ranges of the model's `design`, that are best in its `objective` with the
    /// tolerances about them: in every case, or for a share of the production.
    ///
    /// # Errors
    /// [`Error::Unsuitable`]: the model has no `design`. [`Error::Run`]: it cannot be run. [`Error::Design`]: its
    /// margins have no surrogate over any part of the ranges.
    pub fn design(self, criterion: Criterion) -> Result<DesignStudy, Error> {
        let share = match criterion {
            Criterion::WorstCase => None,
            Criterion::Share(share) => Some(share),
        };
        Ok(design(&self.description, DesignOptions { share }, &self.options)?)
    }

    /// Outputs over time at points: for each a value, SI, of each of [`Model::uncertain`](super::Model::uncertain).
    ///
    /// # Errors
    /// [`Error::Point`]: a point has too few or too many values. [`Error::Run`]: the mechanism cannot be stepped.
    pub fn sample(self, points: &[Vec<f64>]) -> Result<Samples, Error> {
        Samples::of(&self.description, points, &self.options)
    }

    /// What accuracy costs in time: settings of all methods, their errors against a reference, and the cheapest for an
    /// error relative to each output's range. `budget` is in seconds, about.
    ///
    /// # Errors
    /// [`Error::Run`]: the model cannot be run. [`Error::Cost`]: a reference takes too long.
    pub fn cost(self, tolerance: f64, budget: f64) -> Result<CostStudy, Error> {
        let Options { threads, progress, interrupted, .. } = self.options;
        Ok(cost(&self.description, &CostOptions { tolerance, budget, threads, progress, interrupted })?)
    }

    /// Runs every method. A simulation that fails on its way ends the bounds that need it there:
    /// see [`StudyResult::failure`].
    ///
    /// # Errors
    /// [`Error::Run`]: the mechanism cannot be built, assembled or stepped at all, a method would need too many
    /// simulations, or the study is costly and [`allow_costly`](Self::allow_costly) was not called.
    pub fn run(self) -> Result<StudyResult, Error> {
        let (bounds, summary) = run(&self.description, self.options)?;
        Ok(StudyResult::new(bounds, summary))
    }
}
