//! A mechanism as expressions: symbols, bodies, points and frames.

use std::cell::Cell;
use std::collections::{BTreeMap, HashMap};

use symdiff::{Builder, Expr, Scalar};

use super::inputs::{MechanismInput, RandomSymbols};
use super::names::DescriptionNames;
use super::questions::Questions;
use super::reaction::Reaction;
use super::superelement::Superelement;
use super::system::UncertainParameter;
use super::thrust::Thrust;
use super::tree::Tree;
use crate::elements::joints::ToothForce;
use crate::grammar::{Coordinate, JointCoordinate, OnJoint, PointRef, Sensor, TimeOrder};
use crate::model::{Joint, LineMass};
use crate::multibody::{ANGLE, Body, DEGREES_OF_FREEDOM, EULER, Frame, MaterialPoint, Pair, Quaternion, Vector};

/// Index of a coordinate in its body's list.
pub fn dof(coordinate: Coordinate) -> usize {
    match coordinate {
        Coordinate::X => 0,
        Coordinate::Y => 1,
        Coordinate::Z => 2,
        Coordinate::Angle => ANGLE,
        Coordinate::Euler(index) => EULER + index,
    }
}

/// A coordinate of a joint of a tree that formulas have no name for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelativeCoordinate {
    /// Angle about the first or the second axis of two, rad.
    Angle(usize),
    /// Displacement along the first or the second direction of a plane, m.
    Displacement(usize),
    /// Euler parameter p0 to p3 of the second frame against the first.
    Euler(usize),
}

/// The owner of one of q.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// A body.
    Body(usize, Coordinate),
    /// A joint: of a tree, or with a coordinate that a constraint defines, without inertia.
    Joint(usize, JointCoordinate),
    /// A joint of a tree; the coordinate has no name in formulas.
    Relative(usize, RelativeCoordinate),
    /// A mode of a flexible body.
    Mode,
    /// A state, which is the velocity of the coordinate.
    State,
}

impl Owner {
    /// Whether it is a length, of the mechanism's size. That of a mode is one times the square root of a mass.
    pub fn is_length(self) -> bool {
        match self {
            Self::Body(_, coordinate) => coordinate.is_length(),
            Self::Joint(_, coordinate) => coordinate == JointCoordinate::Displacement,
            Self::Relative(_, coordinate) => matches!(coordinate, RelativeCoordinate::Displacement(_)),
            Self::Mode => true,
            Self::State => false,
        }
    }

    /// Whether its velocity is a state.
    pub fn is_state(self) -> bool {
        self == Self::State
    }

    /// The coordinate's name among its owner's.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Body(_, Coordinate::X) => "x",
            Self::Body(_, Coordinate::Y) => "y",
            Self::Body(_, Coordinate::Z) => "z",
            Self::Body(_, Coordinate::Angle) | Self::Joint(_, JointCoordinate::Angle) => "angle",
            Self::Body(_, Coordinate::Euler(index)) | Self::Relative(_, RelativeCoordinate::Euler(index)) => {
                ["p0", "p1", "p2", "p3"][index]
            }
            Self::Relative(_, RelativeCoordinate::Angle(index)) => ["angle_1", "angle_2"][index],
            Self::Relative(_, RelativeCoordinate::Displacement(index)) => ["displacement_1", "displacement_2"][index],
            Self::Joint(_, JointCoordinate::Displacement) => "displacement",
            Self::Mode | Self::State => "",
        }
    }
}

