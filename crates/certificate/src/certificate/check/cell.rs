//! The proof over one cell, computed again. Symbols are those of the theory page.

use symdiff::taylor_model::{ModelSpace, up};

use super::super::flow::{Accelerations, Flow, kinematic_defect, of_first_order};
use super::super::frame::Frame;
use super::super::krawczyk::{self, Image};
use super::super::majorant::bound;
use super::super::matrix::Models;
use super::super::spaces::{Cell, Space, matrix_at, truncate};
use super::super::{Equations, ProvenCell};
use super::evaluation::{Given, State, evaluate};
use crate::numerics::larger;

/// Equations among some unknowns: rows of the list, and indices of the unknowns' derivatives.
pub(super) struct Unknowns<'u> {
    pub equations: &'u Equations,
    pub rows: &'u [usize],
    pub needed: &'u [usize],
    pub indices: Vec<usize>,
}

impl Unknowns<'_> {
    /// Values of the rows over a state, and their derivatives by the variables with these indices.
    fn linearised(&self, given: &Given, state: &State, indices: &[usize]) -> (Models, Models) {
        let space = given.space;
        let found = evaluate(self.equations, self.needed, given, state, true);
        let (mut values, mut slopes) =
            (Models::zero(space, self.rows.len(), 1), Models::zero(space, self.rows.len(), indices.len()));
        for (row, &node) in self.rows.iter().enumerate() {
            let Some(own) = &found[node] else { continue };
            values.at_mut(row, 0).copy_from_slice(&own.value);
            for (column, index) in indices.iter().enumerate() {
                if let Some(slope) = own.by.get(index) {
                    slopes.at_mut(row, column).copy_from_slice(slope);
                }
            }
        }
        (values, slopes)
    }

    /// Bounds of the rows over a state, without derivatives.
    pub fn bounds(&self, given: &Given, state: &State) -> Vec<f64> {
        let found = evaluate(self.equations, self.needed, given, state, false);
        self.rows
            .iter()
            .map(|&node| found[node].as_ref().map_or(f64::NAN, |own| given.space.bound(&own.value)))
            .collect()
    }

    /// Approximate inverse of the derivatives by the unknowns about a state without radii.
    pub fn inverse(&self, given: &Given, about: &State) -> Option<Models> {
        let matrix = self.linearised(given, about, &self.indices).1.without_radii();
        let mut inverse = matrix.inverse_at_centre(given.space)?;
        inverse.refine_inverse_of(given.space, &matrix).then(|| inverse.without_radii())
    }

    /// Gives the unknowns of a state radii within which a solution is for every ξ. `inverse` may be anything.
    pub fn enclose(&self, given: &Given, state: &mut State, inverse: &Models) -> Option<()> {
        let space = given.space;
        self.set_radii(space, state, None);
        let missed = inverse.bounds(space).times(self.linearised(given, state, &[]).0.bounds(space).entries());
        let spread = krawczyk::enclose(missed.clone(), |y| {
            self.set_radii(space, state, Some(y));
            let slopes = self.linearised(given, state, &self.indices).1;
            Image {
                missed: missed.clone(),
                contraction: inverse.times(space, &slopes).off_identity(space).bounds(space),
            }
        })?;
        self.set_radii(space, state, Some(&spread));
        Some(())
    }

    fn set_radii(&self, space: &ModelSpace, state: &mut State, radii: Option<&[f64]>) {
        let n = self.equations.coordinates;
        for (number, &index) in self.indices.iter().enumerate() {
            let (models, row) = match index / n.max(1) {
                0 => (&mut state.q, index),
                1 => (&mut state.v, index - n),
                2 => (&mut state.w, index - 2 * n),
                _ => (&mut state.lambda, index - 3 * n),
            };
            models.at_mut(row, 0)[space.size() - 1] = radii.map_or(0.0, |radii| radii[number]);
        }
    }
}

/// Shapes of polynomials, and time and parameters in them.
pub(super) struct Shapes {
    pub fine: Space,
    pub coarse: Space,
    /// Parameters as polynomials of (τ, ξ), of fine and of coarse order, and of ξ alone.
    pub parameters: [Vec<Vec<f64>>; 3],
}

impl Shapes {
    pub fn time(space: &ModelSpace, cell: Cell) -> Vec<f64> {
        let mut time = vec![0.0; space.size()];
        let coefficients = space.size() - 1;
        space.jets().variable(0, cell.middle, cell.half, &mut time[..coefficients]);
        time
    }
}

/// A cell that is proven.
pub(super) struct Passed {
    pub cell: Cell,
    /// Polynomials of the motion over the cell.
    pub state: State,
    /// Frame at the cell's start.
    frame: Frame,
    flow: Flow,
    /// Polynomials at the cell's end, and the frame there.
    pub end: (Models, Models),
    pub next: Frame,
}

/// Why a cell is not proven.
pub(super) enum Open {
    Irregular,
    Leaves { index: usize, reached: f64, tube: f64 },
    Transition,
}

