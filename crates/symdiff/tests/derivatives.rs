//! Symbolic derivatives against finite differences, jets and adjoints: methods that share only the functions' values.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

use proptest::prelude::*;
use symdiff::jet::{JetScratch, JetSpace};
use symdiff::{Adjoints, Binary, Expr, Graph, Input, Node, Tile, Unary, lower};

const VARIABLES: usize = 3;

/// A random formula; [`build`] keeps every argument inside its function's domain and away from kinks.
#[derive(Clone, Debug)]
enum Tree {
    Variable(usize),
    Constant(f64),
    Unary(Unary, Box<Tree>),
    Binary(Binary, Box<Tree>, Box<Tree>),
}

fn tree() -> impl Strategy<Value = Tree> {
    use Unary::*;
    let leaf = prop_oneof![3 => (0..VARIABLES).prop_map(Tree::Variable), 1 => (-2.0..2.0_f64).prop_map(Tree::Constant)];
    let unary =
        prop::sample::select(vec![Neg, Sin, Cos, Tan, Asin, Acos, Atan, Sqrt, Exp, Log, Abs, Tanh, Sign, Floor]);
    let binary = prop::sample::select(vec![
        Binary::Add,
        Binary::Sub,
        Binary::Mul,
        Binary::Div,
        Binary::Pow,
        Binary::Atan2,
        Binary::Min,
        Binary::Max,
        Binary::Select,
        Binary::SelectElse,
    ]);
    leaf.prop_recursive(4, 16, 2, move |inner| {
        let pair = (binary.clone(), inner.clone(), inner.clone());
        prop_oneof![
            (unary.clone(), inner).prop_map(|(function, a)| Tree::Unary(function, Box::new(a))),
            pair.prop_map(|(function, a, b)| Tree::Binary(function, Box::new(a), Box::new(b))),
        ]
    })
}

/// 0.8 tanh a, in (-0.8, 0.8).
fn inside(graph: &mut Graph, a: Expr) -> Expr {
    let bounded = graph.unary(Unary::Tanh, a);
    graph.scale(0.8, bounded)
}

/// 1.5 + 0.8 tanh a, in (0.7, 2.3).
fn positive(graph: &mut Graph, a: Expr) -> Expr {
    let (bounded, shift) = (inside(graph, a), graph.constant(1.5));
    graph.add(bounded, shift)
}

fn build(graph: &mut Graph, variables: &[Expr], tree: &Tree) -> Expr {
    match tree {
        Tree::Variable(variable) => variables[*variable],
        Tree::Constant(value) => graph.constant(*value),
        Tree::Unary(function, a) => {
            let a = build(graph, variables, a);
            let argument = match function {
                Unary::Asin | Unary::Acos | Unary::Tan | Unary::Exp => inside(graph, a),
                Unary::Sqrt | Unary::Log => positive(graph, a),
                // On the negative side of the kink.
                Unary::Abs | Unary::Sign => {
                    let a = positive(graph, a);
                    graph.neg(a)
                }
                // Between two integers.
                Unary::Floor => {
                    let (a, shift) = (inside(graph, a), graph.constant(2.5));
                    let half = graph.scale(0.5, a);
                    graph.add(half, shift)
                }
                _ => a,
            };
            graph.unary(*function, argument)
        }
        Tree::Binary(function, a, b) => {
            let (a, b) = (build(graph, variables, a), build(graph, variables, b));
            let (a, b) = match function {
                Binary::Div => (a, positive(graph, b)),
                Binary::Pow => (positive(graph, a), inside(graph, b)),
                // In the second quadrant.
                Binary::Atan2 => {
                    let (a, b) = (positive(graph, a), positive(graph, b));
                    (a, graph.neg(b))
                }
                Binary::Min | Binary::Max => {
                    let (a, b) = (inside(graph, a), positive(graph, b));
                    let one = graph.constant(1.0);
                    (a, graph.add(b, one))
                }
                Binary::Select => (positive(graph, a), b),
                Binary::SelectElse => {
                    let a = positive(graph, a);
                    (graph.neg(a), b)
                }
                Binary::Add | Binary::Sub | Binary::Mul => (a, b),
            };
            graph.binary(*function, a, b)
        }
    }
}

fn value(graph: &Graph, expr: Expr, variables: &[Expr], at: &[f64]) -> f64 {
    graph.evaluate(&[expr], |symbol| at[variables.iter().position(|&variable| variable == symbol).unwrap()])[0]
}

/// The expression's jet: every node in turn, in jet arithmetic.
fn jet(graph: &Graph, root: Expr, variables: &[Expr], at: &[f64], space: &JetSpace) -> Vec<f64> {
    let mut scratch = JetScratch::new(space);
    let order = graph.reachable(&[root]);
    let mut jets = std::collections::HashMap::<Expr, Vec<f64>>::new();
    for expr in order {
        let mut out = vec![f64::NAN; space.len()];
        match graph.node(expr) {
            Node::Constant(bits) => space.constant(f64::from_bits(bits), &mut out),
            Node::Symbol(_) => {
                let variable = variables.iter().position(|&variable| variable == expr).unwrap();
                space.variable(variable, at[variable], 1.0, &mut out);
            }
            Node::Unary(function, a) => space.unary(function, &jets[&a], &mut out, &mut scratch),
            Node::Binary(function, a, b) => space.binary(function, &jets[&a], &jets[&b], &mut out, &mut scratch),
        }
        jets.insert(expr, out);
    }
    jets.remove(&root).unwrap()
}

