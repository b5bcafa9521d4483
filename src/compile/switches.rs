//! Where the equations switch: arguments of `abs`, `sign`, `min`, `max` and of conditions, with their rates, as one tape.

use symdiff::{Binary, Expr, Graph, Lowered, Node, Tape, Unary, lower};

use super::equations::time_derivative;
use super::layout::Layout;
use crate::assemble::System;

/// The switches of a system over the registers of [`Layout`]. A switch is where one of its values changes its sign.
#[derive(Clone, Debug)]
pub struct SwitchProgram {
    /// Shared with the step's program.
    pub layout: Layout,
    /// Registers of each switch's value, and of its rate where that does not depend on rates of accelerations or reactions.
    pub switches: Vec<(usize, Option<usize>)>,
    lowered: Lowered,
}

impl SwitchProgram {
    /// Number of registers of a tile.
    pub fn registers(&self) -> usize {
        self.lowered.registers
    }

    /// Numbers that a new tile holds.
    pub fn constants(&self) -> &[(u32, f64)] {
        &self.lowered.constants
    }

    /// Once a sample.
    pub fn sample(&self) -> &Tape {
        &self.lowered.stages[0]
    }

    /// Values and rates at a state.
    pub fn evaluate(&self) -> &Tape {
        &self.lowered.kernels[0]
    }
}

/// The switches of a system's equations; `None` where there are none.
pub fn compile_switches(system: &System) -> Option<SwitchProgram> {
    let layout = Layout::new(system.parameters.len(), system.q.len(), system.lambda.len());
    let inputs = layout.inputs(system);
    let mut graph = system.graph.clone();
    let values = arguments(system, &mut graph);
    if values.is_empty() {
        return None;
    }
    let rates = time_derivative(system, &mut graph, &values);
    let jumps: Vec<Expr> = system.w.iter().chain(&system.lambda).copied().collect();
    let has_rate: Vec<bool> = values.iter().map(|&value| !depends(&graph, value, &jumps)).collect();
    let known = rates.iter().zip(&has_rate).filter(|(_, known)| **known).map(|(&rate, _)| rate);
    let kernel = values.iter().copied().chain(known).map(|value| (value, None)).collect();
    let lowered = lower(&graph, &inputs, 1, layout.registers() as u32, &[kernel]);
    let mut registers = lowered.outputs[0].iter().map(|&register| register as usize);
    let of_values: Vec<usize> = registers.by_ref().take(values.len()).collect();
    let switches =
        of_values.into_iter().zip(has_rate).map(|(value, known)| (value, if known { registers.next() } else { None }));
    let switches = switches.collect();
    Some(SwitchProgram { layout, switches, lowered })
}

/// The arguments that change during a motion, each once.
fn arguments(system: &System, graph: &mut Graph) -> Vec<Expr> {
    let roots: Vec<Expr> = system.force.iter().chain(&system.inertia).chain(&system.constraint).copied().collect();
    let mut found = Vec::new();
    for expr in graph.reachable(&roots) {
        found.push(match graph.node(expr) {
            Node::Unary(Unary::Abs | Unary::Sign, a) => a,
            Node::Binary(Binary::Select | Binary::SelectElse, condition, _) => condition,
            Node::Binary(Binary::Min | Binary::Max, a, b) => graph.sub(a, b),
            _ => continue,
        });
    }
    let moving: Vec<Expr> = [system.time]
        .iter()
        .chain(&system.q)
        .chain(&system.v)
        .chain(&system.w)
        .chain(&system.lambda)
        .copied()
        .collect();
    found.sort_unstable();
    found.dedup();
    found.retain(|&argument| depends(graph, argument, &moving));
    found
}

fn depends(graph: &Graph, expr: Expr, on: &[Expr]) -> bool {
    let symbols = graph.symbols_of(&[expr]);
    on.iter().any(|symbol| symbols.binary_search(symbol).is_ok())
}
