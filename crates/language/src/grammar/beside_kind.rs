//! Help for keys that are written next to the kind that they belong to.

use crate::syntax::suggest::clip;
use crate::syntax::yaml::Entry;

/// Help for keys that are written next to the kind that they belong to, or of which one has the kind as its value.
pub fn within_kind(known: &[&str], entries: &[Entry]) -> Option<String> {
    let is_kind = |text: &str| known.contains(&text);
    let mut kinds = entries.iter().filter(|entry| is_kind(&entry.key));
    match (kinds.next(), kinds.next()) {
        (Some(kind), None) => {
            let other = entries.iter().find(|entry| entry.key != kind.key)?;
            let (kind, other) = (&kind.key, clip(&other.key));
            Some(format!("keys of `{kind}` stand within it: `{{ {kind}: {{ …, {other}: … }} }}`"))
        }
        (None, _) => {
            let mut values = entries.iter().filter_map(|entry| entry.value.scalar());
            let kind = values.find(|scalar| is_kind(&scalar.text))?;
            Some(format!("write `{{ {}: {{ … }} }}`, with the other keys within", kind.text))
        }
        _ => None,
    }
}
