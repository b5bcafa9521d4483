//! One step after another that resolves the functions of the time, within a number of enclosures: functions with very
//! short periods are refused in words, before hours go by.

use super::enclosed::Work;
use super::resolution::TimeFunctions;
use super::tuning::TUNING;
use crate::assemble::System;
use crate::numerics::Sample;
use crate::simulate::diagnostics::place_of;
use crate::simulate::error::SimulationError;

/// The steps of a run.
#[derive(Debug)]
pub(in crate::simulate) struct ResolvingSteps {
    functions: TimeFunctions,
    work: Work,
    /// The last step that was shortened.
    last: Option<f64>,
    /// Whether steps end at jumps, which are looked for.
    end_at_jumps: bool,
}

impl ResolvingSteps {
    /// For a run of at most `most` steps.
    ///
    /// # Errors
    /// Where functions of the time take many more steps than that.
    pub(in crate::simulate) fn new(
        functions: TimeFunctions,
        system: &System,
        most: usize,
    ) -> Result<Self, SimulationError> {
        let mut found = Self { functions, work: Work::default(), last: None, end_at_jumps: false };
        found.refuse_too_many(system, most)?;
        Ok(found)
    }

    /// For a sample whose steps end at jumps.
    pub(in crate::simulate) fn between_jumps(functions: &TimeFunctions, sample: &Sample) -> Self {
        Self { functions: functions.of_sample(sample), work: Work::default(), last: None, end_at_jumps: true }
    }

    fn refuse_too_many(&mut self, system: &System, most: usize) -> Result<(), SimulationError> {
        let duration = self.functions.duration();
        let share = duration / TUNING.counted_times as f64;
        // Times that no period of a function is a multiple of.
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let mut steps: Vec<(f64, f64)> = (1..=TUNING.counted_times)
            .map(|index| (1.0 - share / duration) * duration * (golden * index as f64).fract())
            .map(|from| (from, self.resolved_step(from, share, share, TUNING.halvings_of_share)))
            .collect();
        steps.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.total_cmp(&b.0)));
        steps.truncate(TUNING.counted_times - TUNING.densest_left_out);
        let expected: f64 = steps.iter().map(|(_, step)| share / step).sum();
        match steps.last() {
            Some(&(from, step)) if expected > TUNING.uncertain_count * most as f64 => {
                Err(self.too_fast(system, from, step, most))
            }
            _ => Ok(()),
        }
    }

    /// A part h of a step, halved until it resolves all functions, at most `halvings` times.
    fn resolved_step(&mut self, from: f64, step: f64, mut h: f64, halvings: u32) -> f64 {
        for _ in 0..halvings {
            let share = if h < step { TUNING.resolved } else { TUNING.too_fast };
            let (functions, span) = (&self.functions, (from, from + h));
            let are_resolved = match self.end_at_jumps {
                true => functions.are_resolved_between_jumps(span, h, share, &mut self.work),
                false => functions.are_resolved(span, h, share, &mut self.work),
            };
            if are_resolved {
                break;
            }
            h *= 0.5;
        }
        h
    }

    /// The longest step from a time, of `step` halved and halved again and at most twice as long as one before that was
    /// shortened, that resolves all functions of the time; of those that are not too short for the equations.
    ///
    /// # Errors
    /// Where the search takes too long.
    pub(in crate::simulate) fn longest(
        &mut self,
        from: f64,
        step: f64,
        system: &System,
    ) -> Result<f64, SimulationError> {
        if self.work.enclosures() > TUNING.most_enclosures {
            let short = self.last.unwrap_or(step);
            return Err(self.too_fast(system, from, short, 0));
        }
        Ok(self.resolving(from, step))
    }

    /// The same, however long the search takes.
    pub(in crate::simulate) fn resolving(&mut self, from: f64, step: f64) -> f64 {
        let (mut h, mut halvings) = (step, self.functions.halvings());
        let most = self.last.map_or(f64::INFINITY, |last| TUNING.growth_of_steps * last * (1.0 + 1e-9));
        while h > most && halvings > 0 {
            h *= 0.5;
            halvings -= 1;
        }
        let h = self.resolved_step(from, step, h, halvings);
        self.last = Some(h).filter(|&h| h < step);
        h
    }

    /// Error for a step that is as long as the functions allow: steps of twice its length do not resolve them.
    fn too_fast(&mut self, system: &System, time: f64, step: f64, most: usize) -> SimulationError {
        let h = 2.0 * step;
        let unresolved = self.functions.first_unresolved(time, h, &mut self.work);
        let (function, period) = match unresolved {
            Some(found) => (place_of(system, found.of, found.formula), found.period),
            None => ("a function of the time".to_owned(), h),
        };
        SimulationError::TooFast { function, period, step, time, steps: self.functions.duration() / step, most }
    }
}
