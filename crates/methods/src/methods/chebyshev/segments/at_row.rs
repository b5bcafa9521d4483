//! Motions at a row's time, expanded there: on the branch of a segment, which goes on a little beyond its events, they
//! are as smooth in the parameters at a time as at a share of the segment, and no instant's error moves them.

use symdiff::jet::JetSpace;

use super::piece::{Piece, Told};
use super::seeds::Lattice;
use super::surrogate::Point;
use super::tuning::TUNING;
use crate::numerics::{SegmentMotions, Surrogate, SurrogateWork, largest};

/// Source of the polynomials of values.
#[derive(Clone, Copy)]
pub(super) enum PolynomialSource<'e> {
    Grid(&'e Surrogate),
    Jets(&'e JetSpace),
}

/// Positions and velocities of a part at a time.
#[derive(Clone, Debug)]
pub(super) struct RowMotion {
    /// Branches of the segments that all samples are in, or not far from.
    branches: Vec<Option<Branch>>,
    /// Whether all of the part is in one segment, and this has a branch.
    pub is_common: bool,
}

/// The branch of a segment at a time.
#[derive(Clone, Debug)]
struct Branch {
    /// Coefficients, line by line.
    coefficients: Vec<f64>,
    /// Errors of each line, for each of the part's sets of samples that determine them.
    errors: Vec<Vec<f64>>,
}

impl RowMotion {
    /// Motions of all rows at these times.
    pub fn of_rows(piece: &Piece, lattice: &Lattice, times: &[f64], source: PolynomialSource) -> Vec<Self> {
        let held_out = piece.surrogate.points(piece.motions.points.clone());
        let of_row = |&time: &f64| {
            let segments = 0..piece.surrogate.segments();
            let branches: Vec<Option<Branch>> =
                segments.map(|segment| Branch::new(piece, &held_out, segment, time, source)).collect();
            let common = common_segment(piece, lattice, time);
            let is_common = common.is_some_and(|segment| branches[segment].is_some());
            Self { branches, is_common }
        };
        let own: Vec<Self> = times.iter().map(of_row).collect();
        // Errors of neighbouring rows count too, so that none vanishes by a change of sign.
        let beside = |row: usize| {
            let mut raised = own[row].clone();
            for other in &own[row.saturating_sub(1)..(row + 2).min(own.len())] {
                let branches = raised.branches.iter_mut().zip(&other.branches);
                for (own, other) in branches.filter_map(|(own, other)| own.as_mut().zip(other.as_ref())) {
                    let errors = own.errors.iter_mut().flatten().zip(other.errors.iter().flatten());
                    errors.for_each(|(own, other)| *own = largest([*own, *other]));
                }
            }
            raised
        };
        (0..own.len()).map(beside).collect()
    }

    /// Whether a segment's branch is known.
    pub fn has_branch(&self, segment: usize) -> bool {
        self.branches[segment].is_some()
    }

    /// The motion (2n) of a point on the branch of a segment.
    pub fn motion<'p>(&'p self, point: &'p Point, segment: usize) -> Option<impl Iterator<Item = f64> + 'p> {
        let branch = self.branches[segment].as_ref()?;
        Some(branch.coefficients.chunks_exact(point.terms()).map(|line| point.value(line)))
    }

    /// Error of a line there, from one of the part's sets of samples.
    pub fn error(&self, segment: usize, told: usize, line: usize) -> Option<f64> {
        self.branches[segment].as_ref().map(|branch| branch.errors[told][line])
    }
}

impl Branch {
    /// `held_out` are the points of the piece's samples that are held out.
    fn new(piece: &Piece, held_out: &[Point], segment: usize, time: f64, source: PolynomialSource) -> Option<Self> {
        let surrogate = &piece.surrogate;
        // Only a fit knows its error without samples that are held out.
        if held_out.is_empty() && surrogate.squares().is_none() {
            return None;
        }
        let direct = piece.motions.held_out.at(segment, time, TUNING.beyond_longest)?;
        let mut doubts = direct.doubts;
        // Without held-out samples their motions have no lines.
        doubts.resize(surrogate.lines(), 0.0);
        let mut of_samples = || {
            let motion = piece.motions.fitted.at(segment, time, TUNING.beyond_longest)?;
            doubts.iter_mut().zip(motion.doubts).for_each(|(own, other)| *own = own.max(other));
            Some(motion.values)
        };
        // Leave-one-out errors of a fit's samples.
        let mut left_out = Vec::new();
        let coefficients = match (surrogate.squares(), source) {
            (Some(squares), _) => {
                let values = of_samples()?;
                let fits = values.chunks_exact(piece.samples.len()).map(|line| squares.fit(line));
                let (own, missed): (Vec<_>, Vec<_>) = fits.collect::<Option<Vec<_>>>()?.into_iter().unzip();
                left_out = missed;
                own.concat()
            }
            (None, PolynomialSource::Grid(grid)) => grid.coefficients(&of_samples()?, &mut SurrogateWork::default()),
            (None, PolynomialSource::Jets(space)) => {
                piece.motions.fitted.jet_at(space, segment, time, TUNING.beyond_longest)?
            }
        };
        let of_line = |(line, own): (usize, &[f64])| {
            let least = doubts[line].max(surrogate.truncation(own));
            let values = &direct.values[line * held_out.len()..];
            let of_points: Vec<f64> =
                held_out.iter().zip(values).map(|(point, value)| point.value(own) - value).collect();
            let of_told = |told: &Told| {
                let of_fit = left_out.get(line).into_iter().flat_map(|line| told.fitted.iter().map(|&own| line[own]));
                let others = told.held_out.iter().map(|&point| of_points[point]);
                largest(of_fit.chain(others).chain([least]))
            };
            piece.told().iter().map(of_told).collect::<Vec<f64>>()
        };
        let lines: Vec<Vec<f64>> = coefficients.chunks_exact(surrogate.terms()).enumerate().map(of_line).collect();
        // At shares of the segment polynomials may do better, where its branch is long.
        let at_shares = &piece.errors().lines[segment];
        let at_share = |line: usize| largest(at_shares.iter().map(|of_step| of_step[line]));
        let errors = (0..piece.told().len()).map(|told| lines.iter().map(|line| line[told]).collect()).collect();
        let is_better = lines.iter().enumerate().all(|(line, errors)| errors[0] <= at_share(line));
        is_better.then_some(Self { coefficients, errors })
    }
}

/// The segment that all of a part is in at a time, wherever within their errors instants are.
fn common_segment(piece: &Piece, lattice: &Lattice, time: f64) -> Option<usize> {
    let segment = lattice.points().first()?.segment(time);
    let last = piece.surrogate.segments() - 1;
    let is_within = |begin: f64, end: f64, errors: [f64; 2]| {
        (segment == 0 || begin + errors[0] <= time) && (segment == last || time <= end - errors[1])
    };
    let of_point = |point: &Point| {
        let errors = &piece.errors_at(point).times;
        let safe = [segment, segment + 1].map(|number| TUNING.safety_of_common * errors[number]);
        is_within(point.times[segment], point.times[segment + 1], safe)
    };
    let of_motions = |motions: &SegmentMotions| {
        let mut samples = 0..motions.samples.len();
        samples.all(|own| is_within(motions.times[segment][own], motions.times[segment + 1][own], [0.0; 2]))
    };
    let fitted = piece.surrogate.is_jet() || of_motions(&piece.motions.fitted);
    (fitted && of_motions(&piece.motions.held_out) && lattice.points().iter().all(of_point)).then_some(segment)
}
