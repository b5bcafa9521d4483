//! Names of a robot's file in formulas.

use std::collections::HashSet;

use crate::grammar::names::{GROUND, REACTIONS, is_reserved};

/// A name as formulas can have it: `_` for characters not allowed, and more of them for names in use.
pub fn in_formulas(written: &str, taken: &mut HashSet<String>) -> String {
    let mut name: String = written.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_numeric()) {
        name.insert(0, '_');
    }
    while is_reserved(&name) || name == GROUND || taken.contains(&name) {
        name.push('_');
    }
    taken.insert(name.clone());
    name
}

/// Whether a model, by all its words, speaks of a joint's reaction.
pub fn is_reaction_asked(words: &HashSet<String>, joint: &str) -> bool {
    let prefix = format!("{joint}.");
    words.iter().any(|word| {
        let member = word.strip_prefix("joint.").unwrap_or(word).strip_prefix(&prefix);
        member.and_then(|member| member.split('.').next()).is_some_and(|member| REACTIONS.contains(&member))
    })
}
