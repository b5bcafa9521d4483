//! The true motion, enclosed: the differential equation's solution for every parameter of a box.
//!
//! The equations of motion with Φ̈ = 0 determine w = f(t, q, v, ξ) wherever [M Φ_qᵀ; Φ_q 0] is regular, and a motion
//! that starts on the constraints stays on them: one formulation serves open and closed mechanisms. Over a cell of time
//! ([`Cell`])
//!
//! 1. polynomials ŷ(τ, ξ) of q, v, w and λ come from Picard's iteration ([`approximation`]); none of them is trusted;
//! 2. their defect in q̇ = v, v̇ = w and in the equations is bounded in Taylor models of (τ, ξ) ([`proof`]);
//! 3. ∂f/∂y is enclosed over a tube about ŷ, in which |e|' ≤ |A| |e| + defect has to keep e = y − ŷ;
//! 4. Φ̂(τ, ξ), polynomials of low order, approximates the transition matrix; |Φ − Φ̂| is bounded in the same way;
//! 5. e = B(ξ) z goes from cell to cell with B ← Φ̂ B, so that z does not change but by errors ([`Frame`]).
//!
//! Cells are halved until they can be proven, and doubled again where the defect is at rounding.

mod approximation;
mod cells;
mod proof;
pub(crate) mod tuning;

use symdiff::taylor_model::{ModelSpace, up};
use symdiff::{Interval, JetMemory, ModelMemory};

use super::{Certifier, EnclosureError, start};
use crate::certificate::frame::Frame;
use crate::certificate::matrix::{Bounds, Models};
use crate::certificate::spaces::{Cell, Space};
use crate::certificate::{Piece, ProvenCell};
use crate::compile::{EquationsProgram, Tapes};
use approximation::Approximation;
use cells::{Next, Passed};
use proof::{Claim, inverse_about};
use tuning::TUNING;

/// Shapes of the polynomials of a motion's enclosure.
#[derive(Clone, Debug)]
pub struct MotionSpaces {
    fine: Space,
    coarse: Space,
}

impl MotionSpaces {
    /// Spaces for `parameters` parameters.
    pub fn new(parameters: usize, order: usize) -> Self {
        Self { fine: Space::new(parameters, order), coarse: Space::new(parameters, order.div_ceil(2)) }
    }

    /// Outputs' models: of the parameters.
    pub fn outputs(&self) -> &ModelSpace {
        &self.fine.box_of
    }
}

/// The true motion over a box, cell by cell.
#[derive(Debug)]
pub struct MotionEnclosure<'s> {
    program: &'s EquationsProgram,
    spaces: &'s MotionSpaces,
    solves_accelerations: bool,
    /// Scales of the coordinates, n.
    scales: Vec<f64>,
    fine: ModelMemory<'s>,
    coarse: ModelMemory<'s>,
    jets: JetMemory<'s>,
    /// Memory over ξ, at rows.
    rows: ModelMemory<'s>,
    /// Approximation at the start of the next cell.
    start: Approximation,
    frame: Frame,
    /// Start of the next cell, s.
    time: f64,
    half: f64,
    /// Whether the last terms in τ of the accelerations over the cell that was tried last were large.
    is_stiff: bool,
    last: Option<Passed>,
    /// Range of each output since the time before the one that was observed last.
    since: Vec<Interval>,
    /// The proof so far.
    piece: Piece,
}

