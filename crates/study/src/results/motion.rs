//! Motion of the bodies of a mechanism: at the nominal parameters, at samples of the box, and as polynomials in the
//! parameters.

use super::{Drawing, ParameterSummary};

/// A mechanism's motion at times that were chosen from the rows of a simulation.
///
/// A *pose* has the coordinates of every body but the ground, in the ground's frame and in m: x, y and the angle about
/// z in rad in the plane; x, y, z and the Euler parameters in space.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The mechanism at its nominal start.
    pub drawing: Drawing,
    /// Times of the poses, s.
    pub times: Vec<f64>,
    /// Number of simulated rows that the times were chosen from.
    pub rows: usize,
    /// Largest distance of a point of a body, at a simulated row, from the straight lines between the chosen poses, m:
    /// over all bodies, samples and rows.
    pub between: f64,
    /// Numbers of a body's pose: 3 in the plane, 7 in space.
    pub per_body: usize,
    /// The uncertain parameters.
    pub parameters: Vec<ParameterSummary>,
    /// The nominal motion.
    pub nominal: Poses,
    /// Forces of the nominal motion.
    pub forces: Vec<MovingForce>,
    /// Motions at samples of the box.
    pub samples: Vec<MovingSample>,
    /// Motions under the worst functions of excitations.
    pub worst: Vec<WorstMotion>,
    /// Samples that cannot be assembled or do not move to the end.
    pub stopped: usize,
    /// The motion as a function of the parameters; `None` if there are none, or if a sample that it needs stops.
    pub polynomials: Option<MotionPolynomials>,
}

/// Poses of the bodies at each time, and their points in their own frames.
#[derive(Clone, Debug, Default)]
pub struct Poses {
    /// (time, coordinate of the pose)
    pub bodies: Vec<f64>,
    /// (point, 3), m: of each body, the ground first, the points of [`DrawnBody`](super::DrawnBody), then its centre of
    /// mass if it has one. They do not move in their frames, but depend on parameters.
    pub points: Vec<f64>,
}

/// A force at a point of a body, in the ground's frame.
#[derive(Clone, Debug)]
pub struct MovingForce {
    /// The joint or effect.
    pub name: String,
    /// Whether it is a joint's, on its second body.
    pub is_reaction: bool,
    /// (time, 6): its point, m, and the force, N.
    pub values: Vec<f64>,
}

/// The motion at a sample.
#[derive(Clone, Debug)]
pub struct MovingSample {
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// The motion.
    pub poses: Poses,
}

/// The motion under the functions of excitations under which something goes furthest.
#[derive(Clone, Debug)]
pub struct WorstMotion {
    /// Name of the output, reduced output or requirement.
    pub name: String,
    /// When it goes there, s: the motion stands still behind that. `None` without an instant.
    pub time: Option<f64>,
    /// The motion.
    pub poses: Poses,
}

/// Deviation from the nominal motion: sums of products of Chebyshev polynomials in ξ ∈ [−1, 1], the normalised position
/// of a parameter in its interval.
#[derive(Clone, Debug)]
pub struct MotionPolynomials {
    /// (term, parameter)
    pub degrees: Vec<u8>,
    /// Times of the nominal motion's events, as far as all samples meet the same ones, s.
    pub events: Vec<f64>,
    /// Deviations of these times, s: (event, term)
    pub event_deviations: Vec<f64>,
    /// (time, coordinate of the pose, term). Where there are events, time is that of the nominal motion: between two
    /// events, and from the last one to the end, the time of another motion is a linear function of it.
    pub bodies: Vec<f64>,
    /// (number of the points, term)
    pub points: Vec<f64>,
    /// Largest distance of a point of a body from its simulated position, m, over all times and the samples that the
    /// polynomials were not made from.
    pub error: f64,
}
