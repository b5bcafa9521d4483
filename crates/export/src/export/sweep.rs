//! Bounds against a parameter that is swept, and a cost against its benefit.

use svg::node::element::{Circle, Group, Title};

use super::courses::{Across, BandedCourse, CourseBand, Shown, courses_svg};
use super::figure::Caption;
use super::figure::axis::Axis;
use super::figure::document::{Anchor, document, finished, group, heading, shortened, text};
use super::figure::panel::{Named, Panel, label_width};
use super::figure::path::px;
use super::figure::style::{Color, Hue};
use super::limits::limits;
use super::overlay::style;
use super::plot;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{OutputBounds, RequirementSummary, foremost};

/// A swept parameter: its name, its unit as models write it, and the value of one unit in SI.
#[derive(Clone, Copy, Debug)]
pub struct Swept<'a> {
    /// Name of the parameter.
    pub name: &'a str,
    /// Its unit, as models write it; empty for a number.
    pub unit: &'a str,
    /// Value of one unit in SI.
    pub si: f64,
}

/// Bounds of an output, or of a reduced output, for several values of a parameter.
#[derive(Clone, Copy, Debug)]
pub struct SweptBounds<'a> {
    /// Distinction from others, such as a second parameter's value; empty if there is only one.
    pub label: &'a str,
    /// The parameter's values in SI, ascending.
    pub values: &'a [f64],
    /// The output: each vector runs over the values.
    pub output: &'a OutputBounds,
}

/// Bounds against a parameter as an SVG document: all methods of one row of values, or the edges of several rows.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn sweep_svg(
    caption: Caption,
    swept: Swept,
    rows: &[SweptBounds],
    requirements: &[RequirementSummary],
) -> Result<String, serde_json::Error> {
    let courses: Vec<BandedCourse> = match rows {
        [row] => vec![plot::course(row.values, row.output)],
        rows => rows.iter().enumerate().map(|(index, row)| edges(index, row)).collect(),
    };
    let (name, unit) = rows.first().map_or(("", ShownUnit::from("")), |row| {
        (row.output.name.as_str(), ShownUnit::of(&row.output.display, &row.output.unit))
    });
    let limits = limits(requirements, name).iter().map(|limit| limit.everywhere()).collect::<Vec<_>>();
    let across = Across { name: swept.name, unit: ShownUnit { text: swept.unit, si: swept.si } };
    courses_svg(caption, &Shown { name, unit, across, noise: 0.0, courses: &courses, limits: &limits })
}

/// One of several rows: the edges of its first method that is reliable throughout.
fn edges<'a>(index: usize, row: &SweptBounds<'a>) -> BandedCourse<'a> {
    let band = foremost(&row.output.bands, |band| band.error.unresolved_from().is_none());
    let of = |band| CourseBand { group: format!("row-{index}"), band, style: style(index, row.label.to_owned()) };
    let (label, width) = if band.is_some() { ("", 0.5) } else { (row.label, 1.4) };
    BandedCourse {
        group: format!("row-{index}-nominal"),
        label,
        hue: Hue::Color(Color::of(index)),
        width,
        times: row.values,
        nominal: &row.output.nominal,
        bands: band.into_iter().map(of).collect(),
    }
}

/// An axis of a trade-off: its quantity, and its unit as models write it; numbers are in this unit.
#[derive(Clone, Copy, Debug)]
pub struct TradeAxis<'a> {
    /// Name for people.
    pub name: &'a str,
    /// Empty for a number.
    pub unit: &'a str,
}

/// A point of a trade-off with a name, such as the present tolerances.
#[derive(Clone, Copy, Debug)]
pub struct TradeMark<'a> {
    /// Label for people.
    pub label: &'a str,
    /// Its position, in the units of the axes.
    pub at: (f64, f64),
}

/// Size on the page, px.
const SIZE: (f64, f64) = (700.0, 460.0);

