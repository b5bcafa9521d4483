//! An ensemble of samples in segments between events: whole motions, or row by row.

use rayon::prelude::*;
use symdiff::WIDTHS;

use super::boundary::margins;
use super::followed::Spelled;
use super::path::Path;
use super::rows::SegmentRows;
use super::segments::{Boundary, Segments};
use super::tile::{Lanes, SegmentTile};
use super::tuning::TUNING;
use crate::compile::SwitchProgram;
use crate::numerics::{BoundaryMargins, CutMotions, Sample, SegmentMotions};
use crate::simulate::drive::{Integrator, TiledRun};
use crate::simulate::ensemble::RowClosure;
use crate::simulate::error::SimulationError;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Counters;

/// An ensemble of samples at the start.
#[derive(Debug)]
pub struct SegmentRun<'s> {
    simulator: &'s Simulator,
    segments: &'s Segments,
    tiles: Vec<SegmentRows<'s>>,
    samples: Vec<Sample>,
    /// Indices of words, by sample.
    words: Vec<Option<usize>>,
    duration: f64,
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
        let mut run =
            Self { simulator, segments, tiles: Vec::new(), samples: samples.to_vec(), words: Vec::new(), duration };
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
        let of_lanes = |lanes: Lanes<'s>| {
            let own: Vec<Sample> = lanes.indices.iter().map(|&sample| samples[sample].clone()).collect();
            let width = WIDTHS.into_iter().find(|&width| width >= own.len()).unwrap_or(own.len());
            let tile = SegmentTile::start(simulator, program, segments, lanes, &own, width, duration)?;
            let start = simulator.assemble(width, 0.0, |lane| own[lane.min(own.len() - 1)].clone())?;
            let rows = RowClosure::new(simulator, &start)?;
            Ok(SegmentRows::new(tile, rows))
        };
        run.tiles = lanes.into_par_iter().map(of_lanes).collect::<Result<_, SimulationError>>()?;
        run.words = spelled.iter().map(|spelled| spelled.word).collect();
        Ok(run)
    }

    /// Times of the events that all samples meet in the same order from the start on, s: sample, event.
    pub fn common_event_times(&self) -> Vec<Vec<f64>> {
        let words: Option<Vec<usize>> = self.words.iter().copied().collect();
        let events = |word: usize| &self.segments.words[word].events;
        let common = |words: Vec<usize>| {
            let first = words.first().map_or(&[][..], |&word| events(word));
            let with = |&word: &usize| first.iter().zip(events(word)).take_while(|(own, other)| own == other).count();
            words.iter().map(with).min()
        };
        let count = words.and_then(common).unwrap_or(0);
        let mut times = vec![Vec::new(); self.samples.len()];
        for SegmentRows { tile, .. } in &self.tiles {
            for (&sample, lengths) in tile.samples.iter().zip(&tile.guesses) {
                times[sample] = ends(&lengths[..count]);
            }
        }
        times
    }

    /// The same, row by row.
    pub fn rows(self) -> Box<dyn Integrator<'s> + 's> {
        Box::new(TiledRun::of(self.simulator, self.tiles))
    }

    fn path(&self, program: &'s SwitchProgram, sample: &Sample) -> Result<Path<'s>, SimulationError> {
        Path::start(self.simulator, program, sample, self.duration, self.segments.following())
    }

    /// The motions in their segments, to the end, but those of which an instant cannot be solved for; `None` where
    /// these are all. With them the work that they took.
    pub fn motions(mut self) -> (Option<CutMotions>, Counters) {
        let motions = self.gathered();
        let mut work = Counters::default();
        self.tiles.iter().for_each(|tile| work += tile.tile.counters());
        (motions, work)
    }

    fn gathered(&mut self) -> Option<CutMotions> {
        let strays = |tile: &&SegmentRows| tile.tile.word.is_none();
        let deviates = |tile: &SegmentRows| tile.tile.deviates.unwrap_or(f64::INFINITY);
        let known_to = self.tiles.iter().filter(strays).map(deviates).fold(self.segments.horizon, f64::min);
        self.tiles.retain(|tile| tile.tile.word.is_some());
        self.tiles.par_iter_mut().for_each(|tile| tile.tile.march_to_the_end());
        let own = || self.tiles.iter().flat_map(|tile| &tile.tile.lost[..tile.tile.samples.len()]);
        if own().next().is_some() && own().all(|lost| *lost) {
            return None;
        }
        let of_word = |number: usize| {
            let word = &self.segments.words[number];
            let is_of_word = |tile: &&SegmentRows| tile.tile.word.is_some_and(|own| std::ptr::eq(own, word));
            let tiles: Vec<&SegmentTile> = self.tiles.iter().filter(is_of_word).map(|tile| &tile.tile).collect();
            gathered(&tiles, &word.steps)
        };
        let words = (0..self.segments.words.len()).map(of_word).collect();
        // Lost samples are of no word.
        for tile in &self.tiles {
            let lost = tile.tile.samples.iter().zip(&tile.tile.lost).filter(|(_, lost)| **lost);
            lost.for_each(|(&sample, _)| self.words[sample] = None);
        }
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

/// Ends of segments that follow each other, given their lengths.
fn ends(lengths: &[f64]) -> Vec<f64> {
    let sum = |end: &mut f64, length: &f64| {
        *end += length;
        Some(*end)
    };
    lengths.iter().scan(0.0, sum).collect()
}

/// Motions of all samples of a word.
fn gathered(tiles: &[&SegmentTile], steps: &[Vec<f64>]) -> SegmentMotions {
    let count = steps.len();
    let of_all = |of_tile: &dyn Fn(&SegmentTile) -> Vec<f64>| -> Vec<f64> {
        let parts: Vec<(Vec<f64>, &SegmentTile)> = tiles.iter().map(|tile| (of_tile(tile), *tile)).collect();
        let lines = parts.first().map_or(0, |(values, tile)| values.len() / tile.width());
        let line = |line: usize| {
            let of_tile = move |(values, tile): &'_ (Vec<f64>, &SegmentTile)| {
                tile.kept().map(|lane| values[line * tile.width() + lane]).collect::<Vec<f64>>()
            };
            parts.iter().flat_map(of_tile)
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
        samples: tiles.iter().flat_map(|tile| tile.kept().map(|lane| tile.samples[lane])).collect(),
        steps: steps.to_vec(),
        times: (0..count).map(begin).chain(count.checked_sub(1).map(end)).collect(),
        nodes: (0..count).map(nodes).collect(),
    }
}
