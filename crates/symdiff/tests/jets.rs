//! Jets against closed forms and identities.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

use proptest::prelude::*;
use symdiff::jet::{JetScratch, JetSpace, Monomials};
use symdiff::{Binary, Graph, Unary};

/// Largest difference of two jets, relative to the larger coefficient (at least 1).
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let scale = a.iter().chain(b).fold(1.0_f64, |scale, c| scale.max(c.abs()));
    a.iter().zip(b).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs())) / scale
}

/// Jets as values, for tests that read like mathematics.
struct Calculator {
    space: JetSpace,
    scratch: JetScratch,
}

impl Calculator {
    fn new(variables: usize, order: usize) -> Self {
        let space = JetSpace::new(variables, order);
        Self { scratch: JetScratch::new(&space), space }
    }

    fn variable(&self, variable: usize, value: f64) -> Vec<f64> {
        let mut out = vec![f64::NAN; self.space.len()];
        self.space.variable(variable, value, 1.0, &mut out);
        out
    }

    fn constant(&self, value: f64) -> Vec<f64> {
        let mut out = vec![f64::NAN; self.space.len()];
        self.space.constant(value, &mut out);
        out
    }

    fn unary(&mut self, function: Unary, a: &[f64]) -> Vec<f64> {
        let mut out = vec![f64::NAN; self.space.len()];
        self.space.unary(function, a, &mut out, &mut self.scratch);
        out
    }

    fn binary(&mut self, function: Binary, a: &[f64], b: &[f64]) -> Vec<f64> {
        let mut out = vec![f64::NAN; self.space.len()];
        self.space.binary(function, a, b, &mut out, &mut self.scratch);
        out
    }
}

#[test]
fn monomials_are_graded() {
    let monomials = Monomials::new(2, 3);
    let listed: Vec<&[usize]> = (0..monomials.len()).map(|r| monomials.exponents(r)).collect();
    let expected: [[usize; 2]; 10] = [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2], [3, 0], [2, 1], [1, 2], [0, 3]];
    assert_eq!(listed, expected);
    assert_eq!(Monomials::new(6, 10).len(), 8008);
    assert_eq!(Monomials::new(0, 4).len(), 1);
    assert_eq!(monomials.evaluate(&[1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 1.0], &[0.5, 2.0]), 13.0);
}

#[test]
fn geometric_series() {
    // 1/(1 - x - y) = Σ (x + y)^d: the binomial coefficients.
    let mut jets = Calculator::new(2, 8);
    let (x, y, one) = (jets.variable(0, 0.0), jets.variable(1, 0.0), jets.constant(1.0));
    let sum = jets.binary(Binary::Add, &x, &y);
    let denominator = jets.binary(Binary::Sub, &one, &sum);
    let series = jets.binary(Binary::Div, &one, &denominator);
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    for (r, coefficient) in series.iter().enumerate() {
        let monomials = jets.space.monomials();
        let expected: f64 = choose(monomials.degree(r), monomials.exponents(r)[0]);
        assert!((coefficient - expected).abs() < 1e-12 * expected, "{coefficient} against {expected}");
    }
}

#[test]
fn exponential_of_a_sum_is_the_product() {
    // exp(0.3 + x + y + z): coefficients e^0.3/(i! j! k!).
    let mut jets = Calculator::new(3, 6);
    let mut sum = jets.constant(0.3);
    for variable in 0..3 {
        let x = jets.variable(variable, 0.0);
        sum = jets.binary(Binary::Add, &sum, &x);
    }
    let series = jets.unary(Unary::Exp, &sum);
    for (r, coefficient) in series.iter().enumerate() {
        let factorials = jets.space.monomials().exponents(r).iter().map(|&e| (1..=e).product::<usize>());
        let expected = 0.3_f64.exp() / factorials.product::<usize>() as f64;
        assert!((coefficient - expected).abs() < 1e-14 * expected.max(1.0));
    }
}

