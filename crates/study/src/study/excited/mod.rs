//! Bounds over functions of the time: excitations of which only limits are known.
//!
//! As a constant, an excitation is an uncertain parameter, and methods bound it with the others. As a function, it is an
//! input of equations that are compiled once more: a level and a slope in each step. The gradient of an output in a row by
//! all of them is its kernel, from one run backwards, and says which function is the worst (`climb`), in a class that
//! `limits` evaluates. Every end is attained by a function; it widens the methods' bands.

mod climb;
mod limits;

use super::RunError;
use super::bounding::{FunctionEnd, FunctionEnds, Outcome, WorstFunction, timed};
use super::formulation::compiled;
use super::problem::Study;
use crate::assemble::Questions;
use crate::methods::MethodResult;
use crate::model::{Excitation, Formulation, Trajectory};
use crate::numerics::{FunctionClass, Sample, step_error};
use crate::simulate::{
    Functions, Gradient, NoGradient, Schedule, SimulationError, Simulator, Wanted, gradients_of_functions,
};
use climb::{Climb, Point};
pub(super) use limits::Limits;

/// Outputs and rows whose ends are searched at once.
const AT_ONCE: usize = 128;

/// Steps of a climb.
const STEPS: usize = 24;

/// How often ends are climbed to from elsewhere.
const ROUNDS: usize = 2;

/// Rows in which the steps' error is measured.
const CHECKED: usize = 8;

/// Ending of the name of the parameter that an excitation is as a constant.
const DEVIATION: &str = ".deviation";

/// Whether something of the study is an excitation.
pub(super) fn is_excited(study: &Study) -> bool {
    let is_input = |own: &Trajectory| {
        let name = format!("{}{DEVIATION}", own.name);
        own.excitation().is_some() && study.simulator.system.parameters.iter().any(|known| known.name == name)
    };
    !study.simulator.system.analysis.visits() && study.description.trajectories.iter().any(is_input)
}

/// Searches the ends of all outputs over all functions; `None` where no excitation acts, and at an interruption.
///
/// # Errors
/// Where the equations cannot be compiled, or the nominal motion cannot be simulated.
pub(super) fn excited(study: &Study, schedule: &Schedule) -> Result<Option<(Outcome, FunctionEnds)>, RunError> {
    if !is_excited(study) || study.interruption.is_asked() {
        return Ok(None);
    }
    (study.stage)("any function");
    let joint = study.simulator.system.formulation.joint;
    let formulation = if joint { Formulation::Joint } else { Formulation::Absolute };
    let questions = Questions { as_functions: true, formulation, ..Questions::of(study.description) };
    let simulator = compiled(&questions)?;
    let found = timed(schedule, "any function", || {
        let mut search = Search::new(study, &simulator, schedule);
        search.run()?;
        let result = MethodResult { simulations: search.simulations, ..MethodResult::default() };
        Ok((result, search.found))
    });
    match found {
        Err(SimulationError::Interrupted) => Ok(None),
        found => Ok(Some(found?)),
    }
}

struct Search<'s, 'm> {
    study: &'s Study<'m>,
    simulator: &'s Simulator,
    schedule: Schedule,
    excitations: Vec<&'s Excitation>,
    found: FunctionEnds,
    simulations: usize,
}

impl<'s, 'm> Search<'s, 'm> {
    fn new(study: &'s Study<'m>, simulator: &'s Simulator, schedule: &Schedule) -> Self {
        let inputs: Vec<usize> = simulator.system.inputs.iter().map(|input| input.trajectory).collect();
        let trajectories = &study.description.trajectories;
        let excitations: Vec<&Excitation> = inputs.iter().filter_map(|&own| trajectories[own].excitation()).collect();
        let nominal = Limits::of(study.description, &study.domain.nominal);
        let periods = excitations.iter().filter_map(|own| match nominal.class(own) {
            FunctionClass::Held(period) => Some(period),
            _ => None,
        });
        let schedule = schedule.ending_at_multiples(&periods.collect::<Vec<f64>>());
        let (rows, outputs, cells) = (schedule.rows, simulator.program.outputs.len(), schedule.ends());
        let found = FunctionEnds::new(rows, outputs, inputs, cells);
        Self { study, simulator, schedule, excitations, found, simulations: 0 }
    }

