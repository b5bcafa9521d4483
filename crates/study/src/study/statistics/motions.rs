//! Statistics of simulated motions, each with parameters of their laws and, under random excitations, a realisation of
//! its own: their dimensions are too many for a surrogate, and reduced outputs of motions that are cut at events may
//! have none.

use rayon::prelude::*;

use super::control_variates::Moments;
use super::realisations::{Realisations, realisations, samples, varied};
use super::requirements::interval_of;
use super::tuning::TUNING;
use super::{INTERRUPTED, Laws};
use crate::model::{Description, Requirement};
use crate::numerics::statistics::{Estimate, has_interval, sample_deviation, sample_mean, sample_quantile};
use crate::reduce::Subsystem;
use crate::results::{
    ExposureSummary, NumberStatistics, OutputStatistics, OutputStatisticsSummary, RandomSummary, StatisticsResult,
    StatisticsSummary, Uncertain, YieldSummary,
};
use crate::study::Options;
use crate::study::ensemble::Progress;
use crate::study::prepared::{Prepared, choices, prepare};
use crate::study::problem::Study;
use crate::syntax::suggest;

/// Name of the method that found a share.
const METHOD: &str = "simulated motions";

/// Name of all requirements together.
const TOGETHER: &str = "all requirements";

/// Statistics of the first outputs, reduced outputs and requirements, by simulated motions.
///
/// # Errors
/// In words, if motions cannot be simulated.
pub(super) fn of_motions(
    description: &Description,
    shown: usize,
    options: &Options,
) -> Result<StatisticsResult, String> {
    let asked = &description.statistics;
    let (count, seed) = (asked.samples.unwrap_or(TUNING.samples_of_random), asked.seed);
    let model = varied(description);
    let mut laws = Laws::of(&model)?;
    laws.widen();
    let model = model.over(laws.drawn());
    let simulation = &description.simulation;
    let numbers = simulation.duration / simulation.output_step * (count * description.outputs.len()) as f64;
    if numbers > TUNING.most_numbers_of_random as f64 {
        return Err(format!("{numbers:.0} values are too many to be kept: ask for fewer samples or rows"));
    }
    (options.stage)("samples of the laws");
    let samples = samples(&laws, seed, count);
    let (_, prepared) = prepare(&model, choices(&model, options)).map_err(|error| error.to_string())?;
    let options = Options { methods: Some(Vec::new()), store: None, ..*options };
    let mut parts: Vec<(Subsystem, Realisations)> = Vec::with_capacity(prepared.len());
    let mut simulations = 0;
    for Prepared { subsystem, simulator } in prepared {
        let study = Study::new(&subsystem.description, simulator, &options).map_err(|error| error.to_string())?;
        let progress = Progress::new(count * study.rows(), options.progress);
        let found = realisations(&study, &subsystem, samples.points(), &progress).map_err(|error| error.to_string())?;
        simulations += if study.domain.dimension() == 0 { 1 } else { count };
        drop(study);
        parts.push((subsystem, found.ok_or_else(|| INTERRUPTED.to_owned())?));
    }
    let sampled = Sampled { description, parts, count };
    let outputs: Vec<(OutputStatistics, OutputStatisticsSummary)> =
        (0..shown).filter_map(|output| sampled.output(output)).collect();
    let times = sampled.parts.iter().map(|(_, found)| &found.times).max_by_key(|times| times.len());
    let times = times.cloned().unwrap_or_default();
    let (requirements, together) = sampled.requirements();
    let unknown: Vec<String> =
        asked.quantiles.iter().filter(|share| !has_interval(**share, count)).map(f64::to_string).collect();
    let note = (!unknown.is_empty()).then(|| {
        let names = suggest::list(&unknown.iter().map(String::as_str).collect::<Vec<&str>>());
        format!("{count} samples are too few for the quantiles {names}: ask for more `samples`")
    });
    let excitations = description.trajectories.iter().filter(|own| own.random().is_some());
    let excitations: Vec<String> = excitations.map(|own| own.name.clone()).collect();
    let mut parameters = laws.summaries();
    parameters.retain(|law| description.uncertain().any(|(_, own)| own.name == law.parameter));
    let reduced = sampled.numbers();
    let (outputs, summaries) = outputs.into_iter().unzip();
    let summary = StatisticsSummary {
        products: Some(count),
        samples: count,
        parameters,
        quantiles: asked.quantiles.clone(),
        left_out: laws.left_out(),
        outside: Laws::of(description).map_or(0.0, |laws| laws.outside()),
        simulations,
        outputs: summaries,
        reduced,
        requirements,
        together,
        random: (!excitations.is_empty()).then_some(RandomSummary { excitations, seed }),
        failure: note,
    };
    Ok(StatisticsResult { times, outputs, summary })
}

/// Samples of all subsystems.
struct Sampled<'d> {
    description: &'d Description,
    parts: Vec<(Subsystem, Realisations)>,
    count: usize,
}

