//! Reasons why a mechanism cannot be simulated, in words for the user.

use nalgebra::DMatrix;

use super::residual_text::residual_text;
use super::start::{ConstraintResidual, free_columns, jacobian_rows};
use super::statics::NoEquilibrium;
use crate::assemble::{ConditionOf, CoordinateId, System};
use crate::compile::{ClosureRow, Equation, NoFactors, StartProgram};

/// Parameters of a sample: name and value in SI units.
pub type NamedValues = Vec<(String, f64)>;

/// Why a mechanism cannot be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// No consistent start exists.
    #[error("{}", assembly_message(owner, constraint, residual, *of_velocities, parameters, cause.as_deref()))]
    Assembly {
        /// The joint or the beam that cannot be closed, with its kind.
        owner: String,
        /// Name of the constraint with the largest residual.
        constraint: String,
        /// The residual, with its unit.
        residual: String,
        /// Whether positions are consistent and velocities are not.
        of_velocities: bool,
        /// The sample.
        parameters: NamedValues,
        /// Constraints that are too many, if there are any.
        cause: Option<Box<str>>,
    },
    /// A sample of kinematics has no start on the nominal one's branch of the linkage.
    #[error(
        "with {} the mechanism cannot be assembled on the branch of its nominal position: that ends, or meets another, on the way there",
        parameter_list(parameters)
    )]
    OffBranch {
        /// The sample.
        parameters: NamedValues,
    },
    /// The explicit method is asked for but is of no use.
    #[error("the explicit method is not for this: {why}; `scheme: hht` integrates it, and `auto` chooses")]
    NotExplicit {
        /// The reason.
        why: String,
    },
    /// A program that stands for a mechanism cannot be started.
    #[error("{place}: black box: {why}")]
    BlackBox {
        /// Location in the model.
        place: String,
        /// The system's reason.
        why: String,
    },
    /// A program that stands for a mechanism has no answer for a sample.
    #[error("{place}: the black box has no answer with {}: {why}", parameter_list(parameters))]
    NoAnswer {
        /// Location in the model.
        place: String,
        /// Its fault, with its last words.
        why: String,
        /// The sample.
        parameters: NamedValues,
    },
    /// A speed follows a state where other constraints decide it.
    #[error(
        "joint `{joint}` gives a speed by a state where other joints or motors decide it already: leave one of them out, or let all follow the same state"
    )]
    Contradiction {
        /// Its name.
        joint: String,
    },
    /// A redundant constraint is contradicted by the others, which it agreed with at the start.
    #[error(
        "joint `{joint}` contradicts the others, which it agrees with at the start: at t = {time} s {remain} remain: leave it out, or let it follow the same motion"
    )]
    Parted {
        /// Its name.
        joint: String,
        /// End of the step, s.
        time: f64,
        /// Its residual, with its unit.
        remain: String,
    },
    /// Something begins outside of its enclosure.
    #[error(
        "`{effect}` starts with the centre of its journal {distance:.3e} m outside of the bearing: give its bodies a start or a `guess` inside"
    )]
    StartsOutside {
        /// Its name.
        effect: String,
        /// Distance, m.
        distance: f64,
    },
    /// The equations of motion cannot be solved at the start.
    #[error("the equations of motion are singular at the start: {}{}", equations.join(", "), not_placed(massless.as_deref()))]
    Singular {
        /// Names of the equations without a pivot.
        equations: Vec<String>,
        /// A coordinate among them that has no inertia.
        massless: Option<String>,
    },
    /// No static equilibrium was found.
    #[error("{}", equilibrium_message(pushed, *is_state, *is_free, parameters))]
    NoEquilibrium {
        /// Coordinate with the largest force, and that force; or the state that changes most.
        pushed: String,
        /// Whether it is a state.
        is_state: bool,
        /// Whether nothing holds it, wherever it is.
        is_free: bool,
        /// The sample.
        parameters: NamedValues,
    },
    /// Motors leave freedom in kinematics.
    #[error(
        "motors leave {} free, and without forces nothing moves {}: add a `motor` for each, or ask for `analysis: motion`",
        names(coordinates), if coordinates.len() == 1 { "it" } else { "them" }
    )]
    NotDriven {
        /// Names of coordinates that are left free.
        coordinates: Vec<String>,
    },
    /// A requirement names a result that the analysis does not have.
    #[error("this analysis has no result `{name}`; it has {known}")]
    NoResult {
        /// The name.
        name: String,
        /// Some that it has.
        known: String,
    },
    /// A term of the equations has no finite value.
    #[error("{term} is not a finite number at t = {time} s ({})", parameter_list(parameters))]
    NotFinite {
        /// The term, and where it stands.
        term: String,
        /// s
        time: f64,
        /// The sample.
        parameters: NamedValues,
    },
    /// The run ended at an interruption.
    #[error("interrupted")]
    Interrupted,
    /// Simulations were left to shards.
    #[error("simulations are missing")]
    Deferred,
    /// The folder of stored simulations cannot be used.
    #[error("{message}")]
    Store {
        /// Why.
        message: String,
    },
    /// The program would have more operations than allowed.
    #[error("the equations take too many operations")]
    TooLong,
    /// Newton's iteration of a step did not converge, and smaller steps did not either.
    #[error(
        "sample {sample} ({}) did not converge at t = {time} s; the largest residual is that of `{equation}`",
        parameter_list(parameters)
    )]
    NotConverged {
        /// Number of the sample.
        sample: usize,
        /// End of the step, s.
        time: f64,
        /// Name of the equation with the largest scaled residual.
        equation: String,
        /// The sample.
        parameters: NamedValues,
    },
    /// A jet reached a state in which the Newton matrix has no inverse.
    #[error("the Newton matrix is singular at t = {time} s, so the response has no Taylor coefficients there")]
    SingularJet {
        /// End of the step, s.
        time: f64,
    },
    /// No position fulfils the constraints any more.
    #[error(
        "the mechanism locks at t = {time} s ({}): the loop cannot be closed beyond this position; {residual} remain in `{constraint}`",
        parameter_list(parameters)
    )]
    Locked {
        /// Beginning of the step, s.
        time: f64,
        /// Name of the constraint that cannot be closed.
        constraint: String,
        /// Its smallest residual, with its unit.
        residual: String,
        /// The sample.
        parameters: NamedValues,
    },
    /// Step-size control asks for steps too small to advance.
    #[error(
        "at t = {time} s ({}) the steps fell below {step:.1e} s without meeting the tolerance: {cause}",
        parameter_list(parameters)
    )]
    StepTooSmall {
        /// s
        step: f64,
        /// s
        time: f64,
        /// Cause of an error above the tolerance.
        cause: String,
        /// The sample.
        parameters: NamedValues,
    },
    /// The steps that meet the tolerance are too many.
    #[error("the tolerance takes more than {steps} steps; they are {step:.1e} s long at t = {time} s, where {cause}")]
    TooManySteps {
        /// Most steps.
        steps: usize,
        /// s
        step: f64,
        /// s
        time: f64,
        /// Cause of the short steps.
        cause: String,
    },
    /// A force or a prescribed position changes too fast with the time.
    #[error(
        "{function} has a period near {period:.1e} s at t = {time:.3e} s: a run that follows it takes some {steps:.0e} steps of {step:.1e} s, \
         and {}; simulate a shorter time, or put what it does on average in its place",
        if *most > 0 { format!("{most} are the most") } else { "finding them takes too long".to_owned() }
    )]
    TooFast {
        /// The function and its owner.
        function: String,
        /// Approximate period, or time between its jumps, s.
        period: f64,
        /// s
        step: f64,
        /// s
        time: f64,
        /// Steps that the run would have.
        steps: f64,
        /// Most steps of a run; 0 where the search for steps ended it.
        most: usize,
    },
}

