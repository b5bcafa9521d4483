//! `mbint export`: C and units of FMI compute the nominal motion of the scheme.

use std::fs;
use std::process::Command;

use mbint::{Model, SchemeChoice};

use super::place::Place;

mod steps;

/// Shipped models: planar and spatial linkages, contacts, controllers, beams, cams, belts, redundant constraints and
/// reactions; with the largest difference that was measured, relative to the output's largest value.
const MODELS: [&str; 14] = [
    "pendulum",
    "slider_crank",
    "andrews",
    "belt",
    "braking_car",
    "bricard",
    "cam",
    "car_axis",
    "chain",
    "coin",
    "computed_torque",
    "crane",
    "delta_robot",
    "double_pendulum",
];

/// Columns of a table by name, in its order.
fn columns(text: &str) -> Vec<(String, Vec<f64>)> {
    let mut lines = text.lines();
    let mut columns: Vec<(String, Vec<f64>)> =
        lines.next().unwrap().split(',').map(|name| (name.to_owned(), Vec::new())).collect();
    for line in lines {
        for ((_, values), text) in columns.iter_mut().zip(line.split(',')) {
            values.push(text.parse().unwrap_or(f64::NAN));
        }
    }
    columns
}

#[test]
#[ignore = "15 s"]
fn c_repeats_the_nominal_motion() {
    let place = Place::new();
    for name in MODELS {
        let model = format!("{}/models/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        place.run(&format!("export {model} --c -o {name}"), 0);
        let folder = place.path().join(name);
        let compiled = Command::new("gcc")
            .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O1", "-o", "motion"])
            .args([format!("{name}.c"), format!("{name}_main.c"), "-lm".to_owned()])
            .current_dir(&folder)
            .output()
            .unwrap();
        assert!(compiled.status.success(), "{name}: {}", String::from_utf8_lossy(&compiled.stderr));
        let found = Command::new(folder.join("motion")).output().unwrap();
        assert!(found.status.success(), "{name}: {}", String::from_utf8_lossy(&found.stderr));
        let found = columns(&String::from_utf8(found.stdout).unwrap());
        // The C has the scheme's steps, also where a run has others that end at jumps of functions of the time.
        let model = Model::from_file(&model).unwrap();
        let ran = model.study().scheme(SchemeChoice::Hht).nominal().run().unwrap();
        let expected = &ran.bounds().outputs;
        for (output, values) in &found[1..] {
            let expected = &expected.iter().find(|own| own.name == *output).unwrap().nominal;
            assert_eq!(values.len(), expected.len(), "{name}: {output}");
            let size = expected.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
            let off = values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off <= 1e-9 * size, "{name}: {output} is off by {off} of {size}");
        }
    }
}

/// A host of FMI 3.0: instantiates the library of a unit, and steps it from row to row.
const HOST: &str = r#"
#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
typedef void *(*instantiate)(const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t, void *, void *, void *);
typedef int (*enter)(void *, bool, double, double, bool, double);
typedef int (*of)(void *);
typedef int (*get)(void *, const uint32_t *, size_t, double *, size_t);
typedef int (*do_step)(void *, double, double, bool, bool *, bool *, bool *, double *);
int main(int count, char **given)
{
    void *library = dlopen(given[1], RTLD_NOW);
    double step = atof(given[3]), values[2], reached;
    int rows = atoi(given[4]), row;
    bool event, ends, early;
    uint32_t references[2] = { 0, 1 };
    void *own;
    (void)count;
    if (!library) return 9;
    own = ((instantiate)dlsym(library, "fmi3InstantiateCoSimulation"))("own", "another", "", false, false, false, false, NULL, 0, NULL, NULL, NULL);
    if (own) return 8;
    own = ((instantiate)dlsym(library, "fmi3InstantiateCoSimulation"))("own", given[2], "", false, false, false, false, NULL, 0, NULL, NULL, NULL);
    if (!own || ((enter)dlsym(library, "fmi3EnterInitializationMode"))(own, false, 0, 0, false, 0)) return 7;
    if (((of)dlsym(library, "fmi3ExitInitializationMode"))(own)) return 6;
    printf("t,x\n");
    for (row = 0; row < rows; row++) {
        if (row > 0 && ((do_step)dlsym(library, "fmi3DoStep"))(own, (row - 1) * step, step, true, &event, &ends, &early, &reached)) return 5;
        if (((get)dlsym(library, "fmi3GetFloat64"))(own, references, 2, values, 2)) return 4;
        printf("%.17g,%.17g\n", values[0], values[1]);
    }
    return 0;
}
"#;

