//! The typed model: what a file says, checked, with every name resolved and every number in SI units.

use symdiff::Formula;

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

/// A planar coordinate of a body's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Coordinate {
    /// Position of the frame's origin along the ground's x, m.
    X,
    /// Position of the frame's origin along the ground's y, m.
    Y,
    /// Angle of the frame against the ground, rad, counter-clockwise, never wrapped.
    Angle,
}

/// A rigid planar body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// kg; absent only where no declared coordinate needs it (ground).
    pub mass: Option<Formula>,
    /// About the centre of mass, kg m²; absent only where the angle is not a coordinate.
    pub inertia: Option<Formula>,
    /// Centre of mass in the body's frame, m; by default the origin.
    pub center_of_mass: Option<[Formula; 2]>,
    /// The coordinates that the body has; the others are held. Empty for the ground.
    pub coordinates: Vec<Coordinate>,
    /// Values of coordinates that the body does not have (zero where not named).
    pub held: Vec<(Coordinate, Formula)>,
    /// Named points in the body's frame, m.
    pub points: Vec<Point>,
}

/// A named point of a body.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its name within the body.
    pub name: String,
    /// In the body's frame, m.
    pub position: [Formula; 2],
}

/// A point of a body; the frame's origin where `point` is absent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointRef {
    /// Index into [`Description::bodies`]; 0 is the ground.
    pub body: usize,
    /// Index into that body's points.
    pub point: Option<usize>,
}

/// A named joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// What it constrains.
    pub kind: JointKind,
}

/// What a joint constrains; equations stand in `mechanics::joints`.
#[derive(Clone, Debug)]
pub enum JointKind {
    /// Two points coincide.
    Revolute {
        #[allow(missing_docs)]
        between: [PointRef; 2],
    },
    /// The second point moves along a line through the first, fixed in the first body; no relative rotation:
    /// angle₂ − angle₁ = `angle`.
    Prismatic {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// Direction in the first body's frame; any length but zero.
        axis: [Formula; 2],
        /// rad
        angle: Formula,
    },
    /// Welded: points coincide and angle₂ − angle₁ = `angle`.
    Fixed {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// rad
        angle: Formula,
    },
    /// The second point moves along a line through the first, fixed in the first body; it may turn.
    PinInSlot {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// Direction in the first body's frame; any length but zero.
        axis: [Formula; 2],
    },
    /// The points keep a distance, m.
    Distance {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// m, > 0
        length: Formula,
    },
    /// angle₂ = ratio · angle₁ + offset. An external gear pair has a negative ratio.
    Gear {
        /// Body indices.
        between: [usize; 2],
        #[allow(missing_docs)]
        ratio: Formula,
        /// rad
        offset: Formula,
    },
    /// left = right, a formula of coordinates, points, parameters and t.
    Equation {
        #[allow(missing_docs)]
        left: Formula,
        #[allow(missing_docs)]
        right: Formula,
    },
}

/// A named effect.
#[derive(Clone, Debug)]
pub struct Effect {
    /// Its name.
    pub name: String,
    /// What it does.
    pub kind: EffectKind,
}

/// What an effect does; formulas stand in `mechanics::effects`. Values may depend on parameters, t, positions and
/// velocities.
#[derive(Clone, Debug)]
pub enum EffectKind {
    /// The same acceleration on every body, m/s².
    Gravity {
        #[allow(missing_docs)]
        acceleration: [Formula; 2],
    },
    /// A force at a point, N.
    Force {
        #[allow(missing_docs)]
        on: PointRef,
        #[allow(missing_docs)]
        value: [Formula; 2],
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
        value: Formula,
    },
    /// Between two points: along their connecting line, or along an axis of the ground.
    SpringDamper {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// Direction in the ground's frame; absent: along the connecting line.
        along: Option<[Formula; 2]>,
        /// N/m
        stiffness: Formula,
        /// N s/m
        damping: Formula,
        /// m
        free_length: Formula,
    },
    /// Between two bodies' angles.
    TorsionalSpringDamper {
        /// Body indices.
        between: [usize; 2],
        /// N m/rad
        stiffness: Formula,
        /// N m s/rad
        damping: Formula,
        /// rad
        free_angle: Formula,
    },
}

impl EffectKind {
    /// The word for it in a model file.
    pub fn keyword(&self) -> &'static str {
        match self {
            Self::Gravity { .. } => "gravity",
            Self::Force { .. } => "force",
            Self::Torque { .. } => "torque",
            Self::SpringDamper { .. } => "spring_damper",
            Self::TorsionalSpringDamper { .. } => "torsional_spring_damper",
        }
    }
}

/// How often a quantity is differentiated by time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum TimeOrder {
    Position,
    Velocity,
    Acceleration,
}

