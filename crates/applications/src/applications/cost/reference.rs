//! The reference for errors: bounds of a high order, extrapolated over small steps and widened to the range of a dense
//! scan, with an estimate of their remaining error.
//!
//! - *Steps.* Where no equation switches, every sample's steps are extrapolated, and B(h) is taken as it is. Else B(h),
//!   B(2h), B(4h) of a scheme of second order extrapolate to (4 B(h) − B(2h))/3 and (4 B(2h) − B(4h))/3. The error of
//!   either falls with h by four or more, and so is at most a third of how far it is from that of twice the steps.
//!   Controlled steps have no such expansion: there B(h) is taken as it is, and a third of its distance from B(2h).
//! - *Order.* How far the bounds are from those of order p − 2: rather the latter's error.
//! - *Scan.* Its samples lie in the true range. The rest is taken to be as much as it adds to a scan of half its
//!   density.

use std::cell::Cell;

use super::deviation::KnownBands;
use super::grid::{SCAN, Setting, finer};
use super::plan::ReferencePlan;
use super::timing::bounds;
use super::{CostError, CostOptions};
use crate::model::{Description, Stepping};
use crate::results::{Bounds, OutputBounds};
use crate::results::{CostMethod, CostReference};

/// Bounds and nominal courses with which others are compared, and the estimates of their errors.
pub(super) struct Reference {
    pub(super) known: KnownBands,
    pub(super) summary: CostReference,
}

impl Reference {
    /// Carries out a plan. `progress` gets the share that is done.
    ///
    /// # Errors
    /// If a run fails or ends early.
    pub(super) fn compute(
        model: &Description,
        plan: &ReferencePlan,
        options: &CostOptions,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Self, CostError> {
        let steppings = [1.0, 0.5, 0.25].map(|share| finer(&model.simulation, share * plan.parts));
        let [h, h2, h4] = steppings;
        let done = Cell::new(0.0);
        // Each run has a part of the bar, by about its cost.
        let run = |method: CostMethod, count: usize, stepping: Stepping, share: f64| {
            let setting = Setting { method, count, stepping };
            let before = done.replace(done.get() + share);
            progress(before);
            let (bounds, summary) = bounds(model, &setting, options, &|fraction| progress(before + share * fraction))?;
            summary.failure.map_or(Ok(bounds), |failure| Err(CostError::Reference(failure)))
        };
        let is_plain = matches!(h, Stepping::Fixed(_)) && plan.method.integrator().is_none();
        let limit = |fine: &Bounds, coarse: &Bounds| {
            if is_plain { extrapolated(fine, coarse) } else { fine.outputs.clone() }
        };

        let fine = run(plan.method, plan.order, h, 0.4)?;
        let (middle, coarse) = (run(plan.method, plan.order, h2, 0.2)?, run(plan.method, plan.order, h4, 0.1)?);
        let mut known = KnownBands::new(limit(&fine, &middle));
        let before = limit(&middle, &coarse);
        let of_steps = known.of_bounds(&before).largest() / 3.0;
        let of_courses = known.of_courses(before.iter().map(|output| &output.nominal[..])).largest() / 3.0;
        let mut parts = Vec::new();
        if let Some(lower) = plan.lower_order() {
            let lower_bounds = run(plan.method, lower, h4, 0.05)?;
            let of_order = known.with(coarse.outputs).of_bounds(&lower_bounds.outputs).largest();
            parts.extend([("steps".to_owned(), of_steps), (format!("order {} for {lower}", plan.order), of_order)]);
        }
        if let Some(points) = plan.scan {
            let scan = |points| {
                let scan = plan.method.integrator().map_or(SCAN, |integrator| SCAN.by(integrator));
                let fine = run(scan, points, h, 0.08)?;
                let limit = if is_plain { extrapolated(&fine, &run(scan, points, h2, 0.04)?) } else { fine.outputs };
                Ok::<_, CostError>(limit)
            };
            known.widen(&scan(points / 2 + 1)?);
            let whole = scan(points)?;
            let added = known.of_bounds(&whole).over_width();
            known.widen(&whole);
            parts.push((format!("scan of {points} points for {}", points / 2 + 1), added));
        }
        let summary = CostReference {
            method: plan.method,
            order: plan.order,
            steps: steppings,
            bounds_error: parts.iter().map(|(_, size)| size).sum(),
            trajectory_error: of_courses,
            parts,
        };
        Ok(Self { known, summary })
    }
}

/// The limit h → 0 of bounds and courses at h and 2h.
fn extrapolated(fine: &Bounds, coarse: &Bounds) -> Vec<OutputBounds> {
    let limit = |fine: &mut [f64], coarse: &[f64]| {
        fine.iter_mut().zip(coarse).for_each(|(fine, coarse)| *fine = (4.0 * *fine - coarse) / 3.0);
    };
    let mut outputs = fine.outputs.clone();
    for (output, coarse) in outputs.iter_mut().zip(&coarse.outputs) {
        limit(&mut output.nominal, &coarse.nominal);
        for (band, coarse) in output.bands.iter_mut().zip(&coarse.bands) {
            limit(&mut band.lower, &coarse.lower);
            limit(&mut band.upper, &coarse.upper);
        }
    }
    outputs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::{Band, Method};

    #[test]
    fn errors_of_second_order_are_extrapolated_away() {
        let at = |h: f64| {
            let curve = |value: f64| vec![value + 0.1 * h * h, 2.0 * value - 3.0 * h * h];
            let band =
                Band { method: Method::Chebyshev, lower: curve(1.0), upper: curve(2.0), error: BandError::default() };
            let output = OutputBounds {
                name: "x".into(),
                unit: String::new(),
                display: None,
                nominal: curve(1.5),
                bands: vec![band],
            };
            Bounds { times: vec![0.0, 1.0], outputs: vec![output], ..Bounds::default() }
        };
        let limit = &extrapolated(&at(0.5), &at(1.0))[0];
        for (found, exact) in [(&limit.nominal, 1.5), (&limit.bands[0].lower, 1.0), (&limit.bands[0].upper, 2.0)] {
            assert!((found[0] - exact).abs() < 1e-14 && (found[1] - 2.0 * exact).abs() < 1e-14, "{found:?}");
        }
    }
}
