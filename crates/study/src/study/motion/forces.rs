//! Forces of the nominal motion, for arrows: reactions of joints, and forces of effects at points.
//!
//! They come from a simulation of their own, so that the motion that is shown is not computed in another way because
//! of them.

use symdiff::Formula;

use super::super::drawing::asked::{AskedVector, DrawingOutputs, DrawingValues};
use super::rows::MotionRows;
use super::tuning::TUNING;
use crate::grammar::{PointRef, Sensor};
use crate::model::{Analysis, Description};
use crate::results::MovingForce;

/// A force that is asked.
struct AskedForce {
    name: String,
    is_reaction: bool,
    at: AskedVector,
    force: AskedVector,
}

/// A simulation of the nominal motion, of which forces are asked.
pub(super) struct SimulatedForces {
    asked: Vec<AskedForce>,
    /// Times of the rows, s.
    times: Vec<f64>,
    rows: Vec<DrawingValues>,
}

impl SimulatedForces {
    /// Simulates a model, of which other things are asked too, by the same steps; `None` if forces cannot be
    /// computed, or there are none.
    pub fn of(description: &Description, others: &MotionRows) -> Option<Self> {
        // Without forces there is no motion that could show them, and not every motion is of forces.
        let has_forces = matches!(description.analysis, Analysis::Motion | Analysis::Statics);
        let mut outputs = DrawingOutputs::default();
        let asked = if has_forces { ask(description, &mut outputs) } else { Vec::new() };
        if asked.is_empty() {
            return None;
        }
        let numbers = outputs.0.len();
        let mut asking =
            MotionRows::asking(description, outputs, Some(&others.simulator.system.formulation), others.interruption)
                .ok()?;
        asking.between_events = others.between_events;
        let mut rows: Vec<DrawingValues> = Vec::new();
        let nominal = [asking.domain.nominal.clone()];
        let found = asking.of_samples(description, &nominal, numbers, |_, _, values| rows.push(values)).ok()?;
        let times = found.times;
        (!times.is_empty()).then_some(Self { asked, times, rows })
    }

    /// The forces at some times of the motion.
    pub fn at(self, times: &[f64]) -> Vec<MovingForce> {
        let Self { asked, times: found, rows } = self;
        // Both runs have rows at the same times, this one perhaps more of them; or fewer, where only other samples meet
        // events.
        let row = |time: f64| {
            let after = found.partition_point(|&known| known < time - 1e-9 * time.abs()).min(found.len() - 1);
            let before = if found[after] > time + 1e-9 * time.abs() { after.saturating_sub(1) } else { after };
            let share = if after > before { (time - found[before]) / (found[after] - found[before]) } else { 0.0 };
            (before, after, share)
        };
        let along = |wanted: &AskedForce| -> Vec<f64> {
            let at = |values: &DrawingValues| {
                let [place, force] = [wanted.at, wanted.force].map(|asked| values.vector(asked));
                [place.x, place.y, place.z, force.x, force.y, force.z]
            };
            let of_time = |&time: &f64| {
                let (before, after, share) = row(time);
                let (from, to) = (at(&rows[before]), at(&rows[after]));
                std::array::from_fn::<f64, 6, _>(|number| from[number] + share * (to[number] - from[number]))
            };
            times.iter().flat_map(of_time).collect()
        };
        let all = asked.into_iter().map(|wanted| {
            let values = along(&wanted);
            MovingForce { name: wanted.name, is_reaction: wanted.is_reaction, values }
        });
        all.filter(is_there).take(TUNING.most_arrows).collect()
    }
}

/// Whether it acts at any time, and is a number at all of them.
fn is_there(force: &MovingForce) -> bool {
    let acts = force.values.as_chunks::<6>().0.iter().any(|values| values[3..].iter().any(|part| *part != 0.0));
    acts && force.values.iter().all(|value| value.is_finite())
}

fn ask(description: &Description, asked: &mut DrawingOutputs) -> Vec<AskedForce> {
    let spatial = description.space.spatial;
    let zero = || Formula::number(0.0);
    let named = |owner: &str, parts: [&str; 3]| {
        let [x, y, z] = parts.map(|part| Formula::name(&format!("{owner}.{part}")));
        [x, y, if spatial { z } else { zero() }]
    };
    let mut found = Vec::new();
    for joint in &description.joints {
        let Some([_, second]) = joint.kind.between() else { continue };
        let at = asked.vector(&place(description, second, spatial));
        let force = asked.vector(&named(&joint.name, ["force.x", "force.y", "force.z"]));
        found.push(AskedForce { name: joint.name.clone(), is_reaction: true, at, force });
    }
    for effect in &description.effects {
        for parts in Sensor::THRUSTS {
            let [x, y, z, fx, fy, fz] = parts.map(Sensor::name);
            let at = asked.vector(&named(&effect.name, [x, y, z]));
            let force = asked.vector(&named(&effect.name, [fx, fy, fz]));
            found.push(AskedForce { name: effect.name.clone(), is_reaction: false, at, force });
        }
    }
    found
}

