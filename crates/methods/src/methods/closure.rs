//! Outputs of a mechanism at motions that its surrogate knows.

/// Outputs from independent coordinates and their velocities, without time integration.
pub trait Closure: Sync {
    /// The independent coordinates.
    fn independent(&self) -> &[usize];

    /// Whether the outputs depend on velocities.
    fn needs_velocities(&self) -> bool;

    /// Outputs (output, point) at `count` points, given their parameters (parameter, point) and motions (2n lines,
    /// point); NaN if no solution is near a motion.
    fn outputs(&self, time: f64, count: usize, parameters: Vec<f64>, motion: Vec<f64>) -> Vec<f64>;
}
