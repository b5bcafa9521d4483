//! Filters against closed forms and scipy.

use mbint::results::Method;

use crate::common::{band, curve, largest, nominal, output, read, run};

/// A model of filters and a mass that starts at rest.
fn filters(effects: &str, outputs: &str, simulation: &str) -> String {
    format!(
        "
parameters: {{ tau: {{ value: 0.2, unit: s, tolerance: 10% }} }}
bodies: {{ m: {{ mass: 1, coordinates: [x] }} }}
effects: {{ {effects} }}
initial: {{ m.x: 0.5, m.vx: 0 }}
outputs: {{ {outputs}, tau: tau }}
simulation: {{ duration: 3, output_step: 0.5, {simulation} }}
bounds: {{ chebyshev: {{ order: 5 }}, scan: {{ points: 5 }} }}
"
    )
}

const SIMULATIONS: [(&str, f64); 3] =
    [("step: 1e-3", 2e-5), ("step: 1e-2, extrapolation: 4", 1e-6), ("scheme: explicit, tolerance: 1e-9", 1e-8)];

/// A lag, a lead and an integral of a ramp.
#[test]
fn filters_of_a_ramp_follow_their_closed_forms() {
    let effects = "lag: { filter: { input: t, numerator: [1], denominator: [tau, 1] } },
  lead: { filter: { input: t, numerator: [0.5 s, 1], denominator: [tau, 1] } },
  whole: { filter: { input: t, numerator: [3], denominator: [1 s, 0] } }";
    for (simulation, allowed) in SIMULATIONS {
        let bounds =
            nominal(&read(&filters(effects, "lag: lag, lead: lead, whole: whole, hurry: lag.rate", simulation)));
        for (row, &t) in bounds.times.iter().enumerate() {
            let risen = 1.0 - (-t / 0.2).exp();
            let wanted = [t - 0.2 * risen, t + (0.5 - 0.2) * risen, 1.5 * t * t, risen];
            for (name, value) in ["lag", "lead", "whole", "hurry"].into_iter().zip(wanted) {
                let found = curve(&bounds, name)[row];
                assert!((found - value).abs() < allowed, "{simulation}: {name} at {t}: {found}, not {value}");
            }
        }
        assert_eq!(
            ["lag", "lead", "whole", "hurry"].map(|name| output(&bounds, name).unit.clone()),
            ["s", "s", "s", ""]
        );
    }
}

/// The lag is behind a ramp by more where τ is longer, the lead ahead of it by less.
#[test]
fn bounds_match_those_of_the_time_constant() {
    let effects = "lag: { filter: { input: t, numerator: [1], denominator: [tau, 1] } },
  lead: { filter: { input: t, numerator: [0.5 s, 1], denominator: [tau, 1] } }";
    let bounds = run(&read(&filters(effects, "lag: lag, lead: lead", "step: 1e-3")));
    for method in [Method::Chebyshev, Method::Scan] {
        for (name, zero) in [("lag", 0.0), ("lead", 0.5)] {
            let band = band(output(&bounds, name), method);
            for (row, &t) in bounds.times.iter().enumerate() {
                let [upper, lower] = [0.18, 0.22].map(|tau: f64| t + (zero - tau) * (1.0 - (-t / tau).exp()));
                let allowed = 1.01 * band.error.total[row] + 1e-14;
                let off = largest([band.lower[row] - lower, band.upper[row] - upper]);
                assert!(off <= allowed && allowed < 1e-4, "{method:?} {name} at {t}: {off:e}, {allowed:e}");
            }
        }
    }
}

/// A Butterworth filter of order four with its corner at 5 rad/s; SciPy 1.17, `signal.tf2ss` and `solve_ivp`, DOP853,
/// rtol 1e-13.
#[test]
fn filter_of_order_four_matches_scipy() {
    let effects = "smooth: { filter: { input: 0.3 + sin(4*t), numerator: [625],
  denominator: [1, 13.0656296, 85.3553391, 326.64074, 625] } }";
    let wanted = [(1, 0.29141782), (2, 1.09967865), (4, -0.25727896), (6, 0.11506627)];
    for (simulation, allowed) in SIMULATIONS {
        let bounds = nominal(&read(&filters(effects, "smooth: smooth", simulation)));
        for (row, value) in wanted {
            let found = curve(&bounds, "smooth")[row];
            assert!((found - value).abs() < 3.0 * allowed, "{simulation}: {found}, not {value} in row {row}");
        }
    }
}

