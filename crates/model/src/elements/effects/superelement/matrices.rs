//! Matrices of a flexible body, in the model or in a file of their own: mass and stiffness by the motions of its nodes
//! and by modes.
//!
//! A row and a column belong to each of
//!
//! ```text
//! x, y, z, rotations about x, y and z of the first node, …, of the last one, then the modes
//! x, y, angle of the first node, …, of the last one, then the modes          in the plane
//! ```
//!
//! That is the order of Craig and Bampton's reduction (*Coupling of substructures for dynamic analyses*, AIAA J. 6
//! (1968) 1313): constraint modes, which move one coordinate of one node, then normal modes with all nodes fixed.
//! Lengths and rotations are small, in the axes of the body as it stands undeformed; everything is in SI units.

use nalgebra::{Cholesky, DMatrix, DVector};
use schemars::{Schema, SchemaGenerator, json_schema};
use symdiff::Builder;

use crate::elements::tuning::TUNING;
use crate::grammar::report::Fields;
use crate::grammar::{Image, Node, Quantity, Reader, Span, SymbolTable, Value};
use crate::multibody::Vector;
use crate::syntax::codes::Code;
use crate::syntax::suggest::clip;
use crate::syntax::yaml;

/// Coordinates of a node: displacements, then rotations.
pub const OF_NODE: usize = 6;
/// Coordinates of the plane, among those of a node.
const OF_PLANE: [usize; 3] = [0, 1, 5];

/// Mass and stiffness of a flexible body.
#[derive(Clone, Debug)]
pub struct Matrices {
    /// Nodes of the undeformed body, in its frame, m.
    pub nodes: Vec<[f64; 3]>,
    /// Number of normal modes.
    pub modes: usize,
    /// Mass matrix, by [`OF_NODE`] coordinates of each node, then the modes. kg, kg m, kg m².
    pub mass: DMatrix<f64>,
    /// The same; N/m, N, N m.
    pub stiffness: DMatrix<f64>,
}

impl Matrices {
    /// Number of rows.
    fn size(&self) -> usize {
        OF_NODE * self.nodes.len() + self.modes
    }

    /// A unit displacement of the whole body along an axis.
    pub fn translation(&self, axis: usize) -> DVector<f64> {
        let of_axis = |row: usize| row < OF_NODE * self.nodes.len() && row % OF_NODE == axis;
        DVector::from_fn(self.size(), |row, _| f64::from(u8::from(of_axis(row))))
    }

    /// A unit rotation of the whole body about an axis through its first node.
    pub fn rotation(&self, axis: usize) -> DVector<f64> {
        let mut all = DVector::zeros(self.size());
        let (next, after) = ((axis + 1) % 3, (axis + 2) % 3);
        for node in 0..self.nodes.len() {
            let (first, position) = (OF_NODE * node, self.offset(node));
            (all[first + next], all[first + after]) = (-position[after], position[next]);
            all[first + 3 + axis] = 1.0;
        }
        all
    }

    /// Vector from the first node to another of the undeformed body, m.
    pub fn offset(&self, node: usize) -> [f64; 3] {
        std::array::from_fn(|axis| self.nodes[node][axis] - self.nodes[0][axis])
    }

