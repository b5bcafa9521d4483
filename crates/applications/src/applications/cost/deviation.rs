//! Deviation of bounds and profiles from the reference.
//!
//! Each output has its scale: the widest that its known band gets, or, without a band, how far its course reaches. What
//! deviates is divided by it.

use super::tuning::TUNING;
use crate::results::Deviation;
use crate::results::OutputBounds;

/// Bands (one an output, or none) and nominal courses, with the outputs' scales.
pub(super) struct KnownBands {
    outputs: Vec<OutputBounds>,
    /// NaN for outputs that have none.
    scales: Vec<f64>,
}

/// A distance relative to a scale: infinite if unknown, and zero without a scale.
fn apart(distance: f64, scale: f64) -> f64 {
    let relative = distance / scale;
    match relative.is_nan() {
        _ if scale.is_nan() => 0.0,
        true => f64::INFINITY,
        false => relative,
    }
}

/// Lower and upper bound in a row; NaN beyond the last.
fn ends(output: &OutputBounds, row: usize) -> [f64; 2] {
    let band = output.bands.first().filter(|band| row < band.lower.len());
    band.map_or([f64::NAN; 2], |band| [band.lower[row], band.upper[row]])
}

fn scale(output: &OutputBounds) -> f64 {
    let widths = (0..output.nominal.len()).map(|row| ends(output, row)).map(|[lower, upper]| upper - lower);
    let (low, high) =
        output.nominal.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)));
    let scale = if output.bands.is_empty() { high - low } else { widths.fold(0.0, f64::max) };
    if scale > TUNING.at_rest * low.abs().max(high.abs()) { scale } else { f64::NAN }
}

impl KnownBands {
    pub(super) fn new(outputs: Vec<OutputBounds>) -> Self {
        let scales = outputs.iter().map(scale).collect();
        Self { outputs, scales }
    }

    /// Other outputs, to the same scales.
    pub(super) fn with(&self, outputs: Vec<OutputBounds>) -> Self {
        Self { outputs, scales: self.scales.clone() }
    }

    /// Widens the known bands, if there are any, to the first of other outputs.
    pub(super) fn widen(&mut self, outputs: &[OutputBounds]) {
        for (known, output) in self.outputs.iter_mut().zip(outputs) {
            for row in 0..known.nominal.len() {
                let ([lower, upper], [of_lower, of_upper]) = (ends(known, row), ends(output, row));
                if of_lower < lower {
                    known.bands[0].lower[row] = of_lower;
                }
                if of_upper > upper {
                    known.bands[0].upper[row] = of_upper;
                }
            }
        }
    }

    /// Names of the outputs that are not compared.
    pub(super) fn at_rest(&self) -> impl Iterator<Item = &str> {
        let outputs = self.outputs.iter().zip(&self.scales).filter(|(_, scale)| scale.is_nan());
        outputs.map(|(output, _)| output.name.as_str())
    }

    /// Distances by which the first band of each output lies outside of the known one, and inside: an unknown bound is
    /// infinitely far outside. Rows without a known bound are not compared.
    pub(super) fn of_bounds(&self, outputs: &[OutputBounds]) -> Deviation {
        let (mut over_width, mut under_coverage) = (0.0_f64, 0.0_f64);
        for ((known, &scale), output) in self.outputs.iter().zip(&self.scales).zip(outputs) {
            for row in 0..known.nominal.len() {
                let [lower, upper] = ends(known, row);
                if !(lower.is_finite() && upper.is_finite()) {
                    continue;
                }
                let [of_lower, of_upper] = ends(output, row);
                for outside in [lower - of_lower, of_upper - upper].map(|distance| apart(distance, scale)) {
                    over_width = over_width.max(outside);
                    under_coverage = under_coverage.max(-outside);
                }
            }
        }
        Deviation::Bounds { over_width, under_coverage }
    }

    /// Distance of courses from the nominal ones, output by output; infinite for missing rows.
    pub(super) fn of_courses<'c>(&self, courses: impl Iterator<Item = &'c [f64]>) -> Deviation {
        let mut error = 0.0_f64;
        for ((known, &scale), course) in self.outputs.iter().zip(&self.scales).zip(courses) {
            let values = course.iter().copied().chain(std::iter::repeat(f64::NAN));
            for (exact, value) in known.nominal.iter().zip(values) {
                error = error.max(apart((value - exact).abs(), scale));
            }
        }
        Deviation::Trajectory(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::{Band, Method};

    fn output(lower: &[f64], upper: &[f64]) -> OutputBounds {
        let band =
            Band { method: Method::Scan, lower: lower.to_vec(), upper: upper.to_vec(), error: BandError::default() };
        OutputBounds { name: "x".into(), unit: "m".into(), display: None, nominal: vec![0.5; 3], bands: vec![band] }
    }

    #[test]
    fn excess_and_deficit_of_width_are_distinguished() {
        let known = KnownBands::new(vec![output(&[0.5, 0.0, f64::NAN], &[0.5, 2.0, 3.0])]);
        assert_eq!(known.scales, [2.0]);
        let of = |lower: &[f64], upper: &[f64]| known.of_bounds(&[output(lower, upper)]);
        let is = |over_width, under_coverage| Deviation::Bounds { over_width, under_coverage };
        assert_eq!(of(&[0.5, 0.0, 9.0], &[0.5, 2.0, 9.0]), is(0.0, 0.0));
        assert_eq!(of(&[0.4, 0.2, 9.0], &[0.5, 2.3, 9.0]), is((2.3 - 2.0) / 2.0, 0.1));
        // A bound that is not known, and a row that is missing.
        assert_eq!(of(&[0.5, f64::NAN, 9.0], &[0.5, 1.0, 9.0]), is(f64::INFINITY, 0.5));
        assert_eq!(of(&[0.5], &[0.5]), is(f64::INFINITY, 0.0));
    }

    #[test]
    fn output_at_rest_is_ignored() {
        let still = OutputBounds { bands: vec![], ..output(&[], &[]) };
        let moving = OutputBounds { name: "y".into(), nominal: vec![0.0, 1.0, 4.0], ..still.clone() };
        let known = KnownBands::new(vec![still, moving]);
        assert_eq!(known.at_rest().collect::<Vec<_>>(), ["x"]);
        let of = |course: &[f64]| known.of_courses([&[9.0; 3], course].into_iter());
        assert_eq!(of(&[0.0, 1.0, 3.0]), Deviation::Trajectory(0.25));
        assert_eq!(of(&[0.0, 1.0]), Deviation::Trajectory(f64::INFINITY));
    }

    #[test]
    fn bands_are_widened_where_they_are_known() {
        let mut known = KnownBands::new(vec![output(&[0.0, 0.0, f64::NAN], &[1.0, 2.0, f64::NAN])]);
        known.widen(&[output(&[-1.0, 0.5, 0.0], &[0.5, 3.0, 0.0])]);
        let is = |lower: &[f64], upper: &[f64]| known.of_bounds(&[output(lower, upper)]);
        let exact = Deviation::Bounds { over_width: 0.0, under_coverage: 0.0 };
        assert_eq!(is(&[-1.0, 0.0, 7.0], &[1.0, 3.0, 7.0]), exact, "a row that is not known stays so");
    }
}
