//! `joints:`.

use symdiff::Formula;

use super::description::{Joint, JointKind, Referent};
use super::file::{self, Grammar};
use super::names::Context;
use super::quantity::Dimension;
use super::reader::{Fields, Reader};
use super::yaml::{Entry, Node, Value};

/// Notes the names of the joints, so that outputs can refer to them.
pub fn declare(reader: &mut Reader, entries: &[Entry]) {
    for entry in entries {
        reader.name(entry, "a joint");
        // The kind is put in its place by `read`.
        let kind = JointKind::Equation { left: Formula::number(0.0), right: Formula::number(0.0) };
        reader.model.joints.push(Joint { name: entry.key.clone(), kind });
    }
}

/// Reads the joints that were declared.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    for (index, entry) in entries.iter().enumerate() {
        if let Some(kind) = joint(reader, entry) {
            reader.model.joints[index].kind = kind;
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
        match entry.value.value {
            Value::Sequence(_) if G::KEYS == file::Between::KEYS || G::KEYS == file::Fixed::KEYS => {
                Some(Self::Short(&entry.value))
            }
            _ => reader.fields::<G>(&entry.value, entry.key_span.clone()).map(Self::Full),
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
    match kind.key.as_str() {
        "revolute" => {
            let details = Details::read::<file::Between>(reader, kind)?;
            Some(JointKind::Revolute { between: points(reader, &details)? })
        }
        "prismatic" => {
            let details = Details::read::<file::Prismatic>(reader, kind)?;
            let (between, axis) = (points(reader, &details), axis(reader, &details));
            let angle = angle(reader, &details, "angle");
            Some(JointKind::Prismatic { between: between?, axis: axis?, angle: angle? })
        }
        "fixed" => {
            let details = Details::read::<file::Fixed>(reader, kind)?;
            let (between, angle) = (points(reader, &details), angle(reader, &details, "angle"));
            Some(JointKind::Fixed { between: between?, angle: angle? })
        }
        "pin_in_slot" => {
            let details = Details::read::<file::PinInSlot>(reader, kind)?;
            let (between, axis) = (points(reader, &details), axis(reader, &details));
            Some(JointKind::PinInSlot { between: between?, axis: axis? })
        }
        "distance" => {
            let details = Details::read::<file::Distance>(reader, kind)?;
            let between = points(reader, &details);
            let length = details.required(reader, "length").and_then(|node| {
                let positive = |value| value > 0.0;
                reader.formula_that(node, Context::Constant, Dimension::LENGTH, positive, "must be positive")
            });
            Some(JointKind::Distance { between: between?, length: length? })
        }
        "gear" => {
            let details = Details::read::<file::Gear>(reader, kind)?;
            let between = details.between(reader).and_then(|node| reader.between_bodies(node));
            let ratio = details.required(reader, "ratio").and_then(|node| {
                let turns = |value| value != 0.0;
                reader.formula_that(node, Context::Constant, Dimension::NUMBER, turns, "must not be zero")
            });
            let offset = angle(reader, &details, "offset");
            Some(JointKind::Gear { between: between?, ratio: ratio?, offset: offset? })
        }
        // `only` lets through the kinds of the grammar; this is the last.
        _ => equation(reader, &kind.value),
    }
}

fn points(reader: &mut Reader, details: &Details) -> Option<[super::description::PointRef; 2]> {
    details.between(reader).and_then(|node| reader.between_points(node))
}

fn axis(reader: &mut Reader, details: &Details) -> Option<[Formula; 2]> {
    details.required(reader, "axis").and_then(|node| reader.direction(node))
}

fn angle(reader: &mut Reader, details: &Details, key: &str) -> Option<Formula> {
    match details.get(key) {
        Some(node) => reader.formula(node, Context::Constant, Dimension::ANGLE),
        None => Some(Formula::number(0.0)),
    }
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
        matches!(reader.model.referent(name), Some(Referent::Coordinate { .. } | Referent::Point { .. }))
    });
    if !moves {
        reader.error(node.span.clone(), "the equation constrains nothing: no coordinate stands in it", None);
    }
    Some(JointKind::Equation { left, right })
}