    /// The same as a vector of expressions.
    pub fn offset_in<'g>(&self, g: &'g Builder, node: usize) -> Vector<'g> {
        self.offset(node).map(|part| g.number(part)).into()
    }

    /// The row of a node's coordinate.
    pub fn of_node(node: usize, coordinate: usize) -> usize {
        OF_NODE * node + coordinate
    }

    /// The row of a mode.
    pub fn of_mode(&self, mode: usize) -> usize {
        OF_NODE * self.nodes.len() + mode
    }

    /// Sizes of the entries of K: |K|, and a thousandth of the bound of a positive semidefinite matrix if that is
    /// larger.
    fn sizes(&self) -> DMatrix<f64> {
        let of = |i: usize, j: usize| self.stiffness[(i, j)].abs().max(1e-3 * diagonal(&self.stiffness, i, j));
        DMatrix::from_fn(self.size(), self.size(), of)
    }

    fn read_fields<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) -> Option<Self> {
        let nodes = reader.required(fields, "nodes").and_then(|node| nodes(reader, node));
        let modes = fields.get("modes").map_or(Some(0), |node| reader.count(node, 0, TUNING.most_modes));
        let (mass, stiffness) = (reader.required(fields, "mass"), reader.required(fields, "stiffness"));
        let (nodes, modes) = (nodes?, modes?);
        let place = Places { nodes: nodes.len(), modes };
        let mass = mass.and_then(|node| place.matrix(reader, node, "mass"));
        let stiffness = stiffness.and_then(|node| place.matrix(reader, node, "stiffness"));
        let read = Self { nodes, modes, mass: mass?, stiffness: stiffness? };
        let at = |key: &str| fields.key_span(key);
        match read.defect(reader.model.is_spatial()) {
            Some((key, message, help)) => {
                reader.error(Code::BadMatrix, at(key), message, help.to_owned());
                None
            }
            None => Some(read),
        }
    }

    /// An error in the matrices: the key, the message, and the remedy.
    fn defect(&self, is_spatial: bool) -> Option<(&'static str, String, &'static str)> {
        let in_plane = |row: usize| row >= OF_NODE * self.nodes.len() || OF_PLANE.contains(&(row % OF_NODE));
        let used: Vec<usize> = (0..self.size()).filter(|&row| is_spatial || in_plane(row)).collect();
        if is_spatial && (0..self.size()).any(|row| !in_plane(row) && self.mass[(row, row)] == 0.0) {
            let help = "in space a node has six coordinates: x, y, z and the rotations about them, each with mass";
            return Some(("mass", "the matrices are those of the plane, but the model is spatial".to_owned(), help));
        }
        let mass = self.mass.select_rows(&used).select_columns(&used);
        let Some(factor) = Cholesky::new(mass) else {
            let help = "every motion of the nodes and modes has a kinetic energy";
            return Some(("mass", "the mass matrix is not positive definite".to_owned(), help));
        };
        let axes: &[usize] = if is_spatial { &[0, 1, 2] } else { &[0, 1] };
        let along = |axis: usize| {
            let along = self.translation(axis);
            along.dot(&(&self.mass * &along))
        };
        let total = along(0);
        for &axis in axes {
            let found = along(axis);
            if (found - total).abs() > TUNING.rounding_of_matrices * total {
                let name = ["x", "y", "z"][axis];
                let message = format!("the body's mass is {total:.6} kg along x, but {found:.6} kg along {name}");
                return Some(("mass", message, "are the rows in the order of the reference page, and in SI units?"));
            }
        }
        let rotations: &[usize] = if is_spatial { &[0, 1, 2] } else { &[2] };
        let motions = axes.iter().map(|&axis| (self.translation(axis), "displaced along", axis));
        let motions = motions.chain(rotations.iter().map(|&axis| (self.rotation(axis), "turned about", axis)));
        for (motion, how, axis) in motions {
            let force = &self.stiffness * &motion;
            let size = self.sizes() * motion.abs();
            if let Some(row) = used.iter().find(|&&row| force[row].abs() > TUNING.rounding_of_matrices * size[row]) {
                let name = ["x", "y", "z"][axis];
                let message = format!("the body is strained where it is {how} {name} as a whole (row {})", row + 1);
                let help = "the stiffness of a free body vanishes for rigid motions; are `nodes` where the matrices have them?";
                return Some(("stiffness", message, help));
            }
        }
        let stiffness = self.stiffness.select_rows(&used).select_columns(&used);
        let inverse = factor.l().try_inverse()?;
        let squares = (&inverse * stiffness * inverse.transpose()).symmetric_eigenvalues();
        let largest = squares.amax();
        (squares.min() < -1e-6 * largest).then(|| {
            (
                "stiffness",
                "the stiffness matrix is not positive semidefinite".to_owned(),
                "deformation stores energy, and never yields it",
            )
        })
    }
}

/// Numbers of nodes and modes, which the rows belong to.
struct Places {
    nodes: usize,
    modes: usize,
}

