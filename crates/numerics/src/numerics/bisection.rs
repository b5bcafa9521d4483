//! Bisection.

/// The end beyond a change, between a number before it and one beyond it, after `bisections` bisections.
pub fn bisected(mut before: f64, mut beyond: f64, bisections: usize, is_beyond: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..bisections {
        let middle = 0.5 * (before + beyond);
        if is_beyond(middle) {
            beyond = middle;
        } else {
            before = middle;
        }
    }
    beyond
}

#[cfg(test)]
mod tests {
    use super::bisected;

    #[test]
    fn the_change_is_found_from_either_side() {
        let root = 2.0_f64.sqrt();
        assert!((bisected(1.0, 2.0, 52, |x| x * x >= 2.0) - root).abs() < 1e-15);
        assert!((bisected(2.0, 1.0, 52, |x| x * x <= 2.0) - root).abs() < 1e-15);
    }
}
