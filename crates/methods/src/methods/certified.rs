//! Certified bounds: the box is cut into pieces until each one's enclosure reaches the end, or there are too many.

use std::sync::Arc;

use rayon::prelude::*;
use symdiff::taylor_model::{ModelSpace, up};

use super::BoundsRequest;
use super::ensemble::{Ensemble, EnsembleError, Simulated};
use super::proof::{EnclosureEnd, Lost, Proof};
use super::registry::{About, BoundingMethod, Refusal, Registered};
use super::request::Problem;
use super::result::{BandBuilder, MethodResult};
use super::validation::Validation;
use crate::certificate::{self, Piece};
use crate::numerics::{ParameterBox, Range, RangeKind, TaylorRange};

/// By how much bands are wider than their proof, relative to their width, to the size of the output, and to the radius.
struct Room {
    width: f64,
    size: f64,
    radius: f64,
}

/// So that a second checker of a certificate, whose radii may be larger, finds the same bands.
const ROOM: Room = Room { width: 1e-6, size: 1e-12, radius: 3.0 };

/// Certified bounds: proven for every parameter of the box.
#[derive(Clone, Copy, Debug, Default)]
pub struct Certified {
    /// The proven motion.
    pub proof: Proof,
}

impl Registered for Certified {
    const ABOUT: About = About {
        label: "Certified",
        summary: "proven enclosures of the true motion by Taylor models, for at most three parameters (--certify)",
        source: "Makino & Berz, Int. J. Pure Appl. Math. 4 (2003) 379; Krawczyk, Computing 4 (1969) 187",
        color: [0, 120, 60],
        fill: 0.08,
        dashes: Some([14.0, 3.0]),
        is_sampled: false,
        has_sensitivities: false,
        curves: &[],
    };

    fn default_for(_: &Problem) -> Self {
        Self::default()
    }
}

impl BoundingMethod for Certified {
    fn fit(&mut self, problem: &Problem) -> Result<(), Refusal> {
        if !problem.has_equations {
            return Err(Refusal::no_equations("certified"));
        }
        let parameters = problem.parameters;
        let most = self.proof.orders().len() - 1;
        if parameters > most {
            let most = if most == 2 { "two" } else { "three" };
            let message = format!("certified bounds are for at most {most} uncertain parameters, not {parameters}");
            return Err(Refusal(message));
        }
        if self.proof == Proof::Scheme && !problem.has_fixed_steps {
            let message = "certified bounds of the scheme enclose HHT-I3 itself with a fixed `step`: no `tolerance`, which chooses steps that depend on the samples, and no `extrapolation`; `--certify` without `scheme` encloses the true motion";
            return Err(Refusal(message.to_owned()));
        }
        Ok(())
    }

    fn bound(&self, ensemble: &dyn Ensemble, _: &Validation, _: &BoundsRequest) -> Result<MethodResult, EnsembleError> {
        Ok(enclosed(ensemble, self.proof))
    }
}

/// A piece that is to be enclosed, and the number of ranges of the larger piece that it was cut from.
struct Open {
    piece: ParameterBox,
    before: Option<usize>,
}

/// Ranges of a piece, row by row, output by output, as far as they go.
struct Enclosed {
    piece: ParameterBox,
    ranges: Vec<Range>,
    /// The same since the row before; empty if that is not known.
    between: Vec<Range>,
    lost: Option<Lost>,
    /// The proof for the certificate.
    proof: Option<Piece>,
    /// Number of ranges of the larger piece that it was cut from.
    before: Option<usize>,
}

