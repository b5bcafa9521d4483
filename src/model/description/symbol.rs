//! What a name in a formula stands for.

use super::{Coordinate, TimeOrder};
use crate::model::effect_kinds::Measure;
use crate::model::kinds::JointCoordinate;

/// What a name in a formula stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Referent {
    /// Index into [`Description::parameters`].
    Parameter(usize),
    /// `t`, s.
    Time,
    /// `body.x`, `.y`, `.z`, `.angle`, `.p0` … `.p3`, `.vx`, …, `.angular_velocity`, `.ax`, …, `.angular_acceleration`.
    Coordinate {
        /// Body index.
        body: usize,
        /// Which of its coordinates.
        coordinate: Coordinate,
        /// Position, velocity or acceleration.
        order: TimeOrder,
    },
    /// `body.omega.x`, … and `body.alpha.x`, …, or `omega_body`, `alpha_body` in the body's frame.
    AngularMotion {
        /// Body index.
        body: usize,
        /// 0 to 2: x, y, z.
        axis: usize,
        /// Velocity or acceleration.
        order: TimeOrder,
        /// Components in the body's frame instead of the ground's.
        in_body: bool,
    },
    /// `body.roll`, `.pitch`, `.yaw`: rotations about the fixed x, then y, then z, rad, between −π and π.
    RollPitchYaw {
        /// Body index.
        body: usize,
        /// 0 to 2: roll, pitch, yaw.
        angle: usize,
    },
    /// `joint.angle`, `.displacement`, `.angular_velocity`, `.velocity`, `.angular_acceleration`, `.acceleration`.
    JointCoordinate {
        /// Joint index.
        joint: usize,
        /// Which of its coordinates.
        coordinate: JointCoordinate,
        /// Position, velocity or acceleration.
        order: TimeOrder,
    },
    /// `body.point.x`, `.y`, `.z`, `.vx`, …, `.ax`, …; `coordinate` is a length.
    Point {
        /// Body index.
        body: usize,
        /// Index into the body's points.
        point: usize,
        /// Which of its coordinates.
        coordinate: Coordinate,
        /// Position, velocity or acceleration.
        order: TimeOrder,
    },
    /// `joint.force`, `.force.x`, …, `.torque`, `.torque.x`, ….
    Reaction {
        /// Joint index.
        joint: usize,
        /// Which part of it.
        component: ReactionComponent,
    },
    /// `effect.length`, `effect.force`, …: what an effect measures.
    Measure {
        /// Effect index.
        effect: usize,
        /// Which of its quantities.
        measure: Measure,
    },
    /// `energy`, `kinetic_energy`, `potential_energy`, J.
    Energy(EnergyKind),
}

/// Part of a joint's reaction on its second body, in the ground's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReactionComponent {
    /// Magnitude of the force, N.
    Force,
    /// Along an axis (0 to 2: x, y, z), N.
    ForceAlong(usize),
    /// About the second point, N m: in the plane the component about z, in space the magnitude.
    Torque,
    /// About an axis (0 to 2: x, y, z) through the second point, N m.
    TorqueAbout(usize),
}

/// Which energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyKind {
    /// `energy`: the sum of both.
    Total,
    /// `kinetic_energy`
    Kinetic,
    /// `potential_energy`
    Potential,
}
