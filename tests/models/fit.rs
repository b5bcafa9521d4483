//! Fits against areas and estimates by other means, and against motions by Dormand and Prince.

use mbint::Model;
use mbint::results::Fit;

use crate::common::dormand_prince::dormand_prince;
use crate::common::random::Random;
use crate::through_events::elastic;

/// A body that moves by x₀ + v t: linear in both parameters.
const LINE: &str = "
model: line
parameters: { x0: { value: 0, interval: [-1, 1], unit: m }, v: { value: 0, interval: [-1, 1], unit: m/s } }
bodies: { block: { mass: 1, coordinates: [x] } }
initial: { block.x: x0, block.vx: v }
outputs: { x: block.x }
simulation: { duration: 2, step: 0.1, output_step: 0.1 }
bounds: { chebyshev: { order: 1 } }
";

fn between(random: &mut Random, lower: f64, upper: f64) -> f64 {
    lower + (upper - lower) * random.uniform()
}

/// Rows of a line with noise of at most 0.1 m.
fn line(random: &mut Random) -> Vec<[f64; 2]> {
    (0..21).map(|row| 0.1 * f64::from(row)).map(|t| [t, 0.3 - 0.4 * t + between(random, -0.1, 0.1)]).collect()
}

fn table(rows: &[[f64; 2]]) -> String {
    rows.iter().fold("time,x\n".to_owned(), |text, [t, x]| text + &format!("{t:?},{x:?}\n"))
}

fn fitted(rows: &[[f64; 2]]) -> Fit {
    Model::from_yaml_str("line.yaml", LINE).unwrap().study().fit(&table(rows), &[("x", "0.1 m")]).unwrap()
}

/// The part of a convex polygon where a · p ≤ b (Sutherland & Hodgman).
fn cut(polygon: &[[f64; 2]], a: [f64; 2], b: f64) -> Vec<[f64; 2]> {
    let beyond = |p: &[f64; 2]| a[0] * p[0] + a[1] * p[1] - b;
    let mut rest = Vec::new();
    for (index, from) in polygon.iter().enumerate() {
        let to = &polygon[(index + 1) % polygon.len()];
        let (here, there) = (beyond(from), beyond(to));
        if here <= 0.0 {
            rest.push(*from);
        }
        if here * there < 0.0 {
            let share = here / (here - there);
            rest.push([from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]);
        }
    }
    rest
}

fn area(polygon: &[[f64; 2]]) -> f64 {
    let pairs = polygon.iter().zip(polygon.iter().cycle().skip(1));
    0.5 * pairs.map(|(p, q)| p[0] * q[1] - q[0] * p[1]).sum::<f64>()
}

#[test]
fn consistent_set_of_a_line_is_a_polygon() {
    let rows = line(&mut Random(41));
    let found = fitted(&rows);
    let mut polygon = vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    for [t, x] in &rows {
        polygon = cut(&polygon, [1.0, *t], x + 0.1);
        polygon = cut(&polygon, [-1.0, -t], 0.1 - x);
    }
    let exact = area(&polygon) / 4.0;
    let set = found.set.unwrap();
    let [inner, outer] = set.volumes;
    assert!(inner <= exact && exact <= outer && outer - inner <= 0.05 * outer, "{inner:e} {exact:e} {outer:e}");
    for (axis, parameter) in found.parameters.iter().enumerate() {
        let ends = polygon.iter().map(|corner| corner[axis]);
        let exact = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |ends, own| [ends[0].min(own), ends[1].max(own)]);
        let [lower, upper] = parameter.hull.unwrap();
        let room = 0.05 * (exact[1] - exact[0]);
        assert!(lower <= exact[0] && lower > exact[0] - room, "{parameter:?} {exact:?}");
        assert!(upper >= exact[1] && upper < exact[1] + room, "{parameter:?} {exact:?}");
    }
    // Shadows on the plane of both parameters are the set itself.
    let [shadow] = &set.projections[..] else { panic!("{:?}", set.projections) };
    let size = |cells: &[[f64; 4]]| cells.iter().map(|[a, b, c, d]| (b - a) * (d - c)).sum::<f64>() / 4.0;
    assert!(size(&shadow.outer) >= exact && size(&shadow.inner) <= exact, "{:e}", size(&shadow.inner));
}

#[test]
fn least_squares_of_a_line_match_normal_equations() {
    let rows = line(&mut Random(42));
    let found = fitted(&rows);
    let n = rows.len() as f64;
    let sum = |of: fn(&[f64; 2]) -> f64| rows.iter().map(of).sum::<f64>();
    let (t, x, tt, tx) = (sum(|r| r[0]), sum(|r| r[1]), sum(|r| r[0] * r[0]), sum(|r| r[0] * r[1]));
    let v = (n * tx - t * x) / (n * tt - t * t);
    let estimates = [(x - v * t) / n, v];
    // Variance of uniform noise: 0.1²/3.
    let variance = 0.01 / 3.0 / (n * tt - t * t);
    let deviations = [(variance * tt).sqrt(), (variance * n).sqrt()];
    for ((own, estimate), deviation) in found.parameters.iter().zip(estimates).zip(deviations) {
        assert!((own.estimate - estimate).abs() < 1e-3 * deviation, "{own:?} {estimate}");
        assert!((own.deviation / deviation - 1.0).abs() < 1e-6, "{own:?} {deviation}");
    }
    let correlation = -t / (n * tt).sqrt();
    assert!((found.correlations[0][1] - correlation).abs() < 1e-6, "{:?}", found.correlations);
}

