//! The symbols of a mechanism, and what a formula's names mean in them.

use std::collections::{BTreeMap, HashMap};

use symdiff::{Builder, Expr, Formula, Scalar};

use crate::elements::joints::Mobilizer;
use crate::model::{
    self, Coordinate, Description, JointCoordinate, ParameterValue, PointRef, Rotation, Sensor, Symbol, TimeOrder,
};

use super::body::{ANGLE, Body, DEGREES_OF_FREEDOM, EULER, MaterialPoint, RotationCoordinates};
use super::error::BuildError;
use super::joints::Reaction;
use super::rotation::{self, Quaternion};
use super::space::{self, Vector};
use super::system::UncertainParameter;
use super::tree::Tree;
use crate::multibody::Pair;
pub use crate::multibody::{Context, Frame};

impl Context {
    /// The smallest context in which something is known.
    pub(super) fn of(symbol: Symbol) -> Self {
        match symbol {
            Symbol::Parameter(_) => Self::Parameters,
            Symbol::Time => Self::Time,
            Symbol::Coordinate { order, .. }
            | Symbol::Point { order, .. }
            | Symbol::AngularMotion { order, .. }
            | Symbol::JointCoordinate { order, .. } => match order {
                TimeOrder::Position => Self::Positions,
                TimeOrder::Velocity => Self::Motion,
                TimeOrder::Acceleration => Self::Everything,
            },
            Symbol::RollPitchYaw { .. } => Self::Positions,
            Symbol::Reaction { .. } => Self::Motion,
            Symbol::Sensor { measure, .. } if measure.is_motion() => Self::Motion,
            Symbol::Sensor { .. } | Symbol::Energy(_) => Self::Everything,
        }
    }
}

/// A coordinate's place in its body's list.
pub fn dof(coordinate: Coordinate) -> usize {
    match coordinate {
        Coordinate::X => 0,
        Coordinate::Y => 1,
        Coordinate::Z => 2,
        Coordinate::Angle => ANGLE,
        Coordinate::Euler(index) => EULER + index,
    }
}

/// What one of q is a coordinate of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// Of a body.
    Body(usize, Coordinate),
    /// Of a joint: defined by a constraint, without inertia.
    Joint(usize, JointCoordinate),
}

impl Owner {
    /// Whether it is a length.
    pub fn is_length(self) -> bool {
        match self {
            Self::Body(_, coordinate) => coordinate.is_length(),
            Self::Joint(_, coordinate) => coordinate == JointCoordinate::Displacement,
        }
    }
}

/// A description's symbols and bodies; its reactions and potentials as the joints and effects are built.
pub struct Mechanism<'d> {
    pub description: &'d Description,
    pub time: Expr,
    pub uncertain: Vec<UncertainParameter>,
    /// All parameters: a symbol, or folded to a number or to an expression of symbols.
    pub parameters: Vec<Expr>,
    pub q: Vec<Expr>,
    pub v: Vec<Expr>,
    pub w: Vec<Expr>,
    /// What each of `q` is.
    pub coordinates: Vec<Owner>,
    pub bodies: Vec<Body>,
    /// Which bodies joints carry.
    pub tree: Tree,
    /// Places in `q` of the coordinates of joints that are coordinates of their own.
    pub joint_coordinates: BTreeMap<(usize, JointCoordinate), usize>,
    /// Of the joints built so far.
    pub reactions: Vec<Reaction>,
    /// Potential energies of the effects built so far, J.
    pub potentials: Vec<Expr>,
    /// Kinetic energy of what is no rigid body, J.
    pub bending: Expr,
    /// What the effects built so far measure.
    pub measures: BTreeMap<(usize, Sensor), Expr>,
}

