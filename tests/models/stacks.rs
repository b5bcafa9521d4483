//! Stacks of dimensions: published digits, and closed forms of linear chains and of a slider-crank.

use std::path::Path;

use mbint::results::{Method, OutputStatisticsSummary, Summary};

use crate::common::{Subject, band, load, model_of, output, read, run_methods};

fn example(name: &str) -> Subject {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/examples/{name}.yaml")))
}

fn statistics<'s>(summary: &'s Summary, name: &str) -> &'s OutputStatisticsSummary {
    let found = summary.statistics.as_ref().expect("stacks are asked for statistics");
    assert_eq!(found.summary.failure, None);
    found.summary.outputs.iter().find(|own| own.output == name).unwrap()
}

/// K. W. Chase, Tolerance analysis of 2-D and 3-D mechanical assemblies, ADCATS report 99-4: to its last digits, in
/// degrees.
#[test]
#[ignore = "2 s"]
fn the_overrunning_clutch_has_its_published_digits() {
    let model = example("overrunning_clutch");
    assert_eq!(model.study().description().analysis.name(), "dimensions");
    let (bounds, summary) = run_methods(&model, None);
    let found = statistics(&summary, "phi");
    let worst = band(output(&bounds, "phi"), Method::Chebyshev);
    let digits = [
        (found.nominal, 7.01839, 5e-6),
        (worst.lower[0], 6.13122, 5e-6),
        (worst.upper[0], 7.80448, 5e-6),
        (found.linear, 0.8306, 5e-5),
        (found.rss, 0.4820, 5e-5),
    ];
    for (value, published, half_digit) in digits {
        assert!((value.to_degrees() - published).abs() <= half_digit, "{} {published}", value.to_degrees());
    }
    // The same by hand: dφ = -(da + dc (1 + cos φ) - de cos φ)/((e - c) sin φ).
    let (angle, reach) = (found.nominal, 50.8e-3 - 11.43e-3);
    let by = |name: &str| found.sensitivities.iter().find(|own| own.parameter == name).unwrap().derivative;
    let scale = -1.0 / (reach * angle.sin());
    let closed = [("a", scale), ("c", scale * (1.0 + angle.cos())), ("e", -scale * angle.cos())];
    for (name, wanted) in closed {
        // A central difference over a hundredth of the tolerance.
        assert!((by(name) / wanted - 1.0).abs() < 1e-7, "{name}: {} {wanted}", by(name));
    }
    assert!((found.sensitivities.iter().map(|own| own.share).sum::<f64>() - 1.0).abs() < 1e-12);
}

#[test]
fn a_chain_is_the_signed_sum_of_its_dimensions() {
    let model = example("bearing_gap");
    let (bounds, summary) = run_methods(&model, None);
    // js9 of 12 mm is 43 µm wide.
    let deviations: [(&str, f64, f64); 4] =
        [("housing", 1.0, 0.1e-3), ("ring", -1.0, 0.0215e-3), ("sleeve", -1.0, 0.08e-3), ("cover", -1.0, 0.05e-3)];
    let linear: f64 = deviations.iter().map(|(.., own)| own).sum();
    let found = statistics(&summary, "gap");
    let worst = band(output(&bounds, "gap"), Method::Chebyshev);
    let near = |value: f64, wanted: f64| assert!((value - wanted).abs() < 1e-14, "{value} {wanted}");
    near(found.nominal, 0.5e-3);
    near(worst.lower[0], 0.5e-3 - linear);
    near(worst.upper[0], 0.5e-3 + linear);
    near(found.linear, linear);
    near(found.rss, deviations.iter().map(|(.., own)| own * own).sum::<f64>().sqrt());
    for (name, sign, deviation) in deviations {
        let own = found.sensitivities.iter().find(|own| own.parameter == name).unwrap();
        assert!((own.derivative - sign).abs() < 1e-9, "{own:?}");
        near(own.deviation, sign * deviation);
    }
    let [chain] = &summary.chains[..] else { panic!("{:?}", summary.chains) };
    // From the sleeve's face back over sleeve and ring to the wall, along the housing, and back over the cover.
    let links: Vec<(&str, bool, &str)> =
        chain.links.iter().map(|link| (link.name.as_str(), link.is_forward, link.to.as_str())).collect();
    assert_eq!(
        links,
        [
            ("sleeve", false, "ring face"),
            ("ring", false, "left wall"),
            ("housing", true, "right wall"),
            ("cover", false, "cover face")
        ]
    );
    let sum: f64 = chain.links.iter().map(|link| if link.is_forward { link.nominal } else { -link.nominal }).sum();
    near(sum, chain.nominal);
}

