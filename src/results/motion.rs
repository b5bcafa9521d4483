//! How the bodies of a mechanism move: at the nominal parameters, at samples of the box, and as polynomials in the parameters.

use serde::Serialize;

use super::{Drawing, ParameterSummary};

/// A mechanism's motion at times that were chosen from the rows of a simulation.
///
/// A *pose* has the coordinates of every body but the ground, in the ground's frame and in m: x, y and the angle about z in rad in
/// the plane; x, y, z and the Euler parameters in space.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The mechanism at its nominal start.
    pub drawing: Drawing,
    /// What bodies of a robot look like.
    pub visuals: Vec<MovingVisual>,
    /// Times of the poses, s.
    pub times: Vec<f64>,
    /// Number of simulated rows that the times were chosen from.
    pub rows: usize,
    /// How far a point of a body is, at a simulated row, from where straight lines between the chosen poses have it, m: at most, over all
    /// bodies, samples and rows.
    pub between: f64,
    /// Numbers of a body's pose: 3 in the plane, 7 in space.
    pub per_body: usize,
    /// The uncertain parameters.
    pub parameters: Vec<ParameterSummary>,
    /// The nominal motion.
    pub nominal: Poses,
    /// Motions at samples of the box.
    pub samples: Vec<MovingSample>,
    /// Samples that cannot be assembled or do not move to the end.
    pub stopped: usize,
    /// The motion as a function of the parameters; `None` where there are none, or where a sample that it needs stops.
    pub polynomials: Option<MotionPolynomials>,
}

/// Where the bodies are at each time, and their points in their own frames.
#[derive(Clone, Debug, Default)]
pub struct Poses {
    /// (time, coordinate of the pose)
    pub bodies: Vec<f64>,
    /// (point, 3), m: of each body, the ground first, the points of [`DrawnBody`](super::DrawnBody), then its centre of mass where it
    /// has one. They do not move in their frames, but depend on parameters.
    pub points: Vec<f64>,
}

/// The motion at a sample.
#[derive(Clone, Debug)]
pub struct MovingSample {
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// The motion.
    pub poses: Poses,
}

/// Deviation from the nominal motion: sums of products of Chebyshev polynomials in ξ ∈ [−1, 1], a parameter's place between the
/// ends of its interval.
#[derive(Clone, Debug)]
pub struct MotionPolynomials {
    /// (term, parameter)
    pub degrees: Vec<u8>,
    /// (time, coordinate of the pose, term)
    pub bodies: Vec<f64>,
    /// (number of the points, term)
    pub points: Vec<f64>,
    /// How far a point of a body is from its simulated place, m: at most, over all times and samples that the polynomials were not made
    /// from.
    pub error: f64,
}

/// A solid that moves with a body.
#[derive(Clone, Debug, Serialize)]
pub struct MovingVisual {
    /// Its body, by index; 0 is the ground.
    pub body: usize,
    /// Where its middle is in the body's frame, m.
    pub position: [f64; 3],
    /// How it is turned there: Euler parameters.
    pub orientation: [f64; 4],
    /// `box`, `cylinder` (about z), `sphere` or `mesh`.
    pub shape: &'static str,
    /// The box' sides; radius and length; radius; factors of the mesh; m.
    pub size: Vec<f64>,
    /// Red, green and blue from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<[f64; 3]>,
    /// The file of a mesh, as the robot's file names it.
    #[serde(skip)]
    pub file: Option<String>,
}
