//! What a subsystem's methods found, before it becomes bounds.

use super::internal::InternalError;
use super::kept::KeptPart;
use super::reduced::Found;
use crate::methods::{Ensemble, Method, MethodResult, Simulated, Stop, TooDeep, Validation};
use crate::numerics::{EMPTY, Ledger, ParameterBox, Range, Sample};
use crate::results::{Bounds, MethodSummary, Summary};
use crate::simulate::{ExcitedMode, Schedule, SingularPass, SwitchSearch};

/// A method's result and its line in the summary.
pub(super) struct Outcome {
    pub result: MethodResult,
    pub summary: MethodSummary,
}

/// Contacts and kinks in the equations, with their line in the summary.
pub(super) type Switches = (SwitchSearch, MethodSummary);

/// What one schedule yields.
pub(super) struct Results {
    pub schedule: Schedule,
    /// The first row before which a step does not resolve a function of the time.
    pub unresolved_from: Option<usize>,
    /// Contacts and kinks, where the equations have any.
    pub switches: Option<Switches>,
    /// Fast modes that the start excites and the steps damp.
    pub damped: Vec<ExcitedMode>,
    pub nominal: Outcome,
    /// Singular configurations that the nominal motion passes.
    pub singular: Vec<SingularPass>,
    /// All that was simulated under the schedule, the nominal motion too where it lies in the box.
    pub seen: Ledger,
    /// Absent where no method is asked for.
    pub validation: Option<(Validation, MethodSummary)>,
    pub methods: Vec<(Method, Outcome)>,
    /// Ends that were found along gradients, where they were searched for.
    pub attained: Option<(Outcome, Attained)>,
    /// The same with halved steps, where asked for.
    pub halved: Vec<(Method, Outcome)>,
    /// What this program did wrong; of what failed nothing is known.
    pub internal: Vec<InternalError>,
    /// Reduced outputs.
    pub found: Found,
}

impl Results {
    pub fn outcomes(&self) -> impl Iterator<Item = &Outcome> {
        std::iter::once(&self.nominal).chain(self.methods.iter().map(|(_, outcome)| outcome))
    }

    /// An output's nominal values by row, each as a range; of none where the box does not hold the nominal parameters.
    pub fn nominal_within(&self, domain: &ParameterBox, output: usize) -> Vec<Range> {
        let nominal = &self.nominal.result.bands[output];
        let is_within = domain.contains(&domain.nominal);
        nominal.iter().map(|own| if is_within && !own.lower.is_nan() { *own } else { EMPTY }).collect()
    }

    /// Notes all that an ensemble has seen.
    pub fn note(&self, ensemble: &dyn Ensemble) {
        let all = (0..ensemble.rows()).flat_map(|row| (0..ensemble.outputs()).map(move |output| (row, output)));
        all.for_each(|(row, output)| self.seen.note_range(row, output, ensemble.seen(row, output)));
    }

    /// Samples that stopped.
    pub fn stops(&self) -> impl Iterator<Item = &(Stop, Sample)> {
        let validation = self.validation.iter().filter_map(|(validation, _)| validation.simulated.stop.as_ref());
        self.outcomes().filter_map(|outcome| outcome.result.simulated.stop.as_ref()).chain(validation)
    }

    /// Rows that every sample of every method has reached, validation samples included.
    pub fn whole(&self) -> usize {
        let nominal = self.nominal.result.simulated.stop.as_ref().map(|(stop, _)| stop);
        let stops = self.stops().filter(|(stop, _)| !stop.is_of_jet() && nominal != Some(stop));
        stops.map(|(stop, _)| stop.row).min().unwrap_or(self.schedule.rows)
    }

    /// What came of the samples of every method, and of the validation samples.
    fn simulated(&self) -> impl Iterator<Item = &Simulated> {
        let validation = self.validation.iter().map(|(validation, _)| &validation.simulated);
        self.outcomes().map(|outcome| &outcome.result.simulated).chain(validation)
    }

