//! Tolerances that are chosen, and their costs.

use crate::applications::allocate::{Choice, Item};

/// A tolerance that is chosen.
#[derive(Clone, Debug)]
pub struct Width {
    /// Least and largest multiple of the model's tolerance.
    pub ends: [f64; 2],
    item: Item,
    curve: Curve,
}

/// Its cost, a convex function of the multiple.
#[derive(Clone, Debug)]
enum Curve {
    /// Cost at the model's tolerance, inversely proportional to the multiple.
    Reciprocal(f64),
    /// Straight lines between these multiples and costs: the lower hull of grades, the tightest first.
    Hull(Vec<[f64; 2]>),
}

impl Width {
    /// The width of a tolerance whose cost depends on it; `None` if it is fixed or has no cost.
    pub fn of(item: &Item) -> Option<Self> {
        let curve = match &item.choice {
            Choice::Fixed | Choice::Together => return None,
            Choice::Reciprocal(cost) => Curve::Reciprocal(*cost),
            Choice::Grades(grades) => Curve::Hull(lower_hull(grades.iter().rev().map(|own| [own.0, own.1]))),
        };
        Some(Self { ends: [item.tightest(), item.widest], item: item.clone(), curve })
    }

    /// The cost of a multiple, between grades, too.
    pub fn cost(&self, multiple: f64) -> f64 {
        self.tangent(multiple)[0]
    }

    /// The cost as the model has it; NaN below the tightest grade.
    pub fn price(&self, multiple: f64) -> f64 {
        self.item.cost(multiple).unwrap_or(f64::NAN)
    }

    /// Cost and its derivative.
    pub fn tangent(&self, multiple: f64) -> [f64; 2] {
        match &self.curve {
            Curve::Reciprocal(cost) => [cost / multiple, -cost / (multiple * multiple)],
            Curve::Hull(hull) => match hull.windows(2).rfind(|pair| pair[0][0] <= multiple) {
                Some(pair) => {
                    let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
                    [pair[0][1] + slope * (multiple - pair[0][0]), slope]
                }
                None => [hull[0][1], 0.0],
            },
        }
    }
}

/// The lower hull of points that ascend in the first coordinate (A. M. Andrew, Inf. Process. Lett. 9 (1979) 216).
fn lower_hull(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut hull: Vec<[f64; 2]> = Vec::new();
    for point in points {
        while let [.., a, b] = hull.as_slice()
            && (b[0] - a[0]) * (point[1] - a[1]) <= (b[1] - a[1]) * (point[0] - a[0])
        {
            hull.pop();
        }
        hull.push(point);
    }
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lower_hulls_omit_grades_above_them() {
        let grades = [[1.0, 8.0], [2.0, 7.0], [3.0, 2.0], [4.0, 1.5], [5.0, 1.0]];
        assert_eq!(lower_hull(grades.into_iter()), [[1.0, 8.0], [3.0, 2.0], [5.0, 1.0]]);
    }
}
