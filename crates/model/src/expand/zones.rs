//! `zones:`, and zones of points: parameters in [-1, 1], and formulas of them that lie in the zone.
//!
//! Polar coordinates take the square onto the disc and the cube onto the ball, so that surrogates of boxes serve zones.
//! The nominal radius is 0, an end of its interval: at the middle of the box every angle acts alone, as grids that grow
//! axis by axis need it.

use super::sections::entries_of;
use crate::grammar::report::{Fields, Report};
use crate::keys;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// Deviations that lie in a set together: one cause.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    /// Its name; of a point's zone `BODY_POINT`.
    pub name: String,
    /// The parameters in [-1, 1].
    pub members: Vec<String>,
    /// The set that they are mapped onto.
    pub shape: ZoneShape,
    /// How deviations are distributed in it.
    pub law: ZoneLaw,
    /// The body and the point that it belongs to, if it does.
    pub point: Option<(String, String)>,
    /// Where it stands.
    pub at: Span,
}

impl Zone {
    /// Indices of its parameters in [-1, 1] among these names.
    pub fn indices(&self, names: &[impl AsRef<str>]) -> Vec<usize> {
        let index = |member: &String| names.iter().position(|name| name.as_ref() == member);
        self.members.iter().filter_map(index).collect()
    }

    /// Whether a parameter is one of the zone's, or a deviation in it.
    pub fn owns(&self, parameter: &str) -> bool {
        parameter.strip_prefix(self.name.as_str()).is_some_and(|rest| rest.starts_with('_'))
    }
}

/// Shapes that parameters in [-1, 1] are mapped onto.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZoneShape {
    /// Discs, each by two of the parameters: a radius from 0 on, and an angle in half turns.
    Discs,
    /// A ball, by three: a radius from 0 on, an elevation in quarter turns and an angle in half turns.
    Ball,
    /// The box itself, or a linear map of it.
    Box,
}

/// How deviations are distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZoneLaw {
    /// Evenly over the set.
    Uniform,
    /// Normal in every direction, three standard deviations to the edge.
    RadialNormal,
}

const LAWS: [(&str, ZoneLaw); 2] = [("uniform", ZoneLaw::Uniform), ("radial_normal", ZoneLaw::RadialNormal)];

/// Names of kinds; exactly one is given.
const KINDS: [&str; 6] = ["disc", "sphere", "cylinder", "flatness", "parallelism", "ellipsoid"];

/// Entries and zones that are written out.
#[derive(Default)]
struct Written {
    /// Entries of `parameters`.
    parameters: Vec<Entry>,
    zones: Vec<Zone>,
}

/// The model's tree with its zones written out as parameters, and the zones.
pub fn write_out(report: &mut Report, root: Node) -> (Node, Vec<Zone>) {
    let Value::Mapping(sections) = &root.value else { return (root, Vec::new()) };
    let mut written = Written::default();
    if let Some(section) = sections.iter().find(|entry| entry.key == "zones") {
        for entry in report.entries(&section.value, "zones") {
            zone(report, entry, &entry.key, &mut written);
        }
    }
    let mut sections: Vec<Entry> = sections.iter().filter(|entry| entry.key != "zones").cloned().collect();
    if let Some(bodies) = sections.iter_mut().find(|entry| entry.key == "bodies") {
        points_of_bodies(report, &mut bodies.value, &mut written);
    }
    let Some(at) = written.parameters.first().map(|first| first.key_span.clone()) else {
        return (with(&root, sections), Vec::new());
    };
    if let Some(entries) = entries_of(&mut sections, "parameters", &at) {
        for entry in written.parameters {
            if entries.iter().any(|known| known.key == entry.key) {
                let message = format!("`{}` is a parameter, and a deviation of a zone as well", clip(&entry.key));
                report.error(Code::NameTaken, entry.key_span, message, "give the zone another name".to_owned());
            } else {
                entries.push(entry);
            }
        }
    }
    (with(&root, sections), written.zones)
}

fn with(root: &Node, sections: Vec<Entry>) -> Node {
    Node { span: root.span.clone(), value: Value::Mapping(sections) }
}

/// Zones of points: the point's position is moved by them.
fn points_of_bodies(report: &mut Report, bodies: &mut Node, written: &mut Written) {
    let Value::Mapping(bodies) = &mut bodies.value else { return };
    for body in bodies {
        let Value::Mapping(keys) = &mut body.value.value else { continue };
        let Some(points) = keys.iter_mut().find(|entry| entry.key == "points") else { continue };
        let Value::Mapping(points) = &mut points.value.value else { continue };
        for point in points {
            let Value::Mapping(keys) = &mut point.value.value else { continue };
            let Some(index) = keys.iter().position(|entry| entry.key == "zone") else { continue };
            let own = keys.remove(index);
            let at = own.key_span.clone();
            if body.key.contains('.') {
                let help = "give it in `zones`, and add its deviations to the position".to_owned();
                report.error(Code::BadZone, at, "points of assemblies have no zones", help);
                continue;
            }
            let name = format!("{}_{}", body.key, point.key);
            let Some(axes) = zone(report, &own, &name, written) else { continue };
            if let Some(zone) = written.zones.last_mut() {
                zone.point = Some((body.key.clone(), point.key.clone()));
            }
            if axes[0] != "x" {
                report.error(Code::BadZone, at, "the zone of a point is a `disc` or a `sphere`", None);
                continue;
            }
            move_position(report, keys, &name, &axes, at);
        }
    }
}

