//! Gradients of reduced outputs and of margins' parts, which the search for their ends follows.
//!
//! A value follows from channels and parameters, a channel from the rows of an output: the gradient of a weighted sum
//! of these is that of the value.

use super::ensemble::ReducedEnsemble;
use crate::methods::{Ensemble, Observed, Sampling, Until};
use crate::numerics::Sample;
use crate::simulate::{Functional, NoGradient, Schedule, SimulationError, Term, Under, Wanted, gradients_under};
use crate::study::attained::{Slope, Slopes};
use crate::study::bounding::simulation_error;
use crate::study::ensemble::Motions;
use crate::study::gradient::accumulated_in_rows;
use crate::study::problem::Study;

/// Slopes of values, which are the outputs of one row.
pub struct OfValues<'s, 'm> {
    pub study: &'s Study<'m>,
    pub motions: &'s Motions<'s>,
    pub values: &'s ReducedEnsemble<'s>,
    pub schedule: &'s Schedule,
}

/// Linearisation of a value: its derivatives by outputs in rows and by parameters.
struct Linear {
    value: f64,
    terms: Vec<Term>,
    by_parameters: Vec<f64>,
}

impl Slopes for OfValues<'_, '_> {
    fn slopes(&self, samples: &[Sample], wanted: &[Wanted]) -> Result<Option<Vec<Slope>>, SimulationError> {
        let linear = self.linear(samples, wanted)?;
        // A value that nothing over the time moves needs no gradient.
        let moving = || linear.iter().enumerate().filter(|(_, own)| !own.terms.is_empty());
        let functionals: Vec<Functional> = moving()
            .map(|(number, own)| Functional { sample: wanted[number].sample, terms: own.terms.clone() })
            .collect();
        let numbers: Vec<usize> = moving().map(|(number, _)| number).collect();
        let Self { study, schedule, .. } = self;
        let under = Under { functions: None, backwards: true };
        let found = gradients_under(&study.simulator, schedule, samples, &functionals, under, study.interruption);
        let found = match found {
            Err(NoGradient::Simulation(SimulationError::Interrupted)) => return Err(SimulationError::Interrupted),
            Err(_) => return Ok(None),
            Ok(found) => found,
        };
        let mut all: Vec<Slope> = linear.into_iter().map(|own| (own.value, own.by_parameters)).collect();
        for (number, gradient) in numbers.into_iter().zip(found) {
            all[number].1.iter_mut().zip(gradient.by_parameters).for_each(|(sum, by)| *sum += by);
        }
        Ok(Some(all))
    }
}

impl OfValues<'_, '_> {
    /// Whether an output that values follow from jumps.
    pub fn jump(&self) -> bool {
        self.values.plan().sources().into_iter().any(|source| self.motions.jumps(source))
    }

    /// Linearisation of every value that is wanted; NaN if it is unknown or has no derivatives.
    fn linear(&self, samples: &[Sample], wanted: &[Wanted]) -> Result<Vec<Linear>, SimulationError> {
        let (channels, _) = self.values.channels(samples, false).map_err(simulation_error)?;
        let plan = self.values.plan();
        let (rows, outputs) = (self.schedule.rows, self.motions.outputs());
        let sources = plan.sources();
        // (sample, source, row)
        let mut series = vec![f64::NAN; samples.len() * sources.len() * rows];
        let sampling = Sampling { observed: Observed::Outputs, until: Until::End, whole: false };
        let simulated = self.motions.simulate(samples, sampling, &mut |block, values| {
            for (row, of_row) in block.zip(values.chunks_exact(outputs * samples.len())) {
                for (place, &source) in sources.iter().enumerate() {
                    for (sample, &value) in of_row[source * samples.len()..][..samples.len()].iter().enumerate() {
                        series[(sample * sources.len() + place) * rows + row] = value;
                    }
                }
            }
        });
        simulated.map_err(simulation_error)?;
        let times: Vec<f64> = (0..rows).map(|row| self.schedule.time(row)).collect();
        let mut values = Vec::new();
        let of_wanted = |Wanted { sample, output, .. }: &Wanted| {
            let (own, parameters) = (&channels[*sample], &samples[*sample]);
            plan.values.evaluate(own, parameters, &mut values);
            let slope = plan.values.slope(*output, own, parameters, &values);
            let mut by_parameters = slope.by_parameters;
            by_parameters.resize(parameters.len(), 0.0);
            let mut linear = Linear { value: values[*output], terms: Vec::new(), by_parameters };
            for (channel, factor) in slope.by_channels {
                let channel = plan.channels[channel];
                let place = sources.partition_point(|source| *source < channel.output);
                let series = &series[(sample * sources.len() + place) * rows..][..rows];
                let known = series.iter().all(|value| value.is_finite());
                match accumulated_in_rows(channel, &times, series).filter(|_| known) {
                    Some(found) => {
                        let terms = found.terms.into_iter().map(|term| Term { weight: factor * term.weight, ..term });
                        linear.terms.extend(terms.filter(|term| term.weight != 0.0));
                    }
                    None => return Linear { value: f64::NAN, terms: Vec::new(), ..linear },
                }
            }
            linear
        };
        Ok(wanted.iter().map(of_wanted).collect())
    }
}
