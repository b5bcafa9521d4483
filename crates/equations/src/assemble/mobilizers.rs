//! The relative motion of joints of more axes than one, by coordinates that formulas have no names for.
//!
//! R is the rotation from the second frame F₂ to the first F₁, d the origin of F₂ in F₁, n the normal of a plane and
//! e₁, e₂ two unit vectors across it, r the Euler parameters of R.
//!
//! ```text
//! universal    R = R(a, φ₁) C R(b, φ₂)      d = 0                 Ω = a φ̇₁ + R(a, φ₁) C b φ̇₂
//! planar       R = R(n, φ)                  d = e₁ s₁ + e₂ s₂     Ω = n φ̇
//! spherical    R = R(r),  rᵀr = 1           d = 0                 Ω = 2 E(r) ṙ
//! ```
//!
//! a is an axis of F₁ and b one of F₂; C turns b the shortest way until it is perpendicular to a. Where the child is
//! the joint's first body the motion is the opposite one.

use symdiff::Scalar;

use super::child::{RelativeRotation, constant_matrix};
use super::mechanism::{Mechanism, Owner, RelativeCoordinate};
use super::tree::InboardJoint;
use crate::assemble::tuning::TUNING;
use crate::elements::joints::Mobilizer;
use crate::grammar::JointCoordinate;
use crate::multibody::{
    AxisMotion, BuildError, Context, DegreeOfFreedom, Matrix, Quaternion, RelativeMotion, Vector, rotation,
};

/// Indices in q, and axes in F₁ and in F₂, of rotations of F₂ against F₁.
type Rotations<'g> = Vec<(usize, [Vector<'g>; 2])>;

/// Indices in q, and directions in the axes of the parent's frame, of translations.
type Translations<'g> = Vec<(usize, Vector<'g>)>;

/// Relative motion of a joint's frames.
struct FrameMotion<'g> {
    /// R, as Euler parameters and as a matrix.
    euler: Quaternion<'g>,
    matrix: Matrix<'g>,
    rotations: Rotations<'g>,
    /// β of F₂ against F₁, in the axes of F₁ and of F₂.
    gyration: Option<[Vector<'g>; 2]>,
    /// The origin of the child's frame in the parent's, and its derivatives.
    offset: Vector<'g>,
    translations: Translations<'g>,
    drift: Option<Vector<'g>>,
}

