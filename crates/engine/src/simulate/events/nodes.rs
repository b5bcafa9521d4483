//! States at the nodes of the steps of a segment.

use crate::numerics::{STEP_NODES, step_nodes};
use crate::simulate::drive::Motion;
use crate::simulate::explicit::runge_kutta::RungeKutta;

/// Takes the steps of a segment, which end at these shares of it: the states at their nodes. Where the segment ends at
/// an event, the motion keeps the rates behind it.
pub(super) fn pass(motion: &mut impl Motion, state: &[f64], steps: &[f64], ends_at_event: bool) -> Vec<Vec<f64>> {
    let mut run = RungeKutta::start(motion, 0.0, state.to_vec());
    let mut nodes = vec![state.to_vec()];
    for &end in steps {
        let inner = if ends_at_event && end == 1.0 {
            run.step_to_event(motion, end)
        } else {
            run.attempt(motion, end);
            run.finish(motion, end);
            run.prepare_dense(motion, end);
            end
        };
        let length = (end - run.time) / (inner - run.time);
        for share in &step_nodes()[1..STEP_NODES - 1] {
            let mut node = vec![0.0; state.len()];
            run.interpolate(share * length, &mut node);
            nodes.push(node);
        }
        run.accept(motion, end);
        nodes.push(run.state.clone());
    }
    nodes
}
