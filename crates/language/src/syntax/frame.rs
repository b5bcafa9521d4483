//! Placement of an instance in the model: mirrored, then turned, then moved.
//!
//! A point s of the instance is at r = g + R D s: D has the signs of its mirrors, its parameters `at.model.x`,
//! `at.model.y`, `at.model.z` are g, and `at.model.angle` or the Euler parameters `at.model.p0` … `at.model.p3` give R.
//! This module writes formulas of that, as text.

use super::mirrors::Mirrors;

/// Three components, or rows of them, as text.
pub type TextVector = [String; 3];

/// Placement of an instance; only its nonzero parts have parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InstanceFrame {
    /// D
    pub mirrors: Mirrors,
    /// Components of g that are not zero.
    pub moved: [bool; 3],
    /// R
    pub turned: Turned,
}

/// Rotation of an instance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Turned {
    /// Not at all.
    #[default]
    Not,
    /// About z, by an angle.
    ByAngle,
    /// By Euler parameters of length 1.
    InSpace,
}

/// Prefix of the names of a frame's parameters, in the instance itself.
pub const PLACE: &str = "at.model.";

/// Names of the components of g.
const POSITION: [&str; 3] = ["x", "y", "z"];

impl InstanceFrame {
    /// A frame within this one, whose `moved` and `turned` are in this one's axes.
    #[must_use]
    pub fn within(self, inner: Self) -> Self {
        let turned = match (self.turned, inner.turned) {
            (Turned::Not, turned) | (turned, Turned::Not) => turned,
            (Turned::ByAngle, Turned::ByAngle) => Turned::ByAngle,
            _ => Turned::InSpace,
        };
        let [x, y, z] = inner.moved;
        let seen = match self.turned {
            Turned::Not => inner.moved,
            Turned::ByAngle => [x || y, x || y, z],
            Turned::InSpace => [x || y || z; 3],
        };
        let moved = [0, 1, 2].map(|axis| self.moved[axis] || seen[axis]);
        Self { mirrors: self.mirrors.and(inner.mirrors), moved, turned }
    }

    /// Whether directions of the instance differ in the model by more than their signs.
    pub fn is_turned(self) -> bool {
        self.turned != Turned::Not
    }

    /// g; `place` is the prefix of the names.
    pub fn origin(self, place: &str) -> TextVector {
        [0, 1, 2].map(|axis| if self.moved[axis] { format!("{place}{}", POSITION[axis]) } else { "0".to_owned() })
    }

    /// The Euler parameters of R.
    pub fn quaternion(self, place: &str) -> [String; 4] {
        match self.turned {
            Turned::Not => ["1", "0", "0", "0"].map(str::to_owned),
            Turned::ByAngle => about_z(&format!("{place}angle")),
            Turned::InSpace => [0, 1, 2, 3].map(|index| format!("{place}p{index}")),
        }
    }

    /// The rows of R.
    pub fn rotation(self, place: &str) -> [TextVector; 3] {
        if self.turned != Turned::InSpace {
            let [cos, sin, minus] = match self.turned {
                Turned::ByAngle => {
                    let angle = format!("{place}angle");
                    [format!("cos({angle})"), format!("sin({angle})"), format!("(-sin({angle}))")]
                }
                _ => ["1", "0", "0"].map(str::to_owned),
            };
            let [zero, one] = ["0".to_owned(), "1".to_owned()];
            return [[cos.clone(), minus, zero.clone()], [sin, cos, zero.clone()], [zero.clone(), zero, one]];
        }
        let p = self.quaternion(place);
        let pair = |a: usize, b: usize| format!("{}*{}", p[a], p[b]);
        // R = (p₀² − p·p) 1 + 2 p pᵀ + 2 p₀ p̃
        let on =
            |a: usize| format!("(1 - 2*({} + {}))", pair(a % 3 + 1, a % 3 + 1), pair((a + 1) % 3 + 1, (a + 1) % 3 + 1));
        let off = |a: usize, b: usize, sign: char, c: usize| format!("(2*({} {sign} {}))", pair(a, b), pair(0, c));
        [
            [on(1), off(1, 2, '-', 3), off(1, 3, '+', 2)],
            [off(1, 2, '+', 3), on(2), off(2, 3, '-', 1)],
            [off(1, 3, '-', 2), off(2, 3, '+', 1), on(3)],
        ]
    }

    /// R v, of a vector that has the signs of D.
    pub fn turn(self, place: &str, vector: &TextVector) -> TextVector {
        self.rotation(place).map(|row| dot(&row, vector))
    }

    /// A component of D Rᵀ v.
    pub fn turn_back(self, place: &str, vector: &TextVector, axis: usize) -> String {
        let rows = self.rotation(place);
        signed(&dot(&[0, 1, 2].map(|row| rows[row][axis].clone()), vector), self.mirrors.flips(axis))
    }
}

/// Euler parameters of a rotation about z.
pub fn about_z(angle: &str) -> [String; 4] {
    about(2, angle)
}

/// Euler parameters of a rotation about an axis of the frame.
pub fn about(axis: usize, angle: &str) -> [String; 4] {
    let part = |other: usize| if other == axis { format!("sin(({angle})/2)") } else { "0".to_owned() };
    [format!("cos(({angle})/2)"), part(0), part(1), part(2)]
}

/// The product of two rotations, the second in the frame of the first.
pub fn product(first: &[String; 4], second: &[String; 4]) -> [String; 4] {
    let [a, b] = [first, second];
    let component = |terms: [(usize, usize, bool); 4]| {
        sum(terms.map(|(i, j, is_negative)| signed(&times(&a[i], &b[j]), is_negative)).iter())
    };
    [
        component([(0, 0, false), (1, 1, true), (2, 2, true), (3, 3, true)]),
        component([(0, 1, false), (1, 0, false), (2, 3, false), (3, 2, true)]),
        component([(0, 2, false), (2, 0, false), (3, 1, false), (1, 3, true)]),
        component([(0, 3, false), (3, 0, false), (1, 2, false), (2, 1, true)]),
    ]
}

/// The product of formulas.
fn times(a: &str, b: &str) -> String {
    match (a, b) {
        ("0", _) | (_, "0") => "0".to_owned(),
        ("1", other) | (other, "1") => other.to_owned(),
        _ => format!("({a})*({b})"),
    }
}

/// The sum of formulas.
pub fn sum<'t>(terms: impl Iterator<Item = &'t String>) -> String {
    let terms: Vec<&str> = terms.map(String::as_str).filter(|term| *term != "0").collect();
    match terms.as_slice() {
        [] => "0".to_owned(),
        [only] => (*only).to_owned(),
        _ => terms.iter().map(|term| format!("({term})")).collect::<Vec<_>>().join(" + "),
    }
}

/// The formula, negated if `is_negative`.
pub fn signed(text: &str, is_negative: bool) -> String {
    if is_negative && text != "0" { format!("-({text})") } else { text.to_owned() }
}

fn dot(a: &TextVector, b: &TextVector) -> String {
    sum([0, 1, 2].map(|axis| times(&a[axis], &b[axis])).iter())
}
