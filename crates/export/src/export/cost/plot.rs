//! `cost.svg`: error against seconds, both logarithmic; bounds on the left, nominal trajectories on the right.
//!
//! Every setting is a dot, hollow if its bounds miss more than they overestimate. A method's line joins the settings on
//! its own Pareto front; the thick grey line is the front of all methods.

use svg::node::element::{Circle, Group, Path, Rectangle, Title};

use crate::compile::Scheme;
use crate::export::figure::document::{Anchor, document, finished, group, heading, line, text, upright};
use crate::export::figure::log_axis::LogAxis;
use crate::export::figure::path::{Point, line_data, px};
use crate::export::figure::style::{Color, Hue};
use crate::results::{CostMethod, CostPoint, CostStudy, Integrator, cost_curves, pareto};

/// Size on the page, px.
const SIZE: (f64, f64) = (1100.0, 600.0);
/// Space for title and legend, px.
const TOP: f64 = LEGEND + (ROWS as f64 + 1.0) * LINE - 4.0;
/// The first row of the legend, px.
const LEGEND: f64 = 56.0;
/// Space for the errors' axis, px.
const BOTTOM: f64 = 54.0;
/// Space for the seconds' axis of each panel, px.
const LEFT: f64 = 70.0;
/// Space on the right of each panel, px.
const RIGHT: f64 = 18.0;
/// Text of the legend for the front of all methods.
const CHEAPEST: &str = "no other is cheaper and as good";
/// Rows of the legend.
const ROWS: usize = 5;
/// Distance from one line of the legend to the next, px.
const LINE: f64 = 18.0;
/// Distance from one column of the legend to the next, px.
const COLUMN: f64 = 214.0;
/// A dot's radius, px.
const DOT: f64 = 3.4;
/// The front of all methods.
const FRONT: Color = Color([190, 190, 190]);

/// The colours of the plots of bounds, and others that every colour vision distinguishes from them.
fn color(method: CostMethod) -> Color {
    match method {
        CostMethod::Bounds(curve) => Color(curve.about().color),
        CostMethod::BoundsBy(_, integrator) | CostMethod::By(integrator) => Color(match integrator {
            Integrator::Explicit => [0, 0, 0],
            Integrator::Extrapolated { levels: 2 } => [215, 120, 180],
            Integrator::Extrapolated { levels: 3 } => [213, 94, 0],
            Integrator::Extrapolated { .. } => [120, 94, 240],
        }),
        CostMethod::Scheme(Scheme::Hht { .. }) => Color([0, 114, 178]),
        CostMethod::Scheme(Scheme::TrapezoidalIndex2) => Color([130, 25, 80]),
        CostMethod::Scheme(Scheme::GeneralisedAlpha { spectral_radius }) if spectral_radius < 0.65 => {
            Color([0, 158, 115])
        }
        CostMethod::Scheme(Scheme::GeneralisedAlpha { spectral_radius }) if spectral_radius < 0.85 => {
            Color([240, 160, 20])
        }
        CostMethod::Scheme(Scheme::GeneralisedAlpha { .. }) => Color([86, 180, 233]),
    }
}

/// The study as an SVG document.
pub fn cost_svg(study: &CostStudy) -> String {
    let half = SIZE.0 / 2.0;
    let scale = if study.is_deterministic() { "error / range of the course" } else { "error / largest width" };
    let panels = [
        ("Bounds", &study.bounds, study.reference.bounds_error),
        ("Nominal trajectory", &study.trajectories, study.reference.trajectory_error),
    ];
    let what = format!("{}: error against computing time", study.model);
    let mut figure = document(SIZE, &what).add(heading(&what, (LEFT, 15.0)));
    let shown = panels.into_iter().filter(|(_, points, _)| !points.is_empty());
    for (index, (title, points, reference)) in shown.enumerate() {
        let left = index as f64 * half;
        let shown = || points.iter().filter(|point| is_shown(point));
        let errors = shown().map(|point| point.deviation.largest()).chain([study.tolerance]);
        let panel = Panel {
            left: left + LEFT,
            right: left + half - RIGHT,
            top: TOP,
            bottom: SIZE.1 - BOTTOM,
            x: LogAxis::fit(errors.map(|error| error.max(reference))),
            y: LogAxis::fit(shown().map(|point| point.seconds)),
        };
        let mut drawn = group("panel").add(Title::new(title)).add(panel.mesh()).add(panel.axes(title, scale));
        drawn = drawn.add(panel.threshold(study.tolerance, "tolerance"));
        if points.iter().any(|point| point.limited) {
            drawn = drawn.add(panel.threshold(reference, "reference"));
        }
        figure = figure.add(panel.curves(drawn, points, reference)).add(panel.legend(points));
    }
    finished(&figure)
}

