//! How elements are drawn: the field's usual symbols, of kinematic diagrams (ISO 3952).

use serde::Serialize;

/// A symbol of kinematic diagrams.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Glyph {
    /// A circle: one body turns against the other.
    Pin,
    /// A block on a guide.
    Slider,
    /// A block that also turns on its guide.
    Cylinder,
    /// A block on a thread.
    Screw,
    /// A pin between two guides.
    Slot,
    /// A ball in its socket.
    Ball,
    /// A cross in a circle.
    Universal,
    /// A block on a plane.
    Plane,
    /// A filled square: both bodies are one.
    Weld,
    /// A line between both ends, of a fixed length.
    Rod,
    /// Two circles that roll on one another.
    Gear,
    /// A circle with an arrow about it.
    Motor,
    /// A zigzag between both ends.
    Spring,
    /// A spiral.
    TorsionSpring,
    /// A thin line between both ends.
    Cable,
    /// A line from pulley to pulley.
    Belt,
    /// A bending bar between both ends.
    Beam,
    /// An arrow at the end.
    Force,
    /// A bent arrow at the end.
    Torque,
    /// Nothing: an effect without a location.
    Nothing,
}
