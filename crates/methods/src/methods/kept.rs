//! A surrogate that is stored after the run, to be evaluated at any point of the box: for statistics, verdicts and
//! pictures.
//!
//! It is data: coefficients row by row, for each sub-box that the box was split into. An output is the polynomial
//! through its own samples, or follows from the expanded coordinates through a loop closure, which whoever evaluates it
//! has compiled.

use std::fmt::Debug;
use std::sync::Arc;

use super::closure::Closure;
use super::expansion::{Expansion, Moves};
use crate::numerics::{ParameterBox, Points, SparseBasis, SparseWork};

/// A surrogate over the whole box.
#[derive(Clone, Debug, Default)]
pub struct KeptSurrogate {
    boxes: Vec<KeptBox>,
    /// Instead of boxes, for motions that are cut at events.
    pieces: Option<Arc<dyn CutSurrogate>>,
    /// By output and row; empty if nothing is known of them.
    errors: Vec<Vec<f64>>,
}

/// A surrogate of motions that are cut at events.
pub(super) trait CutSurrogate: Debug + Send + Sync {
    /// Rows that are known.
    fn rows(&self) -> &[CutRow];

    /// Some outputs in one row at samples of the box (values of the parameters in their units), output by output; NaN
    /// where the closure has no solution.
    fn values(&self, row: usize, outputs: &[usize], samples: Points, closure: &dyn Closure) -> Vec<f64>;
}

/// A row of motions that are cut at events.
#[derive(Clone, Debug)]
pub(super) struct CutRow {
    /// s
    pub time: f64,
    /// The independent coordinates from which outputs follow.
    pub independent: Vec<usize>,
}

/// A sub-box with its polynomials.
#[derive(Clone, Debug)]
struct KeptBox {
    domain: ParameterBox,
    basis: SparseBasis,
    /// Rows up to the first that a sample has not reached.
    rows: Vec<KeptRow>,
}

/// One row's polynomials over a sub-box.
#[derive(Clone, Debug)]
pub struct KeptRow {
    /// s
    pub time: f64,
    /// The independent coordinates; none if only outputs are expanded.
    pub independent: Vec<usize>,
    /// Coefficients of each of the 2n lines of the motion, then of each output.
    pub coefficients: Vec<f64>,
    /// Least and largest of each of the 2n lines over the samples.
    pub extent: Vec<(f64, f64)>,
    /// Whether an output is the polynomial through its own samples.
    pub own: Vec<bool>,
}

impl KeptRow {
    /// A row of which only the outputs are expanded: coefficients output by output.
    pub fn of_outputs(time: f64, lines: &[&[f64]]) -> Self {
        let own = vec![true; lines.len()];
        Self { time, independent: Vec::new(), coefficients: lines.concat(), extent: Vec::new(), own }
    }

    /// Some of the expanded coordinates and of the outputs alone.
    fn only(&self, terms: usize, lines: &[usize], outputs: &[usize]) -> Self {
        // Positions, then velocities.
        let n = self.independent.len();
        let lines: Vec<usize> = match n {
            0 => Vec::new(),
            _ => lines.iter().copied().chain(lines.iter().map(|line| n + line)).collect(),
        };
        let of_outputs = outputs.iter().map(|output| self.extent.len() + output);
        let of_line = |line: usize| self.coefficients[line * terms..][..terms].iter().copied();
        Self {
            time: self.time,
            independent: (0..lines.len() / 2).collect(),
            coefficients: lines.iter().copied().chain(of_outputs).flat_map(of_line).collect(),
            extent: lines.iter().map(|&line| self.extent[line]).collect(),
            own: outputs.iter().map(|&output| self.own[output]).collect(),
        }
    }

    /// An output's own polynomial.
    fn of_output(&self, output: usize, terms: usize) -> &[f64] {
        &self.coefficients[(self.extent.len() + output) * terms..][..terms]
    }
}

