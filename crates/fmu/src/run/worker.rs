//! A process that answers points in JSON lines, the protocol of black boxes.

use std::collections::BTreeMap;
use std::io::{BufRead, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::task::{STEP, Task};
use super::{co_simulation, model_exchange};
use crate::native::{Fault, Instance, Native};
use crate::unit::{Interface, Unit};

/// Values of a point by names.
type Values = BTreeMap<String, f64>;

/// A point.
#[derive(Deserialize)]
struct Asked {
    point: u64,
    parameters: Values,
    times: Vec<f64>,
}

/// Its answer.
#[derive(Serialize)]
struct Answer<'a> {
    point: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    outputs: BTreeMap<&'a str, Vec<Option<f64>>>,
}

/// Answers points until there are no more, with the unit in a folder that [`super::Unpacked`] made. Every point has an
/// instance of its own, so that no other point affects its answer.
///
/// # Errors
/// If the folder has no unit, its library cannot be loaded, or input or output ends in the middle of a line.
pub fn answer(folder: &Path, input: impl BufRead, mut output: impl Write) -> std::io::Result<()> {
    let task = Task::read(folder)?;
    let text = std::fs::read_to_string(folder.join("modelDescription.xml"))?;
    let unit = Unit::of_text(&text).map_err(std::io::Error::other)?;
    let native = Native::load(&unit, folder, task.interface).map_err(std::io::Error::other)?;
    for line in input.lines() {
        let asked: Asked = serde_json::from_str(&line?)?;
        let (error, rows) = match motion(&task, &unit, &native, &asked) {
            Ok(rows) => (None, rows),
            Err(fault) => (Some(fault.to_string()), Vec::new()),
        };
        let names = task.outputs.iter().map(|own| own.name.as_str());
        let answer = Answer { point: asked.point, error, outputs: names.zip(rows).collect() };
        // The unit may have written a part of a line.
        writeln!(output, "\n{}", serde_json::to_string(&answer)?)?;
        output.flush()?;
    }
    Ok(())
}

/// Values of each output in each row; `None` if not finite.
fn motion(task: &Task, unit: &Unit, native: &Native, asked: &Asked) -> Result<Vec<Vec<Option<f64>>>, Fault> {
    let mut instance = native.instance()?;
    for own in &task.parameters {
        if let Some(&value) = asked.parameters.get(&own.name) {
            instance.set(own.kind, own.reference, own.of_si(value))?;
        }
    }
    let end = asked.times.last().copied().unwrap_or(0.0);
    instance.initialise(end)?;
    let mut rows: Vec<Vec<Option<f64>>> = task.outputs.iter().map(|_| Vec::with_capacity(asked.times.len())).collect();
    let mut row = |instance: &mut dyn Instance| {
        for (own, column) in task.outputs.iter().zip(&mut rows) {
            let value = own.to_si(instance.get(own.kind, own.reference)?);
            column.push(value.is_finite().then_some(value));
        }
        Ok(())
    };
    let step = asked.parameters.get(STEP).copied().unwrap_or(f64::INFINITY);
    match task.interface {
        Interface::CoSimulation => co_simulation::run(&mut *instance, &asked.times, step, &mut row)?,
        Interface::ModelExchange => {
            model_exchange::run(&mut *instance, unit.states, &asked.times, step, &mut row)?;
        }
    }
    Ok(rows)
}
