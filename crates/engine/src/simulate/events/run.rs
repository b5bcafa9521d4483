//! An ensemble of samples in segments between events, row by row.

use rayon::prelude::*;
use symdiff::WIDTHS;

use super::boundary::margins;
use super::followed::Spelled;
use super::path::Path;
use super::segments::{Boundary, Segments};
use super::tile::{Lanes, SegmentTile};
use super::tuning::TUNING;
use crate::compile::SwitchProgram;
use crate::numerics::{BoundaryMargins, CutMotions, Sample, SegmentMotions};
use crate::simulate::control::{Schedule, Steps};
use crate::simulate::ensemble::{Accumulator, Channel, Observed, RowClosure, Stop, stops_of_lost};
use crate::simulate::error::SimulationError;
use crate::simulate::explicit::tuning::TUNING as EXPLICIT;
use crate::simulate::integrator::Integrator;
use crate::simulate::interruption::Interruption;
use crate::simulate::simulator::Simulator;

/// The run of an ensemble of samples.
#[derive(Debug)]
pub struct SegmentRun<'s> {
    simulator: &'s Simulator,
    segments: &'s Segments,
    tiles: Vec<RowTile<'s>>,
    samples: Vec<Sample>,
    /// By sample.
    words: Vec<Option<usize>>,
    duration: f64,
    interruption: Interruption<'s>,
    /// Whether it ended at an interruption.
    is_cut: bool,
}

/// A tile, and its rows.
#[derive(Debug)]
struct RowTile<'s> {
    tile: SegmentTile<'s>,
    rows: RowClosure<'s>,
    alive: Vec<bool>,
    /// The first row behind the first event that others do not meet.
    deviates: Option<usize>,
    /// Where outputs are reduced to one number: of each lane, whose steps are its own.
    reduced: Vec<Reduced<'s>>,
    /// Segments that are reduced.
    segments: usize,
    /// Number of outputs.
    outputs: usize,
}

/// The reduction of a lane's outputs, and the time up to which they are, s.
#[derive(Debug)]
struct Reduced<'s> {
    reduction: Accumulator<'s>,
    time: f64,
}

impl<'s> SegmentRun<'s> {
    /// Assembles samples, and finds the events of each.
    ///
    /// # Errors
    /// The first sample that cannot be assembled.
    pub fn start(
        simulator: &'s Simulator,
        samples: &[Sample],
        segments: &'s Segments,
        duration: f64,
    ) -> Result<Self, SimulationError> {
        let mut run = Self {
            simulator,
            segments,
            tiles: Vec::new(),
            samples: samples.to_vec(),
            words: Vec::new(),
            duration,
            interruption: Interruption::default(),
            is_cut: false,
        };
        let Some(program) = simulator.switches() else { return Ok(run) };
        let spell = |sample: &Sample| Ok(Spelled::by(run.path(program, sample)?, segments));
        let spelled: Vec<Spelled> = samples.par_iter().map(spell).collect::<Result<_, SimulationError>>()?;
        let mut lanes: Vec<Lanes> = Vec::new();
        for word in (0..segments.words.len()).map(Some).chain([None]) {
            let indices: Vec<usize> = (0..samples.len()).filter(|&sample| spelled[sample].word == word).collect();
            let at_once = indices.len().div_ceil(rayon::current_num_threads().max(1)).clamp(1, TUNING.run_width);
            lanes.extend(indices.chunks(at_once).map(|indices| Lanes {
                word: word.map(|word| &segments.words[word]),
                indices: indices.to_vec(),
                spelled: indices.iter().map(|&sample| spelled[sample].clone()).collect(),
            }));
        }
        let outputs = simulator.program.outputs.len();
        let of_lanes = |lanes: Lanes<'s>| {
            let own: Vec<Sample> = lanes.indices.iter().map(|&sample| samples[sample].clone()).collect();
            let width = WIDTHS.into_iter().find(|&width| width >= own.len()).unwrap_or(own.len());
            let tile = SegmentTile::start(simulator, program, segments, lanes, &own, width, duration)?;
            let start = simulator.assemble(width, 0.0, |lane| own[lane.min(own.len() - 1)].clone())?;
            let rows = RowClosure::new(simulator, &start)?;
            Ok(RowTile {
                tile,
                rows,
                alive: vec![true; width],
                deviates: None,
                reduced: Vec::new(),
                segments: 0,
                outputs,
            })
        };
        run.tiles = lanes.into_par_iter().map(of_lanes).collect::<Result<_, SimulationError>>()?;
        run.words = spelled.iter().map(|spelled| spelled.word).collect();
        Ok(run)
    }

    fn path(&self, program: &'s SwitchProgram, sample: &Sample) -> Result<Path<'s>, SimulationError> {
        Path::start(self.simulator, program, sample, self.duration, self.segments.tolerance)
    }

    /// The motions in their segments, to the end; `None` where an instant cannot be solved for.
    pub fn motions(mut self) -> Option<CutMotions> {
        let strays = |tile: &&RowTile| tile.tile.word.is_none();
        let deviates = |tile: &RowTile| tile.tile.deviates.unwrap_or(f64::INFINITY);
        let known_to = self.tiles.iter().filter(strays).map(deviates).fold(self.segments.horizon, f64::min);
        self.tiles.retain(|tile| tile.tile.word.is_some());
        self.tiles.par_iter_mut().for_each(|tile| tile.tile.march_to_the_end());
        if self.tiles.iter().any(|tile| deviates(tile) < self.segments.horizon) {
            return None;
        }
        let of_word = |number: usize| {
            let word = &self.segments.words[number];
            let is_of_word = |tile: &&RowTile| tile.tile.word.is_some_and(|own| std::ptr::eq(own, word));
            let tiles: Vec<&SegmentTile> = self.tiles.iter().filter(is_of_word).map(|tile| &tile.tile).collect();
            gathered(&tiles, &word.steps)
        };
        let words = (0..self.segments.words.len()).map(of_word).collect();
        let boundaries = self.segments.boundaries.iter().map(|boundary| self.margins(boundary)).collect();
        Some(CutMotions { words, boundaries, known_to })
    }

    /// Margins of all samples.
    fn margins(&self, boundary: &Boundary) -> BoundaryMargins {
        let is_of = |words: &[usize], sample: usize| self.words[sample].is_some_and(|word| words.contains(&word));
        let all = (0..self.samples.len())
            .map(|sample| (sample, is_of(&boundary.met, sample)))
            .filter(|&(sample, is_met)| is_met || is_of(&boundary.missed, sample));
        let all: Vec<(usize, bool)> = all.collect();
        let path = |sample: usize| self.path(self.simulator.switches()?, &self.samples[sample]).ok();
        let found = margins(boundary, &all, path, self.segments.horizon);
        let mut values = vec![f64::NAN; self.samples.len()];
        all.iter().zip(found).for_each(|((sample, _), margin)| values[*sample] = margin);
        BoundaryMargins { met: boundary.met.clone(), missed: boundary.missed.clone(), values }
    }
}