/// Ranges that hold for every parameter of the box, rounding errors included.
fn enclosed(ensemble: &dyn Ensemble, proof: Proof) -> MethodResult {
    let domain = ensemble.domain();
    if let Some(obstacle) = ensemble.obstacle_to_enclosure(proof) {
        let note = format!("not supported with --certify: {obstacle}");
        return MethodResult { note: Some(note), ..hull_of_pieces(ensemble, proof, Vec::new(), 0) };
    }
    let space = ModelSpace::new(domain.dimension(), proof.orders()[domain.dimension()]);
    let mut open = vec![Open { piece: domain.clone(), before: None }];
    let mut closed: Vec<Enclosed> = Vec::new();
    let mut simulations = 0;
    while !open.is_empty() {
        simulations += open.len();
        let found: Vec<Enclosed> =
            std::mem::take(&mut open).into_par_iter().map(|own| enclose(ensemble, proof, &space, own)).collect();
        let interrupted = ensemble.is_interrupted();
        let mut room = if interrupted { 0 } else { proof.most_pieces().saturating_sub(closed.len() + found.len()) };
        // Those that came least far are cut first; the order of the rest does not matter.
        let mut by_reach: Vec<usize> = (0..found.len()).collect();
        by_reach.sort_by_key(|&index| (found[index].ranges.len(), index));
        let can_help = |&index: &usize| found[index].piece_can_help(domain.dimension());
        let mut parts = vec![1; found.len()];
        for index in by_reach.into_iter().filter(can_help) {
            // Halves would hardly come to the end where the piece has not come half as far.
            let wanted = if 2 * found[index].ranges.len() < ensemble.rows() * ensemble.outputs() { 4 } else { 2 };
            parts[index] = [wanted, 2, 1].into_iter().find(|parts| parts - 1 <= room).unwrap_or(1);
            room -= parts[index] - 1;
        }
        for (enclosed, parts) in found.into_iter().zip(parts) {
            let axis = enclosed.lost.as_ref().and_then(|lost| lost.axis);
            let halved = |piece: &ParameterBox| piece.halves(axis_of_cut(piece, domain, axis));
            let pieces: Vec<ParameterBox> = match parts {
                1 => {
                    closed.push(enclosed);
                    continue;
                }
                2 => halved(&enclosed.piece).into(),
                _ => halved(&enclosed.piece).iter().flat_map(halved).collect(),
            };
            let before = Some(enclosed.ranges.len());
            open.extend(pieces.into_iter().map(|piece| Open { piece, before }));
        }
    }
    hull_of_pieces(ensemble, proof, closed, simulations)
}

/// One piece, as far as it goes.
fn enclose(ensemble: &dyn Ensemble, proof: Proof, space: &ModelSpace, open: Open) -> Enclosed {
    let Open { piece, before } = open;
    let mut ranges = Vec::with_capacity(ensemble.rows() * ensemble.outputs());
    let monomials = space.jets().monomials();
    let mut range = TaylorRange::new(monomials.variables(), monomials.order(), RangeKind::Tight);
    let mut between = Vec::new();
    let EnclosureEnd { lost, piece: proof } = ensemble.enclose(proof, space, &piece, &mut |models, since| {
        ranges.extend(models.chunks_exact(space.size()).map(|model| range_of(&mut range, model)));
        between.extend(since.iter().map(|since| known(Range { lower: since.lower(), upper: since.upper() })));
    });
    widen(&mut ranges, ensemble.outputs());
    Enclosed { piece, ranges, between, lost, proof, before }
}

/// Gives each output room by its size over all rows: where it passes through zero, its terms still have their rounding
/// errors.
fn widen(ranges: &mut [Range], outputs: usize) {
    let mut sizes = vec![0.0_f64; outputs];
    for row in ranges.chunks_exact(outputs.max(1)) {
        for (size, range) in sizes.iter_mut().zip(row) {
            // NaN is no size.
            *size = size.max(range.lower.abs()).max(range.upper.abs());
        }
    }
    for row in ranges.chunks_exact_mut(outputs.max(1)) {
        for (size, range) in sizes.iter().zip(row) {
            let room = ROOM.size * size;
            *range = Range { lower: (range.lower - room).next_down(), upper: (range.upper + room).next_up() };
        }
    }
}

/// The hull of all pieces, unknown from where the first is lost.
fn hull_of_pieces(ensemble: &dyn Ensemble, proof: Proof, pieces: Vec<Enclosed>, simulations: usize) -> MethodResult {
    let outputs = ensemble.outputs();
    let rows = pieces.iter().map(|piece| piece.ranges.len() / outputs.max(1)).min().unwrap_or(0);
    let mut bands = BandBuilder::new(outputs, ensemble.rows());
    for (row, output) in (0..rows).flat_map(|row| (0..outputs).map(move |output| (row, output))) {
        let of_piece = |piece: &Enclosed| piece.ranges[row * outputs + output];
        // There is no surrogate: nothing lies outside, and how much too wide it is is not known.
        bands.set(row, output, pieces.iter().map(of_piece).reduce(hull).unwrap_or(Range::UNKNOWN), 0.0);
    }
    let sees_all = !pieces.is_empty() && pieces.iter().all(|piece| piece.between.len() == piece.ranges.len());
    let since = |row: usize, output: usize| {
        let of_piece = |piece: &Enclosed| piece.between[row * outputs + output];
        if row < rows { pieces.iter().map(of_piece).reduce(hull).unwrap_or(Range::UNKNOWN) } else { Range::UNKNOWN }
    };
    let of_output = |output: usize| (0..ensemble.rows()).map(|row| since(row, output)).collect();
    let between = if sees_all { (0..outputs).map(of_output).collect() } else { Vec::new() };
    let lost = pieces.iter().filter_map(|piece| piece.lost.as_ref().map(|lost| (lost, piece)));
    let lost = lost.min_by(|a, b| a.0.time.total_cmp(&b.0.time));
    let note = lost.map(|(Lost { time, why, help, .. }, piece)| {
        let count = pieces.len();
        let is_no_further = piece.before.is_some_and(|before| piece.ranges.len() <= before);
        let help = if is_no_further { "smaller pieces come no further, as where equations are singular or switch" } else { help };
        format!("{why} at t = {time} s (in one of {count} pieces of the box): certified bounds are unknown from there on; {help}")
    });
    let simulated = Simulated { missing: ensemble.rows() - rows, ..Simulated::default() };
    let mut result = bands.finish(simulations, simulated);
    if proof == Proof::Motion {
        // No step is in it.
        let known = |range: &Range| if range.lower.is_nan() { f64::NAN } else { 0.0 };
        result.steps = result.bands.iter().map(|ranges| ranges.iter().map(known).collect()).collect();
    }
    let order = proof.orders()[ensemble.domain().dimension()];
    let certified = certified(ensemble, order, &result.bands, pieces).map(Arc::new);
    MethodResult { note, between, certified, ..result }
}

