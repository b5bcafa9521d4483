//! A panel of a plot: axes, curves, bands with their errors, and a legend above it.
//!
//! A lighter band around each band shows its error; from where it is unreliable, a band is hatched.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::Axis;
use super::canvas::{Canvas, Drawn, FRAME, GRID, fine, pixel, pixels, text_style, text_width};
use super::polyline::{Point, band_pieces, pieces};
use crate::results::Band;

/// Opacity of the error around a band, relative to the band's own.
const LIGHTER: f64 = 0.5;
/// Distance of the lines of a hatched band, and their slant, px.
const HATCH: (f64, f64) = (7.0, 5.0);

/// How a band is drawn.
#[derive(Clone, Debug)]
pub(super) struct Style {
    pub label: String,
    pub color: RGBColor,
    /// Width of the edges, px.
    pub edge: f64,
    /// Opacity of the band.
    pub fill: f64,
    /// Lengths of dash and gap, px.
    pub dashes: Option<[f64; 2]>,
}

/// A rectangle of the canvas with its axes; lengths in px.
#[derive(Clone, Copy)]
pub(super) struct Panel<'a, 'b> {
    pub canvas: &'a Canvas<'b>,
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
    pub x: &'a Axis,
    pub y: &'a Axis,
}

impl Panel<'_, '_> {
    /// Grid and labels of the y axis.
    pub fn mesh(&self) -> Drawn {
        for (at, _) in self.x.ticks() {
            let x = self.left + at * (self.right - self.left);
            self.line(&[(x, self.top), (x, self.bottom)], GRID.stroke_width(fine(1.0)))?;
        }
        for (at, label) in self.y.ticks() {
            let y = self.bottom - at * (self.bottom - self.top);
            self.line(&[(self.left, y), (self.right, y)], GRID.stroke_width(fine(1.0)))?;
            self.line(&[(self.left - 4.0, y), (self.left, y)], FRAME.stroke_width(fine(1.0)))?;
            self.text(&label, (self.left - 7.0, y), HPos::Right, VPos::Center)?;
        }
        Ok(())
    }

    pub fn frame(&self) -> Drawn {
        let Self { left, right, top, bottom, .. } = *self;
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        self.line(&corners, FRAME.stroke_width(fine(1.0)))
    }

    /// Ticks, labels and title of the time axis, below the panel.
    pub fn time_axis(&self) -> Drawn {
        for (at, label) in self.x.ticks() {
            let x = self.left + at * (self.right - self.left);
            self.line(&[(x, self.bottom), (x, self.bottom + 4.0)], FRAME.stroke_width(fine(1.0)))?;
            self.text(&label, (x, self.bottom + 8.0), HPos::Center, VPos::Top)?;
        }
        let middle = (self.left + self.right) / 2.0;
        self.text(&self.x.title("t", "s"), (middle, self.bottom + 27.0), HPos::Center, VPos::Top)
    }

    pub fn y_title(&self, title: &str) -> Drawn {
        let style = text_style(HPos::Center, VPos::Top).transform(FontTransform::Rotate270);
        self.canvas.draw_text(title, &style, pixel((8.0, (self.top + self.bottom) / 2.0)))
    }

    /// A line in the legend, from the left end of its entry.
    pub fn line_key(&self, (x, y): Point, label: &str, color: RGBColor) -> Drawn {
        self.line(&[(x, y), (x + 26.0, y)], color.stroke_width(fine(1.4)))?;
        self.text(label, (x + 33.0, y), HPos::Left, VPos::Center)
    }

    /// A band in the legend.
    pub fn band_key(&self, (x, y): Point, label: &str, style: &Style) -> Drawn {
        let (top, bottom) = (y - 6.0, y + 6.0);
        self.fill(&[(x, top), (x + 26.0, top), (x + 26.0, bottom), (x, bottom)], style, 1.0)?;
        for edge in [top, bottom] {
            self.line(&[(x, edge), (x + 26.0, edge)], style.color.stroke_width(fine(style.edge)))?;
        }
        self.text(label, (x + 33.0, y), HPos::Left, VPos::Center)
    }

