//! Ground whose height over a point is a function of the way along it, and of t.
//!
//! ```text
//! surface up = h(x, t) in the first frame, up its y, in space its z; the same for all z (in space y)
//! foot u of a centre (p, q):    f(u) = u − p + h' (h − q) = 0,    by three steps of Newton's method from u = p
//! n = (−h', 1)/√(1 + h'²),      gap = n · (p − u, q − h) − r,      the surface moves with ∂h/∂t along up
//! ```
//!
//! f' = 1 + h'² + h'' (h − q) is positive where the centre is nearer than the surface's centre of curvature: a circle
//! that is larger than a hollow touches it at two points, of which this knows one.

use symdiff::Scalar;

use super::solid::Gap;
use crate::elements::effects::Forces;
use crate::elements::tuning::TUNING;
use crate::grammar::OfPlace;
use crate::multibody::{BuildError, OwnFunction, Pair, Vector};

/// A height over a point.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'g> {
    height: OwnFunction<'g>,
    slope: OwnFunction<'g>,
    bend: OwnFunction<'g>,
    /// ∂h/∂t
    rate: OwnFunction<'g>,
    /// The axis of the first frame that is up.
    up: usize,
    /// r, m
    radius: Scalar<'g>,
}

/// Where a centre is over the ground, in x and up of the first frame.
struct Foot<'g> {
    /// u
    along: Scalar<'g>,
    /// h'
    slope: Scalar<'g>,
    /// The centre against the foot.
    offset: [Scalar<'g>; 2],
}

impl<'g> Ground<'g> {
    pub fn of(forces: &dyn Forces<'g>, height: &OfPlace, radius: Scalar<'g>) -> Result<Self, BuildError> {
        let height = forces.of_place(height)?;
        let slope = height.derivative();
        let up = if forces.is_spatial() { 2 } else { 1 };
        let rate = height.derivative_by(forces.time());
        Ok(Self { height, slope, bend: slope.derivative(), rate, up, radius })
    }

    fn foot(&self, pair: &Pair<'g>, offset: Vector<'g>) -> Foot<'g> {
        let place = pair.first.orientation.matrix().transposed() * offset;
        let (across, height) = (place[0], place[self.up]);
        let mut along = across;
        for _ in 0..TUNING.steps_to_ground {
            let (h, slope, bend) = (self.height.at(along), self.slope.at(along), self.bend.at(along));
            let above = h - height;
            let value = along - across + slope * above;
            along -= value / (1.0 + slope * slope + bend * above);
        }
        Foot { along, slope: self.slope.at(along), offset: [across - along, height - self.height.at(along)] }
    }

    /// How far a circle is from it.
    pub fn gap(&self, pair: &Pair<'g>, offset: Vector<'g>) -> Gap<'g> {
        let Foot { slope, offset: [across, above], .. } = self.foot(pair, offset);
        let steep = (1.0 + slope * slope).sqrt();
        let distance = (above - slope * across) / steep;
        let mut normal = Vector::along(self.radius.builder(), self.up);
        normal[0] = -slope;
        let gap = distance - self.radius;
        Gap { gap, normal: pair.outward(normal / steep), overlap: -gap, near: None }
    }

    /// How fast it moves at the foot against its body, in the ground's axes.
    pub fn velocity(&self, pair: &Pair<'g>, offset: Vector<'g>) -> Vector<'g> {
        let rate = self.rate.at(self.foot(pair, offset).along);
        pair.outward(rate * Vector::along(self.radius.builder(), self.up))
    }
}
