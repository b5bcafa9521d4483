//! Dormand and Prince's method of order 8 with embedded errors of orders 5 and 3, DOP853: another method for truths.
//! Coefficients are the published ones (Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I* (1993),
//! section II.10 and its program).

/// Times of the stages.
#[rustfmt::skip]
const TIMES: [f64; 12] = [
    0.0, 0.05260015195876773, 0.0789002279381516, 0.1183503419072274, 0.2816496580927726, 1.0 / 3.0, 0.25, 4.0 / 13.0,
    127.0 / 195.0, 0.6, 6.0 / 7.0, 1.0,
];

/// Weights of the stages before each stage.
const WEIGHTS: [&[f64]; 12] = [
    &[],
    &[0.05260015195876773],
    &[0.0197250569845379, 0.0591751709536137],
    &[0.02958758547680685, 0.0, 0.08876275643042054],
    &[0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792],
    &[0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242],
    &[0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125],
    &[
        0.03709200011850479,
        0.0,
        0.0,
        0.17038392571223998,
        0.10726203044637328,
        -0.015319437748624402,
        0.008273789163814023,
    ],
    &[
        0.6241109587160757,
        0.0,
        0.0,
        -3.3608926294469414,
        -0.868219346841726,
        27.59209969944671,
        20.154067550477894,
        -43.48988418106996,
    ],
    &[
        0.47766253643826434,
        0.0,
        0.0,
        -2.4881146199716677,
        -0.590290826836843,
        21.230051448181193,
        15.279233632882423,
        -33.28821096898486,
        -0.020331201708508627,
    ],
    &[
        -0.9371424300859873,
        0.0,
        0.0,
        5.186372428844064,
        1.0914373489967295,
        -8.149787010746927,
        -18.52006565999696,
        22.739487099350505,
        2.4936055526796523,
        -3.0467644718982196,
    ],
    &[
        2.273310147516538,
        0.0,
        0.0,
        -10.53449546673725,
        -2.0008720582248625,
        -17.9589318631188,
        27.94888452941996,
        -2.8589982771350235,
        -8.87285693353063,
        12.360567175794303,
        0.6433927460157636,
    ],
];

/// Weights of the stages in the result, of order 8.
const RESULT: [f64; 12] = [
    0.054293734116568765,
    0.0,
    0.0,
    0.0,
    0.0,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    0.3111643669578199,
    -0.1521609496625161,
    0.20136540080403034,
    0.04471061572777259,
];

/// Weights of the difference between the result and one of order 5.
const FIFTH: [f64; 12] = [
    0.01312004499419488,
    0.0,
    0.0,
    0.0,
    0.0,
    -1.2251564463762044,
    -0.4957589496572502,
    1.6643771824549864,
    -0.35032884874997366,
    0.3341791187130175,
    0.08192320648511571,
    -0.022355307863886294,
];

/// A result of order 3.
const THIRD: [f64; 12] =
    [0.2440944881889764, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.7338466882816118, 0.0, 0.0, 0.022058823529411766];

/// y' = f(t, y): f writes the derivative into its last argument.
pub trait Equation: Fn(f64, &[f64], &mut [f64]) {}
impl<F: Fn(f64, &[f64], &mut [f64])> Equation for F {}

/// The solution at ascending times, from the first of them on; none of them is stepped over. Each step's error is below
/// `tolerance`, relative to y or 1, whichever is larger. Steps are no longer than `longest`.
pub fn solve<const N: usize>(
    f: impl Equation,
    start: &[f64; N],
    times: &[f64],
    tolerance: f64,
    longest: f64,
) -> Vec<[f64; N]> {
    let mut y = *start;
    let mut stages = [[0.0; N]; 12];
    let mut solution = vec![y];
    let mut h = 1e-3 * (times.last().copied().unwrap_or(0.0) - times[0]).min(longest);
    for ends in times.windows(2) {
        let mut t = ends[0];
        while t < ends[1] {
            let (step, is_last) = towards(t, h, ends[1]);
            let next = attempt(&f, t, &y, step, &mut stages);
            let error = step * error(&stages, &y, tolerance);
            if error <= 1.0 {
                y = next;
                t = if is_last { ends[1] } else { t + step };
            }
            // A step that was cut short by a row says nothing against longer ones.
            if !is_last || error > 1.0 {
                h = following(step, error, 5.0).min(longest);
            }
            assert!(step > 1e-14 * ends[1].abs() || is_last, "the reference solution does not proceed at {t} s");
        }
        solution.push(y);
    }
    solution
}

