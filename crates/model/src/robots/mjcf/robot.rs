//! Contents of an MJCF, typed, defaults applied: bodies, joints and their couplings and drives, lengths in m, angles in
//! rad.

use std::collections::{HashMap, HashSet};

use crate::robots::algebra::Quaternion;
use crate::robots::number::Number;
use crate::syntax::source::Span;

/// The whole; body 0 is the world.
pub struct Robot {
    pub gravity: [f64; 3],
    pub bodies: Vec<Body>,
    pub joints: Vec<Joint>,
    pub equalities: Vec<Equality>,
    pub tendons: Vec<Tendon>,
    pub actuators: Vec<Actuator>,
}

pub struct Body {
    /// Name in formulas.
    pub name: String,
    pub span: Span,
    pub parent: usize,
    /// Position in the parent's frame, m; rotation into it.
    pub position: [Number; 3],
    pub rotation: Quaternion,
    pub mass: Option<Mass>,
    /// The one nearest to the parent first.
    pub joints: Vec<usize>,
    pub sites: Vec<Site>,
}

/// A named frame of a body.
pub struct Site {
    pub name: String,
    pub position: [f64; 3],
    pub rotation: Quaternion,
}

/// Mass and inertia in a body's frame.
pub struct Mass {
    pub mass: Number,
    pub center: [Number; 3],
    /// Rotation from the frame of the inertia to the body's.
    pub rotation: Quaternion,
    /// xx, yy, zz, xy, xz, yz about the centre of mass.
    pub inertia: [Number; 6],
    /// Whether the inertia is that of geoms, and so in proportion to the mass.
    pub of_geoms: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MjcfType {
    Hinge,
    Slide,
    Ball,
    Free,
}

pub struct Joint {
    pub name: String,
    pub span: Span,
    pub kind: MjcfType,
    pub body: usize,
    /// Position in the body's frame.
    pub position: [f64; 3],
    /// Unit vector.
    pub axis: [f64; 3],
    pub damping: Number,
    pub friction: Number,
    pub armature: Number,
    pub stiffness: Number,
    /// Where the spring is without force, less the position in the file's configuration.
    pub spring_at: Number,
    /// The joint's position in the file's configuration.
    pub reference: f64,
    /// Less the reference.
    pub range: Option<[Number; 2]>,
    /// Range in which the force of its actuators stays.
    pub force_range: Option<[f64; 2]>,
    /// Time constant and damping ratio from which stiffness and damping follow.
    pub spring_damper: Option<[f64; 2]>,
}

impl Joint {
    /// Whether it has one coordinate.
    pub fn is_single(&self) -> bool {
        matches!(self.kind, MjcfType::Hinge | MjcfType::Slide)
    }

    /// The name of its coordinate, or of its rate.
    pub fn coordinate(&self, rate: bool) -> String {
        let member = match (self.kind, rate) {
            (MjcfType::Slide, false) => "displacement",
            (MjcfType::Slide, true) => "velocity",
            (_, false) => "angle",
            (_, true) => "angular_velocity",
        };
        format!("{}.{member}", self.name)
    }
}

/// A frame on a body: position, and rotation into the body's.
#[derive(Clone)]
pub struct At {
    pub body: usize,
    pub position: [f64; 3],
    pub rotation: Quaternion,
}

pub struct Equality {
    pub name: String,
    pub span: Span,
    pub what: Coupling,
}

pub enum Coupling {
    /// Two points coincide.
    Connect([At; 2]),
    /// Two frames coincide.
    Weld([At; 2]),
    /// The first is a polynomial of the second, each less its value in the file's configuration.
    Polynomial { first: Length, second: Option<Length>, coefficients: [f64; 5] },
}

/// A sum of joints' positions, each times a coefficient.
#[derive(Clone)]
pub struct Length {
    pub terms: Vec<(usize, f64)>,
}

pub struct Tendon {
    pub name: String,
    pub span: Span,
    pub length: Length,
    pub stiffness: Number,
    pub damping: Number,
    pub friction: Number,
    /// Lengths between which its spring is slack, less the length in the file's configuration.
    pub slack: [f64; 2],
}

/// Force of an actuator with a control u on its length ℓ = gear · (sum of positions).
pub enum ActuatorLaw {
    /// gain u + bias₀ + bias₁ ℓ + bias₂ ℓ̇
    Affine { gain: f64, bias: [f64; 3] },
    /// kp (u − ℓ) − kv ℓ̇
    Position { kp: Number, kv: Number },
    /// kv (u − ℓ̇)
    Velocity { kv: Number },
    /// −kv u ℓ̇
    Damper { kv: Number },
}

/// How an actuator's activation a follows its command u; without one it is u.
#[derive(Clone, Copy, Debug)]
pub enum Memory {
    /// ȧ = u
    Integrator,
    /// ȧ = (u − a)/T, with T in s
    Lag(f64),
}

pub struct Actuator {
    pub name: String,
    pub span: Span,
    pub on: Length,
    /// Value of the sum in the file's configuration.
    pub offset: f64,
    pub gear: Number,
    pub law: ActuatorLaw,
    /// Damping ratio from which the damping of the law follows.
    pub damping_ratio: Option<f64>,
    pub memory: Option<Memory>,
    pub control: Option<[f64; 2]>,
    pub force: Option<[f64; 2]>,
}

/// Objects that names of the file stand for.
#[derive(Default)]
pub struct Names {
    /// Names in formulas of bodies, of joints, and of the sites of each body.
    pub taken: HashSet<String>,
    pub taken_by_joints: HashSet<String>,
    pub taken_by_sites: HashMap<usize, HashSet<String>>,
    pub bodies: HashMap<String, usize>,
    pub joints: HashMap<String, usize>,
    /// Body, and index among its sites.
    pub sites: HashMap<String, (usize, usize)>,
}

impl Robot {
    /// Every number that can be a parameter, in the file's order.
    pub fn numbers(&self) -> impl Iterator<Item = &Number> {
        let bodies = self.bodies.iter().skip(1).flat_map(|body| {
            let mass = body.mass.iter().flat_map(|mass| {
                let own = if mass.of_geoms { 0 } else { 6 };
                std::iter::once(&mass.mass).chain(&mass.center[..own / 2]).chain(&mass.inertia[..own])
            });
            mass.chain(&body.position)
        });
        let joints = self.joints.iter().flat_map(|joint| {
            let own = [&joint.damping, &joint.friction, &joint.armature, &joint.stiffness, &joint.spring_at];
            own.into_iter().chain(joint.range.iter().flatten())
        });
        let tendons = self.tendons.iter().flat_map(|tendon| [&tendon.stiffness, &tendon.damping, &tendon.friction]);
        let actuators = self.actuators.iter().flat_map(|actuator| {
            let gains: Vec<&Number> = match &actuator.law {
                ActuatorLaw::Affine { .. } => Vec::new(),
                ActuatorLaw::Position { kp, kv } => vec![kp, kv],
                ActuatorLaw::Velocity { kv } | ActuatorLaw::Damper { kv } => vec![kv],
            };
            std::iter::once(&actuator.gear).chain(gains)
        });
        bodies.chain(joints).chain(tendons).chain(actuators)
    }
}
