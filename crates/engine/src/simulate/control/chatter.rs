//! Equations that switch to and fro: a force that jumps about a velocity which it cannot hold, as `sign` of it does at
//! rest (a sliding mode). The error of a step is the whole jump, so that the tolerance asks for ever shorter steps.

use super::tuning::TUNING;

/// Switches of velocities, lane by lane.
#[derive(Clone, Debug)]
pub struct Chatter {
    lanes: Vec<Lane>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Lane {
    /// `TUNING.chattering_share` for each switch, less one for each other step.
    excess: usize,
    /// When there was none yet, s, and the accepted steps since.
    since: f64,
    steps: usize,
    /// The index of the last such switch.
    switch: usize,
}

impl Chatter {
    /// No switches, before the first step.
    pub fn new(width: usize) -> Self {
        Self { lanes: vec![Lane::default(); width] }
    }

    /// Notes the velocity's switch that each lane passed, if any, in an accepted step that ends at this time, s.
    pub fn note(&mut self, switched: impl Iterator<Item = Option<usize>>, time: f64) {
        for (lane, switched) in self.lanes.iter_mut().zip(switched) {
            lane.steps += 1;
            match switched {
                Some(switch) => (lane.switch, lane.excess) = (switch, lane.excess + TUNING.chattering_share),
                None => lane.excess = lane.excess.saturating_sub(1),
            }
            if lane.excess == 0 {
                (lane.since, lane.steps) = (time, 0);
            }
        }
    }

    /// A lane of those that run, its switch, and since when, s, it chatters, where that would take too many steps from
    /// this time on for the rest, s, of the run.
    pub fn endless(&self, running: &[bool], time: f64, left: f64) -> Option<(usize, usize, f64)> {
        let too_many = |lane: &Lane| left * lane.steps as f64 > TUNING.most_chattering as f64 * (time - lane.since);
        let endless = |&(index, lane): &(usize, &Lane)| {
            running[index] && lane.excess >= TUNING.chattering_switches * TUNING.chattering_share && too_many(lane)
        };
        self.lanes.iter().enumerate().find(endless).map(|(index, lane)| (index, lane.switch, lane.since))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: [bool; 2] = [true; 2];

    /// Two lanes; the first passes switch 3 in every fourth step of length h, the second in every hundredth.
    fn switching(h: f64, switches: usize) -> (Chatter, f64) {
        let mut chatter = Chatter::new(2);
        for step in 1..=4 * switches {
            let switched = [4, 100].map(|every| step.is_multiple_of(every).then_some(3));
            chatter.note(switched.into_iter(), step as f64 * h);
        }
        (chatter, 4.0 * switches as f64 * h)
    }

    #[test]
    fn lane_that_keeps_switching_is_endless() {
        let (chatter, time) = switching(1e-6, 2 * TUNING.chattering_switches);
        // The three steps before the first switch do not count.
        assert_eq!(chatter.endless(&BOTH, time, 1.0), Some((0, 3, 3.0 * 1e-6)));
        assert_eq!(chatter.endless(&[false, true], time, 1.0), None, "a lane that no longer runs");
        assert_eq!(chatter.endless(&BOTH, time, 0.01), None, "10 000 steps are not too many");
        let (chatter, time) = switching(1e-6, TUNING.chattering_switches - 1);
        assert_eq!(chatter.endless(&BOTH, time, 1.0), None);
    }

    #[test]
    fn lane_that_stops_switching_is_not_endless() {
        let (mut chatter, time) = switching(1e-6, 2 * TUNING.chattering_switches);
        (0..2 * TUNING.chattering_switches * TUNING.chattering_share)
            .for_each(|step| chatter.note([None; 2].into_iter(), time + step as f64 * 1e-6));
        assert_eq!(chatter.endless(&BOTH, 2.0 * time, 1.0), None);
        chatter.note([Some(0); 2].into_iter(), 0.5);
        assert_eq!(chatter.endless(&BOTH, 0.5, 1.0), None, "counted anew");
    }
}