#[test]
fn a_row_that_contradicts_the_others_is_named() {
    let mut rows = line(&mut Random(43));
    rows[13][1] += 0.5;
    let found = fitted(&rows);
    assert!(found.set.is_none());
    let unexplained = found.unexplained.unwrap();
    let (row, factor) = unexplained.worst.unwrap();
    assert_eq!(found.rows[row].line, 15, "{unexplained:?}");
    assert!(factor <= 1.0 && unexplained.factor > 1.0, "{unexplained:?}");
    // With noise of that size there are parameters, as a fit with it finds.
    let model = Model::from_yaml_str("line.yaml", LINE).unwrap();
    let noise = |factor: f64| format!("{} m", 0.1 * factor);
    let with = |factor: f64| model.study().fit(&table(&rows), &[("x", &noise(factor))]).unwrap().set.is_some();
    assert!(with(1.01 * unexplained.factor) && !with(0.95 * unexplained.factor), "{unexplained:?}");
}

#[test]
fn a_combination_that_the_data_leave_open_is_named() {
    // Only the sum of both counts.
    let text = LINE.replace("block.x: x0,", "block.x: x0 + v*(1 s),").replace("block.vx: v", "block.vx: 0.5");
    let rows: Vec<[f64; 2]> = (0..21).map(|row| 0.1 * f64::from(row)).map(|t| [t, 0.2 + 0.5 * t]).collect();
    let model = Model::from_yaml_str("line.yaml", &text).unwrap();
    let found = model.study().fit(&table(&rows), &[("x", "0.05 m")]).unwrap();
    let set = found.set.unwrap();
    let [a, b] = set.axes[0].direction[..] else { panic!("{:?}", set.axes) };
    assert!((a + b).abs() < 0.02 && set.axes[0].extent > 2.0, "{:?}", set.axes);
    assert!(found.parameters.iter().all(|own| own.deviation.is_infinite()), "{:?}", found.parameters);
    assert_eq!(set.at_limits, ["x0", "v"]);
}

/// x3 of the slider crank over 2 s with these l1, k and tau, in 201 rows: its equation of motion in the crank's angle,
/// from the kinetic energy ½ M(θ) θ̇².
fn slider(values: [f64; 3]) -> Vec<f64> {
    let [l1, k, tau] = values;
    let (l2, m1, m2, m3, c) = (0.56, 0.37, 0.77, 0.45, 1.0);
    let geometry = move |angle: f64| {
        let sine = -l1 / l2 * angle.sin();
        let cosine = (1.0 - sine * sine).sqrt();
        let turn = -l1 / l2 * angle.cos() / cosine;
        let x = l1 * angle.cos() + l2 * cosine;
        let slope = -l1 * angle.sin() - l2 * sine * turn;
        let middle = [-l1 * angle.sin() - 0.5 * l2 * sine * turn, l1 * angle.cos() + 0.5 * l2 * cosine * turn];
        let mass = m1 * l1 * l1 / 3.0
            + m2 * (middle[0] * middle[0] + middle[1] * middle[1])
            + m2 * l2 * l2 / 12.0 * turn * turn
            + m3 * slope * slope;
        (x, slope, mass)
    };
    let rate = move |_: f64, [angle, speed]: [f64; 2]| {
        let (x, slope, mass) = geometry(angle);
        let h = 1e-5;
        let change = (geometry(angle + h).2 - geometry(angle - h).2) / (2.0 * h);
        let force = -k * (x - l1 - l2) - c * slope * speed;
        [speed, (tau + force * slope - 0.5 * change * speed * speed) / mass]
    };
    dormand_prince(rate, [0.0, 0.0], 0.01, 201, 1e-10).iter().map(|state| geometry(state[0]).0).collect()
}

