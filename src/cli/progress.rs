//! The progress bar.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Parts of the bar; finer than a terminal is wide.
const PARTS: u64 = 10_000;

/// A bar on a terminal's standard error, gone when dropped. It does not show where there is no terminal.
pub(super) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar labelled with `name`, or none.
    pub fn new(name: &str, visible: bool) -> Self {
        let target = if visible { ProgressDrawTarget::stderr_with_hz(10) } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(PARTS), target).with_prefix(crate::syntax::harmless(name));
        let style = ProgressStyle::with_template("{prefix}  [{bar:40}] {percent:>3} %  {eta} left");
        if let Ok(style) = style {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar }
    }

    /// Shows that this fraction is done. May be called from any thread, in any order: the bar never goes back.
    pub fn set(&self, fraction: f64) {
        let parts = (fraction.clamp(0.0, 1.0) * PARTS as f64) as u64;
        if parts > self.bar.position() {
            self.bar.set_position(parts);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
