//! The motion as polynomials in the parameters.
//!
//! At a fixed time some samples have hit and others have not. So where all meet the same events, polynomials give the
//! times of these, and the poses at times that are stretched from event to event (decision 0257).

use super::Recorded;
use crate::numerics::{PointSet, SparseWork, Surrogate, SurrogateWork};
use crate::results::MotionPolynomials;

/// Recorded motions, and which of their rows are shown.
pub(super) struct Recordings<'r> {
    /// Times of all rows, s.
    pub times: &'r [f64],
    /// Rows that are shown.
    pub shown_rows: &'r [usize],
    /// Coordinates of the poses of all bodies.
    pub lines: usize,
    pub nominal: &'r Recorded,
    /// At the samples that the polynomials are made from.
    pub nodes: &'r [Recorded],
    /// At other samples, with their ξ.
    pub others: Vec<(Vec<f64>, &'r Recorded)>,
    /// How far a point of a body goes where a coordinate of its pose changes, m.
    pub weights: &'r [f64],
}

impl Recordings<'_> {
    /// Polynomials through the motions at the nodes, with their largest error at the other samples: stretched between
    /// events, or at fixed times if that is nearer.
    pub fn polynomials(&self, surrogate: &Surrogate) -> MotionPolynomials {
        let fixed = self.between(surrogate, 0);
        match self.events() {
            0 => fixed,
            count => {
                let stretched = self.between(surrogate, count);
                if stretched.error < fixed.error { stretched } else { fixed }
            }
        }
    }

    /// Polynomials of motions that are stretched between their first `count` events.
    fn between(&self, surrogate: &Surrogate, count: usize) -> MotionPolynomials {
        let nominal = self.shown(self.nominal, count);
        let nodes: Vec<Vec<f64>> = self.nodes.iter().map(|node| self.shown(node, count)).collect();
        let fit = |nominal: &[f64], nodes: Vec<&[f64]>| {
            let of_number = |index: usize| nodes.iter().map(move |node| node[index] - nominal[index]);
            let values: Vec<f64> = (0..nominal.len()).flat_map(of_number).collect();
            surrogate.coefficients(&values, &mut SurrogateWork::default())
        };
        let events = self.nominal.events[..count].to_vec();
        let of_events = self.nodes.iter().map(|node| &node.events[..count]).collect();
        let of_points = self.nodes.iter().map(|node| node.points.as_slice()).collect();
        let basis = surrogate.basis();
        let found = MotionPolynomials {
            degrees: (0..basis.len()).flat_map(|term| basis.degrees(term)).copied().collect(),
            event_deviations: fit(&events, of_events),
            events,
            bodies: fit(&nominal, nodes.iter().map(Vec::as_slice).collect()),
            points: fit(&self.nominal.points, of_points),
            error: f64::NAN,
        };
        MotionPolynomials { error: self.error(surrogate, &nominal, &found), ..found }
    }

    /// The end of the motion, s.
    fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Number of events that all motions meet before their end.
    fn events(&self) -> usize {
        let before = |own: &Recorded| own.events.iter().take_while(|event| **event < self.end()).count();
        let all = [self.nominal].into_iter().chain(self.nodes).chain(self.others.iter().map(|(_, own)| *own));
        all.map(before).min().unwrap_or(0)
    }

    /// Poses of a motion at its own times, which belong to those of the shown rows: (row, line).
    fn shown(&self, own: &Recorded, events: usize) -> Vec<f64> {
        let (from, to) = (&self.nominal.events[..events], &own.events[..events]);
        let at = |&row: &usize| {
            let time = stretched(self.times[row], from, to, self.end());
            pose_at(self.times, &own.rows, self.lines, time)
        };
        self.shown_rows.iter().flat_map(at).collect()
    }

    /// How far points of bodies are from where other samples have them in the shown rows, at most, m.
    fn error(&self, surrogate: &Surrogate, nominal: &[f64], found: &MotionPolynomials) -> f64 {
        let points = PointSet::of(&self.others.iter().map(|(xi, _)| xi).collect::<Vec<_>>());
        let count = self.others.len();
        // Deviations: (number, sample)
        let deviations = |coefficients: &[f64], numbers: usize| {
            let mut found = vec![0.0; numbers * count];
            surrogate.basis().values(points.points(), coefficients, &mut found, &mut SparseWork::default());
            found
        };
        let events = &found.events;
        let of_bodies = deviations(&found.bodies, nominal.len());
        let of_events = deviations(&found.event_deviations, events.len());
        let times: Vec<f64> = self.shown_rows.iter().map(|&row| self.times[row]).collect();
        let of_sample = |sample: usize| -> f64 {
            let with = |base: &[f64], deviations: &[f64]| -> Vec<f64> {
                base.iter().enumerate().map(|(index, base)| base + deviations[index * count + sample]).collect()
            };
            let (poses, own_events) = (with(nominal, &of_bodies), with(events, &of_events));
            let of_row = |&row: &usize| -> f64 {
                let time = stretched(self.times[row], &own_events, events, self.end());
                let simulated = &self.others[sample].1.rows[row * self.lines..][..self.lines];
                let off = pose_at(&times, &poses, self.lines, time).into_iter().zip(simulated).zip(self.weights);
                off.map(|((own, simulated), weight)| weight * (own - simulated).abs()).fold(0.0, f64::max)
            };
            self.shown_rows.iter().map(of_row).fold(0.0, f64::max)
        };
        (0..count).map(of_sample).fold(0.0, f64::max)
    }
}

