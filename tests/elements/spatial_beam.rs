//! Beams in space against the textbook, against rods that are integrated along their length, and against the
//! literature.

use std::f64::consts::PI;

use mbint::results::Bounds;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::common::runge_kutta::runge_kutta;
use crate::common::{self, Subject, curve, largest, nominal, order, read};

/// EA, GJ, EI about y and z, and GA of shear where the beam shears.
#[derive(Clone, Copy)]
struct Stiffness {
    axial: f64,
    torsional: f64,
    bending: [f64; 2],
    shear: Option<f64>,
}

/// A straight cantilever of length 1 along x, at rest under a load at its end.
fn cantilever(elements: usize, stiffness: Stiffness, load: &str) -> Subject {
    let Stiffness { axial, torsional, bending: [about_y, about_z], shear } = stiffness;
    let shear = shear.map_or(String::new(), |shear| format!("shear_stiffness: {shear:e},"));
    read(&format!(
        "
space: spatial
analysis: statics
bodies:
  rod:
    beam:
      {{ length: 1, mass_per_length: 1, axial_stiffness: {axial:e}, bending_stiffness: {about_z}, bending_stiffness_y: {about_y},
        torsional_stiffness: {torsional}, {shear} elements: {elements} }}
joints: {{ clamp: {{ fixed: [ground, rod.start] }} }}
effects: {{ load: {load} }}
outputs:
  x: rod.end.x
  y: rod.end.y
  z: rod.end.z
  roll: 2*rod.end.p1
  start_z: rod.element1.start_torque
  start_y: rod.element1.start_torque_y
  end_z: rod.element{elements}.torque
  torsion: rod.element{elements}.torsion
"
    ))
}

fn value(bounds: &Bounds, name: &str) -> f64 {
    curve(bounds, name)[0]
}

fn tip(bounds: &Bounds) -> [f64; 3] {
    ["x", "y", "z"].map(|name| value(bounds, name))
}

/// P L³/3EI + P L/GA along both axes and T L/GJ, of one element already.
#[test]
fn bending_and_torsion_match_the_textbook() {
    for (elements, shear) in [(1, None), (2, Some(40.0)), (4, Some(40.0))] {
        let stiffness = Stiffness { axial: 1e4, torsional: 0.5, bending: [2.0, 1.0], shear };
        let softer = shear.map_or(0.0, |shear| 1.0 / shear);
        let load = "{ force: { on: rod.end, value: [0, -1e-4, -2e-4] } }";
        let bounds = nominal(&cantilever(elements, stiffness, load));
        let wanted = [-1e-4 * (1.0 / 3.0 + softer), -2e-4 * (1.0 / 6.0 + softer)];
        for (name, wanted) in ["y", "z"].into_iter().zip(wanted) {
            let found = value(&bounds, name);
            assert!((found / wanted - 1.0).abs() < 1e-6, "{elements} elements: {name} {found:e} instead of {wanted:e}");
        }
        // Moments at the clamp have the sign of the section's own axes, those at the free end are none.
        let moments = ["start_z", "start_y", "end_z", "torsion"].map(|name| value(&bounds, name));
        let off = largest(moments.into_iter().zip([-1e-4, 2e-4, 0.0, 0.0]).map(|(found, wanted)| found - wanted));
        assert!(off < 1e-8, "{moments:?}");
        let bounds = nominal(&cantilever(elements, stiffness, "{ torque: { on: rod.end, value: [1e-3, 0, 0] } }"));
        assert!((value(&bounds, "roll") - 2e-3).abs() < 1e-9 && (value(&bounds, "torsion") - 1e-3).abs() < 1e-9);
    }
}

