//! Simulations at samples of the laws: products, which determine statistics if the surrogate is not within the
//! tolerance. The largest difference over a box of many parameters is in corners that next to no product comes near.

use symdiff::math;

use super::control_variates::{ControlVariate, largest};
use super::laws::Laws;
use super::tuning::TUNING;
use crate::model::Description;
use crate::numerics::PointSet;
use crate::numerics::statistics::{REPLICATES, SampleQuantile, beta_quantile};
use crate::study::answers::Kept;
use crate::study::attained::tuning::TUNING as ATTAINED;
use crate::study::sample::{ChosenSamples, sample};
use crate::study::{Options, RunError};

/// Each interval of a quantile, by differences and by simulated values alone, leaves so much out: 5 % together.
const DOUBT: f64 = 0.05 / (TUNING.beyond_error.len() + 1) as f64;

/// Simulations of the first outputs, by sample, row and output, and of reduced outputs and margins.
pub(super) struct Products {
    pub samples: PointSet,
    values: Vec<f64>,
    rows: usize,
    outputs: usize,
    /// By sample, the reduced outputs first.
    numbers: Vec<f64>,
    reduced: usize,
    /// Limits of the shares of products that differ by more than each ε.
    beyond: [f64; TUNING.beyond_error.len()],
    /// Quantiles that are requested, of the products alone.
    quantiles: Vec<SampleQuantile>,
}

impl Products {
    /// Products of the first `outputs` outputs; `None` if the parameters are few and motions are not cut at events, a
    /// surrogate is within the tolerance, or samples cannot be simulated.
    ///
    /// # Errors
    /// If the model cannot be simulated.
    pub fn of(
        description: &Description,
        options: &Options,
        laws: &Laws,
        kept: &Kept,
        outputs: usize,
    ) -> Result<Option<Self>, RunError> {
        let are_few = laws.dimension() < ATTAINED.fewest_parameters && !kept.is_cut();
        if are_few || kept.is_resolved(outputs) {
            return Ok(None);
        }
        (options.stage)("samples of the laws");
        let simulations = simulations(&description.statistics.quantiles);
        let samples = laws.samples(REPLICATES, simulations);
        let points = samples.points();
        let at = |indices: std::ops::Range<usize>| {
            indices.map(|index| points.point(index).iter().copied().collect()).collect()
        };
        let chosen = ChosenSamples { count: points.len(), at: &at };
        let options = Options { threads: options.threads, interrupted: options.interrupted, ..Options::default() };
        let found = sample(description, &options, chosen, |trajectories| {
            let (rows, columns) = (trajectories.times.len(), trajectories.outputs.len());
            let mut values = Vec::with_capacity(simulations * rows * outputs);
            trajectories.plan_reductions().map_err(RunError::from)?;
            let done = trajectories.each::<RunError>(|chunk| {
                chunk.chunks_exact(columns.max(1)).for_each(|row| values.extend_from_slice(&row[..outputs]));
                Ok(())
            })?;
            let numbers = trajectories.numbers(description.reduced.len(), description.requirements.len());
            Ok::<_, RunError>(done.map(|_| (values, rows, numbers)))
        })?;
        let limit = |count: usize| beta_quantile(1.0 - DOUBT, (count + 1) as f64, (simulations - count) as f64);
        let beyond = TUNING.beyond_error.map(limit);
        let reduced = description.reduced.len();
        let asked = description.statistics.quantiles.iter();
        let quantiles = asked.map(|&share| SampleQuantile::new(share, simulations, DOUBT)).collect();
        Ok(found.map(|(values, rows, numbers)| Self {
            samples,
            values,
            rows,
            outputs,
            numbers,
            reduced,
            beyond,
            quantiles,
        }))
    }

    /// Number of samples.
    pub fn count(&self) -> usize {
        self.samples.points().len()
    }

    /// The share of a quantile, and pairs that enclose it except for products that differ by more than each ε.
    pub fn shares_around(&self, share: f64) -> impl Iterator<Item = f64> {
        let pairs = self.beyond.into_iter().flat_map(move |own| [(share - own).max(0.0), (share + own).min(1.0)]);
        std::iter::once(share).chain(pairs)
    }

    /// An output in a row, given these values of its surrogate at the samples; `None` if it was not simulated there.
    /// A product that cannot be simulated leaves all unknown.
    pub fn of_output(&self, row: usize, output: usize, surrogate: &[f64]) -> Option<ControlVariate> {
        if row >= self.rows || output >= self.outputs {
            return None;
        }
        let values = self.values.iter().skip(row * self.outputs + output).step_by(self.rows * self.outputs);
        Some(ControlVariate::new(values, surrogate, &self.quantiles))
    }

    /// The same for a reduced output.
    pub fn of_reduced(&self, number: usize, surrogate: &[f64]) -> ControlVariate {
        ControlVariate::new(self.of_number(number), surrogate, &self.quantiles)
    }

    /// Largest difference between the margins of a requirement and these values of its surrogate at the samples, and
    /// the share of products whose margins differ by more: the pair with which `margins`, samples of the surrogate,
    /// give the narrowest interval. `of_box` is the largest difference over the box.
    pub fn of_margin(&self, requirement: usize, surrogate: &[f64], margins: &[f64], of_box: f64) -> (f64, f64) {
        let largest = largest(self.margins(requirement).zip(surrogate).map(|(margin, own)| margin - own));
        if largest[0].is_nan() {
            return (f64::NAN, 0.0);
        }
        let pairs = largest.into_iter().zip(self.beyond).chain(of_box.is_finite().then_some((of_box, 0.0)));
        let open = |(largest, beyond): &(f64, f64)| {
            let near = margins.iter().filter(|margin| margin.abs() <= *largest).count();
            near as f64 / margins.len() as f64 + 2.0 * beyond
        };
        pairs.min_by(|a, b| open(a).total_cmp(&open(b))).unwrap_or((f64::NAN, 0.0))
    }

    /// A requirement's margins of all samples.
    pub fn margins(&self, requirement: usize) -> impl Iterator<Item = &f64> {
        self.of_number(self.reduced + requirement)
    }

    /// A reduced output or a margin of all samples.
    fn of_number(&self, number: usize) -> impl Iterator<Item = &f64> {
        self.numbers.iter().skip(number).step_by(self.numbers.len() / self.count())
    }
}

/// Number of simulations: if none differs by more than ε, the share that does is known to a part of the smallest share
/// beyond these quantiles.
fn simulations(quantiles: &[f64]) -> usize {
    let tail = quantiles.iter().map(|share| share.min(1.0 - share)).fold(0.5, f64::min);
    let needed = -math::ln(DOUBT) / (TUNING.fine_share * tail);
    (needed.ceil() as usize).clamp(TUNING.fewest_simulations, TUNING.most_simulations).next_power_of_two()
}
