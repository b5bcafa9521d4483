//! Mechanisms at random.

use proptest::prelude::*;

use super::quaternion::{Quaternion, Vector, add, cross, sub};

/// Properties that are drawn at random. The laws that hold for a mechanism depend on the properties that it lacks.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    pub spatial: bool,
    /// No joint with the ground, no gravity, nothing that acts from outside.
    pub floating: bool,
    /// With a loop: then it starts at rest.
    pub looped: bool,
    /// With dampers, drag and motors.
    pub driven: bool,
}

/// A tree of bodies, perhaps with a loop.
#[derive(Clone, Debug)]
pub struct Mechanism {
    pub kind: Kind,
    pub bodies: Vec<Body>,
    pub springs: Vec<Spring>,
    /// Distance of the last body from a point of the ground.
    pub tie: Option<Tie>,
    pub gravity: Vector,
}

/// A body, joined to an earlier one or to the ground.
#[derive(Clone, Debug)]
pub struct Body {
    pub mass: f64,
    /// Principal, about its centre of mass.
    pub inertia: Vector,
    /// Index of the body before it; `None` for the first, which is joined to the ground unless it floats.
    pub before: Option<usize>,
    /// The joint, on the body before and on this one.
    pub joint: [Vector; 2],
    /// Point of its springs and ties.
    pub end: Vector,
    /// Whether the joint lets it turn about z alone; in the plane all do.
    pub hinged: bool,
    /// At the start: of its frame, of its centre, of its turning in its own frame.
    pub attitude: Quaternion,
    /// About z, in the plane.
    pub angle: f64,
    pub place: Vector,
    pub velocity: Vector,
    pub omega: Vector,
    /// A torque about z, and drag: N m, N m s.
    pub torque: f64,
    pub drag: f64,
}

/// A spring between the ends of two bodies.
#[derive(Clone, Debug)]
pub struct Spring {
    pub between: [usize; 2],
    pub stiffness: f64,
    pub damping: f64,
    pub free_length: f64,
}

#[derive(Clone, Debug)]
pub struct Tie {
    pub point: Vector,
    pub length: f64,
}

impl Body {
    /// Position and velocity of one of its points.
    fn at(&self, point: Vector) -> [Vector; 2] {
        let arm = self.attitude.turn(point);
        let spin = self.attitude.turn(self.omega);
        [add(self.place, arm), add(self.velocity, cross(spin, arm))]
    }
}

/// Numbers of one body.
#[derive(Clone, Debug)]
struct Numbers {
    mass: f64,
    gyration: Vector,
    before: usize,
    points: [Vector; 3],
    hinged: bool,
    turn: [f64; 4],
    angle: f64,
    omega: Vector,
    act: [f64; 2],
}

fn vector(size: f64) -> impl Strategy<Value = Vector> {
    prop::array::uniform3(-size..size)
}

fn numbers() -> impl Strategy<Value = Numbers> {
    let points = prop::array::uniform3(vector(0.3));
    let turn = prop::array::uniform4(0.1..1.0_f64);
    let first = (0.3..2.0_f64, prop::array::uniform3(0.1..0.15_f64), 0..1000_usize, points, any::<bool>());
    let second = (turn, -3.0..3.0_f64, vector(3.0), [-1.0..1.0_f64, 0.02..0.1_f64]);
    (first, second).prop_map(|((mass, gyration, before, points, hinged), (turn, angle, omega, act))| Numbers {
        mass,
        gyration,
        before,
        points,
        hinged,
        turn,
        angle,
        omega,
        act,
    })
}

/// Two to five bodies, up to three springs.
pub fn mechanism(kind: Kind) -> impl Strategy<Value = Mechanism> {
    let spring = (0..1000_usize, 0..1000_usize, 5.0..100.0_f64, 0.0..1.0_f64, 0.5..1.5_f64);
    let springs = prop::collection::vec(spring, 0..4);
    (prop::collection::vec(numbers(), 2..6), springs, vector(9.81), vector(0.5))
        .prop_map(move |(numbers, springs, gravity, tie)| build(kind, &numbers, &springs, gravity, tie))
        .prop_filter("no spring begins without length, no tie is short", |mechanism| {
            let ends: Vec<Vector> = mechanism.bodies.iter().map(|body| body.at(body.end)[0]).collect();
            let apart = |a: usize, b: usize| super::quaternion::norm(sub(ends[a], ends[b]));
            mechanism.springs.iter().all(|spring| apart(spring.between[0], spring.between[1]) > 0.1)
                && mechanism.tie.iter().all(|tie| tie.length > 0.2)
        })
}

fn build(
    kind: Kind,
    numbers: &[Numbers],
    springs: &[(usize, usize, f64, f64, f64)],
    gravity: Vector,
    tie: Vector,
) -> Mechanism {
    let flat = |v: Vector| if kind.spatial { v } else { [v[0], v[1], 0.0] };
    let mut bodies: Vec<Body> = Vec::new();
    for (place, drawn) in numbers.iter().enumerate() {
        let before = place.checked_sub(1).map(|last| drawn.before % (last + 1));
        let [on_before, on_this, end] = drawn.points.map(flat);
        let rates = if kind.looped { [0.0; 3] } else { drawn.omega };
        let hinged = !kind.spatial || drawn.hinged;
        let earlier = before.map(|before| &bodies[before]);
        let base = earlier.map_or(Quaternion::ONE, |body| body.attitude);
        let turn = if hinged { Quaternion::about_z(drawn.angle) } else { Quaternion::along(drawn.turn) };
        // A hinge lets turn about z alone, which both frames share.
        let carried = earlier.map_or([0.0; 3], |body| turn.inverse().turn(body.omega));
        let omega = if hinged { add(carried, [0.0, 0.0, rates[2]]) } else { rates };
        let gyration = drawn.gyration.map(|radius| drawn.mass * radius * radius);
        let mut body = Body {
            mass: drawn.mass,
            inertia: gyration,
            before,
            joint: [on_before, on_this],
            end,
            hinged,
            attitude: base.times(turn),
            angle: earlier.map_or(0.0, |body| body.angle) + drawn.angle,
            place: [0.0; 3],
            velocity: [0.0; 3],
            omega,
            torque: if kind.driven { drawn.act[0] } else { 0.0 },
            drag: if kind.driven { drawn.act[1] } else { 0.0 },
        };
        let [joint, speed] = match earlier {
            Some(body) => body.at(on_before),
            None if kind.floating => [[0.0; 3], flat(drawn.omega.map(|x| 0.3 * x))],
            None => [[0.0; 3]; 2],
        };
        let [arm, swing] = body.at(on_this);
        (body.place, body.velocity) = (sub(joint, arm), sub(speed, swing));
        bodies.push(body);
    }
    let count = bodies.len();
    let end = |body: usize| bodies[body].at(bodies[body].end)[0];
    let spring = |&(a, b, stiffness, damping, length): &(usize, usize, f64, f64, f64)| {
        let between = [a % count, (a + 1 + b % (count - 1)) % count];
        let apart = super::quaternion::norm(sub(end(between[0]), end(between[1])));
        Spring { between, stiffness, damping: if kind.driven { damping } else { 0.0 }, free_length: apart * length }
    };
    let springs = springs.iter().map(spring).collect();
    let point = flat(tie);
    let tie = kind.looped.then(|| Tie { point, length: super::quaternion::norm(sub(end(count - 1), point)) });
    Mechanism { kind, bodies, springs, tie, gravity: if kind.floating { [0.0; 3] } else { flat(gravity) } }
}