/// A value at the start.
#[derive(Clone, Debug)]
pub struct StartValue {
    /// Body index, not the ground.
    pub body: usize,
    /// One that the body has.
    pub coordinate: Coordinate,
    /// Position or velocity.
    pub order: TimeOrder,
    /// Formula of parameters.
    pub value: Formula,
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

/// What a name in a formula stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Referent {
    /// Index into [`Description::parameters`].
    Parameter(usize),
    /// `t`, s.
    Time,
    /// `body.x`, `.y`, `.angle`, `.vx`, `.vy`, `.angular_velocity`, `.ax`, `.ay`, `.angular_acceleration`.
    Coordinate {
        #[allow(missing_docs)]
        body: usize,
        #[allow(missing_docs)]
        coordinate: Coordinate,
        #[allow(missing_docs)]
        order: TimeOrder,
    },
    /// `body.point.x`, `.y`, `.vx`, `.vy`, `.ax`, `.ay`; `coordinate` is X or Y.
    Point {
        #[allow(missing_docs)]
        body: usize,
        #[allow(missing_docs)]
        point: usize,
        #[allow(missing_docs)]
        coordinate: Coordinate,
        #[allow(missing_docs)]
        order: TimeOrder,
    },
    /// `joint.force`, `.force.x`, `.force.y`, `.torque`.
    Reaction {
        #[allow(missing_docs)]
        joint: usize,
        #[allow(missing_docs)]
        component: ReactionComponent,
    },
    /// `energy`, `kinetic_energy`, `potential_energy`, J.
    Energy(EnergyKind),
}

/// Part of a joint's reaction on its second body, in the ground's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReactionComponent {
    /// Magnitude of the force, N.
    Force,
    /// N
    ForceX,
    /// N
    ForceY,
    /// N m, about the second point.
    Torque,
}

/// Which energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum EnergyKind {
    Total,
    Kinetic,
    Potential,
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
}

/// How steps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping {
    /// Every step this long, s.
    Fixed(f64),
    /// Local position error kept below this, relative to |q|, or to the model's size where that is larger.
    Tolerance(f64),
}

/// A bounding method's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeKind {
    /// Interval evaluation term by term (the paper's).
    Interval,
    /// The polynomial's own range.
    Tight,
}

/// What a Chebyshev surrogate expands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expand {
    /// The independent coordinates and their velocities; outputs follow from them.
    Coordinates,
    /// Each output (the paper's).
    Output,
}

/// Which bounds are asked for; per-parameter vectors run over the uncertain parameters in file order.
#[derive(Clone, Debug, Default)]
pub struct BoundsRequest {
    #[allow(missing_docs)]
    pub chebyshev: Option<ChebyshevRequest>,
    #[allow(missing_docs)]
    pub taylor: Option<TaylorRequest>,
    #[allow(missing_docs)]
    pub scan: Option<ScanRequest>,
    /// Bounds that are proven.
    pub certified: bool,
}

/// Chebyshev bounds.
#[derive(Clone, Debug)]
pub struct ChebyshevRequest {
    /// Degree per parameter.
    pub order: Vec<usize>,
    /// Nodes per parameter, more than the degree.
    pub nodes: Vec<usize>,
    #[allow(missing_docs)]
    pub expand: Expand,
    /// Of the outputs' polynomials, where those are expanded.
    pub range: RangeKind,
}

/// Taylor bounds.
#[derive(Clone, Debug)]
pub struct TaylorRequest {
    /// Total degree.
    pub order: usize,
    #[allow(missing_docs)]
    pub range: RangeKind,
}

/// Scanning bounds.
#[derive(Clone, Debug)]
pub struct ScanRequest {
    /// Points per parameter, both ends included.
    pub points: Vec<usize>,
}

/// Simulations that one method may ask for.
pub const MOST_SOLVES: f64 = 1e7;

impl ChebyshevRequest {
    /// Degree where a model asks for none.
    pub const ORDER: usize = 5;

    /// One degree for each of k parameters, one node more than the degree, the tight range.
    pub fn of_order(order: usize, k: usize) -> Self {
        Self { order: vec![order; k], nodes: vec![order + 1; k], expand: Expand::Output, range: RangeKind::Tight }
    }
}

impl TaylorRequest {
    /// Degree where a model asks for none, the paper's.
    pub const ORDER: usize = 2;
}

impl Default for TaylorRequest {
    /// The usual order, the tight range.
    fn default() -> Self {
        Self { order: Self::ORDER, range: RangeKind::Tight }
    }
}

impl ScanRequest {
    /// Points a parameter where a model asks for none, the paper's.
    pub const POINTS: usize = 30;

    /// One number of points for each of k parameters.
    pub fn of_points(points: usize, k: usize) -> Self {
        Self { points: vec![points; k] }
    }
}
