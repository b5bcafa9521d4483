//! Sizes of zones: above zero, and smaller than the part whose point they move.

use super::description::Point;
use crate::expand::zones::{RADIUS, Zone};
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;

/// Reports zones without a size, and those of points that reach as far as the body's points are apart.
pub(super) fn check(reader: &mut Reader) {
    let found: Vec<(Span, String)> =
        reader.model.zones.iter().filter_map(|zone| Some((zone.at.clone(), wrong(reader, zone)?))).collect();
    for (at, message) in found {
        reader.error(Code::BadZone, at, message, "check the diameter and its unit".to_owned());
    }
}

/// Fault of a zone's size; `None` if it has none.
fn wrong(reader: &Reader, zone: &Zone) -> Option<String> {
    let radius = format!("{}_{RADIUS}", zone.name);
    let index = reader.model.parameters.iter().position(|parameter| parameter.name == radius)?;
    let diameters = reader.corners.iter().filter_map(|corner| corner.values.get(index)).map(|radius| 2.0 * radius);
    let diameter = diameters.reduce(f64::min)?;
    if diameter <= 0.0 {
        return Some(format!("the zone `{}` has no size: its diameter may be {diameter} m", zone.name));
    }
    let (body, point) = zone.point.as_ref()?;
    let own = reader.model.bodies.iter().find(|own| own.name == *body)?;
    // At corner 0 all parameters are nominal: points stand where they are meant to be.
    let position = |point: &Point| point.position.each_ref().map(|along| reader.evaluate(along, 0));
    let moved = own.points.iter().find(|own| own.name == *point).map(position)?;
    let distance = |other: &Point| {
        let apart = position(other).into_iter().zip(moved).map(|(a, b)| Some((a? - b?).powi(2)));
        apart.sum::<Option<f64>>().map(f64::sqrt)
    };
    let farthest = own.points.iter().filter_map(distance).fold(0.0, f64::max);
    (farthest > 0.0 && diameter >= farthest).then(|| {
        format!(
            "the zone of `{body}.{point}` is larger than the part: its diameter is {diameter} m, and the body's points are \
             {farthest} m apart"
        )
    })
}
