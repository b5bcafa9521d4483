//! Choice of the reference within the budget.

use super::grid::{LEVELS, SCAN, Setting, finer, smoothest, uncertain};
use super::timing::spent;
use super::tuning::TUNING;
use super::{CostError, CostOptions};
use crate::model::Description;
use crate::results::CostMethod;
use crate::study::scheme;

/// Runs for the reference: with three step sizes, each twice the one before.
pub(super) struct ReferencePlan {
    pub(super) method: CostMethod,
    pub(super) order: usize,
    /// Refinement of the finest steps relative to the model's.
    pub(super) parts: f64,
    /// Points of the dense scan.
    pub(super) scan: Option<usize>,
    /// Approximate time of a run for each unit of a setting's work, s; 0 if unknown.
    pub(super) rate: f64,
}

impl ReferencePlan {
    /// The highest order, and with it the finest steps, that two short runs promise to be done in time; the cheapest if
    /// none is. If the error has an expansion in powers of the steps, these are extrapolated.
    ///
    /// # Errors
    /// If a run fails, or even the coarsest takes too long, or there are too many parameters for any.
    pub(super) fn within_budget(
        model: &Description,
        composable: bool,
        has_expansion: bool,
        options: &CostOptions,
    ) -> Result<Self, CostError> {
        let k = uncertain(model);
        let simulation = &model.simulation;
        let of_steps = |method: CostMethod| if has_expansion { method.by(LEVELS) } else { method };
        if k == 0 {
            // One simulation, which is cheap.
            return Ok(Self {
                method: of_steps(CostMethod::Scheme(scheme(model))),
                order: 0,
                parts: TUNING.finer_references[0],
                scan: None,
                rate: 0.0,
            });
        }
        let method = of_steps(smoothest(composable));
        let setting = |count, parts| Setting { method, count, stepping: finer(simulation, parts) };
        let simulations = |order| setting(order, 1.0).simulations(k);
        let highest = TUNING.highest_orders.get(k - 1).copied();
        let highest = highest.unwrap_or_else(|| {
            (2..=TUNING.order_of_many).rev().find(|&order| simulations(order) <= TUNING.most_simulations).unwrap_or(2)
        });
        if simulations(highest) > TUNING.most_simulations {
            return Err(CostError::TooMany { parameters: k, simulations: simulations(highest) });
        }

        // Seconds on the clock are a constant, in which the model is compiled, and a rate times the simulations: by the
        // method, and the others, whose number is the same at every order.
        let trials = [setting(2, 0.5), setting(2, 1.0)];
        let [coarse, fine] = [spent(model, &trials[0], options)?, spent(model, &trials[1], options)?];
        let rate = ((fine.seconds - coarse.seconds) / (fine.work - coarse.work)).max(0.0);
        let rate = if rate.is_finite() { rate } else { 0.0 };
        let constant = (fine.seconds - rate * fine.work).max(0.0);
        // The time to find a range grows with the samples of its polynomial, whatever the steps.
        let growth = if fine.seconds > TUNING.share_of_trial * options.budget || highest < 4 {
            0.0
        } else {
            let middle = setting(highest / 2, 0.5);
            let of_middle = spent(model, &middle, options)?;
            let more = of_middle.seconds - rate * of_middle.work - constant;
            (more / (middle.simulations(k) - trials[0].simulations(k)).max(1.0)).max(0.0)
        };
        let constant = |order| constant + growth * (simulations(order) - simulations(2)).max(0.0);
        let of_method = (fine.work - fine.beside) / trials[1].work(k);
        let run =
            |order, parts| constant(order) + rate * (parts * fine.beside + of_method * setting(order, parts).work(k));
        let seconds = |order, parts: f64| {
            let lower = if order > TUNING.least_order { order - 2 } else { 1 };
            [parts, parts / 2.0, parts / 4.0].map(|parts| run(order, parts)).iter().sum::<f64>()
                + run(lower, parts / 4.0)
        };
        let least = TUNING.least_order.min(highest);
        let orders = (least..=highest).rev().step_by(2);
        let (order, parts) = orders
            .flat_map(|order| TUNING.finer_references.map(|parts| (order, parts)))
            .find(|&(order, parts)| seconds(order, parts) <= TUNING.share_of_reference * options.budget)
            .unwrap_or((least, TUNING.finer_references[TUNING.finer_references.len() - 1]));
        let least_seconds = seconds(order, parts);
        if (options.interrupted)() || least_seconds > TUNING.most_of_coarsest * options.budget {
            return Err(CostError::TooCostly { seconds: least_seconds });
        }
        let rate = fine.seconds / trials[1].work(k);
        let scan = dense_scan(model, of_steps(SCAN), parts, options)?;
        Ok(Self { method, order, parts, scan, rate })
    }

    /// The order from which the reference's error is estimated, if there is one.
    pub(super) fn lower_order(&self) -> Option<usize> {
        (self.order > 1).then(|| self.order.saturating_sub(2).max(1))
    }
}

/// Points of the densest scan, and of its half, that can be done in time, each with two step sizes; none for many
/// parameters.
fn dense_scan(
    model: &Description,
    method: CostMethod,
    parts: f64,
    options: &CostOptions,
) -> Result<Option<usize>, CostError> {
    let k = uncertain(model);
    let (Some(&few), Some(dense)) = (TUNING.trial_scans.get(k - 1), TUNING.dense_scans.get(k - 1)) else {
        return Ok(None);
    };
    let scan = |count, parts| Setting { method, count, stepping: finer(&model.simulation, parts) };
    let trial = scan(few, 1.0);
    let rate = spent(model, &trial, options)?.seconds / trial.work(k);
    let seconds = |points: usize| {
        let runs = [(points, parts), (points, parts / 2.0), (points / 2 + 1, parts), (points / 2 + 1, parts / 2.0)];
        runs.map(|(points, parts)| rate * scan(points, parts).work(k)).iter().sum::<f64>()
    };
    Ok(dense.iter().copied().find(|&points| seconds(points) <= TUNING.share_of_scan * options.budget))
}
