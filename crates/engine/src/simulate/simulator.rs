//! A mechanism ready to run: assembled at its nominal parameters, its rank known, its programs compiled.

use std::sync::{Arc, OnceLock};

use symdiff::{Tile, WIDTHS};

use super::assembled::{Assembled, outputs_in};
use super::derived::Derived;
use super::error::{SimulationError, assembly_error, equation_name, no_equilibrium, no_factors};
use super::features::Features;
use super::modal::Vibrations;
use super::start::{Assembly, ConstraintResidual, Mobility, Samples, pivot_samples};
use super::statics::Equilibrium;
use super::time_functions::TimeFunctions;
use super::tuning::TUNING;
use crate::assemble::{EquationId, OutputId, System};
use crate::compile::{
    Equation, Program, Scheme, StartProgram, SwitchProgram, compile, compile_overlaps, compile_start, compile_switches,
};
use crate::model::Analysis;
use crate::numerics::Sample;

/// A mechanism that can be simulated.
#[derive(Clone, Debug)]
pub struct Simulator {
    /// The equations.
    pub system: System,
    /// Tapes for the start.
    pub start: StartProgram,
    /// Tapes for the steps.
    pub program: Program,
    /// The nominal start: values of the layout's registers.
    pub nominal: Vec<f64>,
    /// Degrees of freedom and redundant constraints.
    pub mobility: Mobility,
    /// Outputs that depend on reactions which equilibrium does not determine.
    pub undetermined: Vec<OutputId>,
    /// Coordinates that share the open part of the start: it is nearest to rest, one of many.
    pub shared: Vec<String>,
    /// Equilibrium, if the start is one.
    pub equilibrium: Option<Arc<Equilibrium>>,
    /// Small vibrations, if they are asked for.
    pub vibrations: Option<Arc<Vibrations>>,
    /// Outputs that follow from the results of the analysis, if any.
    pub derived: Option<Arc<Derived>>,
    // Compiled where steps are controlled or watched, and where rows are closed.
    switches: OnceLock<Option<SwitchProgram>>,
    overlaps: OnceLock<Option<SwitchProgram>>,
    features: OnceLock<Option<Features>>,
    time_functions: OnceLock<(f64, Option<TimeFunctions>)>,
    free_closure: OnceLock<Result<StartProgram, SimulationError>>,
}

impl Simulator {
    /// Assembles, and compiles for a scheme. `h` is the step size at which pivots are chosen.
    ///
    /// # Errors
    /// Where no consistent start exists, or the equations are singular there.
    pub fn new(system: System, scheme: Scheme, h: f64) -> Result<Self, SimulationError> {
        Self::within(system, scheme, h, None)
    }

    /// The same with a limit on the number of operations that start and step may take.
    ///
    /// # Errors
    /// Also where the limit is exceeded.
    pub fn within(system: System, scheme: Scheme, h: f64, operations: Option<usize>) -> Result<Self, SimulationError> {
        Self::of(Assembled::within(Samples::All, system, scheme, h, operations)?, scheme, h)
    }

    /// The steps of a mechanism that is assembled for all samples, within the limit that its system has.
    ///
    /// # Errors
    /// Where the equations are singular at the start, or the limit is exceeded.
    pub fn of(assembled: Assembled, scheme: Scheme, h: f64) -> Result<Self, SimulationError> {
        let Assembled { mut system, start, nominal, mobility, undetermined, shared, equilibrium, vibrations, derived } =
            assembled;
        let samples = pivot_samples(&system, &start.layout, &nominal, h);
        let program = compile(&system, scheme, &mobility.redundant, &samples);
        let program = program.map_err(|none| no_factors(&system, &none))?;
        system.graph.limit(None);
        Ok(Self {
            system,
            start,
            program,
            nominal,
            mobility,
            undetermined,
            shared,
            equilibrium,
            vibrations,
            derived,
            switches: OnceLock::new(),
            overlaps: OnceLock::new(),
            features: OnceLock::new(),
            time_functions: OnceLock::new(),
            free_closure: OnceLock::new(),
        })
    }

