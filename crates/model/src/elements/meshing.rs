//! How teeth of a joint rub, for the multiplier λ of its constraint.

use symdiff::Scalar;

use crate::grammar::OnJoint;
use crate::multibody::Vector;

/// Something whose rate is the speed of a toothed member.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Member {
    /// The angle of a body about z.
    Body(usize),
    /// The coordinate of a joint.
    Joint(OnJoint),
}

/// A rim of teeth: its members, each with the radius ∂u/∂q̇ of the rim's speed u, in the unit of the constraint. What
/// acts on the rim along its speed acts on each member by that radius.
pub type Rim<'g> = Vec<(Member, Scalar<'g>)>;

/// How teeth rub.
#[derive(Clone, Debug)]
pub enum Meshing<'g> {
    /// Teeth of these rims roll on one another: their loss is a share of the transmitted power.
    Rolling(Vec<Rim<'g>>),
    /// Flanks of a thread slide along one another.
    Sliding(Flanks<'g>),
}

/// Two flanks at the pitch point.
#[derive(Clone, Copy, Debug)]
pub struct Flanks<'g> {
    /// The bodies, by index: that of the thread, and the other.
    pub bodies: [usize; 2],
    /// Position in the ground's frame, m.
    pub at: Vector<'g>,
    /// The unit vector along the thread, in the ground's axes.
    pub along: Vector<'g>,
    /// Force between the flanks over |λ|, 1/m.
    pub load: Scalar<'g>,
}
