//! A step of HHT-I3, or of another scheme of its family, as expressions: residual, Newton matrix, and the state at its
//! end.
//!
//! Negrut, Rampalli, Ottarsson & Sajdak, J. Comput. Nonlinear Dynam. 2 (2007) 73, in the form of Arnold & Brüls,
//! Multibody Syst. Dyn. 18 (2007) 185, which keeps the algorithmic acceleration a apart from the true one, w = v̇:
//!
//! ```text
//! M(q₊) w₊ + Φ_q(q₊,t₊)ᵀ λ₊ − Q(t₊,q₊,v₊,λ₊) = 0            Φ(q₊,t₊) / (βh²(1+α)) = 0
//! a₊ = (1+α) w₊ − α w
//! q₊ = q + h v + h²/2 [(1−2β) a + 2β a₊]                      v₊ = v + h [(1−γ) a + γ a₊]
//! β = (1−α)²/4,   γ = 1/2 − α
//! ```
//!
//! Other schemes have other numbers in the same equations ([`Coefficients`]): a₊ = g w₊ + e w − d a. With x = w₊: q₊ =
//! q̂ + b x and v₊ = v̂ + c x, b = βh²g, c = γhg (HHT: g = 1+α), where q̂ and v̂ do not change in the iteration. The
//! constraint is divided by b so that the matrix does not degenerate as h → 0; a scheme of index 2 has Φ̇(q₊,v₊,t₊)/c =
//! 0 instead. Velocity constraints are Ψ(q₊,v₊,t₊)/c = 0 in each of them.

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph, Input, SparseMatrix};

use super::equations::{constraint_rates, equations_of_motion, velocity_constraints_by_states};
use super::inertial_change;
use super::layout::Layout;
use super::links::{Linked, Unknowns};
use super::scheme::{Coefficients, ConstraintLevel};
use crate::assemble::System;

/// Stage of values that change with the sample only.
pub const SAMPLE: usize = 0;
/// Stage of values that change with the step size.
pub const STEP_SIZE: usize = 1;
/// Stage of values that change from step to step.
pub const STEP: usize = 2;
/// Stage of values that change in Newton's iteration.
pub const ITERATION: usize = 3;

/// A step's equations over the symbols of [`step_inputs`].
#[derive(Clone, Debug)]
pub struct NewtonSystem {
    /// n + m residuals: equations of motion, then constraints over b (their rates over c).
    pub residual: Vec<Expr>,
    /// ∂residual/∂(w₊, λ₊), (n + m)², and after it rows and columns of values of links, where there are any.
    pub matrix: SparseMatrix,
    /// Pivots (row, column) before all others, of links.
    pub first: Vec<(usize, usize)>,
    /// q₊, n.
    pub position: Vec<Expr>,
    /// v₊, n.
    pub velocity: Vec<Expr>,
    /// a₊, n.
    pub algorithmic: Vec<Expr>,
    /// w₊, n: the iterate itself.
    pub acceleration: Vec<Expr>,
    /// M(q₊) (a₊ − a), n, from which local errors are estimated.
    pub inertial_change: Vec<Expr>,
    /// Where it is not positive, no conditional effect is active; `None` without conditional effects.
    pub active_condition: Option<Expr>,
}

impl NewtonSystem {
    /// Replaces all expressions, given together, by the same number of others.
    pub fn map(mut self, replace: impl FnOnce(&[Expr]) -> Vec<Expr>) -> Self {
        let entries = self.matrix.rows.iter_mut().flatten().map(|entry| &mut entry.1);
        let vectors = [
            &mut self.residual,
            &mut self.position,
            &mut self.velocity,
            &mut self.algorithmic,
            &mut self.acceleration,
            &mut self.inertial_change,
        ];
        let all: Vec<&mut Expr> =
            entries.chain(vectors.into_iter().flatten()).chain(&mut self.active_condition).collect();
        let before: Vec<Expr> = all.iter().map(|value| **value).collect();
        all.into_iter().zip(replace(&before)).for_each(|(value, new)| *value = new);
        self
    }
}

/// The symbols that a step adds to the system's: the state at its beginning, h and the iterate.
struct StepSymbols {
    q: Vec<Expr>,
    v: Vec<Expr>,
    a: Vec<Expr>,
    w: Vec<Expr>,
    x: Vec<Expr>,
    h: Expr,
    t: Expr,
}

