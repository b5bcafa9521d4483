//! Lists of the units, functions and names of formulas, from the tables that resolve them: data for `mbint explain` and
//! for the reference pages.

use serde::Serialize;
use symdiff::formula::FUNCTIONS;

use super::motions::{
    ANGULAR_MOTIONS, ATTITUDE, AXES, JOINT_MOTIONS, MOTIONS, ORIENTATION, joint_dimension, motion_dimension,
};
use super::names::ENERGIES;
use super::quantity::Dimension;
use super::symbols::{Coordinate, EnergyKind, JointCoordinate, TimeOrder};
use super::unit::named_units;

/// A unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnitDocs {
    /// As it is written.
    pub unit: &'static str,
    /// The value of one of this unit in SI units.
    pub value: f64,
    /// The SI unit; empty for a pure number.
    pub si: String,
    /// The quantity that it measures.
    pub quantity: String,
}

/// A function of formulas.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FunctionDocs {
    /// Name and arguments: `atan2(y, x)`.
    pub function: String,
    /// The arguments for which it has a value.
    pub domain: &'static str,
    /// Its value in words.
    pub value: &'static str,
}

/// A quantity that an output may observe.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct OutputDocs {
    /// The kind of thing that has it; for an effect, its keyword.
    pub of: &'static str,
    /// The name, with names of the model's own things in capitals: `BODY.vx`.
    pub output: String,
    /// Unit; empty for a pure number.
    pub unit: String,
    /// Value, sign and frame.
    pub meaning: String,
}

/// All units that have a name.
pub fn units() -> Vec<UnitDocs> {
    let unit = |(name, unit): (&'static str, super::unit::Unit)| UnitDocs {
        unit: name,
        value: unit.to_si(1.0),
        si: unit.dimension.unit(),
        quantity: unit.dimension.noun(),
    };
    named_units().map(unit).collect()
}

/// All functions of formulas.
pub fn functions() -> Vec<FunctionDocs> {
    let function = |known: &symdiff::formula::NamedFunction| FunctionDocs {
        function: format!("{}({})", known.name, known.arguments),
        domain: known.domain,
        value: known.value,
    };
    // The parser expands `sum` before it resolves functions.
    let sum = FunctionDocs {
        function: "sum(i, a..b, term)".to_owned(),
        domain: "whole a ≤ b",
        value: "the term for each i from a to b, added; i may be in names, `leg_{i}.force`",
    };
    FUNCTIONS.iter().map(function).chain([sum]).collect()
}

/// All outputs of bodies, points, joints and of the whole mechanism; effects list their own.
pub fn outputs() -> Vec<OutputDocs> {
    let mut outputs = body_outputs();
    outputs.extend(point_outputs());
    outputs.extend(joint_outputs());
    outputs.extend(ENERGIES.map(|(name, energy)| {
        let meaning = match energy {
            EnergyKind::Total => "kinetic and potential energy of the mechanism",
            EnergyKind::Kinetic => "kinetic energy of all bodies",
            EnergyKind::Potential => "potential energy of gravity and of all elastic effects",
        };
        output("mechanism", name.to_owned(), "J".to_owned(), meaning.to_owned())
    }));
    outputs.push(output("mechanism", "t".to_owned(), Dimension::TIME.unit(), "time since the start".to_owned()));
    outputs
}

fn output(of: &'static str, output: String, unit: String, meaning: String) -> OutputDocs {
    OutputDocs { of, output, unit, meaning }
}

fn rate_of(order: TimeOrder, position: &str, velocity: &str, acceleration: &str) -> String {
    match order {
        TimeOrder::Position => position,
        TimeOrder::Velocity => velocity,
        TimeOrder::Acceleration => acceleration,
    }
    .to_owned()
}

/// The position, velocity or acceleration of a point along an axis of the ground.
fn along(order: TimeOrder, of: &str, axis: &str) -> String {
    format!("{} of {of} along the ground's {axis}", rate_of(order, "position", "velocity", "acceleration"))
}

