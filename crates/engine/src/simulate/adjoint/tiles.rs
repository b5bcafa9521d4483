//! Gradients in lanes.

use rayon::prelude::*;
use symdiff::Tile;

use super::add;
use super::cells::{CellFunctions, TileInputs, TileKernel};
use super::formulas::derivatives_of_formulas;
use super::functional::{Functional, Wanted};
use super::path::TilePath;
use super::rows::{LaneTerm, RowAdjoints};
use super::start::StartAdjoints;
use super::steps::{StepAdjoints, TileSteps};
use super::tuning::TUNING;
use crate::assemble::System;
use crate::compile::Tapes;
use crate::model::Analysis;
use crate::numerics::Sample;
use crate::simulate::control::{Integration, Schedule};
use crate::simulate::drive::{tiles, weights};
use crate::simulate::error::SimulationError;
use crate::simulate::events::{EventAdjoints, EventSteps};
use crate::simulate::explicit::{ExplicitAdjoints, ExplicitRow, ExplicitSteps};
use crate::simulate::interruption::Interruption;
use crate::simulate::sampling::Instants;
use crate::simulate::simulator::Simulator;

/// A functional of a sample, and its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// The weighted sum, SI.
    pub value: f64,
    /// The output of each term, SI.
    pub terms: Vec<f64>,
    /// Derivatives by each parameter (k), SI. Not finite where the output has no derivative.
    pub by_parameters: Vec<f64>,
    /// Derivatives by the inputs in each cell, if functions of the time are given.
    pub by_inputs: Vec<f64>,
    /// End of the first step, s, that does not converge or is singular, if there is one: then neither is known.
    pub lost: Option<f64>,
}

/// Why there are no gradients.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoGradient {
    /// Samples cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// Configurations without steps.
    #[error("gradients are of motions, not of `analysis: {analysis}`")]
    NoMotion {
        /// Its name.
        analysis: &'static str,
    },
    /// Motions that are cut at events, under functions of the time.
    #[error("gradients by functions of the time do not pass through events")]
    Events,
}

/// Gradients of outputs of samples under a schedule, each as [jets](crate::simulate::jet_integrator) have the first
/// derivatives.
///
/// # Errors
/// If samples cannot be assembled, or there are no motions; [`SimulationError::Interrupted`] at an interruption.
pub fn gradients(
    simulator: &Simulator,
    schedule: &Schedule,
    samples: &[Sample],
    wanted: &[Wanted],
    interruption: Interruption<'_>,
) -> Result<Vec<Gradient>, NoGradient> {
    let under = Under { functions: None, backwards: true };
    let wanted: Vec<Functional> = wanted.iter().copied().map(Functional::from).collect();
    gradients_under(simulator, schedule, samples, &wanted, under, interruption)
}

/// Functions of the time that motions are under, and whether these are followed backwards.
#[derive(Clone, Copy)]
pub struct Under<'f> {
    /// Functions for each gradient, which also has derivatives by these.
    pub functions: Option<CellFunctions<'f>>,
    /// Whether derivatives are computed; else they are zero, and the outputs cost a simulation only.
    pub backwards: bool,
}

