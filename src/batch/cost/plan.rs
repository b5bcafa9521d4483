//! Which reference can be had within the budget.

use super::grid::{Setting, finer, uncertain};
use super::timing::timed;
use super::{CostError, CostOptions};
use crate::batch::scheme;
use crate::model::Description;
use crate::report::CostMethod;

/// Highest orders for one, two and three parameters; for more, the highest up to [`FEW`] that the solves allow.
const ORDERS: [usize; 3] = [24, 16, 10];
const FEW: usize = 7;

/// The order is not lowered below this for the time's sake.
const LEAST_ORDER: usize = 4;

/// Simulations of one run of the reference.
const MOST_SOLVES: f64 = 1e4;

/// How much finer the reference's finest steps may be than the model's.
const FINEST: [f64; 3] = [16.0, 8.0, 4.0];

/// Points of the dense scan, a parameter, for one and two.
const DENSE: [usize; 2] = [101, 21];

/// Share of the budget that the reference may take, and of that, the scan.
const SHARE: f64 = 1.0 / 3.0;
const SCAN_SHARE: f64 = 0.5;

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
        let method = if composable { CostMethod::Composed } else { CostMethod::Tight };
        let setting = |count, parts| Setting { method, count, stepping: finer(simulation, parts) };
        let solves = |order| setting(order, 1.0).solves(k);
        let highest = ORDERS.get(k - 1).copied();
        let highest =
            highest.unwrap_or_else(|| (2..=FEW).rev().find(|&order| solves(order) <= MOST_SOLVES).unwrap_or(2));
        if solves(highest) > MOST_SOLVES {
            return Err(CostError::TooMany { parameters: k, solves: solves(highest) });
        }

        // Seconds are a constant, which is the composition's, and a rate times the work.
        let probe =
            |setting: Setting| timed(model, &setting, options, &|_| {}).map(|(_, seconds)| (setting.work(k), seconds));
        let [short, long] = [probe(setting(2, 1.0))?, probe(setting(2, 4.0))?];
        let rate = ((long.1 - short.1) / (long.0 - short.0)).max(0.0);
        let constant = (short.1 - rate * short.0).max(0.0);
        let halved = |parts: f64| [parts, parts / 2.0, parts / 4.0];
        let seconds = |order, parts| {
            halved(parts).map(|parts| constant + rate * setting(order, parts).work(k)).iter().sum::<f64>()
        };

        let affordable = SHARE * options.budget;
        let least = LEAST_ORDER.min(highest);
        let orders = (least..=highest).rev().step_by(2);
        let mut choices = orders.flat_map(|order| FINEST.map(|parts| (order, parts)));
        let (order, parts) = choices
            .find(|&(order, parts)| seconds(order, parts) <= affordable)
            .unwrap_or((least, FINEST[FINEST.len() - 1]));
        let of_scan = |points: usize| {
            let work = |parts| Setting { method: CostMethod::Scan, ..setting(points, parts) }.work(k);
            rate * halved(parts).map(work).iter().sum::<f64>()
        };
        let scan = DENSE.get(k - 1).copied().filter(|&points| of_scan(points) <= SCAN_SHARE * affordable);
        Ok(Self { method, order, parts, scan })
    }

    /// The order that tells how far the reference's is off, where it has one.
    pub(super) fn lower_order(&self) -> Option<usize> {
        (self.order > 1).then(|| self.order.saturating_sub(2).max(1))
    }
}
