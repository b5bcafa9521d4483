//! Bodies that are welded together as one: mass, centre of mass and inertia of all are those of the body that the others follow.
//!
//! With R the rotation from a body's axes to those of the body it is welded to, and o its origin there (`carried`),
//!
//! ```text
//! m = m₁ + m₂          m c = m₁ c₁ + m₂ (o + R c₂)
//! J = J₁ + R J₂ Rᵀ + Σ mᵢ (dᵢᵀdᵢ 1 − dᵢ dᵢᵀ),   dᵢ from c to each centre; together m₁m₂/m (dᵀd 1 − d dᵀ), d = o + R c₂ − c₁
//! ```

use symdiff::{Builder, Expr};

use super::mechanism::Mechanism;
use super::space::{self, Matrix, Vector};

/// Mass, centre of mass, inertia about it.
struct Inertial {
    mass: Expr,
    center: Vector,
    inertia: Matrix,
}

impl Mechanism<'_> {
    /// Hands the inertia of merged bodies on to what they follow.
    pub fn merge(&mut self, g: &Builder) {
        // From the ends of the trees inwards, so that each has all of its own before it hands it on.
        for &index in self.tree.order.iter().rev().filter(|&&index| self.tree.merges(index)) {
            let Some(carried) = &self.bodies[index].carried else { continue };
            let (rotation, parent) = (carried.rotation, carried.parent);
            let foot = space::times(g, &rotation, carried.foot);
            let origin = space::sub(g, carried.reach, foot);
            let body = &self.bodies[index];
            let center = space::times(g, &rotation, body.center);
            let half = space::product(g, &rotation, &body.inertia);
            let back = space::transposed(&rotation);
            let there = Inertial {
                mass: body.mass,
                center: space::add(g, origin, center),
                inertia: space::product(g, &half, &back),
            };
            let body = &self.bodies[parent];
            let here = Inertial { mass: body.mass, center: body.center, inertia: body.inertia };
            let one = together(g, here, there);
            let body = &mut self.bodies[parent];
            (body.mass, body.center, body.inertia) = (one.mass, one.center, one.inertia);
            let zero = space::zero(g);
            let body = &mut self.bodies[index];
            (body.mass, body.center, body.inertia) = (zero[0], zero, [zero; 3]);
        }
    }
}

fn together(g: &Builder, a: Inertial, b: Inertial) -> Inertial {
    let inertia = sum(g, &a.inertia, &b.inertia);
    // Without mass there is no centre, and nothing to be moved to another.
    if g.is_zero(b.mass) {
        return Inertial { inertia, ..a };
    }
    if g.is_zero(a.mass) {
        return Inertial { inertia, ..b };
    }
    let mass = g.add(a.mass, b.mass);
    let share = g.div(b.mass, mass);
    let apart = space::sub(g, b.center, a.center);
    let shift = space::scale(g, share, apart);
    let center = space::add(g, a.center, shift);
    let reduced = g.mul(a.mass, share);
    let square = space::dot(g, apart, apart);
    let steiner: Matrix = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let across = g.mul(apart[i], apart[j]);
            let entry = if i == j { g.sub(square, across) } else { g.neg(across) };
            g.mul(reduced, entry)
        })
    });
    Inertial { mass, center, inertia: sum(g, &inertia, &steiner) }
}

fn sum(g: &Builder, a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| space::add(g, a[i], b[i]))
}
