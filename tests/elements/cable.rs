//! Cables: a fall into a rope.

use crate::common::power::{APART, APART_IN_SPACE, assert_balance, pair, spatial_pair};
use crate::common::{curve, distance_from, largest, nominal, read, row};

/// A jumper on a rope: free fall, then the rope: at the lowest point m g (ℓ₀ + x) = ½ k x², and back to where he was.
#[test]
fn a_cable_is_slack_and_then_taut() {
    let description = read(
        "
bodies: { jumper: { mass: 70, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  rope: { cable: { between: [ground, jumper], free_length: 10, stiffness: 200 } }
initial: { jumper.y: -1, jumper.vy: 0 }
outputs: { y: jumper.y, tension: rope.force, energy: energy }
simulation: { duration: 9, step: 1e-3, output_step: 1e-3 }
",
    );
    let (weight, k): (f64, f64) = (70.0 * 9.81, 200.0);
    let stretch = (weight + (weight * weight + 2.0 * k * weight * 9.0).sqrt()) / k;
    let runs = [2e-3, 1e-3].map(|h| nominal(&description.clone().step(h).rows_every(2e-3)));
    for bounds in &runs {
        let fall = (2.0 * 9.0_f64 / 9.81).sqrt();
        let early = row(bounds, 1.3);
        assert!(bounds.times[early] < fall);
        assert!(curve(bounds, "tension")[..early].iter().all(|tension| *tension == 0.0));
        assert!(distance_from(&bounds.times[..early], &curve(bounds, "y")[..early], |t| -1.0 - 4.905 * t * t) < 1e-9);
        let lowest = curve(bounds, "y").iter().copied().fold(0.0, f64::min);
        assert!((lowest + 10.0 + stretch).abs() < 1e-3, "{lowest} {stretch}");
        let energy = largest(curve(bounds, "energy").iter().map(|energy| energy + weight));
        assert!(energy < 2.0, "{energy}");
    }
}

/// Taut from the start on.
#[test]
fn stored_energy_equals_work_done() {
    assert_balance(&pair("", "  e: { cable: { between: [a.P, b.P], free_length: 0.05, stiffness: 50 } }", APART), "0");
    assert_balance(
        &spatial_pair("", "  e: { cable: { between: [a.P, b.P], free_length: 0.05, stiffness: 50 } }", APART_IN_SPACE),
        "0",
    );
}