/// Gradients of functionals, under functions of the time.
///
/// # Errors
/// As for [`gradients`].
pub fn gradients_under(
    simulator: &Simulator,
    schedule: &Schedule,
    samples: &[Sample],
    wanted: &[Functional],
    Under { functions, backwards }: Under<'_>,
    interruption: Interruption<'_>,
) -> Result<Vec<Gradient>, NoGradient> {
    if simulator.system.analysis == Analysis::Dimensions {
        return Ok(of_formulas(&simulator.system, samples, wanted));
    }
    if simulator.system.analysis.visits() {
        return Err(NoGradient::NoMotion { analysis: simulator.system.analysis.name() });
    }
    let is_cut = schedule.segments().is_some();
    if is_cut && functions.is_some() {
        return Err(NoGradient::Events);
    }
    // Lanes of a tile end in rows that are near each other; between events, whose steps are each sample's own, they
    // are of one sample.
    let own = |number: usize| if is_cut { wanted[number].sample } else { 0 };
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by_key(|&number| (own(number), wanted[number].last_row()));
    let (registers, threads) = (TUNING.tiles_memories * simulator.program.registers(), rayon::current_num_threads());
    let of_group = |group: &[usize]| -> Vec<(Vec<usize>, usize)> {
        let numbers = |first: usize, count: usize, width: usize| -> Vec<usize> {
            (0..width).map(|lane| group[first + lane.min(count - 1)]).collect()
        };
        let tiles = tiles(group.len(), registers, threads).into_iter();
        tiles.map(|(first, count, width)| (numbers(first, count, width), count)).collect()
    };
    let tiles: Vec<(Vec<usize>, usize)> = order.chunk_by(|&a, &b| own(a) == own(b)).flat_map(of_group).collect();
    let parts = tiles.into_par_iter().map(|(numbers, count)| {
        if interruption.is_asked() {
            return Err(NoGradient::from(SimulationError::Interrupted));
        }
        let lanes = numbers.iter().map(|&number| &wanted[number]).collect();
        let inputs = functions.map(|functions| TileInputs::of(&functions, &numbers));
        let lost = vec![None; numbers.len()];
        let tile = TileOf { simulator, schedule, samples, lanes, lost, inputs, backwards };
        let mut of_lanes = tile.gradients()?;
        of_lanes.truncate(count);
        Ok(of_lanes)
    });
    let parts: Vec<Vec<Gradient>> = parts.collect::<Result<_, _>>()?;
    // The last tile may have more lanes than gradients.
    let mut numbered: Vec<(usize, Gradient)> = order.into_iter().zip(parts.into_iter().flatten()).collect();
    numbered.sort_by_key(|(number, _)| *number);
    Ok(numbered.into_iter().map(|(_, gradient)| gradient).collect())
}

/// Functionals of results by formulas, which need no motion.
fn of_formulas(system: &System, samples: &[Sample], wanted: &[Functional]) -> Vec<Gradient> {
    let asked = wanted.iter().flat_map(|own| own.terms.iter().map(|term| (own.sample, term.output)));
    let mut found = derivatives_of_formulas(system, samples, asked).into_iter();
    let of_functional = |own: &Functional| {
        let (mut value, mut by_parameters) = (0.0, vec![0.0; system.parameters.len()]);
        let mut terms = Vec::with_capacity(own.terms.len());
        for (term, (of_term, by)) in own.terms.iter().zip(&mut found) {
            value += term.weight * of_term;
            add(&mut by_parameters, term.weight, &by);
            terms.push(of_term);
        }
        Gradient { value, terms, by_parameters, by_inputs: Vec::new(), lost: None }
    };
    wanted.iter().map(of_functional).collect()
}

/// One gradient a lane.
struct TileOf<'a> {
    simulator: &'a Simulator,
    schedule: &'a Schedule,
    samples: &'a [Sample],
    lanes: Vec<&'a Functional>,
    lost: Vec<Option<f64>>,
    inputs: Option<TileInputs>,
    backwards: bool,
}

/// Adjoints of the parameters (k lines) and of functions of the time.
type ByAll = (Vec<f64>, TileKernel);

