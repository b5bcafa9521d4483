//! The symbols of a mechanism, and what a formula's names mean in them.

use std::collections::HashMap;
use std::fmt;

use symdiff::{Expr, Formula, Graph};

use crate::model::{self, Coordinate, Description, ParameterValue, PointRef, Referent, TimeOrder};

use super::body::{Body, FREEDOMS, MaterialPoint};
use super::error::BuildError;
use super::joints::Reaction;
use super::plane::{self, Vector};
use super::system::UncertainParameter;

/// What a formula may speak of; each includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Context {
    /// Masses, points, values at the start.
    Parameters,
    /// Held coordinates, and numbers of joints (drivers).
    Time,
    /// Constraints: Φ(q, t).
    Positions,
    /// Effects: Q(t, q, v, λ).
    Motion,
    /// Outputs.
    Everything,
}

impl fmt::Display for Context {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Parameters => "parameters",
            Self::Time => "parameters and t",
            Self::Positions => "parameters, t and positions",
            Self::Motion => "parameters, t, positions, velocities and reactions",
            Self::Everything => "all that is observed",
        })
    }
}

impl Context {
    /// The smallest context in which something is known.
    fn of(referent: Referent) -> Self {
        match referent {
            Referent::Parameter(_) => Self::Parameters,
            Referent::Time => Self::Time,
            Referent::Coordinate { order, .. } | Referent::Point { order, .. } => match order {
                TimeOrder::Position => Self::Positions,
                TimeOrder::Velocity => Self::Motion,
                TimeOrder::Acceleration => Self::Everything,
            },
            Referent::Reaction { .. } => Self::Motion,
            Referent::Energy(_) => Self::Everything,
        }
    }
}

/// Position of a coordinate among a body's three.
pub fn freedom(coordinate: Coordinate) -> usize {
    match coordinate {
        Coordinate::X => 0,
        Coordinate::Y => 1,
        Coordinate::Angle => super::body::ANGLE,
    }
}

/// A coordinate's name in formulas.
fn coordinate_name(coordinate: Coordinate) -> &'static str {
    match coordinate {
        Coordinate::X => "x",
        Coordinate::Y => "y",
        Coordinate::Angle => "angle",
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
    /// Body and coordinate behind each of `q`.
    pub coordinates: Vec<(usize, Coordinate)>,
    pub bodies: Vec<Body>,
    /// Of the joints built so far.
    pub reactions: Vec<Reaction>,
    /// Potential energies of the effects built so far, J.
    pub potentials: Vec<Expr>,
}

impl<'d> Mechanism<'d> {
    /// The symbols and bodies of a description.
    pub fn new(g: &mut Graph, description: &'d Description) -> Result<Self, BuildError> {
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
            reactions: Vec::new(),
            potentials: Vec::new(),
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
        for (index, body) in description.bodies.iter().enumerate() {
            let body = mechanism.body(g, index, body)?;
            mechanism.bodies.push(body);
        }
        Ok(mechanism)
    }

    fn body(&mut self, g: &mut Graph, index: usize, body: &model::Body) -> Result<Body, BuildError> {
        let zero = g.constant(0.0);
        let mut built = Body {
            position: [zero; FREEDOMS],
            velocity: [zero; FREEDOMS],
            acceleration: [zero; FREEDOMS],
            index: [None; FREEDOMS],
            mass: self.optional(g, body.mass.as_ref())?,
            inertia: self.optional(g, body.inertia.as_ref())?,
            center: match &body.center_of_mass {
                Some(center) => self.vector(g, center, Context::Parameters)?,
                None => plane::zero(g),
            },
            points: Vec::with_capacity(body.points.len()),
        };
        for &coordinate in &body.coordinates {
            let freedom = freedom(coordinate);
            let name = self.coordinate_name(index, coordinate);
            let symbols = ["q", "v", "w"].map(|kind| g.symbol(&format!("{kind}:{name}")));
            [built.position[freedom], built.velocity[freedom], built.acceleration[freedom]] = symbols;
            built.index[freedom] = Some(self.q.len());
            for (list, symbol) in [&mut self.q, &mut self.v, &mut self.w].into_iter().zip(symbols) {
                list.push(symbol);
            }
            self.coordinates.push((index, coordinate));
        }
        for (coordinate, value) in &body.held {
            let freedom = freedom(*coordinate);
            let value = self.formula(g, value, Context::Time)?;
            built.position[freedom] = value;
            built.velocity[freedom] = g.derivative(value, self.time);
            built.acceleration[freedom] = g.derivative(built.velocity[freedom], self.time);
        }
        for point in &body.points {
            built.points.push(self.vector(g, &point.position, Context::Parameters)?);
        }
        Ok(built)
    }

    fn optional(&self, g: &mut Graph, formula: Option<&Formula>) -> Result<Expr, BuildError> {
        match formula {
            Some(formula) => self.formula(g, formula, Context::Parameters),
            None => Ok(g.constant(0.0)),
        }
    }

    /// Name of a coordinate, e.g. `crank.angle`.
    pub fn coordinate_name(&self, body: usize, coordinate: Coordinate) -> String {
        format!("{}.{}", self.description.bodies[body].name, coordinate_name(coordinate))
    }

    /// A formula as an expression: the one place where names become expressions.
    pub fn formula(&self, g: &mut Graph, formula: &Formula, context: Context) -> Result<Expr, BuildError> {
        formula.build(g, |g, name| match self.description.referent(name) {
            Some(referent) if Context::of(referent) <= context => Ok(self.observe(g, referent)),
            _ => Err(BuildError::Name { name: name.to_owned(), allowed: context }),
        })
    }

    /// Two formulas as a vector.
    pub fn vector(&self, g: &mut Graph, formulas: &[Formula; 2], context: Context) -> Result<Vector, BuildError> {
        Ok([self.formula(g, &formulas[0], context)?, self.formula(g, &formulas[1], context)?])
    }

    /// A point in its body's frame.
    pub fn local(&self, g: &mut Graph, point: PointRef) -> Vector {
        match point.point {
            Some(index) => self.bodies[point.body].points[index],
            None => plane::zero(g),
        }
    }

    /// A point of a body in the ground's frame.
    pub fn point(&self, g: &mut Graph, point: PointRef) -> MaterialPoint {
        let local = self.local(g, point);
        self.point_at(g, point.body, local)
    }

    /// The point s = `local` of a body's frame in the ground's.
    pub fn point_at(&self, g: &mut Graph, body: usize, local: Vector) -> MaterialPoint {
        let frame = &self.bodies[body];
        let arm = frame.rotate(g, local);
        let position = frame.position_of(g, arm);
        let velocity = frame.velocity_of(g, arm);
        MaterialPoint { body, arm, position, velocity }
    }

    /// Whether only parameters and t stand in the expressions.
    pub fn is_given(&self, g: &Graph, exprs: &[Expr]) -> bool {
        let given =
            |symbol: &Expr| *symbol == self.time || self.uncertain.iter().any(|parameter| parameter.symbol == *symbol);
        g.symbols_of(exprs).iter().all(given)
    }

    /// Values at the nominal parameters, t = 0 and, should they occur, zero coordinates.
    pub fn nominal(&self, g: &Graph, exprs: &[Expr]) -> Vec<f64> {
        self.sample(g, exprs, 0.0, |parameter| parameter.nominal)
    }

    /// Values at chosen parameters and time.
    pub fn sample(
        &self,
        g: &Graph,
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
