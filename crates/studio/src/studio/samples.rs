//! Outputs over time at requested samples, simulated as by `mbint sample`.

use std::sync::{Mutex, PoisonError};

use serde_json::{Value, json};

use super::desk::{Current, Desk};
use super::questions::{Values, replaced};
use super::requests::Asked;
use crate::numerics::Sample;
use crate::study::{self, ChosenSamples, RunError, Sampled};

/// Serves one model after the other, until the end.
pub fn work(desk: &Desk) {
    let mut seen = 0;
    while let Some(current) = desk.next_model(seen) {
        seen = current.number;
        let is_replaced = || desk.is_replaced(seen);
        // Waits for the first request.
        let Some(first) = desk.samples.next(&is_replaced) else { continue };
        if first.question.number != seen {
            first.answer(Err(replaced()));
            seen = 0;
            continue;
        }
        let wanted = Mutex::new(first.question.sample.clone());
        let mut asked = Some(first);
        let served = study::caught("the samples", || {
            serve(desk, &current, &wanted, &mut asked).map_err(|error| error.to_string())
        });
        let why = match served {
            Ok(Ok(())) => continue,
            Ok(Err(error)) => error,
            Err(error) => error.to_string(),
        };
        asked.into_iter().for_each(|asked| asked.answer(Err(why.clone())));
        while let Some(asked) = desk.samples.next(&is_replaced) {
            asked.answer(Err(why.clone()));
        }
    }
}

/// Compiles a model once and simulates requested samples, until another model replaces it.
fn serve(
    desk: &Desk,
    current: &Current,
    wanted: &Mutex<Sample>,
    asked: &mut Option<Asked<Values>>,
) -> Result<(), RunError> {
    let is_replaced = || desk.is_replaced(current.number);
    let options = study::Options { interrupted: &is_replaced, ..study::Options::default() };
    let at = |_| vec![wanted.lock().unwrap_or_else(PoisonError::into_inner).clone()];
    study::sample(&current.description, &options, ChosenSamples { count: 1, at: &at }, |trajectories| {
        while let Some(own) = asked.take().or_else(|| desk.samples.next(&is_replaced)) {
            if own.question.number != current.number {
                own.answer(Err(replaced()));
                continue;
            }
            *wanted.lock().unwrap_or_else(PoisonError::into_inner) = own.question.sample.clone();
            let mut values = Vec::new();
            let sampled = trajectories.each(|found| {
                values = found.to_vec();
                Ok::<(), RunError>(())
            });
            let outputs = &trajectories.outputs;
            own.answer(match sampled {
                Err(error) => Err(error.to_string()),
                Ok(None) => Err(replaced()),
                Ok(Some(Sampled { closed: 1.., .. })) => {
                    Err("the mechanism cannot be assembled at these values".to_owned())
                }
                Ok(Some(Sampled { stopped, .. })) => Ok(curves(&trajectories.times, outputs, &values, stopped > 0)),
            });
        }
        Ok(())
    })
}

/// The outputs of a sample: `values` are (row, output).
fn curves(times: &[f64], outputs: &[(String, String)], values: &[f64], is_stopped: bool) -> Value {
    let of_output = |(index, (name, unit)): (usize, &(String, String))| {
        let own: Vec<f64> = values.iter().skip(index).step_by(outputs.len()).copied().collect();
        json!({ "name": name, "unit": unit, "values": own })
    };
    let outputs: Vec<Value> = outputs.iter().enumerate().map(of_output).collect();
    json!({ "times": times, "outputs": outputs, "stopped": is_stopped })
}
