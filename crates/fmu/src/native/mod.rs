//! The library of a unit, and an instance of it: the only code here that the compiler cannot check.

mod callbacks;
mod library;
mod three;
mod two;

use std::path::Path;

use crate::unit::{Interface, NumberType, Unit, Version};

/// Reasons why an instance stops.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// Its library cannot be used.
    #[error("its library: {0}")]
    Library(String),
    /// A function did not succeed.
    #[error("`{function}` failed (status {status})")]
    Status {
        /// Its name.
        function: &'static str,
        /// 2 discard, 3 error, 4 fatal.
        status: i32,
    },
    /// There is no instance.
    #[error("`{0}` made no instance")]
    NoInstance(&'static str),
    /// The unit ends its motion.
    #[error("it ends its motion at t = {0} s")]
    Terminated(f64),
    /// A value is not of the variable's type.
    #[error("{0} is no value of an integer or Boolean variable of its type")]
    Value(f64),
    /// Its events have no end.
    #[error("more than {count} events at t = {time} s")]
    Events {
        /// Events that were counted.
        count: usize,
        /// s
        time: f64,
    },
}

/// Report of an instance on its discrete states.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Discrete {
    /// Whether to ask for them again: in a new event after a step.
    pub again: bool,
    /// Whether it ends its motion.
    pub terminates: bool,
    /// Time of the next event, if known in advance, s.
    pub next: Option<f64>,
}

/// An instance of a unit. Calls have the order of the standard.
pub trait Instance {
    /// Sets a variable.
    fn set(&mut self, kind: NumberType, reference: u32, value: f64) -> Result<(), Fault>;
    /// A variable's value.
    fn get(&mut self, kind: NumberType, reference: u32) -> Result<f64, Fault>;
    /// Finds the start of a motion from 0 to `end`, s.
    fn initialise(&mut self, end: f64) -> Result<(), Fault>;
    /// Takes a step, s, in co-simulation; returns whether the unit ends its motion with that step.
    fn step(&mut self, time: f64, size: f64) -> Result<bool, Fault>;
    /// Enters the mode of events; it begins there.
    fn enter_events(&mut self) -> Result<(), Fault>;
    /// Handles an event.
    fn update_discrete(&mut self) -> Result<Discrete, Fault>;
    /// Enters the mode of continuous time.
    fn enter_continuous(&mut self) -> Result<(), Fault>;
    /// Sets the time, s.
    fn set_time(&mut self, time: f64) -> Result<(), Fault>;
    /// Sets continuous states.
    fn set_states(&mut self, states: &[f64]) -> Result<(), Fault>;
    /// Continuous states.
    fn states(&mut self, into: &mut [f64]) -> Result<(), Fault>;
    /// Derivatives of continuous states.
    fn derivatives(&mut self, into: &mut [f64]) -> Result<(), Fault>;
    /// Event indicators; `into` is resized to their number.
    fn indicators(&mut self, into: &mut Vec<f64>) -> Result<(), Fault>;
    /// Reports the end of an integrator's step; returns whether the unit wants an event, or ends its motion.
    fn completed(&mut self) -> Result<Discrete, Fault>;
}

/// Makes instances of a unit that is unpacked in a folder.
pub struct Native {
    library: Library,
    token: String,
    resources: std::path::PathBuf,
    interface: Interface,
    indicators: usize,
}

enum Library {
    Two(two::Functions),
    Three(three::Functions),
}

impl Native {
    /// Loads the library of a unit for this platform.
    ///
    /// # Errors
    /// If there is none, or it lacks a function.
    pub fn load(unit: &Unit, folder: &Path, interface: Interface) -> Result<Self, Fault> {
        let name =
            unit.library(interface).ok_or_else(|| Fault::Library("it has none for this interface".to_owned()))?;
        let path = library::find(folder, name, unit.version)?;
        let library = match unit.version {
            Version::Two => Library::Two(two::Functions::load(&path, interface)?),
            Version::Three => Library::Three(three::Functions::load(&path, interface)?),
        };
        let (token, resources) = (unit.token.clone(), folder.join("resources"));
        Ok(Self { library, token, resources, interface, indicators: unit.indicators })
    }

    /// A new instance.
    ///
    /// # Errors
    /// If the unit makes none.
    pub fn instance(&self) -> Result<Box<dyn Instance + '_>, Fault> {
        let (token, resources, interface) = (&self.token, &self.resources, self.interface);
        Ok(match &self.library {
            Library::Two(own) => Box::new(two::Two::new(own, token, resources, interface, self.indicators)?),
            Library::Three(own) => Box::new(three::Three::new(own, token, resources, interface)?),
        })
    }
}

/// Whether a status of a function is `OK` or `Warning`.
fn checked(function: &'static str, status: i32) -> Result<(), Fault> {
    if (0..=1).contains(&status) { Ok(()) } else { Err(Fault::Status { function, status }) }
}

/// An integer of type `T`; beyond 2^53 a value does not determine an integer.
fn whole<T: TryFrom<i64>>(value: f64) -> Result<T, Fault> {
    let is_whole = value.fract() == 0.0 && value.abs() <= 9_007_199_254_740_992.0;
    let found = if is_whole { T::try_from(value as i64).ok() } else { None };
    found.ok_or(Fault::Value(value))
}

/// Whether a time, s, is before another by more than rounding.
fn is_before(time: f64, end: f64) -> bool {
    time < end - 1e-9 * (1.0 + end.abs())
}

/// 0 or 1.
fn truth(value: f64) -> Result<bool, Fault> {
    if value == 0.0 || value == 1.0 { Ok(value == 1.0) } else { Err(Fault::Value(value)) }
}
