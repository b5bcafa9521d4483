//! Subsystems of a model, which do not interact: each is a study of its own, over those parameters on which it depends,
//! and the results are merged in the model's order.
//!
//! Each has its own steps too: a subsystem that needs short ones does not slow down the others. The feasible part of a
//! box is a part of the whole box: where only that is to be bounded, there is one subsystem.

use super::answers::{Kept, Ran, arrange, assemblies};
use super::internal::caught;
use super::price::stored_bytes;
use super::ready::{Studied, studied};
use super::reduced::{Parameters, together};
use super::single;
use super::{Options, RunError, feasible, zones};
use crate::methods::Keep;
use crate::model::{Analysis, Description, ParameterValue};
use crate::numerics::ParameterBox;
use crate::reduce::Subsystem;
use crate::results::{
    Bounds, Contribution, ContributionSummary, ErrorSummary, FunctionWitness, OutputBounds, OutputDerivatives,
    ParameterSummary, SubsystemSummary, Summary, Witness, summary_of_subsystems,
};
use crate::simulate::SimulationError;

/// Runs every subsystem and merges the results.
///
/// # Errors
/// As for any run.
pub fn run(
    description: &Description,
    options: &Options,
    keep: Keep,
) -> Result<(Bounds, Summary, Option<Kept>), RunError> {
    studied(description, options, keep, |found| run_all(description, options, keep, found))
}

fn run_all(
    description: &Description,
    options: &Options,
    keep: Keep,
    &Studied { left_out, subsystems, studies, .. }: &Studied,
) -> Result<(Bounds, Summary, Option<Kept>), RunError> {
    let count = studies.len();
    if options.store.is_some() {
        (options.disk)(studies.iter().map(stored_bytes).sum());
    }
    let (mut ran, mut kept) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let (mut lost, mut deferred) = (0, false);
    for (index, (subsystem, study)) in subsystems.iter().zip(studies).enumerate() {
        (options.subsystem)(Some(index));
        let found = caught("the run", || -> Result<_, RunError> {
            if options.skip_infeasible {
                let (bounds, summary) = feasible::run(study)?;
                return Ok((bounds, summary, None));
            }
            let Ran { bounds, summary, kept, .. } =
                single::run(study).map_err(|error| feasible::explained(study, error))?;
            Ok((bounds, summary, kept))
        });
        let (bounds, summary, part) = match found {
            // Simulations that the other subsystems lack are planned in the same round.
            Ok(Err(RunError::Simulation(SimulationError::Deferred))) => {
                deferred = true;
                continue;
            }
            Ok(Err(RunError::Simulation(SimulationError::Interrupted))) => {
                let Ran { bounds, summary, kept, .. } = single::lost(study, None)?;
                (bounds, summary, kept)
            }
            Ok(found) => found?,
            Err(error) => {
                lost += 1;
                // Without any subsystem there is nothing to write.
                if lost == count {
                    return Err(error.into());
                }
                let Ran { bounds, summary, kept, .. } = single::lost(study, Some(error))?;
                (bounds, summary, kept)
            }
        };
        ran.push(Done { subsystem, bounds, summary });
        kept.push(part.map(|part| (part, subsystem)));
    }
    (options.subsystem)(None);
    if deferred {
        return Err(SimulationError::Deferred.into());
    }
    let kept = kept.into_iter().collect::<Option<Vec<_>>>().filter(|_| keep.is_any());
    let kept = kept.map(|parts| Kept::of_parts(parts, description.outputs.len()));
    let (mut bounds, mut summary) = Whole::of(description, left_out.to_vec()).merge(ran);
    arrange(description, &mut bounds, &mut summary);
    if let ([whole], [study]) = (subsystems, studies)
        && left_out.is_empty()
        && !whole.merged.contains(&true)
    {
        summary.chosen_formulation = Some(study.simulator.system.formulation.clone());
    }
    Ok((bounds, summary, kept))
}

/// A model's uncertain parameters, and their box.
pub fn uncertain(description: &Description) -> (Vec<ParameterSummary>, ParameterBox) {
    let interval = |parameter: &crate::model::Parameter| match parameter.value {
        ParameterValue::Interval { nominal, lower, upper } => {
            let (name, unit) = (parameter.name.clone(), parameter.unit.clone());
            let display = description.parameter_units.get(&name).cloned();
            Some(ParameterSummary { name, unit, display, nominal, lower, upper })
        }
        ParameterValue::Formula(_) => None,
    };
    let parameters: Vec<ParameterSummary> = description.parameters.iter().filter_map(interval).collect();
    let domain = ParameterBox {
        nominal: parameters.iter().map(|parameter| parameter.nominal).collect(),
        lower: parameters.iter().map(|parameter| parameter.lower).collect(),
        upper: parameters.iter().map(|parameter| parameter.upper).collect(),
        zones: zones::of_names(description, parameters.iter().map(|parameter| parameter.name.as_str())),
    };
    (parameters, domain)
}

