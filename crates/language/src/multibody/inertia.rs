//! Inertia of a rigid body: its part of M w − Q.
//!
//! With the centre of mass at s = s_c, d'Alembert's m r̈_c and J ω̇ projected on the coordinates of a body that turns
//! by θ are, a = R s being its arm and θ̇² a the level part of the centripetal acceleration,
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
//! J is taken about the centre of mass. 4 Gᵀ J₀ G is singular: it is zero for a change of |p|. The term with μ makes M
//! positive definite and changes no motion, since it acts along p, where the multiplier of pᵀp = 1 takes it up.

use symdiff::{Builder, Scalar};

use super::body::{ANGLE, Body, DEGREES_OF_FREEDOM, EULER, RotationCoordinates, stacked};
use super::matrix::Matrix;
use super::vector::Vector;

/// M and Q of all coordinates of a body, prescribed ones included.
struct Inertia<'g> {
    mass: [[Scalar<'g>; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM],
    force: [Scalar<'g>; DEGREES_OF_FREEDOM],
}

impl<'g> Body<'g> {
    /// Adds the body's entries (row, column, value) to M and its velocity-dependent inertial forces to Q. A prescribed
    /// coordinate that moves drives the others through its column of M.
    pub fn add_inertia(&self, mass: &mut Vec<(usize, usize, Scalar<'g>)>, force: &mut [Scalar<'g>]) {
        if self.has_no_coordinates() {
            return;
        }
        let inertia = match self.rotation_coordinates {
            RotationCoordinates::Angle => self.inertia_by_angle(),
            RotationCoordinates::Euler => self.inertia_by_euler(),
        };
        for (dof, entries) in inertia.mass.iter().enumerate() {
            let Some(row) = self.index[dof] else { continue };
            force[row] += inertia.force[dof];
            for (other, &value) in entries.iter().enumerate() {
                match self.index[other] {
                    Some(column) if !value.is_zero() => mass.push((row, column, value)),
                    Some(_) => {}
                    None => force[row] -= value * self.acceleration[other],
                }
            }
        }
    }

    /// M with m as its only entries.
    fn mass_alone(&self, g: &'g Builder) -> [[Scalar<'g>; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
        let mut matrix = [[g.number(0.0); DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
        (0..3).for_each(|i| matrix[i][i] = self.mass);
        matrix
    }

    fn inertia_by_angle(&self) -> Inertia<'g> {
        let g = self.mass.builder();
        let zero = g.number(0.0);
        let arm = self.rotate(self.center);
        let moment = self.mass * arm;
        let level = Vector::from([self.center[0], self.center[1], zero]);
        let offset = self.mass * level.dot(level);
        let mut mass = self.mass_alone(g);
        let x_angle = -moment[1];
        (mass[0][ANGLE], mass[ANGLE][0]) = (x_angle, x_angle);
        (mass[1][ANGLE], mass[ANGLE][1]) = (moment[0], moment[0]);
        mass[ANGLE][ANGLE] = self.inertia[2][2] + offset;

        let strength = self.mass * (self.velocity[ANGLE] * self.velocity[ANGLE]);
        let mut force = [zero; DEGREES_OF_FREEDOM];
        force[0] = strength * arm[0];
        force[1] = strength * arm[1];
        Inertia { mass, force }
    }

    fn inertia_by_euler(&self) -> Inertia<'g> {
        let g = self.mass.builder();
        let p = self.euler();
        let r = p.matrix();
        let rates = p.body_rates();
        let about_origin = self.inertia_about_origin();
        let mut mass = self.mass_alone(g);

        // −2 m R s̃ G: column j is 2 m R (G_j × s).
        for j in 0..4 {
            let across = rates.column(j).cross(self.center);
            for (i, row) in r.rows().into_iter().enumerate() {
                let entry = 2.0 * (self.mass * row.dot(across));
                (mass[i][EULER + j], mass[EULER + j][i]) = (entry, entry);
            }
        }
        let stretch = 1.0 / 3.0 * about_origin.trace();
        for j in 0..4 {
            let turned = about_origin * rates.column(j);
            for i in j..4 {
                let entry = 4.0 * (rates.column(i).dot(turned) + stretch * (p[i] * p[j]));
                (mass[EULER + i][EULER + j], mass[EULER + j][EULER + i]) = (entry, entry);
            }
        }

        let pull = self.mass * self.centripetal(self.rotate(self.center));
        let omega = self.angular_velocity_in_body();
        let gyroscopic = (about_origin * omega).cross(omega);
        Inertia { mass, force: stacked(pull, rates.transposed_times(2.0, gyroscopic)) }
    }

    /// J₀ = J + m (sᵀs 1 − s sᵀ).
    pub fn inertia_about_origin(&self) -> Matrix<'g> {
        let s = self.center;
        let square = s.dot(s);
        Matrix::from_fn(|i, j| {
            let product = s[i] * s[j];
            let spread = if i == j { square - product } else { -product };
            self.inertia[i][j] + self.mass * spread
        })
    }

    /// ½ m |ṙ_c|² + ½ ω'ᵀ J ω', J.
    pub fn kinetic_energy(&self) -> Scalar<'g> {
        let velocity = self.velocity_of(self.rotate(self.center));
        let moving = self.mass * velocity.dot(velocity);
        let rotating = match self.rotation_coordinates {
            RotationCoordinates::Angle => {
                let square = self.velocity[ANGLE] * self.velocity[ANGLE];
                self.inertia[2][2] * square
            }
            RotationCoordinates::Euler => {
                let omega = self.angular_velocity_in_body();
                (self.inertia * omega).dot(omega)
            }
        };
        0.5 * (moving + rotating)
    }
}
