//! Points of a space one after the other, in one allocation.

/// `count` points of `dimension` coordinates.
#[derive(Clone, Debug)]
pub struct PointSet {
    coordinates: Vec<f64>,
    count: usize,
    dimension: usize,
}

impl PointSet {
    /// Points with some coordinates of others, in this order.
    pub fn of_coordinates<P: AsRef<[f64]>>(points: &[P], chosen: &[usize]) -> Self {
        Self::mapped(points.iter().map(AsRef::as_ref), chosen.len(), |point, axis| point[chosen[axis]])
    }

    /// Points whose coordinates follow from others, axis by axis.
    pub fn mapped<'p>(
        points: impl ExactSizeIterator<Item = &'p [f64]>,
        dimension: usize,
        along: impl Fn(&[f64], usize) -> f64,
    ) -> Self {
        let count = points.len();
        let mut coordinates = Vec::with_capacity(count * dimension);
        points.for_each(|point| coordinates.extend((0..dimension).map(|axis| along(point, axis))));
        Self { coordinates, count, dimension }
    }

    /// Changes the points one after the other.
    pub fn for_each_mut(&mut self, change: impl FnMut(&mut [f64])) {
        self.coordinates.chunks_exact_mut(self.dimension.max(1)).for_each(change);
    }

    /// The points.
    pub fn points(&self) -> Vec<&[f64]> {
        (0..self.count).map(|point| &self.coordinates[point * self.dimension..][..self.dimension]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_chosen_and_changed() {
        let mut chosen = PointSet::of_coordinates(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], &[2, 0]);
        assert_eq!(chosen.points(), [&[3.0, 1.0], &[6.0, 4.0]]);
        chosen.for_each_mut(|point| point[1] -= point[0]);
        assert_eq!(chosen.points(), [&[3.0, -2.0], &[6.0, -2.0]]);
    }

    #[test]
    fn points_without_coordinates_are_counted() {
        assert_eq!(PointSet::of_coordinates(&[[1.0], [2.0]], &[]).points(), [&[] as &[f64], &[]]);
    }
}