/// A description's symbols and bodies; its reactions and potentials as the joints and effects are built.
pub struct Mechanism<'g, 'd> {
    /// The graph that expressions are added to.
    pub g: &'g Builder,
    /// The description with its questions.
    pub questions: &'d Questions<'d>,
    /// Meaning of the names in formulas.
    pub names: DescriptionNames<'d>,
    /// Whether it leaves the plane.
    pub is_spatial: bool,
    /// The joints.
    pub joints: &'d [Joint],
    /// The mass of beams between their nodes.
    pub line_masses: Vec<LineMass<'d>>,
    /// Flexible bodies by their matrices.
    pub superelements: Vec<Superelement<'d>>,
    /// t, s.
    pub time: Scalar<'g>,
    /// Excitations that are functions.
    pub inputs: Vec<MechanismInput<'g>>,
    /// Whether a formula names an excitation within limits.
    pub is_excited: Cell<bool>,
    /// Random excitations, where vibrations are asked for.
    pub random: Vec<RandomSymbols<'g>>,
    /// The parameters that are symbols.
    pub uncertain: Vec<UncertainParameter>,
    /// Indices in q of inboard joints' coordinates, with their guesses.
    pub child_guesses: Vec<(usize, f64)>,
    /// Whether those are of an assembled start, and take precedence over `guess`.
    pub starts_assembled: bool,
    /// All parameters: a symbol, or folded to a number or to an expression of symbols.
    pub parameters: Vec<Scalar<'g>>,
    /// Coordinates.
    pub q: Vec<Scalar<'g>>,
    /// Velocities.
    pub v: Vec<Scalar<'g>>,
    /// Accelerations.
    pub w: Vec<Scalar<'g>>,
    /// Owner of each of `q`.
    pub coordinates: Vec<Owner>,
    /// Name of each of `q`, e.g. `crank.angle`.
    pub coordinate_names: Vec<String>,
    /// Their frames and inertia.
    pub bodies: Vec<Body<'g>>,
    /// The trees of children in joint coordinates.
    pub tree: Tree,
    /// Indices in `q` of the coordinates of joints that are coordinates of their own.
    pub joint_coordinates: BTreeMap<(usize, JointCoordinate), usize>,
    /// Indices in the constraints of the normalisations of joints' Euler parameters, by joint.
    pub normalisations: BTreeMap<usize, usize>,
    /// Guessed poses of the bodies behind joints without names for their coordinates: x, y, z, then the Euler
    /// parameters.
    pub body_guesses: BTreeMap<usize, [f64; DEGREES_OF_FREEDOM]>,
    /// Reactions of the joints built so far.
    pub reactions: Vec<Reaction<'g>>,
    /// Multipliers of the same joints, for those with one constraint.
    pub multipliers: Vec<Option<Scalar<'g>>>,
    /// Forces between teeth, where a reaction depends on them.
    pub teeth: Vec<ToothForce<'g>>,
    /// Potential energies of the effects built so far, J.
    pub potentials: Vec<Scalar<'g>>,
    /// Kinetic energy of flexible bodies, J.
    pub kinetic_energy_of_flexible: Scalar<'g>,
    /// Indices in `q` of the coordinates whose velocities are states, by effect and index among its states.
    pub states: BTreeMap<(usize, usize), usize>,
    /// Indices in `q` of the modal coordinates, by effect and index among its modes.
    pub modes: BTreeMap<(usize, usize), usize>,
    /// Quantities that the effects built so far measure, and all states.
    pub sensors: BTreeMap<(usize, Sensor), Scalar<'g>>,
    /// The forces at points that each of the effects built so far applies.
    pub thrusts: Vec<Vec<Thrust<'g>>>,
}

