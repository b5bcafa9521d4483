//! Effects that pull, touch, mesh and press.

use super::model::{formula, pair};
use super::numbers::State;
use super::power::{potential_rate, power, two_bodies, value};
use crate::elements::effects::{Exponent, RestitutionLaw};
use crate::grammar::{Direction, PerAxis, PointRef, Rotating};
use crate::model::bushing::SixBySix;
use crate::model::{Backlash, Beam, Bushing, Cable, Contact, DryFriction, EffectKind, Friction, Impact, Preload};

fn elastic(stiffness: &str) -> Impact {
    Impact {
        stiffness: formula(stiffness),
        exponent: Exponent(1.5),
        dissipation: None,
        restitution: None,
        impact_velocity: None,
        law: RestitutionLaw::HuntCrossley,
    }
}

/// A ball on a surface that is still to be said.
fn touching(between: [PointRef; 2]) -> Contact {
    Contact {
        between,
        plane: None,
        circle: None,
        block: None,
        hull: None,
        capsule: None,
        friction_along: None,
        hollow: None,
        path: None,
        polygon: None,
        height: None,
        corners: None,
        line: None,
        cylinder: None,
        r#box: None,
        polyhedron: None,
        rounding: formula("0"),
        radius: formula("0.9"),
        axis: None,
        impact: elastic("k"),
        friction: None,
    }
}

/// Effects that pull, touch, mesh and press without loss: the power is minus the rate of the energy. Radii and lengths
/// are such that they act wherever the bodies are, and nowhere just at their corner.
#[test]
fn lossless_effects_have_potentials() {
    let m = two_bodies();
    let between = m.between("a.P", "b.P");
    let contact = || touching(between);
    let cable = Cable {
        between,
        free_length: formula("0.05"),
        stiffness: formula("k"),
        damping: formula("0"),
        transition: formula("0.01"),
    };
    let backlash = Backlash {
        between: [Rotating::of_body(m.body_index("a")), Rotating::of_body(m.body_index("b"))],
        ratio: formula("-1.7"),
        offset: formula("0.1"),
        backlash: formula("0.02"),
        stiffness: formula("k"),
        damping: formula("0"),
        transition: formula("0.3"),
    };
    // A symmetric matrix with everything in it that the plane has.
    let row = |texts: [&str; 6]| texts.map(formula);
    let matrix = [
        row(["30", "4", "0", "0", "0", "2"]),
        row(["4", "50", "0", "0", "0", "-3"]),
        row(["0"; 6]),
        row(["0"; 6]),
        row(["0"; 6]),
        row(["2", "-3", "0", "0", "0", "k/10"]),
    ];
    let beam = Beam {
        between,
        axis: Direction(pair("1", "0.5")),
        length: formula("0.7"),
        axial_stiffness: formula("k"),
        bending_stiffness: formula("3"),
        bending_stiffness_y: None,
        torsional_stiffness: None,
        shear_stiffness: None,
        damping: formula("0"),
        flexible: None,
    };
    let nothing = || PerAxis([0.0; 3].map(symdiff::Formula::number));
    let bushing = Bushing {
        between,
        stiffness: nothing(),
        damping: nothing(),
        torsional_stiffness: nothing(),
        torsional_damping: nothing(),
        stiffness_matrix: Some(SixBySix(Box::new(matrix))),
        damping_matrix: None,
    };
    let kinds = [
        Contact { plane: Some(Direction(pair("1", "2"))), ..contact() }.into(),
        Contact { circle: Some(formula("3")), ..contact() }.into(),
        Contact { hollow: Some(formula("0.91")), ..contact() }.into(),
        EffectKind::Cable(cable),
        EffectKind::Backlash(backlash),
        EffectKind::Preload(Preload { between: Some(between), on: None, value: formula("k/3") }),
        EffectKind::Beam(beam),
        EffectKind::Bushing(bushing),
    ];
    for (index, kind) in kinds.into_iter().enumerate() {
        let mut m = two_bodies();
        m.effect(kind);
        let system = m.build();
        let mut acting = 0;
        for seed in 0..6 {
            let state = State::random(&system, seed);
            let (power, rate) = (power(&system, &state), potential_rate(&system, &state));
            assert!((power + rate).abs() <= 1e-6 * (1.0 + power.abs()), "effect {index}: {power} is not {}", -rate);
            acting += usize::from(power.abs() > 1e-3);
        }
        assert!(acting >= 2, "effect {index} did nothing");
    }
}

/// Friction of a contact takes power, and no more than the load times the speed.
#[test]
fn friction_takes_power() {
    let contact = |friction: Option<Friction>| {
        let mut m = two_bodies();
        let between = m.between("a.P", "b.P");
        m.effect(Contact { circle: Some(formula("3")), friction, ..touching(between) });
        m.output("effect0.force");
        m.build()
    };
    let speed = DryFriction {
        breakaway: formula("1.5"),
        stribeck_velocity: Some(formula("0.1")),
        transition_velocity: formula("0.01"),
    };
    let law = Friction { coefficient: formula("0.3"), speed };
    let (smooth, rough) = (contact(None), contact(Some(law)));
    for seed in 0..5 {
        let [without, with] = [&smooth, &rough].map(|system| power(system, &State::random(system, seed)));
        let load = value(&rough, &State::random(&rough, seed), "effect0.force");
        assert!(load > 1.0 && with < without, "{with} {without}");
        assert!(without - with < 0.3 * 1.5 * load * 10.0);
    }
}