impl Places {
    /// A symmetric matrix: all of its rows, or each up to its diagonal.
    fn matrix<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, node: &Node, what: &str) -> Option<DMatrix<f64>> {
        let rows = list(reader, node, "a list of rows")?;
        let sizes = [OF_NODE, OF_PLANE.len()].map(|of_node| of_node * self.nodes + self.modes);
        let Some(plane) = sizes.iter().position(|size| *size == rows.len()) else {
            let [space, plane] = sizes;
            let message = format!("the {what} matrix has {} rows, not {space} (in the plane {plane})", rows.len());
            let help = "six rows a node (in the plane x, y and angle), then one a mode".to_owned();
            reader.error(Code::BadMatrix, node.span.clone(), message, help);
            return None;
        };
        let index = |row: usize| match plane {
            0 => row,
            _ if row < OF_PLANE.len() * self.nodes => OF_NODE * (row / OF_PLANE.len()) + OF_PLANE[row % OF_PLANE.len()],
            _ => OF_NODE * self.nodes + row - OF_PLANE.len() * self.nodes,
        };
        let mut matrix = DMatrix::zeros(sizes[0], sizes[0]);
        let mut is_full = None;
        for (row, entries) in rows.iter().enumerate() {
            let values = numbers(reader, entries)?;
            let full = *is_full.get_or_insert(values.len() == rows.len());
            let wanted = if full { rows.len() } else { row + 1 };
            if values.len() != wanted {
                let message =
                    format!("row {} of the {what} matrix has {} numbers, not {wanted}", row + 1, values.len());
                let help = "every row has all numbers, or every row ends with its diagonal".to_owned();
                reader.error(Code::BadMatrix, entries.span.clone(), message, help);
                return None;
            }
            for (column, value) in values.into_iter().enumerate() {
                let (i, j) = (index(row), index(column));
                if column < row && full {
                    let above: f64 = matrix[(j, i)];
                    let size = above.abs().max(value.abs());
                    if (above - value).abs() > TUNING.rounding_of_matrices * size
                        && (above - value).abs() > TUNING.rounding_of_matrices * diagonal(&matrix, i, j)
                    {
                        let (row, column) = (row + 1, column + 1);
                        let message = format!(
                            "the {what} matrix is not symmetric: row {row} has {value} in column {column}, row {column} has {above} in column {row}"
                        );
                        reader.error(Code::BadMatrix, entries.span.clone(), message, None);
                        return None;
                    }
                    matrix[(j, i)] = 0.5 * (above + value);
                    matrix[(i, j)] = matrix[(j, i)];
                    continue;
                }
                matrix[(i, j)] = value;
                if !full {
                    matrix[(j, i)] = value;
                }
            }
        }
        Some(matrix)
    }
}

/// √(a_ii a_jj), the scale of off-diagonal entries.
fn diagonal(matrix: &DMatrix<f64>, i: usize, j: usize) -> f64 {
    (matrix[(i, i)] * matrix[(j, j)]).abs().sqrt()
}

impl Value for Matrices {
    const IMAGE: Image = Image::Unknown;

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, at: Span, _: &Quantity) -> Option<Self> {
        let keys = || vec!["nodes", "modes", "mass", "stiffness"];
        if node.scalar().is_none() {
            let fields = reader.mapping("a set of matrices", keys(), node, at)?;
            return Self::read_fields(reader, &fields);
        }
        let (start, text) = reader.file(node)?;
        let root = reader.diagnostics.read_more(start, &text, |diagnostics| yaml::parse(&text, diagnostics))?;
        let root = root.moved(start);
        let fields = reader.mapping("a file of matrices", keys(), &root, root.span.start..root.span.start)?;
        Self::read_fields(reader, &fields)
    }

    fn schema(_: &mut SchemaGenerator) -> Schema {
        let rows = json_schema!({ "type": "array", "items": { "type": "array", "items": { "type": "number" } } });
        json_schema!({
            "anyOf": [
                { "description": "A YAML file of them, in the model's folder.", "type": "string" },
                {
                    "type": "object",
                    "properties": { "nodes": rows, "modes": { "type": "integer", "minimum": 0 }, "mass": rows, "stiffness": rows },
                    "required": ["nodes", "mass", "stiffness"],
                    "additionalProperties": false
                }
            ]
        })
    }
}

/// Positions of two or three numbers.
fn nodes<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node) -> Option<Vec<[f64; 3]>> {
    let items = list(reader, node, "a list of positions")?;
    let mut found = Vec::with_capacity(items.len());
    for item in items {
        match numbers(reader, item)?.as_slice() {
            &[x, y] => found.push([x, y, 0.0]),
            &[x, y, z] => found.push([x, y, z]),
            others => {
                let message = format!("a position has two or three numbers, not {}", others.len());
                reader.error(Code::WrongShape, item.span.clone(), message, None);
                return None;
            }
        }
    }
    Some(found)
}

fn list<'n, S: SymbolTable>(reader: &mut Reader<'_, S>, node: &'n Node, wanted: &str) -> Option<&'n [Node]> {
    match &node.value {
        yaml::Value::Sequence(items) if !items.is_empty() => Some(items),
        _ => {
            reader.error(
                Code::WrongShape,
                node.span.clone(),
                format!("{wanted} belongs here, but here is {}", node.kind()),
                None,
            );
            None
        }
    }
}

/// Plain numbers, in SI units.
fn numbers<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node) -> Option<Vec<f64>> {
    let mut found = Vec::new();
    for item in list(reader, node, "a list of numbers")? {
        let scalar = reader.scalar(item, "a number")?;
        let Some(number) = scalar.text.parse::<f64>().ok().filter(|number| number.is_finite()) else {
            let help = "matrices are plain numbers in SI units; `mass` and `stiffness` of the effect may be uncertain"
                .to_owned();
            reader.error(
                Code::NotANumber,
                item.span.clone(),
                format!("`{}` is not a number", clip(&scalar.text)),
                help,
            );
            return None;
        };
        found.push(number);
    }
    Some(found)
}