/// A subsystem's results.
struct Done<'a> {
    subsystem: &'a Subsystem,
    bounds: Bounds,
    summary: Summary,
}

/// The whole model, for which subsystems' results are merged.
struct Whole<'a> {
    description: &'a Description,
    parameters: Vec<ParameterSummary>,
    domain: ParameterBox,
    left_out: Vec<String>,
}

impl<'a> Whole<'a> {
    fn of(description: &'a Description, left_out: Vec<String>) -> Self {
        let (parameters, domain) = uncertain(description);
        Self { description, parameters, domain, left_out }
    }

    fn merge(self, ran: Vec<Done>) -> (Bounds, Summary) {
        let longest = ran.iter().map(|done| &done.bounds.times).max_by_key(|times| times.len());
        let times = longest.cloned().unwrap_or_default();
        let known = ran.iter().any(|done| !done.bounds.contributions.is_empty());
        let count = self.description.outputs.len();
        let mut outputs: Vec<Option<OutputBounds>> = vec![None; count];
        let mut contributions = vec![Vec::new(); count];
        for done in &ran {
            for (index, (&output, bounds)) in done.subsystem.outputs.iter().zip(&done.bounds.outputs).enumerate() {
                let bounds = bounds.padded(times.len());
                if known {
                    contributions[output] = self.contributions(done, index, &bounds);
                }
                outputs[output] = Some(bounds);
            }
        }
        // Outputs that an analysis adds come after the model's.
        let further = |done: &Done| done.bounds.outputs[done.subsystem.outputs.len()..].to_vec();
        let outputs = outputs.into_iter().flatten().chain(ran.iter().flat_map(further)).collect();
        if known {
            contributions.extend(ran.iter().flat_map(|done| {
                let own = done.subsystem.outputs.len()..done.bounds.outputs.len();
                own.map(|index| self.contributions(done, index, &done.bounds.outputs[index])).collect::<Vec<_>>()
            }));
        }
        let bounds = Bounds {
            times,
            outputs,
            contributions: if known { contributions } else { Vec::new() },
            covered: ran
                .iter()
                .find_map(|done| Some(&done.bounds.covered).filter(|covered| !covered.is_empty()))
                .cloned()
                .unwrap_or_default(),
            analysis: self.description.analysis,
            responses: Vec::new(),
            witnesses: ran.iter().flat_map(|done| self.witnesses(done)).collect(),
            derivatives: ran.iter().flat_map(|done| self.derivatives(done)).collect(),
            functions: ran.iter().flat_map(|done| self.functions(done)).collect(),
            certified: ran.iter().flat_map(|done| done.bounds.certified.clone()).collect(),
        };
        let summary = self.summary(ran, &bounds);
        (bounds, summary)
    }

    /// A subsystem's witnesses as the whole model's; parameters on which it does not depend are nominal there.
    fn witnesses(&self, done: &Done) -> Vec<Witness> {
        let of_whole = |own: &Witness| {
            let output = *done.subsystem.outputs.get(own.output)?;
            let parameters = self.spread(done.subsystem, &own.parameters, &self.domain.nominal);
            Some(Witness { output, parameters, ..own.clone() })
        };
        done.bounds.witnesses.iter().filter_map(of_whole).collect()
    }

    /// The same for derivatives, which are zero by parameters of other subsystems.
    fn derivatives(&self, done: &Done) -> Vec<OutputDerivatives> {
        let none = vec![0.0; self.parameters.len()];
        let of_whole = |own: &OutputDerivatives| {
            let output = *done.subsystem.outputs.get(own.output)?;
            let rows = own.by_parameters.chunks_exact(done.subsystem.parameters.len());
            let by_parameters = rows.flat_map(|row| self.spread(done.subsystem, row, &none)).collect();
            Some(OutputDerivatives { output, by_parameters })
        };
        done.bounds.derivatives.iter().filter_map(of_whole).collect()
    }

