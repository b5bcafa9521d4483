//! The share of the production that fulfils requirements: over the whole motion, between rows too, by samples of the
//! surrogate of their margins.

use rayon::prelude::*;

use super::rows::Rows;
use crate::model::Requirement;
use crate::numerics::statistics::{REPLICATES, RareShare, normal_quantile, rare_share, replicate, share_interval};
use crate::results::YieldSummary;
use crate::study::reduced;

/// Samples of margins, at most.
const MOST: usize = 1 << 18;

/// Where fewer than these fail, samples are drawn where it fails; where fewer than many, these count if they say more.
const FEW: usize = 400;
const MANY: usize = 4000;

/// Samples from which places that fail are looked for.
const STARTS: usize = 12;

/// What most of a requirement's name is when it stands for all of them.
const TOGETHER: &str = "all requirements";

/// Margins of samples, by requirement.
struct Margins<'a> {
    rows: &'a Rows<'a>,
    kept: &'a reduced::Margins<'a>,
    /// By replicate, every so many of its samples.
    fewer: usize,
    /// By requirement, sample by sample.
    values: Vec<Vec<f64>>,
}

/// All requirements, and where there are several all together.
///
/// # Errors
/// At an interruption.
pub(super) fn all(rows: &Rows) -> Result<(Vec<YieldSummary>, Option<YieldSummary>), String> {
    let Some(kept) = rows.kept.margins() else { return Ok((Vec::new(), None)) };
    rows.stage("statistics of requirements");
    let requirements = &rows.description.requirements;
    let fewer = rows.fewer(MOST / REPLICATES);
    let mut margins = Margins { rows, kept: &kept, fewer, values: vec![Vec::new(); requirements.len()] };
    for replicate in 0..REPLICATES {
        rows.go_on()?;
        let samples = rows.points(replicate, fewer);
        let found = kept.values(&samples);
        for (all, own) in margins.values.iter_mut().zip(found.chunks_exact(samples.len())) {
            all.extend_from_slice(own);
        }
    }
    let alone = |number: usize| margins.summary(&requirements[number].name, &[number]);
    let mut each = Vec::with_capacity(requirements.len());
    for (number, requirement) in requirements.iter().enumerate() {
        rows.progress(number, requirements.len());
        if let Some(mut summary) = alone(number) {
            capability(rows, requirement, &margins.values[number], &mut summary)?;
            each.push(summary);
        }
        rows.go_on()?;
    }
    let every: Vec<usize> = (0..requirements.len()).collect();
    let together = (every.len() > 1 && each.len() == every.len()).then(|| margins.summary(TOGETHER, &every)).flatten();
    rows.go_on()?;
    Ok((each, together))
}

impl Margins<'_> {
    /// The share that fulfils some of the requirements.
    fn summary(&self, name: &str, of: &[usize]) -> Option<YieldSummary> {
        let errors: Vec<f64> = of.iter().map(|&number| self.kept.error(number)).collect();
        if errors.iter().any(|error| !error.is_finite()) {
            return None;
        }
        let count = self.values[of[0]].len();
        // NaN has no value, and fails.
        let fulfils = |sample: &usize, sign: f64| {
            of.iter().zip(&errors).all(|(&number, error)| self.values[number][*sample] >= sign * error)
        };
        let seen = |sign: f64| (0..count).into_par_iter().filter(|sample| fulfils(sample, sign)).count();
        let (share, mut interval) =
            (seen(0.0), [share_interval(seen(1.0), count)[0], share_interval(seen(-1.0), count)[1]]);
        let mut fails = 1.0 - share as f64 / count as f64;
        let (mut samples, mut method) = (count, None);
        if count - share < MANY
            && let Some(rare) = self.rare(of, &errors)
        {
            let [least, most] = rare.interval.map(|fails| 1.0 - fails);
            // Where methods contradict one another, or the seen share, that share alone is stated.
            // `least` is the share that fulfils at most: what fails least leaves most.
            let agrees = least >= interval[0] && most <= interval[1];
            if agrees && (count - share < FEW || least - most < interval[1] - interval[0]) {
                (fails, interval) = (rare.value, [most, least]);
                (samples, method) = (rare.samples, Some(rare.method.name().to_owned()));
            }
        }
        // What lies outside of the surrogate counts against it.
        interval[0] *= 1.0 - self.rows.laws.left_out();
        let ppm = |share: f64| 1e6 * (1.0 - share);
        Some(YieldSummary {
            requirement: name.to_owned(),
            share: 1.0 - fails,
            interval,
            ppm: 1e6 * fails,
            ppm_interval: [ppm(interval[1]), ppm(interval[0])],
            cp: None,
            cpk: None,
            time: None,
            samples,
            method,
        })
    }

    /// The share that fails, by samples that look for it.
    fn rare(&self, of: &[usize], errors: &[f64]) -> Option<RareShare> {
        let laws = self.rows.laws;
        let scales: Vec<f64> = of.iter().map(|&number| mean_size(&self.values[number])).collect();
        // The least of all, each in its own scale, with errors that help, none, and errors that harm.
        let slacks = |points: &[Vec<f64>]| -> Vec<[f64; 3]> {
            if self.rows.go_on().is_err() {
                // Unknown, at once: the search then ends soon.
                return vec![[f64::NAN; 3]; points.len()];
            }
            let samples: Vec<Vec<f64>> = points.iter().map(|scores| laws.of_scores(scores)).collect();
            let found = self.kept.values(&samples);
            let of_sample = |sample: usize| {
                [-1.0, 0.0, 1.0].map(|sign| {
                    let slack = |place: usize| {
                        (found[of[place] * samples.len() + sample] - sign * errors[place]) / scales[place]
                    };
                    (0..of.len()).map(slack).fold(f64::INFINITY, |a, b| if b < a || b.is_nan() { b } else { a })
                })
            };
            (0..samples.len()).map(of_sample).collect()
        };
        rare_share(&self.starts(of), &slacks)
    }

    /// Independent normal scores of those of the first replicate's samples that have the least margins.
    fn starts(&self, of: &[usize]) -> Vec<Vec<f64>> {
        let each = self.values[of[0]].len() / REPLICATES;
        let k = self.rows.laws.dimension();
        let shares = replicate(0, k, each * self.fewer);
        let scores = |&sample: &usize| -> Vec<f64> {
            shares[sample * self.fewer * k..][..k].iter().map(|&p| normal_quantile(p)).collect()
        };
        let of_one = |&number: &usize| -> Vec<Vec<f64>> {
            let values = &self.values[number][..each];
            let mut order: Vec<usize> = (0..each).collect();
            order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
            order.iter().take(STARTS).map(scores).collect()
        };
        of.iter().flat_map(of_one).collect()
    }
}

/// How large values are, on average.
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
        let moments: Vec<(f64, f64)> = requirement.places.iter().map(own).collect();
        let cpk = moments.iter().map(|(mean, deviation)| mean / (3.0 * deviation)).fold(f64::INFINITY, f64::min);
        let cp = match moments[..] {
            // Of a response, the same limit at several frequencies.
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
        (summary.cp, summary.cpk, summary.time) = (cp, Some(cpk), Some(times[row]));
    }
    Ok(())
}
