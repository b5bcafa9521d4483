//! Surfaces that overlap more deeply than their contact can handle, or that pass through one another within a step.

use super::tuning::TUNING;
use crate::compile::SwitchProgram;
use crate::simulate::control::SwitchWatch;
use crate::simulate::step::Stepper;

/// Two surfaces that a contact does not hold apart any more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TooDeep {
    /// Index among the effects whose surfaces may overlap to some depth only.
    pub contact: usize,
    /// End of the step, s.
    pub time: f64,
    /// m; `None` where they passed through one another between the ends of the step.
    pub depth: Option<f64>,
    /// m
    pub deepest: f64,
}

/// Search for such surfaces, over the steps of a tile.
#[derive(Clone, Debug)]
pub struct OverlapWatch<'s> {
    watch: SwitchWatch<'s>,
    contacts: usize,
    found: Option<TooDeep>,
}

impl<'s> OverlapWatch<'s> {
    /// Watches the samples of a tile, with the gaps and the remaining overlaps.
    pub fn new(program: &'s SwitchProgram, stepper: &Stepper) -> Self {
        let contacts = program.switches.len() / 2;
        Self { watch: SwitchWatch::new(program, stepper.tile()), contacts, found: None }
    }

    /// Evaluates the gaps before a step.
    pub fn begin(&mut self, stepper: &Stepper) {
        if self.found.is_none() {
            self.watch.begin(stepper.tile());
        }
    }

    /// Examines the first `count` lanes after a step of length h up to `end`, which is one step or, where `is_divided`,
    /// several. Whether the first such surfaces were found.
    pub fn end(&mut self, stepper: &Stepper, count: usize, h: f64, end: f64, is_divided: bool) -> bool {
        if self.found.is_some() {
            return false;
        }
        self.watch.end(stepper.tile());
        let lanes = (0..count).filter(|&lane| stepper.alive()[lane]);
        let mut all = lanes.flat_map(|lane| (0..self.contacts).map(move |contact| (lane, contact)));
        self.found = all.find_map(|(lane, contact)| {
            let [[gap, _], [gap_after, _]] = self.watch.ends(contact, lane);
            let left = self.watch.ends(self.contacts + contact, lane);
            let deepest = left[1][0] - gap_after;
            let found = |depth| TooDeep { contact, time: end, depth, deepest };
            if left[1][0] < TUNING.nothing_left * deepest {
                return Some(found(Some(-gap_after)));
            }
            let nearest = nearest(left, h).filter(|_| !is_divided)?;
            let touched = gap < 0.0 || gap_after < 0.0;
            match () {
                () if touched && nearest < TUNING.nothing_left * deepest => Some(found(Some(deepest - nearest))),
                () if !touched && nearest < TUNING.grazes * deepest => Some(found(None)),
                () => None,
            }
        });
        self.found.is_some()
    }

    /// The first that were found.
    pub fn found(&self) -> Option<TooDeep> {
        self.found
    }
}

/// Least distance, within a step of length h, of a point that passes a point or a line at a constant velocity, given
/// the distances and their rates at the ends; `None` if it does not first approach and then part.
fn nearest([[left, rate], [left_after, rate_after]]: [[f64; 2]; 2], h: f64) -> Option<f64> {
    if !(left > 0.0 && rate < 0.0 && left_after > 0.0 && rate_after > 0.0) {
        return None;
    }
    // With l² = d² + s² and ṡ = v: l l̇ = v s.
    let square_of_speed = (left_after * rate_after - left * rate) / h;
    let square = left * left * (1.0 - rate * rate / square_of_speed);
    Some(square.max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_distance_on_the_way_is_found() {
        // At 4 m/s by steps of 10 ms, past a point at a distance of 5 mm, and through a line.
        let past = |x: f64, d: f64| [x.hypot(d), 4.0 * x / x.hypot(d)];
        for d in [5e-3, 0.0] {
            let found = nearest([past(-0.017, d), past(0.023, d)], 0.01).unwrap();
            assert!((found - d).abs() < 1e-9, "{found}");
        }
        assert_eq!(nearest([past(0.02, 0.0), past(0.06, 0.0)], 0.01), None);
    }
}
