//! The kinds of effects of a [`Description`](super::Description), with their details.

use symdiff::Formula;

use crate::grammar::quantity::Dimension;
use crate::grammar::{JointCoordinate, Measure, OnJoint, PointRef, Turning};

/// What an effect does; formulas stand in `mechanics::effects`. Values may depend on parameters, t, positions and
/// velocities.
#[derive(Clone, Debug)]
pub enum EffectKind {
    /// The same acceleration on every body, m/s².
    Gravity {
        #[allow(missing_docs)]
        acceleration: [Formula; 3],
    },
    /// A force at a point, N.
    Force {
        #[allow(missing_docs)]
        on: PointRef,
        #[allow(missing_docs)]
        value: [Formula; 3],
        /// Components in the body's frame instead of the ground's.
        in_body: bool,
    },
    /// A torque on a body, N m; its reaction acts on `from` (0: the ground).
    Torque {
        /// Body index.
        on: usize,
        /// Body index.
        from: usize,
        #[allow(missing_docs)]
        value: [Formula; 3],
        /// Components in the frame of `on` instead of the ground's.
        in_body: bool,
    },
    /// A torque on a joint's second body about the joint's axis, N m; its reaction acts on the first body.
    JointTorque {
        /// Joint index.
        joint: usize,
        #[allow(missing_docs)]
        value: Formula,
    },
    /// Between two points: along their connecting line, or along an axis of the ground.
    SpringDamper {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// Direction in the ground's frame; absent: along the connecting line.
        along: Option<[Formula; 3]>,
        /// N/m
        stiffness: Formula,
        /// N s/m
        damping: Formula,
        /// m
        free_length: Formula,
        /// Tension, N, added to that of stiffness and damping; may speak of the spring's own length and rate.
        force: Option<Formula>,
    },
    /// Between two bodies' angles, or on the angle of a joint.
    TorsionalSpringDamper {
        #[allow(missing_docs)]
        on: Twisted,
        /// N m/rad
        stiffness: Formula,
        /// N m s/rad
        damping: Formula,
        /// rad
        free_angle: Formula,
        /// Torque against the twist, N m, added to that of stiffness and damping; may speak of the spring's own angle and
        /// rate.
        torque: Option<Formula>,
    },
    /// Springs and dampers between two frames, along and about the axes of the first.
    Bushing {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// N/m
        stiffness: [Formula; 3],
        /// N s/m
        damping: [Formula; 3],
        /// N m/rad
        torsional_stiffness: [Formula; 3],
        /// N m s/rad
        torsional_damping: [Formula; 3],
        /// Rows of forces, then torques, by displacements, then rotations; added to the above.
        stiffness_matrix: Option<Box<[[Formula; 6]; 6]>>,
        /// The same by rates.
        damping_matrix: Option<Box<[[Formula; 6]; 6]>>,
    },
    /// Friction in a joint.
    JointFriction(JointFriction),
    /// Ends of a joint's way.
    Stop(Stop),
    /// Contact of two surfaces.
    Contact(Contact),
    /// A journal that is loose in its bearing.
    ClearanceJoint(ClearanceJoint),
    /// A controlled drive of a joint.
    Servo(Servo),
    /// Resistance of a fluid.
    Drag(Drag),
    /// Pulls, and does not push.
    Cable(Cable),
    /// A gear pair whose teeth have play.
    Backlash(Backlash),
    /// A constant tension.
    Preload(Preload),
    /// A beam of the plane: a massless one, or an element of a flexible body.
    Beam(Beam),
}

/// How dry friction depends on the speed of sliding.
#[derive(Clone, Debug)]
pub struct DryFriction {
    /// Of the load, while sliding fast.
    pub coefficient: Formula,
    /// Friction at rest over that while sliding fast, at least 1.
    pub breakaway: Formula,
    /// Speed at which the excess over sliding friction has fallen to 1/e; absent where there is none.
    pub stribeck: Option<Formula>,
    /// Speed that counts as rest: friction is 71 % of itself there.
    pub transition: Formula,
}

/// Which motions of a joint friction resists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rubbing {
    /// Its turning: revolute joints.
    Turning,
    /// Its sliding: prismatic joints.
    Sliding,
    /// Both at once: cylindrical joints.
    Both,
}

/// Friction in a joint; speeds are rad/s where it only turns, else m/s at the surface.
#[derive(Clone, Debug)]
pub struct JointFriction {
    /// Joint index.
    pub joint: usize,
    #[allow(missing_docs)]
    pub rubbing: Rubbing,
    #[allow(missing_docs)]
    pub dry: DryFriction,
    /// That part of the dry friction that has nothing to do with the load; N m where the joint only turns, else N.
    pub coulomb: Formula,
    /// N m s/rad where the joint only turns, else N s/m.
    pub viscous: Formula,
    /// Of the pin, m.
    pub radius: Formula,
    /// Of the bearing along the axis, m: with it the torque across the axis presses on its ends.
    pub length: Option<Formula>,
}