impl<'g> Mechanism<'g, '_> {
    /// The motion of a child against its parent.
    pub(super) fn motion_by_axes(
        &mut self,
        mobilizer: &Mobilizer,
        inboard: InboardJoint,
    ) -> Result<(RelativeMotion<'g>, RelativeRotation<'g>), BuildError> {
        let g = self.g;
        let frames = match *mobilizer {
            Mobilizer::TwoRotations { axes } => {
                let [first, second] = axes.map(|axis| self.unit_vector(axis, Context::Parameters));
                self.two_rotations(inboard.joint, [first?, second?])
            }
            Mobilizer::PlanarMotion { normal } => {
                let normal = self.unit_vector(normal, Context::Parameters)?;
                self.planar_motion(inboard, normal)
            }
            _ => self.free_rotation(inboard.joint),
        };
        let [parent, child] = [inboard.parent, inboard.child].map(|point| self.local_frame(point));
        let (in_parent, in_child) = (constant_matrix(parent), constant_matrix(child));
        let outwards = in_child.transposed();
        // Rotation of the child's frame against the parent's, and the index of the parent's axes among those of F₁ and
        // F₂.
        let (euler, matrix, of_parent, sign) = if inboard.reversed {
            (frames.euler.conjugate(), frames.matrix.transposed(), 1, -1.0)
        } else {
            (frames.euler, frames.matrix, 0, 1.0)
        };
        let sign = g.number(sign);
        let rotations = frames.rotations.iter().map(|(index, axes)| AxisMotion {
            in_parent: in_parent * axes[of_parent],
            in_child: in_child * axes[1 - of_parent],
            rates: [sign * self.v[*index], sign * self.w[*index]],
        });
        let rotations: Vec<AxisMotion> = rotations.collect();
        let translations = frames.translations.iter().map(|&(index, direction)| AxisMotion {
            in_parent: in_parent * direction,
            in_child: in_child * (matrix.transposed() * direction),
            rates: [self.v[index], self.w[index]],
        });
        let translations: Vec<AxisMotion> = translations.collect();
        let mut indices: Vec<usize> = frames
            .rotations
            .iter()
            .map(|rotation| rotation.0)
            .chain(frames.translations.iter().map(|one| one.0))
            .collect();
        indices.sort_unstable();
        indices.dedup();
        let share = |own: usize, of: usize, factor: Scalar<'g>| if own == of { factor } else { g.number(0.0) };
        let dofs = indices.into_iter().map(|index| DegreeOfFreedom {
            index,
            rotation: frames.rotations.iter().map(|rotation| share(rotation.0, index, sign)).collect(),
            translation: frames.translations.iter().map(|one| share(one.0, index, g.number(1.0))).collect(),
        });
        let motion = RelativeMotion {
            parent: inboard.parent.body,
            joint: inboard.joint,
            rotation: in_parent * matrix * outwards,
            outboard_in_parent: self.local(inboard.parent) + in_parent * frames.offset,
            outboard_in_child: self.local(inboard.child),
            rotations,
            translations,
            gyration: frames.gyration.map(|gyration| {
                [in_parent * (sign * gyration[of_parent]), in_child * (sign * gyration[1 - of_parent])]
            }),
            drift: frames.drift.map(|drift| in_parent * drift),
            dofs: dofs.collect(),
        };
        // In the plane no joint has more axes than one.
        Ok((motion, RelativeRotation { euler: parent * euler * child.conjugate(), angle: g.number(0.0) }))
    }

    fn add_relative_coordinate(&mut self, joint: usize, coordinate: RelativeCoordinate) -> usize {
        let name = self.joints[joint].name.clone();
        self.add_coordinate(Owner::Relative(joint, coordinate), &name)
    }

    fn two_rotations(&mut self, joint: usize, [first, second]: [Vector<'g>; 2]) -> FrameMotion<'g> {
        let indices = [0, 1].map(|axis| self.add_relative_coordinate(joint, RelativeCoordinate::Angle(axis)));
        let cross = self.perpendicular([first, second]);
        let [about_first, about_second] = indices.map(|index| self.q[index]);
        let euler = Quaternion::about(first, about_first) * cross * Quaternion::about(second, about_second);
        let [before, after] = [
            rotation::matrix_about(first, about_first) * constant_matrix(cross),
            rotation::matrix_about(second, about_second),
        ];
        let second_in_first = before * second;
        let first_in_second = after.transposed() * (constant_matrix(cross).transposed() * first);
        let rates = self.v[indices[0]] * self.v[indices[1]];
        FrameMotion {
            euler,
            matrix: before * after,
            rotations: vec![(indices[0], [first, first_in_second]), (indices[1], [second_in_first, second])],
            gyration: Some([rates * first.cross(second_in_first), rates * first_in_second.cross(second)]),
            offset: Vector::zero(self.g),
            translations: Vec::new(),
            drift: None,
        }
    }

    /// C: turns the second axis until it is perpendicular to the first.
    fn perpendicular(&self, [first, second]: [Vector<'g>; 2]) -> Quaternion<'g> {
        let along = first.dot(second);
        if along.is_zero() {
            return Quaternion::identity(self.g);
        }
        let across = second - along * first;
        let [size] = self.nominal([across.norm()]);
        let wanted = if size > TUNING.parallel { across.unit() } else { self.normals(first)[0] };
        let [x, y, z] = second.cross(wanted).components();
        Quaternion::from([1.0 + second.dot(wanted), x, y, z]).normalised()
    }

    /// Two unit vectors across a unit vector and one another.
    fn normals(&self, axis: Vector<'g>) -> [Vector<'g>; 2] {
        let size = self.nominal(axis.components()).into_iter().map(f64::abs).enumerate();
        let least = size.reduce(|best, next| if next.1 < best.1 { next } else { best }).map_or(0, |(index, _)| index);
        let first = Vector::along(self.g, least);
        let first = (first - first.dot(axis) * axis).unit();
        [first, axis.cross(first)]
    }

    fn planar_motion(&mut self, inboard: InboardJoint, normal: Vector<'g>) -> FrameMotion<'g> {
        let joint = inboard.joint;
        let indices = [0, 1].map(|along| self.add_relative_coordinate(joint, RelativeCoordinate::Displacement(along)));
        let turning = self.add_joint_coordinate(joint, JointCoordinate::Angle);
        let angle = self.q[turning];
        let matrix = rotation::matrix_about(normal, angle);
        let [first, second] = self.normals(normal);
        let mut motion = FrameMotion {
            euler: Quaternion::about(normal, angle),
            matrix,
            rotations: vec![(turning, [normal, normal])],
            gyration: None,
            offset: self.q[indices[0]] * first + self.q[indices[1]] * second,
            translations: vec![(indices[0], first), (indices[1], second)],
            drift: None,
        };
        if inboard.reversed {
            // F₁ in F₂ is at δ = −Rᵀ d: δ̇ = σ + δ × n φ̇ with σ = −Rᵀ ḋ, and δ̈ = −Rᵀ d̈ + δ × n φ̈ + 2 σ × n φ̇ − δ
            // φ̇².
            let back = |direction: Vector<'g>| -(matrix.transposed() * direction);
            let [first, second] = [back(first), back(second)];
            let [slides, rate] = [indices.map(|index| self.v[index]), [self.v[turning]; 2]];
            let sliding = slides[0] * first + slides[1] * second;
            motion.offset = back(motion.offset);
            motion.translations =
                vec![(indices[0], first), (indices[1], second), (turning, motion.offset.cross(normal))];
            motion.drift = Some((2.0 * rate[0]) * sliding.cross(normal) - (rate[0] * rate[1]) * motion.offset);
        }
        motion
    }

    fn free_rotation(&mut self, joint: usize) -> FrameMotion<'g> {
        let indices: [usize; 4] =
            std::array::from_fn(|index| self.add_relative_coordinate(joint, RelativeCoordinate::Euler(index)));
        let euler = Quaternion::from(indices.map(|index| self.q[index]));
        let (in_first, in_second) = (euler.ground_rates(), euler.body_rates());
        let rotations = indices
            .into_iter()
            .enumerate()
            .map(|(column, index)| (index, [2.0 * in_first.column(column), 2.0 * in_second.column(column)]));
        FrameMotion {
            euler,
            matrix: euler.matrix(),
            rotations: rotations.collect(),
            gyration: None,
            offset: Vector::zero(self.g),
            translations: Vec::new(),
            drift: None,
        }
    }

    /// Coordinates of joints of the trees that formulas have no names for, and their indices in q.
    pub(super) fn unnamed_coordinates(&self) -> impl Iterator<Item = (usize, RelativeCoordinate, usize)> {
        self.coordinates.iter().enumerate().filter_map(|(index, owner)| match *owner {
            Owner::Relative(joint, coordinate) => Some((joint, coordinate, index)),
            _ => None,
        })
    }

    /// Whether formulas have no names for all coordinates of a joint that can carry a body.
    pub(super) fn has_no_names(&self, joint: usize) -> bool {
        self.joints[joint].kind.mobilizer().is_some_and(|mobilizer| !mobilizer.has_one_axis())
    }

    /// The Euler parameters that are coordinates of joints of the trees, with the joints.
    pub(super) fn euler_parameters(&self) -> Vec<(usize, Quaternion<'g>)> {
        let first = self.unnamed_coordinates().filter(|(_, coordinate, _)| *coordinate == RelativeCoordinate::Euler(0));
        first
            .map(|(joint, _, index)| (joint, std::array::from_fn(|component| self.q[index + component]).into()))
            .collect()
    }

    /// A coordinate of a joint whose second frame is turned and displaced so against the first; of frames that the
    /// joint does not allow one that is near.
    pub(super) fn relative_coordinate(
        &self,
        mobilizer: &Mobilizer,
        coordinate: RelativeCoordinate,
        relative: Quaternion<'g>,
        offset: Vector<'g>,
    ) -> Result<Scalar<'g>, BuildError> {
        let zero = self.g.number(0.0);
        Ok(match (*mobilizer, coordinate) {
            (Mobilizer::FreeRotation, RelativeCoordinate::Euler(index)) => relative[index],
            (Mobilizer::PlanarMotion { normal }, RelativeCoordinate::Displacement(along)) => {
                let normal = self.unit_vector(normal, Context::Parameters)?;
                self.normals(normal)[along].dot(offset)
            }
            (Mobilizer::TwoRotations { axes: [first, second] }, RelativeCoordinate::Angle(axis)) => {
                let first = self.unit_vector(first, Context::Parameters)?;
                let second = self.unit_vector(second, Context::Parameters)?;
                let cross = self.perpendicular([first, second]);
                let (at_zero, now) = (cross.matrix() * second, relative.matrix() * second);
                let about_first = first.cross(at_zero).dot(now).atan2(at_zero.dot(now));
                if axis == 0 {
                    return Ok(about_first);
                }
                let left = cross.conjugate() * Quaternion::about(first, about_first).conjugate() * relative;
                let (cos, sin) = (left[0], left.vector_part().dot(second));
                (2.0 * cos * sin).atan2(cos * cos - sin * sin)
            }
            _ => zero,
        })
    }
}
