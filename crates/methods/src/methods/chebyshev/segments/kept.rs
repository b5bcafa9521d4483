//! Polynomials between events that are stored after a run: outputs at any point of the box, in any row.

use super::at_row::RowMotion;
use super::pieces::Pieces;
use super::row::BoxRow;
use crate::methods::closure::Closure;
use crate::methods::kept::{CutRow, CutSurrogate};
use crate::numerics::{ParameterBox, Points};

/// Polynomials in all parts of the box, with the rows in which outputs are known.
#[derive(Clone, Debug)]
pub(super) struct KeptPieces {
    domain: ParameterBox,
    pieces: Pieces,
    /// Number of outputs.
    outputs: usize,
    rows: Vec<CutRow>,
    /// Motions at the rows' times, by row and part.
    motions: Vec<Vec<RowMotion>>,
}

impl KeptPieces {
    pub fn new(
        domain: &ParameterBox,
        mut pieces: Pieces,
        outputs: usize,
        rows: Vec<CutRow>,
        motions: Vec<Vec<RowMotion>>,
    ) -> Self {
        pieces.forget_samples();
        Self { domain: domain.clone(), pieces, outputs, rows, motions }
    }
}

impl CutSurrogate for KeptPieces {
    fn rows(&self) -> &[CutRow] {
        &self.rows
    }

    fn values(&self, row: usize, outputs: &[usize], samples: Points, closure: &dyn Closure) -> Vec<f64> {
        let points: Vec<Vec<f64>> = samples.iter().map(|sample| self.domain.xi(sample)).collect();
        let Self { domain, pieces, outputs: count, rows, motions } = self;
        let row = BoxRow { domain, outputs: *count, pieces, motions: &motions[row], closure, time: rows[row].time };
        row.some_outputs(outputs, &points)
    }
}
