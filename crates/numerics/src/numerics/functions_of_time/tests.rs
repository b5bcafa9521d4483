//! Against closed forms, and against all chains of values and all levels of a grid.

use super::*;

/// Numbers in [−1, 1) that are spread evenly.
fn spread(number: usize) -> f64 {
    2.0 * (number as f64 * 0.618_033_988_749_895).fract() - 1.0
}

fn kernel(count: usize, seed: usize) -> Vec<Cell> {
    (0..count).map(|cell| [spread(7 * cell + seed), 0.3 * spread(11 * cell + seed)]).collect()
}

/// The largest value of all chains over a grid of values between limits, by trying them all.
fn tried(ratio: f64, limits: impl Fn(usize) -> [f64; 2], ends: &[f64], functional: &[Cell], points: usize) -> f64 {
    let grid: Vec<f64> = (0..points).map(|point| 2.0 * point as f64 / (points - 1) as f64 - 1.0).collect();
    let within = |number: usize, value: f64| {
        let [lower, upper] = limits(number);
        value >= lower - 1e-9 && value <= upper + 1e-9
    };
    let mut best: Vec<f64> = grid.iter().map(|own| if within(0, *own) { 0.0 } else { f64::NEG_INFINITY }).collect();
    for (cell, by) in functional.iter().enumerate() {
        let reach = ratio * (ends[cell] - begin(ends, cell)) * (1.0 + 1e-9);
        let of_end = |to: f64| {
            let from = grid.iter().zip(&best).filter(|(from, _)| (to - **from).abs() <= reach);
            let values = from.map(|(from, best)| {
                let own = straight(ends, cell, *from, to);
                best + by[0] * own[0] + by[1] * own[1]
            });
            values.fold(f64::NEG_INFINITY, f64::max)
        };
        best = grid.iter().map(|to| if within(cell + 1, *to) { of_end(*to) } else { f64::NEG_INFINITY }).collect();
    }
    best.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn chains_of_values_are_optimal() {
    for seed in 0..12 {
        let ends = [0.1, 0.2, 0.35, 0.5, 0.6, 0.8, 1.0];
        let functional = kernel(ends.len(), seed);
        // Steps of the grid are divisors of the change that a cell allows, so that the grid contains a best chain.
        let Worst { value: best, function, .. } = FunctionClass::BoundedRate(4.0).worst(&ends, &functional);
        let expected = tried(4.0, |_| [-1.0, 1.0], &ends, &functional, 101);
        assert!((best - expected).abs() < 1e-9, "{best}, not {expected}, of {seed}");
        let mut before = None;
        for (cell, [level, slope]) in function.iter().enumerate() {
            let [from, to] = [begin(&ends, cell), ends[cell]].map(|time| level + slope * time);
            assert!(slope.abs() <= 4.0 + 1e-9 && from.abs() <= 1.0 + 1e-12 && to.abs() <= 1.0 + 1e-12);
            assert!(before.is_none_or(|before: f64| (before - from).abs() < 1e-9));
            before = Some(to);
        }
    }
}

#[test]
fn a_rate_beyond_all_limits_does_not_limit() {
    let ends: Vec<f64> = (1..=400).map(|end| 0.01 * f64::from(end)).collect();
    // The kernel cos(3 τ): ∫|cos 3τ| over 4 s.
    let functional: Vec<Cell> = ends.iter().map(|end| [0.01 * (3.0 * (end - 0.005)).cos(), 0.0]).collect();
    let Worst { value: free, .. } = FunctionClass::Bounded.worst(&ends, &functional);
    let integral = (8.0 + 12.0_f64.sin()) / 3.0;
    assert!((free - integral).abs() < 1e-3, "{free}, not {integral}");
    let slopes: Vec<Cell> =
        functional.iter().enumerate().map(|(cell, by)| [by[0], by[0] * (begin(&ends, cell) + 0.005)]).collect();
    let Worst { value: fast, .. } = FunctionClass::BoundedRate(1e4).worst(&ends, &slopes);
    let Worst { value: slow, .. } = FunctionClass::BoundedRate(1.0).worst(&ends, &slopes);
    assert!(fast > 0.98 * free && fast <= free * (1.0 + 1e-12) && slow < 0.5 * free, "{slow} {fast} {free}");
}

#[test]
fn bounded_rate_gives_the_integral_of_the_step_response() {
    // y(T) = ∫ u dτ with |u̇| ≤ 1: T²/2, of all slopes 1.
    let ends: Vec<f64> = (1..=50).map(|end| 0.1 * f64::from(end)).collect();
    let functional: Vec<Cell> = (0..50).map(|cell| [0.1, 0.1 * (begin(&ends, cell) + 0.05)]).collect();
    let Worst { value: best, function, .. } = FunctionClass::Rate.worst(&ends, &functional);
    assert!((best - 12.5).abs() < 1e-9 && function.iter().all(|[_, slope]| (*slope - 1.0).abs() < 1e-9));
}

#[test]
fn held_function_has_the_sign_of_its_period() {
    let ends = [0.1, 0.2, 0.3, 0.4, 0.5];
    let functional = [[1.0, 0.0], [-3.0, 0.0], [1.0, 0.0], [1.0, 0.0], [-0.5, 0.0]];
    let Worst { value: best, function, .. } = FunctionClass::Held(0.2).worst(&ends, &functional);
    assert_eq!(best, 2.0 + 2.0 + 0.5);
    assert_eq!(function.map_levels(), [-1.0, -1.0, 1.0, 1.0, -1.0]);
}

trait Levels {
    fn map_levels(&self) -> Vec<f64>;
}

impl Levels for Vec<Cell> {
    fn map_levels(&self) -> Vec<f64> {
        self.iter().map(|[level, _]| *level).collect()
    }
}

#[test]
fn loss_of_a_cell_matches_that_of_a_straight_kernel() {
    // h = τ − z over four cells: cells have the integrals k − 1/2 − z, and lose (z − 2)² or (3 − z)² of it.
    let ends = [1.0, 2.0, 3.0, 4.0];
    for z in [2.0, 2.2, 2.5, 2.9] {
        let functional: Vec<Cell> = (1..=4).map(|k| [f64::from(k) - 0.5 - z, 0.0]).collect();
        let found = FunctionClass::Bounded.worst(&ends, &functional).loss;
        let whole = 0.5 * (z * z + (4.0 - z).powi(2));
        let lost = whole - FunctionClass::Bounded.worst(&ends, &functional).value;
        let expected = (z - 2.0).min(3.0 - z).powi(2);
        assert!((lost - expected).abs() < 1e-12 && lost <= found + 1e-12 && found <= 0.5, "{z}: {lost} {found}");
    }
    assert_eq!(FunctionClass::Held(2.0).worst(&ends, &[[1.0, 0.0]; 4]).loss, 0.0);
}

#[test]
fn chains_between_moving_limits_are_optimal() {
    let ends = [0.1, 0.2, 0.35, 0.5, 0.6, 0.8, 1.0];
    // Lengths of cells times the rate are multiples of the grid's 0.02, and so are limits.
    let paths: [[f64; 8]; 3] = [
        [0.2, 0.6, 0.2, 0.8, 0.3, -0.1, 0.7, 1.0],
        [1.0, 0.6, 0.4, -0.2, -0.5, -0.1, -0.9, -0.1],
        [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7],
    ];
    for (seed, path) in (0..30).map(|seed| (seed, paths[seed % 3])) {
        let width = [0.0, 0.1, 0.6][seed / 10];
        let ends_of = |number: usize| [(path[number] - width).max(-1.0), path[number]];
        let of_x = kernel(ends.len(), seed);
        let expected = tried(4.0, ends_of, &ends, &of_x, 101);
        // x = middle + reach u, so that the functional of u has other coefficients; and a constant.
        let limits: Arc<[[f64; 2]]> =
            (0..8).map(ends_of).map(|[lower, upper]| [0.5 * (upper + lower), 0.5 * (upper - lower)]).collect();
        let by_x = rate::by_values(&ends, &of_x);
        let middle: f64 = by_x.iter().zip(&*limits).map(|(by, [middle, _])| by * middle).sum();
        let of_u = of_values(&ends, by_x.iter().zip(&*limits).map(|(by, [_, reach])| by * reach).collect());
        let class = FunctionClass::Moving { limits: limits.clone(), rate: 4.0 };
        let Worst { value: best, function, .. } = class.worst(&ends, &of_u);
        assert!((middle + best - expected).abs() < 1e-9, "{}, not {expected}, of {seed}", middle + best);
        let mut before = None;
        for (cell, [level, slope]) in function.iter().enumerate() {
            let [from, to] = [(cell, begin(&ends, cell)), (cell + 1, ends[cell])].map(|(number, time)| {
                let u = level + slope * time;
                assert!(u.abs() <= 1.0 + 1e-9, "{seed}: {u}");
                limits[number][0] + limits[number][1] * u
            });
            assert!((to - from).abs() <= 4.0 * (ends[cell] - begin(&ends, cell)) + 1e-9, "{seed}");
            assert!(before.is_none_or(|before: f64| (before - from).abs() < 1e-9));
            before = Some(to);
        }
        for sign in [-1.0, 1.0] {
            assert!(value(&of_u, &class.constant(sign, &ends)) <= best + 1e-12);
        }
        assert!(class.worst(&ends, &of_u).loss >= 0.0);
    }
}

/// The functional of functions that are straight between values, of its coefficients of these.
fn of_values(ends: &[f64], by_values: Vec<f64>) -> Vec<Cell> {
    // Each cell takes half of the values at its ends, those at the beginning and at the end whole.
    let share = |number: usize| if number == 0 || number == ends.len() { 1.0 } else { 0.5 };
    let of_cell = |cell: usize| {
        let [a, b] = [cell, cell + 1].map(|number| share(number) * by_values[number]);
        // a (level + slope t₀) + b (level + slope t₁)
        [a + b, a * begin(ends, cell) + b * ends[cell]]
    };
    (0..ends.len()).map(of_cell).collect()
}

/// The largest value over levels of a grid that fulfil a condition, by trying them all.
fn best_of_levels(functional: &[Cell], points: usize, holds: impl Fn(&[f64]) -> bool) -> f64 {
    let mut levels = vec![0.0; functional.len()];
    let mut best = f64::NEG_INFINITY;
    for mut number in 0..points.pow(functional.len() as u32) {
        for level in &mut levels {
            *level = 2.0 * (number % points) as f64 / (points - 1) as f64 - 1.0;
            number /= points;
        }
        if holds(&levels) {
            best = best.max(functional.iter().zip(&levels).map(|([by, _], level)| by * level).sum());
        }
    }
    best
}

#[test]
fn functions_of_a_given_mean_are_optimal() {
    let ends = [0.1, 0.2, 0.4, 0.5, 0.7];
    let lengths = [0.1, 0.1, 0.2, 0.1, 0.2];
    for (seed, mean) in [(0, 0.0), (1, 1.0), (2, -3.0), (3, 5.0), (4, -7.0), (5, 7.0), (6, 2.0)] {
        let mut functional = kernel(ends.len(), seed);
        if seed > 3 {
            functional[3][0] = 0.0;
        }
        // Sevenths of the mean are multiples of the grid's levels by the cells' lengths.
        for [least, most] in [[mean / 7.0; 2], [mean / 7.0 - 1.0 / 7.0, mean / 7.0]] {
            let class = FunctionClass::Mean([least, most]);
            let Worst { value: best, function, .. } = class.worst(&ends, &functional);
            let holds = |levels: &[f64]| {
                let mean = levels.iter().zip(&lengths).map(|(level, length)| level * length).sum::<f64>() / 0.7;
                mean > least - 1e-9 && mean < most + 1e-9
            };
            assert!(holds(&function.map_levels()) || least < -1.0, "{seed}: {function:?}");
            let expected = best_of_levels(&functional, 5, holds);
            assert!((best - expected).abs() < 1e-12, "{best}, not {expected}, of {seed}, {mean}");
        }
    }
}

#[test]
fn a_limited_energy_follows_the_kernel() {
    // ∫ cos 3τ u over 4 s with ∫ u² ≤ 2 s: √(2 ∫ cos² 3τ), by Cauchy and Schwarz.
    let ends: Vec<f64> = (1..=400).map(|end| 0.01 * f64::from(end)).collect();
    let integral = |time: f64| (3.0 * time).sin() / 3.0;
    let functional: Vec<Cell> = ends.iter().map(|end| [integral(*end) - integral(end - 0.01), 0.0]).collect();
    let class = |energy: f64, bounded: bool| FunctionClass::Energy { energy, bounded };
    let expected = (2.0 * (2.0 + 24.0_f64.sin() / 12.0)).sqrt();
    let Worst { value: best, .. } = class(2.0, false).worst(&ends, &functional);
    let loss = class(2.0, false).worst(&ends, &functional).loss;
    assert!(best <= expected && expected - best <= 1.1 * loss && loss < 2e-3, "{best} {expected} {loss}");
    // With |u| ≤ 1 it is less; with energy enough it is that of all bounded functions.
    let Worst { value: bounded, function, .. } = class(2.0, true).worst(&ends, &functional);
    let spent: f64 = function.iter().map(|[level, _]| 0.01 * level * level).sum();
    assert!(bounded < best && (spent - 2.0).abs() < 1e-9 && function.iter().all(|[level, _]| level.abs() <= 1.0));
    let Worst { value: free, .. } = FunctionClass::Bounded.worst(&ends, &functional);
    assert!((class(4.0, true).worst(&ends, &functional).value - free).abs() < 1e-12 && bounded < free);
    // u = λh cut off at 1 is the best: no other function of the same energy goes further.
    for seed in 0..200 {
        let other: Vec<f64> =
            (0..400).map(|cell| (function[cell][0] + 0.3 * spread(seed * 400 + cell)).clamp(-1.0, 1.0)).collect();
        let energy: f64 = other.iter().map(|level| 0.01 * level * level).sum();
        let scale = (2.0 / energy).sqrt().min(1.0);
        let reached: f64 = functional.iter().zip(&other).map(|([by, _], level)| by * level * scale).sum();
        assert!(reached <= bounded, "{seed}");
    }
}

#[test]
fn worst_function_of_a_band_is_a_sine_at_its_peak() {
    // ∫ sin 5τ cos(ωτ + φ) over 4 s: |∫ sin 5τ exp(iωτ)| is largest near 5 rad/s.
    let ends: Vec<f64> = (1..=800).map(|end| 0.005 * f64::from(end)).collect();
    let moments = |end: f64| {
        let (from, h) = (end - 0.005, 0.005);
        let level = ((5.0 * from).cos() - (5.0 * end).cos()) / 5.0;
        let slope = |t: f64| (5.0 * t).sin() / 25.0 - t * (5.0 * t).cos() / 5.0;
        [level, slope(from + h) - slope(from)]
    };
    let functional: Vec<Cell> = ends.iter().map(|end| moments(*end)).collect();
    let size = |omega: f64| {
        let part = |w: f64| [(1.0 - (4.0 * w).cos()) / w, (4.0 * w).sin() / w];
        let ([a, b], [c, d]) = (part(5.0 + omega), part(5.0 - omega));
        (0.5 * (a + c)).hypot(0.5 * (d - b))
    };
    let band = |from: f64, to: f64| FunctionClass::Band([from, to]);
    let expected = (0..4000).map(|number| size(3.0 + 0.001 * f64::from(number))).fold(0.0, f64::max);
    let Worst { value: best, function, .. } =
        band(3.0 / std::f64::consts::TAU, 7.0 / std::f64::consts::TAU).worst(&ends, &functional);
    let loss = band(3.0 / std::f64::consts::TAU, 7.0 / std::f64::consts::TAU).worst(&ends, &functional).loss;
    assert!((best - expected).abs() <= 2.0 * loss && loss < 1e-3, "{best} {expected} {loss}");
    for (cell, [level, slope]) in function.iter().enumerate() {
        assert!((level + slope * ends[cell]).abs() <= 1.0 + 1e-12);
    }
    // A band next to the peak has its maximum at the nearer end.
    let beside = band(7.5 / std::f64::consts::TAU, 7.6 / std::f64::consts::TAU).worst(&ends, &functional).value;
    assert!((beside - size(7.5).max(size(7.6))).abs() < 1e-3 && beside < best, "{beside}");
    // One frequency.
    let one = band(4.9 / std::f64::consts::TAU, 4.9 / std::f64::consts::TAU).worst(&ends, &functional).value;
    assert!((one - size(4.9)).abs() < 1e-4);
}
