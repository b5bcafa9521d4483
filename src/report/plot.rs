//! `x3.svg`: an output's bounds over time, and how far they are from the nominal course.
//!
//! Two panels share the time axis. The upper shows the output: the nominal course and every method's band. Tolerances of
//! a per cent make bands that are a line wide there, so the lower panel shows the bands less the nominal course.
//!
//! Around each band a lighter one is as wide as its error; from where it is not resolved, a band is hatched.

use std::fmt::Display;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axis::Axis;
use super::polyline::{Point, band_pieces, pieces};
use super::view::{deviation, in_view};
use crate::bounds::{Band, Method, OutputBounds};

/// Size on the page, px.
const SIZE: (u32, u32) = (900, 560);
/// plotters draws on whole pixels, which makes stairs of slanted lines: draw this much larger and let the SVG's view
/// box scale it back.
pub(super) const FINE: f64 = 10.0;
/// Space for the legend, px.
const TOP: f64 = 40.0;
/// Space for the time axis, px.
const BOTTOM: f64 = 50.0;
/// Space between the panels, px.
const BETWEEN: f64 = 22.0;
/// Space on the right, px.
const RIGHT: f64 = 20.0;

pub(super) const TEXT: f64 = 13.0;
const TEXT_COLOR: RGBColor = RGBColor(34, 34, 34);
pub(super) const FRAME: RGBColor = RGBColor(102, 102, 102);
pub(super) const GRID: RGBColor = RGBColor(228, 228, 228);
const NOMINAL: RGBColor = BLACK;
/// Opacity of what a band's error adds, over the band's own.
const LIGHTER: f64 = 0.5;
/// From one line of a hatched band to the next, and how far each leans over, px.
const HATCH: (f64, f64) = (7.0, 5.0);

pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// How a method is drawn. The colours are apart for every colour vision and in grey. Where bands coincide the earlier
/// method shows through the gaps of the later one's dashes.
struct Style {
    label: &'static str,
    color: RGBColor,
    /// Width of the edges, px.
    edge: f64,
    /// Opacity of the band.
    fill: f64,
    /// Lengths of dash and gap, px.
    dashes: Option<[f64; 2]>,
}

fn style(method: Method) -> Style {
    let (label, color, edge, fill, dashes) = match method {
        Method::Chebyshev => ("Chebyshev", RGBColor(0, 114, 178), 2.0, 0.16, None),
        Method::Taylor => ("Taylor", RGBColor(240, 160, 20), 2.0, 0.18, Some([10.0, 7.0])),
        Method::Scan => ("Scan", RGBColor(130, 25, 80), 2.0, 0.10, Some([2.0, 6.5])),
        Method::Certified => ("Certified", RGBColor(0, 120, 60), 2.0, 0.08, Some([14.0, 3.0])),
    };
    Style { label, color, edge, fill, dashes }
}

/// The plot of one output as an SVG document. The same data give the same bytes.
///
/// # Errors
/// plotters' own, as text; none is known to occur.
pub fn plot_svg(times: &[f64], output: &OutputBounds) -> Result<String, String> {
    let svg = svg(SIZE, |canvas| draw(canvas, times, output).map_err(|e| e.to_string()))?;
    Ok(dashed(&svg))
}

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

fn draw(canvas: &Canvas, times: &[f64], output: &OutputBounds) -> Result<(), impl Display + use<>> {
    canvas.fill(&WHITE)?;
    let deviations: Vec<Band> = output.bands.iter().map(|band| deviation(band, &output.nominal)).collect();

    let time = Axis::fit(times.iter().copied(), 9, 0.0);
    let (values, beyond) = in_view(&output.nominal, &output.bands, 4.0);
    let main = Axis::fit(values.into_iter(), 6, 0.04);
    let (values, beyond_below) = in_view(&[0.0], &deviations, 6.0);
    let below = Axis::fit(values.into_iter(), 4, 0.06);

    let (width, height) = (f64::from(SIZE.0), f64::from(SIZE.1));
    let left = 44.0 + label_width(&main).max(label_width(&below));
    let free = height - TOP - BOTTOM;
    let split = if output.bands.is_empty() { TOP + free } else { TOP + 0.6 * (free - BETWEEN) };
    let upper = Panel { canvas, left, right: width - RIGHT, top: TOP, bottom: split, x: &time, y: &main };

    upper.mesh()?;
    upper.bands(times, &output.bands)?;
    upper.curve(times, &output.nominal, NOMINAL, 1.2)?;
    upper.y_title(&main.title(&shortened(&output.name), &output.unit))?;
    let beyond = beyond.iter().zip(beyond_below).map(|(&above, below)| above || below);
    let unresolved = output.bands.iter().map(|band| band.error.unresolved_from().map(|row| times[row]));
    let notes = beyond.zip(unresolved).map(|(beyond, unresolved)| note(beyond, unresolved));
    upper.legend(output.bands.iter().map(|band| style(band.method)).zip(notes))?;
    if output.bands.is_empty() {
        upper.frame()?;
        return upper.time_axis();
    }

    let lower = Panel { top: split + BETWEEN, bottom: height - BOTTOM, y: &below, ..upper };
    lower.mesh()?;
    lower.bands(times, &deviations)?;
    // The nominal course, less itself: a line at zero with the same gaps.
    let zero: Vec<f64> = output.nominal.iter().map(|x| if x.is_finite() { 0.0 } else { f64::NAN }).collect();
    lower.curve(times, &zero, NOMINAL, 1.2)?;
    lower.y_title(&below.title("bound − nominal", &output.unit))?;
    upper.frame()?;
    lower.frame()?;
    lower.time_axis()
}

