//! The figure of bounds over time, for one run or several.
//!
//! Two panels share the time axis. The upper panel shows the output: nominal courses and bands. Tolerances of a per
//! cent make bands as thin as a line there, so the lower panel shows each band minus its own nominal course.

use svg::Document;

use super::figure::Caption;
use super::figure::axis::Axis;
use super::figure::data::{AcrossData, FigureData, SeriesData, extremes, times};
use super::figure::document::{document, finished, heading, metadata, shortened};
use super::figure::legend::{Entry, Legend, Sign};
use super::figure::panel::{Named, Panel, Style, label_width};
use super::figure::style::Hue;
use super::figure::view::{deviation, in_view};
use super::limits::{Limit, near};
use super::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;
use crate::results::Band;

/// Size on the page with one row of legend, px.
const SIZE: (f64, f64) = (900.0, 580.0);
/// Space for the heading and a row of legend, px.
const TOP: f64 = 58.0;
/// Space for the time axis, px.
const BOTTOM: f64 = 50.0;
/// Space between the panels, px.
const BETWEEN: f64 = 22.0;
/// Space on the right, px.
const RIGHT: f64 = 20.0;

/// A nominal course with its bands.
pub(super) struct BandedCourse<'a> {
    /// Key of its group: begins with a letter, and has letters, digits and `-`.
    pub group: String,
    /// Label of the course; empty if the labels of its bands suffice.
    pub label: &'a str,
    pub hue: Hue,
    /// Width of the line, px.
    pub width: f64,
    pub times: &'a [f64],
    pub nominal: &'a [f64],
    pub bands: Vec<CourseBand<'a>>,
}

/// A band of a course.
pub(super) struct CourseBand<'a> {
    /// Key of its group, as a course's.
    pub group: String,
    pub band: &'a Band,
    pub style: Style,
}

/// Name of the time, the axis of courses unless they are over a parameter.
pub(super) const TIME: &str = "t";

/// Horizontal axis of a figure's courses: the time, or a parameter.
#[derive(Clone, Copy)]
pub(super) struct Across<'a> {
    pub name: &'a str,
    pub unit: ShownUnit<'a>,
}

/// Contents of a figure.
#[derive(Clone, Copy)]
pub(super) struct Shown<'a> {
    /// The output's name.
    pub name: &'a str,
    /// The unit that it is shown in.
    pub unit: ShownUnit<'a>,
    pub across: Across<'a>,
    /// Range below which an output is constant, SI.
    pub noise: f64,
    pub courses: &'a [BandedCourse<'a>],
    /// Limits that requirements set for the output.
    pub limits: &'a [Limit],
}

/// The figure of an output as an SVG document. The same data give the same bytes.
///
/// # Errors
/// Only if memory cannot be written to.
pub(super) fn courses_svg(caption: Caption, shown: &Shown) -> Result<String, serde_json::Error> {
    Ok(finished(&Figure::new(caption, shown).drawn()?))
}

/// Contents of the drawing and their positions.
struct Figure<'a> {
    caption: Caption<'a>,
    shown: &'a Shown<'a>,
    /// Each course's bands minus the course.
    deviations: Vec<Vec<Band>>,
    time: Axis,
    value: Axis,
    deviation: Axis,
    left: f64,
    legend: Legend,
}

