//! What many draws came to: a line for each family and method.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

use crate::verdict::{Failure, Verdict};

/// In place of a family's or a method's name.
const ALL: &str = "all";

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
    seconds: f64,
}

impl Line {
    fn add(&mut self, verdict: &Verdict) {
        self.bands += 1;
        self.missed += usize::from(verdict.is_missed());
        self.rows += verdict.rows;
        self.flagged += verdict.flagged;
        self.misses += verdict.misses.len();
        self.contradicted += usize::from(verdict.contradicted > 0);
        self.rows_excess.extend(&verdict.ratios);
        // A band that is exact up to rounding says nothing here.
        if !verdict.ratios.is_empty() && verdict.stated.is_finite() {
            self.bands_excess.push(verdict.stated / verdict.off);
        }
        self.seconds += verdict.seconds;
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
    lines: BTreeMap<(&'static str, &'static str), Line>,
    /// Of every family: draws, refused, panicked, out of time, seconds, the longest.
    draws: BTreeMap<&'static str, [f64; 6]>,
}

impl Table {
    pub fn add(&mut self, family: &'static str, verdicts: &[Verdict], seconds: f64) {
        for verdict in verdicts {
            for line in [(family, verdict.label), (family, ALL), (ALL, verdict.label), (ALL, ALL)] {
                self.lines.entry(line).or_default().add(verdict);
            }
        }
        let draws = self.draws.entry(family).or_default();
        (draws[0], draws[4]) = (draws[0] + 1.0, draws[4] + seconds);
        draws[5] = draws[5].max(seconds);
    }

    pub fn add_failure(&mut self, family: &'static str, failure: &Failure) {
        let kind = match failure {
            Failure::Refused(_) => 1,
            Failure::Panicked => 2,
            Failure::OutOfTime => 3,
        };
        let draws = self.draws.entry(family).or_default();
        (draws[0], draws[kind]) = (draws[0] + 1.0, draws[kind] + 1.0);
    }

    /// Bands of a family that are missed.
    pub fn missed(&self, family: &'static str) -> usize {
        self.lines.get(&(family, ALL)).map_or(0, |line| line.missed)
    }

    /// Bands with rows that contradict their own run.
    pub fn contradicted(&self) -> usize {
        self.lines.get(&(ALL, ALL)).map_or(0, |line| line.contradicted)
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
            for ((family, method), line) in self.lines.iter().filter(|((_, method), _)| (*method == ALL) == sums) {
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
