//! `summary.json`: record of a run and its cost.

use serde::Serialize;

use super::statistics::StatisticsResult;
use super::{
    AnalysisSummary, Band, BlackBoxSummary, Bounds, ChainSummary, Contribution, ExcitationSummary, OutputBounds,
    ReducedSummary, RequirementSummary,
};
use crate::assemble::FormulationInfo;
use crate::grammar::display_unit::DisplayUnit;
use crate::methods::TooDeep;
use crate::syntax::Code;

/// Record of a run; serialised as it stands. Contains nothing that differs between two runs of one command, except
/// `seconds`, which are present only on request.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Name of the model, and of the scene after a slash.
    pub model: String,
    /// Version of this package.
    pub mbint: String,
    /// The coordinates: `absolute`, `joint`, or `absolute and joint` if subsystems differ.
    pub formulation: String,
    /// Number of coordinates.
    pub coordinates: usize,
    /// Number of constraint equations, redundant ones included.
    pub constraints: usize,
    /// Number of independent coordinates at the start.
    pub degrees_of_freedom: usize,
    /// Names of constraints that others imply.
    pub redundant_constraints: Vec<String>,
    /// Outputs that hang on reactions which equilibrium does not determine, since constraints are redundant.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub undetermined_outputs: Vec<String>,
    /// Names of constraints that others imply at the start only.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub singular_at_start: Vec<String>,
    /// Coordinates that share the freedom which the model leaves at the start.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shared_start: Vec<String>,
    /// Singular configurations that the nominal motion passes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub singular_configurations: Vec<SingularSummary>,
    /// A fast mode that the start excites and the steps damp, if it moves an output.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damped_mode: Option<DampedMode>,
    /// Events that a part of the box meets: bounds are divided if one is just grazed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<EventSummary>,
    /// The time up to which events are followed, if it is before the end of the rows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub events_followed: Option<EventsFollowed>,
    /// First time at which some parameter values meet a contact, a stop or a kink that no sample meets, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unmet_switch: Option<f64>,
    /// First time at which fixed steps pass over a change of a force in time or in space, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub passed_force: Option<f64>,
    /// Contacts whose surfaces overlap at the start, unless other forces press them together.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub overlaps_at_start: Vec<StartOverlap>,
    /// The first surfaces that a contact does not hold apart any more, in any sample.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub too_deep: Option<TooDeep>,
    /// Sum of the local errors of a sample's steps, in multiples of the tolerance, if that is more than 1: rows that
    /// need the sample are unresolved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beyond_tolerance: Option<f64>,
    /// The integration method, unless it was HHT-I3 alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integration: Option<String>,
    /// The parameter α of HHT-I3.
    pub alpha: f64,
    /// Length of the run, s.
    pub duration: f64,
    /// Analysis other than a motion from a given start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub analysis: Option<AnalysisSummary>,
    /// The program that answered instead of a mechanism.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub black_box: Option<BlackBoxSummary>,
    /// The uncertain parameters.
    pub parameters: Vec<ParameterSummary>,
    /// Tolerances of the assemblies that the model has instances of: shared by all instances, or independent.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub assemblies: Vec<AssemblySummary>,
    /// Chains of dimensions.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub chains: Vec<ChainSummary>,
    /// Cost of each method.
    pub methods: Vec<MethodSummary>,
    /// Errors of every band.
    pub errors: Vec<ErrorSummary>,
    /// Effect of excitations on outputs, as constants and as functions of the time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub excitations: Vec<ExcitationSummary>,
    /// Random excitations, of which bounds of a motion have one realisation.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub realisations: Vec<String>,
    /// Contributions of tolerances: output by output, the parameters that contribute most first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub contributions: Vec<ContributionSummary>,
    /// Outputs that are one number a motion.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub reduced: Vec<ReducedSummary>,
    /// Requirements with their verdicts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<RequirementSummary>,
    /// Distributions of the outputs, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub statistics: Option<Box<StatisticsResult>>,
    /// If only a part of the box is bounded: the bounded pieces, with the time up to which each is.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pieces: Vec<PieceSummary>,
    /// Parts of the model that no output depends on: `body pendulum`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_simulated: Vec<String>,
    /// Subsystems that do not interact, with the cost of each; empty if the model is one system.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub subsystems: Vec<SubsystemSummary>,
    /// Set when the run stopped early: the reason, and the time up to which results were stored.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
    /// The code of the kind of mistake that stopped it, if it was a mistake.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure_code: Option<Code>,
    /// Whether it ended before it was done, since it was asked to or took too long.
    #[serde(skip)]
    pub is_cut: bool,
    /// The formulation in which other questions of the model are compiled; set if the model is one subsystem from which
    /// nothing is omitted and in which no bodies move as one.
    #[serde(skip)]
    pub chosen_formulation: Option<FormulationInfo>,
}

