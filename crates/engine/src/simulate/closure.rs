//! The closure: the whole motion from the independent coordinates. Positions follow from the loop closure, velocities,
//! accelerations and reactions from their linear systems, outputs from their formulas. No time integration.
//!
//! The tapes are those of the start, with the independent coordinates as given ones.

use nalgebra::DMatrix;
use symdiff::{Tile, WIDTHS};

use super::error::{SimulationError, no_factors};
use super::simulator::Simulator;
use super::start::{Assembly, allowed_residual, free_columns};
use super::tuning::TUNING;
use crate::assemble::{CoordinateId, System};
use crate::compile::{StartProgram, Tapes, compile_start};

/// The closure of a mechanism over one choice of independent coordinates.
#[derive(Clone, Debug)]
pub struct Closure<'s> {
    simulator: &'s Simulator,
    independent: Vec<usize>,
    program: StartProgram,
    /// Whether outputs depend on velocities.
    needs_velocities: bool,
    /// Whether outputs depend on accelerations or reactions.
    needs_accelerations: bool,
}

/// Points at which the closure is evaluated: values by point within each row.
#[derive(Clone, Debug, Default)]
pub struct Points {
    /// Number of points.
    pub count: usize,
    /// k rows.
    pub parameters: Vec<f64>,
    /// 2n rows, positions and velocities: prescribed for independent coordinates, initial guesses for the others.
    pub motion: Vec<f64>,
}

/// A mechanism at a point.
#[derive(Clone, Debug)]
pub struct Configuration {
    /// Whether the closure has this solution near the point's motion.
    pub is_closed: bool,
    /// n values of the coordinates.
    pub positions: Vec<f64>,
    /// Values of the outputs.
    pub outputs: Vec<f64>,
    /// The largest residual of the constraints, SI.
    pub residual: f64,
}

/// The coordinates to take as independent at a motion (its first n values).
pub fn choose_independent(simulator: &Simulator, parameters: &[f64], motion: &[f64], time: f64) -> Vec<CoordinateId> {
    let start = &simulator.start;
    let layout = &start.layout;
    let n = layout.q.len();
    let mut tile = Tile::new(1, start.registers(), start.constants());
    for (register, &value) in layout.parameters.clone().zip(parameters).chain(layout.q.clone().zip(motion)) {
        tile.lane_mut(register)[0] = value;
    }
    tile.lane_mut(layout.time)[0] = time;
    tile.run(start.sample());
    tile.run(start.jacobian());
    // Constraints of positions only: rolling bodies may be anywhere.
    let constraints = simulator.system.constraint.len();
    let mut slopes = DMatrix::zeros(constraints, n);
    for &(row, column, register) in start.jacobian_entries.iter().filter(|&&(row, ..)| row < constraints) {
        slopes[(row, column)] = tile.lane(register)[0] * simulator.program.scale[column];
    }
    let weight: Vec<f64> = simulator
        .system
        .coordinates
        .iter()
        .map(|coordinate| if coordinate.is_angle { TUNING.angles_stay } else { 1.0 })
        .collect();
    free_columns(&slopes, &weight).into_iter().map(CoordinateId::new).collect()
}

impl<'s> Closure<'s> {
    /// Compiles the closure over these coordinates.
    ///
    /// # Errors
    /// Where its equations have no finite values at the start.
    pub fn new(simulator: &'s Simulator, independent: Vec<usize>) -> Result<Self, SimulationError> {
        let mut system: System = simulator.system.clone();
        let n = system.q.len();
        let kept = |symbols: &[symdiff::Expr]| (0..n).map(|i| independent.contains(&i).then_some(symbols[i])).collect();
        system.start.position = kept(&system.q);
        system.start.velocity = kept(&system.v);
        system.start.conditions.clear();
        system.start.fulfils_velocity_constraints = true;
        let program = compile_start(&system, &simulator.mobility.redundant, &simulator.nominal)
            .map_err(|none| no_factors(&simulator.system, &none))?;
        let accelerations = system.observes_accelerations();
        let needs_velocities = accelerations || system.observes_velocities();
        Ok(Self { simulator, independent, program, needs_velocities, needs_accelerations: accelerations })
    }

