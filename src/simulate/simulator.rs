//! A mechanism ready to run: assembled at its nominal parameters, its rank known, its programs compiled.

use symdiff::{Tile, WIDTHS};

use super::initial::{Assembly, Gap};
use super::rank::dependent_rows;
use super::reactions::undetermined_outputs;
use crate::assemble::{StartCondition, System};
use crate::compile::{Layout, NoFactors, PROBES, Probe, Program, Scheme, StartProgram, compile, compile_start};

/// Rows of Φ_q that stand out of the others by less than this (scaled) are implied by them.
pub(super) const DEPENDENT: f64 = 1e-8;

/// How far the probes for pivots are moved from the nominal start, in coordinate scales.
const PROBE_SPREAD: f64 = 0.7;

/// How far a configuration in general position is from the start, in coordinate scales.
const APART: f64 = 0.05;

/// Samples that are assembled together where only that is asked.
const ASSEMBLED_AT_ONCE: usize = 8;

/// Steps from the nominal parameters to those of a sample that is far from them.
const LED: usize = 16;

/// A mechanism that can be simulated.
#[derive(Clone, Debug)]
pub struct Simulator {
    /// The equations.
    pub system: System,
    /// Tapes for the start.
    pub start: StartProgram,
    /// Tapes for the steps.
    pub program: Program,
    /// The nominal start: values of the layout's slots.
    pub nominal: Vec<f64>,
    /// What is known of the constraints.
    pub mobility: Mobility,
    /// Outputs that hang on reactions which equilibrium does not determine.
    pub undetermined: Vec<usize>,
}

/// Degrees of freedom and redundancy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mobility {
    /// Coordinates less independent constraints.
    pub degrees_of_freedom: usize,
    /// Constraints that earlier ones imply.
    pub redundant: Vec<usize>,
    /// Constraints that depend on earlier ones at the start only: it is a singular configuration.
    pub singular_at_start: Vec<usize>,
}

/// Why a mechanism cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// No consistent start.
    #[error("{}", assembly_message(owner, constraint, *amount, *of_velocities, parameters))]
    #[allow(missing_docs)]
    Assembly { owner: String, constraint: String, amount: f64, of_velocities: bool, parameters: Vec<(String, f64)> },
    /// The equations of motion cannot be solved at the start.
    #[error("the equations of motion are singular at the start: {}", equations.join(", "))]
    #[allow(missing_docs)]
    Singular { equations: Vec<String> },
    /// The program would be longer than was allowed.
    #[error("the equations take too many operations")]
    TooLong,
    /// A step did not converge.
    #[error(
        "sample {sample} ({}) did not converge at t = {time} s; the largest residual is that of `{equation}`",
        parameter_list(parameters)
    )]
    #[allow(missing_docs)]
    Stuck { sample: usize, time: f64, equation: String, parameters: Vec<(String, f64)> },
    /// A jet met a Newton matrix without an inverse.
    #[error("the Newton matrix is singular at t = {time} s, so the response has no Taylor coefficients there")]
    #[allow(missing_docs)]
    SingularJet { time: f64 },
    /// The constraints cannot be fulfilled any more.
    #[error(
        "the mechanism locks at t = {time} s ({}): `{constraint}` stays open by {amount:.3e} whatever the position",
        parameter_list(parameters)
    )]
    #[allow(missing_docs)]
    Locked { time: f64, constraint: String, amount: f64, parameters: Vec<(String, f64)> },
    /// Step-size control asks for steps that make no headway.
    #[error(
        "at t = {time} s ({}) the steps fell below {step:.1e} s without meeting the tolerance: {cause}",
        parameter_list(parameters)
    )]
    #[allow(missing_docs)]
    StepTooSmall { step: f64, time: f64, cause: String, parameters: Vec<(String, f64)> },
    /// Steps that meet the tolerance are too many.
    #[error("the tolerance takes more than {steps} steps; they are {step:.1e} s long at t = {time} s, where {cause}")]
    #[allow(missing_docs)]
    TooManySteps { steps: usize, step: f64, time: f64, cause: String },
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
    amount: f64,
    of_velocities: bool,
    parameters: &[(String, f64)],
) -> String {
    let place = if parameters.is_empty() { String::new() } else { format!(" with {}", parameter_list(parameters)) };
    if of_velocities {
        format!(
            "the initial velocities do not fit {owner}{place}: `{constraint}` opens at {:.3e} per second",
            amount.abs()
        )
    } else {
        format!("the mechanism cannot be assembled{place}: {owner} gapes by {:.3e} in `{constraint}`", amount.abs())
    }
}

