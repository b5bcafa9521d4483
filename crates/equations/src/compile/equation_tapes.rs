//! The equations as tapes, without a scheme and without elimination: an enclosure of a solution is verified with them.

use rustc_hash::FxHashMap;
use symdiff::{Binary, Expr, Graph, Lowered, Node, SparseMatrix, Tape, Unary, lower};

use super::layout::Layout;
use super::start_equations::StartEquations;
use super::tapes::Tapes;
use crate::assemble::System;

/// A matrix's entries: (row, column, register).
pub type Entries = Vec<(usize, usize, usize)>;

/// Tapes over the parameters, t, q, v, w and λ in the registers of [`Layout`].
#[derive(Clone, Debug)]
pub struct EquationsProgram {
    /// Shared with the step's program.
    pub layout: Layout,
    /// Registers of M w + Φ_qᵀ λ − Q, n, after [`residual`](Self::residual).
    pub motion: Vec<usize>,
    /// Registers of Φ, m, after [`residual`](Self::residual).
    pub constraint: Vec<usize>,
    /// Registers of Φ̇ and of Φ̈, m each, after [`rates`](Self::rates).
    pub constraint_rates: [Vec<usize>; 2],
    /// Derivatives of the motion's equations after [`jacobian`](Self::jacobian): by q, v, w and λ.
    pub motion_by: [Entries; 4],
    /// Φ_q after [`jacobian`](Self::jacobian).
    pub constraint_by_position: Entries,
    /// Registers of the closure of the start's positions, and of its velocities, after [`closure`](Self::closure).
    pub closure: [Vec<usize>; 2],
    /// Derivatives of these by q, and by v, after [`closure_jacobian`](Self::closure_jacobian).
    pub closure_by: [Entries; 2],
    /// Derivatives of Φ̈ by q and v after [`rates_jacobian`](Self::rates_jacobian).
    pub constraint_acceleration_by: [Entries; 2],
    /// Registers of the outputs after [`observe`](Self::observe).
    pub outputs: Vec<usize>,
    /// (coordinate, register) of the positions, and of the velocities, that are given at the start, after
    /// [`given`](Self::given).
    pub kept: [Vec<(usize, usize)>; 2],
    /// Guesses of positions that are not given, as numbers; `None` where these depend on parameters.
    pub guess: Vec<Option<f64>>,
    /// Whether velocities of zero fulfil all their conditions, and none is given.
    pub can_rest: bool,
    /// Arguments of conditions and signs in the equations that change with the motion: registers after `conditions`.
    /// Derivatives do not show where these jump.
    pub conditions: Vec<usize>,
    /// Whether a function stands in the equations that has knots or kinks.
    pub has_knots: bool,
    lowered: Lowered,
}

const RESIDUAL: usize = 0;
const RATES: usize = 1;
const JACOBIAN: usize = 2;
const OBSERVE: usize = 3;
const GIVEN: usize = 4;
const RATES_JACOBIAN: usize = 5;
const CLOSURE: usize = 6;
const CLOSURE_JACOBIAN: usize = 7;
const CONDITIONS: usize = 8;

impl Tapes for EquationsProgram {
    fn lowered(&self) -> &Lowered {
        &self.lowered
    }
}

impl EquationsProgram {
    /// The equations of motion and Φ.
    pub fn residual(&self) -> &Tape {
        &self.lowered.kernels[RESIDUAL]
    }

    /// Φ̇ and Φ̈.
    pub fn rates(&self) -> &Tape {
        &self.lowered.kernels[RATES]
    }

    /// All first derivatives.
    pub fn jacobian(&self) -> &Tape {
        &self.lowered.kernels[JACOBIAN]
    }

    /// The outputs.
    pub fn observe(&self) -> &Tape {
        &self.lowered.kernels[OBSERVE]
    }

    /// Derivatives of Φ̈ by positions and velocities.
    pub fn rates_jacobian(&self) -> &Tape {
        &self.lowered.kernels[RATES_JACOBIAN]
    }

    /// Φ and the start's conditions on positions, Φ̇ and those on velocities.
    pub fn closure(&self) -> &Tape {
        &self.lowered.kernels[CLOSURE]
    }

    /// Their derivatives.
    pub fn closure_jacobian(&self) -> &Tape {
        &self.lowered.kernels[CLOSURE_JACOBIAN]
    }

    /// Arguments of conditions and signs.
    pub fn conditions(&self) -> &Tape {
        &self.lowered.kernels[CONDITIONS]
    }

    /// Given positions and velocities of the start.
    pub fn given(&self) -> &Tape {
        &self.lowered.kernels[GIVEN]
    }
}

