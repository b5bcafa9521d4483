//! Effects that act on bodies and joints: drives, resistance, cables, gears with play.

use crate::grammar::JointCoordinate;
use symdiff::{Binary, Formula};

use super::{needed, or_zero, positive, positive_or};
use crate::grammar::motions::dimensions_of;
use crate::grammar::names::Context;
use crate::grammar::quantity::Dimension;
use crate::model::effect_kinds::{Backlash, Beam, Cable, Drag, Preload, Preloaded, Servo};
use crate::model::file;
use crate::model::names::Reader;
use crate::syntax::source::Span;
use crate::syntax::yaml::Node;

/// Stretch over which a cable becomes taut, over its length.
const TAUT: f64 = 1e-4;

/// Angle over which teeth come to bear, over the play.
const BEARING: f64 = 1e-2;

pub fn servo(reader: &mut Reader, node: &Node, at: Span) -> Option<Servo> {
    let fields = reader.fields::<file::Servo>(node, at)?;
    let on = reader.on_joint(&fields);
    let [place, speed, effort] = dimensions_of(on.map_or(JointCoordinate::Angle, |on| on.coordinate));
    let target = needed(reader, &fields, "target", Context::Time, place);
    let proportional = needed(reader, &fields, "proportional", Context::Effect, effort.per(place));
    let derivative = or_zero(reader, &fields, "derivative", effort.per(speed));
    let limit = match fields.get("limit") {
        Some(_) => positive(reader, &fields, "limit", effort).map(Some),
        None => Some(None),
    };
    Some(Servo { on: on?, target: target?, proportional: proportional?, derivative: derivative?, limit: limit? })
}

pub fn drag(reader: &mut Reader, node: &Node, at: Span) -> Option<Drag> {
    let fields = reader.fields::<file::Drag>(node, at)?;
    let on = reader.required(&fields, "on").and_then(|node| reader.point_ref(node));
    let square = Dimension::VELOCITY.times(Dimension::VELOCITY);
    let aerodynamic = [
        ("density", Dimension::MASS.per(Dimension::LENGTH.times(Dimension::LENGTH).times(Dimension::LENGTH))),
        ("drag_coefficient", Dimension::NUMBER),
        ("area", Dimension::LENGTH.times(Dimension::LENGTH)),
    ];
    let is_aerodynamic = aerodynamic.iter().any(|(key, _)| fields.get(key).is_some());
    let quadratic = if is_aerodynamic {
        if fields.get("quadratic").is_some() {
            let message = "`quadratic` excludes `density`, `drag_coefficient` and `area`";
            reader.error(fields.key_span("quadratic"), message, None);
        }
        let factors = aerodynamic.map(|(key, dimension)| needed(reader, &fields, key, Context::Effect, dimension));
        let factors: Option<Vec<Formula>> = factors.into_iter().collect();
        factors.map(|factors| [vec![Formula::number(0.5)], factors].concat())
    } else {
        if fields.get("quadratic").is_none() && fields.get("linear").is_none() {
            let help = "or `density`, `drag_coefficient` and `area`".to_owned();
            reader.error(fields.at.clone(), "a drag needs `quadratic` or `linear`", help);
        }
        or_zero(reader, &fields, "quadratic", Dimension::FORCE.per(square)).map(|factor| vec![factor])
    };
    let linear = or_zero(reader, &fields, "linear", Dimension::DAMPING);
    let wind = match fields.get("wind") {
        Some(node) => reader.components(node, Context::Effect, Dimension::VELOCITY),
        None => Some([0.0; 3].map(Formula::number)),
    };
    Some(Drag { on: on?, quadratic: quadratic?, linear: linear?, wind: wind? })
}

pub fn cable(reader: &mut Reader, node: &Node, at: Span) -> Option<Cable> {
    let fields = reader.fields::<file::Cable>(node, at)?;
    let between = reader.required(&fields, "between").and_then(|node| reader.between_points(node));
    let free_length = positive(reader, &fields, "free_length", Dimension::LENGTH);
    let stiffness = needed(reader, &fields, "stiffness", Context::Effect, Dimension::STIFFNESS);
    let damping = or_zero(reader, &fields, "damping", Dimension::DAMPING);
    let free_length = free_length?;
    let corner = scaled(TAUT, &free_length);
    let transition = positive_or(reader, &fields, "transition", Dimension::LENGTH, corner);
    Some(Cable { between: between?, free_length, stiffness: stiffness?, damping: damping?, transition: transition? })
}

