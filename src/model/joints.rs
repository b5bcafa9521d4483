//! `joints:`.

use crate::grammar::{JointCoordinate, PointRef, Referent};
use symdiff::Formula;

use super::description::Joint;
use super::file;
use crate::elements::joints::*;
use crate::grammar::mapping::Grammar;
use crate::grammar::names::Context;
use crate::grammar::quantity::Dimension;
use crate::grammar::reader::{Fields, Written};
use crate::model::names::Reader;
use crate::syntax::yaml::{Entry, Node, Value};

/// Notes the names of the joints, so that outputs can refer to them.
pub fn declare(reader: &mut Reader, entries: &[Entry]) {
    for entry in entries {
        reader.name(entry, "a joint");
        // The kind is put in its place by `read`.
        let kind = Equation { left: Formula::number(0.0), right: Formula::number(0.0) };
        reader.model.joints.push(Joint::new(entry.key.clone(), kind.into()));
    }
}

/// Kinds that speak of other joints.
const COUPLINGS: [&str; 4] = ["gear", "rack", "motor", "equation"];

/// Reads the joints that were declared; what couples joints comes after the joints.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    let couples = |entry: &Entry| match &entry.value.value {
        Value::Mapping(kinds) => kinds.iter().any(|kind| COUPLINGS.contains(&kind.key.as_str())),
        _ => false,
    };
    for coupling in [false, true] {
        for (index, entry) in entries.iter().enumerate().filter(|(_, entry)| couples(entry) == coupling) {
            if let Some(kind) = joint(reader, entry) {
                reader.model.joints[index].kind = kind;
            }
        }
    }
}

/// The details of a joint: a mapping, or a list that is short for `{ between: [a, b] }`.
enum Details<'n> {
    Short(&'n Node),
    Full(Fields<'n>),
}

impl<'n> Details<'n> {
    fn read<G: Grammar>(reader: &mut Reader, entry: &'n Entry) -> Option<Self> {
        reader.fields::<G>(&entry.value, entry.key_span.clone()).map(Self::Full)
    }

    /// Of a joint that needs nothing but what it is between.
    fn read_short<G: Grammar>(reader: &mut Reader, entry: &'n Entry) -> Option<Self> {
        match entry.value.value {
            Value::Sequence(_) => Some(Self::Short(&entry.value)),
            _ => Self::read::<G>(reader, entry),
        }
    }

    fn between(&self, reader: &mut Reader) -> Option<&'n Node> {
        match self {
            Self::Short(node) => Some(node),
            Self::Full(fields) => reader.required(fields, "between"),
        }
    }

    fn required(&self, reader: &mut Reader, key: &str) -> Option<&'n Node> {
        match self {
            Self::Short(_) => None,
            Self::Full(fields) => reader.required(fields, key),
        }
    }

    fn get(&self, key: &str) -> Option<&'n Node> {
        match self {
            Self::Short(_) => None,
            Self::Full(fields) => fields.get(key),
        }
    }
}

