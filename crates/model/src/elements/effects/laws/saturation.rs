//! A limit that is smooth.

use symdiff::Scalar;

/// ε over L.
const CORNER: f64 = 0.01;

/// ½ [√((x + L)² + ε²) − √((x − L)² + ε²)]: x well within the limit L, L beyond, and smooth between.
pub fn saturated<'g>(x: Scalar<'g>, limit: Scalar<'g>) -> Scalar<'g> {
    let corner = CORNER * limit;
    let corner = corner * corner;
    let [above, below] = [x + limit, x - limit].map(|distance| (distance * distance + corner).sqrt());
    0.5 * (above - below)
}
