//! Backwards over steps of the scheme.
//!
//! A step s₊ = S(s, x, ξ) with R(x; s, ξ) = 0, x = (w₊, λ₊), moves the adjoints ν₊ of its end to its beginning:
//!
//! ```text
//! Jᵀ μ = S_xᵀ ν₊,    ν = S_sᵀ ν₊ − R_sᵀ μ,    ξ̄ += S_ξᵀ ν₊ − R_ξᵀ μ
//! ```
//!
//! The tape of a Newton correction, −J⁻¹ R with the factors of the step's own solution, gives the terms with μ when it
//! is followed backwards from S_xᵀ ν₊.
//!
//! Lauß, Oberpeilsteiner, Steiner & Nachbagauer, Multibody Syst. Dyn. 42 (2018) 425.

use symdiff::{Adjoints, Tile};

use super::cells::{TileInputs, TileKernel};
use super::path::{Stepping, TilePath};
use super::start::StartAdjoints;
use crate::compile::{Program, Tapes};
use crate::simulate::sampling::{Instants, Sampling};
use crate::simulate::simulator::Simulator;
use crate::simulate::start::Assembly;
use crate::simulate::step::Stepper;

/// A tile of samples that takes the steps of a list.
#[derive(Debug)]
pub(super) struct TileSteps<'s> {
    simulator: &'s Simulator,
    stepper: Stepper<'s>,
    sampling: Option<Sampling<'s>>,
    /// Length and end of each step, s.
    steps: Vec<(f64, f64)>,
    /// The end of the first step that a lane did not take as its jet would: it did not converge, or its Newton matrix
    /// is singular.
    lost: Vec<Option<f64>>,
    /// Functions of the time that are inputs, and the solver for the accelerations at the beginnings of cells.
    inputs: Option<(&'s TileInputs, Assembly<'s>)>,
}

impl<'s> TileSteps<'s> {
    /// Steps from an assembled tile.
    pub fn new(simulator: &'s Simulator, start: &Tile, steps: Vec<(f64, f64)>, inputs: Option<&'s TileInputs>) -> Self {
        let mut stepper = Stepper::new(&simulator.program, start);
        // Rounding of accelerations is that of positions over h², and so is that of derivatives.
        stepper.refine(true);
        let lost = vec![None; start.width()];
        let parameters = simulator.start.layout.parameters.start;
        let parameter = |parameter: usize, lane: usize| start.lane(parameters + parameter)[lane];
        let assembly = || Assembly::new(&simulator.start, &simulator.system, start.width(), parameter);
        let inputs = inputs.map(|inputs| (inputs, assembly()));
        Self { simulator, stepper, sampling: Sampling::new(simulator, start), steps, lost, inputs }
    }

    /// Sets the inputs of a step. The first begins with accelerations that follow from them. Later on, forces go from
    /// the old value to the new one within a step, as the scheme has it.
    fn enter(&mut self, step: usize) {
        let Some((inputs, assembly)) = &mut self.inputs else { return };
        let layout = &self.simulator.program.layout;
        let (h, end) = self.steps[step];
        let values = inputs.values(inputs.cell(end));
        layout.set_inputs(self.stepper.tile_mut(), values);
        if step == 0 {
            let tile = assembly.tile_mut();
            layout.set_inputs(tile, values);
            tile.block_mut(layout.state()).copy_from_slice(self.stepper.tile().block(layout.state()));
            tile.lane_mut(layout.time).fill(end - h);
            assembly.accelerate();
            assembly.shift_accelerations(self.simulator.program.coefficients.shift() * h);
            self.stepper.begin_anew(assembly.tile());
        }
    }

    /// Times at which lanes were lost.
    pub fn lost(&self) -> &[Option<f64>] {
        &self.lost
    }
}

