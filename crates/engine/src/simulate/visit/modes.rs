//! Modes of a sample: at its start, at its equilibrium, or in every row of its motion.

use super::Visit;
use super::tuning::TUNING;
use crate::compile::Layout;
use crate::numerics::Sample;
use crate::simulate::control::Steps;
use crate::simulate::drive::{Accumulator, Channel, Integrator, Observed, Stop};
use crate::simulate::ensemble::EnsembleRun;
use crate::simulate::error::{SimulationError, assembly_error};
use crate::simulate::interruption::Interruption;
use crate::simulate::modal::tuning::TUNING as MODAL;
use crate::simulate::modal::{ModesThere, Vibrations};
use crate::simulate::simulator::Simulator;
use crate::simulate::start::Assembly;

/// States in rows (the layout's registers), and where they end.
type States = (Vec<Vec<f64>>, Option<Stop>);

impl Simulator {
    pub(super) fn visit_modes(
        &self,
        vibrations: &Vibrations,
        sample: &Sample,
        steps: Steps<'_>,
        channels: &[Channel],
        interruption: Interruption<'_>,
    ) -> Result<Visit, SimulationError> {
        let nominal = match vibrations.nominal.get() {
            Some(nominal) => nominal,
            None => {
                let found = self.nominal_places(vibrations, steps, interruption)?;
                vibrations.nominal.get_or_init(|| found)
            }
        };
        let (states, stop) = self.states(sample, steps, interruption)?;
        let lines = self.system.outputs.len();
        let mut visit = Visit { stop, ..Visit::default() };
        let mut reduction = Accumulator::new(channels, lines, 1);
        for (row, (state, nominal)) in states.iter().zip(nominal).enumerate() {
            if interruption.is_asked() {
                return Err(SimulationError::Interrupted);
            }
            let mut told = match self.followed(vibrations, state, nominal, sample, states.len() == 1) {
                Some(index) => vibrations.tell(state, &index, nominal),
                None => vec![f64::NAN; lines],
            };
            self.derived.iter().for_each(|derived| derived.set(sample, &mut told));
            visit.values.extend_from_slice(&told);
            reduction.push(steps.schedule.time(row), told, &[true]);
        }
        visit.reduced = reduction.finish();
        if visit.stop.is_some() {
            visit.reduced.fill(f64::NAN);
        }
        Ok(visit)
    }

    /// Modes of the nominal sample, each row's in the order of the row before.
    fn nominal_places(
        &self,
        vibrations: &Vibrations,
        steps: Steps<'_>,
        interruption: Interruption<'_>,
    ) -> Result<Vec<ModesThere>, SimulationError> {
        let nominal: Sample = self.system.parameters.iter().map(|parameter| parameter.nominal).collect();
        let (states, _) = self.states(&nominal, steps, interruption)?;
        let mut places: Vec<ModesThere> = Vec::with_capacity(states.len());
        for state in &states {
            if interruption.is_asked() {
                return Err(SimulationError::Interrupted);
            }
            let Some((mut place, _)) = vibrations.place(state, None) else { break };
            if let Some(before) = places.last()
                && let Some((followed, _)) = vibrations.place(state, Some(before))
            {
                place.modes = followed.modes;
            }
            places.push(place);
        }
        Ok(places)
    }

    /// The modes of a state that are the nominal ones. Where shapes are not alike, small changes of the parameters lead
    /// there.
    fn followed(
        &self,
        vibrations: &Vibrations,
        state: &[f64],
        nominal: &ModesThere,
        sample: &Sample,
        is_alone: bool,
    ) -> Option<ModesThere> {
        let (direct, least) = vibrations.place(state, Some(nominal))?;
        if least >= MODAL.alike_shapes || !is_alone {
            return Some(direct);
        }
        let mut known = nominal.clone();
        for step in 1..=TUNING.continuation_steps {
            let share = step as f64 / TUNING.continuation_steps as f64;
            let of_parameter = |(parameter, value): (&crate::assemble::UncertainParameter, &f64)| {
                parameter.nominal + share * (value - parameter.nominal)
            };
            let between: Sample = self.system.parameters.iter().zip(sample.iter()).map(of_parameter).collect();
            let state =
                if step == TUNING.continuation_steps { state.to_vec() } else { self.state_at_start(&between).ok()? };
            known = vibrations.place(&state, Some(&known))?.0;
        }
        Some(known)
    }

    fn state_at_start(&self, sample: &Sample) -> Result<Vec<f64>, SimulationError> {
        let samples = std::slice::from_ref(sample);
        let (assembly, open) = match &self.equilibrium {
            Some(equilibrium) => self.at_equilibria(equilibrium, samples)?,
            None => self.assembly(samples),
        };
        match open.first() {
            Some(worst) => Err(assembly_error(&self.system, worst, sample)),
            None => Ok(assembly.tile().values()[..self.start.layout.registers()].to_vec()),
        }
    }

    /// The states of a sample in all rows.
    fn states(
        &self,
        sample: &Sample,
        steps: Steps<'_>,
        interruption: Interruption<'_>,
    ) -> Result<States, SimulationError> {
        let schedule = steps.schedule;
        let start = self.state_at_start(sample)?;
        if schedule.rows == 1 {
            return Ok((vec![start], None));
        }
        let samples = std::slice::from_ref(sample);
        let mut run = EnsembleRun::start(self, samples, schedule.first_step())?;
        run.heed(interruption);
        let mut motion = Vec::new();
        let stops = run.advance(steps, 0..schedule.rows, Observed::Motion, &mut motion);
        if run.is_cut() {
            return Err(SimulationError::Interrupted);
        }
        let stop = stops.first().map(|stop| Stop { open: run.open_constraint(stop, schedule), ..*stop });
        let reached = stop.as_ref().map_or(schedule.rows, |stop| stop.row);
        let layout: &Layout = &self.start.layout;
        let mut assembly = Assembly::new(&self.start, &self.system, 1, |parameter, _| sample[parameter]);
        assembly.set_state(&start);
        let of_row = |(row, values): (usize, &[f64])| {
            for (register, value) in layout.q.clone().chain(layout.v.clone()).zip(values) {
                assembly.tile_mut().lane_mut(register)[0] = *value;
            }
            assembly.tile_mut().lane_mut(layout.time)[0] = schedule.time(row);
            assembly.accelerate();
            assembly.tile().values()[..layout.registers()].to_vec()
        };
        let lines = Observed::Motion.count(self);
        Ok((motion.chunks_exact(lines).take(reached).enumerate().map(of_row).collect(), stop))
    }
}