fn body_outputs() -> Vec<OutputDocs> {
    let motion = |&(name, coordinate, order): &(&str, Coordinate, TimeOrder)| {
        let meaning = match coordinate {
            Coordinate::X => along(order, "the frame's origin", "x"),
            Coordinate::Y => along(order, "the frame's origin", "y"),
            Coordinate::Z => along(order, "the frame's origin", "z"),
            Coordinate::Angle => rate_of(
                order,
                "angle of the frame against the ground about z, counter-clockwise, never wrapped",
                "angular velocity about z, counter-clockwise",
                "angular acceleration about z, counter-clockwise",
            ),
            Coordinate::Euler(0) => "Euler parameter: cosine of half the angle of rotation from the ground".to_owned(),
            Coordinate::Euler(index) => {
                format!("Euler parameter: {} of the axis times the sine of half the angle", AXES[index - 1])
            }
        };
        output("body", format!("BODY.{name}"), motion_dimension(coordinate, order).unit(), meaning)
    };
    let mut outputs: Vec<OutputDocs> = MOTIONS.iter().map(motion).collect();
    for (name, in_body, order) in ANGULAR_MOTIONS {
        let what = rate_of(order, "rotation", "angular velocity", "angular acceleration");
        let frame = if in_body { "the body's own" } else { "the ground's" };
        outputs.extend(AXES.map(|axis| {
            let unit = motion_dimension(Coordinate::Angle, order).unit();
            output("body", format!("BODY.{name}.{axis}"), unit, format!("{what} along {frame} {axis}"))
        }));
    }
    outputs.extend(ANGULAR_MOTIONS.iter().map(|&(name, _, order)| {
        let unit = motion_dimension(Coordinate::Angle, order).unit();
        let meaning = "the three of them, as outputs NAME_x, NAME_y and NAME_z; alone, not in a formula".to_owned();
        output("body", format!("BODY.{name}"), unit, meaning)
    }));
    outputs.extend(ATTITUDE.iter().zip(AXES).map(|(name, axis)| {
        let meaning = format!("rotation about the ground's {axis}, in the order x, y, z; from −π to π");
        output("body", format!("BODY.{name}"), Dimension::ANGLE.unit(), meaning)
    }));
    let meaning =
        "the three of them, as outputs NAME_roll, NAME_pitch and NAME_yaw; alone, not in a formula".to_owned();
    outputs.push(output("body", format!("BODY.{ORIENTATION}"), Dimension::ANGLE.unit(), meaning));
    outputs
}

fn point_outputs() -> Vec<OutputDocs> {
    let lengths = MOTIONS.iter().filter(|(_, coordinate, _)| coordinate.is_length());
    let motion = |&(name, coordinate, order): &(&str, Coordinate, TimeOrder)| {
        let axis = match coordinate {
            Coordinate::X => "x",
            Coordinate::Y => "y",
            _ => "z",
        };
        let unit = motion_dimension(coordinate, order).unit();
        output("point", format!("BODY.POINT.{name}"), unit, along(order, "the point", axis))
    };
    lengths.map(motion).collect()
}

fn joint_outputs() -> Vec<OutputDocs> {
    let motion = |&(name, coordinate, order): &(&str, JointCoordinate, TimeOrder)| {
        let meaning = match coordinate {
            JointCoordinate::Angle => {
                let what = rate_of(order, "angle", "angular velocity", "angular acceleration");
                let wrapped = if order == TimeOrder::Position { ", never wrapped" } else { "" };
                format!("{what} of the second body against the first about the joint's axis{wrapped}")
            }
            JointCoordinate::Displacement => {
                let what = rate_of(order, "displacement", "velocity", "acceleration");
                format!("{what} of the second point from the first along the joint's axis")
            }
        };
        output("joint", format!("JOINT.{name}"), joint_dimension(coordinate, order).unit(), meaning)
    };
    let mut outputs: Vec<OutputDocs> = JOINT_MOTIONS.iter().map(motion).collect();
    let (force, torque) = (Dimension::FORCE.unit(), Dimension::TORQUE.unit());
    let reaction = |name: &str, unit: &String, meaning: &str| {
        output("joint", format!("JOINT.{name}"), unit.clone(), meaning.to_owned())
    };
    outputs.push(reaction("force", &force, "magnitude of the reaction force on the second body"));
    outputs.extend(AXES.map(|axis| {
        let meaning = format!("reaction force on the second body along the ground's {axis}");
        reaction(&format!("force.{axis}"), &force, &meaning)
    }));
    let meaning = "reaction torque on the second body about its point: about z in the plane; in space, of a motor or gear about \
                   the joint's axis, with its sign, of other joints the magnitude";
    outputs.push(reaction("torque", &torque, meaning));
    outputs.extend(AXES.map(|axis| {
        let meaning =
            format!("reaction torque on the second body about its point, along the ground's {axis}; in space");
        reaction(&format!("torque.{axis}"), &torque, &meaning)
    }));
    let (axial, radial) = (
        "reaction force on the second body along the joint's own axis, for a motor, gear or rack along that of the driven joint; \
         of a `distance` its tension, of a `cam` positive where the follower is pushed away",
        "reaction force on the second body across that axis: the magnitude, or where the axis is one of the plane the \
         component along the axis turned by +90°",
    );
    outputs.push(reaction("axial", &force, axial));
    outputs.push(reaction("radial", &force, radial));
    outputs.push(reaction("torque.axial", &torque, "reaction torque on the second body about that axis"));
    outputs.extend(AXES.map(|axis| {
        let meaning = format!("reaction force on the second body along {axis} of its own frame at its point");
        reaction(&format!("force_body.{axis}"), &force, &meaning)
    }));
    outputs.extend(AXES.map(|axis| {
        let meaning = format!(
            "reaction torque on the second body about its point, along {axis} of its own frame there; in space"
        );
        reaction(&format!("torque_body.{axis}"), &torque, &meaning)
    }));
    let meaning = "reaction torque on the second body about a point of any body, along the ground's z; in space with an \
                   axis, `JOINT.torque_at.BODY.POINT.x`";
    outputs.push(reaction("torque_at.BODY.POINT", &torque, meaning));
    outputs
}
