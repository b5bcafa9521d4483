//! Results of many draws: a line for each family and method.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

use crate::measured::Case;
use crate::verdict::{Failure, Outcome, Verdict, is_missed};

/// Share of the draws that may have a missed band, and of the rows that are covered at least, in per cent.
const MOST_MISSED: f64 = 0.01;
const LEAST_COVERED: f64 = 99.0;

/// In place of a family's or a method's name.
const ALL: &str = "all";

/// The part of a verdict that goes into the table.
#[derive(Clone, Debug)]
pub struct Score {
    /// Label of the method.
    pub label: String,
    pub rows: usize,
    pub flagged: usize,
    pub misses: usize,
    pub contradicted: usize,
    /// Over the rows without a flag: the sum of stated and of true errors, and each row's ratio.
    pub stated: f64,
    pub off: f64,
    pub ratios: Vec<f64>,
}

/// Why a draw has no bands.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    Refused,
    Panicked,
    OutOfTime,
}

impl Kind {
    pub const ALL: [Self; 3] = [Self::Refused, Self::Panicked, Self::OutOfTime];

    pub fn name(self) -> &'static str {
        match self {
            Self::Refused => "refused",
            Self::Panicked => "panicked",
            Self::OutOfTime => "out of time",
        }
    }
}

/// A draw in the table: its bands and the seconds of the run, or why there are none.
#[derive(Clone, Debug)]
pub struct Scored {
    pub family: String,
    pub outcome: Result<(Vec<Score>, f64), Kind>,
}

impl Scored {
    pub fn new(family: &str, outcome: &Outcome) -> Self {
        let outcome = match outcome {
            Outcome::Judged(verdicts, seconds) => Ok((verdicts.iter().map(Score::new).collect(), *seconds)),
            Outcome::Failed(Failure::Refused(_)) => Err(Kind::Refused),
            Outcome::Failed(Failure::Panicked) => Err(Kind::Panicked),
            Outcome::Failed(Failure::OutOfTime) => Err(Kind::OutOfTime),
        };
        Self { family: family.to_owned(), outcome }
    }
}

impl Score {
    fn new(verdict: &Verdict) -> Self {
        Self {
            label: verdict.label.to_owned(),
            rows: verdict.rows,
            flagged: verdict.flagged,
            misses: verdict.misses.len(),
            contradicted: verdict.contradicted,
            stated: verdict.stated,
            off: verdict.off,
            ratios: verdict.ratios.clone(),
        }
    }
}

/// Bands of a family by a method.
#[derive(Default)]
struct Line {
    bands: usize,
    missed: usize,
    rows: usize,
    flagged: usize,
    misses: usize,
    /// Bands with a row that contradicts its own run.
    contradicted: usize,
    /// Stated over true error of every row that is not flagged.
    rows_excess: Vec<f64>,
    /// Mean stated error over mean true error of every band.
    bands_excess: Vec<f64>,
}

impl Line {
    fn add(&mut self, score: &Score) {
        self.bands += 1;
        self.missed += usize::from(is_missed(score.misses, score.rows - score.flagged));
        self.rows += score.rows;
        self.flagged += score.flagged;
        self.misses += score.misses;
        self.contradicted += usize::from(score.contradicted > 0);
        self.rows_excess.extend(&score.ratios);
        // A band that is exact up to rounding says nothing here.
        if !score.ratios.is_empty() && score.stated.is_finite() {
            self.bands_excess.push(score.stated / score.off);
        }
    }

    /// Rows that are covered of those without a flag, in per cent.
    fn covered(&self) -> f64 {
        100.0 * (1.0 - self.misses as f64 / (self.rows - self.flagged).max(1) as f64)
    }

    /// Rows with a flag, in per cent.
    fn share_flagged(&self) -> f64 {
        100.0 * self.flagged as f64 / self.rows.max(1) as f64
    }