/// The certificate of the bands, where every piece has a proof.
fn certified(
    ensemble: &dyn Ensemble,
    order: usize,
    bands: &[Vec<Range>],
    pieces: Vec<Enclosed>,
) -> Option<certificate::Certified> {
    let pieces = pieces.into_iter().map(|piece| piece.proof).collect::<Option<Vec<Piece>>>()?;
    if pieces.is_empty() {
        return None;
    }
    let ends = |range: &Range| (!range.lower.is_nan()).then_some([range.lower, range.upper]);
    let rows = 0..ensemble.rows();
    Some(certificate::Certified {
        order,
        times: rows.clone().map(|row| ensemble.time(row)).collect(),
        bounds: rows.map(|row| bands.iter().map(|own| ends(&own[row])).collect()).collect(),
        pieces,
        ..ensemble.certified()?
    })
}

impl Enclosed {
    /// Whether smaller pieces of it may go further.
    fn piece_can_help(&self, parameters: usize) -> bool {
        self.lost.as_ref().is_some_and(|lost| lost.is_too_wide)
            && parameters > 0
            && self.piece.lower != self.piece.upper
    }
}

/// The axis of which a piece is too wide, or along which it has the largest share of the whole box.
fn axis_of_cut(piece: &ParameterBox, whole: &ParameterBox, too_wide: Option<usize>) -> usize {
    let width = |axis: usize| piece.upper[axis] - piece.lower[axis];
    if let Some(axis) = too_wide.filter(|&axis| width(axis) > 0.0) {
        return axis;
    }
    let share = |axis: usize| {
        let whole = whole.upper[axis] - whole.lower[axis];
        if whole > 0.0 { width(axis) / whole } else { 0.0 }
    };
    (0..whole.dimension()).reduce(|a, b| if share(b) > 1.5 * share(a) { b } else { a }).unwrap_or(0)
}

/// Range of a model: of its polynomial, the rounding errors of finding that, and its radius.
fn range_of(range: &mut TaylorRange, model: &[f64]) -> Range {
    let (coefficients, radius) = model.split_at(model.len() - 1);
    let found = range.range(coefficients);
    // The powers' conversion to Chebyshev polynomials and the sum with the constant: fewer than 100 operations a
    // coefficient.
    let size: f64 = coefficients.iter().map(|c| c.abs()).sum();
    let varies = coefficients[1..].iter().any(|&c| c != 0.0);
    let rounding = if varies { 100.0 * f64::EPSILON * size } else { 0.0 };
    // Another checker's last digits differ.
    let room = ROOM.width * (found.upper - found.lower) + ROOM.radius * radius[0];
    let margin = up(rounding + radius[0] + room);
    let wide = Range { lower: (found.lower - margin).next_down(), upper: (found.upper + margin).next_up() };
    known(wide)
}

/// A range without an end says nothing.
fn known(range: Range) -> Range {
    if range.lower.is_finite() && range.upper.is_finite() { range } else { Range::UNKNOWN }
}

/// The smallest range that contains both; unknown if either is.
fn hull(a: Range, b: Range) -> Range {
    if a.lower.is_nan() || b.lower.is_nan() {
        return Range::UNKNOWN;
    }
    Range { lower: a.lower.min(b.lower), upper: a.upper.max(b.upper) }
}
