//! Which bodies, points and joints the parts of a mechanism refer to by index, and which formulas they are made of.

use symdiff::Formula;

use super::description::{Body, StartValue};
use crate::grammar::{Reference, Rotation};

impl StartValue {
    /// The one index in it.
    pub fn reference(&mut self) -> Reference<'_> {
        match self {
            Self::Coordinate { body, .. }
            | Self::Orientation { body, .. }
            | Self::AngularVelocity { body, .. }
            | Self::AngularRate { body, .. }
            | Self::RollPitchYaw { body, .. } => Reference::Body(body),
            Self::Point { place, .. } => Reference::Point(place),
            Self::Joint { joint, .. } => Reference::Joint(joint),
        }
    }

    /// Every formula in it.
    pub fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::Coordinate { value, .. }
            | Self::Joint { value, .. }
            | Self::AngularRate { value, .. }
            | Self::RollPitchYaw { value, .. }
            | Self::Point { value, .. } => vec![value],
            Self::AngularVelocity { value, .. } => value.iter().collect(),
            Self::Orientation { rotation, .. } => rotation.formulas(),
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
        found.extend(self.prescribed.iter().map(|(_, value)| value));
        found.extend(self.prescribed_orientation.iter().flat_map(Rotation::formulas));
        for point in &self.points {
            found.extend(&point.position);
            found.extend(point.rotation.iter().flat_map(Rotation::formulas));
        }
        found
    }
}
