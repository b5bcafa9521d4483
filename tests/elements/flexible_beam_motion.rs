//! Motions of beams with mass against the textbook: natural frequencies, free flight, rotating beams, stiff rods.

use std::f64::consts::PI;

use mbint::inner::assemble;
use mbint::results::Bounds;
use nalgebra::DMatrix;

use crate::common::{curve, distance_from, largest, nominal, order, read, richardson};

/// Circular frequencies of a beam of length 1, EI = 1, μ = 1, from M and K of the straight beam; `held` coordinates are
/// fixed.
fn frequencies(elements: usize, held: &[&str]) -> Vec<f64> {
    let description = read(&format!(
        "
bodies: {{ rod: {{ beam: {{ length: 1, mass_per_length: 1, axial_stiffness: 1e6, bending_stiffness: 1, elements: {elements} }} }} }}
outputs: {{ x: rod.end.x }}
simulation: {{ duration: 1, step: 0.1 }}
"
    ));
    let system = assemble::build(&assemble::Questions::of(description.study().description())).unwrap();
    let mut g = system.graph.clone();
    let slopes = g.jacobian(&system.force, &system.q);
    let value = |symbol| {
        let place = system.q.iter().position(|q| *q == symbol);
        let node = place.filter(|place| place % 3 == 0).map_or(0, |place| place / 3);
        node as f64 / elements as f64
    };
    let n = system.q.len();
    let free: Vec<usize> = (0..n).filter(|&i| !held.contains(&system.coordinates[i].name.as_str())).collect();
    let matrix = |entries: &mut dyn Iterator<Item = (usize, usize, symdiff::Expr)>| {
        let mut full = DMatrix::zeros(n, n);
        for (row, column, entry) in entries {
            full[(row, column)] = g.evaluate(&[entry], value)[0];
        }
        full.select_rows(&free).select_columns(&free)
    };
    let mass = matrix(&mut system.mass.iter().copied());
    let stiffness = -matrix(&mut slopes.entries());
    let root = mass.cholesky().unwrap().l();
    let inverse = root.try_inverse().unwrap();
    let mut squares: Vec<f64> =
        (&inverse * stiffness * inverse.transpose()).symmetric_eigenvalues().iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    squares.into_iter().map(|square| square.max(0.0).sqrt()).collect()
}

#[test]
fn natural_frequencies_match_the_textbook() {
    let clamped = ["rod.start.x", "rod.start.y", "rod.start.angle"];
    let pinned = ["rod.start.x", "rod.start.y", "rod.end.y"];
    for (name, held, roots) in [
        ("cantilever", clamped, [1.875_104_069, 4.694_091_133, 7.854_757_438]),
        ("pinned at both ends", pinned, [PI, 2.0 * PI, 3.0 * PI]),
    ] {
        let errors: Vec<Vec<f64>> = [1, 2, 4, 8, 16]
            .into_iter()
            .map(|elements| {
                let found = frequencies(elements, &held);
                roots.iter().zip(&found).map(|(root, found)| found / (root * root) - 1.0).collect()
            })
            .collect();
        for errors in &errors {
            let shown: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
            println!("{name}: off by {}", shown.join(", "));
        }
        let last: Vec<f64> = errors[3].iter().zip(&errors[4]).map(|(coarse, fine)| order(*coarse, *fine)).collect();
        println!("orders {last:.2?}");
        // From above, as of every consistent mass.
        assert!(errors.iter().flatten().all(|error| *error > 0.0));
        assert!(last.iter().all(|order| (order - 4.0).abs() < 0.1), "{last:?}");
        assert!(errors[2][0] < 3e-4 && errors[3].iter().all(|error| *error < 2e-3), "{errors:?}");
    }
}

/// The first mode's shape and slope at x of a cantilever of length 1.
fn first_mode(x: f64) -> [f64; 2] {
    let k = 1.875_104_068_711_961_f64;
    let ratio = (k.cosh() + k.cos()) / (k.sinh() + k.sin());
    let shape = (k * x).cosh() - (k * x).cos() - ratio * ((k * x).sinh() - (k * x).sin());
    let slope = k * ((k * x).sinh() + (k * x).sin() - ratio * ((k * x).cosh() - (k * x).cos()));
    [shape, slope]
}

