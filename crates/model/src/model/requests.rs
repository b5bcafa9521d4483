//! Questions to the mechanism: `initial:`, `guess:`, `outputs:` and `simulation:`.

use super::description::{Formulation, Output, Simulation, StartValue, Stepping};
use super::named_outputs::with_outputs;
use super::scheme::refused_alpha;
use super::{display, reduced};
use crate::grammar::dimension::KnownDimension;
use crate::grammar::formulas::Written;
use crate::grammar::motions::{
    ANGULAR_MOTIONS, ATTITUDE, AXES, ORIENTATION, joint_dimension, motion_dimension, motion_name,
};
use crate::grammar::names::{Context, GROUND};
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::grammar::unknown;
use crate::grammar::{Coordinate, PointRef, Symbol, TimeOrder};
use crate::keys;
use crate::model::names::Reader;
use crate::model::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node};

/// Reads `initial:` (with velocities) or `guess:` (without).
pub fn start_values(reader: &mut Reader, entries: &[Entry], velocities: bool) -> Vec<StartValue> {
    entries.iter().filter_map(|entry| start_value(reader, entry, velocities)).collect()
}

fn start_value(reader: &mut Reader, entry: &Entry, velocities: bool) -> Option<StartValue> {
    let name = entry.key.as_str();
    if let Some(value) = rotation_value(reader, entry, velocities) {
        return value;
    }
    let symbol = start_symbol(reader, entry)?;
    let (order, dimension) = match symbol {
        Symbol::Coordinate { body, coordinate, order } if !matches!(coordinate, Coordinate::Euler(_)) => {
            if !reader.model.bodies[body].coordinates.contains(&coordinate) {
                let owner = reader.model.bodies[body].name.clone();
                let coordinate_name = motion_name(coordinate, TimeOrder::Position);
                let message = format!("body `{owner}` has no coordinate `{coordinate_name}`");
                let help = format!("add it to `coordinates` of `{owner}`, or give its constant value in `held`");
                reader.error(Code::BadStart, entry.key_span.clone(), message, help);
            }
            (order, motion_dimension(coordinate, order))
        }
        Symbol::JointCoordinate { coordinate, order, .. } => (order, joint_dimension(coordinate, order)),
        Symbol::Point { body, coordinate, order, .. } if velocities && body != 0 => {
            (order, motion_dimension(coordinate, order))
        }
        Symbol::RollPitchYaw { .. } if velocities => (TimeOrder::Position, Dimension::ANGLE),
        Symbol::AngularMotion { order, .. } if velocities => (order, motion_dimension(Coordinate::Angle, order)),
        _ => {
            let message = format!("`{}` is not a coordinate of a body", clip(name));
            let help = if reader.model.space.spatial {
                "name coordinates of bodies or joints here, such as `hinge.angle` or `slider.vx`, `body.orientation`, \
                 `body.roll`, `body.omega` or `body.omega_body`"
            } else {
                "name coordinates of bodies here, such as `crank.angle` or `slider.vx`"
            };
            reader.error(Code::BadStart, entry.key_span.clone(), message, help.to_owned());
            return None;
        }
    };
    let refusal = match order {
        TimeOrder::Position => None,
        TimeOrder::Velocity if velocities => None,
        TimeOrder::Velocity => Some(ONLY_POSITIONS),
        TimeOrder::Acceleration => Some("an acceleration cannot be chosen: it follows from the forces"),
    };
    if let Some(refusal) = refusal {
        reader.error(Code::BadStart, entry.key_span.clone(), refusal, None);
        return None;
    }
    let value = reader.formula(&entry.value, Context::Constant, dimension)?;
    match symbol {
        Symbol::Coordinate { body, coordinate, .. } => Some(StartValue::Coordinate { body, coordinate, order, value }),
        Symbol::JointCoordinate { joint, coordinate, .. } => {
            Some(StartValue::Joint { joint, coordinate, order, value })
        }
        Symbol::Point { body, point, coordinate, .. } => {
            let place = PointRef { body, point: Some(point) };
            Some(StartValue::Point { place, coordinate, order, value })
        }
        Symbol::RollPitchYaw { body, angle } => Some(StartValue::RollPitchYaw { body, angle, value }),
        Symbol::AngularMotion { body, axis, in_body, .. } => {
            Some(StartValue::AngularRate { body, axis, in_body, value })
        }
        _ => None,
    }
}

