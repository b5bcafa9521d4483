//! `tables:`: functions given by their values, here or in a CSV file.

use symdiff::{Spline, SplineError};

use super::parameters::unit;
use crate::grammar::reader::FunctionTable;
use crate::grammar::report::Fields;
use crate::grammar::unit::Unit;
use crate::keys;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::table::{self, Cell, Line};
use crate::syntax::yaml::{Entry, Node, Value};

/// A value of a table and its location.
type Number = (f64, Span);

/// Reads the tables.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    for entry in entries {
        let named = reader.name(entry, "a table");
        let table = table(reader, entry);
        reader.tables.extend(table.filter(|_| named));
    }
}

fn table(reader: &mut Reader, entry: &Entry) -> Option<FunctionTable> {
    let fields = reader.fields::<keys::Table>(&entry.value, entry.key_span.clone())?;
    let units = units(reader, &fields)?;
    let points = match (fields.get("file"), fields.get("points")) {
        (Some(file), None) => from_file(reader, &fields, file)?,
        (None, Some(points)) => listed(reader, points)?,
        (Some(_), Some(_)) => {
            reader.error(
                Code::ExclusiveKeys,
                fields.key_span("points"),
                "`file` and `points` exclude each other",
                None,
            );
            return None;
        }
        (None, None) if !fields.lacks_all(&["file", "points"]) => return None,
        (None, None) => {
            let help = "e.g. `{ file: road.csv }` or `{ points: [[0, 0], [1, 2]] }`".to_owned();
            reader.error(Code::IncompleteElement, fields.at.clone(), "a table needs `file` or `points`", help);
            return None;
        }
    };
    let to_si = |unit: Option<Unit>, value: f64| unit.map_or(value, |unit| unit.to_si(value));
    let values: Vec<(f64, f64)> = points.iter().map(|[x, y]| (to_si(units[0], x.0), to_si(units[1], y.0))).collect();
    let periodic = match fields.get("periodic") {
        Some(node) => reader.choice(node, &[("true", true), ("false", false)])?,
        None => false,
    };
    let linear = match fields.get("interpolation") {
        Some(node) => reader.choice(node, &[("cubic", false), ("linear", true)])?,
        None => false,
    };
    let spline = match (linear, periodic) {
        (false, false) => Spline::through(&values),
        (false, true) => Spline::periodic(&values),
        (true, false) => Spline::linear(&values),
        (true, true) => {
            let help = "leave out `periodic`, or `interpolation: linear`".to_owned();
            reader.error(
                Code::BadTable,
                fields.key_span("interpolation"),
                "a periodic table is smooth, not linear",
                help,
            );
            return None;
        }
    };
    match spline {
        Ok(spline) => {
            let dimensions = units.map(|unit| unit.map(|unit| unit.dimension));
            Some(FunctionTable { name: entry.key.clone(), spline, dimensions })
        }
        Err(error) => {
            let (message, place) = match error {
                SplineError::TooFew => ("a table has at least two points", entry.key_span.clone()),
                SplineError::NotFinite(point) => ("this point is not finite", points[point][0].1.clone()),
                SplineError::NotAscending(point) => {
                    ("arguments ascend, but this one does not come after the one before", points[point][0].1.clone())
                }
                SplineError::NotPeriodic => {
                    let last = points.last().map_or_else(|| entry.key_span.clone(), |point| point[1].1.clone());
                    ("a periodic table ends with the value that it begins with", last)
                }
            };
            reader.error(Code::BadTable, place, message, None);
            None
        }
    }
}

fn units(reader: &mut Reader, fields: &Fields) -> Option<[Option<Unit>; 2]> {
    let Some(node) = fields.get("units") else { return Some([None; 2]) };
    let pair = reader.two(node, "a list of two units")?;
    let [x, y] = pair.map(|node| unit(reader, node));
    Some([Some(x?), Some(y?)])
}

/// Pairs in the model itself.
fn listed(reader: &mut Reader, node: &Node) -> Option<Vec<[Number; 2]>> {
    let Value::Sequence(items) = &node.value else {
        let message = format!("a list of pairs belongs here, but here is {}", node.kind());
        reader.error(Code::WrongShape, node.span.clone(), message, "e.g. `[[0, 0], [1, 2]]`".to_owned());
        return None;
    };
    let number = |reader: &mut Reader, node: &Node| {
        let scalar = reader.scalar(node, "a number")?;
        let value = scalar.text.parse::<f64>().ok().filter(|value| value.is_finite());
        if value.is_none() {
            reader.error(Code::BadTable, node.span.clone(), format!("`{}` is not a number", clip(&scalar.text)), None);
        }
        Some((value?, node.span.clone()))
    };
    items
        .iter()
        .map(|item| {
            let [x, y] = reader.two(item, "a pair of numbers")?;
            Some([number(reader, x)?, number(reader, y)?])
        })
        .collect()
}

/// Two columns of a file. Errors in it have their locations in it.
fn from_file(reader: &mut Reader, fields: &Fields, node: &Node) -> Option<Vec<[Number; 2]>> {
    let (start, text) = reader.file(node)?;
    let table = table::Table::read(&text);
    let Some(first) = table.lines.first() else {
        reader.error(Code::BadTable, node.span.clone(), "the file has no lines of numbers", None);
        return None;
    };
    let header = table.is_heading(first).then_some(first);
    let [x, y] = chosen_columns(reader, fields, header)?;
    let mut points = Vec::new();
    for line in &table.lines[usize::from(header.is_some())..] {
        let at = |cell: &Cell| start + cell.start..start + cell.start + cell.text.len();
        if let Some(message) = table.misfit(line) {
            reader.error(Code::BadTable, at(&line.cells[0]), message, None);
            return None;
        }
        let mut number = |column: usize| {
            let Some(cell) = line.cells.get(column) else {
                reader.error(
                    Code::BadTable,
                    at(&line.cells[0]),
                    format!("this line has no column {}", column + 1),
                    None,
                );
                return None;
            };
            match table.number(cell) {
                Ok(number) => Some((number, at(cell))),
                Err(message) => {
                    reader.error(Code::BadTable, at(cell), message, None);
                    None
                }
            }
        };
        points.push([number(x)?, number(y)?]);
    }
    Some(points)
}

/// Places of the columns that `columns` names, with the file's first line where that is a header.
fn chosen_columns(reader: &mut Reader, fields: &Fields, header: Option<&Line>) -> Option<[usize; 2]> {
    let Some(node) = fields.get("columns") else { return Some([0, 1]) };
    let [x, y] = reader.two(node, "a list of two columns")?.map(|node| {
        let scalar = reader.scalar(node, "the name of a column")?;
        if let Some(index) = header.and_then(|header| header.cells.iter().position(|cell| cell.text == scalar.text)) {
            return Some(index);
        }
        if let Some(number) = scalar.text.parse::<usize>().ok().filter(|number| *number > 0) {
            return Some(number - 1);
        }
        let help = match header {
            Some(header) => suggest::help(&scalar.text, "columns", header.cells.iter().map(|cell| cell.text)),
            None => Some("the file has no header: give the columns' numbers".to_owned()),
        };
        reader.error(
            Code::BadTable,
            node.span.clone(),
            format!("the file has no column `{}`", clip(&scalar.text)),
            help,
        );
        None
    });
    Some([x?, y?])
}
