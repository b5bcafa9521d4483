//! A manufactured motion: a smooth motion on the constraints, near that of the nominal parameters.
//!
//! Polynomials of low degree follow the nominal motion over a part of the run; Newton's method moves them onto the
//! constraints at Chebyshev nodes, by the shortest way; the series through these points is the motion. It fulfils the
//! constraints to rounding where it is resolved, and velocities and accelerations are its derivatives.

use nalgebra::{DMatrix, DVector};
use symdiff::Tile;

use super::NotVerified;
use super::fit::{Nominal, followed, series};
use super::tuning::TUNING;
use crate::assemble::System;
use crate::compile::{EquationsProgram, Layout, Tapes};
use crate::numerics::ChebyshevSeries;

/// A motion that fulfils the constraints, and the loads with which it fulfils the equations of motion.
#[derive(Clone, Debug)]
pub struct Manufactured {
    /// Begin in the run, s.
    pub begin: f64,
    /// End in the run, s.
    pub end: f64,
    /// Positions, n; constant for states, whose positions stand in no equation.
    pub positions: Vec<ChebyshevSeries>,
    /// Velocities, n, and values of states.
    pub velocities: Vec<ChebyshevSeries>,
    /// Accelerations, n.
    pub accelerations: Vec<ChebyshevSeries>,
    /// Multipliers, m; zero of redundant constraints.
    pub multipliers: Vec<ChebyshevSeries>,
    /// M w + Φ_qᵀ λ − Q, n.
    pub loads: Vec<ChebyshevSeries>,
    /// Ψ(q, v, t) of the velocity constraints.
    pub slips: Vec<ChebyshevSeries>,
    /// Polynomials for q, v and λ near which it is.
    fit: Vec<ChebyshevSeries>,
}

/// The equations at one point.
pub struct EquationsAtPoint<'s> {
    system: &'s System,
    program: EquationsProgram,
    tile: Tile,
    /// Numbers of the constraints that follow from others, and of the independent ones.
    redundant: Vec<usize>,
    kept: Vec<usize>,
}

impl<'s> EquationsAtPoint<'s> {
    /// Equations of a system with these parameters, of whose constraints those by the numbers `redundant` follow from
    /// others.
    pub fn new(system: &'s System, program: EquationsProgram, parameters: &[f64], redundant: Vec<usize>) -> Self {
        let mut tile = Tile::new(1, program.registers(), program.constants());
        for (register, &value) in program.layout.parameters.clone().zip(parameters) {
            tile.lane_mut(register)[0] = value;
        }
        tile.run(program.sample());
        let kept = (0..system.constraint.len()).filter(|constraint| !redundant.contains(constraint)).collect();
        Self { system, program, tile, redundant, kept }
    }

