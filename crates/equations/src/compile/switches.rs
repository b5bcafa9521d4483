//! Where the equations switch: arguments of `abs`, `sign`, `min`, `max` and of conditions, with their rates, as one
//! tape. Where `floor` jumps, the sine of π times its argument changes its sign.

use std::f64::consts::PI;

use rustc_hash::{FxHashMap, FxHashSet};
use symdiff::{Binary, Expr, Graph, Lowered, Node, Tape, Tile, Unary, lower};

use super::equations::time_derivative;
use super::layout::Layout;
use super::tapes::Tapes;
use crate::assemble::{Overlap, System};

/// The switches of a system over the registers of [`Layout`]. A switch is where one of its values changes its sign.
#[derive(Clone, Debug)]
pub struct SwitchProgram {
    /// Shared with the step's program.
    pub layout: Layout,
    /// All of them.
    pub switches: Vec<Switch>,
    lowered: Lowered,
}

/// A switch.
#[derive(Clone, Debug)]
pub struct Switch {
    /// Register of its value.
    pub value: usize,
    /// Register of its rate, where that does not depend on rates of accelerations or reactions.
    pub rate: Option<usize>,
    /// Indices of the switches at whole numbers at which the value itself jumps.
    pub jumps_with: Vec<usize>,
    /// The term of the system's equations that jumps or has a kink there; of a condition, the condition.
    pub of: Expr,
    /// Whether its value depends on velocities.
    pub of_velocity: bool,
}

impl Tapes for SwitchProgram {
    fn lowered(&self) -> &Lowered {
        &self.lowered
    }
}

impl SwitchProgram {
    /// Values and rates at a state.
    pub fn evaluate(&self) -> &Tape {
        &self.lowered.kernels[0]
    }

    /// A memory with the parameters of a tile of samples.
    pub fn memory_for(&self, samples: &Tile) -> Tile {
        let mut memory = Tile::new(samples.width(), self.registers(), self.constants());
        let parameters = self.layout.parameters.clone();
        memory.block_mut(parameters.clone()).copy_from_slice(samples.block(parameters));
        memory.run(self.sample());
        memory
    }

    /// Evaluates values and rates at the states and the times of a tile of samples.
    pub fn evaluate_at(&self, states: &Tile, memory: &mut Tile) {
        memory.block_mut(self.layout.state()).copy_from_slice(states.block(self.layout.state()));
        memory.lane_mut(self.layout.time).copy_from_slice(states.lane(self.layout.time));
        memory.run(self.evaluate());
    }
}

/// The switches of a system's equations; `None` where there are none.
pub fn compile_switches(system: &System) -> Option<SwitchProgram> {
    let mut graph = system.graph.clone();
    let (values, terms) = arguments(system, &mut graph);
    compile_values(system, graph, &values, terms)
}

/// Gaps of all surfaces that may not overlap too deeply, and then the rest of these overlaps, in the order of the
/// effects; `None` where there are none.
pub fn compile_overlaps(system: &System) -> Option<SwitchProgram> {
    let overlaps: Vec<Overlap> = system.effects.iter().filter_map(|effect| effect.overlap).collect();
    let mut graph = system.graph.clone();
    let mut values: Vec<Expr> = overlaps.iter().map(|overlap| overlap.gap).collect();
    values.extend(overlaps.iter().map(|overlap| graph.add(overlap.gap, overlap.deepest)));
    let terms = values.iter().map(|&value| (value, Vec::new())).collect();
    compile_values(system, graph, &values, terms)
}

fn compile_values(
    system: &System,
    mut graph: Graph,
    values: &[Expr],
    terms: Vec<(Expr, Vec<usize>)>,
) -> Option<SwitchProgram> {
    if values.is_empty() {
        return None;
    }
    let layout = Layout::of(system);
    let inputs = layout.inputs(system);
    let rates = time_derivative(system, &mut graph, values);
    let jumps: Vec<Expr> = system.w.iter().chain(&system.lambda).copied().collect();
    let has_rate: Vec<bool> = values.iter().map(|&value| !depends(&graph, value, &jumps)).collect();
    let known = rates.iter().zip(&has_rate).filter(|(_, known)| **known).map(|(&rate, _)| rate);
    let kernel = values.iter().copied().chain(known).map(|value| (value, None)).collect();
    let lowered = lower(&graph, &inputs, 1, layout.registers() as u32, &[kernel]);
    let mut registers = lowered.outputs[0].iter().map(|&register| register as usize);
    let of_values: Vec<usize> = registers.by_ref().take(values.len()).collect();
    let of_velocity = values.iter().map(|&value| depends(&graph, value, &system.v));
    let switches = of_values.into_iter().zip(has_rate).zip(terms).zip(of_velocity);
    let switches = switches.map(|(((value, known), (of, jumps_with)), of_velocity)| Switch {
        value,
        rate: if known { registers.next() } else { None },
        jumps_with,
        of,
        of_velocity,
    });
    let switches = switches.collect();
    Some(SwitchProgram { layout, switches, lowered })
}

