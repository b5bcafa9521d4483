//! Effects, which move bodies.
//!
//! To add one: its file here, and its line in the registry below. All else follows from the file: keys, schema,
//! documentation, its references, its forces, its cost.

mod forces;
mod laws;
mod registry;

use schemars::JsonSchema;
use symdiff::Formula;

pub(super) use self::contact::course::{ContactLine, Points};
pub use self::contact::hull::faces_of_hull;
pub(super) use self::contact::solid::{check_ends, check_lengths};
pub use self::forces::Forces;
pub use self::laws::dry_friction::{DryFriction, Friction, FrictionAlong};
pub use self::laws::impact::Impact;
pub use self::laws::impact::{Exponent, RestitutionLaw};
use self::registry::effects;
pub use self::superelement::carried::Carried;
use self::superelement::matrices::Matrices;
use crate::elements::{Glyph, SurfaceAt, Surroundings};
use crate::grammar::quantity::Dimension;
use crate::grammar::{Element, ElementDocs, Node, OnJoint, PointRef, Reader, Sensor, SymbolTable};
use crate::multibody::BuildError;

effects! {
    gravity::Gravity,
    force::Force,
    torque::Torque,
    spring_damper::SpringDamper,
    torsional_spring_damper::TorsionalSpringDamper,
    bushing::Bushing,
    joint_friction::JointFriction,
    tooth_friction::ToothFriction,
    stop::Stop,
    contact::Contact,
    clearance_joint::ClearanceJoint,
    servo::Servo,
    drag::Drag,
    cable::Cable,
    backlash::Backlash,
    preload::Preload,
    beam::Beam,
    belt::Belt,
    state::State,
    pid::Pid,
    dc_motor::DcMotor,
    filter::Filter,
    delay::Delay,
    sampled::Sampled,
    rate_limit::RateLimit,
    hydraulic_cylinder::HydraulicCylinder,
    gas_spring::GasSpring,
    tyre::Tyre,
    superelement::Superelement,
}

/// A sensor of an effect, with its description.
pub type TypedSensor = (Sensor, Dimension);

/// A kind of effect: its sensors, its forces and its properties.
pub trait ForceElement: Element {
    /// Sensors; its own formulas may refer to those that follow from the motion.
    const SENSORS: &'static [TypedSensor];

    /// Adds its forces to a mechanism.
    ///
    /// # Errors
    /// A formula with a name that cannot stand in it; the reader of model files lets none through.
    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError>;

    /// Sensors.
    fn sensors(&self) -> Vec<TypedSensor> {
        Self::SENSORS.to_vec()
    }

    /// Whether it only resists: it sets nothing at rest in motion.
    const RESISTS: bool = false;

    /// Its symbol in drawings, at the points, bodies and joints that it names.
    const GLYPH: Glyph = Glyph::Nothing;

    /// A direction that a drawing shows, in the ground's axes.
    fn direction(&self) -> Option<&[Formula; 3]> {
        None
    }

    /// Surfaces that it has at points of bodies, for pictures.
    fn surfaces(&self, _: Surroundings) -> Vec<SurfaceAt> {
        Vec::new()
    }

    /// Coordinates of joints that it acts on.
    fn coordinates(&self) -> Vec<OnJoint> {
        Vec::new()
    }

    /// Bodies and joints that it acts on.
    const SCOPE: Scope = Scope::Named;

    /// The mass between two points that it adds to the mechanism.
    fn inertia(&self) -> Option<LineMass<'_>> {
        None
    }

    /// The mass matrix by nodes and modes that it adds to the mechanism.
    fn reduced_inertia(&self) -> Option<ReducedInertia<'_>> {
        None
    }

    /// The joint whose reaction its force grows with, and the factor.
    fn loading_joint(&self) -> Option<(usize, &Formula)> {
        None
    }

    /// The states that it brings; [`Forces::state_rate`] says how they change.
    fn states(&self) -> Vec<StateVariable<'_>> {
        Vec::new()
    }

    /// Whether its name alone stands for a state, known before it is read: the dimension, as far as that is known by
    /// then. Nothing is reported.
    fn value_ahead<S: SymbolTable>(_reader: &mut Reader<'_, S>, _mapping: &Node) -> Option<Option<Dimension>> {
        None
    }
}

/// A state of an effect.
#[derive(Clone, Copy, Debug)]
pub struct StateVariable<'a> {
    /// Sensor by which formulas know it.
    pub sensor: Sensor,
    /// Its value at the start, of parameters.
    pub initial: &'a Formula,
    /// Time between the instants at which it changes, s; `None` if it changes at a rate.
    pub period: Option<f64>,
}

/// Objects that an effect acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The bodies and joints that it names.
    Named,
    /// The bodies that it names, on ground across the model's z, or with a `wheel` in the plane across its y.
    LevelGround,
    /// Every body, without connecting them.
    EveryBody,
}

/// Mass along the line between two points of bodies, which bends with them.
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
    /// In space: stiffness of its sections, which determines their inertia of rotation.
    pub section: Option<Section<'a>>,
}

/// Inertia by a mass matrix, of nodes and modes.
#[derive(Clone, Copy, Debug)]
pub struct ReducedInertia<'a> {
    /// The frames at its nodes.
    pub nodes: &'a [PointRef],
    /// The matrices, and where the nodes are at rest.
    pub matrices: &'a Matrices,
    /// Factor of the mass matrix.
    pub factor: &'a Formula,
}

/// Stiffness of a section: of one material, its radii of gyration are √(EI/EA).
#[derive(Clone, Copy, Debug)]
pub struct Section<'a> {
    /// EA, N
    pub axial_stiffness: &'a Formula,
    /// EI about y and z, N m²
    pub bending_stiffness: [&'a Formula; 2],
}

/// Sensor of the force or torque on a joint's coordinate.
fn effort(on: OnJoint) -> TypedSensor {
    let [_, _, dimension] = crate::grammar::motions::dimensions_of(on.coordinate);
    (Sensor::of_effort(on.coordinate), dimension)
}

/// The documentation of an effect.
fn with_sensors<E: ForceElement>() -> ElementDocs {
    let sensors = E::SENSORS.iter().map(|(measure, dimension)| (measure.name(), dimension.unit())).collect();
    ElementDocs { sensors, ..ElementDocs::of::<E>() }
}
