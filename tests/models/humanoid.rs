//! `humanoid.yaml` against its equations in minimal coordinates, written by hand: the position of the hips and nine
//! absolute angles. A point of a segment is p + Σ aⱼ u(θⱼ) + b n(θ), with u along and n across a segment.

use crate::common::dormand_prince::dormand_prince;
use crate::common::{curve, distance, model, nominal, order};

/// Trunk, then thigh, shank, upper arm and forearm of the left side, then of the right.
const SEGMENTS: usize = 9;
const UNKNOWNS: usize = SEGMENTS + 2;
const LENGTHS: [f64; 5] = [0.5, 0.43, 0.43, 0.33, 0.44];
const MASSES: [f64; 5] = [0.578 * 70.0, 7.0, 0.061 * 70.0, 0.028 * 70.0, 0.022 * 70.0];
const CENTRES: [f64; 5] = [0.66, 0.433, 0.606, 0.436, 0.682];
const GYRATION: [f64; 5] = [0.503, 0.323, 0.416, 0.322, 0.468];

type Unknowns = [f64; UNKNOWNS];

/// Kind of a segment: an index into the tables.
fn kind(segment: usize) -> usize {
    if segment == 0 { 0 } else { (segment - 1) % 4 + 1 }
}

/// Distances along each segment from the hips to a point of one, at a share of its length.
fn path(segment: usize, share: f64) -> [f64; SEGMENTS] {
    let mut along = [0.0; SEGMENTS];
    along[segment] = share * LENGTHS[kind(segment)];
    match kind(segment) {
        2 => along[segment - 1] = LENGTHS[1],
        3 => along[0] = LENGTHS[0],
        4 => (along[0], along[segment - 1]) = (LENGTHS[0], LENGTHS[3]),
        _ => {}
    }
    along
}

/// Velocity of a point for each rate, along x and y, and the part of its acceleration without the rates' derivatives.
struct Point {
    rows: [Unknowns; 2],
    rest: [f64; 2],
    height: f64,
}

fn point(q: Unknowns, w: Unknowns, along: [f64; SEGMENTS], across: (usize, f64)) -> Point {
    let mut found = Point { rows: [[0.0; UNKNOWNS]; 2], rest: [0.0; 2], height: q[1] };
    (found.rows[0][0], found.rows[1][1]) = (1.0, 1.0);
    for segment in 0..SEGMENTS {
        let (sin, cos) = q[segment + 2].sin_cos();
        let (a, b) = (along[segment], if across.0 == segment { across.1 } else { 0.0 });
        found.height += a * sin + b * cos;
        (found.rows[0][segment + 2], found.rows[1][segment + 2]) = (-a * sin - b * cos, a * cos - b * sin);
        let square = w[segment + 2] * w[segment + 2];
        found.rest[0] -= square * (a * cos - b * sin);
        found.rest[1] -= square * (a * sin + b * cos);
    }
    found
}

/// The force of the floor on a point at this height.
fn floor(height: f64, velocity: [f64; 2]) -> [f64; 2] {
    if height >= 0.0 {
        return [0.0; 2];
    }
    let push = 5e5 * (-height).powf(1.5) * (1.0 - 0.5 * velocity[1]).max(0.0);
    [-0.8 * push * velocity[0] / velocity[0].hypot(0.05), push]
}

/// The solution of M x = f for a positive definite matrix.
fn solved(mut matrix: [Unknowns; UNKNOWNS], mut f: Unknowns) -> Unknowns {
    for pivot in 0..UNKNOWNS {
        let row = matrix[pivot];
        for below in pivot + 1..UNKNOWNS {
            let factor = matrix[below][pivot] / row[pivot];
            for (value, above) in matrix[below].iter_mut().zip(row) {
                *value -= factor * above;
            }
            f[below] -= factor * f[pivot];
        }
    }
    for row in (0..UNKNOWNS).rev() {
        let known: f64 = (row + 1..UNKNOWNS).map(|column| matrix[row][column] * f[column]).sum();
        f[row] = (f[row] - known) / matrix[row][row];
    }
    f
}

