//! Measured values from a table: `time`, a column for each measured output, perhaps one for its noise.
//!
//! A heading is the output's name, and may have a unit: `x3 [mm]`. Without one, numbers are in the unit in which the
//! model shows the output. An empty cell was not measured.

use crate::grammar::unit::{Unit, number_and_unit};
use crate::model::{Description, Output, Simulation, Stepping};
use crate::syntax::suggest;
use crate::syntax::table::{Cell, Line, Table};
use crate::syntax::{Code, Coded};

use super::tuning::TUNING;

/// (√5 − 1)/2
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Suffix of the columns of noise bounds.
const NOISE: &str = "_noise";

/// A noise bound for all values of an output: its name, and the text of a quantity, as `0.1 mm`.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseBound {
    /// Name of the output.
    pub output: String,
    /// A number with a unit.
    pub value: String,
}

/// Why a table cannot be used, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{message}", Self::location(*.line, *.column))]
pub struct DataError {
    /// From 1; 0 if the error is one of the whole table.
    pub line: usize,
    /// Column of the character with which the cell begins, from 1.
    pub column: usize,
    /// The error and the remedy.
    pub message: String,
}

/// A measured value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measured {
    pub line: usize,
    /// s
    pub time: f64,
    /// Index of the output in the model.
    pub output: usize,
    /// SI
    pub value: f64,
    /// SI, greater than zero.
    pub noise: f64,
}

/// All measured values of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurements {
    pub(super) values: Vec<Measured>,
}

/// Quantity of a column.
#[derive(Clone, Copy, PartialEq)]
enum Quantity {
    Time,
    Value(usize),
    Noise(usize),
}

/// A column.
struct Column {
    quantity: Quantity,
    /// One of its unit in SI.
    si: f64,
}

impl DataError {
    fn at(line: usize, column: usize, message: impl Into<String>) -> Self {
        Self { line, column, message: message.into() }
    }

    fn location(line: usize, column: usize) -> String {
        if line == 0 { String::new() } else { format!("line {line}, column {column}: ") }
    }
}

impl Measurements {
    /// At most `most` of the values, spread over all by the golden ratio, so that no output is passed over.
    pub(super) fn thinned(&self, most: usize) -> Self {
        if self.values.len() <= most {
            return self.clone();
        }
        let mut indices: Vec<usize> =
            (0..most).map(|index| ((index as f64 * GOLDEN).fract() * self.values.len() as f64) as usize).collect();
        indices.sort_unstable();
        indices.dedup();
        Self { values: indices.into_iter().map(|index| self.values[index].clone()).collect() }
    }

    /// The time between rows of which one is at each measured time: the model's, or the longest, in whole steps; `None`
    /// if there is none, or if there would be too many rows.
    pub(super) fn row_step(&self, simulation: &Simulation) -> Option<f64> {
        let Simulation { duration, stepping, output_step, .. } = simulation;
        let times = || self.values.iter().map(|own| own.time).filter(|time| *time > 0.0 && time <= duration);
        let are_whole = |ratio: f64| (ratio - ratio.round()).abs() < TUNING.rounded_time && ratio > 0.5;
        if times().all(|time| are_whole(time / output_step)) {
            return Some(*output_step);
        }
        let least = duration / TUNING.most_rows;
        // Euclid's algorithm, up to a remainder that is rounding relative to the least step.
        let common = |mut a: f64, mut b: f64| {
            while b > TUNING.rounded_time * least {
                (a, b) = (b, (a - b * (a / b).round()).abs());
            }
            a
        };
        let step = times().reduce(common).filter(|step| *step >= least)?;
        let last = times().fold(0.0, f64::max);
        let step = last / (last / step).round();
        let are_steps = match stepping {
            Stepping::Fixed(fixed) => are_whole(step / fixed),
            Stepping::Tolerance(_) => true,
        };
        (are_steps && times().all(|time| are_whole(time / step))).then_some(step)
    }

    /// Reads a table for a model.
    ///
    /// # Errors
    /// At the first cell that cannot be used.
    pub fn read(text: &str, description: &Description, noise: &[NoiseBound]) -> Result<Self, DataError> {
        let table = Table::read(text);
        let Some((heading, lines)) = table.lines.split_first() else {
            return Err(DataError::at(0, 0, "the table is empty: it needs a heading, as `time, x`, and rows"));
        };
        let columns = columns(heading.number, &heading.cells, description)?;
        let bounds = bounds(noise, description)?;
        let mut values = Vec::new();
        for line in lines {
            if let Some(message) = table.misfit(line) {
                return Err(DataError::at(line.number, 1, message));
            }
            values.extend(measured(&table, line, &columns, description, &bounds)?);
        }
        if values.is_empty() {
            return Err(DataError::at(0, 0, "the table has no measured values below its heading"));
        }
        Ok(Self { values })
    }
}

/// One of the unit in which the model shows an output, in SI.
fn shown(output: &Output, description: &Description) -> f64 {
    description.display.get(&output.name).map_or(1.0, |unit| unit.si())
}

