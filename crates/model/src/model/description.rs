//! The typed model: what a file says, checked, with every name resolved and every number in SI units.

mod analysis;
mod black_box;
mod body;
mod design;
mod index;
mod reduced;
mod robot;
mod simulation;
mod start;
mod statistics;

use std::collections::{BTreeMap, BTreeSet};

use symdiff::Formula;

use crate::elements::effects::EffectKind;
use crate::elements::{JointKind, Trajectory};
pub use crate::expand::dimensions::{Chain, Link};
pub use crate::expand::instance::{Instance, InstanceKind};
pub use crate::expand::zones::{Zone, ZoneLaw, ZoneShape};
use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::quantity::Dimension;
use crate::methods::BoundsRequest;
pub use crate::robots::urdf::robot::{Shape, Visual};
pub use analysis::{Analysis, LinearisedAt, ModesRequest, ResponseRequest};
pub use black_box::{BlackBox, BoxOutput, FmuProgram, Program, Protocol, Refine};
pub use body::{Body, FlexibleBeam, Inertia, Point, Standing};
pub use design::{Design, Free, Objective};
use index::NameIndex;
pub use reduced::{Limit, ReducedKind, ReducedOutput, Requirement};
pub use robot::{RobotTree, TreeJoint, TreeLink};
pub use simulation::{Formulation, SchemeChoice, Simulation, Stepping};
pub use start::StartValue;
pub use statistics::{Correlation, Cost, Grade, Law, Statistics};

/// A mechanism, its uncertain parameters and its questions.
///
/// A `Description` is consistent: every index is in range, every formula's names resolve (through
/// [`Description::symbol`]) in their context, every dimension agrees. Formulas give SI values.
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
    /// Beams, of which the nodes are bodies and the elements effects.
    pub beams: Vec<FlexibleBeam>,
    /// In file order.
    pub joints: Vec<Joint>,
    /// In file order.
    pub effects: Vec<Effect>,
    /// Analysis.
    pub analysis: Analysis,
    /// The program that answers instead of a mechanism, if there is one.
    pub black_box: Option<BlackBox>,
    /// Questions about small vibrations.
    pub modes: ModesRequest,
    /// Whether the start is an equilibrium, near where assembly begins to look.
    pub starts_at_equilibrium: bool,
    /// Coordinates and velocities that are kept at the start, with their values.
    pub initial: Vec<StartValue>,
    /// Where assembly begins to look for the others.
    pub guess: Vec<StartValue>,
    /// Outputs.
    pub outputs: Vec<Output>,
    /// Reduced outputs: one number a motion.
    pub reduced: Vec<ReducedOutput>,
    /// Requirements on outputs.
    pub requirements: Vec<Requirement>,
    /// Nominal values that are free, and the objective for them.
    pub design: Option<Design>,
    /// Units in which outputs and reduced outputs are shown, by their names; the others in SI.
    pub display: BTreeMap<String, DisplayUnit>,
    /// Units other than SI in which parameters are written, by their names.
    pub parameter_units: BTreeMap<String, DisplayUnit>,
    /// How time is stepped.
    pub simulation: Simulation,
    /// Which bounds are asked for.
    pub bounds: BoundsRequest,
    /// Which statistics are asked for, and the parameters' laws.
    pub statistics: Statistics,
    /// Instances of assemblies, and effects on many, of which the parts have dots in their names.
    pub instances: Vec<Instance>,
    /// Ports of instances: the body or the point that each is.
    pub ports: BTreeMap<String, String>,
    /// Effects of instances on joints that turn: their sensors along the joint have the other sign in a mirror.
    pub turning_effects: BTreeSet<String>,
    /// Effects that are states, or have some.
    pub states: BTreeSet<String>,
    /// Functions of the time by their points.
    pub trajectories: Vec<Trajectory>,
    /// Chains of dimensions, with the outputs that close them.
    pub chains: Vec<Chain>,
    /// Zones, each of several parameters.
    pub zones: Vec<Zone>,
    /// Where parameters, bodies and joints are by name.
    pub places: Places,
}

/// Indices of named items.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// Of parameters.
    pub parameters: NameIndex,
    /// Of bodies.
    pub bodies: NameIndex,
    /// Of joints.
    pub joints: NameIndex,
}

