//! The step schedule that all samples share: the rows of output and the steps between them.
//!
//! The last row is at the end of the run, also where the output step does not divide the duration; then it is nearer to
//! the row before. Where the step does not divide the time between these two, the last step is shorter.

use super::integration::Integration;
use serde::{Deserialize, Serialize};

use super::tuning::TUNING;
use crate::simulate::events::segments::{EventSchedule, SegmentMethod, Segments};

/// Rows of output, and the steps that lead from row to row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Schedule {
    /// s between rows of output, but for the last.
    pub output_step: f64,
    /// Rows of output, the one at t = 0 included.
    pub rows: usize,
    /// Time of the last row, s.
    pub(super) end: f64,
    pub(super) steps: StepList,
    /// Method of the steps.
    pub integration: Integration,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum StepList {
    /// Steps of equal length, this many between rows, and those before the last row.
    Fixed { step: f64, per_row: usize, last: LastSteps },
    /// The times at which the steps before each row but the first end; the last is the row's own.
    Listed(Vec<Vec<f64>>),
    /// The times at which steps end, which pass over rows; the last is the end of the run. Those by these numbers are
    /// times at which equations switch: all schedules of the motion keep them.
    Passing { ends: Vec<f64>, kept: Vec<usize> },
    /// Steps between events, whose times are each sample's own.
    Segmented(Segments),
}

/// Steps before the last row: `whole` full steps, then `rests` steps of the length `rest`, s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct LastSteps {
    pub whole: usize,
    pub rests: usize,
    pub rest: f64,
}

impl LastSteps {
    fn new(length: f64, step: f64) -> Self {
        let whole = (length / step + TUNING.no_rest).floor();
        let rest = length - whole * step;
        let rests = usize::from(rest > TUNING.no_rest * step);
        Self { whole: whole as usize, rests, rest: if rests > 0 { rest } else { 0.0 } }
    }
}

/// Rows of a duration: those that fit into it (with the slack of rounded decimals), and the one at its end.
fn rows(duration: f64, output_step: f64) -> usize {
    let ratio = duration / output_step;
    let whole = (ratio * (1.0 + 1e-12) + 1e-9).floor();
    whole as usize + usize::from(ratio - whole > TUNING.no_rest) + 1
}

impl Schedule {
    /// Steps of one length, but for the last; `output_step` is a whole multiple of `step`.
    pub fn fixed(duration: f64, step: f64, output_step: f64) -> Self {
        let per_row = ((output_step / step).round() as usize).max(1);
        Self::of_steps(duration, output_step, step, per_row)
    }

    fn of_steps(end: f64, output_step: f64, step: f64, per_row: usize) -> Self {
        let rows = rows(end, output_step);
        let before = end - rows.saturating_sub(2) as f64 * output_step;
        let last = if (before - output_step).abs() <= TUNING.no_rest * output_step {
            LastSteps { whole: per_row, rests: 0, rest: 0.0 }
        } else {
            LastSteps::new(before, step)
        };
        Self { output_step, rows, end, steps: StepList::Fixed { step, per_row, last }, integration: Integration::Plain }
    }

    /// Steps that end at the listed times: one list for each row but the first.
    pub fn listed(output_step: f64, ends: Vec<Vec<f64>>) -> Self {
        let end = ends.last().and_then(|ends| ends.last()).copied().unwrap_or(0.0);
        Self { output_step, rows: ends.len() + 1, end, steps: StepList::Listed(ends), integration: Integration::Plain }
    }

    /// Steps that end at the listed times, whatever rows lie between. The ends with the indices `kept` remain in all
    /// schedules that are made of this one.
    pub fn passing(duration: f64, output_step: f64, ends: Vec<f64>, kept: Vec<usize>) -> Self {
        let rows = rows(duration, output_step);
        let steps = StepList::Passing { ends, kept };
        Self { output_step, rows, end: duration, steps, integration: Integration::Plain }
    }

    /// Steps that end at the events of all samples.
    pub fn ending_at_events(duration: f64, output_step: f64, steps: EventSchedule) -> Self {
        match steps {
            EventSchedule::Segments(segments) => Self::segmented(duration, output_step, segments),
            EventSchedule::Instants { ends, at_events } => {
                Self::passing(duration, output_step, ends, at_events).taken(Integration::Explicit)
            }
        }
    }

    /// Steps between the events that all samples meet.
    pub fn segmented(duration: f64, output_step: f64, segments: Segments) -> Self {
        let integration = match segments.method {
            SegmentMethod::Explicit | SegmentMethod::ExplicitFromRest => Integration::Segments,
            SegmentMethod::Scheme { levels } => Integration::SchemeSegments { levels },
        };
        let (rows, steps) = (rows(duration, output_step), StepList::Segmented(segments));
        Self { output_step, rows, end: duration, steps, integration }
    }

    /// The events between which steps are taken, with these, where they are.
    pub fn segments(&self) -> Option<&Segments> {
        match &self.steps {
            StepList::Segmented(segments) => Some(segments),
            _ => None,
        }
    }

