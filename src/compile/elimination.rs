//! The Newton matrix's factors as a step uses them: frozen between factorisations, in one version or in two.
//!
//! Effects that act only sometimes (contacts, stops) couple coordinates that nothing else couples, so that elimination has more
//! to do, and what was constant changes with the iterate. Where this is worth it, the matrix is eliminated twice: as it is
//! where something touches, and as it is where nothing does. A lane's own iterate, when its matrix is factorised, decides which
//! of the two solves for its corrections, so its numbers do not depend on who shares its tile; and what no lane of a tile needs
//! is not computed.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph, Guard, Input, SparseMatrix, Stages};

use super::newton_matrix::ITERATION;
use super::sparse_lu::{Factors, NoFactors, Numbers, PIVOT_SAMPLES, Pivoting, factorise};
use super::step::{Mode, Watched, WatchedPivot};

/// Where numbers grow more than this in the elimination, pivots are chosen anew, fewer of them.
const MOST_GROWTH: f64 = 1e4;

/// A pivot may fall this far below its size at the probes: the corrections then still have some six digits, which is
/// all that Newton's iteration needs of them.
const PIVOT_LOSS: f64 = 1e-10;

/// Regularisation of a redundant constraint's multiplier, relative to the size of its row. What the constraint asks for
/// the others see to, so its multiplier stays near the zero from which every step starts it.
const REDUNDANT_WEIGHT: f64 = 1.0;

/// A second version has at most this share of the first one's operations in the iteration; lanes of a tile that do not agree
/// pay for both.
const WORTH_A_VERSION: f64 = 0.8;

/// How pivots are chosen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice<'a> {
    /// Constraints that others imply.
    pub redundant: &'a [usize],
    /// Pivots that cannot vanish.
    pub symmetric: Pivoting<'a>,
    /// Whether only these will do.
    pub spatial: bool,
    /// Number of coordinates.
    pub n: usize,
}

/// A matrix's factors, with the scaling of its rows and columns by which pivots were compared.
#[derive(Clone, Debug)]
pub(super) struct Version {
    pub factors: Factors,
    pub equilibration: Vec<f64>,
}

impl Choice<'_> {
    /// Factorises a Newton matrix, whose entries have these numbers at the probes.
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
                factorise(graph, &regular, numbers, &equilibration, Stages::new(inputs), ITERATION, pivoting)
            };
            // A start in a singular configuration has no pivots of its own: then states in general position decide.
            factorised(graph, &numbers).or_else(|_| {
                let mut apart = numbers.clone();
                apart.iter_mut().for_each(|numbers| numbers[0] = numbers[1]);
                factorised(graph, &apart)
            })
        };
        let factors = match plan(graph, if self.spatial { self.symmetric } else { Pivoting::Any }) {
            Ok(factors) if factors.growth <= MOST_GROWTH || self.spatial => Ok(factors),
            // In a long chain free choice hands errors on from body to body, each time larger.
            free => plan(graph, self.symmetric).or(free),
        }?;
        // Factors that were only kept because others took too long are not those that were looked for.
        if graph.is_full() { Err(NoFactors::TooLong) } else { Ok(Version { factors, equilibration }) }
    }

    /// A redundant constraint's pivot would be zero; its multiplier is regularised in the matrix, not in the residual.
    fn regularised(
        &self,
        graph: &mut Graph,
        matrix: &SparseMatrix,
        numbers: &[Numbers],
        equilibration: &[f64],
    ) -> (SparseMatrix, Vec<Numbers>) {
        let (mut regular, mut numbers) = (matrix.clone(), numbers.to_vec());
        for &constraint in self.redundant {
            let row = self.n + constraint;
            let weight = REDUNDANT_WEIGHT / (equilibration[row] * equilibration[row]);
            let place = matrix.rows[..row].iter().map(Vec::len).sum::<usize>() + regular.rows[row].len();
            let offset = regular.nonzeros() - matrix.nonzeros();
            let value = graph.constant(-weight);
            debug_assert!(
                regular.rows[row].iter().all(|&(column, _)| column < row),
                "a constraint's row ends before its own multiplier"
            );
            regular.rows[row].push((row, value));
            numbers.insert(place + offset, [-weight; PIVOT_SAMPLES]);
        }
        (regular, numbers)
    }
}

