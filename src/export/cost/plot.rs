//! `cost.svg`: error against seconds, both logarithmic; bounds on the left, nominal trajectories on the right.
//!
//! Every setting is a dot, hollow where its bounds leave out more than they are too wide. A method's line joins the settings on
//! its own Pareto front; the thick grey line is the front of all methods.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use crate::compile::Scheme;
use crate::export::canvas::{Canvas, Drawn, FRAME, GRID, fine, pixel, pixels, svg, text_style};
use crate::export::figure::log_axis::LogAxis;
use crate::export::figure::path::Point;
use crate::results::{CostMethod, CostPoint, CostStudy, cost_curves, pareto};

/// Size on the page, px.
const SIZE: (u32, u32) = (1100, 540);
/// Space for title and legend, px.
const TOP: f64 = 96.0;
/// Space for the errors' axis, px.
const BOTTOM: f64 = 54.0;
/// Space for the seconds' axis of each panel, px.
const LEFT: f64 = 70.0;
/// Space on the right of each panel, px.
const RIGHT: f64 = 18.0;
/// From one line of the legend to the next, px.
const LINE: f64 = 18.0;
/// From one column of the legend to the next, px.
const COLUMN: f64 = 214.0;
/// A dot's radius, px.
const DOT: f64 = 3.4;
const FRONT: RGBColor = RGBColor(190, 190, 190);

/// The colours of the plots of bounds, and others that are apart from them for every colour vision.
fn color(method: CostMethod) -> RGBColor {
    match method {
        CostMethod::Bounds(curve) => {
            let [red, green, blue] = curve.about().color;
            RGBColor(red, green, blue)
        }
        CostMethod::Scheme(Scheme::Hht { .. }) => RGBColor(0, 114, 178),
        CostMethod::Scheme(Scheme::TrapezoidalIndex2) => RGBColor(130, 25, 80),
        CostMethod::Scheme(Scheme::GeneralisedAlpha { spectral_radius }) if spectral_radius < 0.65 => {
            RGBColor(0, 158, 115)
        }
        CostMethod::Scheme(Scheme::GeneralisedAlpha { spectral_radius }) if spectral_radius < 0.85 => {
            RGBColor(240, 160, 20)
        }
        CostMethod::Scheme(Scheme::GeneralisedAlpha { .. }) => RGBColor(86, 180, 233),
    }
}

/// The study as an SVG document.
///
/// # Errors
/// plotters' own, as text; none is known to occur.
pub fn cost_svg(study: &CostStudy) -> Result<String, String> {
    svg(SIZE, |canvas| draw(canvas, study).map_err(|error| error.to_string()))
}

fn draw(canvas: &Canvas, study: &CostStudy) -> Drawn {
    canvas.fill(&WHITE)?;
    let half = f64::from(SIZE.0) / 2.0;
    let scale = if study.is_deterministic() { "error / range of the course" } else { "error / largest width" };
    let panels = [
        ("Bounds", &study.bounds, study.reference.bounds_error),
        ("Nominal trajectory", &study.trajectories, study.reference.trajectory_error),
    ];
    let shown = panels.into_iter().filter(|(_, points, _)| !points.is_empty());
    for (place, (title, points, reference)) in shown.enumerate() {
        let left = place as f64 * half;
        let shown = || points.iter().filter(|point| is_shown(point));
        let errors = shown().map(|point| point.deviation.largest()).chain([study.tolerance]);
        let panel = Panel {
            canvas,
            left: left + LEFT,
            right: left + half - RIGHT,
            top: TOP,
            bottom: f64::from(SIZE.1) - BOTTOM,
            x: LogAxis::fit(errors.map(|error| error.max(reference))),
            y: LogAxis::fit(shown().map(|point| point.seconds)),
        };
        panel.mesh()?;
        panel.threshold(study.tolerance, "tolerance")?;
        if points.iter().any(|point| point.limited) {
            panel.threshold(reference, "reference")?;
        }
        panel.curves(points, reference)?;
        panel.frame(title, scale)?;
    }
    Ok(())
}

/// Settings without a result have no place in the plot.
fn is_shown(point: &CostPoint) -> bool {
    point.deviation.largest().is_finite() && point.seconds > 0.0
}

/// A rectangle of the canvas with its axes; lengths in px.
struct Panel<'a, 'b> {
    canvas: &'a Canvas<'b>,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x: LogAxis,
    y: LogAxis,
}

impl Panel<'_, '_> {
    /// Grid and labels of both axes.
    fn mesh(&self) -> Drawn {
        for (at, label) in self.x.ticks() {
            let x = self.left + at * (self.right - self.left);
            if let Some(label) = label {
                self.line(&[(x, self.top), (x, self.bottom)], GRID, 1.0)?;
                self.text(&label, (x, self.bottom + 8.0), HPos::Center, VPos::Top)?;
            }
            self.line(&[(x, self.bottom), (x, self.bottom + 4.0)], FRAME, 1.0)?;
        }
        for (at, label) in self.y.ticks() {
            let y = self.bottom - at * (self.bottom - self.top);
            if let Some(label) = label {
                self.line(&[(self.left, y), (self.right, y)], GRID, 1.0)?;
                self.text(&label, (self.left - 7.0, y), HPos::Right, VPos::Center)?;
            }
            self.line(&[(self.left - 4.0, y), (self.left, y)], FRAME, 1.0)?;
        }
        Ok(())
    }