impl<'s> MotionEnclosure<'s> {
    /// Encloses the start over the box from `lower` to `upper`.
    ///
    /// # Errors
    /// Where the start cannot be proven to exist.
    pub fn start(
        certifier: &'s Certifier<'s>,
        spaces: &'s MotionSpaces,
        lower: &[f64],
        upper: &[f64],
    ) -> Result<Self, EnclosureError> {
        let (simulator, program) = (certifier.simulator, &certifier.program);
        let memory = |space: &'s ModelSpace, first: usize| {
            let mut memory = ModelMemory::new(space, program.registers(), program.constants());
            for (index, register) in program.layout.parameters.clone().enumerate() {
                space.variable(first + index, lower[index], upper[index], memory.model_mut(register));
            }
            memory.run(program.sample());
            memory
        };
        let MotionSpaces { fine, coarse } = spaces;
        let mut rows = memory(&fine.box_of, 0);
        let of_cell = memory(&fine.cell, 1);
        let mut jets = JetMemory::new(fine.cell.jets(), program.registers(), program.constants());
        for register in program.layout.parameters.clone() {
            let model = of_cell.model(register);
            jets.jet_mut(register).copy_from_slice(&model[..model.len() - 1]);
        }
        jets.run(program.sample());
        start::assemble(simulator, program, &fine.box_of, &mut rows, 0.0)?;
        let block = |registers: &std::ops::Range<usize>| {
            let mut models = Models::zero(&fine.box_of, registers.len(), 1);
            registers
                .clone()
                .enumerate()
                .for_each(|(row, register)| models.at_mut(row, 0).copy_from_slice(rows.model(register)));
            models
        };
        let layout = &program.layout;
        let start = Approximation {
            q: block(&layout.q),
            v: block(&layout.v),
            w: block(&layout.w),
            lambda: block(&layout.lambda),
        };
        let radii =
            layout.q.clone().chain(layout.v.clone()).map(|register| rows.model(register)[fine.box_of.size() - 1]);
        let frame = Frame::new(&coarse.box_of, radii.collect());
        let piece = Piece {
            lower: lower.to_vec(),
            upper: upper.to_vec(),
            q: polynomials(&start.q),
            v: polynomials(&start.v),
            cells: Vec::new(),
        };
        Ok(Self {
            program,
            spaces,
            solves_accelerations: simulator.solves_row_accelerations(),
            scales: simulator.system.coordinates.iter().map(|coordinate| coordinate.scale).collect(),
            fine: of_cell,
            coarse: memory(&coarse.cell, 1),
            jets,
            rows,
            start,
            frame,
            time: 0.0,
            half: TUNING.first_half,
            is_stiff: false,
            last: None,
            since: Vec::new(),
            piece,
        })
    }

    /// Outputs over the box at a time that is not before the last one, a model each.
    ///
    /// # Errors
    /// Where the motion cannot be proven, with the time up to which it is.
    pub fn observe(&mut self, time: f64, into: &mut Vec<f64>) -> Result<(), (f64, EnclosureError)> {
        self.since.clear();
        self.since.extend(self.last.iter().flat_map(|last| &last.ranges));
        while self.last.as_ref().is_none_or(|last| last.cell.end() < time) {
            self.pass().map_err(|why| (self.time, why))?;
            let ranges = self.last.iter().flat_map(|last| &last.ranges);
            if self.since.is_empty() {
                self.since.extend(ranges);
            } else {
                self.since.iter_mut().zip(ranges).for_each(|(since, &range)| *since = since.hull(range));
            }
        }
        let Some(Passed { cell, approximation, proven, frame, .. }) = &self.last else { return Ok(()) };
        let Space { box_of, .. } = &self.spaces.fine;
        let tau = ((time - cell.middle) / cell.half).clamp(-1.0, 1.0);
        let errors = frame.error_at(&self.spaces.coarse, &proven.flow, tau);
        let rows = &mut self.rows;
        let at = approximation.at(&self.spaces.fine, tau);
        at.put(self.program, |register, model| rows.model_mut(register).copy_from_slice(model));
        let layout = &self.program.layout;
        for (register, error) in layout.q.clone().chain(layout.v.clone()).zip(errors) {
            let radius = &mut rows.model_mut(register)[box_of.size() - 1];
            *radius = up(*radius + error);
        }
        box_of.constant(Interval::point(time), rows.model_mut(layout.time));
        if self.solves_accelerations {
            start::accelerations(self.program).solve(box_of, rows).map_err(|why| (time, why))?;
        }
        rows.run(self.program.observe());
        into.clear();
        self.program.outputs.iter().for_each(|&register| into.extend_from_slice(rows.model(register)));
        Ok(())
    }

    /// The parameter to which the last terms of the velocities belong most, after the last cell; `None` without any.
    pub fn widest(&self) -> Option<usize> {
        let v = &self.last.as_ref()?.approximation.v;
        let fine = &self.spaces.fine;
        let share = |axis: usize| -> f64 { (0..v.rows).map(|row| fine.last_of_parameter(v.at(row, 0), axis)).sum() };
        let axes = (0..fine.box_of.jets().monomials().variables()).map(|axis| (axis, share(axis)));
        axes.filter(|(_, share)| *share > 0.0).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(axis, _)| axis)
    }

    /// The proof so far, for a certificate.
    pub fn into_piece(self) -> Piece {
        self.piece
    }

    /// Range of each output over all times from the one observed before to the last one.
    pub fn since(&self) -> &[Interval] {
        &self.since
    }

    /// Proves the next cell, as long as can be.
    fn pass(&mut self) -> Result<(), EnclosureError> {
        let mut best: Option<Next> = None;
        loop {
            let cell = Cell { middle: self.time + self.half, half: self.half };
            let attempt = self.attempt(cell);
            let [shortest, of_stiff] = TUNING.shortest_halves;
            let can_halve = self.half > if self.is_stiff { of_stiff } else { shortest };
            let may_help = match (attempt, &best) {
                (Ok(next), Some(before)) if !next.is_better_than(before) => before.passes_knot,
                (Ok(next), _) => {
                    let is_long = next.is_long();
                    best = Some(next);
                    is_long
                }
                (Err(EnclosureError::Unproven), _) if can_halve => true,
                (Err(why), None) => return Err(why),
                (Err(_), Some(_)) => false,
            };
            match best.take() {
                Some(next) if !(can_halve && may_help) => {
                    self.accept(next);
                    return Ok(());
                }
                other => best = other,
            }
            self.half *= 0.5;
        }
    }

    /// An approximation over a cell, and its proof.
    fn attempt(&mut self, cell: Cell) -> Result<Next, EnclosureError> {
        let MotionSpaces { fine, coarse } = self.spaces;
        let time = self.program.layout.time;
        fine.cell.jets().variable(0, cell.middle, cell.half, self.jets.jet_mut(time));
        for (space, memory) in [(fine, &mut self.fine), (coarse, &mut self.coarse)] {
            let model = memory.model_mut(time);
            model.fill(0.0);
            let coefficients = space.cell.size() - 1;
            space.cell.jets().variable(0, cell.middle, cell.half, &mut model[..coefficients]);
        }
        let before = self.last.as_ref().map(|last| (last.cell, &last.approximation));
        let mut approximation = Approximation::first(fine, &self.start, cell, before);
        let inverse = inverse_about(self.program, &coarse.cell, &mut self.coarse, &approximation)?;
        let mut lifted = Models::zero(&fine.cell, inverse.rows, inverse.columns);
        let kept = coarse.cell.size() - 1;
        for row in 0..inverse.rows {
            for column in 0..inverse.columns {
                lifted.at_mut(row, column)[..kept].copy_from_slice(&inverse.at(row, column)[..kept]);
            }
        }
        approximation.iterate(fine, self.program, &mut self.jets, &lifted, &self.start, cell)?;
        let size = |models: &Models| (0..models.rows).map(|row| fine.cell.bound(models.at(row, 0))).fold(0.0, f64::max);
        let n = approximation.q.rows;
        let tail = (0..n).map(|row| fine.last_in_parameters(approximation.v.at(row, 0))).fold(0.0, f64::max);
        if tail > TUNING.large_tail * size(&approximation.v) {
            return Err(EnclosureError::TooWide);
        }
        let terms = |of_power: f64| {
            let rows = (0..n).map(|row| fine.last_in_time(approximation.w.at(row, 0), of_power));
            rows.fold(0.0, f64::max) / (size(&approximation.w) + f64::MIN_POSITIVE)
        };
        let tails = [1.0, 0.5, 2.0].map(terms);
        self.is_stiff = tails[0] > TUNING.stiff_tail;
        let jump = self.jump(&approximation);
        let at_start = self.frame.error(&coarse.box_of);
        let claim = Claim {
            program: self.program,
            fine,
            coarse,
            cell,
            approximation: &approximation,
            inverse: &inverse,
            at_start: &at_start,
            jump: &jump,
        };
        let slopes: Option<&Bounds> = self.last.as_ref().map(|last| &last.proven.slopes);
        let proven = claim.prove(&mut self.fine, &mut self.coarse, slopes)?;
        // The memory has the tube, and all accelerations and multipliers in it.
        self.coarse.run(self.program.observe());
        let outputs = self.program.outputs.iter();
        let outputs = outputs.flat_map(|&register| self.coarse.model(register)).copied().collect();
        let end = approximation.at(fine, 1.0);
        let frame = self.frame.advance(coarse, &proven.flow, &radii(fine, &end)).ok_or(EnclosureError::Unproven)?;
        let errors = frame.error(&coarse.box_of);
        let defect =
            proven.defect[n..].iter().copied().fold(0.0, f64::max) / (size(&approximation.w) + f64::MIN_POSITIVE);
        let passes_knot = self.program.has_knots && defect > TUNING.harmful_defect;
        if !self.scales.iter().zip(errors).all(|(scale, error)| error <= TUNING.large_remainder * scale) {
            return Err(if passes_knot { EnclosureError::Unproven } else { EnclosureError::TooWide });
        }
        let gain = frame.gain();
        Ok(Next { cell, approximation, proven, end, frame, outputs, defect, passes_knot, tails, gain })
    }

    /// Goes on to the end of a cell.
    fn accept(&mut self, next: Next) {
        let is_easy = next.may_be_doubled();
        let Next { cell, approximation, proven, end, frame, outputs, .. } = next;
        let coarse = &self.spaces.coarse;
        let ranges = outputs.chunks_exact(coarse.cell.size()).map(|model| coarse.range(model)).collect();
        let frame = std::mem::replace(&mut self.frame, frame);
        self.start = end;
        self.time = cell.end();
        // Cells begin at multiples of their length.
        self.half = cell.half;
        let doubled = 2.0 * self.half;
        if is_easy && doubled <= TUNING.longest_half && (self.time / (2.0 * doubled)).fract() == 0.0 {
            self.half = doubled;
        }
        self.piece.cells.push(ProvenCell {
            middle: cell.middle,
            half: cell.half,
            w: rounded(polynomials(&approximation.w)),
            lambda: rounded(polynomials(&approximation.lambda)),
            tube: proven.tube.clone(),
        });
        self.last = Some(Passed { cell, approximation, proven, frame, ranges });
    }

    /// Bound of the distance of ŷ(−1) from the polynomials at the cell's start, 2n.
    fn jump(&self, approximation: &Approximation) -> Vec<f64> {
        let fine = &self.spaces.fine;
        let size = fine.box_of.size();
        let (mut at, mut left, mut exact) = (vec![0.0; size], vec![0.0; size], vec![0.0; size]);
        let mut jump = Vec::with_capacity(2 * approximation.q.rows);
        for (models, start) in [(&approximation.q, &self.start.q), (&approximation.v, &self.start.v)] {
            for row in 0..models.rows {
                fine.at(models.at(row, 0), -1.0, &mut at);
                exact[..size - 1].copy_from_slice(&start.at(row, 0)[..size - 1]);
                fine.box_of.sub(&at, &exact, &mut left);
                jump.push(fine.box_of.bound(&left));
            }
        }
        jump
    }
}