    /// Errors below, then the bands.
    pub fn bands<'s>(&self, times: &[f64], bands: impl Iterator<Item = (&'s Band, &'s Style)> + Clone) -> Drawn {
        for (band, style) in bands.clone() {
            let apart = |side: &[f64], sign: f64| -> Vec<f64> {
                side.iter().zip(&band.error.total).map(|(bound, error)| bound + sign * error).collect()
            };
            self.between(times, &apart(&band.lower, -1.0), &apart(&band.upper, 1.0), style, LIGHTER)?;
        }
        bands.into_iter().try_for_each(|(band, style)| self.band(times, band, style))
    }

    fn band(&self, times: &[f64], band: &Band, style: &Style) -> Drawn {
        self.between(times, &band.lower, &band.upper, style, 1.0)?;
        self.hatch(times, band, style)?;
        for (lower, upper) in band_pieces(times, &band.lower, &band.upper) {
            self.points(&lower, style.color, style.edge)?;
            self.points(&upper, style.color, style.edge)?;
        }
        Ok(())
    }

    /// What lies between two curves.
    fn between(&self, times: &[f64], lower: &[f64], upper: &[f64], style: &Style, opacity: f64) -> Drawn {
        for (lower, upper) in band_pieces(times, lower, upper) {
            let outline: Vec<Point> = upper.iter().chain(lower.iter().rev()).map(|p| self.place(*p)).collect();
            self.fill(&outline, style, opacity)?;
        }
        Ok(())
    }

    /// Lines across the band from where it is unreliable.
    fn hatch(&self, times: &[f64], band: &Band, style: &Style) -> Drawn {
        let Some(first) = band.error.unresolved_from() else { return Ok(()) };
        let pixels_a_row = (self.right - self.left) * (self.x.place(times[times.len() - 1]) - self.x.place(times[0]))
            / (times.len() - 1).max(1) as f64;
        let rows = |pixels: f64| ((pixels / pixels_a_row) as usize).clamp(1, times.len());
        for row in (first..times.len()).step_by(rows(HATCH.0)) {
            let over = (row + rows(HATCH.1)).min(times.len() - 1);
            let ends = [(times[row], band.lower[row]), (times[over], band.upper[over])];
            if ends.iter().all(|end| end.1.is_finite()) {
                self.line(&ends.map(|end| self.place(end)), style.color.stroke_width(fine(1.0)))?;
            }
        }
        Ok(())
    }

    pub fn curve(&self, times: &[f64], values: &[f64], color: RGBColor, width: f64) -> Drawn {
        pieces(times, values).iter().try_for_each(|piece| self.points(piece, color, width))
    }

    /// A line through points of the data; a dot if there is but one.
    fn points(&self, points: &[Point], color: RGBColor, width: f64) -> Drawn {
        let placed: Vec<Point> = points.iter().map(|p| self.place(*p)).collect();
        match placed[..] {
            [only] => self.canvas.draw(&Circle::new(pixel(only), fine(0.8 * width + 0.7), color.filled())),
            _ => self.line(&placed, color.stroke_width(fine(width))),
        }
    }

    /// Where a point of the data lies on the canvas; what is beyond the panel, on its frame.
    fn place(&self, (t, y): Point) -> Point {
        let across = self.left + self.x.place(t) * (self.right - self.left);
        (across, self.bottom - self.y.place(y).clamp(0.0, 1.0) * (self.bottom - self.top))
    }

    fn line(&self, points: &[Point], style: ShapeStyle) -> Drawn {
        self.canvas.draw(&PathElement::new(pixels(points), style))
    }

    fn fill(&self, outline: &[Point], style: &Style, opacity: f64) -> Drawn {
        self.canvas.draw(&Polygon::new(pixels(outline), style.color.mix(opacity * style.fill).filled()))
    }

    fn text(&self, text: &str, at: Point, horizontal: HPos, vertical: VPos) -> Drawn {
        self.canvas.draw_text(text, &text_style(horizontal, vertical), pixel(at))
    }
}

/// What the legend adds to a method's name.
pub(super) fn note(beyond: bool, unresolved_from: Option<f64>) -> String {
    match (unresolved_from, beyond) {
        (Some(time), _) => format!(" (unresolved from {} s)", short(time)),
        (None, true) => " (beyond the plot)".to_owned(),
        (None, false) => String::new(),
    }
}

/// A time with three digits.
fn short(time: f64) -> String {
    let text = format!("{time:.2e}").parse::<f64>().unwrap_or(time);
    format!("{text}")
}

/// Width of an axis' widest label, px.
pub(super) fn label_width(axis: &Axis) -> f64 {
    axis.ticks().iter().map(|(_, label)| text_width(label)).fold(0.0, f64::max)
}

/// From one entry of the legend to the next, px.
pub(super) fn legend_step(label: &str) -> f64 {
    33.0 + text_width(label) + 26.0
}

/// A name that fits beside its panel.
pub(super) fn shortened(name: &str) -> String {
    const LONGEST: usize = 28;
    if name.chars().count() <= LONGEST {
        name.to_owned()
    } else {
        name.chars().take(LONGEST - 1).chain(['…']).collect()
    }
}
