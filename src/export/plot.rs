//! `x3.svg`: an output's bounds over time, and their distance from the nominal course.

use plotters::prelude::*;

use super::canvas::fine;
use super::figure::{Course, figure_svg};
use super::panel::Style;
use crate::methods::{About, Method};
use crate::results::OutputBounds;

fn style(method: Method) -> Style {
    let About { label, color: [red, green, blue], fill, dashes, .. } = *method.about();
    Style { label: label.to_owned(), color: RGBColor(red, green, blue), edge: 2.0, fill, dashes }
}

/// The plot of one output as an SVG document. The same data give the same bytes.
///
/// # Errors
/// plotters' own, as text; none is known to occur.
pub fn plot_svg(times: &[f64], output: &OutputBounds) -> Result<String, String> {
    let bands = output.bands.iter().map(|band| (band, style(band.method))).collect();
    let course = Course { label: "Nominal", color: BLACK, times, nominal: &output.nominal, bands };
    Ok(dashed(&figure_svg(&output.name, &output.unit, &[course])?))
}

/// Gives methods' lines, known by their colours, their dashes: plotters would draw each dash as a line of its own.
fn dashed(svg: &str) -> String {
    Method::ALL.map(style).iter().fold(svg.to_owned(), |svg, style| {
        let Some(dashes) = style.dashes else { return svg };
        let RGBColor(r, g, b) = style.color;
        let stroke = format!("stroke=\"#{r:02X}{g:02X}{b:02X}\"");
        let [dash, gap] = dashes.map(fine);
        svg.replace(&stroke, &format!("{stroke} stroke-dasharray=\"{dash} {gap}\""))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::Band;

    fn error(rows: usize, error: f64) -> BandError {
        BandError { total: vec![error; rows], unresolved: vec![false; rows], ..BandError::default() }
    }

    /// A damped oscillation with bands of about a per cent, one method a little wider than the next.
    fn sample(n: usize) -> (Vec<f64>, OutputBounds) {
        let times: Vec<f64> = (0..n).map(|i| 2.0 * i as f64 / (n - 1) as f64).collect();
        let course = |t: f64| 0.56 + 0.15 * (4.0 * t).cos() * (-0.3 * t).exp();
        let half = |t: f64| 0.002 * t * (1.0 + (8.0 * t).sin().powi(2));
        let nominal: Vec<f64> = times.iter().map(|&t| course(t)).collect();
        let band = |method, wide: f64| Band {
            method,
            lower: times.iter().map(|&t| course(t) - wide * half(t)).collect(),
            upper: times.iter().map(|&t| course(t) + wide * half(t) * 0.9).collect(),
            error: error(n, 1e-4),
        };
        let bands = vec![band(Method::Chebyshev, 1.0), band(Method::Taylor, 1.0), band(Method::Scan, 0.99)];
        (times.clone(), OutputBounds { name: "x3".into(), unit: "m".into(), nominal, bands })
    }

    fn check(svg: &str) {
        assert!(svg.starts_with("<svg width=\"900\" height=\"560\""), "{}", &svg[..200]);
        assert!(svg.contains("viewBox=\"0 0 9000 5600\""));
        assert!(svg.trim_end().ends_with("</svg>"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let off = (i32::MAX.to_string(), i32::MIN.to_string());
        assert!(!svg.contains(&off.0) && !svg.contains(&off.1), "a point far off the page");
    }

    #[test]
    fn plots_have_axes_a_legend_and_all_curves() {
        let (times, output) = sample(201);
        let svg = plot_svg(&times, &output).unwrap();
        check(&svg);
        for text in ["x3 [m]", "t [s]", "bound − nominal [10⁻³ m]", "Nominal", "Chebyshev", "Taylor", "Scan"] {
            assert!(svg.contains(text), "{text}");
        }
        assert_eq!(svg, plot_svg(&times, &output).unwrap(), "the same data, the same bytes");
    }

    #[test]
    fn long_runs_make_small_files() {
        let (times, output) = sample(200_001);
        let svg = plot_svg(&times, &output).unwrap();
        check(&svg);
        assert!(svg.len() < 400_000, "{} bytes", svg.len());
    }

    #[test]
    fn gaps_constants_and_extremes_are_drawn() {
        let (times, gap) = sample(101);
        let mut output = gap;
        for i in 40..50 {
            output.nominal[i] = f64::NAN;
            output.bands[1].upper[i + 20] = f64::INFINITY;
        }
        output.bands[0].lower.fill(f64::NAN);
        let svg = plot_svg(&times, &output).unwrap();
        check(&svg);

        for value in [0.0, 5.0, -1e-310, f64::MAX, 1e-9, f64::NAN] {
            let (lower, upper) = (vec![value; 101], vec![value; 101]);
            let mut flat = Band { method: Method::Scan, lower, upper, error: error(101, value) };
            flat.error.unresolved[3..].fill(true);
            let nominal = vec![value; 101];
            let constant = OutputBounds { name: "<c & d>".into(), unit: String::new(), nominal, bands: vec![flat] };
            check(&plot_svg(&times, &constant).unwrap());
            let alone = OutputBounds { bands: vec![], ..constant };
            check(&plot_svg(&times, &alone).unwrap());
            check(&plot_svg(&times[..1], &OutputBounds { nominal: vec![value], ..alone.clone() }).unwrap());
            check(&plot_svg(&[], &OutputBounds { nominal: vec![], ..alone }).unwrap());
        }
    }

    #[test]
    fn a_bound_that_explodes_leaves_the_plot() {
        let (times, mut output) = sample(101);
        output.bands[1].upper[90..].fill(1e12);
        output.bands[1].lower[90..].fill(-1e12);
        let svg = plot_svg(&times, &output).unwrap();
        check(&svg);
        assert!(svg.contains("Taylor (beyond the plot)") && !svg.contains("Scan (beyond"));
        assert!(svg.contains("x3 [m]"), "an axis for the others");
    }

    #[test]
    fn what_is_not_resolved_is_hatched_from_there_on() {
        let (times, mut output) = sample(101);
        let lines = |svg: &str| svg.matches("<polyline").count();
        let before = lines(&plot_svg(&times, &output).unwrap());
        output.bands[0].error.unresolved[50] = true;
        let svg = plot_svg(&times, &output).unwrap();
        check(&svg);
        assert!(svg.contains("Chebyshev (unresolved from 1 s)"));
        assert!(lines(&svg) > before + 60, "lines across the second half of both panels");
    }
}
