//! The functions between a page's worker and the engine, all over linear memory: the only unsafe code of this crate.
//!
//! The worker allocates a question, asks it, reads the answer and releases it: four bytes of its length, least first,
//! then its text. An instance that has stopped (a panic, no more memory) is not asked again.

use std::alloc::{GlobalAlloc, Layout, System};
use std::panic::set_hook;
use std::sync::Once;

use mbint_numerics::numerics::clock::set_clock;

use crate::{Host, answer};

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// A clock, s.
    safe fn seconds() -> f64;
    /// Progress of the run: the activity's text and the fraction that is done.
    safe fn progress(text: *const u8, length: usize, fraction: f64);
    /// The message of a panic, just before the instance stops.
    safe fn panicked(text: *const u8, length: usize);
    /// An allocation of `bytes` bytes failed.
    safe fn exhausted(bytes: usize);
}

/// The allocator of the standard library, which reports that memory is exhausted: the trap that follows reports
/// nothing.
struct Reporting;

#[global_allocator]
static ALLOCATOR: Reporting = Reporting;

// SAFETY: every call is passed to the system's allocator.
unsafe impl GlobalAlloc for Reporting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: by the caller's contract.
        reported(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: by the caller's contract.
        reported(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: by the caller's contract.
        unsafe { System.dealloc(block, layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: by the caller's contract.
        reported(unsafe { System.realloc(block, layout, size) }, size)
    }
}

fn reported(block: *mut u8, bytes: usize) -> *mut u8 {
    if block.is_null() {
        exhausted(bytes);
    }
    block
}

/// The page, as host of the engine.
struct Page;

impl Host for Page {
    fn progress(&self, stage: &str, fraction: f64) {
        progress(stage.as_ptr(), stage.len(), fraction);
    }
}

/// Room for a question of `length` bytes.
#[unsafe(no_mangle)]
pub extern "C" fn allocate(length: usize) -> *mut u8 {
    Box::leak(vec![0; length].into_boxed_slice()).as_mut_ptr()
}

/// Answers a question, whose memory it takes; the answer has to be released.
///
/// # Safety
/// `question` and `length` are from one call of [`allocate`], and are passed once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ask(question: *mut u8, length: usize) -> *mut u8 {
    static BEGUN: Once = Once::new();
    BEGUN.call_once(|| {
        set_clock(|| seconds());
        set_hook(Box::new(|panic| {
            let text = panic.to_string();
            panicked(text.as_ptr(), text.len());
        }));
    });
    // SAFETY: by the contract, this is the block of `allocate`.
    let question = unsafe { Vec::from_raw_parts(question, length, length) };
    let answer = answer(&question, &Page);
    let mut bytes = Vec::with_capacity(4 + answer.len());
    bytes.extend_from_slice(&(answer.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&answer);
    Box::leak(bytes.into_boxed_slice()).as_mut_ptr()
}

/// Releases an answer.
///
/// # Safety
/// `answer` is from one call of [`ask`], and is passed once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn release(answer: *mut u8) {
    // SAFETY: by the contract, the block begins with the length of the rest.
    drop(unsafe {
        let length = 4 + u32::from_le_bytes(answer.cast::<[u8; 4]>().read()) as usize;
        Box::from_raw(std::ptr::slice_from_raw_parts_mut(answer, length))
    });
}
