//! Another method for truths with events: Dormand and Prince's pair of orders 5 and 4, whose steps fall until kinks are
//! passed.

/// Stages' times and weights (Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I* (1993), table
/// II.5.2).
const TIMES: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const WEIGHTS: [&[f64]; 7] = [
    &[],
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];

/// The solution of y' = f(t, y) at whole multiples of `output_step`; each step's error is below `tolerance`, relative
/// to 1 or y where that is larger.
pub fn dormand_prince<const N: usize>(
    f: impl Fn(f64, [f64; N]) -> [f64; N],
    start: [f64; N],
    output_step: f64,
    rows: usize,
    tolerance: f64,
) -> Vec<[f64; N]> {
    let (mut y, mut h) = (start, 1e-3 * output_step);
    let mut solution = vec![y];
    for row in 1..rows {
        let mut t = (row - 1) as f64 * output_step;
        let end = row as f64 * output_step;
        while t < end {
            let last = t + h >= end;
            let step = if last { end - t } else { h };
            let mut slopes = [[0.0; N]; 7];
            let mut next = y;
            for stage in 0..7 {
                next = y;
                for (slope, weight) in slopes.iter().zip(WEIGHTS[stage]) {
                    next = std::array::from_fn(|i| next[i] + step * weight * slope[i]);
                }
                slopes[stage] = f(t + TIMES[stage] * step, next);
            }
            let error = (0..N).map(|i| {
                let part: f64 = slopes.iter().zip(ERROR).map(|(slope, weight)| weight * slope[i]).sum();
                (step * part).abs() / y[i].abs().max(1.0)
            });
            let ratio = error.fold(0.0, f64::max) / tolerance;
            if ratio <= 1.0 {
                t = if last { end } else { t + step };
                y = next;
            }
            if !last || ratio > 1.0 {
                h = step * (0.9 * ratio.powf(-0.2)).clamp(0.2, 5.0);
            }
        }
        solution.push(y);
    }
    solution
}
