//! Schemas of values of keys: numbers, vectors, directions, rotations.

use schemars::JsonSchema;

use super::mapping::{grammar, schema_only};

schema_only! {
    /// A number, a formula, or a number with its unit.
    #[schemars(untagged)]
    pub enum Number {
        /// A number in SI units.
        Plain(f64),
        /// A formula (`m1*l1^2/12`) or a number with a unit (`120 mm`).
        Text(String),
    }

    /// A unit, `mm` or `N*s/m`; `1` for a pure number.
    #[schemars(untagged, inline)]
    pub enum UnitName {
        Name(String),
        One(f64),
    }

    /// Components along x and y, and in space along z, which is 0 if omitted.
    #[schemars(untagged, inline)]
    pub enum Components {
        Planar([Number; 2]),
        Spatial([Number; 3]),
    }

    /// Direction: `x`, `y`, `z` or components.
    #[schemars(untagged, inline)]
    pub enum Direction {
        Named(Axis),
        Components(Components),
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum Axis {
        X,
        Y,
        Z,
    }

    /// A number for each axis of the frame, or one for all.
    #[schemars(untagged, inline)]
    pub enum PerAxis {
        All(Number),
        Each([Number; 3]),
    }

    /// A number (in the plane, about z), or components.
    #[schemars(untagged, inline)]
    pub enum TorqueValue {
        Scalar(Number),
        Vector([Number; 3]),
    }
}

grammar! {
    /// A rotation: one of `rpy`, `axis` with `angle`, and `quaternion`.
    Rotation is "a rotation" {
        /// Roll, pitch and yaw: about the fixed x, then y, then z, rad.
        rpy: Option<[Number; 3]>,
        /// The axis of a rotation by `angle`.
        axis: Option<Direction>,
        /// rad
        angle: Option<Number>,
        /// Euler parameters p0 (cosine of half the angle) to p3, of any length.
        quaternion: Option<[Number; 4]>,
    }
}
