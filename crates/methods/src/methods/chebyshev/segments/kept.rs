//! Polynomials between events that are kept after a run: outputs at any point of the box, in any row.

use super::pieces::Pieces;
use super::row::BoxRow;
use crate::methods::closure::Closure;
use crate::methods::kept::{CutRow, CutSurrogate};
use crate::numerics::ParameterBox;

/// Polynomials in all parts of the box, with the rows in which outputs are known.
#[derive(Clone, Debug)]
pub(super) struct KeptPieces {
    domain: ParameterBox,
    pieces: Pieces,
    /// Number of outputs.
    outputs: usize,
    rows: Vec<CutRow>,
}

impl KeptPieces {
    pub fn new(domain: &ParameterBox, pieces: Pieces, outputs: usize, rows: Vec<CutRow>) -> Self {
        Self { domain: domain.clone(), pieces, outputs, rows }
    }
}

impl CutSurrogate for KeptPieces {
    fn rows(&self) -> &[CutRow] {
        &self.rows
    }

    fn values(&self, row: usize, outputs: &[usize], samples: &[&[f64]], closure: &dyn Closure) -> Vec<f64> {
        let points: Vec<Vec<f64>> = samples.iter().map(|sample| self.domain.xi(sample)).collect();
        let Self { domain, pieces, outputs: count, rows } = self;
        let row = BoxRow { domain, outputs: *count, pieces, closure, time: rows[row].time };
        row.some_outputs(outputs, &points)
    }
}
