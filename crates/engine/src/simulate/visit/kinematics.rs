//! Positions, velocities and accelerations that follow from motors: Φ(q, t) = 0, Φ̇ = 0 and Φ̈ = 0 in every row.
//!
//! Each row begins where q + h v + h²/2 w of the row before leads. It stays on its branch of the linkage: the way is
//! halved where the correction from there is long, where the second correction is not much shorter than the first, so
//! that another root is about as near (P. Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 5.1), and
//! where the determinant of Φ_q changes its sign. Where even the shortest way changes it, branches meet within
//! rounding: the mechanism goes on smoothly, and the configuration is reported as singular.

use super::Visit;
use super::tuning::TUNING;
use crate::assemble::EquationId;
use crate::numerics::Sample;
use crate::simulate::control::Schedule;
use crate::simulate::diagnostics::SingularPass;
use crate::simulate::drive::{Accumulator, Channel, Stop};
use crate::simulate::error::{SimulationError, assembly_error};
use crate::simulate::interruption::Interruption;
use crate::simulate::simulator::Simulator;
use crate::simulate::start::{Assembly, Orientation, Oriented};

impl Simulator {
    /// Every row; where outputs are reduced to one number, every step between rows too.
    pub(super) fn visit_kinematics(
        &self,
        sample: &Sample,
        schedule: &Schedule,
        channels: &[Channel],
        interruption: Interruption<'_>,
    ) -> Result<Visit, SimulationError> {
        let mut visit = Visit::default();
        let (mut times, mut rows) = (Vec::new(), Vec::new());
        for row in 0..schedule.rows {
            if !channels.is_empty() {
                let steps = schedule.steps_to(row).map(|(_, end)| end);
                times.extend(steps.filter(|&end| end < schedule.time(row)));
            }
            rows.push(times.len());
            times.push(schedule.time(row));
        }
        let mut reduction = Accumulator::new(channels, self.start.outputs.len(), 1);
        let mut index = 0;
        let way = self.walk(sample, &times, interruption, &mut |assembly| {
            let outputs = self.start.outputs.iter().map(|&register| assembly.tile().lane(register)[0]);
            if !channels.is_empty() {
                let mut values = reduction.buffer();
                values.iter_mut().zip(outputs.clone()).for_each(|(value, output)| *value = output);
                reduction.push(times[index], values, &[true]);
            }
            if rows.binary_search(&index).is_ok() {
                visit.values.extend(outputs);
            }
            index += 1;
        })?;
        visit.reduced = reduction.finish();
        visit.singular = way.singular;
        visit.stop = way.stop.map(|stop| {
            visit.reduced.fill(f64::NAN);
            Stop { row: rows.partition_point(|&row| row < stop.row), ..stop }
        });
        Ok(visit)
    }

    /// Goes through all rows, and calls `row` in each after the outputs are observed.
    pub(super) fn walk(
        &self,
        sample: &Sample,
        times: &[f64],
        interruption: Interruption<'_>,
        row: &mut dyn FnMut(&Assembly),
    ) -> Result<Way, SimulationError> {
        let mut branch = Branch::new(self);
        let mut assembly = self.assembly_on_branch(sample, &mut branch)?;
        let mut way = Way::default();
        let mut now = 0.0;
        for (index, &time) in times.iter().enumerate() {
            if interruption.is_asked_in(index) {
                return Err(SimulationError::Interrupted);
            }
            while now < time {
                let mut step = time - now;
                // The shortest way to the other sign of the determinant.
                let mut across = None;
                let reached = (0..TUNING.halvings_of_way).any(|_| {
                    let end = if step == time - now { time } else { now + step };
                    match assembly.advance_to(end, step, &mut branch) {
                        Advance::Near => {
                            now = end;
                            return true;
                        }
                        Advance::Crossed(_) => {
                            assembly.restore(&branch.before);
                            across = Some((end, step));
                        }
                        Advance::Far => (),
                    }
                    step *= 0.5;
                    false
                });
                if reached {
                    continue;
                }
                let crossed = across.map(|(end, step)| (end, assembly.advance_to(end, step, &mut branch)));
                let Some((end, Advance::Crossed(oriented))) = crossed else {
                    way.stop = Some(self.stopped(&assembly, index, now, step));
                    return Ok(way);
                };
                now = end;
                branch.is_negative = Some(oriented.is_negative);
                way.singular.push(SingularPass { time: end, constraints: vec![oriented.least] });
            }
            assembly.observe();
            row(&assembly);
        }
        Ok(way)
    }

