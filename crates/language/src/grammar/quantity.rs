//! Dimensions of quantities.

use std::fmt;

use symdiff::math;

/// Exponents are counted in twelfths, so that square and cube roots stay exact.
const ONE: i32 = 12;

/// Dimension of a quantity: powers of m, kg, s and rad.
///
/// An angle is a pure number; its power is stored only to print `rad/s` instead of `1/s`. [`Dimension::fits`] ignores
/// it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Dimension {
    length: i32,
    mass: i32,
    time: i32,
    angle: i32,
}

impl Dimension {
    /// The dimension with these whole powers of m, kg, s and rad.
    const fn of(length: i32, mass: i32, time: i32, angle: i32) -> Self {
        Self { length: length * ONE, mass: mass * ONE, time: time * ONE, angle: angle * ONE }
    }

    /// 1
    pub const NUMBER: Self = Self::of(0, 0, 0, 0);
    /// m
    pub const LENGTH: Self = Self::of(1, 0, 0, 0);
    /// m³
    pub const VOLUME: Self = Self::of(3, 0, 0, 0);
    /// m³/s
    pub const VOLUME_FLOW: Self = Self::of(3, 0, -1, 0);
    /// kg
    pub const MASS: Self = Self::of(0, 1, 0, 0);
    /// s
    pub const TIME: Self = Self::of(0, 0, 1, 0);
    /// 1/s
    pub const FREQUENCY: Self = Self::of(0, 0, -1, 0);
    /// rad
    pub const ANGLE: Self = Self::of(0, 0, 0, 1);
    /// m/s
    pub const VELOCITY: Self = Self::of(1, 0, -1, 0);
    /// m/s²
    pub const ACCELERATION: Self = Self::of(1, 0, -2, 0);
    /// rad/s
    pub const ANGULAR_VELOCITY: Self = Self::of(0, 0, -1, 1);
    /// rad/s²
    pub const ANGULAR_ACCELERATION: Self = Self::of(0, 0, -2, 1);
    /// kg m²
    pub const INERTIA: Self = Self::of(2, 1, 0, 0);
    /// N
    pub const FORCE: Self = Self::of(1, 1, -2, 0);
    /// N m, and J
    pub const TORQUE: Self = Self::of(2, 1, -2, 0);
    /// W
    pub const POWER: Self = Self::of(2, 1, -3, 0);
    /// Pa
    pub const PRESSURE: Self = Self::of(-1, 1, -2, 0);
    /// N/m
    pub const STIFFNESS: Self = Self::of(0, 1, -2, 0);
    /// N s/m
    pub const DAMPING: Self = Self::of(0, 1, -1, 0);
    /// N m/rad
    pub const TORSIONAL_STIFFNESS: Self = Self::of(2, 1, -2, -1);
    /// N m s/rad
    pub const TORSIONAL_DAMPING: Self = Self::of(2, 1, -1, -1);
}

/// Dimensions that have a name, and the unit they are written in.
const NAMED: [(Dimension, &str, &str); 20] = [
    (Dimension::ANGLE, "rad", "an angle"),
    (Dimension::NUMBER, "", "a pure number"),
    (Dimension::LENGTH, "m", "a length"),
    (Dimension::MASS, "kg", "a mass"),
    (Dimension::TIME, "s", "a time"),
    (Dimension::VELOCITY, "m/s", "a velocity"),
    (Dimension::ACCELERATION, "m/s^2", "an acceleration"),
    (Dimension::ANGULAR_VELOCITY, "rad/s", "an angular velocity"),
    (Dimension::ANGULAR_ACCELERATION, "rad/s^2", "an angular acceleration"),
    (Dimension { angle: 0, ..Dimension::ANGULAR_VELOCITY }, "1/s", "a rate"),
    (Dimension::INERTIA, "kg*m^2", "a moment of inertia"),
    (Dimension::FORCE, "N", "a force"),
    (Dimension::TORSIONAL_STIFFNESS, "N*m/rad", "a torsional stiffness"),
    (Dimension::TORSIONAL_DAMPING, "N*m*s/rad", "a torsional damping"),
    (Dimension { angle: 0, ..Dimension::TORSIONAL_DAMPING }, "N*m*s", "a torsional damping"),
    (Dimension::STIFFNESS, "N/m", "a stiffness"),
    (Dimension::DAMPING, "N*s/m", "a damping"),
    (Dimension::TORQUE, "N*m", "a torque or an energy"),
    (Dimension::POWER, "W", "a power"),
    (Dimension::PRESSURE, "Pa", "a pressure"),
];

impl Dimension {
    /// Encodes the dimension as one number, for terms of formulas: whole powers of m, kg, s and rad, 16 bits each.
    pub fn mark(self) -> u64 {
        let powers = [self.length, self.mass, self.time, self.angle];
        // Units have whole powers; a power beyond 16 bits fits nothing.
        let bits = |power: i32| u64::from((power / ONE).clamp(-0x7fff, 0x7fff) as i16 as u16);
        powers.into_iter().fold(0, |mark, power| mark << 16 | bits(power))
    }

