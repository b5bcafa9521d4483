//! Vectors of space, as expressions. What stays in the plane has z = 0, a constant that folds away.

use symdiff::{Builder, Expr};

/// (x, y, z).
pub type Vector = [Expr; 3];

/// By rows.
pub type Matrix = [Vector; 3];

/// (0, 0, 0).
pub fn zero(g: &Builder) -> Vector {
    [g.constant(0.0); 3]
}

/// The unit vector along an axis, 0 to 2.
pub fn along(g: &Builder, axis: usize) -> Vector {
    let mut vector = zero(g);
    vector[axis] = g.constant(1.0);
    vector
}

/// `a + b`.
pub fn add(g: &Builder, a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| g.add(a[i], b[i]))
}

/// `a − b`.
pub fn sub(g: &Builder, a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| g.sub(a[i], b[i]))
}

/// `factor · a`.
pub fn scale(g: &Builder, factor: Expr, a: Vector) -> Vector {
    a.map(|component| g.mul(factor, component))
}

/// `−a`.
pub fn neg(g: &Builder, a: Vector) -> Vector {
    a.map(|component| g.neg(component))
}

/// `a · b`.
pub fn dot(g: &Builder, a: Vector, b: Vector) -> Expr {
    g.dot(&a, &b)
}

/// `a × b`.
pub fn cross(g: &Builder, a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (left, right) = (g.mul(a[j], b[k]), g.mul(a[k], b[j]));
        g.sub(left, right)
    })
}

/// `a` turned about z by a right angle, counter-clockwise: (−a_y, aₓ, 0).
pub fn perpendicular(g: &Builder, a: Vector) -> Vector {
    [g.neg(a[1]), a[0], g.constant(0.0)]
}

/// `|a|`.
pub fn norm(g: &Builder, a: Vector) -> Expr {
    let square = dot(g, a, a);
    g.sqrt(square)
}

/// `a / |a|`; NaN where a = 0.
pub fn unit(g: &Builder, a: Vector) -> Vector {
    let length = norm(g, a);
    a.map(|component| g.div(component, length))
}

/// `A a`.
pub fn times(g: &Builder, matrix: &Matrix, a: Vector) -> Vector {
    matrix.map(|row| dot(g, row, a))
}

/// `Aᵀ`.
pub fn transposed(matrix: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[j][i]))
}

/// `A B`.
pub fn product(g: &Builder, left: &Matrix, right: &Matrix) -> Matrix {
    let columns = transposed(right);
    left.map(|row| columns.map(|column| dot(g, row, column)))
}
