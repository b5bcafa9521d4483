//! FMI 2.0. Source: `fmi2FunctionTypes.h`.

#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::path::Path;

use super::callbacks::Callbacks;
use super::library::{call, call_own, functions};
use super::{Discrete, Fault, Instance, is_before, truth, whole};
use crate::unit::{Interface, NumberType};

type Own = *mut c_void;

/// `fmi2Discard`.
const DISCARD: c_int = 2;

/// `fmi2LastSuccessfulTime` and `fmi2Terminated`, queried after a discarded step.
const LAST_TIME: c_int = 2;
const TERMINATED: c_int = 3;

/// `fmi2EventInfo`.
#[repr(C)]
#[derive(Default)]
pub struct EventInfo {
    again: c_int,
    terminates: c_int,
    has_new_nominals: c_int,
    has_new_states: c_int,
    is_next_known: c_int,
    next: f64,
}

functions! {
    /// Functions of the standard.
    Functions {
        always {
            instantiate = b"fmi2Instantiate": fn(*const c_char, c_int, *const c_char, *const c_char, *const Callbacks, c_int, c_int) -> Own;
            free = b"fmi2FreeInstance": fn(Own);
            setup = b"fmi2SetupExperiment": fn(Own, c_int, f64, f64, c_int, f64) -> c_int;
            enter_initialisation = b"fmi2EnterInitializationMode": fn(Own) -> c_int;
            exit_initialisation = b"fmi2ExitInitializationMode": fn(Own) -> c_int;
            get_real = b"fmi2GetReal": fn(Own, *const c_uint, usize, *mut f64) -> c_int;
            set_real = b"fmi2SetReal": fn(Own, *const c_uint, usize, *const f64) -> c_int;
            get_integer = b"fmi2GetInteger": fn(Own, *const c_uint, usize, *mut c_int) -> c_int;
            set_integer = b"fmi2SetInteger": fn(Own, *const c_uint, usize, *const c_int) -> c_int;
            get_boolean = b"fmi2GetBoolean": fn(Own, *const c_uint, usize, *mut c_int) -> c_int;
            set_boolean = b"fmi2SetBoolean": fn(Own, *const c_uint, usize, *const c_int) -> c_int;
        }
        co_simulation {
            do_step = b"fmi2DoStep": fn(Own, f64, f64, c_int) -> c_int;
            real_status = b"fmi2GetRealStatus": fn(Own, c_int, *mut f64) -> c_int;
            boolean_status = b"fmi2GetBooleanStatus": fn(Own, c_int, *mut c_int) -> c_int;
        }
        model_exchange {
            enter_events = b"fmi2EnterEventMode": fn(Own) -> c_int;
            new_discrete_states = b"fmi2NewDiscreteStates": fn(Own, *mut EventInfo) -> c_int;
            enter_continuous = b"fmi2EnterContinuousTimeMode": fn(Own) -> c_int;
            completed = b"fmi2CompletedIntegratorStep": fn(Own, c_int, *mut c_int, *mut c_int) -> c_int;
            set_time = b"fmi2SetTime": fn(Own, f64) -> c_int;
            set_states = b"fmi2SetContinuousStates": fn(Own, *const f64, usize) -> c_int;
            get_states = b"fmi2GetContinuousStates": fn(Own, *mut f64, usize) -> c_int;
            get_derivatives = b"fmi2GetDerivatives": fn(Own, *mut f64, usize) -> c_int;
            get_indicators = b"fmi2GetEventIndicators": fn(Own, *mut f64, usize) -> c_int;
        }
    }
}

/// An instance.
pub struct Two<'f> {
    functions: &'f Functions,
    instance: Own,
    indicators: usize,
    /// The instance stores a pointer to them.
    _callbacks: Box<Callbacks>,
}

impl<'f> Two<'f> {
    /// A new instance.
    ///
    /// # Errors
    /// If the unit makes none.
    pub fn new(
        functions: &'f Functions,
        token: &str,
        resources: &Path,
        interface: Interface,
        indicators: usize,
    ) -> Result<Self, Fault> {
        let none = |_| Fault::Library("its description has a zero byte".to_owned());
        let token = CString::new(token).map_err(none)?;
        let resources = CString::new(format!("file://{}", resources.display())).map_err(none)?;
        let callbacks = Box::new(Callbacks::new());
        let kind = c_int::from(interface == Interface::CoSimulation);
        // SAFETY: texts end with zero, and callbacks live as long as the instance.
        let instance = unsafe {
            (functions.instantiate)(
                c"mbint".as_ptr(),
                kind,
                token.as_ptr(),
                resources.as_ptr(),
                &raw const *callbacks,
                0,
                0,
            )
        };
        if instance.is_null() {
            return Err(Fault::NoInstance("fmi2Instantiate"));
        }
        Ok(Self { functions, instance, indicators, _callbacks: callbacks })
    }
}

