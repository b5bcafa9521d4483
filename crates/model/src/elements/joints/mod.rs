//! Joints, one file each: keys, constraints, and the data that follow from these for the other stages.
//!
//! A joint is between two points A and B with frames. Axes are directions in both frames alike (any length but zero):
//! where the joint's angle is zero, the frames' axes are parallel.
//!
//! To add a joint: its file here and its line in the registry below. No other stage names a kind of joint: each asks
//! for a capability of the trait [`Joint`].

mod capabilities;
mod registry;
mod rows;
mod teeth;

pub use capabilities::{Joint, JointElement, Mobilizer, Orientation, Placement, RowDocs, Separation, Toothed};
pub use rows::{Kinematics, Row, Rows};
pub use teeth::ToothForce;

pub use registry::JointDocs;

use registry::joints;

joints! {
    revolute::Revolute,
    prismatic::Prismatic,
    fixed::Fixed,
    pin_in_slot::PinInSlot,
    cylindrical::Cylindrical,
    screw::Screw,
    spherical::Spherical,
    universal::Universal,
    planar::Planar,
    point_on_line::PointOnLine,
    point_on_plane::PointOnPlane,
    distance::Distance,
    cam::Cam,
    gear::Gear,
    rack::Rack,
    planetary::Planetary,
    worm::Worm,
    rolling::Rolling,
    rolling_on_plane::RollingOnPlane,
    motor::Motor,
    equation::Equation,
}
