//! Meaning of names in formulas: only this module determines it.

use std::ops::Range;

use super::dimension::KnownDimension;
use super::motions::{
    ANGULAR_MOTIONS, ATTITUDE, AXES, JOINT_MOTIONS, MOTIONS, Motion, joint_dimension, motion_dimension,
};
use super::quantity::Dimension;
use super::symbols::{Coordinate, EnergyKind, PointRef, ReactionComponent, Sensor, Symbol, SymbolTable, TimeOrder};

/// The ground's name.
pub const GROUND: &str = "ground";

/// Reserved names of energies.
pub const ENERGIES: [(&str, EnergyKind); 3] = [
    ("energy", EnergyKind::Total),
    ("kinetic_energy", EnergyKind::Kinetic),
    ("potential_energy", EnergyKind::Potential),
];

/// Separator of a joint and the point about which its reaction torque is taken.
const TORQUE_AT: &str = ".torque_at.";

/// Context of a formula, which decides the names it may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Context {
    /// Parameters only.
    #[default]
    Constant,
    /// Parameters and time.
    Time,
    /// Parameters, time, positions and states.
    Command,
    /// Parameters, time, positions and velocities.
    Effect,
    /// Parameters, time and positions.
    Equation,
    /// Everything.
    Output,
}

/// A name that is unknown, or not allowed here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameError {
    /// Description of the error.
    pub message: String,
    /// The part of the name that is wrong, in bytes.
    pub part: Range<usize>,
    /// Suggested correction.
    pub help: Option<String>,
}

/// Meaning of a word that is reserved in every formula; `None` for other words.
pub fn meaning(name: &str) -> Option<&'static str> {
    let is_function = |name| symdiff::formula::FUNCTIONS.iter().any(|own| own.name == name && own.is_reserved());
    match name {
        "t" => Some("the time"),
        "pi" => Some("the number π"),
        "and" | "or" | "not" => Some("an operator"),
        name if ENERGIES.iter().any(|(energy, _)| *energy == name) => Some("an energy of the mechanism"),
        name if is_function(name) => Some("a function"),
        _ => None,
    }
}

/// Whether a word is reserved in every formula.
pub fn is_reserved(name: &str) -> bool {
    meaning(name).is_some()
}

/// Symbol of a name in a formula; `None` if it is unknown.
pub fn symbol(table: &impl SymbolTable, name: &str) -> Option<Symbol> {
    if let Some(found) = of_robot(table, name) {
        return Some(found);
    }
    if let Some((joint, about)) = name.split_once(TORQUE_AT) {
        return torque_at(table, joint, about);
    }
    let mut parts = name.split('.');
    match (parts.next()?, parts.next(), parts.next(), parts.next()) {
        (name, None, ..) => word(table, name),
        (owner, Some(member), None, _) => body_motion(table, owner, member)
            .or_else(|| attitude(table, owner, member))
            .or_else(|| joint_motion(table, owner, member))
            .or_else(|| reaction(table, owner, member, None))
            .or_else(|| measure(table, owner, member))
            .or_else(|| trajectory(table, owner, member))
            .or_else(|| deviation(table, name))
            .or_else(|| state(table, name)),
        (owner, Some(member), Some(part), None) => point_motion(table, owner, member, part)
            .or_else(|| angular_motion(table, owner, member, part))
            .or_else(|| reaction(table, owner, member, Some(part)))
            .or_else(|| of_beam(table, name))
            .or_else(|| deviation(table, name))
            .or_else(|| of_instance(table, name)),
        _ => deviation(table, name).or_else(|| of_instance(table, name)),
    }
}

/// `front_left.upright.x`, `front_left.spring.force`, `front_left.hub.x`: of a part or a port of an instance.
fn of_instance(table: &impl SymbolTable, name: &str) -> Option<Symbol> {
    table.instances().next()?;
    if let Some(index) = table.parameter(name) {
        return Some(Symbol::Parameter(index));
    }
    if let Some(state) = state(table, name) {
        return Some(state);
    }
    let (owner, member) = name.rsplit_once('.')?;
    if let Some(port) = table.port(owner) {
        return symbol(table, &format!("{port}.{member}"));
    }
    let of_owner = body_motion(table, owner, member)
        .or_else(|| attitude(table, owner, member))
        .or_else(|| joint_motion(table, owner, member))
        .or_else(|| reaction(table, owner, member, None))
        .or_else(|| measure(table, owner, member));
    if of_owner.is_some() {
        return of_owner;
    }
    let (owner, part, member) = owner.rsplit_once('.').map(|(owner, part)| (owner, part, member))?;
    if let Some(port) = table.port(owner) {
        return symbol(table, &format!("{port}.{part}.{member}"));
    }
    point_motion(table, owner, part, member)
        .or_else(|| angular_motion(table, owner, part, member))
        .or_else(|| reaction(table, owner, part, Some(member)))
}

