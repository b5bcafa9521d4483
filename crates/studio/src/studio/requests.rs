//! Questions of the page to a worker: only the latest of each kind is answered.

use std::collections::VecDeque;
use std::mem::discriminant;
use std::sync::mpsc::{Sender, channel};
use std::sync::{Condvar, Mutex, PoisonError};

use super::tuning::TUNING;
use serde_json::Value;

/// A question, and the sender of its answer.
pub struct Asked<Q> {
    /// The question.
    pub question: Q,
    answer: Sender<Result<Value, String>>,
}

impl<Q> Asked<Q> {
    /// Sends the answer.
    pub fn answer(self, answer: Result<Value, String>) {
        // Ignored if the page does not wait any more.
        let _ = self.answer.send(answer);
    }
}

/// Waiting questions.
pub struct Requests<Q> {
    waiting: Mutex<VecDeque<Asked<Q>>>,
    bell: Condvar,
}

impl<Q> Default for Requests<Q> {
    fn default() -> Self {
        Self { waiting: Mutex::default(), bell: Condvar::new() }
    }
}

impl<Q> Requests<Q> {
    /// Asks a question, and waits for the answer.
    ///
    /// # Errors
    /// If the worker has none, or a later question of the same kind replaces this one.
    pub fn ask(&self, question: Q) -> Result<Value, String> {
        let (answer, answered) = channel();
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.retain(|own| discriminant(&own.question) != discriminant(&question));
        waiting.push_back(Asked { question, answer });
        drop(waiting);
        self.bell.notify_one();
        answered.recv().unwrap_or_else(|_| Err("a later request took its place".to_owned()))
    }

    /// Waits for the next question; `None` at an end.
    pub fn next(&self, is_ended: &dyn Fn() -> bool) -> Option<Asked<Q>> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        while !is_ended() {
            if let Some(first) = waiting.pop_front() {
                return Some(first);
            }
            waiting = self
                .bell
                .wait_timeout(waiting, TUNING.between_looks_of_requests)
                .unwrap_or_else(PoisonError::into_inner)
                .0;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    enum Question {
        Number(u64),
        Other,
    }

    #[test]
    fn the_latest_of_a_kind_is_answered() {
        let requests = Requests::default();
        std::thread::scope(|scope| {
            let first = scope.spawn(|| requests.ask(Question::Number(1)));
            let waits = |count: usize| {
                while requests.waiting.lock().unwrap().len() < count {
                    std::thread::yield_now();
                }
            };
            waits(1);
            let other = scope.spawn(|| requests.ask(Question::Other));
            waits(2);
            let second = scope.spawn(|| requests.ask(Question::Number(2)));
            assert!(first.join().unwrap().is_err(), "its place was taken");
            for _ in 0..2 {
                let asked = requests.next(&|| false).unwrap();
                let answer = if let Question::Number(number) = asked.question { number } else { 0 };
                asked.answer(Ok(answer.into()));
            }
            assert_eq!([other.join().unwrap().unwrap(), second.join().unwrap().unwrap()], [0, 2]);
        });
        assert!(requests.next(&|| true).is_none());
    }
}