    /// The start of a sample on the nominal one's branch. Where that of any branch is on another, parameters lead there
    /// by small changes.
    ///
    /// # Errors
    /// Where it cannot be assembled, or its branch ends on the way.
    fn assembly_on_branch(&self, sample: &Sample, branch: &mut Branch) -> Result<Assembly<'_>, SimulationError> {
        let (mut assembly, open) = self.assembly(std::slice::from_ref(sample));
        if let Some(worst) = open.first() {
            return Err(assembly_error(&self.system, worst, sample));
        }
        if branch.oriented(&mut assembly).is_none_or(|oriented| branch.is_on(oriented)) {
            return Ok(assembly);
        }
        let nominal: Vec<f64> = self.system.parameters.iter().map(|parameter| parameter.nominal).collect();
        let mut followed = Assembly::new(&self.start, &self.system, 1, |k, _| nominal[k]);
        followed.set_state(&self.nominal);
        let mut now = 0.0;
        while now < 1.0 {
            let mut step = 1.0 - now;
            let reached = (0..TUNING.halvings_of_way).any(|_| {
                let end: f64 = if step == 1.0 - now { 1.0 } else { now + step };
                let between = |k: usize| nominal[k] + end * (sample[k] - nominal[k]);
                followed.keep(&mut branch.before);
                followed.set_parameters(|k, _| if end == 1.0 { sample[k] } else { between(k) });
                let is_near = matches!(followed.correct_near(branch), Advance::Near);
                if is_near {
                    now = end;
                } else {
                    followed.restore(&branch.before);
                    step *= 0.5;
                }
                is_near
            });
            if !reached {
                return Err(SimulationError::OffBranch { parameters: self.with_names(sample) });
            }
        }
        Ok(followed)
    }

    /// Whether a sample has a start on the nominal one's branch.
    pub(in crate::simulate) fn can_start_on_branch(&self, sample: &Sample) -> bool {
        self.assembly_on_branch(sample, &mut Branch::new(self)).is_ok()
    }

    /// The stop of a walk that ends short of `time + step`.
    fn stopped(&self, assembly: &Assembly, row: usize, time: f64, step: f64) -> Stop {
        let state = assembly.tile().values()[..self.start.layout.registers()].to_vec();
        let open = [time + step, time + 1e3 * step].into_iter().find_map(|time| self.open_constraint(&state, time));
        Stop { sample: 0, row, time, equation: EquationId::new(self.system.q.len()), open, singular: false }
    }
}

/// Result of a walk.
#[derive(Debug, Default)]
pub(super) struct Way {
    /// The stop, if there was one.
    pub stop: Option<Stop>,
    /// Configurations where branches met within rounding.
    pub singular: Vec<SingularPass>,
}

/// The branch of the linkage that a walk follows.
struct Branch {
    orientation: Option<Orientation>,
    /// Whether the determinant of Φ_q is negative there.
    is_negative: Option<bool>,
    /// The lane's state before a step.
    before: Vec<f64>,
}

impl Branch {
    /// Branch of the nominal start.
    fn new(simulator: &Simulator) -> Self {
        let orientation = Orientation::new(&simulator.system, &simulator.mobility.redundant);
        let mut branch = Self { orientation, is_negative: None, before: Vec::new() };
        if branch.orientation.is_some() {
            let parameters = &simulator.system.parameters;
            let mut nominal = Assembly::new(&simulator.start, &simulator.system, 1, |k, _| parameters[k].nominal);
            nominal.set_state(&simulator.nominal);
            branch.is_negative = branch.oriented(&mut nominal).map(|oriented| oriented.is_negative);
        }
        branch
    }

