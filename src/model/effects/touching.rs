//! Effects of bodies that touch: friction, stops, contacts.

use crate::grammar::JointCoordinate;
use symdiff::Formula;

use super::{needed, or_zero, positive, positive_or};
use crate::elements::joints::Mobilizer;
use crate::grammar::motions::dimensions_of;
use crate::grammar::names::Context;
use crate::grammar::quantity::Dimension;
use crate::grammar::reader::Fields;
use crate::model::effect_kinds::{
    ClearanceJoint, Contact, DryFriction, Impact, JointFriction, Loss, RestitutionLaw, Rubbing, Stop, Surface,
};
use crate::model::file;
use crate::model::names::Reader;
use crate::syntax::source::Span;
use crate::syntax::yaml::Node;

/// Speed that counts as rest, m/s or rad/s.
const AT_REST: f64 = 1e-3;

/// Hertz's.
const EXPONENT: f64 = 1.5;

pub fn joint_friction(reader: &mut Reader, node: &Node, at: Span) -> Option<JointFriction> {
    let fields = reader.fields::<file::JointFriction>(node, at)?;
    let (joint, rubbing) = rubbing_joint(reader, &fields)?;
    let turns = rubbing == Rubbing::Turning;
    let coordinate = if turns { JointCoordinate::Angle } else { JointCoordinate::Displacement };
    let [_, speed, effort] = dimensions_of(coordinate);
    let coefficient = or_zero(reader, &fields, "coefficient", Dimension::NUMBER);
    let dry = dry_friction(reader, &fields, coefficient, speed);
    let coulomb = or_zero(reader, &fields, "coulomb", effort);
    let viscous = or_zero(reader, &fields, "viscous", effort.per(speed));
    if ["coefficient", "coulomb", "viscous"].iter().all(|key| fields.get(key).is_none()) {
        let message = "a joint friction needs `coefficient`, `coulomb` or `viscous`";
        reader.error(fields.at.clone(), message, None);
    }
    let by_radius = match rubbing {
        Rubbing::Turning => fields.get("coefficient").is_some(),
        Rubbing::Sliding => false,
        Rubbing::Both => true,
    };
    let radius = match fields.get("radius") {
        None if by_radius => positive(reader, &fields, "radius", Dimension::LENGTH),
        None => Some(Formula::number(0.0)),
        Some(_) => positive(reader, &fields, "radius", Dimension::LENGTH),
    };
    let length = match fields.get("length") {
        Some(_) => positive(reader, &fields, "length", Dimension::LENGTH).map(Some),
        None => Some(None),
    };
    Some(JointFriction {
        joint,
        rubbing,
        dry: dry?,
        coulomb: coulomb?,
        viscous: viscous?,
        radius: radius?,
        length: length?,
    })
}

/// The joint of `on`, and how its bodies rub.
fn rubbing_joint(reader: &mut Reader, fields: &Fields) -> Option<(usize, Rubbing)> {
    let node = reader.required(fields, "on")?;
    let scalar = reader.scalar(node, "the name of a joint")?;
    let Some(joint) = reader.model.joints.iter().position(|joint| joint.name == scalar.text) else {
        // Says so.
        return reader.joint_ref(node, JointCoordinate::Angle).map(|joint| (joint, Rubbing::Turning));
    };
    let rubbing = match reader.model.joints[joint].kind.mobilizer() {
        Some(Mobilizer::Rotation { .. }) => Rubbing::Turning,
        Some(Mobilizer::Translation { .. }) => Rubbing::Sliding,
        Some(Mobilizer::RotationAndTranslation { .. }) => Rubbing::Both,
        _ => {
            let help = "it acts in revolute, prismatic and cylindrical joints".to_owned();
            let message = format!("joint friction does not know how `{}` rubs", reader.model.joints[joint].name);
            reader.error(node.span.clone(), message, help);
            return None;
        }
    };
    Some((joint, rubbing))
}

