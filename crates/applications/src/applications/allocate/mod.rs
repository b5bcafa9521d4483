//! Tolerances that are as loose, or as cheap, as the requirements allow.
//!
//! One run over the widest box (`items`, `wide`) gives a surrogate of the requirements' margins (`surface`). On it,
//! `choose` finds the cheapest tolerances under the margins that worst cases (`worst`) or yields (`share`) leave. A
//! study of its own at the result then checks that they hold, its errors included; its difference from the surrogate
//! corrects the next round.

mod choose;
mod items;
mod share;
mod surface;
pub(crate) mod tuning;
mod wide;
mod worst;

use crate::methods::Keep;
use crate::model::Description;
use crate::numerics::statistics::normal_quantile;
use crate::results::{AllocatedTolerance, Allocation, Criterion, NotMet, Summary, ToleranceZone, TradePoint, Verdict};
use crate::simulate::SimulationError;
use crate::study::{Options, RunError, pool, reduced, statistics};
use crate::syntax::{Code, Coded};
use choose::{Chosen, choose};
use items::with_tolerances;
pub(in crate::applications) use items::{Choice, Item, items};
use share::Share;
use surface::Surface;
use tuning::TUNING;
use wide::{Wide, largest_error, of, surrogate};
pub(in crate::applications) use wide::{raise, run_simulations};
use worst::{Slack, Worst};

/// Options of an allocation.
#[derive(Clone, Copy, Debug)]
pub struct AllocateOptions {
    /// The share of the production that fulfils all requirements; every case if absent.
    pub share: Option<f64>,
    /// Largest multiple of the model's tolerances that is examined.
    pub widest: f64,
}

/// Why nothing was allocated.
#[derive(Debug, thiserror::Error)]
pub enum AllocateError {
    /// The model asks for something else.
    #[error("{0}")]
    Unsuitable(String),
    /// The study failed.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Finds the loosest, or cheapest, tolerances that meet all requirements.
///
/// # Errors
/// If a model has no requirement or no tolerance that may change, or if it cannot be run.
pub fn allocate(
    description: &Description,
    asked: AllocateOptions,
    options: &Options,
) -> Result<Allocation, AllocateError> {
    let unsuitable = |message: &str| Err(AllocateError::Unsuitable(message.to_owned()));
    if description.requirements.is_empty() {
        return unsuitable(
            "tolerances are allocated to meet requirements, and the model has none: add e.g. `requirements: { clears: x >= 0.4 m }`",
        );
    }
    let all = items(description, asked.widest);
    if all.is_empty() {
        return unsuitable("no parameter is uncertain: there is no tolerance to allocate");
    }
    if all.iter().all(|item| item.choice == Choice::Fixed) {
        return unsuitable(
            "no tolerance may change: all are `cost: fixed`, or have a distribution that does not follow the tolerance",
        );
    }
    let pool = pool(options.threads);
    let pool = pool.map_err(RunError::from)?;
    pool.install(|| {
        let model = reduced::expanded(description);
        let wide = surrogate(&model, asked, options)?;
        Allocator { model: &model, asked, options, wide: &wide }.run()
    })
}

struct Allocator<'a> {
    model: &'a Description,
    asked: AllocateOptions,
    options: &'a Options<'a>,
    wide: &'a Wide,
}