    fn run(&mut self) -> Result<(), SimulationError> {
        let (rows, outputs) = (self.schedule.rows, self.simulator.program.outputs.len());
        let checked = checked(rows);
        let all: Vec<(usize, usize)> = (0..rows).flat_map(|row| (0..outputs).map(move |output| (row, output))).collect();
        for some in all.chunks(AT_ONCE) {
            let mut climbs = self.climbs(some)?;
            self.follow(&mut climbs)?;
            self.start_elsewhere(&mut climbs, outputs)?;
            let errors = self.errors_of_steps(&climbs, &checked)?;
            for (climb, error) in climbs.iter().zip(errors) {
                self.note(climb, error);
            }
        }
        self.spread_errors(&checked);
        Ok(())
    }

    /// The functions that each excitation may be at a sample.
    fn classes(&self, sample: &Sample) -> Vec<FunctionClass> {
        let limits = Limits::of(self.study.description, sample);
        self.excitations.iter().map(|own| limits.class(own)).collect()
    }

    /// Climbs to both ends of some outputs in rows, from the middle of all limits: they share its kernel.
    fn climbs(&mut self, some: &[(usize, usize)]) -> Result<Vec<Climb>, SimulationError> {
        let (inputs, cells) = (self.excitations.len(), self.found.ends_of_cells.len());
        let middle = Point::middle(self.study.domain.xi(&self.study.domain.nominal), inputs, cells);
        let points: Vec<&Point> = some.iter().map(|_| &middle).collect();
        let found = self.gradients(&points, some, false)?;
        let classes = self.classes(&self.study.domain.nominal);
        let mut climbs = Vec::with_capacity(2 * some.len());
        for (&(row, output), found) in some.iter().zip(&found) {
            for sign in [-1.0, 1.0] {
                let mut climb = Climb::new(row, output, sign, middle.clone());
                climb.take(found, &self.study.domain, &self.found.ends_of_cells, &classes);
                climbs.push(climb);
            }
        }
        Ok(climbs)
    }

    /// Goes on with climbs until all are done.
    fn follow(&mut self, climbs: &mut [Climb]) -> Result<(), SimulationError> {
        for _ in 0..STEPS {
            let going: Vec<usize> = (0..climbs.len()).filter(|&number| climbs[number].next.is_some()).collect();
            if going.is_empty() {
                break;
            }
            let points: Vec<&Point> = going.iter().filter_map(|&number| climbs[number].next.as_ref()).collect();
            let wanted: Vec<(usize, usize)> =
                going.iter().map(|&number| (climbs[number].row, climbs[number].output)).collect();
            let found = self.gradients(&points, &wanted, false)?;
            for (number, found) in going.into_iter().zip(found) {
                let climb = &mut climbs[number];
                let Some(point) = &climb.next else { continue };
                let classes = self.classes(&self.study.domain.sample(&point.xi));
                climb.take(&found, &self.study.domain, &self.found.ends_of_cells, &classes);
            }
        }
        Ok(())
    }

    /// Climbs once more to ends of which the output is not linear: from the best functions of the rows around and of the
    /// other end, and from the two constants. Twice, since neighbours learn from one another.
    fn start_elsewhere(&mut self, climbs: &mut [Climb], outputs: usize) -> Result<(), SimulationError> {
        let cells = self.found.ends_of_cells.len();
        for round in 0..ROUNDS {
            let mut others = Vec::new();
            for (number, climb) in climbs.iter().enumerate().filter(|(_, climb)| climb.is_bent) {
                let row = 2 * outputs;
                let around = [number.checked_sub(row), number.checked_add(row), Some(number ^ 1)];
                let known = around.into_iter().flatten().filter_map(|other| climbs.get(other)?.best.as_ref());
                let mut starts: Vec<Point> = known.map(|(point, _)| point.clone()).collect();
                if let Some((best, _)) = climb.best.as_ref().filter(|_| round == 0) {
                    let classes = self.classes(&self.study.domain.sample(&best.xi));
                    starts.extend([-1.0, 1.0].map(|sign| Point {
                        xi: best.xi.clone(),
                        functions: classes.iter().map(|class| class.constant(sign, cells)).collect(),
                    }));
                }
                let own = |start| (number, Climb::new(climb.row, climb.output, climb.sign, start));
                others.extend(starts.into_iter().map(own));
            }
            let (numbers, mut others): (Vec<usize>, Vec<Climb>) = others.into_iter().unzip();
            for some in others.chunks_mut(2 * AT_ONCE) {
                self.follow(some)?;
            }
            climbs.iter_mut().for_each(|climb| climb.improved = 0.0);
            for (number, other) in numbers.into_iter().zip(others) {
                climbs[number].learn(other);
            }
        }
        Ok(())
    }