/// Central differences extrapolated four times (Romberg).
fn difference_quotient(f: impl Fn(f64) -> f64) -> f64 {
    let mut column: Vec<f64> =
        (0..5).map(|level| 0.02 / f64::from(1 << level)).map(|h| (f(h) - f(-h)) / (2.0 * h)).collect();
    for order in 1..5 {
        let factor = f64::from(1 << (2 * order));
        column = column.windows(2).map(|pair| (factor * pair[1] - pair[0]) / (factor - 1.0)).collect();
    }
    column[0]
}

proptest! {
    #[test]
    fn first_derivatives_match_finite_differences(tree in tree(), at in prop::array::uniform3(-0.9..0.9_f64)) {
        let mut graph = Graph::new();
        let variables = ["x", "y", "z"].map(|name| graph.symbol(name));
        let root = build(&mut graph, &variables, &tree);
        // The variation of the function limits the accuracy of differences.
        let scale = 1.0 + jet(&graph, root, &variables, &at, &JetSpace::new(VARIABLES, 5)).iter().map(|c| c.abs()).sum::<f64>();
        prop_assume!(scale < 1e4);
        for (variable, &symbol) in variables.iter().enumerate() {
            let derivative = graph.derivative(root, symbol);
            let symbolic = value(&graph, derivative, &variables, &at);
            let numeric = difference_quotient(|h| {
                let mut moved = at;
                moved[variable] += h;
                value(&graph, root, &variables, &moved)
            });
            prop_assert!((symbolic - numeric).abs() < 1e-7 * scale, "{symbolic} against {numeric}, scale {scale}");
        }
    }

    /// r! times a jet's coefficient at ξ^r is the partial derivative of order r.
    #[test]
    fn jets_are_repeated_derivatives(tree in tree(), at in prop::array::uniform3(-0.9..0.9_f64)) {
        let mut graph = Graph::new();
        let variables = ["x", "y", "z"].map(|name| graph.symbol(name));
        let root = build(&mut graph, &variables, &tree);
        let space = JetSpace::new(VARIABLES, 3);
        let jet = jet(&graph, root, &variables, &at, &space);
        let scale = 1.0 + jet.iter().map(|c| c.abs()).sum::<f64>();
        for (r, coefficient) in jet.iter().enumerate() {
            let (mut derivative, mut factorials) = (root, 1.0);
            for (variable, &power) in space.monomials().exponents(r).iter().enumerate() {
                for time in 1..=power {
                    derivative = graph.derivative(derivative, variables[variable]);
                    factorials *= time as f64;
                }
            }
            let expected = value(&graph, derivative, &variables, &at) / factorials;
            prop_assert!((coefficient - expected).abs() < 1e-11 * scale, "{coefficient} against {expected} at {r}");
        }
    }

    /// Adjoints of a tape, in lanes at several points at once, are the coefficients of jets of first order; the tile
    /// has its values from before.
    #[test]
    fn adjoints_are_jets_of_first_order(
        trees in prop::array::uniform2(tree()),
        at in prop::collection::vec(prop::array::uniform3(-0.9..0.9_f64), 4),
        seeds in prop::array::uniform2(-2.0..2.0_f64),
    ) {
        let mut graph = Graph::new();
        let variables = ["x", "y", "z"].map(|name| graph.symbol(name));
        let roots = trees.map(|tree| build(&mut graph, &variables, &tree));
        let inputs: Vec<Input> =
            variables.iter().zip(0..).map(|(&symbol, register)| Input { symbol, stage: 0, register }).collect();
        // The first replaces a variable, as steps do.
        let outputs = vec![(roots[0], Some(0)), (roots[1], Some(VARIABLES as u32))];
        let lowered = lower(&graph, &inputs, 0, VARIABLES as u32 + 1, &[outputs]);
        let mut tile = Tile::new(4, lowered.registers, &lowered.constants);
        for (lane, at) in at.iter().enumerate() {
            (0..VARIABLES).for_each(|register| tile.lane_mut(register)[lane] = at[register]);
        }
        let before = tile.values().to_vec();
        let mut adjoints = Adjoints::new(&tile);
        adjoints.lane_mut(0).fill(seeds[0]);
        adjoints.lane_mut(VARIABLES).fill(seeds[1]);
        adjoints.pull(&lowered.kernels[0], &mut tile);
        prop_assert_eq!(tile.values(), before);
        let space = JetSpace::new(VARIABLES, 1);
        for (lane, at) in at.iter().enumerate() {
            let jets = roots.map(|root| jet(&graph, root, &variables, at, &space));
            for variable in 0..VARIABLES {
                let terms = [0, 1].map(|root| seeds[root] * jets[root][1 + variable]);
                let (found, size) = (adjoints.lane(variable)[lane], 1.0 + terms[0].abs() + terms[1].abs());
                let difference = found - (terms[0] + terms[1]);
                prop_assert!(difference.abs() < 1e-9 * size, "{found}, not {:?}", terms);
            }
        }
    }
}
