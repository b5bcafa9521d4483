//! Equal steps between two rows.

/// Steps of one size from one time to another.
pub struct Steps {
    from: f64,
    to: f64,
    /// Number of steps.
    pub count: usize,
}

impl Steps {
    /// Steps from one row to the next, s; none is longer than `longest`, s.
    pub fn between(from: f64, to: f64, longest: f64) -> Self {
        // A multiple of `longest` up to rounding counts as one.
        let count = (((to - from) / longest - 1e-9).ceil()).max(1.0) as usize;
        Self { from, to, count }
    }

    /// Size of each step, s.
    pub fn size(&self) -> f64 {
        (self.to - self.from) / self.count as f64
    }

    /// Time after `index` steps, s.
    pub fn time(&self, index: usize) -> f64 {
        if index == self.count { self.to } else { self.from + index as f64 * self.size() }
    }
}
