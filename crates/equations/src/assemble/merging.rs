//! Bodies that are welded together as one: mass, centre of mass and inertia of all are those of the body that the
//! others follow.
//!
//! With R the rotation from a body's axes to those of the body it is welded to, and o its origin there (`child`),
//!
//! ```text
//! m = m₁ + m₂          m c = m₁ c₁ + m₂ (o + R c₂)
//! J = J₁ + R J₂ Rᵀ + Σ mᵢ (dᵢᵀdᵢ 1 − dᵢ dᵢᵀ)          dᵢ from c to each centre
//!   = J₁ + R J₂ Rᵀ + m₁m₂/m (dᵀd 1 − d dᵀ)             d = o + R c₂ − c₁
//! ```

use symdiff::Scalar;

use super::mechanism::Mechanism;
use crate::multibody::{Body, Matrix, Vector};

/// Mass, centre of mass, inertia about it.
struct Inertial<'g> {
    mass: Scalar<'g>,
    center: Vector<'g>,
    inertia: Matrix<'g>,
}

impl<'g> Inertial<'g> {
    fn of(body: &Body<'g>) -> Self {
        Self { mass: body.mass, center: body.center, inertia: body.inertia }
    }

    fn give_to(self, body: &mut Body<'g>) {
        (body.mass, body.center, body.inertia) = (self.mass, self.center, self.inertia);
    }
}

impl Mechanism<'_, '_> {
    /// Adds the inertia of merged bodies to the bodies they follow.
    pub fn merge(&mut self) {
        // From the ends of the trees inwards, so that each has all of its own before it hands it on.
        for &index in self.tree.order.iter().rev().filter(|&&index| self.tree.merges(index)) {
            let body = &self.bodies[index];
            let Some(motion) = &body.relative_motion else { continue };
            let rotation = motion.rotation;
            let origin = motion.outboard_in_parent - rotation * motion.outboard_in_child;
            let center = rotation * body.center;
            let half = rotation * body.inertia;
            let center = origin + center;
            let there = Inertial { mass: body.mass, center, inertia: half * rotation.transposed() };
            let parent = motion.parent;
            together(Inertial::of(&self.bodies[parent]), there).give_to(&mut self.bodies[parent]);
            let nothing =
                Inertial { mass: self.g.number(0.0), center: Vector::zero(self.g), inertia: Matrix::zero(self.g) };
            nothing.give_to(&mut self.bodies[index]);
        }
    }
}

fn together<'g>(a: Inertial<'g>, b: Inertial<'g>) -> Inertial<'g> {
    let inertia = a.inertia + b.inertia;
    // Without mass there is no centre, and nothing to be moved to another.
    if b.mass.is_zero() {
        return Inertial { inertia, ..a };
    }
    if a.mass.is_zero() {
        return Inertial { inertia, ..b };
    }
    let mass = a.mass + b.mass;
    let share = b.mass / mass;
    let apart = b.center - a.center;
    let center = a.center + share * apart;
    let reduced = a.mass * share;
    let square = apart.dot(apart);
    let steiner = Matrix::from_fn(|i, j| {
        let across = apart[i] * apart[j];
        let entry = if i == j { square - across } else { -across };
        reduced * entry
    });
    Inertial { mass, center, inertia: inertia + steiner }
}
