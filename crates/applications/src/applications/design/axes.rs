//! Parameters that are free or uncertain, and the models and samples with chosen nominal values.

use super::tuning::TUNING;
use super::width::Width;
use crate::applications::allocate::items;
use crate::grammar::display_unit::DisplayUnit;
use crate::methods::Chebyshev;
use crate::model::{Description, Free, Law, ParameterValue};
use crate::numerics::statistics::Distribution;
use crate::results::AllocatedTolerance;
use crate::study::statistics;
use symdiff::Formula;

/// A parameter that is free or uncertain.
#[derive(Clone, Debug)]
struct Axis {
    name: String,
    /// As the model has it.
    nominal: f64,
    /// Deviations upwards and downwards there.
    deviations: [f64; 2],
    /// If it is free: its number among the free ones, and whether deviations are shares of the nominal value.
    free: Option<(usize, [bool; 2])>,
    /// If the tolerance is chosen: the index of its multiple in a point.
    width: Option<usize>,
}

/// All of them, in the model's order; a point has a nominal value for each free one, then a multiple for each tolerance
/// that is chosen.
#[derive(Clone, Debug)]
pub struct Axes {
    all: Vec<Axis>,
    /// The free axes: names, and ends of their ranges.
    pub free: Vec<Free>,
    /// Tolerances that are chosen.
    pub widths: Vec<Width>,
    /// The units in which people see these, SI.
    shown: Vec<f64>,
}

impl Axis {
    /// The factor of the deviations at a point.
    fn scales(&self, point: &[f64]) -> [f64; 2] {
        let relative = self.free.map_or([false; 2], |(_, relative)| relative);
        let multiple = self.width.map_or(1.0, |index| point[index]);
        let share = (self.nominal(point) / self.nominal).abs();
        relative.map(|is_share| multiple * if is_share && self.nominal != 0.0 { share } else { 1.0 })
    }

    /// Least and largest value.
    fn ends(&self, point: &[f64]) -> [f64; 2] {
        let (nominal, [above, below]) = (self.nominal(point), self.scales(point));
        [nominal - below * self.deviations[1], nominal + above * self.deviations[0]]
    }

    fn nominal(&self, point: &[f64]) -> f64 {
        self.free.map_or(self.nominal, |(number, _)| point[number])
    }

    fn is_uncertain(&self) -> bool {
        self.deviations.iter().any(|side| *side > 0.0)
    }
}

impl Axes {
    /// Axes of a model.
    pub fn of(description: &Description, free: &[Free]) -> Self {
        let axis = |parameter: &crate::model::Parameter| {
            let number = free.iter().position(|own| own.name == parameter.name);
            let (nominal, deviations) = match &parameter.value {
                ParameterValue::Interval { nominal, lower, upper } => (*nominal, [upper - nominal, nominal - lower]),
                ParameterValue::Formula(formula) => (formula.as_number().filter(|_| number.is_some())?, [0.0; 2]),
            };
            let free = number.map(|number| (number, free[number].relative));
            Some(Axis { name: parameter.name.clone(), nominal, deviations, free, width: None })
        };
        let shown = free.iter().map(|own| description.parameter_units.get(&own.name).map_or(1.0, DisplayUnit::si));
        let shown = shown.collect();
        let all = description.parameters.iter().filter_map(axis).collect();
        Self { all, free: free.to_vec(), widths: Vec::new(), shown }
    }

    /// The same, with chosen tolerances that have a cost: up to `widest` times the model's.
    pub fn priced(description: &Description, free: &[Free], widest: f64) -> Self {
        let mut axes = Self::of(description, free);
        for item in items(description, widest) {
            let Some(width) = Width::of(&item) else { continue };
            let index = axes.free.len() + axes.widths.len();
            axes.all.iter_mut().filter(|axis| axis.name == item.name).for_each(|axis| axis.width = Some(index));
            axes.widths.push(width);
        }
        axes
    }

    /// Nominal values with the model's own tolerances, as near as the multiples may be.
    pub fn with_widths(&self, nominal: &[f64]) -> Vec<f64> {
        let present = self.widths.iter().map(|width| 1.0_f64.clamp(width.ends[0], width.ends[1]));
        nominal[..self.free.len()].iter().copied().chain(present).collect()
    }

    /// Nominal values of a point with the model's own tolerances.
    pub fn with_present(&self, point: &[f64]) -> Vec<f64> {
        point[..self.free.len()].iter().copied().chain(self.widths.iter().map(|_| 1.0)).collect()
    }

    /// Nominal values of a point with tolerances that were allocated there, of all uncertain parameters in order.
    pub fn with_tolerances(&self, point: &[f64], tolerances: &[AllocatedTolerance]) -> Vec<f64> {
        let mut point = self.with_present(point);
        for (axis, own) in self.all.iter().filter(|axis| axis.is_uncertain()).zip(tolerances) {
            let [before, after] = [own.before, own.after].map(|zone| zone.above.max(zone.below));
            if let Some(index) = axis.width {
                point[index] = after / before;
            }
        }
        point
    }

