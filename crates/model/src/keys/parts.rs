//! Assemblies, their instances, and repetition.

use indexmap::IndexMap;
use schemars::JsonSchema;

use super::*;
use crate::elements::JointKind;
use crate::elements::effects::{EffectKind, State};
use crate::grammar::mapping::schema_only;

grammar! {
    /// A mechanism that a model has as often as it has instances of it. It sees its own names only.
    Assembly is "an assembly" {
        /// One line for people.
        description: Option<String>,
        /// Its parameters with the default values of instances. Each instance has its own: uncertain values deviate in
        /// each by themselves.
        parameters: Option<IndexMap<String, ParameterFile>>,
        /// Parameters that are one for all instances, as are their deviations; or `all`.
        shared: Option<SharedFile>,
        /// Its bodies. `ground` is the model's, or where the instance is placed; it may be given points.
        bodies: Option<IndexMap<String, Body>>,
        /// Joints, which constrain its bodies.
        joints: Option<IndexMap<String, JointKind>>,
        /// Effects, which move its bodies.
        effects: Option<IndexMap<String, EffectKind>>,
        /// Numbers of its own that change as formulas say.
        states: Option<IndexMap<String, State>>,
        /// Coordinates and velocities at the start.
        initial: Option<IndexMap<String, StartFile>>,
        /// Coordinates from which assembly starts its search.
        guess: Option<IndexMap<String, StartFile>>,
        /// Bodies and points by which others hold it: `hub: upright.hub`.
        ports: Option<IndexMap<String, PortFile>>,
        /// Instances of other assemblies within it.
        instances: Option<IndexMap<String, InstanceFile>>,
    }

    /// A file of assemblies that models include.
    Part is "an included file" {
        /// One line for people.
        description: Option<String>,
        /// Other files, from this one's folder.
        include: Option<IncludeFile>,
        /// Mechanisms that models have instances of.
        assemblies: Option<IndexMap<String, Assembly>>,
    }

    /// A copy of an assembly. Its parts are called after it: `front_left.upright`.
    InstanceFile is "an instance" {
        /// The assembly.
        of: String,
        /// Where the assembly's ground is, and where its bodies start: a position, or a frame, in that of the instance
        /// around it. Its numbers are parameters, `front_left.at.x`.
        at: Option<AtFile>,
        /// The axis across which it is mirrored, before it is placed.
        mirror: Option<AxisName>,
        /// Parameters that are not as the assembly says, in its units.
        parameters: Option<IndexMap<String, ParameterFile>>,
    }

    /// Where an instance is.
    PlaceFile is "`at`" {
        /// Position of the assembly's origin, m.
        position: Option<Components>,
        /// Angle about z, rad.
        angle: Option<Number>,
        /// Rotation, in space; that about z is the same as `angle`.
        rotation: Option<Rotation>,
    }

    /// A point of a body by which others hold an assembly.
    PointPort is "a port" {
        /// The body.
        on: String,
        /// Position in the body's frame, m; by default its origin.
        position: Option<Components>,
        /// Rotation of the frame at the port against the body's; by default none.
        rotation: Option<Rotation>,
    }
}

schema_only! {
    /// Names of parameters, or `all`.
    #[schemars(untagged, inline)]
    pub enum SharedFile {
        All(AllName),
        Some(Vec<String>),
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum AllName {
        /// Every parameter.
        All,
    }

    /// A position, or a frame.
    #[schemars(untagged, inline)]
    pub enum AtFile {
        Position(Components),
        Frame(Box<PlaceFile>),
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum AxisName {
        X,
        Y,
        Z,
    }

    /// `body`, `body.point`, or a point of its own.
    #[schemars(untagged, inline)]
    pub enum PortFile {
        Name(String),
        Point(Box<PointPort>),
    }

    /// One file, or several.
    #[schemars(untagged, inline)]
    pub enum IncludeFile {
        One(String),
        Several(Vec<String>),
    }
}
