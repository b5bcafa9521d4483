//! `effects:`.

use super::description::Effect;
use super::names::Reader;
use crate::elements::effects::EffectKind;
use crate::syntax::yaml::Entry;

/// Reads the effects. A formula may refer to the sensors of its own effect and of those before it.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    for entry in entries {
        reader.name(entry, "an effect");
        let kind = EffectKind::read(reader, &entry.key, &entry.value, entry.key_span.clone());
        add(reader, &entry.key, kind);
    }
}

/// Adds an effect, if it could be read.
pub fn add(reader: &mut Reader, name: &str, kind: Option<EffectKind>) {
    let Some(kind) = kind else { return };
    if !kind.states().is_empty() {
        reader.model.mechanism_mut().states.insert(name.to_owned());
    }
    reader.model.mechanism_mut().effects.push(Effect { name: name.to_owned(), kind });
}
