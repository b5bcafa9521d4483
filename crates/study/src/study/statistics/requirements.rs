//! The share of the production that fulfils requirements: over the whole motion, between rows too, by samples of the
//! surrogate of their margins.

use rayon::prelude::*;

use super::products::Products;
use super::rows::Rows;
use super::tuning::TUNING;
use crate::model::{Analysis, Requirement};
use crate::numerics::Points;
use crate::numerics::statistics::{
    REPLICATES, RareShare, least_slacks, normal_quantile, rare_share, replicate, share_interval,
};
use crate::results::YieldSummary;
use crate::study::reduced;

/// The name of all requirements together.
const TOGETHER: &str = "all requirements";

/// Starts of a search, at most, for many requirements together.
const MOST_STARTS: usize = 8 * TUNING.starts_of_places;

/// Signs of the error in a margin: errors harm, none, errors help.
const SIGNS: [f64; 3] = [1.0, 0.0, -1.0];

/// Some requirements that are to be fulfilled together, and their samples so far. Memory grows with the samples, not
/// with samples times requirements.
struct Together<'a> {
    rows: &'a Rows<'a>,
    name: &'a str,
    /// Share of the products whose margins may differ by more than the errors.
    doubt: f64,
    /// Error of each requirement.
    errors: Vec<f64>,
    scales: Vec<f64>,
    /// Whether a sample fulfils all of them, by the sign of the errors.
    fulfilled: Vec<[bool; 3]>,
    /// The same for simulated products, by the sign of the steps' errors; empty if there are none.
    products: Vec<[bool; 3]>,
    /// Samples of the first replicate with the least margins: the margin in its own scale, and the sample's index.
    least: Vec<(f64, usize)>,
}

/// Each requirement, and if there are several all together.
///
/// # Errors
/// At an interruption.
pub(super) fn all(rows: &Rows) -> Result<(Vec<YieldSummary>, Option<YieldSummary>), String> {
    let Some(kept) = rows.kept.margins() else { return Ok((Vec::new(), None)) };
    rows.stage("statistics of requirements");
    let requirements = &rows.description.requirements;
    let numbers: Vec<usize> = (0..requirements.len()).collect();
    let fewer = rows.fewer(TUNING.most_samples_of_margins / REPLICATES);
    let samples: Vec<Points> = (0..REPLICATES).map(|replicate| rows.points(replicate, fewer)).collect();
    let mut together = Together::new(rows, TOGETHER, &samples);
    let mut each = Vec::with_capacity(requirements.len());
    for group in numbers.chunks(TUNING.requirements_at_once) {
        let own = kept.only(group);
        let values = sampled(rows, &own, &samples)?;
        let at_products = rows.products.as_ref().map(|products| (products, own.values(products.samples.points())));
        for ((index, &number), values) in group.iter().enumerate().zip(values) {
            rows.progress(number, requirements.len());
            let requirement = &requirements[number];
            let (of_box, time) = (kept.error(number), kept.time_error(number));
            let (error, doubt) = match &at_products {
                Some((products, found)) => {
                    let own = &found[index * products.count()..][..products.count()];
                    let (error, doubt) = products.of_margin(number, own, &values, of_box - time);
                    (error + time, doubt)
                }
                None => (of_box, 0.0),
            };
            let mut alone = Together::new(rows, &requirement.name, &samples);
            for own in [&mut alone, &mut together] {
                own.add(&values, error, doubt);
                if let Some(products) = &rows.products {
                    own.add_products(products.margins(number), time);
                }
            }
            if let Some(mut summary) = alone.summary(&kept.only(&[number])) {
                capability(rows, requirement, &values, &mut summary)?;
                each.push(summary);
            }
            rows.go_on()?;
        }
    }
    let together = if requirements.len() > 1 { together.summary(&kept) } else { None };
    rows.go_on()?;
    Ok((each, together))
}

/// Margins of all samples, by requirement.
fn sampled(rows: &Rows, margins: &reduced::Margins, samples: &[Points]) -> Result<Vec<Vec<f64>>, String> {
    let mut values = vec![Vec::new(); margins.count()];
    for &samples in samples {
        rows.go_on()?;
        let found = margins.values(samples);
        values.iter_mut().zip(found.chunks_exact(samples.len())).for_each(|(all, own)| all.extend_from_slice(own));
    }
    Ok(values)
}

