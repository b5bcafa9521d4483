//! What errors are measured against: bounds of a high order, extrapolated over three small steps, with an estimate of what
//! is still wrong with them.
//!
//! - *Steps.* B(h), B(2h), B(4h) of a scheme of second order extrapolate to (4 B(h) − B(2h))/3 and (4 B(2h) − B(4h))/3. The
//!   error of such a value falls with h by four or more, and so is at most a third of how far the two are apart. Controlled
//!   steps have no such expansion: there B(h) is taken as it is, and a third of its distance from B(2h).
//! - *Order.* How far the bounds are from those of order p − 2: rather the latter's error.
//! - *Scan.* How far a dense scan, extrapolated likewise, goes beyond the bounds: its samples lie in the true range.

use super::deviation::Known;
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
        let steppings = [1.0, 0.5, 0.25].map(|share| finer(&model.simulation, share * plan.parts));
        let complete = |method: CostMethod, count: usize, stepping: Stepping| {
            let (bounds, summary) = bounds(model, &Setting { method, count, stepping }, options, &|_| {})?;
            summary.failure.map_or(Ok(bounds), |failure| Err(CostError::Reference(failure)))
        };
        let limit = |method: CostMethod, count: usize| {
            let [fine, middle, coarse] = [0, 1, 2].map(|place| complete(method, count, steppings[place]));
            let runs = [fine?, middle?, coarse?];
            let (outputs, errors) = extrapolate(&runs, matches!(steppings[0], Stepping::Fixed(_)));
            Ok::<_, CostError>((runs, outputs, errors))
        };
        let ([.., coarse], outputs, absolute) = limit(plan.method, plan.order)?;
        let known = Known::new(outputs);
        let [of_bands, of_courses] = known.worst(&absolute);
        progress(0.6);

        let mut parts = vec![("its steps".to_owned(), of_bands)];
        let mut of_surrogate = 0.0;
        if let Some(lower) = plan.lower_order() {
            let bounds = complete(plan.method, lower, steppings[2])?;
            of_surrogate = known.with(coarse.outputs).of_bounds(&bounds.outputs).largest();
            parts.push((format!("its order, {} against {lower}", plan.order), of_surrogate));
        }
        progress(0.7);
        if let Some(points) = plan.scan {
            let (_, outputs, _) = limit(CostMethod::Scan, points)?;
            let beyond = known.of_bounds(&outputs).over_width();
            parts.push((format!("a scan of {points} points a parameter beyond it"), beyond));
            of_surrogate = of_surrogate.max(beyond);
        }
        let told = CostReference {
            method: plan.method,
            order: plan.order,
            steps: steppings,
            bounds_error: of_bands + of_surrogate,
            trajectory_error: of_courses,
            parts,
        };
        Ok(Self { known, told })
    }
}

/// The limit h → 0 of runs at h, 2h and 4h (or the first of them, where steps are not fixed), and the errors of each output's
/// band and course.
fn extrapolate(runs: &[Bounds; 3], fixed: bool) -> (Vec<OutputBounds>, Vec<[f64; 2]>) {
    let limit = |pick: &dyn Fn(&OutputBounds) -> &Vec<f64>, output: usize| {
        let [fine, middle, coarse] = runs.each_ref().map(|run| pick(&run.outputs[output]));
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
    let (mut outputs, mut errors) = (runs[0].outputs.clone(), Vec::new());
    for (place, output) in outputs.iter_mut().enumerate() {
        let of_course;
        (output.nominal, of_course) = limit(&|output| &output.nominal, place);
        let mut of_band = 0.0;
        if let Some(band) = output.bands.first_mut() {
            let (below, above);
            (band.lower, below) = limit(&|output| &output.bands[0].lower, place);
            (band.upper, above) = limit(&|output| &output.bands[0].upper, place);
            of_band = below.max(above);
        }
        errors.push([of_band, of_course]);
    }
    (outputs, errors)
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
        // x(h) = x + a h² + b h³: the limit from h = 1 is off by 4/3 b, and that from h = 2 by eight times as much.
        let (exact, b) = ([1.0, 2.0, 3.0], 1e-3);
        let at = |h: f64| run(exact.map(|x| x + 0.1 * h * h + b * h * h * h));
        let runs = [1.0, 2.0, 4.0].map(at);
        let (outputs, errors) = extrapolate(&runs, true);
        let off = exact.iter().zip(&outputs[0].nominal).map(|(x, value)| (x - value).abs());
        let worst = off.fold(0.0, f64::max);
        assert!((worst - 4.0 / 3.0 * b).abs() < 1e-12, "{worst}");
        let [of_band, of_course] = errors[0];
        assert!((of_course - 7.0 / 3.0 * worst).abs() < 1e-12 && of_band >= worst, "{errors:?}");
        // Without an expansion, a third of the change by the last halving.
        let (outputs, errors) = extrapolate(&runs, false);
        assert_eq!(outputs, runs[0].outputs);
        assert!((errors[0][1] - (0.3 + 7.0 * b) / 3.0).abs() < 1e-12, "{errors:?}");
    }
}