    /// Orientation of Φ_q; `None` if it is not known.
    fn oriented(&mut self, assembly: &mut Assembly) -> Option<Oriented> {
        self.orientation.as_mut()?.at(assembly)
    }

    fn is_on(&self, oriented: Oriented) -> bool {
        self.is_negative.is_none_or(|is_negative| is_negative == oriented.is_negative)
    }
}

/// Result of a correction.
enum Advance {
    /// Too far away, or nowhere.
    Far,
    /// Nearby.
    Near,
    /// Nearby, where the determinant of Φ_q has the other sign.
    Crossed(Oriented),
}

impl Assembly<'_> {
    /// Keeps time, positions, velocities, accelerations and multipliers of the one lane.
    fn keep(&self, state: &mut Vec<f64>) {
        let layout = &self.program().layout;
        state.clear();
        state.extend_from_slice(&self.tile().values()[layout.time..layout.lambda.end]);
    }

    fn restore(&mut self, state: &[f64]) {
        let kept = self.program().layout.time..self.program().layout.lambda.end;
        self.tile_mut().values_mut()[kept].copy_from_slice(state);
    }

    /// Moves the one lane by `step` to a time. If that leads too far, the state is restored; if the branch is another
    /// one, the state before remains in `branch`.
    fn advance_to(&mut self, time: f64, step: f64, branch: &mut Branch) -> Advance {
        let layout = &self.program().layout;
        self.keep(&mut branch.before);
        for ((q, v), w) in layout.q.clone().zip(layout.v.clone()).zip(layout.w.clone()) {
            let [speed, acceleration] = [v, w].map(|register| self.tile().lane(register)[0]);
            self.tile_mut().lane_mut(q)[0] += step * (speed + 0.5 * step * acceleration);
            self.tile_mut().lane_mut(v)[0] += step * acceleration;
        }
        self.tile_mut().lane_mut(layout.time)[0] = time;
        let advance = self.correct_near(branch);
        if matches!(advance, Advance::Far) {
            self.restore(&branch.before);
        }
        advance
    }

    /// Closes the one lane from its state, unless that leads to another branch.
    fn correct_near(&mut self, branch: &mut Branch) -> Advance {
        let layout = &self.program().layout;
        let predicted = self.tile().values()[layout.q.clone()].to_vec();
        let first = self.correct_once();
        let second = self.correct_once();
        let is_alone = first <= TUNING.negligible_correction || second <= TUNING.contracting * first;
        if !is_alone || !self.close() {
            return Advance::Far;
        }
        let moved = predicted.iter().zip(layout.q.clone()).zip(self.scale());
        let is_near = moved.into_iter().all(|((q, register), scale)| {
            // NaN is far.
            ((self.tile().lane(register)[0] - q) / scale).abs() <= TUNING.near_correction
        });
        if !is_near {
            return Advance::Far;
        }
        match branch.oriented(self) {
            Some(oriented) if !branch.is_on(oriented) => Advance::Crossed(oriented),
            Some(oriented) => {
                branch.is_negative = Some(oriented.is_negative);
                Advance::Near
            }
            None => Advance::Near,
        }
    }

    /// One correction of the one lane's positions; its size in their scales.
    fn correct_once(&mut self) -> f64 {
        let program = self.program();
        let layout = &program.layout;
        self.tile_mut().run(program.position());
        let mut size = 0.0_f64;
        for (index, register) in layout.q.clone().enumerate() {
            let change = self.tile().lane(layout.correction.start + index)[0];
            self.tile_mut().lane_mut(register)[0] += change;
            size = size.max((change / self.scale()[index]).abs());
        }
        size
    }
}
