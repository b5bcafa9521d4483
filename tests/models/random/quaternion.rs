//! Rotations: w, x, y, z of norm 1.

pub type Vector = [f64; 3];

#[derive(Clone, Copy, Debug)]
pub struct Quaternion(pub [f64; 4]);

impl Quaternion {
    pub const ONE: Self = Self([1.0, 0.0, 0.0, 0.0]);

    /// About z.
    pub fn about_z(angle: f64) -> Self {
        let (sin, cos) = (0.5 * angle).sin_cos();
        Self([cos, 0.0, 0.0, sin])
    }

    /// Unit quaternion along any four numbers that are not all zero.
    pub fn along(numbers: [f64; 4]) -> Self {
        let norm = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
        Self(numbers.map(|x| x / norm))
    }

    /// First the other, then this one.
    pub fn times(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([
            a * e - b * f - c * g - d * h,
            a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e,
        ])
    }

    pub fn inverse(self) -> Self {
        let [w, x, y, z] = self.0;
        Self([w, -x, -y, -z])
    }

    pub fn turn(self, [x, y, z]: Vector) -> Vector {
        let [_, x, y, z] = self.times(Self([0.0, x, y, z])).times(self.inverse()).0;
        [x, y, z]
    }
}

pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn norm(a: Vector) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}
