//! Conversions between a run and its methods: findings of the run, and quantities that methods observe.

use super::Motions;
use crate::methods::{self, Effort, StopCause};
use crate::simulate::{Counters, Observed, Stop, TooDeep};

pub fn too_deep(motions: &Motions, found: TooDeep) -> methods::TooDeep {
    let mut contacts = motions.simulator.system.effects.iter().filter(|effect| effect.overlap.is_some());
    let contact = contacts.nth(found.contact).map(|effect| effect.name.clone()).unwrap_or_default();
    let TooDeep { time, depth, deepest, .. } = found;
    methods::TooDeep { contact, time, depth, deepest }
}

pub fn effort(counters: Counters) -> Effort {
    Effort { iterations: counters.iterations, rank_revealing: counters.rank_revealing }
}

pub(in crate::study) fn stopped_at(stop: &Stop) -> methods::Stop {
    let cause = match stop.open {
        _ if stop.singular => StopCause::SingularJet,
        Some(open) => StopCause::Locked { constraint: open.constraint, residual: open.residual },
        None => StopCause::NotConverged { equation: stop.equation },
    };
    methods::Stop { sample: stop.sample, row: stop.row, time: stop.time, cause }
}

pub fn observed(by_method: methods::Observed) -> Observed {
    match by_method {
        methods::Observed::Outputs => Observed::Outputs,
        methods::Observed::Motion => Observed::Motion,
    }
}