impl<'d> Mechanism<'d> {
    /// The symbols and bodies of a description; with `carry`, as many bodies as can be are carried by their joints.
    pub fn new(g: &Builder, description: &'d Description, carry: bool) -> Result<Self, BuildError> {
        let time = g.symbol("t");
        let mut mechanism = Self {
            description,
            time,
            uncertain: Vec::new(),
            parameters: Vec::new(),
            q: Vec::new(),
            v: Vec::new(),
            w: Vec::new(),
            coordinates: Vec::new(),
            bodies: Vec::new(),
            tree: Tree::absolute(description),
            joint_coordinates: BTreeMap::new(),
            reactions: Vec::new(),
            potentials: Vec::new(),
            bending: g.constant(0.0),
            measures: BTreeMap::new(),
        };
        for parameter in &description.parameters {
            let expr = match &parameter.value {
                ParameterValue::Formula(formula) => mechanism.formula(g, formula, Context::Parameters)?,
                &ParameterValue::Interval { nominal, lower, upper } => {
                    let symbol = g.symbol(&format!("p:{}", parameter.name));
                    let (name, unit) = (parameter.name.clone(), parameter.unit.clone());
                    mechanism.uncertain.push(UncertainParameter { name, unit, symbol, nominal, lower, upper });
                    symbol
                }
            };
            mechanism.parameters.push(expr);
        }
        if carry {
            mechanism.tree = Tree::spanning(description, |mobilizer| mechanism.is_time_independent(g, mobilizer));
        }
        for (index, body) in description.bodies.iter().enumerate() {
            let body = mechanism.body(g, index, body)?;
            mechanism.bodies.push(body);
        }
        for body in mechanism.tree.order.clone() {
            if let Some(carrier) = mechanism.tree.carriers[body] {
                mechanism.carry(g, body, carrier)?;
            }
        }
        mechanism.merge(g);
        for (joint, coordinate) in super::coordinates::called_for(description) {
            if !mechanism.joint_coordinates.contains_key(&(joint, coordinate)) {
                let index = mechanism.add_coordinate(g, Owner::Joint(joint, coordinate));
                mechanism.joint_coordinates.insert((joint, coordinate), index);
            }
        }
        Ok(mechanism)
    }

    /// Whether a mobilizer does not depend on t.
    pub fn is_time_independent(&self, g: &Builder, mobilizer: &Mobilizer) -> bool {
        mobilizer.formulas().all(|formula| self.formula(g, formula, Context::Parameters).is_ok())
    }

    fn body(&mut self, g: &Builder, index: usize, body: &model::Body) -> Result<Body, BuildError> {
        let zero = g.constant(0.0);
        let turn = if body.has_orientation() { RotationCoordinates::Euler } else { RotationCoordinates::Angle };
        let mut built = Body {
            turn,
            position: [zero; DEGREES_OF_FREEDOM],
            velocity: [zero; DEGREES_OF_FREEDOM],
            acceleration: [zero; DEGREES_OF_FREEDOM],
            index: [None; DEGREES_OF_FREEDOM],
            carried: None,
            attitude: None,
            mass: match &body.mass {
                Some(mass) => self.formula(g, mass, Context::Parameters)?,
                None => zero,
            },
            inertia: self.inertia(g, body, turn)?,
            center: match &body.center_of_mass {
                Some(center) => self.vector(g, center, Context::Parameters)?,
                None => [zero; 3],
            },
            points: Vec::with_capacity(body.points.len()),
            frames: Vec::with_capacity(body.points.len()),
        };
        if turn == RotationCoordinates::Euler {
            let held = match &body.held_orientation {
                Some(rotation) => self.rotation(g, rotation)?,
                None => rotation::identity(g),
            };
            built.position[EULER..].copy_from_slice(&held);
        }
        let carried = self.tree.carriers[index].is_some();
        for &coordinate in body.coordinates.iter().filter(|_| !carried) {
            let dof = dof(coordinate);
            let index = self.add_coordinate(g, Owner::Body(index, coordinate));
            built.index[dof] = Some(index);
            built.position[dof] = self.q[index];
            built.velocity[dof] = self.v[index];
            built.acceleration[dof] = self.w[index];
        }
        for (coordinate, value) in &body.held {
            let dof = dof(*coordinate);
            let value = self.formula(g, value, Context::Time)?;
            built.position[dof] = value;
            built.velocity[dof] = g.derivative(value, self.time);
            built.acceleration[dof] = g.derivative(built.velocity[dof], self.time);
        }
        for point in &body.points {
            built.points.push(self.vector(g, &point.position, Context::Parameters)?);
            let frame = point.rotation.as_ref().map(|rotation| self.rotation(g, rotation)).transpose()?;
            built.frames.push(frame);
        }
        Ok(built)
    }

