//! Outputs of a configuration's small vibrations, in their order.

use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

use nalgebra::DVector;
use symdiff::math;

use super::eigen::{Mode, modes};
use super::follow::followed;
use super::gradients::Gradients;
use super::response::Response;
use crate::assemble::{ConstraintId, OutputInfo, System};
use crate::compile::{EquationsProgram, compile_equations};
use crate::grammar::quantity::Dimension;
use crate::model::ModesRequest;
use crate::numerics::{RowSpace, combined, dot};
use crate::simulate::statics::{Configuration, Linearised, reduced, times};

/// Shapes that are less alike than this may be of other modes: smaller changes of the parameters are made.
pub const ALIKE: f64 = 0.8;

/// Small vibrations of a mechanism.
#[derive(Debug)]
pub struct Vibrations {
    program: EquationsProgram,
    scale: Vec<f64>,
    redundant: Vec<ConstraintId>,
    gradients: Gradients,
    /// Outputs of the model itself.
    outputs: usize,
    number: usize,
    /// Load and output of each response, by number, and its frequencies, Hz.
    responses: Vec<(usize, usize, Vec<f64>)>,
    /// The nominal sample's, which others are compared with, row by row.
    pub nominal: OnceLock<Vec<Place>>,
}

/// A configuration's modes, those that are followed, and the outputs.
#[derive(Clone, Debug)]
pub struct Place {
    /// In the order of the outputs.
    pub modes: Vec<Mode>,
    /// M, by which shapes are compared.
    mass: nalgebra::DMatrix<f64>,
    /// The output by which each mode's shape is measured: there it is one.
    measured_by: Vec<usize>,
    /// Phases of the responses, rad.
    phases: Vec<f64>,
}

/// Names and units of the outputs of the vibrations of a mechanism with so many degrees of freedom.
pub fn further_outputs(system: &mut System, freedom: usize) {
    let request = system.modes.clone();
    let (number, model) = (request.number.min(freedom), system.outputs.clone());
    let expr = system.graph.constant(0.0);
    let mut add = |name: String, unit: String| {
        system.outputs.push(OutputInfo { name, unit, dimension: None, expr });
    };
    for mode in 1..=number {
        add(format!("mode{mode}.frequency"), "Hz".to_owned());
        add(format!("mode{mode}.damping"), String::new());
        model.iter().for_each(|output| add(format!("mode{mode}.shape.{}", output.name), String::new()));
    }
    for response in &request.responses {
        let unit_of = |name: &str| model.iter().find(|output| output.name == name);
        let force = unit_of(&response.load).is_some_and(|load| load.dimension == Some(Dimension::ANGLE));
        let force = if force { "(N*m)" } else { "N" };
        let unit = unit_of(&response.output).map_or("", |output| output.unit.as_str());
        let unit = format!("{}/{force}", if unit.is_empty() { "1" } else { unit });
        for (place, _) in response.frequencies.iter().enumerate() {
            add(format!("response.{}.{place}.amplitude", response.name), unit.clone());
            add(format!("response.{}.{place}.phase", response.name), "rad".to_owned());
        }
    }
}

impl Vibrations {
    /// Of a mechanism with so many degrees of freedom, whose outputs are complete.
    pub fn new(system: &System, redundant: &[ConstraintId], freedom: usize) -> Self {
        let ModesRequest { number, responses } = &system.modes;
        let number = (*number).min(freedom);
        let further: usize = responses.iter().map(|response| 2 * response.frequencies.len()).sum();
        // Every mode has two outputs and one for each of the model's.
        let outputs = (system.outputs.len() - further - 2 * number) / (1 + number);
        let named = |name: &str| system.outputs[..outputs].iter().position(|output| output.name == name);
        let response = |response: &crate::model::ResponseRequest| {
            Some((named(&response.load)?, named(&response.output)?, response.frequencies.clone()))
        };
        Self {
            program: compile_equations(system),
            scale: system.coordinates.iter().map(|coordinate| coordinate.scale).collect(),
            redundant: redundant.to_vec(),
            gradients: Gradients::new(system, outputs),
            outputs,
            number,
            responses: responses.iter().filter_map(response).collect(),
            nominal: OnceLock::new(),
        }
    }

    /// The equations about a state's position (the layout's registers), as if it were held there and let go, and the outputs of the state
    /// itself. Away from an equilibrium a stiffness depends on the coordinates; this is the one in the metric of the kinetic energy.
    fn linearised(&self, state: &[f64]) -> (Linearised, Vec<f64>) {
        let layout = &self.program.layout;
        let parameters = &state[layout.parameters.clone()];
        let mut at = Configuration::new(&self.program, &self.scale, &self.redundant, parameters);
        at.set(layout.time..layout.time + 1, &state[layout.time..layout.time + 1]);
        at.set(layout.state(), &state[layout.state()]);
        let outputs = at.outputs();
        let (n, m) = (layout.q.len(), layout.lambda.len());
        at.set(layout.v.start..layout.w.end, &vec![0.0; layout.w.end - layout.v.start]);
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

    /// The modes of a state that are most like those of a known place, and how much alike the least are; without one, the slowest.
    pub fn place(&self, state: &[f64], known: Option<&Place>) -> Option<(Place, f64)> {
        let (linear, _) = self.linearised(state);
        let found = modes(&linear)?;
        let (modes, least) = match known {
            Some(known) => followed(&known.modes, &found, &known.mass),
            None => (found.into_iter().take(self.number).collect(), 1.0),
        };
        let (measured_by, phases) = match known {
            Some(known) => (known.measured_by.clone(), known.phases.clone()),
            None => {
                let by_position = &self.gradients.at(state, &self.scale, self.outputs)[0];
                let size = |mode: &Mode, output: usize| {
                    let [re, im] = moved(&by_position[output], mode);
                    math::hypot(re, im)
                };
                let largest = |mode: &Mode| {
                    (0..self.outputs).reduce(|a, b| if size(mode, b) > size(mode, a) { b } else { a }).unwrap_or(0)
                };
                (modes.iter().map(largest).collect(), Vec::new())
            }
        };
        let mut place = Place { modes, mass: linear.mass.clone(), measured_by, phases };
        if known.is_none() {
            place.phases = self.responses_of(state, &linear, None).chunks(2).map(|pair| pair[1]).collect();
        }
        Some((place, least))
    }

    /// All outputs at a state whose modes are known, with phases near those of `nominal`.
    pub fn tell(&self, state: &[f64], place: &Place, nominal: &Place) -> Vec<f64> {
        let (linear, outputs) = self.linearised(state);
        let by_position = &self.gradients.at(state, &self.scale, self.outputs)[0];
        let mut told = outputs[..self.outputs].to_vec();
        for (mode, &measured_by) in place.modes.iter().zip(&nominal.measured_by) {
            told.extend([mode.frequency / TAU, mode.damping]);
            let reference = by_position.get(measured_by).map_or([0.0; 2], |by| moved(by, mode));
            let square = reference[0] * reference[0] + reference[1] * reference[1];
            // The part in phase with the output that moves most.
            told.extend(by_position.iter().map(|by| {
                let [re, im] = moved(by, mode);
                if square > 0.0 { (re * reference[0] + im * reference[1]) / square } else { 0.0 }
            }));
        }
        told.extend(self.responses_of(state, &linear, Some(&nominal.phases)));
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

/// What a mode does to an output.
fn moved(by: &[f64], mode: &Mode) -> [f64; 2] {
    [dot(by, &mode.shape[0]), dot(by, &mode.shape[1])]
}
