//! Inertia of a rigid body: its part of M w − Q.
//!
//! With the centre of mass at s = s_c, d'Alembert's m r̈_c and J ω̇ projected on the coordinates of a body that turns by θ
//! are, a = R s being its arm and θ̇² a the level part of the centripetal acceleration,
//!
//! ```text
//!     ⎡ m        0        0    −m a_y                  ⎤           ⎡ m θ̇² aₓ  ⎤
//! M = ⎢ 0        m        0     m aₓ                   ⎥       Q = ⎢ m θ̇² a_y ⎥
//!     ⎢ 0        0        m     0                      ⎥           ⎢ 0        ⎥
//!     ⎣ −m a_y   m aₓ     0     J_zz + m (sₓ² + s_y²)  ⎦           ⎣ 0        ⎦
//! ```
//!
//! and of a body with Euler parameters, ω' = 2 G ṗ being its angular velocity in its own axes,
//!
//! ```text
//! M = ⎡ m 1            −2 m R s̃ G            ⎤       Q = ⎡ −m ω × (ω × R s)    ⎤       J₀ = J + m (sᵀs 1 − s sᵀ)
//!     ⎣ 2 m Gᵀ s̃ Rᵀ    4 Gᵀ J₀ G + 4 μ p pᵀ  ⎦           ⎣ −2 Gᵀ (ω' × J₀ ω')  ⎦       μ = tr J₀ / 3
//! ```
//!
//! J is taken about the centre of mass. 4 Gᵀ J₀ G is singular: it knows nothing of a change of |p|. The term with μ makes M
//! positive definite and changes no motion, since it acts along p, where the multiplier of pᵀp = 1 takes it up.

use symdiff::{Builder, Expr};

use super::body::{ANGLE, Body, DEGREES_OF_FREEDOM, EULER, RotationCoordinates};
use super::rotation;
use super::space::{self, Vector};

type MassMatrix = [[Expr; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];

impl Body {
    /// Adds the body's entries to M and its velocity-dependent inertial forces to Q. A held coordinate that moves (by
    /// a formula of t) drives the others through its column of M.
    pub fn add_inertia(&self, g: &Builder, mass: &mut Vec<(usize, usize, Expr)>, force: &mut [Expr]) {
        if self.carried.is_some() || self.index.iter().all(Option::is_none) {
            return;
        }
        let (matrix, inertial) = match self.turn {
            RotationCoordinates::Angle => self.turning_by_angle(g),
            RotationCoordinates::Euler => self.turning_by_euler(g),
        };
        for (dof, entries) in matrix.iter().enumerate() {
            let Some(row) = self.index[dof] else { continue };
            force[row] = g.add(force[row], inertial[dof]);
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

    /// M and Q with θ, of all coordinates, held ones included.
    fn turning_by_angle(&self, g: &Builder) -> (MassMatrix, [Expr; DEGREES_OF_FREEDOM]) {
        let zero = g.constant(0.0);
        let arm = self.rotate(g, self.center);
        let moment = space::scale(g, self.mass, arm);
        let level = [self.center[0], self.center[1], zero];
        let square = space::dot(g, level, level);
        let offset = g.mul(self.mass, square);
        let mut matrix = [[zero; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
        (0..3).for_each(|i| matrix[i][i] = self.mass);
        let x_angle = g.neg(moment[1]);
        (matrix[0][ANGLE], matrix[ANGLE][0]) = (x_angle, x_angle);
        (matrix[1][ANGLE], matrix[ANGLE][1]) = (moment[0], moment[0]);
        matrix[ANGLE][ANGLE] = g.add(self.inertia[2][2], offset);

        let square = g.mul(self.velocity[ANGLE], self.velocity[ANGLE]);
        let strength = g.mul(self.mass, square);
        let mut inertial = [zero; DEGREES_OF_FREEDOM];
        inertial[0] = g.mul(strength, arm[0]);
        inertial[1] = g.mul(strength, arm[1]);
        (matrix, inertial)
    }

    /// M and Q with Euler parameters.
    fn turning_by_euler(&self, g: &Builder) -> (MassMatrix, [Expr; DEGREES_OF_FREEDOM]) {
        let zero = g.constant(0.0);
        let p = self.euler();
        let r = rotation::matrix(g, p);
        let rates = rotation::body_rates(g, p);
        let about_origin = self.inertia_about_origin(g);
        let mut matrix = [[zero; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
        (0..3).for_each(|i| matrix[i][i] = self.mass);

        // −2 m R s̃ G: column j is 2 m R (G_j × s).
        for j in 0..4 {
            let column = rates.map(|row| row[j]);
            let across = space::cross(g, column, self.center);
            for (i, row) in r.iter().enumerate() {
                let half = space::dot(g, *row, across);
                let half = g.mul(self.mass, half);
                let entry = g.scale(2.0, half);
                (matrix[i][EULER + j], matrix[EULER + j][i]) = (entry, entry);
            }
        }
        let sum = g.sum((0..3).map(|i| about_origin[i][i]));
        let stretch = g.scale(1.0 / 3.0, sum);
        for j in 0..4 {
            let column = rates.map(|row| row[j]);
            let turned = space::times(g, &about_origin, column);
            for i in j..4 {
                let row = rates.map(|row| row[i]);
                let turning = space::dot(g, row, turned);
                let square = g.mul(p[i], p[j]);
                let stretching = g.mul(stretch, square);
                let sum = g.add(turning, stretching);
                let entry = g.scale(4.0, sum);
                (matrix[EULER + i][EULER + j], matrix[EULER + j][EULER + i]) = (entry, entry);
            }
        }

        let arm = self.rotate(g, self.center);
        let centripetal = self.centripetal(g, arm);
        let pull = space::scale(g, self.mass, centripetal);
        let omega = self.angular_velocity_in_body(g);
        let momentum = space::times(g, &about_origin, omega);
        let gyroscopic = space::cross(g, momentum, omega);
        let turning = rotation::transposed(g, 2.0, &rates, gyroscopic);
        (matrix, [pull[0], pull[1], pull[2], turning[0], turning[1], turning[2], turning[3]])
    }

    /// J₀ = J + m (sᵀs 1 − s sᵀ).
    pub fn inertia_about_origin(&self, g: &Builder) -> [Vector; 3] {
        let s = self.center;
        let square = space::dot(g, s, s);
        let mut shifted = self.inertia;
        for (i, row) in shifted.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let product = g.mul(s[i], s[j]);
                let spread = if i == j { g.sub(square, product) } else { g.neg(product) };
                let part = g.mul(self.mass, spread);
                *entry = g.add(*entry, part);
            }
        }
        shifted
    }

    /// ½ m |ṙ_c|² + ½ ω'ᵀ J ω', J.
    pub fn kinetic_energy(&self, g: &Builder) -> Expr {
        let arm = self.rotate(g, self.center);
        let velocity = self.velocity_of(g, arm);
        let square = space::dot(g, velocity, velocity);
        let moving = g.mul(self.mass, square);
        let turning = match self.turn {
            RotationCoordinates::Angle => {
                let square = g.mul(self.velocity[ANGLE], self.velocity[ANGLE]);
                g.mul(self.inertia[2][2], square)
            }
            RotationCoordinates::Euler => {
                let omega = self.angular_velocity_in_body(g);
                let momentum = space::times(g, &self.inertia, omega);
                space::dot(g, momentum, omega)
            }
        };
        let doubled = g.add(moving, turning);
        g.scale(0.5, doubled)
    }
}
