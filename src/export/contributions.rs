//! `contributions.csv` and `NAME.contributions.svg`: the tolerances that matter at each time.

use csv::WriterBuilder;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{Canvas, Drawn, FRAME, GRID, TEXT, fine, pixel, pixels, svg, text_style, text_width};
use super::csv::number;
use super::figure::axis::Axis;
use crate::results::{Bounds, Contribution};

/// The table of all contributions as CSV.
///
/// Columns: `t`, then for each output and parameter `x3.l1.main` and `.total`, the parameter's share of the output's variance
/// alone and with others, and `.width_without`, how wide the output's range would be if the parameter were at its nominal
/// value. Unknown values are `NaN`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn contributions_csv(bounds: &Bounds) -> Result<Vec<u8>, csv::Error> {
    let mut columns: Vec<(String, &[f64])> = vec![("t".to_owned(), &bounds.times)];
    for (output, contributions) in bounds.outputs.iter().zip(&bounds.contributions) {
        for Contribution { parameter, main, total, width_without } in contributions {
            for (name, values) in [("main", main), ("total", total), ("width_without", width_without)] {
                columns.push((format!("{}.{parameter}.{name}", output.name), values));
            }
        }
    }
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(columns.iter().map(|(name, _)| name))?;
    for row in 0..bounds.times.len() {
        writer.write_record(columns.iter().map(|(_, values)| number(values[row])))?;
    }
    writer.into_inner().map_err(|e| e.into_error().into())
}

/// Size on the page, px.
const SIZE: (u32, u32) = (900, 380);
/// Space on the four sides, px.
const LEFT: f64 = 64.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 50.0;

/// Colours that every colour vision distinguishes; further parameters share the last.
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(240, 160, 20),
    RGBColor(0, 158, 115),
    RGBColor(130, 25, 80),
    RGBColor(86, 180, 233),
    RGBColor(213, 94, 0),
    RGBColor(150, 150, 150),
];
/// The share of interactions of parameters.
const TOGETHER: RGBColor = RGBColor(215, 215, 215);

/// The parameters' shares of one output's variance over time, one upon the other, the largest lowest.
///
/// # Errors
/// plotters' own, as text; none is known to occur.
pub fn contributions_svg(times: &[f64], name: &str, contributions: &[Contribution]) -> Result<String, String> {
    svg(SIZE, |canvas| draw(canvas, times, name, contributions).map_err(|error| error.to_string()))
}

fn draw(canvas: &Canvas, times: &[f64], name: &str, contributions: &[Contribution]) -> Drawn {
    canvas.fill(&WHITE)?;
    let (right, bottom) = (f64::from(SIZE.0) - RIGHT, f64::from(SIZE.1) - BOTTOM);
    let time = Axis::fit(times.iter().copied(), "s", 9, 0.0, 0.0);
    let across = |t: f64| LEFT + time.place(t) * (right - LEFT);
    let up = |share: f64| bottom - share.clamp(0.0, 1.0) * (bottom - TOP);
    let line = |points: &[(f64, f64)], color: RGBColor| {
        canvas.draw(&PathElement::new(pixels(points), color.stroke_width(fine(1.0))))
    };
    let text = |text: &str, at: (f64, f64), horizontal, vertical| {
        canvas.draw_text(text, &text_style(horizontal, vertical), pixel(at))
    };

    let mut ranked: Vec<(usize, &Contribution)> = contributions.iter().enumerate().collect();
    let mean = |contribution: &Contribution| contribution.main.iter().filter(|share| share.is_finite()).sum::<f64>();
    ranked.sort_by(|a, b| mean(b.1).total_cmp(&mean(a.1)));
    // Rows without variance or without known shares stay white.
    let known = |row: usize| contributions.iter().any(|contribution| contribution.main[row] > 0.0);
    let mut below = vec![0.0; times.len()];
    let mut entry = LEFT;
    for (place, (_, contribution)) in ranked.iter().enumerate() {
        let color = COLORS[place.min(COLORS.len() - 1)];
        let above: Vec<f64> = below.iter().zip(&contribution.main).map(|(below, share)| below + share).collect();
        fill(canvas, times, &below, &above, color, (&known, &across, &up))?;
        below = above;
        if place < COLORS.len() {
            let label = if place + 1 == COLORS.len() && ranked.len() > COLORS.len() {
                "others"
            } else {
                &contribution.parameter
            };
            entry = key(canvas, entry, color, label)?;
        }
    }
    fill(canvas, times, &below, &vec![1.0; times.len()], TOGETHER, (&known, &across, &up))?;
    key(canvas, entry, TOGETHER, "together")?;

    for (at, label) in time.ticks() {
        let x = LEFT + at * (right - LEFT);
        line(&[(x, bottom), (x, bottom + 4.0)], FRAME)?;
        text(&label, (x, bottom + 8.0), HPos::Center, VPos::Top)?;
    }
    for percent in [0, 25, 50, 75, 100] {
        let y = up(f64::from(percent) / 100.0);
        line(&[(LEFT, y), (right, y)], GRID)?;
        text(&format!("{percent} %"), (LEFT - 7.0, y), HPos::Right, VPos::Center)?;
    }
    line(&[(LEFT, TOP), (right, TOP), (right, bottom), (LEFT, bottom), (LEFT, TOP)], FRAME)?;
    text(&time.title("t"), ((LEFT + right) / 2.0, bottom + 27.0), HPos::Center, VPos::Top)?;
    text(&format!("share of {name}'s variance"), (right, TOP - 19.0), HPos::Right, VPos::Center)
}