    /// Values and gradients of outputs in rows, each at a point of its own; with halved steps or as they are.
    fn gradients(
        &mut self,
        points: &[&Point],
        wanted: &[(usize, usize)],
        halved: bool,
    ) -> Result<Vec<Gradient>, SimulationError> {
        let schedule = if halved { self.schedule.refined(2) } else { self.schedule.clone() };
        let samples: Vec<Sample> = points.iter().map(|point| self.study.domain.sample(&point.xi)).collect();
        let values: Vec<Vec<f64>> = points.iter().map(|point| point.inputs()).collect();
        let jumps = self.classes(&self.study.domain.nominal).iter().any(|class| class.jumps());
        let functions = Functions { ends: &self.found.ends_of_cells, values: &values, jumps };
        let wanted: Vec<Wanted> = wanted
            .iter()
            .enumerate()
            .map(|(sample, &(row, output))| Wanted { sample, row, output })
            .collect();
        self.simulations += wanted.len();
        let found = gradients_of_functions(
            self.simulator,
            &schedule,
            &samples,
            &wanted,
            Some(functions),
            self.study.interruption,
        );
        found.map_err(|error| match error {
            NoGradient::Simulation(error) => error,
            // Neither is asked for: motions are not cut where something is excited.
            NoGradient::NoMotion { .. } | NoGradient::Events => SimulationError::Deferred,
        })
    }

    /// Of climbs in rows that are checked, how much halved steps change their ends; NaN of the others.
    fn errors_of_steps(&mut self, climbs: &[Climb], checked: &[usize]) -> Result<Vec<f64>, SimulationError> {
        let mut errors = vec![f64::NAN; climbs.len()];
        let own: Vec<usize> = (0..climbs.len()).filter(|&number| checked.contains(&climbs[number].row)).collect();
        let known = own.into_iter().filter_map(|number| Some((number, climbs[number].best.as_ref()?)));
        let known: Vec<(usize, &(Point, f64))> = known.collect();
        if known.is_empty() {
            return Ok(errors);
        }
        let points: Vec<&Point> = known.iter().map(|(_, (point, _))| point).collect();
        let wanted: Vec<(usize, usize)> =
            known.iter().map(|&(number, _)| (climbs[number].row, climbs[number].output)).collect();
        let halved = self.gradients(&points, &wanted, true)?;
        for ((number, (_, value)), halved) in known.into_iter().zip(halved) {
            errors[number] = step_error(&[climbs[number].sign * value], &[halved.value]);
        }
        Ok(errors)
    }

    /// Notes what a climb found.
    fn note(&mut self, climb: &Climb, error_of_steps: f64) {
        let Climb { row, output, sign, .. } = *climb;
        let is_upper = sign > 0.0;
        let Some((point, reached)) = &climb.best else { return };
        let value = sign * reached;
        self.found.note(row, output, is_upper, FunctionEnd { value, open: climb.open() });
        let known = self.found.steps(row, output);
        self.found.note_steps(row, output, if known > error_of_steps { known } else { error_of_steps });
        let worst = &mut self.found.worst[output];
        let gain = climb.gain();
        if worst.as_ref().is_none_or(|(known, _)| gain > *known) {
            let (sample, cells) = (self.study.domain.sample(&point.xi), point.functions.clone());
            *worst = Some((gain, WorstFunction { row, value, sample, cells }));
        }
    }

    /// Gives rows that were not checked the error of the worse of those around them.
    fn spread_errors(&mut self, checked: &[usize]) {
        for output in 0..self.simulator.program.outputs.len() {
            for row in (0..self.schedule.rows).filter(|row| !checked.contains(row)) {
                let after = checked.partition_point(|own| *own < row);
                let around = [after.checked_sub(1), Some(after)].into_iter().flatten();
                let errors = around.filter_map(|number| checked.get(number)).map(|own| self.found.steps(*own, output));
                // NaN wins.
                let worse = errors.fold(0.0, |worst: f64, error| if error <= worst { worst } else { error });
                self.found.note_steps(row, output, worse);
            }
        }
    }
}

/// Rows in which the steps' error is measured, ascending, the last of all among them.
fn checked(rows: usize) -> Vec<usize> {
    let count = CHECKED.min(rows);
    (1..=count).map(|number| (number * rows).div_ceil(count) - 1).collect()
}
