//! A draw is run, and every band compared with the truth.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use mbint::{Band, Method, Model, StudyResult};

use crate::draw::Draw;
use crate::truth::{self, Range};

/// Time limit of a draw, longer than any should take, or that of the environment.
fn patience() -> Duration {
    Duration::from_secs(crate::asked("MBINT_FALSIFY_PATIENCE").unwrap_or(60))
}

/// Rounding, relative to the size of the coordinates and to the output's own.
const ROUNDING: f64 = 1e-11;

/// Rows that are not flagged may be missed in this share of a band.
const MISSES: f64 = 0.01;

/// Outcome of a draw.
pub enum Outcome {
    /// Every band, and the seconds of the run.
    Judged(Vec<Verdict>, f64),
    Failed(Failure),
}

/// Why a draw has no bands.
#[derive(thiserror::Error, Debug)]
pub enum Failure {
    /// The model was not accepted, or could not be run.
    #[error("refused: {0}")]
    Refused(String),
    #[error("panicked")]
    Panicked,
    #[error("took too long")]
    OutOfTime,
}

/// A row in which an end is farther off than stated.
#[derive(Clone, Copy, Debug)]
pub struct Miss {
    pub row: usize,
    pub time: f64,
    pub truth: Range,
    pub found: Range,
    pub stated: f64,
    pub off: f64,
    /// Whether the band excludes values that do occur; otherwise it contains values that do not.
    pub inside: bool,
}

/// A band against the truth.
#[derive(Clone, Debug)]
pub struct Verdict {
    pub output: usize,
    pub method: Method,
    /// Label of the method in tables.
    pub label: &'static str,
    pub rows: usize,
    pub flagged: usize,
    /// Rows without a flag.
    pub misses: Vec<Miss>,
    /// Rows without a flag that exclude, by more than the errors, values that the run has simulated or bounded
    /// otherwise.
    pub contradicted: usize,
    /// Over the rows without a flag: the sum of stated and of true errors, and each row's ratio.
    pub stated: f64,
    pub off: f64,
    pub ratios: Vec<f64>,
    /// Largest true width.
    pub width: f64,
}

impl Verdict {
    pub fn is_missed(&self) -> bool {
        is_missed(self.misses.len(), self.rows - self.flagged)
    }

    pub fn worst(&self) -> Option<&Miss> {
        self.misses.iter().max_by(|a, b| (a.off / a.stated).total_cmp(&(b.off / b.stated)))
    }
}

/// Whether a band is, given how many of its rows without a flag are.
pub fn is_missed(misses: usize, open: usize) -> bool {
    misses as f64 > MISSES * open as f64
}

/// Runs a draw and compares. Rows of a band that seem to be missed are compared with the truth of a denser search.
pub fn examine(draw: &Draw) -> Outcome {
    let begun = Instant::now();
    let result = match catch_unwind(AssertUnwindSafe(|| run(draw, begun))) {
        Err(_) => return Outcome::Failed(Failure::Panicked),
        Ok(Err(error)) => return Outcome::Failed(Failure::Refused(error.to_string())),
        Ok(Ok(result)) => result,
    };
    let seconds = begun.elapsed().as_secs_f64();
    if begun.elapsed() > patience() {
        return Outcome::Failed(Failure::OutOfTime);
    }
    let times = result.times();
    let mut truth = truth::ranges(draw, times, 0);
    let mut unsure = vec![vec![0.0; times.len()]; draw.outputs.len()];
    let mut verdicts = judge(draw, &result, &truth, &unsure);
    let missed = verdicts.iter().filter(|verdict| verdict.is_missed());
    let rows: BTreeSet<usize> = missed.flat_map(|verdict| verdict.misses.iter().map(|miss| miss.row)).collect();
    if !rows.is_empty() {
        let at: Vec<f64> = std::iter::once(0.0).chain(rows.iter().map(|&row| times[row])).collect();
        for (output, dense) in truth::ranges(draw, &at, 1).into_iter().enumerate() {
            for (&row, dense) in rows.iter().zip(&dense[1..]) {
                let known = &mut truth[output][row];
                unsure[output][row] = (known.lower - dense.lower).abs().max((known.upper - dense.upper).abs());
                *known = *dense;
            }
        }
        verdicts = judge(draw, &result, &truth, &unsure);
    }
    Outcome::Judged(verdicts, seconds)
}

