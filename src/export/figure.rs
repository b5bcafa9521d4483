//! The figure of bounds over time, for one run or several.
//!
//! Two panels share the time axis. The upper panel shows the output: nominal courses and bands. Tolerances of a per cent make
//! bands as thin as a line there, so the lower panel shows each band minus its own nominal course.

use plotters::prelude::*;

use super::axis::Axis;
use super::canvas::{Canvas, Drawn, svg};
use super::panel::{Panel, Style, label_width, legend_step, note, shortened};
use super::view::{deviation, in_view};
use crate::results::Band;

/// Size on the page with one row of legend, px.
const SIZE: (u32, u32) = (900, 560);
/// Space for a row of legend, and for each one more, px.
const TOP: f64 = 40.0;
const ROW: f64 = 20.0;
/// Space for the time axis, px.
const BOTTOM: f64 = 50.0;
/// Space between the panels, px.
const BETWEEN: f64 = 22.0;
/// Space on the right, px.
const RIGHT: f64 = 20.0;
/// Width of a nominal course, px.
const COURSE: f64 = 1.2;

/// A nominal course with its bands.
pub(super) struct Course<'a> {
    /// Label of the course; empty where the labels of its bands suffice.
    pub label: &'a str,
    pub color: RGBColor,
    pub times: &'a [f64],
    pub nominal: &'a [f64],
    pub bands: Vec<(&'a Band, Style)>,
}

/// An entry of the legend: a line, or a band.
enum Key<'a> {
    Line(&'a str, RGBColor),
    Band(Style, String),
}

impl Key<'_> {
    fn label(&self) -> String {
        match self {
            Self::Line(label, _) => (*label).to_owned(),
            Self::Band(style, note) => format!("{}{note}", style.label),
        }
    }
}

/// The figure of an output as an SVG document. The same data give the same bytes.
///
/// # Errors
/// plotters' own, as text; none is known to occur.
pub(super) fn figure_svg(name: &str, unit: &str, courses: &[Course]) -> Result<String, String> {
    let figure = Figure::new(courses);
    let size = (SIZE.0, SIZE.1 + figure.more_rows() as u32);
    svg(size, |canvas| figure.draw(canvas, f64::from(size.1), name, unit).map_err(|error| error.to_string()))
}

/// What is drawn, and where.
struct Figure<'a> {
    courses: &'a [Course<'a>],
    /// Each course's bands minus the course.
    deviations: Vec<Vec<Band>>,
    time: Axis,
    main: Axis,
    below: Axis,
    left: f64,
    legend: Vec<Vec<Key<'a>>>,
}

impl<'a> Figure<'a> {
    fn new(courses: &'a [Course<'a>]) -> Self {
        let of_course = |course: &Course| -> Vec<Band> {
            course.bands.iter().map(|(band, _)| deviation(band, course.nominal)).collect()
        };
        let deviations: Vec<Vec<Band>> = courses.iter().map(of_course).collect();
        let (mut shown, mut shown_below, mut keys) = (Vec::new(), Vec::new(), Vec::new());
        for (course, deviations) in courses.iter().zip(&deviations) {
            let bands: Vec<Band> = course.bands.iter().map(|(band, _)| (*band).clone()).collect();
            let (values, beyond) = in_view(course.nominal, &bands, 4.0);
            shown.extend(values);
            let (values, beyond_below) = in_view(&[0.0], deviations, 6.0);
            shown_below.extend(values);
            if !course.label.is_empty() {
                keys.push(Key::Line(course.label, course.color));
            }
            for (((band, style), above), below) in course.bands.iter().zip(beyond).zip(beyond_below) {
                let unresolved = band.error.unresolved_from().map(|row| course.times[row]);
                keys.push(Key::Band(style.clone(), note(above || below, unresolved)));
            }
        }
        let time = Axis::fit(courses.iter().flat_map(|course| course.times).copied(), 9, 0.0);
        let main = Axis::fit(shown.into_iter(), 6, 0.04);
        let below = Axis::fit(shown_below.into_iter(), 4, 0.06);
        let left = 44.0 + label_width(&main).max(label_width(&below));
        // One course's legend is short.
        let width = if courses.len() > 1 { f64::from(SIZE.0) - RIGHT - left } else { f64::INFINITY };
        Self { courses, deviations, time, main, below, left, legend: rows(keys, width) }
    }

    /// Height of the legend's rows after the first, px.
    fn more_rows(&self) -> f64 {
        ROW * self.legend.len().saturating_sub(1) as f64
    }

    fn draw(&self, canvas: &Canvas, height: f64, name: &str, unit: &str) -> Drawn {
        canvas.fill(&WHITE)?;
        let top = TOP + self.more_rows();
        let free = height - top - BOTTOM;
        let alone = self.courses.iter().all(|course| course.bands.is_empty());
        let split = if alone { top + free } else { top + 0.6 * (free - BETWEEN) };
        let right = f64::from(SIZE.0) - RIGHT;
        let upper = Panel { canvas, left: self.left, right, top, bottom: split, x: &self.time, y: &self.main };

        upper.mesh()?;
        for course in self.courses {
            upper.bands(course.times, course.bands.iter().map(|(band, style)| (*band, style)))?;
            upper.curve(course.times, course.nominal, course.color, COURSE)?;
        }
        upper.y_title(&self.main.title(&shortened(name), unit))?;
        self.legend(&upper)?;
        if alone {
            upper.frame()?;
            return upper.time_axis();
        }

        let lower = Panel { top: split + BETWEEN, bottom: height - BOTTOM, y: &self.below, ..upper };
        lower.mesh()?;
        for (course, deviations) in self.courses.iter().zip(&self.deviations) {
            lower.bands(course.times, deviations.iter().zip(course.bands.iter().map(|(_, style)| style)))?;
            // The nominal course, less itself: a line at zero with the same gaps.
            let zero: Vec<f64> = course.nominal.iter().map(|x| if x.is_finite() { 0.0 } else { f64::NAN }).collect();
            lower.curve(course.times, &zero, course.color, COURSE)?;
        }
        lower.y_title(&self.below.title("bound − nominal", unit))?;
        upper.frame()?;
        lower.frame()?;
        lower.time_axis()
    }

    /// Rows above the panel, clear of the data.
    fn legend(&self, panel: &Panel) -> Drawn {
        for (row, keys) in self.legend.iter().rev().enumerate() {
            let (mut x, y) = (panel.left, panel.top - 19.0 - ROW * row as f64);
            for key in keys {
                match key {
                    Key::Line(label, color) => panel.line_key((x, y), label, *color)?,
                    Key::Band(style, _) => panel.band_key((x, y), &key.label(), style)?,
                }
                x += legend_step(&key.label());
            }
        }
        Ok(())
    }
}

/// As many entries in a row as fit into a width, px.
fn rows(keys: Vec<Key>, width: f64) -> Vec<Vec<Key>> {
    let mut rows: Vec<Vec<Key>> = vec![Vec::new()];
    let mut x = 0.0;
    for key in keys {
        let step = legend_step(&key.label());
        if x > 0.0 && x + step > width {
            rows.push(Vec::new());
            x = 0.0;
        }
        x += step;
        if let Some(row) = rows.last_mut() {
            row.push(key);
        }
    }
    rows
}
