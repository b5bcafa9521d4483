//! From the best point of a grid to the peak next to it: by the quadratic through a point and its neighbours, as far as
//! those reach.

use super::tuning::TUNING;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// A point near a function's peak, and its neighbours within [−1, 1]^k.
#[derive(Clone, Debug, PartialEq)]
pub struct Peak {
    /// ξ in the middle of the neighbours.
    center: Vec<f64>,
    /// Distance of the neighbours along each axis.
    spacing: Vec<f64>,
}

impl Peak {
    /// Neighbourhood of a point, moved a little from it if its neighbours would lie outside the box.
    pub fn new(mut xi: Vec<f64>, spacing: Vec<f64>) -> Self {
        for (xi, spacing) in xi.iter_mut().zip(&spacing) {
            *xi = xi.clamp(spacing - 1.0, 1.0 - spacing);
        }
        Self { center: xi, spacing }
    }

    /// ξ where the function is needed: the middle, its neighbours along each axis (before, after),
    /// and those along each two (−−, −+, +−, ++).
    pub fn neighbours(&self) -> impl Iterator<Item = Vec<f64>> {
        let k = self.center.len();
        let pairs = (0..k).flat_map(|a| (0..a).map(move |b| (a, b)));
        let alone = (0..k).flat_map(|axis| [-1.0, 1.0].map(|by| [(axis, by); 2]));
        let both = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let beside = pairs.flat_map(move |(a, b)| both.map(|(of_a, of_b)| [(a, of_a), (b, of_b)]));
        let middle = self.center.iter().map(|center| center.clamp(-1.0, 1.0)).collect();
        std::iter::once(middle).chain(alone.chain(beside).map(|moves| self.neighbour(moves)))
    }

    /// ξ of the middle after `moves` (axis, number of spacings) along one or two axes.
    fn neighbour(&self, moves: [(usize, f64); 2]) -> Vec<f64> {
        let mut xi = self.center.clone();
        moves.into_iter().for_each(|(axis, by)| xi[axis] = self.center[axis] + by * self.spacing[axis]);
        xi.iter_mut().for_each(|xi| *xi = xi.clamp(-1.0, 1.0));
        xi
    }

    /// Neighbourhood of the peak that was found: nearer neighbours, or further ones if it lies at the limit of their
    /// reach.
    #[must_use]
    pub fn next(&self, xi: &[f64]) -> Self {
        let at_limit = |axis: usize| (xi[axis] - self.center[axis]).abs() > 0.99 * self.spacing[axis];
        let further = (0..xi.len()).any(|axis| at_limit(axis) && xi[axis].abs() < 1.0);
        if !further {
            return self.nearer(xi);
        }
        Self::new(
            xi.to_vec(),
            self.spacing.iter().map(|spacing| (TUNING.further * spacing).min(TUNING.furthest)).collect(),
        )
    }

    /// Neighbourhood of a point, with nearer neighbours.
    #[must_use]
    pub fn nearer(&self, xi: &[f64]) -> Self {
        Self::new(xi.to_vec(), self.spacing.iter().map(|spacing| TUNING.nearer * spacing).collect())
    }

    /// Whether its neighbours are no further than this along every axis.
    pub fn is_within(&self, distance: f64) -> bool {
        self.spacing.iter().all(|&spacing| spacing <= distance)
    }

    /// ξ at steps of the spacing.
    fn away(&self, steps: impl Iterator<Item = f64>) -> Vec<f64> {
        let xi = self.center.iter().zip(&self.spacing).zip(steps);
        xi.map(|((center, spacing), step)| (center + step * spacing).clamp(-1.0, 1.0)).collect()
    }

    /// ξ, no further away than the neighbours, at which the quadratic through the values at its
    /// [neighbours](Self::neighbours) is best. `sign` is 1 for a largest value, −1 for a least.
    pub fn vertex(&self, values: &[f64], sign: f64) -> Vec<f64> {
        let k = self.center.len();
        let along = |axis: usize| (values[1 + 2 * axis], values[2 + 2 * axis]);
        let slope = DVector::from_fn(k, |axis, _| sign * 0.5 * (along(axis).1 - along(axis).0));
        let mut bend = DMatrix::zeros(k, k);
        let mut corners = values[1 + 2 * k..].chunks_exact(4);
        for a in 0..k {
            bend[(a, a)] = sign * (2.0 * values[0] - along(a).0 - along(a).1);
            for (b, corners) in (0..a).zip(&mut corners) {
                bend[(a, b)] = -sign * 0.25 * (corners[0] - corners[1] - corners[2] + corners[3]);
                bend[(b, a)] = bend[(a, b)];
            }
        }
        self.away(best_step(&slope, &bend).into_iter())
    }
}

