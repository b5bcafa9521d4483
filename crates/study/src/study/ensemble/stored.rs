//! Simulations of an ensemble that are stored: read if they exist, else simulated or deferred.

use std::ops::Range as Rows;
use std::sync::atomic::Ordering;

use super::Motions;
use super::reducing::keep_reduced;
use super::tuning::TUNING;
use crate::methods::{Ensemble, Observed, Sampling, Simulated, Until, lines, scan_shard};
use crate::numerics::{Sample, ScanBounds, ScanGrid};
use crate::simulate::{SimulationError, Steps};
use crate::store::{PartReader, PartStore, ScanPart, StoreError, Task};
use crate::study::price::tuning::TUNING as PRICE;

/// Store of the simulations of a study.
#[derive(Clone, Copy)]
pub(in crate::study) struct Stored<'a> {
    pub store: &'a PartStore,
    /// Number of the subsystem.
    pub subsystem: usize,
    /// Whether samples that cannot be assembled are found before their tasks are deferred, since the box is cut by
    /// them.
    pub assembles_first: bool,
}

fn of_store(error: StoreError) -> SimulationError {
    SimulationError::Store { message: error.to_string() }
}

/// Samples of a part with `lines` lines and `rows` rows.
pub(in crate::study) fn samples_of_part(lines: usize, rows: usize) -> usize {
    let of_sample = (8 * lines * rows).max(1);
    (TUNING.part_bytes / of_sample).clamp(TUNING.fewest_of_part, TUNING.most_of_part) / TUNING.fewest_of_part
        * TUNING.fewest_of_part
}

impl Stored<'_> {
    /// Simulates the missing samples of these parts, to the end, or defers all of them.
    pub fn prepare(
        &self,
        motions: &Motions,
        parts: impl Iterator<Item = Vec<Sample>> + Clone,
    ) -> Result<(), SimulationError> {
        let tasks = parts.map(|samples| self.task(motions, samples, Observed::Outputs, Until::End, None));
        self.each_part(motions, tasks, |_, _| Ok(()))
    }

    /// As [`Ensemble::simulate`], by parts of the samples.
    pub fn simulate(
        &self,
        motions: &Motions,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Result<Simulated, SimulationError> {
        let lines = lines(motions, sampling.observed);
        let size = samples_of_part(lines, motions.rows());
        let task = |samples: &[Sample]| self.task(motions, samples.to_vec(), sampling.observed, sampling.until, None);
        let mut parts = Vec::new();
        self.each_part(motions, samples.chunks(size).map(task), |_, part| {
            parts.push(part);
            Ok(())
        })?;
        let mut total = Simulated::default();
        let counts: Vec<usize> = samples.chunks(size).map(<[Sample]>::len).collect();
        for ((number, part), samples) in parts.iter().enumerate().zip(samples.chunks(size)) {
            keep_reduced(motions, samples, &part.simulated.reduced);
            total.add(number * size, part.simulated.clone());
        }
        deliver(&mut parts, &counts, lines, reduce)?;
        Ok(total)
    }

    /// As [`Ensemble::scan`], by its shards.
    pub fn scan(&self, motions: &Motions, grid: &ScanGrid) -> Result<(ScanBounds, Simulated), SimulationError> {
        let task = |first: usize| {
            let scan = ScanPart { points: grid.points().to_vec(), first };
            self.task(motions, grid.samples(first, motions.domain), Observed::Outputs, Until::End, Some(scan))
        };
        let mut bounds = ScanBounds::new(motions.rows(), motions.outputs(), grid.points());
        let mut total = Simulated::default();
        self.each_part(motions, grid.shards().map(task), |task, part| {
            let (Some(own), Some(scan)) = (&part.scan, &task.scan) else {
                return Err(SimulationError::Store { message: "a part of a scan has no bounds".to_owned() });
            };
            bounds.merge(own);
            keep_reduced(motions, &task.samples, &part.simulated.reduced);
            total.add(scan.first, part.simulated);
            Ok(())
        })?;
        if let Some(ledger) = motions.ledger {
            let all = (0..motions.rows()).flat_map(|row| (0..motions.outputs()).map(move |output| (row, output)));
            all.for_each(|(row, output)| ledger.note_range(row, output, bounds.range(row, output)));
        }
        Ok((bounds, total))
    }

    fn task(
        &self,
        motions: &Motions,
        samples: Vec<Sample>,
        observed: Observed,
        until: Until,
        scan: Option<ScanPart>,
    ) -> Task {
        let Steps { schedule, controller } = motions.steps();
        let (subsystem, schedule, channels) = (self.subsystem, schedule.clone(), motions.channels.to_vec());
        Task { subsystem, schedule, tolerance: controller, observed, until, channels, scan, samples }
    }

    /// Gives every task with its part, which is simulated if it is missing. If the missing ones together take long, all
    /// of them are deferred.
    fn each_part(
        &self,
        motions: &Motions,
        tasks: impl Iterator<Item = Task> + Clone,
        mut take: impl FnMut(Task, PartReader) -> Result<(), SimulationError>,
    ) -> Result<(), SimulationError> {
        let mut seconds = 0.0;
        for task in tasks.clone() {
            if !self.store.has(&self.name(&task)?) {
                seconds += seconds_of(motions, &task);
            }
        }
        let simulates = self.store.simulates(seconds);
        let mut deferred = false;
        for task in tasks {
            let name = self.name(&task)?;
            let part = self.store.part(&name).map_err(of_store)?;
            match part {
                Some(part) if !deferred => {
                    // As over as those that are simulated here.
                    motions.over.fetch_add(task.samples.len(), Ordering::Relaxed);
                    take(task, part)?;
                }
                Some(_) => {}
                None if simulates => {
                    simulate_part(motions, self.store, &name, &task)?;
                    let part = self.store.part(&name).map_err(of_store)?;
                    let lost = || SimulationError::Store { message: format!("the part {name} cannot be read again") };
                    take(task, part.ok_or_else(lost)?)?;
                }
                None => {
                    if self.assembles_first && !motions.simulator.system.analysis.visits() {
                        motions.start(&task.samples)?;
                    }
                    let (seconds, bytes) = (seconds_of(motions, &task), bytes_of(motions, &task));
                    self.store.defer(&name, &task, seconds, bytes).map_err(of_store)?;
                    deferred = true;
                }
            }
        }
        if deferred { Err(SimulationError::Deferred) } else { Ok(()) }
    }

    fn name(&self, task: &Task) -> Result<String, SimulationError> {
        self.store.name(task).map_err(of_store)
    }
}

