//! Outputs of a configuration's small vibrations, in their order.

use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

use nalgebra::DVector;
use symdiff::math;

use super::eigen::{Mode, modes};
use super::first_order::eigenvalues;
use super::follow::followed;
use super::gradients::Gradients;
use super::random::RandomLoads;
use super::response::Response;
use super::roots::{self, ModeKind, OutputChanges, Root};
use crate::assemble::{ConstraintId, System};
use crate::compile::{EquationsProgram, compile_equations};
use crate::model::ModesRequest;
use crate::numerics::{RowSpace, combined, dot};
use crate::simulate::statics::{Linearised, StaticConfiguration, reduced, times};

/// Small vibrations of a mechanism.
#[derive(Debug)]
pub struct Vibrations {
    program: EquationsProgram,
    scale: Vec<f64>,
    redundant: Vec<ConstraintId>,
    /// Indices of the coordinates whose velocities are states.
    states: Vec<usize>,
    gradients: Gradients,
    /// Random excitations, if any.
    random: Option<RandomLoads>,
    /// Outputs of the model itself.
    outputs: usize,
    /// Outputs that follow from the results.
    derived: usize,
    /// Number of modes in the results.
    number: usize,
    /// Load and output of each response, by number, and its frequencies, Hz.
    responses: Vec<(usize, usize, Vec<f64>)>,
    /// With states, the modes of the nominal start, which determine the kind of each mode everywhere.
    first: Option<ModesThere>,
    /// The nominal sample's, which others are compared with, row by row.
    pub nominal: OnceLock<Vec<ModesThere>>,
}

/// A configuration's modes, those that are followed, and the outputs.
#[derive(Clone, Debug)]
pub struct ModesThere {
    /// In the order of the outputs.
    pub modes: Modes,
    /// The output by which each mode's shape is measured: there it is one.
    measured_by: Vec<usize>,
    /// Phases of the responses, rad.
    phases: Vec<f64>,
}

/// The modes of a configuration.
#[derive(Clone, Debug)]
pub enum Modes {
    /// Without states, with M, by which shapes are compared.
    OfMasses { modes: Vec<Mode>, mass: nalgebra::DMatrix<f64> },
    /// With states: all of them, and the largest growth of any.
    OfStates { modes: Vec<Root>, growth: f64 },
}

impl Modes {
    /// Frequencies of all modes that are followed, Hz.
    fn frequencies(&self) -> Vec<f64> {
        match self {
            Self::OfMasses { modes, .. } => modes.iter().map(|mode| mode.frequency.abs() / TAU).collect(),
            Self::OfStates { modes, .. } => modes.iter().flat_map(Root::frequencies).collect(),
        }
    }
}

impl Vibrations {
    /// Prepares a mechanism with `freedom` degrees of freedom and this nominal start (the layout's registers).
    pub fn new(system: &System, redundant: &[ConstraintId], freedom: usize, nominal: &[f64]) -> Self {
        let ModesRequest { number, responses } = &system.modes;
        // Those that follow from modes come last.
        let outputs = system.outputs.iter().filter(|output| !output.is_derived()).count();
        let named = |name: &str| system.outputs.iter().position(|output| output.name == name);
        let response = |response: &crate::model::ResponseRequest| {
            Some((named(&response.load)?, named(&response.output)?, response.frequencies.clone()))
        };
        let mut vibrations = Self {
            program: compile_equations(system),
            scale: system.coordinates.iter().map(|coordinate| coordinate.scale).collect(),
            redundant: redundant.to_vec(),
            states: (0..system.q.len()).filter(|&index| system.coordinates[index].is_state).collect(),
            gradients: Gradients::new(system, outputs),
            random: RandomLoads::new(system, outputs),
            outputs,
            derived: system.outputs.len() - outputs,
            number: (*number).min(freedom),
            responses: responses.iter().filter_map(response).collect(),
            first: None,
            nominal: OnceLock::new(),
        };
        if system.has_states() {
            vibrations.first = vibrations.place(nominal, None).map(|(index, _)| index);
            vibrations.number = vibrations.kinds().len().min(*number);
        }
        vibrations
    }