impl Summary {
    /// The same without values that differ from run to run.
    #[must_use]
    pub fn without_seconds(&self) -> Self {
        let mut summary = self.clone();
        let of_subsystems = summary.subsystems.iter_mut().flat_map(|subsystem| &mut subsystem.methods);
        summary.methods.iter_mut().chain(of_subsystems).for_each(|method| method.seconds = None);
        summary
    }
}

/// A singular configuration: when, s, and which constraints others imply there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SingularSummary {
    /// When, s.
    pub time: f64,
    /// Names of the constraints.
    pub constraints: Vec<String>,
}

/// A mode that the steps damp: its frequency, Hz, and steps that would not, s.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct DampedMode {
    pub frequency: f64,
    pub step: f64,
}

/// An uncertain parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ParameterSummary {
    /// Its name.
    pub name: String,
    /// Its SI unit; empty if none is known.
    pub unit: String,
    /// The unit in which people see it, if the model writes it in another.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// Nominal value.
    pub nominal: f64,
    /// Lower end of the interval.
    pub lower: f64,
    /// Upper end of the interval.
    pub upper: f64,
}

/// The instances of an assembly, with the uncertain parameters on which they depend.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct AssemblySummary {
    /// Its name.
    pub assembly: String,
    /// Names of its instances.
    pub instances: Vec<String>,
    /// Uncertain parameters that each instance has for itself.
    pub independent: Vec<String>,
    /// Uncertain parameters that the instances have from outside: one deviation for all that depend on it.
    pub shared: Vec<String>,
}

/// A piece of the box that is bounded: the least and largest of every parameter, and the last time that it reached, s.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PieceSummary {
    /// Least value of each parameter.
    pub lower: Vec<f64>,
    /// Largest value of each parameter.
    pub upper: Vec<f64>,
    /// The last time, s.
    pub until: f64,
}

/// A subsystem, with the names of its parts and of the uncertain parameters on which it depends.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SubsystemSummary {
    /// Names of its bodies.
    pub bodies: Vec<String>,
    /// Names of its outputs.
    pub outputs: Vec<String>,
    /// Names of the uncertain parameters.
    pub parameters: Vec<String>,
    /// Number of coordinates.
    pub coordinates: usize,
    /// Number of constraint equations.
    pub constraints: usize,
    /// Cost of each method.
    pub methods: Vec<MethodSummary>,
}

/// The largest width and errors of a band over the run, in the output's unit (`null` if unknown), and from which
/// time on it is not resolved.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorSummary {
    /// Name of the output.
    pub output: String,
    /// Its SI unit, in which the numbers are; empty if dimensionless or unknown.
    pub unit: String,
    /// The unit in which people see them, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub display: Option<DisplayUnit>,
    /// Name of the method.
    pub method: String,
    /// Largest width of the band.
    pub width: f64,
    /// Largest error.
    pub error: f64,
    /// Largest part of it that is due to the method.
    pub surrogate: f64,
    /// Largest part of it that is due to time steps.
    pub time: f64,
    /// The first time at which the band is not resolved, s; absent if it is resolved throughout.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unresolved_from: Option<f64>,
}

