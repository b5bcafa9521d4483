//! `x3.svg`: an output's bounds over time, and their distance from the nominal course.

use super::courses::{Across, BandedCourse, CourseBand, Shown, TIME, courses_svg};
use super::figure::Caption;
use super::figure::panel::Style;
use super::figure::style::{Color, Hue};
use super::limits::limits;
use super::rounded::rounded;
use super::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;
use crate::methods::{About, Method};
use crate::numerics::BandError;
use crate::results::{Band, Bounds, OutputBounds, RequirementSummary, StatisticsResult, Uncertain};

fn style(method: Method) -> Style {
    let About { label, color, fill, dashes, .. } = *method.about();
    let index = Method::ALL.iter().position(|known| *known == method).unwrap_or(0);
    let slant = [45.0, -45.0, 20.0, -20.0][index % 4];
    let dashes = dashes.map(Vec::from);
    Style { label: label.to_owned(), color: Color(color), edge: 2.0, fill, dashes, slant }
}

/// Further series in the plot of an output, in addition to its bounds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Beside<'a> {
    /// Range below which the output is constant, by [`noise`].
    pub noise: f64,
    /// Requirements, of which the constant limits of the output are drawn.
    pub requirements: &'a [RequirementSummary],
    /// Statistics, of which the band from the least to the greatest quantile is drawn.
    pub statistics: Option<&'a StatisticsResult>,
}

/// The plot of one output as an SVG document, with the constant limits that requirements set for it, and its quantiles.
/// The same data give the same bytes.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn plot_svg(
    caption: Caption,
    times: &[f64],
    output: &OutputBounds,
    Beside { noise, requirements, statistics }: Beside,
) -> Result<String, serde_json::Error> {
    let limits = limits(requirements, &output.name);
    let quantiles = statistics.and_then(|found| quantiles(found, &output.name, times.len()));
    let mut course = course(times, output);
    let style = |label| Style {
        label,
        color: Color::of(QUANTILES),
        edge: 1.4,
        fill: 0.1,
        dashes: Some(vec![1.5, 2.5]),
        slant: 60.0,
    };
    let of_quantiles = |(label, band)| CourseBand { group: "quantiles".to_owned(), band, style: style(label) };
    course.bands.extend(quantiles.as_ref().map(|(label, band)| of_quantiles((label.clone(), band))));
    courses_svg(caption, &Shown { limits: &limits, ..shown(output, noise, &[course]) })
}

/// Index of the quantiles' colour.
const QUANTILES: usize = 5;

/// The band from an output's least to its greatest quantile, and its name.
fn quantiles(statistics: &StatisticsResult, name: &str, rows: usize) -> Option<(String, Band)> {
    let found = statistics.outputs.iter().find(|own| own.name == name)?;
    let [first, .., last] = &found.quantiles[..] else { return None };
    let shares = &statistics.summary.quantiles;
    let percent = |share: &f64| format!("{} %", rounded(100.0 * share));
    let padded = |mut values: Vec<f64>| {
        values.resize(rows, f64::NAN);
        values
    };
    let values = |of: &[Uncertain]| padded(of.iter().map(|own| own.value).collect());
    let error = padded(first.iter().zip(last).map(|(low, high)| low.total().max(high.total())).collect());
    let mut unresolved: Vec<bool> = found.resolved.iter().map(|resolved| !resolved).collect();
    unresolved.resize(rows, false);
    let error = BandError { total: error, unresolved, ..BandError::default() };
    let band = Band { method: Method::Chebyshev, lower: values(first), upper: values(last), error };
    Some((format!("quantiles, {} to {}", percent(shares.first()?), percent(shares.last()?)), band))
}

/// An output with all its bands.
pub(super) fn course<'a>(times: &'a [f64], output: &'a OutputBounds) -> BandedCourse<'a> {
    let bands = output.bands.iter();
    let bands = bands.map(|band| CourseBand { group: band.method.name().to_owned(), band, style: style(band.method) });
    let (group, nominal) = ("nominal".to_owned(), &output.nominal[..]);
    BandedCourse { group, label: "Nominal", hue: Hue::Ink, width: 1.2, times, nominal, bands: bands.collect() }
}

