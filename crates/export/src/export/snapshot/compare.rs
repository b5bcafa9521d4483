//! Differences from a recorded snapshot.

use super::read::{ColumnKind, Curve, Output, Snapshot};
use crate::export::tuning::TUNING;

/// A curve that moved by more than the errors stated then and now, at the time of its largest change.
#[derive(Clone, Debug, PartialEq)]
pub struct Moved {
    /// E.g. `x3.chebyshev.upper`, or an output alone.
    pub what: String,
    /// SI unit, empty where dimensionless.
    pub unit: String,
    /// Time of its largest change, s; empty if the difference has no time.
    pub time: String,
    /// Recorded value.
    pub before: String,
    /// Present value.
    pub after: String,
    /// Allowed change there: the sum of both stated errors and of the rounding.
    pub allowed: Option<f64>,
    /// The number of times at which it moved, and of all times compared.
    pub times: Option<(usize, usize)>,
}

impl Moved {
    /// A difference without a time.
    fn whole(what: String, unit: &str, before: &str, after: &str) -> Self {
        let [before, after] = [before, after].map(str::to_owned);
        Self { what, unit: unit.to_owned(), time: String::new(), before, after, allowed: None, times: None }
    }
}

/// Differences from the record, in the order of the model's outputs; last the missing ones.
///
/// A bound may move by the sum of its stated errors, the nominal course by the smallest such sum of a method. An error
/// may double. Rounded values may differ in their last digit.
pub fn moved(before: &Snapshot, after: &Snapshot) -> Vec<Moved> {
    let mut found = Vec::new();
    for now in &after.outputs {
        match before.outputs.iter().find(|then| then.name == now.name) {
            Some(then) => of_output(then, now, &mut found),
            None => found.push(Moved::whole(now.name.clone(), &now.unit, "–", "new")),
        }
    }
    for then in &before.outputs {
        if !after.outputs.iter().any(|now| now.name == then.name) {
            found.push(Moved::whole(then.name.clone(), &then.unit, "recorded", "gone"));
        }
    }
    found
}

fn of_output(then: &Output, now: &Output, found: &mut Vec<Moved>) {
    let name = &now.name;
    if then.unit != now.unit {
        found.push(Moved::whole(format!("{name} (unit)"), "", &then.unit, &now.unit));
        return;
    }
    if then.times != now.times {
        found.push(Moved::whole(format!("{name} (times)"), "s", &ends(&then.times), &ends(&now.times)));
    }
    let shared: Vec<(usize, usize)> = (0..then.times.len())
        .filter_map(|row| Some((row, now.times.iter().position(|time| *time == then.times[row])?)))
        .collect();
    for curve in &now.curves {
        let what = || match curve.kind {
            ColumnKind::Nominal => format!("{name}.nominal"),
            kind => format!("{name}.{}.{}", curve.method, kind.name()),
        };
        match curve_of(then, &curve.method, curve.kind) {
            Some(_) => found.extend(of_curve(then, now, curve, &shared).map(|moved| Moved { what: what(), ..moved })),
            None => found.push(Moved::whole(what(), &now.unit, "–", "new")),
        }
    }
    for curve in &then.curves {
        if curve_of(now, &curve.method, curve.kind).is_none() {
            let what = format!("{name}.{}.{}", curve.method, curve.kind.name());
            found.push(Moved::whole(what, &now.unit, "recorded", "gone"));
        }
    }
}

/// The number of times, with the first and the last one.
fn ends(times: &[String]) -> String {
    match times {
        [] => "none".to_owned(),
        [only] => only.clone(),
        [first, .., last] => format!("{} times, {first} to {last}", times.len()),
    }
}

/// The largest change of a curve, relative to the allowance; `None` if it did not move. The field `what` stays empty.
fn of_curve(then: &Output, now: &Output, curve: &Curve, shared: &[(usize, usize)]) -> Option<Moved> {
    let earlier = curve_of(then, &curve.method, curve.kind)?;
    let mut worst: Option<(f64, Moved)> = None;
    let mut count = 0;
    for &(row_then, row_now) in shared {
        let (before, after) = (&earlier.cells[row_then], &curve.cells[row_now]);
        let allowed = match curve.kind {
            ColumnKind::Error => TUNING.grown_error * value(before) + finest(then, row_then),
            _ => {
                stated_error(then, curve, row_then)
                    + stated_error(now, curve, row_now)
                    + rounding(before)
                    + rounding(after)
            }
        };
        let distance = match curve.kind {
            ColumnKind::Error => value(after),
            _ => (value(after) - value(before)).abs(),
        };
        let is_same = before == after || value(before) == value(after);
        // An unknown number is infinitely far from a known one.
        let excess = if distance.is_nan() || allowed.is_nan() { f64::INFINITY } else { distance / allowed };
        if is_same || excess <= 1.0 + 1e-9 {
            continue;
        }
        count += 1;
        if worst.as_ref().is_none_or(|(other, _)| excess > *other) {
            let moved = Moved {
                time: now.times[row_now].clone(),
                allowed: Some(allowed).filter(|allowed| allowed.is_finite()),
                ..Moved::whole(String::new(), &now.unit, before, after)
            };
            worst = Some((excess, moved));
        }
    }
    worst.map(|(_, moved)| Moved { times: Some((count, shared.len())), ..moved })
}