/// A body, a link, or a point of one, by its name: `front_left.upright.hub`, or a port that is one.
pub(super) fn place(table: &impl SymbolTable, name: &str) -> Option<PointRef> {
    let name = table.port(name).unwrap_or(name);
    if let Some(place) = table.link(name) {
        return Some(place);
    }
    if let Some(body) = table.body(name) {
        return Some(PointRef { body, point: None });
    }
    let (body, point) = point_of_body(table, name)?;
    Some(PointRef { body, point: Some(point) })
}

/// A point of a body, by both names: points of a link that is welded to another have the link's name in theirs.
fn point_of_body(table: &impl SymbolTable, name: &str) -> Option<(usize, usize)> {
    name.rmatch_indices('.').find_map(|(dot, _)| {
        let body = table.body(&name[..dot])?;
        let point = table.points(body).position(|known| known == &name[dot + 1..])?;
        Some((body, point))
    })
}

/// `s2.deviation`: deviation of a parameter from the value it follows. `body.arm.mass`: a number of a robot's file.
fn deviation(table: &impl SymbolTable, name: &str) -> Option<Symbol> {
    table.parameter(name).map(Symbol::Parameter)
}

/// `rod.end.x`, `rod.element1.torque`: quantities of a node or an element of a beam.
fn of_beam(table: &impl SymbolTable, name: &str) -> Option<Symbol> {
    let (owner, member) = name.rsplit_once('.')?;
    body_motion(table, owner, member).or_else(|| measure(table, owner, member))
}

/// A number of the URDF that is a parameter; `link.NAME.x` and `joint.NAME.angle`; or a part of the motion of a link
/// that is welded to another, and so a point.
fn of_robot(table: &impl SymbolTable, name: &str) -> Option<Symbol> {
    table.is_robot().then_some(())?;
    if let Some(index) = table.parameter(name) {
        return Some(Symbol::Parameter(index));
    }
    if let Some(rest) = name.strip_prefix("joint.") {
        let (joint, member) = rest.split_once('.')?;
        return match member.split_once('.') {
            None => joint_motion(table, joint, member).or_else(|| reaction(table, joint, member, None)),
            Some((member, part)) => reaction(table, joint, member, Some(part)),
        };
    }
    let rest = name.strip_prefix("link.").unwrap_or(name);
    let placed = |(owner, member)| Some((place(table, owner)?, member));
    let (place, member) = rest.rsplit_once('.').and_then(placed).or_else(|| rest.split_once('.').and_then(placed))?;
    let Some(point) = place.point else {
        // A body of that name: the usual way.
        return if rest.len() < name.len() { symbol(table, rest) } else { None };
    };
    let (_, coordinate, order) = motions(table, place.body).find(|(motion, ..)| *motion == member)?;
    coordinate.is_length().then_some(Symbol::Point { body: place.body, point, coordinate: *coordinate, order: *order })
}

/// The parts of a body's motion.
pub(super) fn motions(table: &impl SymbolTable, body: usize) -> impl Iterator<Item = &'static Motion<Coordinate>> {
    let spatial = table.is_spatial();
    let has_orientation = table.has_orientation(body);
    MOTIONS.iter().filter(move |(_, coordinate, _)| match coordinate {
        Coordinate::X | Coordinate::Y => true,
        Coordinate::Z => spatial,
        Coordinate::Angle => !has_orientation,
        Coordinate::Euler(_) => has_orientation,
    })
}

fn word(table: &impl SymbolTable, word: &str) -> Option<Symbol> {
    if word == "t" {
        return Some(Symbol::Time);
    }
    if let Some((_, kind)) = ENERGIES.iter().find(|(energy, _)| *energy == word) {
        return Some(Symbol::Energy(*kind));
    }
    let value = |trajectory| Symbol::Trajectory { trajectory, order: TimeOrder::Position };
    let parameter = table.parameter(word).map(Symbol::Parameter);
    let answer = || table.black_box(word).map(|output| Symbol::BlackBox { output });
    parameter.or_else(|| state(table, word)).or_else(|| table.trajectory(word).map(value)).or_else(answer)
}

/// Named parts of a trajectory: its derivatives.
pub(super) const OF_TRAJECTORY: [(&str, TimeOrder); 2] =
    [("rate", TimeOrder::Velocity), ("acceleration", TimeOrder::Acceleration)];

