//! Processes of one program: points are cut into calls, and points that fail are asked again, alone.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::answers::Answers;
use super::csv::{self, Table};
use super::launch::Launch;
use super::process::{Process, Said};
use super::trouble::Trouble;
use super::tuning::TUNING;
use super::{Answer, Questions, json};
use crate::model::{BlackBox, Protocol};

/// Why no point has an answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unanswered {
    /// The program cannot be started.
    #[error("the program `{program}` cannot be started: {why}")]
    NotStarted {
        /// Its name.
        program: String,
        /// The system's reason.
        why: String,
    },
    /// The run is to end.
    #[error("interrupted")]
    Interrupted,
}

/// Processes of one program that answer the same questions.
#[derive(Debug)]
pub struct Pool {
    own: BlackBox,
    launch: Launch,
    questions: Questions,
    /// Processes that wait for a call.
    idle: Mutex<Vec<Process>>,
    /// Number of the next point.
    next: AtomicU64,
}

/// A value behind a lock, of which a panic elsewhere leaves nothing half done.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Pool {
    /// No process is started before there is a point.
    pub fn new(own: BlackBox, questions: Questions) -> Self {
        Self {
            launch: Launch::new(own.program.clone()),
            own,
            questions,
            idle: Mutex::default(),
            next: AtomicU64::new(0),
        }
    }

    /// The questions that it answers.
    pub fn questions(&self) -> &Questions {
        &self.questions
    }

    /// Answers of all points (values of the parameters), in their order; `done` is called after every call with its
    /// number of points.
    ///
    /// # Errors
    /// If the program cannot be started, and at an interruption.
    pub fn answers(
        &self,
        points: &[Vec<f64>],
        threads: usize,
        interrupted: &(dyn Fn() -> bool + Sync),
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Vec<Answer>, Unanswered> {
        let processes = self.own.processes.unwrap_or(threads).max(1);
        let size = self.own.points.unwrap_or(usize::MAX).min(points.len().div_ceil(processes)).max(1);
        let calls: Vec<&[Vec<f64>]> = points.chunks(size).collect();
        let next = AtomicUsize::new(0);
        let found: Vec<Mutex<Result<Vec<Answer>, Unanswered>>> =
            calls.iter().map(|_| Mutex::new(Err(Unanswered::Interrupted))).collect();
        let work = || {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(call) = calls.get(index) else { return };
                let answered = self.settled(call, interrupted);
                let is_over = answered.is_err();
                *locked(&found[index]) = answered;
                if is_over {
                    next.store(calls.len(), Ordering::Relaxed);
                    return;
                }
                done(call.len());
            }
        };
        std::thread::scope(|scope| {
            (1..processes.min(calls.len())).for_each(|_| {
                scope.spawn(work);
            });
            work();
        });
        let mut answers = Vec::with_capacity(points.len());
        let found: Vec<_> =
            found.into_iter().map(|own| own.into_inner().unwrap_or_else(PoisonError::into_inner)).collect();
        // A program that cannot be started interrupts the others.
        if let Some(Err(why)) = found.iter().find(|own| matches!(own, Err(Unanswered::NotStarted { .. }))) {
            return Err(why.clone());
        }
        for answered in found {
            answers.extend(answered?);
        }
        Ok(answers)
    }

    /// Answers of a call's points. A point that failed is sent again alone, as often as it may: if a process ended, it
    /// is not known which of the call's points was the reason.
    fn settled(&self, points: &[Vec<f64>], interrupted: &dyn Fn() -> bool) -> Result<Vec<Answer>, Unanswered> {
        let found = self.call(points, interrupted)?;
        let is_alone = points.len() == 1;
        let mut answers = Vec::with_capacity(points.len());
        for (point, found) in points.iter().zip(found) {
            let tried = usize::from(is_alone || found.is_ok());
            let mut answer = found.unwrap_or_else(Err);
            let mut left = self.own.retries + 1 - tried;
            while answer.is_err() && left > 0 {
                let again = self.call(std::slice::from_ref(point), interrupted)?;
                answer = again.into_iter().next().map_or(answer, |again| again.unwrap_or_else(Err));
                left -= 1;
            }
            answers.push(answer);
        }
        Ok(answers)
    }

    /// Asks once. The outer error is of points that were not answered.
    fn call(
        &self,
        points: &[Vec<f64>],
        interrupted: &dyn Fn() -> bool,
    ) -> Result<Vec<Result<Answer, Trouble>>, Unanswered> {
        let waiting = locked(&self.idle).pop();
        let mut process = match waiting {
            Some(process) => process,
            None => {
                let started =
                    self.launch.command().and_then(|command| Process::start(command).map_err(|e| e.to_string()));
                started.map_err(|why| Unanswered::NotStarted { program: self.launch.name(), why })?
            }
        };
        let first = self.next.fetch_add(points.len() as u64, Ordering::Relaxed);
        let values: Vec<&[f64]> = points.iter().map(Vec::as_slice).collect();
        let text = match self.own.protocol {
            Protocol::Json => json::lines(&self.questions, first, &values),
            Protocol::Csv => csv::table(&self.questions, &values),
        };
        let numbers = self.questions.times.len() * (self.questions.outputs.len() + self.questions.parameters.len() + 2);
        let most = TUNING.chatter_bytes + 2 * text.len() as u64 + TUNING.number_bytes * (points.len() * numbers) as u64;
        let limit = self.own.time_limit.map(|limit| limit * points.len() as f64);
        let until = limit.map(|limit| Instant::now() + Duration::from_secs_f64(limit));
        process.give(text, most, !self.own.persistent);
        let (mut answers, mut table) = (Answers::of(points.len()), Table::of(points.len()));
        let mut take = |line: &str, answers: &mut Answers| match self.own.protocol {
            Protocol::Json => json::take(&self.questions, first, line, answers),
            Protocol::Csv => table.take(&self.questions, line, answers),
        };
        let why = loop {
            if answers.is_complete() && self.own.persistent {
                locked(&self.idle).push(process);
                return Ok(answers.finish(None));
            }
            match process.next(until, interrupted) {
                Said::Line(line) => {
                    if let Err(wrong) = take(&line, &mut answers) {
                        process.end(false);
                        break Some(wrong);
                    }
                }
                Said::TooMuch => {
                    process.end(false);
                    break Some(Trouble::TooMuch { most, words: process.words() });
                }
                Said::Nothing => {
                    process.end(false);
                    break Some(Trouble::TooSlow { limit: limit.unwrap_or_default(), words: process.words() });
                }
                Said::Interrupted => {
                    process.end(false);
                    return Err(Unanswered::Interrupted);
                }
                Said::End if answers.is_complete() => break None,
                Said::End => {
                    let status = process.end(true);
                    if interrupted() {
                        return Err(Unanswered::Interrupted);
                    }
                    break Some(Trouble::Ended { status, words: process.words() });
                }
            }
        };
        if self.own.protocol == Protocol::Csv && !matches!(why, Some(Trouble::TooSlow { .. } | Trouble::TooMuch { .. }))
        {
            table.end(&self.questions, &mut answers);
        }
        Ok(answers.finish(why))
    }
}
