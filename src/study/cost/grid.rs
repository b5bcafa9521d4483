//! The settings that a study tries: methods, orders, points and steps.

use crate::methods::{BoundsRequest, Chebyshev, Expand, Scan, Taylor};
use crate::model::{Description, Simulation, Stepping};
use crate::numerics::RangeKind;
use crate::results::CostMethod;
use crate::results::Method;

/// Orders of Chebyshev surrogates.
const CHEBYSHEV_ORDERS: [usize; 4] = [2, 3, 5, 8];

/// Orders of Taylor polynomials.
const TAYLOR_ORDERS: [usize; 3] = [1, 2, 3];

/// Points of scans, a parameter.
const SCAN_POINTS: [usize; 3] = [5, 10, 30];

/// Steps, in parts of the model's own.
const PARTS: [f64; 6] = [0.125, 0.25, 0.5, 1.0, 2.0, 4.0];

/// What is run once, or a few times for the clock's sake.
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

/// The model's stepping made `parts` times as fine: as many whole steps between rows as come nearest to it. A tolerance goes
/// with the third power of the step.
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
    let mut steppings: Vec<Stepping> = PARTS.iter().map(|&parts| finer(simulation, parts)).collect();
    steppings.dedup();
    steppings
}

/// Every setting, method by method, composed ones only if outputs can be.
pub(super) fn settings(simulation: &Simulation, composable: bool) -> Vec<Setting> {
    let composed = composable.then_some((CostMethod::Composed, &CHEBYSHEV_ORDERS[..]));
    let others: [(CostMethod, &[usize]); 4] = [
        (CostMethod::Tight, &CHEBYSHEV_ORDERS),
        (CostMethod::Interval, &CHEBYSHEV_ORDERS),
        (CostMethod::Taylor, &TAYLOR_ORDERS),
        (CostMethod::Scan, &SCAN_POINTS),
    ];
    let mut settings = Vec::new();
    for (method, counts) in composed.into_iter().chain(others) {
        for &count in counts {
            settings.extend(steppings(simulation).into_iter().map(|stepping| Setting { method, count, stepping }));
        }
    }
    settings
}

impl Setting {
    /// The method that a run reports it under.
    pub(super) fn reported(&self) -> Method {
        match self.method {
            CostMethod::Taylor => Method::Taylor,
            CostMethod::Scan => Method::Scan,
            _ => Method::Chebyshev,
        }
    }

    /// The model that asks for this and nothing else.
    pub(super) fn applied(&self, model: &Description) -> Description {
        let k = uncertain(model);
        let chebyshev = |expand, range| BoundsRequest {
            chebyshev: Some(Chebyshev { expand, range, ..Chebyshev::of_order(self.count, k) }),
            ..BoundsRequest::default()
        };
        let mut model = model.clone();
        model.simulation.stepping = self.stepping;
        model.bounds = match self.method {
            CostMethod::Composed => chebyshev(Expand::Coordinates, RangeKind::Tight),
            CostMethod::Tight => chebyshev(Expand::Output, RangeKind::Tight),
            CostMethod::Interval => chebyshev(Expand::Output, RangeKind::Interval),
            CostMethod::Taylor => BoundsRequest {
                taylor: Some(Taylor { order: self.count, ..Taylor::default() }),
                ..BoundsRequest::default()
            },
            CostMethod::Scan => {
                BoundsRequest { scan: Some(Scan::of_points(self.count, k)), ..BoundsRequest::default() }
            }
            // One simulation, and no bounds.
            CostMethod::Scheme(_) => BoundsRequest::default(),
        };
        model
    }

    /// Simulations that it takes of k parameters; a jet counts as the products of its coefficients.
    pub(super) fn solves(&self, k: usize) -> f64 {
        match self.method {
            CostMethod::Composed | CostMethod::Tight | CostMethod::Interval => ((self.count + 1) as f64).powi(k as i32),
            CostMethod::Scan => (self.count as f64).powi(k as i32),
            // Pairs of monomials of at most this degree together: (2k + order) over order.
            CostMethod::Taylor => (1..=self.count).fold(1.0, |pairs, i| pairs * (2 * k + i) as f64 / i as f64),
            CostMethod::Scheme(_) => 1.0,
        }
    }

    /// Simulations times steps, up to a factor that is the same for all settings of a model.
    pub(super) fn work(&self, k: usize) -> f64 {
        let steps = match self.stepping {
            Stepping::Fixed(step) => 1.0 / step,
            Stepping::Tolerance(tolerance) => 1.0 / tolerance.cbrt(),
        };
        self.solves(k) * steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn simulation(stepping: Stepping) -> Simulation {
        Simulation {
            duration: 1.0,
            stepping,
            alpha: -0.1,
            output_step: 0.01,
            formulation: crate::model::Formulation::Auto,
        }
    }

    #[test]
    fn steps_divide_the_rows_and_none_is_there_twice() {
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
    fn work_is_solves_times_steps() {
        let setting = |method, count, step| Setting { method, count, stepping: Stepping::Fixed(step) };
        assert_eq!(setting(CostMethod::Scan, 30, 1e-3).solves(2), 900.0);
        assert_eq!(setting(CostMethod::Composed, 5, 1e-3).solves(2), 36.0);
        // 1, ξ₁, ξ₂ and 1, 2 · (ξ₁, ξ₂): five products.
        assert_eq!(setting(CostMethod::Taylor, 1, 1e-3).solves(2), 5.0);
        let halved = setting(CostMethod::Tight, 5, 5e-4).work(2) / setting(CostMethod::Tight, 5, 1e-3).work(2);
        assert!((halved - 2.0).abs() < 1e-12);
    }
}
