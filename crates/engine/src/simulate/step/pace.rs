//! Times of lanes.

/// Times of lanes whose steps have lengths of their own: a lane's time is its beginning and a share of its length, and
/// all lanes have the shares in common.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::simulate) struct Pace {
    /// Begin and length by lane, s.
    pub begin: Vec<f64>,
    pub length: Vec<f64>,
}

impl Pace {
    /// Times of the lanes at a share of their lengths, s; or the jet of the time.
    pub fn set_times(&self, share: f64, into: &mut [f64]) {
        let lanes = into.iter_mut().zip(self.begin.iter().zip(&self.length));
        lanes.for_each(|(time, (begin, length))| *time = begin + share * length);
    }

    /// Their steps of a share h of their lengths, s; or the jet of the step.
    pub fn set_steps(&self, h: f64, into: &mut [f64]) {
        into.iter_mut().zip(&self.length).for_each(|(step, length)| *step = h * length);
    }
}