impl KeptSurrogate {
    /// Surrogate over one box.
    pub fn of_box(domain: &ParameterBox, basis: &SparseBasis, rows: Vec<KeptRow>) -> Self {
        let boxes = vec![KeptBox { domain: domain.clone(), basis: basis.clone(), rows }];
        Self { boxes, ..Self::default() }
    }

    /// Surrogate of motions that are cut at events.
    pub(super) fn of_pieces(pieces: Arc<dyn CutSurrogate>) -> Self {
        Self { pieces: Some(pieces), ..Self::default() }
    }

    /// Adds errors of its values, by output and row, that the method knows in addition to those at the validation
    /// samples.
    pub fn with_errors(self, errors: Vec<Vec<f64>>) -> Self {
        Self { errors, ..self }
    }

    /// Error of an output's values in a row, as far as the method knows it; else zero.
    pub fn error(&self, output: usize, row: usize) -> f64 {
        self.errors.get(output).map_or(0.0, |errors| errors[row])
    }

    /// A surrogate of outputs that depend on no parameter, row by row: time and outputs.
    pub fn constant(rows: impl Iterator<Item = (f64, Vec<f64>)>) -> Self {
        let row = |(time, values): (f64, Vec<f64>)| {
            let lines: Vec<&[f64]> = values.iter().map(std::slice::from_ref).collect();
            KeptRow::of_outputs(time, &lines)
        };
        Self::of_box(&ParameterBox::default(), &SparseBasis::tensor(&[]), rows.map(row).collect())
    }

    /// Adds a sub-box.
    pub fn add(&mut self, domain: &ParameterBox, basis: &SparseBasis, rows: Vec<KeptRow>) {
        self.boxes.push(KeptBox { domain: domain.clone(), basis: basis.clone(), rows });
    }

    /// Whether it is of motions that are cut at events.
    pub fn is_cut(&self) -> bool {
        self.pieces.is_some()
    }

    /// Some of the expanded coordinates and of the outputs alone, numbered in this order; `lines` ascend. Of boxes.
    pub fn only(&self, lines: &[usize], outputs: &[usize]) -> Self {
        let of_box = |part: &KeptBox| KeptBox {
            domain: part.domain.clone(),
            basis: part.basis.clone(),
            rows: part.rows.iter().map(|row| row.only(part.basis.len(), lines, outputs)).collect(),
        };
        let errors = match self.errors.is_empty() {
            true => Vec::new(),
            false => outputs.iter().map(|&output| self.errors[output].clone()).collect(),
        };
        Self { boxes: self.boxes.iter().map(of_box).collect(), pieces: None, errors }
    }

    /// Rows that are known over the whole box.
    pub fn rows(&self) -> usize {
        let of_pieces = self.pieces.iter().map(|pieces| pieces.rows().len());
        self.boxes.iter().map(|part| part.rows.len()).chain(of_pieces).min().unwrap_or(0)
    }

    /// The choices of independent coordinates through which outputs follow, each once.
    pub fn independent(&self) -> Vec<Vec<usize>> {
        let mut found: Vec<Vec<usize>> = Vec::new();
        let of_boxes = self.boxes.iter().flat_map(|part| &part.rows).filter(|row| row.own.contains(&false));
        let of_pieces = self.pieces.iter().flat_map(|pieces| pieces.rows()).map(|row| &row.independent);
        for independent in of_boxes.map(|row| &row.independent).chain(of_pieces) {
            if !found.contains(independent) {
                found.push(independent.clone());
            }
        }
        found
    }

    /// Whether an output is the same polynomial of the parameters over the whole box in a row, so that no closure is
    /// needed.
    pub fn is_polynomial(&self, row: usize, output: usize) -> bool {
        self.boxes.len() == 1 && self.boxes[0].rows[row].own[output]
    }

