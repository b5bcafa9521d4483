//! The start as tapes: Gauss–Newton corrections of positions, velocities, accelerations and multipliers that make them fulfil
//! the constraints.
//!
//! ```text
//! positions       [ D  Φ_qᵀ ] [δq]   [ 0 ]        velocities      the same matrix,  right side −(Φ_q v + Φ_t)
//!                 [ Φ_q  −ε ] [μ ] = [−Φ ]
//! accelerations   [ M  Φ_qᵀ − Q_λ ] [δw]     [ M w + Φ_qᵀ λ − Q ]
//!                 [ Φ_q     −ε    ] [δλ] = − [ Φ̈(q, v, w, t)    ]
//! ```
//!
//! Velocities of a motion, which nothing gives, are corrected with M in place of D: by what constraint forces do to them.
//!
//! Q_λ is nonzero where friction depends on reactions; the corrections are then Newton's.
//!
//! A massless coordinate has no pivot in M. Where a constraint k defines it by others, both sides are augmented: μ
//! Φ_kᵀ Φ_k is added to M and μ Φ_kᵀ Φ̈_k to the equations of motion, which changes nothing where Φ̈ = 0.
//!
//! For positions and velocities, Φ has further rows: the conditions of the start ([`crate::assemble::StartCondition`]).
//!
//! D = diag(1/scale²) minimises the change of the coordinates that are not given; given ones have no column. ε > 0 makes
//! the matrices quasi-definite (Vanderbei, SIAM J. Optim. 5 (1995) 100): every diagonal elimination order exists, also
//! where constraints are redundant, and the corrections still converge to the exact solution, since the right sides are
//! exact.

use symdiff::{Expr, Graph, Input, Lowered, SparseMatrix, Stages, Tape, lower};

use super::equations::{equations_of_motion, time_derivative};
use super::layout::Layout;
use super::sparse_lu::{NoFactors, Numbers, PIVOT_SAMPLES, Pivoting, factorise};
use crate::assemble::{StartCondition, System};

/// ε relative to a constraint's own size in the matrix's metric.
const REGULARISATION: f64 = 1e-12;

/// The same for constraints known to be redundant: the others imply them, and their multipliers stay near zero.
const RELAXATION: f64 = 1e6;

/// Tapes for the start of a tile of samples; states and corrections are in the registers of [`Layout`].
#[derive(Clone, Debug)]
pub struct StartProgram {
    /// Shared with the step's program.
    pub layout: Layout,
    /// Registers of Φ, m and those of conditions on positions, after [`StartProgram::position`].
    pub constraint: Vec<usize>,
    /// Registers of Φ̇, m and those of conditions on velocities, after [`StartProgram::velocity`].
    pub constraint_rate: Vec<usize>,
    /// Registers of the outputs after [`StartProgram::observe`].
    pub outputs: Vec<usize>,
    /// Φ_q's entries (constraint, coordinate, register) after [`StartProgram::jacobian`].
    pub jacobian_entries: Vec<(usize, usize, usize)>,
    lowered: Lowered,
}

const GIVEN: usize = 0;
const GUESS: usize = 1;
const POSITION: usize = 2;
const VELOCITY: usize = 3;
const ACCELERATION: usize = 4;
const JACOBIAN: usize = 5;
const OBSERVE: usize = 6;
const PROJECTION: usize = 7;

impl StartProgram {
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

    /// Sets the positions and velocities that are given.
    pub fn given(&self) -> &Tape {
        &self.lowered.kernels[GIVEN]
    }

    /// Sets all positions to the guess.
    pub fn guess(&self) -> &Tape {
        &self.lowered.kernels[GUESS]
    }

    /// Correction of the positions (first n of `correction`), and Φ.
    pub fn position(&self) -> &Tape {
        &self.lowered.kernels[POSITION]
    }

    /// Correction of the velocities (first n of `correction`), and Φ̇.
    pub fn velocity(&self) -> &Tape {
        &self.lowered.kernels[VELOCITY]
    }

    /// Correction of accelerations and multipliers.
    pub fn acceleration(&self) -> &Tape {
        &self.lowered.kernels[ACCELERATION]
    }

    /// Correction of the velocities of a motion (first n of `correction`): impulses of the constraints that make them
    /// consistent.
    pub fn projection(&self) -> &Tape {
        &self.lowered.kernels[PROJECTION]
    }

    /// Outputs of the state.
    pub fn observe(&self) -> &Tape {
        &self.lowered.kernels[OBSERVE]
    }

    /// Φ_q.
    pub fn jacobian(&self) -> &Tape {
        &self.lowered.kernels[JACOBIAN]
    }
}

