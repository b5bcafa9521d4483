//! The typed model: what a file says, checked, with every name resolved and every number in SI units.

use symdiff::Formula;

use crate::elements::JointKind;
use crate::elements::effects::EffectKind;
use crate::grammar::{Coordinate, JointCoordinate, PointRef, Rotation, TimeOrder};
use crate::methods::BoundsRequest;

/// A mechanism, its uncertain parameters and what is asked of it.
///
/// A `Description` is consistent: every index is in range, every formula's names resolve (through
/// [`Description::referent`]) in their context, every dimension agrees. Formulas give SI values.
#[derive(Clone, Debug)]
pub struct Description {
    /// Short name; output folder and titles.
    pub name: String,
    /// One line for people.
    pub description: Option<String>,
    /// Whether the mechanism stays in the plane.
    pub space: Space,
    /// The tree of a URDF, where the model names one.
    pub robot: Option<RobotTree>,
    /// In an order in which each depends only on earlier ones.
    pub parameters: Vec<Parameter>,
    /// `bodies[0]` is the ground: no coordinates, no mass, perhaps points.
    pub bodies: Vec<Body>,
    /// In file order.
    pub joints: Vec<Joint>,
    /// In file order.
    pub effects: Vec<Effect>,
    /// Coordinates and velocities that are kept at the start, with their values.
    pub initial: Vec<StartValue>,
    /// Where assembly begins to look for the others.
    pub guess: Vec<StartValue>,
    /// What is observed.
    pub outputs: Vec<Output>,
    /// How time is stepped.
    pub simulation: Simulation,
    /// Which bounds are asked for.
    pub bounds: BoundsRequest,
}

/// The links and joints of a URDF, which the bodies and joints of the model were made of.
#[derive(Clone, Debug)]
pub struct RobotTree {
    /// As the file calls it.
    pub name: String,
    /// Each behind its parent.
    pub links: Vec<TreeLink>,
}

/// A link of a URDF.
#[derive(Clone, Debug)]
pub struct TreeLink {
    /// Its name in formulas.
    pub name: String,
    /// Joints between it and the root.
    pub depth: usize,
    /// kg, where the file has one.
    pub mass: Option<f64>,
    /// Its frame; absent where the link is left out.
    pub place: Option<PointRef>,
    /// The joint that leads to it; absent for the root.
    pub joint: Option<TreeJoint>,
}

/// A joint of a URDF.
#[derive(Clone, Debug)]
pub struct TreeJoint {
    /// Its name in formulas.
    pub name: String,
    /// The file's word for it.
    pub kind: &'static str,
    /// In the child's frame, where the joint has one coordinate.
    pub axis: Option<[f64; 3]>,
    /// Smallest and largest position.
    pub limits: Option<[f64; 2]>,
    /// rad or m, of its position.
    pub unit: &'static str,
    /// N m s/rad or N s/m
    pub damping: f64,
    /// N m or N
    pub friction: f64,
    /// The joint that it follows.
    pub mimics: Option<String>,
}

/// In how many dimensions a mechanism moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Space {
    /// Whether a body that says nothing else has six freedoms, and joints hold bodies in all of them. A planar
    /// mechanism has z = 0 everywhere and turns about z only.
    pub spatial: bool,
    /// For people: what leaves the plane, or that nothing does.
    pub why: String,
}

/// A named number: certain, or known to lie in an interval.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name in formulas.
    pub name: String,
    /// SI unit for people, e.g. `m` or `N*s/m`; empty where none was given.
    pub unit: String,
    /// What it is.
    pub value: ParameterValue,
}

impl Description {
    /// Nothing yet, in the plane, for a second.
    pub(crate) fn empty(name: String) -> Self {
        Self {
            name,
            description: None,
            space: Space { spatial: false, why: String::new() },
            robot: None,
            parameters: Vec::new(),
            bodies: Vec::new(),
            joints: Vec::new(),
            effects: Vec::new(),
            initial: Vec::new(),
            guess: Vec::new(),
            outputs: Vec::new(),
            simulation: Simulation {
                duration: 1.0,
                stepping: Stepping::Fixed(1e-3),
                alpha: -0.1,
                output_step: 0.01,
                formulation: Formulation::Auto,
            },
            bounds: BoundsRequest::default(),
        }
    }

    /// The parameters that are known to lie in an interval, with their indices.
    pub fn uncertain(&self) -> impl Iterator<Item = (usize, &Parameter)> {
        let interval =
            |(_, parameter): &(usize, &Parameter)| matches!(parameter.value, ParameterValue::Interval { .. });
        self.parameters.iter().enumerate().filter(interval)
    }
}

/// What is known of a parameter.
#[derive(Clone, Debug)]
pub enum ParameterValue {
    /// A number or a formula of other parameters.
    Formula(Formula),
    /// Somewhere in `[lower, upper]`, `lower ≤ nominal ≤ upper`.
    Interval {
        #[allow(missing_docs)]
        nominal: f64,
        #[allow(missing_docs)]
        lower: f64,
        #[allow(missing_docs)]
        upper: f64,
    },
}