impl<'s> Integrator<'s> for SegmentRun<'s> {
    /// Nothing is searched for between events.
    fn watch(&mut self) {}

    /// Of samples that spell no word nothing is reduced.
    fn reduce(&mut self, channels: &'s [Channel]) {
        let outputs = self.simulator.program.outputs.len();
        let start = || Reduced { reduction: Accumulator::new(channels, outputs, 1), time: f64::NEG_INFINITY };
        for tile in self.tiles.iter_mut().filter(|_| !channels.is_empty()) {
            tile.reduced = tile.tile.samples.iter().map(|_| start()).collect();
        }
    }

    fn heed(&mut self, interruption: Interruption<'s>) {
        self.interruption = interruption;
    }

    fn is_cut(&self) -> bool {
        self.is_cut
    }

    fn advance(
        &mut self,
        steps: Steps<'_>,
        rows: std::ops::Range<usize>,
        observed: Observed,
        into: &mut Vec<f64>,
    ) -> Vec<Stop> {
        let schedule = steps.schedule;
        let lines = observed.count(self.simulator);
        let interruption = self.interruption;
        let advance = |tile: &mut RowTile| tile.advance(schedule, rows.clone(), observed, lines, interruption);
        let parts: Option<Vec<(Vec<f64>, Vec<Stop>)>> = self.tiles.par_iter_mut().map(advance).collect();
        let Some(parts) = parts else {
            self.is_cut = true;
            return Vec::new();
        };
        into.clear();
        let samples = self.samples.len();
        into.resize(rows.len() * lines * samples, 0.0);
        let mut stops = Vec::new();
        for (RowTile { tile, .. }, (values, stopped)) in self.tiles.iter().zip(parts) {
            for (line, of_tile) in values.chunks_exact(tile.width()).enumerate() {
                tile.samples.iter().zip(of_tile).for_each(|(sample, value)| into[line * samples + sample] = *value);
            }
            stops.extend(stopped.into_iter().map(|stop| Stop { sample: tile.samples[stop.sample], ..stop }));
        }
        stops.sort_by_key(|stop| (stop.row, stop.sample));
        stops
    }

    fn reduced(&mut self) -> Vec<f64> {
        let samples = self.samples.len();
        let mut values = Vec::new();
        for tile in &mut self.tiles {
            let is_known = tile.tile.deviates.is_none();
            for (sample, reduced) in tile.tile.samples.iter().zip(&mut tile.reduced) {
                let found = reduced.reduction.finish();
                values.resize(found.len() * samples, f64::NAN);
                for (channel, value) in found.into_iter().enumerate().filter(|_| is_known) {
                    values[channel * samples + sample] = value;
                }
            }
        }
        values
    }

    /// The first row behind an event that some sample meets and others do not.
    fn beyond_tolerance_from(&self) -> Option<usize> {
        self.tiles.iter().filter_map(|tile| tile.deviates).min()
    }
}

