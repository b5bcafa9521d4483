//! The range of the data that a plot shows.

use crate::results::Band;

/// The values that an axis has to show, and for each band whether it exceeds them.
///
/// The narrowest band and the nominal course are always in view, and so is everything up to `widest` times as wide. A
/// diverged bound, such as Taylor's over long times, would reduce the others to lines: it leaves the plot instead.
pub fn in_view(nominal: &[f64], bands: &[Band], widest: f64) -> (Vec<f64>, Vec<bool>) {
    let nominal = extent(nominal.iter());
    let extents: Vec<_> = bands.iter().map(|band| extent(band.lower.iter().chain(&band.upper))).collect();
    let union = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
    // Halved, so that the difference of the largest numbers does not overflow. Without values, half is -∞.
    let half = |(low, high): (f64, f64)| 0.5 * high - 0.5 * low;
    let whole = extents.iter().map(|&extent| union(extent, nominal)).filter(|&extent| half(extent).is_finite());
    let narrowest = whole.min_by(|&a, &b| half(a).total_cmp(&half(b))).unwrap_or(nominal);
    // A constant output has no width to compare with.
    let room = if half(narrowest) > 0.0 { (widest - 1.0) * half(narrowest) } else { f64::INFINITY };
    let view = (narrowest.0 - room, narrowest.1 + room);

    let mut values = vec![nominal.0, nominal.1];
    let mut beyond = Vec::new();
    for (low, high) in extents {
        values.extend([low.max(view.0), high.min(view.1)]);
        beyond.push(low < view.0 || high > view.1);
    }
    (values, beyond)
}

/// The lowest and the highest finite value; (∞, −∞) without values.
fn extent<'a>(values: impl Iterator<Item = &'a f64>) -> (f64, f64) {
    let finite = values.filter(|x| x.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

/// A band minus the nominal course.
pub fn deviation(band: &Band, nominal: &[f64]) -> Band {
    let less = |side: &[f64]| side.iter().zip(nominal).map(|(x, nominal)| x - nominal).collect();
    Band { lower: less(&band.lower), upper: less(&band.upper), ..band.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::Method;

    fn band(half: f64) -> Band {
        let error = BandError::default();
        Band { method: Method::Scan, lower: vec![0.0, -half, f64::NAN], upper: vec![0.0, half, half], error }
    }

    #[test]
    fn only_bands_far_wider_than_the_narrowest_are_clipped() {
        let (values, beyond) = in_view(&[0.0], &[band(5.9), band(1.0), band(7.0), band(1e300)], 6.0);
        assert_eq!(beyond, [false, false, true, true]);
        let (low, high) = extent(values.iter());
        assert_eq!((low, high), (-6.0, 6.0));
    }

    #[test]
    fn constants_and_empty_data_clip_no_band() {
        assert_eq!(in_view(&[0.0], &[band(0.0), band(3.0)], 6.0).1, [false, false]);
        assert_eq!(in_view(&[f64::NAN], &[band(f64::NAN)], 6.0).1, [false]);
        assert_eq!(in_view(&[0.0], &[band(f64::MAX), band(1.0)], 6.0).1, [true, false]);
        assert!(in_view(&[], &[], 6.0).1.is_empty());
    }
}
