//! Tapes against direct evaluation, bit for bit: random graphs with shared subexpressions, inputs of all stages, two
//! kernels, results that replace inputs, blocks that may be skipped, every tile width.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

use proptest::prelude::*;
use symdiff::{Binary, Expr, Graph, Input, Tile, Unary, WIDTHS, lower};

const INPUTS: usize = 5;
/// Stages below the kernels'.
const SHARED: usize = 2;

/// Operation of one more node on earlier ones.
#[derive(Clone, Copy, Debug)]
enum Step {
    Constant(f64),
    Unary(Unary, usize),
    Binary(Binary, usize, usize),
    /// A longer expression that is only wanted under a condition; with another one elsewhere, or nothing.
    Guarded {
        condition: usize,
        of: [usize; 2],
        elsewhere: Option<usize>,
    },
}

fn step() -> impl Strategy<Value = Step> {
    use Unary::*;
    let unary = prop::sample::select(vec![Neg, Sin, Cos, Tan, Asin, Acos, Atan, Sqrt, Exp, Log, Abs, Tanh, Sign]);
    // Sums and products most often, since these are fused.
    let binary = prop_oneof![
        6 => prop::sample::select(vec![Binary::Add, Binary::Sub, Binary::Mul]),
        1 => prop::sample::select(vec![Binary::Div, Binary::Pow, Binary::Atan2, Binary::Min, Binary::Max, Binary::Select, Binary::SelectElse]),
    ];
    let guarded = (any::<usize>(), any::<[usize; 2]>(), any::<Option<usize>>());
    prop_oneof![
        1 => (-2.0..2.0_f64).prop_map(Step::Constant),
        3 => (unary, any::<usize>()).prop_map(|(function, a)| Step::Unary(function, a)),
        8 => (binary, any::<usize>(), any::<usize>()).prop_map(|(function, a, b)| Step::Binary(function, a, b)),
        3 => guarded.prop_map(|(condition, of, elsewhere)| Step::Guarded { condition, of, elsewhere }),
    ]
}

/// All nodes of a random graph, the inputs first.
fn build(graph: &mut Graph, steps: &[Step]) -> Vec<Expr> {
    let mut nodes: Vec<Expr> = (0..INPUTS).map(|input| graph.symbol(&format!("x{input}"))).collect();
    for &step in steps {
        let node = match step {
            Step::Constant(value) => graph.constant(value),
            Step::Unary(function, a) => graph.unary(function, nodes[a % nodes.len()]),
            Step::Binary(function, a, b) => graph.binary(function, nodes[a % nodes.len()], nodes[b % nodes.len()]),
            Step::Guarded { condition, of, elsewhere } => {
                let [condition, a, b] = [condition, of[0], of[1]].map(|node| nodes[node % nodes.len()]);
                let mut long = a;
                for round in 0..3 {
                    let shifted = graph.constant(f64::from(round) - 0.5);
                    let product = graph.mul(long, b);
                    let sum = graph.add(product, shifted);
                    long = graph.sin(sum);
                }
                match elsewhere {
                    Some(elsewhere) => graph.select(condition, long, nodes[elsewhere % nodes.len()]),
                    None => graph.only_where(condition, long),
                }
            }
        };
        nodes.push(node);
    }
    nodes
}

/// The value of an input in a lane.
fn value(input: usize, lane: usize, seed: f64) -> f64 {
    (seed + 0.7 * input as f64 + 0.31 * lane as f64).sin() * 3.0
}