/// Factors in one version or two, seen by the corrections through symbols of their own.
pub(super) struct Elimination {
    /// What the factorisation computes: the frozen values and their slots.
    pub frozen: Vec<(Expr, Option<u32>)>,
    /// Which of them matter only in one version.
    pub guards: FxHashMap<Expr, Guard>,
    /// Pivots that can become small.
    pub watched: Vec<Watched>,
    /// The matrix's factors; where there are two versions, where something touches.
    pub all: Version,
    /// Over frozen values.
    substituted: Factors,
    /// What decides, frozen too, and the factors where nothing touches.
    apart: Option<(Expr, Factors)>,
}

impl Elimination {
    /// Freezes factors, and with what tells them apart (which the iteration changes) those of where nothing touches. Slots are taken from `next` on.
    pub fn new(
        graph: &mut Graph,
        inputs: &mut Vec<Input>,
        next: &mut u32,
        all: Version,
        apart: Option<(Expr, Version)>,
    ) -> Self {
        let mut freezer = Freezer::new(graph, inputs, next);
        let Some((touching, apart)) = apart else {
            let substituted = freezer.freeze(&all.factors, None);
            let watched = vec![Watched { mode: None, pivots: freezer.watch(&all) }];
            let Freezer { frozen, guards, .. } = freezer;
            return Self { frozen, guards, watched, all, substituted, apart: None };
        };
        let guards = [false, true].map(|elsewhere| Guard { condition: touching, elsewhere });
        let substituted = freezer.freeze(&all.factors, Some(guards[0]));
        let apart_substituted = freezer.freeze(&apart.factors, Some(guards[1]));
        let mode = freezer.frozen_value(touching);
        let (_, slot) = freezer.symbol_of[&touching];
        let watched = [(&all, false), (&apart, true)].map(|(version, elsewhere)| {
            let mode = Some(Mode { slot: slot as usize, elsewhere });
            Watched { mode, pivots: freezer.watch(version) }
        });
        let watched = watched.into();
        let Freezer { frozen, guards, .. } = freezer;
        Self { frozen, guards, watched, all, substituted, apart: Some((mode, apart_substituted)) }
    }

    /// The solution of matrix · x = `right`.
    pub fn solve(&self, graph: &mut Graph, right: &[Expr]) -> Vec<Expr> {
        let mut solution = self.substituted.solve(graph, right);
        if let Some((mode, factors)) = &self.apart {
            let apart = factors.solve(graph, right);
            for (value, apart) in solution.iter_mut().zip(apart) {
                *value = graph.select(*mode, *value, apart);
            }
        }
        solution
    }
}

/// Whether a version of its own is worth it where nothing touches.
pub(super) fn is_worth_it(graph: &Graph, inputs: &[Input], all: &Version, apart: &Version) -> bool {
    let mut stages = Stages::new(inputs);
    stages.update(graph);
    let [all, apart] = [all, apart].map(|version| {
        let values: Vec<Expr> = version.factors.values().collect();
        let changing = graph.reachable(&values).into_iter().filter(|&expr| stages.of(expr) == Some(ITERATION)).count();
        // A solution takes an operation for each value, whether it changes or not.
        (changing + values.len()) as f64
    });
    apart <= WORTH_A_VERSION * all
}

/// Makes symbols of factors that the iteration can change.
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

    /// A value as it was when the matrix was factorised.
    fn frozen_value(&mut self, value: Expr) -> Expr {
        if !self.changes(value) {
            return value;
        }
        if let Some(&(symbol, _)) = self.symbol_of.get(&value) {
            return symbol;
        }
        let symbol = self.graph.symbol(&format!("factor:{}", self.frozen.len()));
        let slot = *self.next;
        *self.next += 1;
        self.inputs.push(Input { symbol, stage: ITERATION, slot });
        self.frozen.push((value, Some(slot)));
        self.symbol_of.insert(value, (symbol, slot));
        symbol
    }

    fn freeze(&mut self, factors: &Factors, guard: Option<Guard>) -> Factors {
        factors.map(|value| {
            let known = self.symbol_of.contains_key(&value);
            let symbol = self.frozen_value(value);
            match guard {
                Some(guard) if !known && symbol != value => _ = self.guards.insert(value, guard),
                // Both versions have it, or there is one.
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
            if let Some(&(_, slot)) = self.symbol_of.get(&pivot.inverse) {
                let smallest = pivot.magnitude.into_iter().fold(f64::INFINITY, f64::min)
                    / (equilibration[pivot.row] * equilibration[pivot.column]);
                watched.push(WatchedPivot { slot: slot as usize, largest_inverse: 1.0 / (PIVOT_LOSS * smallest) });
            }
        }
        watched
    }
}
