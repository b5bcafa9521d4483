//! The equations of motion as expressions: q̇ = v, M v̇ = Q − Φ_qᵀλ, Φ = 0 (design: index-3 form), and where something
//! rolls, Ψ(q, v, t) = 0 with −Ψ_vᵀλ.

use std::sync::Arc;

use super::formulation_info::FormulationInfo;
use super::inputs::{InputInfo, RandomInput};
use super::powers::PowerBalance;
use symdiff::{Expr, Formula, Graph};

use crate::grammar::quantity::Dimension;
use crate::model::{Analysis, ModesRequest, Parameter, Space};

/// A mechanism's equations of motion over the symbols of `graph`.
///
/// n coordinates, m constraints: first those of positions, then those of velocities. `w` stands for the true
/// acceleration v̇.
#[derive(Clone, Debug)]
pub struct System {
    /// Holds every expression below.
    pub graph: Graph,
    /// The uncertain parameters, each a symbol; all other parameters have been folded in.
    pub parameters: Vec<UncertainParameter>,
    /// Excitations that are functions of the time.
    pub inputs: Vec<InputInfo>,
    /// Whether a formula names an excitation within limits.
    pub is_excited: bool,
    /// Random excitations about which a mechanism is linearised.
    pub random: Vec<RandomInput>,
    /// t, s.
    pub time: Expr,
    /// Positions, n symbols.
    pub q: Vec<Expr>,
    /// Velocities, n symbols.
    pub v: Vec<Expr>,
    /// Accelerations, n symbols.
    pub w: Vec<Expr>,
    /// Lagrange multipliers, m symbols.
    pub lambda: Vec<Expr>,
    /// Names and scales of the coordinates, n.
    pub coordinates: Vec<CoordinateInfo>,
    /// Names of the constraints, m.
    pub constraints: Vec<ConstraintInfo>,
    /// M(q)'s nonzero entries (row, column, value), both triangles; none of long trees ([`System::mass_entries`]).
    pub mass: Vec<(usize, usize, Expr)>,
    /// Whether each coordinate has inertia, n.
    pub massive: Vec<bool>,
    /// M w, n; in joint coordinates with velocity-dependent inertial forces and weights, and with those of beams.
    pub inertia: Vec<Expr>,
    /// Q(t, q, v, λ), n, with the velocity-dependent inertial forces and weights that are not in `inertia`.
    pub force: Vec<Expr>,
    /// If it is not positive, no conditional effect (a contact, a stop) acts.
    pub active_condition: Option<Expr>,
    /// Part of Q by conditional effects where it is positive, n; included in `force`, under that condition.
    pub conditional: Vec<Expr>,
    /// Φ(q, t), one for each constraint of positions.
    pub constraint: Vec<Expr>,
    /// Ψ(q, v, t), linear in v: velocity constraints that are no derivatives of positions'.
    pub velocity_constraint: Vec<Expr>,
    /// States that change at instants only.
    pub sampled: Vec<SampledState>,
    /// The children, parents first; in joint coordinates only.
    pub links: Vec<ChildLink>,
    /// Observed quantities over t, q, v, w, λ and the parameters.
    pub outputs: Vec<OutputInfo>,
    /// The model's size, m: the largest length that it names.
    pub length: f64,
    /// Mass of all bodies, kg, nominally.
    pub mass_of_bodies: f64,
    /// Known values at the start.
    pub start: Start,
    /// Analysis of the system.
    pub analysis: Analysis,
    /// Questions about small vibrations.
    pub modes: ModesRequest,
    /// The model's parameters, where outputs follow from results of the analysis.
    pub declared_parameters: Vec<Parameter>,
    /// Properties of each effect, in file order.
    pub effects: Vec<EffectInfo>,
    /// Energies and powers, where they are asked for.
    pub powers: Option<PowerBalance>,
    /// Parts of the model that are in no equation.
    pub left_out: Vec<Omission>,
    /// Number of dimensions in which the bodies move, and why.
    pub space: Space,
    /// Kind of the coordinates, and why.
    pub formulation: FormulationInfo,
}

/// Properties of an effect in the equations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EffectInfo {
    /// Name in the model.
    pub name: String,
    /// E.g. `spring_damper`.
    pub kind: &'static str,
    /// Number of generalised forces that it adds to.
    pub forces: usize,
    /// Number of expressions that no earlier effect has.
    pub expressions: usize,
    /// The distance of two points along which it acts, where it does.
    pub length: Option<Expr>,
    /// Room of the effect, m: none at a start outside of its enclosure.
    pub room: Option<Expr>,
    /// Limit of the overlap of its surfaces, if there is one.
    pub overlap: Option<Overlap>,
    /// The gap of its surfaces, m, the gap's rate, m/s, and the force between them, N.
    pub touch: Option<[Expr; 3]>,
}

