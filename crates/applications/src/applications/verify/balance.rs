//! Balance of power along a manufactured motion: of the whole mechanism, and by effect.

use super::motion::{EquationsAtPoint, Manufactured};
use super::tuning::TUNING;
use crate::assemble::System;
use crate::compile::{OF_EFFECT, OF_WHOLE, compile_equations, observing_powers};
use crate::numerics::{ChebyshevSeries, larger};
use crate::results::{EffectBalance, PowerBalance};

/// Balance of a system whose powers were asked for; `None` without an effect and without motion.
pub fn balance(
    system: &System,
    motion: &Manufactured,
    parameters: &[f64],
    redundant: &[usize],
) -> Option<PowerBalance> {
    let observed = observing_powers(system)?;
    let mut equations = EquationsAtPoint::new(&observed, compile_equations(&observed), parameters, redundant.to_vec());
    let mut found = PowerBalance::default();
    let effects = system.powers.iter().flat_map(|powers| &powers.effects);
    found.effects.extend(effects.map(|effect| EffectBalance {
        effect: effect.name.clone(),
        kind: effect.kind.to_owned(),
        ..EffectBalance::default()
    }));
    let (mut defect, mut size) = (0.0_f64, 0.0_f64);
    for time in ChebyshevSeries::nodes([motion.begin, motion.end], TUNING.instants_of_power) {
        let values = equations.outputs(motion, time);
        let (whole, of_effects) = values.split_at(OF_WHOLE);
        (defect, size) = (larger(defect, whole[0].abs()), larger(size, whole[1]));
        for (own, values) in found.effects.iter_mut().zip(of_effects.chunks_exact(OF_EFFECT)) {
            own.add(values[0], values[1]);
        }
    }
    found.size = size;
    found.defect = if defect == 0.0 { 0.0 } else { defect / size };
    Some(found)
}