    /// The same for functions of excitations.
    fn functions(&self, done: &Done) -> Vec<FunctionWitness> {
        let of_whole = |own: &FunctionWitness| {
            let output = match own.output {
                Some(output) => Some(*done.subsystem.outputs.get(output)?),
                None => None,
            };
            let parameters = self.spread(done.subsystem, &own.parameters, &self.domain.nominal);
            Some(FunctionWitness { output, parameters, ..own.clone() })
        };
        done.bounds.functions.iter().filter_map(of_whole).collect()
    }

    /// Every parameter's contribution to an output; zero for one on which its subsystem does not depend.
    fn contributions(&self, done: &Done, index: usize, bounds: &OutputBounds) -> Vec<Contribution> {
        let rows = bounds.nominal.len();
        let unknown = || vec![f64::NAN; rows];
        let of_subsystem = done.bounds.contributions.get(index);
        let band = bounds.bands.iter().find(|band| band.method.about().has_sensitivities);
        let contribution = |(number, parameter): (usize, &ParameterSummary)| {
            let name = parameter.name.clone();
            match done.subsystem.parameters.iter().position(|&own| own == number) {
                Some(own) => match of_subsystem.and_then(|contributions| contributions.get(own)) {
                    Some(found) => found.padded(rows),
                    None => {
                        Contribution { parameter: name, main: unknown(), total: unknown(), width_without: unknown() }
                    }
                },
                None => {
                    let width = |row: usize| band.map_or(f64::NAN, |band| band.upper[row] - band.lower[row]);
                    let width_without: Vec<f64> = (0..rows).map(width).collect();
                    let nothing = |width: &f64| if width.is_nan() { f64::NAN } else { 0.0 };
                    let none: Vec<f64> = width_without.iter().map(nothing).collect();
                    Contribution { parameter: name, main: none.clone(), total: none, width_without }
                }
            }
        };
        self.parameters.iter().enumerate().map(contribution).collect()
    }

    /// Values of all parameters: of a subsystem's parameters from `values`, of the rest from `others`.
    fn spread<T: Clone>(&self, subsystem: &Subsystem, values: &[T], others: &[T]) -> Vec<T> {
        let own = |number: usize| subsystem.parameters.iter().position(|&own| own == number);
        (0..self.parameters.len())
            .map(|number| own(number).map_or(&others[number], |own| &values[own]).clone())
            .collect()
    }

    fn summary(self, mut ran: Vec<Done>, bounds: &Bounds) -> Summary {
        let zeros = vec![0; self.parameters.len()];
        for done in &mut ran {
            for method in &mut done.summary.methods {
                method.order = method.order.as_ref().map(|order| self.spread(done.subsystem, order, &zeros));
            }
            for piece in &mut done.summary.pieces {
                piece.lower = self.spread(done.subsystem, &piece.lower, &self.domain.lower);
                piece.upper = self.spread(done.subsystem, &piece.upper, &self.domain.upper);
            }
        }
        let parameters = Parameters { all: &self.parameters, domain: &self.domain };
        let (reduced, requirements) =
            together(parameters, ran.iter_mut().map(|done| (done.subsystem, &mut done.summary)));
        let subsystems: Vec<SubsystemSummary> =
            if ran.len() > 1 { ran.iter().map(|done| self.subsystem(done)).collect() } else { Vec::new() };
        let mut summary = summary_of_subsystems(ran.into_iter().map(|done| done.summary).collect());
        if !subsystems.is_empty() {
            summary.errors = ErrorSummary::of(bounds);
            summary.contributions = ContributionSummary::of(bounds);
        }
        (summary.reduced, summary.requirements) = (reduced, requirements);
        if self.description.analysis == Analysis::Motion {
            let random = self.description.trajectories.iter().filter(|own| own.random().is_some());
            summary.realisations = random.map(|own| own.name.clone()).collect();
        }
        summary.parameters = self.parameters;
        summary.assemblies = assemblies(self.description);
        summary.not_simulated = self.left_out;
        summary.subsystems = subsystems;
        summary
    }

    fn subsystem(&self, done: &Done) -> SubsystemSummary {
        let Subsystem { description, outputs, parameters, .. } = done.subsystem;
        SubsystemSummary {
            bodies: description.bodies.iter().skip(1).map(|body| body.name.clone()).collect(),
            outputs: outputs.iter().map(|&output| self.description.outputs[output].name.clone()).collect(),
            parameters: parameters.iter().map(|&number| self.parameters[number].name.clone()).collect(),
            coordinates: done.summary.coordinates,
            constraints: done.summary.constraints,
            methods: done.summary.methods.clone(),
        }
    }
}
