//! Balance of power: the energy of a mechanism changes by the work put in, and by nothing else.

use super::{curve, largest, nominal, order, read};

/// Two bodies of the plane, thrown, with points off their centres of mass; lines of `joints`, `effects` and `initial`
/// are added.
pub fn pair(joints: &str, effects: &str, initial: &str) -> String {
    format!(
        "
space: planar
bodies:
  ground: {{ points: {{ O: [0.2, 0.1] }} }}
  a: {{ mass: 2, inertia: 0.1, center_of_mass: [0.1, 0.2], points: {{ P: [0.3, -0.5] }} }}
  b: {{ mass: 1, inertia: 0.2, points: {{ P: [-0.2, 0.6] }} }}
joints:
{joints}
effects:
  weight: {{ gravity: {{ acceleration: [1, -9.81] }} }}
{effects}
initial:
  a.x: 0.1
  a.y: -0.2
  a.angle: 0.4
  a.vx: 0.7
  a.vy: 1.1
  a.angular_velocity: -0.9
{initial}
{RUN}"
    )
}

/// Where the second body of [`pair`] starts when nothing joins it to the first.
pub const APART: &str = "  b.x: 0.9\n  b.y: 0.5\n  b.angle: -0.6\n  b.vx: -0.4\n  b.vy: 0.8\n  b.angular_velocity: 1.3";

/// The same in space; a stands askew.
pub fn spatial_pair(joints: &str, effects: &str, initial: &str) -> String {
    format!(
        "
space: spatial
bodies:
  ground: {{ points: {{ O: [0.2, 0.1, -0.3] }} }}
  a:
    mass: 2
    inertia: {{ xx: 0.1, yy: 0.14, zz: 0.12, xy: 0.01, xz: -0.02, yz: 0.015 }}
    center_of_mass: [0.1, 0.2, -0.05]
    points: {{ P: {{ position: [0.3, -0.5, 0.2], rotation: {{ rpy: [0.3, -0.4, 0.5] }} }} }}
  b: {{ mass: 1, inertia: [0.2, 0.15, 0.1], points: {{ P: {{ position: [-0.2, 0.6, 0.1], rotation: {{ rpy: [0, 0.2, 1] }} }} }} }}
joints:
{joints}
effects:
  weight: {{ gravity: {{ acceleration: [1, -2, -9.81] }} }}
{effects}
initial:
  a.x: 0.1
  a.y: -0.2
  a.z: 0.3
  a.orientation: {{ rpy: [0.2, -0.5, 0.8] }}
  a.vx: 0.7
  a.vy: 1.1
  a.vz: -0.5
  a.omega: [0.6, -0.9, 0.4]
{initial}
{RUN}"
    )
}

/// Where the second body of [`spatial_pair`] starts when nothing joins it to the first.
pub const APART_IN_SPACE: &str = "  b.x: 0.9\n  b.y: 0.5\n  b.z: -0.2\n  b.orientation: { rpy: [-0.3, 0.1, 0.5] }
  b.vx: -0.4\n  b.vy: 0.8\n  b.vz: 0.3\n  b.omega: [-0.2, 0.5, 1.3]";

const RUN: &str = "outputs: { energy: energy }\nsimulation: { duration: 0.5, step: 1e-3, output_step: 1e-3 }\n";

/// Asserts that the sum of kinetic and stored energy changes by the work of `power`, a formula in W, to second order in
/// the step, and that energy flows at all.
#[track_caller]
pub fn assert_balance(text: &str, power: &str) {
    // From this time on, the start's errors in reactions have faded.
    const FIRST: f64 = 0.1;
    // A constant is no output.
    let is_none = power == "0";
    let observed = ["energy", "kinetic_energy", power];
    let description = read(text).observing(&observed[..if is_none { 2 } else { 3 }]);
    let runs = [1e-3, 5e-4].map(|h| (h, nominal(&description.clone().step(h).rows_every(h))));
    let errors = runs.each_ref().map(|(h, run)| {
        let first = (FIRST / h).round() as usize;
        let energy = &curve(run, "energy")[first..];
        let zero = vec![0.0; energy.len()];
        let power = if is_none { &zero[..] } else { &curve(run, power)[first..] };
        let mut work = 0.0;
        largest((1..energy.len()).map(|row| {
            work += 0.5 * h * (power[row - 1] + power[row]);
            energy[row] - energy[0] - work
        }))
    });
    let kinetic = curve(&runs[1].1, "kinetic_energy");
    let exchanged = largest(kinetic.iter().map(|value| value - kinetic[0]));
    println!("{errors:?} of {exchanged} J");
    assert!(exchanged > 0.1, "only {exchanged} J flow");
    assert!(errors[1] < 1e-4 * exchanged, "{errors:?} of {exchanged} J");
    // Below that, only rounding and Newton's tolerance remain.
    assert!(errors[1] < 1e-9 * exchanged || order(errors[0], errors[1]) > 1.7, "{errors:?} of {exchanged} J");
}
