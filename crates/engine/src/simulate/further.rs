//! Names and units of the results of an analysis in addition to the model's outputs.

use super::modal::{self, Vibrations};
use crate::assemble::{OutputInfo, System};
use crate::model::Analysis;

/// The name of the smallest eigenvalue among the outputs.
const STABILITY: &str = "stability";

/// Adds the further outputs of a mechanism, after the model's outputs.
pub fn further_outputs(system: &mut System, vibrations: Option<&Vibrations>) {
    if let Some(vibrations) = vibrations {
        modal::further_outputs(system, vibrations);
    }
    match system.analysis {
        // The action of a controller at an equilibrium depends on its motion.
        Analysis::Statics if !system.has_states() => {
            let taken = |name: &str| system.outputs.iter().any(|output| output.name == name);
            let mut name = STABILITY.to_owned();
            while taken(&name) {
                name.push('_');
            }
            let expr = system.graph.constant(0.0);
            system.outputs.push(OutputInfo { name, unit: "1/s^2".to_owned(), dimension: None, expr, of_results: None });
        }
        _ => {}
    }
}
