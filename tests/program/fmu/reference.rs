//! Units with the equations of the Reference FMUs: bounds contain dense samples of the equations, which are solved
//! here: by closed forms, Euler's method as the units have it, or a fine method of Runge and Kutta.

use std::fs;

use super::super::place::Place;
use super::{column, compile};

const SOURCE: &str = include_str!("reference.c");

/// A unit: its definition in C, variables that are set with their start values, others, and its events.
struct Unit {
    name: &'static str,
    set: &'static [(&'static str, &'static str)],
    outputs: &'static [&'static str],
    states: usize,
    indicators: usize,
}

const BALL: Unit =
    Unit { name: "BALL", set: &[("g", "-9.81"), ("e", "0.7")], outputs: &["h", "v"], states: 2, indicators: 1 };
const VAN_DER_POL: Unit = Unit {
    name: "VANDERPOL",
    set: &[("mu", "1"), ("x0 start", "2")],
    outputs: &["x0", "x1"],
    states: 2,
    indicators: 0,
};
const DAHLQUIST: Unit =
    Unit { name: "DAHLQUIST", set: &[("k", "1"), ("x start", "1")], outputs: &["x"], states: 1, indicators: 0 };

/// Description of a unit; `more` are further variables.
fn description(unit: &Unit, version: u32, more: &str) -> String {
    let set = unit.set.iter().map(|(name, start)| (*name, "parameter", "fixed", format!("start=\"{start}\"")));
    let outputs = unit.outputs.iter().map(|name| (*name, "output", "continuous", String::new()));
    let variable = |(index, (name, causality, variability, start)): (usize, (&str, &str, &str, String))| {
        let head = format!(
            "name=\"{name}\" valueReference=\"{index}\" causality=\"{causality}\" variability=\"{variability}\""
        );
        match version {
            2 => format!("<ScalarVariable {head}><Real {start}/></ScalarVariable>"),
            _ => format!("<Float64 {head} {start}/>"),
        }
    };
    let variables: String = set.chain(outputs).enumerate().map(variable).collect();
    let (token, derivative) = match version {
        2 => ("guid", "<Unknown index=\"1\"/>"),
        _ => ("instantiationToken", "<ContinuousStateDerivative valueReference=\"2\"/>"),
    };
    let derivatives = derivative.repeat(unit.states);
    let derivatives = if version == 2 { format!("<Derivatives>{derivatives}</Derivatives>") } else { derivatives };
    let indicators =
        if version == 2 { format!("numberOfEventIndicators=\"{}\"", unit.indicators) } else { String::new() };
    format!(
        "<?xml version=\"1.0\"?><fmiModelDescription fmiVersion=\"{version}.0\" modelName=\"unit\" {token}=\"{{7}}\" \
         {indicators}><ModelExchange modelIdentifier=\"unit\"/><CoSimulation modelIdentifier=\"unit\"/>\
         <ModelVariables>{variables}{more}</ModelVariables><ModelStructure>{derivatives}</ModelStructure>\
         </fmiModelDescription>"
    )
}

fn place(unit: &Unit, version: u32, more: &str) -> Place {
    let place = Place::new();
    let defined = [unit.name.to_owned(), format!("INDICATORS={}", unit.indicators)];
    compile(place.path(), version, &description(unit, version, more), SOURCE, &defined);
    place
}

/// Share of the rows in which each output's band holds, with its stated error, all samples; `samples` are
/// values (row, output) of each.
fn coverage(bounds: &str, outputs: &[&str], samples: &[Vec<Vec<f64>>]) -> f64 {
    let (mut held, mut rows) = (0, 0);
    for (output, name) in outputs.iter().enumerate() {
        let [lower, upper, error] =
            ["lower", "upper", "error"].map(|end| column(bounds, &format!("{name}.chebyshev.{end}")));
        for row in 0..lower.len() {
            let values = samples.iter().map(|sample| sample[row][output]);
            let (least, most) = values
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
            // Last digits of two computations of one number.
            let slack = error[row] + 1e-12;
            assert!(lower[row].is_finite() && error[row].is_finite(), "{name}, row {row}");
            held += usize::from(least >= lower[row] - slack && most <= upper[row] + slack);
            rows += 1;
        }
    }
    f64::from(held as u32) / f64::from(rows)
}