fn joint(reader: &mut Reader, entry: &Entry) -> Option<JointKind> {
    let kind = reader.only::<file::Joint>(&entry.value, entry.key_span.clone())?;
    if !reader.model.space.spatial && super::space::SPATIAL_JOINTS.contains(&kind.key.as_str()) {
        reader.leaves_the_plane(&kind.value);
    }
    match kind.key.as_str() {
        "revolute" => {
            let details = Details::read_short::<file::AboutAxis>(reader, kind)?;
            let (between, axis) = (points(reader, &details), axis_or_z(reader, &details, "axis"));
            Some(Revolute { between: between?, axis: axis? }.into())
        }
        "cylindrical" => {
            let details = Details::read_short::<file::AboutAxis>(reader, kind)?;
            let (between, axis) = (points(reader, &details), axis_or_z(reader, &details, "axis"));
            Some(Cylindrical { between: between?, axis: axis? }.into())
        }
        "screw" => {
            let details = Details::read::<file::Screw>(reader, kind)?;
            let (between, axis) = (points(reader, &details), axis_or_z(reader, &details, "axis"));
            let pitch = pitch(reader, &details);
            Some(Screw { between: between?, axis: axis?, pitch: pitch? }.into())
        }
        "spherical" => {
            let details = Details::read_short::<file::Between>(reader, kind)?;
            Some(Spherical { between: points(reader, &details)? }.into())
        }
        "universal" => {
            let details = Details::read_short::<file::Universal>(reader, kind)?;
            let between = points(reader, &details);
            let axes = match details.get("axes") {
                Some(node) => {
                    reader.two(node, "a list of two directions").map(|axes| axes.map(|axis| reader.direction(axis)))
                }
                None => Some([Some(along(0)), Some(along(1))]),
            };
            let [first, second] = axes?;
            Some(Universal { between: between?, axes: [first?, second?] }.into())
        }
        "planar" => {
            let details = Details::read_short::<file::InPlane>(reader, kind)?;
            let (between, normal) = (points(reader, &details), axis_or_z(reader, &details, "normal"));
            Some(Planar { between: between?, normal: normal? }.into())
        }
        "point_on_plane" => {
            let details = Details::read_short::<file::InPlane>(reader, kind)?;
            let (between, normal) = (points(reader, &details), axis_or_z(reader, &details, "normal"));
            Some(PointOnPlane { between: between?, normal: normal? }.into())
        }
        "point_on_line" => {
            let details = Details::read::<file::PinInSlot>(reader, kind)?;
            let (between, axis) = (points(reader, &details), axis(reader, &details));
            Some(PointOnLine { between: between?, axis: axis? }.into())
        }
        "prismatic" => {
            let details = Details::read::<file::Prismatic>(reader, kind)?;
            let (between, axis) = (points(reader, &details), axis(reader, &details));
            let angle = number(reader, &details, "angle", Dimension::ANGLE);
            Some(Prismatic { between: between?, axis: axis?, angle: angle? }.into())
        }
        "fixed" => {
            let details = Details::read_short::<file::Fixed>(reader, kind)?;
            let (between, angle) = (points(reader, &details), number(reader, &details, "angle", Dimension::ANGLE));
            Some(Fixed { between: between?, angle: angle? }.into())
        }
        "pin_in_slot" => {
            let details = Details::read::<file::PinInSlot>(reader, kind)?;
            let (between, axis) = (points(reader, &details), axis(reader, &details));
            Some(PinInSlot { between: between?, axis: axis? }.into())
        }
        "distance" => {
            let details = Details::read::<file::Distance>(reader, kind)?;
            let between = points(reader, &details);
            let length = details.required(reader, "length").and_then(|node| {
                let positive = |value| value > 0.0;
                reader.formula_that(node, Context::Constant, Dimension::LENGTH, positive, "must be positive")
            });
            Some(Distance { between: between?, length: length? }.into())
        }
        "gear" => {
            let details = Details::read::<file::Gear>(reader, kind)?;
            let between = details.between(reader).and_then(|node| reader.turning(node));
            let ratio = ratio(reader, &details, "ratio", Dimension::NUMBER);
            let offset = number(reader, &details, "offset", Dimension::ANGLE);
            Some(Gear { between: between?, ratio: ratio?, offset: offset? }.into())
        }
        "rack" => {
            let details = Details::read::<file::Rack>(reader, kind)?;
            let mut joint = |key: &str, coordinate: JointCoordinate| {
                let node = details.required(reader, key)?;
                reader.joint_ref(node, coordinate)
            };
            let pinion = joint("pinion", JointCoordinate::Angle);
            let rack = joint("rack", JointCoordinate::Displacement);
            let radius = ratio(reader, &details, "radius", Dimension::LENGTH);
            let offset = number(reader, &details, "offset", Dimension::LENGTH);
            Some(Rack { pinion: pinion?, rack: rack?, radius: radius?, offset: offset? }.into())
        }
        "motor" => super::motors::read(reader, &kind.value, kind.key_span.clone()),
        // `only` lets through the kinds of the grammar; this is the last.
        _ => equation(reader, &kind.value),
    }
}

