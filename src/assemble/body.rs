//! Kinematics of a rigid body.
//!
//! A body's frame has the origin r₀ = (x, y, z) and turns by an angle θ about z, counter-clockwise against the ground, or
//! by Euler parameters p ([`rotation`]). Each of these coordinates is a symbol or is held at a formula of the parameters
//! and t. A planar body is one whose z is held at 0 and that turns by θ. With s a point in the frame and R the rotation,
//!
//! ```text
//! r = r₀ + R s          ṙ = ṙ₀ + ω × R s          r̈ = r̈₀ + ω̇ × R s + ω × (ω × R s)
//! ω = (0, 0, θ̇)   or   ω = 2 E(p) ṗ
//! ```
//!
//! so that a force F at r and a torque τ have the generalised forces F on r₀ and T = R s × F + τ about its origin: T_z on θ,
//! 2 Eᵀ T on p. Along p itself nothing acts; what stands there is for the multiplier of pᵀp = 1 alone.

use symdiff::{Builder, Expr};

use super::carried::Carried;
pub use crate::multibody::MaterialPoint;

use super::rotation::{self, Quaternion};
use super::space::{self, Matrix, Vector};

/// Places for coordinates: x, y, z, then θ or p₀ to p₃.
pub const DEGREES_OF_FREEDOM: usize = 7;
/// Place of θ.
pub const ANGLE: usize = 3;
/// Place of p₀.
pub const EULER: usize = 3;

/// By what a body turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotationCoordinates {
    /// θ about z.
    Angle,
    /// Euler parameters.
    Euler,
}

/// A body's frame and inertia, over the symbols.
#[derive(Clone, Debug)]
pub struct Body {
    /// What stands behind x, y, z.
    pub turn: RotationCoordinates,
    /// x, y, z, then θ or p.
    pub position: [Expr; DEGREES_OF_FREEDOM],
    /// Their first derivatives by time.
    pub velocity: [Expr; DEGREES_OF_FREEDOM],
    /// Their second derivatives by time.
    pub acceleration: [Expr; DEGREES_OF_FREEDOM],
    /// Their positions in q; `None` where held, and where the body is carried.
    pub index: [Option<usize>; DEGREES_OF_FREEDOM],
    /// How a joint carries the body, if one does.
    pub carried: Option<Box<Carried>>,
    /// Of a body that is carried and does not only turn about z.
    pub attitude: Option<Attitude>,
    /// Mass m, kg; zero where the body declares none.
    pub mass: Expr,
    /// Inertia tensor J about the centre of mass in the frame's axes, kg m²; zero where the body declares none, and but
    /// for J_zz where it turns by θ.
    pub inertia: [Vector; 3],
    /// Centre of mass s_c in the frame, m.
    pub center: Vector,
    /// Named points s in the frame, m.
    pub points: Vec<Vector>,
    /// Rotations of the frames at those points against the body's.
    pub frames: Vec<Option<Quaternion>>,
}

/// How a body stands and turns, without Euler parameters in it.
#[derive(Clone, Debug)]
pub struct Attitude {
    /// R
    pub matrix: Matrix,
    /// ω in the ground's axes.
    pub omega: Vector,
    /// ω̇ in the ground's axes.
    pub alpha: Vector,
}

/// First three of a list of coordinates.
fn origin(list: &[Expr; DEGREES_OF_FREEDOM]) -> Vector {
    [list[0], list[1], list[2]]
}

/// Last four.
fn euler(list: &[Expr; DEGREES_OF_FREEDOM]) -> Quaternion {
    [list[EULER], list[EULER + 1], list[EULER + 2], list[EULER + 3]]
}

impl Body {
    /// `R a`: from the body's frame to the ground's.
    pub fn rotate(&self, g: &Builder, a: Vector) -> Vector {
        match self.turn {
            RotationCoordinates::Angle => {
                let (cos, sin) = (g.cos(self.position[ANGLE]), g.sin(self.position[ANGLE]));
                let (cx, sy) = (g.mul(cos, a[0]), g.mul(sin, a[1]));
                let (sx, cy) = (g.mul(sin, a[0]), g.mul(cos, a[1]));
                [g.sub(cx, sy), g.add(sx, cy), a[2]]
            }
            RotationCoordinates::Euler => {
                let matrix = self.matrix(g);
                space::times(g, &matrix, a)
            }
        }
    }

    /// R.
    pub fn matrix(&self, g: &Builder) -> Matrix {
        match (&self.attitude, self.turn) {
            (Some(attitude), _) => attitude.matrix,
            (None, RotationCoordinates::Angle) => {
                let axis = space::along(g, 2);
                rotation::matrix_about(g, axis, self.position[ANGLE])
            }
            (None, RotationCoordinates::Euler) => rotation::matrix(g, self.euler()),
        }
    }