impl<'a> Figure<'a> {
    fn new(caption: Caption<'a>, shown: &'a Shown) -> Self {
        let of_course = |course: &BandedCourse| -> Vec<Band> {
            course.bands.iter().map(|of| deviation(of.band, course.nominal)).collect()
        };
        let deviations: Vec<Vec<Band>> = shown.courses.iter().map(of_course).collect();
        let (mut values, mut below, mut entries) = (Vec::new(), Vec::new(), Vec::new());
        for (course, deviations) in shown.courses.iter().zip(&deviations) {
            let bands: Vec<Band> = course.bands.iter().map(|of| of.band.clone()).collect();
            let (in_value, beyond) = in_view(course.nominal, &bands, 4.0);
            values.extend(in_value);
            let (in_deviation, beyond_below) = in_view(&[0.0], deviations, 6.0);
            below.extend(in_deviation);
            if !course.label.is_empty() {
                let (group, label) = (course.group.clone(), course.label.to_owned());
                entries.push(Entry { group, label, sign: Sign::Line(course.hue) });
            }
            for ((of, above), below) in course.bands.iter().zip(beyond).zip(beyond_below) {
                let unresolved = of.band.error.unresolved_from().map(|row| course.times[row]);
                let label = format!("{}{}", of.style.label, note(above || below, unresolved, shown.across.unit));
                entries.push(Entry { group: of.group.clone(), label, sign: Sign::Band(of.style.clone()) });
            }
        }
        for (limit, is_near) in shown.limits.iter().zip(near(shown.limits, &values).collect::<Vec<_>>()) {
            entries.push(limit.entry(is_near));
            if is_near {
                values.push(limit.value);
            }
        }
        let size = values.iter().filter(|x| x.is_finite()).fold(0.0, |size: f64, x| size.max(x.abs()));
        let all_times = shown.courses.iter().flat_map(|course| course.times);
        let time = Axis::fit(all_times.copied(), shown.across.unit, 9, 0.0, 0.0);
        let value = Axis::fit(values.into_iter(), shown.unit, 6, 0.04, shown.noise);
        let noise = shown.noise.max(TUNING.rounding_of_motion * size);
        let deviation = Axis::fit(below.into_iter(), shown.unit, 4, 0.06, noise);
        let left = 44.0 + label_width(&value).max(label_width(&deviation));
        let legend = Legend::new(entries, SIZE.0 - RIGHT - left);
        Self { caption, shown, deviations, time, value, deviation, left, legend }
    }

    fn drawn(&self) -> Result<Document, serde_json::Error> {
        let Shown { name, courses, across, .. } = *self.shown;
        let (top, height) = (TOP + self.legend.more(), SIZE.1 + self.legend.more());
        let free = height - top - BOTTOM;
        let alone = courses.iter().all(|course| course.bands.is_empty());
        let split = if alone { top + free } else { top + 0.6 * (free - BETWEEN) };
        let prefix = self.caption.prefix;
        let (id, right) = (format!("{prefix}-value"), SIZE.0 - RIGHT);
        let value = Panel { id, left: self.left, right, top, bottom: split, x: &self.time, y: &self.value };
        let id = format!("{prefix}-deviation");
        let below = Panel { id, top: split + BETWEEN, bottom: height - BOTTOM, y: &self.deviation, ..value.clone() };

        let title = format!("{}: {}", shortened(self.caption.model, 60), shortened(name, 60));
        let mut figure = document((SIZE.0, height), &format!("{}: {name}", self.caption.model))
            .add(metadata(&self.data(&value, (!alone).then_some(&below)))?)
            .add(heading(&title, (self.left, 15.0)))
            .add(self.legend.drawn((self.left, 38.0)));
        let bands = courses.iter().map(|course| course.bands.iter().map(|of| of.band).collect::<Vec<_>>());
        let limits = || self.shown.limits.iter();
        let mut drawn = self.series(&value, bands, |course| course.nominal.to_vec());
        drawn.extend(limits().map(|limit| limit.drawn(&value)));
        figure = figure.add(value.framed(name, &self.value.title(&shortened(name, 28)), drawn));
        if alone {
            return Ok(figure.add(value.time_axis(across.name)));
        }
        let bands = self.deviations.iter().map(|bands| bands.iter().collect::<Vec<_>>());
        let mut drawn = self.series(&below, bands, zero);
        for course in courses {
            drawn.extend(limits().map(|limit| limit.drawn_below(&below, course.times, course.nominal)));
        }
        let title = "bound − nominal";
        Ok(figure.add(below.framed(title, &self.deviation.title(title), drawn)).add(below.time_axis(across.name)))
    }

