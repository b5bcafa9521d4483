//! `black_box: { fmu: … }`: units that are compiled here from C, of both versions, and units that mbint exports.
//! Expected values are closed forms, or the bounds of the mechanism that was exported.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::place::Place;

mod reference;

const SOURCE: &str = include_str!("unit.c");

/// Functions of the standard for a model's source.
const WRAPPER: &str = include_str!("wrapper.c");

/// Columns of a table by name.
fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let index = lines.next().unwrap().split(',').position(|own| own == name).unwrap_or_else(|| panic!("{name}"));
    lines.map(|line| line.split(',').nth(index).unwrap().parse().unwrap()).collect()
}

fn bounds(place: &Place, folder: &str) -> String {
    fs::read_to_string(place.path().join(folder).join("bounds.csv")).unwrap()
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

fn done(command: &mut Command) {
    let done = command.output().unwrap();
    assert!(done.status.success(), "{command:?}: {}", String::from_utf8_lossy(&done.stderr));
}

/// Variables, as name, type and attributes; `Float64` is `Real` in 2.0.
const VARIABLES: [(&str, &str, &str, &str); 9] = [
    ("k", "Float64", "parameter", "start=\"START_K\" unit=\"UNIT_K\""),
    ("body.m", "Float64", "parameter", "start=\"START_M\""),
    ("x0", "Float64", "parameter", "start=\"100\" declaredType=\"Length\""),
    ("mode", "Int32", "parameter", "start=\"0\""),
    ("x", "Float64", "output", "unit=\"mm\""),
    ("v", "Float64", "output", "unit=\"metre per second\""),
    ("temperature", "Float64", "output", "unit=\"degC\""),
    ("count", "Int32", "output", ""),
    ("not a name", "Float64", "output", ""),
];

const UNITS: &str = r#"<UnitDefinitions>
<Unit name="mm"><BaseUnit m="1" factor="0.001"/></Unit>
<Unit name="metre per second"><BaseUnit m="1" s="-1"/></Unit>
<Unit name="N/m"><BaseUnit kg="1" s="-2"/></Unit>
<Unit name="m/s2"><BaseUnit m="1" s="-2"/></Unit>
<Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
</UnitDefinitions>"#;

fn description(version: u32, ball: bool) -> String {
    let (k, m, unit) = if ball { ("10", "0.8", "m/s2") } else { ("200", "2", "N/m") };
    let fill = |text: &str| text.replace("START_K", k).replace("START_M", m).replace("UNIT_K", unit);
    let variable = |(index, (name, kind, causality, more)): (usize, &(&str, &str, &str, &str))| {
        let more = fill(more);
        // Parameters are fixed, and exact; outputs are calculated.
        let own = if *causality == "output" { "continuous" } else { "fixed" };
        let own = if *kind == "Int32" && *causality == "output" { "discrete" } else { own };
        let head =
            format!("name=\"{name}\" valueReference=\"{index}\" causality=\"{causality}\" variability=\"{own}\"");
        match version {
            2 => {
                let kind = if *kind == "Int32" { "Integer" } else { "Real" };
                format!("<ScalarVariable {head}><{kind} {more}/></ScalarVariable>")
            }
            _ => format!("<{kind} {head} {more}/>"),
        }
    };
    let variables: String = VARIABLES.iter().enumerate().map(variable).collect();
    let indicators = u32::from(ball);
    if version == 2 {
        return format!(
            "<?xml version=\"1.0\"?><fmiModelDescription fmiVersion=\"2.0\" modelName=\"unit\" guid=\"{{7}}\" \
             numberOfEventIndicators=\"{indicators}\"><ModelExchange modelIdentifier=\"unit\"/>\
             <CoSimulation modelIdentifier=\"unit\"/>{UNITS}<TypeDefinitions><SimpleType name=\"Length\">\
             <Real unit=\"mm\"/></SimpleType></TypeDefinitions><ModelVariables>{variables}</ModelVariables>\
             <ModelStructure><Derivatives><Unknown index=\"1\"/><Unknown index=\"2\"/></Derivatives></ModelStructure>\
             </fmiModelDescription>"
        );
    }
    format!(
        "<?xml version=\"1.0\"?><fmiModelDescription fmiVersion=\"3.0\" modelName=\"unit\" instantiationToken=\"{{7}}\">\
         <ModelExchange modelIdentifier=\"unit\"/><CoSimulation modelIdentifier=\"unit\"/>{UNITS}<TypeDefinitions>\
         <Float64Type name=\"Length\" unit=\"mm\"/></TypeDefinitions><ModelVariables>{variables}</ModelVariables>\
         <ModelStructure><ContinuousStateDerivative valueReference=\"1\"/><ContinuousStateDerivative \
         valueReference=\"2\"/></ModelStructure></fmiModelDescription>"
    )
}

/// Writes `unit.fmu` into a folder: a description, and a source of a model that is compiled here with definitions.
fn compile(folder: &Path, version: u32, description: &str, source: &str, defined: &[String]) {
    let unit = folder.join(format!("unit{version}"));
    let arch = std::env::consts::ARCH;
    let binaries = if version == 2 { "binaries/linux64".to_owned() } else { format!("binaries/{arch}-linux") };
    fs::create_dir_all(unit.join(&binaries)).unwrap();
    fs::create_dir_all(unit.join("resources")).unwrap();
    fs::write(unit.join("resources/y.txt"), "a").unwrap();
    fs::write(unit.join("modelDescription.xml"), description).unwrap();
    fs::write(folder.join("unit.c"), source).unwrap();
    fs::write(folder.join("wrapper.c"), WRAPPER).unwrap();
    let mut compiler = Command::new("gcc");
    compiler.args(["-std=gnu11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-O1", "unit.c", "-o"]);
    compiler.arg(unit.join(binaries).join("unit.so")).arg(format!("-DFMI={version}"));
    compiler.args(defined.iter().map(|own| format!("-D{own}"))).arg("-lm").current_dir(folder);
    done(&mut compiler);
    let mut zip = Command::new("python3");
    zip.args(["-m", "zipfile", "-c", "../unit.fmu", "modelDescription.xml", "binaries", "resources"])
        .current_dir(&unit);
    done(&mut zip);
}

fn place(version: u32, ball: bool, model: &str) -> Place {
    let place = Place::new();
    let (k, m) = if ball { ("10.0", "0.8") } else { ("200.0", "2.0") };
    let mut defined = vec![format!("START_K={k}"), format!("START_M={m}"), format!("INDICATORS={}", u32::from(ball))];
    defined.extend(ball.then(|| "BALL".to_owned()));
    compile(place.path(), version, &description(version, ball), SOURCE, &defined);
    fs::write(place.path().join("model.yaml"), model).unwrap();
    place
}

/// Both versions, both interfaces: parameters deviate from the unit's start values, and numbers are those of SI.
#[test]
fn bounds_of_units_match_the_closed_form() {
    for (version, interface) in
        [(2, "co_simulation"), (3, "co_simulation"), (2, "model_exchange"), (3, "model_exchange")]
    {
        let model = format!(
            "parameters: {{ k: ± 5%, mass: 2 kg, start: 0.1 m }}
black_box:
  fmu: unit.fmu
  interface: {interface}
  variables: {{ mass: body.m, start: x0, u: x }}
  outputs: {{ u: cm, v: m/s, temperature: 1, count: 1 }}
outputs: {{ u: u, v: v, stretch: k * u, temperature: temperature, count: count }}
simulation: {{ duration: 0.3, output_step: 0.03 }}
bounds: {{ chebyshev: {{ order: 5 }}, scan: {{ points: 5 }} }}
"
        );
        let place = place(version, false, &model);
        let (output, _) = place.run("run model.yaml -o out", 0);
        let bounds = bounds(&place, "out");
        let [times, nominal, temperature] = ["t", "u.nominal", "temperature.nominal"].map(|name| column(&bounds, name));
        let [lower, upper, error] =
            ["lower", "upper", "error"].map(|end| column(&bounds, &format!("u.chebyshev.{end}")));
        // The unit's own solution is the closed form; that of model exchange is integrated.
        let close = if interface == "co_simulation" { 1e-14 } else { 1e-9 };
        for (row, t) in times.iter().enumerate() {
            let x = |k: f64| 0.1 * ((k / 2.0).sqrt() * t).cos();
            assert!((nominal[row] - x(200.0)).abs() < close, "{version} {interface} {t}: {}", nominal[row]);
            assert!((temperature[row] - 20.0 - x(200.0)).abs() < 1e-9, "{version} {interface} {t}");
            assert!((lower[row] - x(210.0)).abs() <= error[row] + close, "{version} {interface} {t}");
            assert!((upper[row] - x(190.0)).abs() <= error[row] + close, "{version} {interface} {t}");
        }
        let refined = output.contains("the error of its own steps was found by finer `step`");
        assert_eq!(refined, interface == "model_exchange", "{output}");
        let shown = fs::read_to_string(place.path().join("out/summary.json")).unwrap();
        assert!(shown.contains("\"cm\""), "{shown}");
    }
}

/// A ball rebounds where the step of the integrator is cut, to the closed form.
#[test]
fn events_of_model_exchange_match_the_closed_form() {
    for version in [2, 3] {
        let model = "parameters: { k: 10 m/s^2 }
black_box: { fmu: unit.fmu, interface: model_exchange }
simulation: { duration: 0.3, output_step: 0.01 }
bounds: { scan: { points: 2 } }
";
        let model = model.replace("10 m/s^2", "10 m/s^2 ± 1%");
        let place = place(version, true, &model);
        place.run("run model.yaml -o out", 0);
        let bounds = bounds(&place, "out");
        let [times, x, count] = ["t", "x.nominal", "count.nominal"].map(|name| column(&bounds, name));
        // It falls from 0.1 m: the first contact is at √(2 h / g).
        let first = (2.0 * 0.1 / 10.0_f64).sqrt();
        for (row, t) in times.iter().enumerate() {
            let after = t - first;
            let expected =
                if after < 0.0 { 0.1 - 5.0 * t * t } else { 0.8 * 10.0 * first * after - 5.0 * after * after };
            assert!((x[row] - expected).abs() < 1e-12, "{version} {t}: {} {expected}", x[row]);
            assert_eq!(count[row], f64::from(after >= 0.0), "{version} {t}");
        }
    }
}

#[test]
#[ignore = "15 s"]
fn failed_unit_affects_only_its_sample() {
    for (mode, expected) in [
        (1, "the program ended (signal: 6 (SIGABRT)"),
        (2, "the program did not answer within 2 s, and was ended"),
        (3, "the program says: `fmi3DoStep` failed (status 3)"),
    ] {
        let model = format!(
            "parameters: {{ k: ± 5%, mode: {mode} }}
black_box: {{ fmu: unit.fmu, time_limit: 2 s }}
outputs: {{ x: x }}
simulation: {{ duration: 0.3, output_step: 0.03 }}
bounds: {{ scan: {{ points: 5 }} }}
"
        );
        let place = place(3, false, &model);
        let (_, messages) = place.run("run model.yaml -o out --threads 2", 1);
        assert!(messages.contains(expected), "{mode}: {messages}");
        assert!(messages.contains("model.yaml:2: the black box has no answer with k = 210"), "{mode}: {messages}");
        let lower = column(&bounds(&place, "out"), "x.scan.lower");
        let least = 0.1 * ((205.0_f64 / 2.0).sqrt() * 0.3).cos();
        assert!((lower[10] - least).abs() < 1e-12, "{mode}: {}", lower[10]);
    }
}

/// Messages with their locations: names, types, interfaces and units are those of the description.
#[test]
fn wrong_names_are_reported_with_suggestions() {
    let model = "parameters: { kk: ± 5%, k: 200 kg, x: 3 m, unused: 1 }
black_box:
  fmu: unit.fmu
  variables: { kk: kay, mas: body.m }
  outputs: { v: mm, tempreture: 1 }
  protocol: csv
simulation: { duration: 0.3, output_step: 0.03 }
";
    let place = place(2, false, model);
    let (_, messages) = place.run("check model.yaml", 2);
    for expected in [
        "model.yaml:1:25",
        "the unit has no variable `kay`, from whose start value this deviates",
        "stands where a stiffness",
        "`x` cannot be set: it is calculated (output)",
        "the unit has no variable `tempreture`",
        "did you mean `temperature`?",
        "`v` is a velocity (m/s) in the unit, and cannot be shown in `mm`",
        "`mas` is neither a parameter nor an output of the unit",
        "`protocol` belongs to `command`",
    ] {
        assert!(messages.contains(expected), "{expected}: {messages}");
    }
    fs::write(place.path().join("model.yaml"), "parameters: { k: ± 5%, mod: 1 }\nblack_box: { fmu: unit.fmu }\n")
        .unwrap();
    let (_, messages) = place.run("check model.yaml", 2);
    assert!(messages.contains("the unit has no variable `mod`, and no formula uses it"), "{messages}");
    assert!(messages.contains("did you mean `mode`?"), "{messages}");
}

/// Units of a shipped model, and the model: one nominal motion, and one at every sample of its parameters.
#[test]
fn exported_units_have_the_bounds_of_their_model() {
    let place = Place::new();
    let own = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/models/slider_crank.yaml")).unwrap();
    let inner = own.split("bounds:").next().unwrap().replace("# yaml-language-server", "#");
    let asked = "bounds: { scan: { points: 4 } }\n";
    fs::write(place.path().join("own.yaml"), format!("{inner}{asked}")).unwrap();
    place.run("run own.yaml -o own", 0);
    for version in ["2.0", "3.0"] {
        place.run(&format!("export own.yaml --fmu={version} -o unit{version}"), 0);
        let outer = format!(
            "parameters: {{ l1: ± 1%, tau: -0.5 N*m ± 1% }}
black_box: {{ fmu: unit{version}/slider_crank.fmu, outputs: {{ x3: mm }} }}
simulation: {{ duration: 2, output_step: 0.01 }}
{asked}"
        );
        fs::write(place.path().join("outer.yaml"), outer).unwrap();
        place.run(&format!("run outer.yaml -o outer{version}"), 0);
        for name in ["x3.nominal", "x3.scan.lower", "x3.scan.upper"] {
            let [own, outer] =
                ["own".to_owned(), format!("outer{version}")].map(|folder| column(&bounds(&place, &folder), name));
            assert_eq!(own.len(), outer.len());
            let off = largest(own.iter().zip(&outer).map(|(a, b)| (a - b).abs()));
            assert!(off < 1e-10, "{version} {name}: {off}");
        }
    }
}
