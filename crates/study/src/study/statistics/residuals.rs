//! What a surrogate of many parameters leaves to simulations at samples of the laws.
//!
//! The largest difference over a box of many parameters is in corners that next to no product comes near. Statistics
//! are told by what products do: the mean of the differences corrects the mean, their deviation limits the error of the
//! standard deviation (|σ(f) − σ(s)| ≤ σ(f − s)). Where a share δ of the products differs by more than ε, a quantile
//! lies between those of the surrogate whose shares are δ less and δ more, and ε beyond them.

use symdiff::math;

use super::laws::Laws;
use super::tuning::TUNING;
use crate::methods::MOST_ON_GRIDS;
use crate::model::Description;
use crate::numerics::Sample;
use crate::numerics::statistics::{Estimate, REPLICATES, beta_quantile};
use crate::study::sample::{ChosenSamples, sample};
use crate::study::{Options, RunError};

/// Half width of a 95 % confidence interval over the standard error.
const CONFIDENCE: f64 = 1.96;

const DOUBT: f64 = 0.05 / TUNING.beyond_error.len() as f64;

/// Simulations of the first outputs, by sample, row and output, and of reduced outputs and margins.
pub(super) struct Residuals {
    pub samples: Vec<Sample>,
    values: Vec<f64>,
    rows: usize,
    outputs: usize,
    /// By sample, the reduced outputs first.
    numbers: Vec<f64>,
    reduced: usize,
    /// Limits of the shares of products that differ by more than each ε.
    beyond: [f64; TUNING.beyond_error.len()],
}

/// Differences of simulations from a surrogate.
#[derive(Clone, Debug)]
pub(super) struct Residual {
    /// Their mean, with the half width of its 95 % confidence interval.
    pub mean: f64,
    pub sampling: f64,
    /// Their standard deviation, at the upper end of its 95 % confidence interval.
    pub deviation: f64,
    /// The largest but so many as [`Residuals::shares_around`] has shares beyond.
    pub largest: [f64; TUNING.beyond_error.len()],
}

impl Residuals {
    /// Of the first so many outputs; `None` where the parameters are few, or samples cannot be simulated.
    ///
    /// # Errors
    /// Where the model cannot be simulated.
    pub fn of(
        description: &Description,
        options: &Options,
        laws: &Laws,
        outputs: usize,
    ) -> Result<Option<Self>, RunError> {
        if laws.dimension() <= MOST_ON_GRIDS {
            return Ok(None);
        }
        (options.stage)("samples of the laws");
        let simulations = simulations(&description.statistics.quantiles);
        let own = laws.samples(REPLICATES, simulations);
        let samples: Vec<Sample> =
            own.chunks_exact(laws.dimension()).map(|own| own.iter().copied().collect()).collect();
        let at = |indices: std::ops::Range<usize>| samples[indices].to_vec();
        let chosen = ChosenSamples { count: samples.len(), at: &at };
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
        Ok(found.map(|(values, rows, numbers)| Self { samples, values, rows, outputs, numbers, reduced, beyond }))
    }

    /// The share of a quantile, and pairs of those between which it lies but for what differs by more.
    pub fn shares_around(&self, share: f64) -> impl Iterator<Item = f64> {
        let pairs = self.beyond.into_iter().flat_map(move |own| [(share - own).max(0.0), (share + own).min(1.0)]);
        std::iter::once(share).chain(pairs)
    }

    /// Differences of an output in a row from these values of its surrogate at the samples; `None` where it was not
    /// simulated there. A product that cannot be simulated leaves them unknown.
    pub fn from(&self, row: usize, output: usize, surrogate: &[f64]) -> Option<Residual> {
        if row >= self.rows || output >= self.outputs {
            return None;
        }
        let values = self.values.iter().skip(row * self.outputs + output).step_by(self.rows * self.outputs);
        Some(Residual::of(values, surrogate))
    }

    /// The same of a reduced output.
    pub fn of_reduced(&self, number: usize, surrogate: &[f64]) -> Residual {
        Residual::of(self.of_number(number), surrogate)
    }