    /// All series of a panel: errors below, then bands, then the course.
    fn series<'b>(
        &self,
        panel: &Panel,
        bands: impl Iterator<Item = Vec<&'b Band>>,
        nominal: impl Fn(&BandedCourse) -> Vec<f64>,
    ) -> Vec<svg::node::element::Group> {
        let mut drawn = Vec::new();
        for (course, bands) in self.shown.courses.iter().zip(bands) {
            let styled = || course.bands.iter().zip(&bands);
            for (of, band) in styled().filter(|(of, _)| of.style.fill > 0.0) {
                let (id, title) = (error_id(panel, of), format!("error of {}", of.style.label));
                drawn.push(panel.error(named(&id, &of.group, &title), course.times, band, &of.style));
            }
            for (of, band) in styled() {
                let id = series_id(panel, &of.group);
                drawn.push(panel.band(named(&id, &of.group, &of.style.label), course.times, band, &of.style));
            }
            let (id, title) = (series_id(panel, &course.group), nominal_title(course));
            let values = nominal(course);
            drawn.push(panel.curve(named(&id, &course.group, &title), course.times, &values, course.hue, course.width));
        }
        drawn
    }

    /// Scales and series, for the scripts that show the figure.
    fn data(&self, value: &Panel, below: Option<&Panel>) -> FigureData {
        let Shown { name, courses, across, .. } = *self.shown;
        let shared = courses.first().map_or(&[][..], |course| course.times);
        let mut series = Vec::new();
        for (index, course) in courses.iter().enumerate() {
            let time = (course.times != shared).then(|| times(course.times));
            let mut add = |panel: &Panel, id, group: &str, label: String, kind, [lower, upper]: [&[f64]; 2]| {
                let [lower, upper] = extremes(lower, upper, panel.y);
                let (group, panel, time) = (group.to_owned(), panel.id.clone(), time.clone());
                series.push(SeriesData { id, group, label, kind, panel, time, lower, upper });
            };
            let panels = [Some((value, course.nominal.to_vec())), below.map(|below| (below, zero(course)))];
            for (panel, nominal) in panels.into_iter().flatten() {
                let id = series_id(panel, &course.group);
                add(panel, id, &course.group, nominal_title(course), "nominal", [&nominal, &nominal]);
                for (entry, of) in course.bands.iter().enumerate() {
                    let is_value = panel.id == value.id;
                    let band = if is_value { of.band } else { &self.deviations[index][entry] };
                    let (id, label) = (series_id(panel, &of.group), of.style.label.clone());
                    add(panel, id, &of.group, label, "bounds", [&band.lower, &band.upper]);
                    if of.style.fill > 0.0 {
                        let moved = |side: &[f64], sign: f64| -> Vec<f64> {
                            side.iter().zip(&band.error.total).map(|(bound, error)| bound + sign * error).collect()
                        };
                        let (lower, upper) = (moved(&band.lower, -1.0), moved(&band.upper, 1.0));
                        let label = format!("error of {}", of.style.label);
                        add(panel, error_id(panel, of), &of.group, label, "error", [&lower, &upper]);
                    }
                }
            }
        }
        for course in courses {
            let still = vec![0.0; course.times.len()];
            series.extend(self.shown.limits.iter().map(|limit| limit.data(value, course.times, &still)));
            let below = below.iter();
            let limits = below.flat_map(|below| self.shown.limits.iter().map(|limit| (*below, limit)));
            series.extend(limits.map(|(below, limit)| limit.data(below, course.times, course.nominal)));
        }
        FigureData {
            model: self.caption.model.to_owned(),
            output: name.to_owned(),
            unit: self.value.unit.text.clone(),
            across: (across.name != TIME)
                .then(|| AcrossData { name: across.name.to_owned(), unit: across.unit.text.to_owned() }),
            time: times(shared),
            panels: [Some(value), below].into_iter().flatten().map(Panel::data).collect(),
            series,
        }
    }
}

fn named<'n>(id: &'n str, group: &'n str, title: &'n str) -> Named<'n> {
    Named { id, group, title }
}

fn series_id(panel: &Panel, group: &str) -> String {
    format!("{}-{group}", panel.id)
}

fn error_id(panel: &Panel, of: &CourseBand) -> String {
    format!("{}-{}-error", panel.id, of.group)
}

/// Title of a course's line, for people.
fn nominal_title(course: &BandedCourse) -> String {
    match (course.label, course.bands.first()) {
        ("", Some(of)) => format!("{}, nominal", of.style.label),
        (label, _) => label.to_owned(),
    }
}

/// The nominal course minus itself: a line at zero with the same gaps.
fn zero(course: &BandedCourse) -> Vec<f64> {
    course.nominal.iter().map(|x| if x.is_finite() { 0.0 } else { f64::NAN }).collect()
}

/// Addition to a method's name in the legend.
fn note(beyond: bool, unresolved_from: Option<f64>, unit: ShownUnit) -> String {
    match (unresolved_from, beyond) {
        (Some(from), _) => {
            let from = format!("{} {}", short(unit.of_si(from)), unit.text);
            format!(" (unreliable from {})", from.trim_end())
        }
        (None, true) => " (beyond the plot)".to_owned(),
        (None, false) => String::new(),
    }
}

/// Three digits.
fn short(value: f64) -> String {
    let text = format!("{value:.2e}").parse::<f64>().unwrap_or(value);
    format!("{text}")
}
