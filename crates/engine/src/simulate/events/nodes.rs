//! States at the nodes of the steps of a segment.

use crate::numerics::{STEP_NODES, step_nodes};
use crate::simulate::drive::MotionSteps;

/// Takes the steps of a segment, which end at these shares of it: the states at their nodes. Where the segment ends at
/// an event, the motion keeps the rates behind it.
pub(super) fn pass<M>(
    run: &mut (impl MotionSteps<M> + ?Sized),
    motion: &mut M,
    state: &[f64],
    steps: &[f64],
    ends_at_event: bool,
) -> Vec<Vec<f64>> {
    run.begin(motion, 0.0, state);
    let mut nodes = vec![state.to_vec()];
    for &end in steps {
        let inner = if ends_at_event && end == 1.0 {
            run.attempt_to_event(motion, end)
        } else {
            run.attempt(motion, end);
            run.prepare_dense(motion, end);
            end
        };
        let length = (end - run.time()) / (inner - run.time());
        for share in &step_nodes()[1..STEP_NODES - 1] {
            let mut node = vec![0.0; state.len()];
            run.interpolate(share * length, &mut node);
            nodes.push(node);
        }
        nodes.push(run.next().to_vec());
        run.accept(motion, end);
    }
    nodes
}
