//! Pages of the reference that are made from the code.

use crate::elements::effects::EffectKind;
use crate::grammar::{ElementDocs, KeyDocs};
use crate::results::EffectCost;

/// Every effect with its keys, in Markdown; `costs` by keyword.
pub fn effects(costs: &[(&'static str, EffectCost)]) -> String {
    let mut page = "# Effects\n\nMade from the code; `mbint explain --effects` prints the same. Keys marked with * are required.\n".to_owned();
    let docs = EffectKind::docs();
    for docs in &docs {
        page += &element(docs);
    }
    page += "\n## What they cost\n\nInstructions that one of each adds to a small mechanism of the plane in absolute coordinates; \
             inactive: while a conditional effect acts on no sample of a tile.\n\n| effect | an iteration | a factorisation | a step | inactive |\n|---|---|---|---|---|\n";
    for (keyword, EffectCost { active, inactive }) in costs {
        let inactive = inactive.map_or(String::new(), |inactive| {
            format!("{}, {}, {}", inactive.iteration, inactive.factor, inactive.step)
        });
        page += &format!("| `{keyword}` | {} | {} | {} | {inactive} |\n", active.iteration, active.factor, active.step);
    }
    page
}

fn element(docs: &ElementDocs) -> String {
    let mut text =
        format!("\n## `{}`\n\n{}\n\n```text\n{}\n```\n", docs.keyword, docs.description, docs.formulas.join("\n"));
    text += &format!("\nSource: {}.\n", docs.source.trim_end_matches('.'));
    text += &format!("\n```yaml\n{}: {}\n```\n\n| key | |\n|---|---|\n", docs.keyword, docs.example);
    docs.keys.iter().for_each(|key| row(&mut text, "", key));
    if !docs.sensors.is_empty() {
        let sensors: Vec<String> = docs.sensors.iter().map(|(name, unit)| format!("`{name}` ({unit})")).collect();
        text += &format!("\nOutputs: {}.\n", sensors.join(", "));
    }
    text
}

fn row(text: &mut String, within: &str, key: &KeyDocs) {
    let mark = if key.required { " *" } else { "" };
    let name = format!("{within}{}", key.name);
    *text += &format!("| `{name}`{mark} | {} |\n", key.description.replace('|', "\\|"));
    key.keys.iter().for_each(|inner| row(text, &format!("{name}."), inner));
}
