//! A mechanism as an SVG document: in the plane in its true shape, in space from three quarters and along the three
//! axes.

mod body;
mod glyph;
mod hull;
mod label;
mod solid;
mod view;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use svg::Document;
use svg::node::element::{Group, Style, Text, Title};

use self::glyph::{across, arrow, glyph, hatching, head, line, px};
pub(super) use self::hull::flat_hull;
use self::label::Labels;
use self::view::{PLANE, Projection, Px, SPACE, View};
use super::error::ExportError;
use super::folder::AtomicFiles;
use super::tuning::TUNING;
use crate::elements::Glyph;
use crate::results::{Drawing, DrawnBody, DrawnLength};

/// Colours that the colour-blind distinguish (Okabe and Ito, 2008), and their meaning; dark if the reader's system is.
const STYLE: &str = "
svg { background: #fff; font-family: sans-serif; fill: #222; }
.body { fill-opacity: 0.25; stroke-width: 2; stroke-linejoin: round; stroke-linecap: round; }
.body .bar { stroke-width: 9; stroke-opacity: 0.45; }
.color0 { fill: #0072b2; stroke: #0072b2; } .color1 { fill: #e69f00; stroke: #e69f00; }
.color2 { fill: #009e73; stroke: #009e73; } .color3 { fill: #d55e00; stroke: #d55e00; }
.color4 { fill: #cc79a7; stroke: #cc79a7; } .color5 { fill: #56b4e9; stroke: #56b4e9; }
.still { fill: #666; stroke: #666; stroke-width: 1.5; }
.body .rim, .body .wall { fill: none; } .body .thin { stroke-width: 1; } .body .fill { stroke: none; } .body .hatch { stroke-width: 1; }
.body .center { fill-opacity: 1; stroke-width: 0.5; }
.element { fill: #fff; stroke: #222; stroke-width: 1.5; stroke-linecap: round; stroke-linejoin: round; }
.element .thin, .element .open, .element .teeth { fill: none; }
.element .thin { stroke-width: 1; } .element .teeth { stroke-dasharray: 4 2; } .element .beam { stroke-width: 4; }
.filled { fill: #222; } .ground { stroke: #222; stroke-width: 1; }
.measure { stroke: #a00; fill: #a00; stroke-width: 1; } .measure .filled { fill: #a00; }
.name { paint-order: stroke; stroke: #fff; stroke-width: 3px; font-weight: bold; }
.point { paint-order: stroke; stroke: #fff; stroke-width: 2px; fill: #555; }
@media (prefers-color-scheme: dark) {
svg { background: #111; fill: #eee; } .element { fill: #111; stroke: #eee; } .filled { fill: #eee; } .ground { stroke: #eee; }
.measure { stroke: #f99; fill: #f99; } .measure .filled { fill: #f99; } .name, .point { stroke: #111; } .point { fill: #bbb; }
}";

/// The file.
const NAME: &str = "mechanism.svg";

/// Margin of the drawing, px.
const MARGIN: f64 = 70.0;

/// Writes the picture `mechanism.svg`, and returns its path.
///
/// # Errors
/// If it cannot be written.
pub fn write_drawing(dir: &Path, drawing: &Drawing) -> Result<PathBuf, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add(NAME, drawing_svg(drawing).as_bytes())?;
    files.put_in_place()?;
    Ok(dir.join(NAME))
}

/// A document.
pub(super) fn drawing_svg(drawing: &Drawing) -> String {
    let (projections, largest, columns): (&[Projection], Px, usize) =
        if drawing.spatial { (&SPACE, Px::new(460.0, 400.0), 2) } else { (&PLANE, Px::new(900.0, 700.0), 1) };
    let places = places(drawing);
    // All views have one scale, and are no higher than necessary.
    let scaled = projections.iter().map(|view| view.scale(&places, largest - Px::repeat(2.0 * MARGIN)));
    let scale = scaled.fold(f64::INFINITY, f64::min);
    let heights = projections.iter().map(|view| view.height(&places) * scale);
    let size = Px::new(largest.x, heights.fold(0.0, f64::max) + 2.0 * MARGIN);
    let rows = projections.len() / columns;
    let whole = Px::new(size.x * columns as f64, 40.0 + size.y * rows as f64);
    let what = format!("{}: the mechanism at its start", drawing.model);
    let document = Document::new()
        .set("viewBox", (0, 0, px(whole.x), px(whole.y)))
        .set("width", px(whole.x))
        .set("height", px(whole.y))
        .set("role", "img")
        .add(Title::new(what.clone()))
        .add(Style::new(STYLE))
        .add(text(Px::new(20.0, 26.0), 16.0, &what));
    let panels = projections.iter().enumerate().map(|(index, projection)| {
        let corner = Px::new(size.x * (index % columns) as f64, 40.0 + size.y * (index / columns) as f64);
        panel(drawing, &View::centred(*projection, &places, scale, corner, size), corner, size)
    });
    panels.fold(document, Document::add).to_string() + "\n"
}

/// Points that have to be in view.
fn places(drawing: &Drawing) -> Vec<[f64; 3]> {
    let bodies = drawing.bodies[1..].iter().flat_map(body::places);
    let elements = drawing.elements.iter().filter(|element| element.glyph != Glyph::Nothing);
    let ground = drawing.bodies[0].points.iter().map(|point| point.position);
    let solids = drawing.solids.iter().flat_map(|solid| solid::places(solid, drawing));
    bodies.chain(ground).chain(solids).chain(elements.flat_map(|element| element.ends.iter().copied())).collect()
}

/// The mechanism as one view shows it.
fn panel(drawing: &Drawing, view: &View, corner: Px, size: Px) -> Group {
    let elements = drawing.elements.iter().filter(|element| element.glyph != Glyph::Nothing);
    let grounds = drawing.solids.iter().filter(|solid| solid.body == 0);
    let grounds: Vec<Group> = grounds.filter_map(|solid| solid::solid(solid, drawing, view)).collect();
    let still = (!grounds.is_empty()).then(|| Group::new().set("class", "body still").add_all(grounds));
    let mut group = Group::new().add_all(still);
    for (index, known) in drawing.bodies[1..].iter().enumerate() {
        if let Some(along) = known.guide.and_then(|guide| view.direction(guide)) {
            group = group.add(hatching(view.px(known.position), along));
        }
        group = group.add(body::body(drawing, index + 1, view));
    }
    let mut labels = Labels::default();
    let mut grounded = BTreeSet::new();
    for element in elements.clone().filter(|element| element.glyph != Glyph::Force) {
        for (&end, _) in element.ends.iter().zip(&element.bodies).filter(|(_, body)| **body == 0) {
            let at = view.px(end);
            if grounded.insert([at.x, at.y].map(|side| side.round() as i64)) {
                let slides = matches!(element.glyph, Glyph::Slider | Glyph::Cylinder | Glyph::Screw);
                let along = element.axis.filter(|_| slides).and_then(|axis| view.direction(axis));
                group = group.add(hatching(at, along.unwrap_or_else(|| Px::new(1.0, 0.0))));
            }
        }
    }
    for element in elements {
        group = group.add_all(glyph(element, view));
        let reach = if matches!(element.glyph, Glyph::Torque | Glyph::Motor) { 20.0 } else { 6.0 };
        element.ends.iter().for_each(|&end| labels.occupy(view.px(end), reach));
    }
    for length in &drawing.lengths {
        group = group.add(measure(length, view, &mut labels));
    }
    group = names(drawing, view, group, &mut labels);
    group = group.add(scale_bar(view, corner + Px::new(20.0, size.y - 16.0), size.x / 5.0));
    if let Some(gravity) = drawing.gravity {
        group = group.add_all(gravity_arrow(gravity, view, corner + Px::new(size.x - 60.0, 30.0)));
    }
    if view.title().is_empty() { group } else { group.add(text(corner + Px::new(20.0, 16.0), 12.0, view.title())) }
}

/// Names of bodies, and of points if they are few.
fn names(drawing: &Drawing, view: &View, mut group: Group, labels: &mut Labels) -> Group {
    let points: usize = drawing.bodies.iter().map(|body| body.points.len()).sum();
    if drawing.bodies.len() > TUNING.most_names {
        return group;
    }
    let middle = |body: &DrawnBody| {
        let places = body::places(body);
        places.iter().fold(Px::zeros(), |sum, &place| sum + view.px(place)) / places.len() as f64
    };
    for body in &drawing.bodies[1..] {
        group = group.add_all(labels.beside(middle(body), Px::new(0.0, -1.0), &body.name, 13.0, "name"));
    }
    if points <= TUNING.most_names {
        for body in &drawing.bodies {
            for point in body.points.iter().filter(|point| !point.name.is_empty()) {
                let at = view.px(point.position);
                let away = (at - middle(body)).try_normalize(1.0).unwrap_or_else(|| Px::new(0.7, 0.7));
                group = group.add_all(labels.beside(at, away, &point.name, 10.0, "point"));
            }
        }
    }
    group
}

/// An uncertain length, as drawings give it.
fn measure(length: &DrawnLength, view: &View, labels: &mut Labels) -> Group {
    let [from, to] = length.between.map(|end| view.px(end));
    let group = Group::new().set("class", "measure");
    let Some(along) = (to - from).try_normalize(1.0) else { return group };
    let offset = 26.0 * across(along);
    let (first, second) = (from + offset, to + offset);
    let group = group
        .add(line(from + 0.3 * offset, from + 1.2 * offset))
        .add(line(to + 0.3 * offset, to + 1.2 * offset))
        .add(line(first, second))
        .add(head(first, -along))
        .add(head(second, along));
    let middle = 0.5 * (first + second);
    group.add_all(labels.beside(middle, offset.normalize(), &tolerance(length), 11.0, "point"))
}

/// `l1 = 0.15 m ± 0.0015 m`, or the interval if it is not symmetric.
fn tolerance(length: &DrawnLength) -> String {
    let DrawnLength { parameter, nominal, lower, upper, .. } = length;
    let (below, above) = (nominal - lower, upper - nominal);
    if (above - below).abs() <= 1e-9 * (above + below) {
        return format!("{parameter} = {} m ± {} m", short(*nominal), short(above));
    }
    format!("{parameter} = {} m, {} to {} m", short(*nominal), short(*lower), short(*upper))
}

/// Four digits.
fn short(value: f64) -> String {
    let rounded = format!("{value:.3e}");
    rounded.parse::<f64>().map_or(rounded, |value| value.to_string())
}

fn scale_bar(view: &View, at: Px, wanted: f64) -> Group {
    let length = view.round_length(wanted);
    let end = at + Px::new(view.scale * length, 0.0);
    let tick = Px::new(0.0, 4.0);
    let label = match length {
        length if length < 1e-3 => format!("{} µm", short(1e6 * length)),
        length if length < 1.0 => format!("{} mm", short(1e3 * length)),
        length if length < 1e3 => format!("{} m", short(length)),
        length => format!("{} km", short(1e-3 * length)),
    };
    let bar = Group::new()
        .set("class", "ground")
        .add(line(at, end))
        .add(line(at - tick, at + tick))
        .add(line(end - tick, end + tick));
    Group::new().add(bar).add(text(end + Px::new(8.0, 4.0), 11.0, &label))
}

/// Arrow in the direction of gravity; `None` if it points at the reader.
fn gravity_arrow(gravity: [f64; 3], view: &View, at: Px) -> Option<Group> {
    let along = view.direction(gravity)?;
    let size = gravity.iter().map(|component| component * component).sum::<f64>().sqrt();
    let drawn = arrow(Group::new().set("class", "ground"), at - 16.0 * along, at + 16.0 * along);
    Some(drawn.add(Title::new(format!("gravity, {} m/s²", short(size)))).add(text(at + Px::new(8.0, -6.0), 12.0, "g")))
}

fn text(at: Px, size: f64, text: &str) -> Text {
    Text::new(text).set("x", px(at.x)).set("y", px(at.y)).set("font-size", size).set("stroke", "none")
}

/// Extension of [`Group`].
trait AddAll: Sized {
    /// Adds all nodes.
    fn add_all<N: Into<Box<dyn svg::Node>>>(self, nodes: impl IntoIterator<Item = N>) -> Self;
}

impl AddAll for Group {
    fn add_all<N: Into<Box<dyn svg::Node>>>(self, nodes: impl IntoIterator<Item = N>) -> Self {
        nodes.into_iter().fold(self, |group, node| group.add(node))
    }
}