/// Draws parameters of the slider crank and noise of up to 1 mm; returns how many truths lie outside of the sets, and
/// the differences of both pavings, ascending.
fn draws(numbers: impl Iterator<Item = u64>) -> (usize, Vec<f64>) {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/examples/crank_to_fit.yaml")).unwrap();
    let model = Model::from_yaml_str("crank.yaml", &text).unwrap();
    let (mut excluded, mut apart) = (0, Vec::new());
    for number in numbers {
        let mut random = Random(2007 + 7919 * number);
        let xi = [(); 3].map(|()| between(&mut random, -1.0, 1.0));
        let (middles, halves) = ([0.15, 5.0, -0.5], [0.0015, 0.5, 0.005]);
        let truth: [f64; 3] = std::array::from_fn(|axis| middles[axis] + halves[axis] * xi[axis]);
        let rows: Vec<[f64; 2]> = slider(truth)
            .into_iter()
            .enumerate()
            .skip(1)
            .map(|(row, x)| [0.01 * row as f64, x + between(&mut random, -1e-3, 1e-3)])
            .collect();
        let table = rows.iter().fold("time,x3\n".to_owned(), |text, [t, x]| text + &format!("{t:?},{:?}\n", 1e3 * x));
        let found = model.study().fit(&table, &[("x3", "1 mm")]).unwrap();
        let set = found.set.as_ref();
        if set.is_none_or(|set| !set.paving.may_contain(&xi)) {
            println!("draw {number}: {truth:?} is excluded");
            excluded += 1;
        }
        if let Some(set) = set {
            let own = 1.0 - set.volumes[0] / set.volumes[1];
            if own > 0.05 {
                println!("draw {number}: pavings {:.1} % apart, {:?} boxes", 100.0 * own, set.boxes);
            }
            apart.push(own);
        }
    }
    apart.sort_by(f64::total_cmp);
    (excluded, apart)
}

#[test]
#[ignore = "4 s"]
fn the_truth_of_a_slider_crank_is_not_excluded() {
    // In draw 127 the set reaches an end of the model's box, and the polynomials continue beyond it.
    let (excluded, apart) = draws([0, 1, 127].into_iter());
    assert!(excluded == 0 && apart.len() == 3 && apart[2] <= 0.05, "{excluded} {apart:?}");
}

/// `MBINT_DRAWS=0..1000 cargo test --release --test models fit::many -- --ignored --nocapture`: some 4 s a draw.
#[test]
#[ignore = "a minute: as many draws as the gate tries; prints its figures"]
fn many_truths_are_not_excluded() {
    let asked = std::env::var("MBINT_DRAWS").unwrap_or_else(|_| "74..86".to_owned());
    let (first, last) = asked.split_once("..").unwrap();
    let (excluded, apart) = draws(first.parse().unwrap()..last.parse().unwrap());
    let (median, most) = (apart[apart.len() / 2], apart[apart.len() - 1]);
    println!(
        "{} sets: {excluded} truths excluded, pavings {median:.4} apart in the median, {most:.4} at most",
        apart.len()
    );
    assert!(excluded == 0 && most <= 0.05, "{excluded} {most}");
}

/// A ball on a floor without loss, whose step is too long for the contacts, and whose rows are not the measured times.
const BALL: &str = "
model: ball
parameters: { K: { value: 1e5, unit: N/m, tolerance: 5% }, h0: { value: 1, unit: m, tolerance: 2% } }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  ground: { force: { on: ball, value: [0, \"K*max(-ball.y, 0)\"] } }
initial: { ball.y: h0, ball.vy: 0 }
outputs: { y: ball.y }
simulation: { duration: 2, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 3 } }
";

/// Where all steps are those of the model, no parameters agree with the rows.
#[test]
fn the_truth_of_a_bouncing_ball_is_not_excluded() {
    let model = Model::from_yaml_str("ball.yaml", BALL).unwrap();
    for number in 0..6 {
        let mut random = Random(2007 + 7919 * number);
        let xi = [(); 2].map(|()| between(&mut random, -1.0, 1.0));
        let (stiffness, height) = (1e5 * (1.0 + 0.05 * xi[0]), 1.0 + 0.02 * xi[1]);
        // The times of the last two have no common step: values are interpolated, but not near impacts.
        let is_regular = number < 4;
        let late = |random: &mut Random| if is_regular { 0.0 } else { between(random, -0.012, 0.0) };
        let rows = (1..=80).map(|row| 0.025 * f64::from(row));
        let rows: Vec<f64> = rows.map(|t| t + late(&mut random)).collect();
        let rows = rows.into_iter().map(|t| [t, elastic(height, stiffness, t)[0] + between(&mut random, -2e-3, 2e-3)]);
        let table = rows.fold("time,y\n".to_owned(), |text, [t, y]| text + &format!("{t:?},{y:?}\n"));
        let found = model.study().fit(&table, &[("y", "2 mm")]).unwrap();
        let set = found.set.as_ref().unwrap();
        assert!(set.paving.may_contain(&xi), "draw {number}: {xi:?} is excluded");
        assert!(set.volumes[1] < if is_regular { 0.02 } else { 0.1 }, "draw {number}: {:?}", set.volumes);
        assert!(found.residual < 0.75, "draw {number}: {}", found.residual);
        let errors = found.rows.iter().map(|row| row.error).filter(|error| is_regular || error.is_finite());
        assert!(errors.fold(0.0, f64::max) < if is_regular { 2e-5 } else { 2e-3 }, "draw {number}: errors");
    }
}
