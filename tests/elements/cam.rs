//! Cams with a roller and with a flat face: lifts, contact forces and torques against the closed forms of the lift law.

use crate::common::{curve, distance_from, nominal, read};

use mbint::results::Bounds;

/// Mass of the follower, kg; base radius, m; speed of the cam, rad/s; weight, m/s².
const MASS: f64 = 2.0;
const BASE: f64 = 0.03;
const OMEGA: f64 = 10.0;
const GRAVITY: f64 = 9.81;

/// A cam at constant speed that lifts a mass in a guide over its centre, in the plane or in space.
fn run(space: &str, follower: &str, lift: &str, tables: &str) -> Bounds {
    // In space `torque` is a magnitude.
    let about = if space == "spatial" { "torque.z" } else { "torque" };
    nominal(&read(&format!(
        "
space: {space}
{tables}
bodies:
  wheel: {{ mass: 1, inertia: 0.01 }}
  slider: {{ mass: {MASS}, inertia: 0.01 }}
joints:
  shaft: {{ revolute: [ground, wheel] }}
  guide: {{ prismatic: {{ between: [ground, slider], axis: y }} }}
  nose:
    cam: {{ between: [wheel, slider], follower: {follower}, base: {BASE}, lift: \"{lift}\", phase: 90 deg }}
  drive: {{ motor: {{ on: shaft, speed: {OMEGA} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -{GRAVITY}] }} }} }}
guess: {{ slider.y: {BASE} }}
outputs:
  height: slider.y
  contact: nose.force
  side: guide.force.x
  tilt: guide.{about}
  torque: drive.{about}
simulation: {{ duration: 1.3, step: 5e-4, output_step: 5e-3 }}
"
    )))
}

/// Compares with a lift law s, s', s″; the forces from row `first` on, to within `tolerance` of the weight.
fn compare(follower: &str, bounds: &Bounds, first: usize, tolerance: f64, law: impl Fn(f64) -> [f64; 3]) {
    let at = |t: f64| law((OMEGA * t).rem_euclid(std::f64::consts::TAU));
    let push = |t: f64| MASS * (GRAVITY + OMEGA * OMEGA * at(t)[2]);
    let tangent = |t: f64| at(t)[1] / (BASE + at(t)[0]);
    let is_flat = follower == "flat";
    let height = distance_from(&bounds.times, curve(bounds, "height"), |t| BASE + at(t)[0]);
    assert!(height < 1e-9, "{follower}: height off by {height:e} m");
    let check = |name: &str, scale: f64, exact: &dyn Fn(f64) -> f64| {
        let error = distance_from(&bounds.times[first..], &curve(bounds, name)[first..], exact);
        assert!(error < tolerance * MASS * GRAVITY * scale, "{follower}: {name} off by {error:e}");
    };
    check("contact", 1.0, &|t| push(t).abs() * if is_flat { 1.0 } else { 1.0_f64.hypot(tangent(t)) });
    check("side", 1.0, &|t| if is_flat { 0.0 } else { push(t) * tangent(t) });
    check("tilt", BASE, &|t| if is_flat { -push(t) * at(t)[1] } else { 0.0 });
    // The motor's work lifts the mass.
    check("torque", BASE, &|t| push(t) * at(t)[1]);
}

fn harmonic(angle: f64) -> [f64; 3] {
    [0.005 * (1.0 - angle.cos()), 0.005 * angle.sin(), 0.005 * angle.cos()]
}

/// Rises by 10 mm in a third of a turn by a polynomial of degree five, falls in the next, rests in the last.
fn polynomial(angle: f64) -> [f64; 3] {
    let range = std::f64::consts::TAU / 3.0;
    let rise = |angle: f64| {
        let u = (angle / range).clamp(0.0, 1.0);
        [
            u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u),
            30.0 * u * u * (1.0 - u).powi(2) / range,
            60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (range * range),
        ]
    };
    let (up, down) = (rise(angle), rise(angle - range));
    std::array::from_fn(|order| 0.01 * (up[order] - down[order]))
}

#[test]
fn a_harmonic_lift_has_its_closed_form() {
    // In space the start leaves errors in reactions, which fade within a tenth of a second.
    for (space, first) in [("planar", 0), ("spatial", 20)] {
        for follower in ["roller", "flat"] {
            compare(follower, &run(space, follower, "0.005*(1 - cos(angle))", ""), first, 1e-4, harmonic);
        }
    }
}

#[test]
fn a_polynomial_lift_has_its_closed_form() {
    let u = |start: f64| format!("max(0, min(1, angle/(2*pi/3) - {start}))");
    let rise = |start: f64| {
        let u = u(start);
        format!("({u})^3*(10 - 15*({u}) + 6*({u})^2)")
    };
    let lift = format!("0.01*({} - {})", rise(0.0), rise(1.0));
    for follower in ["roller", "flat"] {
        compare(follower, &run("planar", follower, &lift, ""), 0, 2e-2, polynomial);
    }
}

/// A table of the harmonic lift, over a little more than a turn so that its ends do not matter.
#[test]
fn lift_may_be_a_table() {
    let points = (-4..=76).map(|index| {
        let angle = std::f64::consts::TAU * f64::from(index) / 72.0;
        format!("[{angle}, {}]", harmonic(angle)[0])
    });
    let tables = format!("tables: {{ rise: {{ points: [{}] }} }}", points.collect::<Vec<_>>().join(", "));
    let bounds = run("planar", "roller", "rise(angle)", &tables);
    let exact = |t: f64| BASE + harmonic((OMEGA * t).rem_euclid(std::f64::consts::TAU))[0];
    let height = distance_from(&bounds.times, curve(&bounds, "height"), exact);
    assert!(height < 1e-7, "{height:e}");
}