/// The tip of a rod of length s under a dead force at its end, whose line has the curvature κ₀ about z without load:
/// equilibrium integrated along it, the moment at the clamp found by shooting while the force grows.
fn rod(stiffness: Stiffness, length: f64, bend: f64, force: [f64; 3]) -> [f64; 3] {
    let compliance = Vector3::new(1.0 / stiffness.torsional, 1.0 / stiffness.bending[0], 1.0 / stiffness.bending[1]);
    let shear = stiffness.shear.map_or(0.0, |shear| 1.0 / shear);
    let stretch = Vector3::new(1.0 / stiffness.axial, shear, shear);
    let ends = |force: Vector3<f64>, moment: Vector3<f64>| {
        let law = |s: [f64; 10]| {
            let orientation = Quaternion::new(s[3], s[4], s[5], s[6]);
            let unit = UnitQuaternion::from_quaternion(orientation);
            let felt = unit.inverse() * Vector3::new(s[7], s[8], s[9]);
            let curvature = compliance.component_mul(&felt) + Vector3::new(0.0, 0.0, bend);
            let along = unit * (Vector3::x() + stretch.component_mul(&(unit.inverse() * force)));
            let turn = orientation * Quaternion::from_imag(curvature) * 0.5;
            let change = -along.cross(&force);
            [along.x, along.y, along.z, turn.w, turn.i, turn.j, turn.k, change.x, change.y, change.z]
        };
        let start = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, moment.x, moment.y, moment.z];
        *runge_kutta(law, start, length, 2, 400).last().unwrap()
    };
    let free = |s: [f64; 10]| Vector3::new(s[7], s[8], s[9]);
    let (mut moment, steps) = (Vector3::zeros(), 40);
    let force = Vector3::from(force);
    for step in 1..=steps {
        let force = force * (step as f64 / steps as f64);
        for _ in 0..6 {
            let off = free(ends(force, moment));
            let h = 1e-6 * (1.0 + force.norm() * length);
            let columns = [0, 1, 2].map(|axis| (free(ends(force, moment + h * Vector3::ith(axis, 1.0))) - off) / h);
            moment -= Matrix3::from_columns(&columns).lu().solve(&off).unwrap();
        }
    }
    let end = ends(force, moment);
    assert!(free(end).norm() < 1e-9 * (1.0 + moment.norm()), "{}", free(end).norm());
    [end[0], end[1], end[2]]
}

/// Errors of the tip with 2, 4 and 8 elements.
fn errors(stiffness: Stiffness, force: [f64; 3]) -> [f64; 3] {
    let exact = rod(stiffness, 1.0, 0.0, force);
    let [x, y, z] = force;
    [2, 4, 8].map(|elements| {
        let load = format!("{{ force: {{ on: rod.end, value: [{x}, {y}, {z}] }} }}");
        let found = tip(&nominal(&cantilever(elements, stiffness, &load)));
        largest(found.iter().zip(exact).map(|(found, exact)| found - exact))
    })
}

/// The elastica in an oblique plane.
#[test]
fn a_round_cantilever_bends_far_like_the_elastica() {
    let stiffness = Stiffness { axial: 1e5, torsional: 0.8, bending: [1.0, 1.0], shear: None };
    let errors = errors(stiffness, [0.0, -2.4, -1.8]);
    println!("round: off by {errors:?}");
    assert!(order(errors[1], errors[2]) > 3.5 && errors[2] < 1e-5, "{errors:?}");
}

/// As in the experiments at Princeton (Dowell & Traybar, AMRDL TR 75-71): a blade that is soft one way, loaded askew,
/// twists.
#[test]
fn obliquely_loaded_blade_twists() {
    for shear in [None, Some(50.0)] {
        let stiffness = Stiffness { axial: 1e5, torsional: 1.2, bending: [1.0, 8.0], shear };
        let errors = errors(stiffness, [0.0, -3.0, -1.5]);
        println!("blade: off by {errors:?}");
        assert!(order(errors[1], errors[2]) > 1.8 && errors[2] < 2e-3, "{errors:?}");
    }
}

/// A moment about an oblique axis bends it to half a circle, x zero whatever the number of elements.
#[test]
fn a_moment_rolls_a_cantilever_up() {
    let stiffness = Stiffness { axial: 1e5, torsional: 0.5, bending: [1.0, 1.0], shear: None };
    let off = [4, 6].map(|elements| {
        let load = format!("{{ torque: {{ on: rod.end, value: [0, {}, {}] }} }}", 0.6 * PI, 0.8 * PI);
        let [x, y, z] = tip(&nominal(&cantilever(elements, stiffness, &load)));
        assert!(x.abs() < 2e-7, "{elements}: {x:e}");
        (y - 0.8 * 2.0 / PI).hypot(z + 0.6 * 2.0 / PI)
    });
    let order = (off[0] / off[1]).ln() / 1.5_f64.ln();
    assert!(order > 3.8 && off[1] < 5e-5, "{off:?}");
}