impl Stepping for TileSteps<'_> {
    fn state(&self) -> &[f64] {
        self.stepper.tile().block(self.simulator.program.layout.state())
    }

    fn restore(&mut self, step: usize, state: &[f64]) {
        self.stepper.restart(state, self.steps[step.saturating_sub(1)].0);
    }

    fn advance(&mut self, step: usize) -> Option<Vec<f64>> {
        self.enter(step);
        let (h, end) = self.steps[step];
        let converged = self.stepper.try_step(h, end);
        for (lane, converged) in converged.into_iter().enumerate() {
            let is_lost = self.stepper.alive()[lane] && (!converged || self.stepper.is_singular(lane));
            if is_lost {
                self.lost[lane] = Some(end);
                self.stepper.retire(lane..lane + 1);
            }
        }
        let instants = Instants::of(self.simulator);
        let unchanged = instants.contain(end).then(|| self.state().to_vec());
        if let Some(sampling) = &mut self.sampling {
            sampling.end(&mut self.stepper, end);
        }
        unchanged
    }
}

/// Adjoints of a row: number of steps before it, and those of its state.
pub(super) type RowSeeds<'r> = (usize, &'r [f64]);

/// Goes backwards over a path.
#[derive(Debug)]
pub(super) struct StepAdjoints<'s> {
    program: &'s Program,
    path: TilePath<TileSteps<'s>>,
    tile: Tile,
    adjoints: Adjoints,
    /// Adjoints of the start, and of instants at which states change.
    start: StartAdjoints<'s>,
    shift: f64,
    /// Adjoints of the step's solution.
    seeds: Vec<f64>,
    /// Adjoints of functions of the time.
    kernel: TileKernel,
}

impl<'s> StepAdjoints<'s> {
    /// Adjoints over the path of an assembled tile.
    pub fn new(simulator: &'s Simulator, start: &Tile, path: TilePath<TileSteps<'s>>) -> Self {
        let program = &simulator.program;
        let tile = path.stepping().stepper.tile().clone();
        let adjoints = Adjoints::new(&tile);
        let shift = program.coefficients.shift();
        let kernel = path.stepping().inputs.as_ref().map_or_else(TileKernel::default, |(inputs, _)| inputs.kernel());
        Self {
            program,
            path,
            tile,
            adjoints,
            start: StartAdjoints::new(simulator, &simulator.start, start),
            shift,
            seeds: Vec::new(),
            kernel,
        }
    }

    /// Adjoints of the functions of the time.
    pub fn kernel(&self) -> &TileKernel {
        &self.kernel
    }

