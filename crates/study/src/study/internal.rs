//! Errors of this program itself: a panic costs the current computation, and nothing else.

use std::any::Any;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, set_hook, take_hook};
use std::sync::Mutex;

/// The last panic, with its location in the source, once [`record_panics`] was called.
static LAST: Mutex<Option<String>> = Mutex::new(None);

/// A panic, and the remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "internal error in {stage}: {message}; please report it at {}/issues, with this line, the model's files, the command and the \
     system (mbint {})",
    env!("CARGO_PKG_REPOSITORY"),
    env!("CARGO_PKG_VERSION")
)]
pub struct InternalError {
    /// Computation that panicked.
    stage: String,
    /// The panic's message, with its location in the source if known.
    message: String,
}

/// Makes panics appear not where they happen (unless `RUST_BACKTRACE` asks for it), but with the error that they
/// become.
pub fn record_panics() {
    let shown = take_hook();
    let wanted = std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0");
    set_hook(Box::new(move |panic: &PanicHookInfo| {
        let place = panic.location().map_or_else(String::new, |place| format!(" ({}:{})", place.file(), place.line()));
        *last() = Some(format!("{}{place}", message_of(panic.payload())));
        if wanted {
            shown(panic);
        }
    }));
}

/// Computes something; a panic becomes an error.
///
/// # Errors
/// For a panic.
pub fn caught<T>(stage: &str, compute: impl FnOnce() -> T) -> Result<T, InternalError> {
    // Values that a panic leaves half done are dropped with the closure, or not read again.
    catch_unwind(AssertUnwindSafe(compute)).map_err(|payload| {
        let message = last().take().unwrap_or_else(|| message_of(payload.as_ref()));
        InternalError { stage: stage.to_owned(), message: message.replace('\n', " ") }
    })
}

fn last() -> std::sync::MutexGuard<'static, Option<String>> {
    // A text is whole whatever panicked while the lock was taken.
    LAST.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn message_of(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_else(|| "panic".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panic_becomes_an_error_with_a_remedy() {
        assert_eq!(caught("scan", || 1), Ok(1));
        let error = caught("scan", || panic!("row {}", 7)).unwrap_err().to_string();
        assert!(error.starts_with("internal error in scan: row 7"), "{error}");
        assert!(error.contains("please report it at https://") && error.contains("the model's files"), "{error}");
    }
}