/// Adds deviations to the components of a position.
fn move_position(report: &mut Report, keys: &mut Vec<Entry>, name: &str, axes: &[&'static str], at: Span) {
    let deviation = |axis: &str| Scalar::plain(format!("{name}_{axis}"), None);
    let Some(position) = keys.iter_mut().find(|entry| entry.key == "position") else {
        let zero = |axis: &&'static str| Node { span: at.clone(), value: Value::Scalar(deviation(axis)) };
        let value = Node { span: at.clone(), value: Value::Sequence(axes.iter().map(zero).collect()) };
        keys.push(Entry { key: "position".to_owned(), key_span: at, value });
        return;
    };
    let Value::Sequence(components) = &mut position.value.value else {
        let help = "write `position: [x, y]`".to_owned();
        report.error(Code::BadZone, position.value.span.clone(), "the position of a point with a zone is a list", help);
        return;
    };
    for (component, axis) in components.iter_mut().zip(axes) {
        if let Value::Scalar(scalar) = &mut component.value {
            let text = format!("({}) + {name}_{axis}", scalar.text);
            *scalar = Scalar { text, start: None, ..scalar.clone() };
        }
    }
}

/// Reads a zone, and writes its parameters; returns the ends of its deviations' names.
fn zone(report: &mut Report, entry: &Entry, name: &str, written: &mut Written) -> Option<Vec<&'static str>> {
    let fields = report.fields::<keys::ZoneFile>(&entry.value, entry.key_span.clone())?;
    let given: Vec<&str> = KINDS.into_iter().filter(|kind| fields.get(kind).is_some()).collect();
    let [kind] = given[..] else {
        let message = format!("`{}` is not one kind of zone", clip(name));
        let help = "give one of `disc`, `sphere`, `cylinder`, `flatness`, `parallelism` and `ellipsoid`".to_owned();
        report.error(Code::BadZone, entry.key_span.clone(), message, help);
        return None;
    };
    let law = match fields.get("distribution") {
        Some(node) => report.choice(node, &LAWS)?,
        None => ZoneLaw::Uniform,
    };
    if law == ZoneLaw::RadialNormal && matches!(kind, "flatness" | "parallelism") {
        let message = format!("`{kind}` has no radius to be normal along");
        report.error(
            Code::BadZone,
            fields.key_span("distribution"),
            message,
            "leave it out: it is uniform then".to_owned(),
        );
        return None;
    }
    if let Some(node) = fields.get("correlation").filter(|_| kind != "ellipsoid") {
        report.error(
            Code::BadZone,
            node.span.clone(),
            "a `correlation` inclines an ellipse",
            "leave it out".to_owned(),
        );
        return None;
    }
    let mut writer = Writer { name, at: entry.key_span.clone(), written };
    let node = fields.get(kind)?;
    let (shape, axes) = match kind {
        "ellipsoid" => (ellipsoid(report, &fields, node, &mut writer)?, Vec::new()),
        _ => {
            let scalar = report.scalar(node, "a length")?;
            writer.of_diameter(kind, format!("({})/2", scalar.text), &node.span)
        }
    };
    let members = writer.members(shape, kind);
    written.zones.push(Zone { name: name.to_owned(), members, shape, law, point: None, at: entry.key_span.clone() });
    Some(axes)
}

/// Writes parameters of one zone.
struct Writer<'w> {
    name: &'w str,
    at: Span,
    written: &'w mut Written,
}

/// The parameter that is half of a zone's diameter.
pub const RADIUS: &str = "radius";

/// Letters of the parameters in [-1, 1].
const LETTERS: [&str; 4] = ["u", "v", "w", "s"];

