//! Certified bounds: the box is cut into pieces until each one's enclosure reaches the end, or there are too many.

use std::time::Instant;

use rayon::prelude::*;
use symdiff::taylor_model::{ModelSpace, up};

use super::methods::{FleetRun, Lines, Outcome, Run};
use crate::model::RangeKind;
use crate::numerics::{ParameterBox, Range, TaylorRange};
use crate::results::Method;
use crate::simulate::{Certifier, Counters, Enclosure, EnclosureError};

/// Most uncertain parameters: pieces and coefficients grow with powers of their number.
pub(super) const MOST_PARAMETERS: usize = 2;

/// Order of the polynomials, by the number of parameters. (Slider crank, ±1 % of one: 8, 12 and 16 reach 0.51, 0.71 and 0.72 s in one
/// piece.)
const ORDER: [usize; MOST_PARAMETERS + 1] = [0, 12, 6];

/// Most pieces that are enclosed at last.
const MOST_PIECES: usize = 16;

/// What is known of a piece: ranges row by row, output by output, as far as they go.
struct Enclosed {
    piece: ParameterBox,
    ranges: Vec<Range>,
    lost: Option<(f64, EnclosureError)>,
}

impl Run<'_> {
    /// Ranges that hold for every parameter of the box and all that the scheme does, rounding errors included.
    pub(super) fn certified(&self) -> Outcome {
        let begun = Instant::now();
        let domain = &self.study.domain;
        if let Some(effect) = self.study.simulator.system.effects.iter().find(|effect| !effect.enclosed) {
            let note = format!("not supported with --certify: effect {} ({})", effect.name, effect.kind);
            return Outcome { note: Some(note), ..self.join(Vec::new(), 0, begun) };
        }
        let certifier = Certifier::new(&self.study.simulator);
        let space = ModelSpace::new(domain.dimension(), ORDER[domain.dimension()]);
        let mut open = vec![domain.clone()];
        let mut closed: Vec<Enclosed> = Vec::new();
        let mut solves = 0;
        while !open.is_empty() {
            solves += open.len();
            let found: Vec<Enclosed> = std::mem::take(&mut open)
                .into_par_iter()
                .map(|piece| self.enclose(&certifier, &space, piece))
                .collect();
            let room = if self.is_interrupted() { 0 } else { MOST_PIECES.saturating_sub(closed.len() + found.len()) };
            // Those that came least far are cut first; the order of the rest does not matter.
            let mut by_reach: Vec<usize> = (0..found.len()).collect();
            by_reach.sort_by_key(|&index| (found[index].ranges.len(), index));
            let cut: Vec<usize> = by_reach
                .into_iter()
                .filter(|&index| found[index].piece_can_help(domain.dimension()))
                .take(room)
                .collect();
            for (index, enclosed) in found.into_iter().enumerate() {
                if cut.contains(&index) {
                    open.extend(enclosed.piece.halves(widest(&enclosed.piece, domain)));
                } else {
                    closed.push(enclosed);
                }
            }
        }
        self.join(closed, solves, begun)
    }

    /// One piece, as far as it goes.
    fn enclose(&self, certifier: &Certifier, space: &ModelSpace, piece: ParameterBox) -> Enclosed {
        let schedule = self.schedule;
        let outputs = self.outputs();
        let mut ranges = Vec::with_capacity(schedule.rows * outputs);
        let mut models = Vec::new();
        let monomials = space.jets().monomials();
        let mut range = TaylorRange::new(monomials.variables(), monomials.order(), RangeKind::Tight);
        let mut enclosure = match Enclosure::start(certifier, space, &piece.lower, &piece.upper, schedule.first_step())
        {
            Ok(enclosure) => enclosure,
            Err(lost) => return Enclosed { piece, ranges, lost: Some((0.0, lost)) },
        };
        for row in 0..schedule.rows {
            if self.is_interrupted() {
                break;
            }
            if let Err(lost) = enclosure.advance(schedule, row) {
                return Enclosed { piece, ranges, lost: Some(lost) };
            }
            enclosure.observe(&mut models);
            ranges.extend(models.chunks_exact(space.size()).map(|model| range_of(&mut range, model)));
        }
        Enclosed { piece, ranges, lost: None }
    }

    /// The hull of all pieces, unknown from where the first is lost.
    fn join(&self, pieces: Vec<Enclosed>, solves: usize, begun: Instant) -> Outcome {
        let outputs = self.outputs();
        let rows = pieces.iter().map(|piece| piece.ranges.len() / outputs.max(1)).min().unwrap_or(0);
        let mut lines = Lines::new(self);
        for (row, output) in (0..rows).flat_map(|row| (0..outputs).map(move |output| (row, output))) {
            let of_piece = |piece: &Enclosed| piece.ranges[row * outputs + output];
            // There is no surrogate: nothing lies outside, and how much too wide it is is not known.
            lines.set(row, output, pieces.iter().map(of_piece).reduce(hull).unwrap_or(Range::UNKNOWN), 0.0);
        }
        let first = pieces.iter().filter_map(|piece| piece.lost).min_by(|a, b| a.0.total_cmp(&b.0));
        let note = first.map(|(time, lost)| {
            let pieces = pieces.len();
            format!("{lost} for the step to t = {time} s (in one of {pieces} pieces of the box): certified bounds are unknown from there on")
        });
        let summary = self.method_summary(Method::Certified.name(), solves, Counters::default(), None, begun);
        let done = FleetRun { missing: self.schedule.rows - rows, ..FleetRun::default() };
        Outcome { note, ..lines.outcome(done, summary) }
    }
}

impl Enclosed {
    /// Whether smaller pieces of it may go further.
    fn piece_can_help(&self, parameters: usize) -> bool {
        matches!(self.lost, Some((_, EnclosureError::Unproven)))
            && parameters > 0
            && self.piece.lower != self.piece.upper
    }
}

/// The axis along which a piece is widest against the whole box.
fn widest(piece: &ParameterBox, whole: &ParameterBox) -> usize {
    let share = |axis: usize| {
        let width = whole.upper[axis] - whole.lower[axis];
        if width > 0.0 { (piece.upper[axis] - piece.lower[axis]) / width } else { 0.0 }
    };
    (0..whole.dimension()).reduce(|a, b| if share(b) > 1.5 * share(a) { b } else { a }).unwrap_or(0)
}

/// Range of a model: of its polynomial, the rounding errors of finding that, and its radius.
fn range_of(range: &mut TaylorRange, model: &[f64]) -> Range {
    let (coefficients, radius) = model.split_at(model.len() - 1);
    let found = range.range(coefficients);
    // The powers' conversion to Chebyshev polynomials and the sum with the constant: fewer than 100 operations a coefficient.
    let size: f64 = coefficients.iter().map(|c| c.abs()).sum();
    let varies = coefficients[1..].iter().any(|&c| c != 0.0);
    let margin = up(if varies { 100.0 * f64::EPSILON * size } else { 0.0 } + radius[0]);
    let wide = Range { lower: (found.lower - margin).next_down(), upper: (found.upper + margin).next_up() };
    // An infinite radius says nothing.
    if wide.lower.is_finite() && wide.upper.is_finite() { wide } else { Range::UNKNOWN }
}

/// What holds both; unknown where either is.
fn hull(a: Range, b: Range) -> Range {
    if a.lower.is_nan() || b.lower.is_nan() {
        return Range::UNKNOWN;
    }
    Range { lower: a.lower.min(b.lower), upper: a.upper.max(b.upper) }
}
