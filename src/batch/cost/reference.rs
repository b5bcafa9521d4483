//! What errors are measured against: bounds of a high order, extrapolated over three small steps, with an estimate of what
//! is still wrong with them.
//!
//! - *Steps.* B(h), B(2h), B(4h) of a scheme of second order extrapolate to (4 B(h) − B(2h))/3 and (4 B(2h) − B(4h))/3. The
//!   error of such a value falls with h by four or more, and so is at most a third of how far the two are apart. Controlled
//!   steps have no such expansion: there B(h) is taken as it is, and a third of its distance from B(2h).
//! - *Order.* How far the bounds are from those of order p − 2: rather the latter's error.
//! - *Scan.* How far a dense scan, whose samples lie in the true range, goes beyond the bounds.

use super::deviation::{Known, apart};
use super::grid::{Setting, finer};
use super::plan::Plan;
use super::timing::bounds;
use super::{CostError, CostOptions};
use crate::bounds::{Bounds, OutputBounds};
use crate::model::{Description, Stepping};
use crate::report::{CostMethod, CostReference};

/// Bounds and nominal courses that others are held against, and what is known of their errors.
pub(super) struct Reference {
    pub(super) known: Known,
    pub(super) told: CostReference,
}

impl Reference {
    /// Carries out a plan. `progress` is told which share is done.
    ///
    /// # Errors
    /// Where a run fails or ends early.
    pub(super) fn compute(
        model: &Description,
        plan: &Plan,
        options: &CostOptions,
        progress: &dyn Fn(f64),
    ) -> Result<Self, CostError> {
        let complete = |method: CostMethod, count: usize, stepping: Stepping| {
            let (bounds, summary) = bounds(model, &Setting { method, count, stepping }, options, &|_| {})?;
            summary.failure.map_or(Ok(bounds), |failure| Err(CostError::Reference(failure)))
        };
        let steppings = [1.0, 0.5, 0.25].map(|share| finer(&model.simulation, share * plan.parts));
        let fine = complete(plan.method, plan.order, steppings[0])?;
        progress(0.5);
        let middle = complete(plan.method, plan.order, steppings[1])?;
        let coarse = complete(plan.method, plan.order, steppings[2])?;
        progress(0.8);
        let (known, of_steps) = extrapolate(&fine, &middle, &coarse, matches!(steppings[0], Stepping::Fixed(_)));

        let mut parts = vec![("its steps".to_owned(), of_steps.bounds)];
        let (mut of_surrogate, own) = (0.0, finer(&model.simulation, 1.0));
        if !matches!(plan.method, CostMethod::Scheme(_)) {
            let here = known.with(complete(plan.method, plan.order, own)?.outputs);
            let lower = complete(plan.method, plan.order - 2, own)?;
            of_surrogate = here.of_bounds(&lower).largest();
            parts.push((format!("its order ({} against {})", plan.order, plan.order - 2), of_surrogate));
            if let Some(points) = plan.scan {
                let beyond = here.of_bounds(&complete(CostMethod::Scan, points, own)?).over_width();
                parts.push((format!("a scan of {points} points a parameter beyond it"), beyond));
                of_surrogate = of_surrogate.max(beyond);
            }
        }
        let told = CostReference {
            method: plan.method,
            order: plan.order,
            steps: steppings,
            bounds_error: of_steps.bounds + of_surrogate,
            trajectory_error: of_steps.trajectories,
            parts,
        };
        Ok(Self { known, told })
    }
}

/// Largest errors, relative to the outputs' scales.
#[derive(Default)]
struct Errors {
    bounds: f64,
    trajectories: f64,
}

/// The limit h → 0 of runs at h, 2h and 4h (or the first of them, where steps are not fixed), and its error.
fn extrapolate(fine: &Bounds, middle: &Bounds, coarse: &Bounds, fixed: bool) -> (Known, Errors) {
    let limit = |pick: &dyn Fn(&OutputBounds) -> &Vec<f64>, output: usize| {
        let [fine, middle, coarse] = [fine, middle, coarse].map(|run| pick(&run.outputs[output]));
        let mut error = 0.0_f64;
        let values = fine.iter().zip(middle).zip(coarse).map(|((fine, middle), coarse)| {
            let value = if fixed { (4.0 * fine - middle) / 3.0 } else { *fine };
            let before = if fixed { (4.0 * middle - coarse) / 3.0 } else { *middle };
            // Not a number, where bounds are unknown, counts for nothing: those rows are not compared.
            error = error.max((value - before).abs() / 3.0);
            value
        });
        (values.collect::<Vec<f64>>(), error)
    };
    let (mut outputs, mut absolute) = (fine.outputs.clone(), Vec::new());
    for (place, output) in outputs.iter_mut().enumerate() {
        let (nominal, of_trajectory) = limit(&|output| &output.nominal, place);
        output.nominal = nominal;
        let mut of_bounds = 0.0;
        if let Some(band) = output.bands.first_mut() {
            let (lower, below) = limit(&|output| &output.bands[0].lower, place);
            let (upper, above) = limit(&|output| &output.bands[0].upper, place);
            (band.lower, band.upper) = (lower, upper);
            of_bounds = below.max(above);
        }
        absolute.push((of_bounds, of_trajectory));
    }
    let known = Known::new(outputs);
    let mut errors = Errors::default();
    for (&(of_bounds, of_trajectory), &scale) in absolute.iter().zip(&known.scales) {
        errors.bounds = errors.bounds.max(apart(of_bounds, scale));
        errors.trajectories = errors.trajectories.max(apart(of_trajectory, scale));
    }
    (known, errors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::{Band, Method};

    /// An output whose nominal course and lower bound are `values`, with a band of width one above.
    fn run(values: [f64; 3]) -> Bounds {
        let upper = values.iter().map(|value| value + 1.0).collect();
        let band = Band { method: Method::Chebyshev, lower: values.to_vec(), upper };
        let output =
            OutputBounds { name: "x".into(), unit: String::new(), nominal: values.to_vec(), bands: vec![band] };
        Bounds { times: vec![0.0, 1.0, 2.0], outputs: vec![output] }
    }

    #[test]
    fn an_error_of_second_order_is_extrapolated_and_what_is_left_is_estimated() {
        // x(h) = x + a h² + b h³, and its limit at h = 1 is off by −4/3 b... estimated by a third of 7 · 4/3 b.
        let (exact, b) = ([1.0, 2.0, 3.0], 1e-3);
        let at = |h: f64| run(exact.map(|x| x + 0.1 * h * h + b * h * h * h));
        let (known, errors) = extrapolate(&at(1.0), &at(2.0), &at(4.0), true);
        let off = exact.iter().zip(&known.outputs[0].nominal).map(|(x, value)| (x - value).abs());
        let worst = off.fold(0.0, f64::max);
        assert!((worst - 4.0 / 3.0 * b).abs() < 1e-12, "{worst}");
        assert!(
            (errors.trajectories - 7.0 / 3.0 * worst).abs() < 1e-12 && errors.bounds >= worst,
            "{}",
            errors.trajectories
        );
        let (known, errors) = extrapolate(&at(1.0), &at(2.0), &at(4.0), false);
        assert_eq!(known.outputs, at(1.0).outputs);
        assert!(errors.bounds > 0.1, "{}", errors.bounds);
    }
}
