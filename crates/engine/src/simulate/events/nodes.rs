//! States at the nodes of the steps of a segment.

use crate::numerics::{STEP_NODES, step_nodes};
use crate::simulate::drive::Motion;
use crate::simulate::explicit::runge_kutta::RungeKutta;

/// Takes the steps of a segment, which end at these shares of it: the states at their nodes. `at_end` sees the motion
/// with the rates at the segment's end.
pub(super) fn pass<M: Motion>(
    motion: &mut M,
    state: &[f64],
    steps: &[f64],
    mut at_end: impl FnMut(&M),
) -> Vec<Vec<f64>> {
    let mut run = RungeKutta::start(motion, 0.0, state.to_vec());
    let mut nodes = vec![state.to_vec()];
    for &end in steps {
        run.attempt(motion, end);
        run.finish(motion, end);
        if end == 1.0 {
            at_end(motion);
        }
        run.prepare_dense(motion, end);
        for share in &step_nodes()[1..STEP_NODES - 1] {
            let mut node = vec![0.0; state.len()];
            run.interpolate(*share, &mut node);
            nodes.push(node);
        }
        run.accept(motion, end);
        nodes.push(run.state.clone());
    }
    nodes
}
