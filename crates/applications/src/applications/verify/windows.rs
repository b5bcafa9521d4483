//! Parts of a run between the instants at which its equations switch.

use super::fit::Nominal;
use super::motion::{EquationsAtPoint, Manufactured};
use super::tuning::TUNING;

/// The parts between the instants at which conditions change their sign, without the first one; if none does, none,
/// or equal parts of the run if its begin has no smooth motion.
fn parts(nominal: &Nominal, equations: &mut EquationsAtPoint, begins: bool) -> Vec<[f64; 2]> {
    let signs: Vec<Vec<bool>> = (0..nominal.times.len()).map(|row| equations.conditions(nominal, row)).collect();
    let switches = (1..signs.len()).filter(|&row| signs[row] != signs[row - 1]);
    let last = nominal.times.len().saturating_sub(1);
    let mut ends: Vec<usize> = switches.chain([last]).collect();
    if ends.len() == 1 && !begins {
        ends = (1..=TUNING.parts_without_switch).map(|part| part * last / TUNING.parts_without_switch).collect();
    }
    let mut found: Vec<[usize; 2]> = ends.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    found.retain(|[first, end]| end - first >= TUNING.shortest_part);
    found.sort_by_key(|[first, end]| std::cmp::Reverse(end - first));
    let trimmed = |[first, end]: [usize; 2]| {
        let [first, end] = [nominal.times[first], nominal.times[end]];
        let margin = TUNING.margin * (end - first);
        [first + margin, end - margin]
    };
    found.into_iter().map(trimmed).collect()
}

/// A motion on a part after the time `reached`, after the last switch; `None` if there is no smooth one.
pub fn later(nominal: &Nominal, equations: &mut EquationsAtPoint, reached: f64) -> Option<Manufactured> {
    let parts = parts(nominal, equations, reached > 0.0)
        .into_iter()
        .filter(|[begin, _]| *begin >= reached)
        .take(TUNING.tried_parts);
    let mut motions =
        parts.filter_map(|part| Manufactured::near(nominal, equations, part, TUNING.halvings_of_part).ok());
    motions.next()
}
