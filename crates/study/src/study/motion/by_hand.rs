//! A mechanism moved by hand: a point of a body is moved to a position, as near as the joints allow.

use nalgebra::Vector3;

use super::Posed;
use super::reach::{Reach, Reached};
use crate::numerics::Sample;
use crate::results::Drawing;
use crate::study::drawing::asked::DrawingValues;

/// The point of a body that a hand holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grip {
    /// The body, by its index in the drawing; 0 is the ground, which does not move.
    pub body: usize,
    /// The point, by its index among those of the drawing; the next behind the last is the centre of mass.
    pub point: usize,
}

/// State of a mechanism that a hand holds.
#[derive(Clone, Debug)]
pub struct Held {
    /// Poses of all bodies but the ground, as [`Motion`](crate::results::Motion) has them.
    pub pose: Vec<f64>,
    /// Points of all bodies in their frames, as [`Poses`](crate::results::Poses) has them.
    pub points: Vec<f64>,
    /// The point of the grip, m.
    pub at: [f64; 3],
    /// The largest residual of the constraints, SI.
    pub residual: f64,
    /// Degrees of freedom that a hand can move.
    pub freedom: usize,
}

/// A hand on a mechanism.
pub struct Hand<'m> {
    posed: &'m Posed<'m>,
    drawing: &'m Drawing,
    reach: Reach<'m>,
    /// Configuration of the mechanism.
    now: Reached,
}

impl<'m> Hand<'m> {
    /// A hand on a mechanism at its nominal start.
    pub(super) fn new(posed: &'m Posed<'m>, drawing: &'m Drawing) -> Self {
        let simulator = &posed.rows.simulator;
        let now = Reached::start(simulator);
        Self { posed, drawing, reach: Reach::new(simulator), now }
    }

    /// Puts the mechanism back to its start.
    pub fn release(&mut self) {
        self.now = Reached::start(&self.posed.rows.simulator);
    }

    /// Takes the mechanism, of this sample, to where its bodies are in a pose, as near as it can be.
    pub fn follow(&mut self, sample: &Sample, pose: &[f64]) {
        let length = self.posed.rows.simulator.system.length;
        let numbers = self.posed.per_body();
        let first_angle = if numbers == 3 { 2 } else { 3 };
        // Angles count as the way of a point at the size of the model.
        let weight = |line: usize| if line % numbers < first_angle { 1.0 } else { length };
        let wanted = |outputs: &[f64]| {
            let mut found = Vec::with_capacity(pose.len());
            self.posed.pose(&DrawingValues(outputs.to_vec()), &mut found);
            found.iter().zip(pose).enumerate().map(|(line, (found, wanted))| weight(line) * (found - wanted)).collect()
        };
        self.now = self.reach.towards(&self.now, sample, &wanted);
    }

    /// Moves a point of the mechanism, of this sample, to a position, m, or to the nearest one that the closure allows.
    /// `None` if there is no such point.
    pub fn drag(&mut self, grip: Grip, sample: &Sample, place: [f64; 3]) -> Option<Held> {
        let local = self.local(grip)?;
        let (posed, drawing) = (self.posed, self.drawing);
        let at = |outputs: &[f64]| {
            let values = DrawingValues(outputs.to_vec());
            let points = posed.points(&values, drawing);
            let point = Vector3::from_column_slice(&points[3 * local..3 * local + 3]);
            values.frame(&posed.bodies[grip.body]).place(point)
        };
        let wanted = |outputs: &[f64]| {
            let away = at(outputs) - Vector3::from(place);
            vec![away.x, away.y, away.z]
        };
        self.now = self.reach.towards(&self.now, sample, &wanted);
        let outputs = &self.now.outputs;
        let values = DrawingValues(outputs.clone());
        let mut pose = Vec::with_capacity(posed.lines());
        posed.pose(&values, &mut pose);
        Some(Held {
            pose,
            points: posed.points(&values, drawing),
            at: at(outputs).into(),
            residual: self.now.residual,
            freedom: self.now.freedom,
        })
    }

