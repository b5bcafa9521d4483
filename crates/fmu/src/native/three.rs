//! FMI 3.0. Source: `fmi3FunctionTypes.h`.

#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;
use std::ptr;

use super::callbacks::log_three;
use super::library::{call, call_own, functions};
use super::{Discrete, Fault, Instance, is_before, truth, whole};
use crate::unit::{Interface, NumberType};

type Own = *mut c_void;
type Log = extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);
/// `fmi3IntermediateUpdateCallback`, which is never passed.
type Update = Option<extern "C" fn()>;

functions! {
    /// Functions of the standard.
    Functions {
        always {
            free = b"fmi3FreeInstance": fn(Own);
            enter_initialisation = b"fmi3EnterInitializationMode": fn(Own, bool, f64, f64, bool, f64) -> c_int;
            exit_initialisation = b"fmi3ExitInitializationMode": fn(Own) -> c_int;
            get_float64 = b"fmi3GetFloat64": fn(Own, *const u32, usize, *mut f64, usize) -> c_int;
            set_float64 = b"fmi3SetFloat64": fn(Own, *const u32, usize, *const f64, usize) -> c_int;
            get_float32 = b"fmi3GetFloat32": fn(Own, *const u32, usize, *mut f32, usize) -> c_int;
            set_float32 = b"fmi3SetFloat32": fn(Own, *const u32, usize, *const f32, usize) -> c_int;
            get_int8 = b"fmi3GetInt8": fn(Own, *const u32, usize, *mut i8, usize) -> c_int;
            set_int8 = b"fmi3SetInt8": fn(Own, *const u32, usize, *const i8, usize) -> c_int;
            get_uint8 = b"fmi3GetUInt8": fn(Own, *const u32, usize, *mut u8, usize) -> c_int;
            set_uint8 = b"fmi3SetUInt8": fn(Own, *const u32, usize, *const u8, usize) -> c_int;
            get_int16 = b"fmi3GetInt16": fn(Own, *const u32, usize, *mut i16, usize) -> c_int;
            set_int16 = b"fmi3SetInt16": fn(Own, *const u32, usize, *const i16, usize) -> c_int;
            get_uint16 = b"fmi3GetUInt16": fn(Own, *const u32, usize, *mut u16, usize) -> c_int;
            set_uint16 = b"fmi3SetUInt16": fn(Own, *const u32, usize, *const u16, usize) -> c_int;
            get_int32 = b"fmi3GetInt32": fn(Own, *const u32, usize, *mut i32, usize) -> c_int;
            set_int32 = b"fmi3SetInt32": fn(Own, *const u32, usize, *const i32, usize) -> c_int;
            get_uint32 = b"fmi3GetUInt32": fn(Own, *const u32, usize, *mut u32, usize) -> c_int;
            set_uint32 = b"fmi3SetUInt32": fn(Own, *const u32, usize, *const u32, usize) -> c_int;
            get_int64 = b"fmi3GetInt64": fn(Own, *const u32, usize, *mut i64, usize) -> c_int;
            set_int64 = b"fmi3SetInt64": fn(Own, *const u32, usize, *const i64, usize) -> c_int;
            get_uint64 = b"fmi3GetUInt64": fn(Own, *const u32, usize, *mut u64, usize) -> c_int;
            set_uint64 = b"fmi3SetUInt64": fn(Own, *const u32, usize, *const u64, usize) -> c_int;
            get_boolean = b"fmi3GetBoolean": fn(Own, *const u32, usize, *mut u8, usize) -> c_int;
            set_boolean = b"fmi3SetBoolean": fn(Own, *const u32, usize, *const u8, usize) -> c_int;
        }
        co_simulation {
            co_simulation = b"fmi3InstantiateCoSimulation": fn(*const c_char, *const c_char, *const c_char, bool, bool, bool, bool, *const u32, usize, *mut c_void, Log, Update) -> Own;
            do_step = b"fmi3DoStep": fn(Own, f64, f64, bool, *mut bool, *mut bool, *mut bool, *mut f64) -> c_int;
        }
        model_exchange {
            model_exchange = b"fmi3InstantiateModelExchange": fn(*const c_char, *const c_char, *const c_char, bool, bool, *mut c_void, Log) -> Own;
            enter_events = b"fmi3EnterEventMode": fn(Own) -> c_int;
            update_discrete_states = b"fmi3UpdateDiscreteStates": fn(Own, *mut bool, *mut bool, *mut bool, *mut bool, *mut bool, *mut f64) -> c_int;
            enter_continuous = b"fmi3EnterContinuousTimeMode": fn(Own) -> c_int;
            completed = b"fmi3CompletedIntegratorStep": fn(Own, bool, *mut bool, *mut bool) -> c_int;
            set_time = b"fmi3SetTime": fn(Own, f64) -> c_int;
            set_states = b"fmi3SetContinuousStates": fn(Own, *const f64, usize) -> c_int;
            get_states = b"fmi3GetContinuousStates": fn(Own, *mut f64, usize) -> c_int;
            get_derivatives = b"fmi3GetContinuousStateDerivatives": fn(Own, *mut f64, usize) -> c_int;
            count_indicators = b"fmi3GetNumberOfEventIndicators": fn(Own, *mut usize) -> c_int;
            get_indicators = b"fmi3GetEventIndicators": fn(Own, *mut f64, usize) -> c_int;
        }
    }
}

