//! Schedules whose steps end at the instants at which states change.

use std::borrow::Cow;

use super::schedule::Schedule;
use super::tuning::TUNING;
use crate::compile::SampledValue;
use crate::simulate::sampling::Instants;

impl Schedule {
    /// The same with steps that end at all multiples of periods, s, too.
    #[must_use]
    pub fn ending_at_multiples(&self, periods: &[f64]) -> Self {
        let multiples = |&period: &f64| SampledValue { state: 0, value: 0, period };
        let multiples: Vec<SampledValue> = periods.iter().map(multiples).collect();
        self.ending_at(Instants::at(&multiples)).into_owned()
    }

    /// The same with steps that end at some times, s, too, unless they end near them.
    #[must_use]
    pub fn ending_at_times(&self, times: &[f64]) -> Self {
        let parts = |h: f64, end: f64| {
            let near = TUNING.shortest_part * h;
            let within = times.iter().copied().filter(move |time| *time > end - h + near && *time < end - near);
            let mut ends: Vec<f64> = within.collect();
            ends.sort_by(f64::total_cmp);
            ends.dedup_by(|later, earlier| *later - *earlier < near);
            ends.push(end);
            ends
        };
        self.divided(&parts)
    }

    /// The same with each step divided at the instants in it, so that all parts of a step that are halved later end
    /// there too.
    pub(in crate::simulate) fn ending_at(&self, instants: Instants<'_>) -> Cow<'_, Self> {
        let mut steps = (1..self.rows).flat_map(|row| self.steps_to(row));
        if instants.is_empty() || steps.all(|(h, end)| instants.between(end - h, end).is_none()) {
            return Cow::Borrowed(self);
        }
        Cow::Owned(self.divided(&|h, end| instants.divide(h, end).map(|(_, end)| end).collect()))
    }

    /// The same with each step (its length and end, s) divided into parts with these ends.
    fn divided(&self, parts: &dyn Fn(f64, f64) -> Vec<f64>) -> Self {
        let (duration, output_step) = (self.end(), self.output_step);
        let ends = |row: usize| self.steps_to(row).flat_map(|(h, end)| parts(h, end)).collect::<Vec<f64>>();
        let divided = if self.passes_rows() {
            let ends = (1..self.rows).flat_map(ends);
            let at_rows = ends.map(|end| Self::at_row(end, duration, output_step)).collect();
            Self::passing(duration, output_step, at_rows, Vec::new())
        } else {
            Self::listed(self.output_step, (1..self.rows).map(ends).collect())
        };
        divided.taken(self.integration)
    }

    /// An instant, or the time of the row that it equals but for rounding, so that the row comes after the changes
    /// there; of a schedule of this duration and output step, s.
    pub(in crate::simulate) fn at_row(instant: f64, duration: f64, output_step: f64) -> f64 {
        let row = (instant / output_step).round();
        let time = Self::time_of(duration, output_step, row as usize);
        if (time - instant).abs() <= TUNING.same_instant * output_step { time } else { instant }
    }
}