impl TileOf<'_> {
    /// The gradients, one a lane.
    ///
    /// # Errors
    /// Where a lane cannot be assembled.
    fn gradients(mut self) -> Result<Vec<Gradient>, NoGradient> {
        let mut values: Vec<Vec<f64>> = self.lanes.iter().map(|lane| vec![0.0; lane.terms.len()]).collect();
        // Lost lanes are noted while the functions are borrowed.
        let inputs = self.inputs.take();
        let (by_parameters, kernel) = match self.schedule.integration {
            Integration::Plain => self.of_scheme(1, &mut values, inputs.as_ref()),
            Integration::Extrapolated { levels } => self.of_scheme(levels, &mut values, inputs.as_ref()),
            Integration::Explicit | Integration::Segments | Integration::SchemeSegments { .. } => {
                self.of_explicit(&mut values, inputs.as_ref())
            }
        }?;
        let of_lane = |(lane, terms): (usize, Vec<f64>)| {
            let value = self.lanes[lane].terms.iter().zip(&terms).map(|(term, value)| term.weight * value).sum();
            let by_parameters = by_parameters.iter().skip(lane).step_by(self.lanes.len()).copied();
            let by_inputs = kernel.of_lane(lane, self.lanes.len());
            match self.lost[lane] {
                None => Gradient { value, terms, by_parameters: by_parameters.collect(), by_inputs, lost: None },
                lost => {
                    let by_parameters = by_parameters.map(|_| f64::NAN).collect();
                    let terms = vec![f64::NAN; terms.len()];
                    Gradient { value: f64::NAN, terms, by_parameters, by_inputs, lost }
                }
            }
        };
        Ok(values.into_iter().enumerate().map(of_lane).collect())
    }

    /// The tile of samples, assembled.
    fn assemble(&self, first_step: f64) -> Result<Tile, SimulationError> {
        self.simulator.assemble(self.lanes.len(), first_step, |lane| self.samples[self.lanes[lane].sample].clone())
    }

    /// The rows that are asked for, the last first.
    fn rows(&self) -> Vec<usize> {
        let mut rows: Vec<usize> = self.lanes.iter().flat_map(|lane| lane.terms.iter().map(|term| term.row)).collect();
        rows.sort_unstable();
        rows.dedup();
        rows.reverse();
        rows
    }

    /// The terms of all lanes in a row.
    fn terms(&self, row: usize) -> Vec<LaneTerm> {
        let of_lane = |(lane, functional): (usize, &&Functional)| {
            let terms: Vec<LaneTerm> = functional
                .terms
                .iter()
                .enumerate()
                .filter(|(_, term)| term.row == row)
                .map(|(index, term)| LaneTerm { lane, index, output: term.output, weight: term.weight })
                .collect();
            terms
        };
        self.lanes.iter().enumerate().flat_map(of_lane).collect()
    }

    /// Gradients by the scheme on `levels` levels.
    fn of_scheme(
        &mut self,
        levels: usize,
        values: &mut [Vec<f64>],
        inputs: Option<&TileInputs>,
    ) -> Result<ByAll, NoGradient> {
        let Self { simulator, schedule, .. } = *self;
        let (layout, rows) = (&simulator.program.layout, self.rows());
        let schedule = &*schedule.ending_at(Instants::of(simulator));
        let weights = weights(levels);
        let mut motions: Vec<Vec<f64>> = Vec::new();
        let mut runs = Vec::with_capacity(levels);
        for (level, weight) in weights.iter().enumerate() {
            let parts = 1 << level;
            let start = self.assemble(schedule.first_step() / parts as f64)?;
            let refined = schedule.refined(parts);
            let instants = Instants::of(simulator);
            let mut ends_of_rows = vec![0; rows.len()];
            let mut steps = Vec::new();
            for row in 0..=rows.first().copied().unwrap_or(0) {
                steps.extend(instants.steps_to(row, &refined));
                rows.iter()
                    .zip(&mut ends_of_rows)
                    .filter(|(known, _)| **known == row)
                    .for_each(|(_, end)| *end = steps.len());
            }
            let count = steps.len();
            motions.resize(rows.len(), vec![0.0; layout.state().len() * self.lanes.len()]);
            let mut visit = |steps: usize, state: &[f64]| {
                let at_end = motions.iter_mut().zip(&ends_of_rows).filter(|(_, end)| **end == steps);
                at_end.for_each(|(sum, _)| sum.iter_mut().zip(state).for_each(|(sum, value)| *sum += weight * value));
            };
            let path = TilePath::new(TileSteps::new(simulator, &start, steps, inputs), count, &mut visit);
            for (lost, of_level) in self.lost.iter_mut().zip(path.stepping().lost()) {
                *lost = lost.or(*of_level);
            }
            runs.push((StepAdjoints::new(simulator, &start, path), ends_of_rows, start));
        }
        let start = &runs[0].2;
        let mut observer = match levels {
            1 => RowAdjoints::of_steps(simulator, start),
            _ => RowAdjoints::closing(simulator, simulator.free_closure()?, start),
        }
        .under(inputs);
        let mut by_motions = Vec::with_capacity(rows.len());
        for (&row, motion) in rows.iter().zip(&motions) {
            by_motions.push(observer.pull(schedule.time(row), motion, &self.terms(row), values));
        }
        if !self.backwards {
            return Ok(self.nothing());
        }
        let mut total = observer.finish();
        let mut kernel = observer.kernel().clone();
        for ((mut run, ends_of_rows, start), weight) in runs.into_iter().zip(weights) {
            let seeds: Vec<Vec<f64>> =
                by_motions.iter().map(|adjoints| adjoints.iter().map(|value| weight * value).collect()).collect();
            let seeds: Vec<(usize, &[f64])> =
                ends_of_rows.iter().copied().zip(seeds.iter().map(Vec::as_slice)).collect();
            let (positions, parameters) = run.pull(&seeds);
            add(&mut total, 1.0, &parameters);
            kernel.merge(run.kernel());
            self.add_equilibrium(&start, &positions, &mut total);
        }
        Ok((total, kernel))
    }

    /// Adjoints of lanes that are not followed backwards.
    fn nothing(&self) -> ByAll {
        (vec![0.0; self.simulator.system.parameters.len() * self.lanes.len()], TileKernel::default())
    }

    /// Gradients by the explicit method.
    fn of_explicit(&mut self, values: &mut [Vec<f64>], inputs: Option<&TileInputs>) -> Result<ByAll, NoGradient> {
        let Self { simulator, schedule, .. } = *self;
        let start = self.assemble(0.0)?;
        let rows: Vec<ExplicitRow> = self
            .rows()
            .into_iter()
            .map(|row| ExplicitRow { time: schedule.time(row), terms: self.terms(row) })
            .collect();
        let last = rows.first().map_or(0.0, |row| row.time);
        let (EventSteps { ends, events }, at_events) = self.steps_to(last)?;
        let events = EventAdjoints::new(simulator, &start, events, schedule.time(schedule.rows - 1))?;
        let count = ends.len();
        let steps = ExplicitSteps::new(simulator, &start, ends, at_events, inputs)?;
        let path = TilePath::new(steps, count, &mut |_, _| {});
        let mut closing = RowAdjoints::closing(simulator, simulator.free_closure()?, &start).under(inputs);
        let mut run = ExplicitAdjoints::new(simulator, &start, path)?.through(events);
        let by_start = run.pull(&rows, &mut closing, values);
        let mut total = run.finish();
        add(&mut total, 1.0, &closing.finish());
        let mut beginning = StartAdjoints::new(simulator, &simulator.start, &start);
        let layout = &simulator.start.layout;
        beginning.add(layout.q.start, &by_start);
        beginning.pull_start(start.block(layout.state()), None);
        let positions = beginning.take(layout.q.clone());
        add(&mut total, 1.0, &beginning.finish());
        self.add_equilibrium(&start, &positions, &mut total);
        let mut kernel = run.kernel().clone();
        kernel.merge(closing.kernel());
        Ok((total, kernel))
    }

    /// The explicit method's steps to a row at a time, s, and those that end at events. Lanes are lost of which a row
    /// lies behind that up to which their sample can be followed from event to event.
    fn steps_to(&mut self, last: f64) -> Result<(EventSteps, Vec<usize>), NoGradient> {
        let Self { simulator, schedule, .. } = *self;
        let Some(segments) = schedule.segments() else {
            let schedule = schedule.ending_at(Instants::of(simulator));
            let mut ends = schedule.ends();
            let needed = ends.partition_point(|&end| end < last) + 1;
            ends.truncate(needed);
            // Instants that are the same in all samples move none of them.
            let at_events = schedule.at_events().iter().copied().filter(|&step| step < needed).collect();
            return Ok((EventSteps { ends, events: Vec::new() }, at_events));
        };
        let sample = &self.samples[self.lanes[0].sample];
        let steps = EventSteps::of(simulator, segments, sample, last, schedule.time(schedule.rows - 1))?;
        let reached = steps.ends.last().copied().unwrap_or(0.0);
        for (lane, lost) in self.lanes.iter().zip(&mut self.lost) {
            *lost = (schedule.time(lane.last_row()) > reached).then_some(reached);
        }
        let at_events = steps.events.iter().map(|(step, _)| *step).collect();
        Ok((steps, at_events))
    }

    /// Adds the adjoints of the parameters through an equilibrium with which the motion begins.
    fn add_equilibrium(&self, start: &Tile, positions: &[f64], total: &mut [f64]) {
        let Some(equilibrium) = &self.simulator.equilibrium else { return };
        let (layout, width) = (&self.simulator.start.layout, self.lanes.len());
        for lane in 0..width {
            let state: Vec<f64> = (0..layout.registers()).map(|register| start.lane(register)[lane]).collect();
            let by_positions: Vec<f64> = positions.iter().skip(lane).step_by(width).copied().collect();
            let sample = &self.samples[self.lanes[lane].sample];
            let by_parameters = equilibrium.pull(sample, &state, &by_positions);
            for (sum, adjoint) in total.iter_mut().skip(lane).step_by(width).zip(by_parameters) {
                *sum += adjoint;
            }
        }
    }
}
