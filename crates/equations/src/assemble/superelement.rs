//! Flexible bodies by their matrices, as the effects of a description give them.

use crate::elements::effects::Carried;
use crate::model::{Description, ReducedInertia};

/// A flexible body by its matrices.
pub struct Superelement<'d> {
    /// Index of the effect among all.
    pub effect: usize,
    /// Its nodes and matrices.
    pub inertia: ReducedInertia<'d>,
    /// Inertia of the whole body in the axes of its first node.
    pub carried: Carried,
}

/// The superelements of a description.
pub fn superelements(description: &Description) -> Vec<Superelement<'_>> {
    let effects = description.effects.iter().enumerate();
    let found = effects.filter_map(|(effect, kind)| Some((effect, kind.kind.reduced_inertia()?)));
    found.map(|(effect, inertia)| Superelement { effect, inertia, carried: Carried::of(inertia.matrices) }).collect()
}
