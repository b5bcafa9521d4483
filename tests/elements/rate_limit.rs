//! Rate limits against scipy and ramps.

use mbint::results::Method;

use crate::common::{band, curve, largest, nominal, output, read, row, run};

fn follower(keys: &str, simulation: &str) -> String {
    format!(
        "
parameters: {{ r: {{ value: 0.8, unit: 1/s, tolerance: 5% }} }}
bodies: {{ cart: {{ mass: 2, coordinates: [x] }} }}
effects:
  command: {{ rate_limit: {{ rate: r, {keys} }} }}
  pull: {{ force: {{ on: cart, value: [3 N*command, 0] }} }}
initial: {{ cart.x: 0, cart.vx: 0 }}
outputs: {{ y: command, rate: command.rate, x: cart.x }}
simulation: {{ duration: 3, output_step: 0.25, {simulation} }}
"
    )
}

/// SciPy 1.17, `solve_ivp`, DOP853, rtol 1e-12.
#[test]
fn response_matches_scipy() {
    let wanted = [
        (0.25, 0.21942987),
        (0.5, 0.39092721),
        (1.0, 0.21441976),
        (1.5, -0.17888871),
        (2.0, -0.1802476),
        (3.0, 0.28955055),
    ];
    for (simulation, allowed) in [("step: 1e-3", 1e-4), ("scheme: explicit, tolerance: 1e-8", 1e-6)] {
        let text = follower("input: 0.5*sin(3*t), lag: 50 ms, lower: -0.2, upper: 0.4, initial: 0.1", simulation);
        let bounds = nominal(&read(&text));
        for (time, value) in wanted {
            let found = curve(&bounds, "y")[row(&bounds, time)];
            assert!((found - value).abs() < allowed, "{simulation}: {found} at {time}, not {value}");
        }
        assert!(largest(curve(&bounds, "rate").iter().copied()) < 0.801);
    }
}

/// A far goal is reached along a ramp of the rate; the bounds are those of the rate.
#[test]
fn a_step_becomes_a_ramp() {
    let bounds = run(&read(&follower("input: 100, lag: 10 ms", "step: 1e-3")));
    let band = band(output(&bounds, "y"), Method::Chebyshev);
    let off = |share: f64, found: &[f64]| largest(bounds.times.iter().zip(found).map(|(t, y)| y - share * 0.8 * t));
    // Far beyond the limit a smooth one is short of it by (ε/x)²/2.
    assert!(off(0.95, &band.lower) < 1e-4 && off(1.05, &band.upper) < 1e-4);
}

/// In loop with a state that depends on it: a position drive whose command cannot jump; the same written out by
/// `states`.
#[test]
fn rate_limit_matches_equivalent_states() {
    let own = follower("input: (2 - cart.x)/(1 m), lag: 20 ms", "step: 1e-3");
    let written = own.replace("effects:\n", "states: { command: { rate: \"0.5*(sqrt((((2 - cart.x)/(1 m) - command)/(20 ms) + r)^2 + (0.01*r)^2) - sqrt((((2 - cart.x)/(1 m) - command)/(20 ms) - r)^2 + (0.01*r)^2))\", initial: 0 } }\neffects:\n");
    let start = written.find("  command: {").unwrap();
    let end = start + written[start..].find('\n').unwrap();
    let written = format!("{}{}", &written[..start], &written[end + 1..]);
    let [own, written] = [own, written].map(|text| nominal(&read(&text)));
    for name in ["y", "x"] {
        let off = largest(curve(&own, name).iter().zip(curve(&written, name)).map(|(a, b)| a - b));
        assert!(off < 1e-9, "{name}: {off:e}");
    }
}
