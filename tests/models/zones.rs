//! Zones of deviations: ends of linear outputs in them are known in closed form, and so are moments of their laws.

use mbint::results::{Method, OutputStatisticsSummary, Summary};

use crate::common::{band, output, read, run_methods};

fn statistics<'s>(summary: &'s Summary, name: &str) -> &'s OutputStatisticsSummary {
    let found = summary.statistics.as_ref().expect("stacks are asked for statistics");
    assert_eq!(found.summary.failure, None);
    found.summary.outputs.iter().find(|own| own.output == name).unwrap()
}

/// Ends of several discs are sums of all: they are resolved without dividing the box, however small the tolerance is.
#[test]
fn several_zones_add_up() {
    for (tolerance, simulations) in [(1e-2, 300), (1e-7, 400)] {
        let text = format!(
            "
zones: {{ near: {{ disc: 0.2 m }}, far: {{ disc: 0.4 m }}, last: {{ disc: 0.1 m }} }}
parameters: {{ length: 10 m ± 0.1 m }}
outputs: {{ gap: length + 3*near_x + 4*near_y - far_y + last_x }}
bounds: {{ tolerance: {tolerance:e} }}
"
        );
        let (bounds, summary) = run_methods(&read(&text), None);
        let own = band(output(&bounds, "gap"), Method::Chebyshev);
        let reach = 0.1 + 0.5 + 0.2 + 0.05;
        let taken: usize = summary.methods.iter().map(|method| method.simulations).sum();
        println!("{tolerance:e}: {taken} simulations, {own:?}");
        assert!(!own.error.unresolved[0] && own.error.total[0] < 2.0 * tolerance * reach, "{own:?}");
        assert!((own.upper[0] - 10.0 - reach).abs() < own.error.total[0], "{own:?}");
        assert!((own.lower[0] - 10.0 + reach).abs() < own.error.total[0], "{own:?}");
        assert!(taken <= simulations, "{tolerance:e}: {taken}");
    }
}

/// Half of an output's range over a model of zones alone, with the summary.
fn reach(zones: &str, formula: &str) -> (f64, Summary) {
    let text = format!(
        "zones:\n{zones}\nparameters: {{ unused: 1 m }}\noutputs: {{ gap: {formula} }}\nbounds: {{ tolerance: 1e-7 }}\n"
    );
    let (bounds, summary) = run_methods(&read(&text), None);
    let own = band(output(&bounds, "gap"), Method::Chebyshev);
    assert!((own.lower[0] + own.upper[0]).abs() <= own.error.total[0], "{own:?}");
    assert!(!own.error.unresolved[0]);
    (own.upper[0], summary)
}

/// Largest of a linear function over the set, by hand: radius times the length of its gradient.
#[test]
#[ignore = "3 s"]
fn linear_gaps_are_exact_in_every_zone() {
    let cases = [
        ("  h: { disc: 0.2 m }", "3*h_x - 4*h_y", 0.5),
        ("  h: { disc: 0.2 m }", "h_x", 0.1),
        ("  h: { sphere: 0.2 m }", "2*h_x - 3*h_y + 6*h_z", 0.7),
        ("  h: { cylinder: 0.2 m }", "3*h_start_x + 4*h_start_y", 0.5),
        ("  h: { flatness: 0.2 m }", "2*h_z", 0.2),
        // |x| + |y| <= 0.1: the larger coefficient.
        ("  h: { parallelism: 0.2 m }", "3*h_edge_x - 4*h_edge_y", 0.4),
        ("  h: { ellipsoid: { p: 0.2 m, q: 0.1 m } }", "3*h_p + 8*h_q", 1.0),
        // a' R b of the ellipse with correlation r: sqrt(a² + b² + 2 r a b).
        ("  h: { ellipsoid: { p: 0.2 m, q: 0.1 m }, correlation: 0.5 }", "3*h_p + 8*h_q", 1.48_f64.sqrt()),
        ("  h: { ellipsoid: { p: 0.2 m, q: 0.1 m, r: 0.3 m } }", "10*h_p + 20*h_q + 10*h_r/3", 3.0),
    ];
    for (zones, formula, wanted) in cases {
        let (found, summary) = reach(zones, formula);
        assert!((found / wanted - 1.0).abs() < 1e-6, "{zones} {formula}: {found} {wanted}");
        let own = statistics(&summary, "gap");
        assert!((own.linear / wanted - 1.0).abs() < 1e-3, "{zones} {formula}: linear {} {wanted}", own.linear);
        let causes: Vec<&str> = own.sensitivities.iter().map(|own| own.parameter.as_str()).collect();
        assert_eq!(causes, ["h"], "one zone is one cause");
    }
}

