//! `effects:`.

use super::description::Effect;
use super::names::Reader;
use crate::elements::effects::EffectKind;
use crate::syntax::yaml::Entry;

/// Reads the effects. A formula may refer to what its own effect and those before it measure.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    for entry in entries {
        reader.name(entry, "an effect");
        let kind = EffectKind::read(reader, &entry.key, &entry.value, entry.key_span.clone());
        reader.model.effects.extend(kind.map(|kind| Effect { name: entry.key.clone(), kind }));
    }
}
