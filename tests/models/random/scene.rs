//! A mechanism as a model: placed, turned, named and ordered at will.

use std::fmt::Write as _;

use mbint::Model;
use mbint::results::Bounds;

use super::mechanism::Mechanism;
use super::quaternion::{Quaternion, Vector, add};

/// Placement and notation of a mechanism.
#[derive(Clone, Debug)]
pub struct Scene {
    /// All is turned, then shifted.
    pub turn: Quaternion,
    /// The turn in the plane.
    pub angle: f64,
    pub shift: Vector,
    /// Prefix of the names of bodies, before their number.
    pub name: &'static str,
    /// Bodies, joints and springs from the last to the first.
    pub reversed: bool,
    /// s
    pub step: f64,
    pub duration: f64,
    /// Formulas to observe, in which `{i}` is body i.
    pub outputs: Vec<String>,
}

impl Scene {
    pub fn of(outputs: Vec<String>, step: f64, duration: f64) -> Self {
        Self { turn: Quaternion::ONE, angle: 0.0, shift: [0.0; 3], name: "b", reversed: false, step, duration, outputs }
    }

    pub fn body(&self, index: usize) -> String {
        format!("{}{index}", self.name)
    }

    fn section(&self, title: &str, mut lines: Vec<String>) -> String {
        if self.reversed {
            lines.reverse();
        }
        format!("{title}:\n{}", lines.iter().map(|line| format!("  {line}\n")).collect::<String>())
    }

