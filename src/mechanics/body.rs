//! Kinematics and inertia of a planar body.
//!
//! A body's frame has the origin r₀ = (x, y) and the angle θ, counter-clockwise against the ground. Each of the three
//! is a symbol or is held at a formula of the parameters and t. With s a point in the frame and R = R(θ) the rotation,
//!
//! ```text
//! r = r₀ + R s          ṙ = ṙ₀ + θ̇ (R s)⊥          r̈ = r̈₀ + θ̈ (R s)⊥ − θ̇² R s          (a⊥ = (−a_y, aₓ) = k × a)
//! ```
//!
//! so that ∂r/∂(x, y, θ) = [1  1  (R s)⊥], and a force F at r has the generalised forces (Fₓ, F_y, R s × F).
//!
//! With the centre of mass at s_c, d'Alembert's m r̈_c and I θ̈ projected on the three coordinates are M w − Q with
//!
//! ```text
//!     ⎡ m               0              −m (R s_c)_y   ⎤           ⎡ m θ̇² (R s_c)ₓ  ⎤
//! M = ⎢ 0               m               m (R s_c)ₓ    ⎥       Q = ⎢ m θ̇² (R s_c)_y ⎥
//!     ⎣ −m (R s_c)_y    m (R s_c)ₓ      I + m |s_c|²  ⎦           ⎣ 0              ⎦
//! ```
//!
//! and M is constant where the centre of mass is the origin. I is taken about the centre of mass.

use symdiff::{Expr, Graph};

use super::plane::{self, Vector};

/// Number of coordinates of a free planar body: x, y, θ.
pub const FREEDOMS: usize = 3;
/// Position of θ among them.
pub const ANGLE: usize = 2;

/// A body's frame and inertia, over the symbols.
#[derive(Clone, Debug)]
pub struct Body {
    /// x, y, θ.
    pub position: [Expr; FREEDOMS],
    /// Their first derivatives by time.
    pub velocity: [Expr; FREEDOMS],
    /// Their second derivatives by time.
    pub acceleration: [Expr; FREEDOMS],
    /// Their positions in q; `None` where held.
    pub index: [Option<usize>; FREEDOMS],
    /// Mass m, kg; zero where the body declares none.
    pub mass: Expr,
    /// Moment of inertia I about the centre of mass, kg m²; zero where the body declares none.
    pub inertia: Expr,
    /// Centre of mass s_c in the frame, m.
    pub center: Vector,
    /// Named points s in the frame, m.
    pub points: Vec<Vector>,
}

/// A point fixed in a body.
#[derive(Clone, Copy, Debug)]
pub struct MaterialPoint {
    /// Index of the body.
    pub body: usize,
    /// R s: from the frame's origin to the point, in the ground's frame.
    pub arm: Vector,
    /// r
    pub position: Vector,
    /// ṙ
    pub velocity: Vector,
}

impl Body {
    /// `R(θ) a`: from the body's frame to the ground's.
    pub fn rotate(&self, g: &mut Graph, a: Vector) -> Vector {
        let (cos, sin) = (g.cos(self.position[ANGLE]), g.sin(self.position[ANGLE]));
        let (cx, sy) = (g.mul(cos, a[0]), g.mul(sin, a[1]));
        let (sx, cy) = (g.mul(sin, a[0]), g.mul(cos, a[1]));
        [g.sub(cx, sy), g.add(sx, cy)]
    }

    /// `r₀ + arm`.
    pub fn position_of(&self, g: &mut Graph, arm: Vector) -> Vector {
        plane::add(g, [self.position[0], self.position[1]], arm)
    }

    /// `ṙ₀ + θ̇ arm⊥`.
    pub fn velocity_of(&self, g: &mut Graph, arm: Vector) -> Vector {
        let across = plane::perpendicular(g, arm);
        let turning = plane::scale(g, self.velocity[ANGLE], across);
        plane::add(g, [self.velocity[0], self.velocity[1]], turning)
    }

    /// `r̈₀ + θ̈ arm⊥ − θ̇² arm`.
    pub fn acceleration_of(&self, g: &mut Graph, arm: Vector) -> Vector {
        let across = plane::perpendicular(g, arm);
        let turning = plane::scale(g, self.acceleration[ANGLE], across);
        let square = g.mul(self.velocity[ANGLE], self.velocity[ANGLE]);
        let centripetal = plane::scale(g, square, arm);
        let sum = plane::add(g, [self.acceleration[0], self.acceleration[1]], turning);
        plane::sub(g, sum, centripetal)
    }

    /// M of all three coordinates, held ones included.
    fn mass_matrix(&self, g: &mut Graph) -> [[Expr; FREEDOMS]; FREEDOMS] {
        let zero = g.constant(0.0);
        let arm = self.rotate(g, self.center);
        let moment = plane::scale(g, self.mass, arm);
        let x_angle = g.neg(moment[1]);
        let square = plane::dot(g, self.center, self.center);
        let offset = g.mul(self.mass, square);
        let turning = g.add(self.inertia, offset);
        [[self.mass, zero, x_angle], [zero, self.mass, moment[0]], [x_angle, moment[0], turning]]
    }

    /// Adds the body's entries to M and its velocity-dependent inertial forces to Q. A held coordinate that moves (by
    /// a formula of t) drives the others through its column of M.
    pub fn add_inertia(&self, g: &mut Graph, mass: &mut Vec<(usize, usize, Expr)>, force: &mut [Expr]) {
        let matrix = self.mass_matrix(g);
        let arm = self.rotate(g, self.center);
        let square = g.mul(self.velocity[ANGLE], self.velocity[ANGLE]);
        let strength = g.mul(self.mass, square);
        let centripetal = plane::scale(g, strength, arm);
        for (freedom, entries) in matrix.iter().enumerate() {
            let Some(row) = self.index[freedom] else { continue };
            if freedom != ANGLE {
                force[row] = g.add(force[row], centripetal[freedom]);
            }
            for (other, &value) in entries.iter().enumerate() {
                match self.index[other] {
                    Some(column) if !g.is_zero(value) => mass.push((row, column, value)),
                    Some(_) => {}
                    None => {
                        let driven = g.mul(value, self.acceleration[other]);
                        force[row] = g.sub(force[row], driven);
                    }
                }
            }
        }
    }

    /// ½ m |ṙ_c|² + ½ I θ̇², J.
    pub fn kinetic_energy(&self, g: &mut Graph) -> Expr {
        let arm = self.rotate(g, self.center);
        let velocity = self.velocity_of(g, arm);
        let square = plane::dot(g, velocity, velocity);
        let moving = g.mul(self.mass, square);
        let square = g.mul(self.velocity[ANGLE], self.velocity[ANGLE]);
        let turning = g.mul(self.inertia, square);
        let doubled = g.add(moving, turning);
        g.scale(0.5, doubled)
    }
}