impl<'a> Together<'a> {
    /// A group without requirements yet.
    fn new(rows: &'a Rows, name: &'a str, samples: &[Points]) -> Self {
        let count = samples.iter().map(Points::len).sum();
        let (errors, scales, least) = (Vec::new(), Vec::new(), Vec::new());
        let products = vec![[true; 3]; rows.products.as_ref().map_or(0, Products::count)];
        Self { rows, name, doubt: 0.0, errors, scales, fulfilled: vec![[true; 3]; count], products, least }
    }

    /// Adds the margins of simulated products, with the error that the steps leave.
    fn add_products<'v>(&mut self, margins: impl Iterator<Item = &'v f64>, time: f64) {
        for (fulfilled, margin) in self.products.iter_mut().zip(margins) {
            fulfilled.iter_mut().zip(SIGNS).for_each(|(own, sign)| *own &= *margin >= sign * time);
        }
    }

    /// The interval of the share that fulfils them by simulated products alone; all of it if there are none.
    fn of_products(&self) -> [f64; 2] {
        if self.products.is_empty() {
            return [0.0, 1.0];
        }
        interval_of(&self.products)
    }

    /// Adds a requirement with the margins of all samples, their error, and the share of products with a larger one.
    fn add(&mut self, values: &[f64], error: f64, doubt: f64) {
        self.doubt += doubt;
        // NaN has no value, and fails.
        let add = |(fulfilled, value): (&mut [bool; 3], &f64)| {
            fulfilled.iter_mut().zip(SIGNS).for_each(|(own, sign)| *own &= *value >= sign * error);
        };
        self.fulfilled.par_iter_mut().zip(values).for_each(add);
        let scale = mean_size(values);
        let mut order: Vec<usize> = (0..values.len() / REPLICATES).collect();
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]).then(a.cmp(b));
        if order.len() > TUNING.starts_of_places {
            order.select_nth_unstable_by(TUNING.starts_of_places, by_value);
            order.truncate(TUNING.starts_of_places);
        }
        order.sort_unstable_by(by_value);
        self.least.extend(order.iter().map(|&sample| (values[sample] / scale, sample)));
        if self.least.len() > MOST_STARTS {
            self.least.sort_by(|a, b| a.0.total_cmp(&b.0));
            self.least.truncate(MOST_STARTS);
        }
        self.errors.push(error);
        self.scales.push(scale);
    }

    /// The share that fulfils them, given their margins as functions; `None` if an error is unknown.
    fn summary(&self, margins: &reduced::Margins) -> Option<YieldSummary> {
        if self.errors.iter().any(|error| !error.is_finite()) {
            return None;
        }
        let count = self.fulfilled.len();
        let share = self.fulfilled.iter().filter(|own| own[1]).count();
        let mut interval = interval_of(&self.fulfilled);
        let mut fails = 1.0 - share as f64 / count as f64;
        let (mut samples, mut method) = (count, None);
        if count - share < TUNING.many_failing
            && let Some(rare) = self.rare(margins)
        {
            let [least, most] = rare.interval.map(|fails| 1.0 - fails);
            // Where methods contradict one another, or the seen share, that share alone is stated.
            // `least` is the largest share that fulfils: the fewest failures leave most.
            let agrees = least >= interval[0] && most <= interval[1];
            if agrees && (count - share < TUNING.few_failing || least - most < interval[1] - interval[0]) {
                (fails, interval) = (rare.value, [most, least]);
                (samples, method) = (rare.samples, Some(rare.method.name().to_owned()));
            }
        }
        interval = [(interval[0] - self.doubt).max(0.0), (interval[1] + self.doubt).min(1.0)];
        let of_products = self.of_products();
        if of_products[1] - of_products[0] < interval[1] - interval[0] {
            interval = of_products;
            (samples, method) = (self.products.len(), None);
            fails = self.products.iter().filter(|own| !own[1]).count() as f64 / samples as f64;
        }
        // The probability outside of the surrogate's domain counts against the share.
        interval[0] *= 1.0 - self.rows.laws.left_out();
        let ppm = |share: f64| 1e6 * (1.0 - share);
        Some(YieldSummary {
            requirement: self.name.to_owned(),
            share: 1.0 - fails,
            interval,
            ppm: 1e6 * fails,
            ppm_interval: [ppm(interval[1]), ppm(interval[0])],
            exposure: None,
            cp: None,
            cpk: None,
            time: None,
            samples,
            method,
        })
    }

    /// The share that fails, by samples drawn near the failures.
    fn rare(&self, margins: &reduced::Margins) -> Option<RareShare> {
        let some = |points: &[Vec<f64>]| -> Vec<[f64; 3]> {
            if self.rows.go_on().is_err() {
                // Unknown, at once: the search then ends soon.
                return vec![[f64::NAN; 3]; points.len()];
            }
            let found = margins.values(self.rows.laws.of_scores(points).points());
            least_slacks(&found, &self.errors, &self.scales)
        };
        let at_once = (TUNING.most_margins_at_once / self.errors.len()).max(1);
        let all = |points: &[Vec<f64>]| {
            let mut found = Vec::with_capacity(points.len());
            points.chunks(at_once).for_each(|points| found.extend_from_slice(&some(points)));
            found
        };
        rare_share(&self.starts(), &all)
    }

    /// Independent normal scores of the samples with the least margins.
    fn starts(&self) -> Vec<Vec<f64>> {
        let k = self.rows.laws.dimension();
        let each = self.fulfilled.len() / REPLICATES;
        let fewer = self.rows.fewer(each);
        let shares = replicate(0, k, each * fewer);
        let scores = |&(_, sample): &(f64, usize)| -> Vec<f64> {
            shares[sample * fewer * k..][..k].iter().map(|&p| normal_quantile(p)).collect()
        };
        self.least.iter().map(scores).collect()
    }
}

