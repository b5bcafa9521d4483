//! The motion of a child against its parent, by the coordinates of the joint between them.
//!
//! The inboard frame of the joint is fixed in the parent, its outboard frame in the child. With the rates of the
//! coordinates
//!
//! ```text
//! Ω = Σ aᵢ φ̇ᵢ          Ω̇ = Σ aᵢ φ̈ᵢ + β          angular velocity against the parent, as seen from it
//! ρ̇ = Σ eᵢ ṡᵢ          ρ̈ = Σ eᵢ s̈ᵢ + γ          of the origin of the outboard frame, as seen from the parent
//! ```
//!
//! Seen from the child Ω̇ is the same.

use symdiff::Scalar;

use super::matrix::Matrix;
use super::vector::Vector;

/// A rotation about an axis, or a translation along one.
#[derive(Clone, Copy, Debug)]
pub struct AxisMotion<'g> {
    /// aᵢ or eᵢ in the parent's axes.
    pub in_parent: Vector<'g>,
    /// The same in the child's axes.
    pub in_child: Vector<'g>,
    /// φ̇, φ̈ or ṡ, s̈.
    pub rates: [Scalar<'g>; 2],
}

/// A coordinate of a joint that moves a child.
#[derive(Clone, Debug)]
pub struct DegreeOfFreedom<'g> {
    /// Index in q.
    pub index: usize,
    /// φᵢ per unit of the coordinate, by rotation.
    pub rotation: Vec<Scalar<'g>>,
    /// sᵢ per unit of the coordinate, by translation.
    pub translation: Vec<Scalar<'g>>,
}

/// Motion of a child against its parent.
#[derive(Clone, Debug)]
pub struct RelativeMotion<'g> {
    /// Index of the parent.
    pub parent: usize,
    /// Index of the joint.
    pub joint: usize,
    /// Rᵣ: from the child's axes to those of its parent.
    pub rotation: Matrix<'g>,
    /// ρ: the origin of the outboard frame in the parent's frame.
    pub outboard_in_parent: Vector<'g>,
    /// f: the origin of the outboard frame in the child's own frame.
    pub outboard_in_child: Vector<'g>,
    /// Rotation.
    pub rotations: Vec<AxisMotion<'g>>,
    /// Translation.
    pub translations: Vec<AxisMotion<'g>>,
    /// β in the parent's and in the child's axes; `None` if axes do not turn against one another.
    pub gyration: Option<[Vector<'g>; 2]>,
    /// γ in the parent's axes; `None` if translations are along axes of the parent.
    pub drift: Option<Vector<'g>>,
    /// The coordinates.
    pub dofs: Vec<DegreeOfFreedom<'g>>,
}

impl<'g> RelativeMotion<'g> {
    /// The generalised force of torques about the rotations' axes and forces along the translations', on each
    /// coordinate, with its index in q.
    pub fn generalised(
        &self,
        about: Vec<Scalar<'g>>,
        along: Vec<Scalar<'g>>,
    ) -> impl Iterator<Item = (usize, Scalar<'g>)> {
        let g = self.rotation[0][0].builder();
        let total = move |factors: &[Scalar<'g>], parts: &[Scalar<'g>]| {
            g.sum(factors.iter().zip(parts).map(|(&factor, &part)| factor * part))
        };
        self.dofs.iter().map(move |dof| {
            let (rotational, translational) = (total(&dof.rotation, &about), total(&dof.translation, &along));
            (dof.index, rotational + translational)
        })
    }

    /// Ω, or with `derivative` 1 Ω̇ − β, in the child's axes.
    pub fn turning(&self, derivative: usize) -> Vector<'g> {
        self.total(&self.rotations, |axis| axis.rates[derivative] * axis.in_child)
    }

    /// ρ̇, or with `derivative` 1 ρ̈ − γ, in the parent's axes.
    pub fn sliding(&self, derivative: usize) -> Vector<'g> {
        self.total(&self.translations, |axis| axis.rates[derivative] * axis.in_parent)
    }

    /// Rates of rotations or of translations, in the axes to which `outwards` takes those of the parent.
    pub fn rates(
        &self,
        axes: &[AxisMotion<'g>],
        derivative: usize,
        outwards: impl Fn(Vector<'g>) -> Vector<'g>,
    ) -> Vector<'g> {
        match axes {
            [axis] => axis.rates[derivative] * outwards(axis.in_parent),
            axes => outwards(self.total(axes, |axis| axis.rates[derivative] * axis.in_parent)),
        }
    }

    fn total(&self, axes: &[AxisMotion<'g>], term: impl Fn(&AxisMotion<'g>) -> Vector<'g>) -> Vector<'g> {
        let nothing = || Vector::zero(self.rotation[0][0].builder());
        axes.iter().map(term).reduce(|total, term| total + term).unwrap_or_else(nothing)
    }
}