    /// Indices of the steps that end at events whose times are the same in all samples.
    pub fn at_events(&self) -> &[usize] {
        match &self.steps {
            StepList::Passing { kept, .. } => kept,
            _ => &[],
        }
    }

    /// Whether steps end at events.
    pub fn ends_at_events(&self) -> bool {
        self.segments().is_some() || !self.at_events().is_empty()
    }

    /// Whether steps pass over rows.
    pub fn passes_rows(&self) -> bool {
        matches!(self.steps, StepList::Passing { .. } | StepList::Segmented(_))
    }

    /// The same with steps that end at the rows too.
    #[must_use]
    pub fn ending_at_rows(&self) -> Self {
        let StepList::Passing { .. } = &self.steps else { return self.clone() };
        let of_row = |row: usize| {
            let mut ends: Vec<f64> = self.steps_to(row).map(|(_, end)| end).collect();
            if ends.last().is_none_or(|&end| end < self.time(row)) {
                ends.push(self.time(row));
            }
            ends
        };
        Self::listed(self.output_step, (1..self.rows).map(of_row).collect())
    }

    /// Times at which all steps end.
    pub fn ends(&self) -> Vec<f64> {
        match &self.steps {
            StepList::Passing { ends, .. } => ends.clone(),
            _ => (1..self.rows).flat_map(|row| self.steps_to(row)).map(|(_, end)| end).collect(),
        }
    }

    /// The longest of the steps, s.
    pub fn longest_step(&self) -> f64 {
        match &self.steps {
            StepList::Fixed { step, .. } => *step,
            StepList::Listed(_) => {
                (1..self.rows).flat_map(|row| self.steps_to(row)).map(|(h, _)| h).fold(0.0, f64::max)
            }
            StepList::Passing { ends, .. } => {
                let first = ends.first().copied().unwrap_or(0.0);
                ends.windows(2).map(|pair| pair[1] - pair[0]).fold(first, f64::max)
            }
            StepList::Segmented(segments) => self.end / segments.count() as f64,
        }
    }

    /// Number of steps between rows, if all steps but those before the last row have one length.
    pub fn steps_per_row(&self) -> Option<usize> {
        match &self.steps {
            StepList::Fixed { per_row, .. } => Some(*per_row),
            StepList::Listed(_) | StepList::Passing { .. } | StepList::Segmented(_) => None,
        }
    }

    /// The same rows with this many steps of one length between them.
    #[must_use]
    pub fn with_steps_per_row(&self, per_row: usize) -> Self {
        let steps = Self::of_steps(self.end, self.output_step, self.output_step / per_row as f64, per_row);
        steps.taken(self.integration)
    }

    /// The same steps, taken in another way.
    #[must_use]
    pub fn taken(self, integration: Integration) -> Self {
        Self { integration, ..self }
    }

    /// Number of rows of a schedule of this duration.
    pub fn rows_of(duration: f64, output_step: f64) -> usize {
        rows(duration, output_step)
    }

    /// Time of a row, s.
    pub fn time(&self, row: usize) -> f64 {
        if row + 1 == self.rows { self.end } else { row as f64 * self.output_step }
    }

    /// Time of the last row, s.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Time of a row of a schedule of this duration, s.
    pub fn time_of(duration: f64, output_step: f64, row: usize) -> f64 {
        if row + 1 == rows(duration, output_step) { duration } else { row as f64 * output_step }
    }

    /// The first step's length, s.
    pub fn first_step(&self) -> f64 {
        match &self.steps {
            StepList::Fixed { last, .. } if self.rows == 2 && last.whole == 0 => last.rest,
            StepList::Fixed { step, .. } => *step,
            StepList::Listed(ends) => ends.first().and_then(|ends| ends.first()).copied().unwrap_or(self.output_step),
            StepList::Passing { ends, .. } => ends.first().copied().unwrap_or(self.output_step),
            StepList::Segmented(_) => self.longest_step(),
        }
    }

    /// The steps that lead to a row: (length, time at the end). Those between events lead to none.
    pub fn steps_to(&self, row: usize) -> impl Iterator<Item = (f64, f64)> {
        let count = match &self.steps {
            _ if row == 0 => 0,
            StepList::Fixed { last, .. } if row + 1 == self.rows => last.whole + last.rests,
            StepList::Fixed { per_row, .. } => *per_row,
            StepList::Listed(ends) => ends[row - 1].len(),
            StepList::Passing { .. } => self.steps_before(row) - self.steps_before(row - 1),
            StepList::Segmented(_) => 0,
        };
        (0..count).map(move |index| match &self.steps {
            StepList::Fixed { last, .. } if row + 1 == self.rows && index >= last.whole => {
                (last.rest, self.end - (last.whole + last.rests - index - 1) as f64 * last.rest)
            }
            StepList::Fixed { step, per_row, .. } => (*step, ((row - 1) * per_row + index + 1) as f64 * step),
            StepList::Listed(ends) => {
                let before = if index == 0 { self.time(row - 1) } else { ends[row - 1][index - 1] };
                (ends[row - 1][index] - before, ends[row - 1][index])
            }
            StepList::Passing { ends, .. } => {
                let place = self.steps_before(row - 1) + index;
                let before = if place == 0 { 0.0 } else { ends[place - 1] };
                (ends[place] - before, ends[place])
            }
            StepList::Segmented(_) => (0.0, self.end),
        })
    }

