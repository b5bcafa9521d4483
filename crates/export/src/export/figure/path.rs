//! Curves prepared for drawing: broken at gaps, and without points that are invisible.
//!
//! Within a column of pixels the first, the last, the lowest and the highest point stay, which is all that a screen
//! shows of a curve (Jugel et al., Proc. VLDB Endow. 7 (2014) 797). Of the rest, points on a straight line between
//! others are removed (Douglas and Peucker, Cartographica 10 (1973) 112).

use crate::export::tuning::TUNING;

/// A point, px.
pub type Point = (f64, f64);

/// Runs of rows at which all of `values` are finite.
pub fn runs<const N: usize>(values: [&[f64]; N]) -> Vec<std::ops::Range<usize>> {
    let rows = values.iter().map(|values| values.len()).min().unwrap_or(0);
    let mut runs = Vec::new();
    let mut start = None;
    for row in 0..=rows {
        let is_known = row < rows && values.iter().all(|values| values[row].is_finite());
        match (is_known, start) {
            (true, None) => start = Some(row),
            (false, Some(first)) => {
                runs.push(first..row);
                start = None;
            }
            _ => {}
        }
    }
    runs
}

/// The visible points of a curve whose x ascends.
pub fn thinned(points: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    let mut column: Vec<Point> = Vec::new();
    for point in points {
        if column.first().is_some_and(|first| first.0.floor() != point.0.floor()) {
            flush(&mut column, &mut kept);
        }
        column.push(point);
    }
    flush(&mut column, &mut kept);
    simplified(&kept)
}

/// Moves the first, the last, the lowest and the highest point of a column of pixels.
fn flush(column: &mut Vec<Point>, kept: &mut Vec<Point>) {
    if column.len() <= 4 {
        kept.append(column);
        return;
    }
    let (mut low, mut high) = (0, 0);
    for (index, point) in column.iter().enumerate() {
        low = if point.1 < column[low].1 { index } else { low };
        high = if point.1 > column[high].1 { index } else { high };
    }
    let mut places = [0, low.min(high), low.max(high), column.len() - 1].to_vec();
    places.dedup();
    kept.extend(places.into_iter().map(|index| column[index]));
    column.clear();
}

/// The points without those on the line between the remaining ones.
fn simplified(points: &[Point]) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut stays = vec![false; points.len()];
    stays[0] = true;
    stays[points.len() - 1] = true;
    let mut open = vec![(0, points.len() - 1)];
    while let Some((first, last)) = open.pop() {
        let (from, to) = (points[first], points[last]);
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = (dx * dx + dy * dy).sqrt().max(f64::MIN_POSITIVE);
        let distance = |at: Point| ((at.0 - from.0) * dy - (at.1 - from.1) * dx).abs() / length;
        let farthest = (first + 1..last).map(|index| (index, distance(points[index])));
        let farthest = farthest.reduce(|most, next| if next.1 > most.1 { next } else { most });
        if let Some((index, _)) = farthest.filter(|(_, distance)| *distance > TUNING.tolerance_of_path) {
            stays[index] = true;
            open.extend([(first, index), (index, last)]);
        }
    }
    points.iter().zip(&stays).filter(|(_, stays)| **stays).map(|(point, _)| *point).collect()
}

/// A line through points as an SVG path's data, in tenths of a pixel: an absolute start, then steps.
pub fn line_data(points: &[Point]) -> String {
    let tenths = |(x, y): Point| ((10.0 * x).round() as i64, (10.0 * y).round() as i64);
    let mut points = points.iter().map(|point| tenths(*point));
    let Some(mut at) = points.next() else { return String::new() };
    let mut data = format!("M{}", pair(at));
    let mut is_line = false;
    for next in points {
        let step = (next.0 - at.0, next.1 - at.1);
        if step == (0, 0) {
            continue;
        }
        let step = pair(step);
        // The command is written once, and a minus separates as well as a space.
        data.push_str(match (is_line, step.starts_with('-')) {
            (false, _) => "l",
            (true, true) => "",
            (true, false) => " ",
        });
        data.push_str(&step);
        is_line = true;
        at = next;
    }
    data
}

/// Two lengths in tenths: `1.2-.5`.
fn pair((x, y): (i64, i64)) -> String {
    let between = if y < 0 { "" } else { " " };
    format!("{}{between}{}", tenths(x), tenths(y))
}

fn tenths(value: i64) -> String {
    let sign = if value < 0 { "-" } else { "" };
    let (whole, part) = (value.unsigned_abs() / 10, value.unsigned_abs() % 10);
    match (whole, part) {
        (_, 0) => format!("{sign}{whole}"),
        (0, _) => format!("{sign}.{part}"),
        _ => format!("{sign}{whole}.{part}"),
    }
}

/// A length in the form of an attribute.
pub fn px(value: f64) -> f64 {
    // No −0.
    (10.0 * value).round() / 10.0 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_break_a_line() {
        let values = [f64::NAN, 1.0, 2.0, f64::INFINITY, 4.0, 5.0];
        assert_eq!(runs([&values]), [1..3, 4..6]);
        assert_eq!(runs([&values, &[0.0, 1.0, f64::NAN, 1.0, 1.0]]), [1..2, 4..5]);
        assert!(runs([&values[..1]]).is_empty() && runs([&values[..0]]).is_empty());
    }

    #[test]
    fn thinning_keeps_ends_and_extremes() {
        let n = 100_000;
        let mut points: Vec<Point> =
            (0..n).map(|i| (f64::from(i) * 0.008, 100.0 * (f64::from(i) / 500.0).sin())).collect();
        points[77_777].1 = 900.0;
        points[3].1 = -900.0;
        let line = thinned(points.iter().copied());
        assert!(line.len() <= 3202, "{}", line.len());
        assert!(line.contains(&points[77_777]) && line.contains(&points[3]));
        assert_eq!((line[0], line[line.len() - 1]), (points[0], points[n as usize - 1]));
        assert!(line.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn lines_keep_two_points_and_curves_their_shape() {
        let line = thinned((0..500).map(|i| (f64::from(i), 3.0)));
        assert_eq!(line, [(0.0, 3.0), (499.0, 3.0)]);
        let curve = |x: f64| 80.0 * (x / 60.0).sin();
        let bent = thinned((0..800).map(|i| (f64::from(i), curve(f64::from(i)))));
        assert!(bent.len() < 250, "{}", bent.len());
        for pair in bent.windows(2) {
            let middle = 0.5 * (pair[0].0 + pair[1].0);
            assert!((0.5 * (pair[0].1 + pair[1].1) - curve(middle)).abs() < 0.12, "at {middle}");
        }
    }

    #[test]
    fn paths_are_short() {
        assert_eq!(line_data(&[(1.0, 2.04), (1.0, 2.0), (1.52, 1.0), (3.0, 4.0)]), "M1 2l.5-1 1.5 3");
        assert_eq!(line_data(&[]), "");
        assert_eq!((tenths(-5), tenths(0), tenths(-123)), ("-.5".to_owned(), "0".to_owned(), "-12.3".to_owned()));
    }
}