/// Surfaces that overlap to a limited depth only: points inside have no nearest side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overlap {
    /// m
    pub gap: Expr,
    /// m
    pub deepest: Expr,
}

/// A part of the model that is in no equation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Omission {
    /// The part of the model, as it is called in messages.
    pub what: String,
    /// The reason.
    pub why: String,
}

/// A state that changes at the instants 0, T, 2 T, … only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledState {
    /// The coordinate whose velocity it is.
    pub coordinate: usize,
    /// New value, over t, q, v, λ and the parameters just before.
    pub value: Expr,
    /// T, s.
    pub period: f64,
}

/// A child of the trees: all that bodies before it feel of it, and it of them, goes through a few values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChildLink {
    /// The one before it; `None` where its parent is a root.
    pub parent: Option<usize>,
    /// The coordinates of its inboard joint.
    pub coordinates: Vec<usize>,
    /// Index of the constraint on these coordinates alone: the normalisation of Euler parameters.
    pub normalisation: Option<usize>,
    /// Its motion, and the forces applied to it and to all its children.
    pub values: Vec<Expr>,
    /// The inertial forces and torques of it and of all its children.
    pub inertial_forces: Vec<Expr>,
}

/// A parameter that is an interval.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertainParameter {
    /// Its name.
    pub name: String,
    /// Its SI unit; empty where none is known.
    pub unit: String,
    /// Its symbol in the expressions.
    pub symbol: Expr,
    /// Nominal value.
    pub nominal: f64,
    /// Lower end of the interval.
    pub lower: f64,
    /// Upper end of the interval.
    pub upper: f64,
    /// Whether it chooses a realisation of a random excitation: values near one another have nothing in common.
    pub is_seed: bool,
}

/// A coordinate's name and size.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateInfo {
    /// E.g. `crank.angle`.
    pub name: String,
    /// Typical size: 1 for an angle or an Euler parameter, the model's length for a position. Newton's tolerance is
    /// relative to it.
    pub scale: f64,
    /// Whether it describes a rotation (an angle, an Euler parameter) rather than a position.
    pub is_angle: bool,
    /// Whether its velocity is a state, and the coordinate itself stands in no equation.
    pub is_state: bool,
}

/// A constraint's name and owner.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintInfo {
    /// E.g. `pin.x`.
    pub name: String,
    /// Name of the joint.
    pub joint: String,
    /// Unit of its residual.
    pub unit: ResidualUnit,
}

/// Unit of a constraint's residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResidualUnit {
    /// m
    Length,
    /// rad
    Angle,
    /// A pure number, or the unit of an equation's sides.
    Number,
}

/// Something observed.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputInfo {
    /// Its name.
    pub name: String,
    /// Its SI unit; empty where none is known.
    pub unit: String,
    /// Kind of the quantity; `None` if unknown.
    pub dimension: Option<Dimension>,
    /// Its value.
    pub expr: Expr,
    /// The formula over results of the analysis from which it follows, if it does; its expression is nothing then.
    pub of_results: Option<Formula>,
}

impl OutputInfo {
    /// Whether it follows from results of the analysis.
    pub fn is_derived(&self) -> bool {
        self.of_results.is_some()
    }
}

/// Known values at the start; expressions over the parameters.
#[derive(Clone, Debug)]
pub struct Start {
    /// Given positions, n; `None` where assembly finds them.
    pub position: Vec<Option<Expr>>,
    /// Given velocities, n; those of Euler parameters depend on positions, too.
    pub velocity: Vec<Option<Expr>>,
    /// Guesses from which assembly starts, n.
    pub guess: Vec<Expr>,
    /// Whether the given velocities fulfil Ψ = 0, so that none follows from it.
    pub fulfils_velocity_constraints: bool,
    /// Conditions that hold at the start in addition to the constraints.
    pub conditions: Vec<StartCondition>,
    /// Whether it is the equilibrium near these values.
    pub at_equilibrium: bool,
    /// Criterion that determines what the values and conditions leave open; `None` if nothing does.
    pub nearest: Option<Arc<Nearest>>,
}

/// Distances of which the sum of squares is least at the start.
#[derive(Clone, Debug)]
pub struct Nearest {
    /// Holds the system's expressions and those of the distances; `None` where the system's own does.
    pub graph: Option<Graph>,
    /// The distances, over t, q and the parameters.
    pub distances: Vec<Distance>,
}

