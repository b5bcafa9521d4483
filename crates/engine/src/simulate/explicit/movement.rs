//! How far a motion has gone, which errors of its steps count against: not how far it is from the origin.

use super::tuning::TUNING;
use crate::assemble::CoordinateInfo;

/// The farthest that each line of a state, positions and then velocities, has gone.
#[derive(Clone, Debug)]
pub(in crate::simulate) struct Movement {
    /// Distance from the start, or speed.
    farthest: Vec<f64>,
    /// Least size of each line, and its kind: metres, angles, their rates; nothing depends on a coordinate whose
    /// velocity is a state.
    least: Vec<f64>,
    kinds: Vec<Option<usize>>,
}

impl Movement {
    /// Movement before the start of a motion of this duration, s.
    pub fn new(coordinates: &[CoordinateInfo], duration: f64) -> Self {
        let kind = |coordinate: &CoordinateInfo| usize::from(coordinate.is_angle);
        let positions = coordinates.iter().map(|coordinate| (!coordinate.is_state).then(|| kind(coordinate)));
        // A state has a unit of its own.
        let rate = |(index, coordinate): (usize, &CoordinateInfo)| {
            Some(if coordinate.is_state { 4 + index } else { 2 + kind(coordinate) })
        };
        let kinds = positions.chain(coordinates.iter().enumerate().map(rate)).collect();
        let least = coordinates.iter().map(|coordinate| TUNING.at_rest * coordinate.scale);
        let least = least.clone().chain(least.map(|least| least / duration)).collect();
        Self { farthest: vec![0.0; 2 * coordinates.len()], least, kinds }
    }

    /// Extended to a state of `lanes` lanes, which began at `start`.
    #[must_use]
    pub fn reaching(mut self, start: &[f64], state: &[f64], lanes: usize) -> Self {
        let n = self.farthest.len() / 2;
        let lines = start.chunks_exact(lanes).zip(state.chunks_exact(lanes));
        for (line, (farthest, (start, state))) in self.farthest.iter_mut().zip(lines).enumerate() {
            let from = |lane: usize| if line < n { start[lane] } else { 0.0 };
            *farthest = (0..lanes).fold(*farthest, |farthest, lane| farthest.max((state[lane] - from(lane)).abs()));
        }
        self
    }

    /// Scale of each line.
    pub fn sizes(&self) -> Vec<f64> {
        let mut most = vec![0.0_f64; self.farthest.len() + 4];
        for (&farthest, &kind) in self.farthest.iter().zip(&self.kinds) {
            kind.into_iter().for_each(|kind| most[kind] = most[kind].max(farthest));
        }
        let size = |((&farthest, &least), &kind): ((&f64, &f64), &Option<usize>)| {
            kind.map_or(f64::INFINITY, |kind| farthest.max(TUNING.least_movement * most[kind]).max(least))
        };
        self.farthest.iter().zip(&self.least).zip(&self.kinds).map(size).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coordinate(is_angle: bool, is_state: bool) -> CoordinateInfo {
        CoordinateInfo { name: String::new(), scale: 1.0, is_angle, is_state }
    }

    #[test]
    fn error_scales_follow_the_movement() {
        let coordinates =
            [coordinate(false, false), coordinate(false, false), coordinate(true, false), coordinate(false, true)];
        let movement = Movement::new(&coordinates, 10.0);
        let start = [1000.0, 1001.0, 5.0, 5.0, 0.3, 0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut state = start;
        // The second lane goes 0.5 m and 0.1 rad, at −2 m/s; its state is 7.
        (state[1], state[5], state[9], state[15]) = (1000.5, 0.4, -2.0, 7.0);
        let sizes = movement.reaching(&start, &state, 2).sizes();
        let expected = [0.5, 5e-4, 0.1, f64::INFINITY, 2.0, 2e-3, 1e-10, 7.0];
        for (size, expected) in sizes.iter().zip(expected) {
            assert!(*size == expected || (size - expected).abs() < 1e-12, "{sizes:?}");
        }
    }
}