    /// Number of steps up to a row; of those between events, the row's share of all.
    pub fn steps_before(&self, row: usize) -> usize {
        match &self.steps {
            StepList::Fixed { per_row, last, .. } if row > 0 && row + 1 == self.rows => {
                (row - 1) * per_row + last.whole + last.rests
            }
            StepList::Fixed { per_row, .. } => row * per_row,
            StepList::Listed(ends) => ends[..row].iter().map(Vec::len).sum(),
            StepList::Passing { ends, .. } => {
                let time = self.time(row);
                ends.partition_point(|&end| end <= time)
            }
            StepList::Segmented(segments) => segments.count() * row / (self.rows - 1).max(1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixed_steps_end_at_the_rows() {
        let schedule = Schedule::fixed(2.0, 1e-3, 0.01);
        assert_eq!(schedule.rows, 201);
        let steps: Vec<(f64, f64)> = schedule.steps_to(200).collect();
        assert_eq!(steps.len(), 10);
        assert!((steps[9].1 - 2.0).abs() < 1e-12);
        assert_eq!(schedule.steps_before(200), 2000);
    }

    /// Whatever the duration, the steps are as long as they should be, the last is not longer, and they end where the
    /// run does.
    #[test]
    fn the_last_row_is_at_the_end() {
        for (duration, step, output_step) in [
            (0.7, 1e-3, 3e-3),
            (0.5, 1e-3, 2e-3),
            (1.0, 0.03, 0.06),
            (0.355, 0.01, 0.1),
            (0.35, 0.01, 0.35),
            (0.02, 0.03, 0.03),
        ] {
            let schedule = Schedule::fixed(duration, step, output_step);
            for schedule in [schedule.clone(), schedule.refined(2), schedule.with_steps_per_row(3)] {
                assert_eq!(schedule.time(schedule.rows - 1), duration);
                let (mut time, mut count, mut before) = (0.0, 0, f64::INFINITY);
                for row in 1..schedule.rows {
                    for (h, end) in schedule.steps_to(row) {
                        assert!(
                            (time + h - end).abs() < 1e-12 && h <= before * (1.0 + 1e-9),
                            "{duration}: {h} to {end}"
                        );
                        (time, count, before) = (end, count + 1, h);
                    }
                    assert!((time - schedule.time(row)).abs() < 1e-9 * duration, "{duration}: {time}");
                }
                assert_eq!(count, schedule.steps_before(schedule.rows - 1));
            }
        }
    }

    #[test]
    fn listed_steps_have_their_lengths() {
        let schedule = Schedule::listed(0.1, vec![vec![0.05, 0.1], vec![0.2]]);
        let steps: Vec<(f64, f64)> = schedule.steps_to(1).chain(schedule.steps_to(2)).collect();
        assert_eq!(steps, [(0.05, 0.05), (0.05, 0.1), (0.1, 0.2)]);
    }

    #[test]
    fn incommensurate_steps_coincide_only_at_rows() {
        for per_row in 1..40 {
            let schedule = Schedule::fixed(1.0, 1.0 / per_row as f64, 1.0);
            let listed = Schedule::listed(1.0, vec![schedule.steps_to(1).map(|(_, end)| end).collect()]);
            for schedule in [schedule, listed] {
                let ends: Vec<f64> = schedule.refined(2).steps_to(1).map(|(_, end)| end).collect();
                let others: Vec<f64> = schedule.at_odds().steps_to(1).map(|(_, end)| end).collect();
                let finer = others.len() as f64 / per_row as f64;
                assert!((2.2..4.0).contains(&finer), "{per_row}: {finer}");
                let meets = |end: &&f64| others.iter().any(|other| (*end - other).abs() < 1e-9);
                assert_eq!(ends.iter().filter(meets).count(), 1, "{per_row}");
                assert!((others[others.len() - 1] - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn refined_steps_end_at_the_same_rows() {
        for schedule in [Schedule::fixed(0.2, 0.05, 0.1), Schedule::listed(0.1, vec![vec![0.025, 0.1], vec![0.2]])] {
            let refined = schedule.refined(3);
            assert_eq!(refined.steps_before(2), 3 * schedule.steps_before(2));
            for row in 1..3 {
                let (coarse, fine): (Vec<_>, Vec<_>) =
                    (schedule.steps_to(row).collect(), refined.steps_to(row).collect());
                for (coarse, fine) in coarse.iter().zip(fine.chunks_exact(3)) {
                    assert!(fine.iter().all(|(h, _)| (3.0 * h - coarse.0).abs() < 1e-15));
                    assert!((fine[2].1 - coarse.1).abs() < 1e-15);
                }
            }
        }
    }
}
