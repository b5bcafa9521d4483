//! Certificates of the true motion: results of a proof, such that others can check them.
//!
//! A [`Certificate`] has the equations of motion as a list of operations, polynomials of the accelerations and
//! multipliers over cells of time and pieces of the box, a radius about them, and the bounds of the outputs. [`check`]
//! trusts none of it but the equations: it integrates the polynomials, bounds their defect, and finds all derivatives
//! by itself. The file is in `docs/reference/certificate.md`; `python/mbint/certificate.py` is a second checker, in
//! other arithmetic.

mod check;
mod equations;
pub mod flow;
pub mod frame;
mod hexadecimal;
pub mod krawczyk;
pub mod majorant;
pub mod matrix;
pub mod spaces;
mod text;
pub mod tuning;

use std::sync::Arc;

pub use check::{Checked, Refusal, check};
pub use equations::{Equations, Node};
pub use text::{FormatError, read, write};

/// A file that a model was read from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelFile {
    /// Its name, without folders.
    pub name: String,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub sha256: String,
}

/// All that is proven of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// Name of the model.
    pub model: String,
    /// Files that it was read from.
    pub files: Vec<ModelFile>,
    /// Its subsystems, which do not act on each other.
    pub systems: Vec<Arc<Certified>>,
}

/// All that is proven of one system of equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Certified {
    /// Names of the uncertain parameters, k.
    pub parameters: Vec<String>,
    /// Ends of the box, k each.
    pub lower: Vec<f64>,
    /// Ends of the box, k each.
    pub upper: Vec<f64>,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// Equations of motion, of the start and of the outputs.
    pub equations: Equations,
    /// Total degree of the polynomials.
    pub order: usize,
    /// Instants, s, ascending.
    pub times: Vec<f64>,
    /// Ends within which each output is at each instant, for every parameter of the box; `None` if nothing is claimed.
    pub bounds: Vec<Vec<Option<[f64; 2]>>>,
    /// Pieces of the box.
    pub pieces: Vec<Piece>,
}

/// The motion over a piece of the box.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    /// Ends of the piece, k each.
    pub lower: Vec<f64>,
    /// Ends of the piece, k each.
    pub upper: Vec<f64>,
    /// Polynomials of ξ of the positions at t = 0, n.
    pub q: Vec<Vec<f64>>,
    /// The same of the velocities, n.
    pub v: Vec<Vec<f64>>,
    /// One after the other, from t = 0 on.
    pub cells: Vec<ProvenCell>,
}

/// The motion over a cell of time, t = middle + half τ with |τ| ≤ 1.
#[derive(Clone, Debug, PartialEq)]
pub struct ProvenCell {
    /// s
    pub middle: f64,
    /// s, a power of two.
    pub half: f64,
    /// Polynomials of (τ, ξ) of the accelerations, n.
    pub w: Vec<Vec<f64>>,
    /// The same of the multipliers, m.
    pub lambda: Vec<Vec<f64>>,
    /// Largest distance of each position and velocity from the integrals of `w`, 2n.
    pub tube: Vec<f64>,
}