    /// Whole powers of m, kg, s and rad; fractions of powers are cut off.
    pub fn powers(self) -> [i32; 4] {
        [self.length, self.mass, self.time, self.angle].map(|power| power / ONE)
    }

    /// Decodes a mark.
    pub fn of_mark(mark: u64) -> Self {
        let power = |index: u32| i32::from((mark >> (16 * index)) as u16 as i16);
        Self::of(power(3), power(2), power(1), power(0))
    }

    /// A quantity of this dimension made of a length, a mass and two times: the first of several times in the
    /// denominator is `time`, all others are `others`.
    pub fn size(self, [length, mass, time, others]: [f64; 4]) -> f64 {
        let power = |base: f64, exponent: i32| math::pow(base, f64::from(exponent) / f64::from(ONE));
        let times = match self.time {
            below if below < -ONE => power(time, -ONE) * power(others, below + ONE),
            own => power(time, own),
        };
        power(length, self.length) * power(mass, self.mass) * times
    }

    /// Whether quantities of the two may be added or replace one another.
    pub fn fits(self, other: Self) -> bool {
        Self { angle: 0, ..self } == Self { angle: 0, ..other }
    }

    /// Whether it is a quantity per angle.
    pub fn is_per_angle(self) -> bool {
        self.angle < 0
    }

    /// Dimension of the generalised force on a coordinate of this dimension: N on a length, N m on an angle.
    pub fn conjugate(self) -> Self {
        Self::TORQUE.per(Self { angle: 0, ..self })
    }

    /// Dimension of a product.
    pub fn times(self, other: Self) -> Self {
        self.zip(other, i32::saturating_add)
    }

    /// Dimension of a quotient.
    pub fn per(self, other: Self) -> Self {
        self.zip(other, i32::saturating_sub)
    }

    fn zip(self, other: Self, combine: impl Fn(i32, i32) -> i32) -> Self {
        Self {
            length: combine(self.length, other.length),
            mass: combine(self.mass, other.mass),
            time: combine(self.time, other.time),
            angle: combine(self.angle, other.angle),
        }
    }

    /// Dimension of a power; `None` if an exponent would not be a multiple of 1/12, or would be absurdly large.
    pub fn to_the(self, exponent: f64) -> Option<Self> {
        let scale = |own: i32| {
            let scaled = f64::from(own) * exponent;
            let rounded = scaled.round();
            ((scaled - rounded).abs() < 1e-9 && rounded.abs() < 1e6).then_some(rounded as i32)
        };
        Some(Self {
            length: scale(self.length)?,
            mass: scale(self.mass)?,
            time: scale(self.time)?,
            angle: scale(self.angle)?,
        })
    }

    /// Dimension of a sum: an angle only if both terms are.
    pub fn of_sum(self, other: Self) -> Self {
        if self.angle == other.angle { self } else { Self { angle: 0, ..self } }
    }

    fn named(self) -> Option<(&'static str, &'static str)> {
        let find = |wanted: Self| NAMED.iter().find(|(dimension, ..)| *dimension == wanted);
        let found = find(self).or_else(|| find(Self { angle: 0, ..self }));
        found.map(|(_, unit, noun)| (*unit, *noun))
    }

    /// The quantity in words, without an article: `length`.
    pub fn noun(self) -> String {
        match self.named() {
            Some((_, noun)) => noun.trim_start_matches("an ").trim_start_matches("a ").to_owned(),
            None => "quantity".to_owned(),
        }
    }

    /// Whether the quantity has a name.
    pub fn is_named(self) -> bool {
        self.named().is_some()
    }

    /// The SI unit as written; empty for pure numbers.
    pub fn unit(self) -> String {
        if let Some((unit, _)) = self.named() {
            return unit.to_owned();
        }
        let mut above = Vec::new();
        let mut below = Vec::new();
        for (name, exponent) in [("kg", self.mass), ("m", self.length), ("s", self.time)] {
            let power = match exponent.abs() {
                ONE => name.to_owned(),
                whole if whole % ONE == 0 => format!("{name}^{}", whole / ONE),
                broken => format!("{name}^{:.3}", f64::from(broken) / f64::from(ONE)),
            };
            match exponent.signum() {
                1 => above.push(power),
                -1 => below.push(power),
                _ => {}
            }
        }
        let above = if above.is_empty() { "1".to_owned() } else { above.join("*") };
        below.into_iter().fold(above, |unit, divisor| format!("{unit}/{divisor}"))
    }
}

/// For messages: `a length (m)`.
impl fmt::Display for Dimension {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.named() {
            Some(("", noun)) => formatter.write_str(noun),
            Some((unit, noun)) => write!(formatter, "{noun} ({unit})"),
            None => write!(formatter, "a quantity in {}", self.unit()),
        }
    }
}
