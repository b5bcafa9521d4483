//! Another method for truths: Runge and Kutta's classical one, for equations in minimal coordinates.

/// The solution of y' = f(y) at whole multiples of `output_step`.
pub fn runge_kutta<const N: usize>(
    f: impl Fn([f64; N]) -> [f64; N],
    start: [f64; N],
    output_step: f64,
    rows: usize,
    steps_a_row: usize,
) -> Vec<[f64; N]> {
    let h = output_step / steps_a_row as f64;
    let along = |y: [f64; N], d: [f64; N], h: f64| -> [f64; N] { std::array::from_fn(|i| y[i] + h * d[i]) };
    let mut y = start;
    let mut solution = vec![y];
    for _ in 1..rows {
        for _ in 0..steps_a_row {
            let a = f(y);
            let b = f(along(y, a, 0.5 * h));
            let c = f(along(y, b, 0.5 * h));
            let d = f(along(y, c, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        solution.push(y);
    }
    solution
}