/// A parameter's Sobol indices of an output, first-order and total: means over the run, weighted by the width of the
/// output's range.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContributionSummary {
    /// Name of the output.
    pub output: String,
    /// Name of the parameter.
    pub parameter: String,
    /// First-order index: variance due to this parameter alone.
    main: f64,
    /// Total index: variance due to this parameter and its interactions.
    pub total: f64,
}

/// Cost of a method. `method` is `nominal`, `validation` or a bounding method's name.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MethodSummary {
    /// Its name.
    pub method: String,
    /// Number of simulations.
    pub simulations: usize,
    /// Number of time steps of one simulation.
    pub steps: usize,
    /// Newton's iterations of all steps of all simulations.
    pub newton_iterations: u64,
    /// Steps that fell back to the dense rank-revealing solve.
    pub rank_revealing_solves: u64,
    /// Highest degree in each parameter, if a tolerance determined it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<Vec<usize>>,
    /// Number of boxes into which the parameters' was split, if a tolerance determined it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boxes: Option<usize>,
    /// Outputs that at some time do not follow from the coordinates, and were expanded themselves there.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub expanded_outputs: Vec<String>,
    /// Computing time, s, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
}

impl ContributionSummary {
    /// Contributions to all outputs' bounds, the largest of each output first.
    pub fn of(bounds: &Bounds) -> Vec<Self> {
        let of_output = |(output, contributions): (&OutputBounds, &Vec<Contribution>)| {
            let band = output.bands.iter().find(|band| band.method.about().has_sensitivities);
            let width = |row: usize| band.map_or(0.0, |band| band.upper[row] - band.lower[row]);
            let mean = |indices: &[f64]| {
                let known = || (0..indices.len()).filter(|&row| indices[row].is_finite() && width(row).is_finite());
                let total = known().map(width).sum::<f64>();
                // Nothing varies.
                if total == 0.0 { 0.0 } else { known().map(|row| width(row) * indices[row]).sum::<f64>() / total }
            };
            let summary = |contribution: &Contribution| ContributionSummary {
                output: output.name.clone(),
                parameter: contribution.parameter.clone(),
                main: mean(&contribution.main),
                total: mean(&contribution.total),
            };
            let mut summaries: Vec<ContributionSummary> = contributions.iter().map(summary).collect();
            summaries.sort_by(|a, b| b.total.total_cmp(&a.total));
            summaries
        };
        bounds.outputs.iter().zip(&bounds.contributions).flat_map(of_output).collect()
    }
}

impl ErrorSummary {
    /// Errors of every band.
    pub fn of(bounds: &Bounds) -> Vec<Self> {
        let of_band = |output: &OutputBounds, band: &Band| ErrorSummary {
            output: output.name.clone(),
            unit: output.unit.clone(),
            display: output.display.clone(),
            method: band.method.name().to_owned(),
            width: band.upper.iter().zip(&band.lower).map(|(upper, lower)| upper - lower).fold(0.0, f64::max),
            error: band.error.largest(),
            surrogate: band.error.surrogate,
            time: band.error.time,
            unresolved_from: band.error.unresolved_from().map(|row| bounds.times[row]),
        };
        bounds.outputs.iter().flat_map(|output| output.bands.iter().map(move |band| of_band(output, band))).collect()
    }
}

/// A contact whose surfaces overlap at the nominal start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StartOverlap {
    /// Name of the contact.
    pub contact: String,
    /// m
    pub depth: f64,
}

/// The end of the motions that are cut at their events: rows from there on are ranges of simulated values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EventsFollowed {
    /// s
    pub until: f64,
    /// Reason why they are not followed further.
    pub why: String,
}

/// An event that a part of the box meets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EventSummary {
    /// The term of the equations that switches, and where.
    pub event: String,
    /// Number of samples that were followed.
    pub samples: usize,
    /// Number of samples that meet it.
    pub met: usize,
    /// Value of a parameter, SI, at which it is just grazed while the others are nominal.
    pub grazed_at: Vec<(String, f64)>,
}