#[test]
fn univariate_closed_forms() {
    let mut jets = Calculator::new(1, 7);
    let x = jets.variable(0, 0.0);
    let tan = jets.unary(Unary::Tan, &x);
    assert!(distance(&tan, &[0.0, 1.0, 0.0, 1.0 / 3.0, 0.0, 2.0 / 15.0, 0.0, 17.0 / 315.0]) < 1e-15);
    let tanh = jets.unary(Unary::Tanh, &x);
    assert!(distance(&tanh, &[0.0, 1.0, 0.0, -1.0 / 3.0, 0.0, 2.0 / 15.0, 0.0, -17.0 / 315.0]) < 1e-15);
    let asin = jets.unary(Unary::Asin, &x);
    assert!(distance(&asin, &[0.0, 1.0, 0.0, 1.0 / 6.0, 0.0, 3.0 / 40.0, 0.0, 15.0 / 336.0]) < 1e-15);
    let atan = jets.unary(Unary::Atan, &x);
    assert!(distance(&atan, &[0.0, 1.0, 0.0, -1.0 / 3.0, 0.0, 0.2, 0.0, -1.0 / 7.0]) < 1e-15);
    let one = jets.variable(0, 1.0);
    let log = jets.unary(Unary::Log, &one);
    assert!(distance(&log, &[0.0, 1.0, -0.5, 1.0 / 3.0, -0.25, 0.2, -1.0 / 6.0, 1.0 / 7.0]) < 1e-15);
    let root = jets.unary(Unary::Sqrt, &one);
    let exponent = jets.constant(0.5);
    assert!(distance(&root, &jets.binary(Binary::Pow, &one, &exponent)) < 1e-15);
    assert!(distance(&root[..4], &[1.0, 0.5, -0.125, 0.0625]) < 1e-15);
}

#[test]
fn kinks_follow_the_sign_of_the_constant_term() {
    let mut jets = Calculator::new(1, 2);
    let at = |value: f64| vec![value, 2.0, -3.0];
    assert_eq!(jets.unary(Unary::Abs, &at(-1.5)), [1.5, -2.0, 3.0]);
    assert_eq!(jets.unary(Unary::Abs, &at(0.0)), [0.0, 0.0, 0.0]);
    assert_eq!(jets.unary(Unary::Sign, &at(-1.5)), [-1.0, 0.0, 0.0]);
    let other = [0.0, 4.0, 5.0];
    assert_eq!(jets.binary(Binary::Min, &at(-1.0), &other), at(-1.0));
    assert_eq!(jets.binary(Binary::Max, &at(-1.0), &other), other);
    assert_eq!(jets.binary(Binary::Max, &at(0.0), &other), [0.0, 3.0, 1.0]);
    assert!(jets.binary(Binary::Max, &at(f64::NAN), &other)[0].is_nan());
}

#[test]
fn powers_at_zero_and_constants_at_singularities() {
    let mut jets = Calculator::new(1, 3);
    let x = jets.variable(0, 0.0);
    let power = |jets: &mut Calculator, p: f64| {
        let exponent = jets.constant(p);
        jets.binary(Binary::Pow, &x, &exponent)
    };
    assert_eq!(power(&mut jets, 0.0), [1.0, 0.0, 0.0, 0.0]);
    assert_eq!(power(&mut jets, 3.0), [0.0, 0.0, 0.0, 1.0]);
    assert_eq!(power(&mut jets, 40.0), [0.0; 4]);
    assert!(power(&mut jets, 2.5)[3].is_nan());
    let zero = jets.constant(0.0);
    assert_eq!(jets.unary(Unary::Sqrt, &zero), [0.0; 4]);
    assert!(!jets.unary(Unary::Sqrt, &x)[1].is_finite());
}

#[test]
fn fused_products() {
    let jets = Calculator::new(2, 2);
    let (a, b, c) = (jets.variable(0, 2.0), jets.variable(1, 3.0), jets.variable(0, -1.0));
    let mut out = vec![0.0; 6];
    jets.space.mul_add(&a, &b, &c, &mut out);
    assert_eq!(out, [5.0, 4.0, 2.0, 0.0, 1.0, 0.0]);
    jets.space.mul_sub(&a, &b, &c, &mut out);
    assert_eq!(out, [7.0, 2.0, 2.0, 0.0, 1.0, 0.0]);
    jets.space.sub_mul(&a, &b, &c, &mut out);
    assert_eq!(out, [-7.0, -2.0, -2.0, 0.0, -1.0, 0.0]);
}

/// A jet of three variables and order four with the given value; the other coefficients are moderate.
fn jet_at(value: impl Strategy<Value = f64>) -> impl Strategy<Value = Vec<f64>> {
    (value, prop::collection::vec(-0.5..0.5_f64, 34)).prop_map(|(value, rest)| [vec![value], rest].concat())
}

