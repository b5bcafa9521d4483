//! Capabilities of joints that the stages ask for, whatever the joint's kind.

use std::fmt::Debug;

use serde::Serialize;
use symdiff::{Formula, Scalar};

use crate::elements::Glyph;
use crate::elements::meshing::Meshing;
use crate::grammar::{Element, JointCoordinate, MeshKind, OnJoint, PointRef};
use crate::multibody::BuildError;

use super::rows::{Kinematics, Rows};
use super::teeth::ToothForce;

/// Properties of a kind of joint, in addition to its keys.
pub trait JointElement: Element + Joint {
    /// Whether it leaves the plane, whatever its axes.
    const SPATIAL: bool = false;
    /// Whether it refers to other joints, so that it is read after them.
    const COUPLES: bool = false;
    /// Whether effects and drives on it act on its angle unless they say `coordinate`.
    const TURNS: bool = false;
    /// Documentation of its constraints and their multipliers.
    const ROWS: &'static [RowDocs];
}

/// One or several constraints of a joint, for people.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RowDocs {
    /// Their names, as in `pin.x`; empty if the joint has one alone.
    pub name: &'static str,
    /// Unit of the residual.
    pub unit: &'static str,
    /// Unit, sign and frame of the multiplier λ.
    pub multiplier: &'static str,
}

/// A joint, as the stages see it. What a kind does not say has the default: it has not that capability.
pub trait Joint: Debug {
    /// The points A and B that it is between; `None` if it acts on coordinates alone.
    fn between(&self) -> Option<[PointRef; 2]> {
        None
    }

