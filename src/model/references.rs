//! Which bodies, points and joints the parts of a mechanism refer to by index, and which formulas they are made of.

use symdiff::Formula;

use super::description::{Body, StartValue};
use crate::elements::joints::*;
use crate::grammar::{PointRef, Reference, Rotation, Turning};

fn points(between: &mut [PointRef; 2]) -> Vec<Reference<'_>> {
    between.iter_mut().map(Reference::Point).collect()
}

fn angles(between: &mut [Turning; 2]) -> Vec<Reference<'_>> {
    fn one(angle_of: &mut Turning) -> Reference<'_> {
        match angle_of {
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
            Self::Revolute(Revolute { between, .. })
            | Self::Prismatic(Prismatic { between, .. })
            | Self::Fixed(Fixed { between, .. })
            | Self::PinInSlot(PinInSlot { between, .. })
            | Self::Cylindrical(Cylindrical { between, .. })
            | Self::Screw(Screw { between, .. })
            | Self::Spherical(Spherical { between, .. })
            | Self::Universal(Universal { between, .. })
            | Self::Planar(Planar { between, .. })
            | Self::PointOnLine(PointOnLine { between, .. })
            | Self::PointOnPlane(PointOnPlane { between, .. })
            | Self::Distance(Distance { between, .. }) => points(between),
            Self::Gear(Gear { between, .. }) => angles(between),
            Self::Rack(Rack { pinion, rack, .. }) => vec![Reference::Joint(pinion), Reference::Joint(rack)],
            Self::Motor(Motor { joint, .. }) => vec![Reference::Joint(joint)],
            Self::Equation(_) => Vec::new(),
        }
    }

    /// Every formula in it.
    pub fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::Revolute(Revolute { axis, .. })
            | Self::PinInSlot(PinInSlot { axis, .. })
            | Self::Cylindrical(Cylindrical { axis, .. })
            | Self::Planar(Planar { normal: axis, .. })
            | Self::PointOnLine(PointOnLine { axis, .. })
            | Self::PointOnPlane(PointOnPlane { normal: axis, .. }) => axis.iter().collect(),
            Self::Prismatic(Prismatic { axis, angle: number, .. }) | Self::Screw(Screw { axis, pitch: number, .. }) => {
                axis.iter().chain([number]).collect()
            }
            Self::Fixed(Fixed { angle: number, .. }) | Self::Distance(Distance { length: number, .. }) => vec![number],
            Self::Spherical(_) => Vec::new(),
            Self::Universal(Universal { axes, .. }) => axes.iter().flatten().collect(),
            Self::Gear(Gear { ratio, offset, .. }) | Self::Rack(Rack { radius: ratio, offset, .. }) => {
                vec![ratio, offset]
            }
            Self::Motor(Motor { motion, .. }) => motion.formulas(),
            Self::Equation(Equation { left, right }) => vec![left, right],
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