/// A value to compute, and the register that it must have, if any.
type Target = (Expr, Option<u32>);

/// Compiles the start of a system. `redundant` are constraints that others imply, as far as known; `sample` is a state near
/// the start (values of the layout's registers).
///
/// # Errors
/// Where the equations have no finite values at the sample (rows: motion, constraints, then start conditions), and where
/// the graph is full.
pub fn compile_start(system: &System, redundant: &[usize], sample: &[f64]) -> Result<StartProgram, NoFactors> {
    let layout = Layout::new(system.parameters.len(), system.q.len(), system.lambda.len());
    let inputs = layout.inputs(system);
    let mut graph = system.graph.clone();
    let equations = Equations::new(system, &mut graph);
    let mut builder = Builder { system, graph, inputs: &inputs, redundant, sample };
    let [position, velocity, acceleration, projection] = builder.corrections(&equations)?;
    let graph = builder.graph;

    let at = |values: &[Expr], start: usize| -> Vec<Target> {
        values.iter().zip(start..).map(|(&value, register)| (value, Some(register as u32))).collect()
    };
    let with = |correction: &[Expr], further: &[Expr]| {
        let mut targets = at(correction, layout.correction.start);
        targets.extend(further.iter().map(|&value| (value, None)));
        targets
    };
    let n = system.q.len();
    let jacobian = &equations.jacobian;
    let kernels = [
        given_values(system, &layout),
        at(&system.start.guess, layout.q.start),
        with(&position[..n], &equations.closure),
        with(&velocity[..n], &equations.closure_rate),
        with(&acceleration, &[]),
        jacobian.entries().map(|(_, _, value)| (value, None)).collect(),
        system.outputs.iter().map(|output| (output.expr, None)).collect(),
        with(&projection[..n], &[]),
    ];
    let lowered = lower(&graph, &inputs, 1, layout.registers() as u32, &kernels);
    let tail = |kernel: usize, skip: usize| {
        lowered.outputs[kernel].iter().skip(skip).map(|&register| register as usize).collect::<Vec<_>>()
    };
    let jacobian_entries =
        jacobian.entries().zip(tail(JACOBIAN, 0)).map(|((row, column, _), register)| (row, column, register)).collect();
    Ok(StartProgram {
        constraint: tail(POSITION, n),
        constraint_rate: tail(VELOCITY, n),
        outputs: tail(OBSERVE, 0),
        jacobian_entries,
        layout,
        lowered,
    })
}

/// Positions and velocities that are given at the start, in the registers of the state.
fn given_values(system: &System, layout: &Layout) -> Vec<Target> {
    let mut given = Vec::new();
    for (values, block) in [(&system.start.position, &layout.q), (&system.start.velocity, &layout.v)] {
        given.extend(
            values.iter().zip(block.clone()).filter_map(|(value, register)| value.map(|v| (v, Some(register as u32)))),
        );
    }
    given
}

/// The equations that hold at the start.
struct Equations {
    /// M w + Φ_qᵀ λ − Q.
    motion: Vec<Expr>,
    /// Φ_q.
    jacobian: SparseMatrix,
    /// Φ, then the conditions on positions; and its derivatives by q.
    closure: Vec<Expr>,
    closure_jacobian: SparseMatrix,
    /// Φ̇, then the rates of the conditions on velocities; and its derivatives by v.
    closure_rate: Vec<Expr>,
    closure_rate_jacobian: SparseMatrix,
    /// Φ̈.
    rate_of_rate: Vec<Expr>,
}

/// Conditions on positions.
const OF_POSITION: Kind = |condition| condition.position;
/// Conditions on velocities.
const OF_VELOCITY: Kind = |condition| condition.velocity;

impl Equations {
    fn new(system: &System, graph: &mut Graph) -> Self {
        let (motion, jacobian) = equations_of_motion(system, graph);
        let rate = time_derivative(system, graph, &system.constraint);
        let rate_of_rate = time_derivative(system, graph, &rate);
        let (further, closure_jacobian) = with_conditions(system, graph, &jacobian, OF_POSITION);
        let closure = [&system.constraint[..], &further].concat();
        let (further, closure_rate_jacobian) = with_conditions(system, graph, &jacobian, OF_VELOCITY);
        let closure_rate = [rate, time_derivative(system, graph, &further)].concat();
        Self { motion, jacobian, closure, closure_jacobian, closure_rate, closure_rate_jacobian, rate_of_rate }
    }
}

/// Conditions on positions, or those on velocities.
type Kind = fn(&StartCondition) -> bool;