    /// The relative motion, if the joint can place a body in joint coordinates.
    fn mobilizer(&self) -> Option<Mobilizer<'_>> {
        None
    }

    /// Data by which a first guess places a body on the joint; `None` if the joint does not place bodies.
    fn placement(&self) -> Option<Placement<'_>> {
        None
    }

    /// The coordinates of joints that its constraints are written in; `own` is its own index.
    fn coordinates(&self, own: usize) -> Vec<OnJoint> {
        let _ = own;
        Vec::new()
    }

    /// The two sides, where the joint equates two formulas of the motion. It has no second body then, and its
    /// multiplier stands for the reaction's force.
    fn equation(&self) -> Option<[&Formula; 2]> {
        None
    }

    /// Axis of this coordinate of the joint; `None` if the joint does not have the coordinate.
    fn axis_of(&self, coordinate: JointCoordinate) -> Option<&[Formula; 3]> {
        self.mobilizer()?.axis_of(coordinate)
    }

    /// Direction in the first frame along which `axial` counts the joint's reaction; `None` if it has no direction of
    /// its own.
    fn reaction_axis(&self) -> Option<&[Formula; 3]> {
        self.axis_of(JointCoordinate::Angle).or_else(|| self.axis_of(JointCoordinate::Displacement))
    }

    /// `axial` over the one multiplier, where its force acts along a line that moves against both bodies.
    fn axial_by_multiplier(&self) -> Option<f64> {
        None
    }

    /// The force that its multiplier λ stands for, where that acts between two bodies by teeth; `own` is its own index.
    ///
    /// # Errors
    /// Bearings between which teeth cannot touch, and a formula with a name that cannot stand in it.
    fn tooth_force<'g>(
        &self,
        own: usize,
        k: &dyn Kinematics<'g>,
        lambda: Scalar<'g>,
    ) -> Result<Option<ToothForce<'g>>, BuildError> {
        let _ = (own, k, lambda);
        Ok(None)
    }

    /// Bodies it pushes on by teeth of unknown geometry: bearings feel more than its own torque and force.
    fn toothed(&self) -> Toothed {
        Toothed::default()
    }

    /// Kind of friction of its teeth; `None` if they have none.
    fn mesh_kind(&self) -> Option<MeshKind> {
        None
    }

    /// How its teeth rub; `own` is its own index.
    ///
    /// # Errors
    /// As [`tooth_force`](Self::tooth_force).
    fn meshing<'g>(&self, own: usize, k: &dyn Kinematics<'g>) -> Result<Option<Meshing<'g>>, BuildError> {
        let _ = (own, k);
        Ok(None)
    }

    /// The coordinate of which it prescribes the motion, whatever its formulas.
    fn driven(&self) -> Option<OnJoint> {
        None
    }

    /// Whether it prescribes a motion.
    fn drives(&self) -> bool {
        self.driven().is_some()
    }

    /// Its constraints; `own` is its own index.
    ///
    /// # Errors
    /// A formula with a name that cannot stand in it; the reader of model files lets none through.
    fn rows<'g>(&self, own: usize, k: &dyn Kinematics<'g>) -> Rows<'g>;

    /// Whether it constrains velocities beyond positions.
    fn is_nonholonomic(&self) -> bool {
        false
    }

    /// The speed of a coordinate, if it is given: it constrains velocities if it follows the motion.
    fn speed(&self) -> Option<&Formula> {
        None
    }

    /// Its nonholonomic constraints: Ψ(q, v, t) = 0, linear in the velocities of the mechanism, which are no
    /// derivatives of constraints of positions.
    ///
    /// # Errors
    /// As [`rows`](Self::rows).
    fn velocity_rows<'g>(&self, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let _ = k;
        Ok(Vec::new())
    }

    /// Its symbol in drawings.
    fn glyph(&self) -> Glyph {
        match self.mobilizer() {
            Some(Mobilizer::Weld { .. }) => Glyph::Weld,
            Some(Mobilizer::Translation { .. }) => Glyph::Slider,
            Some(Mobilizer::RotationAndTranslation { .. }) => Glyph::Cylinder,
            Some(Mobilizer::Helix { .. }) => Glyph::Screw,
            Some(Mobilizer::Rotation { .. }) => Glyph::Pin,
            Some(Mobilizer::TwoRotations { .. }) => Glyph::Universal,
            Some(Mobilizer::PlanarMotion { .. }) => Glyph::Plane,
            Some(Mobilizer::FreeRotation) => Glyph::Ball,
            None => Glyph::Nothing,
        }
    }

    /// The direction that its symbol is turned to, in the first frame.
    fn direction(&self) -> Option<&[Formula; 3]> {
        self.mobilizer()?.axis()
    }

    /// The angle of the second frame against the first, where the joint welds its bodies together.
    fn weld(&self) -> Option<&Formula> {
        match self.mobilizer()? {
            Mobilizer::Weld { twist } => Some(twist),
            _ => None,
        }
    }
}

/// Joints, and bodies, that have teeth, by index.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Toothed {
    /// The second body of each has teeth: the joint is its bearing.
    pub joints: Vec<usize>,
    /// Bodies whose bearings are not named.
    pub bodies: Vec<usize>,
}

/// The relative motions that a recursion over a tree of bodies knows.
///
/// `twist` is the angle by which the second frame is turned about the first's z where the coordinates are zero, rad.
#[derive(Clone, Copy, Debug)]
pub enum Mobilizer<'a> {
    /// None.
    Weld {
        /// Angle between the frames about z where the coordinates are zero, rad.
        twist: &'a Formula,
    },
    /// Rotation about the axis.
    Rotation {
        /// Direction of the axis in the first frame.
        axis: &'a [Formula; 3],
    },
    /// Translation along the axis.
    Translation {
        /// Direction of the axis in the first frame.
        axis: &'a [Formula; 3],
        /// Angle between the frames about z where the coordinates are zero, rad.
        twist: &'a Formula,
    },
    /// Rotation about the axis and translation along it.
    RotationAndTranslation {
        /// Direction of the axis in the first frame.
        axis: &'a [Formula; 3],
    },
    /// Rotation about the axis with a translation of `pitch` in a turn, m.
    Helix {
        /// Direction of the axis in the first frame.
        axis: &'a [Formula; 3],
        /// Translation in one turn, m.
        pitch: &'a Formula,
    },
    /// Rotations about an axis of the first frame and about one of the second, which stay perpendicular.
    TwoRotations {
        /// An axis of the first frame and one of the second.
        axes: [&'a [Formula; 3]; 2],
    },
    /// Translations across the normal and rotation about it.
    PlanarMotion {
        /// Normal of the plane in the first frame.
        normal: &'a [Formula; 3],
    },
    /// Any rotation; no translation.
    FreeRotation,
}

