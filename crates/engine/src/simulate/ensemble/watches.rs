//! Watches of each step of a tile. None of them changes a state.

use super::switch_extents::SwitchExtents;
use crate::simulate::diagnostics::{OverlapWatch, PartingWatch, SingularWatch};
use crate::simulate::drive::Observed;
use crate::simulate::features::FeatureWatch;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Stepper;

/// A step that was taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepTaken {
    /// Its length, s.
    pub h: f64,
    /// Its end, s.
    pub end: f64,
    /// Lanes that are samples.
    pub count: usize,
    /// Whether lanes may have taken shorter steps to its end.
    pub is_divided: bool,
}

/// The watches of a tile.
#[derive(Debug, Default)]
pub(super) struct Watches<'s> {
    /// Search for singular configurations of the first lane.
    pub singular: Option<SingularWatch<'s>>,
    /// Search for constraints of the first lane that open.
    pub parting: Option<PartingWatch<'s>>,
    /// Ranges of switches, if they are observed.
    pub switches: Option<SwitchExtents<'s>>,
    /// Search for surfaces that overlap more deeply than they may.
    pub overlaps: Option<OverlapWatch<'s>>,
    /// Search for features of forces in space that steps pass over, without a tolerance.
    pub features: Option<FeatureWatch<'s>>,
}

impl<'s> Watches<'s> {
    /// Prepares the rows, before the first one.
    pub fn begin_rows(&mut self, simulator: &'s Simulator, stepper: &Stepper, observed: Observed, is_controlled: bool) {
        self.features = simulator.features().filter(|_| !is_controlled).map(FeatureWatch::new);
        let switches = simulator.switches().filter(|_| observed == Observed::Switches);
        self.switches = switches.map(|program| SwitchExtents::new(program, stepper));
    }

    /// Prepares the watches for a step.
    pub fn begin(&mut self, stepper: &Stepper) {
        if let Some(switches) = &mut self.switches {
            switches.begin(stepper);
        }
        if let Some(features) = &mut self.features {
            features.begin(stepper);
        }
        if let Some(overlaps) = &mut self.overlaps {
            overlaps.begin(stepper);
        }
    }

    /// Examines a step; returns whether it passes over a force, or surfaces overlap by more than they may.
    pub fn end(&mut self, stepper: &Stepper, StepTaken { h, end, count, is_divided }: StepTaken) -> bool {
        if let Some(singular) = &mut self.singular {
            singular.look(stepper, end);
        }
        if let Some(parting) = &mut self.parting {
            parting.look(end, stepper.motion_of(0));
        }
        if let Some(switches) = &mut self.switches {
            switches.end(stepper, h);
        }
        let is_hidden = self.features.as_mut().is_some_and(|it| it.end_hidden(stepper, count, h, end));
        let is_too_deep = self.overlaps.as_mut().is_some_and(|it| it.end(stepper, count, h, end, is_divided));
        is_hidden || is_too_deep
    }
}