/// A cantilever that begins in its first mode swings in it: y = A sin ωt, of order two in h.
#[test]
fn a_cantilever_swings_in_its_first_mode() {
    let elements = 10;
    let amplitude = 1e-3;
    let mut start = "rod.start.vx: 0, rod.start.vy: 0, rod.start.angular_velocity: 0".to_owned();
    for node in 1..=elements {
        let name = if node == elements { "end".to_owned() } else { format!("node{node}") };
        let [shape, slope] = first_mode(node as f64 / elements as f64).map(|value| amplitude * value);
        start += &format!(", rod.{name}.vx: 0, rod.{name}.vy: {shape:e}, rod.{name}.angular_velocity: {slope:e}");
    }
    let description = read(&format!(
        "
bodies: {{ rod: {{ beam: {{ length: 1, mass_per_length: 1, axial_stiffness: 1e6, bending_stiffness: 1, elements: {elements} }} }} }}
joints: {{ clamp: {{ fixed: [ground, rod.start] }} }}
initial: {{ {start} }}
outputs: {{ y: rod.end.y, energy: energy }}
simulation: {{ duration: 3.6, step: 0.01, output_step: 0.1 }}
"
    ));
    let omega = 1.875_104_068_711_961_f64.powi(2);
    let exact = |t: f64| amplitude * first_mode(1.0)[0] / omega * (omega * t).sin();
    let runs = [0.01, 0.005, 0.0025].map(|h| nominal(&description.clone().step(h)));
    let errors = runs.each_ref().map(|run| distance_from(&run.times, curve(run, "y"), exact) * omega / amplitude);
    let best = richardson(curve(&runs[1], "y"), curve(&runs[2], "y"));
    let left = distance_from(&runs[0].times, &best, exact) * omega / amplitude;
    let orders = [order(errors[0], errors[1]), order(errors[1], errors[2])];
    println!("off by {errors:?}, orders {orders:.2?}; extrapolated {left:.1e}");
    assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.15) && left < 5e-5, "{errors:?} {left:e}");
}

/// Free flight: the centre of mass moves straight on, the energy stays; turned at the start by any angle, no strain.
#[test]
fn a_free_beam_keeps_its_momentum_and_its_energy() {
    let description = read(
        "
bodies: { rod: { beam: { length: 2, mass_per_length: 1.5, axial_stiffness: 1e4, bending_stiffness: 2, elements: 2 } } }
effects: { push: { force: { on: rod.end, value: [0, 4*exp(-(20*(t - 0.3))^2)] } } }
initial: { rod.start.angle: 2.5, rod.start.x: 1, rod.start.y: 3, rod.start.vx: 0.7, rod.start.vy: -0.3, rod.start.angular_velocity: 1.1 }
outputs:
  strain: potential_energy
  energy: energy
  x: rod.start.x/4 + rod.node1.x/2 + rod.end.x/4 + (cos(rod.start.angle) - cos(rod.end.angle))/24
  y: rod.start.y/4 + rod.node1.y/2 + rod.end.y/4 + (sin(rod.start.angle) - sin(rod.end.angle))/24
  bend: rod.end.angle - rod.start.angle
simulation: { duration: 3, step: 1e-3, output_step: 0.01 }
",
    );
    let runs = [2e-3, 1e-3].map(|h| nominal(&description.clone().step(h)));
    assert!(curve(&runs[0], "strain")[0].abs() < 1e-20, "{:e}", curve(&runs[0], "strain")[0]);
    let drifts = runs.each_ref().map(|run| {
        let energy = &curve(run, "energy")[60..];
        largest(energy.iter().map(|value| value - energy[0]))
    });
    let energy = curve(&runs[1], "energy")[100];
    println!("energy {energy} J off by {drifts:?}, order {:.2}", order(drifts[0], drifts[1]));
    assert!((order(drifts[0], drifts[1]) - 2.0).abs() < 0.3 && drifts[1] < 1e-4 * energy, "{drifts:?}");
    // It bends for all that.
    assert!(largest(curve(&runs[1], "bend").iter().copied()) > 0.2);
    // Σ F t/m beyond the push: 4 √π/20 N s on 3 kg.
    let drift = |run: &Bounds| {
        let x = curve(run, "x");
        largest(run.times.iter().zip(x).map(|(t, value)| value - x[0] - (0.7 - 1.1 * 2.5_f64.sin()) * t))
    };
    let drifts = runs.each_ref().map(drift);
    println!("the centre's x off by {drifts:?}, order {:.2}", order(drifts[0], drifts[1]));
    assert!((order(drifts[0], drifts[1]) - 2.0).abs() < 0.1 && drifts[1] < 1e-6, "{drifts:?}");
    let y = curve(&runs[1], "y");
    let speed = (y[300] - y[100]) / 2.0;
    let expected = -0.3 + 1.1 * 2.5_f64.cos() + 4.0 * PI.sqrt() / 20.0 / 3.0;
    println!("its y velocity {speed:.9}, expected {expected:.9}");
    assert!((speed - expected).abs() < 1e-6);
}