/// How two bodies push each other apart as they touch, by the depth δ to which they do.
#[derive(Clone, Debug)]
pub struct Impact {
    /// N/m^exponent, N m/rad^exponent
    pub stiffness: Formula,
    #[allow(missing_docs)]
    pub exponent: f64,
    #[allow(missing_docs)]
    pub loss: Loss,
}

/// What an impact takes away.
#[derive(Clone, Debug)]
pub enum Loss {
    /// χ, s/m or s/rad.
    Dissipation(Formula),
    /// χ follows from what is left of a speed.
    Restitution {
        #[allow(missing_docs)]
        law: RestitutionLaw,
        /// Speed after over speed before.
        restitution: Formula,
        /// Speed before, m/s or rad/s.
        velocity: Formula,
    },
}

/// Whose formula gives χ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestitutionLaw {
    /// Hunt & Crossley 1975.
    HuntCrossley,
    /// Lankarani & Nikravesh 1990.
    LankaraniNikravesh,
}

/// Ends of a joint's way.
#[derive(Clone, Debug)]
pub struct Stop {
    #[allow(missing_docs)]
    pub on: OnJoint,
    /// m or rad
    pub lower: Option<Formula>,
    /// m or rad
    pub upper: Option<Formula>,
    #[allow(missing_docs)]
    pub impact: Impact,
}

/// The surface at the first point of a contact.
#[derive(Clone, Debug)]
pub enum Surface {
    /// A plane through the point with this normal, a direction of the point's frame, on whose side the other body is.
    Plane([Formula; 3]),
    /// A circle (in space a sphere or, with an axis, a cylinder) around the point, of this radius, m.
    Round(Formula),
    /// The same, hollow: the other body is inside.
    Hollow(Formula),
}

/// Contact of the surface at a first point with a circle, sphere, cylinder or mere point around the second.
#[derive(Clone, Debug)]
pub struct Contact {
    #[allow(missing_docs)]
    pub between: [PointRef; 2],
    #[allow(missing_docs)]
    pub surface: Surface,
    /// Of what is around the second point, m.
    pub radius: Formula,
    /// Of two cylinders, in the first point's frame; absent for circles and spheres.
    pub axis: Option<[Formula; 3]>,
    #[allow(missing_docs)]
    pub impact: Impact,
    #[allow(missing_docs)]
    pub friction: Option<DryFriction>,
}

/// A journal that is loose in its bearing.
#[derive(Clone, Debug)]
pub struct ClearanceJoint {
    /// The bearing's centre, then the journal's.
    pub between: [PointRef; 2],
    /// The bearing's radius less the journal's, m.
    pub clearance: Formula,
    /// The journal's, m.
    pub radius: Formula,
    /// In the bearing's frame; z in the plane.
    pub axis: [Formula; 3],
    #[allow(missing_docs)]
    pub impact: Impact,
    #[allow(missing_docs)]
    pub friction: Option<DryFriction>,
}

/// Torque or force of a controlled drive.
#[derive(Clone, Debug)]
pub struct Servo {
    #[allow(missing_docs)]
    pub on: OnJoint,
    /// Wanted coordinate over time, rad or m.
    pub target: Formula,
    /// N m/rad or N/m
    pub proportional: Formula,
    /// N m s/rad or N s/m
    pub derivative: Formula,
    /// Largest torque or force, N m or N.
    pub limit: Option<Formula>,
}

/// Resistance of a fluid at a point.
#[derive(Clone, Debug)]
pub struct Drag {
    #[allow(missing_docs)]
    pub on: PointRef,
    /// Their product is the force by the square of the speed, N s²/m².
    pub quadratic: Vec<Formula>,
    /// N s/m
    pub linear: Formula,
    /// Velocity of the fluid, m/s.
    pub wind: [Formula; 3],
}

/// A cable between two points.
#[derive(Clone, Debug)]
pub struct Cable {
    #[allow(missing_docs)]
    pub between: [PointRef; 2],
    /// Without tension, m.
    pub free_length: Formula,
    /// N/m
    pub stiffness: Formula,
    /// N s/m
    pub damping: Formula,
    /// Stretch over which it becomes taut, either way, m.
    pub transition: Formula,
}

