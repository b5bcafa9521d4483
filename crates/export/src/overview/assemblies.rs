//! Tolerances that all instances of an assembly share, for people.

use super::tuning::TUNING;
use super::words::count;
use crate::results::AssemblySummary;

/// A line for each assembly.
pub fn lines(assemblies: &[AssemblySummary]) -> String {
    assemblies.iter().map(line).collect()
}

fn line(of: &AssemblySummary) -> String {
    let names = |names: &[String]| {
        let shown = names.iter().take(TUNING.named_assemblies).map(String::as_str).collect::<Vec<_>>().join(", ");
        let more = names.len().saturating_sub(TUNING.named_assemblies);
        if more > 0 { format!("{shown} and {more} more") } else { shown }
    };
    let instances = count(of.instances.len(), "instance", "instances");
    let owner = if of.instances.len() == 1 { "its" } else { "their" };
    let independent = match of.independent.as_slice() {
        [] => format!("no tolerance of {owner} own"),
        own => format!("{} of {owner} own ({})", count(own.len(), "tolerance", "tolerances"), names(own)),
    };
    let shared = match of.shared.as_slice() {
        [] => String::new(),
        shared => format!(", shared {}", names(shared)),
    };
    format!("  {instances} of {}: {independent}{shared}\n", of.assembly)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_lists_shared_tolerances() {
        let mut of = AssemblySummary {
            assembly: "quarter_car".into(),
            instances: vec!["left".into(), "right".into()],
            independent: vec!["left.damper".into(), "right.damper".into()],
            shared: vec!["quarter_car.speed".into()],
        };
        let line = "  2 instances of quarter_car: 2 tolerances of their own (left.damper, right.damper), shared quarter_car.speed\n";
        assert_eq!(lines(std::slice::from_ref(&of)), line);
        of.independent = (0..10).map(|k| format!("p{k}")).collect();
        of.shared.clear();
        assert!(lines(&[of]).ends_with("(p0, p1, p2, p3, p4, p5, p6, p7 and 2 more)\n"));
    }
}
