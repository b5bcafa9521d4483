//! Numbers of the file as they go into a body: plain ones are computed at once, those that are parameters become
//! formulas. Vectors and rotations of them.

use std::f64::consts::{FRAC_PI_2, TAU};

use symdiff::{Formula, math};

/// A number, or the text of a formula of parameters, in parentheses if it has an operator.
#[derive(Clone, Debug)]
pub enum Value {
    Number(f64),
    Text(String),
}

pub type Vector = [Value; 3];
/// Euler parameters, from a frame to the frame around it.
pub type Quaternion = [Value; 4];

pub fn number(value: f64) -> Value {
    Value::Number(value)
}

pub fn vector(values: [f64; 3]) -> Vector {
    values.map(Value::Number)
}

impl Value {
    pub fn is_zero(&self) -> bool {
        matches!(self, Self::Number(value) if *value == 0.0)
    }

    /// Text as a part of a formula.
    pub fn text(&self) -> String {
        match self {
            // In full precision; a sign must not meet an operator.
            Self::Number(value) if *value < 0.0 => format!("({value:e})"),
            Self::Number(value) => format!("{value:e}"),
            Self::Text(text) => text.clone(),
        }
    }

    /// The formula; `None` if the text is too deeply nested.
    pub fn formula(&self) -> Option<Formula> {
        match self {
            Self::Number(value) => Some(Formula::number(*value)),
            Self::Text(text) => Formula::parse(text).ok(),
        }
    }
}

/// Plain numbers are added up first.
pub fn sum(terms: &[Value]) -> Value {
    let mut plain = 0.0;
    let mut texts = Vec::new();
    for term in terms {
        match term {
            Value::Number(value) => plain += value,
            Value::Text(text) => texts.push(text.clone()),
        }
    }
    if texts.is_empty() {
        return Value::Number(plain);
    }
    if plain != 0.0 {
        texts.push(Value::Number(plain).text());
    }
    if texts.len() == 1 { Value::Text(texts.remove(0)) } else { Value::Text(format!("({})", texts.join(" + "))) }
}

pub fn mul(a: &Value, b: &Value) -> Value {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => Value::Number(a * b),
        (Value::Number(one), other) | (other, Value::Number(one)) if *one == 1.0 => other.clone(),
        (a, b) if a.is_zero() || b.is_zero() => Value::Number(0.0),
        (a, b) => Value::Text(format!("({}*{})", a.text(), b.text())),
    }
}

pub fn neg(a: &Value) -> Value {
    mul(&Value::Number(-1.0), a)
}

pub fn sub(a: &Value, b: &Value) -> Value {
    sum(&[a.clone(), neg(b)])
}

pub fn div(a: &Value, b: &Value) -> Value {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => Value::Number(a / b),
        (a, b) => Value::Text(format!("({}/{})", a.text(), b.text())),
    }
}

/// cos and sin of half an angle.
fn half(angle: &Value) -> [Value; 2] {
    match angle {
        Value::Number(angle) => [math::cos(angle / 2.0), math::sin(angle / 2.0)].map(Value::Number),
        Value::Text(text) => ["cos", "sin"].map(|function| Value::Text(format!("{function}({text}/2)"))),
    }
}

pub fn add(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| sum(&[a[i].clone(), b[i].clone()]))
}

pub fn identity() -> Quaternion {
    [1.0, 0.0, 0.0, 0.0].map(Value::Number)
}

/// p ∘ q: first q, then p.
pub fn product(p: &Quaternion, q: &Quaternion) -> Quaternion {
    // Rows of the product's matrix: index into q and sign of each p.
    const ROWS: [[(usize, f64); 4]; 4] = [
        [(0, 1.0), (1, -1.0), (2, -1.0), (3, -1.0)],
        [(1, 1.0), (0, 1.0), (3, 1.0), (2, -1.0)],
        [(2, 1.0), (3, -1.0), (0, 1.0), (1, 1.0)],
        [(3, 1.0), (2, 1.0), (1, -1.0), (0, 1.0)],
    ];
    ROWS.map(|row| {
        let terms: Vec<Value> =
            row.iter().zip(p).map(|(&(index, sign), p)| mul(&Value::Number(sign), &mul(p, &q[index]))).collect();
        sum(&terms)
    })
}

/// Rotation about an axis of length one.
pub fn turn(axis: [f64; 3], angle: f64) -> Quaternion {
    let (cos, sin) = (math::cos(angle / 2.0), math::sin(angle / 2.0));
    [cos, sin * axis[0], sin * axis[1], sin * axis[2]].map(Value::Number)
}

