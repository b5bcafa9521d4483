//! An ensemble of samples in segments between events, row by row.

use rayon::prelude::*;
use symdiff::WIDTHS;

use super::segments::Segments;
use super::tile::SegmentTile;
use crate::numerics::{Sample, SegmentMotions};
use crate::simulate::control::Schedule;
use crate::simulate::ensemble::{Observed, RowClosure, Stop, put_lanes, stops_of_lost};
use crate::simulate::error::SimulationError;
use crate::simulate::interruption::Interruption;
use crate::simulate::simulator::Simulator;

/// Samples whose segments are passed together.
const WIDTH: usize = 16;

/// The run of an ensemble of samples.
#[derive(Debug)]
pub struct SegmentRun<'s> {
    simulator: &'s Simulator,
    tiles: Vec<RowTile<'s>>,
    samples: usize,
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
        let interruption = Interruption::default();
        let Some(program) = simulator.switches() else {
            return Ok(Self { simulator, tiles: Vec::new(), samples: 0, interruption, is_cut: false });
        };
        let at_once = samples.len().div_ceil(rayon::current_num_threads().max(1)).clamp(1, WIDTH);
        let of_tile = |(place, samples): (usize, &[Sample])| {
            let width = WIDTHS.into_iter().find(|&width| width >= samples.len()).unwrap_or(samples.len());
            let tile = SegmentTile::start(simulator, (program, segments), (place * at_once, samples, width), duration)?;
            let start = simulator.assemble(width, 0.0, |lane| samples[lane.min(samples.len() - 1)].clone())?;
            let rows = RowClosure::new(simulator, &start)?;
            Ok(RowTile { tile, rows, alive: vec![true; width], deviates: None })
        };
        let chunks: Vec<(usize, &[Sample])> = samples.chunks(at_once).enumerate().collect();
        let tiles = chunks.into_par_iter().map(of_tile).collect::<Result<Vec<_>, SimulationError>>()?;
        Ok(Self { simulator, tiles, samples: samples.len(), interruption, is_cut: false })
    }

    /// As [`EnsembleRun::heeding`](crate::simulate::EnsembleRun::heeding).
    #[must_use]
    pub fn heeding(self, interruption: Interruption<'s>) -> Self {
        Self { interruption, ..self }
    }

    /// As [`EnsembleRun::is_cut`](crate::simulate::EnsembleRun::is_cut).
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// As [`EnsembleRun::advance`](crate::simulate::EnsembleRun::advance).
    pub fn advance(
        &mut self,
        schedule: &Schedule,
        rows: std::ops::Range<usize>,
        observed: Observed,
        into: &mut Vec<f64>,
    ) -> Vec<Stop> {
        let lines = observed.count(self.simulator);
        let interruption = self.interruption;
        let advance = |tile: &mut RowTile| tile.advance(schedule, rows.clone(), observed, lines, interruption);
        let parts: Option<Vec<(Vec<f64>, Vec<Stop>)>> = self.tiles.par_iter_mut().map(advance).collect();
        let Some(parts) = parts else {
            self.is_cut = true;
            return Vec::new();
        };
        into.clear();
        into.resize(rows.len() * lines * self.samples, 0.0);
        let mut stops = Vec::new();
        for (RowTile { tile, .. }, (values, stopped)) in self.tiles.iter().zip(parts) {
            put_lanes(&values, tile.width(), tile.first..tile.first + tile.count, into, self.samples);
            stops.extend(stopped);
        }
        stops
    }

    /// The first row behind an event that some sample meets and others do not.
    pub fn deviates_from(&self) -> Option<usize> {
        self.tiles.iter().filter_map(|tile| tile.deviates).min()
    }

    /// The motions in their segments, to the end; `None` where a sample meets other events.
    pub fn motions(mut self, segments: &Segments) -> Option<SegmentMotions> {
        if self.tiles.iter().any(|tile| tile.tile.deviates.is_some()) {
            return None;
        }
        let count = segments.steps.len();
        self.tiles.par_iter_mut().for_each(|tile| (0..count).for_each(|_| tile.tile.march()));
        let gathered = |of_tile: &dyn Fn(&SegmentTile) -> Vec<f64>| -> Vec<f64> {
            let parts: Vec<(Vec<f64>, &SegmentTile)> =
                self.tiles.iter().map(|tile| (of_tile(&tile.tile), &tile.tile)).collect();
            let lines = parts.first().map_or(0, |(values, tile)| values.len() / tile.width());
            let line = |line: usize| {
                parts.iter().flat_map(move |(values, tile)| values[line * tile.width()..][..tile.count].iter().copied())
            };
            (0..lines).flat_map(line).collect()
        };
        let begin = |number: usize| gathered(&|tile| tile.recorded[number].begin.clone());
        let end = |number: usize| {
            gathered(&|tile| {
                let Some(last) = tile.recorded.get(number) else { return Vec::new() };
                last.begin.iter().zip(&last.length).map(|(begin, length)| begin + length).collect()
            })
        };
        let times = (0..count).map(begin).chain(count.checked_sub(1).map(end)).collect();
        let nodes = |number: usize| {
            let count = self.tiles.first().map_or(0, |tile| tile.tile.recorded[number].nodes.len());
            (0..count).map(|node| gathered(&|tile| tile.recorded[number].nodes[node].clone())).collect()
        };
        Some(SegmentMotions { steps: segments.steps.clone(), times, nodes: (0..count).map(nodes).collect() })
    }
}

impl RowTile<'_> {
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
            self.rows.close(time, &mut state);
            self.rows.record(observed, &state, values);
            stops.extend(stops_of_lost(
                &mut self.alive,
                self.tile.first..self.tile.first + self.tile.count,
                &state,
                row,
                time,
                values,
            ));
        }
        Some((values, stops))
    }
}