fn trajectory(table: &impl SymbolTable, owner: &str, member: &str) -> Option<Symbol> {
    let trajectory = table.trajectory(owner)?;
    let &(_, order) = OF_TRAJECTORY.iter().find(|(name, _)| *name == member)?;
    Some(Symbol::Trajectory { trajectory, order })
}

/// The value of a state, by its name alone.
fn state(table: &impl SymbolTable, name: &str) -> Option<Symbol> {
    measure_of(table, table.state(name)?, Sensor::VALUE.name())
}

fn body_motion(table: &impl SymbolTable, body: &str, member: &str) -> Option<Symbol> {
    let body = table.body(body)?;
    let (_, coordinate, order) = motions(table, body).find(|(motion, ..)| *motion == member)?;
    (body != 0).then_some(Symbol::Coordinate { body, coordinate: *coordinate, order: *order })
}

fn attitude(table: &impl SymbolTable, body: &str, member: &str) -> Option<Symbol> {
    let body = table.body(body)?;
    let angle = ATTITUDE.iter().position(|angle| *angle == member)?;
    table.has_orientation(body).then_some(Symbol::RollPitchYaw { body, angle })
}

fn angular_motion(table: &impl SymbolTable, body: &str, member: &str, part: &str) -> Option<Symbol> {
    let body = table.body(body)?;
    let &(_, in_body, order) = ANGULAR_MOTIONS.iter().find(|(vector, ..)| *vector == member)?;
    let axis = AXES.iter().position(|axis| *axis == part)?;
    (body != 0 && table.is_spatial()).then_some(Symbol::AngularMotion { body, axis, order, in_body })
}

fn point_motion(table: &impl SymbolTable, body: &str, point: &str, member: &str) -> Option<Symbol> {
    let body = table.body(body)?;
    let point = table.points(body).position(|known| known == point)?;
    let (_, coordinate, order) = motions(table, body).find(|(motion, ..)| *motion == member)?;
    coordinate.is_length().then_some(Symbol::Point { body, point, coordinate: *coordinate, order: *order })
}

fn joint_motion(table: &impl SymbolTable, joint: &str, member: &str) -> Option<Symbol> {
    let joint = table.joint(joint)?;
    let &(_, coordinate, order) = JOINT_MOTIONS.iter().find(|(motion, ..)| *motion == member)?;
    table.has_coordinate(joint, coordinate).then_some(Symbol::JointCoordinate { joint, coordinate, order })
}

/// Members of every joint that refer to its reaction.
pub const REACTIONS: [&str; 5] = ["force", "torque", "force_body", "torque_body", "torque_at"];

fn reaction(table: &impl SymbolTable, joint: &str, member: &str, part: Option<&str>) -> Option<Symbol> {
    let joint = table.joint(joint)?;
    let of_axis = match (member, part) {
        ("axial", None) | ("force", Some("axial")) => Some(ReactionComponent::Axial),
        ("radial", None) | ("force", Some("radial")) => Some(ReactionComponent::Radial),
        ("torque", Some("axial")) => Some(ReactionComponent::AxialTorque),
        _ => None,
    };
    if let Some(component) = of_axis {
        let has_it = match component {
            ReactionComponent::Axial => table.has_axial_force(joint),
            _ => table.has_axis(joint),
        };
        return has_it.then_some(Symbol::Reaction { joint, component });
    }
    let axis = match part {
        Some(part) => Some(AXES.iter().position(|axis| *axis == part)?),
        None => None,
    };
    let component = match (member, axis) {
        ("force", None) => ReactionComponent::Force,
        ("force", Some(axis)) if axis < 2 || table.is_spatial() => ReactionComponent::ForceAlong(axis),
        ("torque", None) => ReactionComponent::Torque,
        ("torque", Some(axis)) if table.is_spatial() => ReactionComponent::TorqueAbout(axis),
        ("force_body", Some(axis)) if (axis < 2 || table.is_spatial()) && table.has_place(joint) => {
            ReactionComponent::ForceInBody(axis)
        }
        ("torque_body", Some(axis)) if table.is_spatial() && table.has_place(joint) => {
            ReactionComponent::TorqueInBody(axis)
        }
        _ => return None,
    };
    Some(Symbol::Reaction { joint, component })
}

/// `joint.torque_at.body.point.x`: about any point of a body or the ground.
fn torque_at(table: &impl SymbolTable, joint: &str, about: &str) -> Option<Symbol> {
    let joint = table.joint(joint).filter(|&joint| table.has_place(joint))?;
    let (place, axis) = if table.is_spatial() {
        let (place, axis) = about.rsplit_once('.')?;
        (place, AXES.iter().position(|known| *known == axis)?)
    } else {
        (about, 2)
    };
    let place = self::place(table, place)?;
    Some(Symbol::Reaction { joint, component: ReactionComponent::TorqueAt(place, axis) })
}

