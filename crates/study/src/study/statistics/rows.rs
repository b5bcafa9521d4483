//! One row after the other: samples of the surrogate, and their statistics of each output.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::INTERRUPTED;
use super::causes::{Cause, causes};
use super::control_variates::{ControlVariate, Moments};
use super::laws::Laws;
use super::products::Products;
use super::tuning::TUNING;
use crate::model::Description;
use crate::numerics::statistics::{REPLICATES, Replicates};
use crate::numerics::{PointSet, Points, largest};
use crate::results::OutputStatistics;
use crate::simulate::is_one_number;
use crate::study::Options;
use crate::study::answers::{Evaluator, Kept};

/// Samples and their evaluator.
pub(super) struct Rows<'a> {
    pub description: &'a Description,
    options: &'a Options<'a>,
    pub laws: &'a Laws,
    pub kept: &'a Kept,
    evaluator: Evaluator<'a>,
    /// By replicate.
    samples: Vec<PointSet>,
    /// If the surrogate of several parameters is not within the tolerance.
    pub products: Option<Products>,
}

/// Statistics of one output in one row.
struct RowStatistics {
    moments: Moments,
    linear: f64,
    rss: f64,
    resolved: bool,
}

impl<'a> Rows<'a> {
    /// Draws the samples.
    ///
    /// # Errors
    /// If a loop closure cannot be compiled.
    pub fn new(
        description: &'a Description,
        options: &'a Options<'a>,
        laws: &'a Laws,
        kept: &'a Kept,
    ) -> Result<Self, String> {
        let evaluator = kept.evaluator().map_err(|error| error.to_string())?;
        let asked = description.statistics.samples.unwrap_or(TUNING.samples);
        let count = asked.min(TUNING.most_numbers / laws.dimension()).max(REPLICATES);
        // The largest power of two that is not more.
        let count = 1 << (count / REPLICATES).ilog2();
        let samples = (0..REPLICATES).into_par_iter().map(|number| laws.samples(number, count)).collect();
        Ok(Self { description, options, laws, kept, evaluator, samples, products: None })
    }

    /// The same with errors from simulations at samples of the laws, if the surrogate is not within the tolerance.
    ///
    /// # Errors
    /// If these cannot be simulated.
    pub fn with_products(self, outputs: usize) -> Result<Self, String> {
        let products = Products::of(self.description, self.options, self.laws, self.kept, outputs);
        Ok(Self { products: products.map_err(|error| error.to_string())?, ..self })
    }

    /// Tells the current activity.
    pub fn stage(&self, activity: &str) {
        (self.options.stage)(activity);
        (self.options.progress)(0.0);
    }

    /// Tells which share of it is done.
    pub fn progress(&self, done: usize, of: usize) {
        (self.options.progress)(done as f64 / of as f64);
    }

    /// An error at an interruption.
    ///
    /// # Errors
    /// In words.
    pub fn go_on(&self) -> Result<(), String> {
        if (self.options.interrupted)() { Err(INTERRUPTED.to_owned()) } else { Ok(()) }
    }

    /// Samples of each row.
    pub fn samples(&self) -> usize {
        self.samples.iter().map(|samples| samples.points().len()).sum()
    }

    /// The first `count` outputs, and the results that an analysis adds to the outputs, each with its number; without
    /// shapes and responses, which are many.
    ///
    /// # Errors
    /// At an interruption.
    pub fn outputs(&self, count: usize) -> Result<Vec<(usize, OutputStatistics)>, String> {
        self.stage("statistics of outputs");
        let further = self.description.outputs.len()..self.kept.outputs();
        let further = further.filter(|&output| is_one_number(self.kept.named(output).0));
        let wanted: Vec<usize> = (0..count).chain(further).collect();
        let done = AtomicUsize::new(0);
        let all = wanted.len() * self.kept.times().len();
        let of_row_done = || self.progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
        wanted.into_iter().map(|output| Ok((output, self.of_output(output, &of_row_done)?))).collect()
    }