/// A gear pair with play.
#[derive(Clone, Debug)]
pub struct Backlash {
    #[allow(missing_docs)]
    pub between: [Turning; 2],
    /// Angle of the second per angle of the first.
    pub ratio: Formula,
    /// rad
    pub offset: Formula,
    /// Angle by which the second can turn while the first is held, rad.
    pub backlash: Formula,
    /// Of the teeth, at the second, N m/rad.
    pub stiffness: Formula,
    /// N m s/rad
    pub damping: Formula,
    /// Angle over which teeth come to bear, either way, rad.
    pub transition: Formula,
}

/// A constant tension.
#[derive(Clone, Debug)]
pub struct Preload {
    #[allow(missing_docs)]
    pub on: Preloaded,
    /// Pulls the points together, N; or pushes the joint's coordinate up, N or N m.
    pub value: Formula,
}

/// What a preload acts between.
#[derive(Clone, Copy, Debug)]
pub enum Preloaded {
    /// Two points, along the line between them.
    Points([PointRef; 2]),
    /// The bodies of a joint, along or about its axis.
    Joint(OnJoint),
}

/// A beam of the plane between two bodies that turn about z.
#[derive(Clone, Debug)]
pub struct Beam {
    #[allow(missing_docs)]
    pub between: [PointRef; 2],
    /// Of the straight beam, in both bodies' frames.
    pub axis: [Formula; 3],
    /// m
    pub length: Formula,
    /// EA, N
    pub axial_stiffness: Formula,
    /// EI, N m²
    pub bending_stiffness: Formula,
    /// τ, s
    pub damping: Formula,
    /// μ, kg/m; absent where it is massless. The bodies of an element with mass need none of their own.
    pub mass_per_length: Option<Formula>,
}

/// Whose angle a torsional spring twists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Twisted {
    /// angle₂ − angle₁ of two bodies, by index.
    Bodies([usize; 2]),
    /// The angle of a joint, by index.
    Joint(usize),
}