fn measure(table: &impl SymbolTable, effect: &str, member: &str) -> Option<Symbol> {
    measure_of(table, table.effect(effect)?, member)
}

fn measure_of(table: &impl SymbolTable, effect: usize, member: &str) -> Option<Symbol> {
    let measures = table.measures(effect).into_iter().map(|(measure, _)| measure);
    let thrusts = Sensor::THRUSTS.into_iter().flatten();
    let measure = measures.chain(thrusts).find(|measure| measure.name() == member)?;
    Some(Symbol::Sensor { effect, measure })
}

/// Returns the symbol of a name, or an error if the context does not allow it.
pub fn allowed(name: &str, symbol: Symbol, context: Context) -> Result<Symbol, NameError> {
    let refusal = match (context, symbol) {
        (Context::Output, _) | (_, Symbol::Parameter(_)) => None,
        (Context::Constant, Symbol::Time | Symbol::Trajectory { .. }) => {
            Some("only parameters can stand here: this value cannot change in time")
        }
        (Context::Constant, _) => Some("only parameters can stand here: this value cannot change with the motion"),
        (_, Symbol::Time | Symbol::Trajectory { .. }) => None,
        (Context::Time, _) => Some("only parameters and t can stand here: this value does not follow the motion"),
        (_, Symbol::Reaction { .. }) => Some("reactions are known only when the motion is; only outputs may use them"),
        (_, Symbol::Energy(_)) => Some("only outputs may use energies"),
        (_, Symbol::BlackBox { .. }) => Some("only outputs may use answers of a black box"),
        (Context::Effect, Symbol::Sensor { measure, .. }) if measure.is_motion() => None,
        (Context::Command, Symbol::Sensor { measure, .. })
            if measure.is_motion() && measure.name() == Sensor::VALUE.name() =>
        {
            None
        }
        (Context::Command, Symbol::Sensor { .. }) => {
            Some("a speed is one of t, positions and states: write this as a state, or let a `filter` follow it")
        }
        (Context::Equation, Symbol::Sensor { measure, .. }) if measure.is_motion() => Some(
            "a joint constrains positions, which no state gives: let a `servo` follow it, or the `speed` of a motor",
        ),
        (_, Symbol::Sensor { .. }) => {
            Some("forces of an effect are known only with the motion; only outputs may use them")
        }
        (_, Symbol::RollPitchYaw { .. }) => {
            Some("these angles jump by a turn, so only outputs may use them; a joint's `angle` does not")
        }
        (
            _,
            Symbol::Coordinate { order, .. }
            | Symbol::Point { order, .. }
            | Symbol::AngularMotion { order, .. }
            | Symbol::JointCoordinate { order, .. },
        ) => match (context, order) {
            (_, TimeOrder::Position) | (Context::Effect, TimeOrder::Velocity) => None,
            (Context::Command, TimeOrder::Velocity) => {
                Some("a speed is one of t, positions and states: let a `filter` follow the velocity")
            }
            (Context::Equation, TimeOrder::Velocity) => {
                Some("an equation constrains positions, so it cannot use velocities")
            }
            _ => Some("accelerations are known only when the motion is; only outputs may use them"),
        },
    };
    match refusal {
        None => Ok(symbol),
        Some(reason) => Err(NameError {
            message: format!("`{name}` cannot stand here"),
            part: 0..name.len(),
            help: Some(reason.to_owned()),
        }),
    }
}

/// The dimension of a symbol; `parameters` has those of the parameters. The reader knows those of reactions of
/// equations, trajectories, black boxes and measures of effects.
pub fn kind(symbol: Symbol, parameters: &[KnownDimension]) -> KnownDimension {
    KnownDimension::motion(match symbol {
        Symbol::Parameter(index) => return parameters.get(index).copied().unwrap_or(KnownDimension::Any),
        Symbol::Time => Dimension::TIME,
        Symbol::Coordinate { coordinate, order, .. } | Symbol::Point { coordinate, order, .. } => {
            motion_dimension(coordinate, order)
        }
        Symbol::AngularMotion { order, .. } => motion_dimension(Coordinate::Angle, order),
        Symbol::RollPitchYaw { .. } => Dimension::ANGLE,
        Symbol::JointCoordinate { coordinate, order, .. } => joint_dimension(coordinate, order),
        Symbol::Reaction { component, .. } if component.is_torque() => Dimension::TORQUE,
        Symbol::Energy(_) => Dimension::TORQUE,
        Symbol::Reaction { .. } => Dimension::FORCE,
        Symbol::Sensor { .. } | Symbol::Trajectory { .. } | Symbol::BlackBox { .. } => return KnownDimension::Any,
    })
}
