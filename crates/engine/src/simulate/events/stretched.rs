//! Segments of all lanes on a time of their own, which runs from 0 to 1: each lane's rates are those of its time times
//! the segment's length.

use crate::simulate::drive::Motion;
use crate::simulate::ensemble::RowClosure;
use crate::simulate::step::Pace;

/// A tile of samples on their way through a segment.
#[derive(Debug)]
pub struct Stretched<'s> {
    /// What moves.
    pub closure: RowClosure<'s>,
    /// When the segment begins, and how long it is.
    pub pace: Pace,
}

/// Lanes whose times are that of the motion, or shares of lengths of their own.
pub(super) trait LaneMotion<'s>: Motion {
    /// What moves.
    fn closure(&self) -> &RowClosure<'s>;

    /// Times of the lanes' own.
    fn pace(&self) -> Option<&Pace>;

    /// How long the motion's unit of time is in each lane, s.
    fn lengths(&self) -> Vec<f64>;
}

impl<'s> LaneMotion<'s> for RowClosure<'s> {
    fn closure(&self) -> &RowClosure<'s> {
        self
    }

    fn pace(&self) -> Option<&Pace> {
        None
    }

    fn lengths(&self) -> Vec<f64> {
        vec![1.0; self.tile().width()]
    }
}

impl<'s> LaneMotion<'s> for Stretched<'s> {
    fn closure(&self) -> &RowClosure<'s> {
        &self.closure
    }

    fn pace(&self) -> Option<&Pace> {
        Some(&self.pace)
    }

    fn lengths(&self) -> Vec<f64> {
        self.pace.length.clone()
    }
}

impl Stretched<'_> {
    fn set_times(&mut self, share: f64) {
        let lanes = self.closure.times_mut().iter_mut().zip(self.pace.begin.iter().zip(&self.pace.length));
        lanes.for_each(|(time, (begin, length))| *time = begin + share * length);
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
