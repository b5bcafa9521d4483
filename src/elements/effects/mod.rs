//! Effects: what moves bodies.
//!
//! To add one: its file here, its forces in the file of the same name in `assemble::effects`, and its line in the registry. All else
//! follows from the file: keys, schema, documentation, what it refers to, what it costs.

mod dry_friction;
mod impact;
mod registry;

use schemars::JsonSchema;
use symdiff::Formula;

pub use self::dry_friction::{DryFriction, Friction};
pub use self::impact::{Exponent, Impact, RestitutionLaw};
use self::registry::effects;
pub(crate) use self::registry::registry;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Element, ElementDocs, Measure, OnJoint, PointRef};

registry!(effects);

/// Something that an effect measures, and what it is.
pub type Sensor = (Measure, Dimension);

/// What an effect does beside its forces.
pub trait ForceElement: Element {
    /// What it may measure; its own formulas may refer to what of this follows from the motion.
    const SENSORS: &'static [Sensor];

    /// What it measures.
    fn sensors(&self) -> Vec<Sensor> {
        Self::SENSORS.to_vec()
    }

    /// Coordinates of joints that it acts on.
    fn coordinates(&self) -> Vec<OnJoint> {
        Vec::new()
    }

    /// What it acts on.
    fn scope(&self) -> Scope {
        Scope::Named
    }

    /// The mass between two points that it adds to the mechanism.
    fn inertia(&self) -> Option<LineMass<'_>> {
        None
    }

    /// The joint whose reaction its force grows with, and the factor.
    fn loading_joint(&self) -> Option<(usize, &Formula)> {
        None
    }
}

/// What an effect acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The bodies and joints that it names.
    Named,
    /// Every body, without connecting them.
    EveryBody,
}

/// Mass along the line between two points of bodies of the plane, which bends with them.
#[derive(Clone, Copy, Debug)]
pub struct LineMass<'a> {
    /// The flexible body that it is a part of.
    pub body: &'a str,
    /// Its ends.
    pub between: [PointRef; 2],
    /// The straight line's direction in both bodies' frames.
    pub axis: &'a [Formula; 3],
    /// m
    pub length: &'a Formula,
    /// kg/m
    pub mass_per_length: &'a Formula,
}

/// What pushes a joint's coordinate.
fn effort(on: OnJoint) -> Sensor {
    let [_, _, dimension] = crate::grammar::motions::dimensions_of(on.coordinate);
    (Measure::of_effort(on.coordinate), dimension)
}

/// What people are told of an effect.
fn with_sensors<E: ForceElement>() -> ElementDocs {
    let sensors = E::SENSORS.iter().map(|(measure, dimension)| (measure.name(), dimension.unit())).collect();
    ElementDocs { sensors, ..ElementDocs::of::<E>() }
}