/// The step at which sᵀd − ½ dᵀBd is largest for |dᵢ| ≤ 1.
fn best_step(slope: &DVector<f64>, bend: &DMatrix<f64>) -> Vec<f64> {
    if slope.len() <= TUNING.most_faces { best_of_faces(slope, bend) } else { along_faces(slope, bend) }
}

/// Looks inside the box, and inside all of its faces, edges, … with a peak there.
fn best_of_faces(slope: &DVector<f64>, bend: &DMatrix<f64>) -> Vec<f64> {
    let k = slope.len();
    let slope = Vector3::from_fn(|axis, _| slope.get(axis).copied().unwrap_or(0.0));
    let bend = Matrix3::from_fn(|a, b| bend.get((a, b)).copied().unwrap_or(0.0));
    let mut best = (0.0, Vector3::zeros());
    for face in 0..3_usize.pow(k as u32) {
        // Along each axis: free, or at one of its ends. What the box has no axis for is at rest.
        let side = |axis: usize| face / 3_usize.pow(axis as u32) % 3;
        let is_free = |axis: usize| axis < k && side(axis) == 0;
        let mut step = Vector3::from_fn(|axis, _| if axis < k { [0.0, -1.0, 1.0][side(axis)] } else { 0.0 });
        let pull = slope - bend * step;
        let own = |a: usize, b: usize| {
            if is_free(a) && is_free(b) { bend[(a, b)] } else { f64::from(u8::from(a == b)) }
        };
        let Some(peak) = Matrix3::from_fn(own).cholesky() else { continue };
        step += peak.solve(&Vector3::from_fn(|axis, _| if is_free(axis) { pull[axis] } else { 0.0 }));
        let gain = slope.dot(&step) - 0.5 * step.dot(&(bend * step));
        if gain > best.0 && step.iter().all(|step| step.abs() <= 1.0) {
            best = (gain, step);
        }
    }
    best.1.as_slice()[..k].to_vec()
}

/// Climbs from the middle, from face to face (an active-set method): the best where B is positive definite, else a
/// local peak. Where a free direction bends upwards, it is followed to the next face.
fn along_faces(slope: &DVector<f64>, bend: &DMatrix<f64>) -> Vec<f64> {
    let k = slope.len();
    let mut step = DVector::zeros(k);
    let mut held = vec![false; k];
    for _ in 0..TUNING.changes_of_faces * k {
        let pull = slope - bend * &step;
        let free: Vec<usize> = (0..k).filter(|&axis| !held[axis]).collect();
        let way = way_up(&free, &pull, bend);
        let gain = way.dot(&pull);
        // Written so that NaN ends it too.
        let rises = gain > TUNING.settled_gain * slope.dot(&step).abs();
        if rises {
            let curvature = way.dot(&(bend * &way));
            let reach = |axis: usize| (way[axis].signum() - step[axis]) / way[axis];
            let moving = free.iter().copied().filter(|&axis| way[axis] != 0.0);
            let Some(first) = moving.min_by(|&a, &b| reach(a).total_cmp(&reach(b))) else { break };
            let most = reach(first);
            let share = if curvature > 0.0 { most.min(gain / curvature) } else { most };
            step += &way * share;
            if share == most {
                (step[first], held[first]) = (way[first].signum(), true);
            }
        } else {
            let inwards = |&axis: &usize| held[axis] && pull[axis] * step[axis] < 0.0;
            let pulled = (0..k).filter(inwards).max_by(|&a, &b| pull[a].abs().total_cmp(&pull[b].abs()));
            let Some(pulled) = pulled else { break };
            held[pulled] = false;
        }
    }
    step.as_slice().to_vec()
}

