//! What many draws came to: a line for each family and method.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

use crate::verdict::{Failure, Outcome, Verdict, is_missed};

/// In place of a family's or a method's name.
const ALL: &str = "all";

/// What of a verdict goes into the table.
#[derive(Clone, Debug)]
pub struct Score {
    /// Of the method.
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
    /// Of every row that is not flagged, stated over true error.
    rows_excess: Vec<f64>,
    /// Of every band the mean stated over the mean true error.
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
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Bands, and draws that have none.
#[derive(Default)]
pub struct Table {
    /// By family and method.
    lines: BTreeMap<(String, String), Line>,
    /// Of every family: draws, refused, panicked, out of time, seconds, the longest.
    draws: BTreeMap<String, [f64; 6]>,
}

impl Table {
    pub fn add(&mut self, scored: &Scored) {
        let draws = self.draws.entry(scored.family.clone()).or_default();
        draws[0] += 1.0;
        match &scored.outcome {
            Ok((scores, seconds)) => {
                (draws[4], draws[5]) = (draws[4] + seconds, draws[5].max(*seconds));
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
    let Line { bands, missed, rows, flagged, misses, contradicted, rows_excess, bands_excess, .. } = line;
    let open = rows - flagged;
    let covered = 100.0 * (1.0 - *misses as f64 / open.max(1) as f64);
    let share = 100.0 * *flagged as f64 / (*rows).max(1) as f64;
    let mean = bands_excess.iter().map(|excess| excess.ln()).sum::<f64>() / bands_excess.len() as f64;
    writeln!(
        f,
        "| {family} | {method} | {bands} | {missed} | {contradicted} | {covered:.2} % | {share:.1} % | {:.1} | {:.1} | {:.1} |",
        median(rows_excess),
        median(bands_excess),
        mean.exp()
    )
}