impl<'a> Mobilizer<'a> {
    /// The one axis about which it turns or along which it slides, or the normal of a planar motion; `None` if there is
    /// no axis, or two.
    pub fn axis(&self) -> Option<&'a [Formula; 3]> {
        match *self {
            Self::Weld { .. } | Self::TwoRotations { .. } | Self::FreeRotation => None,
            Self::PlanarMotion { normal } => Some(normal),
            Self::Rotation { axis }
            | Self::Translation { axis, .. }
            | Self::RotationAndTranslation { axis }
            | Self::Helix { axis, .. } => Some(axis),
        }
    }

    /// The axis, where the motion has the coordinate.
    pub fn axis_of(&self, coordinate: JointCoordinate) -> Option<&'a [Formula; 3]> {
        let absent = match self {
            Self::Rotation { .. } | Self::PlanarMotion { .. } => Some(JointCoordinate::Displacement),
            Self::Translation { .. } => Some(JointCoordinate::Angle),
            Self::Weld { .. }
            | Self::RotationAndTranslation { .. }
            | Self::Helix { .. }
            | Self::TwoRotations { .. }
            | Self::FreeRotation => None,
        };
        self.axis().filter(|_| absent != Some(coordinate))
    }

    /// Whether the coordinate is one that the motion is counted by; a helix' displacement follows from its angle.
    pub fn is_counted_by(&self, coordinate: JointCoordinate) -> bool {
        let follows = matches!(self, Self::Helix { .. }) && coordinate == JointCoordinate::Displacement;
        self.axis_of(coordinate).is_some() && !follows
    }

    /// The angle at rest; `None` for zero.
    pub fn twist(&self) -> Option<&'a Formula> {
        match *self {
            Self::Weld { twist } | Self::Translation { twist, .. } => Some(twist),
            _ => None,
        }
    }

    /// Whether its coordinates are an angle about an axis and a displacement along it, or fewer.
    pub fn has_one_axis(&self) -> bool {
        !matches!(self, Self::TwoRotations { .. } | Self::PlanarMotion { .. } | Self::FreeRotation)
    }

    /// The axes of two rotations.
    fn two_axes(&self) -> Option<[&'a [Formula; 3]; 2]> {
        match *self {
            Self::TwoRotations { axes } => Some(axes),
            _ => None,
        }
    }

    /// The advance in a turn, m, of a helix.
    pub fn pitch(&self) -> Option<&'a Formula> {
        match *self {
            Self::Helix { pitch, .. } => Some(pitch),
            _ => None,
        }
    }

    /// Every formula in it.
    pub fn formulas(&self) -> impl Iterator<Item = &'a Formula> {
        let axes = self.axis().into_iter().chain(self.two_axes().into_iter().flatten());
        axes.flatten().chain(self.twist()).chain(self.pitch())
    }
}

/// Where a joint puts one of its bodies when the other is placed.
#[derive(Clone, Copy, Debug)]
pub struct Placement<'a> {
    /// Separation of the points.
    pub separation: Separation<'a>,
    /// Orientation of the frames.
    pub orientation: Orientation<'a>,
}

/// How far apart a joint's points are.
#[derive(Clone, Copy, Debug)]
pub enum Separation<'a> {
    /// The points coincide.
    Coincident,
    /// Somewhere on a line or in a plane.
    Unknown,
    /// At a distance, m.
    Distance(&'a Formula),
}

/// How a joint's frames are turned against one another.
#[derive(Clone, Copy, Debug)]
pub enum Orientation<'a> {
    /// Anyhow.
    Free,
    /// About axes of the joint, so that parallel frames are near enough.
    AboutAxis,
    /// By an angle about the first frame's z, rad.
    Fixed(&'a Formula),
}
