//! Which reference can be had within the budget.

use super::grid::{LEVELS, SCAN, Setting, finer, smoothest, uncertain};
use super::timing::spent;
use super::{CostError, CostOptions};
use crate::model::Description;
use crate::results::CostMethod;
use crate::study::scheme;

/// Highest orders for one, two and three parameters; for more, the highest up to [`FEW`] that this many simulations
/// allow.
const ORDERS: [usize; 3] = [32, 24, 10];
const FEW: usize = 7;

/// The order is not lowered below this for the time's sake, nor the steps made coarser.
const LEAST_ORDER: usize = 2;

/// Simulations of one run of the reference.
const MOST_SIMULATIONS: f64 = 1e4;

/// How much finer the reference's finest steps may be than the model's.
const FINEST: [f64; 5] = [16.0, 8.0, 4.0, 2.0, 1.0];

/// Points of the dense scan, a parameter, for one, two and three: odd, so that every second of them makes a scan too.
const DENSE: [[usize; 3]; 3] = [[401, 201, 101], [61, 41, 21], [21, 13, 9]];

/// Points of a scan that tells what many samples take.
const SCAN_TRIAL: [usize; 3] = [64, 8, 4];

/// The coarsest reference may take this share; with more, nothing would be left to compare with it.
const MOST: f64 = 0.7;

/// What orders add is only measured where a short run takes less than this share.
const TRIAL: f64 = 0.05;

/// Shares of the budget that the reference's surrogate and its scan may take.
const SHARE: f64 = 0.35;
const SCAN_SHARE: f64 = 0.25;

/// Runs for the reference: with three step sizes, each twice the one before.
pub(super) struct ReferencePlan {
    pub(super) method: CostMethod,
    pub(super) order: usize,
    /// How much finer the finest steps are than the model's.
    pub(super) parts: f64,
    /// Points of the dense scan.
    pub(super) scan: Option<usize>,
    /// What a run takes on the clock for each of a setting's work, s, about; 0 where it is not known.
    pub(super) rate: f64,
}

impl ReferencePlan {
    /// The highest order, and with it the finest steps, that two short runs promise to be done in time; the cheapest
    /// there is where none is. Where the error has an expansion in powers of the steps, these are extrapolated.
    ///
    /// # Errors
    /// Where a run fails, or even the coarsest takes too long, or there are too many parameters for any.
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
                parts: FINEST[0],
                scan: None,
                rate: 0.0,
            });
        }
        let method = of_steps(smoothest(composable));
        let setting = |count, parts| Setting { method, count, stepping: finer(simulation, parts) };
        let simulations = |order| setting(order, 1.0).simulations(k);
        let highest = ORDERS.get(k - 1).copied();
        let highest = highest
            .unwrap_or_else(|| (2..=FEW).rev().find(|&order| simulations(order) <= MOST_SIMULATIONS).unwrap_or(2));
        if simulations(highest) > MOST_SIMULATIONS {
            return Err(CostError::TooMany { parameters: k, simulations: simulations(highest) });
        }

        // Seconds on the clock are a constant, in which the model is compiled, and a rate times the simulations: by the
        // method, and beside it, which takes as many simulations at every order.
        let trials = [setting(2, 0.5), setting(2, 1.0)];
        let [coarse, fine] = [spent(model, &trials[0], options)?, spent(model, &trials[1], options)?];
        let rate = ((fine.seconds - coarse.seconds) / (fine.work - coarse.work)).max(0.0);
        let rate = if rate.is_finite() { rate } else { 0.0 };
        let constant = (fine.seconds - rate * fine.work).max(0.0);
        // What a range takes to be found grows with the samples of its polynomial, whatever the steps.
        let growth = if fine.seconds > TRIAL * options.budget || highest < 4 {
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
            let lower = if order > LEAST_ORDER { order - 2 } else { 1 };
            [parts, parts / 2.0, parts / 4.0].map(|parts| run(order, parts)).iter().sum::<f64>()
                + run(lower, parts / 4.0)
        };
        let least = LEAST_ORDER.min(highest);
        let orders = (least..=highest).rev().step_by(2);
        let (order, parts) = orders
            .flat_map(|order| FINEST.map(|parts| (order, parts)))
            .find(|&(order, parts)| seconds(order, parts) <= SHARE * options.budget)
            .unwrap_or((least, FINEST[FINEST.len() - 1]));
        let least_seconds = seconds(order, parts);
        if (options.interrupted)() || least_seconds > MOST * options.budget {
            return Err(CostError::TooCostly { seconds: least_seconds });
        }
        let rate = fine.seconds / trials[1].work(k);
        let scan = dense_scan(model, of_steps(SCAN), parts, options)?;
        Ok(Self { method, order, parts, scan, rate })
    }

    /// The order that tells how far the reference's is off, where it has one.
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
    let (Some(&few), Some(dense)) = (SCAN_TRIAL.get(k - 1), DENSE.get(k - 1)) else { return Ok(None) };
    let scan = |count, parts| Setting { method, count, stepping: finer(&model.simulation, parts) };
    let trial = scan(few, 1.0);
    let rate = spent(model, &trial, options)?.seconds / trial.work(k);
    let seconds = |points: usize| {
        let runs = [(points, parts), (points, parts / 2.0), (points / 2 + 1, parts), (points / 2 + 1, parts / 2.0)];
        runs.map(|(points, parts)| rate * scan(points, parts).work(k)).iter().sum::<f64>()
    };
    Ok(dense.iter().copied().find(|&points| seconds(points) <= SCAN_SHARE * options.budget))
}