fn parameter_list(parameters: &[(String, f64)]) -> String {
    if parameters.is_empty() {
        return "no uncertain parameters".to_owned();
    }
    parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ")
}

fn assembly_message(
    owner: &str,
    constraint: &str,
    residual: &str,
    of_velocities: bool,
    parameters: &[(String, f64)],
    cause: Option<&str>,
) -> String {
    let with = if parameters.is_empty() { String::new() } else { format!(" with {}", parameter_list(parameters)) };
    if of_velocities {
        format!("the initial velocities are inconsistent with {owner}{with}: {residual} remain in `{constraint}`")
    } else {
        let advice = cause.unwrap_or("check lengths, initial positions and joint kinds");
        format!("{owner} cannot be closed{with}: {residual} remain in `{constraint}`; {advice}")
    }
}

fn equilibrium_message(pushed: &str, is_state: bool, is_free: bool, parameters: &[(String, f64)]) -> String {
    let with = if parameters.is_empty() { String::new() } else { format!(" with {}", parameter_list(parameters)) };
    let advice = match (is_state, is_free) {
        (false, true) => "and no force changes as it moves: hold it by a joint or a spring",
        (false, false) => "say in `guess` near where it is to rest, or hold it by a spring or a stop",
        (true, true) => "and no rate or force depends on it: close its loop",
        (true, false) => "say as its `initial` near where it is to rest",
    };
    format!("there is no equilibrium near the start{with}: {pushed}, {advice}")
}

fn names(coordinates: &[String]) -> String {
    coordinates.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" and ")
}

