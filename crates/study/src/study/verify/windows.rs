//! Parts of a run between the instants at which its equations switch.

use super::fit::Nominal;
use super::motion::{Equations, Manufactured};

/// Share of a part that is left out at both ends: the manufactured motion is near the nominal one, and switches at
/// other instants.
const MARGIN: f64 = 0.1;

/// Parts that are tried, the longest first.
const TRIED: usize = 6;

/// Parts of a run where no condition is seen to switch: friction at rest is steep in some only.
const PARTS: usize = 8;

/// Shortest part, in rows of the nominal motion.
const ROWS: usize = 16;

/// Halvings of a later part.
const HALVINGS: usize = 3;

/// The parts between the instants at which conditions change their sign, without the first one; where none does, none,
/// or equal parts of the run where its begin has no smooth motion.
fn parts(nominal: &Nominal, equations: &mut Equations, begins: bool) -> Vec<[f64; 2]> {
    let signs: Vec<Vec<bool>> = (0..nominal.times.len()).map(|row| equations.conditions(nominal, row)).collect();
    let switches = (1..signs.len()).filter(|&row| signs[row] != signs[row - 1]);
    let last = nominal.times.len().saturating_sub(1);
    let mut ends: Vec<usize> = switches.chain([last]).collect();
    if ends.len() == 1 && !begins {
        ends = (1..=PARTS).map(|part| part * last / PARTS).collect();
    }
    let mut found: Vec<[usize; 2]> = ends.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    found.retain(|[first, end]| end - first >= ROWS);
    found.sort_by_key(|[first, end]| std::cmp::Reverse(end - first));
    let trimmed = |[first, end]: [usize; 2]| {
        let [first, end] = [nominal.times[first], nominal.times[end]];
        let margin = MARGIN * (end - first);
        [first + margin, end - margin]
    };
    found.into_iter().map(trimmed).collect()
}

/// A motion on a part after the time `reached`, behind what switches; `None` where there is no smooth one.
pub fn later(nominal: &Nominal, equations: &mut Equations, reached: f64) -> Option<Manufactured> {
    let parts = parts(nominal, equations, reached > 0.0).into_iter().filter(|[begin, _]| *begin >= reached).take(TRIED);
    let mut motions = parts.filter_map(|part| Manufactured::near(nominal, equations, part, HALVINGS).ok());
    motions.next()
}
