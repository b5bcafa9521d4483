//! The start as tapes: Gauss–Newton corrections of positions, velocities, accelerations and multipliers that make them
//! fulfil the constraints.
//!
//! ```text
//! positions       [ D  Φ_qᵀ ] [δq]   [ 0 ]        velocities      the same matrix,  right side −(Φ_q v + Φ_t)
//!                 [ Φ_q  −ε ] [μ ] = [−Φ ]
//! accelerations   [ M  Φ_qᵀ − Q_λ ] [δw]     [ M w + Φ_qᵀ λ − Q ]
//!                 [ Φ_q     −ε    ] [δλ] = − [ Φ̈(q, v, w, t)    ]
//! ```
//!
//! Velocity constraints Ψ are below Φ̇ and Φ̈, with Ψ_v below Φ_q; positions know nothing of them.
//!
//! Velocities of a motion, which nothing gives, are corrected with M instead of D: as by impulses of constraint forces.
//!
//! Q_λ is nonzero where friction depends on reactions; the corrections are then Newton's.
//!
//! A massless coordinate has no pivot in M. Where a constraint k defines it by massive ones, and its derivative by it
//! cannot vanish (the angle of a joint), the two are eliminated as a pair, without ε. Where it may vanish, both sides
//! are augmented: μ Φ_kᵀ Φ_k is added to M and μ Φ_kᵀ Φ̈_k to the equations of motion, which changes nothing where Φ̈ =
//! 0, but couples the coordinates that k couples.
//!
//! Where positions or velocities are left open, D gives way to the least squares of [`super::nearest`].
//!
//! For positions and velocities, Φ has further rows: the conditions of the start ([`crate::assemble::StartCondition`]).
//!
//! D = diag(1/scale²) minimises the change of the coordinates that are not given; given ones have no column. ε > 0
//! makes the matrices quasi-definite (Vanderbei, SIAM J. Optim. 5 (1995) 100): every diagonal elimination order
//! exists, also where constraints are redundant, and the corrections still converge to the exact solution, since the
//! right sides are exact.

use symdiff::{Expr, Graph, Input, SparseMatrix, Stages, lower, with_reciprocals};

use super::at_sample::AtSample;
use super::equations::Equation;
use super::layout::Layout;
use super::links::{self, MassOfLinks};
use super::nearest::{LeastSquares, OpenStart};
use super::sparse_lu::{NoFactors, Numbers, PivotRule, Pivoting, factorise};
use super::start_equations::{ClosureOf, StartEquations, constraint_sizes, given_values, named, residuals};
use super::start_factors::Factorised;
use super::start_program::{JACOBIAN, OBSERVE, POSITION, SAMPLING, SampledValue, StartProgram, VELOCITY};
use crate::assemble::{ConstraintId, System};
use crate::compile::tuning::TUNING;

/// A value to compute, and the register that it must have, if any.
type Target = (Expr, Option<u32>);

/// Compiles the start of a system. `redundant` are constraints that others imply, as far as known; `sample` is a state
/// near the start (values of the layout's registers).
///
/// # Errors
/// Where the equations have no finite values at the sample, and where the graph is full.
pub fn compile_start(
    system: &System,
    redundant: &[ConstraintId],
    sample: &[f64],
) -> Result<StartProgram, NoFactors<Equation>> {
    compile_nearest_start(system, redundant, sample, OpenStart::default())
}