/// The error that motors leave coordinates free in a state, with their names.
pub(super) fn not_driven(system: &System, start: &StartProgram, state: &[f64]) -> SimulationError {
    let rows = jacobian_rows(system, start, state);
    let mut matrix = DMatrix::zeros(rows.len(), system.q.len());
    for (row, entries) in rows.iter().enumerate() {
        entries.iter().for_each(|&(column, value)| matrix[(row, column)] += value);
    }
    // Users would drive an angle.
    let weight: Vec<f64> =
        system.coordinates.iter().map(|coordinate| if coordinate.is_angle { 1e-3 } else { 1.0 }).collect();
    let free = free_columns(&matrix, &weight);
    SimulationError::NotDriven {
        coordinates: free.into_iter().map(|index| system.coordinates[index].name.clone()).collect(),
    }
}

/// Why a sample with these parameters has no equilibrium.
pub(super) fn no_equilibrium(system: &System, none: &NoEquilibrium, parameters: &[f64]) -> SimulationError {
    let names = system.parameters.iter().map(|parameter| parameter.name.clone());
    let coordinate = &system[none.coordinate];
    let (name, amount) = (&coordinate.name, none.force.abs());
    let pushed = match (coordinate.is_state, coordinate.is_angle) {
        (true, _) => format!("the state `{name}` still changes by {amount:.3e} a second"),
        (false, true) => format!("{amount:.3e} N m still push `{name}`"),
        (false, false) => format!("{amount:.3e} N still push `{name}`"),
    };
    SimulationError::NoEquilibrium {
        pushed,
        is_state: coordinate.is_state,
        is_free: none.is_free,
        parameters: names.zip(parameters.iter().copied()).collect(),
    }
}

/// An equation's name.
pub(super) fn equation_name(system: &System, equation: Equation) -> String {
    match equation {
        Equation::Motion(coordinate) => format!("motion of {}", system[coordinate].name),
        Equation::Closure(ClosureRow::Constraint(constraint)) => system[constraint].name.clone(),
        Equation::Closure(ClosureRow::Condition(condition)) => {
            format!("start of {}", system[condition].info.name)
        }
    }
}

/// Advice if joints place a body without mass only in part.
fn not_placed(massless: Option<&str>) -> String {
    let Some(coordinate) = massless else { return String::new() };
    format!(
        "; `{coordinate}` has no inertia, and joints place its body only in part: leave `formulation: absolute` out, \
         or give the body a small mass"
    )
}

/// Why a matrix of this system has no factors.
pub(super) fn no_factors(system: &System, none: &NoFactors<Equation>) -> SimulationError {
    match none {
        NoFactors::Singular { rows } => {
            let has_inertia = |coordinate: CoordinateId| system.massive[coordinate.number()];
            let massless = rows.iter().find_map(|row| match row {
                Equation::Motion(coordinate) if !has_inertia(*coordinate) => Some(*coordinate),
                _ => None,
            });
            SimulationError::Singular {
                equations: rows.iter().map(|&row| equation_name(system, row)).collect(),
                massless: massless.map(|coordinate| system[coordinate].name.clone()),
            }
        }
        NoFactors::TooLong => SimulationError::TooLong,
    }
}

/// Why a sample with these parameters cannot be assembled.
pub(super) fn assembly_error(system: &System, worst: &ConstraintResidual, parameters: &[f64]) -> SimulationError {
    let names = system.parameters.iter().map(|parameter| parameter.name.clone());
    let (owner, info) = match worst.row {
        ClosureRow::Constraint(constraint) => {
            let info = &system[constraint];
            (format!("joint `{}`", info.joint), info)
        }
        ClosureRow::Condition(condition) => {
            let info = &system[condition].info;
            let (how, names) = match worst.of_velocities {
                false => ("straight", "all coordinates"),
                true => ("as a rigid body", "all velocities"),
            };
            let of = &info.joint;
            let owner = match system[condition].of {
                ConditionOf::Beam => {
                    format!("beam `{of}` (it starts {how} unless `initial` gives {names} of all its nodes)")
                }
                ConditionOf::Superelement => {
                    let how = if worst.of_velocities { "moves as a rigid body" } else { "is undeformed" };
                    format!("superelement `{of}` (at the start it {how})")
                }
                ConditionOf::Initial => format!("`{of}` of `initial`"),
            };
            (owner, info)
        }
    };
    SimulationError::Assembly {
        owner,
        constraint: info.name.clone(),
        residual: residual_text(worst.residual, info, worst.of_velocities),
        of_velocities: worst.of_velocities,
        parameters: names.zip(parameters.iter().copied()).collect(),
        cause: None,
    }
}

impl SimulationError {
    /// Adds the reason why constraints of an assembly cannot hold, if it is known.
    pub(super) fn because(mut self, why: Option<String>) -> Self {
        if let Self::Assembly { cause, of_velocities: false, .. } = &mut self {
            *cause = why.map(String::into_boxed_str);
        }
        self
    }
}
