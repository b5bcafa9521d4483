//! The page of a design.

use super::{criterion, piece, points, shown};
use crate::export::allocation::shown_unit;
use crate::export::report::{Section, plain_page};
use crate::export::rounded::{rounded, shown as shown_in, significant};
use crate::export::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{Allocation, DesignPoint, DesignStudy, DesignTrade, ToleranceZone};

/// The page with these figures.
pub(super) fn page(design: &DesignStudy, figures: Vec<String>) -> String {
    let mut sections = vec![Section::Text(format!(
        "Objective: {}, for {}. Every figure is that of a study at the point.",
        design.objective.text,
        criterion(design)
    ))];
    sections.push(all(design));
    let value = if design.is_priced() { "cost" } else { "worst case" };
    if let Some(gain) = design.gain().filter(|gain| gain.abs() >= TUNING.shown_gain) {
        sections.push(Section::Text(format!(
            "At the optimum without tolerances the {value} is {}; at the optimum with tolerances it is {} % {}.",
            design.nominal_point.as_ref().map_or_else(String::new, |point| objective(design, point.worst)),
            rounded(significant(100.0 * gain.abs(), 3)),
            match (design.is_priced(), gain < 0.0) {
                (true, true) => "more",
                (true, false) => "less",
                (false, true) => "worse",
                (false, false) => "better",
            }
        )));
    }
    sections.push(ranges(design));
    sections.extend(design.best().map(requirements));
    for own in &design.not_met {
        let unit = ShownUnit::of(&own.display, &own.unit);
        sections.push(Section::Text(format!(
            "No values within the ranges meet {}: the nearest miss it by {}.",
            own.requirement,
            shown_in(unit, -own.margin)
        )));
    }
    sections.extend(design.allocation.as_ref().map(allocated));
    if !design.front.is_empty() {
        sections.push(front(design));
    }
    sections.extend(figures.into_iter().map(Section::Figure));
    plain_page(&format!("{}: design", design.model), &sections)
}

/// The objective's value; a margin in percent.
fn objective(design: &DesignStudy, value: f64) -> String {
    if design.objective.text == "margin" {
        return format!("{} %", rounded(significant(100.0 * value, 5)));
    }
    shown_in(ShownUnit::of(&design.objective.display, &design.objective.unit), value)
}

fn all(design: &DesignStudy) -> Section {
    let mut headings = vec!["point".to_owned()];
    headings.extend(design.parameters.iter().map(|own| own.name.clone()));
    let figures: &[&str] = if design.is_priced() { &["cost"] } else { &["nominal", "worst case", "error"] };
    headings.extend(figures.iter().chain(&["requirements"]).map(|&own| own.to_owned()));
    let row = |(name, point): (String, &DesignPoint)| {
        let mut cells = vec![name];
        cells.extend(point.values.iter().enumerate().map(|(index, value)| shown(design, index, *value)));
        let values = [point.nominal, point.worst, significant(point.error, 2)].map(|value| objective(design, value));
        match design.is_priced() {
            true => cells.push(rounded(significant(point.worst, 5))),
            false => cells.extend(values),
        }
        cells.push(if point.is_feasible { "hold" } else { "not met" }.to_owned());
        cells
    };
    Section::Table("Points", headings, points(design).map(row).collect())
}

fn ranges(design: &DesignStudy) -> Section {
    let row = |index: usize| {
        let own = &design.parameters[index];
        let interval =
            |[lower, upper]: [f64; 2]| format!("{} to {}", shown(design, index, lower), shown(design, index, upper));
        let best = design.best();
        let at_limit = best.is_some_and(|best| best.at_limits.contains(&own.name));
        vec![
            own.name.clone(),
            interval(own.range),
            interval(own.searched),
            best.map_or_else(String::new, |best| piece(design, best, index)),
            if at_limit { "at an end of the range" } else { "" }.to_owned(),
        ]
    };
    let headings = ["parameter", "range", "searched", "best, with its tolerance", ""].map(str::to_owned).to_vec();
    Section::Table("Parameters", headings, (0..design.parameters.len()).map(row).collect())
}

fn requirements(best: &DesignPoint) -> Section {
    let row = |own: &crate::results::RequirementSummary| {
        let unit = ShownUnit::of(&own.display, &own.unit);
        let margin = shown_in(unit, own.margin);
        let error = shown_in(unit, significant(own.error, 2));
        vec![own.name.clone(), own.text.clone(), own.verdict.name().to_owned(), margin, error]
    };
    let headings = ["requirement", "", "verdict", "margin", "error"].map(str::to_owned).to_vec();
    Section::Table("Requirements at the optimum", headings, best.requirements.iter().map(row).collect())
}

/// Tolerances, grades and costs at the optimum, before and after the allocation.
fn allocated(allocation: &Allocation) -> Section {
    let row = |own: &crate::results::AllocatedTolerance| {
        let (scale, unit) = shown_unit(own);
        let zone = |zone: ToleranceZone| deviations(zone, scale, unit);
        let cost = |cost: Option<f64>| cost.map_or_else(String::new, |cost| rounded(significant(cost, 4)));
        let grade = own.grade.clone().unwrap_or_default();
        vec![
            own.parameter.clone(),
            zone(own.before),
            zone(own.after),
            grade,
            cost(own.cost_before),
            cost(own.cost_after),
        ]
    };
    let headings = ["parameter", "tolerance", "cheapest", "grade", "cost", "then"].map(str::to_owned).to_vec();
    Section::Table("Tolerances at the optimum", headings, allocation.tolerances.iter().map(row).collect())
}

/// Deviations in a unit; one SI unit is `scale` of these.
fn deviations(zone: ToleranceZone, scale: f64, unit: &str) -> String {
    let [above, below] = [zone.above, zone.below].map(|side| rounded(significant(scale * side, 4)));
    let both = if above == below { format!("± {above}") } else { format!("+{above} -{below}") };
    format!("{both} {unit}").trim_end().to_owned()
}

/// A row for each margin: the cheapest nominal values and tolerances that leave it.
fn front(design: &DesignStudy) -> Section {
    let changed = || design.front[0].tolerances.iter().filter(|own| own.is_free);
    let mut headings = vec!["margin".to_owned(), "cost".to_owned()];
    headings.extend(design.parameters.iter().map(|own| own.name.clone()));
    headings.extend(changed().map(|own| format!("{} ±", own.parameter)));
    let row = |own: &DesignTrade| {
        let mut cells =
            vec![format!("{} %", rounded(significant(100.0 * own.margin, 4))), rounded(significant(own.cost, 5))];
        cells.extend(own.values.iter().enumerate().map(|(index, value)| shown(design, index, *value)));
        cells.extend(own.tolerances.iter().filter(|own| own.is_free).map(|own| {
            let (scale, unit) = shown_unit(own);
            let grade = own.grade.as_ref().map_or_else(String::new, |grade| format!(" ({grade})"));
            deviations(own.after, scale, unit) + &grade
        }));
        cells
    };
    Section::Table("Cost against margin", headings, design.front.iter().map(row).collect())
}
