//! A limit that is smooth.

use crate::elements::tuning::TUNING;
use symdiff::Scalar;

/// ½ [√((x + L)² + ε²) − √((x − L)² + ε²)]: x well within the limit L, L beyond, and smooth between.
pub fn saturated<'g>(x: Scalar<'g>, limit: Scalar<'g>) -> Scalar<'g> {
    let corner = TUNING.corner_of_saturation * limit;
    let corner = corner * corner;
    let [above, below] = [x + limit, x - limit].map(|distance| (distance * distance + corner).sqrt());
    0.5 * (above - below)
}
