//! `trajectories:`.

use symdiff::Formula;

use super::names::Reader;
use crate::elements::{Timing, Trajectory, Waypoint};
use crate::grammar::Context;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::keys;
use crate::model::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node, Value};

/// Rate given at an end.
const AT_REST: &str = "must be 0 in the first and the last point: the trajectory rests before and after";

/// Sections whose names formulas may use too.
const OTHERS: [&str; 5] = ["parameters", "bodies", "joints", "effects", "states"];

/// Reads the trajectories of a model, once its parameters are known.
pub fn read(reader: &mut Reader, fields: &Fields) {
    let Some(node) = fields.get("trajectories") else { return };
    let is_taken = |name: &str| {
        let taken = |section: &Node| section.get(name).is_some();
        OTHERS.iter().any(|section| fields.get(section).is_some_and(taken))
    };
    for entry in reader.entries(node, "trajectories") {
        let named = reader.name(entry, "a trajectory");
        if is_taken(&entry.key) {
            let message = format!("something else is called `{}` too", clip(&entry.key));
            reader.error(
                Code::NameTaken,
                entry.key_span.clone(),
                message,
                "give the trajectory another name".to_owned(),
            );
            continue;
        }
        let found = trajectory(reader, entry);
        reader.model.mechanism_mut().trajectories.extend(found.filter(|_| named));
    }
}

fn trajectory(reader: &mut Reader, entry: &Entry) -> Option<Trajectory> {
    let fields = reader.fields::<keys::Trajectory>(&entry.value, entry.key_span.clone())?;
    let timings = ["cubic", "quintic", "trapezoidal", "spline"].map(|word| (word, word));
    let timing = reader.required(&fields, "timing").and_then(|node| reader.choice(node, &timings));
    let nodes = reader.required(&fields, "points").and_then(|node| listed(reader, node))?;
    let timing = timing?;
    let has_rates = matches!(timing, "cubic" | "quintic");
    let mut dimension = None;
    let mut points = Vec::with_capacity(nodes.len());
    for (index, node) in nodes.iter().enumerate() {
        let at_end = index == 0 || index + 1 == nodes.len();
        points.push(point(reader, node, has_rates, at_end, &mut dimension)?);
    }
    ascending(reader, &points, nodes)?;
    let timing = match (timing, fields.get("ramp")) {
        ("trapezoidal", None) => Timing::Trapezoidal(None),
        ("trapezoidal", Some(node)) => Timing::Trapezoidal(Some(ramp(reader, node, &points)?)),
        (_, Some(_)) => {
            reader.error(Code::MisplacedKey, fields.key_span("ramp"), "`ramp` goes with `timing: trapezoidal`", None);
            return None;
        }
        ("cubic", None) => Timing::Cubic,
        ("quintic", None) => Timing::Quintic,
        _ => Timing::Spline,
    };
    Some(Trajectory { name: entry.key.clone(), points, timing, dimension })
}

fn listed<'n>(reader: &mut Reader, node: &'n Node) -> Option<&'n [Node]> {
    let found = match &node.value {
        Value::Sequence(items) if (2..=TUNING.trajectory_points).contains(&items.len()) => return Some(items),
        Value::Sequence(items) if items.len() > 2 => {
            format!("a trajectory has at most {trajectory_points} points", trajectory_points = TUNING.trajectory_points)
        }
        Value::Sequence(_) => "a trajectory has at least two points".to_owned(),
        _ => format!("a list of points belongs here, but here is {}", node.kind()),
    };
    reader.error(
        Code::BadTrajectory,
        node.span.clone(),
        found,
        "e.g. `[[0, 0 deg], [1.5, 90 deg]]`; a `table` goes through many".to_owned(),
    );
    None
}