impl StepSymbols {
    fn new(graph: &mut Graph, n: usize) -> Self {
        let mut block = |name: &str| (0..n).map(|i| graph.symbol(&format!("step:{name}{i}"))).collect::<Vec<_>>();
        let (q, v, a, w, x) = (block("q"), block("v"), block("a"), block("w"), block("x"));
        Self { q, v, a, w, x, h: graph.symbol("step:h"), t: graph.symbol("step:t") }
    }

    fn inputs(&self, layout: &Layout, system: &System) -> Vec<Input> {
        let mut inputs = Vec::new();
        let mut add = |symbols: &[Expr], start: usize, stage: usize| {
            inputs.extend(symbols.iter().zip(start..).map(|(&symbol, register)| Input {
                symbol,
                stage,
                register: register as u32,
            }));
        };
        let parameters: Vec<Expr> = system.parameters.iter().map(|parameter| parameter.symbol).collect();
        add(&parameters, layout.parameters.start, SAMPLE);
        let of_inputs: Vec<Expr> = system.input_symbols().collect();
        add(&of_inputs, layout.inputs.start, STEP);
        add(&[self.h], layout.step, STEP_SIZE);
        add(&[self.t], layout.time, STEP);
        add(&self.q, layout.q.start, STEP);
        add(&self.v, layout.v.start, STEP);
        add(&self.a, layout.a.start, STEP);
        add(&self.w, layout.w.start, STEP);
        add(&self.x, layout.iterate.start, ITERATION);
        // Kernels that run between steps read the state by the system's own symbols.
        add(&system.lambda, layout.lambda.start, ITERATION);
        add(&[system.time], layout.time, ITERATION);
        add(&system.q, layout.q.start, ITERATION);
        add(&system.v, layout.v.start, ITERATION);
        add(&system.w, layout.w.start, ITERATION);
        inputs
    }
}

/// The gains of a step: derivatives of q₊ (b) and of v₊ (c) by w₊.
#[derive(Clone, Copy)]
struct Gains {
    h2: Expr,
    b: Expr,
    c: Expr,
}

/// The state at the end of a step.
struct NewState {
    position: Vec<Expr>,
    velocity: Vec<Expr>,
    algorithmic: Vec<Expr>,
}

/// The equations of a step and their inputs.
pub fn newton_system(
    system: &System,
    graph: &mut Graph,
    layout: &Layout,
    coefficients: Coefficients,
    by_links: bool,
) -> (NewtonSystem, Vec<Input>) {
    let symbols = StepSymbols::new(graph, system.q.len());
    let h2 = graph.mul(symbols.h, symbols.h);
    let b = graph.scale(coefficients.beta * coefficients.of_new(), h2);
    let c = graph.scale(coefficients.gamma * coefficients.of_new(), symbols.h);
    let gains = Gains { h2, b, c };
    let state = new_state(graph, &symbols, coefficients, gains);
    let (residual, mut matrix, linked) = residual_and_matrix(system, graph, coefficients.level, gains, by_links);

    // Everything at t₊: the system's symbols become the step's expressions.
    let mut at_end: FxHashMap<Expr, Expr> = FxHashMap::default();
    at_end.insert(system.time, symbols.t);
    for i in 0..system.q.len() {
        at_end.insert(system.q[i], state.position[i]);
        at_end.insert(system.v[i], state.velocity[i]);
        at_end.insert(system.w[i], symbols.x[i]);
    }
    let residual = graph.substitute(&residual, &at_end);
    let inertial_change = match linked {
        None => inertial_change::by_mass(system, graph, [&state.algorithmic, &symbols.a], &at_end),
        Some(_) => inertial_change::by_forces(system, graph, [&state.algorithmic, &symbols.a], &at_end),
    };
    if let Some(linked) = &linked {
        let (symbols, values): (Vec<Expr>, Vec<Expr>) = linked.symbols().unzip();
        let values = graph.substitute(&values, &at_end);
        at_end.extend(symbols.into_iter().zip(values));
    }
    let first = linked.map(|linked| linked.order(system, residual.len())).unwrap_or_default();
    let values: Vec<Expr> = matrix.entries().map(|(_, _, value)| value).collect();
    let mut values = graph.substitute(&values, &at_end).into_iter();
    for entry in matrix.rows.iter_mut().flatten() {
        // `substitute` returns an image of each of the entries, in this order.
        entry.1 = values.next().expect("one value an entry");
    }
    let active_condition = system.active_condition.map(|condition| graph.substitute(&[condition], &at_end)[0]);
    let inputs = symbols.inputs(layout, system);
    let NewState { position, velocity, algorithmic } = state;
    let acceleration = symbols.x;
    let newton = NewtonSystem {
        residual,
        matrix,
        first,
        position,
        velocity,
        algorithmic,
        acceleration,
        inertial_change,
        active_condition,
    };
    (newton, inputs)
}

