//! The file of a unit's library, and its functions by name.

use std::env::consts::{ARCH, DLL_EXTENSION, OS};
use std::path::{Path, PathBuf};

use super::Fault;
use crate::unit::Version;

/// The library for this platform in an unpacked unit.
///
/// # Errors
/// If there is none: the message lists the platforms that exist.
pub fn find(folder: &Path, name: &str, version: Version) -> Result<PathBuf, Fault> {
    let binaries = folder.join("binaries");
    let system = if OS == "macos" { "darwin" } else { OS };
    let platform = match version {
        Version::Two => format!("{}64", if OS == "windows" { "win" } else { system }),
        Version::Three => format!("{ARCH}-{system}"),
    };
    let path = binaries.join(&platform).join(format!("{name}.{DLL_EXTENSION}"));
    if path.is_file() {
        return Ok(path);
    }
    let found = std::fs::read_dir(&binaries).into_iter().flatten().flatten();
    let mut found: Vec<String> = found.map(|entry| format!("`{}`", entry.file_name().to_string_lossy())).collect();
    found.sort();
    let found = if found.is_empty() { "none".to_owned() } else { found.join(", ") };
    Err(Fault::Library(format!("the unit has no library for `{platform}`, but {found}")))
}

/// An error with its reason, which is the system's.
pub fn in_words(error: &libloading::Error) -> String {
    let reason = std::error::Error::source(error).map(|reason| format!(": {reason}"));
    format!("{error}{}", reason.unwrap_or_default())
}

/// Declares a struct of functions that are loaded from a library by their names; those of the other interface are
/// `None`.
macro_rules! functions {
    ($(#[$attribute:meta])* $name:ident { always { $($field:ident = $symbol:literal : fn($($argument:ty),* $(,)?) $(-> $result:ty)?;)* }
     co_simulation { $($cs:ident = $cs_symbol:literal : fn($($cs_argument:ty),* $(,)?) -> $cs_result:ty;)* }
     model_exchange { $($me:ident = $me_symbol:literal : fn($($me_argument:ty),* $(,)?) -> $me_result:ty;)* } }) => {
        $(#[$attribute])*
        pub struct $name {
            $(pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
            $(pub $cs: Option<unsafe extern "C" fn($($cs_argument),*) -> $cs_result>,)*
            $(pub $me: Option<unsafe extern "C" fn($($me_argument),*) -> $me_result>,)*
            /// Functions are valid as long as their library is loaded.
            _library: libloading::Library,
        }

        #[allow(unsafe_code)]
        impl $name {
            /// Loads them.
            ///
            /// # Errors
            /// If the library cannot be loaded, or lacks a function.
            pub fn load(path: &std::path::Path, interface: crate::unit::Interface) -> Result<Self, super::Fault> {
                let fault = |error: libloading::Error| super::Fault::Library(super::library::in_words(&error));
                // SAFETY: the library's initialisers run, which the user trusts by naming the unit.
                let library = unsafe { libloading::Library::new(path) }.map_err(fault)?;
                let steps = interface == crate::unit::Interface::CoSimulation;
                // SAFETY: types are those of the standard's header, and pointers do not outlive the library.
                unsafe {
                    Ok(Self {
                        $($field: *library.get($symbol).map_err(fault)?,)*
                        $($cs: if steps { Some(*library.get($cs_symbol).map_err(fault)?) } else { None },)*
                        $($me: if steps { None } else { Some(*library.get($me_symbol).map_err(fault)?) },)*
                        _library: library,
                    })
                }
            }
        }
    };
}

/// Calls a function of an instance and checks its status.
macro_rules! call {
    ($self:ident, $field:ident, $symbol:literal $(, $argument:expr)*) => {{
        // SAFETY: the instance is the library's own, slices have the stated lengths, and no argument is stored.
        let status = unsafe { ($self.functions.$field)($self.instance $(, $argument)*) };
        super::checked($symbol, status)
    }};
}

/// Calls, likewise, a function that only one interface has.
macro_rules! call_own {
    ($self:ident, $field:ident, $symbol:literal $(, $argument:expr)*) => {{
        match $self.functions.$field {
            // SAFETY: as for `call`.
            Some(function) => super::checked($symbol, unsafe { function($self.instance $(, $argument)*) }),
            None => Err(super::Fault::Library(format!("it has no `{}`", $symbol))),
        }
    }};
}

pub(super) use {call, call_own, functions};
