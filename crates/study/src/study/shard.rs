//! The simulations of a shard.

use super::ensemble::{Progress, simulate_part};
use super::prepared::{Prepared, choices, prepare};
use super::problem::Study;
use super::{Options, RunError, pool, reduced};
use crate::model::Description;
use crate::simulate::{SimulationError, Steps};
use crate::store::{PartStore, StoreError};

/// Simulates parts of a model's run that are not in the store yet, by the tasks that are there.
///
/// # Errors
/// If the model cannot be compiled, is another one than when the tasks were written, or a part cannot be simulated
/// or written.
pub fn simulate_parts(
    description: &Description,
    options: &Options,
    store: &PartStore,
    names: &[String],
) -> Result<(), RunError> {
    let pool = pool(options.threads)?;
    let model = reduced::expanded(description);
    pool.install(|| simulate(&model, options, store, names))
}

fn simulate(description: &Description, options: &Options, store: &PartStore, names: &[String]) -> Result<(), RunError> {
    let of_store = |error: StoreError| SimulationError::Store { message: error.to_string() };
    let (_, prepared) = prepare(description, choices(description, options))?;
    let studies = prepared.into_iter().map(|Prepared { subsystem, simulator }| (subsystem.description, simulator));
    let studies: Vec<_> = studies.collect();
    for name in names {
        if (options.interrupted)() {
            return Ok(());
        }
        if store.part(name).map_err(of_store)?.is_some() {
            continue;
        }
        let task = store.task(name).map_err(of_store)?;
        let changed = || SimulationError::Store {
            message: "the model has changed since the study was planned; plan it again".to_owned(),
        };
        let (description, simulator) = studies.get(task.subsystem).ok_or_else(changed)?;
        if store.name(&task).map_err(of_store)? != *name {
            return Err(changed().into());
        }
        let study = Study::new(description, simulator.clone(), options)?;
        let progress = Progress::new(task.samples.len() * task.schedule.rows, options.progress);
        let motions = study
            .motions(Steps { schedule: &task.schedule, controller: task.tolerance }, &progress)
            .reducing(&task.channels);
        match simulate_part(&motions, store, name, &task) {
            Err(SimulationError::Interrupted) => return Ok(()),
            done => done?,
        }
    }
    Ok(())
}
