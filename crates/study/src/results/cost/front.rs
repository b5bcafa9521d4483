//! Pareto front: points that no other point dominates.

/// Indices of the pairs (error, seconds) that no other dominates (as good in both, better in one), by rising error. The
/// first of equal points is retained; points that are not finite are on no front.
pub fn pareto(points: &[(f64, f64)]) -> Vec<usize> {
    let mut indices: Vec<usize> = (0..points.len()).collect();
    indices.retain(|&index| points[index].0.is_finite() && points[index].1.is_finite());
    indices.sort_by(|&a, &b| {
        let ((error, seconds), (other_error, other_seconds)) = (points[a], points[b]);
        error.total_cmp(&other_error).then(seconds.total_cmp(&other_seconds))
    });
    // By rising error, only points cheaper than all before them are worth their error.
    let mut cheapest = f64::INFINITY;
    indices.retain(|&index| {
        let better = points[index].1 < cheapest;
        cheapest = cheapest.min(points[index].1);
        better
    });
    indices
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn dominated_points_are_not_on_the_front() {
        let points =
            [(1.0, 1.0), (0.1, 5.0), (0.1, 4.0), (0.5, 4.5), (2.0, 1.0), (0.01, f64::NAN), (f64::INFINITY, 0.1)];
        assert_eq!(pareto(&points), [2, 0]);
        assert_eq!(pareto(&[(1.0, 2.0), (1.0, 2.0)]), [0], "of equals the first");
        assert!(pareto(&[]).is_empty());
    }

    proptest! {
        #[test]
        fn front_matches_its_definition(points in prop::collection::vec((0..20_u8, 0..20_u8), 0..40)) {
            let points: Vec<(f64, f64)> = points.into_iter().map(|(x, y)| (f64::from(x), f64::from(y))).collect();
            let front = pareto(&points);
            let betters = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
            for (index, &point) in points.iter().enumerate() {
                let bettered = points.iter().any(|&other| betters(other, point));
                let on_it = front.iter().any(|&other| points[other] == point);
                prop_assert_eq!(on_it, !bettered, "{:?}", points[index]);
            }
        }
    }
}
