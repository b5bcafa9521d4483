//! Names and units of the results about small vibrations.

use super::vibrations::Vibrations;
use crate::assemble::{OutputInfo, System};
use crate::grammar::quantity::Dimension;

/// The name of the largest growth of any mode among the outputs.
const GROWTH: &str = "growth";

/// Results about a mode without states.
const QUANTITIES: &[(&str, &str)] = &[("frequency", "Hz"), ("damping", "")];

/// Whether an output is not one of the many numbers of a mode's shape or of a response.
pub fn is_one_number(name: &str) -> bool {
    !name.contains(".shape.") && !name.starts_with("response.")
}

/// Adds the outputs of a mechanism's vibrations after the model's.
pub fn further_outputs(system: &mut System, vibrations: &Vibrations) {
    let model: Vec<OutputInfo> = system.outputs.iter().filter(|output| !output.is_derived()).cloned().collect();
    let quantities = vibrations.quantities();
    let expr = system.graph.constant(0.0);
    let is_random = !system.random.is_empty();
    let mut add = |name: String, unit: String| {
        system.outputs.push(OutputInfo { name, unit, dimension: None, expr, of_results: None });
    };
    if quantities.is_some() {
        let taken = |name: &str| model.iter().any(|output| output.name == name);
        let mut name = GROWTH.to_owned();
        while taken(&name) {
            name.push('_');
        }
        add(name, "1/s".to_owned());
    }
    for mode in 1..=vibrations.number() {
        let own = quantities.as_ref().map_or(QUANTITIES, |quantities| quantities[mode - 1]);
        own.iter().for_each(|(quantity, unit)| add(format!("mode{mode}.{quantity}"), (*unit).to_owned()));
        model.iter().for_each(|output| add(format!("mode{mode}.shape.{}", output.name), String::new()));
    }
    for response in &system.modes.responses {
        let unit_of = |name: &str| model.iter().find(|output| output.name == name);
        let force = unit_of(&response.load).is_some_and(|load| load.dimension == Some(Dimension::ANGLE));
        let force = if force { "(N*m)" } else { "N" };
        let unit = unit_of(&response.output).map_or("", |output| output.unit.as_str());
        let unit = format!("{}/{force}", if unit.is_empty() { "1" } else { unit });
        for (index, _) in response.frequencies.iter().enumerate() {
            add(format!("response.{}.{index}.amplitude", response.name), unit.clone());
            add(format!("response.{}.{index}.phase", response.name), "rad".to_owned());
        }
    }
    if is_random {
        for output in &model {
            add(format!("{}.rms", output.name), output.unit.clone());
            add(format!("{}.crossings", output.name), "Hz".to_owned());
        }
    }
}