/// Values evenly between two.
fn between(lower: f64, upper: f64, count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |index| lower + (upper - lower) * index as f64 / (count - 1) as f64)
}

/// Checks one unit in both versions.
fn covers(unit: &Unit, interface: &str, model: &str, samples: &[Vec<Vec<f64>>]) {
    // A response that jumps over the parameters has bounds with warnings.
    let status = if unit.indicators > 0 { 3 } else { 0 };
    for version in [2, 3] {
        let place = place(unit, version, "");
        let model = model.replace("INTERFACE", interface);
        fs::write(place.path().join("model.yaml"), model).unwrap();
        place.run("run model.yaml -o out", status);
        let bounds = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
        let share = coverage(&bounds, unit.outputs, samples);
        for name in unit.outputs.iter().filter(|_| status == 0) {
            let [nominal, error] = ["nominal", "chebyshev.error"].map(|end| column(&bounds, &format!("{name}.{end}")));
            let size = nominal.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
            assert!(error.iter().all(|error| *error <= 2e-3 * size), "{} {name}: {error:?}", unit.name);
        }
        assert!(share >= 0.99, "{} {version} {interface}: {share}", unit.name);
    }
}

/// Motion by steps of Euler's method, as the units have it; `rows` rows of `steps` steps each.
fn euler<const N: usize>(
    mut x: [f64; N],
    h: f64,
    rows: usize,
    steps: usize,
    mut go: impl FnMut(&mut [f64; N], f64),
) -> Vec<Vec<f64>> {
    let mut values = vec![x.to_vec()];
    for _ in 1..rows {
        (0..steps).for_each(|_| go(&mut x, h));
        values.push(x.to_vec());
    }
    values
}

#[test]
fn bounds_of_dahlquists_equation_contain_exponentials() {
    let model = "parameters: { k: ± 10% }
black_box: { fmu: unit.fmu, interface: INTERFACE, outputs: { x: 1 } }
simulation: { duration: 10, output_step: 0.1 }
bounds: { tolerance: 1e-4 }
";
    let exact = |k: f64| (0..101).map(|row| vec![(-k * 0.1 * f64::from(row)).exp()]).collect();
    let samples: Vec<_> = between(0.9, 1.1, 201).map(exact).collect();
    covers(&DAHLQUIST, "model_exchange", model, &samples);
    let of_steps = |k: f64| euler([1.0], 0.1, 101, 1, |x, h| x[0] -= h * k * x[0]);
    let samples: Vec<_> = between(0.9, 1.1, 201).map(of_steps).collect();
    covers(&DAHLQUIST, "co_simulation", model, &samples);
}