/// Length of a step from t that is h long or ends at a time, and whether it ends there.
fn towards(t: f64, h: f64, end: f64) -> (f64, bool) {
    let is_last = t + h >= end;
    (if is_last { end - t } else { h }, is_last)
}

/// Length of the step after one with this error over the tolerance, at most `most` times as long.
fn following(step: f64, error: f64, most: f64) -> f64 {
    step * (0.9 * error.powf(-0.125)).clamp(0.2, most)
}

/// The stages of a step from y at t, and where it leads.
fn attempt<const N: usize>(
    f: &impl Equation,
    t: f64,
    y: &[f64; N],
    step: f64,
    stages: &mut [[f64; N]; 12],
) -> [f64; N] {
    for stage in 0..12 {
        let mut inner = *y;
        for (k, weight) in stages.iter().zip(WEIGHTS[stage]).filter(|(_, weight)| **weight != 0.0) {
            inner.iter_mut().zip(k).for_each(|(inner, k)| *inner += step * weight * k);
        }
        f(t + TIMES[stage] * step, &inner, &mut stages[stage]);
    }
    let rates = weighted(stages, &RESULT);
    std::array::from_fn(|i| y[i] + step * rates[i])
}

/// y' = f(t, y, sides): `sides` has for each switch whether it is positive.
pub trait Sided: Fn(f64, &[f64], &[bool], &mut [f64]) {}
impl<F: Fn(f64, &[f64], &[bool], &mut [f64])> Sided for F {}

/// As [`solve`], where f changes at zeros of switches, functions of t and y: within a step f keeps the sides of its
/// beginning, and a step in which a switch changes its sign, also there and back, ends at its zero, to rounding.
pub fn solve_located<const N: usize, const S: usize>(
    f: impl Sided,
    switches: impl Fn(f64, &[f64]) -> [f64; S],
    start: &[f64; N],
    times: &[f64],
    tolerance: f64,
    longest: f64,
) -> Vec<[f64; N]> {
    let mut y = *start;
    let mut stages = [[0.0; N]; 12];
    let mut solution = vec![y];
    let mut sides = switches(times[0], &y).map(|value| value > 0.0);
    let mut h = longest;
    for ends in times.windows(2) {
        let mut t = ends[0];
        while t < ends[1] {
            let (step, is_last) = towards(t, h, ends[1]);
            let held = |t: f64, y: &[f64], d: &mut [f64]| f(t, y, &sides, d);
            let mut next = attempt(&held, t, &y, step, &mut stages);
            let error = step * error(&stages, &y, tolerance);
            if error > 1.0 {
                h = following(step, error, 0.9);
                assert!(h > 1e-14 * ends[1].abs(), "the reference solution does not proceed at {t} s");
                continue;
            }
            let mut after = |step: f64| attempt(&held, t, &y, step, &mut stages);
            let sides_at = |step: f64, y: &[f64]| switches(t + step, y).map(|value| value > 0.0);
            let mut taken = step;
            if sides_at(step, &next) == sides {
                let rate = |t: f64, y: &[f64; N]| rates(&held, &switches, t, y, 1e-6 * step);
                let values = [switches(t, &y), switches(t + step, &next)];
                let rates = [rate(t, &y), rate(t + step, &next)];
                let at = |share: f64, i: usize| switches(t + share * step, &after(share * step))[i];
                if let Some(touch) = touched(values, rates, at) {
                    (taken, next) = (touch * step, after(touch * step));
                }
            }
            if sides_at(taken, &next) != sides {
                let at = |step: f64| {
                    let next = after(step);
                    (switches(t + step, &next), next)
                };
                (taken, next) = crossed(&sides, taken, 4.0 * f64::EPSILON * ends[1].abs(), at);
            }
            let now = sides_at(taken, &next);
            let is_cut = taken < step;
            (y, sides) = (next, now);
            t = if is_last && !is_cut { ends[1] } else { t + taken };
            if !is_last || is_cut {
                h = following(step, error, 5.0).min(longest);
            }
        }
        solution.push(y);
    }
    solution
}

