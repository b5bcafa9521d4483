//! What acts on a joint's coordinate: which one it is, and motors that prescribe it.

use crate::grammar::JointCoordinate;
use std::convert::Infallible;

use symdiff::{Builder, Formula};

use super::file;
use crate::elements::joints::{JointKind, Motor, Prescribed, Profile};
use crate::grammar::names::Context;
use crate::grammar::quantity::Dimension;
use crate::grammar::reader::Fields;
use crate::model::names::Reader;
use crate::syntax::source::Span;
use crate::syntax::yaml::Node;

/// Part of a trapezoidal profile's duration that each acceleration takes.
const RAMP: f64 = 0.25;

/// Keys of moves and run-ups.
const PROFILED: [&str; 3] = ["start", "duration", "ramp"];

/// A motor.
pub fn read(reader: &mut Reader, node: &Node, at: Span) -> Option<JointKind> {
    let fields = reader.fields::<file::Motor>(node, at)?;
    let on = reader.on_joint(&fields);
    let [place, speed, _] =
        crate::grammar::motions::dimensions_of(on.map_or(JointCoordinate::Angle, |on| on.coordinate));
    let motion = prescribed(reader, &fields, place, speed);
    let on = on?;
    Some(Motor { joint: on.joint, coordinate: on.coordinate, motion: motion? }.into())
}

fn prescribed(reader: &mut Reader, fields: &Fields, place: Dimension, speed: Dimension) -> Option<Prescribed> {
    let given: Vec<&str> = ["position", "speed", "to"].into_iter().filter(|key| fields.get(key).is_some()).collect();
    let [wanted] = given.as_slice() else {
        let help = "e.g. `speed: 60 rpm`, `position: 0.1*sin(3*t)` or `to: 90 deg` with a `profile`".to_owned();
        let message = "a motor has one of `position`, `speed` and `to`";
        reader.error(fields.at.clone(), message, help);
        return None;
    };
    if *wanted == "position" {
        for key in ["from", "profile", "start", "duration", "ramp"] {
            if fields.get(key).is_some() {
                reader.error(fields.key_span(key), format!("`{key}` does not go with `position`"), None);
            }
        }
        return reader.formula(fields.get("position")?, Context::Time, place).map(Prescribed::Position);
    }
    let constant = |reader: &mut Reader, key: &str, dimension: Dimension| match fields.get(key) {
        Some(node) => reader.formula(node, Context::Constant, dimension),
        None => Some(Formula::number(0.0)),
    };
    let from = constant(reader, "from", place);
    if *wanted == "speed" && fields.get("profile").is_none() {
        for key in PROFILED.into_iter().filter(|key| fields.get(key).is_some()) {
            reader.error(fields.key_span(key), format!("`{key}` goes with a `profile`"), None);
        }
        return Some(Prescribed::Speed { from: from?, speed: integrable(reader, fields.get("speed")?, speed)? });
    }
    let end = constant(reader, wanted, if *wanted == "speed" { speed } else { place });
    let Some(profile) = fields.get("profile") else {
        for key in PROFILED.into_iter().filter(|key| fields.get(key).is_some()) {
            reader.error(fields.key_span(key), format!("`{key}` goes with a `profile`"), None);
        }
        let help = "cycloidal, quintic or trapezoidal".to_owned();
        reader.error(fields.key_span("to"), "`to` needs a `profile` and a `duration`", help);
        return None;
    };
    let profile = read_profile(reader, fields, profile);
    let start = constant(reader, "start", Dimension::TIME);
    let duration = reader.required(fields, "duration").and_then(|node| {
        reader.formula_that(node, Context::Constant, Dimension::TIME, |value| value > 0.0, "must be positive")
    });
    let (profile, from, end, start, duration) = (profile?, from?, end?, start?, duration?);
    Some(match *wanted {
        "speed" => Prescribed::RunUp { profile, from, speed: end, start, duration },
        _ => Prescribed::Move { profile, from, to: end, start, duration },
    })
}

/// A formula of parameters and t that can be integrated.
fn integrable(reader: &mut Reader, node: &Node, dimension: Dimension) -> Option<Formula> {
    let formula = reader.formula(node, Context::Time, dimension)?;
    let builder = Builder::new();
    let time = builder.variable("t");
    let Ok(speed) = formula.build(&builder, |name| Ok::<_, Infallible>(builder.variable(name)));
    let integral = speed.integral(time);
    if integral.is_none() {
        let help = "polynomials, sin, cos, exp, sqrt, min and max of straight lines, and their sums can be; or give it as `position`";
        reader.error(node.span.clone(), "this speed cannot be integrated by formulas", help.to_owned());
    }
    integral.map(|_| formula)
}

fn read_profile(reader: &mut Reader, fields: &Fields, node: &Node) -> Option<Profile> {
    let names = [("cycloidal", 0), ("quintic", 1), ("trapezoidal", 2)];
    let chosen = reader.choice(node, &names)?;
    if chosen != 2 && fields.get("ramp").is_some() {
        reader.error(fields.key_span("ramp"), "`ramp` goes with the trapezoidal profile", None);
    }
    Some(match chosen {
        0 => Profile::Cycloidal,
        1 => Profile::Quintic,
        _ => {
            let ramp = match fields.get("ramp") {
                Some(node) => {
                    let holds = |value| value > 0.0 && value <= 0.5;
                    let requirement = "must be above 0 and at most 0.5";
                    reader.formula_that(node, Context::Constant, Dimension::NUMBER, holds, requirement)?
                }
                None => Formula::number(RAMP),
            };
            Profile::Trapezoidal { ramp }
        }
    })
}
