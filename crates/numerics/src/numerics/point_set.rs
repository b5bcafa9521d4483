//! Points of a space one after the other, in one allocation.

use rayon::prelude::*;

/// `count` points of `dimension` coordinates.
#[derive(Clone, Debug)]
pub struct PointSet {
    coordinates: Vec<f64>,
    count: usize,
    dimension: usize,
}

/// Points of a [`PointSet`].
#[derive(Clone, Copy, Debug)]
pub struct Points<'p> {
    coordinates: &'p [f64],
    count: usize,
    dimension: usize,
    /// From one point's coordinates to those of the next.
    stride: usize,
}

impl PointSet {
    /// Points of at least one dimension, from their coordinates point by point.
    pub fn new(coordinates: Vec<f64>, dimension: usize) -> Self {
        Self { count: coordinates.len() / dimension, coordinates, dimension }
    }

    /// Points of the same dimension.
    pub fn of(points: &[impl AsRef<[f64]>]) -> Self {
        let dimension = points.first().map_or(0, |point| point.as_ref().len());
        let mut coordinates = Vec::with_capacity(points.len() * dimension);
        points.iter().for_each(|point| coordinates.extend_from_slice(point.as_ref()));
        Self { coordinates, count: points.len(), dimension }
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
    pub fn points(&self) -> Points<'_> {
        let Self { coordinates, count, dimension } = self;
        Points { coordinates, count: *count, dimension: *dimension, stride: *dimension }
    }
}

impl<'p> Points<'p> {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Coordinates of a point.
    #[inline]
    pub fn point(&self, index: usize) -> &'p [f64] {
        &self.coordinates[index * self.stride..][..self.dimension]
    }

    /// One coordinate of a point.
    #[inline]
    pub fn coordinate(&self, index: usize, axis: usize) -> f64 {
        self.coordinates[index * self.stride + axis]
    }

    /// The points one after the other.
    pub fn iter(self) -> impl ExactSizeIterator<Item = &'p [f64]> {
        (0..self.count).map(move |index| self.point(index))
    }

    /// The first point, and each that is `step` after the last one.
    pub fn step_by(self, step: usize) -> Self {
        Self { count: self.count.div_ceil(step), stride: self.stride * step, ..self }
    }

    /// Groups of `size` successive points; the last has the rest.
    pub fn chunks(self, size: usize) -> Vec<Self> {
        (0..self.count).step_by(size).map(|first| self.part(first, size)).collect()
    }

    /// Up to `size` successive points.
    pub fn part(self, first: usize, size: usize) -> Self {
        let coordinates = &self.coordinates[first * self.stride..];
        Self { coordinates, count: size.min(self.count - first), ..self }
    }

    /// Lines of values of all points, line by line, point by point, from those of `size` points at a time. In parallel,
    /// with the same bits for any number of threads.
    pub fn lines(self, size: usize, count: usize, of_chunk: &(dyn Fn(Self) -> Vec<f64> + Sync)) -> Vec<f64> {
        let chunks: Vec<(usize, Vec<f64>)> =
            self.chunks(size).into_par_iter().map(|chunk| (chunk.len(), of_chunk(chunk))).collect();
        let mut all = Vec::with_capacity(count * self.len());
        for line in 0..count {
            chunks.iter().for_each(|(own, values)| all.extend_from_slice(&values[line * own..][..*own]));
        }
        all
    }

    /// Some of the points, in this order.
    pub fn chosen(self, indices: &[usize]) -> PointSet {
        let points = indices.iter().map(|&index| self.point(index));
        PointSet::mapped(points, self.dimension, |point, axis| point[axis])
    }

    /// Some coordinates of the points, in this order.
    pub fn coordinates(self, chosen: &[usize]) -> PointSet {
        PointSet::mapped(self.iter(), chosen.len(), |point, axis| point[chosen[axis]])
    }
}

/// The least of lines of values at each of `count` points; NaN if one is.
pub fn least_of_lines(lines: &[f64], count: usize) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; count];
    for line in lines.chunks_exact(count.max(1)) {
        for (least, &value) in least.iter_mut().zip(line) {
            if value < *least || value.is_nan() {
                *least = value;
            }
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(points: Points<'_>) -> Vec<&[f64]> {
        points.iter().collect()
    }

    #[test]
    fn coordinates_are_chosen_and_changed() {
        let set = PointSet::new(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 3);
        let mut chosen = set.points().coordinates(&[2, 0]);
        assert_eq!(all(chosen.points()), [&[3.0, 1.0], &[6.0, 4.0]]);
        chosen.for_each_mut(|point| point[1] -= point[0]);
        assert_eq!(all(chosen.points()), [&[3.0, -2.0], &[6.0, -2.0]]);
    }

    #[test]
    fn points_without_coordinates_are_counted() {
        let set = PointSet::of(&[[1.0], [2.0]]);
        assert_eq!(all(set.points().coordinates(&[]).points()), [&[] as &[f64], &[]]);
    }

    #[test]
    fn steps_and_chunks_have_the_same_points() {
        let set = PointSet::of(&[[0.0, 0.5], [1.0, 1.5], [2.0, 2.5], [3.0, 3.5], [4.0, 4.5]]);
        let every_other = set.points().step_by(2);
        assert_eq!(all(every_other), [&[0.0, 0.5], &[2.0, 2.5], &[4.0, 4.5]]);
        let chunks: Vec<Vec<&[f64]>> = every_other.chunks(2).into_iter().map(all).collect();
        assert_eq!(chunks, [vec![&[0.0, 0.5][..], &[2.0, 2.5]], vec![&[4.0, 4.5][..]]]);
    }

    #[test]
    fn least_is_unknown_where_a_value_is() {
        let least = least_of_lines(&[1.0, f64::NAN, 3.0, 2.0, 0.0, f64::NAN], 3);
        assert!(least[0] == 1.0 && least[1].is_nan() && least[2].is_nan(), "{least:?}");
    }

    #[test]
    fn lines_of_chunks_are_those_of_all_points() {
        let set = PointSet::of(&[[0.0, 0.5], [1.0, 1.5], [2.0, 2.5]]);
        let of_chunk = |points: Points| {
            let line = |axis: usize| points.iter().map(move |point| 10.0 * point[axis]);
            line(0).chain(line(1)).collect::<Vec<f64>>()
        };
        assert_eq!(set.points().lines(2, 2, &of_chunk), [0.0, 10.0, 20.0, 5.0, 15.0, 25.0]);
    }
}
