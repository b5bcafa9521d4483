//! Joints in a mechanism: what their constraints are written in, their axes, and their reactions.

use symdiff::{Builder, Expr, Formula, Scalar, Unary};

use crate::elements::joints::{Joint, Kinematics, Row};
use crate::grammar::{JointCoordinate, OfAngle, OnJoint, PointRef, TimeOrder};
use crate::multibody::{Pair, Vector as Handle};

use super::body::ANGLE;
use super::error::BuildError;
use super::mechanism::{Context, Mechanism};
use super::space::{self, Vector};

/// A joint's reaction on its second body, in the ground's axes.
#[derive(Clone, Copy, Debug)]
pub struct Reaction {
    /// N
    pub force: Vector,
    /// |force|, N; for an `equation` its multiplier.
    pub magnitude: Expr,
    /// About the second point, N m.
    pub torque: Vector,
    /// About the joint's axis, N m, where the torque cannot be about another and there is no force: of motors and gears.
    pub about_axis: Option<Expr>,
}

/// A joint's constraints.
pub fn rows<'g>(g: &'g Builder, m: &Mechanism, joint: usize) -> Result<Vec<Row<'g>>, BuildError> {
    m.description.joints[joint].kind.rows(joint, &Position { g, m })
}

/// The positions of a mechanism, in a graph.
struct Position<'g, 'm, 'd> {
    g: &'g Builder,
    m: &'m Mechanism<'d>,
}

impl<'g> Kinematics<'g> for Position<'g, '_, '_> {
    fn graph(&self) -> &'g Builder {
        self.g
    }

    fn is_spatial(&self) -> bool {
        self.m.is_spatial()
    }

    fn time(&self) -> Scalar<'g> {
        self.g.scalar(self.m.time)
    }

    fn number(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError> {
        self.m.formula(self.g, formula, Context::Time).map(|expr| self.g.scalar(expr))
    }

    fn of_positions(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError> {
        self.m.formula(self.g, formula, Context::Positions).map(|expr| self.g.scalar(expr))
    }

    fn of_angle(&self, formula: &OfAngle, angle: Scalar<'g>) -> Result<[Scalar<'g>; 2], BuildError> {
        // A name that no file can give to anything else.
        let variable = self.g.variable("own:angle");
        let value = formula.0.build(self.g, |name| match self.m.description.symbol(name) {
            _ if name == OfAngle::VARIABLE => Ok(variable),
            Some(symbol) if Context::of(symbol) <= Context::Time => Ok(self.g.scalar(self.m.observe(self.g, symbol))),
            _ => Err(BuildError::Name { name: name.to_owned(), allowed: Context::Time }),
        })?;
        let roots = [value.expr(), value.derivative(variable).expr()];
        let at = std::iter::once((variable.expr(), angle.expr())).collect();
        let substituted = self.g.with(|graph| graph.substitute(&roots, &at));
        Ok([self.g.scalar(substituted[0]), self.g.scalar(substituted[1])])
    }

    fn unit_vector(&self, direction: &[Formula; 3]) -> Result<Handle<'g>, BuildError> {
        let direction = self.m.vector(self.g, direction, Context::Time)?;
        Ok(Handle::of(self.g, direction).unit())
    }

    fn points(&self, between: [PointRef; 2]) -> [Handle<'g>; 2] {
        between.map(|point| Handle::of(self.g, self.m.point(self.g, point).position))
    }

    fn pair(&self, between: [PointRef; 2]) -> Pair {
        self.m.pair(self.g, between)
    }

    fn rotated(&self, body: usize, vector: Handle<'g>) -> Handle<'g> {
        Handle::of(self.g, self.m.bodies[body].rotate(self.g, vector.exprs()))
    }

    fn angle(&self, body: usize) -> Scalar<'g> {
        self.g.scalar(self.m.bodies[body].position[ANGLE])
    }

    fn coordinate(&self, on: OnJoint) -> Scalar<'g> {
        self.g.scalar(self.m.joint_coordinate(self.g, on.joint, on.coordinate, TimeOrder::Position))
    }

    fn axis(&self, on: OnJoint) -> Result<Handle<'g>, BuildError> {
        let axis = axis_in_ground(self.g, self.m, on.joint, on.coordinate)?;
        Ok(Handle::of(self.g, axis))
    }

    fn nominal(&self, vector: Handle<'g>) -> [f64; 3] {
        let values = self.m.nominal(self.g, &vector.exprs());
        std::array::from_fn(|axis| values[axis])
    }
}

