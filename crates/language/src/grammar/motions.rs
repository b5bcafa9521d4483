//! Parts of motions that names can refer to: `body.vx`, `body.omega.z`, `joint.angle`.

use super::quantity::Dimension;
use super::symbols::{Coordinate, JointCoordinate, TimeOrder};

/// A part of a motion: its name, its owner, and the order of its time derivative.
pub type Motion<T> = (&'static str, T, TimeOrder);

/// Parts of a body's or a point's motion.
pub const MOTIONS: [Motion<Coordinate>; 16] = [
    ("x", Coordinate::X, TimeOrder::Position),
    ("y", Coordinate::Y, TimeOrder::Position),
    ("angle", Coordinate::Angle, TimeOrder::Position),
    ("vx", Coordinate::X, TimeOrder::Velocity),
    ("vy", Coordinate::Y, TimeOrder::Velocity),
    ("angular_velocity", Coordinate::Angle, TimeOrder::Velocity),
    ("ax", Coordinate::X, TimeOrder::Acceleration),
    ("ay", Coordinate::Y, TimeOrder::Acceleration),
    ("angular_acceleration", Coordinate::Angle, TimeOrder::Acceleration),
    ("z", Coordinate::Z, TimeOrder::Position),
    ("vz", Coordinate::Z, TimeOrder::Velocity),
    ("az", Coordinate::Z, TimeOrder::Acceleration),
    ("p0", Coordinate::Euler(0), TimeOrder::Position),
    ("p1", Coordinate::Euler(1), TimeOrder::Position),
    ("p2", Coordinate::Euler(2), TimeOrder::Position),
    ("p3", Coordinate::Euler(3), TimeOrder::Position),
];

/// Vectors of a body's rotation in space, in the ground's axes or in the body's.
pub const ANGULAR_MOTIONS: [Motion<bool>; 4] = [
    ("omega", false, TimeOrder::Velocity),
    ("alpha", false, TimeOrder::Acceleration),
    ("omega_body", true, TimeOrder::Velocity),
    ("alpha_body", true, TimeOrder::Acceleration),
];

/// Angles of a body's orientation.
pub const ATTITUDE: [&str; 3] = ["roll", "pitch", "yaw"];

/// A body's orientation, which is no number, but can be given as an initial value.
pub const ORIENTATION: &str = "orientation";

/// Coordinates of a joint and their derivatives.
pub const JOINT_MOTIONS: [Motion<JointCoordinate>; 6] = [
    ("angle", JointCoordinate::Angle, TimeOrder::Position),
    ("angular_velocity", JointCoordinate::Angle, TimeOrder::Velocity),
    ("angular_acceleration", JointCoordinate::Angle, TimeOrder::Acceleration),
    ("displacement", JointCoordinate::Displacement, TimeOrder::Position),
    ("velocity", JointCoordinate::Displacement, TimeOrder::Velocity),
    ("acceleration", JointCoordinate::Displacement, TimeOrder::Acceleration),
];

/// Components of a vector.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// Whether a name is that of a part of a body's motion, which no point can have.
pub fn is_motion(name: &str) -> bool {
    MOTIONS.iter().any(|(motion, ..)| *motion == name)
        || ANGULAR_MOTIONS.iter().any(|(vector, ..)| *vector == name)
        || ATTITUDE.contains(&name)
        || name == ORIENTATION
}

/// The coordinate's name, as in `body.angle`.
pub fn motion_name(coordinate: Coordinate, order: TimeOrder) -> &'static str {
    MOTIONS.iter().find(|(_, c, o)| (*c, *o) == (coordinate, order)).map_or("", |(name, ..)| name)
}

/// The name of a derivative of a coordinate of a body or a joint: `block.vx` for `block.x`. The coordinate's own name
/// if its derivatives have none.
pub fn derivative_name(coordinate: &str, order: TimeOrder) -> String {
    let derivative = coordinate.rsplit_once('.').and_then(|(owner, position)| {
        let of_body = MOTIONS.iter().find(|(name, ..)| *name == position).map(|(_, of, _)| motion_name(*of, order));
        let of_joint = || {
            let (_, of, _) = JOINT_MOTIONS.iter().find(|(name, ..)| *name == position)?;
            JOINT_MOTIONS.iter().find(|(_, c, o)| (c, *o) == (of, order)).map(|(name, ..)| *name)
        };
        let name = of_body.or_else(of_joint).filter(|name| !name.is_empty())?;
        Some(format!("{owner}.{name}"))
    });
    derivative.unwrap_or_else(|| coordinate.to_owned())
}

/// The dimension of a joint's coordinate and of its derivatives.
pub fn joint_dimension(coordinate: JointCoordinate, order: TimeOrder) -> Dimension {
    match coordinate {
        JointCoordinate::Angle => motion_dimension(Coordinate::Angle, order),
        JointCoordinate::Displacement => motion_dimension(Coordinate::X, order),
    }
}

/// The dimension of a coordinate and of its derivatives.
pub fn motion_dimension(coordinate: Coordinate, order: TimeOrder) -> Dimension {
    match (coordinate, order) {
        (Coordinate::Euler(_), _) => Dimension::NUMBER,
        (Coordinate::Angle, TimeOrder::Position) => Dimension::ANGLE,
        (Coordinate::Angle, TimeOrder::Velocity) => Dimension::ANGULAR_VELOCITY,
        (Coordinate::Angle, TimeOrder::Acceleration) => Dimension::ANGULAR_ACCELERATION,
        (_, TimeOrder::Position) => Dimension::LENGTH,
        (_, TimeOrder::Velocity) => Dimension::VELOCITY,
        (_, TimeOrder::Acceleration) => Dimension::ACCELERATION,
    }
}

/// Dimensions of a joint's coordinate, of its rate, and of its generalised force.
pub fn dimensions_of(coordinate: JointCoordinate) -> [Dimension; 3] {
    match coordinate {
        JointCoordinate::Angle => [Dimension::ANGLE, Dimension::ANGULAR_VELOCITY, Dimension::TORQUE],
        JointCoordinate::Displacement => [Dimension::LENGTH, Dimension::VELOCITY, Dimension::FORCE],
    }
}
