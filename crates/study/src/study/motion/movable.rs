//! A mechanism that is moved: by a simulation of one sample, or by hand.

use super::by_hand::Hand;
use super::tuning::TUNING;
use super::{Posed, Recorded};
use crate::model::Description;
use crate::numerics::{Sample, Thinning};
use crate::results::{Drawing, Motion, Poses};
use crate::simulate::Interruption;
use crate::study::RunError;

/// A compiled model with its bodies' poses in place of its outputs.
pub struct Movable<'a> {
    description: &'a Description,
    posed: Posed<'a>,
    drawing: Drawing,
}

impl<'a> Movable<'a> {
    /// Compiles a model.
    ///
    /// # Errors
    /// If the mechanism cannot be built or assembled.
    pub fn new(description: &'a Description, interruption: Interruption<'a>) -> Result<Self, RunError> {
        let posed = Posed::compile(description, None, interruption)?;
        let drawing = posed.drawn(description, None)?;
        Ok(Self { description, posed, drawing })
    }

    /// Nominal values of the uncertain parameters.
    pub fn nominal(&self) -> Sample {
        self.posed.rows.domain.nominal.clone()
    }

    /// The simulated motion of a sample, as the nominal one of a [`Motion`] without samples. `size` is how many numbers
    /// of two bytes the poses may come to, about.
    ///
    /// # Errors
    /// If the sample cannot be assembled or stepped, and at an interruption.
    pub fn motion(&self, sample: &Sample, size: usize) -> Result<Motion, RunError> {
        let posed = &self.posed;
        let (times, recorded) = posed.record(self.description, &self.drawing, std::slice::from_ref(sample))?;
        let Recorded { rows, points, .. } = &recorded[0];
        let lines = posed.lines();
        let weights = posed.weights(points, &self.drawing);
        let most = (size / (2 * lines).max(1)).clamp(TUNING.fewest_poses, TUNING.most_poses);
        let thinning = Thinning { samples: vec![rows], weights: &weights };
        let (kept, between) = thinning.rows(&times, most, TUNING.near_pose * posed.rows.simulator.system.length);
        let bodies = kept.iter().flat_map(|row| &rows[row * lines..][..lines]).copied().collect();
        Ok(Motion {
            drawing: posed.with_ground(self.description, self.drawing.clone(), rows)?,
            times: kept.iter().map(|&row| times[row]).collect(),
            rows: times.len(),
            between,
            per_body: posed.per_body(),
            parameters: posed.parameters(self.description),
            nominal: Poses { bodies, points: points.clone() },
            forces: Vec::new(),
            samples: Vec::new(),
            worst: Vec::new(),
            stopped: 0,
            polynomials: None,
        })
    }

    /// A hand on the mechanism at its start.
    pub fn hand(&self) -> Hand<'_> {
        Hand::new(&self.posed, &self.drawing)
    }
}