impl Allocator<'_> {
    fn run(&self) -> Result<Allocation, AllocateError> {
        let items = &self.wide.items;
        let mut slack = self.slack()?;
        let present = vec![1.0; items.len()];
        let mut allocation = self.begun();
        let mut best: Option<(f64, Chosen, Summary)> = None;
        let mut chosen = None;
        let mut may_fail = self.asked.share.map(|share| TUNING.aim * (1.0 - share));
        let (rounds, enough) = if may_fail.is_some() {
            (TUNING.rounds_of_share, TUNING.unused_of_share)
        } else {
            (TUNING.confirming_rounds, TUNING.unused)
        };
        let mut start = present.clone();
        for _ in 0..rounds {
            (self.options.stage)("choosing tolerances");
            let Some(mut found) = choose(&mut *slack, items, &start) else { break };
            if (self.options.interrupted)() {
                break;
            }
            start.clone_from(&found.multiples);
            for (multiple, item) in found.multiples.iter_mut().zip(items) {
                *multiple = item.rounded(*multiple);
            }
            let left = slack.left(&found.multiples);
            let summary = match self.confirm(&found.multiples, &mut allocation) {
                // Half a study confirms nothing.
                _ if (self.options.interrupted)() => break,
                summary => summary?,
            };
            let (holds, unused) = self.compare(&summary, &left, &mut *slack, &mut may_fail);
            let cost = self.cost(&found.multiples);
            if holds && best.as_ref().is_none_or(|best| cost < best.0) {
                best = Some((cost, found.clone(), summary));
            } else if best.is_none() {
                chosen = Some((found.clone(), summary));
            }
            if holds && unused < enough {
                break;
            }
            if let Some(may_fail) = may_fail {
                slack.allow(may_fail);
            }
        }
        if best.is_none() && (self.options.interrupted)() {
            return Err(RunError::from(SimulationError::Interrupted).into());
        }
        let confirmed = best.is_some();
        let last = best.map(|(_, found, summary)| (found, summary)).or(chosen);
        let Some((found, summary)) = last else {
            allocation.not_met = self.not_met(&mut *slack);
            allocation.tolerances = self.tolerances(&present, &present, &mut *slack, &mut allocation.tightest);
            return Ok(allocation);
        };
        allocation.is_confirmed = confirmed;
        allocation.is_exhaustive = found.is_exhaustive;
        allocation.tolerances = self.tolerances(&present, &found.multiples, &mut *slack, &mut allocation.tightest);
        self.trade(&mut *slack, &found.multiples, &mut allocation);
        allocation.requirements = summary.requirements;
        if let Some(found) = summary.statistics {
            allocation.yields = found.summary.requirements.into_iter().chain(found.summary.together).collect();
        }
        Ok(allocation)
    }

    fn begun(&self) -> Allocation {
        let surface = self.surface();
        Allocation {
            model: self.model.name.clone(),
            criterion: self.asked.share.map_or(Criterion::WorstCase, Criterion::Share),
            tolerances: Vec::new(),
            tightest: String::new(),
            not_met: Vec::new(),
            is_exhaustive: true,
            requirements: Vec::new(),
            yields: Vec::new(),
            is_confirmed: false,
            trade: Vec::new(),
            trade_before: None,
            trade_after: None,
            simulations: self.wide.simulations,
            confirming: 0,
            surrogate_error: surface.as_ref().filter(|own| own.has_errors()).map(largest_error),
            widest: self.wide.items.iter().map(|item| item.widest).fold(0.0, f64::max),
        }
    }

    fn surface(&self) -> Option<Surface<'_>> {
        Some(Surface::new(self.wide.kept.margins()?, &self.wide.items))
    }

    /// Remaining margins of the requirements: in every case, or in a share of samples.
    fn slack(&self) -> Result<Box<dyn Slack + '_>, AllocateError> {
        let Some(surface) = self.surface() else {
            return Err(AllocateError::Unsuitable("there is no surrogate over the whole box".to_owned()));
        };
        let Some(share) = self.asked.share else { return Ok(Box::new(Worst::new(surface, self.options.interrupted))) };
        let laws = statistics::laws(self.model).map_err(AllocateError::Unsuitable)?;
        Ok(Box::new(Share::new(surface, laws, self.options.interrupted, TUNING.aim * (1.0 - share))))
    }

    /// A study at these multiples.
    fn confirm(&self, multiples: &[f64], allocation: &mut Allocation) -> Result<Summary, AllocateError> {
        (self.options.stage)("confirming");
        let mut model = with_tolerances(self.model, &self.wide.items, multiples);
        let options = of(self.options);
        let (_, summary) = if let Some(share) = self.asked.share {
            model.statistics.asked = true;
            // The quantile to be reported.
            model.statistics.quantiles = vec![share];
            // Statistics of requirements only: quantiles of outputs over time cost more than all else, and nothing here
            // reads them.
            statistics::run(&model, 0, &options)?
        } else {
            let (bounds, summary, _) = reduced::run(&model, &options, Keep::Nothing)?;
            (bounds, summary)
        };
        allocation.confirming += run_simulations(&summary);
        allocation.confirming += summary
            .statistics
            .as_ref()
            .map_or(0, |found| found.summary.simulations + found.summary.products.unwrap_or(0));
        Ok(summary)
    }

    /// Whether a study confirms the surrogate, and the unused margin; the difference corrects the next round.
    fn compare(
        &self,
        summary: &Summary,
        left: &[f64],
        slack: &mut dyn Slack,
        may_fail: &mut Option<f64>,
    ) -> (bool, f64) {
        if let (Some(share), Some(may_fail)) = (self.asked.share, may_fail) {
            let known = summary.statistics.as_ref().map(|found| &found.summary);
            let yields = known.and_then(|found| found.together.as_ref().or(found.requirements.first()));
            let Some(found) = yields else { return (false, 0.0) };
            let fails = 1.0 - found.interval[0];
            let unused = (1.0 - share - fails) / (1.0 - share);
            *may_fail *= (TUNING.aim * (1.0 - share) / fails.max(1e-3 * (1.0 - share))).clamp(0.2, 5.0);
            // A tenth of few failures hardly changes a tolerance: d ln Φ(−z) is about −z² d ln z.
            let z = normal_quantile(share);
            return (unused >= 0.0, unused / (z * z).max(1.0));
        }
        let surface = self.surface();
        let mut holds = true;
        let mut unused = f64::INFINITY;
        for (index, requirement) in summary.requirements.iter().enumerate() {
            let scale = surface.as_ref().map_or(1.0, |surface| surface.scale(index));
            let known = (requirement.margin - requirement.error) / scale;
            holds &= requirement.verdict == Verdict::Holds;
            if known.is_finite() {
                slack.reserves()[index] += scale * (left[index] - known) + 1e-9 * scale;
                unused = unused.min(known.max(0.0));
            }
        }
        (holds, unused)
    }

    /// The sum of all costs, or how much tighter all tolerances are.
    fn cost(&self, multiples: &[f64]) -> f64 {
        let items = &self.wide.items;
        let together = items.iter().zip(multiples).find(|(item, _)| item.choice == Choice::Together);
        match together {
            Some((_, multiple)) => 1.0 / multiple,
            None => items.iter().zip(multiples).filter_map(|(item, multiple)| item.cost(*multiple)).sum(),
        }
    }

    /// Requirements of which the tightest tolerances leave nothing.
    fn not_met(&self, slack: &mut dyn Slack) -> Vec<NotMet> {
        let tightest: Vec<f64> = self.wide.items.iter().map(Item::tightest).collect();
        let left = slack.left(&tightest);
        let Some(surface) = self.surface() else { return Vec::new() };
        let reserves = &*slack.reserves();
        let of = |(index, left): (usize, &f64)| {
            let own = &self.model.requirements[index];
            let error = reserves[index];
            let margin = left * surface.scale(index) + error;
            let (requirement, unit, display) = (own.name.clone(), own.unit.clone(), own.display.clone());
            NotMet { requirement, unit, display, margin, error }
        };
        let mut all: Vec<NotMet> =
            left.iter().enumerate().filter(|(_, left)| **left < 0.0 || left.is_nan()).map(of).collect();
        if all.is_empty() {
            // Each alone is met, but not all together.
            all = left.iter().enumerate().map(of).collect();
        }
        all
    }

    fn tolerances(
        &self,
        before: &[f64],
        after: &[f64],
        slack: &mut dyn Slack,
        tightest: &mut String,
    ) -> Vec<AllocatedTolerance> {
        let left = slack.left(after);
        let index = (0..left.len()).min_by(|&a, &b| left[a].total_cmp(&left[b])).unwrap_or(0);
        tightest.clone_from(&self.model.requirements[index].name);
        let shares = [before, after].map(|multiples| slack.shares(multiples, index));
        let of = |(index, item): (usize, &Item)| {
            let zone = |multiple: f64| ToleranceZone { above: multiple * item.above, below: multiple * item.below };
            let own_name = item.name.strip_suffix(".deviation");
            AllocatedTolerance {
                parameter: own_name.unwrap_or(&item.name).to_owned(),
                unit: item.unit.clone(),
                nominal: if own_name.is_some() { f64::NAN } else { item.nominal },
                before: zone(before[index]),
                after: zone(after[index]),
                grade: item.grade(after[index]),
                cost_before: item.cost(before[index]),
                cost_after: item.cost(after[index]),
                share_before: shares[0][index],
                share_after: shares[1][index],
                is_free: item.choice != Choice::Fixed,
                at_widest: item.choice != Choice::Fixed && after[index] >= item.widest * (1.0 - 1e-3),
            }
        };
        self.wide.items.iter().enumerate().map(of).collect()
    }

    /// Cost against the share of the nominal margins that is left, on the surrogate.
    fn trade(&self, slack: &mut dyn Slack, found: &[f64], allocation: &mut Allocation) {
        let Some(surface) = self.surface() else { return };
        let point = |left: f64, cost: f64| TradePoint { margin: left, cost };
        let present = vec![1.0; found.len()];
        let priced =
            self.wide.items.iter().all(|item| {
                item.choice == Choice::Fixed || item.choice == Choice::Together || item.cost(1.0).is_some()
            });
        let now = slack.least(&present);
        allocation.trade_before = priced.then(|| point(now, self.cost(&present)));
        allocation.trade_after = Some(point(slack.least(found), self.cost(found)));
        let step = 0.8 / TUNING.traded as f64;
        let mut start = found.to_vec();
        for number in 0..=TUNING.traded {
            if (self.options.interrupted)() {
                break;
            }
            if number > 0 {
                (0..surface.count).for_each(|index| slack.reserves()[index] += step * surface.scale(index));
            }
            let Some(chosen) = choose(slack, &self.wide.items, &start) else { break };
            start.clone_from(&chosen.multiples);
            allocation.trade.push(point(number as f64 * step, self.cost(&chosen.multiples)));
        }
    }
}

impl Coded for AllocateError {
    fn code(&self) -> Option<Code> {
        match self {
            Self::Run(error) => error.code(),
            Self::Unsuitable(_) => Some(Code::Unsuitable),
        }
    }
}
