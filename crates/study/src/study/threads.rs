//! The threads of a run.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// Threads that share the work of a run.
pub struct Threads(Option<ThreadPool>);

/// The threads of a run: `threads`, or one per core. Where the target has none, as in a browser, the work is done on
/// the thread that asks for it.
///
/// # Errors
/// If they cannot be started.
pub fn pool(threads: Option<usize>) -> Result<Threads, ThreadPoolBuildError> {
    if cfg!(target_family = "wasm") {
        return Ok(Threads(None));
    }
    ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build().map(|pool| Threads(Some(pool)))
}

impl Threads {
    /// Computes something on these threads.
    pub fn install<T: Send>(&self, compute: impl FnOnce() -> T + Send) -> T {
        match &self.0 {
            Some(pool) => pool.install(compute),
            None => compute(),
        }
    }
}