/// The law whose coefficient was read.
fn dry_friction(
    reader: &mut Reader,
    fields: &Fields,
    coefficient: Option<Formula>,
    speed: Dimension,
) -> Option<DryFriction> {
    if let (Some(node), Some(coefficient)) = (fields.get("coefficient"), &coefficient) {
        reader.require(node, coefficient, |value| value >= 0.0, "must not be negative");
    }
    let breakaway = match fields.get("breakaway") {
        Some(node) => reader.formula_that(
            node,
            Context::Constant,
            Dimension::NUMBER,
            |value| value >= 1.0,
            "must be at least 1: friction at rest is not less than sliding",
        ),
        None => Some(Formula::number(1.0)),
    };
    let stribeck = match (fields.get("stribeck_velocity"), fields.get("breakaway")) {
        (Some(_), None) => {
            let message = "`stribeck_velocity` goes with `breakaway`, the friction at rest over that while sliding";
            reader.error(fields.key_span("stribeck_velocity"), message, None);
            None
        }
        (None, Some(_)) => {
            let message = "`breakaway` needs `stribeck_velocity`, the speed at which its excess fades";
            reader.error(fields.key_span("breakaway"), message, None);
            None
        }
        (Some(_), Some(_)) => positive(reader, fields, "stribeck_velocity", speed).map(Some),
        (None, None) => Some(None),
    };
    let transition = positive_or(reader, fields, "transition_velocity", speed, Formula::number(AT_REST));
    Some(DryFriction { coefficient: coefficient?, breakaway: breakaway?, stribeck: stribeck?, transition: transition? })
}

pub fn stop(reader: &mut Reader, node: &Node, at: Span) -> Option<Stop> {
    let fields = reader.fields::<file::Stop>(node, at)?;
    let on = reader.on_joint(&fields);
    let [place, speed, effort] = dimensions_of(on.map_or(JointCoordinate::Angle, |on| on.coordinate));
    let end = |reader: &mut Reader, key: &str| match fields.get(key) {
        Some(node) => reader.formula(node, Context::Constant, place).map(Some),
        None => Some(None),
    };
    let (lower, upper) = (end(reader, "lower"), end(reader, "upper"));
    match (&lower, &upper) {
        (Some(None), Some(None)) => reader.error(fields.at.clone(), "a stop needs `lower` or `upper`", None),
        (Some(Some(lower)), Some(Some(upper))) => ordered(reader, &fields, ("lower", lower), ("upper", upper)),
        _ => {}
    }
    let impact = impact(reader, &fields, [place, speed, effort]);
    Some(Stop { on: on?, lower: lower?, upper: upper?, impact: impact? })
}

/// Reports where the second is not larger than the first.
fn ordered(reader: &mut Reader, fields: &Fields, (low, first): (&str, &Formula), (high, second): (&str, &Formula)) {
    for corner in 0..reader.corners.len() {
        let values = reader.evaluate(first, corner).zip(reader.evaluate(second, corner));
        if let Some((first, second)) = values
            && first >= second
        {
            let label = reader.corners[corner].label.clone();
            let message = format!("`{high}` ({second}) must be larger than `{low}` ({first}){label}");
            reader.error(fields.key_span(high), message, None);
            return;
        }
    }
}

/// `impact:`, by the dimensions of a depth, of its rate, and of what it pushes with.
pub fn impact(reader: &mut Reader, fields: &Fields, [depth, speed, effort]: [Dimension; 3]) -> Option<Impact> {
    let node = reader.required(fields, "impact")?;
    let fields = reader.fields::<file::Impact>(node, fields.key_span("impact"))?;
    let exponent = match fields.get("exponent") {
        Some(node) => {
            let exponent = reader.number(node, Dimension::NUMBER)?;
            if !(1.0..=3.0).contains(&exponent) {
                let help = "1 is a linear spring, 1.5 Hertz's contact of curved surfaces".to_owned();
                reader.error(node.span.clone(), format!("an exponent from 1 to 3 belongs here, not {exponent}"), help);
                return None;
            }
            exponent
        }
        None => EXPONENT,
    };
    let stiffness = reader.required(&fields, "stiffness").and_then(|node| match depth.to_the(exponent) {
        Some(power) => {
            let positive = |value| value > 0.0;
            reader.formula_that(node, Context::Constant, effort.per(power), positive, "must be positive")
        }
        // An exponent that no unit has: a plain number, in SI.
        None => {
            reader.formula_that(node, Context::Constant, Dimension::NUMBER, |value| value > 0.0, "must be positive")
        }
    });
    let given = |key: &str| fields.get(key).is_some();
    let loss = if given("restitution") || given("impact_velocity") || given("law") {
        if given("dissipation") {
            let message = "`dissipation` and `restitution` exclude each other";
            reader.error(fields.key_span("dissipation"), message, None);
        }
        let restitution = reader.required(&fields, "restitution").and_then(|node| {
            let holds = |value| value > 0.0 && value <= 1.0;
            reader.formula_that(node, Context::Constant, Dimension::NUMBER, holds, "must be above 0 and at most 1")
        });
        let velocity = positive(reader, &fields, "impact_velocity", speed);
        let law = match fields.get("law") {
            Some(node) => reader.choice(
                node,
                &[
                    ("hunt_crossley", RestitutionLaw::HuntCrossley),
                    ("lankarani_nikravesh", RestitutionLaw::LankaraniNikravesh),
                ],
            ),
            None => Some(RestitutionLaw::HuntCrossley),
        };
        Some((law, restitution, velocity)).and_then(|(law, restitution, velocity)| {
            Some(Loss::Restitution { law: law?, restitution: restitution?, velocity: velocity? })
        })
    } else {
        match fields.get("dissipation") {
            Some(node) => {
                let wanted = Dimension::NUMBER.per(speed);
                let holds = |value| value >= 0.0;
                reader.formula_that(node, Context::Constant, wanted, holds, "must not be negative")
            }
            None => Some(Formula::number(0.0)),
        }
        .map(Loss::Dissipation)
    };
    Some(Impact { stiffness: stiffness?, exponent, loss: loss? })
}