/// Courses of an output over time.
pub(super) fn shown<'a>(output: &'a OutputBounds, noise: f64, courses: &'a [BandedCourse<'a>]) -> Shown<'a> {
    let across = Across { name: TIME, unit: ShownUnit::from("s") };
    Shown {
        name: &output.name,
        unit: ShownUnit::of(&output.display, &output.unit),
        across,
        noise,
        courses,
        limits: &[],
    }
}

/// Width below which an output counts as constant: rounding relative to the largest of all outputs of its unit.
pub fn noise(bounds: &Bounds, output: &OutputBounds) -> f64 {
    let same = bounds.outputs.iter().filter(|other| other.unit == output.unit);
    let sizes = same.flat_map(|output| &output.nominal).filter(|x| x.is_finite()).map(|x| x.abs());
    TUNING.rounding_of_motion * sizes.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::results::{LimitLine, OutputStatistics, StatisticsSummary, Verdict};

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
        (times.clone(), OutputBounds { name: "x3".into(), unit: "m".into(), display: None, nominal, bands })
    }

    /// All texts of a figure.
    fn texts(svg: &str) -> Vec<String> {
        let document = roxmltree::Document::parse(svg).unwrap();
        let texts = document.descendants().filter(|node| node.has_tag_name("text"));
        texts.filter_map(|node| node.text()).map(|text| text.trim().to_owned()).collect()
    }

    /// The plot, and its scales and data.
    fn plot(times: &[f64], output: &OutputBounds) -> (String, serde_json::Value) {
        let caption = Caption { model: "crank", prefix: "p" };
        let svg = plot_svg(caption, times, output, Beside::default()).unwrap();
        let document = roxmltree::Document::parse(&svg).unwrap();
        assert_eq!(document.root_element().attribute("class"), Some("mbint-figure"));
        let find = |name: &'static str| document.descendants().filter(move |node| node.has_tag_name(name));
        let data: serde_json::Value = serde_json::from_str(find("metadata").next().unwrap().text().unwrap()).unwrap();
        // Every series of the data has a group with a title, and the other way round.
        let series: Vec<&str> = document.descendants().filter_map(|node| node.attribute("data-series")).collect();
        let listed: Vec<&str> =
            data["series"].as_array().unwrap().iter().map(|series| series["id"].as_str().unwrap()).collect();
        assert_eq!(BTreeSet::from_iter(&series), BTreeSet::from_iter(&listed));
        let panels: Vec<&str> = document.descendants().filter_map(|node| node.attribute("data-panel")).collect();
        for (panel, listed) in panels.iter().zip(data["panels"].as_array().unwrap()) {
            assert_eq!(listed["id"], **panel);
        }
        let ids: Vec<&str> = document.descendants().filter_map(|node| node.attribute("id")).collect();
        assert!(ids.iter().all(|id| id.starts_with("p-")) && BTreeSet::from_iter(&ids).len() == ids.len(), "{ids:?}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let data_of = find("path").filter_map(|path| path.attribute("d"));
        let mut numbers = data_of.flat_map(|data| data.split(['M', 'l', 'z', ' ', '-']));
        assert!(numbers.all(|number| number.len() < 8), "a point far off the page");
        (svg, data)
    }

    #[test]
    fn plots_have_axes_a_legend_and_all_curves() {
        let (times, output) = sample(201);
        let (svg, data) = plot(&times, &output);
        for text in ["crank: x3", "x3 [m]", "t [s]", "bound − nominal [mm]", "Nominal", "Chebyshev", "Taylor", "Scan"]
        {
            assert!(texts(&svg).iter().any(|found| found == text), "{text}");
        }
        assert_eq!(svg, plot(&times, &output).0, "the same data, the same bytes");
        assert_eq!((data["output"].as_str(), data["unit"].as_str()), (Some("x3"), Some("m")));
        assert_eq!((data["panels"][0]["si"].as_f64(), data["panels"][1]["si"].as_f64()), (Some(1.0), Some(1e-3)));
        assert_eq!(data["series"].as_array().unwrap().len(), 14);
    }

    /// The data are those of the table, in the panels' units and to the digits that can be seen.
    #[test]
    fn plotted_data_equal_the_curves() {
        let (times, output) = sample(201);
        let (_, data) = plot(&times, &output);
        let series = |id: &str| data["series"].as_array().unwrap().iter().find(|series| series["id"] == id).unwrap();
        let near = |found: &serde_json::Value, wanted: f64, step: f64| (found.as_f64().unwrap() - wanted).abs() <= step;
        for row in [0, 77, 200] {
            assert!(near(&data["time"][row], times[row], 1e-12));
            assert!(near(&series("p-value-nominal")["lower"][row], output.nominal[row], 1e-4));
            let band = &output.bands[1];
            assert!(near(&series("p-value-taylor")["upper"][row], band.upper[row], 1e-4));
            let below = 1e3 * (band.lower[row] - output.nominal[row]);
            assert!(near(&series("p-deviation-taylor")["lower"][row], below, 1e-3));
            let error = below - 1e3 * band.error.total[row];
            assert!(near(&series("p-deviation-taylor-error")["lower"][row], error, 1e-3));
        }
    }

    #[test]
    fn long_runs_make_small_files_with_their_extremes() {
        let (times, mut output) = sample(200_001);
        output.nominal[123_456] = 0.9;
        let (svg, data) = plot(&times, &output);
        assert!(svg.len() < 250_000, "{} bytes", svg.len());
        let nominal = &data["series"][0];
        assert!(nominal["upper"].as_array().unwrap().contains(&0.9.into()));
        assert!(nominal["upper"].as_array().unwrap().len() <= 400);
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
        plot(&times, &output);

        for value in [0.0, 5.0, -1e-310, f64::MAX, 1e-9, f64::NAN] {
            let (lower, upper) = (vec![value; 101], vec![value; 101]);
            let mut flat = Band { method: Method::Scan, lower, upper, error: error(101, value) };
            flat.error.unresolved[3..].fill(true);
            let nominal = vec![value; 101];
            let constant =
                OutputBounds { name: "<c & d>".into(), unit: String::new(), display: None, nominal, bands: vec![flat] };
            plot(&times, &constant);
            let alone = OutputBounds { bands: vec![], ..constant };
            plot(&times, &alone);
            plot(&times[..1], &OutputBounds { nominal: vec![value], ..alone.clone() });
            plot(&[], &OutputBounds { nominal: vec![], ..alone });
        }
    }

    #[test]
    fn diverging_bound_is_clipped() {
        let (times, mut output) = sample(101);
        output.bands[1].upper[90..].fill(1e12);
        output.bands[1].lower[90..].fill(-1e12);
        let (svg, _) = plot(&times, &output);
        assert!(svg.contains("Taylor (beyond the plot)") && !svg.contains("Scan (beyond"));
        assert!(svg.contains("x3 [m]"), "an axis for the others");
    }

    #[test]
    fn only_unreliable_rows_are_hatched() {
        let (times, mut output) = sample(101);
        assert!(!plot(&times, &output).0.contains("class=\"hatch\""));
        output.bands[0].error.unresolved[50] = true;
        let (svg, _) = plot(&times, &output);
        assert!(svg.contains("Chebyshev (unreliable from 1 s)"));
        let document = roxmltree::Document::parse(&svg).unwrap();
        let hatched: Vec<&str> = document
            .descendants()
            .filter(|node| node.attribute("class") == Some("hatch"))
            .filter_map(|node| node.attribute("d"))
            .collect();
        assert_eq!(hatched.len(), 2, "in both panels");
        assert!(hatched.iter().all(|data| data.len() < 60), "{hatched:?}");
    }

    #[test]
    fn limits_are_drawn_where_they_hold() {
        let (times, output) = sample(201);
        let line = |value, is_upper| LimitLine { output: "x3".into(), value, is_upper, from: 0.5, to: 1.5 };
        let requirement = RequirementSummary {
            name: "clears".into(),
            text: "x3 >= 0.4 m".into(),
            unit: "m".into(),
            display: None,
            verdict: Verdict::Holds,
            certified: false,
            margin: 0.01,
            percent: None,
            error: 0.0,
            surrogate: 0.0,
            time: 0.0,
            method: "scan".into(),
            nearest: None,
            decides: None,
            limits: vec![line(0.4, false), line(9.0, true), LimitLine { output: "y".into(), ..line(0.5, true) }],
        };
        let caption = Caption { model: "crank", prefix: "p" };
        let svg =
            plot_svg(caption, &times, &output, Beside { requirements: &[requirement], ..Beside::default() }).unwrap();
        assert_eq!(svg.matches("class=\"forbidden\"").count(), 2, "of its own output");
        assert!(texts(&svg).contains(&"clears: x3 >= 0.4 m".to_owned()));
        assert!(svg.contains("(beyond the plot)"), "9 m is far away");
        let data = svg.split_once("<metadata>").unwrap().1;
        assert!(data.contains("\"kind\":\"limit\""));
    }

    #[test]
    fn rounding_among_outputs_of_its_unit_is_a_constant() {
        let (times, mut output) = sample(101);
        let noise = OutputBounds {
            name: "noise".into(),
            nominal: times.iter().map(|t| 1e-14 * (50.0 * t).sin()).collect(),
            bands: vec![],
            ..output.clone()
        };
        output.nominal.iter_mut().for_each(|x| *x *= 1e3);
        let bounds = Bounds { times: times.clone(), outputs: vec![output, noise.clone()], ..Bounds::default() };
        let threshold = super::noise(&bounds, &noise);
        let svg = plot_svg(
            Caption { model: "m", prefix: "p" },
            &times,
            &noise,
            Beside { noise: threshold, ..Beside::default() },
        )
        .unwrap();
        assert!(texts(&svg).contains(&"constant".to_owned()), "{:?}", texts(&svg));
        assert!(texts(&svg).contains(&"0.5".to_owned()), "an axis about zero");
        let alone = plot_svg(Caption { model: "m", prefix: "p" }, &times, &noise, Beside::default()).unwrap();
        assert!(!texts(&alone).contains(&"constant".to_owned()));
    }

    #[test]
    fn quantiles_form_a_separate_band() {
        let (times, output) = sample(101);
        let at = |share: f64| -> Vec<Uncertain> {
            let of = |x: &f64| Uncertain { value: x + share, sampling: 1e-4, error: 0.0 };
            output.nominal.iter().take(90).map(of).collect()
        };
        let own = OutputStatistics {
            name: "x3".into(),
            unit: "m".into(),
            mean: at(0.0),
            deviation: at(0.0),
            quantiles: vec![at(-1e-3), at(0.0), at(1e-3)],
            linear: vec![],
            rss: vec![],
            resolved: vec![true; 90],
        };
        let summary = StatisticsSummary { quantiles: vec![0.00135, 0.5, 0.99865], ..StatisticsSummary::default() };
        let statistics = StatisticsResult { times: times.clone(), outputs: vec![own], summary };
        let caption = Caption { model: "crank", prefix: "p" };
        let beside = Beside { statistics: Some(&statistics), ..Beside::default() };
        let svg = plot_svg(caption, &times, &output, beside).unwrap();
        assert!(texts(&svg).contains(&"quantiles, 0.135 % to 99.865 %".to_owned()), "{:?}", texts(&svg));
        assert!(svg.contains("p-value-quantiles") && svg.contains("p-deviation-quantiles"));
        let other = OutputBounds { name: "y".into(), ..output.clone() };
        assert!(!plot_svg(caption, &times, &other, beside).unwrap().contains("quantiles"));
    }
}
