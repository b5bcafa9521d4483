//! Finds the greatest value along a ridge of a function of two parameters.

/// Reach across a ridge to either side, and smallest steps across it and along it, in cells.
const ACROSS: f64 = 1.5;
const FINEST_ACROSS: f64 = 1e-7;
const FINEST_ALONG: f64 = 1e-6;

/// The greatest value along a ridge of a function of two parameters, from a place near to it: for each value of one
/// parameter the greatest by the other one, near to where it was before. A ridge may have a kink across, and be curved.
pub fn along_ridge(start: &[f64], axis: usize, points: usize, f: &dyn Fn(&[f64]) -> f64) -> f64 {
    let last = (points - 1) as f64;
    let across = |own: f64, middle: f64| {
        let value = |other: f64| f(&if axis == 0 { [own, other] } else { [other, own] });
        let (lower, upper) = ((middle - ACROSS).max(0.0), (middle + ACROSS).min(last));
        let inside = by_golden_section(lower, upper, &value);
        [lower, upper].map(|end| (value(end), end)).into_iter().fold(inside, |a, b| if b.0 > a.0 { b } else { a })
    };
    let (mut own, mut step) = (start[axis], 0.25);
    let (mut best, mut middle) = across(own, start[1 - axis]);
    while step > FINEST_ALONG {
        let moved = [own + step, own - step].map(|next| next.clamp(0.0, last)).map(|next| (across(next, middle), next));
        let (found, next) = if moved[0].0.0 >= moved[1].0.0 { moved[0] } else { moved[1] };
        if found.0 > best {
            ((best, middle), own) = (found, next);
            step *= 1.5;
        } else {
            step *= 0.5;
        }
    }
    best
}

/// The greatest value of a function with one peak between two places, and where it is.
fn by_golden_section(mut lower: f64, mut upper: f64, f: &dyn Fn(f64) -> f64) -> (f64, f64) {
    let share = 0.5 * (5_f64.sqrt() - 1.0);
    let inner = |lower: f64, upper: f64| [upper - share * (upper - lower), lower + share * (upper - lower)];
    let at = |place: f64| (f(place), place);
    let [mut low, mut high] = inner(lower, upper).map(at);
    while upper - lower > FINEST_ACROSS {
        if low.0 > high.0 {
            (upper, high) = (high.1, low);
            low = at(inner(lower, upper)[0]);
        } else {
            (lower, low) = (low.1, high);
            high = at(inner(lower, upper)[1]);
        }
    }
    if low.0 > high.0 { low } else { high }
}

#[cfg(test)]
mod tests {
    use super::along_ridge;

    /// A curved ridge with a kink across, which hardly rises along: its greatest value is at an end of an interval.
    #[test]
    fn a_curved_ridge_with_a_kink_is_followed_to_its_end() {
        let f = |p: &[f64]| 1e-3 * p[1] - (p[0] - 3.7 - 0.3 * p[1] - 0.01 * p[1] * p[1]).abs();
        let start = vec![9.0, 14.0];
        for axis in [0, 1] {
            let best = along_ridge(&start, axis, 21, &f);
            assert!((best - 0.02).abs() < 1e-6, "{best}");
        }
    }
}
