//! `beam` among `bodies:`: a flexible body. It becomes bodies without mass, its nodes, and an element with mass
//! between each two.

use crate::grammar::{Coordinate, PointRef};
use symdiff::{Binary, Formula};

use super::description::{Description, Effect};
use crate::elements::effects::Beam;
use crate::elements::effects::beam::Flexible;
use crate::grammar::Direction;
use crate::grammar::names::Context;
use crate::grammar::quantity::Dimension;
use crate::keys;
use crate::model::names::Reader;
use crate::model::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::yaml::{Entry, Value};

/// Keys of rigid bodies that mean nothing here.
const RIGID: [&str; 7] = ["mass", "inertia", "center_of_mass", "coordinates", "held", "points", "shape"];

/// Number of elements of the beam that a body's entry describes; `None` if it describes a rigid body.
pub fn elements(entry: &Entry) -> Option<usize> {
    let find = |value: &Value, key: &str| match value {
        Value::Mapping(fields) => fields.iter().position(|field| field.key == key),
        _ => None,
    };
    let Value::Mapping(fields) = &entry.value.value else { return None };
    let beam = &fields[find(&entry.value.value, "beam")?].value;
    let Value::Mapping(keys) = &beam.value else { return Some(TUNING.beam_elements) };
    let count = find(&beam.value, "elements").and_then(|key| keys[key].value.scalar()?.text.parse().ok());
    Some(count.filter(|count| (1..=TUNING.most_beam_elements).contains(count)).unwrap_or(TUNING.beam_elements))
}

/// Names of the nodes: `rod.start`, `rod.node1`, …, `rod.end`.
pub fn nodes(beam: &str, elements: usize) -> impl Iterator<Item = String> {
    (0..=elements).map(move |node| match node {
        0 => format!("{beam}.start"),
        node if node == elements => format!("{beam}.end"),
        node => format!("{beam}.node{node}"),
    })
}

/// Keys that a beam has in space alone.
const OF_SPACE: [&str; 2] = ["bending_stiffness_y", "torsional_stiffness"];

/// Reads a beam whose nodes were declared as the bodies from `first` on.
pub fn read(reader: &mut Reader, entry: &Entry, first: usize, elements: usize) {
    let spatial = reader.model.space.spatial;
    for node in &mut reader.model.mechanism_mut().bodies[first..=first + elements] {
        node.coordinates = match spatial {
            true => [&[Coordinate::X, Coordinate::Y, Coordinate::Z], &Coordinate::ORIENTATION[..]].concat(),
            false => vec![Coordinate::X, Coordinate::Y, Coordinate::Angle],
        };
    }
    let Some(body) = reader.fields::<keys::Body>(&entry.value, entry.key_span.clone()) else { return };
    for key in RIGID.into_iter().filter(|key| body.get(key).is_some()) {
        let help = "its mass is along it (`mass_per_length`), and its nodes are its points; what is rigid is a body of its own, \
                    joined to a node by `fixed`";
        reader.error(Code::MisplacedKey, body.key_span(key), format!("a beam has no `{key}`"), help.to_owned());
    }
    let (Some(node), at) = (body.get("beam"), body.key_span("beam")) else { return };
    let Some(fields) = reader.fields::<keys::FlexibleBeam>(node, at) else { return };
    if let Some(node) = fields.get("elements") {
        reader.count(node, 1, TUNING.most_beam_elements);
    }
    for key in OF_SPACE.into_iter().filter(|key| !spatial && fields.get(key).is_some()) {
        let help = "in a model with `space: spatial` it bends about y and twists, too".to_owned();
        reader.error(Code::MisplacedKey, fields.key_span(key), format!("a beam of the plane has no `{key}`"), help);
    }
    let positive = |value: f64| value > 0.0;
    let mut needed = |key: &str, dimension: Dimension| {
        let node = reader.required(&fields, key)?;
        reader.formula_that(node, Context::Constant, dimension, positive, "must be positive")
    };
    let of_bending = Dimension::TORQUE.times(Dimension::LENGTH);
    let length = needed("length", Dimension::LENGTH);
    let mass_per_length = needed("mass_per_length", Dimension::MASS.per(Dimension::LENGTH));
    let axial_stiffness = needed("axial_stiffness", Dimension::FORCE);
    let bending_stiffness = needed("bending_stiffness", of_bending);
    let torsional_stiffness = spatial.then(|| needed("torsional_stiffness", of_bending));
    let mut number = |key: &str, dimension: Dimension| {
        let node = fields.get(key)?;
        reader.formula_that(node, Context::Constant, dimension, positive, "must be positive")
    };
    let bending_stiffness_y = number("bending_stiffness_y", of_bending);
    let shear_stiffness = number("shear_stiffness", Dimension::FORCE);
    let damping = match fields.get("damping") {
        Some(node) => {
            let dimension = Dimension::TIME;
            reader.formula_that(node, Context::Constant, dimension, |value| value >= 0.0, "must not be negative")
        }
        None => Some(Formula::number(0.0)),
    };
    let numbers = (length, mass_per_length, axial_stiffness, bending_stiffness, damping);
    let (Some(length), Some(mass), Some(axial_stiffness), Some(bending_stiffness), Some(damping)) = numbers else {
        return;
    };
    let share = Formula::number(1.0 / elements as f64).combined(Binary::Mul, &length);
    for element in 0..elements {
        let node = |node: usize| PointRef { body: first + node, point: None };
        let kind = Beam {
            between: [node(element), node(element + 1)],
            axis: Direction::along(0),
            length: share.clone(),
            axial_stiffness: axial_stiffness.clone(),
            bending_stiffness: bending_stiffness.clone(),
            bending_stiffness_y: bending_stiffness_y.clone(),
            torsional_stiffness: torsional_stiffness.clone().flatten(),
            shear_stiffness: shear_stiffness.clone(),
            damping: damping.clone(),
            flexible: Some(Flexible { body: entry.key.clone(), mass_per_length: mass.clone() }),
        };
        reader
            .model
            .mechanism_mut()
            .effects
            .push(Effect { name: format!("{}.element{}", entry.key, element + 1), kind: kind.into() });
    }
}

impl Description {
    /// Number of elements of a beam; `None` if there is no beam of that name.
    pub(super) fn elements_of(&self, beam: &str) -> Option<usize> {
        self.beams.iter().find(|known| known.name == beam).map(|beam| beam.elements)
    }

    /// Named parts of a beam.
    pub(super) fn named_parts_of_beam(&self, beam: &str) -> Option<String> {
        let elements = self.elements_of(beam)?;
        let inner = match elements {
            1 => String::new(),
            2 => format!(", `{beam}.node1`"),
            _ => format!(", `{beam}.node1` to `{beam}.node{}`", elements - 1),
        };
        Some(format!(
            "its nodes are `{beam}.start`{inner} and `{beam}.end`, its elements `{beam}.element1` to `{beam}.element{elements}`"
        ))
    }
}
