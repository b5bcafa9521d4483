//! Accelerations and multipliers of rows of output, from the positions and velocities there.
//!
//! A step's own w₊ and λ₊ fulfil Φ(q₊) = 0 through b w₊, b ∼ h²: rounding and Newton's tolerance are in them as ε/h²,
//! and a change of h disturbs them by as much as it changes. Positions and velocities do not suffer. So where outputs
//! depend on w or λ, a row takes those that solve M w + Φ_qᵀ λ = Q and Φ̈ = 0 at its q and v. The steps go on with
//! their own.
//!
//! With controlled steps velocities are made consistent too: steps grow as long as the motion allows, and leave Φ_q v +
//! Φ_t = C h² with it, which local errors of positions do not show.

use symdiff::Tile;

use crate::compile::Layout;
use crate::simulate::simulator::Simulator;
use crate::simulate::start::Assembly;
use crate::simulate::step::Stepper;

/// Solves for the accelerations of a tile's rows.
#[derive(Debug)]
pub(super) struct RowAccelerations<'s> {
    layout: &'s Layout,
    assembly: Assembly<'s>,
    /// Whether velocities are made consistent.
    projects_velocities: bool,
    /// Whether accelerations are solved for.
    solves_accelerations: bool,
    /// v, a, w and λ of the steps.
    own: Vec<f64>,
}

impl<'s> RowAccelerations<'s> {
    /// Solver for the samples of an assembled tile; `None` if outputs do not depend on the solution, or no constraint
    /// disturbs it. `controlled` says whether steps follow a tolerance.
    pub fn new(simulator: &'s Simulator, start: &Tile, controlled: bool) -> Option<Self> {
        let projects_velocities = controlled && simulator.projects_row_velocities();
        let solves_accelerations = simulator.solves_row_accelerations();
        if !projects_velocities && !solves_accelerations {
            return None;
        }
        let parameters = simulator.start.layout.parameters.clone();
        let parameter = |parameter: usize, lane: usize| start.lane(parameters.start + parameter)[lane];
        let assembly = Assembly::new(&simulator.start, &simulator.system, start.width(), parameter);
        let layout = &simulator.start.layout;
        Some(Self { layout, assembly, projects_velocities, solves_accelerations, own: Vec::new() })
    }

    /// The outputs of the state, as [`Stepper::observe`] gives them, with these accelerations. A lane in which they are
    /// not determined, as in a singular configuration, keeps those of its step.
    pub fn observe(&mut self, stepper: &mut Stepper, into: &mut [f64]) {
        let (layout, width) = (self.layout, stepper.tile().width());
        let block = |registers: std::ops::Range<usize>| registers.start * width..registers.end * width;
        let (state, time) = (block(layout.q.start..layout.lambda.end), layout.time);
        let unknowns = layout.v.start..layout.lambda.end;
        let tile = self.assembly.tile_mut();
        tile.values_mut()[state.clone()].copy_from_slice(&stepper.tile().values()[state]);
        tile.lane_mut(time).copy_from_slice(stepper.tile().lane(time));
        self.own.clear();
        self.own.extend_from_slice(&stepper.tile().values()[block(unknowns.clone())]);
        let mut settled = vec![true; width];
        let mut also = |lanes: Vec<bool>| settled.iter_mut().zip(lanes).for_each(|(settled, lane)| *settled &= lane);
        if self.projects_velocities {
            also(self.assembly.project_velocities());
        }
        if self.solves_accelerations {
            also(self.assembly.accelerate());
        }
        for register in unknowns.clone() {
            also(self.assembly.tile().lane(register).iter().map(|value| value.is_finite()).collect());
        }
        for register in unknowns.clone() {
            let found = self.assembly.tile().lane(register);
            for lane in (0..width).filter(|&lane| settled[lane]) {
                stepper.tile_mut().lane_mut(register)[lane] = found[lane];
            }
        }
        stepper.observe(into);
        stepper.tile_mut().values_mut()[block(unknowns)].copy_from_slice(&self.own);
    }
}
