//! Uncertain parameters that the instances of an assembly have for themselves, and those that they share.

use crate::model::{Description, InstanceKind, ParameterValue};
use crate::results::AssemblySummary;

/// Summaries of the assemblies that the model has instances of, in the order of the first instances.
pub fn of(description: &Description) -> Vec<AssemblySummary> {
    let mut found: Vec<AssemblySummary> = Vec::new();
    for instance in &description.instances {
        let InstanceKind::Assembly(assembly) = &instance.kind else { continue };
        let index = found.iter().position(|known| known.assembly == *assembly).unwrap_or_else(|| {
            let (independent, shared) = (Vec::new(), Vec::new());
            found.push(AssemblySummary { assembly: assembly.clone(), instances: Vec::new(), independent, shared });
            found.len() - 1
        });
        let (independent, shared) = uncertain(description, &format!("{}.", instance.name));
        let summary = &mut found[index];
        summary.instances.push(instance.name.clone());
        summary.independent.extend(independent);
        for name in shared {
            if !summary.shared.contains(&name) {
                summary.shared.push(name);
            }
        }
    }
    found
}

/// Whether a parameter is one of the instance itself, or a number of its position (`at`).
fn is_own(name: &str) -> bool {
    !name.strip_prefix("at.").unwrap_or(name).contains('.')
}

/// The uncertain parameters of an instance, and those outside on which its parameters depend.
fn uncertain(description: &Description, prefix: &str) -> (Vec<String>, Vec<String>) {
    let parameters = &description.parameters;
    let own = |name: &str| name.strip_prefix(prefix).is_some_and(is_own);
    let mut needed: Vec<bool> = parameters.iter().map(|parameter| own(&parameter.name)).collect();
    // Each depends on earlier ones only.
    for index in (0..parameters.len()).rev() {
        if let (true, ParameterValue::Formula(formula)) = (needed[index], &parameters[index].value) {
            for (name, _) in formula.names() {
                if let Some(used) = parameters[..index].iter().position(|parameter| parameter.name == name) {
                    needed[used] = true;
                }
            }
        }
    }
    let needed = parameters.iter().zip(needed).filter(|(_, needed)| *needed).map(|(parameter, _)| parameter);
    let uncertain = needed.filter(|parameter| matches!(parameter.value, ParameterValue::Interval { .. }));
    uncertain.map(|parameter| parameter.name.clone()).partition(|name| own(name))
}