/// Ψ(q, t), distance of a joint's coordinate, or of that of a body which no joint carries, from its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Distance {
    /// E.g. `elbow.angle`.
    pub name: String,
    /// Ψ
    pub value: Expr,
    /// Typical size.
    pub scale: f64,
    /// Whether the start leaves the position open.
    pub position: bool,
    /// Whether it leaves the velocity open.
    pub velocity: bool,
}

/// Ψ(q, t), which is zero at the start, or has the rate zero there, and is free afterwards.
#[derive(Clone, Debug, PartialEq)]
pub struct StartCondition {
    /// Name and subject.
    pub info: ConstraintInfo,
    /// Source of the condition.
    pub of: ConditionOf,
    /// Ψ
    pub value: Expr,
    /// Ψ̇(q, v, t), where it is not the derivative of Ψ.
    pub rate: Option<Expr>,
    /// Whether Ψ = 0.
    pub position: bool,
    /// Whether Ψ̇ = 0.
    pub velocity: bool,
}

/// Source of a condition of the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConditionOf {
    /// A beam, which starts straight.
    Beam,
    /// A superelement, which starts undeformed.
    Superelement,
    /// `initial`, by a name that is no coordinate of the equations.
    Initial,
}

impl System {
    /// Symbols of all inputs: level and slope of each, and value, rate and acceleration of random ones.
    pub fn input_symbols(&self) -> impl Iterator<Item = Expr> {
        let functions = self.inputs.iter().flat_map(|input| input.symbols);
        functions.chain(self.random.iter().flat_map(|random| random.symbols))
    }

    /// Symbols of q, v, w and λ.
    pub fn motion_symbols(&self) -> Vec<Expr> {
        [&self.q[..], &self.v, &self.w, &self.lambda].concat()
    }

    /// All equations, outputs and start values.
    pub fn roots(&self) -> Vec<Expr> {
        let mut roots: Vec<Expr> = self.mass.iter().map(|&(_, _, value)| value).collect();
        roots.extend(self.inertia.iter().chain(&self.force).chain(&self.start.guess));
        roots.extend(self.named_constraints().map(|(value, _)| value));
        roots.extend(self.sampled.iter().map(|sampled| sampled.value));
        roots.extend(self.outputs.iter().map(|output| output.expr));
        roots.extend(self.random.iter().flat_map(|random| [random.level, random.speed, random.delay]));
        roots.extend(self.start.position.iter().chain(&self.start.velocity).flatten());
        roots.extend(
            self.start.conditions.iter().flat_map(|condition| [Some(condition.value), condition.rate]).flatten(),
        );
        roots
    }

    /// Uncertain parameters that no equation, output or start value depends on, by number.
    pub fn unused_parameters(&self) -> Vec<usize> {
        let used = self.graph.symbols_of(&self.roots());
        let unused = |number: &usize| used.binary_search(&self.parameters[*number].symbol).is_err();
        (0..self.parameters.len()).filter(unused).collect()
    }

    /// Whether M is not written down, because it has an entry for every pair of bodies of a long tree.
    pub fn is_mass_left_out(&self) -> bool {
        self.mass.is_empty() && self.massive.contains(&true)
    }

    /// M's nonzero entries (row, column, value), both triangles.
    pub fn mass_entries(&self, graph: &mut Graph) -> Vec<(usize, usize, Expr)> {
        if !self.is_mass_left_out() {
            return self.mass.clone();
        }
        graph.jacobian(&self.inertia, &self.w).entries().collect()
    }

    /// Φ and Ψ, m, by name.
    pub fn named_constraints(&self) -> impl Iterator<Item = (Expr, &ConstraintInfo)> {
        self.constraint.iter().chain(&self.velocity_constraint).copied().zip(&self.constraints)
    }

    /// The coordinates of the mechanism, without those of states.
    pub fn coordinates_of_motion(&self) -> impl Iterator<Item = &CoordinateInfo> {
        self.coordinates.iter().filter(|coordinate| !coordinate.is_state)
    }

    /// Whether an output depends on accelerations or multipliers.
    pub fn observes_accelerations(&self) -> bool {
        self.observes(&self.w) || self.observes(&self.lambda)
    }

    /// Whether an output depends on velocities.
    pub fn observes_velocities(&self) -> bool {
        self.observes(&self.v)
    }

    fn observes(&self, symbols: &[Expr]) -> bool {
        let outputs: Vec<Expr> = self.outputs.iter().map(|output| output.expr).collect();
        let used = self.graph.symbols_of(&outputs);
        symbols.iter().any(|symbol| used.binary_search(symbol).is_ok())
    }

    /// Notes them as omissions.
    pub(super) fn note_unused_parameters(&mut self) {
        for number in self.unused_parameters() {
            let why = "nothing depends on it".to_owned();
            self.left_out.push(Omission { what: format!("parameter {}", self.parameters[number].name), why });
        }
    }
}
