//! A program's answers as the model's outputs.

use std::collections::HashMap;
use std::sync::{Mutex, OnceLock, PoisonError};

use symdiff::{Formula, math};

use mbint_fmu::{Interface, STEP};

use super::tuning::TUNING;
use crate::assemble::NumberFormulas;
use crate::black_box::{Answer, Pool, Questions, Unanswered};
use crate::model::{BlackBox, BoxOutput, Description, Parameter, ParameterValue, Refine};
use crate::numerics::Sample;
use crate::results::BlackBoxSummary;
use crate::simulate::{Interruption, Schedule, SimulationError};

/// The time among the names that a formula of answers may use.
const TIME: &str = "t";

/// A program, and the model that asks it.
#[derive(Debug)]
pub(in crate::study) struct ProgramSource {
    parameters: Vec<Parameter>,
    pub(super) own: BlackBox,
    pool: Pool,
    /// Steps of a unit of FMI.
    steps: Option<UnitSteps>,
    /// The outputs as formulas of answers, the time and the parameters.
    outputs: NumberFormulas,
    output_count: usize,
    /// The model's schedule, with one step a row.
    schedule: Schedule,
    known: Mutex<Known>,
    /// Findings of repeated points.
    summary: OnceLock<BlackBoxSummary>,
}

/// Steps of a unit of FMI.
#[derive(Clone, Copy, Debug)]
struct UnitSteps {
    /// s
    length: f64,
    /// Whether they are integrated here, so that finer ones show their error.
    are_own: bool,
}

impl UnitSteps {
    fn of(own: &BlackBox, output_step: f64) -> Option<Self> {
        let own = own.fmu()?;
        let are_own = own.task.interface == Interface::ModelExchange;
        let length = own.step.or(are_own.then_some(output_step / TUNING.steps_a_row))?;
        Some(Self { length, are_own })
    }
}

/// Stored answers, by the bits of their points.
#[derive(Debug, Default)]
struct Known {
    answers: HashMap<Vec<u64>, Vec<f64>>,
    values: usize,
}

impl ProgramSource {
    /// The program of a model; `None` if the model is a mechanism.
    pub fn of(description: &Description) -> Option<Self> {
        let own = description.black_box.clone()?;
        let simulation = &description.simulation;
        let schedule = Schedule::fixed(simulation.duration, simulation.output_step, simulation.output_step);
        let steps = UnitSteps::of(&own, simulation.output_step);
        let names = description.parameters.iter().map(|parameter| parameter.name.clone());
        // A unit answers in SI.
        let si = |output: &BoxOutput| if own.fmu().is_some() { 1.0 } else { output.unit.si() };
        let questions = Questions {
            parameters: names.chain(steps.map(|_| STEP.to_owned())).collect(),
            outputs: own.outputs.iter().map(|output| (output.name.clone(), si(output))).collect(),
            times: (0..schedule.rows).map(|row| schedule.time(row)).collect(),
        };
        let names: Vec<&str> = own.outputs.iter().map(|output| output.name.as_str()).chain([TIME]).collect();
        let formulas: Vec<Formula> = description.outputs.iter().map(|output| output.formula.clone()).collect();
        Some(Self {
            outputs: NumberFormulas::of(&description.parameters, &names, &formulas),
            output_count: formulas.len(),
            pool: Pool::new(own.clone(), questions),
            parameters: description.parameters.clone(),
            steps,
            own,
            schedule,
            known: Mutex::default(),
            summary: OnceLock::new(),
        })
    }

    /// Times of the rows, s.
    pub fn times(&self) -> &[f64] {
        &self.pool.questions().times
    }

    /// Number of the model's outputs.
    pub fn outputs(&self) -> usize {
        self.output_count
    }

    /// Stores the findings of repeated points, once.
    pub fn note(&self, summary: BlackBoxSummary) {
        // Parts of a box share one program.
        let _ = self.summary.set(summary);
    }

    /// Findings of repeated points, if known.
    pub fn summary(&self) -> Option<BlackBoxSummary> {
        self.summary.get().cloned()
    }

    /// Refinement of the program's own steps under a schedule, relative to the model's; 1 if nothing refines them.
    pub fn refinement(&self, schedule: &Schedule) -> f64 {
        if self.refined_by().is_none() { 1.0 } else { self.schedule.first_step() / schedule.first_step() }
    }

