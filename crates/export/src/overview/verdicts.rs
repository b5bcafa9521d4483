//! Reduced outputs and requirements of a run.

use super::table::{Align, Table};
use super::words::short;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{NearestCase, ReducedBand, ReducedSummary, RequirementSummary, Summary, Verdict, foremost};

/// A reduced output's foremost band.
pub fn band(reduced: &ReducedSummary) -> Option<&ReducedBand> {
    foremost(&reduced.bands, |band: &ReducedBand| !band.unresolved)
}

/// Both tables; empty if there is nothing to show.
pub fn tables(summary: &Summary) -> String {
    let mut text = String::new();
    if !summary.reduced.is_empty() {
        text += &format!("{}\n", reduced(&summary.reduced));
    }
    if !summary.requirements.is_empty() {
        text += &format!("{}\n{}", requirements(&summary.requirements), notes(&summary.requirements));
    }
    text
}

fn reduced(all: &[ReducedSummary]) -> String {
    let mut table = Table::new([
        ("reduced output", Align::Left),
        ("nominal", Align::Right),
        ("from", Align::Right),
        ("to", Align::Right),
        ("error", Align::Right),
        ("unit", Align::Left),
        ("tolerances that matter", Align::Left),
    ]);
    for own in all {
        let unit = ShownUnit::of(&own.display, &own.unit);
        let shown = |value: f64| unit.of_si(value);
        let numbers = match band(own) {
            Some(band) => [short(shown(band.lower)), short(shown(band.upper)), format!("{:.1e}", shown(band.error))],
            None => [(); 3].map(|()| "unknown".to_owned()),
        };
        let [lower, upper, error] = numbers;
        let several = own.contributions.len() > 1;
        let shares = own.contributions.iter().filter(|own| several && own.total >= 0.005).take(3);
        let mut notes: Vec<String> =
            shares.map(|own| format!("{} {:.0} %", own.parameter, 100.0 * own.total)).collect();
        if let Some(occurs) = &own.occurs {
            notes.push(format!("occurs in {} of {} samples", occurs.samples, occurs.of));
            notes.extend(occurs.share.map(of_box));
            let is_bounded = band(own).is_some_and(|band| !band.unresolved);
            let ends = own
                .worst
                .as_ref()
                .filter(|_| !is_bounded)
                .map(|ends| ends.each_ref().map(|end| short(shown(end.value))));
            notes.extend(ends.map(|[least, greatest]| format!("in these {least} to {greatest}")));
        } else if band(own).is_some_and(|band| band.unresolved) {
            notes.push("unreliable".to_owned());
        }
        let unit = unit.text.to_owned();
        table.row([own.name.clone(), short(shown(own.nominal)), lower, upper, error, unit, notes.join(", ")]);
    }
    table.render(2)
}

/// A share of the box, as its least and largest value.
fn of_box(share: [f64; 2]) -> String {
    let [least, most] = share.map(|share| format!("{:.1}", 100.0 * share));
    if least == most { format!("{least} % of the box") } else { format!("{least} to {most} % of the box") }
}

/// Verdicts with margins and errors.
pub fn requirements(all: &[RequirementSummary]) -> String {
    let mut table = Table::new([
        ("requirement", Align::Left),
        ("", Align::Left),
        ("verdict", Align::Left),
        ("margin", Align::Right),
        ("error", Align::Right),
        ("unit", Align::Left),
        ("", Align::Right),
    ]);
    for own in all {
        let certified = if own.certified { ", certified" } else { "" };
        let unit = ShownUnit::of(&own.display, &own.unit);
        let percent = own.percent.filter(|percent| percent.is_finite());
        table.row([
            own.name.clone(),
            own.text.clone(),
            format!("{}{certified}", own.verdict.name()),
            short(unit.of_si(own.margin)),
            if own.error.is_nan() { "unknown".to_owned() } else { format!("{:.1e}", unit.of_si(own.error)) },
            unit.text.to_owned(),
            percent.map_or_else(String::new, |percent| format!("{percent:.2} %")),
        ]);
    }
    table.render(2)
}

/// Proofs of violated requirements, and means that would decide the undecided ones.
fn notes(all: &[RequirementSummary]) -> String {
    let mut text = String::new();
    for own in all {
        let nearest = own.nearest.as_ref();
        match own.verdict {
            Verdict::Holds => (),
            Verdict::Violated => {
                let unit = ShownUnit::of(&own.display, &own.unit);
                let by = |margin: f64| format!("by {} {}", short(-unit.of_si(margin)), unit.text).trim_end().to_owned();
                let fails = |nearest: &&NearestCase| nearest.margin.is_nan() || nearest.margin < 0.0;
                let Some(nearest) = nearest.filter(fails) else {
                    text += &format!(
                        "  {} is violated, {}, under functions of excitations: see its witness\n",
                        own.name,
                        by(own.margin)
                    );
                    continue;
                };
                let time = nearest.time.map_or_else(String::new, |time| format!(" at {} s", short(time)));
                let command =
                    if nearest.command.is_empty() { nearest.settings.join(", ") } else { nearest.command.clone() };
                let margin = match nearest.margin.is_nan() {
                    true => "has no value".to_owned(),
                    false => by(nearest.margin),
                };
                text += &format!("  {} is violated{time}, {margin}: {command}\n", own.name);
            }
            Verdict::Undecided => {
                let decides = own.decides.as_deref().unwrap_or_default();
                text += &format!("  {} is undecided; it takes {decides}\n", own.name);
            }
        }
    }
    if text.is_empty() { text } else { text + "\n" }
}
