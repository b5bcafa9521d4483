//! The declared mechanism, which copies of a description share.

use std::collections::{BTreeMap, BTreeSet};

use super::index::NameIndex;
use super::{BlackBox, Body, Effect, FlexibleBeam, Instance, Joint, RobotTree, Space, StartValue};
use crate::elements::Trajectory;

/// Bodies, joints and effects as the file declares them, with their start: all of a model that a study does not vary.
///
/// Formulas refer to parameters by name, of which [`Description`](super::Description) has the values.
#[derive(Clone, Debug)]
pub struct DeclaredMechanism {
    /// Whether the mechanism stays in the plane.
    pub space: Space,
    /// The tree of a URDF, where the model names one.
    pub robot: Option<RobotTree>,
    /// `bodies[0]` is the ground: no coordinates, no mass, perhaps points.
    pub bodies: Vec<Body>,
    /// Beams, of which the nodes are bodies and the elements effects.
    pub beams: Vec<FlexibleBeam>,
    /// Joints, in file order.
    pub joints: Vec<Joint>,
    /// Effects, in file order.
    pub effects: Vec<Effect>,
    /// The program that answers instead of a mechanism, if there is one.
    pub black_box: Option<BlackBox>,
    /// Whether the start is an equilibrium, near the start of assembly's search.
    pub starts_at_equilibrium: bool,
    /// Prescribed coordinates and velocities at the start, with their values.
    pub initial: Vec<StartValue>,
    /// Values from which assembly starts its search for the others.
    pub guess: Vec<StartValue>,
    /// Instances of assemblies, and effects on many, of which the parts have dots in their names.
    pub instances: Vec<Instance>,
    /// Ports of instances: the body or the point that each is.
    pub ports: BTreeMap<String, String>,
    /// Effects of instances on joints that turn: their sensors along the joint have the other sign in a mirror.
    pub turning_effects: BTreeSet<String>,
    /// Effects that are states, or have some.
    pub states: BTreeSet<String>,
    /// Functions of the time by their points.
    pub trajectories: Vec<Trajectory>,
    /// Indices of bodies by name.
    pub body_index: NameIndex,
    /// Indices of joints by name.
    pub joint_index: NameIndex,
}

impl DeclaredMechanism {
    /// A planar mechanism without parts.
    pub(super) fn empty() -> Self {
        Self {
            space: Space { spatial: false, why: String::new() },
            robot: None,
            bodies: Vec::new(),
            beams: Vec::new(),
            joints: Vec::new(),
            effects: Vec::new(),
            black_box: None,
            starts_at_equilibrium: false,
            initial: Vec::new(),
            guess: Vec::new(),
            instances: Vec::new(),
            ports: BTreeMap::new(),
            turning_effects: BTreeSet::new(),
            states: BTreeSet::new(),
            trajectories: Vec::new(),
            body_index: NameIndex::default(),
            joint_index: NameIndex::default(),
        }
    }
}
