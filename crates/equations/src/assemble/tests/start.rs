use crate::assemble::System;
use crate::elements::joints::*;
use crate::grammar::Direction;
use crate::model::{JointKind, StartValue, TimeOrder};

use super::model::{Model, formula, pair, slider_crank};
use super::numbers::{State, assert_all_close, assert_close};

/// The constraints at the first guess.
fn gaps(system: &System) -> Vec<f64> {
    let positions = State::random(system, 1).values(&system.graph, &system.start.guess);
    State::at(system, &positions).values(&system.graph, &system.constraint)
}

fn link(m: &mut Model, name: &str, length: &str) {
    m.body(name, "1", "1", "xya", &[("A", &format!("-({length})/2"), "0"), ("B", &format!("({length})/2"), "0")]);
}

#[test]
fn given_coordinates_are_kept() {
    let mut m = slider_crank();
    m.initial("rod", 'x', TimeOrder::Position, "2*l1");
    let mut guess = m.0.mechanism_mut().initial.pop().unwrap();
    let StartValue::Coordinate { value, .. } = &mut guess else { panic!("a coordinate") };
    *value = formula("0.6");
    m.0.mechanism_mut().guess.push(guess);
    let system = m.build();
    let kept: Vec<usize> = (0..7).filter(|&row| system.start.position[row].is_some()).collect();
    assert_eq!(kept, [2]);
    let kept: Vec<usize> = (0..7).filter(|&row| system.start.velocity[row].is_some()).collect();
    assert_eq!(kept, [2]);
    assert_eq!(system.graph.as_constant(system.start.guess[3]), Some(0.6));
}

#[test]
fn the_slider_crank_is_guessed_closed() {
    let system = slider_crank().build();
    assert_all_close(&gaps(&system), &[0.0; 6], 1e-15);
    let guess = State::random(&system, 1).values(&system.graph, &system.start.guess);
    assert_close(guess[6], 0.71, 1e-15);
}

/// With all of its links at angle 0 the guess would be singular.
#[test]
fn a_four_bar_linkage_is_guessed_closed() {
    for rocker_first in [false, true] {
        let mut m = Model::new();
        m.ground_point("D", "4", "0");
        link(&mut m, "crank", "1");
        link(&mut m, "coupler", "3");
        link(&mut m, "rocker", "2.5");
        if rocker_first {
            m.revolute("rocking", "rocker.B", "ground.D");
        }
        m.revolute("turning", "ground", "crank.A");
        m.revolute("first", "crank.B", "coupler.A");
        m.revolute("second", "rocker.A", "coupler.B");
        if !rocker_first {
            m.revolute("rocking", "rocker.B", "ground.D");
        }
        m.initial("crank", 'a', TimeOrder::Position, "pi/3");
        m.output("rocker.A.y");
        let system = m.build();
        assert_all_close(&gaps(&system), &[0.0; 8], 1e-14);
        let positions = State::random(&system, 1).values(&system.graph, &system.start.guess);
        let state = State::at(&system, &positions);
        assert!(state.value(&system.graph, system.outputs[0].expr) > 0.0, "the corner is on top");
    }
}

/// The slide is taken last: the rod says where on it the slider is.
#[test]
fn slider_with_all_coordinates_is_guessed_after_its_rod() {
    let mut m = Model::new();
    link(&mut m, "crank", "1");
    link(&mut m, "rod", "3");
    m.body("slider", "1", "1", "xya", &[]);
    let guide = JointKind::Prismatic(Prismatic {
        between: m.between("ground", "slider"),
        axis: Direction(pair("1", "0")),
        angle: formula("0"),
    });
    m.joint("guide", guide);
    m.revolute("pivot", "ground", "crank.A");
    m.revolute("pin", "crank.B", "rod.A");
    m.revolute("wrist", "rod.B", "slider");
    let system = m.build();
    assert_all_close(&gaps(&system), &[0.0; 8], 1e-15);
    let positions = State::random(&system, 1).values(&system.graph, &system.start.guess);
    assert_close(positions[6], 4.0, 1e-15);
}

#[test]
fn welds_and_rods_are_guessed_closed() {
    let mut m = Model::new();
    link(&mut m, "arm", "2");
    link(&mut m, "hand", "1");
    m.body("bob", "1", "1", "xy", &[]);
    m.revolute("shoulder", "ground", "arm.A");
    // The second body of this joint is the one that is placed first.
    m.joint("wrist", JointKind::Fixed(Fixed { between: m.between("hand.A", "arm.B"), angle: formula("pi/4") }));
    m.joint("string", JointKind::Distance(Distance { between: m.between("hand.B", "bob"), length: formula("0.7") }));
    m.initial("arm", 'a', TimeOrder::Position, "0.3");
    assert_all_close(&gaps(&m.build()), &[0.0; 6], 1e-15);
}

#[test]
fn positions_are_scaled_by_the_largest_length() {
    let system = slider_crank().build();
    for (row, info) in system.coordinates.iter().enumerate() {
        let expected = if matches!(row, 2 | 5) { 1.0 } else { 0.28 };
        assert_close(info.scale, expected, 1e-15);
    }
    let mut m = Model::new();
    m.body("point", "1", "0", "xy", &[]);
    assert_eq!(m.build().coordinates[0].scale, 1.0);
}