    /// A vertical line at an error.
    fn threshold(&self, error: f64, label: &str) -> Drawn {
        let (x, _) = self.place((error, 1.0));
        self.line(&[(x, self.top), (x, self.bottom)], FRAME, 1.0)?;
        self.text(label, (x - 4.0, self.bottom - 6.0), HPos::Right, VPos::Bottom)
    }

    /// The common front below every method's dots and line, and the legend above. Errors below the reference's own error are
    /// shown at that error.
    fn curves(&self, points: &[CostPoint], reference: f64) -> Drawn {
        let all = || points.iter().filter(|point| is_shown(point));
        self.front(&all().map(|point| point.place(reference)).collect::<Vec<Point>>(), FRONT, 7.0)?;
        for (entry, method) in cost_curves(points).into_iter().enumerate() {
            let own = || all().filter(|point| point.method == method);
            self.front(&own().map(|point| point.place(reference)).collect::<Vec<Point>>(), color(method), 1.6)?;
            for point in own() {
                self.dot(self.place(point.place(reference)), color(method), point.deviation.is_narrow())?;
            }
            let (row, column) = (entry % 3, entry / 3);
            let (x, y) = (self.left + column as f64 * COLUMN, 32.0 + row as f64 * LINE);
            self.line(&[(x, y), (x + 22.0, y)], color(method), 1.6)?;
            self.dot((x + 11.0, y), color(method), false)?;
            self.text(&method.label(), (x + 28.0, y), HPos::Left, VPos::Center)?;
        }
        let (x, y) = (self.left, 32.0 + 3.0 * LINE);
        self.line(&[(x, y), (x + 22.0, y)], FRONT, 7.0)?;
        self.text("no other is cheaper and as good", (x + 28.0, y), HPos::Left, VPos::Center)?;
        if all().any(|point| point.deviation.is_narrow()) {
            self.dot((x + 251.0, y), FRAME, true)?;
            self.text("too narrow", (x + 260.0, y), HPos::Left, VPos::Center)?;
        }
        Ok(())
    }

    fn frame(&self, title: &str, scale: &str) -> Drawn {
        let Self { left, right, top, bottom, .. } = *self;
        self.line(&[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], FRAME, 1.0)?;
        let middle = (left + right) / 2.0;
        self.text(title, (middle, 12.0), HPos::Center, VPos::Center)?;
        self.text(scale, (middle, bottom + 28.0), HPos::Center, VPos::Top)?;
        let upright = text_style(HPos::Center, VPos::Top).transform(FontTransform::Rotate270);
        self.canvas.draw_text("seconds", &upright, pixel((left - 62.0, (top + bottom) / 2.0)))
    }

    fn place(&self, (error, seconds): Point) -> Point {
        let across = self.left + self.x.place(error) * (self.right - self.left);
        (across, self.bottom - self.y.place(seconds) * (self.bottom - self.top))
    }

    /// A line through the points on the Pareto front.
    fn front(&self, points: &[Point], color: RGBColor, width: f64) -> Drawn {
        let line: Vec<Point> = pareto(points).into_iter().map(|place| self.place(points[place])).collect();
        self.line(&line, color, width)
    }

    fn line(&self, points: &[Point], color: RGBColor, width: f64) -> Drawn {
        self.canvas.draw(&PathElement::new(pixels(points), color.stroke_width(fine(width))))
    }

    fn dot(&self, at: Point, color: RGBColor, hollow: bool) -> Drawn {
        self.canvas.draw(&Circle::new(pixel(at), fine(DOT), color.filled()))?;
        if hollow {
            self.canvas.draw(&Circle::new(pixel(at), fine(DOT - 1.3), WHITE.filled()))?;
        }
        Ok(())
    }

    fn text(&self, text: &str, at: Point, horizontal: HPos, vertical: VPos) -> Drawn {
        self.canvas.draw_text(text, &text_style(horizontal, vertical), pixel(at))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Stepping;
    use crate::results::cost_tests::COMPOSED;
    use crate::results::cost_tests::{sample, study};

    #[test]
    fn the_plot_shows_every_method_and_leaves_out_what_has_no_result() {
        let mut whole = sample();
        whole.bounds.push(CostPoint::without_result(COMPOSED, Stepping::Fixed(1e-2)));
        for study in [whole, study(vec![])] {
            let svg = cost_svg(&study).unwrap();
            assert!(svg.starts_with("<svg width=\"1100\" height=\"540\"") && svg.trim_end().ends_with("</svg>"));
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
            for point in study.bounds.iter().chain(&study.trajectories) {
                assert!(svg.contains(&point.method.label()), "{}", point.method.label());
            }
            assert_eq!(svg.contains("too narrow"), !study.bounds.is_empty());
        }
    }
}