/// The same where the start is left open: it is then the one nearest to rest.
///
/// # Errors
/// As for [`compile_start`].
pub fn compile_nearest_start(
    system: &System,
    redundant: &[ConstraintId],
    sample: &[f64],
    open: OpenStart,
) -> Result<StartProgram, NoFactors<Equation>> {
    let layout = Layout::of(system);
    let inputs = layout.inputs(system);
    let mut graph = match &system.start.nearest {
        Some(nearest) if open.is_any() => nearest.graph.as_ref().unwrap_or(&system.graph).clone(),
        _ => system.graph.clone(),
    };
    let equations = StartEquations::new(system, &mut graph);
    let at_sample = AtSample::new(&inputs, sample);
    let masses = at_sample.masses(system);
    let mut builder =
        Builder { system, graph, inputs: &inputs, redundant, at_sample, masses, factorised: Vec::new(), linked: None };
    let [position, velocity, acceleration, projection] = builder.corrections(&equations, open)?;
    let mut graph = builder.graph;

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
    let mut kernels = [
        given_values(system, &layout),
        at(&system.start.guess, layout.q.start),
        with(&position[..n], &equations.closure),
        with(&velocity[..n], &equations.closure_rate),
        with(&acceleration, &[]),
        jacobian.entries().map(|(_, _, value)| (value, None)).collect(),
        system.outputs.iter().map(|output| (output.expr, None)).collect(),
        with(&projection[..n], &[]),
        system.sampled.iter().map(|sampled| (sampled.value, None)).collect(),
    ];
    let values: Vec<Expr> = kernels.iter().flatten().map(|&(value, _)| value).collect();
    let replaced = with_reciprocals(&mut graph, &inputs, &values);
    kernels.iter_mut().flatten().zip(replaced).for_each(|(target, value)| target.0 = value);
    let lowered = lower(&graph, &inputs, 1, layout.registers() as u32, &kernels);
    let tail = |kernel: usize, skip: usize| {
        lowered.outputs[kernel].iter().skip(skip).map(|&register| register as usize).collect::<Vec<_>>()
    };
    let jacobian_entries =
        jacobian.entries().zip(tail(JACOBIAN, 0)).map(|((row, column, _), register)| (row, column, register)).collect();
    Ok(StartProgram {
        constraint: residuals(system, ClosureOf::Positions, tail(POSITION, n)),
        constraint_rate: residuals(system, ClosureOf::Velocities, tail(VELOCITY, n)),
        outputs: tail(OBSERVE, 0),
        sampled: SampledValue::all(system, &layout, tail(SAMPLING, 0)),
        jacobian_entries,
        open,
        layout,
        lowered,
    })
}

/// Known properties of a correction's matrix.
#[derive(Clone, Copy)]
struct Known<'m> {
    /// Coordinates that do not change.
    given: &'m [bool],
    /// Number of constraints among the rows below the metric.
    constraints: usize,
    /// Coordinates and the constraints that define them.
    pairs: &'m [(usize, usize)],
    /// Whether the metric couples coordinates of different bodies.
    is_coupled: bool,
    /// Whether the metric is M.
    is_mass: bool,
}

struct Builder<'s> {
    system: &'s System,
    graph: Graph,
    inputs: &'s [Input],
    redundant: &'s [ConstraintId],
    at_sample: AtSample<'s>,
    /// The diagonal of M at the sample.
    masses: Vec<f64>,
    factorised: Vec<Factorised>,
    /// M by the values of links, once it is known to be shorter.
    linked: Option<MassOfLinks>,
}

