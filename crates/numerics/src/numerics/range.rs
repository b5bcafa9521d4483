//! Intervals, and the range over two parts of a box with its error.

/// An interval; NaN at both ends if the bounded quantity is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
}

impl Range {
    /// Range of values that cannot be bounded.
    pub const UNKNOWN: Self = Self { lower: f64::NAN, upper: f64::NAN };

    /// Range from the least to the largest value; unknown if there are none or one is NaN.
    pub fn of(values: &[f64]) -> Self {
        if values.is_empty() || values.iter().any(|value| value.is_nan()) {
            return Self::UNKNOWN;
        }
        let (lower, upper) = limits(values);
        Self { lower, upper }
    }

    /// Upper less lower end.
    pub fn width(self) -> f64 {
        self.upper - self.lower
    }

    /// Distance of `value` outside; NaN for an unknown range.
    pub fn distance(self, value: f64) -> f64 {
        if self.contains(value) { 0.0 } else { (self.lower - value).max(value - self.upper) }
    }

    /// Widened to values from the least to the largest of others; an unknown range stays unknown, and an empty one
    /// changes nothing.
    pub fn with(self, others: Self) -> Self {
        if self.lower.is_nan() || others == EMPTY {
            return self;
        }
        Self { lower: least(self.lower, others.lower), upper: most(self.upper, others.upper) }
    }

    /// Largest distance outside of values from the least to the largest of others; zero if there are none, NaN for an
    /// unknown range.
    pub fn misses(self, others: Self) -> f64 {
        if others == EMPTY { 0.0 } else { self.distance(others.lower).max(self.distance(others.upper)) }
    }

    /// Whether `value` lies within, ends included; nothing lies within the unknown.
    pub fn contains(self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }
}

/// Known parts of a range: it lies within `outer`, and holds `attained`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosed {
    /// Contains the range.
    pub outer: Range,
    /// Part of the range that is attained.
    pub attained: Range,
}

impl Enclosed {
    /// Enclosure of values that cannot be bounded.
    pub const UNKNOWN: Self = Self { outer: Range::UNKNOWN, attained: Range::UNKNOWN };

    /// How much too wide `outer` may be, at the worse end.
    pub fn excess(self) -> f64 {
        let Self { outer, attained } = self;
        let excess = (attained.lower - outer.lower).max(outer.upper - attained.upper);
        // Rounding may have put the one past the other.
        if excess < 0.0 { 0.0 } else { excess }
    }
}

/// The smaller of two; NaN does not count. Of zeros with two signs it is the first: `f64::min` leaves that to the
/// processor, and a sign is a bit of the results.
pub fn least(a: f64, b: f64) -> f64 {
    if b < a || a.is_nan() { b } else { a }
}

/// The larger of two, likewise.
pub fn most(a: f64, b: f64) -> f64 {
    if b > a || a.is_nan() { b } else { a }
}

/// The larger of two; NaN if either is.
pub fn larger(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

/// Range of no part yet.
pub const EMPTY: Range = Range { lower: f64::INFINITY, upper: f64::NEG_INFINITY };

/// The range of two parts together. Its error is how far its ends may lie from the true ones, given those of the
/// parts'.
pub fn union((a, of_a): (Range, f64), (b, of_b): (Range, f64)) -> (Range, f64) {
    if a == EMPTY || b.lower.is_nan() {
        return (b, of_b);
    }
    if a.lower.is_nan() {
        return (a, of_a);
    }
    let range = Range { lower: least(a.lower, b.lower), upper: most(a.upper, b.upper) };
    let above = error_of_larger([a.upper, b.upper], [of_a, of_b]);
    let below = error_of_larger([-a.lower, -b.lower], [of_a, of_b]);
    (range, above.max(below))
}

/// Largest distance of the larger of two values from the larger of the true ones, given the errors of both; NaN if one
/// is unknown.
pub fn error_of_larger([a, b]: [f64; 2], [of_a, of_b]: [f64; 2]) -> f64 {
    let [above, below] = [1.0, -1.0].map(|sign| (a + sign * of_a).max(b + sign * of_b) - a.max(b));
    // `max` passes over NaN.
    if of_a.is_nan() || of_b.is_nan() { f64::NAN } else { above.abs().max(below.abs()) }
}

/// Number of values that are compared at once.
const LANES: usize = 16;

/// Least and largest of some values; NaN does not count. (In lanes, which need not wait for each other.)
pub fn limits(values: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    for values in values.chunks(LANES) {
        for ((low, high), &value) in low.iter_mut().zip(&mut high).zip(values) {
            *low = if value < *low { value } else { *low };
            *high = if value > *high { value } else { *high };
        }
    }
    (low.into_iter().fold(f64::INFINITY, least), high.into_iter().fold(f64::NEG_INFINITY, most))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_of_two_zeros_is_returned() {
        let zeros = [0.0, -0.0_f64];
        for (a, b) in zeros.into_iter().flat_map(|a| zeros.map(|b| (a, b))) {
            assert_eq!([least(a, b), most(a, b)].map(f64::to_bits), [a, a].map(f64::to_bits));
        }
        assert_eq!([least(f64::NAN, 1.0), most(1.0, f64::NAN), least(2.0, 1.0), most(1.0, 2.0)], [1.0, 1.0, 1.0, 2.0]);
    }

    #[test]
    fn a_union_has_the_error_of_its_ends() {
        let range = |lower, upper| Range { lower, upper };
        let (all, error) = union((range(0.0, 1.0), 0.1), (range(0.5, 2.0), 0.01));
        assert_eq!(all, range(0.0, 2.0));
        assert!((error - 0.1).abs() < 1e-15);
        // An end that another part might go beyond.
        let (_, error) = union((range(0.0, 1.0), 0.01), (range(0.5, 0.99), 0.2));
        assert!((error - 0.19).abs() < 1e-15);
        assert!(union((range(0.0, 1.0), 0.0), (Range::UNKNOWN, f64::NAN)).0.lower.is_nan());
        assert_eq!(union((EMPTY, 0.0), (range(0.0, 1.0), 0.5)), (range(0.0, 1.0), 0.5));
    }
}
