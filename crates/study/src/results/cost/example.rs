//! A small study, for tests of tables and plots.

use super::{CostMethod, CostPoint, CostReference, CostStudy, Deviation};
use crate::compile::Scheme;
use crate::methods::{Curve, Method};
use crate::model::Stepping;

/// Chebyshev at the first curve.
pub const COMPOSED: CostMethod = CostMethod::Bounds(Curve { method: Method::Chebyshev, index: 0 });
/// Chebyshev at the second curve.
pub const TIGHT: CostMethod = CostMethod::Bounds(Curve { method: Method::Chebyshev, index: 1 });
/// Chebyshev at the third curve.
pub const INTERVAL: CostMethod = CostMethod::Bounds(Curve { method: Method::Chebyshev, index: 2 });
/// Taylor.
pub const TAYLOR: CostMethod = CostMethod::Bounds(Curve { method: Method::Taylor, index: 0 });
/// Scan.
pub const SCAN: CostMethod = CostMethod::Bounds(Curve { method: Method::Scan, index: 0 });

/// A point with bounds of such deviations.
pub fn point(method: CostMethod, seconds: f64, over_width: f64, under_coverage: f64) -> CostPoint {
    let deviation = Deviation::Bounds { over_width, under_coverage };
    let point = CostPoint::without_result(method, Stepping::Fixed(1e-3));
    CostPoint { order: Some(5), simulations: 36, steps: 2000, seconds, deviation, ..point }
}

/// A study of some bounds and two schemes.
pub fn study(bounds: Vec<CostPoint>) -> CostStudy {
    let hht = CostMethod::Scheme(Scheme::Hht { alpha: -0.1 });
    let trapezoidal = CostMethod::Scheme(Scheme::TrapezoidalIndex2);
    let trajectory = |method, seconds, error| CostPoint {
        seconds,
        deviation: Deviation::Trajectory(error),
        ..CostPoint::without_result(method, Stepping::Tolerance(1e-6))
    };
    CostStudy {
        model: "crank".into(),
        tolerance: 1e-3,
        budget: 60.0,
        reference_seconds: 10.0,
        seconds: 40.0,
        reference: CostReference {
            method: COMPOSED,
            order: 12,
            steps: [1e-4, 2e-4, 4e-4].map(Stepping::Fixed),
            bounds_error: 1e-5,
            trajectory_error: 1e-6,
            parts: vec![("its steps".into(), 1e-5)],
        },
        bounds,
        trajectories: vec![trajectory(hht, 2e-3, 5e-4), trajectory(trapezoidal, 1e-3, 2e-4)],
        left_out: vec![],
    }
}

/// One of each kind.
pub fn sample() -> CostStudy {
    study(vec![
        point(INTERVAL, 0.01, 0.4, 0.0),
        // Too narrow is no better than too wide.
        point(SCAN, 0.02, 0.0, 2e-3),
        point(COMPOSED, 0.05, 3e-4, 8e-4),
        point(TIGHT, 0.04, 9.95e-4, 0.0),
        CostPoint { failure: Some("it locks".into()), ..point(TAYLOR, 0.001, 0.0, 0.0) },
    ])
}
