//! Segments of all lanes on a time of their own, which runs from 0 to 1: each lane's rates are those of its time times
//! the segment's length.

use crate::simulate::drive::Motion;
use crate::simulate::ensemble::RowClosure;

/// A tile of samples on their way through a segment.
#[derive(Debug)]
pub struct Stretched<'s> {
    /// What moves.
    pub closure: RowClosure<'s>,
    /// When the segment begins, and how long it is, s; lane by lane.
    pub begin: Vec<f64>,
    pub length: Vec<f64>,
}

impl Stretched<'_> {
    fn set_times(&mut self, share: f64) {
        let lanes = self.closure.times_mut().iter_mut().zip(self.begin.iter().zip(&self.length));
        lanes.for_each(|(time, (begin, length))| *time = begin + share * length);
    }
}

impl Motion for Stretched<'_> {
    fn rate(&mut self, share: f64, state: &[f64], into: &mut [f64]) {
        self.set_times(share);
        self.closure.rate_at_times(state, into);
        for line in into.chunks_exact_mut(self.length.len()) {
            line.iter_mut().zip(&self.length).for_each(|(rate, length)| *rate *= length);
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