    /// The largest error ratio of a sample, where that is more than 1.
    pub fn beyond_tolerance(&self) -> Option<f64> {
        let ratios = self.simulated().filter_map(|simulated| simulated.worst_ratio.as_ref());
        ratios.map(|(_, ratio)| *ratio).filter(|ratio| *ratio > 1.0).max_by(f64::total_cmp)
    }

    /// The first row before which some parameter values meet a contact or a kink that no sample meets.
    pub fn unmet_switch_from(&self) -> Option<usize> {
        self.switches.as_ref().and_then(|(found, _)| found.unmet_from)
    }

    /// The first row before which steps have a switch inside them. Steps from a tolerance end there.
    pub fn switched_from(&self) -> Option<usize> {
        self.switches.as_ref().and_then(|(found, _)| found.switched_from)
    }

    /// The first surfaces that a contact does not hold apart any more, of all samples.
    pub fn too_deep(&self) -> Option<TooDeep> {
        TooDeep::first(self.simulated().filter_map(|simulated| simulated.too_deep.as_ref()))
    }

    /// The first row that cannot be relied on, whatever a method says of it.
    pub fn unreliable_from(&self) -> Option<usize> {
        let beyond = self.simulated().filter_map(|simulated| simulated.beyond_tolerance_from);
        self.unresolved_from.into_iter().chain(self.unmet_switch_from()).chain(beyond).min()
    }
}

/// What a study found.
pub(super) struct Ran {
    pub bounds: Bounds,
    pub summary: Summary,
    /// Rows that every sample of every method has reached.
    pub whole: usize,
    /// The surrogate, where it is to be kept.
    pub kept: Option<KeptPart>,
}

/// How far validation samples of a box came.
pub(super) struct Tried {
    /// Rows that all have reached.
    pub reached: usize,
    /// ξ of those that did not reach the end.
    pub stopped: Vec<Vec<f64>>,
    /// Whether any did.
    pub any: bool,
}

/// The samples at which each output is least and largest in each row, of those that were searched for them.
pub(super) struct Attained {
    outputs: usize,
    samples: Vec<Sample>,
    /// By row and output, of both ends: the value and the number of its sample, once there is one.
    ends: Vec<[Option<(f64, usize)>; 2]>,
}

impl Attained {
    /// Of so many rows and outputs, of which nothing is known.
    pub fn new(rows: usize, outputs: usize) -> Self {
        Self { outputs, samples: Vec::new(), ends: vec![[None; 2]; rows * outputs] }
    }

    /// Takes in consecutive rows' values (row, output, sample) of samples.
    pub fn note(&mut self, first: usize, samples: &[Sample], values: &[f64]) {
        let mut numbers: Vec<Option<usize>> = vec![None; samples.len()];
        let Self { outputs, samples: kept, ends } = self;
        let known = ends.iter_mut().skip(first * *outputs);
        for (ends, values) in known.zip(values.chunks_exact(samples.len())) {
            for (number, &value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                for (end, sign) in ends.iter_mut().zip([-1.0, 1.0]) {
                    if end.is_none_or(|(best, _)| sign * value > sign * best) {
                        let own = *numbers[number].get_or_insert_with(|| number_of(kept, &samples[number]));
                        *end = Some((value, own));
                    }
                }
            }
        }
    }

    /// From the least to the largest value of an output in a row.
    pub fn range(&self, row: usize, output: usize) -> Option<Range> {
        let [Some((lower, _)), Some((upper, _))] = self.ends[row * self.outputs + output] else { return None };
        Some(Range { lower, upper })
    }

    /// The value and the sample of an output's ends in a row, the least first.
    pub fn ends(&self, row: usize, output: usize) -> [Option<(f64, &Sample)>; 2] {
        self.ends[row * self.outputs + output].map(|end| end.map(|(value, number)| (value, &self.samples[number])))
    }
}

/// The number of a sample among those that are kept, to which it is added where it is new.
fn number_of(kept: &mut Vec<Sample>, sample: &Sample) -> usize {
    kept.iter().position(|known| known == sample).unwrap_or_else(|| {
        kept.push(sample.clone());
        kept.len() - 1
    })
}
