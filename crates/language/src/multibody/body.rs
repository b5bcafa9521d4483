//! Kinematics of a rigid body.
//!
//! A body's frame has the origin r₀ = (x, y, z) and turns by an angle θ about z, counter-clockwise against the ground,
//! or by Euler parameters p ([`super::rotation`]). Each of these coordinates is a symbol or is prescribed by a formula
//! of the parameters and t. A planar body is one whose z is prescribed as 0 and that turns by θ. With s a point in the
//! frame and R the rotation,
//!
//! ```text
//! r = r₀ + R s          ṙ = ṙ₀ + ω × R s          r̈ = r̈₀ + ω̇ × R s + ω × (ω × R s)
//! ω = (0, 0, θ̇)   or   ω = 2 E(p) ṗ
//! ```
//!
//! so that a force F at r and a torque τ have the generalised forces F on r₀ and T = R s × F + τ about its origin: T_z
//! on θ, 2 Eᵀ T on p. No force acts along p itself; the equation there serves the multiplier of pᵀp = 1 alone.

use symdiff::{Builder, Scalar};

use super::matrix::Matrix;
use super::relative_motion::RelativeMotion;
use super::rotation::{self, Quaternion};
use super::vector::Vector;
use super::wrench::Wrench;
use crate::grammar::TimeOrder;

/// Number of entries for coordinates: x, y, z, then θ or p₀ to p₃.
pub const DEGREES_OF_FREEDOM: usize = 7;
/// Index of θ.
pub const ANGLE: usize = 3;
/// Index of p₀.
pub const EULER: usize = 3;

/// Coordinates of a body's rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotationCoordinates {
    /// θ about z.
    Angle,
    /// Euler parameters.
    Euler,
}

/// A value for each of x, y, z, then of θ or p.
type Coordinates<'g> = [Scalar<'g>; DEGREES_OF_FREEDOM];

/// A body's frame and inertia, over the symbols.
#[derive(Clone, Debug)]
pub struct Body<'g> {
    /// Coordinates after x, y, z.
    pub rotation_coordinates: RotationCoordinates,
    /// x, y, z, then θ or p.
    pub position: Coordinates<'g>,
    /// Their first derivatives by time.
    pub velocity: Coordinates<'g>,
    /// Their second derivatives by time.
    pub acceleration: Coordinates<'g>,
    /// Their indices in q; `None` for prescribed ones, and for a child.
    pub index: [Option<usize>; DEGREES_OF_FREEDOM],
    /// Motion of a child: a body that has no coordinates of its own, but moves against its parent by those of a joint.
    pub relative_motion: Option<Box<RelativeMotion<'g>>>,
    /// Rotation of a child that does not only turn about z.
    pub attitude: Option<Attitude<'g>>,
    /// Mass m, kg; zero if the body declares none.
    pub mass: Scalar<'g>,
    /// Inertia tensor J about the centre of mass in the frame's axes, kg m²; zero if the body declares none, and zero
    /// except for J_zz if it turns by θ.
    pub inertia: Matrix<'g>,
    /// Centre of mass s_c in the frame, m.
    pub center: Vector<'g>,
    /// Named points s in the frame, m.
    pub points: Vec<Vector<'g>>,
    /// Rotations of the frames at those points against the body's.
    pub frames: Vec<Option<Quaternion<'g>>>,
}

/// A rotation and its rates, without Euler parameters in them.
#[derive(Clone, Debug)]
pub struct Attitude<'g> {
    /// R
    pub matrix: Matrix<'g>,
    /// ω in the ground's axes.
    pub omega: Vector<'g>,
    /// ω̇ in the ground's axes.
    pub alpha: Vector<'g>,
}

/// First three of a list of coordinates.
fn origin<'g>(list: &Coordinates<'g>) -> Vector<'g> {
    [list[0], list[1], list[2]].into()
}

/// Last four.
fn euler<'g>(list: &Coordinates<'g>) -> Quaternion<'g> {
    [list[EULER], list[EULER + 1], list[EULER + 2], list[EULER + 3]].into()
}