/// Elements of a body's inertia tensor about its centre of mass, along its frame's axes, kg m². I_xy = −∫ x y dm, as in
/// URDF. A body that only turns about z needs no more than zz.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct Inertia {
    pub xx: Formula,
    pub yy: Formula,
    pub zz: Formula,
    pub xy: Formula,
    pub xz: Formula,
    pub yz: Formula,
}

impl Inertia {
    /// The same about every axis.
    pub fn scalar(value: &Formula) -> Self {
        let zero = || Formula::number(0.0);
        Self { xx: value.clone(), yy: value.clone(), zz: value.clone(), xy: zero(), xz: zero(), yz: zero() }
    }
}

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// kg; absent only where no declared coordinate needs it (ground), and of a beam's node, which its elements make heavy.
    pub mass: Option<Formula>,
    /// Absent only where the body does not turn, and of a beam's node.
    pub inertia: Option<Inertia>,
    /// Centre of mass in the body's frame, m; by default the origin.
    pub center_of_mass: Option<[Formula; 3]>,
    /// The coordinates that the body has; the others are held. Empty for the ground.
    pub coordinates: Vec<Coordinate>,
    /// Values of coordinates that the body does not have (zero where not named).
    pub held: Vec<(Coordinate, Formula)>,
    /// Orientation of a body that does not turn, where it is more than an angle about z.
    pub held_orientation: Option<Rotation>,
    /// Named points in the body's frame, m.
    pub points: Vec<Point>,
}

impl Body {
    /// Whether its orientation is that of Euler parameters, and not an angle about z.
    pub fn has_orientation(&self) -> bool {
        self.held_orientation.is_some() || self.coordinates.contains(&Coordinate::Euler(0))
    }

    /// Whether nothing of it is held, so that a joint alone may say where it is.
    pub fn is_free(&self, spatial: bool) -> bool {
        let has = |coordinate: &Coordinate| self.coordinates.contains(coordinate);
        let freedoms: &[Coordinate] = if spatial {
            &[Coordinate::X, Coordinate::Y, Coordinate::Z, Coordinate::Euler(0)]
        } else {
            &[Coordinate::X, Coordinate::Y, Coordinate::Angle]
        };
        freedoms.iter().all(has) && self.held.is_empty()
    }
}

/// A named point of a body, and a frame there.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its name within the body.
    pub name: String,
    /// In the body's frame, m.
    pub position: [Formula; 3],
    /// From the frame at the point to the body's; absent where their axes are parallel.
    pub rotation: Option<Rotation>,
}

/// A named joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// What it constrains.
    pub kind: JointKind,
    /// Whether both bodies move as one, so that there is no reaction between them; of a weld, and set by `reduce`.
    pub merged: bool,
}

impl Joint {
    /// A joint whose bodies move as two.
    pub fn new(name: String, kind: JointKind) -> Self {
        Self { name, kind, merged: false }
    }
}

/// A named effect.
#[derive(Clone, Debug)]
pub struct Effect {
    /// Its name.
    pub name: String,
    /// What it does.
    pub kind: EffectKind,
}

/// A value at the start; formulas are of parameters.
#[derive(Clone, Debug)]
pub enum StartValue {
    /// Of a coordinate.
    Coordinate {
        /// Body index, not the ground.
        body: usize,
        /// One that the body has.
        coordinate: Coordinate,
        /// Position or velocity.
        order: TimeOrder,
        #[allow(missing_docs)]
        value: Formula,
    },
    /// Of a body's Euler parameters.
    Orientation {
        /// Body index.
        body: usize,
        #[allow(missing_docs)]
        rotation: Rotation,
    },
    /// Of a body that has an orientation, rad/s.
    AngularVelocity {
        /// Body index.
        body: usize,
        #[allow(missing_docs)]
        value: [Formula; 3],
        /// Components in the body's frame instead of the ground's.
        in_body: bool,
    },
    /// Of a joint's coordinate.
    Joint {
        /// Joint index.
        joint: usize,
        #[allow(missing_docs)]
        coordinate: JointCoordinate,
        /// Position or velocity.
        order: TimeOrder,
        #[allow(missing_docs)]
        value: Formula,
    },
}

/// Something observed.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its name in files and plots.
    pub name: String,
    /// Formula over names of [`Description::referent`].
    pub formula: Formula,
    /// SI unit derived from the formula, for axes; empty where dimensionless or unknown.
    pub unit: String,
}

/// How time is stepped.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// s
    pub duration: f64,
    /// Fixed, or controlled.
    pub stepping: Stepping,
    /// HHT parameter α ∈ [−1/3, 0).
    pub alpha: f64,
    /// s between rows of output.
    pub output_step: f64,
    /// By which coordinates the motion is described.
    pub formulation: Formulation,
}

/// By which coordinates a motion is described; the motion is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Formulation {
    /// Whichever takes fewer instructions.
    #[default]
    Auto,
    /// Each body has its own, and joints constrain them.
    Absolute,
    /// Those of the joints, of which each carries a body; joints that close loops constrain them.
    Joint,
}

/// How steps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping {
    /// Every step this long, s.
    Fixed(f64),
    /// Steps' local position errors add up to no more than this over the run, relative to |q|, or to the model's size where that
    /// is larger.
    Tolerance(f64),
}