/// Depth, rate and force of a contact.
const STRAIGHT: [Dimension; 3] = [Dimension::LENGTH, Dimension::VELOCITY, Dimension::FORCE];

/// `friction:`, where it is there.
fn friction(reader: &mut Reader, fields: &Fields) -> Option<Option<DryFriction>> {
    let Some(node) = fields.get("friction") else { return Some(None) };
    let fields = reader.fields::<file::Friction>(node, fields.key_span("friction"))?;
    let coefficient = needed(reader, &fields, "coefficient", Context::Constant, Dimension::NUMBER);
    dry_friction(reader, &fields, coefficient, Dimension::VELOCITY).map(Some)
}

pub fn contact(reader: &mut Reader, node: &Node, at: Span) -> Option<Contact> {
    let fields = reader.fields::<file::Contact>(node, at)?;
    let between = reader.required(&fields, "between").and_then(|node| reader.between_points(node));
    let radius = match fields.get("radius") {
        Some(node) => reader.formula_that(
            node,
            Context::Constant,
            Dimension::LENGTH,
            |value| value >= 0.0,
            "must not be negative",
        ),
        None => Some(Formula::number(0.0)),
    };
    let surface = surface(reader, &fields);
    if let (Some(Surface::Hollow(bore)), Some(radius)) = (&surface, &radius)
        && fields.get("radius").is_some()
    {
        ordered(reader, &fields, ("radius", radius), ("hollow", bore));
    }
    let axis = match fields.get("axis") {
        Some(node) => reader.turning_axis(node).map(Some),
        None => Some(None),
    };
    let impact = impact(reader, &fields, STRAIGHT);
    let friction = friction(reader, &fields);
    // In the plane all cylinders' axes are z.
    let axis = axis?.filter(|_| reader.model.space.spatial);
    Some(Contact { between: between?, surface: surface?, radius: radius?, axis, impact: impact?, friction: friction? })
}

fn surface(reader: &mut Reader, fields: &Fields) -> Option<Surface> {
    let given: Vec<&str> = ["plane", "circle", "hollow"].into_iter().filter(|key| fields.get(key).is_some()).collect();
    match given.as_slice() {
        ["plane"] => reader.direction(fields.get("plane")?).map(Surface::Plane),
        ["circle"] => positive(reader, fields, "circle", Dimension::LENGTH).map(Surface::Round),
        [_] => positive(reader, fields, "hollow", Dimension::LENGTH).map(Surface::Hollow),
        [] => {
            let help = "say what the first body's surface is, e.g. `plane: y`".to_owned();
            reader.error(fields.at.clone(), "a contact needs `plane`, `circle` or `hollow`", help);
            None
        }
        [_, second, ..] => {
            let message = "`plane`, `circle` and `hollow` exclude one another";
            reader.error(fields.key_span(second), message, None);
            None
        }
    }
}

pub fn clearance_joint(reader: &mut Reader, node: &Node, at: Span) -> Option<ClearanceJoint> {
    let fields = reader.fields::<file::ClearanceJoint>(node, at)?;
    let between = reader.required(&fields, "between").and_then(|node| reader.between_points(node));
    let clearance = positive(reader, &fields, "clearance", Dimension::LENGTH);
    let radius = positive_or(reader, &fields, "radius", Dimension::LENGTH, Formula::number(0.0));
    let axis = match fields.get("axis") {
        Some(node) => reader.turning_axis(node),
        None => Some([0.0, 0.0, 1.0].map(Formula::number)),
    };
    let impact = impact(reader, &fields, STRAIGHT);
    let friction = friction(reader, &fields);
    Some(ClearanceJoint {
        between: between?,
        clearance: clearance?,
        radius: radius?,
        axis: axis?,
        impact: impact?,
        friction: friction?,
    })
}
