//! Certified bands of drawn mechanisms: whatever motion the truth attains lies within.

use std::fmt;
use std::time::{Duration, Instant};

use mbint::Model;

use crate::draw::Draw;
use crate::{families, truth};

/// Longest time that a proof is waited for. Of the gate's 52 draws, five take longer, and are compared in the rows
/// that are proven by then.
const PATIENCE: Duration = Duration::from_secs(5);

/// Rounding of the truth, relative to the size of the coordinates and to the output's own.
const ROUNDING: f64 = 1e-11;

/// Counts over the draws.
#[derive(Default)]
pub struct Tally {
    pub draws: usize,
    /// Draws with a proven row.
    pub proven: usize,
    pub rows: usize,
    pub known: usize,
    /// Rows that exclude values that occur.
    pub missed: usize,
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { draws, proven, rows, known, missed } = self;
        write!(f, "{draws} draws, {proven} of them proven: {known} of {rows} rows known, {missed} missed")
    }
}

/// Draws of a seed with at most three parameters.
pub fn compare(seed: u64, draws: u64) -> Tally {
    let mut tally = Tally::default();
    let drawn = (0..draws).map(|number| (number, families::draw(seed, number, None)));
    for (number, draw) in drawn.filter(|(_, draw)| (1..=3).contains(&draw.uncertain_count())) {
        one(number, &draw, &mut tally);
    }
    tally
}

fn one(number: u64, draw: &Draw, tally: &mut Tally) {
    tally.draws += 1;
    let begun = Instant::now();
    let late = move || begun.elapsed() > PATIENCE;
    let study = |model: Model| model.study().allow_costly().certified().interrupted(&late).run();
    // Draws that cannot be proven are refused, which is no miss.
    let Ok(result) = Model::from_yaml_str("draw", &draw.yaml()).and_then(study) else { return };
    let truth = truth::ranges(draw, result.times(), 0);
    let mut is_proven = false;
    for (index, output) in result.outputs().enumerate() {
        let Some(band) = output.bands().find(|band| band.method().name() == "certified") else { continue };
        let inputs = draw.outputs[index].inputs.iter();
        let coordinates: f64 = inputs.map(|&(term, _)| draw.terms[term].size).sum();
        let size = truth[index].iter().fold(coordinates, |size, range| size.max(range.upper.abs()));
        for (row, truth) in truth[index].iter().enumerate() {
            let (lower, upper) = (band.lower()[row], band.upper()[row]);
            tally.rows += 1;
            if lower.is_nan() {
                continue;
            }
            (is_proven, tally.known) = (true, tally.known + 1);
            if lower > truth.lower + ROUNDING * size || upper < truth.upper - ROUNDING * size {
                tally.missed += 1;
                println!(
                    "# draw {number}, {}: [{lower}, {upper}] and {truth:?} in row {row}\n{}",
                    draw.family,
                    draw.yaml()
                );
            }
        }
    }
    tally.proven += usize::from(is_proven);
}