/// Nodes that no lane of the tile wants are not computed, and lanes that want them get the same bits.
#[test]
fn blocks_needed_by_no_lane_are_skipped() {
    let mut g = Graph::new();
    let (c, x, y) = (g.symbol("c"), g.symbol("x"), g.symbol("y"));
    let base = g.add(x, y);
    let mut long = base;
    for _ in 0..10 {
        let root = g.sqrt(long);
        long = g.add(root, x);
    }
    let push = g.add(base, long);
    let total = g.select(c, push, base);
    let inputs = [(c, 0), (x, 1), (y, 2)].map(|(symbol, register)| Input { symbol, stage: 0, register });
    let lowered = lower(&g, &inputs, 0, 3, &[vec![(total, Some(1))]]);
    let tape = &lowered.kernels[0];
    // Outside of the block there is only the sum; it is computed in the register of the block's choice, and copied to x
    // at the end.
    assert_eq!((tape.len_where(false), tape.len_where(true), tape.len()), (2, 24, 24), "{tape:?}");
    for width in WIDTHS {
        for active in 0..=width.min(2) {
            let mut tile = Tile::new(width, lowered.registers, &lowered.constants);
            // Memory of a skipped block may be anything.
            tile.values_mut()[3 * width..].fill(f64::NAN);
            lowered.constants.iter().for_each(|&(register, value)| tile.lane_mut(register as usize).fill(value));
            let at = |lane: usize| [if lane < active { 0.5 } else { -0.0 }, lane as f64 - 3.0, 1.0];
            for lane in 0..width {
                at(lane).into_iter().enumerate().for_each(|(register, value)| tile.lane_mut(register)[lane] = value);
            }
            tile.run(tape);
            for lane in 0..width {
                let values = at(lane);
                let direct =
                    g.evaluate(&[total], |symbol| values[[c, x, y].iter().position(|&s| s == symbol).unwrap()]);
                assert!(same(tile.lane(1)[lane], direct[0]), "{lane} of {width}: {} {}", tile.lane(1)[lane], direct[0]);
            }
        }
    }
}

/// Whether both are equal to the bit, or both NaN.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

proptest! {
    #[test]
    fn tapes_give_the_bits_of_direct_evaluation(
        steps in prop::collection::vec(step(), 1..60),
        stages in prop::array::uniform5(0..=SHARED),
        picks in prop::collection::vec((any::<usize>(), any::<bool>()), 1..8),
        seed in 0.0..6.0_f64,
    ) {
        let mut graph = Graph::new();
        let nodes = build(&mut graph, &steps);
        let inputs: Vec<Input> =
            (0..INPUTS).map(|i| Input { symbol: nodes[i], stage: stages[i], register: i as u32 }).collect();
        let observed: Vec<Expr> = picks.iter().map(|&(pick, _)| nodes[pick % nodes.len()]).collect();
        // The second kernel writes results over inputs of its own stage, as a step does with the state.
        let mut places = (0..INPUTS).filter(|&i| stages[i] == SHARED);
        let replaced: Vec<(Expr, Option<u32>)> =
            observed.iter().zip(&picks).map(|(&expr, &(_, replace))| {
                (expr, if replace { places.next().map(|index| index as u32) } else { None })
            }).collect();
        let kernels = [observed.iter().map(|&expr| (expr, None)).collect(), replaced];
        let lowered = lower(&graph, &inputs, SHARED, INPUTS as u32, &kernels);

        for width in WIDTHS {
            let mut tile = Tile::new(width, lowered.registers, &lowered.constants);
            for input in 0..INPUTS {
                for lane in 0..width {
                    tile.lane_mut(input)[lane] = value(input, lane, seed);
                }
            }
            for stage in &lowered.stages {
                tile.run(stage);
            }
            for (kernel, outputs) in lowered.kernels.iter().zip(&lowered.outputs) {
                tile.run(kernel);
                for lane in 0..width {
                    let direct = graph.evaluate(&observed, |symbol| {
                        let input = nodes.iter().position(|&node| node == symbol).unwrap();
                        value(input, lane, seed)
                    });
                    for (&register, &direct) in outputs.iter().zip(&direct) {
                        let found = tile.lane(register as usize)[lane];
                        prop_assert!(same(found, direct), "{found:e} is not {direct:e} (width {width}, lane {lane})");
                    }
                }
            }
        }
    }
}
