//! The progress bar; where there is no terminal, a line now and then.

use std::io::{IsTerminal, Write};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::syntax::harmless;

/// Parts of the bar; finer than a terminal is wide.
const PARTS: u64 = 10_000;

/// Between two lines where there is no terminal.
const BETWEEN: Duration = Duration::from_secs(10);

/// A bar on a terminal's standard error, gone when dropped; elsewhere a line every ten seconds.
pub(super) struct Progress {
    bar: ProgressBar,
    /// What is being done.
    name: String,
    begun: Instant,
    /// When the last line was written; `None` where there are no lines.
    last: Option<Mutex<Instant>>,
}

impl Progress {
    /// A bar labelled with `name`, or none.
    pub fn new(name: &str, visible: bool) -> Self {
        let target = if visible { ProgressDrawTarget::stderr_with_hz(10) } else { ProgressDrawTarget::hidden() };
        let name = harmless(name);
        let bar = ProgressBar::with_draw_target(Some(PARTS), target).with_prefix(name.clone());
        let style = ProgressStyle::with_template("{prefix}  [{bar:40}] {percent:>3} %  {eta} left");
        if let Ok(style) = style {
            bar.set_style(style.progress_chars("=> "));
        }
        let begun = Instant::now();
        let lines = visible && !std::io::stderr().is_terminal();
        Self { bar, name, begun, last: lines.then(|| Mutex::new(begun)) }
    }

    /// Shows that this fraction is done. May be called from any thread, in any order: the bar never goes back.
    pub fn set(&self, fraction: f64) {
        let fraction = fraction.clamp(0.0, 1.0);
        let parts = (fraction * PARTS as f64) as u64;
        if parts > self.bar.position() {
            self.bar.set_position(parts);
        }
        // Another thread that writes a line does it for all.
        let Some(Ok(mut last)) = self.last.as_ref().map(Mutex::try_lock) else { return };
        if last.elapsed() >= BETWEEN {
            *last = Instant::now();
            let line = line(&self.name, self.bar.position() as f64 / PARTS as f64, self.begun.elapsed());
            // If standard error is closed, nobody can be told.
            let _ = writeln!(std::io::stderr(), "{line}");
        }
    }
}

/// What is done, and how long the rest takes if it goes on like that.
fn line(name: &str, fraction: f64, elapsed: Duration) -> String {
    let left = elapsed.as_secs_f64() * (1.0 / fraction.max(1e-6) - 1.0);
    let left = match fraction > 0.01 && left < 1e6 {
        true => format!(", about {} left", HumanDuration(Duration::from_secs_f64(left))),
        false => String::new(),
    };
    format!("{name}: {:.0} % done{left}", 100.0 * fraction)
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_tell_what_is_left() {
        let line = |fraction| line("crank", fraction, Duration::from_secs(30));
        assert_eq!(line(0.25), "crank: 25 % done, about 2 minutes left");
        assert_eq!(line(0.75), "crank: 75 % done, about 10 seconds left");
        assert_eq!(line(0.0), "crank: 0 % done");
    }
}