proptest! {
    #[test]
    fn identities(a in jet_at(-1.2..1.2_f64), b in jet_at(0.5..2.0_f64), inside in jet_at(-0.8..0.8_f64)) {
        let mut jets = Calculator::new(3, 4);
        let one = jets.constant(1.0);
        macro_rules! same {
            ($left:expr, $right:expr) => {
                let (left, right) = ($left, $right);
                prop_assert!(distance(&left, &right) < 1e-12, "{left:?} against {right:?}");
            };
        }
        let (s, c) = (jets.unary(Unary::Sin, &a), jets.unary(Unary::Cos, &a));
        let (mut sine, mut cosine) = (vec![0.0; 35], vec![0.0; 35]);
        jets.space.sin_cos(&a, &mut sine, &mut cosine, &mut jets.scratch);
        prop_assert_eq!((&s, &c), (&sine, &cosine));
        let (ss, cc) = (jets.binary(Binary::Mul, &s, &s), jets.binary(Binary::Mul, &c, &c));
        same!(jets.binary(Binary::Add, &ss, &cc), one.clone());
        same!(jets.unary(Unary::Tan, &a), jets.binary(Binary::Div, &s, &c));

        let (e, minus) = (jets.unary(Unary::Exp, &a), jets.unary(Unary::Neg, &a));
        same!(jets.unary(Unary::Log, &e), a.clone());
        let f = jets.unary(Unary::Exp, &minus);
        let (up, down) = (jets.binary(Binary::Sub, &e, &f), jets.binary(Binary::Add, &e, &f));
        same!(jets.unary(Unary::Tanh, &a), jets.binary(Binary::Div, &up, &down));

        let root = jets.unary(Unary::Sqrt, &b);
        same!(jets.binary(Binary::Mul, &root, &root), b.clone());
        let quotient = jets.binary(Binary::Div, &a, &b);
        same!(jets.binary(Binary::Mul, &quotient, &b), a.clone());

        let (asin, acos) = (jets.unary(Unary::Asin, &inside), jets.unary(Unary::Acos, &inside));
        same!(jets.unary(Unary::Sin, &asin), inside.clone());
        same!(jets.unary(Unary::Cos, &acos), inside.clone());
        let atan = jets.unary(Unary::Atan, &inside);
        same!(jets.unary(Unary::Tan, &atan), inside.clone());

        // atan2(b sin a, b cos a) = a, in every quadrant, up to whole turns.
        let (y, x) = (jets.binary(Binary::Mul, &b, &s), jets.binary(Binary::Mul, &b, &c));
        same!(jets.binary(Binary::Atan2, &y, &x), a.clone());
        same!(jets.binary(Binary::Atan2, &inside, &one), atan.clone());
        let half_turn = jets.constant(std::f64::consts::PI);
        let (y, x) = (jets.unary(Unary::Neg, &s), jets.unary(Unary::Neg, &c));
        let back = if a[0] > 0.0 { Binary::Sub } else { Binary::Add };
        same!(jets.binary(Binary::Atan2, &y, &x), jets.binary(back, &a, &half_turn));

        let log = jets.unary(Unary::Log, &b);
        for p in [-2.0, 0.7, 3.0] {
            let exponent = jets.constant(p);
            let scaled = jets.binary(Binary::Mul, &exponent, &log);
            same!(jets.binary(Binary::Pow, &b, &exponent), jets.unary(Unary::Exp, &scaled));
        }
        let scaled = jets.binary(Binary::Mul, &a, &log);
        same!(jets.binary(Binary::Pow, &b, &a), jets.unary(Unary::Exp, &scaled));
        let (three, negative) = (jets.constant(3.0), jets.unary(Unary::Neg, &b));
        let square = jets.binary(Binary::Mul, &negative, &negative);
        same!(jets.binary(Binary::Pow, &negative, &three), jets.binary(Binary::Mul, &square, &negative));
    }

    /// The constant term equals the value of a graph, to the bit.
    #[test]
    fn constant_terms_are_scalar(a in jet_at(-2.0..2.0_f64), b in jet_at(prop_oneof![-2.0..2.0_f64, Just(0.0), Just(-0.0)])) {
        let mut jets = Calculator::new(3, 4);
        let mut graph = Graph::new();
        let (x, y) = (graph.symbol("x"), graph.symbol("y"));
        let value_of = |expr| if expr == x { a[0] } else { b[0] };
        for function in [Unary::Neg, Unary::Sin, Unary::Cos, Unary::Tan, Unary::Asin, Unary::Acos, Unary::Atan,
                         Unary::Sqrt, Unary::Exp, Unary::Log, Unary::Abs, Unary::Tanh, Unary::Sign, Unary::Floor] {
            let node = graph.unary(function, x);
            let expected = graph.evaluate(&[node], value_of)[0];
            prop_assert_eq!(jets.unary(function, &a)[0].to_bits(), expected.to_bits());
        }
        for function in [Binary::Add, Binary::Sub, Binary::Mul, Binary::Div, Binary::Pow, Binary::Atan2, Binary::Min,
                         Binary::Max, Binary::Select, Binary::SelectElse] {
            let node = graph.binary(function, x, y);
            let expected = graph.evaluate(&[node], value_of)[0];
            prop_assert_eq!(jets.binary(function, &a, &b)[0].to_bits(), expected.to_bits());
        }
    }
}
