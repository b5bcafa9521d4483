//! Certificates of enclosed motions: the equations, polynomials and radii that a proof found, their file, and a checker
//! that computes the proof again.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

// Rooms of the crates below keep their names here.
use mbint_numerics::numerics;

pub mod certificate;
