//! States, of which the names are known before anything is read that may speak of them.

use std::collections::HashMap;

use super::quantity::Dimension;
use super::symbols::Sensor;

/// What a state measures: its value, and how fast it changes.
type Measures = [(Sensor, Dimension); 2];

/// States by name, with their units as far as these are known.
#[derive(Clone, Debug, Default)]
pub struct DeclaredStates {
    places: HashMap<String, usize>,
    measures: Vec<Measures>,
}

impl DeclaredStates {
    /// Makes a name known; of several of the same name the first stands.
    pub fn add(&mut self, name: &str) {
        self.places.entry(name.to_owned()).or_insert(self.measures.len());
        self.measures.push([Sensor::VALUE, Sensor::CHANGE].map(|sensor| (sensor.of_unknown_unit(), Dimension::NUMBER)));
    }

    /// The place of a name whose unit is unknown.
    pub fn without_unit(&self, name: &str) -> Option<usize> {
        let place = *self.places.get(name)?;
        (!self.measures[place][0].0.has_unit()).then_some(place)
    }

    /// Says what a state measures.
    pub fn set(&mut self, place: usize, dimension: Dimension) {
        self.measures[place] = [(Sensor::VALUE, dimension), (Sensor::CHANGE, dimension.per(Dimension::TIME))];
    }

    /// What a name's measure is, with the name's place; nothing for other names, and nothing within for other measures.
    pub(super) fn measure(&self, name: &str, member: &str) -> Option<Option<(usize, Sensor)>> {
        let place = *self.places.get(name)?;
        let found = self.measures[place].iter().find(|(sensor, _)| sensor.name() == member);
        Some(found.map(|&(sensor, _)| (place, sensor)))
    }

    /// What the state in a place measures.
    pub(super) fn measures_of(&self, place: usize) -> &[(Sensor, Dimension)] {
        self.measures.get(place).map_or(&[], |measures| measures)
    }
}
