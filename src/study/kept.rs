//! Simulations of an ensemble that are kept in a store: read where they are there, simulated or deferred where they are not.

use std::ops::Range as Rows;

use super::ensemble::Motions;
use super::price::INSTRUCTION_SECONDS;
use crate::methods::{Ensemble, Observed, Sampling, Simulated, Until, lines};
use crate::numerics::{Sample, ScanBounds};
use crate::simulate::SimulationError;
use crate::store::{PartReader, ScanPart, Store, StoreError, Task};

/// Values of a part are about so many bytes, in samples between [`FEWEST`] and [`MOST`], a whole number of the widest tiles.
const PART_BYTES: usize = 64 << 20;
const FEWEST: usize = 32;
const MOST: usize = 1024;

/// Where the simulations of a study are kept.
#[derive(Clone, Copy)]
pub(super) struct Kept<'a> {
    pub store: &'a Store,
    /// Number of the subsystem.
    pub subsystem: usize,
}

fn of_store(error: StoreError) -> SimulationError {
    SimulationError::Store { message: error.to_string() }
}

impl Kept<'_> {
    /// As [`Ensemble::simulate`], by parts of the samples.
    pub fn simulate(
        &self,
        motions: &Motions,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Result<Simulated, SimulationError> {
        let lines = lines(motions, sampling.observed);
        let of_sample = (8 * lines * motions.rows()).max(1);
        let size = (PART_BYTES / of_sample).clamp(FEWEST, MOST) / FEWEST * FEWEST;
        let tasks: Vec<Task> = samples
            .chunks(size)
            .map(|samples| self.task(motions, samples, (sampling.observed, sampling.until), None))
            .collect();
        let mut parts = self.parts(motions, &tasks)?;
        let mut total = Simulated::default();
        for (number, part) in parts.iter().enumerate() {
            total.add(number * size, part.simulated.clone());
        }
        let counts: Vec<usize> = tasks.iter().map(|task| task.samples.len()).collect();
        deliver(&mut parts, (&counts, lines), reduce)?;
        Ok(total)
    }

    /// As [`Ensemble::scan`].
    pub fn scan(
        &self,
        motions: &Motions,
        samples: &[Sample],
        points: &[usize],
        first: usize,
    ) -> Result<(ScanBounds, Simulated), SimulationError> {
        let scan = ScanPart { points: points.to_vec(), first };
        let task = self.task(motions, samples, (Observed::Outputs, Until::End), Some(scan));
        let part = self.parts(motions, std::slice::from_ref(&task))?.pop();
        match part.map(|part| (part.scan, part.simulated)) {
            Some((Some(bounds), simulated)) => Ok((bounds, simulated)),
            _ => Err(SimulationError::Store { message: "a part of a scan has no bounds".to_owned() }),
        }
    }

    fn task(
        &self,
        motions: &Motions,
        samples: &[Sample],
        (observed, until): (Observed, Until),
        scan: Option<ScanPart>,
    ) -> Task {
        let (schedule, tolerance) = motions.steps();
        let (schedule, samples) = (schedule.clone(), samples.to_vec());
        Task { subsystem: self.subsystem, schedule, tolerance, observed, until, scan, samples }
    }

    /// The parts of all tasks. Where one is deferred, all that are missing are.
    fn parts(&self, motions: &Motions, tasks: &[Task]) -> Result<Vec<PartReader>, SimulationError> {
        let mut parts = Vec::with_capacity(tasks.len());
        let mut missing = Vec::new();
        for (place, task) in tasks.iter().enumerate() {
            let name = self.store.name(task).map_err(of_store)?;
            let part = self.store.part(&name).map_err(of_store)?;
            if part.is_none() {
                missing.push((place, name));
            }
            parts.push(part);
        }
        let seconds = |task: &Task| seconds_of(motions, task);
        let total = missing.iter().map(|(place, _)| seconds(&tasks[*place])).sum();
        if !self.store.simulates(total) {
            for (place, name) in missing {
                let task = &tasks[place];
                let values = match task.scan {
                    Some(_) => 5 * motions.outputs(),
                    None => lines(motions, task.observed) * task.samples.len(),
                };
                self.store.defer(&name, task, seconds(task), (8 * values * motions.rows()) as u64).map_err(of_store)?;
            }
            return Err(SimulationError::Deferred);
        }
        for (place, name) in missing {
            if motions.is_interrupted() {
                return Err(SimulationError::Deferred);
            }
            simulate_part(motions, self.store, &name, &tasks[place])?;
            parts[place] = self.store.part(&name).map_err(of_store)?;
        }
        let lost = || SimulationError::Store { message: "a part that was just written cannot be read".to_owned() };
        parts.into_iter().map(|part| part.ok_or_else(lost)).collect()
    }
}

/// Simulates a task and keeps its part.
pub(super) fn simulate_part(motions: &Motions, store: &Store, name: &str, task: &Task) -> Result<(), SimulationError> {
    let mut writer = store.begin(name).map_err(of_store)?;
    if let Some(ScanPart { points, first }) = &task.scan {
        let (bounds, simulated) = motions.scan_here(&task.samples, points, *first)?;
        if motions.is_interrupted() {
            return Err(SimulationError::Deferred);
        }
        return writer.finish(&simulated, Some(&bounds)).map_err(of_store);
    }
    let sampling = Sampling { observed: task.observed, until: task.until, finish: false };
    let mut failed = Ok(());
    let simulated = motions.simulate_here(&task.samples, sampling, &mut |_, values| {
        if failed.is_ok() {
            failed = writer.rows(values);
        }
    })?;
    failed.map_err(of_store)?;
    if motions.is_interrupted() {
        // Half of the rows is no part.
        return Err(SimulationError::Deferred);
    }
    writer.finish(&simulated, None).map_err(of_store)
}

/// Gives the rows that all parts have, in blocks as those of a simulation of all samples.
fn deliver(
    parts: &mut [PartReader],
    (counts, lines): (&[usize], usize),
    reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
) -> Result<(), SimulationError> {
    let all: usize = counts.iter().sum();
    let rows_of = |(part, count): (&PartReader, &usize)| (part.left() as usize) / (lines * count).max(1);
    let rows = parts.iter().zip(counts).map(rows_of).min().unwrap_or(0);
    let block = Motions::rows_a_block(lines, all);
    let (mut values, mut read) = (Vec::new(), Vec::new());
    let mut next = 0;
    while next < rows {
        let block = next..(next + block).min(rows);
        values.resize(block.len() * lines * all, 0.0);
        let mut first = 0;
        for (part, &count) in parts.iter_mut().zip(counts) {
            read.resize(block.len() * lines * count, 0.0);
            part.read(&mut read).map_err(of_store)?;
            for (line, of_part) in read.chunks_exact(count).enumerate() {
                values[line * all + first..][..count].copy_from_slice(of_part);
            }
            first += count;
        }
        next = block.end;
        reduce(block, &values);
    }
    Ok(())
}

/// What a task is expected to take on one core, s.
fn seconds_of(motions: &Motions, task: &Task) -> f64 {
    let (schedule, _) = motions.steps();
    let steps = schedule.steps_before(schedule.rows.saturating_sub(1)) as f64;
    task.samples.len() as f64 * steps * motions.instructions_of_step() * INSTRUCTION_SECONDS
}
