//! Functions that a unit may call: messages, which go to standard error, and memory.

#![allow(unsafe_code)]

use std::ffi::{CStr, c_char, c_int, c_void};

/// Callbacks of FMI 2.0.
#[repr(C)]
pub struct Callbacks {
    /// Declared variadic in C. In every C calling convention, further arguments do not move the named ones.
    pub log: extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char),
    pub allocate: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    pub free: unsafe extern "C" fn(*mut c_void),
    pub finished: Option<extern "C" fn(*mut c_void, c_int)>,
    pub environment: *mut c_void,
}

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}

impl Callbacks {
    /// The callbacks of this process.
    pub fn new() -> Self {
        Self { log: log_two, allocate: calloc, free, finished: None, environment: std::ptr::null_mut() }
    }
}

extern "C" fn log_two(_: *mut c_void, _: *const c_char, status: c_int, _: *const c_char, message: *const c_char) {
    // Format marks of further arguments stay in the text.
    note(status, message);
}

/// A message of FMI 3.0.
pub extern "C" fn log_three(_: *mut c_void, status: c_int, _: *const c_char, message: *const c_char) {
    note(status, message);
}

fn note(status: c_int, message: *const c_char) {
    if status == 0 || message.is_null() {
        return;
    }
    // SAFETY: by the standard, it is a text that ends with zero.
    let message = unsafe { CStr::from_ptr(message) };
    eprintln!("{}", message.to_string_lossy().trim_end());
}
