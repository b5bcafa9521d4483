//! The typed model: contents of a file, checked, with every name resolved and every number in SI units.

mod analysis;
mod black_box;
mod body;
mod design;
mod index;
mod mechanism;
mod reduced;
mod robot;
mod simulation;
mod start;
mod statistics;

use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::Arc;

use symdiff::Formula;

use crate::elements::JointKind;
use crate::elements::effects::EffectKind;
pub use crate::expand::dimensions::{Chain, ChainLink};
pub use crate::expand::instance::{Instance, InstanceKind};
pub use crate::expand::zones::{Zone, ZoneLaw, ZoneShape};
use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::quantity::Dimension;
use crate::methods::BoundsRequest;
pub use crate::robots::urdf::robot::{Visual, VisualShape};
pub use analysis::{Analysis, LinearisedAt, ModesRequest, ResponseRequest};
pub use black_box::{BlackBox, BoxOutput, FmuProgram, Program, Protocol, Refine};
pub use body::{Body, FlexibleBeam, Inertia, Point, Standing};
pub use design::{Design, Free, Objective};
use index::NameIndex;
pub use mechanism::DeclaredMechanism;
pub use reduced::{Limit, ReducedKind, ReducedOutput, Requirement};
pub use robot::{RobotTree, TreeJoint, TreeLink};
pub use simulation::{Formulation, SchemeChoice, Simulation, Stepping};
pub use start::StartValue;
pub use statistics::{Correlation, Cost, Grade, Law, Statistics};

/// A mechanism, its parameters and its questions.
///
/// The reader of a file builds the mechanism once; copies with other questions or values of parameters share it. Its
/// fields are read as those of the description; [`Description::mechanism_mut`] is the one way to change them.
///
/// A `Description` is consistent: every index is in range, every formula's names resolve (through
/// [`Description::symbol`]) in their context, every dimension agrees. Formulas give SI values.
#[derive(Clone, Debug)]
pub struct Description {
    /// Short name; output folder and titles.
    pub name: String,
    /// One line for people.
    pub description: Option<String>,
    /// Bodies, joints, effects and their start.
    pub mechanism: Arc<DeclaredMechanism>,
    /// Parameters, in an order in which each depends only on earlier ones.
    pub parameters: Vec<Parameter>,
    /// Analysis.
    pub analysis: Analysis,
    /// Questions about small vibrations.
    pub modes: ModesRequest,
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
    /// Requested bounds.
    pub bounds: BoundsRequest,
    /// Requested statistics, and the parameters' laws.
    pub statistics: Statistics,
    /// Chains of dimensions, with the outputs that close them.
    pub chains: Vec<Chain>,
    /// Zones, each of several parameters.
    pub zones: Vec<Zone>,
    /// Indices of parameters by name.
    pub parameter_index: NameIndex,
}

/// Number of dimensions in which a mechanism moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Space {
    /// Whether a body has six degrees of freedom unless it declares its coordinates, and joints constrain all six. A
    /// planar mechanism has z = 0 everywhere and turns about z only.
    pub spatial: bool,
    /// For people: the part of the model that leaves the plane, or that there is none.
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
    /// SI unit for people, e.g. `m` or `N*s/m`; empty if none was given.
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
    /// SI unit derived from the formula, for axes; empty if dimensionless or unknown.
    pub unit: String,
    /// Dimension; `None` if unknown.
    pub dimension: Option<Dimension>,
    /// Whether the formula names results of the analysis, and other outputs: it is known when these are.
    pub of_results: bool,
}

impl Deref for Description {
    type Target = DeclaredMechanism;

    fn deref(&self) -> &DeclaredMechanism {
        &self.mechanism
    }
}

impl Description {
    /// A planar model without parts, for a second.
    pub fn empty(name: String) -> Self {
        Self {
            name,
            description: None,
            mechanism: Arc::new(DeclaredMechanism::empty()),
            parameters: Vec::new(),
            analysis: Analysis::Motion,
            modes: ModesRequest::default(),
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
            chains: Vec::new(),
            zones: Vec::new(),
            parameter_index: NameIndex::default(),
        }
    }

    /// The mechanism, to be changed: a copy of its own where others share it.
    pub fn mechanism_mut(&mut self) -> &mut DeclaredMechanism {
        Arc::make_mut(&mut self.mechanism)
    }

    /// The parameters that are known to lie in an interval, with their indices.
    pub fn uncertain(&self) -> impl Iterator<Item = (usize, &Parameter)> {
        let interval =
            |(_, parameter): &(usize, &Parameter)| matches!(parameter.value, ParameterValue::Interval { .. });
        self.parameters.iter().enumerate().filter(interval)
    }

    /// Intervals of the parameters, to be changed: nominal, least and largest value, SI, in the order of
    /// [`Self::uncertain`].
    pub fn intervals_mut(&mut self) -> impl Iterator<Item = [&mut f64; 3]> {
        self.parameters.iter_mut().filter_map(|parameter| match &mut parameter.value {
            ParameterValue::Interval { nominal, lower, upper } => Some([nominal, lower, upper]),
            ParameterValue::Formula(_) => None,
        })
    }

    /// The same mechanism and questions over another box: ends of the intervals, SI, in the order of
    /// [`Self::uncertain`]. Nominal values stay.
    #[must_use]
    pub fn over(&self, ends: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut model = self.clone();
        for ([_, lower, upper], ends) in model.intervals_mut().zip(ends) {
            [*lower, *upper] = ends;
        }
        model
    }

    /// The reduced outputs that a formula names, with their indices.
    pub fn reduced_in(&self, formula: &Formula) -> impl Iterator<Item = (usize, &ReducedOutput)> {
        let is_named = |(_, own): &(usize, &ReducedOutput)| formula.names().any(|(name, _)| name == own.name);
        self.reduced.iter().enumerate().filter(is_named)
    }
}