    /// The system whose equations they are.
    pub fn system(&self) -> &'s System {
        self.system
    }

    /// Numbers of the constraints that follow from others.
    pub fn redundant(&self) -> &[usize] {
        &self.redundant
    }

    /// Its tapes.
    pub fn program(&self) -> &EquationsProgram {
        &self.program
    }

    /// Values of the layout's registers on the motion.
    pub fn registers(&mut self, motion: &Manufactured, time: f64) -> Vec<f64> {
        self.follow(motion, time);
        (0..self.layout().registers()).map(|register| self.value(register)).collect()
    }

    fn layout(&self) -> &Layout {
        &self.program.layout
    }

    fn set(&mut self, registers: std::ops::Range<usize>, values: impl IntoIterator<Item = f64>) {
        for (register, value) in registers.zip(values) {
            self.tile.lane_mut(register)[0] = value;
        }
    }

    fn value(&self, register: usize) -> f64 {
        self.tile.lane(register)[0]
    }

    /// Φ(q, t).
    fn gaps(&mut self, time: f64, q: &[f64]) -> DVector<f64> {
        let layout = self.layout().clone();
        self.set(layout.q, q.iter().copied());
        self.set(layout.time..layout.time + 1, [time]);
        self.tile.run(self.program.residual());
        let gap = |&constraint: &usize| self.value(self.program.constraint[constraint]);
        DVector::from_iterator(self.kept.len(), self.kept.iter().map(gap))
    }

    /// Moves positions onto the constraints; `None` if Newton's method does not get there.
    fn closed(&mut self, time: f64, q: &mut [f64]) -> Option<()> {
        if self.kept.is_empty() {
            return Some(());
        }
        let least = TUNING.closed_constraint
            * self.system.coordinates.iter().map(|coordinate| coordinate.scale).fold(0.0, f64::max);
        let mut before = f64::INFINITY;
        for _ in 0..TUNING.corrections {
            let gaps = self.gaps(time, q);
            let gap = gaps.amax();
            // Corrections that change nothing more are at rounding.
            if gap == 0.0 || (gap < least && gap >= 0.5 * before) {
                return Some(());
            }
            before = gap;
            let moved = self.shortest(&gaps)?;
            for (coordinate, q) in q.iter_mut().enumerate() {
                *q -= moved[coordinate];
            }
        }
        (before < least).then_some(())
    }

    /// The shortest change of positions by which the constraints change so much, to first order; `None` if the
    /// position is singular.
    fn shortest(&mut self, gaps: &DVector<f64>) -> Option<DVector<f64>> {
        let coordinates = &self.system.coordinates;
        self.tile.run(self.program.jacobian());
        let mut slopes = DMatrix::zeros(self.kept.len(), coordinates.len());
        for &(row, column, register) in &self.program.constraint_by_position {
            if let Ok(row) = self.kept.binary_search(&row) {
                slopes[(row, column)] = self.value(register) * coordinates[column].scale;
            }
        }
        let mut moved = slopes.transpose() * (&slopes * slopes.transpose()).cholesky()?.solve(gaps);
        moved.iter_mut().zip(coordinates).for_each(|(moved, coordinate)| *moved *= coordinate.scale);
        Some(moved)
    }

    /// Velocities or accelerations with which Φ̇ (`order` 0) or Φ̈ (1) is zero, nearest to those given.
    fn consistent(&mut self, order: usize, values: &mut [f64]) -> Option<()> {
        let layout = self.layout();
        let registers = if order == 0 { layout.v.clone() } else { layout.w.clone() };
        self.set(registers.clone(), values.iter().copied());
        if self.kept.is_empty() {
            return Some(());
        }
        self.tile.run(self.program.rates());
        let rates = &self.program.constraint_rates[order];
        let gaps = DVector::from_iterator(self.kept.len(), self.kept.iter().map(|&own| self.value(rates[own])));
        let moved = self.shortest(&gaps)?;
        values.iter_mut().zip(moved.iter()).for_each(|(value, moved)| *value -= moved);
        self.set(registers, values.iter().copied());
        Some(())
    }

    /// Flags of conditions that are positive in a row of the nominal motion.
    pub fn conditions(&mut self, nominal: &Nominal, row: usize) -> Vec<bool> {
        let (layout, state) = (self.layout().clone(), &nominal.states[row]);
        let n = layout.q.len();
        self.set(layout.time..layout.time + 1, [nominal.times[row]]);
        self.set(layout.q, state[..n].iter().copied());
        self.set(layout.v, state[n..2 * n].iter().copied());
        self.set(layout.lambda, state[2 * n..].iter().copied());
        for tape in [self.program.residual(), self.program.rates(), self.program.closure(), self.program.conditions()] {
            self.tile.run(tape);
        }
        self.program.conditions.iter().map(|&register| self.value(register) > 0.0).collect()
    }

    /// Sets all symbols to their values on the motion.
    fn follow(&mut self, motion: &Manufactured, time: f64) {
        let layout = self.layout().clone();
        let at = |series: &[ChebyshevSeries]| series.iter().map(|own| own.at(time)).collect::<Vec<f64>>();
        self.set(layout.time..layout.time + 1, [time]);
        self.set(layout.q, at(&motion.positions));
        self.set(layout.v, at(&motion.velocities));
        self.set(layout.w, at(&motion.accelerations));
        self.set(layout.lambda, at(&motion.multipliers));
        self.tile.run(self.program.residual());
    }

    /// The system's outputs on the motion.
    pub fn outputs(&mut self, motion: &Manufactured, time: f64) -> Vec<f64> {
        self.follow(motion, time);
        for tape in [self.program.rates(), self.program.jacobian(), self.program.observe()] {
            self.tile.run(tape);
        }
        self.program.outputs.iter().map(|&register| self.value(register)).collect()
    }

    /// Residuals of the equations of motion (n), then of the velocity constraints.
    fn residuals(&mut self, motion: &Manufactured, time: f64) -> Vec<f64> {
        self.follow(motion, time);
        self.tile.run(self.program.rates());
        let slips = &self.program.constraint_rates[0][self.system.constraint.len()..];
        self.program.motion.iter().chain(slips).map(|&register| self.value(register)).collect()
    }
}

