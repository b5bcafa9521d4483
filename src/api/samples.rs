//! Outputs over time at chosen values of the uncertain parameters.

use super::Error;
use crate::model::Description;
use crate::numerics::Sample;
use crate::study::{ChosenSamples, Options, Sampled, sample, uncertain};

/// Outputs over time of simulations at chosen points.
#[derive(Clone, Debug)]
pub struct Samples {
    times: Vec<f64>,
    outputs: Vec<(String, String)>,
    /// By sample, row and output.
    values: Vec<f64>,
    sampled: Sampled,
}

impl Samples {
    /// Simulates all points.
    pub(super) fn of(description: &Description, points: &[Vec<f64>], options: &Options) -> Result<Self, Error> {
        let parameters: Vec<String> = uncertain(description).0.into_iter().map(|own| own.name).collect();
        let fits = |point: &&Vec<f64>| point.len() == parameters.len() && point.iter().all(|value| value.is_finite());
        if let Some(index) = points.iter().position(|point| !fits(&point)) {
            return Err(Error::Point { index, parameters });
        }
        let at = |range: std::ops::Range<usize>| points[range].iter().cloned().map(Sample::from).collect();
        sample(description, options, ChosenSamples { count: points.len(), at: &at }, |trajectories| {
            let mut values = Vec::new();
            let sampled = trajectories.each(|own| {
                values.extend_from_slice(own);
                Ok::<(), Error>(())
            })?;
            let Some(sampled) = sampled else { return Err(Error::Interrupted) };
            Ok(Self { times: trajectories.times.clone(), outputs: trajectories.outputs.clone(), values, sampled })
        })
    }

    /// Output times, s, ascending.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Names of the outputs, each with its SI unit (empty if dimensionless or unknown).
    pub fn outputs(&self) -> impl Iterator<Item = (&str, &str)> {
        self.outputs.iter().map(|(name, unit)| (name.as_str(), unit.as_str()))
    }

    /// An output over time in the simulation of a point; NaN if the mechanism cannot be assembled, and after its stop.
    /// `None` without such a point or output.
    pub fn course(&self, point: usize, output: &str) -> Option<Vec<f64>> {
        let index = self.outputs.iter().position(|(name, _)| name == output)?;
        let size = self.times.len() * self.outputs.len();
        let own = self.values.get(point * size..(point + 1) * size)?;
        Some(own.iter().skip(index).step_by(self.outputs.len()).copied().collect())
    }

    /// Number of points at which the mechanism cannot be assembled.
    pub fn not_assembled(&self) -> usize {
        self.sampled.closed
    }

    /// Number of points whose simulation stops before the end.
    pub fn stopped(&self) -> usize {
        self.sampled.stopped
    }
}