    /// Whether the mechanism leaves the plane.
    pub fn is_spatial(&self) -> bool {
        self.description.space.spatial
    }

    /// Symbols for one more coordinate; its place in q.
    pub fn add_coordinate(&mut self, g: &Builder, owner: Owner) -> usize {
        let name = match owner {
            Owner::Body(..) => self.coordinate_name(owner),
            // A joint may be called like a body.
            Owner::Joint(..) => format!("joint:{}", self.coordinate_name(owner)),
        };
        for (kind, list) in [("q", &mut self.q), ("v", &mut self.v), ("w", &mut self.w)] {
            list.push(g.symbol(&format!("{kind}:{name}")));
        }
        self.coordinates.push(owner);
        self.q.len() - 1
    }

    /// J; of a body that turns about z only, no more than J_zz.
    fn inertia(&self, g: &Builder, body: &model::Body, turn: RotationCoordinates) -> Result<[Vector; 3], BuildError> {
        let mut tensor = [space::zero(g); 3];
        let Some(inertia) = &body.inertia else { return Ok(tensor) };
        let model::Inertia { xx, yy, zz, xy, xz, yz } = inertia;
        let elements: &[(usize, usize, &Formula)] = match turn {
            RotationCoordinates::Angle => &[(2, 2, zz)],
            RotationCoordinates::Euler => &[(0, 0, xx), (1, 1, yy), (2, 2, zz), (0, 1, xy), (0, 2, xz), (1, 2, yz)],
        };
        for &(row, column, element) in elements {
            let element = self.formula(g, element, Context::Parameters)?;
            (tensor[row][column], tensor[column][row]) = (element, element);
        }
        Ok(tensor)
    }

    /// Name of a coordinate, e.g. `crank.angle`.
    pub fn coordinate_name(&self, owner: Owner) -> String {
        match owner {
            Owner::Body(body, coordinate) => {
                let name = match coordinate {
                    Coordinate::X => "x",
                    Coordinate::Y => "y",
                    Coordinate::Z => "z",
                    Coordinate::Angle => "angle",
                    Coordinate::Euler(index) => ["p0", "p1", "p2", "p3"][index],
                };
                format!("{}.{name}", self.description.bodies[body].name)
            }
            Owner::Joint(joint, coordinate) => {
                let name = match coordinate {
                    JointCoordinate::Angle => "angle",
                    JointCoordinate::Displacement => "displacement",
                };
                format!("{}.{name}", self.description.joints[joint].name)
            }
        }
    }

    /// A formula as an expression: the one place where names become expressions.
    pub fn formula(&self, g: &Builder, formula: &Formula, context: Context) -> Result<Expr, BuildError> {
        let built = formula.build(g, |name| match self.description.symbol(name) {
            Some(symbol) if Context::of(symbol) <= context => Ok(g.scalar(self.observe(g, symbol))),
            _ => Err(BuildError::Name { name: name.to_owned(), allowed: context }),
        });
        built.map(Scalar::expr)
    }

    /// A formula of an effect, which may speak of what the effect measures itself.
    pub fn own_formula(&self, g: &Builder, formula: &Formula, own: &[(Sensor, Expr)]) -> Result<Expr, BuildError> {
        let built = formula.build(g, |name| match self.description.symbol(name) {
            Some(Symbol::Sensor { effect, measure }) if !self.measures.contains_key(&(effect, measure)) => {
                let found = own.iter().find(|(known, _)| *known == measure).map(|&(_, expr)| g.scalar(expr));
                found.ok_or_else(|| BuildError::Name { name: name.to_owned(), allowed: Context::Motion })
            }
            Some(symbol) if Context::of(symbol) <= Context::Motion => Ok(g.scalar(self.observe(g, symbol))),
            _ => Err(BuildError::Name { name: name.to_owned(), allowed: Context::Motion }),
        });
        built.map(Scalar::expr)
    }

    /// Three formulas as a vector.
    pub fn vector(&self, g: &Builder, formulas: &[Formula; 3], context: Context) -> Result<Vector, BuildError> {
        let [x, y, z] = formulas;
        Ok([self.formula(g, x, context)?, self.formula(g, y, context)?, self.formula(g, z, context)?])
    }

