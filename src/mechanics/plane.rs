//! Vectors of the plane, as expressions.

use symdiff::{Expr, Graph};

/// (x, y).
pub type Vector = [Expr; 2];

/// (0, 0).
pub fn zero(g: &mut Graph) -> Vector {
    let zero = g.constant(0.0);
    [zero, zero]
}

/// `a + b`.
pub fn add(g: &mut Graph, a: Vector, b: Vector) -> Vector {
    [g.add(a[0], b[0]), g.add(a[1], b[1])]
}

/// `a − b`.
pub fn sub(g: &mut Graph, a: Vector, b: Vector) -> Vector {
    [g.sub(a[0], b[0]), g.sub(a[1], b[1])]
}

/// `factor · a`.
pub fn scale(g: &mut Graph, factor: Expr, a: Vector) -> Vector {
    [g.mul(factor, a[0]), g.mul(factor, a[1])]
}

/// `−a`.
pub fn neg(g: &mut Graph, a: Vector) -> Vector {
    [g.neg(a[0]), g.neg(a[1])]
}

/// `a · b`.
pub fn dot(g: &mut Graph, a: Vector, b: Vector) -> Expr {
    g.dot(&a, &b)
}

/// `a × b = aₓ b_y − a_y bₓ`, out of the plane; counter-clockwise is positive.
pub fn cross(g: &mut Graph, a: Vector, b: Vector) -> Expr {
    let (left, right) = (g.mul(a[0], b[1]), g.mul(a[1], b[0]));
    g.sub(left, right)
}

/// `a` turned by a right angle, counter-clockwise: (−a_y, aₓ).
pub fn perpendicular(g: &mut Graph, a: Vector) -> Vector {
    [g.neg(a[1]), a[0]]
}

/// `a / |a|`; not a number where a = 0.
pub fn unit(g: &mut Graph, a: Vector) -> Vector {
    let square = dot(g, a, a);
    let length = g.sqrt(square);
    [g.div(a[0], length), g.div(a[1], length)]
}
