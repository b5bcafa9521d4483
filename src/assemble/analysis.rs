//! What an analysis makes of the equations.

use super::System;
use super::system::Start;

impl System {
    /// Without forces and masses: w minimises Σ (w/scale)², and so is what the constraints make of it. Where they leave no freedom,
    /// nothing else is.
    pub(super) fn forget_forces(&mut self) {
        let graph = &mut self.graph;
        let mut mass = Vec::with_capacity(self.q.len());
        let mut inertia = Vec::with_capacity(self.q.len());
        for (place, (coordinate, &w)) in self.coordinates.iter().zip(&self.w).enumerate() {
            let weight = graph.constant(coordinate.scale.powi(-2));
            mass.push((place, place, weight));
            inertia.push(graph.mul(weight, w));
        }
        let nothing = vec![graph.constant(0.0); self.q.len()];
        (self.mass, self.inertia) = (mass, inertia);
        (self.force, self.conditional, self.active_condition) = (nothing.clone(), nothing, None);
    }
}

impl Start {
    /// Positions are known: nothing is given of them, and nothing decides where they are left open.
    pub fn leave_positions(&mut self) {
        self.position.fill(None);
        self.conditions.iter_mut().for_each(|condition| condition.position = false);
        self.conditions.retain(|condition| condition.velocity);
        if let Some(nearest) = &mut self.nearest {
            let nearest = std::sync::Arc::make_mut(nearest);
            nearest.distances.iter_mut().for_each(|distance| distance.position = false);
        }
    }
}