/// In how many dimensions a mechanism moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Space {
    /// Whether a body has six degrees of freedom unless it declares its coordinates, and joints constrain all six. A
    /// planar mechanism has z = 0 everywhere and turns about z only.
    pub spatial: bool,
    /// For people: what leaves the plane, or that nothing does.
    pub why: String,
}

impl Space {
    /// Part of the model that leaves the plane, where that decides.
    pub fn because(&self) -> Option<&str> {
        Some(self.why.as_str()).filter(|why| self.spatial && why.ends_with("leaves the plane"))
    }
}

/// A named number: deterministic, or known to lie in an interval.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name in formulas.
    pub name: String,
    /// SI unit for people, e.g. `m` or `N*s/m`; empty where none was given.
    pub unit: String,
    /// Kind of the joint.
    pub value: ParameterValue,
}

/// Facts about a parameter.
#[derive(Clone, Debug)]
pub enum ParameterValue {
    /// A number or a formula of other parameters.
    Formula(Formula),
    /// Somewhere in `[lower, upper]`, `lower ≤ nominal ≤ upper`.
    Interval {
        /// Value without deviation, SI.
        nominal: f64,
        /// Smallest value, SI.
        lower: f64,
        /// Largest value, SI.
        upper: f64,
    },
}

/// A named joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// Constrained bodies.
    pub kind: JointKind,
}

impl Joint {
    /// A joint of a kind.
    pub fn new(name: String, kind: JointKind) -> Self {
        Self { name, kind }
    }
}

/// A named effect.
#[derive(Clone, Debug)]
pub struct Effect {
    /// Its name.
    pub name: String,
    /// Action.
    pub kind: EffectKind,
}

/// Something observed.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its name in files and plots.
    pub name: String,
    /// Formula over names of [`Description::symbol`].
    pub formula: Formula,
    /// SI unit derived from the formula, for axes; empty where dimensionless or unknown.
    pub unit: String,
    /// What kind of quantity it is; `None` where unknown.
    pub dimension: Option<Dimension>,
    /// Whether the formula names results of the analysis, and other outputs: it is known when these are.
    pub of_results: bool,
}

impl Description {
    /// Nothing yet, in the plane, for a second.
    pub fn empty(name: String) -> Self {
        Self {
            name,
            description: None,
            space: Space { spatial: false, why: String::new() },
            robot: None,
            parameters: Vec::new(),
            bodies: Vec::new(),
            beams: Vec::new(),
            joints: Vec::new(),
            effects: Vec::new(),
            analysis: Analysis::Motion,
            black_box: None,
            modes: ModesRequest::default(),
            starts_at_equilibrium: false,
            initial: Vec::new(),
            guess: Vec::new(),
            outputs: Vec::new(),
            reduced: Vec::new(),
            requirements: Vec::new(),
            design: None,
            display: BTreeMap::new(),
            parameter_units: BTreeMap::new(),
            simulation: Simulation {
                duration: 1.0,
                stepping: Stepping::Fixed(1e-3),
                alpha: -0.1,
                output_step: 0.01,
                formulation: Formulation::Auto,
                scheme: SchemeChoice::Auto,
                extrapolation: None,
            },
            bounds: BoundsRequest::default(),
            statistics: Statistics::default(),
            instances: Vec::new(),
            ports: BTreeMap::new(),
            turning_effects: BTreeSet::new(),
            states: BTreeSet::new(),
            trajectories: Vec::new(),
            chains: Vec::new(),
            zones: Vec::new(),
            places: Places::default(),
        }
    }

    /// The parameters that are known to lie in an interval, with their indices.
    pub fn uncertain(&self) -> impl Iterator<Item = (usize, &Parameter)> {
        let interval =
            |(_, parameter): &(usize, &Parameter)| matches!(parameter.value, ParameterValue::Interval { .. });
        self.parameters.iter().enumerate().filter(interval)
    }

    /// The reduced outputs that a formula names, with their indices.
    pub fn reduced_in(&self, formula: &Formula) -> impl Iterator<Item = (usize, &ReducedOutput)> {
        let is_named = |(_, own): &(usize, &ReducedOutput)| formula.names().any(|(name, _)| name == own.name);
        self.reduced.iter().enumerate().filter(is_named)
    }
}