/// Sets an integer variable.
macro_rules! set_whole {
    ($self:ident, $field:ident: $integer:ty, $symbol:literal, $of:expr, $value:expr) => {{
        let value: $integer = whole($value)?;
        call!($self, $field, $symbol, $of, 1, &raw const value, 1)
    }};
}

/// An integer variable's value; a large one is rounded.
macro_rules! get_whole {
    ($self:ident, $field:ident: $integer:ty, $symbol:literal, $of:expr) => {{
        let mut value: $integer = 0;
        call!($self, $field, $symbol, $of, 1, &raw mut value, 1)?;
        value as f64
    }};
}

/// An instance.
pub struct Three<'f> {
    functions: &'f Functions,
    instance: Own,
}

impl<'f> Three<'f> {
    /// A new instance.
    ///
    /// # Errors
    /// If the unit makes none.
    pub fn new(functions: &'f Functions, token: &str, resources: &Path, interface: Interface) -> Result<Self, Fault> {
        let none = |_| Fault::Library("its description has a zero byte".to_owned());
        let token = CString::new(token).map_err(none)?;
        // With a separator at the end, as the standard requires.
        let resources = CString::new(format!("{}{}", resources.display(), std::path::MAIN_SEPARATOR)).map_err(none)?;
        let (name, token, resources) = (c"mbint".as_ptr(), token.as_ptr(), resources.as_ptr());
        let nobody = ptr::null_mut();
        // SAFETY: texts end with zero; there is no environment, and the callback stores nothing.
        let instance = unsafe {
            match (functions.co_simulation, functions.model_exchange) {
                (Some(make), _) if interface == Interface::CoSimulation => {
                    make(name, token, resources, false, false, false, false, ptr::null(), 0, nobody, log_three, None)
                }
                (_, Some(make)) => make(name, token, resources, false, false, nobody, log_three),
                _ => nobody,
            }
        };
        if instance.is_null() {
            return Err(Fault::NoInstance("fmi3Instantiate"));
        }
        Ok(Self { functions, instance })
    }
}

impl Drop for Three<'_> {
    fn drop(&mut self) {
        // SAFETY: the instance is the library's own, and is not used again.
        unsafe { (self.functions.free)(self.instance) };
    }
}

