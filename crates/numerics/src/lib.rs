//! Numerics that know nothing of mechanisms: Chebyshev and sparse bases, ranges of polynomials, searches over boxes,
//! quadrature and statistics, and the parameter box itself.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

pub mod numerics;