    /// With states, the kind of each mode.
    fn kinds(&self) -> Vec<ModeKind> {
        match self.first.as_ref().map(|first| &first.modes) {
            Some(Modes::OfStates { modes, .. }) => modes.iter().map(|mode| mode.kind).collect(),
            _ => Vec::new(),
        }
    }

    /// Names and units of each mode's results; `None` without states.
    pub fn quantities(&self) -> Option<Vec<&'static [(&'static str, &'static str)]>> {
        let kinds = self.kinds();
        (!self.states.is_empty()).then(|| kinds[..self.number].iter().map(|kind| kind.quantities()).collect())
    }

    /// Number of modes in the results.
    pub fn number(&self) -> usize {
        self.number
    }

    /// The equations about a state's position (the layout's registers), as if it were stopped there and released, and
    /// the outputs of the state itself. Away from an equilibrium a stiffness depends on the coordinates; this is the
    /// one in the metric of the kinetic energy. States keep their values.
    fn linearised(&self, state: &[f64]) -> (Linearised, Vec<f64>) {
        let layout = &self.program.layout;
        let parameters = &state[layout.parameters.clone()];
        let mut at = StaticConfiguration::new(&self.program, &self.scale, &self.redundant, parameters);
        at.set(layout.time..layout.time + 1, &state[layout.time..layout.time + 1]);
        at.set(layout.state(), &state[layout.state()]);
        let outputs = at.outputs();
        let (n, m) = (layout.q.len(), layout.lambda.len());
        at.set(layout.v.start..layout.w.end, &vec![0.0; layout.w.end - layout.v.start]);
        for register in self.states.iter().map(|index| layout.v.start + index) {
            at.set(register..register + 1, &state[register..register + 1]);
        }
        at.set(layout.lambda.clone(), &vec![0.0; m]);
        let unheld = at.linearise();
        let space = RowSpace::of(&unheld.jacobian, n);
        let forces: Vec<f64> = unheld.motion.iter().map(|force| -force).collect();
        let along: Vec<f64> = space.null.iter().map(|vector| dot(vector, &forces)).collect();
        let part = reduced(&unheld.mass, &space.null).cholesky().map(|root| root.solve(&DVector::from_vec(along)));
        let begins = part.map_or_else(|| vec![0.0; n], |part| combined(&space.null, part.as_slice(), n));
        let inertial = times(&unheld.mass, &begins);
        let held: Vec<f64> = forces.iter().zip(&inertial).map(|(force, inertial)| force - inertial).collect();
        at.set(layout.lambda.clone(), &space.multipliers(&held, m));
        (at.linearise(), outputs)
    }

    /// The modes of a state that are most like those of a known configuration, and how much alike the least are;
    /// without one, the slowest.
    pub fn place(&self, state: &[f64], known: Option<&ModesThere>) -> Option<(ModesThere, f64)> {
        let (linear, _) = self.linearised(state);
        let reference = known.or(self.first.as_ref());
        let (modes, least) = self.modes(&linear, reference)?;
        let (measured_by, phases) = match reference {
            Some(reference) => (reference.measured_by.clone(), reference.phases.clone()),
            None => {
                let gradients = self.gradients.at(state, &self.scale, self.outputs);
                let largest = |changes: &Vec<[f64; 2]>| {
                    let size = |output: usize| math::hypot(changes[output][0], changes[output][1]);
                    (0..self.outputs).reduce(|a, b| if size(b) > size(a) { b } else { a }).unwrap_or(0)
                };
                (self.changes(&linear, &gradients, &modes).iter().map(largest).collect(), Vec::new())
            }
        };
        let mut place = ModesThere { modes, measured_by, phases };
        if known.is_none() {
            place.phases = self.responses_of(state, &linear, None).chunks(2).map(|pair| pair[1]).collect();
        }
        Some((place, least))
    }

    fn modes(&self, linear: &Linearised, known: Option<&ModesThere>) -> Option<(Modes, f64)> {
        if !self.states.is_empty() {
            let found = eigenvalues(linear, &self.states)?;
            let growth = roots::growth(&found);
            let (modes, least) = match known.map(|known| &known.modes) {
                Some(Modes::OfStates { modes, .. }) => roots::followed(modes, &found),
                _ => (found.into_iter().map(Root::of).collect(), 1.0),
            };
            return Some((Modes::OfStates { modes, growth }, least));
        }
        let found = modes(linear)?;
        let (modes, least) = match known.map(|known| &known.modes) {
            Some(Modes::OfMasses { modes, mass }) => followed(modes, &found, mass),
            _ => (found.into_iter().take(self.number).collect(), 1.0),
        };
        Some((Modes::OfMasses { modes, mass: linear.mass.clone() }, least))
    }

    /// Change of each output with each mode, real and imaginary part. Without states, positions alone count.
    fn changes(&self, linear: &Linearised, gradients: &[Vec<Vec<f64>>; 4], modes: &Modes) -> Vec<Vec<[f64; 2]>> {
        match modes {
            Modes::OfMasses { modes, .. } => {
                let of_mode = |mode: &Mode| gradients[0].iter().map(|by| moved(by, mode)).collect();
                modes.iter().map(of_mode).collect()
            }
            Modes::OfStates { modes, .. } => {
                let changes = OutputChanges::of(linear, gradients);
                modes.iter().map(|mode| changes.of_root(mode)).collect()
            }
        }
    }

    /// All outputs at a state whose modes are known, with phases near those of `nominal`.
    pub fn tell(&self, state: &[f64], place: &ModesThere, nominal: &ModesThere) -> Vec<f64> {
        let (linear, outputs) = self.linearised(state);
        let gradients = self.gradients.at(state, &self.scale, self.outputs);
        let mut told = outputs[..self.outputs].to_vec();
        told.extend(std::iter::repeat_n(f64::NAN, self.derived));
        if let Modes::OfStates { growth, .. } = &place.modes {
            told.push(*growth);
        }
        let changes = self.changes(&linear, &gradients, &place.modes);
        for (mode, (changes, &measured_by)) in changes.iter().zip(&nominal.measured_by).take(self.number).enumerate() {
            match &place.modes {
                Modes::OfMasses { modes, .. } => told.extend([modes[mode].frequency / TAU, modes[mode].damping]),
                Modes::OfStates { modes, .. } => told.extend(modes[mode].told()),
            }
            let reference = changes.get(measured_by).copied().unwrap_or([0.0; 2]);
            let square = reference[0] * reference[0] + reference[1] * reference[1];
            // The part in phase with the output that moves most.
            let in_phase = |[re, im]: &[f64; 2]| {
                if square > 0.0 { (re * reference[0] + im * reference[1]) / square } else { 0.0 }
            };
            told.extend(changes.iter().map(in_phase));
        }
        told.extend(self.responses_of(state, &linear, Some(&nominal.phases)));
        if let Some(random) = &self.random {
            let found =
                random.tell(state, &self.scale, &Response::new(&linear), &gradients, &place.modes.frequencies());
            told.extend(found.into_iter().flatten());
        }
        told
    }

    /// Amplitude and phase of each response at each of its frequencies; phases within half a turn of known ones.
    fn responses_of(&self, state: &[f64], linear: &Linearised, near: Option<&Vec<f64>>) -> Vec<f64> {
        if self.responses.is_empty() {
            return Vec::new();
        }
        let gradients = self.gradients.at(state, &self.scale, self.outputs);
        let response = Response::new(linear);
        let mut told = Vec::new();
        for (load, output, frequencies) in &self.responses {
            let by = [0, 1, 2, 3].map(|kind| gradients[kind][*output].as_slice());
            for &frequency in frequencies {
                let [re, im] = response.of(&gradients[0][*load], by, TAU * frequency);
                let mut phase = math::atan2(im, re);
                if let Some(&near) = near.and_then(|near| near.get(told.len() / 2)) {
                    phase += TAU * ((near - phase) / TAU).round();
                } else if phase > PI - 1e-9 {
                    phase -= TAU;
                }
                told.extend([math::hypot(re, im), phase]);
            }
        }
        told
    }
}

/// Change of an output with a mode.
fn moved(by: &[f64], mode: &Mode) -> [f64; 2] {
    [dot(by, &mode.shape[0]), dot(by, &mode.shape[1])]
}
