//! Parameters of instances: given, the assembly's, or one for all; and those that are whole numbers.

use std::collections::HashMap;

use symdiff::formula::indices::{self, Index};

use super::Writer;
use crate::expand::notation;
use crate::expand::scenes::draft::overridden;
use crate::grammar::mentions::NameKind;
use crate::syntax::codes::Code;
use crate::syntax::scope::Scope;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

impl Writer<'_, '_> {
    /// The model's parameters that are whole numbers.
    pub(super) fn counts_of_model(&self, root: &Node) -> HashMap<String, i64> {
        let mut counts = HashMap::new();
        let Some(Value::Mapping(entries)) = root.get("parameters").map(|node| &node.value) else { return counts };
        for entry in entries {
            let node = self.overrides.get(&entry.key).unwrap_or(&entry.value);
            let known = |name: &str| counts.get(name).copied().map(Index::Number);
            if let Some(value) = count(node, &known) {
                counts.insert(entry.key.clone(), value);
            }
        }
        counts
    }

    /// Those of an instance's parameters, which are full names with their values.
    pub(super) fn counts_of_instance(&self, prefix: &str, entries: &[Entry]) -> HashMap<String, i64> {
        let mut counts: HashMap<String, i64> = HashMap::new();
        for entry in entries {
            let node = self.overrides.get(&entry.key).unwrap_or(&entry.value);
            let scope = node.scalar().and_then(|scalar| scalar.scope.clone());
            let known = |name: &str| match &scope {
                Some(scope) if scope.prefix() == prefix => counts.get(name).copied().map(Index::Number),
                Some(scope) => scope.whole(name),
                None => self.model.whole(name),
            };
            let name = entry.key.strip_prefix(prefix).unwrap_or(&entry.key).to_owned();
            if let Some(value) = count(node, &known) {
                counts.insert(name, value);
            }
        }
        counts
    }

    /// The parameters of an instance, by their full names: `own` is the assembly's copy for it, `given` the instance's
    /// entries.
    pub(super) fn parameters(
        &mut self,
        definition: &str,
        prefix: &str,
        own: Vec<Entry>,
        given: &[Entry],
        is_shared: impl Fn(&str) -> bool,
    ) -> Vec<Entry> {
        for entry in given {
            self.report.mentions(Some(NameKind::Parameter), &format!("{prefix}{}", entry.key), &entry.key_span);
        }
        for entry in given.iter().filter(|entry| !own.iter().any(|known| known.key == entry.key)) {
            let help = suggest::help(&entry.key, "parameters of it", own.iter().map(|known| known.key.as_str()));
            let message = format!("assembly `{definition}` has no parameter `{}`", clip(&entry.key));
            self.report.error(Code::UnknownName, entry.key_span.clone(), message, help);
        }
        let mut parameters = Vec::with_capacity(own.len());
        for entry in own {
            let key = format!("{prefix}{}", entry.key);
            let follows = format!("{definition}.{}", entry.key);
            let mut entry = if let Some(given) = given.iter().find(|given| given.key == entry.key) {
                notation::fits(self.report, &given.value, &entry.value);
                notation::suspect_unit(self.report, &given.value, &entry.value);
                overridden(&entry, given)
            } else if is_shared(&entry.key) {
                let value = Value::Scalar(Scalar::plain(follows, None));
                Entry { value: Node { span: entry.value.span, value }, ..entry }
            } else {
                self.parts.followers.entry(follows).or_default().push(key.clone());
                entry
            };
            entry.key = key;
            parameters.push(entry);
        }
        parameters
    }
}

/// The value of a parameter that is a whole number.
fn count(node: &Node, known: &dyn Fn(&str) -> Option<Index>) -> Option<i64> {
    let scalar = match &node.value {
        Value::Scalar(scalar) => scalar,
        Value::Mapping(entries) => {
            let deviates =
                |entry: &Entry| matches!(entry.key.as_str(), "tolerance" | "interval" | "plus" | "minus" | "unit");
            if entries.iter().any(deviates) {
                return None;
            }
            node.get("value")?.scalar()?
        }
        Value::Sequence(_) => return None,
    };
    indices::whole(&scalar.text, known).ok()
}

/// Whether an assembly says of a parameter that it is one for all instances.
pub(super) fn is_shared(shared: Option<&Node>, name: &str) -> bool {
    match shared.map(|node| &node.value) {
        Some(Value::Scalar(scalar)) => scalar.text == "all",
        Some(Value::Sequence(items)) => items.iter().any(|item| item.scalar().is_some_and(|known| known.text == name)),
        _ => false,
    }
}

/// Scope of the entries that the instances of an assembly share.
pub(super) fn scope_of_shared(definition: &str) -> Scope {
    Scope::of_instance(definition, None, std::sync::Arc::default())
}