impl Simulator {
    /// Assembles, and compiles for a scheme. `h` is the step size that the first probes use.
    ///
    /// # Errors
    /// Where no consistent start exists, or the equations are singular there.
    pub fn new(system: System, scheme: Scheme, h: f64) -> Result<Self, SimulationError> {
        Self::within(system, scheme, h, None)
    }

    /// The same, but given up where start or step take more operations, if there is a limit, than so many.
    ///
    /// # Errors
    /// Also where it is given up.
    pub fn within(
        mut system: System,
        scheme: Scheme,
        h: f64,
        operations: Option<usize>,
    ) -> Result<Self, SimulationError> {
        system.graph.limit(operations.map(|operations| system.graph.len() + operations));
        let parameters: Vec<f64> = system.parameters.iter().map(|parameter| parameter.nominal).collect();
        let layout = Layout::new(parameters.len(), system.q.len(), system.lambda.len());
        let told = |none: NoFactors| no_factors(&system, &none);
        let probe = guess_probe(&system, &layout, &parameters);
        let assembled = |start: &StartProgram| {
            let mut assembly = Assembly::new(start, &system, 1, |parameter, _| parameters[parameter]);
            assembly.assemble_nominal().map_err(|gap| assembly_error(&system, &gap, &parameters))?;
            assembly.shift_accelerations(scheme.coefficients().shift() * h);
            Ok(assembly.tile().values()[..layout.slots()].to_vec())
        };
        let mut start = compile_start(&system, &[], &probe).map_err(told)?;
        let mut nominal = assembled(&start)?;
        let mobility = mobility(&system, &start, &nominal);
        if !mobility.redundant.is_empty() {
            start = compile_start(&system, &mobility.redundant, &probe).map_err(told)?;
            nominal = assembled(&start)?;
        }
        let undetermined = undetermined_outputs(&system, &start, &nominal, &mobility);
        let probes = probes(&system, &layout, &nominal, h);
        let program = compile(&system, scheme, &mobility.redundant, &probes).map_err(told)?;
        system.graph.limit(None);
        Ok(Self { system, start, program, nominal, mobility, undetermined })
    }

    /// Start states of samples: a tile of this width in which lane l has the parameters `sample(l)`.
    ///
    /// # Errors
    /// The first sample that cannot be assembled, with its parameters.
    pub fn assemble(&self, width: usize, h: f64, sample: impl Fn(usize) -> Vec<f64>) -> Result<Tile, SimulationError> {
        let samples: Vec<Vec<f64>> = (0..width).map(sample).collect();
        let (mut assembly, gaps) = self.assembly(&samples);
        if let Some(gap) = gaps.first() {
            return Err(assembly_error(&self.system, gap, &samples[gap.lane]));
        }
        assembly.shift_accelerations(self.program.coefficients.shift() * h);
        Ok(assembly.tile().clone())
    }

    /// The uncertain parameters with a sample's values.
    pub fn with_names(&self, sample: &[f64]) -> Vec<(String, f64)> {
        let names = self.system.parameters.iter().map(|parameter| parameter.name.clone());
        names.zip(sample.iter().copied()).collect()
    }

    /// Whether each of some samples can be assembled.
    pub fn can_assemble(&self, samples: &[Vec<f64>]) -> Vec<bool> {
        let of_tile = |samples: &[Vec<f64>]| {
            let mut can = vec![true; samples.len()];
            // Lanes beyond the samples repeat the last one.
            let width = WIDTHS.into_iter().find(|&width| width >= samples.len()).unwrap_or(samples.len());
            let lanes: Vec<Vec<f64>> = (0..width).map(|lane| samples[lane.min(samples.len() - 1)].clone()).collect();
            for gap in self.assembly(&lanes).1 {
                can.get_mut(gap.lane).into_iter().for_each(|can| *can = false);
            }
            can
        };
        samples.chunks(ASSEMBLED_AT_ONCE).flat_map(of_tile).collect()
    }

