//! The Newton matrix's factors as a step uses them: frozen between factorisations, in one version or in two.
//!
//! Conditional effects (contacts, stops) couple coordinates that nothing else couples, so that elimination has more to
//! do, and entries that were constant change with the iterate. Where it saves enough, the matrix is eliminated twice:
//! with conditional effects active, and with them inactive. The iterate of each lane at its factorisation decides
//! which version solves for its corrections, so its numbers do not depend on the lanes that share its tile. Values
//! that no lane of a tile needs are not computed.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph, Guard, Input, SparseMatrix, Stages};

use super::newton_matrix::ITERATION;
use super::program::{FactorMode, WatchedPivot, WatchedPivots};
use super::sparse_lu::{Factors, NoFactors, Numbers, PivotRule, Pivoting, factorise};
use crate::assemble::ConstraintId;
use crate::compile::tuning::TUNING;

/// Rule for the choice of pivots.
#[derive(Clone, Copy, Debug)]
pub(super) struct PivotChoice<'a> {
    /// Constraints that others imply.
    pub redundant: &'a [ConstraintId],
    /// Pivots that cannot vanish.
    pub symmetric: Pivoting<'a>,
    /// Whether only those are allowed.
    pub spatial: bool,
    /// Number of coordinates.
    pub n: usize,
    /// Pivots (row, column) before all others, of links.
    pub first: &'a [(usize, usize)],
}

/// A matrix's factors, and the scaling of its rows and columns by which pivots were compared.
#[derive(Clone, Debug)]
pub(super) struct Version {
    pub factors: Factors,
    pub equilibration: Vec<f64>,
}

impl PivotChoice<'_> {
    /// Factorises a Newton matrix, whose entries have these numbers at the pivot samples.
    ///
    /// # Errors
    /// Where the matrix has no acceptable pivots, and where the graph is full.
    pub fn factorise(
        &self,
        graph: &mut Graph,
        matrix: &SparseMatrix,
        numbers: &[Numbers],
        equilibration: Vec<f64>,
        inputs: &[Input],
    ) -> Result<Version, NoFactors> {
        let (regular, numbers) = self.regularised(graph, matrix, numbers, &equilibration);
        let plan = |graph: &mut Graph, pivoting: Pivoting| {
            let factorised = |graph: &mut Graph, numbers: &[Numbers]| {
                let rule = PivotRule { stages: Stages::new(inputs), costly: ITERATION, pivoting };
                factorise(graph, &regular, numbers, &equilibration, self.first, rule)
            };
            // A singular start has no pivots of its own: then the states in general position decide.
            factorised(graph, &numbers).or_else(|_| {
                let mut without_start = numbers.clone();
                without_start.iter_mut().for_each(|numbers| numbers[0] = numbers[1]);
                factorised(graph, &without_start)
            })
        };
        let only_symmetric = self.spatial || !self.first.is_empty();
        let factors = match plan(graph, if only_symmetric { self.symmetric } else { Pivoting::Any }) {
            Ok(factors) if factors.growth <= TUNING.growth || only_symmetric => Ok(factors),
            // In a long chain, freely chosen pivots amplify errors from body to body.
            free => plan(graph, self.symmetric).or(free),
        }?;
        // A full graph means that the symmetric attempt was cut short: the factors at hand are not the ones wanted.
        if graph.is_full() { Err(NoFactors::TooLong) } else { Ok(Version { factors, equilibration }) }
    }

    /// The matrix and its numbers with the multipliers of redundant constraints regularised, whose pivots would be
    /// zero. The residual stays as it is.
    fn regularised(
        &self,
        graph: &mut Graph,
        matrix: &SparseMatrix,
        numbers: &[Numbers],
        equilibration: &[f64],
    ) -> (SparseMatrix, Vec<Numbers>) {
        let (mut regular, mut numbers) = (matrix.clone(), numbers.to_vec());
        for &constraint in self.redundant {
            let row = self.n + constraint.number();
            let weight = TUNING.redundant_weight / (equilibration[row] * equilibration[row]);
            let index = matrix.rows[..row].iter().map(Vec::len).sum::<usize>() + regular.rows[row].len();
            let offset = regular.nonzeros() - matrix.nonzeros();
            let value = graph.constant(-weight);
            debug_assert!(
                regular.rows[row].iter().all(|&(column, _)| column < row),
                "a constraint's row ends before its own multiplier"
            );
            regular.rows[row].push((row, value));
            numbers.insert(index + offset, [-weight; TUNING.pivot_samples]);
        }
        (regular, numbers)
    }
}

/// Frozen factors in one version or two; the corrections refer to them by symbols of their own.
pub(super) struct Elimination {
    /// The values that the factorisation computes, and the registers in which they are stored.
    pub frozen: Vec<(Expr, Option<u32>)>,
    /// Values that only one version needs.
    pub guards: FxHashMap<Expr, Guard>,
    /// Pivots that can become small.
    pub watched: Vec<WatchedPivots>,
    /// The matrix's factors; of two versions, those of active conditional effects.
    pub active: Version,
    /// The same over frozen values.
    frozen_active: Factors,
    /// The frozen condition, and the frozen factors of inactive conditional effects.
    inactive: Option<(Expr, Factors)>,
}