/// Motions of all samples of a word.
fn gathered(tiles: &[&SegmentTile], steps: &[Vec<f64>]) -> SegmentMotions {
    let count = steps.len();
    let of_all = |of_tile: &dyn Fn(&SegmentTile) -> Vec<f64>| -> Vec<f64> {
        let parts: Vec<(Vec<f64>, &SegmentTile)> = tiles.iter().map(|tile| (of_tile(tile), *tile)).collect();
        let lines = parts.first().map_or(0, |(values, tile)| values.len() / tile.width());
        let line = |line: usize| {
            parts
                .iter()
                .flat_map(move |(values, tile)| values[line * tile.width()..][..tile.samples.len()].iter().copied())
        };
        (0..lines).flat_map(line).collect()
    };
    let begin = |number: usize| of_all(&|tile| tile.recorded[number].begin.clone());
    let end = |number: usize| {
        of_all(&|tile| {
            let Some(last) = tile.recorded.get(number) else { return Vec::new() };
            last.begin.iter().zip(&last.length).map(|(begin, length)| begin + length).collect()
        })
    };
    let nodes = |number: usize| {
        let count = tiles.first().map_or(0, |tile| tile.recorded[number].nodes.len());
        (0..count).map(|node| of_all(&|tile| tile.recorded[number].nodes[node].clone())).collect()
    };
    SegmentMotions {
        samples: tiles.iter().flat_map(|tile| tile.samples.iter().copied()).collect(),
        steps: steps.to_vec(),
        times: (0..count).map(begin).chain(count.checked_sub(1).map(end)).collect(),
        nodes: (0..count).map(nodes).collect(),
    }
}

impl RowTile<'_> {
    /// Reduces outputs over the segments that were passed since the last call, up to the end of the rows.
    fn reduce(&mut self, end: f64) {
        let Some(word) = self.tile.word.filter(|_| !self.reduced.is_empty()) else { return };
        let (width, lines) = (self.tile.width(), self.tile.lines());
        let mut state = vec![0.0; lines * width];
        let mut own = vec![0.0; lines];
        let mut outputs = vec![0.0; self.outputs * width];
        while let Some(recorded) = self.tile.recorded.iter().find(|recorded| recorded.number == self.segments) {
            let steps = &word.steps[recorded.number];
            let begins = std::iter::once(0.0).chain(steps.iter().copied());
            let of_step = |(begin, end): (f64, f64)| {
                (0..=EXPLICIT.places_of_reduced)
                    .map(move |part| begin + (end - begin) * part as f64 / EXPLICIT.places_of_reduced as f64)
            };
            for share in begins.zip(steps.iter().copied()).flat_map(of_step) {
                for lane in 0..width {
                    let time = (recorded.begin[lane] + share * recorded.length[lane]).min(end);
                    self.rows.times_mut()[lane] = time;
                    recorded.interpolate(steps, lane, width, time, &mut own);
                    state.iter_mut().skip(lane).step_by(width).zip(&own).for_each(|(value, own)| *value = *own);
                }
                self.rows.close_at_times(&mut state);
                self.rows.observe(&mut outputs);
                let times = self.rows.times_mut().to_vec();
                for ((lane, reduced), time) in self.reduced.iter_mut().enumerate().zip(times) {
                    // The end of one step is the beginning of the next, and nothing is behind the end.
                    if time > reduced.time {
                        let mut values = reduced.reduction.buffer();
                        values
                            .iter_mut()
                            .zip(outputs.iter().skip(lane).step_by(width))
                            .for_each(|(own, value)| *own = *value);
                        reduced.reduction.push(time, values, &[true]);
                        reduced.time = time;
                    }
                }
            }
            self.segments += 1;
        }
    }

    /// None at an interruption.
    fn advance(
        &mut self,
        schedule: &Schedule,
        rows: std::ops::Range<usize>,
        observed: Observed,
        lines: usize,
        interruption: Interruption,
    ) -> Option<(Vec<f64>, Vec<Stop>)> {
        let width = self.tile.width();
        let mut values = vec![0.0; rows.len() * lines * width];
        let mut stops = Vec::new();
        let mut state = vec![0.0; self.tile.lines() * width];
        for (row, values) in rows.zip(values.chunks_exact_mut((lines * width).max(1))) {
            if interruption.is_asked() {
                return None;
            }
            let time = schedule.time(row);
            if self.tile.deviates.is_some_and(|from| from <= time) {
                self.deviates.get_or_insert(row);
            }
            self.tile.reach(time, &mut state);
            self.reduce(schedule.end());
            self.tile.forget_before(time);
            self.rows.close(time, &mut state);
            self.rows.record(observed, &state, values);
            stops.extend(stops_of_lost(&mut self.alive, 0..self.tile.samples.len(), &state, row, time, values));
        }
        Some((values, stops))
    }
}