/// Symbol that a start value belongs to; reports a name that stands for nothing.
fn start_symbol(reader: &mut Reader, entry: &Entry) -> Option<Symbol> {
    let name = entry.key.as_str();
    reader.mentions(None, name, &entry.key_span);
    let found = reader.model.symbol(name);
    if found.is_none() {
        let error = unknown::unknown(&reader.model, name, Context::Equation);
        let part = entry.key_span.start + error.part.start..entry.key_span.start + error.part.end;
        let verbatim = entry.key_span.len() == name.len();
        reader.error(
            Code::UnknownName,
            if verbatim { part } else { entry.key_span.clone() },
            error.message,
            error.help,
        );
    }
    found
}

/// Reads `body.orientation`, `body.omega` and `body.omega_body`; `None` for any other name.
fn rotation_value(reader: &mut Reader, entry: &Entry, velocities: bool) -> Option<Option<StartValue>> {
    let (owner, part) = entry.key.rsplit_once('.')?;
    let velocity = ANGULAR_MOTIONS.iter().find(|(name, _, order)| *name == part && *order == TimeOrder::Velocity);
    if part != ORIENTATION && velocity.is_none() {
        return None;
    }
    let body = reader.model.bodies.iter().position(|body| body.name == owner && owner != GROUND)?;
    if !reader.model.bodies[body].coordinates.contains(&Coordinate::Euler(0)) {
        let help = "a body in space has the coordinate `orientation` unless it says otherwise".to_owned();
        reader.error(
            Code::BadStart,
            entry.key_span.clone(),
            format!("body `{owner}` does not turn freely in space"),
            help,
        );
        return Some(None);
    }
    let Some(&(_, in_body, _)) = velocity else {
        let rotation = reader.rotation(&entry.value, entry.key_span.clone());
        return Some(rotation.map(|rotation| StartValue::Orientation { body, rotation }));
    };
    if !velocities {
        reader.error(Code::BadStart, entry.key_span.clone(), ONLY_POSITIONS, None);
        return Some(None);
    }
    let value = reader.three(&entry.value, Context::Constant, Dimension::ANGULAR_VELOCITY);
    Some(value.map(|value| StartValue::AngularVelocity { body, value, in_body }))
}

/// Why a velocity is not guessed.
const ONLY_POSITIONS: &str = "only positions are guessed: velocities follow from them";

/// Reads `outputs:`.
pub fn outputs(reader: &mut Reader, entries: &[Entry]) {
    let (mappings, formulas): (Vec<&Entry>, Vec<&Entry>) = entries.iter().partition(|entry| reduced::is_one(entry));
    let reduced: Vec<&str> = mappings.iter().map(|entry| entry.key.as_str()).collect();
    for entry in formulas {
        let known = reader.model.outputs.len();
        if let Some((entry, unit)) = display::formula(reader, entry)
            && name_of_output(reader, &entry)
            && reduced::is_of_motion(reader, &entry, &reduced)
        {
            let found = parts(reader, &entry).or_else(|| Some(vec![output(reader, &entry, entries)?]));
            found.into_iter().flatten().for_each(|output| add(reader, &entry, output));
            for index in known..reader.model.outputs.len() {
                let Output { name, dimension, .. } = reader.model.outputs[index].clone();
                unit.iter().for_each(|unit| display::read(reader, unit, &name, dimension));
            }
        }
        if reader.model.outputs.len() == known {
            reader.unread_outputs.push(entry.key.clone());
        }
    }
    // These may be of outputs that stand behind them.
    for entry in mappings {
        let known = reader.model.reduced.len();
        if name_of_output(reader, entry) && reduced::is_of_motion(reader, entry, &reduced) {
            reduced::read(reader, entry);
        }
        if reader.model.reduced.len() == known {
            reader.unread_outputs.push(entry.key.clone());
        }
    }
}

