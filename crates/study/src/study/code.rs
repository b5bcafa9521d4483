//! A model as source code of its nominal motion.

use super::black_box::needs_mechanism;
use super::prepared::Prepared;
use super::problem::Study;
use super::sample::steps_and_end;
use super::{Options, RunError, pool};
use crate::c_code::{CModel, CodeRequest, FmiVersion, NoCode, c_code};
use crate::model::Description;
use crate::reduce::Reduction;
use crate::syntax::{Code, Coded};

/// Why a model is not written as source code.
#[derive(Debug, thiserror::Error)]
pub enum CodeError {
    /// It cannot be run either.
    #[error(transparent)]
    Run(#[from] RunError),
    /// It takes more than the runtime has.
    #[error(transparent)]
    None(#[from] NoCode),
}

/// C99 that repeats a model's nominal motion: its programs under the steps of a run, all subsystems as one. `inputs`
/// are parameters that may change during the motion, `version` is that of its unit of FMI.
///
/// # Errors
/// If the model has no motion, or one that does not reach its end, if the runtime lacks a feature that its steps need,
/// and if an input cannot be one.
pub fn code(description: &Description, inputs: &[String], version: FmiVersion) -> Result<CModel, CodeError> {
    needs_mechanism(description, "source code").map_err(RunError::from)?;
    let pool = pool(None).map_err(RunError::from)?;
    pool.install(|| {
        let Prepared { subsystem, simulator } = Prepared::new(Reduction::joined(description))?;
        let options = Options { methods: Some(Vec::new()), ..Options::default() };
        let study = Study::new(&subsystem.description, simulator, &options)?;
        let (plan, ended) = steps_and_end(&study).map_err(RunError::from)?;
        if let Some(error) = ended {
            return Err(RunError::from(error).into());
        }
        let name = description.name.replace('/', "_");
        Ok(c_code(&study.simulator, plan.steps(), CodeRequest { name: &name, inputs, version })?)
    })
}

impl Coded for CodeError {
    fn code(&self) -> Option<Code> {
        match self {
            Self::Run(error) => error.code(),
            Self::None(NoCode::Simulation(error)) => error.code(),
            Self::None(_) => Some(Code::NoCode),
        }
    }
}