/// `[time, value]`, or `[time, value, rate]`.
fn point(
    reader: &mut Reader,
    node: &Node,
    has_rates: bool,
    at_end: bool,
    dimension: &mut Option<Dimension>,
) -> Option<Waypoint> {
    let (time, value, rate) = match &node.value {
        Value::Sequence(items) => match items.as_slice() {
            [time, value] => (time, value, None),
            [time, value, rate] if has_rates => (time, value, Some(rate)),
            [_, _, rate] => {
                let message = "only with timing `cubic` or `quintic` a point has a rate";
                reader.error(Code::BadTrajectory, rate.span.clone(), message, "leave the third number out".to_owned());
                return None;
            }
            _ => return no_point(reader, node),
        },
        _ => return no_point(reader, node),
    };
    let time = reader.formula(time, Context::Constant, Dimension::TIME);
    let value = any_of(reader, value, dimension);
    let rate = match rate {
        None => None,
        Some(node) => {
            let mut of_rate = dimension.map(|dimension| dimension.per(Dimension::TIME));
            let rate = any_of(reader, node, &mut of_rate)?;
            if at_end {
                reader.require(node, &rate, |rate| rate == 0.0, AT_REST);
            }
            Some(rate)
        }
    };
    Some(Waypoint { time: time?, value: value?, rate })
}

fn no_point(reader: &mut Reader, node: &Node) -> Option<Waypoint> {
    reader.error(Code::BadTrajectory, node.span.clone(), "a point is `[time, value]` or `[time, value, rate]`", None);
    None
}

/// A formula of parameters that fits the dimension, or says it.
fn any_of(reader: &mut Reader, node: &Node, dimension: &mut Option<Dimension>) -> Option<Formula> {
    let (formula, own) = reader.any_unit(node, Context::Constant)?;
    match (own, *dimension) {
        (Some(own), Some(dimension)) => reader.check_fits(&node.span, own, dimension).then_some(formula),
        (own, known) => {
            *dimension = known.or(own);
            Some(formula)
        }
    }
}

/// Reports the first time that does not come after the one before, at some values of the parameters.
fn ascending(reader: &mut Reader, points: &[Waypoint], nodes: &[Node]) -> Option<()> {
    for (pair, node) in points.windows(2).zip(&nodes[1..]) {
        let found = moves(reader, pair).find(|([before, after], _)| before >= after);
        if let Some(([before, after], label)) = found {
            let message = format!("times ascend, but {after} s does not come after {before} s{label}");
            reader.error(Code::BadTrajectory, node.span.clone(), message, None);
            return None;
        }
    }
    Some(())
}

/// Beginning and end of a move, s, at every corner of the parameters, and the corner's label.
fn moves<'r>(reader: &'r Reader, pair: &'r [Waypoint]) -> impl Iterator<Item = ([f64; 2], String)> + 'r {
    (0..reader.corners.len()).filter_map(|corner| {
        let times = [reader.evaluate(&pair[0].time, corner)?, reader.evaluate(&pair[1].time, corner)?];
        Some((times, reader.corners[corner].label.clone()))
    })
}

/// Two ramps fit into every move.
fn ramp(reader: &mut Reader, node: &Node, points: &[Waypoint]) -> Option<Formula> {
    let ramp = reader.formula_that(node, Context::Constant, Dimension::TIME, |ramp| ramp > 0.0, "must be positive")?;
    for pair in points.windows(2) {
        let ramps = (0..reader.corners.len()).map(|corner| reader.evaluate(&ramp, corner));
        let short = ramps.zip(moves(reader, pair)).find_map(|(ramp, ([before, after], label))| {
            let (ramp, length) = (ramp?, after - before);
            (2.0 * ramp > length * (1.0 + TUNING.same_time)).then_some((ramp, length, label))
        });
        if let Some((ramp, length, label)) = short {
            let message = format!("two ramps of {ramp} s do not fit into a move of {length} s{label}");
            reader.error(
                Code::BadTrajectory,
                node.span.clone(),
                message,
                "a ramp is at most half of the shortest move".to_owned(),
            );
            return None;
        }
    }
    Some(ramp)
}