    /// Pulls adjoints from the rows, the last first, to the start: returns those of the start's positions (n lines) and
    /// of the parameters (k lines).
    pub fn pull(&mut self, rows: &[RowSeeds<'_>]) -> (Vec<f64>, Vec<f64>) {
        let layout = &self.program.layout;
        let mut rows = rows.iter().peekable();
        let mut size = f64::NAN;
        for step in (0..=self.path.steps()).rev() {
            while let Some((_, seeds)) = rows.next_if(|(before, _)| *before == step) {
                let own = self.adjoints.block_mut(layout.state());
                own.iter_mut().zip(*seeds).for_each(|(own, seed)| *own += seed);
            }
            if let Some(before) = step.checked_sub(1) {
                self.pull_step(before, &mut size);
            }
        }
        self.pull_step_size(size);
        self.adjoints.pull(self.program.sample(), &mut self.tile);
        let first_step = self.path.stepping().steps.first().map_or(0.0, |&(h, _)| h);
        let seeds = self.adjoints.block(layout.state()).to_vec();
        self.start.add(layout.q.start, &seeds);
        // Samples are assembled without inputs.
        let nothing = vec![0.0; layout.inputs.len() * self.tile.width()];
        self.start.set_inputs(&nothing);
        self.start.pull_start(self.path.start(), Some(self.shift * first_step));
        let positions = self.start.take(layout.q.clone());
        let mut parameters = self.start.finish();
        parameters.iter_mut().zip(self.adjoints.block(layout.parameters.clone())).for_each(|(sum, own)| *sum += own);
        (positions, parameters)
    }

    /// Pulls adjoints to the beginning of a step. `size` is the length of the step behind it.
    fn pull_step(&mut self, step: usize, size: &mut f64) {
        let layout = &self.program.layout;
        let (h, end) = self.path.stepping().steps[step];
        let before = step.checked_sub(1).map(|before| self.path.stepping().steps[before].0);
        if h != *size {
            self.pull_step_size(*size);
            self.tile.lane_mut(layout.step).fill(h);
            self.tile.run(self.program.step_size());
            *size = h;
        }
        let inputs = self.path.stepping().inputs.as_ref().map(|(inputs, _)| *inputs);
        let cell = inputs.map_or(0, |inputs| inputs.cell(end));
        let (state, after, unchanged) = self.path.around(step);
        if let Some(inputs) = inputs {
            self.start.set_inputs(inputs.values(cell));
            layout.set_inputs(&mut self.tile, inputs.values(cell));
        }
        if let Some(unchanged) = unchanged {
            // As the path samples: new accelerations of the new states, which follow from the old state.
            let seeds = self.adjoints.block(layout.state()).to_vec();
            self.start.add(layout.q.start, &seeds);
            self.start.pull_anew(end, after, self.shift * h);
            self.start.set(end, layout.q.start, unchanged);
            self.start.pull_sampling(end);
            let pulled = self.start.take(layout.state());
            self.adjoints.block_mut(layout.state()).copy_from_slice(&pulled);
        }
        // The state that the first step begins with.
        let is_first = inputs.is_some() && step == 0;
        let anew = is_first.then(|| self.start.solve_anew(end - h, state, self.shift * h));
        let state = anew.as_deref().unwrap_or(state);
        let ratio = before.map_or(1.0, |before| h / before);
        let width = self.tile.width();
        let block = |registers: &std::ops::Range<usize>| {
            let first = layout.q.start;
            (registers.start - first) * width..(registers.end - first) * width
        };
        let values = self.tile.values_mut();
        values[layout.q.start * width..layout.lambda.start * width]
            .copy_from_slice(&state[..block(&layout.lambda).start]);
        if ratio != 1.0 {
            let algorithmic = &mut values[layout.a.start * width..layout.a.end * width];
            for (a, w) in algorithmic.iter_mut().zip(&state[block(&layout.w)]) {
                *a = w + ratio * (*a - w);
            }
        }
        let end_state = unchanged.unwrap_or(after);
        values[layout.iterate.start * width..layout.iterate.end * width].copy_from_slice(&end_state[block(&layout.w)]);
        values[layout.lambda.start * width..layout.lambda.end * width]
            .copy_from_slice(&end_state[block(&layout.lambda)]);
        self.tile.lane_mut(layout.time).fill(end);
        self.tile.run(self.program.step());
        self.tile.run(self.program.factor());
        self.adjoints.pull(self.program.advance(), &mut self.tile);
        self.seeds.clear();
        self.seeds.extend_from_slice(self.adjoints.block(layout.iterate.clone()));
        self.seeds.extend_from_slice(self.adjoints.block(layout.lambda.clone()));
        // The solution does not depend on the prediction.
        let forget = |adjoints: &mut Adjoints| {
            adjoints.block_mut(layout.iterate.clone()).fill(0.0);
            adjoints.block_mut(layout.lambda.clone()).fill(0.0);
        };
        forget(&mut self.adjoints);
        self.adjoints.block_mut(layout.correction.clone()).copy_from_slice(&self.seeds);
        self.adjoints.pull(self.program.correct(), &mut self.tile);
        forget(&mut self.adjoints);
        self.adjoints.pull(self.program.step(), &mut self.tile);
        if ratio != 1.0 {
            for (a, w) in layout.a.clone().zip(layout.w.clone()) {
                for lane in 0..width {
                    let by_a = self.adjoints.lane(a)[lane];
                    self.adjoints.lane_mut(w)[lane] += (1.0 - ratio) * by_a;
                    self.adjoints.lane_mut(a)[lane] = ratio * by_a;
                }
            }
        }
        if let Some(anew) = &anew {
            let seeds = self.adjoints.block(layout.state()).to_vec();
            self.start.add(layout.q.start, &seeds);
            self.start.pull_anew(end - h, anew, self.shift * h);
            let pulled = self.start.take(layout.state());
            self.adjoints.block_mut(layout.state()).copy_from_slice(&pulled);
        }
        if inputs.is_some() {
            self.kernel.add(cell, &self.start.take(layout.inputs.clone()));
            let own = self.adjoints.block_mut(layout.inputs.clone());
            self.kernel.add(cell, own);
            own.fill(0.0);
        }
    }

    /// Pulls adjoints through the values that depend on the length of steps, once it changes.
    fn pull_step_size(&mut self, size: f64) {
        if size.is_finite() {
            self.adjoints.pull(self.program.step_size(), &mut self.tile);
        }
    }
}