#[test]
#[ignore = "2 s"]
fn a_unit_repeats_the_nominal_motion() {
    let place = Place::new();
    for name in ["slider_crank", "car_axis", "andrews"] {
        let model = format!("{}/models/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        place.run(&format!("export {model} --fmu -o {name}"), 0);
        let folder = place.path().join(name);
        fs::write(folder.join("host.c"), HOST).unwrap();
        let done = |program: &str, arguments: &[&str]| {
            let done = Command::new(program).args(arguments).current_dir(&folder).output().unwrap();
            assert!(
                done.status.success(),
                "{name}, {program}: {:?} {}",
                done.status,
                String::from_utf8_lossy(&done.stderr)
            );
            String::from_utf8(done.stdout).unwrap()
        };
        done("python3", &["-m", "zipfile", "-e", &format!("{name}.fmu"), "unit"]);
        done("gcc", &["-std=gnu11", "-o", "host", "host.c", "-ldl"]);
        let text = fs::read_to_string(folder.join("unit/modelDescription.xml")).unwrap();
        let description = roxmltree::Document::parse(&text).unwrap();
        let root = description.root_element();
        let find = |tag: &str| root.descendants().find(|node| node.has_tag_name(tag)).unwrap();
        let token = root.attribute("instantiationToken").unwrap();
        let step = find("DefaultExperiment").attribute("stepSize").unwrap();
        let outputs: Vec<_> = root.descendants().filter(|node| node.attribute("causality") == Some("output")).collect();
        let output = outputs[0].attribute("name").unwrap();
        place.run(&format!("run {model} --method chebyshev --yes --quiet -o {name}/run"), 0);
        let expected = columns(&fs::read_to_string(folder.join("run/bounds.csv")).unwrap());
        let (_, expected) = expected.iter().find(|(own, _)| *own == format!("{output}.nominal")).unwrap();
        let library = format!("./unit/binaries/{}-linux/{name}.so", std::env::consts::ARCH);
        let found = columns(&done("./host", &[&library, token, step, &expected.len().to_string()]));
        let size = expected.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        let off = found[1].1.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off <= 1e-9 * size, "{name}: {output} is off by {off} of {size}");
    }
}

/// A host of the C model: starts it with other parameters, and writes its rows.
const OTHER_START: &str = r#"
#include "NAME.h"
#include <stdio.h>
#include <stdlib.h>
static PREFIX_model model;
int main(int count, char **given)
{
    double parameters[PREFIX_parameter_count], outputs[PREFIX_output_count];
    int row, k;
    for (k = 0; k < PREFIX_parameter_count; k++) parameters[k] = k + 1 < count ? atof(given[k + 1]) : PREFIX_parameter_values[k];
    if (PREFIX_start_at(&model, parameters)) return 9;
    printf("t");
    for (k = 0; k < PREFIX_output_count; k++) printf(",%s", PREFIX_output_names[k]);
    printf("\n");
    for (row = 0; row < PREFIX_rows; row++) {
        if (row > 0 && PREFIX_row(&model, row)) return 8;
        PREFIX_outputs(&model, outputs);
        printf("%.17g", PREFIX_time(row));
        for (k = 0; k < PREFIX_output_count; k++) printf(",%.17g", outputs[k]);
        printf("\n");
    }
    return 0;
}
"#;