fn run(draw: &Draw, begun: Instant) -> Result<StudyResult, mbint::Error> {
    let model = Model::from_yaml_str("draw", &draw.yaml())?;
    let patience = patience();
    let late = move || begun.elapsed() > patience;
    model.study().allow_costly().threads(1).interrupted(&late).run()
}

fn judge(draw: &Draw, result: &StudyResult, truth: &[Vec<Range>], unsure: &[Vec<f64>]) -> Vec<Verdict> {
    let mut verdicts = Vec::new();
    for (index, output) in result.outputs().enumerate() {
        let bands: Vec<Band> = output.bands().collect();
        let inputs = draw.outputs[index].inputs.iter();
        let coordinates: f64 = inputs.map(|&(term, _)| draw.terms[term].size).sum();
        for &band in &bands {
            let size = truth[index].iter().fold(coordinates, |size, range| size.max(range.upper.abs()));
            let slack: Vec<f64> = unsure[index].iter().map(|unsure| unsure + ROUNDING * size).collect();
            let ends = result.failure().is_some();
            let verdict = compare(band, result.times(), &truth[index], &slack, ends);
            let contradicted = (0..slack.len())
                .filter(|&row| is_contradicted(band, &bands, output.nominal()[row], row, ROUNDING * size))
                .count();
            let name = band.method().name();
            let label =
                if draw.bounds.tolerance.is_some() && name == "chebyshev" { "chebyshev to a tolerance" } else { name };
            verdicts.push(Verdict { output: index, label, contradicted, ..verdict });
        }
    }
    verdicts
}

/// Whether a row without a flag excludes the nominal motion, or an end of another method's band that is not flagged
/// either.
fn is_contradicted(band: Band, all: &[Band], nominal: f64, row: usize, rounding: f64) -> bool {
    let apart = |a: f64, b: f64, error: f64| (a - b).abs() > error + rounding;
    let (lower, upper, error) = (band.lower()[row], band.upper()[row], band.errors()[row]);
    let is_other_excluded = |other: &Band| {
        let error = error + other.errors()[row];
        other.is_reliable(row) && (apart(lower, other.lower()[row], error) || apart(upper, other.upper()[row], error))
    };
    let is_nominal_outside = nominal < lower - error - rounding || nominal > upper + error + rounding;
    band.is_reliable(row) && (is_nominal_outside || all.iter().any(is_other_excluded))
}

/// A band row by row. Where a run says that it ended early, rows without a value are as good as flagged.
fn compare(band: Band, times: &[f64], truth: &[Range], slack: &[f64], ended: bool) -> Verdict {
    let mut verdict = Verdict {
        output: 0,
        method: band.method(),
        label: "",
        rows: times.len(),
        flagged: 0,
        misses: Vec::new(),
        contradicted: 0,
        stated: 0.0,
        off: 0.0,
        ratios: Vec::new(),
        width: truth.iter().fold(0.0, |width, range| width.max(range.upper - range.lower)),
    };
    for (row, &truth) in truth.iter().enumerate() {
        let found = Range { lower: band.lower()[row], upper: band.upper()[row] };
        if !band.is_reliable(row) || (ended && found.lower.is_nan()) {
            verdict.flagged += 1;
            continue;
        }
        let stated = band.errors()[row];
        let [below, above] = [found.lower - truth.lower, truth.upper - found.upper];
        let off = below.abs().max(above.abs());
        let inside = below.max(above) >= off;
        let is_covered = off <= stated + slack[row];
        if !is_covered {
            verdict.misses.push(Miss { row, time: times[row], truth, found, stated, off, inside });
        }
        verdict.stated += stated;
        verdict.off += off;
        if off > slack[row] {
            verdict.ratios.push(stated / off);
        }
    }
    verdict
}