impl Builder<'_> {
    /// The corrections of positions, of velocities, of accelerations with multipliers, and of a motion's velocities.
    fn corrections(
        &mut self,
        equations: &StartEquations,
        open: OpenStart,
    ) -> Result<[Vec<Expr>; 4], NoFactors<Equation>> {
        let system = self.system;
        let n = system.q.len();
        let smallest = LeastSquares::smallest_change(system, &mut self.graph);
        let positions = open.positions.then(|| LeastSquares::of_positions(system, &mut self.graph));
        let velocities = open.velocities.then(|| LeastSquares::of_velocities(system, &mut self.graph));
        let [positions, velocities] = [&positions, &velocities].map(|open| open.as_ref().unwrap_or(&smallest));
        let given = |values: &[Option<Expr>]| values.iter().map(Option::is_some).collect::<Vec<bool>>();
        let none = SparseMatrix::zero(n, system.lambda.len());
        let StartEquations { closure, closure_jacobian, closure_rate, closure_rate_jacobian, .. } = equations;
        let position = self
            .correction(
                &positions.metric,
                &none,
                closure_jacobian,
                Known {
                    given: &given(&system.start.position),
                    constraints: ClosureOf::Positions.constraints(system),
                    pairs: &[],
                    is_coupled: positions.is_coupled,
                    is_mass: false,
                },
                &positions.gradient,
                closure,
            )
            .map_err(|none| named(system, none, ClosureOf::Positions))?;
        let velocity = self
            .correction(
                &velocities.metric,
                &none,
                closure_rate_jacobian,
                Known {
                    given: &given(&system.start.velocity),
                    constraints: ClosureOf::Velocities.constraints(system),
                    pairs: &[],
                    is_coupled: velocities.is_coupled,
                    is_mass: false,
                },
                &velocities.gradient,
                closure_rate,
            )
            .map_err(|none| named(system, none, ClosureOf::Velocities))?;
        let by_multiplier = self.graph.jacobian(&system.force, &system.lambda);
        let StartEquations { jacobian, rate_of_rate, .. } = equations;
        let pairs = self.pairs(jacobian);
        let elimination = links::elimination(system, !self.redundant.is_empty() || !pairs.is_empty());
        let entries = match elimination {
            links::LinkElimination::Links => Vec::new(),
            links::LinkElimination::Whole | links::LinkElimination::Shorter => system.mass_entries(&mut self.graph),
        };
        let motion = equations.motion.clone();
        let (mass, motion) = self.with_defined_coordinates(jacobian, entries.clone(), motion, rate_of_rate, &pairs);
        let free = vec![false; n];
        let constraints = system.lambda.len();
        let of_masses = Known { given: &free, constraints, pairs: &pairs, is_coupled: false, is_mass: true };
        let of_motion = |none: NoFactors| none.named(|row| Equation::of_row(row, n));
        let solve = |builder: &mut Self| {
            builder.correction(&mass, &by_multiplier, jacobian, of_masses, &motion, rate_of_rate).map_err(of_motion)
        };
        let acceleration = match elimination {
            links::LinkElimination::Whole => solve(self)?,
            links::LinkElimination::Links => {
                self.linked = Some(MassOfLinks::new(system, &mut self.graph));
                solve(self)?
            }
            links::LinkElimination::Shorter => {
                let before = (self.graph.clone(), self.factorised.len());
                let whole = solve(self)?;
                let operations = self.graph.reachable(&whole).len();
                let with_whole = std::mem::replace(&mut self.graph, before.0);
                self.factorised.truncate(before.1);
                self.linked = Some(MassOfLinks::new(system, &mut self.graph));
                match solve(self) {
                    Ok(by_links) if self.graph.reachable(&by_links).len() < operations => by_links,
                    _ => {
                        (self.graph, self.linked) = (with_whole, None);
                        whole
                    }
                }
            }
        };
        let zero = vec![self.graph.constant(0.0); n];
        let (mass, motion) = self.with_defined_coordinates(jacobian, entries, zero, &equations.rate, &pairs);
        let projection =
            self.correction(&mass, &none, jacobian, of_masses, &motion, &equations.rate).map_err(of_motion)?;
        Ok([position, velocity, acceleration, projection])
    }

    /// Solution of [metric Φ_qᵀ − `by_multiplier`; Φ_q −ε] (δ, μ) = −(first, second), n + rows of Φ; given coordinates
    /// have δ = 0.
    fn correction(
        &mut self,
        metric: &[(usize, usize, Expr)],
        by_multiplier: &SparseMatrix,
        jacobian: &SparseMatrix,
        Known { given, constraints, pairs, is_coupled, is_mass }: Known,
        first: &[Expr],
        second: &[Expr],
    ) -> Result<Vec<Expr>, NoFactors> {
        let (n, m) = (self.system.q.len(), jacobian.rows.len());
        let one = self.graph.constant(1.0);
        let of_links = self.linked.clone().filter(|_| is_mass);
        let whole = if of_links.is_some() { &[] } else { metric };
        let MassOfLinks { mut matrix, first: pivots } =
            of_links.unwrap_or_else(|| MassOfLinks { matrix: SparseMatrix::zero(n + m, n + m), first: Vec::new() });
        for &(row, column, value) in whole.iter().filter(|(row, column, _)| !given[*row] && !given[*column]) {
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
        let mut diagonal = if pivots.is_empty() { vec![1.0; n] } else { self.masses.clone() };
        for ((row, column, _), numbers) in matrix.entries().zip(&numbers).filter(|_| pivots.is_empty()) {
            if row == column && row < n {
                diagonal[row] = numbers[0];
            }
        }
        let sizes = constraint_sizes(&matrix, &numbers, &diagonal, m);
        let mut scale = vec![1.0; matrix.rows.len()];
        for (constraint, size) in sizes.into_iter().enumerate() {
            let relaxed = constraint < constraints && self.redundant.contains(&ConstraintId::new(constraint));
            if pairs.iter().all(|&(_, paired)| paired != constraint) {
                let value =
                    self.graph.constant(-size * if relaxed { TUNING.relaxation } else { TUNING.regularisation });
                matrix.add(&mut self.graph, n + constraint, n + constraint, value);
            }
            scale[n + constraint] = size.sqrt().recip();
        }
        let numbers = self.numbers(&matrix);
        for (scale, size) in scale.iter_mut().zip(&diagonal) {
            *scale = size.abs().sqrt().recip();
        }
        let pairs: Vec<(usize, usize)> = pairs.iter().map(|&(row, constraint)| (row, n + constraint)).collect();
        // Where the metric couples coordinates along a chain, all of them before the first constraint would couple
        // every pair of constraints. Few may be.
        let late = if is_coupled && n > TUNING.start_coordinates { n + m } else { n };
        let known = self.factorised.iter().position(|known| known.is_of(&matrix, &pairs, late));
        let known = match known {
            Some(known) => known,
            None => {
                let pivoting = Pivoting::Diagonal { constraints: late, pairs: &pairs };
                let rule = PivotRule { stages: Stages::new(self.inputs), costly: 1, pivoting };
                let factors = factorise(&mut self.graph, &matrix, &numbers, &scale, &pivots, rule)?;
                self.factorised.push(Factorised { matrix, pairs, late, factors });
                self.factorised.len() - 1
            }
        };
        let mut right: Vec<Expr> = first.iter().chain(second).map(|&value| self.graph.neg(value)).collect();
        let zero = self.graph.constant(0.0);
        given.iter().zip(&mut right).filter(|(given, _)| **given).for_each(|(_, value)| *value = zero);
        let Factorised { matrix, factors, .. } = &self.factorised[known];
        right.resize(matrix.rows.len(), zero);
        let mut solution = factors.solve(&mut self.graph, &right);
        solution.truncate(n + m);
        Ok(solution)
    }

    /// Massless coordinates with the constraints that define them by massive ones, where the derivative by them cannot
    /// vanish.
    fn pairs(&self, jacobian: &SparseMatrix) -> Vec<(usize, usize)> {
        let diagonal = &self.masses;
        let mut taken = vec![false; diagonal.len()];
        let mut pairs = Vec::new();
        for (constraint, derivatives) in jacobian.rows.iter().enumerate() {
            let mut massless = derivatives.iter().filter(|&&(column, _)| diagonal[column] == 0.0);
            let (Some(&(column, derivative)), None) = (massless.next(), massless.next()) else { continue };
            // A joint's coordinate and the constraint that measures it have one name; the derivative is −1 wherever
            // that is closed.
            let names = (&self.system.constraints[constraint].name, &self.system.coordinates[column].name);
            let is_measured = names.0 == names.1;
            let is_number = self.graph.as_constant(derivative).is_some_and(|number| number != 0.0);
            let may_be_pivot = is_number || is_measured;
            let is_defined =
                derivatives.len() > 1 && may_be_pivot && !self.redundant.contains(&ConstraintId::new(constraint));
            if is_defined && !std::mem::replace(&mut taken[column], true) {
                pairs.push((column, constraint));
            }
        }
        pairs
    }

    /// M and the equations of motion, augmented by the constraints that define massless coordinates. μ gives the
    /// defined coordinate about the mass of those that define it.
    fn with_defined_coordinates(
        &mut self,
        jacobian: &SparseMatrix,
        mut mass: Vec<(usize, usize, Expr)>,
        mut motion: Vec<Expr>,
        rate_of_rate: &[Expr],
        pairs: &[(usize, usize)],
    ) -> (Vec<(usize, usize, Expr)>, Vec<Expr>) {
        let diagonal = &self.masses;
        let mut paired = vec![false; jacobian.rows.len()];
        pairs.iter().for_each(|&(_, constraint)| paired[constraint] = true);
        for (constraint, derivatives) in jacobian.rows.iter().enumerate().filter(|(constraint, _)| !paired[*constraint])
        {
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

    fn numbers(&self, matrix: &SparseMatrix) -> Vec<Numbers> {
        let entries: Vec<Expr> = matrix.entries().map(|(_, _, value)| value).collect();
        self.at_sample.values(&self.graph, &entries).into_iter().map(|value| [value; TUNING.pivot_samples]).collect()
    }
}
