//! Delays against the delayed signals that they approximate.

use mbint::results::{Bounds, Method};

use crate::common::{band, curve, largest, nominal, output, read, run};

/// Delays next to a mass that hangs still.
fn text(effects: &str, states: &str, outputs: &str, simulation: &str) -> String {
    format!(
        "
parameters: {{ late: {{ value: 0.2, unit: s, tolerance: 10% }} }}
bodies: {{ m: {{ mass: 1, coordinates: [x] }} }}
states: {{ {states} }}
effects: {{ {effects} }}
initial: {{ m.x: 0.5, m.vx: 0 }}
outputs: {{ {outputs}, late: late }}
simulation: {{ duration: 3, output_step: 0.1, {simulation} }}
bounds: {{ chebyshev: {{ order: 5 }}, scan: {{ points: 5 }} }}
"
    )
}

fn off(bounds: &Bounds, name: &str, from: f64, wanted: impl Fn(f64) -> f64) -> f64 {
    let rows = bounds.times.iter().zip(curve(bounds, name)).filter(|(t, _)| **t > from);
    largest(rows.map(|(&t, value)| value - wanted(t)))
}

/// A sine of x = ω T is met to n! (n−1)!/((2n)! (2n−1)!) x²ⁿ, the first term of the error of Padé's approximation, once
/// it has settled.
#[test]
fn sines_are_delayed() {
    for (simulation, allowed) in [("step: 2e-4", 1e-6), ("scheme: explicit, tolerance: 1e-10", 1e-9)] {
        for (order, missed) in
            [(2, 2.0 / (24.0 * 6.0)), (3, 12.0 / (720.0 * 120.0)), (5, 2880.0 / (3_628_800.0 * 362_880.0))]
        {
            let effects = format!("slow: {{ delay: {{ input: sin(5*t), time: late, order: {order} }} }}");
            let bounds = nominal(&read(&text(&effects, "", "slow: slow", simulation)));
            // x = 1; poles have real parts below −2/T, so that 2 s later nothing is left of the start.
            let error = off(&bounds, "slow", 2.0, |t| (5.0 * (t - 0.2)).sin());
            assert!(error < 1.1 * missed + allowed, "{simulation}, order {order}: {error:e}");
            assert!(order > 3 || error > 0.3 * missed, "{simulation}, order {order}: {error:e}");
        }
    }
}

/// A ramp is late by T itself, whatever T.
#[test]
fn bounds_of_a_delayed_ramp_match_those_of_the_delay() {
    let bounds =
        run(&read(&text("slow: { delay: { input: t, time: late, order: 3 } }", "", "slow: slow", "step: 1e-3")));
    assert_eq!(output(&bounds, "slow").unit, "s");
    for method in [Method::Chebyshev, Method::Scan] {
        let band = band(output(&bounds, "slow"), method);
        for (row, &t) in bounds.times.iter().enumerate().filter(|(_, t)| **t > 2.0) {
            let allowed = 1.01 * band.error.total[row] + 1e-12;
            assert!(
                (band.lower[row] - (t - 0.22)).abs() < allowed && (band.upper[row] - (t - 0.18)).abs() < allowed,
                "{method:?} at {t}"
            );
        }
    }
}

/// ẋ = −k x(t − T) with x = 1 before: Σ (−k)ʲ (t − (j − 1) T)ʲ/j! over j with t > (j − 1) T. Here x jumps in its rates,
/// at which a rational law rings: less, the more states it has.
#[test]
fn a_loop_with_a_delay_moves_by_the_method_of_steps() {
    let exact = |t: f64| {
        let mut sum = 1.0;
        let mut factor = 1.0;
        for j in 1..20 {
            let since = t - f64::from(j - 1) * 0.2;
            factor *= -3.0 / f64::from(j);
            if since > 0.0 {
                sum += factor * since.powi(j);
            }
        }
        sum
    };
    let errors = [2, 4, 8].map(|order| {
        let effects = format!("old: {{ delay: {{ input: x, time: late, order: {order}, initial: 1 }} }}");
        let states = "x: { rate: -3*old/(1 s), initial: 1 }";
        let bounds = nominal(&read(&text(&effects, states, "x: x", "step: 1e-3")));
        off(&bounds, "x", -1.0, exact)
    });
    println!("{errors:?}");
    assert!(errors[0] < 2e-2 && errors[1] < 0.3 * errors[0] && errors[2] < 0.3 * errors[1], "{errors:?}");
}

