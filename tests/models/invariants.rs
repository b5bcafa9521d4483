//! Invariants that no step may lose: the loops stay closed, and energy is conserved unless something takes it.

use mbint::Formulation;

use crate::common::{Findings, Subject, curve, largest, model, nominal, order, read};

/// Models and the gaps of their joints: positions, then the velocities.
const GAPS: [(&str, &[&str], &[&str]); 5] = [
    (
        "slider_crank",
        &["crank.A.x", "crank.B.x - rod.B.x", "crank.B.y - rod.B.y", "rod.C.x - slider.x", "rod.C.y"],
        &["crank.A.vx", "crank.B.vx - rod.B.vx", "crank.B.vy - rod.B.vy", "rod.C.vx - slider.vx", "rod.C.vy"],
    ),
    ("pendulum", &["(bob.x^2 + bob.y^2 - length^2)/2"], &["bob.x*bob.vx + bob.y*bob.vy"]),
    (
        "double_pendulum",
        &["upper.top.x", "upper.top.y", "upper.end.x - lower.top.x", "upper.end.y - lower.top.y"],
        &["upper.top.vx", "upper.top.vy", "upper.end.vx - lower.top.vx", "upper.end.vy - lower.top.vy"],
    ),
    (
        "four_bar",
        &["crank.B.x - coupler.B.x", "coupler.C.y - rocker.C.y", "rocker.D.x - base"],
        &["crank.B.vx - coupler.B.vx", "coupler.C.vy - rocker.C.vy", "rocker.D.vx"],
    ),
    (
        "car_axis",
        &["left.x*road.x + left.y*road.y", "((left.x - right.x)^2 + (left.y - right.y)^2 - 1)/2"],
        &["(left.x - right.x)*(left.vx - right.vx) + (left.y - right.y)*(left.vy - right.vy)"],
    ),
];

/// Largest value of each output.
fn worst(description: &Subject, formulas: &[&str], h: f64) -> Vec<f64> {
    let bounds = nominal(&description.clone().observing(formulas).step(h));
    bounds.outputs.iter().map(|output| largest(output.nominal.iter().copied())).collect()
}

#[test]
fn joints_stay_closed() {
    // Newton ends at 1e-11 of the model's size; the remaining gap after a correction is mostly far smaller.
    let mut findings = Findings::default();
    for (name, gaps, _) in GAPS {
        for (gap, worst) in gaps.iter().zip(worst(&model(name).duration(1.0), gaps, 1e-3)) {
            println!("{name}: {gap} = {worst:.2e}");
            findings.check(worst < 1e-11, format_args!("{name}: {gap} = {worst:e}"));
        }
    }
    findings.none();
}

#[test]
fn velocity_constraint_errors_are_of_second_order() {
    // Only positions are constrained; the velocities of HHT satisfy Φ_q v + Φ_t = 0 to second order.
    let mut findings = Findings::default();
    for (name, _, rates) in GAPS {
        let mut description = model(name).duration(1.0).rows_every(0.01);
        // In joint coordinates they cannot leave.
        description = description.formulation(Formulation::Absolute);
        let runs = [5e-4, 2.5e-4].map(|h| worst(&description, rates, h));
        for ((rate, coarse), fine) in rates.iter().zip(&runs[0]).zip(&runs[1]) {
            let order = order(*coarse, *fine);
            println!("{name}: {rate} = {coarse:.2e}, order {order:.3}");
            findings.check((order - 2.0).abs() < 0.1, format_args!("{name}: {rate} = {coarse:e}, order {order}"));
        }
    }
    findings.none();
}

/// Largest change of the energy from its start.
fn drift(description: &Subject, h: f64) -> f64 {
    let bounds = nominal(&description.clone().observing(&["energy"]).step(h));
    let energy = &bounds.outputs[0].nominal;
    largest(energy.iter().map(|value| value - energy[0]))
}

#[test]
fn conservative_models_keep_their_energy() {
    let mut findings = Findings::default();
    // Energies turned over: 9.81 J by the pendulum, 3 J by the double pendulum.
    for (name, duration, turnover) in [("pendulum", 5.0, 9.81), ("double_pendulum", 2.0, 3.0)] {
        let description = model(name).duration(duration);
        let drifts = [1e-3, 5e-4, 2.5e-4].map(|h| drift(&description, h));
        let orders = [order(drifts[0], drifts[1]), order(drifts[1], drifts[2])];
        println!("{name}: {drifts:?}, orders {orders:.3?}");
        let second = orders.iter().all(|order| (order - 2.0).abs() < 0.15);
        findings.check(second, format_args!("{name}: orders {orders:?}"));
        let share = drifts[0] / turnover;
        findings.check(share < 1e-4, format_args!("{name}: {share:e} of the energy is lost"));
    }
    findings.none();
}

#[test]
fn motor_work_equals_stored_and_dissipated_energy() {
    // The slider crank: energy = −work of the damper + work of the torque. The damper's work is integrated by Simpson's
    // rule.
    let formulas = ["energy", "tau*crank.angle", "-c*slider.vx^2"];
    let bounds = nominal(&model("slider_crank").observing(&formulas).step(1e-4).rows_every(1e-3));
    let [energy, given, power] = [0, 1, 2].map(|index| &bounds.outputs[index].nominal);
    let mut lost = 0.0;
    let mut worst = 0.0_f64;
    for row in (2..energy.len()).step_by(2) {
        lost += 1e-3 / 3.0 * (power[row - 2] + 4.0 * power[row - 1] + power[row]);
        worst = worst.max((energy[row] - energy[0] - given[row] - lost).abs());
    }
    println!("balance {worst:.3e} of {:.3} J", given.last().unwrap());
    // The scheme's error at h = 1e-4: x3 is good to 1.8e-5 m, speeds to about 1e-4 of themselves.
    assert!(worst < 1e-4 * given.last().unwrap(), "{worst:e} J");
}

/// A point that nothing refers to, wherever it is and on whatever body, changes nothing: not a bit.
#[test]
fn unused_points_change_nothing() {
    let run_with = |of_ground: &str, of_rod: &str, simulation: &str| {
        nominal(&read(&format!(
            "
bodies:
  ground: {{ points: {{ {of_ground} pin: [0.1, 0] }} }}
  rod: {{ mass: 1.2, inertia: 0.03, points: {{ {of_rod} a: [0.2, 0], c: [-0.2, 0] }} }}
  bob: {{ mass: 0.8, inertia: 0.01, points: {{ a: [0.15, 0.05] }} }}
joints: {{ S: {{ revolute: [ground.pin, rod.a] }}, R: {{ revolute: [rod.c, bob.a] }} }}
effects: {{ g: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ S.angle: 0.4, S.angular_velocity: 0, R.angle: 0.1, R.angular_velocity: 1.5 }}
outputs: {{ y: bob.y, f: R.force, a: bob.ay }}
simulation: {{ duration: 0.5, {simulation}, output_step: 0.05, formulation: absolute }}
"
        )))
    };
    for simulation in ["step: 1e-3", "tolerance: 1e-5"] {
        let [without, with] =
            [("", ""), ("far: [2e5, 0],", "off: [-3e4, 1e4],")].map(|(ground, rod)| run_with(ground, rod, simulation));
        for name in ["y", "f", "a"] {
            assert_eq!(curve(&without, name), curve(&with, name), "{simulation}: {name}");
        }
    }
}