/// The polynomials of a column.
fn polynomials(of: &Models) -> Vec<Vec<f64>> {
    let polynomial = |row: usize| of.at(row, 0).split_last().map_or_else(Vec::new, |(_, own)| own.to_vec());
    (0..of.rows).map(polynomial).collect()
}

/// The same to a share of 2⁻⁵⁸ of their sizes: small coefficients need few digits, and no proof trusts them.
fn rounded(mut polynomials: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for own in &mut polynomials {
        let size: f64 = own.iter().map(|c| c.abs()).sum();
        let unit = 2.0_f64.powi((symdiff::math::log2(size).ceil() as i32).saturating_sub(58));
        if unit.is_normal() {
            own.iter_mut().for_each(|c| *c = (*c / unit).round() * unit);
        }
    }
    polynomials
}

/// Radii of positions and velocities, 2n.
fn radii(space: &Space, end: &Approximation) -> Vec<f64> {
    let last = space.box_of.size() - 1;
    let rows = [&end.q, &end.v].into_iter().flat_map(|models| (0..models.rows).map(|row| models.at(row, 0)[last]));
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::rounded;

    /// A multiplier that is zero has a size of which there is no logarithm.
    #[test]
    fn coefficients_are_rounded_to_a_share_of_their_sum() {
        let unit = 2.0_f64.powi(-57);
        let polynomials = vec![vec![0.0, 0.0], vec![1.0, 0.5, 3.25 * unit]];
        assert_eq!(rounded(polynomials), [vec![0.0, 0.0], vec![1.0, 0.5, 3.0 * unit]]);
    }
}
