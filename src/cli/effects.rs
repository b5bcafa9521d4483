//! `mbint explain --effects`: every effect of the language, from the grammar and from the effects' own files.

use serde::Serialize;

use super::Failure;
use super::console::BOLD;
use super::table::{Align, Table};
use crate::assemble::SHEETS;
use crate::model::{Key, effect_grammar};
use crate::results::EffectCost;
use crate::study::language_costs;

/// What there is to tell of an effect.
#[derive(Debug, Serialize)]
pub(super) struct EffectSheet {
    keyword: &'static str,
    description: String,
    formulas: &'static [&'static str],
    source: &'static str,
    keys: Vec<Key>,
    /// In a small mechanism of the plane.
    adds: Option<EffectCost>,
}

/// All effects.
///
/// # Errors
/// Never, but for a defect of the examples that are counted.
pub(super) fn all() -> Result<Vec<EffectSheet>, Failure> {
    let costs = language_costs().map_err(|error| Failure::Wrong(error.to_string()))?;
    let sheets = SHEETS.iter().filter_map(|sheet| {
        let (description, keys) = effect_grammar(sheet.keyword)?;
        let (keyword, formulas, source) = (sheet.keyword, sheet.formulas, sheet.source);
        let adds = costs.iter().find(|(known, _)| *known == keyword).map(|(_, cost)| *cost);
        Some(EffectSheet { keyword, description, formulas, source, keys, adds })
    });
    Ok(sheets.collect())
}

/// What an effect adds to the instructions of a step.
pub(super) fn adds(cost: &EffectCost) -> String {
    let EffectCost { acting, apart } = cost;
    let always =
        format!("adds {} an iteration, {} a factorisation, {} a step", acting.iteration, acting.factor, acting.step);
    match apart {
        Some(apart) => format!("{always}; apart {}, {}, {}", apart.iteration, apart.factor, apart.step),
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
        ("while apart", Align::Right),
    ]);
    for sheet in all()? {
        if !text.is_empty() {
            text.push('\n');
        }
        text += &format!("{BOLD}{}{BOLD:#}  {}\n", sheet.keyword, sheet.description);
        for formula in sheet.formulas {
            text += &format!("  {formula}\n");
        }
        text += &format!("  Source: {}.\n", sheet.source.trim_end_matches('.'));
        let mut keys = Table::new([("", Align::Left), ("", Align::Left)]);
        for key in &sheet.keys {
            add(&mut keys, "", key);
        }
        text += &keys.render(4);
        if let Some(EffectCost { acting, apart }) = sheet.adds {
            let number = |number: i64| number.to_string();
            let apart =
                apart.map_or(String::new(), |apart| format!("{}, {}, {}", apart.iteration, apart.factor, apart.step));
            let [iteration, factor, step] = [acting.iteration, acting.factor, acting.step].map(number);
            costs.row([sheet.keyword.to_owned(), iteration, factor, step, apart]);
        }
    }
    text += "\nWhat one of each adds to a small mechanism of the plane in absolute coordinates. Apart: where no sample of a tile touches.\n";
    text += &costs.render(2);
    Ok(text)
}

/// A key, and those within it.
fn add(table: &mut Table<2>, indent: &str, key: &Key) {
    let needed = if key.required { " *" } else { "" };
    table.row([format!("{indent}{}{needed}", key.name), key.description.clone()]);
    key.keys.iter().for_each(|inner| add(table, &format!("{indent}  "), inner));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_of_the_grammar_is_told_with_all_that_there_is() {
        let told: Vec<&str> = all().unwrap().iter().map(|sheet| sheet.keyword).collect();
        assert_eq!(told, crate::model::effect_keywords());
        for sheet in all().unwrap() {
            assert!(!sheet.description.is_empty() && !sheet.formulas.is_empty() && !sheet.source.is_empty());
            assert!(!sheet.keys.is_empty(), "{}", sheet.keyword);
            assert!(sheet.keys.iter().all(|key| !key.description.is_empty()), "{}", sheet.keyword);
        }
    }

    #[test]
    fn an_effect_reads_well() {
        let plain = anstream::adapter::strip_str(&text().unwrap()).to_string();
        let stop = plain.split("\n\n").find(|part| part.starts_with("stop ")).unwrap();
        insta::assert_snapshot!(stop, @r"
        stop  Stops at the ends of a joint's way.
          f = K ⟨δ⟩ⁿ ⟨1 + χ δ̇⟩, δ = lower − s or s − upper
          Source: Hunt & Crossley, J. Appl. Mech. 42 (1975) 440; Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369.
            coordinate         Which of the joint's; by default the displacement of a prismatic joint, the angle of others.
            impact *           How it pushes back.
              dissipation      s/m or s/rad; by default 0: nothing is lost.
              exponent         n, from 1 to 3; by default 1.5.
              impact_velocity  Speed of the impact for which the restitution holds, m/s or rad/s.
              law              Whose formula makes dissipation of restitution; by default Hunt and Crossley's.
              restitution      Instead of `dissipation`: speed after over speed before, above 0 and at most 1.
              stiffness *      K, N/m^n or N*m/rad^n
            lower              m or rad
            on *               A revolute, prismatic, cylindrical or screw joint.
            upper              m or rad
        ");
    }
}
