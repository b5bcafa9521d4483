//! Contacts that a part of the box only just touches. Truths are closed forms of throws under a ceiling.

use mbint::results::Method;

use super::through_events::{integrated, range};
use super::throws_to_a_ceiling::{assert_within, thrown};
use crate::common::{band, output, read, run_methods};

/// A ball thrown up to a ceiling: gravity, height, speed, stiffness over mass; the duration, the output step and the
/// methods.
fn throw([g, height, speed, stiffness]: [&str; 4], duration: f64, output_step: f64, bounds: &str) -> String {
    format!(
        "
parameters: {{ g: {g}, H: {height}, v0: {speed}, K: {stiffness} }}
bodies: {{ ball: {{ mass: 1, coordinates: [y] }} }}
effects:
  forces: {{ force: {{ on: ball, value: [0, \"-K*max(ball.y - H, 0) - g\"] }} }}
initial: {{ ball.y: 0, ball.vy: v0 }}
outputs: {{ y: ball.y, v: ball.vy }}
simulation: {{ duration: {duration}, step: {step}, output_step: {output_step} }}
bounds: {{ {bounds} }}
",
        step = output_step / 50.0
    )
}

/// Height and velocity under any gravity: that of 9.81 m/s² on another time.
fn under(g: f64, height: f64, speed: f64, stiffness: f64, t: f64) -> [f64; 2] {
    let faster = (g / 9.81).sqrt();
    let [y, v] = thrown(height, speed / faster, stiffness / (faster * faster), t * faster);
    [y, faster * v]
}

/// A contact that is entered with less than g/ω = 0.46 mm/s takes as long as the throw would have been above the
/// ceiling; a faster one ends it at once. Polynomials through the faster ones leave the slow ones out by
/// πg/ω = 1.4 mm/s.
#[test]
fn slow_grazing_contacts_are_distinguished() {
    let (height, stiffness): (f64, f64) = (0.01826, 4.503e8);
    let text = throw(
        ["9.81", "0.01826", "{ interval: [0.4714, 0.6686] }", "4.503e8"],
        0.095,
        0.0025,
        "chebyshev: { order: 6 }, taylor: { order: 5 }",
    );
    let (bounds, summary) = run_methods(&read(&text), None);
    assert!(integrated(&summary, "chebyshev").0);
    let grazes = (2.0 * 9.81 * height).sqrt();
    let speeds = || {
        let beside = (0..400).map(|place| 0.07 * 10.0_f64.powf(-f64::from(place) / 30.0));
        let beside = beside.flat_map(move |by| [grazes - by, grazes + by]);
        beside.chain([0.4714, grazes, 0.6686]).filter(|speed| (0.4714..=0.6686).contains(speed))
    };
    // Behind all contacts.
    let behind = bounds.times.iter().position(|&t| t > 0.07).unwrap();
    for method in [Method::Chebyshev, Method::Taylor] {
        let band = band(output(&bounds, "v"), method);
        for (row, &t) in bounds.times.iter().enumerate().skip(behind) {
            let [lower, upper] = range(speeds().map(|speed| thrown(height, speed, stiffness, t)[1]));
            let off = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
            let stated = band.error.total[row];
            assert!(!band.error.unresolved[row] && off <= stated + 1e-8, "{off:e} off, {stated:e} stated at {t}");
        }
    }
}

/// The height is largest within a contact of 16 ms, which a layer of the box behind the grazed surface meets at this
/// time: no edge of a lattice of the box ends within the layer.
#[test]
fn layers_thinner_than_the_lattice_are_searched() {
    let text = throw(
        ["{ interval: [9.691, 9.929] }", "214.8", "{ interval: [60.57, 71.23] }", "41083.52"],
        9.9,
        3.3,
        "taylor: { order: 5 }",
    );
    let (bounds, _) = run_methods(&read(&text), None);
    let row = bounds.times.iter().position(|&t| (t - 6.6).abs() < 1e-9).unwrap();
    let band = band(output(&bounds, "y"), Method::Taylor);
    // With less gravity the flight to the ceiling is steeper.
    let speeds = (0..200_000).map(|place| 64.4 + 0.3 * f64::from(place) / 2e5);
    let most = speeds.map(|speed| under(9.691, 214.8, speed, 41083.52, 6.6)[0]).fold(f64::NEG_INFINITY, f64::max);
    let (upper, error) = (band.upper[row], band.error.total[row]);
    assert!(!band.error.unresolved[row] && (upper - most).abs() <= error, "{upper} ± {error}, in truth {most}");
}

/// Three parameters divide the box into throws that touch the ceiling and others.
#[test]
fn boxes_of_three_parameters_are_divided() {
    let text = throw(
        ["9.81", "{ interval: [5.908, 6.716] }", "{ interval: [9.979, 10.821] }", "{ interval: [7.5e5, 8.9e5] }"],
        2.208,
        0.048,
        "chebyshev: { order: 2 }",
    );
    let (bounds, summary) = run_methods(&read(&text), None);
    assert!(integrated(&summary, "chebyshev").0);
    let points: Vec<[f64; 3]> = (0..81 * 81 * 3)
        .map(|place| {
            let share = |index: i32, count: i32| f64::from(index) / f64::from(count);
            [
                5.908 + 0.808 * share(place % 81, 80),
                9.979 + 0.842 * share(place / 81 % 81, 80),
                7.5e5 + 1.4e5 * share(place / 6561, 2),
            ]
        })
        .collect();
    let truth = |line: usize, t: f64| range(points.iter().map(|[h, v, k]| thrown(*h, *v, *k, t)[line]));
    // The lattice misses this much where contacts begin and end.
    assert_within(&bounds, "v", Method::Chebyshev, 0.1, |t| truth(1, t));
    assert_within(&bounds, "y", Method::Chebyshev, 0.01, |t| truth(0, t));
}

/// Nominal throws graze the ceiling by 1e-4 of its height: a sample without a solvable instant is omitted.
#[test]
fn a_nominal_throw_may_graze() {
    let text = throw(
        ["{ interval: [9.7988, 9.8212] }", "0.912", "4.23", "{ interval: [1.353e6, 1.573e6] }"],
        0.828,
        0.023,
        "taylor: { order: 1 }",
    );
    let (bounds, summary) = run_methods(&read(&text), None);
    assert!(integrated(&summary, "taylor").0);
    let grazes = 4.23 * 4.23 / (2.0 * 0.912);
    let gravities = || {
        let beside = (0..300).map(|place| 0.02 * 10.0_f64.powf(-f64::from(place) / 30.0));
        let all = beside.flat_map(move |by| [grazes - by, grazes + by]).chain([9.7988, 9.8212]);
        all.filter(|g| (9.7988..=9.8212).contains(g))
    };
    let truth = |line: usize, t: f64| {
        let of = move |g: f64| [1.353e6, 1.463e6, 1.573e6].map(|k| under(g, 0.912, 4.23, k, t)[line]);
        range(gravities().flat_map(of))
    };
    assert_within(&bounds, "y", Method::Taylor, 1e-4, |t| truth(0, t));
}

/// A contact so stiff that the layer behind the surface has three parts: the one in the middle has samples from its one
/// end to the other. The fastest throw under the highest ceiling misses it, and turns back last.
#[test]
fn layers_in_the_middle_have_samples_of_their_own() {
    let text = throw(
        [
            "9.81",
            "{ interval: [0.08065, 0.08429] }",
            "{ interval: [1.1251, 1.2749] }",
            "{ interval: [3.475e6, 3.487e6] }",
        ],
        0.392,
        0.014,
        "chebyshev: { order: 4 }",
    );
    let (bounds, summary) = run_methods(&read(&text), None);
    assert!(integrated(&summary, "chebyshev").0);
    let own = band(output(&bounds, "v"), Method::Chebyshev);
    for row in 10..bounds.times.len() {
        let fastest = 1.2749 - 9.81 * bounds.times[row];
        let (off, error) = ((own.upper[row] - fastest).abs(), own.error.total[row]);
        assert!(off <= error && error < 5e-3, "{off:e}, {error:e} stated at {} s", bounds.times[row]);
    }
}
