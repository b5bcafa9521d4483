//! `mbint explain --effects`: every effect of the language, from the grammar and from the effects' own files.

use serde::Serialize;

use super::console::BOLD;
use super::table::{Align, Table};
use crate::mechanics::SHEETS;
use crate::model::{Key, effect_grammar};

/// What there is to tell of an effect.
#[derive(Debug, Serialize)]
pub(super) struct EffectSheet {
    keyword: &'static str,
    description: String,
    formulas: &'static [&'static str],
    source: &'static str,
    keys: Vec<Key>,
}

/// All effects.
pub(super) fn all() -> Vec<EffectSheet> {
    let sheets = SHEETS.iter().filter_map(|sheet| {
        let (description, keys) = effect_grammar(sheet.keyword)?;
        let (keyword, formulas, source) = (sheet.keyword, sheet.formulas, sheet.source);
        Some(EffectSheet { keyword, description, formulas, source, keys })
    });
    sheets.collect()
}

/// All effects, for people.
pub(super) fn text() -> String {
    let mut text = String::new();
    for sheet in all() {
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
    }
    text
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
        let told: Vec<&str> = all().iter().map(|sheet| sheet.keyword).collect();
        assert_eq!(told, crate::model::effect_keywords());
        for sheet in all() {
            assert!(!sheet.description.is_empty() && !sheet.formulas.is_empty() && !sheet.source.is_empty());
            assert!(!sheet.keys.is_empty(), "{}", sheet.keyword);
            assert!(sheet.keys.iter().all(|key| !key.description.is_empty()), "{}", sheet.keyword);
        }
    }

    #[test]
    fn an_effect_reads_well() {
        let plain = anstream::adapter::strip_str(&text()).to_string();
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