/// Whether a setting is in the plot: settings without a result are not.
fn is_shown(point: &CostPoint) -> bool {
    point.deviation.largest().is_finite() && point.seconds > 0.0
}

/// A rectangle of the figure with its axes; lengths in px.
struct Panel {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x: LogAxis,
    y: LogAxis,
}

impl Panel {
    fn across(&self, at: f64) -> f64 {
        self.left + at * (self.right - self.left)
    }

    fn up(&self, at: f64) -> f64 {
        self.bottom - at * (self.bottom - self.top)
    }

    /// Lines at the decades.
    fn mesh(&self) -> Group {
        let decades = |ticks: Vec<(f64, Option<String>)>| ticks.into_iter().filter(|(_, label)| label.is_some());
        let across =
            decades(self.x.ticks()).map(|(at, _)| self.across(at)).map(|x| line((x, self.top), (x, self.bottom)));
        let up = decades(self.y.ticks()).map(|(at, _)| self.up(at)).map(|y| line((self.left, y), (self.right, y)));
        across.chain(up).fold(group("grid"), Group::add)
    }

    /// The frame, ticks, labels and titles of both axes.
    fn axes(&self, title: &str, scale: &str) -> Group {
        let Self { left, right, top, bottom, .. } = *self;
        let frame = Rectangle::new().set("class", "frame").set("x", px(left)).set("y", px(top));
        let mut axes = group("axis").add(frame.set("width", px(right - left)).set("height", px(bottom - top)));
        for (at, label) in self.x.ticks() {
            let x = self.across(at);
            axes = axes.add(line((x, bottom), (x, bottom + 4.0)).set("class", "frame"));
            if let Some(label) = label {
                axes = axes.add(text(&label, (x, bottom + 15.0), Anchor::Middle));
            }
        }
        for (at, label) in self.y.ticks() {
            let y = self.up(at);
            axes = axes.add(line((left - 4.0, y), (left, y)).set("class", "frame"));
            if let Some(label) = label {
                axes = axes.add(text(&label, (left - 7.0, y), Anchor::End));
            }
        }
        axes.add(text(title, (left, 36.0), Anchor::Start))
            .add(text(scale, (0.5 * (left + right), bottom + 36.0), Anchor::Middle))
            .add(upright("computing time [s]", (left - 54.0, 0.5 * (top + bottom))))
    }

    /// A vertical line at an error.
    fn threshold(&self, error: f64, label: &str) -> Group {
        let (x, _) = self.place((error, 1.0));
        group("threshold").add(line((x, self.top), (x, self.bottom)).set("class", "frame")).add(text(
            label,
            (x - 4.0, self.bottom - 12.0),
            Anchor::End,
        ))
    }

    /// The common front below every method's dots and line. Errors below the reference's own error are shown at that
    /// error.
    fn curves(&self, drawn: Group, points: &[CostPoint], reference: f64) -> Group {
        let all = || points.iter().filter(|point| is_shown(point));
        let places: Vec<Point> = all().map(|point| point.place(reference)).collect();
        let front = Hue::Color(FRONT).paint(Group::new().add(Title::new(CHEAPEST)), "series");
        let drawn = drawn.add(front.add(self.front(&places, 7.0)));
        cost_curves(points).into_iter().enumerate().fold(drawn, |drawn, (entry, method)| {
            let own = || all().filter(|point| point.method == method);
            let places: Vec<Point> = own().map(|point| point.place(reference)).collect();
            let series = Group::new().set("data-series", method.label()).add(Title::new(method.label()));
            let series = Hue::Color(color(method)).paint(series, "series").add(self.front(&places, 1.6));
            drawn.add(own().zip(&places).fold(series, |series, (point, index)| {
                series.add(mark(self.place(*index), entry, point.deviation.is_narrow()))
            }))
        })
    }