    /// How far the margins of a requirement differ from these values of its surrogate at the samples, and the share of
    /// products whose margins differ by more: where `margins`, samples of the surrogate, say the most. `of_box` is how
    /// far any may differ.
    pub fn of_margin(&self, requirement: usize, surrogate: &[f64], margins: &[f64], of_box: f64) -> (f64, f64) {
        let residual = Residual::of(self.of_number(self.reduced + requirement), surrogate);
        if residual.mean.is_nan() {
            return (f64::NAN, 0.0);
        }
        let pairs = residual.largest.into_iter().zip(self.beyond).chain(of_box.is_finite().then_some((of_box, 0.0)));
        let open = |(largest, beyond): &(f64, f64)| {
            let near = margins.iter().filter(|margin| margin.abs() <= *largest).count();
            near as f64 / margins.len() as f64 + 2.0 * beyond
        };
        pairs.min_by(|a, b| open(a).total_cmp(&open(b))).unwrap_or((f64::NAN, 0.0))
    }

    /// A reduced output or a margin of all samples.
    fn of_number(&self, number: usize) -> impl Iterator<Item = &f64> {
        self.numbers.iter().skip(number).step_by(self.numbers.len() / self.samples.len())
    }
}

impl Residual {
    /// Simulated values less those of the surrogate.
    fn of<'v>(values: impl Iterator<Item = &'v f64>, surrogate: &[f64]) -> Self {
        let differences: Vec<f64> = values.zip(surrogate).map(|(value, own)| value - own).collect();
        let count = differences.len() as f64;
        let mean = differences.iter().sum::<f64>() / count;
        let squares: f64 = differences.iter().map(|own| (own - mean) * (own - mean)).sum();
        let deviation = (squares / (count - 1.0)).sqrt();
        let mut sizes: Vec<f64> = differences.iter().map(|own| own.abs()).collect();
        // NaN is the largest.
        sizes.sort_unstable_by(f64::total_cmp);
        Self {
            mean,
            sampling: CONFIDENCE * deviation / count.sqrt(),
            deviation: deviation * (1.0 + CONFIDENCE / (2.0 * count).sqrt()),
            largest: TUNING
                .beyond_error
                .map(|beyond| if mean.is_nan() { f64::NAN } else { sizes[sizes.len() - 1 - beyond] }),
        }
    }
}

/// Simulations of which none differing by more than ε tells the share that does to a part of the smallest share beyond
/// these quantiles.
fn simulations(quantiles: &[f64]) -> usize {
    let tail = quantiles.iter().map(|share| share.min(1.0 - share)).fold(0.5, f64::min);
    let needed = -math::ln(DOUBT) / (TUNING.fine_share * tail);
    (needed.ceil() as usize).clamp(TUNING.fewest_simulations, TUNING.most_simulations).next_power_of_two()
}

/// Shares around a quantile, itself included.
pub(super) const AROUND: usize = 1 + 2 * TUNING.beyond_error.len();

impl Residual {
    /// The mean of the surrogate as that of the products.
    pub fn corrected(&self, Estimate { value, sampling }: Estimate) -> Estimate {
        Estimate { value: value + self.mean, sampling: sampling + self.sampling }
    }

    /// Errors of the mean, of the deviation and of quantiles, each with those around it, where that of the whole box is
    /// not less; `time`: that of the steps. A product that cannot be simulated leaves them unknown.
    pub fn errors(&self, quantiles: &[Estimate], of_box: f64, time: f64) -> Vec<f64> {
        let of_quantiles = quantiles.chunks_exact(AROUND).map(|around| self.of_quantile(around) + time);
        let errors = [time, self.deviation + time].into_iter().chain(of_quantiles);
        // Written so that NaN stays.
        errors.map(|error| if of_box < error { of_box } else { error }).collect()
    }

    /// How far a quantile may be off, given those of the surrogate at the shares around it.
    fn of_quantile(&self, around: &[Estimate]) -> f64 {
        let value = around[0].value;
        let pairs = around[1..].chunks_exact(2).zip(self.largest);
        let errors = pairs.map(|(pair, largest)| (value - pair[0].value).max(pair[1].value - value) + largest);
        // Written so that the unknown is.
        errors.reduce(|a, b| if b < a { b } else { a }).unwrap_or(f64::NAN)
    }
}