/// One quantity against another as an SVG document: a line through points that ascend in x, and points with names.
pub fn trade_svg(
    caption: Caption,
    title: &str,
    axes: [TradeAxis; 2],
    line: &[(f64, f64)],
    marks: &[TradeMark],
) -> String {
    let all = || line.iter().copied().chain(marks.iter().map(|mark| mark.at));
    let x = Axis::fit(all().map(|(x, _)| x), axes[0].unit, 7, 0.06, 0.0);
    let y = Axis::fit(all().map(|(_, y)| y), axes[1].unit, 6, 0.08, 0.0);
    let left = 44.0 + label_width(&y);
    let id = format!("{}-trade", caption.prefix);
    let panel = Panel { id, left, right: SIZE.0 - 20.0, top: 36.0, bottom: SIZE.1 - 50.0, x: &x, y: &y };
    let (xs, ys): (Vec<f64>, Vec<f64>) = line.iter().copied().unzip();
    let id = format!("{}-line", panel.id);
    let hue = Hue::Color(Color::of(0));
    let mut drawn = vec![panel.curve(Named { id: &id, group: "line", title }, &xs, &ys, hue, 1.6)];
    drawn.extend(line.iter().map(|&at| hue.paint(Group::new().add(dot(panel.place(at.0, at.1), 2.6)), "dot")));
    for (index, mark) in marks.iter().enumerate() {
        let at = panel.place(mark.at.0, mark.at.1);
        // On the side with more room.
        let (beside, anchor) = if at.0 > 0.7 * SIZE.0 { (-10.0, Anchor::End) } else { (10.0, Anchor::Start) };
        // Labels of near points alternate: one above, one below.
        let height = if index % 2 == 0 { -12.0 } else { 22.0 };
        let label = text(mark.label, (at.0 + beside, at.1 + height), anchor);
        let marked = Group::new().add(Title::new(mark.label)).add(dot(at, 5.0)).add(label);
        drawn.push(Hue::Color(Color::of(index + 1)).paint(marked, "mark"));
    }
    let title = format!("{}: {}", shortened(caption.model, 60), shortened(title, 60));
    let figure = document(SIZE, &title)
        .add(heading(&title, (left, 15.0)))
        .add(panel.framed(&title, &y.title(axes[1].name), drawn))
        .add(group("across").add(panel.time_axis(axes[0].name)));
    finished(&figure)
}

fn dot(at: (f64, f64), radius: f64) -> Circle {
    Circle::new().set("class", "area").set("cx", px(at.0)).set("cy", px(at.1)).set("r", radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::{Band, Method};

    fn output() -> OutputBounds {
        let error = BandError { total: vec![0.0; 3], unresolved: vec![false; 3], ..BandError::default() };
        let band = Band { method: Method::Scan, lower: vec![1.0, 1.5, 1.9], upper: vec![1.2, 1.8, 2.6], error };
        let nominal = vec![1.1, 1.6, 2.2];
        OutputBounds { name: "stroke".into(), unit: "m".into(), display: None, nominal, bands: vec![band] }
    }

    #[test]
    fn bounds_are_plotted_against_a_parameter() {
        let output = output();
        let caption = Caption { model: "crank", prefix: "s" };
        let swept = Swept { name: "l1", unit: "mm", si: 1e-3 };
        let row = |label| SweptBounds { label, values: &[0.1, 0.15, 0.2], output: &output };
        let svg = sweep_svg(caption, swept, &[row("")], &[]).unwrap();
        for text in ["crank: stroke", "l1 [mm]", "stroke [m]", "Scan", "150"] {
            assert!(svg.contains(&format!("\n{text}\n")), "{text}");
        }
        let svg = sweep_svg(caption, swept, &[row("s = 1"), row("s = 2")], &[]).unwrap();
        assert!(svg.contains("s = 1") && svg.contains("s = 2") && !svg.contains("\nScan\n"));
        assert!(sweep_svg(caption, swept, &[], &[]).is_ok());
    }

    #[test]
    fn a_trade_off_has_its_line_and_its_marks() {
        let axes = [TradeAxis { name: "margin", unit: "m" }, TradeAxis { name: "cost", unit: "" }];
        let caption = Caption { model: "crank", prefix: "s" };
        let marks = [TradeMark { label: "now", at: (1e-3, 9.0) }];
        let svg = trade_svg(caption, "cost against margin", axes, &[(0.0, 1.0), (2e-3, 4.0)], &marks);
        for text in ["margin [mm]", "cost", "now", "crank: cost against margin"] {
            assert!(svg.contains(&format!("\n{text}\n")), "{text}");
        }
        assert!(!trade_svg(caption, "none", axes, &[], &[]).contains("NaN"));
    }
}