    /// Geometric mean over bands of the mean stated over the mean true error.
    fn mean_excess(&self) -> f64 {
        let logarithms = self.bands_excess.iter().map(|excess| excess.ln());
        (logarithms.sum::<f64>() / self.bands_excess.len() as f64).exp()
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Bands, and draws that have none.
#[derive(Default)]
pub struct Table {
    /// Lines by family and method.
    lines: BTreeMap<(String, String), Line>,
    /// Counts by family: draws, refused, panicked, out of time, seconds, the longest.
    draws: BTreeMap<String, [f64; 6]>,
    /// Draws of every family with a band that is missed.
    with_misses: BTreeMap<String, usize>,
}

impl Table {
    pub fn add(&mut self, scored: &Scored) {
        let draws = self.draws.entry(scored.family.clone()).or_default();
        draws[0] += 1.0;
        match &scored.outcome {
            Ok((scores, seconds)) => {
                (draws[4], draws[5]) = (draws[4] + seconds, draws[5].max(*seconds));
                let is_missed = scores.iter().any(|own| is_missed(own.misses, own.rows - own.flagged));
                *self.with_misses.entry(scored.family.clone()).or_default() += usize::from(is_missed);
                for score in scores {
                    let (family, label) = (&*scored.family, &*score.label);
                    for (family, label) in [(family, label), (family, ALL), (ALL, label), (ALL, ALL)] {
                        self.lines.entry((family.to_owned(), label.to_owned())).or_default().add(score);
                    }
                }
            }
            Err(kind) => draws[1 + *kind as usize] += 1.0,
        }
    }

    fn of_all(&self, family: &str) -> Option<&Line> {
        self.lines.get(&(family.to_owned(), ALL.to_owned()))
    }

    /// Bands of a family that are missed.
    pub fn missed(&self, family: &str) -> usize {
        self.of_all(family).map_or(0, |line| line.missed)
    }

    /// Bands with rows that contradict their own run.
    pub fn contradicted(&self) -> usize {
        self.of_all(ALL).map_or(0, |line| line.contradicted)
    }

    /// Notes every family, and all of them, for the verification report: bands of one draw hang together, draws do not.
    pub fn note(&self, seed: u64) {
        let judged = |[draws, refused, panicked, late, ..]: &[f64; 6]| (draws - refused - panicked - late) as usize;
        let families = self.draws.iter().map(|(family, draws)| (family.as_str(), judged(draws)));
        let all = (ALL, self.draws.values().map(judged).sum());
        for (family, draws) in families.chain([all]) {
            let Some(line) = self.of_all(family) else { continue };
            let with_misses = match family {
                ALL => self.with_misses.values().sum(),
                own => self.with_misses.get(own).copied().unwrap_or(0),
            };
            // A family has too few draws for a limit of its own.
            let limit = (family == ALL).then_some(MOST_MISSED);
            let case = Case::new("falsifier", family).source(&format!("seed {seed}"));
            let asked = if family == ALL { self.draws.values().map(|own| own[0]).sum() } else { self.draws[family][0] };
            let case = case.share("draws with a missed band", with_misses, draws, limit);
            let case = case.figure("bands", line.bands as f64).figure("bands missed", line.missed as f64);
            let case = match family {
                ALL => case.at_least("rows covered, %", line.covered(), LEAST_COVERED),
                _ => case.figure("rows covered, %", line.covered()),
            };
            let case = case.figure("rows flagged, %", line.share_flagged());
            let case = case.figure("stated / true error", line.mean_excess());
            case.figure("draws not judged", asked - draws as f64).note();
        }
    }

    /// Draws that were refused or panicked. (How many are out of time hangs on the machine.)
    pub fn failures(&self) -> usize {
        self.draws.values().map(|draws| (draws[1] + draws[2]) as usize).sum()
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        writeln!(
            f,
            "| family | method | bands | missed | contradicted | rows covered | flagged | excess, median row | median band | mean band |"
        )?;
        writeln!(f, "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|")?;
        // The families' sums come last.
        for sums in [false, true] {
            for ((family, method), line) in self.lines.iter().filter(|((_, method), _)| (method == ALL) == sums) {
                write_line(f, family, method, line)?;
            }
        }
        writeln!(f, "\n| family | draws | refused | panicked | out of time | s a draw | at most |")?;
        writeln!(f, "|---|--:|--:|--:|--:|--:|--:|")?;
        for (family, [draws, refused, panicked, late, seconds, longest]) in &self.draws {
            writeln!(
                f,
                "| {family} | {draws} | {refused} | {panicked} | {late} | {:.2} | {longest:.1} |",
                seconds / draws
            )?;
        }
        Ok(())
    }
}

fn write_line(f: &mut Formatter, family: &str, method: &str, line: &Line) -> fmt::Result {
    let Line { bands, missed, contradicted, rows_excess, bands_excess, .. } = line;
    let (covered, share) = (line.covered(), line.share_flagged());
    writeln!(
        f,
        "| {family} | {method} | {bands} | {missed} | {contradicted} | {covered:.2} % | {share:.1} % | {:.1} | {:.1} | {:.1} |",
        median(rows_excess),
        median(bands_excess),
        line.mean_excess()
    )
}
