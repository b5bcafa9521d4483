//! Quantities in which a joint's constraints are written, and the constraints that several joints share.
//!
//! A virtual rotation δπ of the second body, in the axes of the first frame F₁, changes the vector part e of the
//! relative rotation q = (q₀, e) by ½ (q₀ δπ + δπ × e), so a row
//!
//! ```text
//! Φ = 2 n · e = 0          1 row, rad
//! ```
//!
//! forbids rotations with a part about n: with all three n the frames are parallel; with the two normal to an axis,
//! they turn about it, by any angle. −Φ_qᵀ λ is the torque −λ (q₀ n + e × n), in F₁'s axes, on the second body and the
//! opposite on the first. Unlike products of axes, the row has no second solution in which an axis points backwards.

use symdiff::{Builder, Formula, Scalar};

use crate::grammar::{OfAngle, OnJoint, PointRef};
use crate::multibody::{BuildError, Pair, Vector};

/// One scalar constraint.
///
/// The equations of motion are M w = Q − Φ_qᵀ λ, so a row's generalised force is −Φ_qᵀ λ, or −Ψ_vᵀ λ of a velocity
/// constraint. `force` and `torque` act on the joint's second body, for λ = 1; the first body has the opposite, at the
/// same point (but for gears and racks).
#[derive(Clone, Copy, Debug)]
pub struct Row<'g> {
    /// Distinguishes it from the joint's other rows; empty if there are none.
    pub name: &'static str,
    /// Φ, m or rad; Ψ, m/s, of a velocity constraint.
    pub value: Scalar<'g>,
    /// Force on the second body for λ = 1, in the ground's axes: a unit vector where Φ = 0, or zero.
    pub force: Vector<'g>,
    /// Torque on the second body about the second point for λ = 1, in the ground's axes.
    pub torque: Vector<'g>,
}