    /// The independent coordinates.
    pub fn independent(&self) -> &[usize] {
        &self.independent
    }

    /// Whether outputs depend on velocities; if not, those of [`Points`] are ignored.
    pub fn needs_velocities(&self) -> bool {
        self.needs_velocities
    }

    /// Outputs at all points: output by output, point by point; NaN where the closure has no solution near the point's
    /// motion.
    pub fn outputs(&self, time: f64, points: &Points, into: &mut Vec<f64>) {
        into.clear();
        into.resize(self.program.outputs.len() * points.count, 0.0);
        self.each(time, points, |first, count, assembly| {
            let closed = self.closed(assembly);
            for (line, &register) in into.chunks_exact_mut(points.count).zip(&self.program.outputs) {
                for (lane, value) in line[first..first + count].iter_mut().enumerate() {
                    *value = if closed[lane] { assembly.tile().lane(register)[lane] } else { f64::NAN };
                }
            }
        });
    }

    /// The configurations at all points.
    pub fn configurations(&self, time: f64, points: &Points) -> Vec<Configuration> {
        let mut found = Vec::with_capacity(points.count);
        self.each(time, points, |_, count, assembly| {
            let closed = self.closed(assembly);
            let tile = assembly.tile();
            let values = |registers: &mut dyn Iterator<Item = usize>, lane: usize| -> Vec<f64> {
                registers.map(|register| tile.lane(register)[lane]).collect()
            };
            for (lane, &is_closed) in closed.iter().enumerate().take(count) {
                let gaps = values(&mut self.program.constraint.iter().map(|residual| residual.register), lane);
                found.push(Configuration {
                    is_closed,
                    positions: values(&mut self.program.layout.q.clone(), lane),
                    outputs: values(&mut self.program.outputs.iter().copied(), lane),
                    residual: gaps.into_iter().map(f64::abs).fold(0.0, f64::max),
                });
            }
        });
        found
    }

    /// Closes all points, some at once; gives each tile of them: number of its first, their count, and the assembly.
    fn each(&self, time: f64, points: &Points, mut visit: impl FnMut(usize, usize, &Assembly)) {
        let layout = &self.program.layout;
        let width = WIDTHS
            .into_iter()
            .find(|&width| width >= points.count.min(TUNING.closure_width))
            .unwrap_or(TUNING.closure_width);
        let mut assembly = Assembly::new(&self.program, &self.simulator.system, width, |_, _| 0.0);
        let mut first = 0;
        while first < points.count {
            let count = width.min(points.count - first);
            let tile = assembly.tile_mut();
            let mut set = |registers: std::ops::Range<usize>, values: &[f64]| {
                for (register, values) in registers.zip(values.chunks_exact(points.count)) {
                    for (lane, value) in tile.lane_mut(register).iter_mut().enumerate() {
                        *value = values[first + lane.min(count - 1)];
                    }
                }
            };
            set(layout.parameters.clone(), &points.parameters);
            set(layout.q.start..layout.v.end, &points.motion);
            (layout.w.start..layout.lambda.end).for_each(|register| tile.lane_mut(register).fill(0.0));
            tile.lane_mut(layout.time).fill(time);
            tile.run(self.program.sample());
            self.close(&mut assembly);
            visit(first, count, &assembly);
            first += count;
        }
    }

    fn close(&self, assembly: &mut Assembly) {
        let layout = &self.program.layout;
        assembly.correct_until_settled(self.program.position(), layout.q.start);
        if self.needs_velocities {
            assembly.correct_until_settled(self.program.velocity(), layout.v.start);
        }
        if self.needs_accelerations {
            assembly.correct_until_settled(self.program.acceleration(), layout.w.start);
        }
        assembly.tile_mut().run(self.program.position());
        assembly.tile_mut().run(self.program.observe());
    }

    fn closed(&self, assembly: &Assembly) -> Vec<bool> {
        let allowed = allowed_residual(&self.simulator.program.scale);
        let mut closed = vec![true; assembly.tile().width()];
        for residual in &self.program.constraint {
            for (closed, gap) in closed.iter_mut().zip(assembly.tile().lane(residual.register)) {
                *closed &= gap.abs() <= allowed;
            }
        }
        closed
    }
}
