//! Volume, centre and inertia of the solid that triangles enclose, by tetrahedra from each to a common apex:
//!
//! ```text
//! V = Σ Vᵢ,   Vᵢ = a·(b × c)/6,   ∫ x dV = Σ Vᵢ (a + b + c)/4
//! ∫ x xᵀ dV = Σ Vᵢ/20 (a aᵀ + b bᵀ + c cᵀ + s sᵀ),   s = a + b + c
//! ```
//!
//! Exact for a closed surface, wherever the apex is. For a surface, areas replace volumes:
//! ∫ x xᵀ dA = Σ Aᵢ/12 (…).

use std::collections::HashMap;

use super::Triangle;

/// How a body follows from triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The volume that they enclose.
    Exact,
    /// Tetrahedra to the middle of the surface, none of them negative: of an open or misoriented mesh too; more than is
    /// there where the surface is seen from its middle more than once.
    Unsigned,
    /// A thin shell.
    Shell,
}

/// Volume, or area of a shell; centre; ∫ (x² 1 − x xᵀ) about it: of density one.
#[derive(Clone, Copy, Debug)]
pub struct SolidMeasures {
    pub size: f64,
    pub center: [f64; 3],
    pub inertia: [[f64; 3]; 3],
}

/// Edges that a closed surface does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Edges of one triangle only.
    pub open: usize,
    /// Edges along which neighbours run the same way.
    pub turned: usize,
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn area([a, b, c]: Triangle) -> f64 {
    let normal = cross(less(b, a), less(c, a));
    dot(normal, normal).sqrt() / 2.0
}

/// Measures of the body that triangles make up. The size of a wrong mesh may be zero, negative or not a number.
pub fn measure(triangles: &[Triangle], way: Way) -> SolidMeasures {
    let middle = middle(triangles);
    let share = |[a, b, c]: Triangle| match way {
        Way::Exact => dot(a, cross(b, c)) / 6.0,
        Way::Unsigned => dot(a, cross(b, c)).abs() / 6.0,
        Way::Shell => area([a, b, c]),
    };
    let seen_from = |apex: [f64; 3]| triangles.iter().map(move |triangle| triangle.map(|corner| less(corner, apex)));
    // The apex counts as a corner of a tetrahedron; a triangle of a shell has its own three corners only.
    let corners = if way == Way::Shell { 3.0 } else { 4.0 };
    let (mut size, mut moment) = (0.0, [0.0; 3]);
    for triangle in seen_from(middle) {
        let share = share(triangle);
        size += share;
        let sum = [0, 1, 2].map(|i| triangle[0][i] + triangle[1][i] + triangle[2][i]);
        (0..3).for_each(|i| moment[i] += share * sum[i] / corners);
    }
    let center = [0, 1, 2].map(|i| middle[i] + moment[i] / size);
    let scale = if way == Way::Shell { 12.0 } else { 20.0 };
    let (mut size, mut squares) = (0.0, [[0.0; 3]; 3]);
    for triangle in seen_from(center) {
        let share = share(triangle);
        size += share;
        let [a, b, c] = triangle;
        let sum = [0, 1, 2].map(|i| a[i] + b[i] + c[i]);
        for i in 0..3 {
            for k in 0..3 {
                squares[i][k] += share / scale * (a[i] * a[k] + b[i] * b[k] + c[i] * c[k] + sum[i] * sum[k]);
            }
        }
    }
    let trace = squares[0][0] + squares[1][1] + squares[2][2];
    let inertia = std::array::from_fn(|i| std::array::from_fn(|k| f64::from(i == k) * trace - squares[i][k]));
    SolidMeasures { size, center, inertia }
}

/// Centre of the surface.
fn middle(triangles: &[Triangle]) -> [f64; 3] {
    let (mut whole, mut moment) = (0.0, [0.0; 3]);
    for &triangle in triangles {
        let area = area(triangle);
        whole += area;
        (0..3).for_each(|i| moment[i] += area * (triangle[0][i] + triangle[1][i] + triangle[2][i]) / 3.0);
    }
    if whole > 0.0 { moment.map(|part| part / whole) } else { [0.0; 3] }
}