/// The unit vector about (along) which a joint's coordinate is counted, in the ground's axes; zero where it has none.
pub fn axis_in_ground(
    g: &Builder,
    m: &Mechanism,
    joint: usize,
    coordinate: JointCoordinate,
) -> Result<Vector, BuildError> {
    let kind = &m.description.joints[joint].kind;
    let (Some(between), Some(axis)) = (kind.between(), kind.axis_of(coordinate)) else { return Ok(space::zero(g)) };
    let axis = m.vector(g, axis, Context::Time)?;
    let axis = space::unit(g, axis);
    Ok(m.pair(g, between).outward(g, axis))
}

/// The reaction Σ λᵢ (forceᵢ, torqueᵢ) over the rows that were kept.
///
/// A dropped row (both sides prescribed) has no multiplier: how much the ground carries there is not determined by the
/// motion, and it counts as zero.
pub fn reaction(g: &Builder, joint: &dyn Joint, kept: &[(Row, Expr)]) -> Reaction {
    let (mut force, mut torque) = (space::zero(g), space::zero(g));
    let mut along = Vec::new();
    for (row, lambda) in kept {
        let part = space::scale(g, *lambda, row.force.exprs());
        force = space::add(g, force, part);
        let part = space::scale(g, *lambda, row.torque.exprs());
        torque = space::add(g, torque, part);
        if !row.force.is_zero() {
            along.push(*lambda);
        }
    }
    let magnitude = match (joint.equation(), kept, along.as_slice()) {
        (Some(_), [(_, lambda)], _) => *lambda,
        // One unit vector: no root is needed, which would have no derivative where the force vanishes.
        (_, _, [lambda]) => g.unary(Unary::Abs, *lambda),
        _ => space::norm(g, force),
    };
    // A coupling's row pushes against its coordinate: its vector is the opposite of the axis.
    let about_axis = match kept {
        [(row, lambda)] if row.force.is_zero() && !row.torque.is_zero() && joint.between().is_none() => Some(g.neg(*lambda)),
        _ => None,
    };
    Reaction { force, magnitude, torque, about_axis }
}

/// The part of a vector along a unit vector.
pub fn along(g: &Builder, vector: Vector, axis: Vector) -> Expr {
    space::dot(g, vector, axis)
}

/// The part of a vector across a unit vector: its magnitude or, in the plane across an axis of the plane, its component
/// along the axis turned by a right angle, counter-clockwise.
pub fn across(g: &Builder, vector: Vector, axis: Vector, is_spatial: bool) -> Expr {
    if !is_spatial && g.is_zero(axis[2]) {
        let normal = space::perpendicular(g, axis);
        return space::dot(g, vector, normal);
    }
    let part = space::scale(g, space::dot(g, vector, axis), axis);
    space::norm(g, space::sub(g, vector, part))
}

impl Mechanism<'_> {
    /// The unit vector of a joint's own axis in the ground's axes; for a coupling that of what it drives. Zero where the
    /// joint has none.
    pub fn axis_of_joint(&self, g: &Builder, joint: usize) -> Vector {
        let kind = &self.description.joints[joint].kind;
        let own = [JointCoordinate::Angle, JointCoordinate::Displacement].map(|coordinate| OnJoint { joint, coordinate });
        let driven = kind.coordinates(joint);
        let has_axis = |on: &&OnJoint| self.description.joints[on.joint].kind.axis_of(on.coordinate).is_some();
        let on = if kind.between().is_some() { own.iter().find(has_axis) } else { driven.iter().rfind(has_axis) };
        // The axis has been read as a formula of parameters and t: nothing else is in it.
        on.and_then(|on| axis_in_ground(g, self, on.joint, on.coordinate).ok()).unwrap_or_else(|| space::zero(g))
    }
}
