//! The surrogates of reduced outputs and margins that a study stores.

use std::sync::Arc;

use crate::study::bounding::Bounded;
use crate::study::problem::Study;

use super::kept::KeptReduced;
use super::values::ChannelValues;
use crate::methods::Method;
use crate::numerics::{BandError, PointSet, largest, step_error, surrogate_error};

/// Stored surrogates of reduced outputs and margins, with the errors of their values.
pub fn kept_reduced(
    study: &Study,
    results: &mut Bounded,
    values: &Arc<ChannelValues>,
    unreliable: bool,
) -> Option<KeptReduced> {
    if !study.request.keep.is_any() {
        return None;
    }
    let index = results.methods.iter().position(|(method, _)| *method == Method::Chebyshev)?;
    let surrogate = results.methods[index].1.result.kept.take().filter(|kept| kept.rows() > 0)?;
    let outcome = &results.methods[index].1;
    let (validation, _) = results.validation.as_ref()?;
    let mut kept = KeptReduced { surrogate, values: values.clone(), errors: Vec::new() };
    let set = PointSet::of(&study.domain.samples(&validation.points));
    let samples = set.points();
    let every: Vec<usize> = (0..values.count()).collect();
    let own = kept.surrogate.values(0, &every, samples, &kept.closures());
    let of_value = |value: usize| {
        let direct = validation.direct.at(0, value);
        let known = &own[value * samples.len()..][..samples.len()];
        let surrogate = largest([surrogate_error(known, &direct), kept.surrogate.error(value, 0)]);
        let correction = validation.corrections(value, 1, None)[0];
        let time = correction.of(step_error(&direct, &validation.halved.at(0, value)));
        let ranges = &outcome.result.bands[value][..1];
        let span = validation.spans[value];
        let mut error = BandError::new(ranges, &[surrogate], &[time], span, study.request.tolerance);
        if unreliable {
            error.distrust(0..1);
        }
        error
    };
    kept.errors = every.iter().map(|&value| of_value(value)).collect();
    Some(kept)
}
