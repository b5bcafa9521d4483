//! A quadratic model of a function that is to be made large, from gradients at a few points: its largest value in the
//! box. Along directions in which no point was tried the model is linear, so that it goes on along a ridge where steps
//! of limited-memory BFGS, whose curvature there is the one across the ridge, come to rest.

use super::tuning::TUNING;
use crate::numerics::dot;

/// The move from one point to another, and the decrease of the gradient.
pub(super) struct Curvature {
    pub moved: Vec<f64>,
    pub fall: Vec<f64>,
}

/// −½ dᵀB d with B = Σ w u uᵀ.
pub(super) struct Bend(Vec<(f64, Vec<f64>)>);

impl Bend {
    /// The model by the BFGS formula from B = 0 (Nocedal & Wright, Numerical Optimization, equation 6.19), from moves
    /// along which the gradient falls.
    pub fn of<'c>(curvatures: impl Iterator<Item = &'c Curvature>) -> Self {
        let mut bend = Self(Vec::new());
        for Curvature { moved, fall } in curvatures {
            let curvature = dot(moved, fall);
            let known = bend.times(moved);
            let before = dot(moved, &known);
            if before > TUNING.rounding_of_product * curvature {
                bend.0.push((-1.0 / before, known));
            }
            bend.0.push((1.0 / curvature, fall.clone()));
        }
        bend
    }

    /// B d.
    fn times(&self, d: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; d.len()];
        for (weight, vector) in &self.0 {
            let share = weight * dot(vector, d);
            product.iter_mut().zip(vector).for_each(|(sum, own)| *sum += share * own);
        }
        product
    }

    /// The point of the box at which slope · d − ½ dᵀB d is largest, d counted from `point`: conjugate gradients on the
    /// faces of the box, one after the other.
    pub fn largest(&self, point: &[f64], slope: &[f64]) -> Vec<f64> {
        let k = point.len();
        let (mut at, mut left) = (point.to_vec(), slope.to_vec());
        let pushes = |x: f64, left: f64| left * x > 0.0 && x.abs() >= 1.0 - TUNING.rounding_of_product;
        let mut way: Option<(Vec<f64>, f64)> = None;
        for _ in 0..TUNING.rounds_of_face * k {
            let free: Vec<f64> =
                at.iter().zip(&left).map(|(&x, &own)| if pushes(x, own) { 0.0 } else { own }).collect();
            let size = dot(&free, &free);
            if size <= TUNING.rounding_of_product * dot(slope, slope) {
                break;
            }
            let direction: Vec<f64> = match &way {
                Some((before, known)) => {
                    free.iter().zip(before).map(|(own, before)| own + size / known * before).collect()
                }
                None => free,
            };
            let bent = self.times(&direction);
            let curvature = dot(&direction, &bent);
            let share = if curvature > TUNING.rounding_of_product * size { size / curvature } else { f64::INFINITY };
            let reach = at.iter().zip(&direction).filter(|(_, by)| **by != 0.0);
            let reach = reach.map(|(x, by)| (by.signum() - x) / by).fold(f64::INFINITY, f64::min).max(0.0);
            let step = share.min(reach);
            at.iter_mut().zip(&direction).for_each(|(x, by)| *x = (*x + step * by).clamp(-1.0, 1.0));
            left.iter_mut().zip(&bent).for_each(|(own, by)| *own -= step * by);
            // Another face begins anew.
            way = (share < reach).then_some((direction, size));
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// x of the box with slope 1 everywhere and a ridge along x + y = 0, known from one move across it.
    #[test]
    fn ridge_is_followed_to_a_side_of_the_box() {
        let across = Curvature { moved: vec![0.5, 0.5], fall: vec![40.0, 40.0] };
        let found = Bend::of([&across].into_iter()).largest(&[0.0, 0.0], &[1.0, 0.0]);
        // x − 20 (x + y)² is largest at x = 1, where its derivative by y vanishes: at y = −1.
        assert!((found[0] - 1.0).abs() < 1e-12 && (found[1] + 1.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn model_without_curvature_is_largest_in_a_corner() {
        let found = Bend::of(std::iter::empty()).largest(&[0.3, -0.2, 0.1], &[2.0, -1e-3, 0.0]);
        assert_eq!(found, [1.0, -1.0, 0.1]);
    }

    proptest! {
        /// The conditions of Karush, Kuhn and Tucker: the gradient of the model vanishes along axes on which the point
        /// lies within the box, and points outwards at a side. B is that of a function whose Hessian is H = Σ n nᵀ.
        #[test]
        fn found_point_satisfies_the_kkt_conditions(
            normals in prop::collection::vec(prop::collection::vec(-3.0..3.0, 6), 1..5),
            moves in prop::collection::vec(prop::collection::vec(-1.0..1.0, 6), 1..9),
            point in prop::collection::vec(-1.0..1.0, 6),
            slope in prop::collection::vec(-1.0..1.0, 6),
        ) {
            let falls = |moved: &Vec<f64>| {
                let of = |axis: usize| normals.iter().map(|n: &Vec<f64>| n[axis] * dot(n, moved)).sum();
                Curvature { moved: moved.clone(), fall: (0..6).map(of).collect() }
            };
            let known: Vec<Curvature> = moves.iter().map(falls).collect();
            let bend = Bend::of(known.iter().filter(|own| dot(&own.moved, &own.fall) > 1e-3));
            let found = bend.largest(&point, &slope);
            let by: Vec<f64> = found.iter().zip(&point).map(|(to, x)| to - x).collect();
            let bent = bend.times(&by);
            for axis in 0..6 {
                let left = slope[axis] - bent[axis];
                prop_assert!(found[axis].abs() <= 1.0);
                let is_outwards = found[axis].abs() > 1.0 - 1e-9 && left * found[axis] > 0.0;
                prop_assert!(is_outwards || left.abs() < 1e-4, "{axis}: {left} at {found:?}");
            }
        }
    }
}
