//! Derivatives of a mechanism's programs against central differences of the same programs with twice the digits.
//!
//! Differences of numbers with 32 digits determine a derivative to about 20: more than it has as an `f64`. Compared are
//! the symbolic derivatives of the equations, the Newton matrix of a step, and derivatives by jets and by adjoints.

use std::ops::Range;

use nalgebra::DMatrix;
use symdiff::jet::JetSpace;
use symdiff::{Adjoints, DoubleDouble, DoubleDoubleMemory, JetMemory, Tape, Tile};

use super::motion::{EquationsAtPoint, Manufactured};
use super::tuning::TUNING;
use crate::compile::{Entries, EquationsProgram, Layout, Program, Tapes};
use crate::results::DerivativeCheck;
use crate::simulate::Simulator;

/// Joint change of registers, per unit of a variable of its scale.
type Direction = Vec<(usize, f64)>;

/// Matrix entries by row and column.
type Matrix = DMatrix<f64>;

/// A program with twice the digits at a point.
struct Point<'p> {
    tapes: Vec<&'p Tape>,
    memory: DoubleDoubleMemory,
    values: Vec<f64>,
    rows: Vec<usize>,
}

impl<'p> Point<'p> {
    /// A point of tapes that run one after the other, at values of the layout's registers.
    fn new(program: &'p impl Tapes, tapes: Vec<&'p Tape>, values: &[f64], rows: Vec<usize>) -> Self {
        let mut memory = DoubleDoubleMemory::new(program.registers(), program.constants());
        values.iter().enumerate().for_each(|(register, &value)| memory.set(register, value.into()));
        memory.run(program.sample());
        Self { tapes, memory, values: values.to_vec(), rows }
    }

    /// The rows at a moved point.
    fn at(&mut self, direction: &Direction, share: f64) -> Vec<DoubleDouble> {
        for &(register, slope) in direction {
            let moved = DoubleDouble::from(self.values[register]) + DoubleDouble::from(slope) * share.into();
            self.memory.set(register, moved);
        }
        self.tapes.iter().for_each(|tape| self.memory.run(tape));
        let found = self.rows.iter().map(|&row| self.memory.value(row)).collect();
        direction.iter().for_each(|&(register, _)| self.memory.set(register, self.values[register].into()));
        found
    }

    /// Derivatives of the rows, a column a direction.
    fn by(&mut self, directions: &[Direction]) -> Matrix {
        let mut found = Matrix::zeros(self.rows.len(), directions.len());
        for (column, direction) in directions.iter().enumerate() {
            let (after, before) =
                (self.at(direction, TUNING.share_of_difference), self.at(direction, -TUNING.share_of_difference));
            let width = DoubleDouble::from(2.0 * TUNING.share_of_difference);
            for (row, (after, before)) in after.into_iter().zip(before).enumerate() {
                found[(row, column)] = ((after - before) / width).to_f64();
            }
        }
        found
    }
}

/// Scales of registers, so that derivatives by all of them are comparable.
struct Scales {
    of: Vec<f64>,
}

impl Scales {
    fn new(equations: &EquationsAtPoint, motion: &Manufactured, values: &[f64]) -> Self {
        let layout = &equations.program().layout;
        let mut of: Vec<f64> = values.iter().map(|value| value.abs()).collect();
        let rate = 1.0 / motion.length();
        for (index, coordinate) in equations.system().coordinates.iter().enumerate() {
            let mut least = |register: usize, scale: f64| of[register] = of[register].max(scale);
            least(layout.q.start + index, coordinate.scale);
            least(layout.v.start + index, coordinate.scale * rate);
            least(layout.w.start + index, coordinate.scale * rate * rate);
        }
        let of_reactions = of[layout.lambda.clone()].iter().fold(0.0, |most: f64, own| most.max(*own));
        of[layout.lambda.clone()].fill(of_reactions);
        of.iter_mut().filter(|scale| **scale == 0.0).for_each(|scale| *scale = 1.0);
        Self { of }
    }

    fn directions(&self, registers: impl IntoIterator<Item = usize>) -> Vec<Direction> {
        registers.into_iter().map(|register| vec![(register, self.of[register])]).collect()
    }
}

