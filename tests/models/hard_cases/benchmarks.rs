//! The published benchmarks, each against a solution that another method found: second order in the step, errors in
//! proportion to the tolerance, and the further demands of each benchmark.

use std::fmt::Write as _;

use mbint::results::Bounds;

use crate::common::measured::Case;
use crate::common::{Findings, Subject, curve, largest, model, nominal, order, read, reference, row, run_methods};

/// A benchmark with the known values of its solution.
struct Benchmark {
    name: &'static str,
    description: Subject,
    formulas: &'static [&'static str],
    /// The library that has it, and how its solution was found.
    source: &'static str,
    /// t, then a value for each formula.
    rows: Vec<Vec<f64>>,
}

/// Location of a benchmark's solution.
struct Solution {
    file: &'static str,
    source: &'static str,
    /// s; time of the last row, and interval between the rows that are compared.
    duration: f64,
    every: f64,
}

impl Benchmark {
    fn new(name: &'static str, description: Subject, formulas: &'static [&'static str], solution: &Solution) -> Self {
        let is_row = |row: &Vec<f64>| {
            let place = row[0] / solution.every;
            (place - place.round()).abs() < 1e-6 && row[0] <= solution.duration * (1.0 + 1e-9)
        };
        let pick = |row: Vec<f64>| row[..=formulas.len()].to_vec();
        let rows = reference(solution.file).into_iter().filter(is_row).map(pick).collect();
        let description = description.duration(solution.duration).rows_every(solution.every).observing(formulas);
        Self { name, description, formulas, source: solution.source, rows }
    }

    /// Largest difference from the solution, over all times and formulas.
    fn error(&self, bounds: &Bounds) -> f64 {
        let error = |(column, name)| {
            let curve = curve(bounds, name);
            largest(self.rows.iter().map(|line| curve[row(bounds, line[0])] - line[column + 1]))
        };
        largest(self.formulas.iter().copied().enumerate().map(error))
    }

    fn errors_of_steps(&self, steps: &[f64]) -> Vec<f64> {
        let errors: Vec<f64> = steps.iter().map(|&h| self.error(&nominal(&self.description.clone().step(h)))).collect();
        steps.iter().zip(&errors).for_each(|(h, error)| println!("{}: h = {h:.2e} s, error {error:.2e}", self.name));
        errors
    }

    fn errors_of_tolerances(&self, tolerances: &[f64]) -> Vec<f64> {
        let error = |&tolerance: &f64| {
            let (bounds, summary) =
                run_methods(&self.description.clone().by_hht().tolerance(tolerance), Some(Vec::new()));
            let error = self.error(&bounds);
            println!("{}: tolerance {tolerance:.0e}, {} steps, error {error:.2e}", self.name, summary.methods[0].steps);
            error
        };
        tolerances.iter().map(error).collect()
    }
}

fn pendulum() -> Benchmark {
    let source = "IFToMM A01; Jacobi's elliptic functions, 40 digits";
    let solution = Solution { file: "iftomm/pendulum.csv", source, duration: 10.0, every: 0.1 };
    Benchmark::new("pendulum", model("pendulum"), &["bob.x", "bob.y"], &solution)
}

/// `count` four-bar linkages side by side.
fn loops(count: usize) -> String {
    let list = |what: &dyn Fn(usize) -> String, range: std::ops::Range<usize>| range.map(what).collect::<String>();
    let bar = |i| format!("  bar{i}: {{ mass: 1, inertia: 1/12, points: {{ foot: [-0.5, 0], end: [0.5, 0] }} }}\n");
    let link = |i| format!("  link{i}: {{ mass: 1, inertia: 1/12, points: {{ left: [-0.5, 0], right: [0.5, 0] }} }}\n");
    let mut text = String::from("bodies:\n");
    writeln!(text, "  ground: {{ points: {{ {} }} }}", list(&|i| format!("P{i}: [{i}, 0], "), 0..count + 1)).unwrap();
    text += &list(&bar, 0..count + 1);
    text += &list(&link, 0..count);
    text += "joints:\n";
    text += &list(&|i| format!("  foot{i}: {{ revolute: [ground.P{i}, bar{i}.foot] }}\n"), 0..count + 1);
    text += &list(&|i| format!("  left{i}: {{ revolute: [bar{i}.end, link{i}.left] }}\n"), 0..count);
    text += &list(&|i| format!("  right{i}: {{ revolute: [link{i}.right, bar{}.end] }}\n", i + 1), 0..count);
    text += "effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { bar0.angle: 90 deg, bar0.angular_velocity: -1 }
";
    writeln!(text, "guess: {{ {} }}", list(&|i| format!("bar{i}.angle: 90 deg, "), 1..count + 1)).unwrap();
    text += "outputs: { x: bar0.end.x }\nsimulation: { duration: 10, step: 1e-3, output_step: 0.01 }\n";
    text
}

const FIRST_END: &[&str] = &["bar0.end.x", "bar0.end.y"];

fn two_loops() -> Benchmark {
    let source = "IFToMM A02; Taylor series in the bars' one angle, 30 digits";
    let solution = Solution { file: "iftomm/four_bar_n2.csv", source, duration: 10.0, every: 0.1 };
    Benchmark::new("two loops", model("four_bars"), FIRST_END, &solution)
}

fn forty_loops() -> Benchmark {
    let source = "IFToMM A02; Taylor series in the bars' one angle, 30 digits";
    let solution = Solution { file: "iftomm/four_bar_n40.csv", source, duration: 10.0, every: 0.1 };
    Benchmark::new("forty loops", read(&loops(40)), FIRST_END, &solution)
}

fn andrews() -> Benchmark {
    let formulas = &[
        "K1.angle",
        "K2.angle - K1.angle",
        "K3.angle",
        "K4.angle - K5.angle",
        "K5.angle",
        "K6.angle - K7.angle",
        "K7.angle",
    ];
    let source = "test set for IVP solvers; published solution, continued to more digits";
    let solution = Solution { file: "ivp/andrews.csv", source, duration: 0.03, every: 3e-4 };
    Benchmark::new("Andrews", model("andrews"), formulas, &solution)
}

fn bricard() -> Benchmark {
    let formulas = &["rod3.P3.x", "rod3.P3.y", "rod3.P3.z", "rod3.P2.x", "rod3.P2.y", "rod3.P2.z"];
    let source = "IFToMM A04; minimal coordinates, DOP853 at 1e-11";
    let solution = Solution { file: "iftomm/bricard.csv", source, duration: 10.0, every: 0.1 };
    Benchmark::new("Bricard", model("bricard"), formulas, &solution)
}

fn governor() -> Benchmark {
    let source = "IFToMM A05; minimal coordinates";
    let solution = Solution { file: "iftomm/flyball_governor.csv", source, duration: 10.0, every: 0.1 };
    let formulas = &["guide.displacement", "pin1.angle", "bearing.angular_velocity"];
    Benchmark::new("flyball governor", model("flyball_governor"), formulas, &solution)
}

fn car_axis() -> Benchmark {
    let source = "test set for IVP solvers; minimal coordinates, Radau at 1e-13";
    let solution = Solution { file: "ivp/car_axis.csv", source, duration: 3.0, every: 0.05 };
    Benchmark::new("car axis", model("car_axis"), &["left.x", "left.y", "right.x", "right.y"], &solution)
}

fn heavy_top() -> Benchmark {
    let source = "top with a fixed point; minimal coordinates, DOP853 at 1e-11";
    let solution = Solution { file: "iftomm/heavy_top.csv", source, duration: 0.5, every: 5e-3 };
    Benchmark::new("heavy top", model("heavy_top"), &["top.x", "top.y", "top.z"], &solution)
}

#[test]
#[ignore = "30 s: eight benchmarks of steps halved"]
fn every_benchmark_converges_with_order_two() {
    let cases = [
        (pendulum(), 1e-3),
        (two_loops(), 2.5e-4),
        (forty_loops(), 5e-4),
        (andrews(), 2e-6),
        (bricard(), 2e-3),
        (governor(), 2e-3),
        (car_axis(), 5e-4),
        (heavy_top(), 1e-4),
    ];
    let mut findings = Findings::default();
    for (benchmark, h) in cases {
        let errors = benchmark.errors_of_steps(&[h, 0.5 * h]);
        let case = Case::new("benchmarks", benchmark.name).source(benchmark.source);
        let case = case.order("order", order(errors[0], errors[1]), 2.0).figure("step, s", 0.5 * h);
        findings.note(case.figure("largest error, m or rad", errors[1]));
    }
    findings.none();
}

/// Halved down to where round-off shows, or patience ends: 2 minutes. Singular positions amplify rounding: two loops
/// are passed to 6e-8 m at best, with steps of 8e-6 s to 1.6e-5 s, others below 1e-9 m. Forty loops meet a flat
/// position to 1e-6 s with steps of 1.25e-4 s.
#[test]
#[ignore = "2 minutes: every benchmark with ever smaller steps"]
fn order_two_down_to_round_off() {
    let cases = [
        (pendulum(), 2e-3, 12, 1e-9),
        (two_loops(), 1e-3, 9, 1e-7),
        (forty_loops(), 1e-3, 5, 1e-7),
        (andrews(), 2e-6, 7, 1e-9),
        (bricard(), 2e-3, 5, 1e-9),
        (governor(), 4e-3, 6, 1e-9),
        (car_axis(), 1e-3, 11, 1e-9),
        (heavy_top(), 2e-4, 9, 1e-9),
    ];
    for (benchmark, h, count, rounding) in cases {
        let steps: Vec<f64> = (0..count).map(|level| h * 0.5_f64.powi(level)).collect();
        let errors = benchmark.errors_of_steps(&steps);
        for pair in errors.windows(2).take_while(|pair| pair[1] > rounding) {
            assert!((order(pair[0], pair[1]) - 2.0).abs() < 0.25, "{}: {errors:?}", benchmark.name);
        }
        // Rounding may stop the decrease, but does no harm.
        assert!(errors.iter().all(|error| *error <= errors[0]), "{}: {errors:?}", benchmark.name);
    }
}

/// A decade of the tolerance is a decade of the error, within a factor of 3.
fn falls_with_the_tolerance(benchmark: &Benchmark, tolerances: &[f64], findings: &mut Findings) {
    let errors = benchmark.errors_of_tolerances(tolerances);
    for (errors, tolerances) in errors.windows(2).zip(tolerances.windows(2)) {
        let fall = (errors[0] / errors[1]) / (tolerances[0] / tolerances[1]);
        let fine = (1.0 / 3.0..3.0).contains(&fall);
        findings.check(fine, format_args!("{}: {errors:?} for {tolerances:?}", benchmark.name));
    }
}

#[test]
#[ignore = "a minute: tolerances over decades"]
fn error_falls_with_the_tolerance() {
    let mut findings = Findings::default();
    let tolerances = [1e-4, 1e-5, 1e-6];
    for benchmark in [pendulum(), two_loops(), andrews(), car_axis(), heavy_top()] {
        falls_with_the_tolerance(&benchmark, &tolerances, &mut findings);
    }
    falls_with_the_tolerance(&bricard(), &[1e-3, 1e-4], &mut findings);
    falls_with_the_tolerance(&governor(), &[1e-3, 1e-4], &mut findings);
    findings.none();
}

#[test]
#[ignore = "by hand: tolerances down to 1e-7"]
fn error_falls_with_the_tolerance_down_to_1e_7() {
    let mut findings = Findings::default();
    for benchmark in [pendulum(), two_loops(), andrews(), car_axis(), heavy_top(), bricard(), governor()] {
        let tolerances = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
        falls_with_the_tolerance(&benchmark, &tolerances, &mut findings);
    }
    // At 1e-3 they are out of step with the reference by 0.12 m at the end, and further is hardly possible.
    falls_with_the_tolerance(&forty_loops(), &[1e-4, 1e-5, 1e-6], &mut findings);
    findings.none();
}

#[test]
fn andrews_mechanism_is_exact_to_a_millionth() {
    let benchmark = andrews();
    let errors = benchmark.errors_of_steps(&[5e-7]);
    let case = Case::new("benchmarks", "Andrews, short steps").source(benchmark.source);
    case.figure("step, s", 5e-7).at_most("largest error, m or rad", errors[0], 1e-6).note();
}

#[test]
#[ignore = "2 minutes: hundreds of thousands of steps"]
fn andrews_mechanism_is_exact_to_1e_8_by_tolerance() {
    // The crank's turns, 16 rad, carry 18 to 24 times the tolerance.
    let errors = andrews().errors_of_tolerances(&[3e-10]);
    assert!(errors[0] < 1e-8, "{errors:?}");
}

/// Limits of the benchmarks on the energy: 5e-5 J for the pendulum, 0.1 J for the loops, 1e-3 J for Bricard's
/// mechanism.
#[test]
#[ignore = "10 s: long motions"]
fn energy_is_kept_as_the_benchmarks_ask() {
    for (benchmark, h, allowed) in
        [(pendulum(), 1e-4, 5e-5), (two_loops(), 1e-3, 0.1), (forty_loops(), 1e-3, 0.1), (bricard(), 1e-3, 1e-3)]
    {
        let bounds = nominal(&benchmark.description.observing(&["energy"]).step(h));
        let energy = curve(&bounds, "energy");
        let drift = largest(energy.iter().map(|value| value - energy[0]));
        println!("{}: h = {h:.0e} s, energy off by {drift:.2e} J", benchmark.name);
        let case =
            Case::new("benchmarks", &format!("{}, energy", benchmark.name)).source("limit of the IFToMM library");
        case.figure("step, s", h).at_most("largest drift of energy, J", drift, allowed).note();
    }
}

#[test]
fn loops_stay_parallel_through_their_singular_positions() {
    let all_bars = &["bar40.angle - bar0.angle", "bar20.angle - bar0.angle", "link0.angle", "link39.angle"];
    let two_bars = &["bar2.angle - bar0.angle", "bar1.angle - bar0.angle", "coupler0.angle", "coupler1.angle"];
    for (benchmark, formulas) in [(two_loops(), two_bars), (forty_loops(), all_bars)] {
        let bounds = nominal(&benchmark.description.observing(formulas).step(1e-3));
        for formula in formulas {
            let off = largest(curve(&bounds, formula).iter().copied());
            println!("{}: {formula} is {off:.2e} rad at most", benchmark.name);
            assert!(off < 1e-6, "{}: {formula} {off:e}", benchmark.name);
        }
    }
}

/// Bars lie on one line where the first one's end is at the height of its foot: in the reference between rows.
#[test]
fn singular_configurations_on_the_path_are_reported() {
    let benchmark = two_loops();
    let (_, summary) = run_methods(&benchmark.description.clone().step(5e-4), Some(Vec::new()));
    let found: Vec<f64> = summary.singular_configurations.iter().map(|pass| pass.time).collect();
    println!("{found:?}");
    for pass in &summary.singular_configurations {
        assert_eq!(pass.constraints.len(), 2, "two loops lose one constraint each: {pass:?}");
    }
    let rows = reference("iftomm/four_bar_n2.csv");
    let crossings: Vec<f64> = rows
        .windows(2)
        .filter(|pair| pair[0][2] * pair[1][2] < 0.0)
        .map(|pair| pair[0][0] + (pair[1][0] - pair[0][0]) * pair[0][2] / (pair[0][2] - pair[1][2]))
        .collect();
    assert_eq!(found.len(), crossings.len(), "{found:?} instead of {crossings:?}");
    // Linear between rows 0.01 s apart: 1e-5 s; the motion itself: 7e-5 of a turn of 7 rad/s.
    for (found, crossing) in found.iter().zip(&crossings) {
        assert!((found - crossing).abs() < 1e-4, "{found} instead of {crossing}");
    }
}

#[test]
fn bricards_reactions_are_reported_as_not_unique() {
    let outputs = &["J5.torque.x", "J0.force.x", "rod3.P3.x", "energy"];
    let description = bricard().description.observing(outputs).duration(0.1).rows_every(0.05);
    let (_, summary) = run_methods(&description.step(5e-3), Some(Vec::new()));
    println!("{:?}", summary.undetermined_outputs);
    assert_eq!(summary.redundant_constraints.len(), 1);
    let undetermined = &summary.undetermined_outputs;
    assert!(undetermined.iter().all(|name| name.starts_with('J')) && !undetermined.is_empty(), "{undetermined:?}");
}
