//! Which reference can be had within the budget.

use super::grid::{SCAN, Setting, finer, smoothest, uncertain};
use super::timing::timed;
use super::{CostError, CostOptions};
use crate::model::Description;
use crate::results::CostMethod;
use crate::study::scheme;

/// Highest orders for one, two and three parameters; for more, the highest up to [`FEW`] that this many simulations allow.
const ORDERS: [usize; 3] = [24, 16, 10];
const FEW: usize = 7;

/// The order is not lowered below this for the time's sake.
const LEAST_ORDER: usize = 4;

/// Simulations of one run of the reference.
const MOST_SIMULATIONS: f64 = 1e4;

/// How much finer the reference's finest steps may be than the model's.
const FINEST: [f64; 3] = [16.0, 8.0, 4.0];

/// Points of the dense scan, a parameter, for one, two and three: odd, so that every second of them makes a scan too.
const DENSE: [[usize; 3]; 3] = [[401, 201, 101], [61, 41, 21], [21, 13, 9]];

/// Points of a scan that tells what many samples take.
const SCAN_TRIAL: [usize; 3] = [64, 8, 4];

/// Shares of the budget that the reference's surrogate and its scan may take.
const SHARE: f64 = 0.25;
const SCAN_SHARE: f64 = 0.25;

/// What is run for the reference: with three step sizes, each twice the one before.
pub(super) struct Plan {
    pub(super) method: CostMethod,
    pub(super) order: usize,
    /// How much finer the finest steps are than the model's.
    pub(super) parts: f64,
    /// Points of the dense scan.
    pub(super) scan: Option<usize>,
}

impl Plan {
    /// The highest order, and with it the finest steps, that two short runs promise to be done in time; the cheapest there is
    /// where none is.
    ///
    /// # Errors
    /// Where a run fails, or there are too many parameters for any.
    pub(super) fn within_budget(
        model: &Description,
        composable: bool,
        options: &CostOptions,
    ) -> Result<Self, CostError> {
        let k = uncertain(model);
        let simulation = &model.simulation;
        if k == 0 {
            // One simulation, which is cheap.
            return Ok(Self { method: CostMethod::Scheme(scheme(model)), order: 0, parts: FINEST[0], scan: None });
        }
        let method = smoothest(composable);
        let setting = |count, parts| Setting { method, count, stepping: finer(simulation, parts) };
        let simulations = |order| setting(order, 1.0).simulations(k);
        let highest = ORDERS.get(k - 1).copied();
        let highest = highest
            .unwrap_or_else(|| (2..=FEW).rev().find(|&order| simulations(order) <= MOST_SIMULATIONS).unwrap_or(2));
        if simulations(highest) > MOST_SIMULATIONS {
            return Err(CostError::TooMany { parameters: k, simulations: simulations(highest) });
        }

        // Seconds are a constant, which is the composition's, and a rate times the work.
        let trials = [setting(2, 1.0), setting(2, 4.0)];
        let [short, long] = [measured(model, &trials[0], options)?, measured(model, &trials[1], options)?];
        let rate = ((long - short) / (trials[1].work(k) - trials[0].work(k))).max(0.0);
        let constant = (short - rate * trials[0].work(k)).max(0.0);
        let seconds = |order, parts: f64| {
            [parts, parts / 2.0, parts / 4.0]
                .map(|parts| constant + rate * setting(order, parts).work(k))
                .iter()
                .sum::<f64>()
        };
        let least = LEAST_ORDER.min(highest);
        let orders = (least..=highest).rev().step_by(2);
        let (order, parts) = orders
            .flat_map(|order| FINEST.map(|parts| (order, parts)))
            .find(|&(order, parts)| seconds(order, parts) <= SHARE * options.budget)
            .unwrap_or((least, FINEST[FINEST.len() - 1]));
        Ok(Self { method, order, parts, scan: dense_scan(model, parts, options)? })
    }

    /// The order that tells how far the reference's is off, where it has one.
    pub(super) fn lower_order(&self) -> Option<usize> {
        (self.order > 1).then(|| self.order.saturating_sub(2).max(1))
    }
}

/// What a setting takes, s.
fn measured(model: &Description, setting: &Setting, options: &CostOptions) -> Result<f64, CostError> {
    Ok(timed(model, setting, options, &|_| {})?.1)
}

/// Points of the densest scan, and of its half, that can be done in time, each with two step sizes; none for many parameters.
fn dense_scan(model: &Description, parts: f64, options: &CostOptions) -> Result<Option<usize>, CostError> {
    let k = uncertain(model);
    let (Some(&few), Some(dense)) = (SCAN_TRIAL.get(k - 1), DENSE.get(k - 1)) else { return Ok(None) };
    let scan = |count, parts| Setting { method: SCAN, count, stepping: finer(&model.simulation, parts) };
    let trial = scan(few, 1.0);
    let rate = measured(model, &trial, options)? / trial.work(k);
    let seconds = |points: usize| {
        let runs = [(points, parts), (points, parts / 2.0), (points / 2 + 1, parts), (points / 2 + 1, parts / 2.0)];
        runs.map(|(points, parts)| rate * scan(points, parts).work(k)).iter().sum::<f64>()
    };
    Ok(dense.iter().copied().find(|&points| seconds(points) <= SCAN_SHARE * options.budget))
}