    /// The polynomial through an output's own samples in a row: its terms, and their coefficients. `None` unless there
    /// is exactly one box.
    pub fn polynomial(&self, row: usize, output: usize) -> Option<(&SparseBasis, &[f64])> {
        let [part] = self.boxes.as_slice() else { return None };
        Some((&part.basis, part.rows[row].of_output(output, part.basis.len())))
    }

    /// Values of the polynomials through outputs' own samples in one row, at samples of the box, output by output.
    /// `None` if the box was split.
    pub fn own_values(&self, row: usize, outputs: &[usize], samples: Points) -> Option<Vec<f64>> {
        let [part] = self.boxes.as_slice() else { return None };
        let points = part.domain.xi_of(samples);
        let terms = part.basis.len();
        let coefficients: Vec<f64> =
            outputs.iter().flat_map(|&output| part.rows[row].of_output(output, terms).to_vec()).collect();
        let mut values = vec![0.0; outputs.len() * samples.len()];
        part.basis.values(points.points(), &coefficients, &mut values, &mut SparseWork::default());
        Some(values)
    }

    /// Outputs in one row at samples of the box (values of the parameters in their units), output by output; NaN if
    /// a closure has no solution. `closures` has one for every choice of [`independent`](Self::independent).
    pub fn values<'c>(
        &self,
        row: usize,
        outputs: &[usize],
        samples: Points,
        closures: &'c [Box<dyn Closure + 'c>],
    ) -> Vec<f64> {
        if let Some(pieces) = &self.pieces {
            let Some(closure) = closures.iter().find(|own| own.independent() == pieces.rows()[row].independent) else {
                return vec![f64::NAN; outputs.len() * samples.len()];
            };
            return pieces.values(row, outputs, samples, closure.as_ref());
        }
        if let [part] = self.boxes.as_slice() {
            return part.values(row, outputs, part.domain.xi_of(samples).points(), closures);
        }
        let mut values = vec![f64::NAN; outputs.len() * samples.len()];
        let mut left: Vec<usize> = (0..samples.len()).collect();
        for part in &self.boxes {
            let holds = |index: &usize| part.domain.contains(samples.point(*index));
            let (inside, outside): (Vec<usize>, Vec<usize>) = left.into_iter().partition(holds);
            left = outside;
            let points = part.domain.xi_of(samples.chosen(&inside).points());
            let found = part.values(row, outputs, points.points(), closures);
            for (of_output, found) in
                values.chunks_exact_mut(samples.len().max(1)).zip(found.chunks_exact(inside.len().max(1)))
            {
                inside.iter().zip(found).for_each(|(&index, &value)| of_output[index] = value);
            }
        }
        values
    }
}

impl KeptBox {
    fn values<'c>(
        &self,
        row: usize,
        outputs: &[usize],
        points: Points,
        closures: &'c [Box<dyn Closure + 'c>],
    ) -> Vec<f64> {
        let row = &self.rows[row];
        let mut values = vec![f64::NAN; outputs.len() * points.len()];
        let mut work = SparseWork::default();
        let closure = closures.iter().find(|closure| closure.independent() == row.independent);
        let closed = match closure {
            Some(closure) if outputs.iter().any(|&output| !row.own[output]) => {
                let expansion = Expansion {
                    basis: &self.basis,
                    domain: &self.domain,
                    closure: closure.as_ref(),
                    time: row.time,
                    coefficients: &row.coefficients,
                    extent: &row.extent,
                    phases: &[],
                };
                expansion.evaluate_moved(points, &[Moves::default()])
            }
            _ => Vec::new(),
        };
        for (&output, values) in outputs.iter().zip(values.chunks_exact_mut(points.len().max(1))) {
            if row.own[output] {
                self.basis.values(points, row.of_output(output, self.basis.len()), values, &mut work);
            } else if let Some(closed) = closed.get(output * points.len()..(output + 1) * points.len()) {
                values.copy_from_slice(closed);
            }
        }
        values
    }
}