impl Writer<'_> {
    /// Names of the first `count` parameters in [-1, 1].
    fn hidden(&self, count: usize) -> Vec<String> {
        LETTERS[..count].iter().map(|letter| format!("{}_{letter}", self.name)).collect()
    }

    /// Writes the parameters in [-1, 1]; returns their names.
    fn members(&mut self, shape: ZoneShape, kind: &str) -> Vec<String> {
        let count = match (shape, kind) {
            (_, "cylinder") => 4,
            (_, "flatness") => 1,
            (ZoneShape::Ball, _) => 3,
            _ => 2,
        };
        let names = self.hidden(count);
        for (index, name) in names.iter().enumerate() {
            let number = |text: &str| Node { span: self.at.clone(), value: Value::Scalar(Scalar::plain(text, None)) };
            let ends = Node { span: self.at.clone(), value: Value::Sequence(vec![number("-1"), number("1")]) };
            let key = |key: &str, value: Node| Entry { key: key.to_owned(), key_span: self.at.clone(), value };
            let is_radius = shape != ZoneShape::Box && (index == 0 || shape == ZoneShape::Discs && index == 2);
            let nominal = number(if is_radius { "-1" } else { "0" });
            let keys = vec![key("value", nominal), key("interval", ends)];
            let value = Node { span: self.at.clone(), value: Value::Mapping(keys) };
            self.written.parameters.push(Entry { key: name.clone(), key_span: self.at.clone(), value });
        }
        names
    }

    /// Writes a deviation as a formula.
    fn deviation(&mut self, axis: &str, formula: String, at: &Span) {
        let value = Node { span: at.clone(), value: Value::Scalar(Scalar::plain(formula, None)) };
        let key = format!("{}_{axis}", self.name);
        self.written.parameters.push(Entry { key, key_span: self.at.clone(), value });
    }

    /// A zone of a size: its shape, and the ends of its deviations' names.
    fn of_diameter(&mut self, kind: &str, radius: String, at: &Span) -> (ZoneShape, Vec<&'static str>) {
        let hidden = self.hidden(4);
        let [u, v, w, s] = [0, 1, 2, 3].map(|index| hidden[index].clone());
        let (shape, axes, formulas): (ZoneShape, Vec<&'static str>, Vec<String>) = match kind {
            "disc" => (ZoneShape::Discs, vec!["x", "y"], disc(&u, &v).to_vec()),
            "cylinder" => {
                let axes = vec!["start_x", "start_y", "end_x", "end_y"];
                (ZoneShape::Discs, axes, [disc(&u, &v), disc(&w, &s)].concat())
            }
            "sphere" => (ZoneShape::Ball, vec!["x", "y", "z"], ball(&u, &v, &w).to_vec()),
            "flatness" => (ZoneShape::Box, vec!["z"], vec![u]),
            // The square turned by 45 degrees.
            _ => (ZoneShape::Box, vec!["edge_x", "edge_y"], vec![format!("({u} + {v})/2"), format!("({u} - {v})/2")]),
        };
        self.deviation(RADIUS, radius, at);
        for (axis, formula) in axes.iter().zip(formulas) {
            self.deviation(axis, format!("{}_{RADIUS}*({formula})", self.name), at);
        }
        (shape, axes)
    }
}

/// The disc of radius 1, by a radius and a turn. It begins where neither coordinate is 0, nor their sum or difference:
/// a coordinate that is 0 at the first nodes of a grid is not examined again.
fn disc(u: &str, v: &str) -> [String; 2] {
    [format!("(1 + {u})/2*cos(pi*{v} + 1)"), format!("(1 + {u})/2*sin(pi*{v} + 1)")]
}

/// The ball of radius 1: a radius, an elevation from the plane of x and y, and a turn about z.
fn ball(u: &str, v: &str, w: &str) -> [String; 3] {
    let across = format!("(1 + {u})/2*cos(pi/2*{v})");
    [format!("{across}*cos(pi*{w} + 1)"), format!("{across}*sin(pi*{w} + 1)"), format!("(1 + {u})/2*sin(pi/2*{v})")]
}

/// Deviations in an ellipse or an ellipsoid, by their names.
fn ellipsoid(report: &mut Report, fields: &Fields, node: &Node, writer: &mut Writer) -> Option<ZoneShape> {
    let entries = report.entries(node, "semi-axes");
    let correlation = match fields.get("correlation") {
        None => None,
        Some(own) => {
            let scalar = report.scalar(own, "a number from -1 to 1")?;
            let value: Option<f64> = scalar.text.trim().parse().ok().filter(|value: &f64| value.abs() < 1.0);
            if value.is_none() || entries.len() != 2 {
                let help = "a number above -1 and below 1, of two deviations".to_owned();
                report.error(
                    Code::BadZone,
                    own.span.clone(),
                    format!("`{}` is no correlation of an ellipse", clip(&scalar.text)),
                    help,
                );
                return None;
            }
            value
        }
    };
    let hidden = writer.hidden(3);
    let (shape, unit) = match entries.len() {
        2 => (ZoneShape::Discs, disc(&hidden[0], &hidden[1]).to_vec()),
        3 => (ZoneShape::Ball, ball(&hidden[0], &hidden[1], &hidden[2]).to_vec()),
        count => {
            let help = "for more, a law of distribution with correlations says how likely they are".to_owned();
            report.error(
                Code::BadZone,
                node.span.clone(),
                format!("an ellipsoid has two or three semi-axes, not {count}"),
                help,
            );
            return None;
        }
    };
    for (index, entry) in entries.iter().enumerate() {
        let scalar = report.scalar(&entry.value, "a semi-axis")?;
        let along = match (index, correlation) {
            (1, Some(own)) => format!("{own}*{} + {}*{}", unit[0], (1.0 - own * own).sqrt(), unit[1]),
            _ => unit[index].clone(),
        };
        writer.deviation(&entry.key, format!("({})*({along})", scalar.text), &entry.value.span);
    }
    Some(shape)
}