/// The outputs that stand for `body.omega` (`NAME_x`, `NAME_y`, `NAME_z`), `body.alpha` and `body.orientation`
/// (`NAME_roll`, …); `None` for any other value.
fn parts(reader: &Reader, entry: &Entry) -> Option<Vec<Output>> {
    let text = entry.value.scalar()?.text.trim();
    let (owner, vector) = text.rsplit_once('.')?;
    let parts = if vector == ORIENTATION {
        ATTITUDE.map(|angle| (angle, format!("{owner}.{angle}")))
    } else {
        ANGULAR_MOTIONS.iter().find(|(name, ..)| *name == vector)?;
        AXES.map(|axis| (axis, format!("{text}.{axis}")))
    };
    let output = |(part, name): (&str, String)| {
        let dimension = match reader.model.symbol(&name)? {
            Symbol::AngularMotion { order, .. } => motion_dimension(Coordinate::Angle, order),
            Symbol::RollPitchYaw { .. } => Dimension::ANGLE,
            _ => return None,
        };
        let formula = symdiff::Formula::parse(&name).ok()?;
        let name = format!("{}_{part}", entry.key);
        Some(Output { name, formula, unit: dimension.unit(), dimension: Some(dimension), of_results: false })
    };
    parts.into_iter().map(output).collect()
}

/// Adds an output, unless its name is taken: by a part of a vector.
fn add(reader: &mut Reader, entry: &Entry, output: Output) {
    if reader.model.outputs.iter().any(|known| known.name == output.name) {
        let message = format!("two outputs are called `{}`: one is a part of a vector", output.name);
        reader.error(Code::NameTaken, entry.key_span.clone(), message, "give one of them another name".to_owned());
    } else {
        reader.model.outputs.push(output);
    }
}

fn output(reader: &mut Reader, entry: &Entry, all: &[Entry]) -> Option<Output> {
    let node = &entry.value;
    let (formula, unit, dimension) = match reader.written(node)? {
        Written::Quantity { value, unit } => {
            (symdiff::Formula::number(unit.to_si(value)), unit.dimension.unit(), Some(unit.dimension))
        }
        Written::Formula(formula) => {
            let formula = with_outputs(reader, entry, all, formula)?;
            reader.check_names(node, &formula, 0, Context::Output).then_some(())?;
            let dimension = match reader.kind(node, &formula, 0) {
                KnownDimension::Known { dimension, .. } => Some(dimension),
                KnownDimension::Number(_) | KnownDimension::Any => None,
            };
            let natural = natural_unit(reader, &formula);
            let unit = natural.unwrap_or_else(|| dimension.map_or_else(String::new, Dimension::unit));
            (formula, unit, dimension)
        }
    };
    reader.refuse_like_names(node);
    if formula.names().next().is_none() {
        reader.error(Code::ConstantOutput, node.span.clone(), "constant output: it refers to no variable", None);
    }
    Some(Output { name: entry.key.clone(), formula, unit, dimension, of_results: false })
}

/// The unit of a formula that is just a name, where its dimension alone does not say it.
fn natural_unit(reader: &Reader, formula: &symdiff::Formula) -> Option<String> {
    let [(symdiff::formula::Term::Name(name), _)] = formula.terms() else { return None };
    match reader.model.symbol(name)? {
        Symbol::Energy(_) => Some("J".to_owned()),
        Symbol::Reaction { component, .. } if component.is_torque() => Some("N*m".to_owned()),
        Symbol::Parameter(index) => Some(reader.model.parameters[index].unit.clone()),
        _ => None,
    }
}

/// An output may be called like its source (`energy: energy`), but needs a plain name for files.
fn name_of_output(reader: &mut Reader, entry: &Entry) -> bool {
    crate::grammar::names::is_reserved(&entry.key) || reader.name(entry, "an output")
}

const FORMULATIONS: [(&str, Formulation); 3] =
    [("auto", Formulation::Auto), ("absolute", Formulation::Absolute), ("joint", Formulation::Joint)];

