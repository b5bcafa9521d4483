//! Criteria by which two formulations of a mechanism, or two cuts of its loops, are compared.

use crate::simulate::Simulator;
use crate::study::formulation::tuning::TUNING;

/// Whether both have the same degrees of freedom and the same outputs at the start.
pub fn starts_alike(one: &Simulator, other: &Simulator) -> bool {
    let [first, second] = [one, other].map(Simulator::outputs_at_start);
    // NaN is like nothing.
    let alike = |(a, b): (f64, f64)| (a - b).abs() <= TUNING.alike * a.abs().max(b.abs()).max(1.0);
    one.mobility.degrees_of_freedom == other.mobility.degrees_of_freedom
        && first.len() == second.len()
        && first.into_iter().zip(second).all(alike)
}

/// Instructions of a step with one correction.
pub fn instructions(simulator: &Simulator) -> usize {
    simulator.program.instructions()
}