/// A spring that acts on the filtered position: the filter starts settled at the mass's position. SciPy as above, with
/// the filter in another form (a chain of rates, the output their sum).
#[test]
fn filter_in_a_closed_loop_matches_scipy() {
    let effects =
        "felt: { filter: { input: m.x, numerator: [0.05 s, 1], denominator: [0.01 s^2, 0.14 s, 1], initial: 0.5 m } },
  pull: { force: { on: m, value: [20 N/m*(0.2 m - felt) - 3 N*s/m*m.vx, 0] } }";
    let before = effects.split_once(",\n").map(|(filter, pull)| format!("{pull}, {filter}")).unwrap();
    let wanted = [
        (1, [0.10422988, -0.84774475, 0.19792115]),
        (2, [0.10119641, 0.69619274, 0.03750276]),
        (4, [0.14081410, -0.37987044, 0.18412003]),
        (6, [0.26922009, -0.06737261, 0.27087265]),
    ];
    for (effects, (simulation, allowed)) in [effects, &before].into_iter().zip(SIMULATIONS) {
        let bounds = nominal(&read(&filters(effects, "x: m.x, v: m.vx, felt: felt", simulation)));
        assert_eq!(output(&bounds, "felt").unit, "m");
        for (row, values) in wanted {
            for (name, value) in ["x", "v", "felt"].into_iter().zip(values) {
                let found = curve(&bounds, name)[row];
                assert!(
                    (found - value).abs() < 3.0 * allowed,
                    "{simulation}: {name} in row {row}: {found}, not {value}"
                );
            }
        }
    }
}

/// Any filter stays at its settled value: the gain times its constant input.
#[test]
fn settled_filter_stays_constant() {
    for (numerator, denominator, gain) in [
        ("[1]", "[tau, 1]", 1.0),
        ("[0.5 s, 3]", "[0.02 s^2, tau, 2]", 1.5),
        ("[2 s^2, 0.1 s, 3]", "[0.02 s^2, tau, 4]", 0.75),
        ("[tau, 0]", "[tau, 1]", 0.0),
        ("[1 s^3, 0.4 s^2, 0.1 s, 3]", "[0.01 s^3, 0.2 s^2, tau, 4]", 0.75),
    ] {
        let effects = format!(
            "it: {{ filter: {{ input: 2 m, numerator: {numerator}, denominator: {denominator}, initial: 2 m }} }}"
        );
        let bounds = run(&read(&filters(&effects, "it: it", "step: 1e-2")));
        let band = band(output(&bounds, "it"), Method::Chebyshev);
        let off = largest(band.lower.iter().chain(&band.upper).map(|value| value - 2.0 * gain));
        assert!(off < 1e-11, "{numerator}/{denominator}: {off:e}");
    }
}

/// In a mirrored instance angles count the other way, and a filter of something that does not is the same.
#[test]
fn a_mirrored_instance_filters_the_same() {
    let text = "
assemblies:
  arm:
    bodies: { rod: { mass: 1, inertia: 0.02, points: { pin: [-0.2, 0] } } }
    joints: { hinge: { revolute: [ground, rod.pin] } }
    effects:
      slow: { filter: { input: 0.4 rad - hinge.angle, numerator: [1], denominator: [0.2 s, 1] } }
      drive: { torque: { on: hinge, value: 5 N*m*slow } }
    initial: { hinge.angle: 0, hinge.angular_velocity: 0 }
instances:
  left: { of: arm, at: { position: [1, 0] } }
  right: { of: arm, at: { position: [-1, 0] }, mirror: x }
outputs: { left: left.slow, right: right.slow, angle: left.hinge.angle, image: right.hinge.angle }
simulation: { duration: 1, step: 1e-3, output_step: 0.5 }
";
    let bounds = nominal(&read(text));
    let together = |a: &str, b: &str, sign: f64| {
        largest(curve(&bounds, a).iter().zip(curve(&bounds, b)).map(|(a, b)| a - sign * b))
    };
    assert!(together("left", "right", 1.0) < 1e-12 && together("angle", "image", -1.0) < 1e-12);
    assert!(largest(curve(&bounds, "angle").iter().copied()) > 0.1);
}

/// A filter that rings faster than the steps are long, from a start that is not settled: the steps damp it, halved ones
/// too, and the error contains this.
#[test]
fn error_contains_damping_of_a_ringing_filter() {
    let (omega, damping) = (5e3_f64, 1e-4);
    let bounds = run(&read(&format!(
        "
parameters: {{ size: {{ value: 1, tolerance: 1% }} }}
bodies: {{ m: {{ mass: 1, coordinates: [x] }} }}
effects: {{ ring: {{ filter: {{ input: size, numerator: [1], denominator: [1/{omega}^2, 2*{damping}/{omega}, 1] }} }} }}
initial: {{ m.x: 0, m.vx: 0 }}
outputs: {{ ring: ring }}
simulation: {{ duration: 0.2, step: 1e-3, output_step: 0.02 }}
bounds: {{ chebyshev: {{ order: 2 }} }}
"
    )));
    let band = band(output(&bounds, "ring"), Method::Chebyshev);
    let nominal = curve(&bounds, "ring");
    for (row, time) in bounds.times.iter().enumerate().skip(1) {
        let truth = 1.0 - (-damping * omega * time).exp() * (omega * time).cos();
        let off = (nominal[row] - truth).abs();
        assert!(
            band.error.unresolved[row] || band.error.total[row] > 0.8 * off,
            "{time}: {off} of {}",
            band.error.total[row]
        );
    }
}
