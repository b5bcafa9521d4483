//! The settings that a study tries: methods, orders, points and steps.

use super::tuning::TUNING;
use crate::methods::{BoundsRequest, Curve, Method};
use crate::model::{Description, SchemeChoice, Simulation, Stepping};
use crate::results::{CostMethod, Integrator};

/// Levels of extrapolation that samples of bounds are tried with.
pub(super) const LEVELS: Integrator = Integrator::Extrapolated { levels: 3 };

/// The scan, all of whose samples lie in the true range: checks a reference.
pub(super) const SCAN: CostMethod = CostMethod::Bounds(Curve { method: Method::Scan, index: 0 });

/// The method of a reference: the expansion of coordinates or, if the model does not admit that, of outputs.
pub(super) fn smoothest(composable: bool) -> CostMethod {
    CostMethod::Bounds(Curve { method: Method::Chebyshev, index: usize::from(!composable) })
}

/// A setting that runs once, or a few times for the clock's sake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Setting {
    pub(super) method: CostMethod,
    /// Degree, or a scan's points.
    pub(super) count: usize,
    pub(super) stepping: Stepping,
}

/// Number of uncertain parameters.
pub(super) fn uncertain(model: &Description) -> usize {
    model.uncertain().count()
}

/// The model's stepping made `parts` times as fine: as many whole steps between rows as come nearest to it. A tolerance
/// goes with the third power of the step.
pub(super) fn finer(simulation: &Simulation, parts: f64) -> Stepping {
    match simulation.stepping {
        Stepping::Fixed(step) => {
            let steps = (simulation.output_step / step).round() * parts;
            Stepping::Fixed(simulation.output_step / steps.round().max(1.0))
        }
        Stepping::Tolerance(tolerance) => Stepping::Tolerance(tolerance / parts.powi(3)),
    }
}

/// From coarse to fine, none twice.
pub(super) fn steppings(simulation: &Simulation) -> Vec<Stepping> {
    let mut steppings: Vec<Stepping> = TUNING.parts_of_step.iter().map(|&parts| finer(simulation, parts)).collect();
    steppings.dedup();
    steppings
}

/// The same for an integrator in place of plain steps.
pub(super) fn steppings_by(integrator: Integrator, simulation: &Simulation) -> Vec<Stepping> {
    match integrator {
        Integrator::Extrapolated { .. } => steppings(simulation),
        Integrator::Explicit => TUNING.tolerances.map(Stepping::Tolerance).to_vec(),
    }
}

/// Every setting, method by method, composed ones only if outputs can be.
pub(super) fn settings(simulation: &Simulation, composable: bool) -> Vec<Setting> {
    let mut settings = Vec::new();
    for curve in Curve::all().filter(|curve| composable || !curve.about().composes) {
        let method = CostMethod::Bounds(curve);
        for &count in curve.about().counts {
            settings.extend(steppings(simulation).into_iter().map(|stepping| Setting { method, count, stepping }));
        }
    }
    for integrator in [LEVELS, Integrator::Explicit] {
        let method = smoothest(composable).by(integrator);
        for count in TUNING.orders_of_accurate_samples {
            let steppings = steppings_by(integrator, simulation).into_iter();
            settings.extend(steppings.map(|stepping| Setting { method, count, stepping }));
        }
    }
    settings
}

impl Setting {
    /// The method under which a run reports it.
    pub(super) fn reported(&self) -> Option<Method> {
        self.method.curve().map(|curve| curve.method)
    }

    /// The model that asks for this and nothing else.
    pub(super) fn applied(&self, model: &Description) -> Description {
        let mut model = model.clone();
        let k = uncertain(&model);
        model.simulation.stepping = self.stepping;
        (model.simulation.scheme, model.simulation.extrapolation) = match self.method.integrator() {
            None => (SchemeChoice::Hht, None),
            Some(Integrator::Extrapolated { levels }) => (SchemeChoice::Hht, Some(levels)),
            Some(Integrator::Explicit) => (SchemeChoice::Explicit, None),
        };
        model.bounds = BoundsRequest::default();
        if let Some(curve) = self.method.curve() {
            (curve.about().ask)(&mut model.bounds, self.count, k);
        }
        model
    }

    /// Simulations that it takes of k parameters.
    pub(super) fn simulations(&self, k: usize) -> f64 {
        self.method.curve().map_or(1.0, |curve| (curve.about().simulations)(self.count, k))
    }

    /// Simulations times steps, up to a factor that is the same for all settings of a model.
    pub(super) fn work(&self, k: usize) -> f64 {
        let steps = match (self.stepping, self.method.integrator()) {
            // About as much as the scheme's steps, at the tolerances that it takes.
            (Stepping::Tolerance(tolerance), Some(Integrator::Explicit)) => {
                100.0 * symdiff::math::pow(tolerance, -0.125)
            }
            (Stepping::Fixed(step), _) => 1.0 / step,
            (Stepping::Tolerance(tolerance), _) => 1.0 / symdiff::math::cbrt(tolerance),
        };
        let levels = match self.method.integrator() {
            Some(Integrator::Extrapolated { levels }) => f64::from((1_u32 << levels) - 1),
            _ => 1.0,
        };
        self.simulations(k) * levels * steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::cost_example::{COMPOSED, TAYLOR, TIGHT};

    fn simulation(stepping: Stepping) -> Simulation {
        Simulation {
            duration: 1.0,
            stepping,
            alpha: -0.1,
            output_step: 0.01,
            formulation: crate::model::Formulation::Auto,
            scheme: SchemeChoice::Auto,
            extrapolation: None,
        }
    }

    #[test]
    fn steps_divide_the_rows_without_duplicates() {
        let steps = |step: f64| -> Vec<f64> {
            steppings(&simulation(Stepping::Fixed(step)))
                .into_iter()
                .map(|stepping| match stepping {
                    Stepping::Fixed(step) => (0.01 / step).round(),
                    Stepping::Tolerance(_) => unreachable!("steps stay fixed"),
                })
                .collect()
        };
        assert_eq!(steps(1e-3), [1.0, 3.0, 5.0, 10.0, 20.0, 40.0]);
        assert_eq!(steps(0.01), [1.0, 2.0, 4.0]);
        let tolerances = steppings(&simulation(Stepping::Tolerance(1e-6)));
        assert_eq!((tolerances[0], tolerances[3]), (Stepping::Tolerance(512e-6), Stepping::Tolerance(1e-6)));
    }

    #[test]
    fn work_is_simulations_times_steps() {
        let setting = |method, count, step| Setting { method, count, stepping: Stepping::Fixed(step) };
        assert_eq!(setting(SCAN, 30, 1e-3).simulations(2), 900.0);
        assert_eq!(setting(COMPOSED, 5, 1e-3).simulations(2), 36.0);
        // 1, ξ₁, ξ₂ and 1, 2 · (ξ₁, ξ₂): five products.
        assert_eq!(setting(TAYLOR, 1, 1e-3).simulations(2), 5.0);
        let halved = setting(TIGHT, 5, 5e-4).work(2) / setting(TIGHT, 5, 1e-3).work(2);
        assert!((halved - 2.0).abs() < 1e-12);
    }
}
