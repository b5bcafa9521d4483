//! What every plot is drawn on: a fine canvas that becomes an SVG document, its text and its lines.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::figure::path::Point;

/// plotters draws on whole pixels, which makes stairs of slanted lines: draw this much larger and let the SVG's view
/// box scale it back.
pub(super) const FINE: f64 = 10.0;

pub(super) const TEXT: f64 = 13.0;
const TEXT_COLOR: RGBColor = RGBColor(34, 34, 34);
pub(super) const FRAME: RGBColor = RGBColor(102, 102, 102);
pub(super) const GRID: RGBColor = RGBColor(228, 228, 228);

pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

pub(super) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// What is drawn, as an SVG document of a size on the page in px.
///
/// # Errors
/// The drawing's and plotters' own, as text.
pub(super) fn svg(size: (u32, u32), draw: impl FnOnce(&Canvas) -> Result<(), String>) -> Result<String, String> {
    let mut svg = String::new();
    let (width, height) = (fine(f64::from(size.0)), fine(f64::from(size.1)));
    {
        let canvas = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
        draw(&canvas)?;
        canvas.present().map_err(|e| e.to_string())?;
    }
    let drawn = format!("<svg width=\"{width}\" height=\"{height}\"");
    let shown = format!("<svg width=\"{}\" height=\"{}\" stroke-linejoin=\"round\"", size.0, size.1);
    Ok(svg.replacen(&drawn, &shown, 1))
}

pub(super) fn text_style(horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    // plotters sets a font of size s at s/1.24.
    let style = TextStyle::from(("Helvetica, Arial, sans-serif", TEXT * 1.24 * FINE).into_font());
    style.color(&TEXT_COLOR).pos(Pos::new(horizontal, vertical))
}

/// px → pixels of the finer canvas.
pub(super) fn pixel((x, y): Point) -> (i32, i32) {
    ((x * FINE).round() as i32, (y * FINE).round() as i32)
}

/// The same for a line, without the steps in place that many points a pixel make.
pub(super) fn pixels(points: &[Point]) -> Vec<(i32, i32)> {
    let mut pixels: Vec<_> = points.iter().map(|p| pixel(*p)).collect();
    if pixels.len() > 2 {
        pixels.dedup();
    }
    pixels
}

/// A width in px → of the finer canvas.
pub(super) fn fine(width: f64) -> u32 {
    (width * FINE).round() as u32
}

/// About the width of a text, px; a digit is 0.56 to 0.64 of the text's size in sans-serif fonts.
pub(super) fn text_width(text: &str) -> f64 {
    0.6 * TEXT * text.chars().count() as f64
}