/// A zone and a length: variances add, and the zone is one contribution. Of an even radius and angle, each coordinate
/// has the variance r²/6.
#[test]
fn a_zone_is_one_contribution() {
    let text = "
zones: { near: { disc: 0.2 m } }
parameters: { length: 10 m ± 0.1 m }
outputs: { gap: length + near_x - 3*near_y }
bounds: { tolerance: 1e-8 }
";
    let (_, summary) = run_methods(&read(text), None);
    let variance_of_axis = |radius: f64| radius * radius / 6.0;
    let variances = [("near", 10.0 * variance_of_axis(0.1)), ("length", 0.01 / 3.0)];
    let total: f64 = variances.iter().map(|(_, own)| own).sum();
    assert_eq!(summary.contributions.len(), 2, "{:?}", summary.contributions);
    for (name, variance) in variances {
        let own = summary.contributions.iter().find(|own| own.parameter == name).unwrap();
        assert!((own.total - variance / total).abs() < 1e-4, "{name}: {} {}", own.total, variance / total);
    }
}

/// Deviations of uniform and of radial normal laws: a quarter and a fifth of R², and σ² = R²/9 less the part of the
/// tails.
#[test]
#[ignore = "3 s"]
fn laws_in_zones_have_their_moments() {
    let deviation = |kind: &str, law: &str| {
        let (_, summary) = reach(&format!("  h: {{ {kind}: 0.2 m, distribution: {law} }}"), "h_x");
        statistics(&summary, "gap").deviation
    };
    let near = |kind: &str, law: &str, wanted: f64| {
        let found = deviation(kind, law);
        assert!((found.value / (0.1 * wanted.sqrt()) - 1.0).abs() < 2e-3, "{kind} {law}: {found:?} {wanted}");
    };
    near("disc", "uniform", 1.0 / 4.0);
    near("sphere", "uniform", 1.0 / 5.0);
    let outside = (-4.5_f64).exp();
    near("disc", "radial_normal", (1.0 - 4.5 * outside / (1.0 - outside)) / 9.0);
    // Per axis a third of E r² of Maxwell's distribution cut off at three: 3 - 27 φ-density/(share inside).
    let density = (2.0 / std::f64::consts::PI).sqrt() * 27.0 * outside;
    let inside = 0.970_709_1;
    near("sphere", "radial_normal", (3.0 - density / inside) / 3.0 / 9.0);
}

/// The pin of a turning arm in a disc, which is the same disc from every side.
#[test]
fn the_point_of_a_body_lies_in_a_disc() {
    let text = "
analysis: kinematics
bodies:
  arm: { points: { A: [0, 0], B: { position: [0.3 m, 0], zone: { disc: 0.02 m } } } }
joints:
  pivot: { revolute: [ground, arm.A] }
  drive: { motor: { on: pivot, position: t/(1 s) } }
outputs: { x: arm.B.x, y: arm.B.y }
simulation: { duration: 1.5, output_step: 0.25 }
bounds: { tolerance: 1e-8 }
";
    let (bounds, summary) = run_methods(&read(text), None);
    for (row, &time) in bounds.times.iter().enumerate() {
        for (name, middle) in [("x", 0.3 * time.cos()), ("y", 0.3 * time.sin())] {
            let own = band(output(&bounds, name), Method::Chebyshev);
            // A disc is a disc from every side; a square would reach up to 0.0141.
            assert!((own.upper[row] - middle - 0.01).abs() < 1e-8, "{name} {time}: {}", own.upper[row] - middle);
            assert!((own.lower[row] - middle + 0.01).abs() < 1e-8, "{name} {time}");
        }
    }
    assert!(summary.contributions.iter().all(|own| own.parameter == "arm_B"), "{:?}", summary.contributions);
}

/// At maximum material the zone grows with the hole: 0.1 mm at 12 mm, and as much more as the hole is larger.
#[test]
fn a_zone_may_grow_with_the_hole() {
    let text = "
parameters: { bore: { interval: [12 mm, 12.05 mm] } }
zones: { hole: { disc: 0.1 mm + (bore - 12 mm) } }
outputs: { shift: hole_x }
bounds: { tolerance: 1e-8 }
";
    let (bounds, _) = run_methods(&read(text), None);
    let own = band(output(&bounds, "shift"), Method::Chebyshev);
    assert!((own.upper[0] - 0.075e-3).abs() < 1e-9 && (own.lower[0] + 0.075e-3).abs() < 1e-9, "{own:?}");
}
