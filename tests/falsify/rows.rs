//! Draws whose output has a known range in every row.

use std::fmt::{self, Display, Formatter};

use mbint::Model;

use crate::random::Random;
use crate::truth::Range;

/// A model, and the truth.
pub struct Drawn {
    pub yaml: String,
    pub output: &'static str,
    pub truth: Box<dyn Fn(f64) -> Range>,
    /// Allowance for rounding, and for the error of the truth.
    pub rounding: f64,
}

/// Counts over the draws.
#[derive(Default)]
pub struct Tally {
    pub draws: usize,
    pub rows: usize,
    pub flagged: usize,
    /// Rows without a flag that the truth contradicts.
    pub missed: usize,
    /// Sums over the rows without a flag: of true widths, of the parts of these outside of the bands, and of stated
    /// errors.
    width: f64,
    short: f64,
    stated: f64,
}

impl Display for Tally {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let Self { draws, rows, flagged, missed, width, short, stated } = self;
        let [short, stated] = [short, stated].map(|sum| 100.0 * sum / width);
        write!(
            f,
            "{draws} draws, {rows} rows: {flagged} are flagged, {missed} missed; bands are short of {short:.3} % of the width, and state {stated:.3} %"
        )
    }
}

/// Runs draws and compares every row.
pub fn compare(seed: u64, draws: u64, draw: impl Fn(&mut Random) -> Drawn) -> Tally {
    let mut tally = Tally::default();
    for number in 0..draws {
        let Drawn { yaml, output, truth, rounding } = draw(&mut Random::new(seed, number));
        let model = Model::from_yaml_str("drawn", &yaml).unwrap_or_else(|error| panic!("{error}\n{yaml}"));
        let result =
            model.study().allow_costly().run().unwrap_or_else(|error| panic!("draw {number}: {error}\n{yaml}"));
        tally.draws += 1;
        let output = result.outputs().find(|own| own.name() == output).expect("the output is asked for");
        let band = output.bands().next().unwrap();
        let before = tally.missed;
        for (row, &time) in result.times().iter().enumerate() {
            tally.rows += 1;
            if !band.is_reliable(row) {
                tally.flagged += 1;
                continue;
            }
            let (truth, allowed) = (truth(time), band.errors()[row] + rounding);
            let [below, above] = [band.lower()[row] - truth.lower, truth.upper - band.upper()[row]];
            tally.width += truth.upper - truth.lower;
            tally.short += below.max(0.0) + above.max(0.0);
            tally.stated += band.errors()[row];
            if below.abs().max(above.abs()) > allowed {
                tally.missed += 1;
                println!(
                    "# draw {number} at {time} s: [{}, {}] ± {allowed}, in truth [{}, {}]",
                    band.lower()[row],
                    band.upper()[row],
                    truth.lower,
                    truth.upper
                );
            }
        }
        if tally.missed > before {
            println!("{yaml}");
        }
    }
    tally
}