#[test]
fn bounds_of_van_der_pols_oscillator_contain_its_motions() {
    let model = "parameters: { mu: ± 5% }
black_box: { fmu: unit.fmu, interface: INTERFACE, outputs: { x0: 1, x1: 1 } }
simulation: { duration: 20, output_step: 0.1 }
bounds: { tolerance: 1e-3 }
";
    let slope = |mu: f64, [a, b]: [f64; 2]| [b, mu * (1.0 - a * a) * b - a];
    let moved = |x: [f64; 2], h: f64, d: [f64; 2]| [x[0] + h * d[0], x[1] + h * d[1]];
    let fine = |mu: f64| {
        euler([2.0, 0.0], 1e-3, 201, 100, |x, h| {
            let a = slope(mu, *x);
            let b = slope(mu, moved(*x, h / 2.0, a));
            let c = slope(mu, moved(*x, h / 2.0, b));
            let d = slope(mu, moved(*x, h, c));
            *x = moved(*x, h / 6.0, [0, 1].map(|i| a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        })
    };
    let samples: Vec<_> = between(0.95, 1.05, 101).map(fine).collect();
    covers(&VAN_DER_POL, "model_exchange", model, &samples);
    let of_steps = |mu: f64| euler([2.0, 0.0], 1e-2, 201, 10, |x, h| *x = moved(*x, h, slope(mu, *x)));
    let samples: Vec<_> = between(0.95, 1.05, 101).map(of_steps).collect();
    covers(&VAN_DER_POL, "co_simulation", model, &samples);
}

/// Height and velocity of a ball that falls from 1 m and rebounds, up to its rest.
fn bounced(g: f64, e: f64, t: f64) -> Vec<f64> {
    // As if thrown up from the ground before the start.
    let mut up = (-2.0 * g).sqrt();
    let mut begin = up / g;
    while t > begin - 2.0 * up / g {
        begin -= 2.0 * up / g;
        up *= e;
        if up < 0.1 {
            return vec![0.0, 0.0];
        }
    }
    let since = t - begin;
    vec![up * since + 0.5 * g * since * since, up + g * since]
}

#[test]
fn bounds_of_a_bouncing_ball_contain_its_motions() {
    let model = "parameters: { e: ± 2%, g: ± 0.5% }
black_box: { fmu: unit.fmu, interface: INTERFACE, outputs: { h: 1, v: 1 } }
simulation: { duration: 3, output_step: 0.03 }
bounds: { chebyshev: { order: 5 } }
";
    let points =
        || between(0.686, 0.714, 31).flat_map(|e| between(-9.81 * 1.005, -9.81 * 0.995, 31).map(move |g| (e, g)));
    let exact = |(e, g): (f64, f64)| (0..101).map(|row| bounced(g, e, 0.03 * f64::from(row))).collect();
    covers(&BALL, "model_exchange", model, &points().map(exact).collect::<Vec<_>>());
    let of_steps = |(e, g): (f64, f64)| {
        let mut rests = false;
        euler([1.0, 0.0], 1e-3, 101, 30, |x, h| {
            *x = [x[0] + h * x[1], x[1] + if rests { 0.0 } else { h * g }];
            if x[0] <= 0.0 && x[1] < 0.0 {
                *x = [f64::MIN_POSITIVE, -e * x[1]];
                if x[1] < 0.1 {
                    (x[1], rests) = (0.0, true);
                }
            }
        })
    };
    covers(&BALL, "co_simulation", model, &points().map(of_steps).collect::<Vec<_>>());
}

/// A unit without continuous states.
const fn discrete(name: &'static str) -> Unit {
    Unit { name, set: &[], outputs: &[], states: 0, indicators: 0 }
}

/// A variable of a type, named as in 3.0, by its number.
fn variable(version: u32, name: &str, reference: u32, kind: &str, causality: &str) -> String {
    let variability = if kind.starts_with("Float") { "continuous" } else { "discrete" };
    let start = if causality == "output" { "" } else { "start=\"0\"" };
    let head = format!(
        "name=\"{name}\" valueReference=\"{reference}\" causality=\"{causality}\" variability=\"{variability}\""
    );
    let old = match kind {
        "Float64" => "Real",
        "Int32" => "Integer",
        other => other,
    };
    match version {
        2 => format!("<ScalarVariable {head}><{old} {start}/></ScalarVariable>"),
        _ => format!("<{kind} {head} {start}/>"),
    }
}

/// Table of bounds of a unit without continuous states.
fn bounds_of(unit: &Unit, version: u32, variables: &str, model: &str) -> String {
    let place = place(unit, version, variables);
    fs::write(place.path().join("model.yaml"), model).unwrap();
    place.run("run model.yaml -o out", 0);
    fs::read_to_string(place.path().join("out/bounds.csv")).unwrap()
}

/// Stairs end their motion with the last row, by events whose times are known before.
#[test]
#[ignore = "2 s"]
fn stairs_rise_once_per_second() {
    for (version, interface) in
        [(2, "model_exchange"), (3, "model_exchange"), (2, "co_simulation"), (3, "co_simulation")]
    {
        let model = format!(
            "black_box: {{ fmu: unit.fmu, interface: {interface}, outputs: {{ counter: 1 }} }}
simulation: {{ duration: 10, output_step: 0.5 }}
"
        );
        let counter = variable(version, "counter", 9, "Int32", "output");
        let bounds = bounds_of(&discrete("STAIR"), version, &counter, &model);
        let expected: Vec<f64> = (0..21).map(|row| f64::from(row / 2)).collect();
        assert_eq!(column(&bounds, "counter.nominal"), expected, "{version} {interface}");
        // A motion that ends before the last row is a failure.
        let place = place(&discrete("STAIR"), version, &counter);
        fs::write(place.path().join("model.yaml"), model.replace("duration: 10,", "duration: 11,")).unwrap();
        let (_, message) = place.run("run model.yaml -o out", 2);
        assert!(message.contains("it ends its motion at t = 10 s"), "{version} {interface}: {message}");
    }
}

/// Inputs come out as outputs, in each type that is one number; texts are not requested.
#[test]
#[ignore = "2 s"]
fn inputs_of_all_types_are_outputs() {
    let kinds = ["Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Enumeration"];
    for (version, kind) in kinds.map(|kind| (3, kind)).into_iter().chain([(2, "Int32"), (2, "Enumeration")]) {
        let variables = [
            variable(version, "number in", 0, "Float64", "input"),
            variable(version, "whole in", 9, kind, "input"),
            variable(version, "truth in", 10, "Boolean", "input"),
            variable(version, "number", 2, "Float64", "output"),
            variable(version, "whole", 9, kind, "output"),
            variable(version, "truth", 10, "Boolean", "output"),
            variable(version, "text", 11, "String", "output"),
        ];
        let model = "parameters: { a: 2.5 ± 10%, b: 100, c: 1 }
black_box: { fmu: unit.fmu, variables: { a: number in, b: whole in, c: truth in } }
simulation: { duration: 1, output_step: 0.5 }
bounds: { chebyshev: { order: 1 } }
";
        let bounds = bounds_of(&discrete("FEEDTHROUGH"), version, &variables.concat(), model);
        for (name, expected) in [
            ("number.nominal", 2.5),
            ("number.chebyshev.lower", 2.25),
            ("number.chebyshev.upper", 2.75),
            ("whole.nominal", 100.0),
            ("truth.nominal", 1.0),
        ] {
            let found = column(&bounds, name);
            assert!(found.iter().all(|value| (value - expected).abs() < 1e-12), "{version} {kind} {name}: {found:?}");
        }
    }
}

#[test]
fn a_unit_reads_its_resources() {
    for version in [2, 3] {
        let model = "black_box: { fmu: unit.fmu, outputs: { y: 1 } }
simulation: { duration: 1, output_step: 0.5 }
";
        let y = variable(version, "y", 9, "Int32", "output");
        let bounds = bounds_of(&discrete("RESOURCE"), version, &y, model);
        assert_eq!(column(&bounds, "y.nominal"), [f64::from(b'a'); 3], "{version}");
    }
}

/// Clocks belong to scheduled execution, which has no motion of its own.
#[test]
fn a_unit_of_scheduled_execution_alone_is_refused() {
    let unit = discrete("STAIR");
    let scheduled = description(&unit, 3, &variable(3, "counter", 9, "Int32", "output"))
        .replace("<CoSimulation modelIdentifier=\"unit\"/>", "")
        .replace("ModelExchange", "ScheduledExecution");
    let place = Place::new();
    compile(place.path(), 3, &scheduled, SOURCE, &["STAIR".to_owned(), "INDICATORS=0".to_owned()]);
    fs::write(place.path().join("model.yaml"), "black_box: { fmu: unit.fmu }\n").unwrap();
    let (_, message) = place.run("check model.yaml", 2);
    assert!(message.contains("the unit has neither co-simulation nor model exchange"), "{message}");
}
