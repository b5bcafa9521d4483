//! Validation: bands of models against published measurements, by ASME V&V 20.
//!
//! E = S − D is the comparison error of a simulated value and a measured one. Its standard uncertainty is that of
//! numbers, of inputs and of the measurement, u_val² = u_num² + u_input² + u_D²; the model's own error is E ± u_val.
//! Bands have uniform inputs: u_input is their half width over √3. No source states an uncertainty of its measurements,
//! so that u_D is that of the numbers: their scatter about a smooth curve, and the digits of a reading.

use std::path::Path;

use mbint::Model;
use mbint::results::{Bounds, Method};
use nalgebra::{DMatrix, DVector};

use crate::common::measured::Case;
use crate::common::{Subject, band, curve, nominal, output, run};

/// Digits of a reading, as a standard uncertainty of a uniform distribution over one of them.
fn of_digits(step: f64) -> f64 {
    step / 12.0_f64.sqrt()
}

/// A model of `tests/validation` with some texts replaced.
fn model(file: &str, replaced: &[(&str, String)]) -> Subject {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validation").join(file);
    let mut text = std::fs::read_to_string(path).unwrap();
    for (old, new) in replaced {
        assert_eq!(text.matches(old).count(), 1, "{file}: {old}");
        text = text.replace(old, new);
    }
    Model::from_yaml_str(file, &text).unwrap().into()
}

/// Nominal value, and half the width of the band.
fn value(bounds: &Bounds, name: &str) -> [f64; 2] {
    let band = band(output(bounds, name), Method::Chebyshev);
    [curve(bounds, name)[0], 0.5 * (band.upper[0] - band.lower[0])]
}

/// Standard deviation of measured values about the sum of functions that fits them best.
fn scatter(points: &[(f64, f64)], functions: &[fn(f64) -> f64]) -> f64 {
    let basis = DMatrix::from_fn(points.len(), functions.len(), |row, column| functions[column](points[row].0));
    let values = DVector::from_iterator(points.len(), points.iter().map(|(_, value)| *value));
    let best = basis.clone().svd(true, true).solve(&values, 1e-12).unwrap();
    ((values - basis * best).norm_squared() / (points.len() - functions.len()) as f64).sqrt()
}

/// A comparison in one unit.
struct Comparison {
    simulated: f64,
    measured: f64,
    numbers: f64,
    inputs: f64,
    measurement: f64,
}

impl Comparison {
    /// Adds its figures; the error is no more than this share of the measured value.
    fn figures(&self, case: Case, unit: &str, share: f64) -> Case {
        let error = self.simulated - self.measured;
        let uncertainty = self.numbers.hypot(self.inputs).hypot(self.measurement);
        println!("{:.4} {:.4}: E = {error:.4} {unit}, u_val = {uncertainty:.4}", self.simulated, self.measured);
        case.figure(&format!("measured D, {unit}"), self.measured)
            .figure(&format!("simulated S, {unit}"), self.simulated)
            .figure(&format!("E = S − D, {unit}"), error)
            .figure("u_num", self.numbers)
            .figure("u_input", self.inputs)
            .figure("u_D", self.measurement)
            .figure("u_val", uncertainty)
            .text("E within u_val", if error.abs() <= uncertainty { "yes" } else { "no" })
            .at_most("E/D, %", 100.0 * (error / self.measured).abs(), share)
    }
}

/// Tip displacements of the Pazy wing without skin, m: mass, measured by Avin et al., computed by Riso and Cesnik with
/// UM/NAST and the same stiffnesses. Files of the source have them in % of the semispan of 0.549843728 m
/// (`static_bending_sweep_skin0_disp_exp.txt`, `static_bending_sweep_skin0.txt`).
const PAZY: [(f64, f64, Option<f64>); 10] = [
    (0.2, 4.273_941_631_648_47, None),
    (0.4, 9.093_492_833_294_63, Some(8.682_121_710)),
    (0.6, 13.549_304_321_609_0, None),
    (0.8, 17.914_180_881_590_6, Some(16.840_796_161)),
    (1.0, 22.097_187_584_905_9, None),
    (1.2, 25.916_454_574_889_7, Some(24.228_549_008)),
    (1.4, 29.553_851_708_207_5, None),
    (1.6, 32.918_444_056_526_5, Some(30.743_386_677)),
    (1.8, 36.010_231_619_846_7, None),
    (2.0, 38.829_214_398_168_1, Some(36.395_361_848)),
];
const SEMISPAN: f64 = 0.549_843_728;