/// Rows of which something is known, and where times and shares lie.
type Places<'a> = (&'a dyn Fn(usize) -> bool, &'a dyn Fn(f64) -> f64, &'a dyn Fn(f64) -> f64);

/// The area between two curves.
fn fill(
    canvas: &Canvas,
    times: &[f64],
    below: &[f64],
    above: &[f64],
    color: RGBColor,
    (known, across, up): Places,
) -> Drawn {
    let rows: Vec<usize> = (0..times.len()).collect();
    for piece in rows.split(|&row| !known(row)).filter(|piece| piece.len() > 1) {
        let upper = piece.iter().map(|&row| (across(times[row]), up(above[row])));
        let lower = piece.iter().rev().map(|&row| (across(times[row]), up(below[row])));
        let outline: Vec<(f64, f64)> = upper.chain(lower).collect();
        canvas.draw(&Polygon::new(pixels(&outline), color.filled()))?;
    }
    Ok(())
}

/// An entry of the legend; where the next begins.
fn key(canvas: &Canvas, x: f64, color: RGBColor, label: &str) -> Result<f64, DrawingAreaErrorKind<std::io::Error>> {
    let (top, bottom) = (TOP - 19.0 - 0.5 * TEXT, TOP - 19.0 + 0.5 * TEXT);
    let square = [(x, top), (x + TEXT, top), (x + TEXT, bottom), (x, bottom)];
    canvas.draw(&Polygon::new(pixels(&square), color.filled()))?;
    canvas.draw_text(label, &text_style(HPos::Left, VPos::Center), pixel((x + TEXT + 6.0, TOP - 19.0)))?;
    Ok(x + TEXT + 6.0 + text_width(label) + 18.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::OutputBounds;

    fn contribution(parameter: &str, main: f64) -> Contribution {
        let shares = vec![f64::NAN, main, main];
        Contribution {
            parameter: parameter.into(),
            main: shares.clone(),
            total: shares,
            width_without: vec![0.0, 1.0, 2.0],
        }
    }

    #[test]
    fn a_column_for_each_share() {
        let output = OutputBounds { name: "x3".into(), unit: "m".into(), nominal: vec![0.0; 3], bands: vec![] };
        let bounds = Bounds {
            times: vec![0.0, 0.5, 1.0],
            outputs: vec![output],
            contributions: vec![vec![contribution("l1", 0.25), contribution("tau", 0.5)]],
            ..Bounds::default()
        };
        let text = String::from_utf8(contributions_csv(&bounds).unwrap()).unwrap();
        assert_eq!(
            text,
            "t,x3.l1.main,x3.l1.total,x3.l1.width_without,x3.tau.main,x3.tau.total,x3.tau.width_without\n\
             0,NaN,NaN,0,NaN,NaN,0\n0.5,0.25,0.25,1,0.5,0.5,1\n1,0.25,0.25,2,0.5,0.5,2\n"
        );
    }

    #[test]
    fn shares_are_stacked_and_named() {
        let shares: Vec<Contribution> =
            (0..9).map(|place| contribution(&format!("p{place}"), 0.1)).chain([contribution("l1", 0.05)]).collect();
        let svg = contributions_svg(&[0.0, 0.5, 1.0], "x3", &shares).unwrap();
        assert!(svg.starts_with("<svg width=\"900\"") && svg.trim_end().ends_with("</svg>"));
        for text in ["p0", "others", "together", "t [s]", "100 %", "share of x3"] {
            assert!(svg.contains(text), "{text}");
        }
        assert!(!svg.contains("NaN"));
        assert!(contributions_svg(&[], "x3", &[]).is_ok());
    }
}