/// At the upper ends of all parameters the C is that of `mbint sample`: linkages are assembled anew.
#[test]
#[ignore = "2 s"]
fn start_at_other_parameters_matches_a_sample() {
    let place = Place::new();
    for name in ["slider_crank", "four_bars", "car_axis", "andrews"] {
        let model = format!("{}/models/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        place.run(&format!("export {model} --c --fmu -o {name}"), 0);
        let folder = place.path().join(name);
        let unit = fs::read_to_string(folder.join(format!("{name}.h"))).unwrap();
        assert!(unit.contains("_start_at("), "{name}");
        place.run(&format!("sample {model} --design sobol:3 -o {name}/samples.csv"), 0);
        let text = fs::read_to_string(folder.join("samples.csv")).unwrap();
        let samples = columns(&text);
        let heading: Vec<&str> = samples.iter().map(|(name, _)| name.as_str()).collect();
        fs::write(folder.join("host.c"), OTHER_START.replace("NAME", name).replace("PREFIX", name)).unwrap();
        let compiled = Command::new("gcc")
            .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-o", "motion", "host.c"])
            .args([format!("{name}.c"), "-lm".to_owned()])
            .current_dir(&folder)
            .output()
            .unwrap();
        assert!(compiled.status.success(), "{name}: {}", String::from_utf8_lossy(&compiled.stderr));
        let rows = samples[0].1.iter().filter(|number| **number == 0.0).count();
        // Parameters stand between the number of the sample and the time.
        let time = heading.iter().position(|own| *own == "t").unwrap();
        for sample in 0..3 {
            let point: Vec<String> = (1..time).map(|own| format!("{:?}", samples[own].1[sample * rows])).collect();
            let found = Command::new(folder.join("motion")).args(&point).output().unwrap();
            assert!(found.status.success(), "{name}: {:?}", found.status);
            let found = columns(&String::from_utf8(found.stdout).unwrap());
            for (output, values) in &found[1..] {
                let (_, expected) = samples.iter().find(|(own, _)| own == output).unwrap();
                let expected = &expected[sample * rows..][..rows];
                let size = expected.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
                let off = values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(off <= 1e-9 * size, "{name}, sample {sample}: {output} is off by {off} of {size}");
            }
        }
    }
}

/// A force that changes from row to row moves a mass by parabolas, whatever steps it takes.
#[test]
#[ignore = "2 s"]
fn inputs_change_forces_during_the_motion() {
    let place = Place::new();
    let model = "model: mass
parameters: { f: 3 N ± 1%, m: 2 kg ± 1% }
bodies: { mass: { mass: m, coordinates: [x] } }
effects: { push: { force: { on: mass, value: [f, 0] } } }
initial: { mass.x: 0, mass.vx: 0 }
outputs: { x: mass.x, a: mass.ax }
simulation: { duration: 1, STEPS, output_step: 0.1 }
";
    for steps in [
        "step: 1e-2",
        "step: 1e-2, extrapolation: 2",
        "tolerance: 1e-4, scheme: hht",
        "tolerance: 1e-4, scheme: explicit",
    ] {
        follows_inputs(&place, &model.replace("STEPS", steps));
    }
}

fn follows_inputs(place: &Place, model: &str) {
    fs::write(place.path().join("mass.yaml"), model).unwrap();
    let (_, message) = place.run("export mass.yaml --c --input m", 2);
    assert!(message.contains("`m` cannot be an input: constraints or masses depend on it"), "{message}");
    let (_, message) = place.run("export mass.yaml --c --input g", 2);
    assert!(message.contains("`g` cannot be an input: inputs are uncertain parameters"), "{message}");
    place.run("export mass.yaml --c --fmu --input f -o out", 0);
    let host = OTHER_START.replace("NAME", "mass").replace("PREFIX", "mass");
    let host = host
        .replace("if (row > 0 &&", "if (row > 0) mass_set(&model, 0, row % 2 ? 4.0 : -2.0);\n        if (row > 0 &&");
    let folder = place.path().join("out");
    fs::write(folder.join("host.c"), host).unwrap();
    let compiled = Command::new("gcc")
        .args(["-std=c99", "-Werror", "-O1", "-o", "motion", "host.c", "mass.c", "-lm"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let found = Command::new(folder.join("motion")).output().unwrap();
    let found = columns(&String::from_utf8(found.stdout).unwrap());
    let (mut x, mut v) = (0.0, 0.0);
    for row in 1..11 {
        let a = if row % 2 == 1 { 2.0 } else { -1.0 };
        (x, v) = (x + 0.1 * v + 0.005 * a, v + 0.1 * a);
        assert!((found[1].1[row] - x).abs() < 1e-12, "row {row}: {} {x}", found[1].1[row]);
        assert!((found[2].1[row] - a).abs() < 1e-11, "row {row}: {} {a}", found[2].1[row]);
    }
    let archive = Command::new("python3")
        .args(["-m", "zipfile", "-e", "mass.fmu", "unit"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(archive.status.success());
    let description = fs::read_to_string(folder.join("unit/modelDescription.xml")).unwrap();
    assert!(description.contains("name=\"f\" valueReference=\"3\" causality=\"input\""), "{description}");
    assert!(description.contains("name=\"m\" valueReference=\"4\" causality=\"parameter\""), "{description}");
    assert!(description.contains("<Parameter name=\"f\" nominal=\"3"), "{description}");
    // The terms stand in the unit and in its sources.
    assert!(description.contains("license=\"the model: its author's terms; the runtime, mbint's: MIT OR Apache-2.0\""));
    for file in ["documentation/licenses/license.txt", "sources/mass.c", "sources/mass.h", "sources/fmi3.c"] {
        let text = fs::read_to_string(folder.join("unit").join(file)).unwrap();
        assert!(text.contains("SPDX-License-Identifier: MIT OR Apache-2.0"), "{file}");
    }
}

/// Parallelograms that become flat: the C omits the steps through singular configurations, and the command reports it.
#[test]
fn singular_configurations_are_announced() {
    let place = Place::new();
    let (mut bodies, mut joints, mut initial) = (String::new(), String::new(), Vec::new());
    for k in 0..4 {
        bodies += &format!(
            "  one{k}: {{ mass: 1, inertia: 0.1, points: {{ A: [0, 0], B: [1, 0] }} }}
  two{k}: {{ mass: 1, inertia: 0.1, points: {{ A: [0, 0], B: [1, 0] }} }}
  rod{k}: {{ mass: 1, inertia: 0.3, points: {{ A: [0, 0], B: [2, 0] }} }}
"
        );
        joints += &format!(
            "  p{k}: {{ revolute: [ground, one{k}.A] }}
  q{k}: {{ revolute: [ground.b, two{k}.A] }}
  r{k}: {{ revolute: [one{k}.B, rod{k}.A] }}
  s{k}: {{ revolute: [two{k}.B, rod{k}.B] }}
"
        );
        initial.push(format!("one{k}.angle: 1.2, one{k}.angular_velocity: -3"));
    }
    let model = format!(
        "model: flat
bodies:
  ground: {{ points: {{ b: [2, 0] }} }}
{bodies}joints:
{joints}initial: {{ {} }}
outputs: {{ a: one0.angle + one1.angle + one2.angle + one3.angle }}
simulation: {{ duration: DURATION, step: 1e-3, output_step: 0.02 }}
",
        initial.join(", ")
    );
    for (duration, is_met) in [("0.2", false), ("1", true)] {
        fs::write(place.path().join("flat.yaml"), model.replace("DURATION", duration)).unwrap();
        let (_, message) = place.run("export flat.yaml --c -o out", 0);
        let expected = "the nominal motion passes singular configurations (steps there: ";
        assert_eq!(message.contains(expected), is_met, "{message}");
    }
}

/// A motion that does not reach its end is refused with the reason.
#[test]
fn motions_that_stop_are_refused() {
    let place = Place::new();
    let model = "model: block
bodies: { block: { mass: 1, coordinates: [x] } }
effects:
  push: { force: { on: block, value: [FORCE, 0] } }
initial: { block.x: 0, block.vx: 1 }
outputs: { x: block.x }
simulation: { duration: 2, STEPS, output_step: 0.02 }
";
    let jumps = model.replace("FORCE", "\"-3 N*sign(block.vx) + 2 N*sin(7*t)\"");
    fs::write(place.path().join("block.yaml"), jumps.replace("STEPS", "tolerance: 1e-5, scheme: hht")).unwrap();
    let (_, message) = place.run("export block.yaml --c", 1);
    assert!(message.contains("the tolerance takes more than 20000 steps"), "{message}");
    let ends = model.replace("FORCE", "\"1 N*sqrt(0.5 - t/(1 s))\"").replace("STEPS", "step: 1e-3");
    fs::write(place.path().join("block.yaml"), ends).unwrap();
    let (_, message) = place.run("export block.yaml --c", 2);
    assert!(message.contains("its nominal motion stops before the end"), "{message}");
}

#[test]
fn unsupported_models_are_refused() {
    let place = Place::new();
    let model = format!("{}/models/four_bar_ventilator.yaml", env!("CARGO_MANIFEST_DIR"));
    let (_, message) = place.run(&format!("export {model} --c"), 2);
    let expected = "four_bar_ventilator: it cannot be written as C: its analysis has no motion; without the key `analysis` it has one";
    assert!(message.contains(expected), "{message}");
    let (_, message) = place.run(&format!("export {model}"), 2);
    assert!(message.contains("--c"), "{message}");
}