fn columns(line: usize, heading: &[Cell], description: &Description) -> Result<Vec<Column>, DataError> {
    let mut columns: Vec<Column> = Vec::new();
    for cell in heading {
        let wrong = |message: String| DataError::at(line, cell.column, message);
        let (name, unit) = match cell.text.split_once('[') {
            Some((name, unit)) => (name.trim(), Some(unit.trim_end().trim_end_matches(']').trim())),
            None => (cell.text, None),
        };
        let quantity = quantity(name, description).map_err(wrong)?;
        if columns.iter().any(|other| other.quantity == quantity) {
            return Err(wrong(format!("there are two columns `{name}`")));
        }
        let si = match (quantity, unit) {
            (_, Some(unit)) => of_unit(unit, quantity, description).map_err(wrong)?,
            (Quantity::Time, None) => 1.0,
            (Quantity::Value(output) | Quantity::Noise(output), None) => {
                shown(&description.outputs[output], description)
            }
        };
        columns.push(Column { quantity, si });
    }
    let has = |wanted: fn(&Quantity) -> bool| columns.iter().any(|column| wanted(&column.quantity));
    if !has(|quantity| *quantity == Quantity::Time) {
        return Err(DataError::at(line, 1, "there is no column `time`"));
    }
    if !has(|quantity| matches!(quantity, Quantity::Value(_))) {
        let known = description.outputs.iter().map(|output| output.name.as_str());
        let help = suggest::help("", "outputs", known).unwrap_or_default();
        return Err(DataError::at(line, 1, format!("no column is an output of the model; {help}")));
    }
    Ok(columns)
}

fn quantity(name: &str, description: &Description) -> Result<Quantity, String> {
    let output = |name: &str| description.outputs.iter().position(|output| output.name == name);
    if matches!(name, "time" | "t") {
        return Ok(Quantity::Time);
    }
    if let Some(output) = output(name) {
        return Ok(Quantity::Value(output));
    }
    if let Some(output) = name.strip_suffix(NOISE).and_then(output) {
        return Ok(Quantity::Noise(output));
    }
    let known = description.outputs.iter().map(|output| output.name.as_str()).chain(["time"]);
    let help = suggest::help(name, "columns", known).map_or_else(String::new, |help| format!("; {help}"));
    Err(format!("`{}` is no output of the model{help}", suggest::clip(name)))
}

/// Value of the unit in SI, if it has the column's dimension.
fn of_unit(text: &str, quantity: Quantity, description: &Description) -> Result<f64, String> {
    let unit = Unit::parse(text).map_err(|error| error.message)?;
    let wanted = match quantity {
        Quantity::Time => Unit::parse("s").ok().map(|second| second.dimension),
        Quantity::Value(output) | Quantity::Noise(output) => description.outputs[output].dimension,
    };
    match wanted {
        Some(wanted) if !unit.dimension.fits(wanted) => {
            Err(format!("`{text}` is a unit of {}, but the column is {}", unit.dimension.noun(), wanted.noun()))
        }
        _ => Ok(unit.to_si(1.0)),
    }
}

/// Noise bounds of outputs, by index, SI.
fn bounds(noise: &[NoiseBound], description: &Description) -> Result<Vec<Option<f64>>, DataError> {
    let mut bounds = vec![None; description.outputs.len()];
    for bound in noise {
        let wrong =
            |message: String| DataError::at(0, 0, format!("noise `{}={}`: {message}", bound.output, bound.value));
        let Quantity::Value(output) = quantity(&bound.output, description).map_err(wrong)? else {
            return Err(wrong(format!("`{}` is no output of the model", bound.output)));
        };
        let own = match number_and_unit(&bound.value) {
            Some((number, unit, _)) => number * of_unit(unit, Quantity::Noise(output), description).map_err(wrong)?,
            None => {
                let number: Result<f64, _> = bound.value.trim().parse();
                let number = number.map_err(|_| wrong("it is no number with a unit, as `0.1 mm`".to_owned()))?;
                number * shown(&description.outputs[output], description)
            }
        };
        if !(own > 0.0 && own.is_finite()) {
            return Err(wrong("a noise bound is greater than zero".to_owned()));
        }
        if bounds[output].replace(own).is_some() {
            return Err(wrong("it is given twice".to_owned()));
        }
    }
    Ok(bounds)
}

/// Measured values of a line.
fn measured(
    table: &Table,
    line: &Line,
    columns: &[Column],
    description: &Description,
    bounds: &[Option<f64>],
) -> Result<Vec<Measured>, DataError> {
    let Line { number: line, cells } = line;
    let line = *line;
    let number = |index: usize| -> Result<Option<f64>, DataError> {
        if cells[index].text.is_empty() {
            return Ok(None);
        }
        let number =
            table.number(&cells[index]).map_err(|message| DataError::at(line, cells[index].column, message))?;
        Ok(Some(number * columns[index].si))
    };
    let find = |wanted: Quantity| columns.iter().position(|column| column.quantity == wanted);
    // `columns` has made sure that there is one.
    let Some(of_time) = find(Quantity::Time) else { return Ok(Vec::new()) };
    let at = cells[of_time].column;
    let time = number(of_time)?.ok_or_else(|| DataError::at(line, at, "there is no time in this row"))?;
    let end = description.simulation.duration;
    if !(0.0..=end * (1.0 + 1e-9)).contains(&time) {
        let message = format!("the time {time} s is outside of the simulation, which is from 0 to {end} s");
        return Err(DataError::at(line, at, message));
    }
    let mut values = Vec::new();
    for (index, column) in columns.iter().enumerate() {
        let Quantity::Value(output) = column.quantity else { continue };
        let Some(value) = number(index)? else { continue };
        let of_noise = find(Quantity::Noise(output));
        let noise = of_noise.map(number).transpose()?.flatten().or(bounds[output]).ok_or_else(|| {
            let name = &description.outputs[output].name;
            let message =
                format!("the noise of `{name}` is not known: add a column `{name}{NOISE}`, or `--noise {name}=…`");
            DataError::at(line, cells[index].column, message)
        })?;
        if noise <= 0.0 {
            let column = of_noise.map_or(1, |index| cells[index].column);
            return Err(DataError::at(line, column, "a noise bound is greater than zero"));
        }
        values.push(Measured { line, time: time.min(end), output, value, noise });
    }
    Ok(values)
}

impl Coded for DataError {
    fn code(&self) -> Option<Code> {
        Some(Code::BadData)
    }
}