    /// One replicate's samples, one in `fewer`: these points of the lattice are a lattice again.
    pub fn points(&self, replicate: usize, fewer: usize) -> Points<'_> {
        self.samples[replicate].points().step_by(fewer)
    }

    /// Factor by which fewer samples are taken, so that there are this many of each replicate.
    pub fn fewer(&self, count: usize) -> usize {
        (self.samples[0].points().len() / count).max(1)
    }

    fn of_output(&self, output: usize, of_row_done: &(dyn Fn() + Sync)) -> Result<OutputStatistics, String> {
        let of_row = |row: usize| {
            let found = self.of_row(row, output, TUNING.over_time);
            of_row_done();
            found
        };
        let rows = (0..self.kept.times().len()).into_par_iter().map(of_row);
        let mut rows: Vec<RowStatistics> = rows.collect::<Result<_, String>>()?;
        let deviation = |row: &usize| rows[*row].moments.deviation.value;
        let known = (0..rows.len()).filter(|row| deviation(row).is_finite());
        if let Some(widest) = known.max_by(|a, b| deviation(a).total_cmp(&deviation(b)).then(b.cmp(a))) {
            rows[widest] = self.of_row(widest, output, 1)?;
        }
        let quantile = |index: usize| rows.iter().map(|row| row.moments.quantiles[index]).collect();
        let (name, unit) = self.kept.named(output);
        Ok(OutputStatistics {
            name: name.to_owned(),
            unit: unit.to_owned(),
            mean: rows.iter().map(|row| row.moments.mean).collect(),
            deviation: rows.iter().map(|row| row.moments.deviation).collect(),
            quantiles: (0..self.description.statistics.quantiles.len()).map(quantile).collect(),
            linear: rows.iter().map(|row| row.linear).collect(),
            rss: rows.iter().map(|row| row.rss).collect(),
            resolved: rows.iter().map(|row| row.resolved).collect(),
        })
    }

    fn of_row(&self, row: usize, output: usize, fewer: usize) -> Result<RowStatistics, String> {
        self.go_on()?;
        let stated = self.kept.error(output);
        let own_error = self.own_error(row, output, stated.total[row]);
        let variate = self.control_variate(row, output);
        let shares = self.shares(variate.is_some());
        let mut replicates = Replicates::new(&shares);
        for replicate in 0..REPLICATES {
            self.go_on()?;
            replicates.add(&mut self.values(row, output, replicate, fewer, own_error.is_some()));
        }
        let error = stated.total[row] + own_error.unwrap_or(0.0);
        let (moments, resolved) = match variate {
            None => (Moments::of(&replicates, error), !stated.unresolved[row] && error.is_finite()),
            Some(variate) => {
                let moments = variate.corrected(&replicates, error, stated.time);
                let are_known = moments.are_known();
                (moments, are_known)
            }
        };
        let (linear, rss) = self.stack(row, output);
        Ok(RowStatistics { moments, linear, rss, resolved })
    }

    /// The shares of the quantiles that are asked for, each with some around it if errors are those of products.
    pub fn shares(&self, of_products: bool) -> Vec<f64> {
        let asked = &self.description.statistics.quantiles;
        match self.products.as_ref().filter(|_| of_products) {
            Some(products) => asked.iter().flat_map(|&share| products.shares_around(share)).collect(),
            None => asked.clone(),
        }
    }

    /// Simulated values of an output with its surrogate as control variate, if there are any.
    fn control_variate(&self, row: usize, output: usize) -> Option<ControlVariate> {
        let products = self.products.as_ref()?;
        let surrogate = self.evaluator.values(row, &[output], products.samples.points());
        products.of_output(row, output, &surrogate)
    }

    /// An output's values in a row, enough of them for mean and deviation.
    pub fn few_values(&self, row: usize, output: usize) -> Vec<f64> {
        let by_own = self.own_error(row, output, self.kept.error(output).total[row]).is_some();
        let fewer = self.fewer(if by_own { TUNING.few_samples } else { TUNING.few_closed_samples });
        (0..REPLICATES).flat_map(|replicate| self.values(row, output, replicate, fewer, by_own)).collect()
    }

    /// An output's values in a row, by its own polynomial or through the loop closure.
    pub fn values(&self, row: usize, output: usize, replicate: usize, fewer: usize, by_own: bool) -> Vec<f64> {
        if by_own {
            return self.kept.own_values(row, output, self.points(replicate, fewer)).unwrap_or_default();
        }
        let fewer = fewer.max(self.fewer(TUNING.closed_samples / REPLICATES));
        self.evaluator.values(row, &[output], self.points(replicate, fewer))
    }

    /// Largest difference between the polynomial through an output's own samples and the closure, if it may replace the
    /// closure.
    pub fn own_error(&self, row: usize, output: usize, stated: f64) -> Option<f64> {
        if self.kept.is_polynomial(row, output) {
            return Some(0.0);
        }
        let samples = self.points(0, self.fewer(TUNING.compared_samples));
        let own = self.kept.own_values(row, output, samples)?;
        let closed = self.evaluator.values(row, &[output], samples);
        let apart = largest(own.iter().zip(&closed).map(|(own, closed)| own - closed));
        let (least, most) = closed.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
        // Written so that NaN does not.
        (apart <= (TUNING.near_closure.0 * (most - least)).max(TUNING.near_closure.1 * stated)).then_some(apart)
    }

    /// The linearised worst case about the nominal value, and the root sum square.
    fn stack(&self, row: usize, output: usize) -> (f64, f64) {
        let causes = self.causes(row, output);
        let deviations: Vec<f64> = causes.iter().map(|(.., deviation)| *deviation).collect();
        let linear = deviations.iter().map(|d| d.abs()).sum();
        (linear, deviations.iter().map(|d| d * d).sum::<f64>().sqrt())
    }

    /// Effect of each cause on an output about the nominal values.
    pub fn causes(&self, row: usize, output: usize) -> Vec<Cause> {
        causes(&self.description.zones, self.laws, |at| self.derivatives(row, output, at))
    }

    /// By parameter: the derivative at a point, and that times the parameter's larger deviation.
    fn derivatives(&self, row: usize, output: usize, at: &[f64]) -> Vec<(f64, f64)> {
        let Laws { nominal, lower, upper, .. } = self.laws;
        let mut points: Vec<Vec<f64>> = Vec::with_capacity(2 * nominal.len());
        for axis in 0..nominal.len() {
            let step = TUNING.step_of_difference * 0.5 * (upper[axis] - lower[axis]);
            for side in [-step, step] {
                let mut point = at.to_vec();
                point[axis] = (point[axis] + side).clamp(lower[axis], upper[axis]);
                points.push(point);
            }
        }
        let values = self.evaluator.values(row, &[output], PointSet::of(&points).points());
        let deviation = |axis: usize| {
            let between = points[2 * axis + 1][axis] - points[2 * axis][axis];
            let slope = (values[2 * axis + 1] - values[2 * axis]) / between;
            (slope, slope * (upper[axis] - nominal[axis]).max(nominal[axis] - lower[axis]))
        };
        (0..nominal.len()).map(deviation).collect()
    }
}