impl EffectKind {
    /// The word for it in a model file.
    pub fn keyword(&self) -> &'static str {
        match self {
            Self::Gravity { .. } => "gravity",
            Self::Force { .. } => "force",
            Self::Torque { .. } | Self::JointTorque { .. } => "torque",
            Self::SpringDamper { .. } => "spring_damper",
            Self::TorsionalSpringDamper { .. } => "torsional_spring_damper",
            Self::Bushing { .. } => "bushing",
            Self::JointFriction(_) => "joint_friction",
            Self::Stop(_) => "stop",
            Self::Contact(_) => "contact",
            Self::ClearanceJoint(_) => "clearance_joint",
            Self::Servo(_) => "servo",
            Self::Drag(_) => "drag",
            Self::Cable(_) => "cable",
            Self::Backlash(_) => "backlash",
            Self::Preload(_) => "preload",
            Self::Beam(_) => "beam",
        }
    }

    /// What it measures, for outputs.
    pub fn measures(&self) -> Vec<(Measure, Dimension)> {
        let effort = |coordinate: JointCoordinate| match coordinate {
            JointCoordinate::Angle => (Measure::Torque, Dimension::TORQUE),
            JointCoordinate::Displacement => (Measure::Force, Dimension::FORCE),
        };
        let (length, speed) = ((Measure::Length, Dimension::LENGTH), (Measure::Rate, Dimension::VELOCITY));
        let (angle, spin) = ((Measure::Angle, Dimension::ANGLE), (Measure::Rate, Dimension::ANGULAR_VELOCITY));
        let (force, torque) = ((Measure::Force, Dimension::FORCE), (Measure::Torque, Dimension::TORQUE));
        let gap = (Measure::Gap, Dimension::LENGTH);
        let friction = (Measure::Friction, Dimension::FORCE);
        let load = (Measure::Load, Dimension::FORCE);
        match self {
            Self::SpringDamper { .. } | Self::Cable(_) => vec![length, speed, force],
            Self::TorsionalSpringDamper { .. } => vec![angle, spin, torque],
            Self::Backlash(_) => vec![angle, spin, torque],
            Self::JointFriction(JointFriction { rubbing, .. }) => match rubbing {
                Rubbing::Turning => vec![load, torque],
                Rubbing::Sliding => vec![load, force],
                Rubbing::Both => vec![load, force, torque],
            },
            Self::Stop(Stop { on, .. }) | Self::Servo(Servo { on, .. }) => vec![effort(on.coordinate)],
            Self::Contact(_) | Self::ClearanceJoint(_) => vec![gap, speed, force, friction],
            Self::Drag(_) => vec![force],
            Self::Beam(_) => vec![length, force, torque, (Measure::StartTorque, Dimension::TORQUE)],
            Self::Gravity { .. }
            | Self::Force { .. }
            | Self::Torque { .. }
            | Self::JointTorque { .. }
            | Self::Bushing { .. }
            | Self::Preload(_) => Vec::new(),
        }
    }

    /// Coordinates of joints that it acts on.
    pub fn coordinates(&self) -> Vec<OnJoint> {
        let angle = |joint: usize| OnJoint { joint, coordinate: JointCoordinate::Angle };
        match self {
            Self::TorsionalSpringDamper { on: Twisted::Joint(joint), .. } => vec![angle(*joint)],
            Self::Stop(Stop { on, .. })
            | Self::Servo(Servo { on, .. })
            | Self::Preload(Preload { on: Preloaded::Joint(on), .. }) => vec![*on],
            Self::Backlash(Backlash { between, .. }) => {
                let joint = |turning: &Turning| match turning {
                    Turning::Joint(joint) => Some(angle(*joint)),
                    Turning::Body(_) => None,
                };
                between.iter().filter_map(joint).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Every formula in it.
    pub fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::Gravity { acceleration: value } | Self::Force { value, .. } | Self::Torque { value, .. } => {
                value.iter().collect()
            }
            Self::JointTorque { value, .. } => vec![value],
            Self::SpringDamper { along, stiffness, damping, free_length, force, .. } => {
                [stiffness, damping, free_length].into_iter().chain(along.iter().flatten()).chain(force).collect()
            }
            Self::TorsionalSpringDamper { stiffness, damping, free_angle, torque, .. } => {
                [stiffness, damping, free_angle].into_iter().chain(torque).collect()
            }
            Self::Bushing {
                stiffness,
                damping,
                torsional_stiffness,
                torsional_damping,
                stiffness_matrix,
                damping_matrix,
                ..
            } => {
                let diagonal = [stiffness, damping, torsional_stiffness, torsional_damping].into_iter().flatten();
                let full = [stiffness_matrix, damping_matrix].into_iter().flatten().flat_map(|m| m.iter().flatten());
                diagonal.chain(full).collect()
            }
            Self::JointFriction(JointFriction { dry, coulomb, viscous, radius, length, .. }) => {
                dry.formulas().into_iter().chain([coulomb, viscous, radius]).chain(length).collect()
            }
            Self::Stop(Stop { lower, upper, impact, .. }) => {
                lower.iter().chain(upper).chain(impact.formulas()).collect()
            }
            Self::Contact(Contact { surface, radius, axis, impact, friction, .. }) => {
                let surface = match surface {
                    Surface::Plane(normal) => normal.iter().collect(),
                    Surface::Round(radius) | Surface::Hollow(radius) => vec![radius],
                };
                let friction = friction.iter().flat_map(DryFriction::formulas);
                let shape = surface.into_iter().chain([radius]).chain(axis.iter().flatten());
                shape.chain(impact.formulas()).chain(friction).collect()
            }
            Self::ClearanceJoint(ClearanceJoint { clearance, radius, axis, impact, friction, .. }) => {
                let friction = friction.iter().flat_map(DryFriction::formulas);
                [clearance, radius].into_iter().chain(axis).chain(impact.formulas()).chain(friction).collect()
            }
            Self::Servo(Servo { target, proportional, derivative, limit, .. }) => {
                [target, proportional, derivative].into_iter().chain(limit).collect()
            }
            Self::Drag(Drag { quadratic, linear, wind, .. }) => quadratic.iter().chain([linear]).chain(wind).collect(),
            Self::Cable(Cable { free_length, stiffness, damping, transition, .. }) => {
                vec![free_length, stiffness, damping, transition]
            }
            Self::Backlash(Backlash { ratio, offset, backlash, stiffness, damping, transition, .. }) => {
                vec![ratio, offset, backlash, stiffness, damping, transition]
            }
            Self::Preload(Preload { value, .. }) => vec![value],
            Self::Beam(Beam { axis, length, axial_stiffness, bending_stiffness, damping, mass_per_length, .. }) => {
                let numbers = [length, axial_stiffness, bending_stiffness, damping];
                axis.iter().chain(numbers).chain(mass_per_length).collect()
            }
        }
    }
}

impl DryFriction {
    fn formulas(&self) -> Vec<&Formula> {
        [&self.coefficient, &self.breakaway, &self.transition].into_iter().chain(&self.stribeck).collect()
    }
}

impl Impact {
    fn formulas(&self) -> Vec<&Formula> {
        match &self.loss {
            Loss::Dissipation(dissipation) => vec![&self.stiffness, dissipation],
            Loss::Restitution { restitution, velocity, .. } => vec![&self.stiffness, restitution, velocity],
        }
    }
}
