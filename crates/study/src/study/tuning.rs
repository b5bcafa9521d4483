//! Constants of all rooms that have them in a struct, for people.

use super::{formulation, price, stepping};
use crate::{assemble, compile, model, simulate};
use symdiff::constants::Constant;

/// The constants, room by room, in the order of the stages.
pub fn tuning() -> Vec<Constant> {
    [
        model::tuning(),
        assemble::tuning::Tuning::constants(),
        compile::tuning::Tuning::constants(),
        simulate::tuning(),
        formulation::tuning::Tuning::constants(),
        stepping::tuning::Tuning::constants(),
        price::tuning::Tuning::constants(),
    ]
    .concat()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_constant_has_a_name_of_its_own_a_reason_and_an_effect() {
        let constants = tuning();
        let names: BTreeSet<_> = constants.iter().map(|constant| (constant.room, constant.name)).collect();
        assert!(names.len() == constants.len() && constants.len() > 350);
        for constant in constants {
            let Constant { why, moves, value, name, .. } = constant;
            assert!(why.ends_with('.') && !moves.is_empty() && !value.is_empty(), "{name}: {why}");
        }
    }
}