impl<'g> Body<'g> {
    fn graph(&self) -> &'g Builder {
        self.mass.builder()
    }

    /// Whether it moves against a parent by the coordinates of a joint.
    pub fn is_child(&self) -> bool {
        self.relative_motion.is_some()
    }

    /// Whether it is prescribed, or is a child.
    pub fn has_no_coordinates(&self) -> bool {
        self.is_child() || self.index.iter().all(Option::is_none)
    }

    /// The coordinates, or their first or second derivatives.
    pub fn motion(&self, order: TimeOrder) -> &Coordinates<'g> {
        match order {
            TimeOrder::Position => &self.position,
            TimeOrder::Velocity => &self.velocity,
            TimeOrder::Acceleration => &self.acceleration,
        }
    }

    /// `R a`: from the body's frame to the ground's.
    pub fn rotate(&self, a: Vector<'g>) -> Vector<'g> {
        match self.rotation_coordinates {
            RotationCoordinates::Angle => {
                let (cos, sin) = (self.position[ANGLE].cos(), self.position[ANGLE].sin());
                let (cx, sy) = (cos * a[0], sin * a[1]);
                let (sx, cy) = (sin * a[0], cos * a[1]);
                [cx - sy, sx + cy, a[2]].into()
            }
            RotationCoordinates::Euler => self.matrix() * a,
        }
    }

    /// R
    pub fn matrix(&self) -> Matrix<'g> {
        match (&self.attitude, self.rotation_coordinates) {
            (Some(attitude), _) => attitude.matrix,
            (None, RotationCoordinates::Angle) => {
                rotation::matrix_about(Vector::along(self.graph(), 2), self.position[ANGLE])
            }
            (None, RotationCoordinates::Euler) => self.euler().matrix(),
        }
    }

    /// The frame's orientation as Euler parameters.
    pub fn orientation(&self) -> Quaternion<'g> {
        match self.rotation_coordinates {
            RotationCoordinates::Angle => Quaternion::about(Vector::along(self.graph(), 2), self.position[ANGLE]),
            RotationCoordinates::Euler => self.euler(),
        }
    }

    /// p
    pub fn euler(&self) -> Quaternion<'g> {
        euler(&self.position)
    }

    /// r₀
    pub fn origin(&self) -> Vector<'g> {
        origin(&self.position)
    }

    /// r̈₀
    pub fn acceleration_of_origin(&self) -> Vector<'g> {
        origin(&self.acceleration)
    }

    /// ω in the ground's axes.
    pub fn angular_velocity(&self) -> Vector<'g> {
        match &self.attitude {
            Some(attitude) => attitude.omega,
            None => self.rate_of_rotation(&self.velocity),
        }
    }

    /// ω̇ in the ground's axes.
    pub fn angular_acceleration(&self) -> Vector<'g> {
        match &self.attitude {
            Some(attitude) => attitude.alpha,
            None => self.rate_of_rotation(&self.acceleration),
        }
    }

    fn rate_of_rotation(&self, derivative: &Coordinates<'g>) -> Vector<'g> {
        match self.rotation_coordinates {
            RotationCoordinates::Angle => {
                let zero = self.graph().number(0.0);
                [zero, zero, derivative[ANGLE]].into()
            }
            RotationCoordinates::Euler => self.euler().ground_rates().rotation(euler(derivative)),
        }
    }

    /// ω in the body's axes.
    pub fn angular_velocity_in_body(&self) -> Vector<'g> {
        let omega = self.attitude.as_ref().map(|attitude| attitude.omega);
        self.in_body(omega, &self.velocity)
    }

    /// ω̇ in the body's axes.
    pub fn angular_acceleration_in_body(&self) -> Vector<'g> {
        let alpha = self.attitude.as_ref().map(|attitude| attitude.alpha);
        self.in_body(alpha, &self.acceleration)
    }

    /// A rate of rotation in the body's axes, from that in the ground's axes if it is known, else from the derivative
    /// of the coordinates.
    fn in_body(&self, in_ground: Option<Vector<'g>>, derivative: &Coordinates<'g>) -> Vector<'g> {
        match (in_ground, self.rotation_coordinates) {
            (Some(rate), _) => self.matrix().transposed() * rate,
            (None, RotationCoordinates::Angle) => self.rate_of_rotation(derivative),
            (None, RotationCoordinates::Euler) => self.euler().body_rates().rotation(euler(derivative)),
        }
    }

    /// `r₀ + arm`
    pub fn position_of(&self, arm: Vector<'g>) -> Vector<'g> {
        self.origin() + arm
    }

    /// `ṙ₀ + ω × arm`
    pub fn velocity_of(&self, arm: Vector<'g>) -> Vector<'g> {
        origin(&self.velocity) + self.angular_velocity().cross(arm)
    }

    /// `r̈₀ + ω̇ × arm + ω × (ω × arm)`
    pub fn acceleration_of(&self, arm: Vector<'g>) -> Vector<'g> {
        self.acceleration_of_origin() + self.angular_acceleration().cross(arm) - self.centripetal(arm)
    }

    /// `−ω × (ω × arm)`
    pub fn centripetal(&self, arm: Vector<'g>) -> Vector<'g> {
        match self.rotation_coordinates {
            RotationCoordinates::Angle => {
                let square = self.velocity[ANGLE] * self.velocity[ANGLE];
                square * Vector::from([arm[0], arm[1], self.graph().number(0.0)])
            }
            RotationCoordinates::Euler => {
                let omega = self.angular_velocity();
                omega.cross(arm).cross(omega)
            }
        }
    }

    /// Generalised forces of a force on r₀ and a torque about it, in the ground's axes.
    pub fn generalised(&self, Wrench { force, torque }: Wrench<'g>) -> Coordinates<'g> {
        let rotational = match self.rotation_coordinates {
            RotationCoordinates::Angle => self.on_angle(torque),
            RotationCoordinates::Euler => self.euler().ground_rates().transposed_times(2.0, torque),
        };
        stacked(force, rotational)
    }

    /// The same for a torque in the body's axes, the force still in the ground's.
    pub fn generalised_of_torque_in_body(&self, force: Vector<'g>, torque: Vector<'g>) -> Coordinates<'g> {
        let rotational = match self.rotation_coordinates {
            RotationCoordinates::Angle => self.on_angle(torque),
            RotationCoordinates::Euler => self.euler().body_rates().transposed_times(2.0, torque),
        };
        stacked(force, rotational)
    }

    fn on_angle(&self, torque: Vector<'g>) -> Quaternion<'g> {
        let zero = self.graph().number(0.0);
        [torque[2], zero, zero, zero].into()
    }
}

/// Entries of the origin, then of the rotation.
pub(super) fn stacked<'g>(origin: Vector<'g>, rotation: Quaternion<'g>) -> Coordinates<'g> {
    let ([x, y, z], [p0, p1, p2, p3]) = (origin.components(), rotation.components());
    [x, y, z, p0, p1, p2, p3]
}
