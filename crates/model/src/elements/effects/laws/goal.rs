//! Target of a drive's coordinate, and its rate.
//!
//! The rate of a target that depends on t alone is its derivative by t. Of one that follows states or a motion it is a
//! formula of its own, `target_rate`: the target's derivative would need rates and accelerations.

use symdiff::{Formula, Scalar};

use crate::elements::effects::Forces;
use crate::grammar::{Context, Fields, Reader, Symbol, SymbolTable, TimeOrder};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

/// A target and its rate.
pub fn goal<'g>(
    forces: &dyn Forces<'g>,
    target: &Formula,
    rate: Option<&Formula>,
) -> Result<[Scalar<'g>; 2], BuildError> {
    let target = forces.value(target)?;
    let rate = match rate {
        Some(rate) => forces.value(rate)?,
        None => target.derivative(forces.time()),
    };
    Ok([target, rate])
}

/// Reports a target of more than t whose rate one of the keys needs and nothing says.
pub fn check_rate<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, target: &Formula, keys: &[&str]) {
    let Some(key) = keys.iter().find(|key| fields.get(key).is_some()) else { return };
    let has_no_rate = |name: &str| match reader.resolve(name, Context::Time) {
        Ok(Symbol::Trajectory { trajectory, .. }) => reader.model.derivatives(trajectory) == Some(TimeOrder::Position),
        known => known.is_err(),
    };
    let moving = target.names().find(|(name, _)| has_no_rate(name));
    if let Some((name, _)) = moving.filter(|_| fields.get("target_rate").is_none()) {
        let message = format!("`target` follows `{}`, so its rate is not known", crate::syntax::suggest::clip(name));
        let help = format!("`{key}` needs it: say `target_rate`");
        reader.error(Code::MisplacedKey, fields.key_span("target"), message, help);
    }
}