/// The arguments that change during a motion, each once, with the term that contains it and the indices of those at
/// which it jumps.
fn arguments(system: &System, graph: &mut Graph) -> (Vec<Expr>, Vec<(Expr, Vec<usize>)>) {
    let constraints = system.named_constraints().map(|(value, _)| value);
    let roots: Vec<Expr> = system.force.iter().chain(&system.inertia).copied().chain(constraints).collect();
    let mut found = Vec::new();
    let mut of_floor: FxHashMap<Expr, Expr> = FxHashMap::default();
    let mut terms: FxHashMap<Expr, Expr> = FxHashMap::default();
    let values = reachable_values(graph, &roots);
    for expr in graph.reachable(&roots) {
        let kinks = |node| matches!(node, Node::Unary(Unary::Abs, _) | Node::Binary(Binary::Min | Binary::Max, ..));
        if kinks(graph.node(expr)) && !values.contains(&expr) {
            continue;
        }
        let (argument, term) = match graph.node(expr) {
            Node::Unary(Unary::Abs | Unary::Sign, a) => (a, expr),
            Node::Binary(Binary::Select | Binary::SelectElse, condition, _) => (condition, condition),
            Node::Binary(Binary::Min | Binary::Max, a, b) => (graph.sub(a, b), expr),
            Node::Unary(Unary::Floor, a) => {
                let turns = graph.scale(PI, a);
                let sine = graph.sin(turns);
                of_floor.insert(expr, sine);
                (sine, expr)
            }
            _ => continue,
        };
        found.push(argument);
        terms.entry(argument).or_insert(term);
    }
    let moving = [&[system.time][..], &system.motion_symbols()].concat();
    found.sort_unstable();
    found.dedup();
    // An argument that only jumps does so where something else switches.
    found.retain(|&argument| graph.changes_steadily(argument, &moving));
    let index = |of: Expr| of_floor.get(&of).and_then(|sine| found.binary_search(sine).ok());
    let jumps_with = |of: Expr| graph.reachable(&[of]).into_iter().filter_map(index).collect();
    let terms = found.iter().map(|&of| (terms[&of], jumps_with(of))).collect();
    (found, terms)
}

/// Expressions whose values are in the roots. Of a condition the sign alone counts: a kink in it is no kink of a root.
fn reachable_values(graph: &Graph, roots: &[Expr]) -> FxHashSet<Expr> {
    let mut found = FxHashSet::default();
    let mut rest = roots.to_vec();
    while let Some(expr) = rest.pop() {
        if !found.insert(expr) {
            continue;
        }
        match graph.node(expr) {
            Node::Binary(Binary::Select | Binary::SelectElse, _, value) => rest.push(value),
            node => rest.extend(node.children()),
        }
    }
    found
}

/// Whether an expression has kinks or jumps: an `abs`, `sign`, `min` or `max`, a condition.
pub fn has_kink(graph: &Graph, expr: Expr) -> bool {
    graph.reachable(&[expr]).into_iter().any(|part| {
        matches!(
            graph.node(part),
            Node::Unary(Unary::Abs | Unary::Sign, _)
                | Node::Binary(Binary::Min | Binary::Max | Binary::Select | Binary::SelectElse, ..)
        )
    })
}

/// Whether an expression jumps: a `floor`, an `atan2`, a `sign`, a condition.
pub fn jumps(graph: &Graph, expr: Expr) -> bool {
    graph.reachable(&[expr]).into_iter().any(|part| {
        matches!(
            graph.node(part),
            Node::Unary(Unary::Floor | Unary::Sign, _)
                | Node::Binary(Binary::Atan2 | Binary::Select | Binary::SelectElse, ..)
        )
    })
}

fn depends(graph: &Graph, expr: Expr, on: &[Expr]) -> bool {
    let symbols = graph.symbols_of(&[expr]);
    on.iter().any(|symbol| symbols.binary_search(symbol).is_ok())
}
