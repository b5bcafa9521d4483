//! The tolerances of a model, and the choices for each.

use super::tuning::TUNING;
use crate::model::{Cost, Description, Grade, Law, ParameterValue};
use crate::numerics::statistics::Distribution;

/// Choices for a tolerance, in multiples of the model's.
#[derive(Clone, Debug, PartialEq)]
pub enum Choice {
    /// It stays.
    Fixed,
    /// It is loosened together with all others.
    Together,
    /// Its cost at the model's value, inversely proportional to the multiple.
    Reciprocal(f64),
    /// One of these: multiple, cost and name, the cheapest first.
    Grades(Vec<(f64, f64, String)>),
}

/// An uncertain parameter.
#[derive(Clone, Debug)]
pub struct Item {
    pub name: String,
    pub unit: String,
    pub nominal: f64,
    pub above: f64,
    pub below: f64,
    pub choice: Choice,
    /// The largest multiple.
    pub widest: f64,
}

impl Item {
    /// The least multiple.
    pub fn tightest(&self) -> f64 {
        match &self.choice {
            Choice::Fixed => 1.0,
            Choice::Together | Choice::Reciprocal(_) => TUNING.tightest.min(self.widest),
            Choice::Grades(grades) => grades.iter().map(|grade| grade.0).fold(f64::INFINITY, f64::min),
        }
    }

    /// Cost of a multiple; `None` if no cost is known.
    pub fn cost(&self, multiple: f64) -> Option<f64> {
        match &self.choice {
            Choice::Fixed | Choice::Together => None,
            Choice::Reciprocal(cost) => Some(cost / multiple),
            // The loosest that is good enough.
            Choice::Grades(grades) => {
                let good = grades.iter().filter(|grade| grade.0 <= multiple * (1.0 + 1e-9));
                good.map(|grade| grade.1).min_by(f64::total_cmp)
            }
        }
    }

    /// The name of a grade.
    pub fn grade(&self, multiple: f64) -> Option<String> {
        let Choice::Grades(grades) = &self.choice else { return None };
        grades.iter().find(|grade| grade.0 == multiple).map(|grade| grade.2.clone())
    }

    /// The multiple whose tolerance has few digits, and is not looser.
    pub fn rounded(&self, multiple: f64) -> f64 {
        if !matches!(self.choice, Choice::Together | Choice::Reciprocal(_)) {
            return multiple;
        }
        let whole = self.above.max(self.below);
        let tolerance = whole * multiple;
        let digit = 10_f64.powi(symdiff::math::log10(tolerance).floor() as i32 + 1 - TUNING.digits);
        // A number of few digits is unchanged, but for rounding.
        ((tolerance / digit * (1.0 + 1e-12)).floor() * digit / whole).min(multiple)
    }
}

/// All uncertain parameters; those with a cost reach up to `widest` times their tolerances.
pub fn items(description: &Description, widest: f64) -> Vec<Item> {
    let statistics = &description.statistics;
    let priced = statistics.is_priced();
    let of = |parameter: &crate::model::Parameter| {
        let ParameterValue::Interval { nominal, lower, upper } = parameter.value else { return None };
        let (above, below) = (upper - nominal, nominal - lower);
        let law = statistics.law(&parameter.name, lower, upper);
        let choice = match statistics.cost(&parameter.name) {
            _ if !follows_tolerance(&law, nominal) => Choice::Fixed,
            Some(Cost::Fixed) => Choice::Fixed,
            Some(Cost::Reciprocal(cost)) => Choice::Reciprocal(*cost),
            Some(Cost::Grades(grades)) => Choice::Grades(useful(grades, 0.5 * (above + below))),
            None if priced => Choice::Fixed,
            None => Choice::Together,
        };
        let widest = match &choice {
            Choice::Fixed => 1.0,
            Choice::Together | Choice::Reciprocal(_) => widest,
            Choice::Grades(grades) => grades.iter().map(|grade| grade.0).fold(0.0, f64::max),
        };
        let (name, unit) = (parameter.name.clone(), parameter.unit.clone());
        Some(Item { name, unit, nominal, above, below, choice, widest })
    };
    description.parameters.iter().filter_map(of).collect()
}

/// Grades as multiples of a half width, the cheapest first, without those that cost no less than a tighter one.
fn useful(grades: &[Grade], half: f64) -> Vec<(f64, f64, String)> {
    let mut useful: Vec<(f64, f64, String)> = Vec::new();
    for grade in grades {
        // The tightest stands first.
        if useful.last().is_none_or(|last| grade.cost < last.1) {
            useful.push((grade.tolerance / half, grade.cost, grade.name.clone()));
        }
    }
    useful.reverse();
    useful
}

/// Whether a law is that of its tolerance, whatever that is.
fn follows_tolerance(law: &Law, nominal: f64) -> bool {
    match &law.distribution {
        Distribution::Uniform { .. } | Distribution::Beta { .. } => true,
        Distribution::Normal { .. } | Distribution::TruncatedNormal { .. } => law.by_tolerance,
        Distribution::Triangular { mode, .. } => *mode == nominal,
        Distribution::Table(_) | Distribution::Lognormal { .. } => false,
    }
}

/// The model with these multiples of its tolerances, and laws that follow.
pub fn with_tolerances(description: &Description, items: &[Item], multiples: &[f64]) -> Description {
    let ends =
        |item: &Item, multiple: f64| [item.nominal - multiple * item.below, item.nominal + multiple * item.above];
    let mut model = description.over(items.iter().zip(multiples).map(|(item, multiple)| ends(item, *multiple)));
    for (name, law) in &mut model.statistics.laws {
        if let Some(index) = items.iter().position(|item| item.name == *name) {
            scale(law, items[index].nominal, multiples[index]);
        }
    }
    model
}

/// Multiplies the distance of a law from the nominal value by `multiple`.
fn scale(law: &mut Law, nominal: f64, multiple: f64) {
    if multiple == 1.0 || !follows_tolerance(law, nominal) {
        return;
    }
    let move_to = |value: &mut f64| *value = nominal + multiple * (*value - nominal);
    match &mut law.distribution {
        Distribution::Uniform { lower, upper } | Distribution::Beta { lower, upper, .. } => {
            [lower, upper].into_iter().for_each(move_to);
        }
        Distribution::Triangular { lower, upper, .. } => [lower, upper].into_iter().for_each(move_to),
        Distribution::Normal { mean, sigma } => {
            move_to(mean);
            *sigma *= multiple;
        }
        Distribution::TruncatedNormal { mean, sigma, lower, upper } => {
            [mean, lower, upper].into_iter().for_each(move_to);
            *sigma *= multiple;
        }
        Distribution::Table(_) | Distribution::Lognormal { .. } => (),
    }
}