/// Simulates a task and stores its part.
pub(in crate::study) fn simulate_part(
    motions: &Motions,
    store: &PartStore,
    name: &str,
    task: &Task,
) -> Result<(), SimulationError> {
    if motions.is_interrupted() {
        return Err(SimulationError::Interrupted);
    }
    let mut writer = store.begin(name).map_err(of_store)?;
    let (simulated, bounds) = match &task.scan {
        Some(ScanPart { points, first }) => {
            let mut bounds = ScanBounds::new(motions.rows(), motions.outputs(), points);
            let simulated = scan_shard(&mut bounds, *first, &task.samples, |samples, sampling, reduce| {
                motions.simulate_here(samples, sampling, reduce)
            })?;
            (simulated, Some(bounds))
        }
        None => {
            let sampling = Sampling { observed: task.observed, until: task.until, whole: false };
            let mut written = Ok(());
            let simulated = motions.simulate_here(&task.samples, sampling, &mut |_, values| {
                if written.is_ok() {
                    written = writer.rows(values);
                }
            })?;
            written.map_err(of_store)?;
            (simulated, None)
        }
    };
    if motions.is_interrupted() {
        // Half of the rows is no part.
        return Err(SimulationError::Interrupted);
    }
    writer.finish(&simulated, bounds.as_ref()).map_err(of_store)
}

/// Gives the rows that all parts have, in blocks as those of a simulation of all samples.
fn deliver(
    parts: &mut [PartReader],
    counts: &[usize],
    lines: usize,
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

/// Expected time of a task on one core, s.
fn seconds_of(motions: &Motions, task: &Task) -> f64 {
    if motions.source.is_some() {
        return task.samples.len() as f64 * PRICE.answer_seconds;
    }
    let schedule = motions.steps().schedule;
    let steps = (schedule.steps_before(schedule.rows.saturating_sub(1)) * schedule.integration.steps()) as f64;
    task.samples.len() as f64 * steps * motions.instructions_of_step() * PRICE.instruction_seconds
}

/// Size of a task's part.
fn bytes_of(motions: &Motions, task: &Task) -> u64 {
    match task.scan {
        Some(_) => bytes_of_scan(motions.outputs(), motions.rows(), task.samples.len()),
        None => bytes_of_values(lines(motions, task.observed), motions.rows(), task.samples.len()),
    }
}

/// Size of the values of `samples` samples, bytes.
pub(in crate::study) fn bytes_of_values(lines: usize, rows: usize, samples: usize) -> u64 {
    (8 * lines * rows) as u64 * samples as u64
}

/// Size of the parts of a scan of `samples` samples, at most, bytes.
pub(in crate::study) fn bytes_of_scan(outputs: usize, rows: usize, samples: usize) -> u64 {
    bytes_of_values(TUNING.numbers_of_scan * outputs, rows, samples.div_ceil(ScanGrid::LEAST_SHARD))
}
