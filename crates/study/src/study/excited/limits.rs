//! Limits of excitations as numbers: classes of functions, and functions in the excitation's own unit.

use symdiff::Formula;

use crate::grammar::Symbol;
use crate::grammar::formulas::evaluate;
use crate::model::{Class, Description, Excitation, ParameterValue};
use crate::numerics::{Cell, FunctionClass, Sample};

/// A model with values of its uncertain parameters.
pub struct Limits<'d> {
    description: &'d Description,
    /// Values of all parameters.
    values: Vec<f64>,
}

impl<'d> Limits<'d> {
    /// Limits for a sample.
    pub fn of(description: &'d Description, sample: &Sample) -> Self {
        let mut limits = Self { description, values: Vec::with_capacity(description.parameters.len()) };
        let mut uncertain = sample.iter();
        for parameter in &description.parameters {
            let value = match &parameter.value {
                ParameterValue::Interval { nominal, .. } => uncertain.next().copied().unwrap_or(*nominal),
                ParameterValue::Formula(formula) => limits.value(formula, f64::NAN),
            };
            limits.values.push(value);
        }
        limits
    }

    fn value(&self, formula: &Formula, time: f64) -> f64 {
        let value = evaluate(formula, |name| match self.description.symbol(name)? {
            Symbol::Parameter(index) => self.values.get(index).copied(),
            Symbol::Time => Some(time),
            _ => None,
        });
        value.unwrap_or(f64::NAN)
    }

    /// The functions that an excitation may be, over cells that end at these times, s.
    pub fn class(&self, excitation: &Excitation, ends: &[f64]) -> FunctionClass {
        let number = |formula: &Formula| self.value(formula, 0.0);
        match &excitation.class {
            Class::Bounded => FunctionClass::Bounded,
            Class::Held(period) => FunctionClass::Held(*period),
            Class::Rate => FunctionClass::Rate,
            Class::BoundedRate(ratio) => FunctionClass::BoundedRate(number(ratio)),
            Class::MovingRate(rate) => {
                let at = |time| [&excitation.middle, &excitation.reach].map(|formula| self.value(formula, time));
                let limits = std::iter::once(0.0).chain(ends.iter().copied()).map(at).collect();
                FunctionClass::Moving { limits, rate: number(rate) }
            }
            Class::Mean(mean) => FunctionClass::Mean(mean.each_ref().map(number)),
            Class::Energy { energy, is_bounded, .. } => {
                FunctionClass::Energy { energy: number(energy), bounded: *is_bounded }
            }
            Class::Band(band) => FunctionClass::Band(*band),
        }
    }

    /// The excitation's value at a time, s, in a cell of the function.
    pub fn value_at(&self, excitation: &Excitation, [level, slope]: Cell, time: f64) -> f64 {
        let [middle, reach] = [&excitation.middle, &excitation.reach].map(|formula| self.value(formula, time));
        middle + reach * (level + slope * time)
    }
}
