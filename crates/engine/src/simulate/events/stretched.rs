//! Segments of all lanes on a time of their own, which runs from 0 to 1: each lane's rates are those of its time times
//! the segment's length.

use crate::simulate::drive::Motion;
use crate::simulate::ensemble::RowClosure;
use crate::simulate::step::Pace;

/// A tile of samples on their way through a segment.
#[derive(Debug)]
pub struct Stretched<'s> {
    /// Closure of the samples' motions.
    pub closure: RowClosure<'s>,
    /// When the segment begins, and how long it is.
    pub pace: Pace,
}

/// A motion that levels of the scheme follow, whose time is that of the mechanism, or a share of a length.
pub(super) trait SchemeMotion: Motion {
    /// q, v, a, w, λ of the state whose rates were evaluated last; a is unknown.
    fn unknowns(&self) -> Vec<f64>;

    /// Times of the lanes, if the time is a share of a length.
    fn pace(&self) -> Option<&Pace>;

    /// Moves a state (q, v) on by a share, given its accelerations.
    fn moved(&self, share: f64, state: &[f64], accelerations: &[f64]) -> Vec<f64>;
}

impl SchemeMotion for RowClosure<'_> {
    fn unknowns(&self) -> Vec<f64> {
        RowClosure::unknowns(self).to_vec()
    }

    fn pace(&self) -> Option<&Pace> {
        None
    }

    fn moved(&self, share: f64, state: &[f64], accelerations: &[f64]) -> Vec<f64> {
        moved(state, accelerations, |_| share)
    }
}

impl SchemeMotion for Stretched<'_> {
    fn unknowns(&self) -> Vec<f64> {
        self.closure.unknowns().to_vec()
    }

    fn pace(&self) -> Option<&Pace> {
        Some(&self.pace)
    }

    fn moved(&self, share: f64, state: &[f64], accelerations: &[f64]) -> Vec<f64> {
        let width = self.pace.length.len();
        moved(state, accelerations, |index| share * self.pace.length[index % width])
    }
}

/// A state moved on by each value's own time, s.
fn moved(state: &[f64], accelerations: &[f64], time: impl Fn(usize) -> f64) -> Vec<f64> {
    let (positions, velocities) = state.split_at(accelerations.len());
    let values = || velocities.iter().zip(accelerations).enumerate();
    let position = |(position, (index, (speed, own))): (&f64, (usize, (&f64, &f64)))| {
        position + time(index) * (speed + 0.5 * time(index) * own)
    };
    let velocity = |(index, (speed, own)): (usize, (&f64, &f64))| speed + time(index) * own;
    positions.iter().zip(values()).map(position).chain(values().map(velocity)).collect()
}

impl Stretched<'_> {
    fn set_times(&mut self, share: f64) {
        self.pace.set_times(share, self.closure.times_mut());
    }
}

impl Motion for Stretched<'_> {
    fn rate(&mut self, share: f64, state: &[f64], into: &mut [f64]) {
        self.set_times(share);
        self.closure.rate_at_times(state, into);
        for line in into.chunks_exact_mut(self.pace.length.len()) {
            line.iter_mut().zip(&self.pace.length).for_each(|(rate, length)| *rate *= length);
        }
    }

    fn close(&mut self, share: f64, state: &mut [f64]) {
        self.set_times(share);
        self.closure.close_at_times(state);
    }

    fn sample(&mut self, _: f64, _: &mut [f64]) -> bool {
        false
    }
}
