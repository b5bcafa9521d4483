//! Zones in results: several parameters that are one cause.

use crate::model::Description;
use crate::results::{Bounds, ContributionSummary, Summary};

/// Members of each zone among parameters with these names, by their indices.
pub(super) fn of_names<'n>(description: &Description, names: impl Iterator<Item = &'n str>) -> Vec<Vec<usize>> {
    if description.zones.is_empty() {
        return Vec::new();
    }
    let names: Vec<&str> = names.collect();
    let zones = description.zones.iter().map(|zone| zone.indices(&names));
    zones.filter(|zone| !zone.is_empty()).collect()
}

/// Results in which a zone is one contribution, under its name.
pub(super) fn joined(description: &Description, bounds: &mut Bounds, summary: &mut Summary) {
    if description.zones.is_empty() {
        return;
    }
    let zone_of =
        |parameter: &str| description.zones.iter().find(|zone| zone.members.iter().any(|own| own == parameter));
    // Shares of a zone are those of each of its parameters: the first stands for all.
    let renamed = |parameter: &mut String| match zone_of(parameter) {
        Some(zone) if zone.members[0] != *parameter => false,
        Some(zone) => {
            parameter.clone_from(&zone.name);
            true
        }
        None => true,
    };
    for contributions in &mut bounds.contributions {
        contributions.retain_mut(|own| renamed(&mut own.parameter));
    }
    for own in &mut summary.reduced {
        own.contributions.retain_mut(|own| renamed(&mut own.parameter));
    }
    summary.contributions = ContributionSummary::of(bounds);
}