/// The curve of a method and kind.
fn curve_of<'o>(output: &'o Output, method: &str, kind: ColumnKind) -> Option<&'o Curve> {
    output.curves.iter().find(|curve| curve.method == method && curve.kind == kind)
}

/// The stated error of a bound in a row; for the nominal course, which has none, the smallest of a method. 0 if
/// unknown.
fn stated_error(output: &Output, curve: &Curve, row: usize) -> f64 {
    let errors = output.curves.iter().filter(|other| other.kind == ColumnKind::Error);
    let errors = errors.filter(|other| curve.kind == ColumnKind::Nominal || other.method == curve.method);
    // Proven bounds have error 0, which the simulated nominal course cannot meet.
    let known = errors.map(|error| value(&error.cells[row])).filter(|error| *error > 0.0 && error.is_finite());
    known.reduce(f64::min).unwrap_or(0.0)
}

/// The last digit shown of an output's bounds in a row.
fn finest(output: &Output, row: usize) -> f64 {
    let known =
        output.curves.iter().filter(|curve| curve.kind != ColumnKind::Error).map(|curve| rounding(&curve.cells[row]));
    2.0 * known.fold(0.0, f64::max)
}

/// A number that was checked while reading.
fn value(cell: &str) -> f64 {
    cell.parse().unwrap_or(f64::NAN)
}

/// Half of the last digit of a number with a decimal point, or 0.
fn rounding(cell: &str) -> f64 {
    let decimals = cell.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    0.5 * format!("1e-{decimals}").parse::<f64>().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::super::snapshot_table;
    use super::super::table::tests::bounds;
    use super::*;
    use crate::results::Bounds;

    fn snapshot(bounds: &Bounds) -> Snapshot {
        Snapshot::read(&snapshot_table(bounds)).unwrap()
    }

    fn names(found: &[Moved]) -> Vec<&str> {
        found.iter().map(|moved| moved.what.as_str()).collect()
    }

    #[test]
    fn bounds_may_move_by_both_errors() {
        let before = snapshot(&bounds(&[1.0, 2.0, 1.5], 0.5, 1e-2));
        let after = |shift: f64| snapshot(&bounds(&[1.0 + shift, 2.0, 1.5 + 2.0 * shift], 0.5, 1e-2));
        assert_eq!(moved(&before, &before), []);
        assert_eq!(moved(&before, &after(0.009)), []);
        let found = moved(&before, &after(0.02));
        assert_eq!(names(&found), ["x.nominal", "x.scan.lower", "x.scan.upper"]);
        let upper = &found[2];
        assert_eq!((upper.time.as_str(), upper.before.as_str(), upper.after.as_str()), ("0.2000", "1.7500", "1.7900"));
        assert_eq!((upper.unit.as_str(), upper.times), ("m", Some((1, 3))));
        assert!((upper.allowed.unwrap() - 0.0201).abs() < 1e-12, "{upper:?}");
    }

    #[test]
    fn grown_error_counts_as_a_change() {
        let [before, doubled, grown] = [1e-2, 2e-2, 3e-2].map(|error| snapshot(&bounds(&[1.0, 2.0], 0.5, error)));
        assert_eq!(moved(&before, &doubled), []);
        assert_eq!(names(&moved(&before, &grown)), ["x.scan.error"]);
        let [none, rounding] = [0.0, 1e-14].map(|error| snapshot(&bounds(&[1.0, 2.0], 0.5, error)));
        assert_eq!(moved(&none, &rounding), []);
        assert_eq!(names(&moved(&none, &before)), ["x.scan.error"]);
    }

    #[test]
    fn new_removed_and_unknown_outputs_count_as_changes() {
        let before = bounds(&[1.0, 2.0], 0.5, 1e-2);
        let mut renamed = before.clone();
        renamed.outputs[0].name = "y".into();
        let found = moved(&snapshot(&before), &snapshot(&renamed));
        assert_eq!(names(&found), ["y", "x"]);
        assert_eq!((found[0].after.as_str(), found[1].after.as_str()), ("new", "gone"));
        let mut certain = before.clone();
        certain.outputs[0].bands.clear();
        assert_eq!(moved(&snapshot(&before), &snapshot(&certain)).len(), 3);
        let mut other = before.clone();
        other.outputs[0].unit = "mm".into();
        assert_eq!(names(&moved(&snapshot(&before), &snapshot(&other))), ["x (unit)"]);
        let ended = bounds(&[1.0, f64::NAN], 0.5, 1e-2);
        assert_eq!(moved(&snapshot(&before), &snapshot(&ended)).len(), 3);
        assert_eq!(moved(&snapshot(&ended), &snapshot(&ended)), []);
        let longer = bounds(&[1.0, 2.0, 3.0], 0.5, 1e-2);
        assert_eq!(names(&moved(&snapshot(&before), &snapshot(&longer))), ["x (times)"]);
    }
}
