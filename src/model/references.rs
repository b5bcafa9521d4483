//! Which bodies, points and joints the parts of a mechanism refer to by index, and which formulas they are made of.

use symdiff::Formula;

use super::description::{Body, StartValue};
use super::kinds::JointKind;
use crate::grammar::{PointRef, Reference, Rotation, Turning};

fn points(between: &mut [PointRef; 2]) -> Vec<Reference<'_>> {
    between.iter_mut().map(Reference::Point).collect()
}

fn turnings(between: &mut [Turning; 2]) -> Vec<Reference<'_>> {
    fn one(turning: &mut Turning) -> Reference<'_> {
        match turning {
            Turning::Body(body) => Reference::Body(body),
            Turning::Joint(joint) => Reference::Joint(joint),
        }
    }
    between.iter_mut().map(one).collect()
}

impl JointKind {
    /// Every index in it; what its formulas name is not among them.
    pub fn references(&mut self) -> Vec<Reference<'_>> {
        match self {
            Self::Revolute { between, .. }
            | Self::Prismatic { between, .. }
            | Self::Fixed { between, .. }
            | Self::PinInSlot { between, .. }
            | Self::Cylindrical { between, .. }
            | Self::Screw { between, .. }
            | Self::Spherical { between }
            | Self::Universal { between, .. }
            | Self::Planar { between, .. }
            | Self::PointOnLine { between, .. }
            | Self::PointOnPlane { between, .. }
            | Self::Distance { between, .. } => points(between),
            Self::Gear { between, .. } => turnings(between),
            Self::Rack { pinion, rack, .. } => vec![Reference::Joint(pinion), Reference::Joint(rack)],
            Self::Motor { joint, .. } => vec![Reference::Joint(joint)],
            Self::Equation { .. } => Vec::new(),
        }
    }

    /// Every formula in it.
    pub fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::Revolute { axis, .. }
            | Self::PinInSlot { axis, .. }
            | Self::Cylindrical { axis, .. }
            | Self::Planar { normal: axis, .. }
            | Self::PointOnLine { axis, .. }
            | Self::PointOnPlane { normal: axis, .. } => axis.iter().collect(),
            Self::Prismatic { axis, angle: number, .. } | Self::Screw { axis, pitch: number, .. } => {
                axis.iter().chain([number]).collect()
            }
            Self::Fixed { angle: number, .. } | Self::Distance { length: number, .. } => vec![number],
            Self::Spherical { .. } => Vec::new(),
            Self::Universal { axes, .. } => axes.iter().flatten().collect(),
            Self::Gear { ratio, offset, .. } | Self::Rack { radius: ratio, offset, .. } => vec![ratio, offset],
            Self::Motor { motion, .. } => motion.formulas(),
            Self::Equation { left, right } => vec![left, right],
        }
    }
}

impl StartValue {
    /// The one index in it.
    pub fn reference(&mut self) -> Reference<'_> {
        match self {
            Self::Coordinate { body, .. } | Self::Orientation { body, .. } | Self::AngularVelocity { body, .. } => {
                Reference::Body(body)
            }
            Self::Joint { joint, .. } => Reference::Joint(joint),
        }
    }

    /// Every formula in it.
    pub fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::Coordinate { value, .. } | Self::Joint { value, .. } => vec![value],
            Self::AngularVelocity { value, .. } => value.iter().collect(),
            Self::Orientation { rotation, .. } => rotation.formulas(),
        }
    }
}

impl Rotation {
    /// Every formula in it.
    pub fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::RollPitchYaw(angles) => angles.iter().collect(),
            Self::AxisAngle(axis, angle) => axis.iter().chain([angle]).collect(),
            Self::Quaternion(p) => p.iter().collect(),
        }
    }
}

impl Body {
    /// Every formula in it.
    pub fn formulas(&self) -> Vec<&Formula> {
        let mut found: Vec<&Formula> = self.mass.iter().chain(self.center_of_mass.iter().flatten()).collect();
        if let Some(inertia) = &self.inertia {
            let super::Inertia { xx, yy, zz, xy, xz, yz } = inertia;
            found.extend([xx, yy, zz, xy, xz, yz]);
        }
        found.extend(self.held.iter().map(|(_, value)| value));
        found.extend(self.held_orientation.iter().flat_map(Rotation::formulas));
        for point in &self.points {
            found.extend(&point.position);
            found.extend(point.rotation.iter().flat_map(Rotation::formulas));
        }
        found
    }
}