    /// Index of a point among [`Posed::points`].
    fn local(&self, grip: Grip) -> Option<usize> {
        let count = |body: &crate::results::DrawnBody| body.points.len() + usize::from(body.center_of_mass.is_some());
        let body = self.drawing.bodies.get(grip.body)?;
        let before: usize = self.drawing.bodies[..grip.body].iter().map(count).sum();
        (grip.body > 0 && grip.point < count(body)).then_some(before + grip.point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model;
    use crate::simulate::Interruption;
    use crate::study::Movable;

    /// A crank of length 1 and a rod of length 2 with a slider on the x axis.
    const CRANK: &str = "
bodies:
  crank: { mass: 1, inertia: 1, points: { A: [0, 0], B: [1, 0] } }
  rod: { mass: 1, inertia: 1, points: { B: [0, 0], C: [2, 0] } }
  slider: { mass: 1, coordinates: [x] }
joints:
  A: { revolute: [ground, crank.A] }
  B: { revolute: [crank.B, rod.B] }
  C: { revolute: [rod.C, slider] }
initial: { crank.angle: 60 deg }
outputs: { x: slider.x }
simulation: { duration: 1, step: 0.01 }
";

    fn held(hand: &mut Hand, grip: Grip, sample: &Sample, place: [f64; 3]) -> Held {
        let held = hand.drag(grip, sample, place).unwrap();
        assert!(held.residual < 1e-10, "{}", held.residual);
        assert_eq!(held.freedom, 1);
        held
    }

    /// The crank's end goes around, over both dead centres, and the slider is where Pythagoras has it.
    #[test]
    fn a_crank_is_turned_around_and_its_loop_is_closed() {
        let model = model::load_str("crank.yaml", CRANK, &[]).unwrap();
        let movable = Movable::new(&model, Interruption::default()).unwrap();
        let (sample, mut hand) = (movable.nominal(), movable.hand());
        let end = Grip { body: 1, point: 1 };
        for step in 0..80 {
            let angle = 1.0 + 0.1 * f64::from(step);
            let [x, y] = [1.5 * angle.cos(), 1.5 * angle.sin()];
            let Held { at, pose, .. } = held(&mut hand, end, &sample, [x, y, 0.0]);
            // The nearest point of a circle of radius 1.
            let off = (at[0] - x / 1.5).hypot(at[1] - y / 1.5);
            assert!(off < 1e-6, "{angle}: {at:?}");
            let slider = at[0] + (4.0 - at[1] * at[1]).sqrt();
            assert!((pose[6] - slider).abs() < 1e-9, "{angle}: {pose:?}");
        }
    }

    /// The slider's reach ends at 3: it waits there, and comes back.
    #[test]
    fn unreachable_position_is_approached() {
        let model = model::load_str("crank.yaml", CRANK, &[]).unwrap();
        let movable = Movable::new(&model, Interruption::default()).unwrap();
        let (sample, mut hand) = (movable.nominal(), movable.hand());
        let slider = Grip { body: 3, point: 0 };
        for place in [2.8, 3.0, 4.0, 9.0] {
            let at = held(&mut hand, slider, &sample, [place, 0.5, 0.0]).at;
            assert!((at[0] - f64::min(place, 3.0)).abs() < 1e-4, "{place}: {at:?}");
        }
        let at = held(&mut hand, slider, &sample, [2.0, 0.0, 0.0]).at;
        assert!((at[0] - 2.0).abs() < 1e-9, "{at:?}");
        hand.release();
        assert!(hand.drag(Grip { body: 0, point: 0 }, &sample, [0.0; 3]).is_none());
        assert!(hand.drag(Grip { body: 1, point: 9 }, &sample, [0.0; 3]).is_none());
    }

    #[test]
    fn driven_body_does_not_follow_the_hand() {
        let text = CRANK.replace("joints:", "joints:\n  drive: { equation: crank.angle = 1 }");
        let text = text.replace("initial: { crank.angle: 60 deg }\n", "");
        let model = model::load_str("crank.yaml", &text, &[]).unwrap();
        let movable = Movable::new(&model, Interruption::default()).unwrap();
        let (sample, mut hand) = (movable.nominal(), movable.hand());
        let Held { at, freedom, .. } = hand.drag(Grip { body: 1, point: 1 }, &sample, [0.0, 1.0, 0.0]).unwrap();
        assert_eq!(freedom, 0);
        assert!((at[0] - 1.0_f64.cos()).hypot(at[1] - 1.0_f64.sin()) < 1e-10, "{at:?}");
    }

    /// The hand takes the mechanism to any instant of a motion.
    #[test]
    fn a_pose_of_a_motion_is_found_again() {
        let text = CRANK.replace("initial:", "effects: { push: { torque: { on: crank, value: 4 } } }\ninitial:");
        let model = model::load_str("crank.yaml", &text, &[]).unwrap();
        let movable = Movable::new(&model, Interruption::default()).unwrap();
        let sample = movable.nominal();
        let motion = movable.motion(&sample, 100_000).unwrap();
        let lines = motion.nominal.bodies.len() / motion.times.len();
        let last = &motion.nominal.bodies[motion.nominal.bodies.len() - lines..];
        assert!((last[2] - motion.nominal.bodies[2]).abs() > 0.3, "it turns");
        let mut hand = movable.hand();
        hand.follow(&sample, last);
        let end = Grip { body: 1, point: 1 };
        let angle = last[2];
        let Held { pose, .. } = held(&mut hand, end, &sample, [angle.cos(), angle.sin(), 0.0]);
        let off = pose.iter().zip(last).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-7, "{off}");
    }
}
