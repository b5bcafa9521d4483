//! Positions, velocities and accelerations that follow from motors: Φ(q, t) = 0, Φ̇ = 0 and Φ̈ = 0 in every row.
//!
//! Each row begins where q + h v + h²/2 w of the row before leads. Where the correction from there is long, so that it might end on
//! another branch of the linkage, the way is halved.

use super::Visit;
use crate::assemble::EquationId;
use crate::numerics::Sample;
use crate::simulate::control::Schedule;
use crate::simulate::ensemble::{Channel, Reduction, Stop};
use crate::simulate::error::{SimulationError, assembly_error};
use crate::simulate::simulator::Simulator;
use crate::simulate::start::Assembly;

/// Corrections of a coordinate, in its scale, that do not leave the branch.
const NEAR: f64 = 0.05;

/// Times that the way to a row is halved at most.
const MOST_HALVINGS: u32 = 16;

impl Simulator {
    /// Every row; where outputs are reduced to one number, every step between rows too.
    pub(super) fn visit_kinematics(
        &self,
        sample: &Sample,
        schedule: &Schedule,
        channels: &[Channel],
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
        let mut reduction = Reduction::new(channels, self.start.outputs.len(), 1);
        let mut place = 0;
        let stop = self.walk(sample, &times, &mut |assembly| {
            let outputs = self.start.outputs.iter().map(|&register| assembly.tile().lane(register)[0]);
            if !channels.is_empty() {
                let mut values = reduction.buffer();
                values.iter_mut().zip(outputs.clone()).for_each(|(value, output)| *value = output);
                reduction.push(times[place], values, &[true]);
            }
            if rows.binary_search(&place).is_ok() {
                visit.values.extend(outputs);
            }
            place += 1;
        })?;
        visit.reduced = reduction.finish();
        visit.stop = stop.map(|stop| {
            visit.reduced.fill(f64::NAN);
            Stop { row: rows.partition_point(|&row| row < stop.row), ..stop }
        });
        Ok(visit)
    }

    /// Tells of every row, in which the outputs are observed. Returns where it stopped, if it did.
    pub(super) fn walk(
        &self,
        sample: &Sample,
        times: &[f64],
        row: &mut dyn FnMut(&Assembly),
    ) -> Result<Option<Stop>, SimulationError> {
        let (mut assembly, open) = self.assembly(std::slice::from_ref(sample));
        if let Some(worst) = open.first() {
            return Err(assembly_error(&self.system, worst, sample));
        }
        let mut now = 0.0;
        for (place, &time) in times.iter().enumerate() {
            while now < time {
                let mut step = time - now;
                let reached = (0..MOST_HALVINGS).any(|_| {
                    let end = if step == time - now { time } else { now + step };
                    let advanced = assembly.advance_to(end, step, NEAR);
                    if advanced {
                        now = end;
                    } else {
                        step *= 0.5;
                    }
                    advanced
                });
                if !reached {
                    return Ok(Some(self.stopped(&assembly, place, now, step)));
                }
            }
            assembly.observe();
            row(&assembly);
        }
        Ok(None)
    }

    /// Of a walk that stops short of `time + step`.
    fn stopped(&self, assembly: &Assembly, row: usize, time: f64, step: f64) -> Stop {
        let state = assembly.tile().values()[..self.start.layout.registers()].to_vec();
        let open = [time + step, time + 1e3 * step].into_iter().find_map(|time| self.open_constraint(&state, time));
        Stop { sample: 0, row, time, equation: EquationId::new(self.system.q.len()), open, singular: false }
    }
}

impl Assembly<'_> {
    /// Moves the one lane by `step` to a time. Where that takes corrections of more than `near`, in the coordinates' scales, or where
    /// constraints cannot hold, it stays. Returns whether it moved.
    fn advance_to(&mut self, time: f64, step: f64, near: f64) -> bool {
        let layout = self.program().layout.clone();
        let before = self.tile().values()[layout.time..layout.lambda.end].to_vec();
        for ((q, v), w) in layout.q.clone().zip(layout.v.clone()).zip(layout.w.clone()) {
            let [speed, acceleration] = [v, w].map(|register| self.tile().lane(register)[0]);
            self.tile_mut().lane_mut(q)[0] += step * (speed + 0.5 * step * acceleration);
            self.tile_mut().lane_mut(v)[0] += step * acceleration;
        }
        self.tile_mut().lane_mut(layout.time)[0] = time;
        let predicted = self.tile().values()[layout.q.clone()].to_vec();
        let closed = self.close();
        let moved = predicted.iter().zip(layout.q.clone()).zip(self.scale());
        let is_near = moved.into_iter().all(|((q, register), scale)| {
            // NaN is far.
            ((self.tile().lane(register)[0] - q) / scale).abs() <= near
        });
        if closed && is_near {
            return true;
        }
        self.tile_mut().values_mut()[layout.time..layout.lambda.end].copy_from_slice(&before);
        false
    }
}
