//! Functions that are sums of functions of fewer parameters: their ranges are the sums of those functions' ranges.
//!
//! Parameters i and j act together where the mixed difference f(…aᵢ…bⱼ…) − f(…aᵢ…) − f(…bⱼ…) + f is not zero. It is
//! taken about one point of a low-discrepancy sequence and between others; the groups of parameters that are found are
//! tried at further points.

use super::extremes::ValuesAt;
use super::samples::spread;
use super::tuning::TUNING;

/// A function of k parameters as a sum over groups of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Separated {
    /// Numbers of the parameters of each group, ascending; those that change nothing are in none.
    pub groups: Vec<Vec<usize>>,
    /// Distance of the sum from the function.
    pub defect: f64,
}

/// Finds out on which parameters functions depend, and which of these act together.
#[derive(Clone, Debug)]
pub struct Separation {
    dimension: usize,
    /// Point with the parameters that are not of a group.
    anchor: Vec<f64>,
    /// The anchor; with one parameter elsewhere, twice; with two, twice; the points to be tried.
    points: Vec<Vec<f64>>,
    tried: Vec<Vec<f64>>,
}

impl Separation {
    /// Separation for k parameters.
    pub fn new(dimension: usize) -> Self {
        let mut scattered = spread(dimension, 3 + TUNING.tried_points);
        let tried = scattered.split_off(3);
        let [anchor, a, b]: [Vec<f64>; 3] = std::array::from_fn(|index| scattered[index].clone());
        let moved = |moves: &[(usize, f64)]| {
            let mut point = anchor.clone();
            moves.iter().for_each(|&(axis, xi)| point[axis] = xi);
            point
        };
        let mut points = vec![anchor.clone()];
        points.extend((0..dimension).flat_map(|i| [moved(&[(i, a[i])]), moved(&[(i, b[i])])]));
        for (i, j) in pairs(dimension) {
            points.extend([moved(&[(i, a[i]), (j, b[j])]), moved(&[(i, b[i]), (j, a[j])])]);
        }
        points.extend(tried.iter().cloned());
        Self { dimension, anchor, points, tried }
    }

    /// Points at which functions have to be known.
    pub fn points(&self) -> &[Vec<f64>] {
        &self.points
    }

    /// A point with the parameters of a group given, and the others at the anchor.
    pub fn embed(&self, group: &[usize], xi: &[f64]) -> Vec<f64> {
        let mut point = self.anchor.clone();
        group.iter().zip(xi).for_each(|(&axis, &xi)| point[axis] = xi);
        point
    }

    /// The groups of a function with these values at the points; `evaluate` gives its values at others.
    pub fn of(&self, values: &[f64], evaluate: &ValuesAt) -> Separated {
        let together = Separated { groups: vec![(0..self.dimension).collect()], defect: 0.0 };
        let (least, largest) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| (l.min(*v), u.max(*v)));
        if self.dimension < 2 || values.iter().any(|value| !value.is_finite()) {
            return together;
        }
        let none =
            TUNING.no_difference * (largest - least) + TUNING.rounding_of_difference * least.abs().max(largest.abs());
        let mut group: Vec<usize> = (0..self.dimension).collect();
        let single = |axis: usize, index: usize| values[1 + 2 * axis + index];
        let mut matters: Vec<bool> = (0..self.dimension)
            .map(|axis| (0..2).any(|index| (single(axis, index) - values[0]).abs() > none))
            .collect();
        let mixed = values[1 + 2 * self.dimension..].chunks_exact(2);
        for ((i, j), mixed) in pairs(self.dimension).zip(mixed) {
            let defect = |index: usize| mixed[index] - single(i, index) - single(j, 1 - index) + values[0];
            if (0..2).any(|index| defect(index).abs() > none) {
                let (from, to) = (group[j], group[i]);
                group.iter_mut().filter(|group| **group == from).for_each(|group| *group = to);
                (matters[i], matters[j]) = (true, true);
            }
        }
        let members =
            |label: usize| (0..self.dimension).filter(|&axis| group[axis] == label && matters[axis]).collect();
        let groups: Vec<Vec<usize>> =
            (0..self.dimension).map(members).filter(|members: &Vec<usize>| !members.is_empty()).collect();
        if groups.len() == 1 && groups[0].len() == self.dimension {
            return together;
        }
        let defect = self.defect(&groups, values, evaluate);
        // Written so that NaN is not taken for a sum.
        if defect <= none * groups.len().max(1) as f64 { Separated { groups, defect } } else { together }
    }

    /// Distance of the sum over groups from the function at the tried points.
    fn defect(&self, groups: &[Vec<usize>], values: &[f64], evaluate: &ValuesAt) -> f64 {
        let parts = self.tried.iter().flat_map(|xi| {
            groups.iter().map(move |group| {
                let own: Vec<f64> = group.iter().map(|&axis| xi[axis]).collect();
                self.embed(group, &own)
            })
        });
        let parts = evaluate(&parts.collect::<Vec<_>>());
        let whole = &values[values.len() - TUNING.tried_points..];
        let of_point = |(index, whole): (usize, &f64)| {
            let own = &parts[index * groups.len()..][..groups.len()];
            (own.iter().map(|part| part - values[0]).sum::<f64>() + values[0] - whole).abs()
        };
        super::error::largest(whole.iter().enumerate().map(of_point))
    }
}

fn pairs(k: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..k).flat_map(move |j| (0..j).map(move |i| (i, j)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(k: usize, f: impl Fn(&[f64]) -> f64) -> Vec<Vec<usize>> {
        let separation = Separation::new(k);
        let evaluate = |points: &[Vec<f64>]| points.iter().map(|xi| f(xi)).collect::<Vec<f64>>();
        separation.of(&evaluate(separation.points()), &evaluate).groups
    }

    #[test]
    fn sums_are_separated_and_idle_parameters_omitted() {
        assert_eq!(groups(4, |x| x[0].sin() + x[1] * x[3] + x[2].exp()), [vec![0], vec![1, 3], vec![2]]);
        assert_eq!(groups(3, |x| x[0] * x[1] + 0.1 * x[1] * x[2]), [[0, 1, 2]]);
        assert_eq!(groups(3, |x| 1e3 + x[1].cos()), [[1]]);
        assert_eq!(groups(2, |_| 4.0), Vec::<Vec<usize>>::new());
        assert_eq!(groups(1, |x| x[0]), [[0]]);
        // Unknown values are not separated.
        assert_eq!(groups(2, |x| if x[0] + x[1] > 1.2 { 1.0 } else { f64::NAN }), [[0, 1]]);
    }
}