/// The tip goes by 39 % of the length. It is measured 5 to 7 % further than the stiffnesses of the finite-element model
/// let it go, in mbint as in UM/NAST.
#[test]
fn the_pazy_wing_bends_as_measured() {
    let millimetres = |percent: f64| 10.0 * percent * SEMISPAN;
    let points = PAZY.map(|(mass, percent, _)| (mass, millimetres(percent)));
    let smooth: [fn(f64) -> f64; 3] = [|mass| mass, |mass| mass * mass, |mass| mass * mass * mass];
    // All readings are whole multiples of half a millimetre.
    assert!(points.iter().all(|(_, value)| (2.0 * value - (2.0 * value).round()).abs() < 1e-3), "{points:?}");
    let measurement = scatter(&points, &smooth).hypot(of_digits(0.5));
    let at = |mass: f64| {
        let bounds = run(&model("pazy_wing.yaml", &[("load: 0 kg", format!("load: {mass} kg"))]));
        value(&bounds, "y").map(|own| 1e3 * own)
    };
    let unloaded = at(0.0);
    for (mass, percent, computed) in PAZY {
        let Some(computed) = computed.map(millimetres) else { continue };
        let [tip, half] = at(mass);
        let simulated = unloaded[0] - tip;
        let found = Comparison {
            simulated,
            measured: millimetres(percent),
            numbers: (simulated - computed).abs(),
            inputs: (half - unloaded[1]) / 3.0_f64.sqrt(),
            measurement,
        };
        let case = Case::new("validation", &format!("Pazy wing, {mass} kg at the tip"))
            .source("Avin et al., AIAA J. 60 (2022); stiffnesses of Riso and Cesnik (2022)");
        let against_peer = 100.0 * found.numbers / computed;
        found.figures(case, "mm", 8.0).at_most("apart from UM/NAST, %", against_peer, 0.1).note();
    }
}

/// Frequencies of Tang and Dowell's wing, Hz, by root angle: flapwise and chordwise (`freqs_exp.txt`), and its
/// chordwise tip displacement, mm (`u2_exp.txt`).
const TANG_DOWELL: [(f64, [f64; 2]); 7] = [
    (0.0, [2.5492, 13.796]),
    (15.0, [2.5301, 13.841]),
    (30.0, [2.5209, 13.917]),
    (45.0, [2.5024, 14.032]),
    (60.0, [2.4839, 14.082]),
    (75.0, [2.4745, 14.271]),
    (90.0, [2.4708, 14.273]),
];
const CHORDWISE: [(f64, f64); 2] = [(45.0, 1.0005), (90.0, 1.3530)];

/// It sags by an eighth of its length, which couples bending and torsion. Displacements agree; the flapwise frequency
/// is measured a tenth higher than the published stiffness and masses have it.
#[test]
#[ignore = "seconds: bounds of three spatial models about their equilibria"]
fn the_wing_of_tang_and_dowell_vibrates_as_measured() {
    let source = "Tang & Dowell, AIAA J. 39 (2001) 1430, by AeroBeams";
    let smooth: [fn(f64) -> f64; 2] = [|_| 1.0, |degrees| degrees.to_radians().sin().powi(2)];
    for angle in [0.0, 45.0, 90.0] {
        let (_, frequencies) = TANG_DOWELL.iter().find(|(own, _)| *own == angle).unwrap();
        let root = ("root: { value: 0 deg,", format!("root: {{ value: {angle} deg,"));
        let found = run(&model("tang_dowell_wing.yaml", std::slice::from_ref(&root)));
        let finer = nominal(&model("tang_dowell_wing.yaml", &[root, ("elements: 8", "elements: 12".to_owned())]));
        let compared = |name: &str, per: f64, measured: f64, measurement: f64| {
            let [simulated, half] = value(&found, name).map(|own| per * own);
            let fine = per * curve(&finer, name)[0];
            Comparison {
                simulated,
                measured,
                numbers: (simulated - fine).abs(),
                inputs: half / 3.0_f64.sqrt(),
                measurement,
            }
        };
        for (mode, word) in ["flapwise", "chordwise"].into_iter().enumerate() {
            let points: Vec<(f64, f64)> = TANG_DOWELL.iter().map(|(angle, all)| (*angle, all[mode])).collect();
            let name = format!("mode{}.frequency", mode + 1);
            let case = Case::new("validation", &format!("wing of Tang and Dowell at {angle}°, {word} frequency"));
            let found = compared(&name, 1.0, frequencies[mode], scatter(&points, &smooth));
            found.figures(case.source(source), "Hz", 12.0).note();
        }
        if let Some((_, measured)) = CHORDWISE.iter().find(|(own, _)| *own == angle) {
            let case = Case::new("validation", &format!("wing of Tang and Dowell at {angle}°, chordwise tip"));
            compared("chordwise", 1e3, *measured, of_digits(1e-4)).figures(case.source(source), "mm", 4.0).note();
        }
    }
}
