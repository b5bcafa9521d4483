//! Parameters and functions under which outputs are simulated.

use crate::numerics::Cell;

/// Arguments of an output: parameters (ξ), and a function for each input.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub xi: Vec<f64>,
    /// Input by input, its cells.
    pub functions: Vec<Vec<Cell>>,
}

impl Point {
    /// Levels and slopes, cell by cell, input by input.
    pub fn inputs(&self) -> Vec<f64> {
        let cells = self.functions.first().map_or(0, Vec::len);
        (0..cells).flat_map(|cell| self.functions.iter().flat_map(move |function| function[cell])).collect()
    }

    /// The middle between two points.
    pub fn halfway(&self, other: &Self) -> Self {
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        let of_function = |(a, b): (&Vec<Cell>, &Vec<Cell>)| {
            a.iter().zip(b).map(|(a, b)| [mean(a[0], b[0]), mean(a[1], b[1])]).collect()
        };
        Self {
            xi: self.xi.iter().zip(&other.xi).map(|(a, b)| mean(*a, *b)).collect(),
            functions: self.functions.iter().zip(&other.functions).map(of_function).collect(),
        }
    }

    /// The functions later by a time, s, over cells that end at some times; they begin as before. Where there are fewer
    /// cells than before, they may be none of their class.
    pub fn later(&self, by: f64, ends: &[f64], others: &[f64]) -> Self {
        let moved = |cells: &Vec<Cell>| -> Vec<Cell> {
            let mut begin = 0.0;
            let of_cell = |&end: &f64| {
                let middle = 0.5 * (begin + end) - by;
                begin = end;
                let [level, slope] = cells[ends.partition_point(|own| *own < middle).min(cells.len() - 1)];
                [level - slope * by, slope]
            };
            others.iter().map(of_cell).collect()
        };
        Self { xi: self.xi.clone(), functions: self.functions.iter().map(moved).collect() }
    }

    /// The opposite functions.
    pub fn opposite(&self) -> Self {
        let of_function = |cells: &Vec<Cell>| cells.iter().map(|[level, slope]| [-level, -slope]).collect();
        Self { xi: self.xi.clone(), functions: self.functions.iter().map(of_function).collect() }
    }
}