    /// A tile of samples assembled from the nominal one, and the gaps of those that cannot be. A sample far from it is led there
    /// by small changes of the parameters, lest it ends on another branch of the linkage.
    fn assembly(&self, samples: &[Vec<f64>]) -> (Assembly<'_>, Vec<Gap>) {
        let at = |share: f64| {
            move |parameter: usize, lane: usize| {
                let (nominal, value) = (self.system.parameters[parameter].nominal, samples[lane][parameter]);
                if share == 1.0 { value } else { nominal + share * (value - nominal) }
            }
        };
        let mut assembly = Assembly::new(&self.start, &self.system, samples.len(), at(1.0));
        let mut gaps = assembly.assemble_from(&self.nominal);
        let mut far = assembly.far_from(&self.nominal);
        gaps.iter().for_each(|gap| far[gap.lane] = true);
        if far.contains(&true) {
            let mut led = Assembly::new(&self.start, &self.system, samples.len(), at(0.0));
            led.set_state(&self.nominal);
            for part in 1..LED {
                led.follow(at(part as f64 / LED as f64));
            }
            led.set_parameters(at(1.0));
            let gaping = led.assemble();
            let closes = |lane: usize| gaping.iter().all(|gap| gap.lane != lane);
            let gaped = |lane: usize| gaps.iter().any(|gap| gap.lane == lane);
            let better: Vec<usize> =
                (0..far.len()).filter(|&lane| far[lane] && (closes(lane) || gaped(lane))).collect();
            assembly.copy_lanes(&led, &better);
            gaps = gaping.into_iter().filter(|gap| better.contains(&gap.lane)).collect();
        }
        (assembly, gaps)
    }

    /// Name of one of the n + m equations of a step: a coordinate's equation of motion or a constraint.
    pub fn equation_name(&self, equation: usize) -> String {
        equation_names(&self.system, &[equation]).remove(0)
    }
}

/// What a matrix of this mechanism without factors means.
pub(super) fn no_factors(system: &System, none: &NoFactors) -> SimulationError {
    match none {
        NoFactors::Singular { rows } => SimulationError::Singular { equations: equation_names(system, rows) },
        NoFactors::TooLong => SimulationError::TooLong,
    }
}

/// Equations of motion, then constraints, then what holds at the start only.
fn equation_names(system: &System, equations: &[usize]) -> Vec<String> {
    let n = system.q.len();
    let name = |&equation: &usize| match equation.checked_sub(n) {
        None => format!("motion of {}", system.coordinates[equation].name),
        Some(row) => match row.checked_sub(system.constraints.len()) {
            None => system.constraints[row].name.clone(),
            Some(condition) => format!("start of {}", system.start.conditions[condition].info.name),
        },
    };
    equations.iter().map(name).collect()
}

fn assembly_error(system: &System, gap: &Gap, parameters: &[f64]) -> SimulationError {
    let names = system.parameters.iter().map(|parameter| parameter.name.clone());
    let (owner, constraint) = match gap.constraint.checked_sub(system.constraints.len()) {
        None => {
            let info = &system.constraints[gap.constraint];
            (format!("joint `{}`", info.joint), &info.name)
        }
        Some(place) => {
            let of_kind = |condition: &&StartCondition| {
                if gap.of_velocities { condition.velocity } else { condition.position }
            };
            let info = system.start.conditions.iter().filter(of_kind).nth(place).map(|condition| &condition.info);
            // Rows of a gap beyond the constraints are those of the conditions of its kind.
            let info = info.expect("a gap is of a row that there is");
            let (what, names) = match gap.of_velocities {
                false => ("straight", "x, y and angle"),
                true => ("as a rigid body", "vx, vy and angular_velocity"),
            };
            let beam = &info.joint;
            (format!("beam `{beam}`, which starts {what} unless `initial` has {names} of all its nodes,"), &info.name)
        }
    };
    SimulationError::Assembly {
        owner,
        constraint: constraint.clone(),
        amount: gap.amount,
        of_velocities: gap.of_velocities,
        parameters: names.zip(parameters.iter().copied()).collect(),
    }
}

/// Additive recurrences in [−1, 1): evenly spread numbers, the same on every machine.
pub(super) fn spread(series: usize, place: usize) -> f64 {
    2.0 * ((place + 1) as f64 * 0.618_033_988_749_895 + series as f64 * 0.414_213_562_373_095).fract() - 1.0
}