#[test]
fn delay_starts_in_equilibrium() {
    let effects =
        "old: { delay: { input: m.x, time: late, initial: 0.5 m } }, slow: { delay: { input: m.x, time: late } }";
    let bounds = nominal(&read(&text(effects, "", "old: old, slow: slow", "step: 1e-3")));
    assert!(off(&bounds, "old", -1.0, |_| 0.5) < 1e-12);
    assert_eq!((output(&bounds, "old").unit.as_str(), curve(&bounds, "slow")[0]), ("m", 0.0));
}

/// ẍ = −k x(t − T) − c ẋ with x = x₀ before, by Runge and Kutta's steps of T/10 through the cubic between old ones, in
/// rows of 0.02 s.
fn by_old_values(time: f64) -> Vec<f64> {
    const PARTS: usize = 10;
    let h = time / PARTS as f64;
    let mut known: Vec<[f64; 3]> = vec![[0.1, 0.0, -40.0]];
    let mut rows = vec![0.1];
    while rows.len() <= 100 {
        let at = |known: &Vec<[f64; 3]>, step: f64| -> f64 {
            let step = step - PARTS as f64;
            if step <= 0.0 {
                return 0.1;
            }
            let index = (step as usize).min(known.len() - 2);
            let (s, [a, da, _], [b, db, _]) = (step - index as f64, known[index], known[index + 1]);
            let (da, db) = (h * da, h * db);
            a + s * (da + s * (3.0 * (b - a) - 2.0 * da - db + s * (2.0 * (a - b) + da + db)))
        };
        let step = (known.len() - 1) as f64;
        let pull = |part: f64, v: f64| -400.0 * at(&known, step + part) - v;
        let [x, v, _] = known[known.len() - 1];
        let a1 = pull(0.0, v);
        let (v2, v3);
        v2 = v + 0.5 * h * a1;
        let a2 = pull(0.5, v2);
        v3 = v + 0.5 * h * a2;
        let a3 = pull(0.5, v3);
        let v4 = v + h * a3;
        let a4 = pull(1.0, v4);
        let next = [x + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4), v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)];
        known.push([next[0], next[1], 0.0]);
        let (before, now) = (step * h, (step + 1.0) * h);
        let wanted = 0.02 * rows.len() as f64;
        if now >= wanted - 1e-12 {
            // Within a step the motion is a parabola.
            let (s, dt) = (wanted - before, 0.5 * (a1 + a4));
            rows.push(x + v * s + 0.5 * dt * s * s);
        }
    }
    rows
}

/// A delay as short as a step has fast poles, which nothing excites: the stated error is the steps' error.
#[test]
fn stated_error_of_short_delays_is_that_of_the_steps() {
    let bounds = run(&read(
        "
parameters: { T: { value: 1 ms, tolerance: 20% } }
bodies: { p: { mass: 1, coordinates: [x] } }
effects:
  late: { delay: { input: p.x, time: T, initial: 0.1 m } }
  pull: { force: { on: p, value: [-400 N/m*late - 1 N*s/m*p.vx, 0] } }
initial: { p.x: 0.1, p.vx: 0 }
outputs: { x: p.x }
simulation: { duration: 2, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 5 } }
",
    ));
    let band = band(output(&bounds, "x"), Method::Chebyshev);
    let missed = largest([0.8e-3, 1e-3, 1.2e-3].map(|time| {
        let truth = by_old_values(time);
        largest((0..truth.len()).map(|row| {
            let (low, high) = (band.lower[row] - truth[row], truth[row] - band.upper[row]);
            assert!(low.max(high) <= band.error.total[row] + 1e-7, "{time} at {row}: {low} {high}");
            if time == 1e-3 { curve(&bounds, "x")[row] - truth[row] } else { 0.0 }
        }))
    }));
    let stated = largest(band.error.total.iter().copied());
    assert!(band.error.total[0] < 1e-5, "{:e}", band.error.total[0]);
    assert!(stated < 20.0 * missed, "{stated:e} stated, {missed:e} missed");
}