/// Rates of switches at y, from their differences over so short a time.
fn rates<const N: usize, const S: usize>(
    f: &impl Equation,
    switches: &impl Fn(f64, &[f64]) -> [f64; S],
    t: f64,
    y: &[f64; N],
    short: f64,
) -> [f64; S] {
    let mut slope = [0.0; N];
    f(t, y, &mut slope);
    let moved = |time: f64| switches(t + time, &std::array::from_fn::<f64, N, _>(|i| y[i] + time * slope[i]));
    let [before, after] = [moved(-short), moved(short)];
    std::array::from_fn(|i| after[i] - before[i])
}

/// Share of a step at which a switch has another sign than at both ends: about the vertices of parabolas, which are
/// drawn ever closer, for those that come nearer at the beginning and go away at the end.
fn touched<const S: usize>(
    [first, last]: [[f64; S]; 2],
    [begins, ends]: [[f64; S]; 2],
    mut at: impl FnMut(f64, usize) -> f64,
) -> Option<f64> {
    (0..S).filter(|&i| first[i] * begins[i] <= 0.0 && last[i] * ends[i] >= 0.0).find_map(|i| {
        let nearest = first[i].abs().min(last[i].abs());
        let (mut middle, mut reach) = (0.5, 0.5);
        for _ in 0..6 {
            let [a, b, c] = [middle - reach, middle, middle + reach].map(|share| at(share, i));
            let vertex = middle + 0.5 * reach * (a - c) / (a - 2.0 * b + c);
            if !(vertex > 0.0 && vertex < 1.0) {
                return None;
            }
            let value = at(vertex, i);
            if (value > 0.0) != (first[i] > 0.0) {
                return Some(vertex);
            }
            if value.abs() > nearest {
                return None;
            }
            reach = 0.2 * reach.min(vertex).min(1.0 - vertex);
            middle = vertex;
        }
        None
    })
}

/// Just behind the first change of sides before `taken`, to within `fine`: the step, and where it leads. By chords,
/// which aim a little towards the middle so that both ends close in, and by halves where these are slow.
fn crossed<const N: usize, const S: usize>(
    sides: &[bool; S],
    taken: f64,
    fine: f64,
    mut at: impl FnMut(f64) -> ([f64; S], [f64; N]),
) -> (f64, [f64; N]) {
    let (whole, mut before, mut behind) = (taken, 0.0, taken);
    let (mut held, _) = at(before);
    let (mut changed, mut next) = at(behind);
    let mut is_slow = false;
    while behind - before > fine {
        let width = behind - before;
        let zero = |i: usize| held[i].abs() / (held[i].abs() + changed[i].abs());
        let others = (0..S).filter(|&i| (changed[i] > 0.0) != sides[i]);
        let first = before + width * others.map(zero).fold(1.0, f64::min);
        let middle = before + 0.5 * width;
        let inwards = (0.02 * width * width / whole).max(0.5 * fine);
        let chord = if first < middle { (first + inwards).min(middle) } else { (first - inwards).max(middle) };
        let step = if is_slow { middle } else { chord };
        let (values, state) = at(step);
        if values.map(|value| value > 0.0) == *sides {
            (before, held) = (step, values);
        } else {
            (behind, changed, next) = (step, values, state);
        }
        is_slow = !is_slow && behind - before > 0.5 * width;
    }
    (behind, next)
}

fn weighted<const N: usize>(stages: &[[f64; N]; 12], weights: &[f64; 12]) -> [f64; N] {
    let mut sums = [0.0; N];
    for (k, weight) in stages.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        sums.iter_mut().zip(k).for_each(|(sum, k)| *sum += weight * k);
    }
    sums
}