    /// The frame's orientation as Euler parameters.
    pub fn orientation(&self, g: &Builder) -> Quaternion {
        match self.turn {
            RotationCoordinates::Angle => {
                let axis = space::along(g, 2);
                rotation::about(g, axis, self.position[ANGLE])
            }
            RotationCoordinates::Euler => self.euler(),
        }
    }

    /// p.
    pub fn euler(&self) -> Quaternion {
        euler(&self.position)
    }

    /// r₀.
    pub fn origin(&self) -> Vector {
        origin(&self.position)
    }

    /// ω in the ground's axes.
    pub fn angular_velocity(&self, g: &Builder) -> Vector {
        match &self.attitude {
            Some(attitude) => attitude.omega,
            None => self.turning(g, &self.velocity),
        }
    }

    /// ω̇ in the ground's axes.
    pub fn angular_acceleration(&self, g: &Builder) -> Vector {
        match &self.attitude {
            Some(attitude) => attitude.alpha,
            None => self.turning(g, &self.acceleration),
        }
    }

    fn turning(&self, g: &Builder, derivative: &[Expr; DEGREES_OF_FREEDOM]) -> Vector {
        match self.turn {
            RotationCoordinates::Angle => {
                let zero = g.constant(0.0);
                [zero, zero, derivative[ANGLE]]
            }
            RotationCoordinates::Euler => {
                let rates = rotation::ground_rates(g, self.euler());
                rotation::turning(g, &rates, euler(derivative))
            }
        }
    }

    /// ω in the body's axes.
    pub fn angular_velocity_in_body(&self, g: &Builder) -> Vector {
        let omega = self.attitude.as_ref().map(|attitude| attitude.omega);
        self.turning_in_body(g, omega, &self.velocity)
    }

    /// ω̇ in the body's axes.
    pub fn angular_acceleration_in_body(&self, g: &Builder) -> Vector {
        let alpha = self.attitude.as_ref().map(|attitude| attitude.alpha);
        self.turning_in_body(g, alpha, &self.acceleration)
    }

    fn turning_in_body(&self, g: &Builder, turning: Option<Vector>, derivative: &[Expr; DEGREES_OF_FREEDOM]) -> Vector {
        match (turning, self.turn) {
            (Some(turning), _) => {
                let back = space::transposed(&self.matrix(g));
                space::times(g, &back, turning)
            }
            (None, RotationCoordinates::Angle) => self.turning(g, derivative),
            (None, RotationCoordinates::Euler) => {
                let rates = rotation::body_rates(g, self.euler());
                rotation::turning(g, &rates, euler(derivative))
            }
        }
    }

    /// `r₀ + arm`.
    pub fn position_of(&self, g: &Builder, arm: Vector) -> Vector {
        space::add(g, self.origin(), arm)
    }

    /// `ṙ₀ + ω × arm`.
    pub fn velocity_of(&self, g: &Builder, arm: Vector) -> Vector {
        let omega = self.angular_velocity(g);
        let turning = space::cross(g, omega, arm);
        space::add(g, origin(&self.velocity), turning)
    }

    /// `r̈₀ + ω̇ × arm + ω × (ω × arm)`.
    pub fn acceleration_of(&self, g: &Builder, arm: Vector) -> Vector {
        let alpha = self.angular_acceleration(g);
        let turning = space::cross(g, alpha, arm);
        let sum = space::add(g, origin(&self.acceleration), turning);
        let centripetal = self.centripetal(g, arm);
        space::sub(g, sum, centripetal)
    }

    /// `−ω × (ω × arm)`.
    pub fn centripetal(&self, g: &Builder, arm: Vector) -> Vector {
        match self.turn {
            RotationCoordinates::Angle => {
                let square = g.mul(self.velocity[ANGLE], self.velocity[ANGLE]);
                let level = [arm[0], arm[1], g.constant(0.0)];
                space::scale(g, square, level)
            }
            RotationCoordinates::Euler => {
                let omega = self.angular_velocity(g);
                let turning = space::cross(g, omega, arm);
                space::cross(g, turning, omega)
            }
        }
    }

    /// Generalised forces of a force F on r₀ and a torque T about it, in the ground's axes.
    pub fn generalised(&self, g: &Builder, force: Vector, torque: Vector) -> [Expr; DEGREES_OF_FREEDOM] {
        let zero = g.constant(0.0);
        let turning = match self.turn {
            RotationCoordinates::Angle => [torque[2], zero, zero, zero],
            RotationCoordinates::Euler => {
                let rates = rotation::ground_rates(g, self.euler());
                rotation::transposed(g, 2.0, &rates, torque)
            }
        };
        [force[0], force[1], force[2], turning[0], turning[1], turning[2], turning[3]]
    }
}
