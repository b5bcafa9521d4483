//! The page of a verification: verdict, orders with their errors, derivatives, and the balance of power.

use std::path::Path;

use super::error::ExportError;
use super::report::{Section, plain_page};
use super::rounded::{rounded, significant};
use super::tuning::TUNING;
use crate::results::{FormulationVerification, PowerBalance, Verification};

/// Writes the page.
///
/// # Errors
/// If the file cannot be written.
pub fn write_verification(path: &Path, found: &Verification) -> Result<(), ExportError> {
    std::fs::write(path, page(found)).map_err(|source| ExportError::Write { path: path.to_owned(), source })
}

fn page(found: &Verification) -> String {
    let verdict = if found.is_verified() { "Verified" } else { "Not verified" };
    let means = "a motion that is exact because its loads are added is integrated with shorter and shorter steps, \
                 derivatives are compared with differences of 32 digits, and powers are balanced.";
    let mut sections = vec![Section::Text(format!("{verdict}: {means}"))];
    sections.extend(found.formulations.iter().flat_map(formulation));
    plain_page(&format!("{}: verification", found.model), &sections)
}

fn number(value: f64) -> String {
    rounded(significant(value, TUNING.digits_of_verification))
}

fn headings<const N: usize>(names: [&str; N]) -> Vec<String> {
    names.map(str::to_owned).to_vec()
}

fn formulation(own: &FormulationVerification) -> Vec<Section> {
    let names = |names: &[String], what: &str| match names {
        [] => String::new(),
        names => format!(" {what}: {}.", names.join(", ")),
    };
    let mut text = format!(
        "In {} coordinates: {} coordinates, {} constraints.{}{}",
        own.formulation,
        own.coordinates,
        own.constraints,
        names(&own.redundant, "Redundant"),
        names(&own.singular_at_start, "Singular at the start")
    );
    if let Some(why) = &own.failure {
        text += &format!(" Not verified: {why}.");
        return vec![Section::Text(text)];
    }
    text += &format!(" The motion is of {} s from t = {} s on.", number(own.duration), number(own.begin));
    let mut sections = vec![Section::Text(text), orders(own), derivatives(own)];
    sections.extend(own.balance.iter().flat_map(balance));
    sections
}

fn orders(own: &FormulationVerification) -> Section {
    let mut rows = Vec::new();
    for scheme in &own.schemes {
        for found in &scheme.convergence {
            let errors = found.errors.iter().map(|(step, error)| format!("{} ({} s)", number(*error), number(*step)));
            rows.push(vec![
                scheme.scheme.clone(),
                found.quantity.name().to_owned(),
                found.shown_order(),
                number(found.theory),
                if found.is_verified { "as in theory" } else { "not as in theory" }.to_owned(),
                errors.collect::<Vec<_>>().join(", "),
            ]);
        }
        if let Some(why) = &scheme.failure {
            let none = String::new;
            rows.push(vec![scheme.scheme.clone(), none(), none(), none(), "not verified".to_owned(), why.clone()]);
        }
    }
    Section::Table("Orders", headings(["scheme", "of", "order", "theory", "verdict", "errors (step)"]), rows)
}

fn derivatives(own: &FormulationVerification) -> Section {
    let rows = own.derivatives.iter().map(|check| {
        let verdict = if check.is_verified() { "exact to rounding" } else { "not the derivative" };
        vec![
            check.of.clone(),
            check.by.clone(),
            check.derivatives.to_string(),
            number(check.difference),
            verdict.to_owned(),
        ]
    });
    Section::Table("Derivatives", headings(["of", "by", "number", "largest difference", "verdict"]), rows.collect())
}

fn balance(balance: &PowerBalance) -> Vec<Section> {
    let verdict = if balance.is_verified() { "balanced" } else { "not balanced" };
    let text = format!("Power is {verdict} to {} of {} W.", number(balance.defect), number(balance.size));
    let rows = balance.effects.iter().map(|effect| {
        let energy = effect.exchange().name().to_owned();
        let powers = [effect.power, effect.put_in, effect.taken].map(number);
        [vec![effect.effect.clone(), effect.kind.clone(), energy], powers.to_vec()].concat()
    });
    let table = Section::Table(
        "Power",
        headings(["effect", "kind", "energy", "power, W", "puts in, W", "takes, W"]),
        rows.collect(),
    );
    vec![Section::Text(text), table]
}
