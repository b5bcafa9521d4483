//! Forces that act at one position only, which a step may jump over. The truth: a body that passes a position of no
//! length loses the work that is done there, and has that speed from then on.

use std::f64::consts::PI;

use mbint::Model;

/// Integral of the table below by scipy, from 0 to 2 m, N m.
const WORK: f64 = 1.59;

/// A sledge of 1.6 kg thrown at 2.9 … 3.3 m/s past a brake at 0.83 m.
fn thrown(tables: &str, brake: &str, stepping: &str) -> String {
    format!(
        "
{tables}
parameters: {{ v: {{ interval: [2.9, 3.3], unit: m/s }} }}
bodies: {{ sledge: {{ mass: 1.6, coordinates: [x] }} }}
effects: {{ brake: {{ force: {{ on: sledge, value: [\"{brake}\", 0] }} }} }}
initial: {{ sledge.x: 0, sledge.vx: v }}
outputs: {{ x: sledge.x }}
simulation: {{ duration: 0.8, {stepping}, output_step: 0.1 }}
bounds: {{ chebyshev: {{ order: 5 }}, scan: {{ points: 9 }} }}
"
    )
}

/// Range of the position over the speeds, behind a brake that takes this work.
fn truth(work: f64, t: f64) -> [f64; 2] {
    let at = |speed: f64| {
        let time = 0.83 / speed;
        let slower = (speed * speed - 2.0 * work / 1.6).sqrt();
        if t < time { speed * t } else { 0.83 + slower * (t - time) }
    };
    let positions = (0..=2000).map(|place| at(2.9 + 0.4 * f64::from(place) / 2000.0));
    positions.fold([f64::INFINITY, f64::NEG_INFINITY], |[lower, upper], x| [lower.min(x), upper.max(x)])
}

/// Number of rows of all bands that are not flagged; at these both ends of the true band are within the stated error
/// and `slack`, the effect of the brake's own length.
fn covered(text: &str, work: f64, slack: f64) -> usize {
    let result = Model::from_yaml_str("thrown", text).unwrap().study().run().unwrap();
    let mut counted = 0;
    for band in result.outputs().next().unwrap().bands() {
        for (row, &time) in result.times().iter().enumerate().filter(|&(row, _)| band.is_reliable(row)) {
            let [lower, upper] = truth(work, time);
            let off = (band.lower()[row] - lower).abs().max((band.upper()[row] - upper).abs());
            let stated = band.errors()[row];
            assert!(off <= stated + slack, "{} at {time} s is off by {off:e}, {stated:e} stated", band.method().name());
            counted += 1;
        }
    }
    counted
}

/// Least number of rows that are not flagged, of 18: with fixed steps those before the brake, which is reached after
/// 0.25 s.
fn least(stepping: &str) -> usize {
    if stepping.starts_with("tolerance") { 16 } else { 4 }
}

#[test]
fn bell_shaped_force_at_a_position_is_found() {
    for width in [1e-3, 1e-4, 1e-5_f64] {
        let (force, work) = (2.0 / width, 2.0 * PI.sqrt());
        let brake = format!("-{force:?}*exp(-((sledge.x - 0.83)/{width:?})^2)");
        for stepping in ["tolerance: 1e-4", "tolerance: 1e-4, scheme: hht", "step: 2e-3", "step: 4e-4"] {
            let counted = covered(&thrown("", &brake, stepping), work, 2.0 * width);
            println!("{width} m, {stepping}: {counted} of 18 rows");
            assert!(counted >= least(stepping), "{width} m, {stepping}: {counted}");
        }
    }
}

/// 1/(1 + u²)², and two edges.
#[test]
fn quotients_and_pairs_of_edges_are_found() {
    for (brake, work) in [
        ("-9000/(1 + ((sledge.x - 0.83)/2e-4)^2)^2", 9000.0 * 2e-4 * PI / 2.0),
        ("-2000*(tanh((sledge.x - 0.8295)/2e-5) - tanh((sledge.x - 0.8305)/2e-5))", 4.0),
    ] {
        for stepping in ["tolerance: 1e-4", "step: 2e-3"] {
            let counted = covered(&thrown("", brake, stepping), work, 2e-3);
            println!("{brake}, {stepping}: {counted} of 18 rows");
            assert!(counted >= least(stepping), "{brake}, {stepping}: {counted}");
        }
    }
}

/// A table whose knots lie within a step: a natural cubic spline of 6000 N at 0.83 m, and of 0 N at knots around it,
/// ever further apart. Its work is the integral of scipy's `CubicSpline`.
#[test]
fn a_table_within_a_step_is_found() {
    let beside: Vec<f64> = (0..26)
        .scan((0.0, 3e-4), |(sum, length), _| {
            *sum += *length;
            *length *= 1.5;
            Some(*sum)
        })
        .collect();
    let points = beside.iter().rev().map(|offset| format!("[{:?}, 0]", 0.83 - offset));
    let points = points.chain(["[0.83, 6000]".to_owned()]);
    let points: Vec<String> = points.chain(beside.iter().map(|offset| format!("[{:?}, 0]", 0.83 + offset))).collect();
    let table = format!("tables: {{ post: {{ points: [{}], units: [m, N] }} }}", points.join(", "));
    let text = thrown(&table, "-post(sledge.x)", "tolerance: 1e-4");
    let counted = covered(&text, WORK, 1e-3);
    assert!(counted >= least("tolerance"), "{counted}");
}

/// Two sledges that travel together and pass one another: a force with a bell of 8 mm in their distance.
fn convoy(speed: f64, apart: f64) -> String {
    format!(
        "
parameters: {{ v: {{ interval: [1.8, 2.2], unit: m/s }} }}
bodies:
  front: {{ mass: 1.5, coordinates: [x] }}
  back: {{ mass: 0.5, coordinates: [x] }}
effects:
  push: {{ force: {{ on: front, value: [\"10*exp(-((front.x - back.x)/8e-3)^2)\", 0] }} }}
  recoil: {{ force: {{ on: back, value: [\"-10*exp(-((front.x - back.x)/8e-3)^2)\", 0] }} }}
initial: {{ front.x: {apart:?}, back.x: 0, front.vx: {speed:?}, back.vx: \"{speed:?} + v\" }}
outputs: {{ distance: front.x - back.x }}
simulation: {{ duration: 0.5, step: 1e-3, output_step: 0.05 }}
bounds: {{ chebyshev: {{ order: 5 }} }}
"
    )
}

/// Galilean invariance: the interaction of two bodies is seen, or missed, whatever speed they have in common.
#[test]
fn common_velocity_changes_no_band_and_no_flag() {
    let band = |speed: f64| {
        let text = convoy(speed, 0.4);
        let result = Model::from_yaml_str("convoy", &text).unwrap().study().run().unwrap();
        let output = result.outputs().next().unwrap();
        let band = output.bands().next().unwrap();
        let reliable: Vec<bool> = (0..result.times().len()).map(|row| band.is_reliable(row)).collect();
        (band.lower().to_vec(), band.upper().to_vec(), reliable)
    };
    let at_rest = band(0.0);
    assert!(at_rest.2.iter().all(|reliable| *reliable), "{:?}", at_rest.2);
    let moving = band(20.0);
    assert_eq!(at_rest.2, moving.2);
    for (row, ends) in at_rest.0.iter().zip(&moving.0).chain(at_rest.1.iter().zip(&moving.1)).enumerate() {
        assert!((ends.0 - ends.1).abs() < 1e-9, "row {row}: {ends:?}");
    }
}

/// The speeds reach the brake after 0.25 s to 0.29 s.
#[test]
fn summary_states_when_fixed_steps_miss_a_force() {
    let passed = |stepping: &str| {
        let text = thrown("", "-2e4*exp(-((sledge.x - 0.83)/1e-4)^2)", stepping);
        let result = Model::from_yaml_str("thrown", &text).unwrap().study().run().unwrap();
        result.summary().passed_force
    };
    let from = passed("step: 2e-3");
    assert!(from.is_some_and(|from| (0.15..0.3).contains(&from)), "{from:?}");
    assert_eq!(passed("tolerance: 1e-4"), None);
}