pub fn backlash(reader: &mut Reader, node: &Node, at: Span) -> Option<Backlash> {
    let fields = reader.fields::<file::Backlash>(node, at)?;
    let between = reader.required(&fields, "between").and_then(|node| reader.turning(node));
    let ratio = reader.required(&fields, "ratio").and_then(|node| {
        let holds = |value| value != 0.0;
        reader.formula_that(node, Context::Constant, Dimension::NUMBER, holds, "must not be zero")
    });
    let offset = match fields.get("offset") {
        Some(node) => reader.formula(node, Context::Constant, Dimension::ANGLE),
        None => Some(Formula::number(0.0)),
    };
    let play = positive(reader, &fields, "backlash", Dimension::ANGLE);
    let stiffness = needed(reader, &fields, "stiffness", Context::Effect, Dimension::TORSIONAL_STIFFNESS);
    let damping = or_zero(reader, &fields, "damping", Dimension::TORSIONAL_DAMPING);
    let play = play?;
    let corner = scaled(BEARING, &play);
    let transition = positive_or(reader, &fields, "transition", Dimension::ANGLE, corner);
    Some(Backlash {
        between: between?,
        ratio: ratio?,
        offset: offset?,
        backlash: play,
        stiffness: stiffness?,
        damping: damping?,
        transition: transition?,
    })
}

pub fn preload(reader: &mut Reader, node: &Node, at: Span) -> Option<Preload> {
    let fields = reader.fields::<file::Preload>(node, at)?;
    if fields.get("on").is_none() {
        if fields.get("coordinate").is_some() {
            reader.error(fields.key_span("coordinate"), "`coordinate` goes with `on`, a joint", None);
        }
        let between = reader.required(&fields, "between").and_then(|node| reader.between_points(node));
        let value = needed(reader, &fields, "value", Context::Effect, Dimension::FORCE);
        return Some(Preload { on: Preloaded::Points(between?), value: value? });
    }
    if fields.get("between").is_some() {
        reader.error(fields.key_span("between"), "`on` and `between` exclude each other", None);
    }
    let on = reader.on_joint(&fields)?;
    let [_, _, effort] = dimensions_of(on.coordinate);
    let value = needed(reader, &fields, "value", Context::Effect, effort)?;
    Some(Preload { on: Preloaded::Joint(on), value })
}

pub fn beam(reader: &mut Reader, node: &Node, at: Span) -> Option<Beam> {
    let fields = reader.fields::<file::Beam>(node, at)?;
    let between = reader.required(&fields, "between").and_then(|node| reader.between_points(node));
    if let (Some(between), Some(node)) = (between, fields.get("between"))
        && let Some(end) = between.iter().find(|end| reader.model.bodies[end.body].has_orientation())
    {
        let message = format!("`{}` turns about more than z", reader.model.bodies[end.body].name);
        let help = "a beam bends in the plane: use a `bushing` in space".to_owned();
        reader.error(node.span.clone(), message, help);
    }
    let axis = match fields.get("axis") {
        Some(node) => reader.direction(node),
        None => Some([1.0, 0.0, 0.0].map(Formula::number)),
    };
    let length = positive(reader, &fields, "length", Dimension::LENGTH);
    let axial_stiffness = needed(reader, &fields, "axial_stiffness", Context::Effect, Dimension::FORCE);
    let bending = Dimension::TORQUE.times(Dimension::LENGTH);
    let bending_stiffness = needed(reader, &fields, "bending_stiffness", Context::Effect, bending);
    let damping = or_zero(reader, &fields, "damping", Dimension::TIME);
    Some(Beam {
        between: between?,
        axis: axis?,
        length: length?,
        axial_stiffness: axial_stiffness?,
        bending_stiffness: bending_stiffness?,
        damping: damping?,
        mass_per_length: None,
    })
}

/// A multiple of a formula.
fn scaled(factor: f64, formula: &Formula) -> Formula {
    Formula::number(factor).combined(Binary::Mul, formula)
}