/// Renumbers the rows of conditions of a kind, which follow the constraints, by their numbers among all conditions.
fn numbered(system: &System, none: NoFactors, kind: Kind) -> NoFactors {
    let NoFactors::Singular { rows } = none else { return none };
    let first = system.q.len() + system.constraint.len();
    let conditions: Vec<usize> =
        (0..system.start.conditions.len()).filter(|&place| kind(&system.start.conditions[place])).collect();
    let row = |row: usize| if row < first { row } else { first + conditions[row - first] };
    NoFactors::Singular { rows: rows.into_iter().map(row).collect() }
}

/// The conditions of a kind, and Φ_q with their derivatives below it.
fn with_conditions(
    system: &System,
    graph: &mut Graph,
    jacobian: &SparseMatrix,
    kind: Kind,
) -> (Vec<Expr>, SparseMatrix) {
    let conditions = system.start.conditions.iter().filter(|condition| kind(condition));
    let values: Vec<Expr> = conditions.map(|condition| condition.value).collect();
    let mut all = jacobian.clone();
    all.rows.extend(graph.jacobian(&values, &system.q).rows);
    (values, all)
}

struct Builder<'s> {
    system: &'s System,
    graph: Graph,
    inputs: &'s [Input],
    redundant: &'s [usize],
    sample: &'s [f64],
}

