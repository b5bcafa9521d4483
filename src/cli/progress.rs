//! The progress bar; without a terminal, a line now and then.

use std::fmt::Write as _;
use std::io::{IsTerminal, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use super::tuning::TUNING;
use crate::syntax::harmless;

/// A bar on a terminal's standard error, removed when dropped; elsewhere a line every ten seconds.
pub(super) struct Progress {
    bar: ProgressBar,
    /// Current activity.
    stage: Arc<Mutex<String>>,
    /// Thread that writes the lines without a terminal, until the sender is dropped.
    lines: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// A bar labelled with `name`; hidden unless `visible`.
    pub fn new(name: &str, visible: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let target =
            if visible && terminal { ProgressDrawTarget::stderr_with_hz(10) } else { ProgressDrawTarget::hidden() };
        let name = harmless(name);
        let bar = ProgressBar::with_draw_target(Some(TUNING.parts_of_bar), target).with_prefix(name.clone());
        let style = ProgressStyle::with_template("{prefix}: {msg}  [{bar:30}] {percent:>3} %{left}");
        if let Ok(style) = style {
            let left = |state: &ProgressState, text: &mut dyn std::fmt::Write| {
                // Failures of the output are ignored.
                let _ = text.write_str(&left(f64::from(state.fraction()), state.elapsed()));
            };
            bar.set_style(style.progress_chars("=> ").with_key("left", left));
        }
        if visible && terminal {
            bar.enable_steady_tick(TUNING.tick);
        }
        let stage = Arc::new(Mutex::new(String::new()));
        let lines = (visible && !terminal).then(|| {
            let (sender, ended) = channel();
            let (bar, stage) = (bar.clone(), Arc::clone(&stage));
            (sender, std::thread::spawn(move || write_lines(&name, &bar, &stage, &ended)))
        });
        Self { bar, stage, lines }
    }

    /// Shows the finished fraction. May be called from any thread, in any order: the bar goes back only for a new
    /// count, which begins with 0.
    pub fn set(&self, fraction: f64) {
        if fraction == 0.0 {
            self.bar.reset();
        }
        let parts = (fraction.clamp(0.0, 1.0) * TUNING.parts_of_bar as f64) as u64;
        if parts > self.bar.position() {
            self.bar.set_position(parts);
        }
    }

    /// Prints a line above the bar, which stays.
    pub fn note(&self, line: &str) {
        // If standard error is closed, nothing can be reported.
        self.bar.suspend(|| drop(writeln!(std::io::stderr(), "{line}")));
    }

    /// Shows the current activity.
    pub fn stage(&self, stage: &str) {
        stage.clone_into(&mut self.stage.lock().unwrap_or_else(PoisonError::into_inner));
        self.bar.set_message(stage.to_owned());
    }
}

/// Writes a line every ten seconds, until the other end of `ended` is dropped.
fn write_lines(name: &str, bar: &ProgressBar, stage: &Mutex<String>, ended: &Receiver<()>) {
    let mut known = None;
    while ended.recv_timeout(TUNING.between_lines) == Err(RecvTimeoutError::Timeout) {
        let done = bar.position() as f64 / TUNING.parts_of_bar as f64;
        let stage = stage.lock().unwrap_or_else(PoisonError::into_inner).clone();
        // An unchanged state is not repeated.
        if known.as_ref().is_some_and(|known| *known == (stage.clone(), percent(done))) {
            continue;
        }
        let line = line(name, &stage, done, bar.elapsed());
        known = Some((stage, percent(done)));
        // If standard error is closed, nothing can be reported.
        let _ = writeln!(std::io::stderr(), "{line}");
    }
}

/// Current activity, share done, and remaining time.
fn line(name: &str, stage: &str, fraction: f64, elapsed: Duration) -> String {
    let mut line = name.to_owned();
    let separator = if stage.is_empty() { ": " } else { ", " };
    if !stage.is_empty() {
        line += &format!(": {stage}");
    }
    // Writing to a text does not fail.
    let _ = write!(line, "{separator}{} % done{}", percent(fraction), left(fraction, elapsed));
    line
}

/// Whole per cent: a hundred only when all is done.
fn percent(fraction: f64) -> u32 {
    (100.0 * fraction) as u32
}

/// Remaining time at the present speed; empty if unknown yet.
fn left(fraction: f64, elapsed: Duration) -> String {
    let left = elapsed.as_secs_f64() * (1.0 / fraction.max(1e-6) - 1.0);
    match fraction > 0.01 && fraction < 1.0 && left < 1e6 {
        true => format!(", about {} left", HumanDuration(Duration::from_secs_f64(left))),
        false => String::new(),
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
        if let Some((sender, lines)) = self.lines.take() {
            drop(sender);
            // The thread has no result; after a panic only its lines are missing.
            let _ = lines.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_state_the_remaining_time() {
        let line = |stage, fraction| line("crank", stage, fraction, Duration::from_secs(30));
        assert_eq!(line("scan", 0.25), "crank: scan, 25 % done, about 2 minutes left");
        assert_eq!(line("", 0.75), "crank: 75 % done, about 10 seconds left");
        assert_eq!(line("compiling", 0.0), "crank: compiling, 0 % done");
    }
}