    /// Name of the parameter, or the key, that refines the program's own steps.
    pub fn refined_by(&self) -> Option<&str> {
        let by_parameter = self.own.refine.map(|refine| self.parameters[refine.parameter].name.as_str());
        by_parameter.or(self.steps.filter(|steps| steps.are_own).map(|_| "step"))
    }

    /// The model's outputs (row, output) at samples, sample by sample. Known points are not asked again.
    ///
    /// # Errors
    /// If the program cannot be started, and at an interruption.
    pub fn answers(
        &self,
        samples: &[Sample],
        refinement: f64,
        interruption: Interruption<'_>,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Vec<Answer>, SimulationError> {
        let points = self.points(samples, refinement);
        let bits = |point: &Vec<f64>| point.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
        let mut found: Vec<Option<Answer>> = {
            let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
            points.iter().map(|point| known.answers.get(&bits(point)).map(|own| Ok(own.clone()))).collect()
        };
        let open: Vec<usize> = (0..points.len()).filter(|&index| found[index].is_none()).collect();
        done(points.len() - open.len());
        let asked: Vec<Vec<f64>> = open.iter().map(|&index| points[index].clone()).collect();
        let answers = self.asked(&asked, interruption, done)?;
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        for (index, answer) in open.into_iter().zip(answers) {
            let answer = answer.map(|rows| self.outputs_of(&rows, &samples[index]));
            if let Ok(values) = &answer
                && known.values + values.len() <= TUNING.most_kept
            {
                known.values += values.len();
                known.answers.insert(bits(&points[index]), values.clone());
            }
            found[index] = Some(answer);
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// The same, evaluated once more even if known.
    ///
    /// # Errors
    /// If the program cannot be started, and at an interruption.
    pub fn once_more(
        &self,
        samples: &[Sample],
        interruption: Interruption<'_>,
    ) -> Result<Vec<Answer>, SimulationError> {
        let answers = self.asked(&self.points(samples, 1.0), interruption, &|_| ())?;
        let outputs = answers.into_iter().zip(samples);
        Ok(outputs.map(|(answer, sample)| answer.map(|rows| self.outputs_of(&rows, sample))).collect())
    }

    fn asked(
        &self,
        points: &[Vec<f64>],
        interruption: Interruption<'_>,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Vec<Answer>, SimulationError> {
        let interrupted = || interruption.is_asked();
        self.pool.answers(points, rayon::current_num_threads(), &interrupted, done).map_err(|why| match why {
            Unanswered::Interrupted => SimulationError::Interrupted,
            not_started => SimulationError::BlackBox { place: self.own.place.clone(), why: not_started.to_string() },
        })
    }

    /// All parameters at samples of the uncertain ones, with steps that are `refinement` times finer.
    fn points(&self, samples: &[Sample], refinement: f64) -> Vec<Vec<f64>> {
        let mut parameters = self.parameters.clone();
        if let Some(Refine { parameter, by }) = self.own.refine.filter(|_| refinement != 1.0)
            && let ParameterValue::Formula(formula) = parameters[parameter].value.clone()
        {
            let value = NumberFormulas::of(&parameters, &[], &[formula]).values(&[], &[])[0];
            let factor = math::exp(math::ln(by) * math::log2(refinement));
            // Twice is exactly the factor that the model gives.
            let factor = if refinement == 2.0 { by } else { factor };
            parameters[parameter].value = ParameterValue::Formula(Formula::number(value * factor));
        }
        let names: Vec<Formula> = parameters.iter().map(|parameter| Formula::name(&parameter.name)).collect();
        let formulas = NumberFormulas::of(&parameters, &[], &names);
        let refines = self.own.refine.is_none() && self.steps.is_some_and(|steps| steps.are_own);
        let length = self.steps.map(|steps| if refines { steps.length / refinement } else { steps.length });
        samples.iter().map(|sample| formulas.values(sample, &[]).into_iter().chain(length).collect()).collect()
    }

    /// The model's outputs of a program's rows.
    fn outputs_of(&self, rows: &[f64], sample: &Sample) -> Vec<f64> {
        let width = self.own.outputs.len();
        let mut values = Vec::with_capacity(rows.len() / width * self.output_count);
        let mut numbers = vec![0.0; width + 1];
        for (row, &time) in rows.chunks_exact(width).zip(self.times()) {
            numbers[..width].copy_from_slice(row);
            numbers[width] = time;
            values.extend(self.outputs.values(sample, &numbers));
        }
        values
    }
}
