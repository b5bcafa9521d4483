//! Meanings of names: the parts of a mechanism by their index.

use symdiff::Formula;

use super::friction::{FrictionMode, MeshKind};
use super::quantity::Dimension;
pub use super::sensor::{JointCoordinate, Sensor};

/// The names of a model, which fills the table as it is read. Bodies, joints and effects are numbered in the order of
/// the file; body 0 is the ground.
pub trait SymbolTable {
    /// Whether the mechanism leaves the plane.
    fn is_spatial(&self) -> bool;
    /// Whether bodies and joints are a robot's, whose numbers are parameters.
    fn is_robot(&self) -> bool;
    /// Names of the parameters.
    fn parameters(&self) -> impl Iterator<Item = &str> + Clone;
    /// Names of the bodies.
    fn bodies(&self) -> impl Iterator<Item = &str> + Clone;
    /// Names of a body's points.
    fn points(&self, body: usize) -> impl Iterator<Item = &str> + Clone;
    /// Names of the joints.
    fn joints(&self) -> impl Iterator<Item = &str> + Clone;
    /// Number of effects so far.
    fn effects(&self) -> usize;
    /// The effect with a name.
    fn effect(&self, name: &str) -> Option<usize>;
    /// The effect with a name, if its name alone refers to its value.
    fn state(&self, name: &str) -> Option<usize>;
    /// The trajectory with a name.
    fn trajectory(&self, name: &str) -> Option<usize>;
    /// The dimension of a trajectory's value, if it is known.
    fn trajectory_dimension(&self, trajectory: usize) -> Option<Dimension>;
    /// The highest derivative of an excitation that is known; `None` for other trajectories.
    fn derivatives(&self, trajectory: usize) -> Option<TimeOrder>;
    /// Measures of an effect, with their dimensions.
    fn measures(&self, effect: usize) -> Vec<(Sensor, Dimension)>;
    /// The body or the point that a link of the robot is.
    fn link(&self, name: &str) -> Option<PointRef>;
    /// Names of the parts of a beam, in words; `None` if there is no beam of that name.
    fn parts_of_beam(&self, beam: &str) -> Option<String>;
    /// Whether a body's orientation has Euler parameters instead of an angle about z.
    fn has_orientation(&self, body: usize) -> bool;
    /// Whether a joint has a coordinate.
    fn has_coordinate(&self, joint: usize, coordinate: JointCoordinate) -> bool;
    /// Motions of a joint that friction resists; `None` if friction does not act in it.
    fn friction_mode(&self, joint: usize) -> Option<FrictionMode>;
    /// Kind of friction of a joint's teeth; `None` if it has none.
    fn mesh_kind(&self, joint: usize) -> Option<MeshKind>;
    /// Whether a joint joins two points, so that its reaction has a point of action.
    fn has_place(&self, joint: usize) -> bool;
    /// Whether a joint has an axis of its own, or drives a joint that has one.
    fn has_axis(&self, joint: usize) -> bool;
    /// Whether a joint's reaction has an `axial` part: along its axis, or along a line of its own.
    fn has_axial_force(&self, joint: usize) -> bool;
    /// Left side of a joint that is an equation; `None` for other joints.
    fn equated(&self, joint: usize) -> Option<&Formula>;

    /// The output of a black box with a name.
    fn black_box(&self, name: &str) -> Option<usize>;
    /// The dimension of an output of a black box.
    fn black_box_dimension(&self, output: usize) -> Dimension;
    /// Names of the outputs of a black box.
    fn black_box_outputs(&self) -> impl Iterator<Item = &str> + Clone;

    /// Names of the instances of assemblies, and of effects on many, which have dots in the names of their parts.
    fn instances(&self) -> impl Iterator<Item = &str> + Clone;
    /// Name of the body or the point of a body that a port of an instance is.
    fn port(&self, name: &str) -> Option<&str>;
    /// Whether an effect of an instance is on a joint that turns.
    fn is_on_turning_joint(&self, effect: &str) -> bool;

    /// The parameter with a name.
    fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters().position(|known| known == name)
    }

    /// The body with a name.
    fn body(&self, name: &str) -> Option<usize> {
        self.bodies().position(|known| known == name)
    }

    /// The joint with a name.
    fn joint(&self, name: &str) -> Option<usize> {
        self.joints().position(|known| known == name)
    }

    /// Ports and bodies of an instance, by their names in it.
    fn parts_of(&self, instance: &str) -> Vec<String>;

    /// The name of a joint.
    fn joint_name(&self, joint: usize) -> &str {
        self.joints().nth(joint).unwrap_or_default()
    }

    /// The name of a body.
    fn body_name(&self, body: usize) -> &str {
        self.bodies().nth(body).unwrap_or_default()
    }
}

/// A coordinate of a body's frame. A body turns by its angle or, with all four of them, by its Euler parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Coordinate {
    /// Position of the frame's origin along the ground's x, m.
    X,
    /// Position of the frame's origin along the ground's y, m.
    Y,
    /// Position of the frame's origin along the ground's z, m.
    Z,
    /// Angle of the frame against the ground about z, rad, counter-clockwise, never wrapped.
    Angle,
    /// Euler parameter p0 (cosine of half the angle) to p3.
    Euler(usize),
}

impl Coordinate {
    /// The Euler parameters.
    pub const ORIENTATION: [Self; 4] = [Self::Euler(0), Self::Euler(1), Self::Euler(2), Self::Euler(3)];

    /// Whether it is a length rather than a part of the orientation.
    pub fn is_length(self) -> bool {
        matches!(self, Self::X | Self::Y | Self::Z)
    }
}

