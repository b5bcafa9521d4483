//! States at the nodes of the steps of a segment.

use crate::numerics::{STEP_NODES, step_nodes};
use crate::simulate::drive::Motion;
use crate::simulate::explicit::runge_kutta::{RungeKutta, before_event};

/// Takes the steps of a segment, which end at these shares of it: the states at their nodes. Where the segment ends at
/// an event, `at_event` sees the motion with the rates behind it.
pub(super) fn pass<M: Motion>(
    motion: &mut M,
    state: &[f64],
    steps: &[f64],
    at_event: Option<impl FnOnce(&M)>,
) -> Vec<Vec<f64>> {
    let mut at_event = at_event;
    let mut run = RungeKutta::start(motion, 0.0, state.to_vec());
    let mut nodes = vec![state.to_vec()];
    for &end in steps {
        let seen = at_event.take_if(|_| end == 1.0);
        let inner = if seen.is_some() { before_event(run.time, end) } else { end };
        run.attempt(motion, inner);
        run.finish(motion, inner);
        match seen {
            Some(seen) => {
                run.extrapolate(motion, inner, end);
                seen(motion);
            }
            None => run.prepare_dense(motion, end),
        }
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
