//! The motion of a child against its parent, by the coordinates of the joint between them.
//!
//! The inboard frame of the joint is fixed in the parent, its outboard frame in the child.

use symdiff::Scalar;

use super::matrix::Matrix;
use super::vector::Vector;

/// A coordinate of a joint that moves a child.
#[derive(Clone, Copy, Debug)]
pub struct DegreeOfFreedom<'g> {
    /// Its place in q.
    pub index: usize,
    /// Rotation about the axis for one of it.
    pub rotation: Scalar<'g>,
    /// Translation along the axis for one of it.
    pub translation: Scalar<'g>,
}

/// How a child moves against its parent: it turns by φ about an axis and slides by s along it.
#[derive(Clone, Debug)]
pub struct RelativeMotion<'g> {
    /// Index of the parent.
    pub parent: usize,
    /// Index of the joint.
    pub joint: usize,
    /// Rᵣ: from the child's axes to those of its parent.
    pub rotation: Matrix<'g>,
    /// ρ: the origin of the outboard frame in the parent's frame, s included.
    pub outboard_in_parent: Vector<'g>,
    /// f: the origin of the outboard frame in the child's own frame.
    pub outboard_in_child: Vector<'g>,
    /// Unit vector of the axis in the child's frame.
    pub axis: Vector<'g>,
    /// The same in the parent's frame.
    pub axis_in_parent: Vector<'g>,
    /// φ̇, φ̈
    pub angular: [Scalar<'g>; 2],
    /// ṡ, s̈
    pub sliding: [Scalar<'g>; 2],
    /// The coordinates.
    pub dofs: Vec<DegreeOfFreedom<'g>>,
}

impl<'g> RelativeMotion<'g> {
    /// The generalised force of a torque about the axis and a force along it, on each coordinate, with its place in q.
    pub fn generalised(&self, about: Scalar<'g>, along: Scalar<'g>) -> impl Iterator<Item = (usize, Scalar<'g>)> {
        self.dofs.iter().map(move |dof| {
            let (rotational, translational) = (dof.rotation * about, dof.translation * along);
            (dof.index, rotational + translational)
        })
    }
}