fn accelerations(q: Unknowns, w: Unknowns) -> Unknowns {
    let (mut mass, mut force) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
    for segment in 0..SEGMENTS {
        let kind = kind(segment);
        let Point { rows, rest, .. } = point(q, w, path(segment, CENTRES[kind]), (0, 0.0));
        for (row, (rest, gravity)) in rows.iter().zip(rest.iter().zip([0.0, -9.81])) {
            for i in 0..UNKNOWNS {
                force[i] += MASSES[kind] * row[i] * (gravity - rest);
                for j in 0..UNKNOWNS {
                    mass[i][j] += MASSES[kind] * row[i] * row[j];
                }
            }
        }
        mass[segment + 2][segment + 2] += MASSES[kind] * (GYRATION[kind] * LENGTHS[kind]).powi(2);
    }
    for side in 0..2 {
        let (thigh, shank) = [(25f64, 20f64), (10.0, 12.0)][side];
        let [thigh_at, shank_at, upper_at, lower_at] = [3, 4, 5, 6].map(|place| place + 4 * side);
        for (first, second, free, stiffness, damping) in [
            (2, thigh_at, thigh - 180.0, 250.0, 15.0),
            (thigh_at, shank_at, -shank - thigh, 250.0, 15.0),
            (2, upper_at, -180.0, 10.0, 1.0),
            (upper_at, lower_at, 20.0, 10.0, 1.0),
        ] {
            let torque = stiffness * (q[second] - q[first] - free.to_radians()) + damping * (w[second] - w[first]);
            force[first] += torque;
            force[second] -= torque;
        }
        for across in [0.18, -0.06] {
            let Point { rows, height, .. } = point(q, w, path(shank_at - 2, 1.0), (shank_at - 2, across));
            let velocity = rows.map(|row| row.iter().zip(w).map(|(factor, rate)| factor * rate).sum());
            for (row, push) in rows.iter().zip(floor(height, velocity)) {
                for (force, factor) in force.iter_mut().zip(row) {
                    *force += factor * push;
                }
            }
        }
    }
    solved(mass, force)
}

/// Unknowns and their rates every 10 ms.
fn dropped() -> Vec<[f64; 2 * UNKNOWNS]> {
    let (thigh, shank) = (10f64.to_radians(), 12f64.to_radians());
    let hips = 0.1 + 0.43 * thigh.cos() + 0.43 * shank.cos() + 0.18 * shank.sin();
    let angles = [90.0, 25.0 - 90.0, -20.0 - 90.0, -90.0, -70.0, 10.0 - 90.0, -12.0 - 90.0, -90.0, -70.0f64];
    let mut start = [0.0; 2 * UNKNOWNS];
    start[1] = hips;
    angles.iter().enumerate().for_each(|(index, angle)| start[index + 2] = angle.to_radians());
    let motion = |_: f64, y: [f64; 2 * UNKNOWNS]| {
        let half = |first: usize| -> Unknowns { std::array::from_fn(|index| y[first + index]) };
        let [q, w] = [half(0), half(UNKNOWNS)];
        let a = accelerations(q, w);
        std::array::from_fn(|index| if index < UNKNOWNS { w[index] } else { a[index - UNKNOWNS] })
    };
    dormand_prince(motion, start, 0.01, 51, 1e-10)
}

#[test]
fn the_humanoid_lands_on_its_feet() {
    let expected = dropped();
    let angle = |index: usize| expected.iter().map(|row| row[index]).collect::<Vec<f64>>();
    let observed = [
        ("trunk.hip.x", angle(0)),
        ("trunk.hip.y", angle(1)),
        ("trunk.angle", angle(2)),
        ("shank_left.angle", angle(4)),
        ("lower_right.angle", angle(10)),
    ];
    let names: Vec<&str> = observed.iter().map(|(name, _)| *name).collect();
    let errors = [5e-4, 2.5e-4].map(|h| {
        let bounds = nominal(&model("humanoid").observing(&names).step(h));
        let errors = observed.iter().map(|(name, expected)| distance(curve(&bounds, name), expected));
        errors.fold(0.0, f64::max)
    });
    println!("{errors:?}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.3 && errors[1] < 1e-4, "{errors:?}");
}