impl Manufactured {
    /// Near a part of a nominal motion, over as much of it from `begin` on as polynomials follow, by at most `halvings`
    /// halvings.
    ///
    /// # Errors
    /// If no part of it has a smooth motion on the constraints, or its equations are not smooth along it.
    pub fn near(
        nominal: &Nominal,
        equations: &mut EquationsAtPoint,
        [begin, whole]: [f64; 2],
        halvings: usize,
    ) -> Result<Self, NotVerified> {
        let mut why = NotVerified::NoMotion;
        for swing in TUNING.swings {
            for halving in 0..=halvings {
                let span = [begin, begin + (whole - begin) * 0.5_f64.powi(halving as i32)];
                let near = (halving < TUNING.halvings_of_motion / 2).then_some(TUNING.near_nominal);
                let Some(fit) = followed(nominal, span, equations.system, swing, near) else { continue };
                match Self::of_fit(fit, span, equations) {
                    Ok(motion) => return Ok(motion),
                    Err(reason) => why = reason,
                }
            }
        }
        Err(why)
    }

    /// A motion near the same polynomials over the first part of the time; `None` if there is none.
    pub fn shortened(&self, share: f64, equations: &mut EquationsAtPoint) -> Option<Self> {
        Self::of_fit(self.fit.clone(), [self.begin, self.begin + share * self.length()], equations).ok()
    }

    /// s
    pub fn length(&self) -> f64 {
        self.end - self.begin
    }

    /// A motion from polynomials for q, v and λ.
    fn of_fit(
        fit: Vec<ChebyshevSeries>,
        span: [f64; 2],
        equations: &mut EquationsAtPoint,
    ) -> Result<Self, NotVerified> {
        let n = equations.system.q.len();
        let [begin, end] = span;
        let coordinates = &equations.system.coordinates;
        // The groups of the motion, of states, and of slips behind them.
        let group = |index: usize| coordinates.get(index).map_or(2, |coordinate| usize::from(coordinate.is_state));
        let times = ChebyshevSeries::nodes(span, TUNING.nodes);
        let mut values = Vec::with_capacity(times.len());
        for &time in &times {
            let mut q: Vec<f64> = fit[..n].iter().map(|own| own.at(time)).collect();
            equations.closed(time, &mut q).ok_or(NotVerified::NotClosed { time })?;
            values.push(q);
        }
        let mut positions =
            series(span, &values, TUNING.resolved_series, group).ok_or(NotVerified::NotSmooth { end })?;
        let mut velocities: Vec<ChebyshevSeries> = positions.iter().map(ChebyshevSeries::derivative).collect();
        for (index, coordinate) in equations.system.coordinates.iter().enumerate() {
            if coordinate.is_state {
                positions[index] = ChebyshevSeries::through(span, &[0.0, 0.0]);
                velocities[index] = fit[n + index].clone();
            }
        }
        let mut accelerations: Vec<ChebyshevSeries> = velocities.iter().map(ChebyshevSeries::derivative).collect();
        // Derivatives amplify rounding; the constraints' own rates remove it.
        let (mut rates, mut changes) = (Vec::new(), Vec::new());
        for &time in &times {
            let at = |series: &[ChebyshevSeries]| series.iter().map(|own| own.at(time)).collect::<Vec<f64>>();
            let (mut v, mut w) = (at(&velocities), at(&accelerations));
            equations.gaps(time, &at(&positions));
            let consistent = equations.consistent(0, &mut v).and_then(|()| equations.consistent(1, &mut w));
            consistent.ok_or(NotVerified::NotClosed { time })?;
            rates.push(v);
            changes.push(w);
        }
        velocities = series(span, &rates, TUNING.resolved_series, group).ok_or(NotVerified::NotSmooth { end })?;
        accelerations = series(span, &changes, TUNING.loads_resolved, group).unwrap_or(accelerations);
        let multipliers = fit[2 * n..].to_vec();
        let mut motion =
            Self { begin, end, positions, velocities, accelerations, multipliers, loads: vec![], slips: vec![], fit };
        for nodes in TUNING.nodes_of_loads {
            let times = ChebyshevSeries::nodes(span, nodes);
            let values: Vec<Vec<f64>> = times.iter().map(|&time| equations.residuals(&motion, time)).collect();
            if values.iter().flatten().any(|value| !value.is_finite()) {
                return Err(NotVerified::NotFinite { end });
            }
            if let Some(mut all) = series(span, &values, TUNING.loads_resolved, group) {
                motion.slips = all.split_off(n);
                motion.loads = all;
                return Ok(motion);
            }
        }
        Err(NotVerified::Kink { end })
    }
}
