//! Sine and cosine at once. (Placeholder arithmetic; the branch-free version replaces it.)

/// (sin x, cos x).
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    (libm::sin(x), libm::cos(x))
}