impl Passed {
    /// Proves that the motion stays in the cell's tube.
    pub fn new(
        motion: &Unknowns,
        shapes: &Shapes,
        (q, v): &(Models, Models),
        frame: Frame,
        proven: &ProvenCell,
    ) -> Result<Self, Open> {
        let (fine, coarse) = (&shapes.fine, &shapes.coarse);
        let n = motion.equations.coordinates;
        let cell = Cell { middle: proven.middle, half: proven.half };
        let state = integrated(fine, cell, q, v, proven);
        // Distance of ŷ(−1) from the polynomials that it begins with.
        let begun = [matrix_at(fine, &state.q, -1.0), matrix_at(fine, &state.v, -1.0)];
        let jump: Vec<f64> = begun.iter().zip([q, v]).flat_map(|(at, start)| distances(fine, at, start)).collect();
        let entry: Vec<f64> = frame.error(&coarse.box_of).iter().zip(&jump).map(|(a, b)| up(a + b)).collect();

        let time = Shapes::time(&fine.cell, cell);
        let given = Given { space: &fine.cell, time: &time, parameters: &shapes.parameters[0] };
        let residual = motion.bounds(&given, &state);
        let kinematic = kinematic_defect(fine, cell, &state.q, &state.v, &state.w);

        let time = Shapes::time(&coarse.cell, cell);
        let given = Given { space: &coarse.cell, time: &time, parameters: &shapes.parameters[1] };
        let linear = over_tube(motion, &given, &state, &proven.tube, &residual).ok_or(Open::Irregular)?;
        let defect: Vec<f64> =
            (0..2 * n).map(|row| up(kinematic[row] + if row < n { 0.0 } else { linear.missed[row - n] })).collect();
        let sizes = of_first_order(&linear.slopes.bounds(&coarse.cell));
        let duration = 2.0 * cell.half;
        let reached = bound(&sizes, &entry, duration, &defect).unwrap_or_else(|| vec![f64::INFINITY; 2 * n]);
        // Written so that NaN is no proof.
        if let Some(index) =
            (0..2 * n).find(|&row| reached[row].partial_cmp(&proven.tube[row]) != Some(std::cmp::Ordering::Less))
        {
            return Err(Open::Leaves { index, reached: reached[index], tube: proven.tube[index] });
        }
        let flow = Flow::new(coarse, cell, &linear.slopes, &sizes, &jump, &defect).ok_or(Open::Transition)?;
        let end = (matrix_at(fine, &state.q, 1.0), matrix_at(fine, &state.v, 1.0));
        let rounded = |models: &Models| (0..n).map(|row| models.at(row, 0)[fine.box_of.size() - 1]).collect::<Vec<_>>();
        let added = [rounded(&end.0), rounded(&end.1)].concat();
        let next = frame.advance(coarse, &flow, &added).ok_or(Open::Transition)?;
        let end = (end.0.without_radii(), end.1.without_radii());
        Ok(Self { cell, state, frame, flow, end, next })
    }

    /// The motion at an instant, with radii of q and v.
    pub fn at(&self, shapes: &Shapes, tau: f64) -> State {
        let (fine, coarse) = (&shapes.fine, &shapes.coarse);
        let mut state = self.state.map(|models| matrix_at(fine, models, tau));
        state.widen(&fine.box_of, &self.frame.error_at(coarse, &self.flow, tau));
        state
    }
}

/// q̂ and v̂ as integrals of ŵ from the start of a cell.
fn integrated(space: &Space, cell: Cell, q: &Models, v: &Models, proven: &ProvenCell) -> State {
    let fill = |polynomials: &[Vec<f64>]| {
        let mut models = Models::zero(&space.cell, polynomials.len(), 1);
        for (row, own) in polynomials.iter().enumerate() {
            models.at_mut(row, 0)[..own.len()].copy_from_slice(own);
        }
        models
    };
    let kept = space.box_of.size() - 1;
    let integral = |start: &Models, of: &Models| {
        let mut models = Models::zero(&space.cell, start.rows, 1);
        (0..start.rows).for_each(|row| {
            space.integral(&start.at(row, 0)[..kept], cell.half, of.at(row, 0), models.at_mut(row, 0));
        });
        models
    };
    let (w, lambda) = (fill(&proven.w), fill(&proven.lambda));
    let v = integral(v, &w);
    State { q: integral(q, &v), v, w, lambda }
}

/// Bounds of the distances of models from polynomials, row by row.
fn distances(space: &Space, models: &Models, from: &Models) -> Vec<f64> {
    let mut left = vec![0.0; space.box_of.size()];
    let mut distance = |row: usize| {
        space.box_of.sub(models.at(row, 0), from.at(row, 0), &mut left);
        space.box_of.bound(&left)
    };
    (0..models.rows).map(&mut distance).collect()
}

/// The accelerations over a tube.
fn over_tube(motion: &Unknowns, given: &Given, fine: &State, tube: &[f64], residual: &[f64]) -> Option<Accelerations> {
    let (space, n) = (given.space, motion.equations.coordinates);
    let last = space.size() - 1;
    let cut = |models: &Models| {
        let mut cut = Models::zero(space, models.rows, 1);
        (0..models.rows).for_each(|row| truncate(models.at(row, 0), space, cut.at_mut(row, 0)));
        cut
    };
    let mut state = fine.map(cut);
    let inverse = motion.inverse(given, &state.bare())?;
    state.widen(space, tube);
    let tails = [state.w.clone(), state.lambda.clone()];
    motion.enclose(given, &mut state, &inverse)?;
    // ŵ and λ̂ themselves are to be in the enclosure, too.
    for (models, tails) in [&mut state.w, &mut state.lambda].into_iter().zip(&tails) {
        for row in 0..models.rows {
            let radius = &mut models.at_mut(row, 0)[last];
            *radius = larger(*radius, tails.at(row, 0)[last]);
        }
    }
    let indices: Vec<usize> = motion.indices.iter().copied().chain(0..2 * n).collect();
    let (values, all) = motion.linearised(given, &state, &indices);
    // Derivatives do not show where a condition jumps, but values are unknown there.
    values.bounds(space).entries().iter().all(|bound| bound.is_finite()).then_some(())?;
    let unknowns = motion.indices.len();
    let by_unknown = all.part(space, 0..unknowns, 0..unknowns);
    let by_state = all.part(space, 0..unknowns, unknowns..unknowns + 2 * n);
    Accelerations::new(space, &inverse, &by_unknown, &by_state, residual)
}