    /// All outputs in the nominal state.
    pub fn outputs_at_start(&self) -> Vec<f64> {
        let nominal: Sample = self.system.parameters.iter().map(|parameter| parameter.nominal).collect();
        outputs_in(&self.system, &self.start.layout, &self.nominal, 0..self.system.outputs.len(), &nominal)
    }

    /// Start states of samples: a tile of this width in which lane l has the parameters `sample(l)`.
    ///
    /// # Errors
    /// The first sample that cannot be assembled, with its parameters.
    pub fn assemble(&self, width: usize, h: f64, sample: impl Fn(usize) -> Sample) -> Result<Tile, SimulationError> {
        let samples: Vec<Sample> = (0..width).map(sample).collect();
        let (mut assembly, open) = match &self.equilibrium {
            Some(equilibrium) => self.at_equilibria(equilibrium, &samples)?,
            None => self.assembly(&samples),
        };
        if let Some(worst) = open.first() {
            return Err(assembly_error(&self.system, worst, &samples[worst.lane]));
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
    pub fn can_assemble(&self, samples: &[Sample]) -> Vec<bool> {
        let of_tile = |samples: &[Sample]| {
            let mut can = vec![true; samples.len()];
            // Lanes beyond the samples repeat the last one.
            let width = WIDTHS.into_iter().find(|&width| width >= samples.len()).unwrap_or(samples.len());
            let lanes: Vec<Sample> = (0..width).map(|lane| samples[lane.min(samples.len() - 1)].clone()).collect();
            if let Some(equilibrium) = &self.equilibrium {
                let has_one = |sample: &Sample| self.equilibrium_of(equilibrium, sample).is_ok();
                return samples.iter().map(has_one).collect();
            }
            if self.system.analysis == Analysis::Kinematics {
                return samples.iter().map(|sample| self.can_start_on_branch(sample)).collect();
            }
            for open in self.assembly(&lanes).1 {
                can.get_mut(open.lane).into_iter().for_each(|can| *can = false);
            }
            can
        };
        samples.chunks(TUNING.assembled_at_once).flat_map(of_tile).collect()
    }

    /// The state of a sample's equilibrium, at rest.
    ///
    /// # Errors
    /// Where none is found.
    pub fn equilibrium_of(&self, equilibrium: &Equilibrium, sample: &Sample) -> Result<Vec<f64>, SimulationError> {
        let nominal: Vec<f64> = self.system.parameters.iter().map(|parameter| parameter.nominal).collect();
        equilibrium.near(&self.nominal, &nominal, sample).map_err(|none| no_equilibrium(&self.system, &none, sample))
    }

    /// A tile of samples, each at its equilibrium.
    pub(super) fn at_equilibria(
        &self,
        equilibrium: &Equilibrium,
        samples: &[Sample],
    ) -> Result<(Assembly<'_>, Vec<ConstraintResidual>), SimulationError> {
        let mut assembly = Assembly::new(&self.start, &self.system, samples.len(), |k, lane| samples[lane][k]);
        assembly.set_state(&self.nominal);
        for (lane, sample) in samples.iter().enumerate() {
            let state = self.equilibrium_of(equilibrium, sample)?;
            for register in self.start.layout.q.clone() {
                assembly.tile_mut().lane_mut(register)[lane] = state[register];
            }
        }
        let open = assembly.assemble();
        Ok((assembly, open))
    }

    /// A tile of samples assembled from the nominal one, and the residuals of those that cannot be assembled. A sample
    /// far from the nominal one is reached by small changes of the parameters (continuation), which keeps it on the
    /// same branch of the linkage.
    pub(super) fn assembly(&self, samples: &[Sample]) -> (Assembly<'_>, Vec<ConstraintResidual>) {
        let at = |share: f64| {
            move |parameter: usize, lane: usize| {
                let (nominal, value) = (self.system.parameters[parameter].nominal, samples[lane][parameter]);
                if share == 1.0 { value } else { nominal + share * (value - nominal) }
            }
        };
        let mut assembly = Assembly::new(&self.start, &self.system, samples.len(), at(1.0));
        let mut open = assembly.assemble_from(&self.nominal);
        let mut far = assembly.far_from(&self.nominal);
        open.iter().for_each(|residual| far[residual.lane] = true);
        if far.contains(&true) {
            let mut continued = Assembly::new(&self.start, &self.system, samples.len(), at(0.0));
            continued.set_state(&self.nominal);
            for step in 1..TUNING.continuation_steps {
                continued.follow(at(step as f64 / TUNING.continuation_steps as f64));
            }
            continued.set_parameters(at(1.0));
            let open_now = continued.assemble();
            let closes = |lane: usize| open_now.iter().all(|residual| residual.lane != lane);
            let was_open = |lane: usize| open.iter().any(|residual| residual.lane == lane);
            let better: Vec<usize> =
                (0..far.len()).filter(|&lane| far[lane] && (closes(lane) || was_open(lane))).collect();
            assembly.copy_lanes(&continued, &better);
            open = open_now.into_iter().filter(|residual| better.contains(&residual.lane)).collect();
        }
        (assembly, open)
    }

    /// Whether rows of output solve for their accelerations and multipliers: outputs depend on them, and constraints
    /// disturb those of the steps.
    pub(crate) fn solves_row_accelerations(&self) -> bool {
        !self.system.lambda.is_empty() && self.system.observes_accelerations()
    }

    /// Whether rows of output make their velocities consistent where steps are controlled.
    pub(crate) fn projects_row_velocities(&self) -> bool {
        !self.system.lambda.is_empty() && (self.system.observes_velocities() || self.system.observes_accelerations())
    }

    /// The start's tapes with nothing given: they move any motion onto the constraints.
    ///
    /// # Errors
    /// Where its equations have no factors.
    pub(crate) fn free_closure(&self) -> Result<&StartProgram, SimulationError> {
        let compiled = self.free_closure.get_or_init(|| {
            let mut system = self.system.clone();
            let n = system.q.len();
            system.start.position = vec![None; n];
            system.start.velocity = vec![None; n];
            system.start.conditions.clear();
            compile_start(&system, &self.mobility.redundant, &self.nominal)
                .map_err(|none| no_factors(&self.system, &none))
        });
        compiled.as_ref().map_err(Clone::clone)
    }

    /// Switches of the equations, if they have any.
    pub fn switches(&self) -> Option<&SwitchProgram> {
        self.switches.get_or_init(|| compile_switches(&self.system)).as_ref()
    }

    /// Gaps of surfaces that may not overlap too deeply, if there are any.
    pub(super) fn overlaps(&self) -> Option<&SwitchProgram> {
        self.overlaps.get_or_init(|| compile_overlaps(&self.system)).as_ref()
    }

    /// Functions of the positions that a step may pass over, if forces have any.
    pub(super) fn features(&self) -> Option<&Features> {
        self.features.get_or_init(|| Features::of(&self.system)).as_ref()
    }

    /// Functions of the time in the equations of motion over a duration, s, if there are any. They are found once for
    /// the duration that is asked for first.
    pub fn time_functions(&self, duration: f64) -> Option<TimeFunctions> {
        let of = || TimeFunctions::of(&self.system, &self.start.layout, &self.nominal, duration);
        let (known, functions) = self.time_functions.get_or_init(|| (duration, of()));
        if *known == duration { functions.clone() } else { of() }
    }

    /// Name of an equation of a step: a coordinate's equation of motion or a constraint.
    pub fn equation_name(&self, equation: EquationId) -> String {
        equation_name(&self.system, Equation::of_row(equation.number(), self.system.q.len()))
    }
}
