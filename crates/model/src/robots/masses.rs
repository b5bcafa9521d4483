//! Parts that make up one body:
//!
//! ```text
//! m = Σ mᵢ,   m c = Σ mᵢ cᵢ,   J = Σ Rᵢ Jᵢ Rᵢᵀ + mᵢ (dᵢ² 1 − dᵢ dᵢᵀ),   dᵢ = cᵢ − c
//! ```

use super::algebra::{self, Value, Vector};

/// Mass, centre of mass and inertia about it of a part, in the frame of its body.
pub struct MassPart {
    pub mass: Value,
    pub center: Vector,
    pub inertia: [Vector; 3],
}

/// The centre of mass of all parts, whose masses add up to `mass`; without mass it is nowhere, and at 0.
pub fn center(parts: &[MassPart], mass: &Value) -> Vector {
    match parts {
        _ if mass.is_zero() => algebra::vector([0.0; 3]),
        [part] => part.center.clone(),
        parts => std::array::from_fn(|i| {
            let moments: Vec<Value> = parts.iter().map(|part| algebra::mul(&part.mass, &part.center[i])).collect();
            algebra::div(&algebra::sum(&moments), mass)
        }),
    }
}

/// Inertia of all parts about their centre of mass.
pub fn inertia(parts: &[MassPart], center: &Vector) -> [Vector; 3] {
    let steiner = |part: &MassPart| {
        let d: Vector = std::array::from_fn(|i| algebra::sub(&part.center[i], &center[i]));
        algebra::steiner(&part.mass, &d)
    };
    let shifts: Vec<[Vector; 3]> = if parts.len() > 1 { parts.iter().map(steiner).collect() } else { Vec::new() };
    std::array::from_fn(|i| {
        std::array::from_fn(|k| {
            let terms: Vec<Value> = parts
                .iter()
                .enumerate()
                .flat_map(|(index, part)| {
                    let shift = shifts.get(index).map_or_else(|| algebra::number(0.0), |shift| shift[i][k].clone());
                    [part.inertia[i][k].clone(), shift]
                })
                .collect();
            algebra::sum(&terms)
        })
    })
}
