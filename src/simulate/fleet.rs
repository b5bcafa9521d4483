//! Many samples in step: tiles over all cores, advanced row by row of output.

use rayon::prelude::*;
use symdiff::WIDTHS;

use super::hht::{Stepper, Stuck};
use super::newton::Counters;
use super::simulator::{SimulationError, Simulator};
use super::singular::{SingularPass, SingularWatch};
use super::steps::Schedule;

/// Widest tile in use: a wider one's memory would leave the first-level cache.
const WIDEST: usize = 32;

/// Memory that a tile should not exceed, so that a large mechanism's stays in the second-level cache; it is narrower then,
/// down to [`NARROWEST`], where dispatch costs more than memory does.
const TILE_MEMORY: usize = 2 << 20;

/// See [`TILE_MEMORY`].
const NARROWEST: usize = 8;

/// A block of samples in step.
#[derive(Debug)]
pub struct Fleet<'s> {
    simulator: &'s Simulator,
    tiles: Vec<Member<'s>>,
    samples: usize,
}

#[derive(Debug)]
struct Member<'s> {
    stepper: Stepper<'s>,
    /// First sample of the tile, and how many of its lanes are samples.
    first: usize,
    count: usize,
    /// What each lane's local errors add up to, over the tolerance.
    strain: Vec<f64>,
    /// The first of its samples that stopped, and where the step began that it did not take.
    stopped: Option<(usize, Vec<f64>)>,
    /// Looks for singular configurations of the first lane.
    watch: Option<SingularWatch<'s>>,
}

/// What is looked at in each row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observed {
    /// The model's outputs.
    Outputs,
    /// Positions, then velocities (2n), then the model's outputs.
    Motion,
}

impl Observed {
    /// Number of values a row and sample.
    pub fn count(self, simulator: &Simulator) -> usize {
        match self {
            Self::Outputs => simulator.program.outputs.len(),
            Self::Motion => 2 * simulator.program.scale.len() + simulator.program.outputs.len(),
        }
    }
}

/// A sample that stopped, and in which row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Sample of the fleet.
    pub sample: usize,
    /// First row of output that it did not reach.
    pub row: usize,
    /// s
    pub time: f64,
    /// Of n + m, the one that resists most.
    pub equation: usize,
    /// The constraint that stays open there whatever the position, and by how much, where it is known that one does.
    pub open: Option<(usize, f64)>,
    /// Whether it would go on, but not with an invertible Newton matrix, which jets need.
    pub singular: bool,
}

/// How `samples` with so many slots each are cut into tiles for `threads`: (first, count, width). The results do not depend
/// on it.
fn tiles(samples: usize, slots: usize, threads: usize) -> Vec<(usize, usize, usize)> {
    let fits = TILE_MEMORY / (slots * size_of::<f64>()).max(1);
    let share = samples.div_ceil(threads).min(fits.clamp(NARROWEST, WIDEST));
    let width = WIDTHS.into_iter().rev().find(|&width| width <= share).unwrap_or(1);
    let mut tiles = Vec::new();
    let mut first = 0;
    while first < samples {
        let count = width.min(samples - first);
        let width = WIDTHS.into_iter().find(|&width| width >= count).unwrap_or(width);
        tiles.push((first, count, width));
        first += count;
    }
    tiles
}

impl<'s> Fleet<'s> {
    /// Assembles samples for a schedule that begins with steps of `first_step`.
    ///
    /// # Errors
    /// The first sample that cannot be assembled.
    pub fn start(simulator: &'s Simulator, samples: &[Vec<f64>], first_step: f64) -> Result<Self, SimulationError> {
        let tiles = tiles(samples.len(), simulator.program.slots(), rayon::current_num_threads());
        let assembled: Vec<Result<Member<'s>, SimulationError>> = tiles
            .into_par_iter()
            .map(|(first, count, width)| {
                // Lanes beyond the samples repeat the last one and do not run.
                let sample = |lane: usize| samples[first + lane.min(count - 1)].clone();
                let start = simulator.assemble(width, first_step, sample)?;
                let mut stepper = Stepper::new(&simulator.program, &start);
                stepper.retire(count..width);
                Ok(Member { stepper, first, count, strain: vec![0.0; width], stopped: None, watch: None })
            })
            .collect();
        let tiles = assembled.into_iter().collect::<Result<Vec<_>, _>>()?;
        Ok(Self { simulator, tiles, samples: samples.len() })
    }

    /// The same, looking for singular configurations that the first sample passes.
    #[must_use]
    pub fn watching(mut self) -> Self {
        if let Some(member) = self.tiles.first_mut() {
            member.watch = Some(SingularWatch::new(self.simulator, &member.stepper));
        }
        self
    }