/// A rectangle of the canvas with its axes; lengths in px.
#[derive(Clone, Copy)]
struct Panel<'a, 'b> {
    canvas: &'a Canvas<'b>,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x: &'a Axis,
    y: &'a Axis,
}

pub(super) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

impl Panel<'_, '_> {
    /// Grid and labels of the y axis.
    fn mesh(&self) -> Drawn {
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

    fn frame(&self) -> Drawn {
        let Self { left, right, top, bottom, .. } = *self;
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        self.line(&corners, FRAME.stroke_width(fine(1.0)))
    }

    /// Ticks, labels and title of the time axis, below the panel.
    fn time_axis(&self) -> Drawn {
        for (at, label) in self.x.ticks() {
            let x = self.left + at * (self.right - self.left);
            self.line(&[(x, self.bottom), (x, self.bottom + 4.0)], FRAME.stroke_width(fine(1.0)))?;
            self.text(&label, (x, self.bottom + 8.0), HPos::Center, VPos::Top)?;
        }
        let middle = (self.left + self.right) / 2.0;
        self.text(&self.x.title("t", "s"), (middle, self.bottom + 27.0), HPos::Center, VPos::Top)
    }

    fn y_title(&self, title: &str) -> Drawn {
        let style = text_style(HPos::Center, VPos::Top).transform(FontTransform::Rotate270);
        self.canvas.draw_text(title, &style, pixel((8.0, (self.top + self.bottom) / 2.0)))
    }

    /// A row above the panel: never in the way of the data.
    fn legend(&self, bands: impl Iterator<Item = (Style, String)>) -> Drawn {
        let y = self.top - 19.0;
        let mut x = self.left;
        self.line(&[(x, y), (x + 26.0, y)], NOMINAL.stroke_width(fine(1.4)))?;
        self.text("Nominal", (x + 33.0, y), HPos::Left, VPos::Center)?;
        x += legend_step("Nominal");
        for (style, note) in bands {
            let (top, bottom) = (y - 6.0, y + 6.0);
            self.fill(&[(x, top), (x + 26.0, top), (x + 26.0, bottom), (x, bottom)], &style, 1.0)?;
            for edge in [top, bottom] {
                self.line(&[(x, edge), (x + 26.0, edge)], style.color.stroke_width(fine(style.edge)))?;
            }
            let label = format!("{}{note}", style.label);
            self.text(&label, (x + 33.0, y), HPos::Left, VPos::Center)?;
            x += legend_step(&label);
        }
        Ok(())
    }

    /// Errors below, then the bands.
    fn bands(&self, times: &[f64], bands: &[Band]) -> Drawn {
        for band in bands {
            let apart = |side: &[f64], sign: f64| -> Vec<f64> {
                side.iter().zip(&band.error.total).map(|(bound, error)| bound + sign * error).collect()
            };
            self.between(times, &apart(&band.lower, -1.0), &apart(&band.upper, 1.0), &style(band.method), LIGHTER)?;
        }
        bands.iter().try_for_each(|band| self.band(times, band))
    }

    fn band(&self, times: &[f64], band: &Band) -> Drawn {
        let style = style(band.method);
        self.between(times, &band.lower, &band.upper, &style, 1.0)?;
        self.hatch(times, band, &style)?;
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

    /// Lines across the band from where it is not resolved.
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

    fn curve(&self, times: &[f64], values: &[f64], color: RGBColor, width: f64) -> Drawn {
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
fn note(beyond: bool, unresolved_from: Option<f64>) -> String {
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

/// Width of an axis' widest label, px.
fn label_width(axis: &Axis) -> f64 {
    axis.ticks().iter().map(|(_, label)| text_width(label)).fold(0.0, f64::max)
}

/// From one entry of the legend to the next, px.
fn legend_step(label: &str) -> f64 {
    33.0 + text_width(label) + 26.0
}

/// A name that fits beside its panel.
fn shortened(name: &str) -> String {
    const LONGEST: usize = 28;
    if name.chars().count() <= LONGEST {
        name.to_owned()
    } else {
        name.chars().take(LONGEST - 1).chain(['…']).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::BandError;

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
