//! A mechanism that is assembled at its nominal parameters, before the programs of its steps are compiled.

use std::ops::Range;
use std::sync::Arc;

use rustc_hash::FxHashMap;
use symdiff::Expr;

use super::derived::Derived;
use super::diagnostics::{not_finite, outside, over_constrained, undetermined_outputs};
use super::error::{SimulationError, assembly_error, no_equilibrium, no_factors, not_driven};
use super::further::further_outputs;
use super::modal::Vibrations;
use super::start::{Assembly, Mobility, Samples, contradiction, guess_state, mobility, open_start, shared_coordinates};
use super::statics::Equilibrium;
use crate::assemble::{OutputId, System};
use crate::compile::{Layout, Scheme, StartProgram, compile_nearest_start, compile_start};
use crate::model::Analysis;
use crate::numerics::Sample;

/// A mechanism that is assembled at its nominal parameters.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// The equations.
    pub system: System,
    /// Tapes for the start.
    pub start: StartProgram,
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
}

impl Assembled {
    /// Assembles for steps of `h`, with a limit on the number of operations that the start may take. The system keeps
    /// the limit, and the start is one for these samples.
    ///
    /// # Errors
    /// Where no consistent start exists, the equations are singular there, or the limit is exceeded.
    pub fn within(
        samples: Samples,
        mut system: System,
        scheme: Scheme,
        h: f64,
        operations: Option<usize>,
    ) -> Result<Self, SimulationError> {
        system.graph.limit(operations.map(|operations| system.graph.len() + operations));
        let parameters: Vec<f64> = system.parameters.iter().map(|parameter| parameter.nominal).collect();
        let layout = Layout::of(&system);
        let guess = guess_state(&system, &layout, &parameters);
        let no_number = |state: &[f64]| {
            let names = system.parameters.iter().map(|parameter| parameter.name.clone());
            let named = || names.zip(parameters.iter().copied()).collect();
            let term = not_finite(&system, &layout, state, 0.0)?;
            Some(SimulationError::NotFinite { term, time: 0.0, parameters: named() })
        };
        let assembled = |start: &StartProgram| {
            let mut assembly = Assembly::new(start, &system, 1, |parameter, _| parameters[parameter]);
            assembly.assemble_nominal().map_err(|worst| {
                // Values that follow from a term without a finite value are not finite either.
                let finite = |value: &f64| if value.is_finite() { *value } else { 0.0 };
                let state: Vec<f64> = assembly.tile().values()[..layout.registers()].iter().map(finite).collect();
                let not_a_number = worst.residual.is_nan().then(|| no_number(&state));
                not_a_number.flatten().unwrap_or_else(|| {
                    assembly_error(&system, &worst, &parameters).because(over_constrained(&system, start, &guess))
                })
            })?;
            assembly.shift_accelerations(scheme.coefficients().shift() * h);
            Ok(assembly.tile().values()[..layout.registers()].to_vec())
        };
        let mut start = compile_start(&system, &[], &guess).map_err(|none| no_factors(&system, &none))?;
        let mut nominal = assembled(&start)?;
        let mobility = mobility(&system, &start, &nominal);
        if !mobility.redundant.is_empty() {
            start = compile_start(&system, &mobility.redundant, &guess).map_err(|none| no_factors(&system, &none))?;
            nominal = assembled(&start)?;
        }
        if let Some(error) = no_number(&nominal) {
            return Err(error);
        }
        if let Some(constraint) = contradiction(&system, &start, &nominal, &mobility) {
            return Err(SimulationError::Contradiction { joint: system[constraint].joint.clone() });
        }
        let mut equilibrium =
            system.start.at_equilibrium.then(|| Arc::new(Equilibrium::new(&system, &mobility.redundant)));
        if let Some(equilibrium) = &equilibrium {
            let found = equilibrium.find(&nominal, &parameters);
            nominal = found.map_err(|none| no_equilibrium(&system, &none, &parameters))?;
            system.start_at_equilibrium();
            start = compile_start(&system, &mobility.redundant, &nominal).map_err(|none| no_factors(&system, &none))?;
            let mut assembly = Assembly::new(&start, &system, 1, |parameter, _| parameters[parameter]);
            if let Some(worst) = assembly.assemble_from(&nominal).first() {
                return Err(assembly_error(&system, worst, &parameters));
            }
            assembly.shift_accelerations(scheme.coefficients().shift() * h);
            nominal = assembly.tile().values()[..layout.registers()].to_vec();
        }
        let open = open_start(&system, &start, &nominal, samples);
        if open.is_any() {
            let nearest = compile_nearest_start(&system, &mobility.redundant, &guess, open)
                .map_err(|none| no_factors(&system, &none))?;
            let mut assembly = Assembly::new(&nearest, &system, 1, |parameter, _| parameters[parameter]);
            if assembly.assemble_nearest(&nominal).is_ok() {
                assembly.shift_accelerations(scheme.coefficients().shift() * h);
                nominal = assembly.tile().values()[..layout.registers()].to_vec();
                start = nearest;
            }
        }
        if let Some((effect, distance)) = outside(&system, &layout, &nominal) {
            return Err(SimulationError::StartsOutside { effect, distance });
        }
        let shared = shared_coordinates(&system, &start, &nominal);
        let vibrations = matches!(system.analysis, Analysis::Modes(_))
            .then(|| Arc::new(Vibrations::new(&system, &mobility.redundant, mobility.degrees_of_freedom, &nominal)));
        further_outputs(&mut system, vibrations.as_deref());
        let derived = Derived::of(&system)?.map(Arc::new);
        if let (Some(equilibrium), Some(_)) = (&mut equilibrium, system.analysis.is_without_steps().then_some(())) {
            *equilibrium = Arc::new(Equilibrium::new(&system, &mobility.redundant));
        }
        if system.analysis == Analysis::Kinematics && mobility.degrees_of_freedom > 0 {
            return Err(not_driven(&system, &start, &nominal));
        }
        let undetermined = undetermined_outputs(&system, &start, &nominal, &mobility);
        Ok(Self { system, start, nominal, mobility, undetermined, shared, equilibrium, vibrations, derived })
    }

    /// Some outputs in the nominal state, with these parameters in their formulas.
    pub fn outputs_at_start(&self, which: Range<usize>, sample: &Sample) -> Vec<f64> {
        outputs_in(&self.system, &self.start.layout, &self.nominal, which, sample)
    }
}

/// Some outputs in a state (the layout's registers), with these parameters in their formulas.
pub(super) fn outputs_in(
    system: &System,
    layout: &Layout,
    state: &[f64],
    which: Range<usize>,
    sample: &Sample,
) -> Vec<f64> {
    let symbols = [&system.q, &system.v, &system.w, &system.lambda].into_iter().flatten().copied();
    let registers = [&layout.q, &layout.v, &layout.w, &layout.lambda].into_iter().flat_map(Clone::clone);
    let values = symbols.zip(registers.map(|register| state[register]));
    let parameters = system.parameters.iter().map(|parameter| parameter.symbol).zip(sample.iter().copied());
    let inputs = system.input_symbols().zip(layout.inputs.clone());
    let inputs = inputs.map(|(symbol, register)| (symbol, state[register]));
    let values: FxHashMap<Expr, f64> = values.chain(parameters).chain(inputs).chain([(system.time, 0.0)]).collect();
    let outputs: Vec<Expr> = system.outputs[which].iter().map(|output| output.expr).collect();
    system.graph.evaluate(&outputs, |symbol| values.get(&symbol).copied().unwrap_or(f64::NAN))
}