/// A cantilever whose line is an arc of 45°, of radius 100, in eight straight pieces, under a force across its plane.
/// Bathe and Bolourchi (Int. J. Num. Meth. Eng. 14 (1979) 961) have the tip at (22.5, 59.2, 39.5) and (15.9, 47.2,
/// 53.4), Simo and Vu-Quoc (Comput. Methods Appl. Mech. Eng. 58 (1986) 79) at (22.33, 58.84, 40.08) and (15.79, 47.23,
/// 53.37), each with eight elements.
#[test]
fn an_arc_bends_out_of_its_plane() {
    let stiffness = Stiffness { axial: 1e7, torsional: 5e6 / 6.0, bending: [1e7 / 12.0; 2], shear: Some(5e6) };
    for (force, published) in [(300.0, [22.33, 58.84, 40.08]), (600.0, [15.79, 47.23, 53.37])] {
        let along = |node: usize| {
            format!("node_{node}.x: radius*sin({node}*turn), node_{node}.y: radius*(1 - cos({node}*turn))")
        };
        let guess = (1..=8).map(along).collect::<Vec<_>>().join(", ");
        let bounds = nominal(&read(&format!(
            "
space: spatial
analysis: statics
parameters: {{ radius: 100, turn: pi/32 }}
bodies:
  ground: {{ points: {{ out: {{ rotation: {{ axis: z, angle: turn/2 }} }} }} }}
  node_{{i}}:
    repeat: {{ i: 1..8 }}
    mass: 1
    inertia: 1
    points:
      in: {{ rotation: {{ axis: z, angle: \"(i - 0.5)*turn\" }} }}
      out: {{ rotation: {{ axis: z, angle: \"(i + 0.5)*turn\" }} }}
effects:
  first: {{ beam: {{ between: [ground.out, node_1.in], length: 2*radius*sin(turn/2), axial_stiffness: 1e7, bending_stiffness: 1e7/12,
                   torsional_stiffness: 5e6/6, shear_stiffness: 5e6 }} }}
  piece_{{i}}:
    repeat: {{ i: 2..8 }}
    beam: {{ between: [\"node_{{i - 1}}.out\", \"node_{{i}}.in\"], length: 2*radius*sin(turn/2), axial_stiffness: 1e7,
            bending_stiffness: 1e7/12, torsional_stiffness: 5e6/6, shear_stiffness: 5e6 }}
  load: {{ force: {{ on: node_8, value: [0, 0, {force}] }} }}
guess: {{ {guess} }}
outputs: {{ x: node_8.x, y: node_8.y, z: node_8.z }}
"
        )));
        // Theirs goes along y, and ends at 70.71 along it.
        let [along, aside, up] = tip(&bounds);
        let exact = rod(stiffness, 100.0 * PI / 4.0, 0.01, [0.0, 0.0, force]);
        println!("{force}: {along} {aside} {up}, a continuous arc {exact:?}");
        for (found, (published, exact)) in
            [aside, along, up].into_iter().zip(published.into_iter().zip([exact[1], exact[0], exact[2]]))
        {
            assert!((found - published).abs() < 0.3 && (found - exact).abs() < 0.25, "{found}, {published}, {exact}");
        }
    }
}

/// Loaded along its stiff axis, a cantilever falls aside above P = 4.013 √(EI GJ)/L² (Timoshenko & Gere, *Theory of
/// Elastic Stability* (1961), § 6.3).
#[test]
fn a_blade_buckles_sideways() {
    let stiffness = Stiffness { axial: 1e5, torsional: 1.0, bending: [1e3, 1.0], shear: None };
    let stability = |load: f64| {
        let load = format!("{{ force: {{ on: rod.end, value: [0, 0, -{load}] }} }}");
        value(&nominal(&cantilever(6, stiffness, &load)), "stability")
    };
    assert!(stability(3.95) > 0.0 && stability(4.1) < 0.0, "{} {}", stability(3.95), stability(4.1));
}

/// β² √(EI/μ)/2π both ways, and ¼ √(GJ/i) of torsion.
#[test]
fn frequencies_of_a_blade_match_the_textbook() {
    let bounds = nominal(&read(
        "
space: spatial
analysis: modes
modes: { number: 4 }
bodies:
  rod:
    beam: { length: 1, mass_per_length: 1, axial_stiffness: 2000, bending_stiffness: 1, bending_stiffness_y: 3, torsional_stiffness: 0.2, elements: 6 }
joints: { clamp: { fixed: [ground, rod.start] } }
outputs: { y: rod.end.y, z: rod.end.z, roll: rod.end.p1 }
",
    ));
    let first = 1.875_104_07_f64.powi(2) / (2.0 * PI);
    // i = μ (1 + 3)/EA.
    let torsion = 0.25 * (0.2_f64 / (4.0 / 2000.0)).sqrt();
    let second = 4.694_091_13_f64.powi(2) / (2.0 * PI);
    // Sections turn, which lowers frequencies a little: by less than half of β² EI/EA (Rayleigh) times a number near 4.
    for (mode, wanted, within) in
        [(1, first, 2e-3), (2, first * 3.0_f64.sqrt(), 6e-3), (3, torsion, 4e-3), (4, second, 1.5e-2)]
    {
        let found = value(&bounds, &format!("mode{mode}.frequency"));
        println!("mode {mode}: {found} for {wanted}");
        assert!((found / wanted - 1.0).abs() < within, "mode {mode}: {found} instead of {wanted}");
    }
}

/// A free beam that is hit, after Simo and Vu-Quoc (Comput. Methods Appl. Mech. Eng. 66 (1988) 125): its centre moves
/// by the momentum, and once nothing acts its energy stays.
#[test]
fn a_beam_flies_with_its_momentum_and_energy() {
    let bounds = nominal(&read(
        "
space: spatial
bodies:
  rod:
    beam: { length: 10, mass_per_length: 1, axial_stiffness: 1e4, bending_stiffness: 500, bending_stiffness_y: 500,
            torsional_stiffness: 500, elements: 4 }
effects:
  hit: { force: { on: rod.start, value: [\"8*max(0, min(1, 10*(0.5 - t)))\", 0, 0] } }
  turn: { torque: { on: rod.start, value: [0, \"-40*max(0, min(1, 10*(0.5 - t)))\", \"-20*max(0, min(1, 10*(0.5 - t)))\"] } }
initial: { rod.start.x: 0, rod.start.y: 0, rod.start.z: 0, rod.start.vx: 0, rod.start.vy: 0, rod.start.vz: 0,
           rod.start.orientation: { rpy: [0, 0, 0] }, rod.start.omega: [0, 0, 0] }
outputs:
  energy: kinetic_energy + potential_energy
  x: \"(rod.start.x + rod.end.x)/8 + (rod.node1.x + rod.node2.x + rod.node3.x)/4
      + 2.5/24*(rod.end.p2^2 + rod.end.p3^2 - rod.start.p2^2 - rod.start.p3^2)\"
  bend: rod.element2.torque
simulation: { duration: 3, step: 1e-3, output_step: 0.1, alpha: -0.02 }
",
    ));
    let (times, x) = (&bounds.times, curve(&bounds, "x"));
    // ∫ F dt = 8 · 0.45, of a mass of 10, from (5, 0, 0): the force ends linearly at 0.5 s.
    let impulse = 8.0 * 0.45;
    let lever = 8.0 * (0.4 * 0.2 + 0.05 * (0.4 + 0.1 / 3.0));
    for (&time, &x) in times.iter().zip(x).filter(|(time, _)| **time > 0.55) {
        let wanted = 5.0 + (impulse * time - lever) / 10.0;
        assert!((x - wanted).abs() < 2e-5, "{x} instead of {wanted} at {time}");
    }
    let energy: Vec<f64> =
        times.iter().zip(curve(&bounds, "energy")).filter(|(t, _)| **t > 0.55).map(|(_, &e)| e).collect();
    let drift = largest(energy.iter().map(|value| value - energy[0]));
    println!("energy {} drifts by {drift:e}", energy[0]);
    assert!(energy[0] > 1.0 && drift < 1e-4 * energy[0], "{drift:e} of {}", energy[0]);
    assert!(largest(curve(&bounds, "bend").iter().copied()) > 1.0, "it bends");
}

/// The block of `models/spatial_slider_crank_flexible.yaml` is where a rigid rod has it, up to the shortening of the
/// bent rod.
#[test]
fn block_on_a_stiff_rod_moves_as_on_a_rigid_rod() {
    let bounds = nominal(&common::model("spatial_slider_crank_flexible"));
    let rigid = |t: f64| {
        let (sin, cos) = (60.0 * t).sin_cos();
        let (y, z) = (0.1 - 0.08 * sin, 0.12 + 0.08 * cos);
        (0.09 - y * y - z * z).sqrt()
    };
    let off = largest(bounds.times.iter().zip(curve(&bounds, "x")).map(|(&t, x)| x - rigid(t)));
    assert!(off < 2e-5, "{off:e}");
}