impl<'g> Mechanism<'g, '_> {
    /// Symbols for one more coordinate of a body or joint called `name`; its index in q.
    pub fn add_coordinate(&mut self, owner: Owner, name: &str) -> usize {
        let name = match owner {
            Owner::Mode | Owner::State => name.to_owned(),
            _ => format!("{name}.{}", owner.suffix()),
        };
        // A joint may be called like a body.
        let prefix = match owner {
            Owner::Body(..) => "",
            Owner::Joint(..) | Owner::Relative(..) => "joint:",
            Owner::Mode => "mode:",
            Owner::State => "state:",
        };
        for (kind, list) in [("q", &mut self.q), ("v", &mut self.v), ("w", &mut self.w)] {
            list.push(self.g.variable(&format!("{kind}:{prefix}{name}")));
        }
        self.coordinates.push(owner);
        self.coordinate_names.push(name);
        self.q.len() - 1
    }

    /// Makes a joint's coordinate one of the mechanism's own; its index in q.
    pub fn add_joint_coordinate(&mut self, joint: usize, coordinate: JointCoordinate) -> usize {
        let index = self.add_coordinate(Owner::Joint(joint, coordinate), &self.joints[joint].name);
        self.joint_coordinates.insert((joint, coordinate), index);
        index
    }

    /// A joint's coordinate or its derivative. One that is not a coordinate of its own is an angle of the plane.
    pub fn joint_coordinate(&self, on: OnJoint, order: TimeOrder) -> Scalar<'g> {
        if let Some(&index) = self.joint_coordinates.get(&(on.joint, on.coordinate)) {
            let list = match order {
                TimeOrder::Position => &self.q,
                TimeOrder::Velocity => &self.v,
                TimeOrder::Acceleration => &self.w,
            };
            return list[index];
        }
        let Some(between) = self.joints[on.joint].kind.between() else { return self.g.number(0.0) };
        let [first, second] = between.map(|point| self.bodies[point.body].motion(order)[ANGLE]);
        second - first
    }

    /// A point in its body's frame.
    pub fn local(&self, point: PointRef) -> Vector<'g> {
        match point.point {
            Some(index) => self.bodies[point.body].points[index],
            None => Vector::zero(self.g),
        }
    }

    /// The rotation of the frame at a point against its body's.
    pub fn local_frame(&self, point: PointRef) -> Quaternion<'g> {
        let frame = point.point.and_then(|index| self.bodies[point.body].frames[index]);
        frame.unwrap_or_else(|| Quaternion::identity(self.g))
    }

    /// A point of a body in the ground's frame.
    pub fn point(&self, point: PointRef) -> MaterialPoint<'g> {
        self.point_at(point.body, self.local(point))
    }

    /// The point s = `local` of a body's frame in the ground's.
    pub fn point_at(&self, body: usize, local: Vector<'g>) -> MaterialPoint<'g> {
        let frame = &self.bodies[body];
        let arm = frame.rotate(local);
        MaterialPoint { body, arm, position: frame.position_of(arm), velocity: frame.velocity_of(arm) }
    }

    /// The point of a body that is now at a position in the ground's frame.
    pub fn point_now_at(&self, body: usize, position: Vector<'g>) -> MaterialPoint<'g> {
        let frame = &self.bodies[body];
        let arm = position - frame.origin();
        MaterialPoint { body, arm, position, velocity: frame.velocity_of(arm) }
    }

    /// The frame at a point of a body.
    pub fn frame(&self, point: PointRef) -> Frame<'g> {
        let body = &self.bodies[point.body];
        let orientation = body.orientation();
        let local = point.point.and_then(|index| body.frames[index]);
        let orientation = local.map_or(orientation, |local| orientation * local);
        Frame { point: self.point(point), orientation }
    }

    /// The frames at two points.
    pub fn pair(&self, between: [PointRef; 2]) -> Pair<'g> {
        let [first, second] = between.map(|point| self.frame(point));
        Pair { first, second }
    }

    /// Whether only parameters and t stand in the expressions.
    pub fn is_given(&self, expressions: &[Scalar<'g>]) -> bool {
        let given = |symbol: &Expr| {
            *symbol == self.time.expr() || self.uncertain.iter().any(|parameter| parameter.symbol == *symbol)
        };
        self.g.graph().symbols_of(&Scalar::exprs(expressions)).iter().all(given)
    }

    /// Values at the nominal parameters, t = 0 and, should they occur, zero coordinates.
    pub fn nominal<const N: usize>(&self, expressions: [Scalar<'g>; N]) -> [f64; N] {
        let values = self.sample(&expressions, 0.0, |parameter| parameter.nominal);
        std::array::from_fn(|index| values[index])
    }

    /// Values at chosen parameters and time.
    pub fn sample(
        &self,
        expressions: &[Scalar<'g>],
        time: f64,
        choose: impl Fn(&UncertainParameter) -> f64,
    ) -> Vec<f64> {
        let mut values: HashMap<Expr, f64> =
            self.uncertain.iter().map(|parameter| (parameter.symbol, choose(parameter))).collect();
        values.insert(self.time.expr(), time);
        let value = |symbol| values.get(&symbol).copied().unwrap_or(0.0);
        self.g.graph().evaluate(&Scalar::exprs(expressions), value)
    }
}