/// The mechanism as far as constraints depend on it: at a position and a time, and for velocity constraints in a
/// motion.
pub trait Kinematics<'g> {
    /// The graph that expressions are added to.
    fn graph(&self) -> &'g Builder;
    /// Whether the mechanism leaves the plane.
    fn is_spatial(&self) -> bool;
    /// t, s.
    fn time(&self) -> Scalar<'g>;
    /// A formula of parameters and t.
    fn number(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError>;
    /// A formula of parameters, t and positions.
    fn of_positions(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError>;
    /// Whether a formula is one of parameters and t alone.
    fn is_prescribed(&self, formula: &Formula) -> bool;
    /// A formula of parameters, t, positions and states.
    fn command(&self, formula: &Formula) -> Result<Scalar<'g>, BuildError>;
    /// A formula of parameters, t and an angle, and its derivative by that angle.
    fn of_angle(&self, formula: &OfAngle, angle: Scalar<'g>) -> Result<[Scalar<'g>; 2], BuildError>;
    /// A direction of parameters and t, of length 1.
    fn unit_vector(&self, direction: &[Formula; 3]) -> Result<Vector<'g>, BuildError>;
    /// Positions of two points in the ground's frame, m.
    fn points(&self, between: [PointRef; 2]) -> [Vector<'g>; 2];
    /// The velocity of a point in the ground's axes, m/s.
    fn velocity(&self, point: PointRef) -> Vector<'g>;
    /// The angular velocity of a body in the ground's axes, rad/s.
    fn angular_velocity(&self, body: usize) -> Vector<'g>;
    /// The frames at two points.
    fn pair(&self, between: [PointRef; 2]) -> Pair<'g>;
    /// A vector of a body's frame, in the ground's axes.
    fn rotated(&self, body: usize, vector: Vector<'g>) -> Vector<'g>;
    /// The angle of a body about z, rad.
    fn angle(&self, body: usize) -> Scalar<'g>;
    /// A coordinate of a joint, rad or m.
    fn coordinate(&self, on: OnJoint) -> Scalar<'g>;
    /// The rate of a joint's coordinate, rad/s or m/s, by the velocities of its bodies.
    fn rate(&self, on: OnJoint) -> Result<Scalar<'g>, BuildError>;
    /// The unit vector about or along which a joint's coordinate is counted, in the ground's axes.
    fn axis(&self, on: OnJoint) -> Result<Vector<'g>, BuildError>;
    /// The name of a joint.
    fn joint_name(&self, joint: usize) -> &str;
    /// The bodies that a joint is between, by index.
    fn bodies(&self, joint: usize) -> Option<[usize; 2]>;
    /// The line about or along which a joint's coordinate is counted: a point of it and the unit vector along it, in
    /// the frame of one of the joint's bodies; `None` if there is no such line.
    fn line(&self, on: OnJoint, body: usize) -> Result<Option<[Vector<'g>; 2]>, BuildError>;
    /// The position of a point of a body's frame, m.
    fn place(&self, body: usize, local: Vector<'g>) -> Vector<'g>;
    /// A vector's components at the nominal parameters.
    fn nominal(&self, vector: Vector<'g>) -> [f64; 3];
}

/// The rows of a joint, or why there are none.
pub type Rows<'g> = Result<Vec<Row<'g>>, BuildError>;

/// Two frames, and the rows between them.
pub(super) struct Frames<'g, 'k> {
    k: &'k dyn Kinematics<'g>,
    g: &'g Builder,
    pair: Pair<'g>,
}

impl<'g, 'k> Frames<'g, 'k> {
    /// The frames at two points.
    pub fn of(k: &'k dyn Kinematics<'g>, between: [PointRef; 2]) -> Self {
        Self { k, g: k.graph(), pair: k.pair(between) }
    }

    /// The first frame turned by an angle about its z.
    pub fn turned(mut self, angle: Scalar<'g>) -> Self {
        self.pair = self.pair.turned(angle);
        self
    }

    /// A direction of the first frame in the ground's axes.
    pub fn outward(&self, direction: Vector<'g>) -> Vector<'g> {
        self.pair.outward(direction)
    }

    /// A direction of the second frame in the ground's axes.
    pub fn outward_of_second(&self, direction: Vector<'g>) -> Vector<'g> {
        self.pair.outward_of_second(direction)
    }

    /// r_B − r_A, in the ground's axes.
    pub fn offset(&self) -> Vector<'g> {
        self.pair.offset()
    }

    /// a · (r_B − r_A) with a direction of the first frame.
    pub fn displacement(&self, direction: Vector<'g>) -> Scalar<'g> {
        self.pair.displacement(direction)
    }

    /// No displacement along n, a unit vector of the first frame: Φ = n₁ · (r_B − r_A), m. −Φ_qᵀ λ is the force −λ n₁
    /// at B on the second body and the opposite on the first, at the same point.
    pub fn normal_row(&self, name: &'static str, normal: Vector<'g>) -> Row<'g> {
        let normal = self.outward(normal);
        let offset = self.offset();
        Row { name, value: normal.dot(offset), force: -normal, torque: Vector::zero(self.g) }
    }

    /// No rotation with a part about n, a unit vector of the first frame.
    fn turn_row(&self, name: &'static str, normal: Vector<'g>) -> Row<'g> {
        let relative = self.pair.relative();
        let (q0, e) = (relative[0], relative.vector_part());
        let value = 2.0 * normal.dot(e);
        let torque = self.outward(q0 * normal + e.cross(normal));
        Row { name, value, force: Vector::zero(self.g), torque: -torque }
    }

    /// The frames stay parallel.
    pub fn parallel(&self) -> [Row<'g>; 3] {
        let names = ["turn_x", "turn_y", "turn_z"];
        std::array::from_fn(|axis| self.turn_row(names[axis], Vector::along(self.g, axis)))
    }

    /// The frames turn about the axis alone.
    pub fn coaxial(&self, axis: Vector<'g>) -> [Row<'g>; 2] {
        let [first, second] = self.normals(axis);
        [self.turn_row("tilt_1", first), self.turn_row("tilt_2", second)]
    }

    /// The second point stays on the line through the first along the axis.
    pub fn on_line(&self, axis: Vector<'g>) -> [Row<'g>; 2] {
        let [first, second] = self.normals(axis);
        [self.normal_row("normal_1", first), self.normal_row("normal_2", second)]
    }

    /// Two unit vectors normal to a unit vector and to one another. Which axis of the frame they lean on is decided at
    /// the nominal parameters: the one that the vector is farthest from.
    pub fn normals(&self, axis: Vector<'g>) -> [Vector<'g>; 2] {
        let size = self.k.nominal(axis).into_iter().map(f64::abs).enumerate();
        let least = size.reduce(|best, next| if next.1 < best.1 { next } else { best }).map_or(0, |(index, _)| index);
        let lean = Vector::along(self.g, least);
        let first = axis.cross(lean).unit();
        [first, axis.cross(first)]
    }
}

/// Two points coincide: Φ = r_A − r_B, m. λ is the force on the second body, at B, in the ground's axes.
pub(super) fn coincident<'g>(k: &dyn Kinematics<'g>, between: [PointRef; 2]) -> Vec<Row<'g>> {
    let g = k.graph();
    let [a, b] = k.points(between);
    let residual = a - b;
    let names = ["x", "y", "z"];
    let row = |axis: usize| {
        let (force, torque) = (Vector::along(g, axis), Vector::zero(g));
        Row { name: names[axis], value: residual[axis], force, torque }
    };
    (0..if k.is_spatial() { 3 } else { 2 }).map(row).collect()
}

/// The second point stays on a line of the plane: Φ = n₁ · (r_B − r_A), n₁ the axis turned by a right angle.
pub(super) fn planar_normal<'g>(
    k: &dyn Kinematics<'g>,
    between: [PointRef; 2],
    axis: &[Formula; 3],
) -> Result<Row<'g>, BuildError> {
    let normal = k.unit_vector(axis)?.perpendicular();
    let normal = k.rotated(between[0].body, normal);
    let [a, b] = k.points(between);
    let value = normal.dot(b - a);
    Ok(Row { name: "normal", value, force: -normal, torque: Vector::zero(k.graph()) })
}

/// The bodies of the plane keep their angle: Φ = θ₂ − θ₁ − angle.
pub(super) fn planar_angle<'g>(
    k: &dyn Kinematics<'g>,
    between: [PointRef; 2],
    angle: &Formula,
) -> Result<Row<'g>, BuildError> {
    let angle = k.number(angle)?;
    let [first, second] = between.map(|point| k.angle(point.body));
    let value = second - first - angle;
    let about = Vector::along(k.graph(), 2);
    Ok(Row { name: "angle", value, force: Vector::zero(k.graph()), torque: -about })
}

/// The second point stays on a line through the first.
pub(super) fn point_on_line<'g>(k: &dyn Kinematics<'g>, between: [PointRef; 2], axis: &[Formula; 3]) -> Rows<'g> {
    if !k.is_spatial() {
        return Ok(vec![Row { name: "", ..planar_normal(k, between, axis)? }]);
    }
    let axis = k.unit_vector(axis)?;
    Ok(Frames::of(k, between).on_line(axis).to_vec())
}
