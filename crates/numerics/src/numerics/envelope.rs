//! Envelope of an error that changes its sign now and then: the line through its peaks.

use symdiff::math;

/// Estimates of an error, in the order of time, none below the line from the peak before it to the one after it.
///
/// An estimate by halved steps is zero where both curves cross, where the error need not be. Between peaks the line is
/// geometric, so that an error which grows or decays over decades is not taken for the larger of its ends. After the
/// last peak its value stays for as long as the last two are apart.
pub fn envelope(estimates: &[f64]) -> Vec<f64> {
    let at = |row: usize| estimates[row];
    let is_peak = |row: &usize| {
        let before = row.checked_sub(1).map_or(0.0, at);
        let after = estimates.get(row + 1).copied().unwrap_or(0.0);
        at(*row) > 0.0 && at(*row) >= before && at(*row) >= after
    };
    let mut peaks = (0..estimates.len()).filter(is_peak).collect::<Vec<usize>>();
    // The end of a rise that goes on is no peak.
    if peaks.len() > 1 && peaks.last() == Some(&(estimates.len() - 1)) {
        let last = estimates.len() - 1;
        if peaks[peaks.len() - 2] + 1 < last {
            peaks.pop();
        }
    }
    let mut held = estimates.to_vec();
    for pair in peaks.windows(2) {
        let (first, last) = (pair[0], pair[1]);
        let (from, to) = (at(first), at(last));
        for (row, value) in held.iter_mut().enumerate().take(last).skip(first + 1) {
            let share = (row - first) as f64 / (last - first) as f64;
            let line = from * math::pow(to / from, share);
            // `max` would pass over NaN.
            *value = if *value < line { line } else { *value };
        }
    }
    if let [.., before, last] = peaks[..] {
        let until = (2 * last - before + 1).min(estimates.len());
        held[last..until].iter_mut().for_each(|value| *value = if *value < at(last) { at(last) } else { *value });
    }
    held
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn envelope_of_a_wave_holds_its_peaks() {
        let wave: Vec<f64> = (0..200).map(|row| math::sin(0.1 * f64::from(row)).abs()).collect();
        let held = envelope(&wave);
        assert!(held[16..].iter().all(|value| *value > 0.99), "{held:?}");
        assert!(held.iter().zip(&wave).all(|(held, wave)| held >= wave));
    }

    #[test]
    fn growth_and_decay_stay_as_they_are() {
        let growing: Vec<f64> = (0..100).map(|row| 1e-9 * math::exp(0.2 * f64::from(row))).collect();
        assert_eq!(envelope(&growing), growing);
        let decaying: Vec<f64> = growing.iter().rev().copied().collect();
        assert_eq!(envelope(&decaying), decaying);
        // The envelope of a wave that grows by decades follows the wave's own line.
        let wave: Vec<f64> =
            (0..300).map(|row| math::exp(0.05 * f64::from(row)) * math::sin(0.3 * f64::from(row)).abs()).collect();
        let held = envelope(&wave);
        assert!((20..280).all(
            |row| held[row] < 2.0 * math::exp(0.05 * row as f64) && held[row] > 0.5 * math::exp(0.05 * row as f64)
        ));
    }

    #[test]
    fn unknown_values_stay_unknown() {
        let held = envelope(&[0.0, 1.0, f64::NAN, 1.0, 0.5, 1.0]);
        assert!(held[2].is_nan());
        assert_eq!(envelope(&[0.0; 4]), [0.0; 4]);
        assert_eq!(envelope(&[]), Vec::<f64>::new());
    }
}