/// Reads `simulation:`.
pub fn simulation(reader: &mut Reader, fields: &Fields) -> Option<Simulation> {
    let positive = |reader: &mut Reader, key: &str| {
        let node = fields.get(key)?;
        let dimension = if key == "tolerance" { Dimension::NUMBER } else { Dimension::TIME };
        let value = reader.number(node, dimension)?;
        if value <= 0.0 {
            reader.error(
                Code::OutOfRange,
                node.span.clone(),
                format!("`{key}` must be positive, but is {value}"),
                None,
            );
            return None;
        }
        Some((value, node))
    };
    reader.required(fields, "duration");
    let duration = positive(reader, "duration");
    let step = positive(reader, "step");
    let tolerance = positive(reader, "tolerance");
    let output_step = positive(reader, "output_step");
    let alpha = match fields.get("alpha") {
        Some(node) => alpha(reader, node),
        None => Some(-0.1),
    };
    let formulation = match fields.get("formulation") {
        Some(node) => reader.choice(node, &FORMULATIONS),
        None => Some(Formulation::Auto),
    };
    let integration = super::scheme::read(reader, fields);
    if fields.get("step").is_some() && fields.get("tolerance").is_some() {
        let place = fields.key_span("tolerance");
        let diagnostic = Diagnostic::error(Code::ExclusiveKeys, place, "`step` and `tolerance` exclude each other");
        let help = "with a tolerance the steps are chosen as they are needed; leave one out".to_owned();
        reader.diagnostics.push(diagnostic.also(fields.key_span("step"), "the step").help(help));
    }
    let (duration, _) = duration?;
    let stepping = match (step, tolerance) {
        (_, Some((tolerance, _))) => Stepping::Tolerance(tolerance),
        (Some((step, node)), None) => {
            if step > duration {
                let message = format!("the step ({step} s) is longer than the duration ({duration} s)");
                reader.error(Code::BadTimes, node.span.clone(), message, None);
            } else if duration / step > TUNING.steps {
                let message = format!("{:.0e} steps are too many", duration / step);
                reader.error(
                    Code::TooLarge,
                    node.span.clone(),
                    message,
                    format!("a step of {:e} s makes 10000", duration / 1e4),
                );
            }
            Stepping::Fixed(step)
        }
        (None, None) => Stepping::Fixed(1e-3_f64.min(duration / 10.0)),
    };
    // Without steps, rows stand by themselves.
    let spaced_by = if reader.model.analysis.is_without_steps() { Stepping::Tolerance(1.0) } else { stepping };
    let output_step = match output_step {
        Some((output_step, node)) => {
            check_output_step(reader, node, output_step, duration, spaced_by);
            output_step
        }
        None => match spaced_by {
            Stepping::Fixed(step) => step * (duration / 200.0 / step).round().max(1.0),
            Stepping::Tolerance(_) => duration / 200.0,
        },
    };
    let (formulation, (scheme, extrapolation)) = (formulation?, integration?);
    Some(Simulation { duration, stepping, alpha: alpha?, output_step, formulation, scheme, extrapolation })
}

fn alpha(reader: &mut Reader, node: &Node) -> Option<f64> {
    let alpha = reader.number(node, Dimension::NUMBER)?;
    if let Some(message) = refused_alpha(alpha) {
        let help = if alpha == 0.0 {
            "α = 0 is unstable for index-3 equations at every step; the default is -0.1"
        } else {
            "the default is -0.1; nearer to 0 dissipates less, but 0 itself is unstable for index-3 equations"
        };
        reader.error(Code::OutOfRange, node.span.clone(), message, help.to_owned());
        return None;
    }
    Some(alpha.max(-1.0 / 3.0))
}

fn check_output_step(reader: &mut Reader, node: &Node, output_step: f64, duration: f64, stepping: Stepping) {
    if output_step > duration * (1.0 + 1e-9) {
        let message = format!("the output step ({output_step} s) is longer than the duration ({duration} s)");
        reader.error(Code::BadTimes, node.span.clone(), message, None);
    } else if duration / output_step > TUNING.rows {
        reader.error(
            Code::TooLarge,
            node.span.clone(),
            format!("{:.0e} rows of output are too many", duration / output_step),
            None,
        );
    } else if let Stepping::Fixed(step) = stepping {
        let steps = output_step / step;
        if steps < 1.0 - 1e-9 {
            let message = format!("the output step ({output_step} s) is shorter than the step ({step} s)");
            reader.error(Code::BadTimes, node.span.clone(), message, None);
        } else if (steps - steps.round()).abs() > 1e-9 * steps {
            let message = format!("the output step ({output_step} s) is not a whole multiple of the step ({step} s)");
            let help =
                format!("the nearest multiples are {} and {}", tidy(step * steps.floor()), tidy(step * steps.ceil()));
            reader.error(Code::BadTimes, node.span.clone(), message, help);
        }
    }
}

/// A number without the last digits' rounding.
fn tidy(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

/// Reads the whole section.
pub fn simulation_section(reader: &mut Reader, node: &Node, at: crate::syntax::source::Span) {
    if let Some(fields) = reader.fields::<keys::Simulation>(node, at)
        && let Some(simulation) = simulation(reader, &fields)
    {
        reader.model.simulation = simulation;
    }
}