/// q₊, v₊ and a₊, summed in the order of Negrut et al.
fn new_state(graph: &mut Graph, symbols: &StepSymbols, coefficients: Coefficients, gains: Gains) -> NewState {
    let Coefficients { beta, gamma, .. } = coefficients;
    let (of_new, of_old, of_algorithmic) =
        (coefficients.of_new(), coefficients.of_old(), coefficients.of_algorithmic());
    let (h, Gains { h2, b, c }) = (symbols.h, gains);
    let mut state = NewState { position: Vec::new(), velocity: Vec::new(), algorithmic: Vec::new() };
    let (q_a, q_w) = (graph.scale(0.5 - beta * (1.0 + of_algorithmic), h2), graph.scale(beta * of_old, h2));
    let (v_a, v_w) = (graph.scale(1.0 - gamma * (1.0 + of_algorithmic), h), graph.scale(gamma * of_old, h));
    for i in 0..symbols.q.len() {
        let (q, v, a, w, x) = (symbols.q[i], symbols.v[i], symbols.a[i], symbols.w[i], symbols.x[i]);
        let drift = graph.mul(h, v);
        let predicted = graph.add(q, drift);
        let (from_a, from_w, from_x) = (graph.mul(q_a, a), graph.mul(q_w, w), graph.mul(b, x));
        let known = graph.add(predicted, from_a);
        let known = graph.add(known, from_w);
        state.position.push(graph.add(known, from_x));
        let (from_a, from_w, from_x) = (graph.mul(v_a, a), graph.mul(v_w, w), graph.mul(c, x));
        let known = graph.add(v, from_a);
        let known = graph.add(known, from_w);
        state.velocity.push(graph.add(known, from_x));
        let (new, old, before) = (graph.scale(of_new, x), graph.scale(of_old, w), graph.scale(of_algorithmic, a));
        let sum = graph.add(new, old);
        state.algorithmic.push(graph.sub(sum, before));
    }
    state
}

/// The residual and its derivatives by (w₊, λ₊), over the system's own symbols.
fn residual_and_matrix(
    system: &System,
    graph: &mut Graph,
    level: ConstraintLevel,
    gains: Gains,
    by_links: bool,
) -> (Vec<Expr>, SparseMatrix, Option<Linked>) {
    let Gains { b, c, .. } = gains;
    let (n, m) = (system.q.len(), system.lambda.len());
    let (motion, constraint_jacobian) = equations_of_motion(system, graph);
    let linked =
        by_links.then(|| Linked::new(system, graph, &motion, &[&system.q, &system.v, &system.w, &system.lambda]));
    let size = n + m + linked.as_ref().map_or(0, Linked::len);
    let mut matrix = SparseMatrix::zero(size, size);
    match &linked {
        None => differentiate(system, graph, &motion, &mut matrix, gains),
        Some(linked) => {
            let by: [Unknowns; 4] =
                [(&system.w, 0, None), (&system.q, 0, Some(b)), (&system.v, 0, Some(c)), (&system.lambda, n, None)];
            linked.differentiate(graph, &mut matrix, n + m, &by);
        }
    }
    for (row, column, value) in constraint_jacobian.entries() {
        matrix.add(graph, n + row, column, value);
    }
    // ∂Ψ/∂y₊: states push on nothing, and nothing on them, but a step solves for them.
    for (row, column, value) in velocity_constraints_by_states(system, graph).entries() {
        matrix.add(graph, n + system.constraint.len() + row, column, value);
    }
    let mut residual = motion;
    let (positions, rates) = match level {
        ConstraintLevel::Position => (&system.constraint[..], system.velocity_constraint.clone()),
        ConstraintLevel::Velocity => (&[][..], constraint_rates(system, graph)),
    };
    residual.extend(positions.iter().map(|&value| graph.div(value, b)));
    // ∂Φ̇/∂v₊ = Φ_q and ∂Ψ/∂v₊ are in the matrix already.
    if !rates.is_empty() {
        let ratio = graph.div(b, c);
        for (row, column, derivative) in graph.jacobian(&rates, &system.q).entries() {
            let value = graph.mul(ratio, derivative);
            matrix.add(graph, residual.len() + row, column, value);
        }
        residual.extend(rates.iter().map(|&rate| graph.div(rate, c)));
    }
    (residual, matrix, linked)
}

