//! States, whose names are known before anything that may refer to them is read.

use std::collections::HashMap;

use super::quantity::Dimension;
use super::symbols::Sensor;

/// Measures of a state: its value, and its rate of change.
type Measures = [(Sensor, Dimension); 2];

/// States by name, with their units as far as these are known.
#[derive(Clone, Debug, Default)]
pub struct DeclaredStates {
    indices: HashMap<String, usize>,
    measures: Vec<Measures>,
}

impl DeclaredStates {
    /// Declares a name; of several states of the same name, the first counts.
    pub fn add(&mut self, name: &str) {
        self.indices.entry(name.to_owned()).or_insert(self.measures.len());
        self.measures.push([Sensor::VALUE, Sensor::CHANGE].map(|sensor| (sensor.of_unknown_unit(), Dimension::NUMBER)));
    }

    /// Index of a name whose unit is unknown.
    pub fn without_unit(&self, name: &str) -> Option<usize> {
        let index = *self.indices.get(name)?;
        (!self.measures[index][0].0.has_unit()).then_some(index)
    }

    /// Sets the dimension of a state.
    pub fn set(&mut self, index: usize, dimension: Dimension) {
        self.measures[index] = [(Sensor::VALUE, dimension), (Sensor::CHANGE, dimension.per(Dimension::TIME))];
    }

    /// Measure of a state, with the state's index; `None` for other names, `Some(None)` for other measures.
    pub(super) fn measure(&self, name: &str, member: &str) -> Option<Option<(usize, Sensor)>> {
        let index = *self.indices.get(name)?;
        let found = self.measures[index].iter().find(|(sensor, _)| sensor.name() == member);
        Some(found.map(|&(sensor, _)| (index, sensor)))
    }

    /// Measures of the state with an index.
    pub(super) fn measures_of(&self, index: usize) -> &[(Sensor, Dimension)] {
        self.measures.get(index).map_or(&[], |measures| measures)
    }
}