/// Kane, Ryan & Banerjee's and Simo & Vu-Quoc's manoeuvre (J. Appl. Mech. 53 (1986) 849): a beam is turned about its
/// end from rest to 6 rad/s within 15 s. Its tip lags by 0.574 m (0.58 in their plots), then swings about its straight
/// position; the centrifugal force stretches it by tan(kL)/k − L, k = ω √(μ/EA): 5.14e-4 m.
#[test]
fn a_beam_is_spun_up() {
    let (length, mass, axial, omega) = (10.0, 1.2, 2.8e7_f64, 6.0);
    let description = |elements: usize| {
        read(&format!(
            "
parameters: {{ T: 15, w: {omega} }}
bodies:
  arm:
    beam: {{ length: {length}, mass_per_length: {mass}, axial_stiffness: {axial}, bending_stiffness: 1.4e4, elements: {elements} }}
joints:
  pivot: {{ revolute: [ground, arm.start] }}
  drive:
    motor: {{ on: pivot, position: \"w/T*(min(t, T)^2/2 + (T/(2*pi))^2*(cos(2*pi*min(t, T)/T) - 1)) + w*max(t - T, 0)\" }}
outputs:
  stretch: cos(pivot.angle)*arm.end.x + sin(pivot.angle)*arm.end.y - {length}
  lag: cos(pivot.angle)*arm.end.y - sin(pivot.angle)*arm.end.x
simulation: {{ duration: 20, step: 5e-3, output_step: 0.05 }}
"
        ))
    };
    let k = omega * (mass / axial).sqrt();
    let expected = (k * length).tan() / k - length;
    let mut lags = Vec::new();
    for (elements, h) in [(1, 5e-3), (2, 5e-3), (4, 5e-3), (8, 5e-3), (4, 2.5e-3)] {
        let bounds = nominal(&description(elements).step(h));
        let (lag, stretch) = (curve(&bounds, "lag"), curve(&bounds, "stretch"));
        let most = lag.iter().copied().fold(0.0, f64::min);
        let steady = stretch[330..].iter().sum::<f64>() / (stretch.len() - 330) as f64;
        let swings = largest(lag[300..].iter().copied());
        println!(
            "{elements} elements, h = {h:.1e}: lags by {most:.5}, stretched by {steady:.4e} ({expected:.4e}), swings by {swings:.1e}"
        );
        lags.push(-most);
        assert!(swings < 5e-3, "{swings:e}");
        if elements >= 4 {
            assert!((most + 0.574).abs() < 1e-3, "{most}");
            assert!((steady / expected - 1.0).abs() < 0.005, "{steady:e} {expected:e}");
        }
    }
    // Each doubling of the elements brings it nearer.
    assert!((lags[3] - lags[2]).abs() < 0.1 * (lags[2] - lags[1]).abs(), "{lags:?}");
}

/// A beam between two clamps: the start's conditions and the constraints say the same of it, and it swings with 4.730²
/// √(EI/μL⁴). Clamps that are too near to one another are reported.
#[test]
fn clamped_beam_starts_straight_or_is_refused() {
    let clamped = |apart: f64| {
        read(&format!(
            "
bodies: {{ rod: {{ beam: {{ length: 1, mass_per_length: 1, axial_stiffness: 1e5, bending_stiffness: 1, elements: 4 }} }} }}
joints:
  a: {{ fixed: [ground, rod.start] }}
  b: {{ equation: rod.end.x = {apart} }}
  c: {{ equation: rod.end.y = 0 }}
  d: {{ equation: rod.end.angle = 0 }}
effects: {{ push: {{ gravity: {{ acceleration: [0, -1e-3] }} }} }}
outputs: {{ y: rod.node2.y }}
simulation: {{ duration: 0.5, step: 1e-3, output_step: 1e-3 }}
"
        ))
    };
    let bounds = nominal(&clamped(1.0));
    let y = curve(&bounds, "y");
    assert_eq!(y[0], 0.0);
    // About q L⁴/384EI, mostly in the first mode: lowest after half a period, back after a whole one.
    let lowest = y.iter().copied().fold(0.0, f64::min);
    assert!((lowest / (-2.0e-3 / 384.0) - 1.0).abs() < 0.1, "{lowest:e}");
    let period = std::f64::consts::TAU / 4.730_040_745_f64.powi(2);
    let around = (750.0 * period) as usize..(1250.0 * period) as usize;
    let back = around.max_by(|&a, &b| y[a].total_cmp(&y[b])).unwrap();
    assert!((back as f64 * 1e-3 / period - 1.0).abs() < 0.03, "{back} {period}");
    let failure = clamped(0.99).refused();
    println!("{failure}");
    assert!(
        failure.contains("beam `rod` (it starts straight unless `initial` gives all coordinates of all its nodes)")
    );
}

/// A slider crank whose rod hardly bends is the one of rigid bodies, motor torque included; the harder, the nearer.
#[test]
fn a_stiff_rod_moves_as_a_rigid_one() {
    let slider_crank = |rod: &str, [start, end]: [&str; 2]| {
        nominal(&read(&format!(
            "
bodies:
  crank: {{ mass: 0.36, inertia: 6.75e-4, points: {{ A: [-0.075, 0], B: [0.075, 0] }} }}
  rod: {rod}
  slider: {{ mass: 0.075, coordinates: [x] }}
joints:
  pivot: {{ revolute: [ground, crank.A] }}
  pin: {{ revolute: [crank.B, rod.{start}] }}
  wrist: {{ revolute: [rod.{end}, slider] }}
  drive: {{ motor: {{ on: pivot, speed: 30 }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
outputs: {{ x: slider.x, torque: drive.torque, energy: energy }}
simulation: {{ duration: 0.4, step: 1e-4, output_step: 1e-3, formulation: absolute }}
"
        )))
    };
    let points = "{ B: [-0.15, 0], C: [0.15, 0] }";
    let rigid = slider_crank(&format!("{{ mass: 0.066, inertia: 0.066*0.09/12, points: {points} }}"), ["B", "C"]);
    let errors = [1e2, 1e3].map(|bending: f64| {
        let beam = format!(
            "{{ beam: {{ length: 0.3, mass_per_length: 0.22, axial_stiffness: {:e}, bending_stiffness: {bending}, damping: 1e-4, elements: 2 }} }}",
            1e5 * bending
        );
        let bends = slider_crank(&beam, ["start", "end"]);
        // Once the start's jump has died away.
        let off = |name: &str| {
            let pairs = curve(&bends, name)[50..].iter().zip(&curve(&rigid, name)[50..]);
            largest(pairs.map(|(bends, rigid)| bends - rigid)) / largest(curve(&rigid, name)[50..].iter().copied())
        };
        ["x", "torque", "energy"].map(off)
    });
    println!("off by {errors:?}");
    for (soft, hard) in errors[0].iter().zip(errors[1]) {
        assert!(hard < 1e-4 && (hard / soft - 0.1).abs() < 0.01, "{errors:?}");
    }
}