/// Three uniform laws and a normal one: moments of the sum, and a histogram that has them.
#[test]
fn a_histogram_has_the_moments_of_the_sum() {
    let (_, summary) = run_methods(&example("bearing_gap"), None);
    let found = statistics(&summary, "gap");
    let variance = (0.1_f64.powi(2) + 0.0215_f64.powi(2) + 0.05_f64.powi(2)) / 3.0 + (0.08_f64 / 3.0).powi(2);
    let deviation = 1e-3 * variance.sqrt();
    assert!((found.deviation.value - deviation).abs() <= 2.0 * found.deviation.sampling + found.deviation.error);
    let histogram = found.histogram.as_ref().unwrap();
    let width = (histogram.upper - histogram.lower) / histogram.shares.len() as f64;
    let at = |index: usize| histogram.lower + width * (index as f64 + 0.5);
    let moment = |of: &dyn Fn(f64) -> f64| -> f64 {
        histogram.shares.iter().enumerate().map(|(index, share)| share * of(at(index))).sum()
    };
    assert!((moment(&|_| 1.0) - 1.0).abs() < 1e-9);
    assert!((moment(&|x| x) - 0.5e-3).abs() < 0.01 * deviation);
    // Sheppard's correction of a histogram's variance is width²/12.
    let own = moment(&|x| (x - 0.5e-3).powi(2)) - width * width / 12.0;
    assert!((own.sqrt() / deviation - 1.0).abs() < 0.01, "{} {deviation}", own.sqrt());
    let [requirement] = &summary.statistics.as_ref().unwrap().summary.requirements[..] else { panic!() };
    let (cp, cpk) = (requirement.cp.unwrap(), requirement.cpk.unwrap());
    assert!((cp - 0.7e-3 / (6.0 * deviation)).abs() < 0.01, "{cp}");
    assert!((cpk - 0.2e-3 / (3.0 * deviation)).abs() < 0.01, "{cpk}");
}

/// x = r cos θ + √(l² - r² sin² θ), and the gap 112 - 30 - x, at every position of the crank.
#[test]
#[ignore = "2 s"]
fn chain_may_include_a_mechanism() {
    let model = example("ejector");
    assert_eq!(model.study().description().analysis.name(), "kinematics");
    let (bounds, summary) = run_methods(&model, None);
    let gap = output(&bounds, "gap");
    let travel = |r: f64, l: f64, time: f64| {
        let angle = std::f64::consts::FRAC_PI_2 * time;
        r * angle.cos() + (l * l - (r * angle.sin()).powi(2)).sqrt()
    };
    let worst = band(gap, Method::Chebyshev);
    for (row, &time) in bounds.times.iter().enumerate() {
        assert!((gap.nominal[row] - (82e-3 - travel(20e-3, 60e-3, time))).abs() < 1e-11, "{time}");
        // The travel is monotonic in both lengths at every position of this quarter.
        let corners = [-1.0, 1.0]
            .map(|r: f64| [-1.0, 1.0].map(|l: f64| 82e-3 - travel(20e-3 + r * 0.02e-3, 60e-3 + l * 0.03e-3, time)));
        let all = corners.as_flattened();
        let [least, most] = [all.iter().copied().fold(1.0, f64::min), all.iter().copied().fold(0.0, f64::max)];
        let error = worst.error.total[row] + 1e-10;
        assert!((worst.lower[row] - (least - 0.15e-3)).abs() <= error, "{time}: {error}");
        assert!((worst.upper[row] - (most + 0.15e-3)).abs() <= error, "{time}: {error}");
    }
    let found = statistics(&summary, "gap");
    let by = |name: &str| found.sensitivities.iter().find(|own| own.parameter == name).unwrap().derivative;
    assert!(["stop", "ejector"].iter().zip([1.0, -1.0]).all(|(name, sign)| (by(name) - sign).abs() < 1e-6));
    let links: Vec<&str> = summary.chains[0].links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(links, ["ejector", "travel", "stop"]);
}

const PRODUCT: &str = "
parameters: { a: 2 m ± 0.1 m, b: 3 m ± 0.2 m, unused: 1 ± 0.5, area: a*b }
outputs: { size: area + a^2 }
bounds: { chebyshev: { order: 3 }, taylor: { order: 2 }, scan: { points: 9 } }
";

/// ab + a² grows with both.
#[test]
fn every_method_bounds_formulas_alone() {
    let (bounds, _) = run_methods(&read(PRODUCT), None);
    let size = output(&bounds, "size");
    for method in [Method::Chebyshev, Method::Taylor, Method::Scan] {
        let own = band(size, method);
        assert!((own.lower[0] - (1.9 * 2.8 + 1.9 * 1.9)).abs() <= own.error.total[0] + 1e-12, "{method:?} {own:?}");
        assert!((own.upper[0] - (2.1 * 3.2 + 2.1 * 2.1)).abs() <= own.error.total[0] + 1e-12, "{method:?} {own:?}");
    }
}

#[test]
fn gradients_of_formulas_are_their_derivatives() {
    let found = model_of(PRODUCT).gradients().unwrap();
    let by = |name: &str| {
        let index = found.parameters.iter().position(|parameter| parameter.name == name).unwrap();
        found.outputs[0].by_parameters[0][index]
    };
    assert_eq!((found.outputs[0].values[0], by("a"), by("b"), by("unused")), (10.0, 7.0, 2.0, 0.0));
}

#[test]
#[ignore = "2 s"]
fn a_hundred_dimensions_are_bounded_exactly() {
    let names: Vec<String> = (0..100).map(|index| format!("d{index}")).collect();
    let parameters: String = names.iter().map(|name| format!("  {name}: 10 mm ± 0.1 mm\n")).collect();
    let text = format!("parameters:\n{parameters}outputs: {{ gap: {} }}\n", names.join(" + "));
    let (bounds, _) = run_methods(&read(&text), None);
    let own = band(output(&bounds, "gap"), Method::Chebyshev);
    assert!((own.lower[0] - 0.99).abs() < 1e-12 && (own.upper[0] - 1.01).abs() < 1e-12, "{own:?}");
    assert!(!own.error.unresolved[0]);
}