impl Sampled<'_> {
    fn statistics(&self, values: &[f64], error: f64) -> Moments {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let with_error = |Estimate { value, sampling }: Estimate| Uncertain { value, sampling, error };
        let shares = &self.description.statistics.quantiles;
        Moments {
            mean: with_error(sample_mean(values)),
            deviation: with_error(sample_deviation(values)),
            quantiles: shares.iter().map(|share| with_error(sample_quantile(&sorted, *share))).collect(),
        }
    }

    /// Statistics of an output over the time, and where it varies most; `None` for one that no subsystem has.
    fn output(&self, output: usize) -> Option<(OutputStatistics, OutputStatisticsSummary)> {
        let (line, found) = self
            .parts
            .iter()
            .find_map(|(subsystem, found)| Some((subsystem.outputs.iter().position(|own| *own == output)?, found)))?;
        let all: Vec<Moments> = (0..found.times.len())
            .into_par_iter()
            .map(|row| {
                let (values, error) = found.of_row(row, line);
                self.statistics(values, error)
            })
            .collect();
        let known = (0..all.len()).filter(|row| all[*row].deviation.value.is_finite());
        let row = known.max_by(|a, b| all[*a].deviation.value.total_cmp(&all[*b].deviation.value).then(b.cmp(a)))?;
        let own = &self.description.outputs[output];
        let widest = &all[row];
        let summary = OutputStatisticsSummary {
            output: own.name.clone(),
            unit: own.unit.clone(),
            display: None,
            time: found.times[row],
            worst_case: [f64::NAN; 2],
            worst_case_error: f64::NAN,
            nominal: f64::NAN,
            linear: f64::NAN,
            rss: f64::NAN,
            mean: widest.mean,
            deviation: widest.deviation,
            quantiles: widest.quantiles.clone(),
            sensitivities: Vec::new(),
            histogram: None,
        };
        let quantiles = self.description.statistics.quantiles.len();
        let statistics = OutputStatistics {
            name: own.name.clone(),
            unit: own.unit.clone(),
            mean: all.iter().map(|row| row.mean).collect(),
            deviation: all.iter().map(|row| row.deviation).collect(),
            quantiles: (0..quantiles).map(|index| all.iter().map(|row| row.quantiles[index]).collect()).collect(),
            linear: vec![f64::NAN; all.len()],
            rss: vec![f64::NAN; all.len()],
            resolved: all.iter().map(|row| row.mean.total().is_finite()).collect(),
        };
        Some((statistics, summary))
    }

    /// Reduced outputs, in the model's order.
    fn numbers(&self) -> Vec<NumberStatistics> {
        let of = |(index, own): (usize, &crate::model::ReducedOutput)| {
            let (values, error) = self.parts.iter().find_map(|(subsystem, found)| {
                found.numbers.get(subsystem.reduced.iter().position(|number| *number == index)?)
            })?;
            let Moments { mean, deviation, quantiles } = self.statistics(values, *error);
            let display = self.description.display.get(&own.name).cloned();
            let (name, unit) = (own.name.clone(), own.unit.clone());
            Some(NumberStatistics { name, unit, display, mean, deviation, quantiles })
        };
        self.description.reduced.iter().enumerate().filter_map(of).collect()
    }

    /// Shares that fulfil each requirement, and all of them.
    fn requirements(&self) -> (Vec<YieldSummary>, Option<YieldSummary>) {
        let margins = |index: usize| {
            self.parts.iter().find_map(|(subsystem, found)| {
                let own = subsystem.requirements.iter().position(|number| *number == index)?;
                found.numbers.get(subsystem.reduced.len() + own)
            })
        };
        let mut all = vec![[true; 3]; self.count];
        let (mut each, mut shortest) = (Vec::new(), f64::INFINITY);
        for (index, own) in self.description.requirements.iter().enumerate() {
            let Some((values, error)) = margins(index) else { continue };
            // Errors harm, none, errors help; NaN has no value, and fails.
            let fulfilled: Vec<[bool; 3]> =
                values.iter().map(|value| [1.0, 0.0, -1.0].map(|sign| *value >= sign * error)).collect();
            all.iter_mut().zip(&fulfilled).for_each(|(all, own)| {
                all.iter_mut().zip(own).for_each(|(all, own)| *all &= own);
            });
            shortest = shortest.min(self.window(own));
            each.push(self.share(&own.name, &fulfilled, self.window(own)));
        }
        let together = (each.len() > 1).then(|| self.share(TOGETHER, &all, shortest));
        (each, together)
    }

    /// Duration for which a requirement counts in a motion, s.
    fn window(&self, own: &Requirement) -> f64 {
        let duration = self.description.simulation.duration;
        own.times.map_or(duration, |(from, to)| to.min(duration) - from)
    }

    fn share(&self, name: &str, fulfilled: &[[bool; 3]], window: f64) -> YieldSummary {
        let count = fulfilled.len();
        let share = fulfilled.iter().filter(|own| own[1]).count() as f64 / count as f64;
        let interval = interval_of(fulfilled);
        let ppm = |share: f64| 1e6 * (1.0 - share);
        // Windows of the motion fail independently of one another, one after the other.
        let exposure = self.description.statistics.exposure.filter(|_| window > 0.0).map(|time| {
            let long = |share: f64| ppm(symdiff::math::pow(share, time / window));
            ExposureSummary { time, ppm: long(share), ppm_interval: [long(interval[1]), long(interval[0])] }
        });
        YieldSummary {
            requirement: name.to_owned(),
            share,
            interval,
            ppm: ppm(share),
            ppm_interval: [ppm(interval[1]), ppm(interval[0])],
            exposure,
            cp: None,
            cpk: None,
            time: None,
            samples: count,
            method: Some(METHOD.to_owned()),
        }
    }
}
