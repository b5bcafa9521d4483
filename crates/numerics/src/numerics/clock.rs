//! The clock by which runs are timed: that of the system, or of the page in which the program runs.

#[cfg(not(target_family = "wasm"))]
pub use std::time::Instant;

#[cfg(target_family = "wasm")]
pub use hosted::{Instant, set_clock};

/// The standard library has no clock on this target: a program that is embedded in a page asks its host.
#[cfg(target_family = "wasm")]
mod hosted {
    use std::sync::OnceLock;
    use std::time::Duration;

    static CLOCK: OnceLock<fn() -> f64> = OnceLock::new();

    /// Sets the host's clock, s from any time on. Without one, nothing takes any time.
    pub fn set_clock(seconds: fn() -> f64) {
        CLOCK.get_or_init(|| seconds);
    }

    /// A reading of the host's clock, s.
    #[derive(Clone, Copy, Debug)]
    pub struct Instant(f64);

    impl Instant {
        /// The present.
        pub fn now() -> Self {
            Self(CLOCK.get().map_or(0.0, |seconds| seconds()))
        }

        /// The time since then.
        pub fn elapsed(&self) -> Duration {
            Duration::try_from_secs_f64(Self::now().0 - self.0).unwrap_or_default()
        }
    }
}