    /// A rotation of parameters as Euler parameters of length 1.
    pub fn rotation(&self, g: &Builder, rotation: &Rotation) -> Result<Quaternion, BuildError> {
        match rotation {
            Rotation::RollPitchYaw(angles) => {
                let angles = self.vector(g, angles, Context::Parameters)?;
                Ok(rotation::roll_pitch_yaw(g, angles))
            }
            Rotation::AxisAngle(axis, angle) => {
                let axis = self.vector(g, axis, Context::Parameters)?;
                let axis = space::unit(g, axis);
                let angle = self.formula(g, angle, Context::Parameters)?;
                Ok(rotation::about(g, axis, angle))
            }
            Rotation::Quaternion([p0, p1, p2, p3]) => {
                let scalar = self.formula(g, p0, Context::Parameters)?;
                let vector = [p1, p2, p3].map(|p| self.formula(g, p, Context::Parameters));
                let [p1, p2, p3] = vector;
                Ok(rotation::normalised(g, [scalar, p1?, p2?, p3?]))
            }
        }
    }

    /// A point in its body's frame.
    pub fn local(&self, g: &Builder, point: PointRef) -> Vector {
        match point.point {
            Some(index) => self.bodies[point.body].points[index],
            None => space::zero(g),
        }
    }

    /// A point of a body in the ground's frame.
    pub fn point(&self, g: &Builder, point: PointRef) -> MaterialPoint {
        let local = self.local(g, point);
        self.point_at(g, point.body, local)
    }

    /// The point s = `local` of a body's frame in the ground's.
    pub fn point_at(&self, g: &Builder, body: usize, local: Vector) -> MaterialPoint {
        let frame = &self.bodies[body];
        let arm = frame.rotate(g, local);
        let position = frame.position_of(g, arm);
        let velocity = frame.velocity_of(g, arm);
        MaterialPoint { body, arm, position, velocity }
    }

    /// The point of a body that is at a place of the ground just now.
    pub fn carried_along(&self, g: &Builder, body: usize, position: Vector) -> MaterialPoint {
        let frame = &self.bodies[body];
        let arm = space::sub(g, position, frame.origin());
        let velocity = frame.velocity_of(g, arm);
        MaterialPoint { body, arm, position, velocity }
    }

    /// The frame at a point of a body.
    pub fn frame(&self, g: &Builder, point: PointRef) -> Frame {
        let body = &self.bodies[point.body];
        let orientation = body.orientation(g);
        let local = point.point.and_then(|index| body.frames[index]);
        let orientation = match local {
            Some(local) => rotation::product(g, orientation, local),
            None => orientation,
        };
        Frame { point: self.point(g, point), orientation }
    }

    /// The frames at two points.
    pub fn pair(&self, g: &Builder, between: [PointRef; 2]) -> Pair {
        let [first, second] = between.map(|point| self.frame(g, point));
        Pair { first, second }
    }

    /// Whether only parameters and t stand in the expressions.
    pub fn is_given(&self, g: &Builder, exprs: &[Expr]) -> bool {
        let given =
            |symbol: &Expr| *symbol == self.time || self.uncertain.iter().any(|parameter| parameter.symbol == *symbol);
        g.symbols_of(exprs).iter().all(given)
    }

    /// Values at the nominal parameters, t = 0 and, should they occur, zero coordinates.
    pub fn nominal(&self, g: &Builder, exprs: &[Expr]) -> Vec<f64> {
        self.sample(g, exprs, 0.0, |parameter| parameter.nominal)
    }

    /// Values at chosen parameters and time.
    pub fn sample(
        &self,
        g: &Builder,
        exprs: &[Expr],
        time: f64,
        choose: impl Fn(&UncertainParameter) -> f64,
    ) -> Vec<f64> {
        let mut values: HashMap<Expr, f64> =
            self.uncertain.iter().map(|parameter| (parameter.symbol, choose(parameter))).collect();
        values.insert(self.time, time);
        g.evaluate(exprs, |symbol| values.get(&symbol).copied().unwrap_or(0.0))
    }
}
