//! Forces with their torques.

use std::ops::{Add, AddAssign};

use symdiff::{Builder, Scalar};

use super::vector::Vector;

/// A force, N, and a torque about the origin of a body's frame, N m.
#[derive(Clone, Copy, Debug)]
pub struct Wrench<'g> {
    /// F
    pub force: Vector<'g>,
    /// T
    pub torque: Vector<'g>,
}

impl<'g> Wrench<'g> {
    /// No force and no torque.
    pub fn zero(g: &'g Builder) -> Self {
        Self { force: Vector::zero(g), torque: Vector::zero(g) }
    }

    /// Components 0 to 2 are the force's, 3 to 5 the torque's.
    pub fn component_mut(&mut self, component: usize) -> &mut Scalar<'g> {
        match component {
            0..3 => &mut self.force[component],
            _ => &mut self.torque[component - 3],
        }
    }

    /// The torque about the point whose arm from the origin is `arm`.
    pub fn torque_about(self, arm: Vector<'g>) -> Vector<'g> {
        self.torque - arm.cross(self.force)
    }
}

impl Add for Wrench<'_> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

impl AddAssign for Wrench<'_> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