/// By the formula of the program: e₅² / √(e₅² + 0.01 e₃²), over the step and relative to the tolerance.
fn error<const N: usize>(stages: &[[f64; N]; 12], y: &[f64; N], tolerance: f64) -> f64 {
    let [result, of_third, of_fifth] = [&RESULT, &THIRD, &FIFTH].map(|weights| weighted(stages, weights));
    let (mut fifth, mut third) = (0.0, 0.0);
    for i in 0..N {
        let scale = tolerance * y[i].abs().max(1.0);
        fifth += (of_fifth[i] / scale).powi(2);
        third += ((result[i] - of_third[i]) / scale).powi(2);
    }
    let both = fifth + 0.01 * third;
    if both > 0.0 { fifth / (both * N as f64).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::{solve, solve_located};

    /// A fixed step: with no tolerance, `longest` decides.
    fn error_at(steps: usize) -> f64 {
        // x'' = −x + cos(2t), from rest at x = 1: x = (4 cos t − cos 2t)/3.
        let f = |t: f64, y: &[f64], d: &mut [f64]| (d[0], d[1]) = (y[1], -y[0] + (2.0 * t).cos());
        let times: Vec<f64> = (0..=steps).map(|i| 3.0 * i as f64 / steps as f64).collect();
        let solution = solve(f, &[1.0, 0.0], &times, 1e9, 3.0 / steps as f64);
        (solution[steps][0] - (4.0 * 3.0_f64.cos() - 6.0_f64.cos()) / 3.0).abs()
    }

    #[test]
    fn converges_with_order_eight() {
        let [coarse, fine] = [6, 12].map(error_at);
        let order = (coarse / fine).log2();
        assert!((7.5..9.5).contains(&order), "{order}: {coarse:e}, {fine:e}");
    }

    /// Kepler's ellipse of eccentricity 0.6: after a period it is where it was.
    #[test]
    fn closes_an_ellipse() {
        let f = |_: f64, y: &[f64], d: &mut [f64]| {
            let cube = y[0].hypot(y[1]).powi(3);
            d.copy_from_slice(&[y[2], y[3], -y[0] / cube, -y[1] / cube]);
        };
        let start = [0.4, 0.0, 0.0, 2.0];
        let solution = solve(f, &start, &[0.0, std::f64::consts::TAU], 1e-13, 1.0);
        for (end, start) in solution[1].iter().zip(start) {
            assert!((end - start).abs() < 1e-10, "{end} {start}");
        }
    }

    /// A ball that is dropped from 1 m onto a spring of 1e4 N/m and 1 kg: parabola, sine, parabola, with a period.
    #[test]
    fn an_impact_is_located() {
        let f = |_: f64, y: &[f64], sides: &[bool], d: &mut [f64]| {
            let push = if sides[0] { 0.0 } else { -1e4 * y[0] };
            (d[0], d[1]) = (y[1], push - 9.81);
        };
        let (fall, speed, omega) = ((2.0 / 9.81_f64).sqrt(), (2.0 * 9.81_f64).sqrt(), 100.0);
        let period = 2.0 * fall + 2.0 / omega * (std::f64::consts::PI - (speed * omega / 9.81).atan());
        let found = solve_located(f, |_, y| [y[0]], &[1.0, 0.0], &[0.0, period, 2.0 * period], 1e-13, 0.01);
        for state in &found {
            assert!((state[0] - 1.0).abs() < 1e-10 && state[1].abs() < 1e-9, "{state:?}");
        }
    }

    /// v = 1, but 2 within 1e-3 of x = 0.5: passed in steps of 0.1.
    #[test]
    fn a_touch_within_a_step_is_located() {
        let f = |_: f64, _: &[f64], sides: &[bool], d: &mut [f64]| d[0] = if sides[0] { 2.0 } else { 1.0 };
        let near = |_: f64, y: &[f64]| [1e-6 - (y[0] - 0.5) * (y[0] - 0.5)];
        let found = solve_located(f, near, &[0.03], &[0.0, 0.9], 1e-13, 0.1);
        assert!((found[1][0] - 0.931).abs() < 1e-12, "{found:?}");
    }
}
