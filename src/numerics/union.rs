//! The range of two parts of a box together, with its error.

use super::range::Range;

/// Of no part yet.
pub const EMPTY: Range = Range { lower: f64::INFINITY, upper: f64::NEG_INFINITY };

/// The range of two parts together. Its error is how far its ends may lie from the true ones, given those of the parts'.
pub fn union((a, of_a): (Range, f64), (b, of_b): (Range, f64)) -> (Range, f64) {
    if a == EMPTY || b.lower.is_nan() {
        return (b, of_b);
    }
    if a.lower.is_nan() {
        return (a, of_a);
    }
    let range = Range { lower: a.lower.min(b.lower), upper: a.upper.max(b.upper) };
    let outer = |x: f64, y: f64, end: f64| (x.max(y) - end).abs();
    let above =
        outer(a.upper + of_a, b.upper + of_b, range.upper).max(outer(a.upper - of_a, b.upper - of_b, range.upper));
    let below =
        outer(of_a - a.lower, of_b - b.lower, -range.lower).max(outer(-of_a - a.lower, -of_b - b.lower, -range.lower));
    let error = if of_a.is_nan() || of_b.is_nan() { f64::NAN } else { above.max(below) };
    (range, error)
}

#[cfg(test)]
mod tests {
    use super::*;

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
