//! The half car in space: both formulations, and its mirror.

use mbint::inner::model::Formulation;

use crate::common::{Vary, curve, distance, model, nominal, read};

/// Absolute coordinates have constraints at ball joints and track rods, joint coordinates other ones.
#[test]
fn the_half_car_moves_alike_in_both_formulations() {
    let [absolute, joint] = [Formulation::Absolute, Formulation::Joint].map(|formulation| {
        let mut description = model("half_car").step(1e-3);
        description.simulation.formulation = formulation;
        nominal(&description)
    });
    for (name, size) in [("height", 0.016), ("roll", 0.02)] {
        let apart = distance(curve(&absolute, name), curve(&joint, name));
        // Errors of the steps, which differ between the formulations.
        assert!(apart < 2e-3 * size, "{name}: {apart}");
    }
}

/// Without bumps both sides are alike.
#[test]
fn the_half_car_does_not_roll_on_a_level_road() {
    let text = include_str!("../../models/half_car.yaml").replace("bump_h:   { value: 40,", "bump_h:   { value: 0,");
    let bounds = nominal(&read(&text));
    assert!(curve(&bounds, "roll").iter().all(|roll| roll.abs() < 1e-9));
    assert!(curve(&bounds, "height").iter().any(|height| (height - 0.52).abs() > 1e-4), "it settles on its springs");
}
