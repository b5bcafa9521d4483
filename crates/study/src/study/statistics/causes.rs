//! Effect of each cause on an output, to first order: parameters, and zones of several of them.

use super::laws::Laws;
use crate::model::{Zone, ZoneShape};

/// A cause: its name, the output's derivative by it, and its deviation.
pub(super) type Cause = (String, f64, f64);

/// Causes of an output, given each parameter's derivative and deviation at a point. A zone is one: its deviation is the
/// largest of a linear output in it, the gradient's length times the radius of a disc or a ball.
pub(super) fn causes(zones: &[Zone], laws: &Laws, derivatives: impl Fn(&[f64]) -> Vec<(f64, f64)>) -> Vec<Cause> {
    let at_nominal = derivatives(&laws.nominal);
    let is_member = |name: &String| zones.iter().any(|zone| zone.members.contains(name));
    let alone = laws.names.iter().zip(&at_nominal).filter(|(name, _)| !is_member(name));
    let alone = alone.map(|(name, &(derivative, deviation))| (name.clone(), derivative, deviation));
    let of_zone = |zone: &Zone| {
        let members = zone.indices(&laws.names);
        // Along the radius, in directions at right angles: values of an angle, or of elevation and angle.
        let length = |members: &[usize]| {
            let directions: &[&[f64]] =
                if members.len() == 2 { &[&[0.0], &[0.5]] } else { &[&[0.0, 0.0], &[0.0, 0.5], &[1.0, 0.0]] };
            let along = |direction: &&[f64]| {
                let mut at = laws.nominal.clone();
                members[1..].iter().zip(*direction).for_each(|(&member, angle)| at[member] = *angle);
                derivatives(&at)[members[0]].1
            };
            directions.iter().map(|direction| along(direction).powi(2)).sum::<f64>().sqrt()
        };
        let deviation = match zone.shape {
            ZoneShape::Box => members.iter().map(|&member| at_nominal[member].1.abs()).sum(),
            ZoneShape::Discs => members.chunks_exact(2).map(length).sum(),
            ZoneShape::Ball if members.len() == 3 => length(&members),
            // A zone on which the output does not depend.
            ZoneShape::Ball => 0.0,
        };
        (zone.name.clone(), deviation, deviation)
    };
    alone.chain(zones.iter().map(of_zone)).collect()
}