impl Elimination {
    /// Freezes one version of factors, or two with the condition that decides between them. Registers are taken from
    /// `next` on.
    pub fn new(
        graph: &mut Graph,
        inputs: &mut Vec<Input>,
        next: &mut u32,
        active: Version,
        inactive: Option<(Expr, Version)>,
    ) -> Self {
        let mut freezer = Freezer::new(graph, inputs, next);
        let Some((condition, inactive)) = inactive else {
            let frozen_active = freezer.freeze(&active.factors, None);
            let watched = vec![WatchedPivots { mode: None, pivots: freezer.watch(&active) }];
            let Freezer { frozen, guards, .. } = freezer;
            return Self { frozen, guards, watched, active, frozen_active, inactive: None };
        };
        let guards = [false, true].map(|elsewhere| Guard { condition, elsewhere });
        let frozen_active = freezer.freeze(&active.factors, Some(guards[0]));
        let frozen_inactive = freezer.freeze(&inactive.factors, Some(guards[1]));
        let frozen_condition = freezer.frozen_value(condition);
        let (_, register) = freezer.symbol_of[&condition];
        let watched = [(&active, false), (&inactive, true)].map(|(version, inactive)| {
            let mode = Some(FactorMode { register: register as usize, inactive });
            WatchedPivots { mode, pivots: freezer.watch(version) }
        });
        let watched = watched.into();
        let Freezer { frozen, guards, .. } = freezer;
        Self { frozen, guards, watched, active, frozen_active, inactive: Some((frozen_condition, frozen_inactive)) }
    }

    /// The solution of matrix · x = `right`.
    pub fn solve(&self, graph: &mut Graph, right: &[Expr]) -> Vec<Expr> {
        let mut solution = self.frozen_active.solve(graph, right);
        if let Some((condition, factors)) = &self.inactive {
            let inactive = factors.solve(graph, right);
            for (value, inactive) in solution.iter_mut().zip(inactive) {
                *value = graph.select(*condition, *value, inactive);
            }
        }
        solution
    }
}

/// Whether a version of its own saves enough where conditional effects are inactive.
pub(super) fn is_worthwhile(graph: &Graph, inputs: &[Input], active: &Version, inactive: &Version) -> bool {
    let mut stages = Stages::new(inputs);
    stages.update(graph);
    let [active, inactive] = [active, inactive].map(|version| {
        let values: Vec<Expr> = version.factors.values().collect();
        let changing = graph.reachable(&values).into_iter().filter(|&expr| stages.of(expr) == Some(ITERATION)).count();
        // A solution takes an operation for each value, whether it changes or not.
        (changing + values.len()) as f64
    });
    inactive <= TUNING.second_version * active
}

/// Replaces factors that the iteration can change by symbols for their values at the factorisation.
struct Freezer<'g> {
    graph: &'g mut Graph,
    inputs: &'g mut Vec<Input>,
    next: &'g mut u32,
    stages: Stages,
    symbol_of: FxHashMap<Expr, (Expr, u32)>,
    frozen: Vec<(Expr, Option<u32>)>,
    guards: FxHashMap<Expr, Guard>,
}

impl<'g> Freezer<'g> {
    fn new(graph: &'g mut Graph, inputs: &'g mut Vec<Input>, next: &'g mut u32) -> Self {
        let stages = Stages::new(inputs);
        let (symbol_of, guards) = (FxHashMap::default(), FxHashMap::default());
        Self { graph, inputs, next, stages, symbol_of, frozen: Vec::new(), guards }
    }

    fn changes(&mut self, value: Expr) -> bool {
        self.stages.update(self.graph);
        self.stages.of(value) == Some(ITERATION)
    }

    /// The value at the factorisation, as a symbol if the iteration can change it.
    fn frozen_value(&mut self, value: Expr) -> Expr {
        if !self.changes(value) {
            return value;
        }
        if let Some(&(symbol, _)) = self.symbol_of.get(&value) {
            return symbol;
        }
        let symbol = self.graph.symbol(&format!("factor:{}", self.frozen.len()));
        let register = *self.next;
        *self.next += 1;
        self.inputs.push(Input { symbol, stage: ITERATION, register });
        self.frozen.push((value, Some(register)));
        self.symbol_of.insert(value, (symbol, register));
        symbol
    }

    fn freeze(&mut self, factors: &Factors, guard: Option<Guard>) -> Factors {
        factors.map(|value| {
            let known = self.symbol_of.contains_key(&value);
            let symbol = self.frozen_value(value);
            match guard {
                Some(guard) if !known && symbol != value => _ = self.guards.insert(value, guard),
                // Both versions have the value, or there is one version.
                _ if self.guards.get(&value) != guard.as_ref() => _ = self.guards.remove(&value),
                _ => {}
            }
            symbol
        })
    }

    /// Pivots that can change.
    fn watch(&self, version: &Version) -> Vec<WatchedPivot> {
        let Version { factors, equilibration } = version;
        let mut watched = Vec::new();
        for pivot in &factors.pivots {
            if let Some(&(_, register)) = self.symbol_of.get(&pivot.inverse) {
                let smallest = pivot.magnitude.into_iter().fold(f64::INFINITY, f64::min)
                    / (equilibration[pivot.row] * equilibration[pivot.column]);
                watched.push(WatchedPivot {
                    register: register as usize,
                    largest_inverse: 1.0 / (TUNING.pivot_loss * smallest),
                });
            }
        }
        watched
    }
}