/// Faults that keep triangles from being a closed surface; equal corners are one.
pub fn faults(triangles: &[Triangle]) -> Faults {
    let mut places: HashMap<[u64; 3], usize> = HashMap::new();
    let mut place = |corner: [f64; 3]| {
        let next = places.len();
        // Zero has two signs.
        *places.entry(corner.map(|part| (part + 0.0).to_bits())).or_insert(next)
    };
    // The number of triangles at each edge, and how many more run along it one way than the other.
    let mut edges: HashMap<(usize, usize), (usize, isize)> = HashMap::new();
    for triangle in triangles {
        let [a, b, c] = triangle.map(&mut place);
        if a == b || b == c || c == a {
            continue;
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (count, balance) = edges.entry((from.min(to), from.max(to))).or_default();
            *count += 1;
            *balance += if from < to { 1 } else { -1 };
        }
    }
    let open = edges.values().filter(|(count, _)| *count == 1).count();
    let turned = edges.values().filter(|(count, balance)| *count > 1 && *balance != 0).count();
    Faults { open, turned }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A prism over the polygon (0,0) (2,0) (2,1) (1,1) (1,2) (0,2), of height 1: three unit cubes, moved.
    fn prism(moved: [f64; 3]) -> Vec<Triangle> {
        const OUTLINE: [[f64; 2]; 6] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let at = |index: usize, height: f64| {
            let [x, y] = OUTLINE[index % 6];
            [x + moved[0], y + moved[1], height + moved[2]]
        };
        let mut triangles = Vec::new();
        for i in 1..5 {
            triangles.push([at(0, 1.0), at(i, 1.0), at(i + 1, 1.0)]);
            triangles.push([at(0, 0.0), at(i + 1, 0.0), at(i, 0.0)]);
        }
        for i in 0..6 {
            triangles.push([at(i, 0.0), at(i + 1, 0.0), at(i + 1, 1.0)]);
            triangles.push([at(i, 0.0), at(i + 1, 1.0), at(i, 1.0)]);
        }
        triangles
    }

    fn near(found: f64, exact: f64) {
        assert!((found - exact).abs() < 1e-9 * exact.abs().max(1.0), "{found} for {exact}");
    }

    #[test]
    fn three_cubes_have_their_volume_and_inertia_anywhere() {
        for moved in [[0.0; 3], [5.0, -3.0, 8.0]] {
            let found = measure(&prism(moved), Way::Exact);
            near(found.size, 3.0);
            let center = [5.0 / 6.0, 5.0 / 6.0, 0.5];
            (0..3).for_each(|i| near(found.center[i], center[i] + moved[i]));
            // Three times 1/6, and the squares of the distances of their middles: 1/9 + 1/9, 4/9 + 1/9 and 1/9 + 4/9.
            near(found.inertia[2][2], 0.5 + 12.0 / 9.0);
            near(found.inertia[0][1], 1.0 / 3.0);
        }
        assert_eq!(faults(&prism([0.0; 3])), Faults::default());
    }

    #[test]
    fn open_edges_and_turned_neighbours_are_found() {
        let mut triangles = prism([0.0; 3]);
        triangles[3].swap(0, 1);
        assert_eq!(faults(&triangles), Faults { open: 0, turned: 3 });
        near(measure(&triangles, Way::Unsigned).size, 3.0);
        triangles.remove(3);
        assert_eq!(faults(&triangles), Faults { open: 3, turned: 0 });
    }

    #[test]
    fn a_shell_has_its_area() {
        let found = measure(&prism([0.0; 3]), Way::Shell);
        near(found.size, 14.0);
        near(found.center[0], 12.0 / 14.0);
        near(found.inertia[2][2], 12.0952380952);
    }
}
