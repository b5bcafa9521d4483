//! The one way up to the start: `check` accepts the models that a run begins to simulate.

use super::answers::keep_surrogate;
use super::ensemble::Stored;
use super::prepared::{Prepared, choices, prepare, share_budget};
use super::price::{Memory, Price};
use super::problem::Study;
use super::{Options, RunError, reduced};
use crate::assemble;
use crate::certificate::Certified;
use crate::methods::Keep;
use crate::model::Description;
use crate::reduce::{Reduction, Subsystem};
use crate::simulate::Certifier;

/// The stage up to the start: a run that ends in it was not begun.
pub const COMPILING: &str = "compiling";

/// A model's subsystems as studies, none of which was begun.
pub(super) struct Studied<'s> {
    /// Parts that no output depends on.
    pub left_out: &'s [String],
    pub subsystems: &'s [Subsystem],
    /// One for each subsystem.
    pub studies: &'s [Study<'s>],
    /// Cost of their simulations.
    pub price: Price,
}

impl Studied<'_> {
    /// The price, if a run asks before it begins.
    fn asked(&self, description: &Description) -> Option<Price> {
        self.price.is_costly(description.bounds.budget.simulations).then_some(self.price)
    }
}

/// Reduces and compiles a model, and fits the methods to its subsystems; with `keep`, the method that has surrogates.
/// Every refusal comes before the first subsystem is run.
///
/// # Errors
/// If a subsystem cannot be built, assembled or bounded; if the run takes long, and nobody has allowed it.
pub(super) fn studied<T>(
    description: &Description,
    options: &Options,
    keep: Keep,
    then: impl FnOnce(&Studied) -> Result<T, RunError>,
) -> Result<T, RunError> {
    (options.stage)(COMPILING);
    let (Reduction { left_out, .. }, mut prepared) = prepare(description, choices(description, options))?;
    share_budget(&mut prepared);
    let count = prepared.len();
    let report = |number: usize| move |fraction: f64| (options.progress)((number as f64 + fraction) / count as f64);
    let reports: Vec<_> = (0..count).map(report).collect();
    let mut subsystems = Vec::with_capacity(count);
    let mut simulators = Vec::with_capacity(count);
    for Prepared { subsystem, simulator } in prepared {
        subsystems.push(subsystem);
        simulators.push(simulator);
    }
    let parts = subsystems.iter().zip(simulators).zip(&reports).enumerate();
    let studies = parts.map(|(number, ((subsystem, simulator), progress))| {
        let mut study = Study::new(&subsystem.description, simulator, options)?;
        study.progress = progress;
        study.stored =
            options.store.map(|store| Stored { store, subsystem: number, assembles_first: options.skip_infeasible });
        if keep.is_any() {
            keep_surrogate(&mut study, keep)?;
        }
        Ok(study)
    });
    let studies = studies.collect::<Result<Vec<Study>, RunError>>()?;
    let price = Price::of(&studies);
    let studied = Studied { left_out: &left_out, subsystems: &subsystems, studies: &studies, price };
    if let Some(price) = studied.asked(description).filter(|_| !options.costly) {
        return Err(RunError::Costly(price));
    }
    if let Some(allowance) = options.allowance {
        match description.bounds.certified {
            // The time of a proof is not known beforehand, and it was asked for.
            Some(_) => allowance.lift(),
            None => allowance.expect(&price, &description.bounds.budget),
        }
    }
    match Memory::lacking(&studies) {
        Some(lacking) => Err(RunError::Memory(lacking)),
        None => then(&studied),
    }
}

/// Size of the part of a model that a run simulates.
#[derive(Clone, Debug)]
pub struct Ready {
    /// Coordinates, constraints and degrees of freedom of all subsystems.
    pub sizes: [usize; 3],
    /// Names of their formulations.
    pub formulation: String,
    /// Whether it is the model with all its parts.
    pub is_whole: bool,
    /// Parts that no output depends on.
    pub left_out: Vec<String>,
    /// Price of a run, if it has to be allowed before it begins.
    pub price: Option<Price>,
}

/// Goes as far as a run does before it simulates.
///
/// # Errors
/// All those with which a run does not begin.
pub fn ready(description: &Description) -> Result<Ready, RunError> {
    built(description)?;
    let model = reduced::expanded(description);
    let keep = if model.statistics.asked { Keep::Statistics } else { Keep::Nothing };
    studied(&model, &Options::default(), keep, |found| {
        let sum = |of: fn(&Study) -> usize| found.studies.iter().map(of).sum();
        let sizes = [
            sum(|study| study.simulator.system.coordinates_of_motion().count()),
            sum(|study| study.simulator.system.constraints.len()),
            sum(|study| study.simulator.mobility.degrees_of_freedom),
        ];
        let formulation = |study: &Study| study.simulator.system.formulation.name().to_owned();
        let mut formulations: Vec<String> = found.studies.iter().map(formulation).collect();
        formulations.sort_unstable();
        formulations.dedup();
        let counts = |model: &Description| [model.bodies.len(), model.joints.len(), model.effects.len()];
        Ok(Ready {
            sizes,
            formulation: formulations.join(" and "),
            is_whole: matches!(found.subsystems, [only] if counts(&only.description) == counts(&model)),
            left_out: found.left_out.to_vec(),
            price: found.asked(&model),
        })
    })
}

/// Builds a whole model's equations, with the parts that no output depends on: errors there are errors of the model.
///
/// # Errors
/// If they cannot be built.
pub fn built(description: &Description) -> Result<(), RunError> {
    assemble::build(&assemble::Questions::of(description))?;
    Ok(())
}

/// The equations of a model's subsystems, as certificates have them, without any proof.
///
/// # Errors
/// As for [`ready`].
pub fn equations(description: &Description) -> Result<Vec<Certified>, RunError> {
    let model = reduced::expanded(description);
    let list =
        |found: &Studied| found.studies.iter().map(|study| Certifier::new(&study.simulator).certified()).collect();
    studied(&model, &Options::default(), Keep::Nothing, |found| Ok(list(found)))
}