fn points(reader: &mut Reader, details: &Details) -> Option<[PointRef; 2]> {
    details.between(reader).and_then(|node| reader.between_points(node))
}

fn axis(reader: &mut Reader, details: &Details) -> Option<[Formula; 3]> {
    details.required(reader, "axis").and_then(|node| reader.direction(node))
}

/// A turning axis or a normal; z where there is none.
fn axis_or_z(reader: &mut Reader, details: &Details, key: &str) -> Option<[Formula; 3]> {
    match details.get(key) {
        Some(node) if key == "axis" => reader.turning_axis(node),
        Some(node) => reader.direction(node),
        None => Some(along(2)),
    }
}

fn along(axis: usize) -> [Formula; 3] {
    [0, 1, 2].map(|other| Formula::number(f64::from(u8::from(axis == other))))
}

/// A number, or 0.
fn number(reader: &mut Reader, details: &Details, key: &str, dimension: Dimension) -> Option<Formula> {
    match details.get(key) {
        Some(node) => reader.formula(node, Context::Constant, dimension),
        None => Some(Formula::number(0.0)),
    }
}

/// A factor that is not zero.
fn ratio(reader: &mut Reader, details: &Details, key: &str, dimension: Dimension) -> Option<Formula> {
    let node = details.required(reader, key)?;
    reader.formula_that(node, Context::Constant, dimension, |value| value != 0.0, "must not be zero")
}

/// The advance in a turn. `5 mm/rev` is read as a length a radian like any other, and would be taken for that in a turn.
fn pitch(reader: &mut Reader, details: &Details) -> Option<Formula> {
    let node = details.required(reader, "pitch")?;
    let pitch = ratio(reader, details, "pitch", Dimension::LENGTH)?;
    let per_angle = match reader.written(node)? {
        Written::Quantity { unit, .. } => unit.dimension.is_per_angle(),
        Written::Formula(formula) => reader.kind(node, &formula, 0).dimension().is_some_and(Dimension::is_per_angle),
    };
    if per_angle {
        let help = "a pitch is the advance in a turn: write `5 mm` for 5 mm/rev".to_owned();
        reader.error(node.span.clone(), "a length an angle stands where a length (m) belongs", help);
        return None;
    }
    Some(pitch)
}

/// `left = right`.
fn equation(reader: &mut Reader, node: &Node) -> Option<JointKind> {
    let scalar = reader.scalar(node, "an equation")?;
    let text = scalar.text.as_str();
    let Some(equals) = text.find('=') else {
        let help = "write `left = right`, e.g. `crank.angle = omega*t`".to_owned();
        reader.error(node.span.clone(), "an equation has two sides", help);
        return None;
    };
    let mut side = |start: usize, end: usize| {
        let formula = reader.parse(node, scalar, start..end)?;
        reader.check_names(node, &formula, start, Context::Equation).then_some(())?;
        let kind = reader.kind(node, &formula, start);
        Some((formula, kind))
    };
    let left = side(0, equals);
    let right = side(equals + 1, text.len());
    let ((left, left_kind), (right, right_kind)) = (left?, right?);
    if let (Some(a), Some(b)) = (left_kind.dimension(), right_kind.dimension())
        && !a.fits(b)
    {
        reader.error(node.span.clone(), format!("{a} cannot equal {b}"), None);
    }
    let moves = left.names().chain(right.names()).any(|(name, _)| {
        matches!(
            reader.model.referent(name),
            Some(Referent::Coordinate { .. } | Referent::Point { .. } | Referent::JointCoordinate { .. })
        )
    });
    if !moves {
        reader.error(node.span.clone(), "the equation constrains nothing: no coordinate stands in it", None);
    }
    Some(Equation { left, right }.into())
}
