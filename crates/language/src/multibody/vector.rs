//! Vectors of space, as expressions. Vectors in the plane have z = 0, a constant that folds away.

use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub};

use symdiff::{Builder, Scalar};

/// (x, y, z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<'g>([Scalar<'g>; 3]);

impl<'g> Vector<'g> {
    /// (0, 0, 0).
    pub fn zero(g: &'g Builder) -> Self {
        Self([g.number(0.0); 3])
    }

    /// The unit vector along an axis, 0 to 2.
    pub fn along(g: &'g Builder, axis: usize) -> Self {
        let mut vector = Self::zero(g);
        vector.0[axis] = g.number(1.0);
        vector
    }

    /// x, y, z.
    pub fn components(self) -> [Scalar<'g>; 3] {
        self.0
    }

    /// Whether it is the constant 0.
    pub fn is_zero(self) -> bool {
        self.0.iter().all(|component| component.is_zero())
    }

    /// Each component's image, in order.
    pub fn map(self, image: impl FnMut(Scalar<'g>) -> Scalar<'g>) -> Self {
        Self(self.0.map(image))
    }

    /// `self · other`
    pub fn dot(self, other: Self) -> Scalar<'g> {
        self.0[0].builder().dot(&self.0, &other.0)
    }

    /// `self × other`
    pub fn cross(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self(std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            a[j] * b[k] - a[k] * b[j]
        }))
    }

    /// `other`, component by component times this.
    pub fn weighting(self, other: Self) -> Self {
        Self(std::array::from_fn(|axis| self.0[axis] * other.0[axis]))
    }

    /// Rotated about z by a right angle, counter-clockwise: (−y, x, 0).
    pub fn perpendicular(self) -> Self {
        let [x, y, _] = self.0;
        Self([-y, x, x.builder().number(0.0)])
    }

    /// `|self|`
    pub fn norm(self) -> Scalar<'g> {
        self.dot(self).sqrt()
    }

    /// `self / |self|`; NaN at zero.
    pub fn unit(self) -> Self {
        self / self.norm()
    }
}

impl<'g> From<[Scalar<'g>; 3]> for Vector<'g> {
    fn from(components: [Scalar<'g>; 3]) -> Self {
        Self(components)
    }
}

impl<'g> Index<usize> for Vector<'g> {
    type Output = Scalar<'g>;

    fn index(&self, axis: usize) -> &Scalar<'g> {
        &self.0[axis]
    }
}

impl IndexMut<usize> for Vector<'_> {
    fn index_mut(&mut self, axis: usize) -> &mut Self::Output {
        &mut self.0[axis]
    }
}

impl Add for Vector<'_> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl AddAssign for Vector<'_> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Vector<'_> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Neg for Vector<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        self.map(Neg::neg)
    }
}

impl<'g> Mul<Vector<'g>> for Scalar<'g> {
    type Output = Vector<'g>;

    fn mul(self, vector: Vector<'g>) -> Vector<'g> {
        vector.map(|component| self * component)
    }
}

impl<'g> Mul<Vector<'g>> for f64 {
    type Output = Vector<'g>;

    fn mul(self, vector: Vector<'g>) -> Vector<'g> {
        vector.map(|component| self * component)
    }
}

impl<'g> Div<Scalar<'g>> for Vector<'g> {
    type Output = Self;

    fn div(self, divisor: Scalar<'g>) -> Self {
        self.map(|component| component / divisor)
    }
}
