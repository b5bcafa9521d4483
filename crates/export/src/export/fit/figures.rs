//! Residuals over time, and shadows of the consistent set.

use svg::node::element::{Circle, Group, Rectangle, Title};

use crate::export::figure::axis::Axis;
use crate::export::figure::document::{Anchor, document, finished, group, heading, line, shortened, text};
use crate::export::figure::panel::{Panel, label_width};
use crate::export::figure::path::px;
use crate::export::figure::style::{Color, Hue};
use crate::grammar::display_unit::ShownUnit;
use crate::results::{Fit, FitParameter, FitProjection, FitRow};

/// Sizes on the page, px, and free space on each side.
const WIDE: (f64, f64) = (760.0, 340.0);
const SQUARE: (f64, f64) = (520.0, 480.0);
const RIGHT: f64 = 20.0;
const TOP: f64 = 60.0;
const BOTTOM: f64 = 50.0;

/// Measured minus fitted, each with its noise bound.
pub(super) fn residuals(fit: &Fit, output: usize) -> String {
    let own = &fit.outputs[output];
    let unit = ShownUnit::of(&own.display, &own.unit);
    let rows: Vec<&FitRow> = fit.rows.iter().filter(|row| row.output == output && row.fitted.is_finite()).collect();
    let residual = |row: &FitRow| row.measured - row.fitted;
    let ends = rows.iter().flat_map(|row| [residual(row) - row.noise, residual(row) + row.noise]);
    let y = Axis::fit(ends.chain([0.0]), unit, 6, 0.05, 0.0);
    let x = Axis::fit(rows.iter().map(|row| row.time), "s", 8, 0.02, 0.0);
    let left = label_width(&y) + 44.0;
    let panel = framed("fit-residuals", WIDE, left, &x, &y);
    let mut bars = group("bars");
    for row in &rows {
        let ends = [residual(row) - row.noise, residual(row) + row.noise].map(|end| panel.place(row.time, end));
        let middle = panel.place(row.time, residual(row));
        let dot = Circle::new().set("class", "area").set("cx", px(middle.0)).set("cy", px(middle.1)).set("r", 1.6);
        bars = bars.add(line(ends[0], ends[1]).set("class", "line").set("stroke-width", 1)).add(dot);
    }
    let zero = panel.place(0.0, 0.0).1;
    let zero = group("mark").add(line((left, zero), (WIDE.0 - RIGHT, zero)).set("class", "frame"));
    let name = shortened(&own.name, 50);
    let title = format!("{}: {name}, measured − fitted", shortened(&fit.model, 50));
    let series = [Hue::Color(Color::of(0)).paint(bars, "bars"), zero];
    let note = "dots: least squares; bars: noise bounds";
    let figure = document(WIDE, &title)
        .add(heading(&title, (12.0, 16.0)))
        .add(text(note, (12.0, 38.0), Anchor::Start))
        .add(panel.framed(&name, &y.title("residual"), series))
        .add(panel.time_axis("t"));
    finished(&figure)
}

/// Both pavings over two parameters.
pub(super) fn projected(fit: &Fit, projection: &FitProjection) -> String {
    let pair = projection.parameters.map(|index| &fit.parameters[index]);
    let axis = |own: &FitParameter, side: usize| {
        let ends = projection.outer.iter().flat_map(|cell| [cell[2 * side], cell[2 * side + 1]]);
        Axis::fit(ends, ShownUnit::of(&own.display, &own.unit), 5, 0.08, 0.0)
    };
    let (x, y) = (axis(pair[0], 0), axis(pair[1], 1));
    let panel = framed("fit-set", SQUARE, label_width(&y) + 44.0, &x, &y);
    let cells = |cells: &[[f64; 4]], color: usize, name: &str| {
        let cell = |all: Group, ends: &[f64; 4]| {
            let (from, to) = (panel.place(ends[0], ends[3]), panel.place(ends[1], ends[2]));
            let area = Rectangle::new().set("class", "area").set("x", px(from.0)).set("y", px(from.1));
            all.add(area.set("width", px(to.0 - from.0)).set("height", px(to.1 - from.1)))
        };
        let all = cells.iter().fold(group("cells").add(Title::new(name)), cell);
        Hue::Color(Color::of(color)).paint(all, "cells")
    };
    let estimate = panel.place(pair[0].estimate, pair[1].estimate);
    let estimate = Circle::new().set("class", "hollow").set("cx", px(estimate.0)).set("cy", px(estimate.1)).set("r", 4);
    let series = [
        cells(&projection.outer, 1, "outer paving"),
        cells(&projection.inner, 0, "inner paving"),
        Hue::Ink.paint(group("mark").add(Title::new("least squares")).add(estimate), "mark"),
    ];
    let names = pair.map(|own| shortened(&own.name, 30));
    let title = format!("{}: {} and {}", shortened(&fit.model, 40), names[0], names[1]);
    let note = "shadows of the consistent set: blue inner, orange outer paving";
    let figure = document(SQUARE, &title)
        .add(heading(&title, (12.0, 16.0)))
        .add(text(note, (12.0, 38.0), Anchor::Start))
        .add(panel.framed(&title, &y.title(&names[1]), series))
        .add(panel.time_axis(&names[0]));
    finished(&figure)
}

fn framed<'a>(id: &str, size: (f64, f64), left: f64, x: &'a Axis, y: &'a Axis) -> Panel<'a> {
    Panel { id: id.to_owned(), left, right: size.0 - RIGHT, top: TOP, bottom: size.1 - BOTTOM, x, y }
}
