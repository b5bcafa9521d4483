//! The half car in space, and its mirror.

use crate::common::{curve, nominal, read};

/// Without bumps both sides are alike.
#[test]
fn the_half_car_does_not_roll_on_a_level_road() {
    let text = include_str!("../../models/half_car.yaml").replace("bump_h:   { value: 40,", "bump_h:   { value: 0,");
    let bounds = nominal(&read(&text));
    assert!(curve(&bounds, "roll").iter().all(|roll| roll.abs() < 1e-9));
    assert!(curve(&bounds, "height").iter().any(|height| (height - 0.52).abs() > 1e-4), "it settles on its springs");
}