    /// Cost of the tolerances at a point, interpolated between grades.
    pub fn cost(&self, point: &[f64]) -> f64 {
        self.widths.iter().zip(&point[self.free.len()..]).map(|(width, multiple)| width.cost(*multiple)).sum()
    }

    /// The cost by the model's own grades.
    pub fn price(&self, point: &[f64]) -> f64 {
        self.widths.iter().zip(&point[self.free.len()..]).map(|(width, multiple)| width.price(*multiple)).sum()
    }

    /// A coordinate moved by a share of its range: nominal values by lengths, multiples by factors.
    pub fn moved_by(&self, axis: usize, value: f64, share: f64, [lower, upper]: [f64; 2]) -> f64 {
        let moved = match axis < self.free.len() {
            true => value + share * (upper - lower),
            false => value * symdiff::math::pow(upper / lower, share),
        };
        moved.clamp(lower, upper)
    }

    /// Number of uncertain parameters.
    pub fn uncertain(&self) -> usize {
        self.all.iter().filter(|axis| axis.is_uncertain()).count()
    }

    /// The model's own nominal values, as near as the ranges allow.
    pub fn start(&self) -> Vec<f64> {
        let own = |number: usize| {
            let axis = self.all.iter().find(|axis| axis.free.is_some_and(|(own, _)| own == number));
            let Free { lower, upper, .. } = self.free[number];
            axis.map_or(0.5 * (lower + upper), |axis| axis.nominal.clamp(lower, upper))
        };
        self.with_widths(&(0..self.free.len()).map(own).collect::<Vec<f64>>())
    }

    /// The model's own nominal values, wherever they are.
    pub fn present(&self) -> Vec<f64> {
        let own = |number: usize| self.all.iter().find(|axis| axis.free.is_some_and(|(own, _)| own == number));
        let nominal = (0..self.free.len()).map(|number| own(number).map_or(f64::NAN, |axis| axis.nominal));
        nominal.chain(self.widths.iter().map(|_| 1.0)).collect()
    }

    /// Ends of all ranges.
    pub fn ranges(&self) -> Vec<[f64; 2]> {
        let nominal = self.free.iter().map(|own| [own.lower, own.upper]);
        nominal.chain(self.widths.iter().map(|own| own.ends)).collect()
    }

    /// Points with few digits about one: both neighbours along each axis, of the first few.
    pub fn rounded(&self, point: &[f64]) -> Vec<Vec<f64>> {
        let mut all = vec![point.to_vec()];
        for (axis, own) in self.free.iter().enumerate() {
            let width = (own.upper - own.lower) / self.shown[axis];
            let digits = TUNING.digits - symdiff::math::log10(width).floor() as i32;
            let unit = 10_f64.powi(digits.clamp(-300, 300)) / self.shown[axis];
            let near = |value: f64| (value / unit).clamp(own.lower, own.upper);
            let value = point[axis] * unit;
            let choices = if axis < TUNING.rounded_parameters {
                vec![near(value.floor()), near(value.ceil())]
            } else {
                vec![near(value.round())]
            };
            let with = |choice: &f64, point: &Vec<f64>| {
                let mut point = point.clone();
                point[axis] = *choice;
                point
            };
            all = choices.iter().flat_map(|choice| all.iter().map(move |point| with(choice, point))).collect();
        }
        all
    }

    /// Deviations upwards and downwards of the free parameters about a point.
    pub fn deviations(&self, point: &[f64]) -> Vec<[f64; 2]> {
        let mut found = vec![[0.0; 2]; self.free.len()];
        for axis in &self.all {
            if let Some((number, _)) = axis.free {
                let scales = axis.scales(point);
                found[number] = [0, 1].map(|side| scales[side] * axis.deviations[side]);
            }
        }
        found
    }

    /// The sample at ξ ∈ [−1, 1] of the uncertain parameters, about a point.
    pub fn sample(&self, point: &[f64], xi: &[f64]) -> Vec<f64> {
        let mut xi = xi.iter();
        let along = |axis: &Axis| {
            if !axis.is_uncertain() {
                return axis.nominal(point);
            }
            let xi = xi.next().copied().unwrap_or(0.0);
            let [lower, upper] = axis.ends(point);
            0.5 * (1.0 - xi) * lower + 0.5 * (1.0 + xi) * upper
        };
        self.all.iter().map(along).collect()
    }

    /// The sample without deviations.
    pub fn nominal(&self, point: &[f64]) -> Vec<f64> {
        self.all.iter().map(|axis| axis.nominal(point)).collect()
    }