    /// What is `observed` at `rows`, which follow those asked for last (row 0 is the start): row by row, value by value,
    /// sample by sample. With a tolerance, local errors are watched. Returns which samples stopped.
    pub fn advance(
        &mut self,
        schedule: &Schedule,
        rows: std::ops::Range<usize>,
        tolerance: Option<f64>,
        observed: Observed,
        into: &mut Vec<f64>,
    ) -> Vec<Stop> {
        let outputs = observed.count(self.simulator);
        let parts: Vec<(Vec<f64>, Vec<Stop>)> = self
            .tiles
            .par_iter_mut()
            .map(|member| member.advance(schedule, rows.clone(), tolerance, (observed, outputs)))
            .collect();
        into.clear();
        into.resize(rows.len() * outputs * self.samples, 0.0);
        let mut stops = Vec::new();
        for (member, (values, stopped)) in self.tiles.iter().zip(parts) {
            let width = member.stepper.tile().width();
            for (line, lanes) in values.chunks_exact(width).enumerate() {
                into[line * self.samples + member.first..][..member.count].copy_from_slice(&lanes[..member.count]);
            }
            stops.extend(stopped);
        }
        stops
    }

    /// Iterations and fallbacks so far.
    pub fn counters(&self) -> Counters {
        self.tiles.iter().fold(Counters::default(), |total, member| {
            let counters = member.stepper.counters();
            Counters {
                iterations: total.iterations + counters.iterations,
                rank_revealing: total.rank_revealing + counters.rank_revealing,
            }
        })
    }

    /// Singular configurations that the first sample has passed, where they were looked for.
    pub fn singular_passes(&self) -> Vec<SingularPass> {
        self.tiles.iter().filter_map(|member| member.watch.as_ref()).flat_map(SingularWatch::passes).collect()
    }

    /// A constraint that stays open where a sample stopped, whatever its position, and by how much: the mechanism locks there.
    /// Known of the first sample of each tile that stops.
    pub fn stays_open(&self, stop: &Stop, schedule: &Schedule) -> Option<(usize, f64)> {
        let mut stopped = self.tiles.iter().filter_map(|member| member.stopped.as_ref());
        let (_, state) = stopped.find(|(sample, _)| *sample == stop.sample)?;
        // An opening needs time to show.
        let times = [stop.time, stop.time + schedule.output_step];
        times.into_iter().find_map(|time| self.simulator.stays_open(state, time))
    }

    /// The sample whose local errors add up to most, and to how much over the tolerance.
    pub fn most_strained(&self) -> Option<(usize, f64)> {
        let strains = self.tiles.iter().flat_map(|member| {
            member.strain[..member.count].iter().enumerate().map(|(lane, &strain)| (member.first + lane, strain))
        });
        strains.reduce(|a, b| if b.1 > a.1 { b } else { a })
    }
}

impl Member<'_> {
    fn advance(
        &mut self,
        schedule: &Schedule,
        rows: std::ops::Range<usize>,
        tolerance: Option<f64>,
        (observed, outputs): (Observed, usize),
    ) -> (Vec<f64>, Vec<Stop>) {
        let width = self.stepper.tile().width();
        if tolerance.is_some() {
            self.stepper.estimate_errors();
        }
        let mut values = vec![0.0; rows.len() * outputs * width];
        let mut stops = Vec::new();
        for (place, row) in rows.enumerate() {
            for (h, end) in schedule.steps_to(row) {
                if !self.stepper.alive().contains(&true) {
                    break;
                }
                self.stepper.set_step_size(h);
                let stuck = self.stepper.step(h, end);
                if let (Some(first), None) = (stuck.first(), &self.stopped) {
                    self.stopped = Some((self.first + first.lane, self.stepper.lane(first.lane)));
                }
                if let Some(watch) = &mut self.watch {
                    watch.look(&self.stepper, end);
                }
                stops.extend(stuck.into_iter().map(|Stuck { lane, time, equation }| Stop {
                    sample: self.first + lane,
                    row,
                    time,
                    equation,
                    open: None,
                    singular: false,
                }));
                if let Some(tolerance) = tolerance {
                    for (lane, error) in self.stepper.local_errors().iter().enumerate() {
                        if self.stepper.alive()[lane] {
                            self.strain[lane] += error.size / tolerance;
                        }
                    }
                }
            }
            let values = &mut values[place * outputs * width..][..outputs * width];
            match observed {
                Observed::Outputs => self.stepper.observe(values),
                Observed::Motion => {
                    let (motion, outputs) = values.split_at_mut(2 * self.stepper.coordinates() * width);
                    self.stepper.copy_motion(motion);
                    self.stepper.observe(outputs);
                }
            }
        }
        (values, stops)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_all_samples_once() {
        for samples in 1..200 {
            for (threads, slots) in [(1, 100), (2, 100), (7, 100), (2, 100_000)] {
                let mut next = 0;
                for (first, count, width) in tiles(samples, slots, threads) {
                    assert_eq!(first, next);
                    assert!(count >= 1 && count <= width && WIDTHS.contains(&width));
                    next += count;
                }
                assert_eq!(next, samples);
            }
        }
    }
}