/// Position of a point in the ground's frame.
fn place(description: &Description, of: PointRef, spatial: bool) -> [Formula; 3] {
    let body = &description.bodies[of.body];
    let point = of.point.map(|point| &body.points[point]);
    if of.body == 0 {
        return point.map_or([0.0; 3].map(Formula::number), |point| point.position.clone());
    }
    let owner = point.map_or(body.name.clone(), |point| format!("{}.{}", body.name, point.name));
    let [x, y, z] = ["x", "y", "z"].map(|axis| Formula::name(&format!("{owner}.{axis}")));
    [x, y, if spatial { z } else { Formula::number(0.0) }]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model;
    use crate::simulate::Interruption;

    fn forces_of(text: &str) -> Vec<MovingForce> {
        let description =
            model::load_str("forces.yaml", text, &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        let rows = MotionRows::asking(&description, DrawingOutputs::default(), None, Interruption::default()).unwrap();
        let found = SimulatedForces::of(&description, &rows);
        found.map_or_else(Vec::new, |found| found.at(&[0.0, 0.005]))
    }

    #[test]
    fn body_without_joints_and_effects_has_no_forces() {
        assert!(
            forces_of(
                "bodies: { b: { mass: 1, coordinates: [x] } }\noutputs: { x: b.x }\nsimulation: { duration: 0.01 s, step: 0.005 s }\n"
            )
            .is_empty()
        );
    }

    fn assert_near(found: &MovingForce, expected: [f64; 6]) {
        for values in found.values.chunks_exact(6) {
            let distance = values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(distance < 1e-6, "{}: {values:?} instead of {expected:?}", found.name);
        }
    }

    /// A weight hangs from a rod that hangs from a spring: each carries everything below it.
    #[test]
    fn rod_and_spring_carry_hanging_weights() {
        let found = forces_of(
            "bodies:\n  upper: { mass: 2, coordinates: [y], points: { top: [0, 1], bottom: [0, -1] } }\n  lower: { mass: 3, coordinates: [y] }\n\
             joints: { weld: { fixed: [upper.bottom, lower] } }\n\
             effects:\n  weight: { gravity: { acceleration: [0, -10] } }\n  spring: { spring_damper: { between: [ground, upper.top], stiffness: 100, free_length: 0.5 } }\n\
             initial: { upper.y: -2, upper.vy: 0 }\noutputs: { y: upper.y }\nsimulation: { duration: 0.01, step: 1e-3 }\n",
        );
        let names: Vec<(&str, bool)> = found.iter().map(|force| (force.name.as_str(), force.is_reaction)).collect();
        assert_eq!(names, [("weld", true), ("spring", false)]);
        // The spring is 1 m long: 50 N. The weld holds 3 kg.
        assert_near(&found[0], [0.0, -3.0, 0.0, 0.0, 30.0, 0.0]);
        assert_near(&found[1], [0.0, -1.0, 0.0, 0.0, 50.0, 0.0]);
    }

    /// A crate rests on two of its corners, to which the floor's force is spread as the lever says.
    #[test]
    fn floor_force_acts_at_the_contact() {
        let found = forces_of(
            "bodies: { crate: { mass: 1, inertia: 1, points: { foot: [0, 0] } } }\n\
             effects:\n  weight: { force: { on: crate, value: [0, -10] } }\n\
             \u{20} floor: { contact: { between: [ground, crate], plane: y, corners: [[-1, 0], [1, 0]], impact: { stiffness: 1000, exponent: 1, dissipation: 0 } } }\n\
             initial: { crate.y: -0.005, crate.vy: 0, crate.angle: 0, crate.angular_velocity: 0 }\noutputs: { y: crate.y }\n\
             simulation: { duration: 0.01, step: 1e-3 }\n",
        );
        let of = |name: &str| found.iter().find(|force| force.name == name).unwrap();
        assert_near(of("floor"), [0.0, -0.005, 0.0, 0.0, 10.0, 0.0]);
        assert_near(of("weight"), [0.0, -0.005, 0.0, 0.0, -10.0, 0.0]);
    }
}