    /// The sample about a point with the deviations that values of the uncertain parameters have about another one.
    pub fn moved(&self, values: &[f64], from: &[f64], to: &[f64]) -> Vec<f64> {
        let mut values = values.iter();
        let along = |axis: &Axis| {
            let (before, after) = (axis.nominal(from), axis.nominal(to));
            if !axis.is_uncertain() {
                return after;
            }
            let deviation = values.next().map_or(0.0, |value| value - before);
            let side = usize::from(deviation < 0.0);
            after + deviation * axis.scales(to)[side] / axis.scales(from)[side]
        };
        self.all.iter().map(along).collect()
    }

    /// The model with a point's nominal values; tolerances and laws go with them.
    pub fn at(&self, description: &Description, point: &[f64]) -> Description {
        let mut model = description.clone();
        for axis in &self.all {
            let nominal = axis.nominal(point);
            set(&mut model, &axis.name, nominal, axis.ends(point));
            let scales = axis.scales(point);
            let laws = model.statistics.laws.iter_mut().filter(|(name, _)| *name == axis.name);
            laws.for_each(|(_, law)| move_law(law, axis.nominal, nominal, scales));
        }
        model
    }

    /// The model over all samples about points of a region; for statistics, with the reach of laws beyond tolerances.
    pub fn over(&self, description: &Description, region: &[[f64; 2]], is_statistical: bool) -> Description {
        let mut model = description.clone();
        let widest = |side: usize| -> Vec<f64> {
            let end = |(axis, own): (usize, &[f64; 2])| own[if axis < self.free.len() { side } else { 1 }];
            region.iter().enumerate().map(end).collect()
        };
        let [least, most] = [widest(0), widest(1)];
        for axis in &self.all {
            let reach = if is_statistical { statistics::reach(description, &axis.name) } else { 1.0 };
            let [first, last] = [&least, &most].map(|point| axis.nominal(point));
            let [lower, upper] = [axis.ends(&least)[0], axis.ends(&most)[1]];
            let (lower, upper) = (first - reach * (first - lower), last + reach * (upper - last));
            set(&mut model, &axis.name, 0.5 * (first + last), [lower, upper]);
        }
        model.statistics.asked = false;
        model.bounds.chebyshev = Some(Chebyshev::ADAPTIVE);
        model.bounds.tolerance = Some(model.bounds.tolerance.unwrap_or(TUNING.tolerance).min(TUNING.tolerance));
        model
    }
}

/// The model without tolerances.
pub fn without_tolerances(description: &Description) -> Description {
    let mut model = description.clone();
    for parameter in &mut model.parameters {
        if let ParameterValue::Interval { nominal, .. } = parameter.value {
            parameter.value = ParameterValue::Formula(Formula::number(nominal));
        }
    }
    model.statistics = Default::default();
    model.zones.clear();
    model
}

fn set(model: &mut Description, name: &str, nominal: f64, [lower, upper]: [f64; 2]) {
    let value = match lower < upper {
        true => ParameterValue::Interval { nominal, lower, upper },
        false => ParameterValue::Formula(Formula::number(nominal)),
    };
    model.parameters.iter_mut().filter(|own| own.name == name).for_each(|own| own.value = value.clone());
}

/// A law about another nominal value.
fn move_law(law: &mut Law, from: f64, to: f64, scales: [f64; 2]) {
    if from == to && scales == [1.0; 2] {
        return;
    }
    let moved = |value: f64| to + scales[usize::from(value < from)] * (value - from);
    // A standard deviation that is given stays, and with it the mean's distance, as in a model whose value is set.
    let is_given = !law.by_tolerance
        && matches!(law.distribution, Distribution::Normal { .. } | Distribution::TruncatedNormal { .. });
    let mean = |value: f64| if is_given { to + (value - from) } else { moved(value) };
    let width = if is_given { 1.0 } else { 0.5 * (scales[0] + scales[1]) };
    match &mut law.distribution {
        Distribution::Uniform { lower, upper } | Distribution::Beta { lower, upper, .. } => {
            (*lower, *upper) = (moved(*lower), moved(*upper));
        }
        Distribution::Normal { mean: own, sigma } => (*own, *sigma) = (mean(*own), width * *sigma),
        Distribution::TruncatedNormal { mean: own, sigma, lower, upper } => {
            (*own, *sigma, *lower, *upper) = (mean(*own), width * *sigma, moved(*lower), moved(*upper));
        }
        Distribution::Triangular { lower, upper, mode } => {
            (*lower, *upper, *mode) = (moved(*lower), moved(*upper), moved(*mode));
        }
        Distribution::Table(table) => table.iter_mut().for_each(|(value, _)| *value = moved(*value)),
        Distribution::Lognormal { median, lower, upper, .. } => {
            // Its logarithm deviates: so does it by a share.
            let factor = if from == 0.0 { 1.0 } else { to / from };
            (*median, *lower, *upper) = (factor * *median, factor * *lower, factor * *upper);
        }
    }
}
