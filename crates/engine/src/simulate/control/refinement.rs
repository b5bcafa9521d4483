//! Schedules of the same rows with more steps, from which errors are estimated.

use super::schedule::{LastSteps, Schedule, StepList};
use super::tuning::TUNING;
use crate::simulate::events::segments::divided;

/// A number of steps none of which ends where one of `count` steps, or half of one, ends.
fn odd_to(count: usize) -> usize {
    let least = (TUNING.finer_steps * count as f64).round() as usize;
    (least..).find(|&others| are_coprime(others, 2 * count)).unwrap_or(least)
}

fn are_coprime(a: usize, b: usize) -> bool {
    if b == 0 { a == 1 } else { are_coprime(b, a % b) }
}

/// As `divided`, for steps with some fixed ends `kept`; `others(n)` steps replace the n steps between two of these.
fn divided_between(ends: &[f64], kept: &[usize], others: impl Fn(usize) -> usize) -> StepList {
    let mut divisions = Vec::new();
    let mut still = Vec::with_capacity(kept.len());
    let mut times = vec![0.0];
    for (index, &end) in ends.iter().enumerate() {
        times.push(end);
        let is_kept = kept.binary_search(&index).is_ok();
        if is_kept || index + 1 == ends.len() {
            divisions.extend(divided(&times, others(times.len() - 1)));
            if is_kept {
                still.push(divisions.len() - 1);
            }
            times = vec![end];
        }
    }
    StepList::Passing { ends: divisions, kept: still }
}

impl Schedule {
    /// The same rows, each step divided into `parts` equal ones.
    #[must_use]
    pub fn refined(&self, parts: usize) -> Self {
        let steps = match &self.steps {
            StepList::Fixed { step, per_row, last } => StepList::Fixed {
                step: step / parts as f64,
                per_row: per_row * parts,
                last: LastSteps {
                    whole: last.whole * parts,
                    rests: last.rests * parts,
                    rest: last.rest / parts as f64,
                },
            },
            StepList::Passing { ends, kept } => divided_between(ends, kept, |count| count * parts),
            StepList::Segmented(segments) => StepList::Segmented(segments.with_steps(|count| count * parts)),
            StepList::Listed(ends) => {
                let refine = |row: usize| {
                    self.steps_to(row)
                        .flat_map(|(h, end)| {
                            (1..=parts).map(move |part| end - h * (parts - part) as f64 / parts as f64)
                        })
                        .collect()
                };
                StepList::Listed((1..=ends.len()).map(refine).collect())
            }
        };
        Self { steps, ..*self }
    }

    /// The same rows with between two and three steps for each, none of which ends where a step or half a step does but
    /// at the rows, and where equations switch.
    #[must_use]
    pub fn at_odds(&self) -> Self {
        let steps = match &self.steps {
            StepList::Fixed { .. } => return self.with_steps_per_row(odd_to(self.steps_per_row().unwrap_or(1))),
            StepList::Passing { ends, kept } => divided_between(ends, kept, odd_to),
            StepList::Segmented(segments) => StepList::Segmented(segments.with_steps(odd_to)),
            StepList::Listed(ends) => {
                let of_row = |row: usize| {
                    let mut times = vec![self.time(row - 1)];
                    times.extend(&ends[row - 1]);
                    divided(&times, odd_to(times.len() - 1)).collect()
                };
                StepList::Listed((1..=ends.len()).map(of_row).collect())
            }
        };
        Self { steps, ..*self }
    }

    /// Length of other steps over that of these, on average.
    pub fn ratio_to(&self, other: &Self) -> f64 {
        let [these, others] =
            [self, other].map(|schedule| schedule.steps_before(schedule.rows.saturating_sub(1)) as f64);
        if others > 0.0 { these / others } else { 1.0 / TUNING.finer_steps }
    }
}