/// The time of a motion that meets events `to`, which belongs to a time of one that meets the events `from`: a linear
/// function from event to event, and on to the end. Without events it is the same time.
fn stretched(time: f64, from: &[f64], to: &[f64], end: f64) -> f64 {
    if from.is_empty() {
        return time;
    }
    let piece = from.partition_point(|event| *event <= time);
    let ends = |events: &[f64]| {
        let begin = piece.checked_sub(1).map_or(0.0, |before| events[before]);
        (begin, events.get(piece).copied().unwrap_or(end))
    };
    let ((begin, next), (own_begin, own_next)) = (ends(from), ends(to));
    let share = if next > begin { (time - begin) / (next - begin) } else { 0.0 };
    own_begin + share * (own_next - own_begin)
}

/// A pose at a time, on the straight line between the rows around it.
pub(super) fn pose_at(times: &[f64], rows: &[f64], lines: usize, time: f64) -> Vec<f64> {
    let row = |row: usize| &rows[row.min(times.len() - 1) * lines..][..lines];
    let after = times.partition_point(|own| *own < time);
    if times.get(after) == Some(&time) {
        return row(after).to_vec();
    }
    let after = after.clamp(1, (times.len() - 1).max(1));
    let (before, after) = (after - 1, after.min(times.len() - 1));
    let share =
        if after > before { ((time - times[before]) / (times[after] - times[before])).clamp(0.0, 1.0) } else { 0.0 };
    row(before).iter().zip(row(after)).map(|(from, to)| from + share * (to - from)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_stretched_from_event_to_event() {
        let (from, to) = ([1.0, 3.0], [2.0, 3.0]);
        let at = |time: f64| stretched(time, &from, &to, 5.0);
        assert_eq!([0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0].map(at), [0.0, 1.0, 2.0, 2.5, 3.0, 4.0, 5.0]);
        assert_eq!(stretched(0.3, &[], &[], 5.0), 0.3);
    }

    #[test]
    fn poses_are_on_lines_between_rows() {
        let (times, rows) = ([0.0, 0.5, 1.5], [0.0, 1.0, 2.0, 3.0, 4.0, 9.0]);
        assert_eq!(pose_at(&times, &rows, 2, 0.5), [2.0, 3.0]);
        assert_eq!(pose_at(&times, &rows, 2, 1.0), [3.0, 6.0]);
        assert_eq!(pose_at(&times, &rows, 2, 2.0), [4.0, 9.0]);
    }
}