/// The derivatives of the equations of motion by (w₊, λ₊).
fn differentiate(
    system: &System,
    graph: &mut Graph,
    motion: &[Expr],
    matrix: &mut SparseMatrix,
    Gains { b, c, .. }: Gains,
) {
    let n = system.q.len();
    let by_position = graph.jacobian(motion, &system.q);
    let by_velocity = graph.jacobian(motion, &system.v);
    let by_acceleration = graph.jacobian(motion, &system.w);
    let by_multiplier = graph.jacobian(motion, &system.lambda);
    for (row, column, value) in by_acceleration.entries() {
        matrix.add(graph, row, column, value);
    }
    for (row, column, value) in by_position.entries() {
        let value = graph.mul(b, value);
        matrix.add(graph, row, column, value);
    }
    for (row, column, value) in by_velocity.entries() {
        let value = graph.mul(c, value);
        matrix.add(graph, row, column, value);
    }
    for (row, column, value) in by_multiplier.entries() {
        matrix.add(graph, row, n + column, value);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;
    use crate::assemble::tests::model::{Model, formula};
    use crate::compile::scheme::Scheme;
    use crate::grammar::FrictionMode;
    use crate::model::joint_friction::FrictionJoint;
    use crate::model::{DryFriction, JointFriction};

    /// The whole matrix, −∂Q/∂λ of friction included, against differences of the residual.
    #[test]
    fn matrix_is_the_jacobian_if_forces_depend_on_reactions() {
        let mut m = Model::new();
        m.body("rod", "2", "0.1", "xya", &[("pin", "-0.3", "0.1"), ("tip", "0.4", "0")]);
        m.body("bob", "1", "0.1", "xya", &[]);
        m.revolute("pin", "ground", "rod.pin");
        m.revolute("knee", "rod.tip", "bob");
        m.gravity();
        for joint in 0..2 {
            let dry = DryFriction {
                breakaway: formula("1.5"),
                stribeck_velocity: Some(formula("0.7")),
                transition_velocity: formula("0.2"),
            };
            let (coulomb, viscous, radius) = (formula("0.1"), formula("0.2"), Some(formula("0.05")));
            let (on, coefficient) = (FrictionJoint { joint, mode: FrictionMode::Rotating }, formula("0.4"));
            m.effect(JointFriction { on, coefficient, dry, coulomb, viscous, radius, length: None });
        }
        let system = m.build();
        let n = system.q.len();
        let layout = Layout::of(&system);
        let mut graph = system.graph.clone();
        let (newton, inputs) =
            newton_system(&system, &mut graph, &layout, Scheme::Hht { alpha: -0.1 }.coefficients(), false);
        let unknowns = layout.iterate.clone().chain(layout.lambda.clone());
        let mut values: HashMap<usize, f64> =
            (0..layout.registers()).map(|register| (register, (1.7 * register as f64 + 0.3).sin())).collect();
        values.insert(layout.step, 0.05);
        let residual = |values: &HashMap<usize, f64>| {
            graph.evaluate(&newton.residual, |symbol| {
                let input = inputs.iter().find(|input| input.symbol == symbol).unwrap();
                values[&(input.register as usize)]
            })
        };
        let entries: Vec<_> = newton.matrix.entries().collect();
        let exprs: Vec<Expr> = entries.iter().map(|entry| entry.2).collect();
        let numbers = graph.evaluate(&exprs, |symbol| {
            values[&(inputs.iter().find(|input| input.symbol == symbol).unwrap().register as usize)]
        });
        let mut by_friction = 0;
        for (column, register) in unknowns.enumerate() {
            let ends = [1e-6, -1e-6].map(|step| {
                let mut moved = values.clone();
                *moved.get_mut(&register).unwrap() += step;
                residual(&moved)
            });
            for (row, (ahead, behind)) in ends[0].iter().zip(&ends[1]).enumerate() {
                let difference = (ahead - behind) / 2e-6;
                let entry = entries.iter().zip(&numbers).find(|((r, c, _), _)| (*r, *c) == (row, column));
                let entry = entry.map_or(0.0, |(_, number)| *number);
                assert!(
                    (difference - entry).abs() < 1e-6 * (1.0 + difference.abs()),
                    "({row}, {column}): {entry}, not {difference}"
                );
                // Φ_qᵀ has the entries of Φ_q; friction adds the rest.
                if row < n && column >= n {
                    let transposed = entries.iter().zip(&numbers).find(|((r, c, _), _)| (*r, *c) == (column, row));
                    by_friction += usize::from((entry - transposed.map_or(0.0, |(_, number)| *number)).abs() > 1e-6);
                }
            }
        }
        assert!(by_friction >= 6, "only {by_friction} entries depend on friction");
    }
}