    /// Rows of methods, and the meaning of the front and of hollow marks.
    fn legend(&self, points: &[CostPoint]) -> Group {
        let mut legend = group("legend");
        for (entry, method) in cost_curves(points).into_iter().enumerate() {
            let (row, column) = (entry % ROWS, entry / ROWS);
            let (x, y) = (self.left + column as f64 * COLUMN, LEGEND + row as f64 * LINE);
            let stroke = line((x, y), (x + 22.0, y)).set("class", "line").set("stroke-width", 1.6);
            let key = Hue::Color(color(method)).paint(Group::new(), "key").add(stroke);
            let key = key.add(mark((x + 11.0, y), entry, false));
            legend = legend.add(key.add(text(&method.label(), (x + 28.0, y), Anchor::Start)));
        }
        let (x, y) = (self.left, LEGEND + ROWS as f64 * LINE);
        let stroke = line((x, y), (x + 22.0, y)).set("class", "line").set("stroke-width", 7.0);
        let key = Hue::Color(FRONT).paint(Group::new(), "key").add(stroke);
        legend = legend.add(key.add(text(CHEAPEST, (x + 28.0, y), Anchor::Start)));
        if points.iter().any(|point| is_shown(point) && point.deviation.is_narrow()) {
            let key = Hue::Ink.paint(Group::new(), "key").add(mark((x + 251.0, y), 0, true));
            legend = legend.add(key.add(text("too narrow", (x + 262.0, y), Anchor::Start)));
        }
        legend
    }

    fn place(&self, (error, seconds): Point) -> Point {
        (self.across(self.x.place(error)), self.up(self.y.place(seconds)))
    }

    /// A line through the points on the Pareto front.
    fn front(&self, points: &[Point], width: f64) -> Path {
        let line: Vec<Point> = pareto(points).into_iter().map(|index| self.place(points[index])).collect();
        Path::new().set("class", "line").set("d", line_data(&line)).set("stroke-width", width)
    }
}

/// A mark whose shape distinguishes the methods in addition to their colours.
fn mark((x, y): Point, entry: usize, hollow: bool) -> Group {
    let class = if hollow { "hollow" } else { "area" };
    let shape = |corners: &[Point]| {
        let corners: Vec<Point> = corners.iter().map(|(dx, dy)| (x + DOT * dx, y + DOT * dy)).collect();
        Path::new().set("class", class).set("d", line_data(&corners) + "z")
    };
    let mark = Group::new().set("stroke-width", 1.4);
    match entry % 4 {
        0 => mark.add(Circle::new().set("class", class).set("cx", px(x)).set("cy", px(y)).set("r", DOT)),
        1 => mark.add(shape(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)])),
        2 => mark.add(shape(&[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)])),
        _ => mark.add(shape(&[(0.0, -1.2), (1.2, 0.9), (-1.2, 0.9)])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Stepping;
    use crate::results::cost_example::COMPOSED;
    use crate::results::cost_example::{sample, study};

    #[test]
    fn plot_shows_every_method_and_omits_missing_results() {
        let mut whole = sample();
        whole.bounds.push(CostPoint::without_result(COMPOSED, Stepping::Fixed(1e-2)));
        for study in [whole, study(vec![])] {
            let svg = cost_svg(&study);
            roxmltree::Document::parse(&svg).unwrap();
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
            for point in study.bounds.iter().chain(&study.trajectories) {
                assert!(svg.contains(&point.method.label()), "{}", point.method.label());
            }
            assert_eq!(svg.contains("too narrow"), !study.bounds.is_empty());
        }
    }
}