impl Instance for Three<'_> {
    fn set(&mut self, kind: NumberType, reference: u32, value: f64) -> Result<(), Fault> {
        let of = &raw const reference;
        match kind {
            NumberType::Float64 => call!(self, set_float64, "fmi3SetFloat64", of, 1, &raw const value, 1),
            NumberType::Float32 => {
                let value = value as f32;
                call!(self, set_float32, "fmi3SetFloat32", of, 1, &raw const value, 1)
            }
            NumberType::Int8 => set_whole!(self, set_int8: i8, "fmi3SetInt8", of, value),
            NumberType::UInt8 => set_whole!(self, set_uint8: u8, "fmi3SetUInt8", of, value),
            NumberType::Int16 => set_whole!(self, set_int16: i16, "fmi3SetInt16", of, value),
            NumberType::UInt16 => set_whole!(self, set_uint16: u16, "fmi3SetUInt16", of, value),
            NumberType::Int32 => set_whole!(self, set_int32: i32, "fmi3SetInt32", of, value),
            NumberType::UInt32 => set_whole!(self, set_uint32: u32, "fmi3SetUInt32", of, value),
            NumberType::Int64 => set_whole!(self, set_int64: i64, "fmi3SetInt64", of, value),
            NumberType::UInt64 => set_whole!(self, set_uint64: u64, "fmi3SetUInt64", of, value),
            NumberType::Boolean => {
                let value = u8::from(truth(value)?);
                call!(self, set_boolean, "fmi3SetBoolean", of, 1, &raw const value, 1)
            }
        }
    }

    fn get(&mut self, kind: NumberType, reference: u32) -> Result<f64, Fault> {
        let of = &raw const reference;
        let (mut double, mut single, mut truth) = (0.0, 0.0_f32, 0);
        match kind {
            NumberType::Float64 => call!(self, get_float64, "fmi3GetFloat64", of, 1, &raw mut double, 1)?,
            NumberType::Float32 => {
                call!(self, get_float32, "fmi3GetFloat32", of, 1, &raw mut single, 1)?;
                double = f64::from(single);
            }
            NumberType::Int8 => double = get_whole!(self, get_int8: i8, "fmi3GetInt8", of),
            NumberType::UInt8 => double = get_whole!(self, get_uint8: u8, "fmi3GetUInt8", of),
            NumberType::Int16 => double = get_whole!(self, get_int16: i16, "fmi3GetInt16", of),
            NumberType::UInt16 => double = get_whole!(self, get_uint16: u16, "fmi3GetUInt16", of),
            NumberType::Int32 => double = get_whole!(self, get_int32: i32, "fmi3GetInt32", of),
            NumberType::UInt32 => double = get_whole!(self, get_uint32: u32, "fmi3GetUInt32", of),
            NumberType::Int64 => double = get_whole!(self, get_int64: i64, "fmi3GetInt64", of),
            NumberType::UInt64 => double = get_whole!(self, get_uint64: u64, "fmi3GetUInt64", of),
            NumberType::Boolean => {
                call!(self, get_boolean, "fmi3GetBoolean", of, 1, &raw mut truth, 1)?;
                double = f64::from(truth);
            }
        }
        Ok(double)
    }

    fn initialise(&mut self, end: f64) -> Result<(), Fault> {
        call!(self, enter_initialisation, "fmi3EnterInitializationMode", false, 0.0, 0.0, end > 0.0, end)?;
        call!(self, exit_initialisation, "fmi3ExitInitializationMode")
    }

    fn step(&mut self, time: f64, size: f64) -> Result<bool, Fault> {
        let (mut event, mut ends, mut early, mut reached) = (false, false, false, time);
        let found = [&raw mut event, &raw mut ends, &raw mut early];
        call_own!(self, do_step, "fmi3DoStep", time, size, true, found[0], found[1], found[2], &raw mut reached)?;
        if ends && is_before(reached, time + size) { Err(Fault::Terminated(reached)) } else { Ok(ends) }
    }

    fn enter_events(&mut self) -> Result<(), Fault> {
        call_own!(self, enter_events, "fmi3EnterEventMode")
    }

    fn update_discrete(&mut self) -> Result<Discrete, Fault> {
        let mut found = [false; 5];
        let mut next = 0.0;
        let [again, ends, nominals, states, known] = found.each_mut().map(|own| own as *mut bool);
        let next_at = &raw mut next;
        call_own!(
            self,
            update_discrete_states,
            "fmi3UpdateDiscreteStates",
            again,
            ends,
            nominals,
            states,
            known,
            next_at
        )?;
        let [again, terminates, _, _, is_next_known] = found;
        Ok(Discrete { again, terminates, next: is_next_known.then_some(next) })
    }

    fn enter_continuous(&mut self) -> Result<(), Fault> {
        call_own!(self, enter_continuous, "fmi3EnterContinuousTimeMode")
    }

    fn set_time(&mut self, time: f64) -> Result<(), Fault> {
        call_own!(self, set_time, "fmi3SetTime", time)
    }

    fn set_states(&mut self, states: &[f64]) -> Result<(), Fault> {
        call_own!(self, set_states, "fmi3SetContinuousStates", states.as_ptr(), states.len())
    }

    fn states(&mut self, into: &mut [f64]) -> Result<(), Fault> {
        call_own!(self, get_states, "fmi3GetContinuousStates", into.as_mut_ptr(), into.len())
    }

    fn derivatives(&mut self, into: &mut [f64]) -> Result<(), Fault> {
        call_own!(self, get_derivatives, "fmi3GetContinuousStateDerivatives", into.as_mut_ptr(), into.len())
    }

    fn indicators(&mut self, into: &mut Vec<f64>) -> Result<(), Fault> {
        let mut count = 0;
        call_own!(self, count_indicators, "fmi3GetNumberOfEventIndicators", &raw mut count)?;
        into.resize(count, 0.0);
        call_own!(self, get_indicators, "fmi3GetEventIndicators", into.as_mut_ptr(), count)
    }

    fn completed(&mut self) -> Result<Discrete, Fault> {
        let (mut event, mut ends) = (false, false);
        call_own!(self, completed, "fmi3CompletedIntegratorStep", true, &raw mut event, &raw mut ends)?;
        Ok(Discrete { again: event, terminates: ends, next: None })
    }
}
