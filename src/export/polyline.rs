//! Curves made ready for drawing: broken at gaps, thinned where there are more points than pixels.

/// A curve with more points than this is thinned to about as many: more than a plot has pixels.
const LIMIT: usize = 1200;

/// A point (t, y).
pub(super) type Point = (f64, f64);

/// The curve's pieces between gaps (anything that is not finite), each thinned.
pub(super) fn pieces(times: &[f64], values: &[f64]) -> Vec<Vec<Point>> {
    let bucket = bucket(times.len());
    split(times, |i| [values[i]]).into_iter().map(|piece| thin(&piece, 0, bucket)).collect()
}

/// The band's pieces where both its sides are finite: (lower side, upper side), each thinned.
pub(super) fn band_pieces(times: &[f64], lower: &[f64], upper: &[f64]) -> Vec<(Vec<Point>, Vec<Point>)> {
    let bucket = bucket(times.len());
    let pieces = split(times, |i| [lower[i], upper[i]]);
    pieces.into_iter().map(|piece| (thin(&piece, 0, bucket), thin(&piece, 1, bucket))).collect()
}

/// How many neighbouring points of a curve are drawn as two.
fn bucket(points: usize) -> usize {
    // Two points, the lowest and the highest, stand for each bucket.
    if points <= LIMIT { 1 } else { points.div_ceil(LIMIT / 2) }
}

/// Runs of points at which the time and all of `values` are finite.
fn split<const N: usize>(times: &[f64], values: impl Fn(usize) -> [f64; N]) -> Vec<Vec<(f64, [f64; N])>> {
    let mut pieces = Vec::new();
    let mut piece = Vec::new();
    for (i, &t) in times.iter().enumerate() {
        let y = values(i);
        if t.is_finite() && y.iter().all(|y| y.is_finite()) {
            piece.push((t, y));
        } else if !piece.is_empty() {
            pieces.push(std::mem::take(&mut piece));
        }
    }
    if !piece.is_empty() {
        pieces.push(piece);
    }
    pieces
}

/// One side of a piece with the lowest and the highest of every `bucket` points kept, as well as both ends.
fn thin<const N: usize>(piece: &[(f64, [f64; N])], side: usize, bucket: usize) -> Vec<Point> {
    let point = |&(t, y): &(f64, [f64; N])| (t, y[side]);
    if bucket <= 2 {
        return piece.iter().map(point).collect();
    }
    let mut kept = Vec::new();
    for (start, points) in (0..).step_by(bucket).zip(piece.chunks(bucket)) {
        let (mut low, mut high) = (0, 0);
        for (i, (_, y)) in points.iter().enumerate() {
            if y[side] < points[low].1[side] {
                low = i;
            }
            if y[side] > points[high].1[side] {
                high = i;
            }
        }
        kept.extend([start + low.min(high), start + low.max(high)]);
    }
    kept.insert(0, 0);
    kept.push(piece.len().saturating_sub(1));
    kept.dedup();
    kept.into_iter().filter_map(|i| piece.get(i)).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_break_a_line() {
        let times = [0.0, 1.0, 2.0, 3.0, 4.0, f64::NAN];
        let values = [f64::NAN, 1.0, 2.0, f64::INFINITY, 4.0, 5.0];
        assert_eq!(pieces(&times, &values), [vec![(1.0, 1.0), (2.0, 2.0)], vec![(4.0, 4.0)]]);
        let upper = [1.0, 1.5, f64::NAN, 1.0, 5.0, 6.0];
        assert_eq!(
            band_pieces(&times, &values, &upper),
            [(vec![(1.0, 1.0)], vec![(1.0, 1.5)]), (vec![(4.0, 4.0)], vec![(4.0, 5.0)])]
        );
        assert!(pieces(&times[..1], &values[..1]).is_empty());
    }

    #[test]
    fn thinning_keeps_ends_and_extremes() {
        let n = 100_000;
        let times: Vec<f64> = (0..n).map(f64::from).collect();
        let mut values: Vec<f64> = times.iter().map(|t| (t / 500.0).sin()).collect();
        values[77_777] = 9.0;
        values[3] = -9.0;
        let [line] = &pieces(&times, &values)[..] else { panic!("one piece") };
        assert!(line.len() <= LIMIT + 2, "{}", line.len());
        assert!(line.contains(&(77_777.0, 9.0)) && line.contains(&(3.0, -9.0)));
        assert_eq!(line[0], (0.0, values[0]));
        assert_eq!(line[line.len() - 1].0, f64::from(n - 1));
        assert!(line.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn few_points_stay_as_they_are() {
        let times: Vec<f64> = (0..2001).map(f64::from).collect();
        let [line] = &pieces(&times[..LIMIT], &times[..LIMIT])[..] else { panic!("one piece") };
        assert_eq!(line.len(), LIMIT);
        let [line] = &pieces(&times, &times)[..] else { panic!("one piece") };
        assert!(line.len() <= LIMIT + 2);
    }
}