/// The 95 % confidence interval of the share that fulfils something, by the sign of the errors.
pub(super) fn interval_of(fulfilled: &[[bool; 3]]) -> [f64; 2] {
    let seen = |sign: usize| fulfilled.iter().filter(|own| own[sign]).count();
    [share_interval(seen(0), fulfilled.len())[0], share_interval(seen(2), fulfilled.len())[1]]
}

/// Mean absolute value.
fn mean_size(values: &[f64]) -> f64 {
    let known = values.iter().filter(|value| value.is_finite());
    (known.map(|value| value.abs()).sum::<f64>() / values.len() as f64).max(f64::MIN_POSITIVE)
}

/// Capabilities of a requirement over time at its worst time, of another by its margin.
fn capability(
    rows: &Rows,
    requirement: &Requirement,
    margins: &[f64],
    summary: &mut YieldSummary,
) -> Result<(), String> {
    let moments = |values: &[f64]| {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        (mean, (values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0)).sqrt())
    };
    let Some((from, to)) = requirement.times else {
        let (mean, deviation) = moments(margins);
        summary.cpk = Some(mean / (3.0 * deviation)).filter(|cpk| cpk.is_finite());
        return Ok(());
    };
    let times = rows.kept.times();
    let rounding = 1e-9 * times.last().copied().unwrap_or(0.0);
    let within = |row: &usize| times[*row] >= from - rounding && times[*row] <= to + rounding;
    let of_row = |row: usize| {
        rows.go_on()?;
        let own = |&output: &usize| moments(&rows.few_values(row, output));
        let moments: Vec<(f64, f64)> = requirement.outputs.iter().map(own).collect();
        let cpk = moments.iter().map(|(mean, deviation)| mean / (3.0 * deviation)).fold(f64::INFINITY, f64::min);
        let cp = match moments[..] {
            // A response may have one limit at two frequencies, which is no pair of limits.
            _ if requirement.of_results && requirement.limits.len() < 2 => None,
            [(above, deviation), (below, _)] => Some((above + below) / (6.0 * deviation)),
            _ => None,
        };
        Ok((row, cp, cpk))
    };
    let all = (0..times.len()).filter(within).collect::<Vec<_>>().into_par_iter().map(of_row);
    let all: Result<Vec<_>, String> = all.collect();
    let known = all?.into_iter().filter(|(_, _, cpk)| cpk.is_finite());
    if let Some((row, cp, cpk)) = known.min_by(|a, b| a.2.total_cmp(&b.2)) {
        let time = (rows.description.analysis != Analysis::Dimensions).then_some(times[row]);
        (summary.cp, summary.cpk, summary.time) = (cp, Some(cpk), time);
    }
    Ok(())
}