impl Builder<'_> {
    /// The corrections of positions, of velocities, of accelerations with multipliers, and of a motion's velocities.
    fn corrections(&mut self, equations: &Equations) -> Result<[Vec<Expr>; 4], NoFactors> {
        let system = self.system;
        let n = system.q.len();
        let metric: Vec<f64> = system.coordinates.iter().map(|coordinate| coordinate.scale.powi(-2)).collect();
        let diagonal: Vec<(usize, usize, Expr)> =
            metric.iter().enumerate().map(|(i, &weight)| (i, i, self.graph.constant(weight))).collect();
        let given = |values: &[Option<Expr>]| values.iter().map(Option::is_some).collect::<Vec<bool>>();
        let zero = vec![self.graph.constant(0.0); n];
        let none = SparseMatrix::zero(n, system.lambda.len());
        let Equations { closure, closure_jacobian, closure_rate, closure_rate_jacobian, .. } = equations;
        let position = self
            .correction(&diagonal, &none, closure_jacobian, &given(&system.start.position), &zero, closure)
            .map_err(|none| numbered(system, none, OF_POSITION))?;
        let velocity = self
            .correction(&diagonal, &none, closure_rate_jacobian, &given(&system.start.velocity), &zero, closure_rate)
            .map_err(|none| numbered(system, none, OF_VELOCITY))?;
        let by_multiplier = self.graph.jacobian(&system.force, &system.lambda);
        let Equations { jacobian, rate_of_rate, .. } = equations;
        let (mass, motion) = self.with_defined_coordinates(jacobian, equations.motion.clone(), rate_of_rate);
        let free = vec![false; n];
        let acceleration = self.correction(&mass, &by_multiplier, jacobian, &free, &motion, rate_of_rate)?;
        let rate = &closure_rate[..system.lambda.len()];
        let (mass, motion) = self.with_defined_coordinates(jacobian, zero, rate);
        let projection = self.correction(&mass, &none, jacobian, &free, &motion, rate)?;
        Ok([position, velocity, acceleration, projection])
    }

    /// Solution of [metric Φ_qᵀ − `by_multiplier`; Φ_q −ε] (δ, μ) = −(first, second), n + rows of Φ; given coordinates have
    /// δ = 0.
    fn correction(
        &mut self,
        metric: &[(usize, usize, Expr)],
        by_multiplier: &SparseMatrix,
        jacobian: &SparseMatrix,
        given: &[bool],
        first: &[Expr],
        second: &[Expr],
    ) -> Result<Vec<Expr>, NoFactors> {
        let (n, m) = (self.system.q.len(), jacobian.rows.len());
        let (one, mut matrix) = (self.graph.constant(1.0), SparseMatrix::zero(n + m, n + m));
        for &(row, column, value) in metric.iter().filter(|(row, column, _)| !given[*row] && !given[*column]) {
            matrix.add(&mut self.graph, row, column, value);
        }
        for (row, column, value) in jacobian.entries().filter(|(_, column, _)| !given[*column]) {
            matrix.add(&mut self.graph, n + row, column, value);
            matrix.add(&mut self.graph, column, n + row, value);
        }
        for (row, column, value) in by_multiplier.entries() {
            let value = self.graph.neg(value);
            matrix.add(&mut self.graph, row, n + column, value);
        }
        for coordinate in (0..n).filter(|&coordinate| given[coordinate]) {
            matrix.add(&mut self.graph, coordinate, coordinate, one);
        }
        let numbers = self.numbers(&matrix);
        let sizes = self.constraint_sizes(&matrix, &numbers, n);
        let mut scale = vec![1.0; n + m];
        for (constraint, size) in sizes.into_iter().enumerate() {
            let relaxed = self.redundant.contains(&constraint);
            let value = self.graph.constant(-size * if relaxed { RELAXATION } else { REGULARISATION });
            matrix.add(&mut self.graph, n + constraint, n + constraint, value);
            scale[n + constraint] = size.sqrt().recip();
        }
        let numbers = self.numbers(&matrix);
        for (place, (row, column, _)) in matrix.entries().enumerate() {
            if row == column && row < n {
                scale[row] = numbers[place][0].abs().sqrt().recip();
            }
        }
        let stages = Stages::new(self.inputs);
        let factors =
            factorise(&mut self.graph, &matrix, &numbers, &scale, stages, 1, Pivoting::Diagonal { constraints: n })?;
        let mut right: Vec<Expr> = first.iter().chain(second).map(|&value| self.graph.neg(value)).collect();
        let zero = self.graph.constant(0.0);
        given.iter().zip(&mut right).filter(|(given, _)| **given).for_each(|(_, value)| *value = zero);
        Ok(factors.solve(&mut self.graph, &right))
    }

    /// M and the equations of motion, augmented by the constraints that define massless coordinates. μ gives the defined
    /// coordinate about the mass of those that define it.
    fn with_defined_coordinates(
        &mut self,
        jacobian: &SparseMatrix,
        mut motion: Vec<Expr>,
        rate_of_rate: &[Expr],
    ) -> (Vec<(usize, usize, Expr)>, Vec<Expr>) {
        let mut mass = self.system.mass.clone();
        let mut diagonal = vec![0.0; self.system.q.len()];
        let entries: Vec<Expr> = mass.iter().map(|&(_, _, value)| value).collect();
        for (&(row, column, _), value) in mass.iter().zip(self.at_sample(&entries)) {
            if row == column {
                diagonal[row] = value;
            }
        }
        for (constraint, derivatives) in jacobian.rows.iter().enumerate() {
            let defines = derivatives.iter().any(|&(column, _)| diagonal[column] == 0.0);
            let weight = derivatives.iter().fold(0.0, |largest: f64, &(column, _)| largest.max(diagonal[column]));
            if !defines || weight == 0.0 {
                continue;
            }
            for &(row, derivative) in derivatives {
                let weighted = self.graph.scale(weight, derivative);
                let residual = self.graph.mul(weighted, rate_of_rate[constraint]);
                motion[row] = self.graph.add(motion[row], residual);
                for &(column, other) in derivatives {
                    mass.push((row, column, self.graph.mul(weighted, other)));
                }
            }
        }
        (mass, motion)
    }

    /// Values at the sample.
    fn at_sample(&self, exprs: &[Expr]) -> Vec<f64> {
        let register_of: rustc_hash::FxHashMap<Expr, usize> =
            self.inputs.iter().map(|input| (input.symbol, input.register as usize)).collect();
        self.graph.evaluate(exprs, |symbol| self.sample[register_of[&symbol]])
    }

    fn numbers(&self, matrix: &SparseMatrix) -> Vec<Numbers> {
        let entries: Vec<Expr> = matrix.entries().map(|(_, _, value)| value).collect();
        self.at_sample(&entries).into_iter().map(|value| [value; PIVOT_SAMPLES]).collect()
    }

    /// Σ Φ_ki² / metric_ii: a constraint's own entry in Φ_q metric⁻¹ Φ_qᵀ; 1 where nothing of it is left.
    fn constraint_sizes(&self, matrix: &SparseMatrix, numbers: &[Numbers], n: usize) -> Vec<f64> {
        let mut diagonal = vec![1.0; n];
        let mut sizes = vec![0.0; matrix.rows.len() - n];
        let entries = || matrix.entries().zip(numbers).map(|((row, column, _), number)| (row, column, number[0]));
        entries().filter(|&(row, column, _)| row == column).for_each(|(row, _, value)| diagonal[row] = value);
        entries().filter(|&(row, column, _)| row >= n && column < n).for_each(|(row, column, value)| {
            sizes[row - n] += value * value / diagonal[column];
        });
        sizes.into_iter().map(|size| if size > 0.0 { size } else { 1.0 }).collect()
    }
}