/// Step from a point with this pull to the peak of the quadratic along the free axes, or upwards if it has no peak.
fn way_up(free: &[usize], pull: &DVector<f64>, bend: &DMatrix<f64>) -> DVector<f64> {
    let own = DMatrix::from_fn(free.len(), free.len(), |a, b| bend[(free[a], free[b])]);
    let up = DVector::from_fn(free.len(), |index, _| pull[free[index]]);
    let mut shift = 0.0;
    let solved = loop {
        let shifted = &own + DMatrix::identity(free.len(), free.len()) * shift;
        match shifted.cholesky() {
            Some(peak) => break peak.solve(&up),
            None if shift < own.amax() * free.len() as f64 => shift = (4.0 * shift).max(TUNING.shift * own.amax()),
            None => break up,
        }
    };
    let mut way = DVector::zeros(pull.len());
    free.iter().zip(solved.iter()).for_each(|(&axis, &along)| way[axis] = along);
    way
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vertex(peak: &Peak, f: impl Fn(&[f64]) -> f64, sign: f64) -> Vec<f64> {
        let values: Vec<f64> = peak.neighbours().map(|xi| f(&xi)).collect();
        peak.vertex(&values, sign)
    }

    #[test]
    fn corners_are_kept_and_peaks_near_them_found() {
        let near = |found: Vec<f64>, x: f64, y: f64| (found[0] - x).abs() < 1e-12 && (found[1] - y).abs() < 1e-12;
        let corner = Peak::new(vec![1.0, -1.0], vec![0.1; 2]);
        assert!(near(vertex(&corner, |xi| xi[0] - 2.0 * xi[1] + xi[0] * xi[0], 1.0), 1.0, -1.0));
        assert!(near(vertex(&corner, |xi| -(xi[0] - 0.98).powi(2) - xi[1], 1.0), 0.98, -1.0));
        let edge = Peak::new(vec![1.0, 0.2], vec![0.1; 2]);
        assert!(near(vertex(&edge, |xi| xi[0] - (xi[1] - 0.25).powi(2) - 0.5 * xi[0] * xi[1], -1.0), 0.8, 0.3));
    }

    #[test]
    fn nan_moves_no_peak() {
        let peak = Peak::new(vec![0.5], vec![0.1]);
        assert_eq!(peak.vertex(&[1.0, f64::NAN, 2.0], 1.0), [0.5]);
    }

    proptest! {
        /// Where the quadratic has one peak in the box, from face to face leads to it.
        #[test]
        fn search_over_faces_finds_the_peak(
            slope in prop::array::uniform3(-3.0..3.0_f64),
            factor in prop::collection::vec(-1.0..1.0_f64, 9),
        ) {
            let factor = DMatrix::from_vec(3, 3, factor);
            let bend = &factor * factor.transpose() + DMatrix::identity(3, 3) * 1e-3;
            let slope = DVector::from_row_slice(&slope);
            let gain = |step: Vec<f64>| {
                let step = DVector::from_vec(step);
                slope.dot(&step) - 0.5 * step.dot(&(&bend * &step))
            };
            let (found, best) = (along_faces(&slope, &bend), best_of_faces(&slope, &bend));
            prop_assert!(found.iter().all(|step| step.abs() <= 1.0));
            prop_assert!((gain(found) - gain(best)).abs() < 1e-9);
        }

        /// Whichever way it bends, no axis alone leads further up.
        #[test]
        fn no_single_axis_improves_the_peak(
            slope in prop::array::uniform5(-3.0..3.0_f64),
            bends in prop::collection::vec(-1.0..1.0_f64, 25),
        ) {
            let bends = DMatrix::from_vec(5, 5, bends);
            let (slope, bend) = (DVector::from_row_slice(&slope), &bends + bends.transpose());
            let found = DVector::from_vec(along_faces(&slope, &bend));
            let pull = &slope - &bend * &found;
            for axis in 0..5 {
                prop_assert!(found[axis].abs() <= 1.0);
                let held = found[axis].abs() == 1.0 && pull[axis] * found[axis] >= 0.0;
                prop_assert!(held || pull[axis].abs() < 1e-5, "{axis}: {found} {pull}");
            }
        }

        #[test]
        fn quadratics_take_one_step(
            center in prop::array::uniform3(-0.3..0.3_f64),
            start in prop::array::uniform3(-0.3..0.3_f64),
            mixed in prop::array::uniform3(-0.4..0.4_f64),
            sign in prop::sample::select(vec![-1.0, 1.0]),
        ) {
            let f = |xi: &[f64]| {
                let d = [xi[0] - center[0], xi[1] - center[1], xi[2] - center[2]];
                let squares = d[0] * d[0] + 2.0 * d[1] * d[1] + 1.5 * d[2] * d[2];
                -sign * (squares + mixed[0] * d[0] * d[1] + mixed[1] * d[1] * d[2] + mixed[2] * d[0] * d[2])
            };
            let found = vertex(&Peak::new(start.to_vec(), vec![0.7; 3]), f, sign);
            for (found, center) in found.iter().zip(center) {
                prop_assert!((found - center).abs() < 1e-10);
            }
        }
    }
}