/// A state in general position near the model's guess.
fn guess_probe(system: &System, layout: &Layout, parameters: &[f64]) -> Vec<f64> {
    let mut values = vec![0.0; layout.slots()];
    values[layout.parameters.clone()].copy_from_slice(parameters);
    let value_of = |symbol| system.parameters.iter().position(|parameter| parameter.symbol == symbol);
    let guess =
        system.graph.evaluate(&system.start.guess, |symbol| value_of(symbol).map_or(f64::NAN, |k| parameters[k]));
    for (place, slot) in layout.q.clone().enumerate() {
        values[slot] = guess[place] + 0.1 * system.coordinates[place].scale * spread(0, place);
    }
    for (place, slot) in (layout.v.start..layout.correction.end).enumerate() {
        values[slot] = spread(1, place);
    }
    values
}

/// The nominal start, and states in general position around it.
fn probes(system: &System, layout: &Layout, nominal: &[f64], h: f64) -> [Probe; PROBES] {
    std::array::from_fn(|series| {
        let mut values = nominal.to_vec();
        values[layout.step] = h;
        for (place, (w, x)) in layout.w.clone().zip(layout.iterate.clone()).enumerate() {
            values[x] = values[w];
            if series > 0 {
                let scale = system.coordinates[place].scale;
                values[layout.q.start + place] += PROBE_SPREAD * scale * spread(series, place);
                values[layout.v.start + place] += PROBE_SPREAD * scale * spread(series + PROBES, place);
            }
        }
        Probe { values }
    })
}

/// Rank of Φ_q at the nominal start and, where it has dependent rows there, at a configuration in general position near
/// it: what depends on others at the start only is no redundancy, but a singular start.
fn mobility(system: &System, start: &StartProgram, nominal: &[f64]) -> Mobility {
    let at_start = dependent_constraints(system, start, nominal);
    let elsewhere = if at_start.is_empty() { None } else { move_apart(system, nominal) };
    let redundant = match elsewhere.map(|state| dependent_constraints(system, start, &state)) {
        Some(generic) if generic.len() <= at_start.len() => generic,
        _ => at_start.clone(),
    };
    let degrees_of_freedom = (system.q.len() + redundant.len()).saturating_sub(system.lambda.len());
    let singular_at_start = if at_start.len() > redundant.len() { at_start } else { Vec::new() };
    Mobility { degrees_of_freedom, redundant, singular_at_start }
}

/// Constraints that earlier ones imply at a state.
fn dependent_constraints(system: &System, start: &StartProgram, state: &[f64]) -> Vec<usize> {
    dependent_rows(&slope_rows(system, start, state), DEPENDENT)
}

/// Rows of Φ_q at a state (the layout's slots), per scale of each coordinate: (coordinate, value).
pub(super) fn slope_rows(system: &System, start: &StartProgram, state: &[f64]) -> Vec<Vec<(usize, f64)>> {
    let mut tile = Tile::new(1, start.slots(), start.constants());
    tile.values_mut()[..state.len()].copy_from_slice(state);
    tile.run(start.sample());
    tile.run(start.slopes());
    let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); system.lambda.len()];
    for &(row, column, slot) in &start.slope_entries {
        rows[row].push((column, tile.lane(slot)[0] * system.coordinates[column].scale));
    }
    rows
}

/// An assembled state in general position near another; nothing is kept but the constraints. `None` where there is none.
pub(super) fn move_apart(system: &System, state: &[f64]) -> Option<Vec<f64>> {
    let mut free = system.clone();
    free.start.position.fill(None);
    free.start.conditions.clear();
    let start = compile_start(&free, &[], state).ok()?;
    let mut tile = Tile::new(1, start.slots(), start.constants());
    tile.values_mut()[..state.len()].copy_from_slice(state);
    tile.run(start.sample());
    for (place, slot) in start.layout.q.clone().enumerate() {
        tile.lane_mut(slot)[0] += APART * system.coordinates[place].scale * spread(7, place);
    }
    for _ in 0..30 {
        tile.run(start.position());
        for (slot, correction) in start.layout.q.clone().zip(start.layout.correction.clone()) {
            tile.lane_mut(slot)[0] += tile.lane(correction)[0];
        }
    }
    tile.run(start.position());
    let assembled = start.constraint.iter().all(|&slot| tile.lane(slot)[0].abs() < 1e-9);
    assembled.then(|| tile.values()[..state.len()].to_vec())
}