/// Adds a comparison at one more point. Differences are shares of a row's largest entry.
fn compare(checks: &mut Vec<DerivativeCheck>, of: &str, by: &str, sizes: &[f64], matrices: [&Matrix; 2]) {
    let [found, expected] = matrices;
    if expected.is_empty() {
        return;
    }
    let differences = found - expected;
    let rows = differences.row_iter().zip(sizes).map(|(row, size)| match row.amax() {
        0.0 => 0.0,
        difference => difference / size,
    });
    // A NaN counts as a difference.
    let most = rows.fold(0.0, |most: f64, own| if own <= most { most } else { own });
    match checks.iter_mut().find(|check| check.of == of && check.by == by) {
        Some(check) => check.add(most),
        None => checks.push(DerivativeCheck {
            of: of.to_owned(),
            by: by.to_owned(),
            derivatives: expected.len(),
            difference: most,
        }),
    }
}

/// Compares all derivatives along a motion.
pub fn derivatives(
    simulator: &Simulator,
    equations: &mut EquationsAtPoint,
    motion: &Manufactured,
) -> Vec<DerivativeCheck> {
    let mut checks = Vec::new();
    for share in TUNING.instants_of_derivatives {
        let values = equations.registers(motion, motion.begin + share * motion.length());
        let scales = Scales::new(equations, motion, &values);
        of_equations(&mut checks, equations.program(), &values, &scales);
        of_rates(&mut checks, equations.program(), &values, &scales, motion.length());
        of_outputs(&mut checks, equations.program(), &values, &scales);
        of_step(&mut checks, &simulator.program, &values, &scales, TUNING.step_of_matrix * motion.length());
    }
    checks
}

/// The tapes of the equations, in the order in which they build on each other.
fn tapes(program: &EquationsProgram) -> Vec<&Tape> {
    vec![program.residual(), program.rates(), program.closure(), program.jacobian(), program.rates_jacobian()]
}

/// Registers of a tile after all tapes.
fn evaluated(program: &impl Tapes, tapes: &[&Tape], values: &[f64]) -> Tile {
    let mut tile = Tile::new(1, program.registers(), program.constants());
    values.iter().enumerate().for_each(|(register, &value)| tile.lane_mut(register)[0] = value);
    tile.run(program.sample());
    tapes.iter().for_each(|tape| tile.run(tape));
    tile
}

/// The largest entry of each row.
fn sizes(matrix: &Matrix) -> Vec<f64> {
    matrix.row_iter().map(|row| row.amax()).collect()
}

