//! Half a car with stops and tyres that lift off, over any road of a limited slope: its worst roads against random
//! ones, and replayed, by the classical Runge and Kutta method. `MBINT_SAMPLES` is the number of random roads.

use rayon::prelude::*;

use crate::common::{read, run_methods};

/// Steps of 1 ms.
const STEP: f64 = 1e-3;
const STEPS: usize = 1000;
/// Steps of a row.
const EVERY: usize = 100;

/// Positions and velocities of the body, its angle, the front and the rear wheel.
type State = [f64; 8];

/// Accelerations under heights of the road.
fn accelerations(state: &State, roads: [f64; 2]) -> [f64; 4] {
    let (body, wheel, g) = (700.0, 40.0, 9.81);
    let arms = [1.2, -1.5];
    let loads = [body * g * 1.5 / 2.7, body * g * 1.2 / 2.7];
    let (sine, cosine) = state[1].sin_cos();
    let (mut lift, mut moment, mut wheels) = (-body * g, 0.0, [0.0; 2]);
    for side in 0..2 {
        let (y, vy) = (state[0] + arms[side] * sine, state[4] + arms[side] * cosine * state[5]);
        let (at, speed) = (state[2 + side], state[6 + side]);
        let stop = 150e3 * ((at - y - 0.05).max(0.0) - (y - at - 0.05).max(0.0));
        let push = loads[side] - 22e3 * (y - at) - 1.5e3 * (vy - speed) + stop;
        lift += push;
        moment += push * arms[side] * cosine;
        let tyre = (loads[side] + wheel * g + 190e3 * (roads[side] - at)).max(0.0);
        wheels[side] = (tyre - push) / wheel - g;
    }
    [lift / body, moment / 900.0, wheels[0], wheels[1]]
}

/// The body's height and the driver's acceleration at the end of each row.
fn motion(road: impl Fn(f64) -> [f64; 2]) -> Vec<[f64; 2]> {
    let mut state: State = [0.0; 8];
    let rate = |state: &State, time: f64| -> State {
        let [a, b, c, d] = accelerations(state, road(time));
        [state[4], state[5], state[6], state[7], a, b, c, d]
    };
    let along = |state: &State, by: &State, h: f64| -> State { std::array::from_fn(|i| state[i] + h * by[i]) };
    let mut rows = Vec::new();
    for step in 0..STEPS {
        let t = STEP * step as f64;
        let a = rate(&state, t);
        let b = rate(&along(&state, &a, 0.5 * STEP), t + 0.5 * STEP);
        let c = rate(&along(&state, &b, 0.5 * STEP), t + 0.5 * STEP);
        let d = rate(&along(&state, &c, STEP), t + STEP);
        state = std::array::from_fn(|i| state[i] + STEP / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        if (step + 1) % EVERY == 0 {
            let own = accelerations(&state, road(t + STEP));
            let (sine, cosine) = state[1].sin_cos();
            // The driver sits 0.2 m before the middle and 0.3 m above it.
            let (x, y) = (0.2 * cosine - 0.3 * sine, 0.2 * sine + 0.3 * cosine);
            rows.push([state[0], own[0] + x * own[1] - y * state[5] * state[5]]);
        }
    }
    rows
}

/// Numbers in [0, 1).
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A road within 60 mm whose slope is 0.5 m/s either way, or 0, and changes at random: its heights at half steps.
fn random_road(next: &mut impl FnMut() -> f64) -> Vec<f64> {
    let mean = 0.02 + 0.4 * next() * next();
    let flat = 0.3 * next();
    let (mut height, mut slope, mut left) = (0.12 * next() - 0.06, 0.5, 0.0);
    let mut road = Vec::with_capacity(2 * STEPS + 2);
    for _ in 0..2 * STEPS + 2 {
        if left <= 0.0 {
            left = -mean * (1.0 - next()).ln();
            slope = if next() < flat {
                0.0
            } else if next() < 0.5 {
                0.5
            } else {
                -0.5
            };
        }
        road.push(height);
        height = (height + slope * 0.5 * STEP).clamp(-0.06, 0.06);
        left -= 0.5 * STEP;
    }
    road
}

fn compare(roads: u64) {
    let model = read(include_str!("../../docs/examples/half_car_on_a_road.yaml"));
    let (bounds, _) = run_methods(&model, None);
    let of_road = |seed: u64| {
        let mut next = numbers(seed + 1);
        let [front, rear] = [random_road(&mut next), random_road(&mut next)];
        let at = |time: f64| (2.0 * time / STEP).round() as usize;
        motion(|time| [front[at(time)], rear[at(time)]])
    };
    let nothing = || vec![[[f64::INFINITY, f64::NEG_INFINITY]; 2]; STEPS / EVERY];
    let wider = |mut a: Vec<[[f64; 2]; 2]>, b: Vec<[[f64; 2]; 2]>| {
        for (a, b) in a.iter_mut().flatten().zip(b.iter().flatten()) {
            *a = [a[0].min(b[0]), a[1].max(b[1])];
        }
        a
    };
    let ranges = (0..roads)
        .into_par_iter()
        .map(|seed| of_road(seed).into_iter().map(|row| row.map(|value| [value, value])).collect())
        .reduce(nothing, wider);
    let mut beyond = 0.0_f64;
    for (row, ranges) in ranges.iter().enumerate() {
        for (output, [least, greatest]) in ranges.iter().enumerate() {
            let band = &bounds.outputs[output].bands[0];
            let (lower, upper, error) = (band.lower[row + 1], band.upper[row + 1], band.error.total[row + 1]);
            beyond = beyond.max((lower - least).max(greatest - upper) / error);
        }
    }
    println!("{roads} random roads come at most {beyond:.3} of the stated errors beyond the ends");
    assert!(beyond < 1.0);
    // The worst of all rows is worse than the worst of all rows of all roads.
    for output in 0..2 {
        let band = &bounds.outputs[output].bands[0];
        let farthest = |ends: &[f64]| ends.iter().fold(0.0, |most: f64, end| most.max(end.abs()));
        let found = farthest(&band.lower).max(farthest(&band.upper));
        let of_roads = ranges.iter().map(|row| row[output][0].abs().max(row[output][1].abs())).fold(0.0, f64::max);
        println!("output {output}: {found:.4} by the worst road, {of_roads:.4} by random ones");
        assert!(found > of_roads, "{output}: {found} {of_roads}");
    }
    for witness in bounds.functions.iter().take(2) {
        let at = |points: &[(f64, f64)], time: f64| {
            let after = points.partition_point(|(own, _)| *own < time).clamp(1, points.len() - 1);
            let ((from, a), (to, b)) = (points[after - 1], points[after]);
            a + (b - a) * ((time - from) / (to - from)).clamp(0.0, 1.0)
        };
        let rows = motion(|time| [0, 1].map(|input| at(&witness.functions[input].points, time)));
        let (output, time) = (witness.output.unwrap(), witness.time.unwrap());
        let replayed = rows[(time / 0.1).round() as usize - 1][output];
        let width = bounds.outputs[output].bands[0].upper.iter().fold(0.0, |a: f64, b| a.max(*b));
        assert!((replayed - witness.value).abs() < 0.01 * width, "{output}: {replayed} {}", witness.value);
    }
}

fn asked(roads: u64) -> u64 {
    std::env::var("MBINT_SAMPLES").map_or(roads, |count| count.parse().unwrap())
}

#[test]
#[ignore = "ten seconds"]
fn worst_roads_of_a_half_car_exceed_random_ones() {
    compare(asked(2000));
}