/// Compiles a system's equations.
pub fn compile_equations(system: &System) -> EquationsProgram {
    let layout = Layout::of(system);
    let mut graph = system.graph.clone();
    let StartEquations {
        motion,
        jacobian,
        closure,
        closure_jacobian,
        closure_rate,
        closure_rate_jacobian,
        rate,
        rate_of_rate,
    } = StartEquations::new(system, &mut graph);
    let of_closure = [closure_jacobian, closure_rate_jacobian];
    let by = |graph: &mut Graph, symbols: &[Expr]| graph.jacobian(&motion, symbols);
    let mut matrices: Vec<SparseMatrix> =
        [&system.q, &system.v, &system.w, &system.lambda].map(|symbols| by(&mut graph, symbols)).into();
    matrices.push(jacobian);
    let of_rates = [&system.q, &system.v].map(|symbols| graph.jacobian(&rate_of_rate, symbols));
    let at_rest: FxHashMap<Expr, Expr> = system.v.iter().map(|&v| (v, graph.constant(0.0))).collect();
    let rates_at_rest = graph.substitute(&closure_rate, &at_rest);
    let can_rest =
        rates_at_rest.iter().all(|&rate| graph.is_zero(rate)) && system.start.velocity.iter().all(Option::is_none);
    let rows = [&motion[..], &rate_of_rate, &closure, &closure_rate].concat();
    let (conditions, has_knots) = conditions_and_knots(system, &graph, &rows);
    let guess = system.start.guess.iter().map(|&guess| graph.as_constant(guess)).collect();
    let kept = [&system.start.position, &system.start.velocity];
    let given: Vec<Expr> = kept.iter().flat_map(|values| values.iter().flatten().copied()).collect();
    let free = |values: &[Expr]| values.iter().map(|&value| (value, None)).collect::<Vec<_>>();
    let kernels = [
        free(&[&motion[..], &system.constraint].concat()),
        free(&[rate, rate_of_rate].concat()),
        matrices.iter().flat_map(|matrix| matrix.entries().map(|(_, _, value)| (value, None))).collect(),
        system.outputs.iter().map(|output| (output.expr, None)).collect(),
        free(&given),
        of_rates.iter().flat_map(|matrix| matrix.entries().map(|(_, _, value)| (value, None))).collect(),
        free(&[&closure[..], &closure_rate].concat()),
        of_closure.iter().flat_map(|matrix| matrix.entries().map(|(_, _, value)| (value, None))).collect(),
        free(&conditions),
    ];
    let lowered = lower(&graph, &layout.inputs(system), 1, layout.registers() as u32, &kernels);

    let (n, m) = (system.q.len(), system.lambda.len());
    let registers = |kernel: usize| lowered.outputs[kernel].iter().map(|&register| register as usize);
    let entries = |kernel: usize, matrices: &[SparseMatrix]| -> Vec<Entries> {
        let mut derivatives = registers(kernel);
        let entries = |matrix: &SparseMatrix| -> Entries {
            let found = matrix.entries().zip(derivatives.by_ref());
            found.map(|((row, column, _), register)| (row, column, register)).collect()
        };
        matrices.iter().map(entries).collect()
    };
    let mut of_motion = entries(JACOBIAN, &matrices);
    let constraint_by_position = of_motion.pop().unwrap_or_default();
    let mut of_motion = of_motion.into_iter();
    let motion_by = std::array::from_fn(|_| of_motion.next().unwrap_or_default());
    let mut of_closure = entries(CLOSURE_JACOBIAN, &of_closure).into_iter();
    let closure_by = std::array::from_fn(|_| of_closure.next().unwrap_or_default());
    let mut of_rates = entries(RATES_JACOBIAN, &of_rates).into_iter();
    let constraint_acceleration_by = std::array::from_fn(|_| of_rates.next().unwrap_or_default());
    let mut given = registers(GIVEN);
    let kept = kept.map(|values| {
        let places = (0..n).filter(|&index| values[index].is_some());
        places.zip(given.by_ref()).collect::<Vec<_>>()
    });
    drop(given);
    EquationsProgram {
        motion: registers(RESIDUAL).take(n).collect(),
        constraint: registers(RESIDUAL).skip(n).collect(),
        constraint_rates: [registers(RATES).take(m).collect(), registers(RATES).skip(m).collect()],
        closure: [registers(CLOSURE).take(closure.len()).collect(), registers(CLOSURE).skip(closure.len()).collect()],
        closure_by,
        outputs: registers(OBSERVE).collect(),
        motion_by,
        constraint_by_position,
        constraint_acceleration_by,
        kept,
        guess,
        can_rest,
        conditions: registers(CONDITIONS).collect(),
        has_knots,
        layout,
        lowered,
    }
}

/// Arguments of conditions and signs in some rows, as far as they change with the motion, each once; and whether a
/// function that is made of pieces stands in the rows.
fn conditions_and_knots(system: &System, graph: &Graph, rows: &[Expr]) -> (Vec<Expr>, bool) {
    let of_motion = graph.depending_on(rows, &system.motion_symbols());
    let (mut conditions, mut has_knots) = (Vec::new(), false);
    for expr in graph.reachable(rows) {
        let argument = match graph.node(expr) {
            Node::Unary(Unary::Sign, argument) => Some(argument),
            Node::Binary(Binary::Select | Binary::SelectElse, argument, _) => Some(argument),
            Node::Unary(Unary::Spline(..) | Unary::Abs | Unary::Floor, _) => None,
            Node::Binary(Binary::Min | Binary::Max, ..) => None,
            _ => continue,
        };
        has_knots = true;
        conditions.extend(argument.filter(|argument| of_motion.contains(argument)));
    }
    conditions.sort_unstable();
    conditions.dedup();
    (conditions, has_knots)
}