/// Variables of the motion and their names.
fn variables(layout: &Layout) -> [(&'static str, Range<usize>); 4] {
    let Layout { q, v, w, lambda, .. } = layout.clone();
    [("positions", q), ("velocities", v), ("accelerations", w), ("reactions", lambda)]
}

/// Symbolic derivatives of the equations of motion, constraints and conditions of the start.
fn of_equations(checks: &mut Vec<DerivativeCheck>, program: &EquationsProgram, values: &[f64], scales: &Scales) {
    let tile = evaluated(program, &[&tapes(program)[..], &[program.closure_jacobian()]].concat(), values);
    let holonomic = program.constraint.len();
    // Rows of Φ_q are followed by those of Ψ_v.
    let (by_position, by_velocity): (Entries, Entries) =
        program.constraint_by_position.iter().partition(|(row, _, _)| *row < holonomic);
    let by_velocity: Entries =
        by_velocity.into_iter().map(|(row, column, register)| (row - holonomic, column, register)).collect();
    let [rates, accelerations] = program.constraint_rates.each_ref();
    let groups = [
        ("equations of motion", &program.motion[..], program.motion_by.each_ref().map(Some)),
        ("constraints", &program.constraint, [Some(&by_position), None, None, None]),
        ("velocity constraints", &rates[holonomic..], [None, Some(&by_velocity), None, None]),
        ("start's positions", &program.closure[0], [Some(&program.closure_by[0]), None, None, None]),
        ("start's velocities", &program.closure[1], [None, Some(&program.closure_by[1]), None, None]),
        (
            "constraints' accelerations",
            accelerations,
            [Some(&program.constraint_acceleration_by[0]), Some(&program.constraint_acceleration_by[1]), None, None],
        ),
    ];
    let rows: Vec<usize> = groups.iter().flat_map(|(_, rows, _)| rows.iter().copied()).collect();
    let mut point = Point::new(program, tapes(program), values, rows);
    let variables = variables(&program.layout);
    let all: Vec<usize> = variables.iter().flat_map(|(_, registers)| registers.clone()).collect();
    let expected = point.by(&scales.directions(all.iter().copied()));
    let mut first = 0;
    for (of, rows, entries) in groups {
        let own = expected.rows(first, rows.len()).into_owned();
        first += rows.len();
        let sizes = sizes(&own);
        let mut column = 0;
        for ((by, registers), entries) in variables.iter().zip(entries) {
            let expected = own.columns(column, registers.len()).into_owned();
            column += registers.len();
            let Some(entries) = entries else { continue };
            let mut found = Matrix::zeros(rows.len(), registers.len());
            for &(row, column, register) in entries {
                found[(row, column)] += tile.lane(register)[0] * scales.of[registers.start + column];
            }
            compare(checks, of, by, &sizes, [&found, &expected]);
        }
    }
}

/// Φ̇ and Φ̈ against differences of Φ and Φ̇ along the motion.
fn of_rates(
    checks: &mut Vec<DerivativeCheck>,
    program: &EquationsProgram,
    values: &[f64],
    scales: &Scales,
    length: f64,
) {
    let (constraints, layout) = (program.constraint.len(), &program.layout);
    let tile = evaluated(program, &tapes(program), values);
    let [rate, acceleration] = program.constraint_rates.each_ref();
    let rows = [&program.constraint[..constraints], rate].concat();
    let mut point = Point::new(program, tapes(program), values, rows);
    let along = |registers: &Range<usize>, rates: &Range<usize>| -> Direction {
        registers.clone().zip(rates.clone()).map(|(register, rate)| (register, values[rate] * length)).collect()
    };
    let mut direction = vec![(layout.time, length)];
    direction.extend(along(&layout.q, &layout.v));
    direction.extend(along(&layout.v, &layout.w));
    // Directions of the single registers, at least by their scales, show the size of terms that may cancel.
    let by_scale = |&(register, slope): &(usize, f64)| vec![(register, slope.abs().max(scales.of[register]))];
    let apart: Vec<Direction> = direction.iter().map(by_scale).collect();
    let (expected, sizes) = (point.by(&[direction]), sizes(&point.by(&apart)));
    let found = |registers: &[usize]| {
        Matrix::from_iterator(registers.len(), 1, registers.iter().map(|&register| tile.lane(register)[0] * length))
    };
    for (of, found, first) in
        [("constraints", found(&rate[..constraints]), 0), ("constraints' velocities", found(acceleration), constraints)]
    {
        let expected = expected.rows(first, found.nrows()).into_owned();
        compare(checks, of, "time", &sizes[first..], [&found, &expected]);
    }
}

/// Outputs by adjoints, and the equations of motion and outputs by parameters, by jets.
fn of_outputs(checks: &mut Vec<DerivativeCheck>, program: &EquationsProgram, values: &[f64], scales: &Scales) {
    let layout = &program.layout;
    let parameters = layout.parameters.clone();
    let tapes = [program.residual(), program.rates(), program.jacobian(), program.observe()];
    let all = [&[program.sample()], &tapes[..]].concat();
    let rows = [&program.motion[..], &program.outputs].concat();
    let mut point = Point::new(program, all.clone(), values, rows.clone());
    let by_parameters = point.by(&scales.directions(parameters.clone()));
    let motion = layout.q.start..layout.lambda.end;
    let by_motion = point.by(&scales.directions(motion.clone()));
    let numbers = point.at(&Direction::new(), 0.0);
    let sizes: Vec<f64> = (0..rows.len())
        .map(|row| by_parameters.row(row).amax().max(by_motion.row(row).amax()).max(numbers[row].to_f64().abs()))
        .collect();

    let space = JetSpace::new(parameters.len(), 1);
    let mut memory = JetMemory::new(&space, program.registers(), program.constants());
    values.iter().enumerate().for_each(|(register, &value)| memory.set_constant(register, value));
    for (variable, register) in parameters.clone().enumerate() {
        space.variable(variable, values[register], scales.of[register], memory.jet_mut(register));
    }
    all.iter().for_each(|tape| memory.run(tape));
    let found = Matrix::from_fn(rows.len(), parameters.len(), |row, column| memory.jet(rows[row])[1 + column]);
    let count = program.motion.len();
    for (of, first, many) in [("equations of motion", 0, count), ("outputs", count, rows.len() - count)] {
        let part = |matrix: &Matrix| matrix.rows(first, many).into_owned();
        compare(checks, of, "parameters", &sizes[first..], [&part(&found), &part(&by_parameters)]);
    }

    let mut tile = evaluated(program, &tapes, values);
    let mut found = Matrix::zeros(program.outputs.len(), motion.len() + parameters.len());
    for (row, &output) in program.outputs.iter().enumerate() {
        let mut adjoints = Adjoints::new(&tile);
        all.iter().for_each(|tape| adjoints.record(tape, &mut tile));
        adjoints.lane_mut(output)[0] = 1.0;
        all.iter().rev().for_each(|tape| adjoints.pull_last(tape, &mut tile));
        for (column, register) in motion.clone().chain(parameters.clone()).enumerate() {
            found[(row, column)] = adjoints.lane(register)[0] * scales.of[register];
        }
    }
    let expected = [by_motion, by_parameters].map(|matrix| matrix.rows(count, program.outputs.len()).into_owned());
    let expected = Matrix::from_fn(found.nrows(), found.ncols(), |row, column| {
        if column < motion.len() { expected[0][(row, column)] } else { expected[1][(row, column - motion.len())] }
    });
    compare(checks, "outputs", "motion and parameters, backwards", &sizes[count..], [&found, &expected]);
}

/// The Newton matrix of a step of HHT-I3 by accelerations and multipliers.
fn of_step(checks: &mut Vec<DerivativeCheck>, program: &Program, values: &[f64], scales: &Scales, step: f64) {
    let layout = &program.layout;
    let mut values = values.to_vec();
    values[layout.step] = step;
    values[layout.time] += step;
    for (from, to) in layout.w.clone().zip(layout.a.clone()).chain(layout.w.clone().zip(layout.iterate.clone())) {
        values[to] = values[from];
    }
    let tile = evaluated(program, &[program.step_size(), program.step(), program.matrix()], &values);
    let mut matrix = Matrix::zeros(program.size, program.size);
    for &(row, column, register) in &program.matrix_entries {
        matrix[(row, column)] += tile.lane(register)[0];
    }
    let (size, links) = (program.residual.len(), program.size - program.residual.len());
    let mut found = matrix.view((0, 0), (size, size)).into_owned();
    if links > 0 {
        // Values of links follow from the unknowns: they are eliminated.
        let [across, down, within] =
            [((0, size), (size, links)), ((size, 0), (links, size)), ((size, size), (links, links))]
                .map(|(place, shape)| matrix.view(place, shape).into_owned());
        match within.lu().solve(&down) {
            Some(solved) => found -= across * solved,
            None => found.fill(f64::NAN),
        }
    }
    let unknowns: Vec<(usize, f64)> = layout
        .iterate
        .clone()
        .zip(layout.w.clone())
        .map(|(register, like)| (register, scales.of[like]))
        .chain(layout.lambda.clone().map(|register| (register, scales.of[register])))
        .collect();
    for (column, (_, scale)) in unknowns.iter().enumerate() {
        found.column_mut(column).scale_mut(*scale);
    }
    let mut point = Point::new(program, vec![program.step_size(), program.step()], &values, program.residual.clone());
    point.tapes.iter().for_each(|tape| point.memory.run(tape));
    point.tapes = vec![program.matrix()];
    let directions: Vec<Direction> = unknowns.into_iter().map(|one| vec![one]).collect();
    let expected = point.by(&directions);
    compare(checks, "step of HHT-I3", "accelerations and reactions", &sizes(&expected), [&found, &expected]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assemble::Questions;
    use crate::compile::compile_equations;
    use crate::model::load_str;
    use crate::numerics::larger;
    use crate::study::formulation::compiled;

    /// A pendulum on a spring; an entry of ∂r/∂v in place of one of ∂r/∂q is detected, and the right ones are exact.
    #[test]
    fn wrong_derivative_is_detected() {
        let text = "bodies: { ground: { points: { P: [0.2, 0.6] } }, rod: { mass: 2, inertia: 0.3, points: { A: [-0.4, 0.1], B: [0.5, 0] } } }\n\
                    joints: { pin: { revolute: [ground, rod.A] } }\n\
                    effects: { spring: { spring_damper: { between: [ground.P, rod.B], stiffness: 30, damping: 2, free_length: 0.3 } } }\n\
                    initial: { rod.angle: 0.3, rod.angular_velocity: 2 }\noutputs: { x: rod.x }\n\
                    simulation: { duration: 1, step: 1e-3 }\n";
        let description = load_str("pendulum", text, &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
        let simulator = compiled(&Questions::of(&description)).unwrap();
        let mut program = compile_equations(&simulator.system);
        let registers = program.layout.registers();
        let values: Vec<f64> = (0..registers).map(|register| 0.3 + 0.1 * register as f64).collect();
        let scales = Scales { of: vec![1.0; registers] };
        let worst = |program: &EquationsProgram| {
            let mut checks = Vec::new();
            of_equations(&mut checks, program, &values, &scales);
            checks.iter().map(|check| check.difference).fold(0.0, larger)
        };
        assert!(worst(&program) < 1e-14);
        let other = program.motion_by[1][0].2;
        assert_ne!(program.motion_by[0][0].2, other);
        program.motion_by[0][0].2 = other;
        assert!(worst(&program) > 1e-3);
    }
}
