//! Contents of a URDF, typed: links, joints, and every number with its location and its name as a parameter.

use crate::robots::number::Number;
use crate::syntax::source::Span;

/// Where a frame is in the frame around it: m, rad about the fixed x, y, z.
#[derive(Clone, Debug)]
pub struct Origin {
    pub xyz: [Number; 3],
    pub rpy: [Number; 3],
}

#[derive(Clone, Debug)]
pub struct Inertial {
    pub origin: Origin,
    pub mass: Number,
    /// xx, yy, zz, xy, xz, yz about the centre of mass, along the origin's axes.
    pub inertia: [Number; 6],
}

#[derive(Clone, Debug)]
pub struct Link {
    /// A name in formulas: that of the file, with `_` for characters that cannot stand there.
    pub name: String,
    pub span: Span,
    pub inertial: Option<Inertial>,
    pub visuals: Vec<Visual>,
}

/// A part of a link's appearance.
#[derive(Clone, Debug)]
pub struct Visual {
    /// Where it is in the link's frame, m.
    pub xyz: [f64; 3],
    /// How it is turned there: rad about the fixed x, y, z.
    pub rpy: [f64; 3],
    /// Its shape, in the middle of its frame.
    pub shape: VisualShape,
    /// Red, green and blue from 0 to 1.
    pub color: Option<[f64; 3]>,
}

/// A shape; lengths in m.
#[derive(Clone, Debug, PartialEq)]
pub enum VisualShape {
    /// Its sides along x, y and z.
    Box([f64; 3]),
    /// About z.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its length.
        length: f64,
    },
    /// Its radius.
    Sphere(f64),
    /// A mesh of a file.
    Mesh {
        /// Name in the robot's file.
        file: String,
        /// Factors along x, y and z.
        scale: [f64; 3],
    },
}

/// In the order of [`WORDS`](Kind::WORDS).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UrdfJointType {
    Revolute,
    Continuous,
    Prismatic,
    Fixed,
    Planar,
    Floating,
}

impl UrdfJointType {
    pub const WORDS: [&str; 6] = ["revolute", "continuous", "prismatic", "fixed", "planar", "floating"];

    /// The format's word for it.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    pub fn turns(self) -> bool {
        matches!(self, Self::Revolute | Self::Continuous)
    }
}

/// Positions in m or rad, effort in N or N m, velocity in m/s or rad/s; `None` for no limit.
#[derive(Clone, Debug)]
pub struct Limits {
    pub lower: Option<Number>,
    pub upper: Option<Number>,
    pub effort: Option<Number>,
    pub velocity: Option<Number>,
}

/// position = multiplier · position of `joint` + offset.
#[derive(Clone, Debug)]
pub struct Mimic {
    pub joint: usize,
    pub multiplier: f64,
    pub offset: f64,
}

#[derive(Clone, Debug)]
pub struct Joint {
    pub name: String,
    pub span: Span,
    pub kind: UrdfJointType,
    pub parent: usize,
    pub child: usize,
    pub origin: Origin,
    /// Axis in the child's frame; of any length but zero.
    pub axis: [f64; 3],
    pub damping: Number,
    pub friction: Number,
    pub limits: Option<Limits>,
    pub mimic: Option<Mimic>,
}

#[derive(Clone, Debug, Default)]
pub struct Robot {
    pub name: String,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
    pub root: usize,
    /// Joints, each behind the one that moves its parent.
    pub order: Vec<usize>,
}

impl Robot {
    /// Whether it has no joints that move.
    pub fn is_rigid(&self) -> bool {
        self.joints.iter().all(|joint| joint.kind == UrdfJointType::Fixed)
    }

    /// Whether a link has mass.
    pub fn has_mass(&self) -> bool {
        self.links.iter().filter_map(|link| link.inertial.as_ref()).any(|inertial| inertial.mass.value > 0.0)
    }

    /// Every number that can be a parameter, in the file's order.
    pub fn numbers(&self) -> impl Iterator<Item = &Number> {
        let links = self.links.iter().filter_map(|link| link.inertial.as_ref()).flat_map(|inertial| {
            let origin = inertial.origin.xyz.iter().chain(&inertial.origin.rpy);
            std::iter::once(&inertial.mass).chain(&inertial.inertia).chain(origin)
        });
        let joints = self.joints.iter().flat_map(|joint| {
            let limits = joint.limits.iter().flat_map(|l| [&l.lower, &l.upper, &l.effort, &l.velocity]).flatten();
            joint.origin.xyz.iter().chain(&joint.origin.rpy).chain([&joint.damping, &joint.friction]).chain(limits)
        });
        links.chain(joints)
    }
}