/// A point of a body; the frame's origin if `point` is absent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointRef {
    /// Index into the bodies; 0 is the ground.
    pub body: usize,
    /// Index into that body's points.
    pub point: Option<usize>,
}

/// Order of a derivative by time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TimeOrder {
    /// The value.
    Position,
    /// Its first derivative by time.
    Velocity,
    /// Its second derivative by time.
    Acceleration,
}

/// Meaning of a name in a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// Index of the parameter.
    Parameter(usize),
    /// `t`, s.
    Time,
    /// `body.x`, `.y`, `.z`, `.angle`, `.p0` … `.p3`, `.vx`, …, `.angular_velocity`, `.ax`, …, `.angular_acceleration`.
    Coordinate {
        /// Index of the body.
        body: usize,
        /// Which of its coordinates.
        coordinate: Coordinate,
        /// The coordinate itself or a derivative.
        order: TimeOrder,
    },
    /// `body.omega.x`, … and `body.alpha.x`, …, or `omega_body`, `alpha_body` in the body's frame.
    AngularMotion {
        /// Index of the body.
        body: usize,
        /// 0 to 2: x, y, z.
        axis: usize,
        /// Velocity or acceleration.
        order: TimeOrder,
        /// Whether the component is along the body's axis, not the ground's.
        in_body: bool,
    },
    /// `body.roll`, `.pitch`, `.yaw`: rotations about the fixed x, then y, then z, rad, between −π and π.
    RollPitchYaw {
        /// Index of the body.
        body: usize,
        /// 0 to 2: roll, pitch, yaw.
        angle: usize,
    },
    /// `joint.angle`, `.displacement`, `.angular_velocity`, `.velocity`, `.angular_acceleration`, `.acceleration`.
    JointCoordinate {
        /// Index of the joint.
        joint: usize,
        /// Which of its coordinates.
        coordinate: JointCoordinate,
        /// The coordinate itself or a derivative.
        order: TimeOrder,
    },
    /// `body.point.x`, `.y`, `.z`, `.vx`, …, `.ax`, …; `coordinate` is a length.
    Point {
        /// Index of the body.
        body: usize,
        /// Index of the point in the body.
        point: usize,
        /// Axis of the ground.
        coordinate: Coordinate,
        /// The position or a derivative.
        order: TimeOrder,
    },
    /// `joint.force`, `.force.x`, …, `.torque`, `.torque.x`, ….
    Reaction {
        /// Index of the joint.
        joint: usize,
        /// Which part of the reaction.
        component: ReactionComponent,
    },
    /// `effect.length`, `effect.force`, …: a measure of an effect.
    Sensor {
        /// Index of the effect.
        effect: usize,
        /// Which of its sensors.
        measure: Sensor,
    },
    /// `trajectory`, `trajectory.rate`, `trajectory.acceleration`: a function of the time.
    Trajectory {
        /// Index of the trajectory.
        trajectory: usize,
        /// Its value or a derivative.
        order: TimeOrder,
    },
    /// An output of a black box, by its name.
    BlackBox {
        /// Index of its output.
        output: usize,
    },
    /// `energy`, `kinetic_energy`, `potential_energy`, J.
    Energy(EnergyKind),
}

/// Part of a joint's reaction on its second body, in the ground's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReactionComponent {
    /// Magnitude of the force, N.
    Force,
    /// Force along an axis (0 to 2: x, y, z), N.
    ForceAlong(usize),
    /// Torque about the second point, N m: in the plane the component about z; in space the component about the joint's
    /// axis if the joint has a torque about that alone, else the magnitude.
    Torque,
    /// Torque about an axis (0 to 2: x, y, z) through the second point, N m.
    TorqueAbout(usize),
    /// Force along the joint's own axis, N; for a rod its tension, for a cam its contact force.
    Axial,
    /// Force across the joint's own axis, N: the magnitude; along a direction of the plane, with a sign.
    Radial,
    /// Torque about the joint's own axis, N m.
    AxialTorque,
    /// Force along an axis (0 to 2: x, y, z) of the second point's frame, N.
    ForceInBody(usize),
    /// Torque about an axis through the second point along one (0 to 2: x, y, z) of its frame, N m.
    TorqueInBody(usize),
    /// Torque about an axis (0 to 2: x, y, z, the ground's) through any point, N m.
    TorqueAt(PointRef, usize),
}

impl ReactionComponent {
    /// Whether it is a torque rather than a force.
    pub fn is_torque(self) -> bool {
        match self {
            Self::Torque | Self::TorqueAbout(_) | Self::AxialTorque | Self::TorqueInBody(_) | Self::TorqueAt(..) => {
                true
            }
            Self::Force | Self::ForceAlong(_) | Self::Axial | Self::Radial | Self::ForceInBody(_) => false,
        }
    }
}

/// Kind of energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyKind {
    /// Kinetic and potential energy.
    Total,
    /// Kinetic energy.
    Kinetic,
    /// Potential energy of gravity and springs.
    Potential,
}

/// A joint's coordinate that an effect acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OnJoint {
    /// Index of the joint.
    pub joint: usize,
    /// Which of its coordinates.
    pub coordinate: JointCoordinate,
}

impl OnJoint {
    /// The angle of a joint.
    pub fn angle(joint: usize) -> Self {
        Self { joint, coordinate: JointCoordinate::Angle }
    }
}

/// An index in a joint, an effect or an initial value.
#[derive(Debug)]
pub enum Reference<'a> {
    /// Index of a body.
    Body(&'a mut usize),
    /// Index of a body, with that of one of its points.
    Point(&'a mut PointRef),
    /// Index of a joint.
    Joint(&'a mut usize),
}
