//! Samples that decide on the steps, all of them in step.

use super::movement::Movement;
use super::runge_kutta::StepError;
use super::tile::{ExplicitTile, tiles};
use super::tuning::TUNING;
use crate::numerics::Sample;
use crate::simulate::control::SwitchWatch;
use crate::simulate::ensemble::RowClosure;
use crate::simulate::error::SimulationError;
use crate::simulate::features::{FeatureWork, Features, Passage};
use crate::simulate::simulator::Simulator;

/// Controlling samples in step.
#[derive(Debug)]
pub(super) struct Tiles<'s> {
    tiles: Vec<ExplicitTile<'s, RowClosure<'s>>>,
    /// Watch for switches, of a sample that is the only one: steps that end at the switches of some samples would hide
    /// the effect of switches on the samples between these.
    watch: Option<SwitchWatch<'s>>,
    features: Option<&'s Features>,
    samples: Vec<Sample>,
    movement: Movement,
}

impl<'s> Tiles<'s> {
    pub fn start(simulator: &'s Simulator, samples: &[Sample], duration: f64) -> Result<Self, SimulationError> {
        let (features, tiles) = (simulator.features(), tiles(simulator, samples, 1)?);
        let movement = Movement::new(&simulator.system.coordinates, duration);
        let switches = simulator.switches().filter(|_| samples.len() == 1);
        let watch = switches.zip(tiles.first()).map(|(program, tile)| {
            let mut watch = SwitchWatch::new(program, tile.motion.tile());
            watch.begin(tile.motion.tile());
            watch
        });
        Ok(Self { tiles, watch, features, samples: samples.to_vec(), movement })
    }

    /// Whether a sample passes over most of a feature of a force in space in the step that was tried.
    pub fn pass_over(&self, end: f64) -> bool {
        let Some(features) = self.features else { return false };
        let mut work = FeatureWork::default();
        self.tiles.iter().any(|tile| {
            (0..tile.count).any(|lane| {
                let passage = Passage {
                    end,
                    h: end - tile.run.time,
                    parameters: &self.samples[tile.first + lane],
                    states: [&tile.run.state, &tile.run.next],
                    width: tile.alive.len(),
                    lane,
                };
                features.change(passage, TUNING.most_passed, &mut work)
            })
        })
    }

    /// The first switch in a step of length h that was tried, as a share of it.
    pub fn crossing(&self, h: f64) -> Option<f64> {
        self.watch.as_ref()?.crossing(0, h).map(|(_, crossing)| crossing.share)
    }

    /// Tries a step of all; the worst lane's error.
    pub fn attempt(&mut self, end: f64, tolerance: f64) -> StepError {
        let mut worst = StepError::default();
        for tile in &mut self.tiles {
            tile.run.attempt(&mut tile.motion, end);
            tile.run.finish(&mut tile.motion, end);
        }
        if let (Some(watch), Some(tile)) = (&mut self.watch, self.tiles.first()) {
            watch.end(tile.motion.tile());
        }
        let tried = self.tiles.iter().fold(self.movement.clone(), |movement, tile| {
            movement.reaching(&tile.start, &tile.run.next, tile.alive.len())
        });
        let sizes = tried.sizes();
        for tile in &self.tiles {
            for error in tile.run.errors(end, &sizes, tolerance, tile.alive.len()) {
                worst.ratio = worst.ratio.max(error.ratio);
                worst.stiffness = worst.stiffness.max(error.stiffness);
            }
        }
        worst
    }

    /// Forgets the values that a rejected step leaves in the memory: they may not be finite.
    pub fn reject(&mut self) {
        self.tiles.iter_mut().for_each(|tile| tile.motion.forget());
    }

    /// Goes on from the step's end.
    pub fn accept(&mut self, end: f64) {
        for tile in &mut self.tiles {
            tile.run.accept(&mut tile.motion, end);
            self.movement = self.movement.clone().reaching(&tile.start, &tile.run.state, tile.alive.len());
        }
        if let (Some(watch), Some(tile)) = (&mut self.watch, self.tiles.first()) {
            watch.begin(tile.motion.tile());
        }
    }
}