    /// The model's text.
    pub fn write(&self, mechanism: &Mechanism) -> String {
        let kind = mechanism.kind;
        let world = |point: Vector| add(self.shift, self.turn.turn(point));
        let vector = |v: Vector| {
            let components = if kind.spatial { &v[..] } else { &v[..2] };
            format!("[{}]", components.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", "))
        };
        let name = |index: usize| self.body(index);
        let (mut bodies, mut joints, mut effects) = (Vec::new(), Vec::new(), Vec::new());
        let tie = mechanism.tie.as_ref().map_or([0.0; 3], |tie| tie.point);
        let (root, tie) = (vector(world([0.0; 3])), vector(world(tie)));
        // A hinge's axis is given in the frames of both its points.
        let root = match kind.spatial {
            true => format!("{{ position: {root}, rotation: {{ quaternion: {:?} }} }}", self.turn.0),
            false => root,
        };
        bodies.push(format!("ground: {{ points: {{ root: {root}, tie: {tie} }} }}"));
        for (index, body) in mechanism.bodies.iter().enumerate() {
            let mut points = format!("joint: {}, end: {}", vector(body.joint[1]), vector(body.end));
            for (next, other) in mechanism.bodies.iter().enumerate().filter(|(_, other)| other.before == Some(index)) {
                write!(points, ", to{next}: {}", vector(other.joint[0])).unwrap();
            }
            let inertia = if kind.spatial { vector(body.inertia) } else { format!("{:?}", body.inertia[2]) };
            bodies.push(format!(
                "{}: {{ mass: {:?}, inertia: {inertia}, points: {{ {points} }} }}",
                name(index),
                body.mass
            ));
            let joint = if body.hinged { "revolute" } else { "spherical" };
            match body.before {
                Some(before) => {
                    joints.push(format!(
                        "j{index}: {{ {joint}: [{}.to{index}, {}.joint] }}",
                        name(before),
                        name(index)
                    ));
                }
                None if !kind.floating => {
                    joints.push(format!("j{index}: {{ {joint}: [ground.root, {}.joint] }}", name(index)));
                }
                None => (),
            }
            if kind.driven {
                let value = |omega: &str| format!("{:?} - {:?}*{}.{omega}", body.torque, body.drag, name(index));
                // In space along the world's z, which is why such scenes are not turned.
                let value =
                    if kind.spatial { format!("[0, 0, {}]", value("omega.z")) } else { value("angular_velocity") };
                effects.push(format!("motor{index}: {{ torque: {{ on: {}, value: {value} }} }}", name(index)));
            }
        }
        if let Some(tie) = &mechanism.tie {
            let last = name(mechanism.bodies.len() - 1);
            joints.push(format!(
                "tie: {{ distance: {{ between: [ground.tie, {last}.end], length: {:?} }} }}",
                tie.length
            ));
        }
        for (index, spring) in mechanism.springs.iter().enumerate() {
            let [a, b] = spring.between.map(name);
            effects.push(format!(
                "spring{index}: {{ spring_damper: {{ between: [{a}.end, {b}.end], stiffness: {:?}, damping: {:?}, free_length: {:?} }} }}",
                spring.stiffness, spring.damping, spring.free_length
            ));
        }
        if mechanism.gravity != [0.0; 3] {
            effects.push(format!(
                "weight: {{ gravity: {{ acceleration: {} }} }}",
                vector(self.turn.turn(mechanism.gravity))
            ));
        }
        let outputs: Vec<String> = self
            .outputs
            .iter()
            .enumerate()
            .map(|(index, formula)| {
                let bodies = (0..mechanism.bodies.len()).rev();
                let formula = bodies.fold(formula.clone(), |text, i| text.replace(&format!("{{{i}}}"), &name(i)));
                format!("o{index}: {formula}")
            })
            .collect();
        let mut text = format!("model: drawn\nspace: {}\n", if kind.spatial { "spatial" } else { "planar" });
        text += &self.section("bodies", bodies);
        if !joints.is_empty() {
            text += &self.section("joints", joints);
        }
        if !effects.is_empty() {
            text += &self.section("effects", effects);
        }
        text += &self.section("initial", self.start(mechanism, false));
        text += &self.section("guess", self.start(mechanism, true));
        text += &format!("outputs:\n{}", outputs.iter().map(|line| format!("  {line}\n")).collect::<String>());
        let Self { step, duration, .. } = self;
        text + &format!("simulation: {{ duration: {duration:?}, step: {step:?}, output_step: {:?} }}\n", self.row())
    }

    /// Rows are as far apart as the longest step of a comparison.
    fn row(&self) -> f64 {
        ROW
    }

    /// The given values of the start, or the guesses for it.
    fn start(&self, mechanism: &Mechanism, guessed: bool) -> Vec<String> {
        let spatial = mechanism.kind.spatial;
        let mut lines = Vec::new();
        for (index, body) in mechanism.bodies.iter().enumerate() {
            let name = self.body(index);
            let [x, y, z] = add(self.shift, self.turn.turn(body.place));
            let [vx, vy, vz] = self.turn.turn(body.velocity);
            // The joints determine the positions of all bodies but a floating one.
            if guessed != (mechanism.kind.floating && body.before.is_none()) {
                lines.push(format!("{name}.x: {x:?}\n  {name}.y: {y:?}"));
                lines.extend(spatial.then(|| format!("{name}.z: {z:?}")));
                if !guessed {
                    lines.push(format!("{name}.vx: {vx:?}\n  {name}.vy: {vy:?}"));
                    lines.extend(spatial.then(|| format!("{name}.vz: {vz:?}")));
                }
            }
            if guessed {
                continue;
            }
            if spatial {
                let q = self.turn.times(body.attitude).0;
                lines.push(format!(
                    "{name}.orientation: {{ quaternion: {q:?} }}\n  {name}.omega_body: {:?}",
                    body.omega
                ));
            } else {
                lines.push(format!("{name}.angle: {:?}", body.angle + self.angle));
                lines.push(format!("{name}.angular_velocity: {:?}", body.omega[2]));
            }
        }
        lines
    }

    /// The motion.
    pub fn run(&self, mechanism: &Mechanism) -> Bounds {
        let text = self.write(mechanism);
        let model = Model::from_yaml_str("drawn", &text);
        let run = |model: Model| model.study().nominal().threads(1).run();
        let result = model.and_then(run).unwrap_or_else(|error| panic!("{text}\n{error}"));
        assert_eq!(result.failure(), None, "{text}");
        result.bounds().clone()
    }
}

/// s
pub const ROW: f64 = 2e-3;