impl Drop for Two<'_> {
    fn drop(&mut self) {
        // SAFETY: the instance is the library's own, and is not used again.
        unsafe { (self.functions.free)(self.instance) };
    }
}

impl Instance for Two<'_> {
    fn set(&mut self, kind: NumberType, reference: u32, value: f64) -> Result<(), Fault> {
        let of = &raw const reference;
        match kind {
            NumberType::Float64 | NumberType::Float32 => call!(self, set_real, "fmi2SetReal", of, 1, &raw const value),
            NumberType::Boolean => {
                let value = c_int::from(truth(value)?);
                call!(self, set_boolean, "fmi2SetBoolean", of, 1, &raw const value)
            }
            _ => {
                let value: c_int = whole(value)?;
                call!(self, set_integer, "fmi2SetInteger", of, 1, &raw const value)
            }
        }
    }

    fn get(&mut self, kind: NumberType, reference: u32) -> Result<f64, Fault> {
        let of = &raw const reference;
        let (mut real, mut integer) = (0.0, 0);
        match kind {
            NumberType::Float64 | NumberType::Float32 => {
                call!(self, get_real, "fmi2GetReal", of, 1, &raw mut real)?;
                return Ok(real);
            }
            NumberType::Boolean => call!(self, get_boolean, "fmi2GetBoolean", of, 1, &raw mut integer)?,
            // All others are integers of one width.
            _ => call!(self, get_integer, "fmi2GetInteger", of, 1, &raw mut integer)?,
        }
        Ok(f64::from(integer))
    }

    fn initialise(&mut self, end: f64) -> Result<(), Fault> {
        call!(self, setup, "fmi2SetupExperiment", 0, 0.0, 0.0, c_int::from(end > 0.0), end)?;
        call!(self, enter_initialisation, "fmi2EnterInitializationMode")?;
        call!(self, exit_initialisation, "fmi2ExitInitializationMode")
    }

    fn step(&mut self, time: f64, size: f64) -> Result<bool, Fault> {
        let done = call_own!(self, do_step, "fmi2DoStep", time, size, 1);
        let Err(Fault::Status { status: DISCARD, .. }) = done else { return done.map(|()| false) };
        let (mut terminated, mut reached) = (0, time);
        let is_known = call_own!(self, boolean_status, "fmi2GetBooleanStatus", TERMINATED, &raw mut terminated).is_ok()
            && call_own!(self, real_status, "fmi2GetRealStatus", LAST_TIME, &raw mut reached).is_ok();
        match is_known && terminated != 0 {
            true if is_before(reached, time + size) => Err(Fault::Terminated(reached)),
            true => Ok(true),
            false => done.map(|()| false),
        }
    }

    fn enter_events(&mut self) -> Result<(), Fault> {
        call_own!(self, enter_events, "fmi2EnterEventMode")
    }

    fn update_discrete(&mut self) -> Result<Discrete, Fault> {
        let mut info = EventInfo::default();
        call_own!(self, new_discrete_states, "fmi2NewDiscreteStates", &raw mut info)?;
        Ok(Discrete {
            again: info.again != 0,
            terminates: info.terminates != 0,
            next: (info.is_next_known != 0).then_some(info.next),
        })
    }

    fn enter_continuous(&mut self) -> Result<(), Fault> {
        call_own!(self, enter_continuous, "fmi2EnterContinuousTimeMode")
    }

    fn set_time(&mut self, time: f64) -> Result<(), Fault> {
        call_own!(self, set_time, "fmi2SetTime", time)
    }

    fn set_states(&mut self, states: &[f64]) -> Result<(), Fault> {
        call_own!(self, set_states, "fmi2SetContinuousStates", states.as_ptr(), states.len())
    }

    fn states(&mut self, into: &mut [f64]) -> Result<(), Fault> {
        call_own!(self, get_states, "fmi2GetContinuousStates", into.as_mut_ptr(), into.len())
    }

    fn derivatives(&mut self, into: &mut [f64]) -> Result<(), Fault> {
        call_own!(self, get_derivatives, "fmi2GetDerivatives", into.as_mut_ptr(), into.len())
    }

    fn indicators(&mut self, into: &mut Vec<f64>) -> Result<(), Fault> {
        into.resize(self.indicators, 0.0);
        call_own!(self, get_indicators, "fmi2GetEventIndicators", into.as_mut_ptr(), into.len())
    }

    fn completed(&mut self) -> Result<Discrete, Fault> {
        let (mut event, mut ends): (c_int, c_int) = (0, 0);
        call_own!(self, completed, "fmi2CompletedIntegratorStep", 1, &raw mut event, &raw mut ends)?;
        Ok(Discrete { again: event != 0, terminates: ends != 0, next: None })
    }
}
