//! Shadows of the consistent set on pairs of parameters, as rows of a raster.

use super::local::{SkewAxes, value};
use super::tuning::TUNING;
use crate::numerics::{Boxes, ParameterBox, Paving};
use crate::results::FitProjection;

/// The raster over the outer hull of two parameters.
struct Raster {
    lower: [f64; 2],
    size: [f64; 2],
    cells: Vec<bool>,
}

/// Projections on every pair of parameters, within the hull of ξ.
pub fn projections(frame: &SkewAxes, paving: &Paving, hull: &[[f64; 2]], prior: &ParameterBox) -> Vec<FitProjection> {
    let k = prior.dimension();
    let pairs = (0..k).flat_map(|first| (first + 1..k).map(move |second| [first, second]));
    let of = |pair: [usize; 2]| {
        let mut outer = Raster::over(pair.map(|axis| hull[axis]));
        let mut inner = Raster::over(pair.map(|axis| hull[axis]));
        let shadow = |lower: &[f64], upper: &[f64]| shadow(frame, pair, lower, upper);
        let each = |boxes: &Boxes, raster: &mut Raster, is_inner: bool| {
            boxes.iter().for_each(|(lower, upper)| raster.fill(&shadow(lower, upper), is_inner));
        };
        each(&paving.inside, &mut inner, true);
        each(&paving.inside, &mut outer, false);
        each(&paving.undecided, &mut outer, false);
        let in_units = |raster: &Raster| {
            let of = |ends: [f64; 4]| {
                let at = |index: usize| value(prior, pair[index / 2], ends[index]);
                [at(0), at(1), at(2), at(3)]
            };
            raster.rectangles().into_iter().map(of).collect()
        };
        FitProjection { parameters: pair, outer: in_units(&outer), inner: in_units(&inner) }
    };
    pairs.map(of).collect()
}

/// The shadow of a box along skew axes: a convex polygon of ξ, as its corners in order.
fn shadow(frame: &SkewAxes, pair: [usize; 2], lower: &[f64], upper: &[f64]) -> Vec<[f64; 2]> {
    let axes = &frame.axes;
    let mut start = pair.map(|axis| frame.center[axis]);
    let mut edges: Vec<[f64; 2]> = Vec::with_capacity(2 * lower.len());
    for (index, (lower, upper)) in lower.iter().zip(upper).enumerate() {
        let own = pair.map(|axis| axes[(axis, index)]);
        let mut edge = own.map(|entry| entry * (upper - lower));
        let mut from = *lower;
        // All edges go up, so that the polygon begins at its lowest corner.
        if edge[1] < 0.0 || (edge[1] == 0.0 && edge[0] < 0.0) {
            (edge, from) = (edge.map(|own| -own), *upper);
        }
        (0..2).for_each(|side| start[side] += own[side] * from);
        edges.push(edge);
    }
    edges.sort_by(|a, b| (a[1] * b[0]).total_cmp(&(b[1] * a[0])));
    let back = edges.clone().into_iter().map(|edge| edge.map(|own| -own));
    let mut corners = Vec::with_capacity(2 * edges.len());
    for edge in edges.into_iter().chain(back) {
        corners.push(start);
        start = [start[0] + edge[0], start[1] + edge[1]];
    }
    corners
}

impl Raster {
    fn over(hull: [[f64; 2]; 2]) -> Self {
        let size = hull.map(|[lower, upper]| ((upper - lower) / TUNING.cells as f64).max(f64::MIN_POSITIVE));
        Self { lower: hull.map(|own| own[0]), size, cells: vec![false; TUNING.cells * TUNING.cells] }
    }

    /// Cells that a convex polygon meets, or those of which it has the middle.
    fn fill(&mut self, corners: &[[f64; 2]], middles: bool) {
        let rows = corners.iter().map(|corner| (corner[1] - self.lower[1]) / self.size[1]);
        let [least, most] = rows.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], own| [a.min(own), b.max(own)]);
        let clamped = |row: f64| (row.max(0.0) as usize).min(TUNING.cells - 1);
        for row in clamped(least.floor())..=clamped(most.ceil()) {
            let begin = self.lower[1] + row as f64 * self.size[1];
            let strip = if middles { [begin + 0.5 * self.size[1]; 2] } else { [begin, begin + self.size[1]] };
            let Some([from, to]) = across(corners, strip) else { continue };
            let [from, to] = [from, to].map(|x| (x - self.lower[0]) / self.size[0]);
            let [first, end] = match middles {
                true => [(from - 0.5).ceil(), (to - 0.5).floor() + 1.0],
                false => [from.floor(), to.floor() + 1.0],
            };
            let cells = (first.max(0.0) as usize)..(end.max(0.0) as usize).min(TUNING.cells);
            cells.for_each(|column| self.cells[row * TUNING.cells + column] = true);
        }
    }

    /// Runs of cells, row by row: ends of the first, then of the second parameter.
    fn rectangles(&self) -> Vec<[f64; 4]> {
        let mut rectangles = Vec::new();
        for (row, cells) in self.cells.chunks_exact(TUNING.cells).enumerate() {
            let at = |side: usize, cell: usize| self.lower[side] + cell as f64 * self.size[side];
            let mut column = 0;
            while column < TUNING.cells {
                let end = column + cells[column..].iter().take_while(|own| **own).count();
                if end > column {
                    rectangles.push([at(0, column), at(0, end), at(1, row), at(1, row + 1)]);
                }
                column = end + 1;
            }
        }
        rectangles
    }
}

/// Least and largest first coordinate of a convex polygon where the second is in a strip.
fn across(corners: &[[f64; 2]], strip: [f64; 2]) -> Option<[f64; 2]> {
    let mut extent: Option<[f64; 2]> = None;
    let mut meet = |x: f64| {
        let [least, most] = extent.unwrap_or([x, x]);
        extent = Some([least.min(x), most.max(x)]);
    };
    for (index, from) in corners.iter().enumerate() {
        let to = corners[(index + 1) % corners.len()];
        if (strip[0]..=strip[1]).contains(&from[1]) {
            meet(from[0]);
        }
        for level in strip {
            let share = (level - from[1]) / (to[1] - from[1]);
            if (0.0..=1.0).contains(&share) {
                meet(from[0] + share * (to[0] - from[0]));
            }
        }
    }
    extent
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygon_fills_the_cells_that_it_intersects() {
        let mut raster = Raster::over([[0.0, 1.0], [0.0, 1.0]]);
        // Half of the unit square.
        let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        raster.fill(&triangle, true);
        let inner = raster.cells.iter().filter(|own| **own).count();
        raster.fill(&triangle, false);
        let outer = raster.cells.iter().filter(|own| **own).count();
        let half = TUNING.cells * TUNING.cells / 2;
        assert!(
            inner <= half + TUNING.cells / 2 && outer >= half && outer - inner <= 3 * TUNING.cells,
            "{inner} {outer}"
        );
        let area = |[a, b, c, d]: [f64; 4]| (b - a) * (d - c);
        let whole: f64 = raster.rectangles().into_iter().map(area).sum();
        assert!((whole - outer as f64 / (TUNING.cells * TUNING.cells) as f64).abs() < 1e-12);
    }
}