/// The opposite rotation.
pub fn inverse([w, x, y, z]: &Quaternion) -> Quaternion {
    [w.clone(), neg(x), neg(y), neg(z)]
}

/// Rotation about the fixed x, then y, then z.
pub fn roll_pitch_yaw(angles: &Vector) -> Quaternion {
    let about = |axis: usize| {
        let [cos, sin] = half(&angles[axis]);
        let mut q = [cos, number(0.0), number(0.0), number(0.0)];
        q[axis + 1] = sin;
        q
    };
    product(&about(2), &product(&about(1), &about(0)))
}

/// Roll, pitch and yaw, −π to π, of Euler parameters (cosine of half the angle first) of any length but zero.
///
/// Sums of halves of the angles come from p₁ ± p₃ and p₀ ± p₂ (Bernardes & Viollet, PLoS ONE 17 (2022) e0276302): exact
/// at a pitch of ±90° too, where only the sum or the difference of roll and yaw is determined.
pub fn angles_of([w, x, y, z]: [f64; 4]) -> [f64; 3] {
    let half_sum = math::atan2(x + z, w - y);
    let half_difference = math::atan2(x - z, w + y);
    let pitch = 2.0 * math::atan2(math::hypot(w + y, x - z), math::hypot(w - y, x + z)) - FRAC_PI_2;
    let wrapped = |angle: f64| angle - TAU * (angle / TAU).round();
    [wrapped(half_sum + half_difference), pitch, wrapped(half_sum - half_difference)]
}

/// The rotation matrix of unit Euler parameters.
pub fn matrix(q: &Quaternion) -> [Vector; 3] {
    let two = |a: usize, b: usize| mul(&number(2.0), &mul(&q[a], &q[b]));
    let diagonal = |a: usize, b: usize| sum(&[number(1.0), neg(&two(a, a)), neg(&two(b, b))]);
    [
        [diagonal(2, 3), sub(&two(1, 2), &two(0, 3)), sum(&[two(1, 3), two(0, 2)])],
        [sum(&[two(1, 2), two(0, 3)]), diagonal(1, 3), sub(&two(2, 3), &two(0, 1))],
        [sub(&two(1, 3), &two(0, 2)), sum(&[two(2, 3), two(0, 1)]), diagonal(1, 2)],
    ]
}

pub fn rotate(q: &Quaternion, v: &Vector) -> Vector {
    matrix(q).map(|row| sum(&[0, 1, 2].map(|i| mul(&row[i], &v[i]))))
}

/// A symmetric tensor in the frame around its own: R J Rᵀ.
pub fn rotate_tensor(q: &Quaternion, tensor: &[Vector; 3]) -> [Vector; 3] {
    let r = matrix(q);
    let half: [Vector; 3] =
        std::array::from_fn(|i| std::array::from_fn(|k| sum(&[0, 1, 2].map(|j| mul(&r[i][j], &tensor[j][k])))));
    std::array::from_fn(|i| std::array::from_fn(|k| sum(&[0, 1, 2].map(|j| mul(&half[i][j], &r[k][j])))))
}

/// Inertia of a point mass at d: m (d² 1 − d dᵀ).
pub fn steiner(mass: &Value, d: &Vector) -> [Vector; 3] {
    let square = sum(&[0, 1, 2].map(|i| mul(&d[i], &d[i])));
    std::array::from_fn(|i| {
        std::array::from_fn(|k| {
            let across = neg(&mul(&d[i], &d[k]));
            mul(mass, &if i == k { sum(&[square.clone(), across]) } else { across })
        })
    })
}

/// A frame in another: position, and rotation into the other.
#[derive(Clone)]
pub struct Pose {
    pub position: Vector,
    pub rotation: Quaternion,
}

impl Pose {
    pub fn identity() -> Self {
        Self { position: vector([0.0; 3]), rotation: identity() }
    }

    /// A frame in this one, in the frame around it.
    pub fn then(&self, xyz: &Vector, rotation: &Quaternion) -> Self {
        let position = add(&self.position, &rotate(&self.rotation, xyz));
        Self { position, rotation: product(&self.rotation, rotation) }
    }
}

/// The numbers, where all are.
pub fn numbers<const N: usize>(values: &[Value; N]) -> Option<[f64; N]> {
    let mut found = [0.0; N];
    for (slot, value) in found.iter_mut().zip(values) {
        let Value::Number(value) = value else { return None };
        *slot = *value;
    }
    Some(found)
}
