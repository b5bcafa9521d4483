//! Parameters that change during a motion.

use symdiff::Expr;

use super::NoCode;
use crate::assemble::{System, UncertainParameter};

/// Whether each of the parameters is an input.
///
/// # Errors
/// Where a name is of none of them, or of one on which constraints or masses depend: a change would break them.
pub(super) fn of(system: &System, parameters: &[UncertainParameter], names: &[String]) -> Result<Vec<bool>, NoCode> {
    for name in names {
        let no_input = |why: String| NoCode::NoInput { name: name.clone(), why };
        let Some(own) = parameters.iter().find(|own| own.name == *name) else {
            let known: Vec<String> = parameters.iter().map(|own| format!("`{}`", own.name)).collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            return Err(no_input(format!("inputs are uncertain parameters, of which there are {known}")));
        };
        let masses = system.mass.iter().map(|(_, _, entry)| *entry);
        let rows = system.constraint.iter().chain(&system.velocity_constraint).copied();
        let fixed: Vec<Expr> = masses.chain(rows).collect();
        if system.graph.symbols_of(&fixed).contains(&own.symbol) {
            return Err(no_input("constraints or masses depend on it".to_owned()));
        }
    }
    Ok(parameters.iter().map(|own| names.contains(&own.name)).collect())
}
