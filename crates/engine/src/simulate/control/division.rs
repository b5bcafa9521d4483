//! Steps divided where they do not resolve the functions of the time.

use std::ops::Range;

use super::schedule::Schedule;
use super::tuning::TUNING;
use crate::simulate::time_functions::tuning::TUNING as TIME_FUNCTIONS;
use crate::simulate::time_functions::{TimeFunctions, Work};

/// A schedule with its steps divided.
#[derive(Clone, Debug)]
pub struct Divided {
    /// The schedule.
    pub schedule: Schedule,
    /// The first row before which a step does not resolve a function of the time.
    pub unresolved_from: Option<usize>,
}

impl TimeFunctions {
    /// The same rows, with those steps divided that do not resolve a function of the time. A schedule that resolves all
    /// is returned as it is.
    pub fn divided(&self, schedule: &Schedule) -> Divided {
        let mut division = Division { functions: self, schedule, work: Work::default(), unresolved_from: None };
        let mut rows = Vec::new();
        division.find_rows(1..schedule.rows, &mut rows);
        if rows.is_empty() {
            return Divided { schedule: schedule.clone(), unresolved_from: None };
        }
        let steps = schedule.steps_before(schedule.rows.saturating_sub(1));
        let mut left = TUNING
            .most_parts_of_step
            .saturating_mul(steps)
            .saturating_add(TUNING.most_parts_besides)
            .min(steps + TUNING.most_further_steps);
        let mut rows = rows.into_iter().peekable();
        let mut ends = Vec::with_capacity(schedule.rows - 1);
        for row in 1..schedule.rows {
            let mut list = Vec::new();
            if division.work.enclosures() > TIME_FUNCTIONS.most_enclosures {
                left = 0;
            }
            if rows.next_if_eq(&row).is_some() && left > 0 {
                division.divide_row(row, left, &mut list);
                left = left.saturating_sub(list.len());
            } else {
                list.extend(schedule.steps_to(row).map(|(_, end)| end));
                if left == 0 {
                    division.unresolved_from.get_or_insert(row);
                }
            }
            // The last step ends at the row, to the bit.
            if let Some(last) = list.last_mut() {
                *last = schedule.time(row);
            }
            ends.push(list);
        }
        let unresolved_from = division.unresolved_from;
        Divided { schedule: Schedule::listed(schedule.output_step, ends).taken(schedule.integration), unresolved_from }
    }
}

/// The division of a schedule.
struct Division<'a> {
    functions: &'a TimeFunctions,
    schedule: &'a Schedule,
    work: Work,
    unresolved_from: Option<usize>,
}

impl Division<'_> {
    /// Rows before which there are steps to divide, ascending.
    fn find_rows(&mut self, rows: Range<usize>, into: &mut Vec<usize>) {
        if rows.is_empty() {
            return;
        }
        let schedule = self.schedule;
        let longest = match schedule.steps_per_row() {
            Some(_) => schedule.longest_step(),
            None => rows.clone().flat_map(|row| schedule.steps_to(row)).map(|(h, _)| h).fold(0.0, f64::max),
        };
        let span = (schedule.time(rows.start - 1), schedule.time(rows.end - 1));
        if self.functions.are_resolved(span, longest, TIME_FUNCTIONS.too_fast, &mut self.work) {
            return;
        }
        if rows.len() == 1 {
            into.push(rows.start);
            return;
        }
        let middle = rows.start + rows.len() / 2;
        self.find_rows(rows.start..middle, into);
        self.find_rows(middle..rows.end, into);
    }

    /// Ends of the steps to a row, divided where necessary; no more than `most` and those of a last step.
    fn divide_row(&mut self, row: usize, most: usize, ends: &mut Vec<f64>) {
        for (h, end) in self.schedule.steps_to(row) {
            let span = (end - h, end);
            if self.functions.are_resolved(span, h, TIME_FUNCTIONS.too_fast, &mut self.work) {
                ends.push(end);
            } else if ends.len() > most || !self.divide(end - h, end, self.functions.halvings(), most, ends) {
                self.unresolved_from.get_or_insert(row);
                if ends.last().is_none_or(|&last| last < end) {
                    ends.push(end);
                }
            }
        }
    }

    /// Divides a step; whether all its parts resolve the functions.
    fn divide(&mut self, a: f64, b: f64, halvings: u32, most: usize, ends: &mut Vec<f64>) -> bool {
        let resolved = self.functions.are_resolved((a, b), b - a, TIME_FUNCTIONS.resolved, &mut self.work);
        if resolved || halvings == 0 || ends.len() > most {
            ends.push(b);
            return resolved;
        }
        let middle = 0.5 * (a + b);
        let first = self.divide(a, middle, halvings - 1, most, ends);
        let second = self.divide(middle, b, halvings - 1, most, ends);
        first && second
    }
}
