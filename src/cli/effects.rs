//! `mbint explain --effects`: every effect of the language, from its own file.

use serde::Serialize;

use super::Failure;
use super::console::BOLD;
use crate::applications::language_costs;
use crate::elements::effects::EffectKind;
use crate::grammar::{ElementDocs, KeyDocs};
use crate::overview::{Align, Table};
use crate::results::EffectCost;

/// An effect with its cost.
#[derive(Debug, Serialize)]
pub(super) struct EffectDocs {
    #[serde(flatten)]
    docs: ElementDocs,
    /// Its cost in a small planar mechanism.
    adds: Option<EffectCost>,
}

/// All effects.
///
/// # Errors
/// Only for a defect of the counted examples.
pub(super) fn all() -> Result<Vec<EffectDocs>, Failure> {
    let costs = language_costs().map_err(|error| Failure::wrong(&error).of(&error))?;
    let with_cost = |docs: ElementDocs| {
        let adds = costs.iter().find(|(known, _)| *known == docs.keyword).map(|(_, cost)| *cost);
        EffectDocs { docs, adds }
    };
    Ok(EffectKind::docs().into_iter().map(with_cost).collect())
}

/// Instructions that an effect adds to a step, in words.
pub(super) fn adds(cost: &EffectCost) -> String {
    let EffectCost { active, inactive } = cost;
    let always =
        format!("adds {} an iteration, {} a factorisation, {} a step", active.iteration, active.factor, active.step);
    match inactive {
        Some(inactive) => format!("{always}; inactive {}, {}, {}", inactive.iteration, inactive.factor, inactive.step),
        None => always,
    }
}

/// All effects, for people.
///
/// # Errors
/// As [`all`].
pub(super) fn text() -> Result<String, Failure> {
    let mut text = String::new();
    let mut costs = Table::new([
        ("instructions that it adds", Align::Left),
        ("an iteration", Align::Right),
        ("a factorisation", Align::Right),
        ("a step", Align::Right),
        ("while inactive", Align::Right),
    ]);
    for EffectDocs { docs, adds } in all()? {
        if !text.is_empty() {
            text.push('\n');
        }
        text += &element(&docs);
        if let Some(EffectCost { active, inactive }) = adds {
            let number = |number: i64| number.to_string();
            let inactive = inactive.map_or(String::new(), |inactive| {
                format!("{}, {}, {}", inactive.iteration, inactive.factor, inactive.step)
            });
            let [iteration, factor, step] = [active.iteration, active.factor, active.step].map(number);
            costs.row([docs.keyword.to_owned(), iteration, factor, step, inactive]);
        }
    }
    text += "\nWhat one of each adds to a small mechanism of the plane in absolute coordinates. Apart: where no sample of a tile touches.\n";
    text += &costs.render(2);
    Ok(text)
}

/// An element, for people.
pub(super) fn element(docs: &ElementDocs) -> String {
    let mut text = format!("{BOLD}{}{BOLD:#}  {}\n", docs.keyword, docs.description);
    for formula in docs.formulas {
        text += &format!("  {formula}\n");
    }
    text += &format!("  Source: {}.\n", docs.source.trim_end_matches('.'));
    text += &format!("  Example: {}\n", docs.example);
    let mut keys = Table::new([("", Align::Left), ("", Align::Left)]);
    docs.keys.iter().for_each(|key| add(&mut keys, "", key));
    text + &keys.render(4)
}

/// A key, and those within it.
fn add(table: &mut Table<2>, indent: &str, key: &KeyDocs) {
    let needed = if key.required { " *" } else { "" };
    table.row([format!("{indent}{}{needed}", key.name), key.description.clone()]);
    key.keys.iter().for_each(|inner| add(table, &format!("{indent}  "), inner));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_is_documented_completely() {
        for EffectDocs { docs, adds } in all().unwrap() {
            assert!(!docs.description.is_empty() && !docs.keys.is_empty() && adds.is_some(), "{}", docs.keyword);
            assert!(docs.keys.iter().all(|key| !key.description.is_empty()), "{}", docs.keyword);
        }
    }

    #[test]
    fn an_effect_reads_well() {
        let plain = crate::overview::plain(&text().unwrap());
        let stop = plain.split("\n\n").find(|part| part.starts_with("stop ")).unwrap();
        insta::assert_snapshot!(stop, @r"
        stop  Stops at the ends of a joint's range.
          f = K ⟨δ⟩ⁿ ⟨1 + χ δ̇⟩, δ = lower − s or s − upper
          Source: Hunt & Crossley, J. Appl. Mech. 42 (1975) 440; Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369.
          Example: { on: hinge, lower: -1.5, upper: 0.8, impact: { stiffness: 1e4, restitution: 0.5, impact_velocity: 2 } }
            on *               A revolute, prismatic, cylindrical or screw joint.
            coordinate         Which of the joint's; by default the displacement of a prismatic joint, the angle of others.
            lower              Smallest value of the coordinate, m or rad.
            upper              Largest value of the coordinate, m or rad.
            impact *           How it pushes back.
              exponent         n, from 1 to 3: 1 is a linear spring, 1.5 Hertz's contact of curved surfaces; by default 1.5.
              stiffness *      K, N/m^n or N*m/rad^n.
              dissipation      χ, the loss coefficient, s/m or s/rad; by default 0: no energy is lost.
              restitution      Instead of `dissipation`: speed after over speed before, above 0 and at most 1.
              impact_velocity  Speed of the impact for which the restitution holds, m/s or rad/s.
              law              Whose formula makes dissipation of restitution; by default exact.
        ");
    }
}
